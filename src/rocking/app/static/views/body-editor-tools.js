/** What draws on the board beside the vertices: its view, the pen, dimensions, arcs, mirrors, a photograph. */

import { iconButton, button, el, fill, freshId, number, numberField, tidy, toolbar } from "/views/body-parts.js";
import { slider } from "/app/fields.js";
import * as model from "/views/body-editor-model.js";
import { asHole, asOutline, asRegion } from "/views/body-paste.js";
import { boxOf } from "/drawing/viewport.js";

/** The tools: {pen, ends, edge, photo, told, follow}; the board asks `editor.tool` what a point or a key does. */
export const createTools = (editor, canvas) => {
  const told = el("p", { class: "field-help board-told", role: "status", "data-testid": "board-told" });
  const say = (words) => fill(told, words);
  const [pen, edge, photo] = [penPart(editor, canvas, say), edgePart(editor, say), photoPart(editor, canvas, say)];
  editor.tool = toolOf(editor, say, { pen: pen.close, scale: photo.measured });
  const follow = () => [pen, edge, photo].forEach((each) => each.follow());
  canvas.element.append(viewPart(canvas));
  return { pen: pen.buttons, ends: pen.ends, edge: edge.element, photo: photo.element, told, follow };
};

const viewPart = (canvas) => el("div", { class: "board-view" },
  iconButton({ sign: "+", label: "Zoom in", onClick: () => canvas.zoom(1.5) }),
  iconButton({ sign: "\u2212", label: "Zoom out", onClick: () => canvas.zoom(1 / 1.5) }),
  iconButton({ sign: "\u2922", label: "Show the whole body", onClick: canvas.fit }),
  ...[["\u2190", "Pan left", 80, 0], ["\u2192", "Pan right", -80, 0], ["\u2191", "Pan up", 0, 80], ["\u2193", "Pan down", 0, -80]]
    .map(([sign, label, dx, dy]) => iconButton({ sign, label, onClick: () => canvas.pan(dx, dy) })),
);

// What a point and a key do while a tool is held: the arrow keys move a cursor, Space sets a point where it stands.
const toolOf = (editor, say, done) => {
  const tell = () => {
    const { points, cursor } = editor.state.tool;
    say(`${points.length} points set${cursor ? `; the cursor stands at x ${number(cursor[0], 7)}, y ${number(cursor[1], 7)} ${editor.units()}` : ""}.`);
    editor.tell();
  };
  const leave = () => {
    editor.state.tool = null;
    say("");
    editor.tell();
  };
  const put = (point, reach = 0) => {
    const { tool } = editor.state;
    const first = tool.points[0];
    const closes = tool.kind === "pen" && tool.points.length > 2 && Math.hypot(point[0] - first[0], point[1] - first[1]) <= reach;
    if (closes) return done.pen();
    const last = tool.points.at(-1);
    if (last && last[0] === point[0] && last[1] === point[1]) return undefined;
    tool.points = [...(tool.kind === "scale" && tool.points.length === 2 ? [] : tool.points), point];
    tell();
    if (tool.kind === "scale" && tool.points.length === 2) done.scale();
    return undefined;
  };
  const key = (name, times, start) => {
    const { tool } = editor.state;
    const by = times * editor.step();
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[name];
    if (way) {
      const from = tool.cursor ?? editor.snapped(start());
      tool.cursor = from.map((value, axis) => tidy(value + by * way[axis], 9));
      tell();
    } else if (name === " ") put(tool.cursor ?? editor.snapped(start()).map((value) => tidy(value, 9)));
    else if (name === "Enter") done[tool.kind]();
    else if (name === "Backspace" || name === "Delete") {
      tool.points = tool.points.slice(0, -1);
      tell();
    } else if (name === "Escape") leave();
    else return false;
    return true;
  };
  return { put, key, leave };
};

