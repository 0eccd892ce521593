"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const unpacked = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
const [attitude, centre, tilt] = [data.quaternion, data.centre, data.tilt].map(unpacked);
const last = tilt.length - 1;
const element = (name) => document.getElementById(name);
const [canvas, slider, play, speed] = ["scene", "time", "play", "speed"].map(element);
let time = 0, before = null, turned = data.turned, raised = 0.35;
slider.max = data.end;

function pose() {
  const position = last * Math.min(time / data.end, 1), k = Math.min(Math.floor(position), last - 1), fraction = position - k;
  const between = (row, width) => Array.from({ length: width },
    (_, i) => row[width * k + i] * (1 - fraction) + row[width * (k + 1) + i] * fraction);
  let [s, x, y, z] = between(attitude, 4);
  const length = Math.hypot(s, x, y, z);
  [s, x, y, z] = [s / length, x / length, y / length, z / length];
  return {
    turn: [[1 - 2 * (y * y + z * z), 2 * (x * y - s * z), 2 * (x * z + s * y)],
           [2 * (x * y + s * z), 1 - 2 * (x * x + z * z), 2 * (y * z - s * x)],
           [2 * (x * z - s * y), 2 * (y * z + s * x), 1 - 2 * (x * x + y * y)]],
    centre: between(centre, 3), tilt: between(tilt, 1)[0],
  };
}

function draw() {
  const wide = canvas.clientWidth, high = 0.62 * wide, sharp = window.devicePixelRatio || 1;
  canvas.width = wide * sharp; canvas.height = high * sharp; canvas.style.height = high + "px";
  const pen = canvas.getContext("2d"), look = getComputedStyle(document.documentElement);
  const colour = (name) => look.getPropertyValue(name).trim();
  const [c, s, ce, se] = [Math.cos(turned), Math.sin(turned), Math.cos(raised), Math.sin(raised)];
  const unit = 0.42 * high / data.reach * sharp, [mx, my, mz] = data.middle;
  const seen = ([x, y, z]) => [0.5 * canvas.width + unit * (c * (y - my) - s * (x - mx)),
    0.5 * canvas.height - unit * (ce * (z - mz) - se * (c * (x - mx) + s * (y - my)))];
  const path = (points) => { pen.beginPath(); points.forEach((p) => pen.lineTo(...seen(p))); };
  const gap = data.reach / 4;
  pen.strokeStyle = colour("--line"); pen.lineWidth = 0.7 * sharp;
  for (let k = -48; k <= 48; k += 1) {
    path([[k * gap, -48 * gap, 0], [k * gap, 48 * gap, 0]]); pen.stroke();
    path([[-48 * gap, k * gap, 0], [48 * gap, k * gap, 0]]); pen.stroke();
  }
  const now = pose(), at = (p) => now.turn.map((row) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
  const points = data.points.map((p) => at(p).map((value, i) => value + now.centre[i]));
  pen.strokeStyle = colour("--ink"); pen.lineJoin = "round";
  data.facets.forEach((facet, k) => {
    const n = at(data.normals[k]);
    if (n[0] * ce * c + n[1] * ce * s + n[2] * se <= 0) return; // hidden facet of a convex body
    const shade = Math.max(0, 0.35 * n[0] - 0.25 * n[1] + 0.9 * n[2]);
    pen.fillStyle = colour("--body"); path(facet.map((i) => points[i])); pen.closePath(); pen.fill();
    pen.fillStyle = `rgba(0, 0, 0, ${0.35 * (1 - Math.min(1, shade))})`; pen.fill(); pen.stroke();
  });
  element("now").textContent = time.toFixed(2) + " s";
  element("tilt").textContent = (now.tilt * 180 / Math.PI).toFixed(2) + " deg";
  slider.value = time;
}

function step(moment) {
  if (before === null) return;
  time += (moment - before) / 1000 * Number(speed.value);
  before = moment;
  if (time >= data.end) { time = data.end; stop(); }
  draw();
  if (before !== null) requestAnimationFrame(step);
}
function stop() { before = null; play.textContent = "Play"; }
play.addEventListener("click", () => {
  if (before !== null) { stop(); return; }
  if (time >= data.end) time = 0;
  before = performance.now(); play.textContent = "Pause"; requestAnimationFrame(step);
});
slider.addEventListener("input", () => { time = Number(slider.value); draw(); });
canvas.addEventListener("pointermove", (event) => {
  if (!event.buttons) return;
  turned -= event.movementX / 150;
  raised = Math.min(1.5, Math.max(0.05, raised + event.movementY / 150));
  draw();
});
window.addEventListener("resize", draw);
draw();
