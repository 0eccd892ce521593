function sized(canvas, height) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "13px system-ui, 'DejaVu Sans', sans-serif";
  return [pen, width, height];
}

function line(pen, points, colour, width, dashes) {
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.setLineDash(dashes || []);
  pen.stroke();
  pen.setLineDash([]);
}

function drawScene() {
  const canvas = element("scene"), [x0, y0, x1, y1] = data.window;
  const tall = (canvas.clientWidth * (y1 - y0)) / (x1 - x0);
  const height = Math.round(Math.min(Math.max(tall, 220), Math.max(260, (canvas.clientWidth < 560 ? 0.36 : 0.46) * window.innerHeight)));
  canvas.style.height = height + "px";
  const [pen, w, h] = sized(canvas, height);
  const floor = 46, scale = Math.min(w / (x1 - x0), (h - floor) / (y1 - Math.max(y0, 0)));
  const moved = at("ground", now), camera = (x0 + x1) / 2 + (data.follows ? moved : 0);
  const project = (x, y) => [w / 2 + (x - camera) * scale, h - floor - y * scale];
  drawGround(pen, w, h, h - floor, scale, project, moved, camera);
  const theta = at("rotation", now), pivot = theta > 0 ? data.feet[1] : data.feet[0];
  const c = Math.cos(theta), s = Math.sin(theta);
  const turned = ([x, y]) => project(pivot + c * (x - pivot) + s * y + moved, -s * (x - pivot) + c * y);
  drawBody(pen, turned);
  drawFlash(pen, project, moved);
}

function drawGround(pen, w, h, level, scale, project, moved, camera) {
  line(pen, [[0, level], [w, level]], colours.ink, 1.5);
  // hatches belong to the ground and move with it
  const gap = 16 / scale, first = Math.floor((camera - w / 2 / scale - moved) / gap);
  for (let k = first; k * gap < camera - moved + w / 2 / scale + gap; k++) {
    const [x] = project(k * gap + moved, 0);
    line(pen, [[x, level], [x - 8, level + 8]], colours.soft, 1);
  }
  // the ruler is fixed
  const step = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]
    .find((length) => length * scale > 70) || 5000;
  pen.fillStyle = colours.soft;
  pen.textAlign = "center";
  for (let k = Math.ceil((camera - w / 2 / scale) / step); k * step < camera + w / 2 / scale; k++) {
    const [x] = project(k * step, 0);
    line(pen, [[x, level + 14], [x, level + 20]], colours.soft, 1);
    if (x > 25 && x < w - 25) pen.fillText(fixed(k * step, step < 0.01 ? 3 : step < 0.1 ? 2 : step < 1 ? 1 : 0) + " m", x, level + 35);
  }
  pen.textAlign = "left";
  if (!hardest) return pen.fillText("the ground is at rest", 10, 20);
  const push = at("acceleration", now), long = (60 * push) / hardest, from = [80, 36];
  pen.fillText("ground acceleration " + fixed(push, 2) + " m/s\u00b2", 10, 20);
  if (Math.abs(long) > 8) {
    const tip = from[0] + long, back = tip - 6 * Math.sign(long);
    line(pen, [from, [tip, from[1]]], colours.ink, 2);
    line(pen, [[back, from[1] - 4], [tip, from[1]], [back, from[1] + 4]], colours.ink, 2);
  }
  return undefined;
}

function drawBody(pen, turned) {
  for (const { shade, rings } of data.regions) {
    pen.beginPath();
    for (const ring of rings) {
      ring.forEach((corner, k) => (k ? pen.lineTo(...turned(corner)) : pen.moveTo(...turned(corner))));
      pen.closePath();
    }
    pen.globalAlpha = 0.35 + 0.65 * shade;
    pen.fillStyle = colours.body;
    pen.fill("evenodd");
    pen.globalAlpha = 1;
    pen.strokeStyle = colours.ink;
    pen.lineWidth = 1.5;
    pen.stroke();
  }
  if (data.points.length) {
    const centre = turned(data.centre);
    for (const foot of data.feet) line(pen, [turned([foot, 0]), centre], colours.soft, 1, [5, 4]);
    line(pen, data.feet.map((foot) => turned([foot, 0])), colours.ink, 2);
  }
  pen.fillStyle = colours.ink;
  for (const [x, y, mass] of data.points) {
    pen.beginPath();
    pen.arc(...turned([x, y]), 3 + 6 * Math.sqrt(mass), 0, 2 * Math.PI);
    pen.fill();
  }
  const [x, y] = turned(data.centre), colour = data.points.length ? colours.rotation : colours.ink;
  line(pen, [[x - 6, y], [x + 6, y]], colour, 1.5);
  line(pen, [[x, y - 6], [x, y + 6]], colour, 1.5);
}