const penPart = (editor, canvas, say) => {
  const take = (kind) => {
    if (editor.state.tool?.kind === kind) return editor.tool.leave();
    editor.state.tool = { kind, points: [], cursor: null };
    say("Click, or move the cursor with the arrow keys and press Space: one point after another. Enter, or a click on the first, closes the outline; Escape leaves.");
    canvas.focus();
    return editor.tell();
  };
  const close = (use = asOutline) => {
    const { points } = editor.state.tool;
    if (points.length < 3) return say("An outline needs three points.");
    editor.tool.leave();
    say(use(editor, points) ?? `${points.length} points added.`);
    return canvas.focus();
  };
  const pen = button({ text: "Pen", onClick: () => take("pen") });
  const ends = toolbar(
    button({ text: "Close as body", kind: "primary", onClick: () => close() }),
    button({ text: "Close as region", onClick: () => close(asRegion) }),
    button({ text: "Close as hole", onClick: () => close(asHole) }),
    button({ text: "Leave", onClick: () => editor.tool.leave() }),
  );
  const follow = () => {
    const held = editor.state.tool?.kind === "pen";
    pen.setAttribute("aria-pressed", String(held));
    ends.hidden = !held;
  };
  const mirror = button({
    text: "Mirror", onClick: () => {
      editor.replace(model.mirrored(editor.section(), editor.regions(), tidy));
      say("Left is right now.");
    },
  });
  return { buttons: [pen, mirror], ends, close, follow };
};

const edgePart = (editor, say) => {
  const fixed = () => {
    const { length } = model.edgeAt(editor.regions(), editor.state.place);
    if (length > 0) return true;
    say("Both ends of this edge are at one place.");
    return false;
  };
  const change = (key) => (value) => {
    const { length, angle } = model.edgeAt(editor.regions(), editor.state.place);
    editor.change(model.withEdge(editor.regions(), editor.state.place, { length, angle, [key]: value }, tidy));
  };
  const length = numberField({ label: "Edge length", above: 0, onChange: change("length"), help: "From the chosen vertex to the next, which moves." });
  const angle = numberField({ label: "Edge angle", unit: "°", onChange: change("angle"), help: "From the horizontal, counter-clockwise." });
  const rise = numberField({ label: "Rise of the arc", optional: true, help: "Out of the body; less than 0: into it." });
  const error = numberField({ label: "At most off the arc", above: 0, optional: true, help: "Empty: a hundredth of the rise." });
  const arc = () => {
    if (!fixed()) return undefined;
    if (rise.fault() || error.fault() || !rise.value) return say("How far does the arc rise? A number other than 0.");
    const made = model.withArc(editor.regions(), editor.state.place, rise.value, error.value ?? Math.abs(rise.value) / 100, tidy);
    if (!made) return say("That needs more than 1000 chords: let it be further off the arc.");
    editor.change(made.regions);
    return say(`An arc of ${made.chords} chords, at most ${number(made.error)} ${editor.units()} off.`);
  };
  const double = () => fixed() && editor.change(model.doubled(editor.regions(), editor.state.place, tidy));
  const title = el("summary", {}, "The edge after the chosen vertex");
  const follow = () => {
    if (!editor.regions().length) return;
    const now = model.edgeAt(editor.regions(), editor.state.place);
    if (document.activeElement !== length.input) length.value = tidy(now.length, 9);
    if (document.activeElement !== angle.input) angle.value = tidy(now.angle, 9);
  };
  return {
    element: el("details", { class: "paste", "data-testid": "edge" }, title, el("div", { class: "stack" },
      el("div", { class: "fields" }, length, angle, rise, error),
      toolbar(button({ text: "Make it an arc", onClick: arc }), button({ text: "Double over this edge", onClick: double })))),
    follow,
  };
};

