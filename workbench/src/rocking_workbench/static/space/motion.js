/** Animation of a 3D body: common time of the picture, the curve of the tilt, and the text. */

import { fixed } from "/app/format.js";
import { html, useEffect, useRef, useSignal } from "/parts/preact.js";
import { highest } from "/app/extremes.js";
import { lineChart } from "/charts/line.js";
import { Choice } from "/parts/fields.js";
import { Clock } from "/scene/clock.js";
import { noteFrame, resetFrames } from "/scene/frames.js";
import { Played } from "/space/played.js";
import { Scene } from "/space/scene.js";
import { t } from "/app/words.js";

const WORTH = 0.01; // smallest energy loss of a marked impact / largest loss
const UPDATE_INTERVAL = 100; // between two updates of text and curve during playback [ms]
const SPEEDS = [["1", "1\u00d7, real speed"], ["2", "2\u00d7"], ["0.5", "0.5\u00d7"], ["0.1", "0.1\u00d7, slow motion"]];
/** @type {{ [key: string]: number }} */
const STRIDES = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
const LEGEND = [["holds", "sticking contact"], ["slides", "sliding contact"], ["plumb", "centre of mass and plumb line"]];

// Marked impacts: those with a visible energy loss.
/** @param {{ time: number, energy_before: number, energy_after: number }[]} impacts */
const marked = (impacts) => {
  const losses = impacts.map((impact) => impact.energy_before - impact.energy_after);
  const most = highest(losses);
  return impacts.filter((_, k) => losses[k] > WORTH * most).map(({ time: at }) => at);
};

/** Motion of a result, with its controls.
 * @param {{ question: Server.WholeQuestion, answer: any }} props */
export const MotionScene = ({ question, answer }) => {
  const [now, running, text] = [useSignal(0), useSignal(false), useSignal("Loading the motion.")];
  const speed = useSignal("1");
  /** @type {{ clock: Clock, played: Played, chart: Chart, updated: number }} */
  const kept = useRef(/** @type {any} */ ({ clock: new Clock(), played: null, chart: null, updated: 0 })).current;
  const curve = useRef(null);
  const { clock } = kept;
  const tell = () => {
    now.value = clock.now;
    text.value = kept.played.describe(clock.now);
    kept.chart.point(clock.now);
  };
  /** @param {number} instant */
  const seek = (instant) => {
    if (!kept.played) return;
    clock.seek(instant);
    clock.stop();
    running.value = false;
    kept.played.show(clock.now);
    tell();
  };
  /** @param {number} stamp */
  const frame = (stamp) => {
    if (!clock.running) return;
    const begun = performance.now();
    clock.speed = Number(speed.value);
    clock.tick(stamp);
    kept.played.show(clock.now);
    if (stamp - kept.updated > UPDATE_INTERVAL || !clock.running) {
      kept.updated = stamp;
      tell();
    }
    noteFrame(performance.now() - begun);
    if (clock.running) requestAnimationFrame(frame);
    else running.value = false;
  };
  const toggle = () => {
    if (!kept.played) return;
    if (clock.running) {
      seek(clock.now);
      return;
    }
    clock.start();
    resetFrames();
    running.value = clock.running;
    requestAnimationFrame(frame);
  };
  /** @param {SpaceStage} stage */
  const standing = (stage) => {
    kept.played = new Played(stage.three, stage, answer);
    clock.end = kept.played.end;
    const { time, tilt } = kept.played.motion;
    kept.chart = lineChart(curve.current, {
      title: "Tilt from the initial pose", height: 150, x: { label: "time", unit: "s" }, y: { label: "tilt", unit: "\u00b0" },
      series: [{ label: "tilt", colour: "--accent" }],
    });
    kept.chart.setData([Array.from(time), Array.from(tilt, (angle) => (angle * 180) / Math.PI)]);
    kept.chart.setMarks({ vertical: marked(answer.impacts) });
    kept.chart.plot.over.addEventListener("click", () => {
      const at = kept.chart.plot.cursor.left;
      if (at !== undefined && at >= 0) seek(kept.chart.plot.posToVal(at, "x"));
    });
    seek(0);
  };
  useEffect(() => () => {
    clock.stop();
    kept.chart?.destroy();
  }, []);
  return html`
    <${Scene} question=${question} description=${text.value} legend=${LEGEND} title="Motion of the body" onStage=${standing} onSpace=${toggle}
      label=${t("Motion of the body: {summary}", { summary: answer.summary })} />
    <div class="scene-row" role="group" aria-label="Play">
      <button type="button" class="button primary scene-play" data-testid="space-play" onClick=${toggle}>
        ${running.value ? "Pause" : "Play"}</button>
      <input type="range" class="scene-time" min="0" max=${clock.end || 1} step="any" value=${now.value} aria-label="Instant"
        aria-valuetext=${text.value} data-testid="space-time" onInput=${(event) => seek(Number(event.target.value))}
        onKeyDown=${(event) => {
          const stride = STRIDES[event.key];
          if (!stride) return;
          event.preventDefault();
          seek(clock.now + (stride * (event.shiftKey ? 0.5 : 0.05)));
        }} />
      <output>${fixed(now.value, 2)} s</output>
    </div>
    <${Choice} label="Speed" value=${speed} options=${SPEEDS} />
    <div ref=${curve} data-own=${question.name}></div>`;
};
