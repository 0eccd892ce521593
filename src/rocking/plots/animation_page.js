"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const element = (id) => document.getElementById(id);
const unpacked = (text) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, k) => view.getFloat32(4 * k, true));
};
const series = {};
for (const name of ["rotation", "velocity", "ground", "acceleration"]) series[name] = unpacked(data[name]);
const degrees = 180 / Math.PI;
const last = series.rotation.length - 1;
const reach = series.rotation.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
const hardest = series.acceleration.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
let now = 0, playing = false, before = null, colours = {};

const at = (name, time) => {
  const x = Math.min(Math.max(time / data.end, 0), 1) * last;
  const k = Math.min(Math.floor(x), last - 1);
  return series[name][k] + (series[name][k + 1] - series[name][k]) * (x - k);
};
const speed = () => Number(element("speed").value);
const ratio = (theta) => theta / (theta > 0 ? data.alpha[1] : data.alpha[0]);
// a minus sign, and none before a zero
const fixed = (value, digits) => {
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) > 0 ? "\u2212" + text : text;
};

function draw() {
  const theta = at("rotation", now);
  element("now").textContent = now.toFixed(3) + " s";
  element("rotation").textContent = fixed(theta * degrees, 3) + "\u00b0";
  element("share").textContent = fixed(ratio(theta), 3);
  element("velocity").textContent = fixed(at("velocity", now), 3) + " rad/s";
  element("time").value = now / data.end;
  element("time").setAttribute("aria-valuetext", now.toFixed(2) + " seconds, " + fixed(theta * degrees, 1) + " degrees");
  drawScene();
  drawCurve();
}

function frame(stamp) {
  if (!playing) return;
  if (before !== null) now += Math.min((stamp - before) / 1000, 0.1) * speed();
  before = stamp;
  if (now >= data.end) {
    now = data.end;
    play(false);
  } else requestAnimationFrame(frame);
  draw();
}

function play(start) {
  if (start && now >= data.end) now = 0;
  if (start && !playing) requestAnimationFrame(frame);
  playing = start;
  before = null;
  element("play").textContent = playing ? "Pause" : "Play";
  if (!playing) speak();
}

function speak() {
  const theta = at("rotation", now);
  element("spoken").textContent = "At " + now.toFixed(2) + " seconds the rotation is " + fixed(theta * degrees, 2) +
    " degrees" + (now >= data.end ? "; the end: " + data.outcome : "") + ".";
}

function seek(time) {
  now = Math.min(Math.max(time, 0), data.end);
  play(false);
  draw();
}

function paint() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["ink", "soft", "line", "body", "rotation", "impact", "fall"])
    colours[name] = style.getPropertyValue("--" + name).trim();
  draw();
}

for (const [time, first, second, r, onto] of data.impacts) {
  const row = element("impacts").insertRow();
  for (const text of [time.toFixed(4), fixed(first, 4), fixed(second, 4), r.toFixed(4), onto > 0 ? "right" : "left"])
    row.insertCell().textContent = text;
}
element("play").addEventListener("click", () => play(!playing));
element("time").addEventListener("input", (event) => seek(Number(event.target.value) * data.end));
element("speed").addEventListener("change", draw);
const curve = element("curve");
const drag = (event) => seek(curve.seek(event.clientX - curve.getBoundingClientRect().left));
curve.addEventListener("pointerdown", (event) => { curve.setPointerCapture(event.pointerId); drag(event); });
curve.addEventListener("pointermove", (event) => { if (event.buttons) drag(event); });
document.addEventListener("keydown", (event) => {
  const where = event.target.tagName, stride = event.shiftKey ? 0.5 : 1 / 30;
  if (event.ctrlKey || event.metaKey || event.altKey || where === "SELECT") return;
  const does = {
    " ": () => play(!playing),
    ArrowRight: () => seek(now + stride),
    ArrowLeft: () => seek(now - stride),
    Home: () => seek(0),
    End: () => seek(data.end),
  }[event.key];
  if (!does || (event.key === " " && (where === "BUTTON" || where === "SUMMARY"))) return;
  event.preventDefault();
  does();
});
window.addEventListener("resize", draw);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
paint();
// page.html#t=1.5 opens at this time
const requested = /^#t=([0-9.]+)$/.exec(window.location.hash);
if (requested) seek(Number(requested[1]));
else if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