// The photograph stays in this browser: it is drawn from the file itself, and nothing of it is sent or kept.
const photoPart = (editor, canvas, say) => {
  const id = freshId("photo");
  const file = el("input", { id, type: "file", accept: "image/*", "aria-describedby": `${id}-about` });
  const off = () => {
    if (editor.state.photo) URL.revokeObjectURL(editor.state.photo.url);
    editor.state.photo = null;
    file.value = "";
  };
  file.addEventListener("change", async () => {
    const [given] = file.files;
    if (!given) return;
    const url = URL.createObjectURL(given);
    const image = new Image();
    image.src = url;
    try {
      await image.decode();
    } catch {
      URL.revokeObjectURL(url);
      say("This file is no picture that the browser can show.");
      return;
    }
    if (editor.state.photo) URL.revokeObjectURL(editor.state.photo.url);
    const box = boxOf(editor.regions().flatMap((each) => each.outline));
    const [width, height] = [image.naturalWidth, image.naturalHeight];
    editor.state.photo = { url, width, height, x: box.left, y: box.bottom, scale: (box.top - box.bottom) / height, opacity: opacity.value };
    say("The picture is as high as the body. Give it a scale.");
    editor.tell();
  });
  const put = (key) => (value) => {
    editor.state.photo[key] = value;
    editor.tell();
  };
  const opacity = slider({ label: "Opacity", min: 0.1, max: 1, step: 0.05, value: 0.6, onInput: (value) => editor.state.photo && put("opacity")(value) });
  const places = ["x", "y"].map((axis) => numberField({ label: axis === "x" ? "Picture's left edge" : "Picture's lower edge", onChange: put(axis) }));
  const known = numberField({ label: "Length between the two points", above: 0, optional: true });
  const begin = () => {
    if (editor.state.tool?.kind === "scale") return editor.tool.leave();
    editor.state.tool = { kind: "scale", points: [], cursor: null };
    say("Set two points on the picture whose distance is known; arrow keys and Space do it too.");
    canvas.focus();
    return editor.tell();
  };
  const measured = () => {
    if (editor.state.tool.points.length < 2) return say("Two points are needed.");
    say("Now type how far apart they are, and apply it.");
    return known.input.focus();
  };
  // The first point stays where it is.
  const apply = () => {
    const [from, to] = editor.state.tool?.points ?? [];
    if (!to) return say("Two points are needed.");
    if (known.fault() || !known.value) return say("How far apart are they? A number above 0.");
    const factor = known.value / Math.hypot(to[0] - from[0], to[1] - from[1]);
    const { photo } = editor.state;
    Object.assign(photo, {
      scale: photo.scale * factor, x: from[0] + (photo.x - from[0]) * factor, y: from[1] + (photo.y - from[1]) * factor,
    });
    editor.tool.leave();
    return say(`The picture is ${number(photo.scale * photo.width)} by ${number(photo.scale * photo.height)} ${editor.units()} now.`);
  };
  const set = button({ text: "Set two points", onClick: begin });
  const needs = el("div", { class: "stack" }, el("div", { class: "fields" }, opacity, ...places, known), toolbar(
    set, button({ text: "Apply the length", kind: "primary", onClick: apply }),
    button({ text: "Take the picture away", onClick: () => {
      off();
      if (editor.state.tool?.kind === "scale") editor.tool.leave();
      else editor.tell();
    } })));
  const follow = () => {
    const { photo, tool } = editor.state;
    needs.hidden = !photo;
    set.setAttribute("aria-pressed", String(tool?.kind === "scale"));
    if (photo) places.forEach((field, index) => document.activeElement !== field.input && (field.value = tidy(photo["xy"[index]], 6)));
  };
  return {
    element: el("details", { class: "paste", "data-testid": "photo" },
      el("summary", {}, "Trace a photograph"),
      el("div", { class: "stack" },
        el("div", { class: "field" }, el("label", { for: id }, "Picture"), file,
          el("p", { id: `${id}-about`, class: "field-help" }, "It stays in this browser: nothing of it is sent or kept.")),
        needs)),
    measured, follow,
  };
};