function drawFlash(pen, project, moved) {
  // equal duration at any speed
  const lasts = Math.max(0.4 * speed(), 0.02);
  const recent = data.impacts.filter((impact) => impact[0] <= now && now < impact[0] + lasts);
  if (!recent.length) return;
  const [time, , , r, onto] = recent[recent.length - 1], age = (now - time) / lasts;
  const [x, y] = project(data.feet[onto > 0 ? 1 : 0] + moved, 0);
  pen.globalAlpha = 1 - 0.7 * age;
  pen.beginPath();
  pen.arc(x, y, 6 + 22 * age, Math.PI, 2 * Math.PI);
  pen.strokeStyle = pen.fillStyle = colours.impact;
  pen.lineWidth = 3;
  pen.stroke();
  pen.globalAlpha = 1;
  pen.font = "bold 14px system-ui, 'DejaVu Sans', sans-serif";
  const text = "r = " + r.toFixed(3), wide = pen.measureText(text).width;
  // next to the ring, on the other side near the edge of the picture
  const right = onto > 0 ? x + 34 + wide < pen.canvas.clientWidth : x - 34 - wide < 0;
  pen.textAlign = right ? "left" : "right";
  pen.fillText(text, right ? x + 34 : x - 34, y - 10);
  pen.textAlign = "left";
}

function drawCurve() {
  const canvas = element("curve"), [pen, w, h] = sized(canvas, canvas.clientHeight);
  const left = 60, right = w - 12, top = 12, bottom = h - 26, most = top + bottom;
  const falls = data.fall !== null;
  // end of the rotation axis: 2 alpha if the body overturns; alpha or the peak if the peak exceeds 0.2 alpha; otherwise the peak
  const biggest = Math.max(...data.alpha);
  const span = 1.12 * (falls ? 2 * biggest : Math.max(reach, reach > 0.2 * biggest || !reach ? biggest : 0));
  const x = (time) => left + ((right - left) * time) / data.end;
  const y = (theta) => most / 2 - ((bottom - top) / 2) * (theta / span);
  pen.fillStyle = colours.soft;
  line(pen, [[left, y(0)], [right, y(0)]], colours.line, 1);
  pen.textAlign = "right";
  pen.fillText("0\u00b0", left - 6, y(0) + 4);
  for (const alpha of [data.alpha[1], -data.alpha[0]]) {
    if (Math.abs(alpha) < span) {
      line(pen, [[left, y(alpha)], [right, y(alpha)]], colours.soft, 1, [6, 4]);
      pen.fillText(fixed(alpha * degrees, 1) + "\u00b0", left - 6, y(alpha) + 4);
    } else pen.fillText(fixed(Math.sign(alpha) * reach * degrees, 1) + "\u00b0", left - 6, y(Math.sign(alpha) * reach) + 4);
  }
  pen.save();
  pen.beginPath();
  pen.rect(left, 0, right - left, bottom + 4);
  pen.clip();
  if (falls) line(pen, [[x(data.fall), 0], [x(data.fall), bottom]], colours.fall, 1.5, [4, 3]);
  const points = [];
  for (let k = 0; k <= last; k++) points.push([x((data.end * k) / last), y(series.rotation[k])]);
  line(pen, points, colours.rotation, 1.8);
  pen.restore();
  if (falls) {
    pen.fillStyle = colours.fall;
    pen.fillText("no return", x(data.fall) - 6, data.overturnedTo > 0 ? bottom - 2 : top + 4);
  }
  pen.fillStyle = colours.impact;
  for (const [time] of data.impacts) {
    pen.beginPath();
    pen.arc(x(time), y(0), 2.6, 0, 2 * Math.PI);
    pen.fill();
  }
  pen.fillStyle = colours.soft;
  pen.fillText(data.end.toFixed(1) + " s", right, h - 8);
  pen.textAlign = "left";
  pen.fillText("0 s", left, h - 8);
  pen.textAlign = "center";
  const dashed = w >= 520 && Math.min(...data.alpha) < span ? ", slenderness angle (dashed)" : "";
  pen.fillText("rotation, impacts (dots)" + dashed, (left + right) / 2, h - 8);
  line(pen, [[x(now), 4], [x(now), bottom]], colours.ink, 1.5);
  pen.beginPath();
  pen.fillStyle = colours.ink;
  pen.arc(x(now), Math.min(Math.max(y(at("rotation", now)), 4), bottom), 4.5, 0, 2 * Math.PI);
  pen.fill();
  canvas.seek = (pixel) => ((pixel - left) / (right - left)) * data.end;
}
