/** Controls under the stage: play, speed, position and ground motion. */
import { fixed } from "/app/format.js";
import { el, svg } from "/app/dom.js";
import { t } from "/app/words.js";

const SPEEDS = [
  ["2", "2\u00d7"],
  ["1", "1\u00d7, real speed"],
  ["0.5", "0.5\u00d7"],
  ["0.1", "0.1\u00d7, slow motion"],
  ["0.01", "0.01\u00d7"],
];
const GROUNDS = [
  ["true", "true scale"],
  ["magnified", "magnified"],
  ["ride", "camera follows the ground"],
];
const PLAY = "M3 1.5v13l11-6.5z";
const PAUSE = "M3 1.5h3.6v13H3zM9.4 1.5H13v13H9.4z";
const DEGREES = 180 / Math.PI;

/** @param {string} label @param {string[][]} options @param {string} value @param {string} testid @param {(value: string) => unknown} onChange */
const choice = (label, options, value, testid, onChange) => {
  const items = options.map(([key, text]) => el("option", { value: key }, text));
  const select = el("select", { "data-testid": testid }, ...items);
  select.value = value;
  select.addEventListener("change", () => onChange(select.value));
  return el("label", { class: "scene-choice" }, el("span", {}, label), select);
};

/** @param {() => unknown} onToggle @returns {[HTMLButtonElement, (running: boolean) => void]} */
const playButton = (onToggle) => {
  const path = svg("path", { d: PLAY, fill: "currentColor" });
  const icon = svg("svg", { viewBox: "0 0 16 16", width: "16", height: "16", "aria-hidden": "true" }, path);
  const caption = el("span", {}, "Play");
  const button = el(
    "button",
    { type: "button", class: "button primary scene-play", "data-testid": "scene-play", title: "Space" },
    icon,
    caption,
  );
  button.addEventListener("click", onToggle);
  /** @param {boolean} running */
  const tellRunning = (running) => {
    path.setAttribute("d", running ? PAUSE : PLAY);
    caption.textContent = t(running ? "Pause" : "Play");
    button.dataset.running = String(running);
  };
  return [button, tellRunning];
};

/** @param {(share: number) => unknown} onSeek */
const scrubber = (onSeek) => {
  const range = el("input", {
    type: "range",
    class: "scene-time",
    min: "0",
    max: "1000",
    step: "1",
    value: "0",
    "aria-label": "Instant of the animation",
    "data-testid": "scene-time",
  });
  range.addEventListener("input", () => onSeek(Number(range.value) / 1000));
  return range;
};

/** Controls: their element, and functions to update them.
 * @param {{ onToggle: () => unknown, onSeek: (share: number) => unknown, onSpeed: (speed: number) => unknown, onGround: (mode: string) => unknown }} acts */
export const controlsOf = ({ onToggle, onSeek, onSpeed, onGround }) => {
  const [button, tellRunning] = playButton(onToggle);
  const range = scrubber(onSeek);
  const time = el("output", { class: "scene-now", "data-testid": "scene-now" }, "0.000 s");
  const rotationOutput = el("output", { class: "scene-place", "data-testid": "scene-rotation" });
  const factor = el("span", { class: "scene-factor", "aria-live": "polite" });
  const element = el(
    "div",
    { class: "scene-controls" },
    el("div", { class: "scene-row" }, button, range),
    el("div", { class: "scene-row scene-readout" }, time, rotationOutput, factor),
    el(
      "div",
      { class: "scene-row" },
      choice("Speed", SPEEDS, "1", "scene-speed", (text) => onSpeed(Number(text))),
      choice("Ground", GROUNDS, "true", "scene-ground", onGround),
    ),
  );
  /** @param {number} now @param {number} end @param {number} rotation @param {number} share */
  const tell = (now, end, rotation, share) => {
    range.value = String(end > 0 ? (1000 * now) / end : 0);
    time.textContent = `${fixed(now, 3)} s`;
    rotationOutput.textContent = t("\u03b8 = {rotation}\u00b0, {share} of \u03b1", { rotation: fixed(rotation * DEGREES, 2), share: fixed(share, 2) });
    const degrees = fixed(rotation * DEGREES, 1);
    range.setAttribute("aria-valuetext", t("{time} seconds, {angle} degrees", { time: fixed(now, 2), angle: degrees }));
  };
  /** @param {string} mode @param {number} times @param {boolean} rides */
  const tellGround = (mode, times, rides) => {
    const far = "large ground displacement: the camera follows the ground";
    const magnified = times === 1 ? "" : t("ground displacement magnified {factor} times", { factor: times });
    const text = mode !== "ride" && rides ? far : magnified;
    if (factor.textContent !== text) factor.textContent = text;
  };
  return { element, tell, tellRunning, tellGround };
};
