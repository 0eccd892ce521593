/** Drawing tools: pen, dimensions, arcs, mirror, photograph. */

import { html, useRef, useSignal } from "/parts/preact.js";
import { number, tidy } from "/app/format.js";
import { boxOf } from "/drawing/viewport.js";
import { Button, Frame, NumberField, Slider, toWrong, wrongIn } from "/parts/fields.js";
import * as model from "/views/body-editor-model.js";
import { asHole, asOutline, asRegion } from "/views/body-paste.js";
import { t } from "/app/words.js";

/** @type {{ [key: string]: number[] | undefined }} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const HOW = {
  pen: "Click to set a point, or move the cursor with the arrow keys and press Space. Enter or a click on the first point closes the outline. Escape cancels.",
  scale: "Set two points with a known distance on the picture. Click, or use the arrow keys and Space.",
};

/** Pointer and keys of a tool: the arrow keys move a cursor, Space sets a point at the cursor.
 * @param {Editor} editor */
export const createTool = (editor) => {
  const held = () => /** @type {NonNullable<Editor["state"]["tool"]>} */ (editor.state.tool);
  /** @param {string} text */
  const say = (text) => (editor.status.value = text);
  const tell = () => {
    const { points, cursor } = held();
    const count = points.length;
    say(cursor ? t("{count} points set; cursor at x {x}, y {y} {unit}.", { count, x: number(cursor[0], 7), y: number(cursor[1], 7), unit: editor.units() })
      : t("{count} points set.", { count }));
    editor.tell();
  };
  const leave = () => {
    editor.state.tool = null;
    say("");
    editor.tell();
  };
  /** @param {"pen" | "scale"} kind */
  const take = (kind) => {
    if (editor.state.tool?.kind === kind) return leave();
    editor.state.tool = { kind, points: [], cursor: null };
    say(HOW[kind]);
    editor.board.focus();
    return editor.tell();
  };
  /** @param {(editor: Editor, points: Ring) => string | void} [use] */
  const close = (use = asOutline) => {
    const { points } = held();
    if (points.length < 3) return say("An outline needs at least three points.");
    leave();
    say(use(editor, points) ?? t("{count} points added.", { count: points.length }));
    return editor.board.focus();
  };
  const measured = () => {
    if (held().points.length < 2) return say("Set two points first.");
    say("Enter the distance of the points, then apply the length.");
    return /** @type {HTMLElement | null} */ (document.querySelector("[name=known-length]"))?.focus();
  };
  /** @type {{ [kind: string]: () => unknown }} */
  const done = { pen: close, scale: measured };
  /** @param {number[]} point @param {number} [reach] */
  const put = (point, reach = 0) => {
    const tool = held();
    const first = tool.points[0];
    const closes = tool.kind === "pen" && tool.points.length > 2 && Math.hypot(point[0] - first[0], point[1] - first[1]) <= reach;
    if (closes) return close();
    const last = tool.points.at(-1);
    if (last && last[0] === point[0] && last[1] === point[1]) return undefined;
    tool.points = [...(tool.kind === "scale" && tool.points.length === 2 ? [] : tool.points), /** @type {Point} */ (point)];
    tell();
    return tool.kind === "scale" && tool.points.length === 2 ? measured() : undefined;
  };
  /** @param {string} name @param {number} times @param {() => number[]} start */
  const key = (name, times, start) => {
    const tool = held();
    const by = times * editor.step();
    const way = WAYS[name];
    if (way) {
      const from = tool.cursor ?? editor.snapped(start());
      tool.cursor = from.map((/** @type {number} */ value, /** @type {number} */ axis) => tidy(value + by * way[axis], 9));
      tell();
    } else if (name === " ") put(tool.cursor ?? editor.snapped(start()).map((/** @type {number} */ value) => tidy(value, 9)));
    else if (name === "Enter") done[tool.kind]();
    else if (name === "Backspace" || name === "Delete") {
      tool.points = tool.points.slice(0, -1);
      tell();
    } else if (name === "Escape") leave();
    else return false;
    return true;
  };
  return { put, key, leave, take, close, say };
};

/** The pen, and the mirror. @param {{ editor: Editor }} props */
export const Pen = ({ editor }) => {
  const mirror = () => {
    editor.replace(model.mirrored(editor.section(), editor.regions(), tidy));
    editor.tool.say("Body mirrored.");
  };
  return html`
    <${Button} aria-pressed=${String(editor.state.tool?.kind === "pen")} onClick=${() => editor.tool.take("pen")}>Pen<//>
    <${Button} onClick=${mirror}>Mirror<//>`;
};

/** Use of the points of the pen. @param {{ editor: Editor }} props */
export const PenEnds = ({ editor: { state, tool } }) => html`
  <div class="toolbar" hidden=${state.tool?.kind !== "pen"}>
    <${Button} kind="primary" onClick=${() => tool.close()}>Close as body<//>
    <${Button} onClick=${() => tool.close(asRegion)}>Close as region<//>
    <${Button} onClick=${() => tool.close(asHole)}>Close as hole<//>
    <${Button} onClick=${tool.leave}>Cancel<//></div>`;

/** The edge after the chosen vertex: its dimensions, as an arc, as a mirror. @param {{ editor: Editor }} props */
export const EdgePart = ({ editor }) => {
  const box = useRef(null);
  const [rise, off, wrong] = [null, null, ""].map(useSignal);
  const { selected: position } = editor.state;
  const { length, angle } = model.edgeAt(editor.regions(), position);
  /** @param {string} key */
  const change = (key) => (/** @type {number} */ value) => {
    const now = model.edgeAt(editor.regions(), position);
    editor.change(model.withEdge(editor.regions(), position, { ...now, [key]: value }, tidy));
  };
  const fixed = () => {
    if (length === 0) editor.tool.say("This edge has length 0.");
    return length > 0;
  };
  const arc = () => {
    if (!fixed()) return undefined;
    if (!rise.value) wrong.value = "Enter a rise other than 0.";
    if (!rise.value || wrongIn(box.current)) return toWrong(box.current);
    const arcResult = model.withArc(editor.regions(), position, rise.value, off.value ?? Math.abs(rise.value) / 100, tidy);
    if (!arcResult) return editor.tool.say("This arc needs more than 1000 chords. Allow a larger deviation.");
    editor.change(arcResult.regions);
    return editor.tool.say(t("Arc of {count} chords, largest deviation {length} {unit}.", { count: arcResult.chords, length: number(arcResult.error), unit: editor.units() }));
  };
  /** @param {number | null} value */
  const rises = (value) => {
    rise.value = value;
    wrong.value = "";
  };
  const of = Object.values(position).join();
  return html`
    <details class="paste" data-testid="edge"><summary>Edge after the selected vertex</summary><div class="stack">
      <div class="fields">
        <${NumberField} key=${`length ${of}`} label="Edge length" value=${tidy(length, 9)} on=${change("length")} above=${0}
          help="From the selected vertex to the next vertex, which moves." />
        <${NumberField} key=${`angle ${of}`} label="Edge angle" unit="°" value=${tidy(angle, 9)} on=${change("angle")}
          help="From the horizontal, counter-clockwise." /></div>
      <div ref=${box} class="fields">
        <${NumberField} label="Rise of the arc" value=${rise.value} on=${rises} error=${wrong.value} optional aside
          help="Positive: out of the body. Negative: into the body." />
        <${NumberField} label="Largest deviation from the arc" value=${off} above=${0} optional aside help="Empty: 1/100 of the rise." /></div>
      <div class="toolbar"><${Button} onClick=${arc}>Replace by an arc<//>
        <${Button} onClick=${() => fixed() && editor.change(model.doubled(editor.regions(), position, tidy))}>Complete by symmetry<//></div>
    </div></details>`;
};

/** Photograph as background. It remains in this browser: it is neither sent nor stored.
 * @param {{ editor: Editor }} props */
export const PhotoPart = ({ editor }) => {
  const { state: { photo, tool }, tool: { say } } = editor;
  const [box, opacity, knownLength, wrong] = [useRef(null), useSignal(0.6), useSignal(null), useSignal("")];
  /** @param {any} next */
  const show = (next) => {
    if (editor.state.photo) URL.revokeObjectURL(editor.state.photo.url);
    editor.state.photo = next;
    editor.tell();
  };
  /** @param {any} event */
  const load = async ({ target: { files: [file] } }) => {
    if (!file) return;
    const [url, image] = [URL.createObjectURL(file), new Image()];
    image.src = url;
    try {
      await image.decode();
    } catch {
      URL.revokeObjectURL(url);
      say("The browser cannot show this file as a picture.");
      return;
    }
    const around = boxOf(editor.regions().flatMap((/** @type {Region} */ region) => region.outline));
    const [width, height] = [image.naturalWidth, image.naturalHeight];
    say("The picture has the height of the body. Set its scale.");
    show({ url, width, height, x: around.left, y: around.bottom, scale: (around.top - around.bottom) / height, opacity: opacity.value });
  };
  /** @param {string} key */
  const put = (key) => (/** @type {number} */ value) => {
    Object.assign(photo, { [key]: value });
    editor.tell();
  };
  /** @param {number} value */
  const fade = (value) => {
    opacity.value = value;
    put("opacity")(value);
  };
  /** @param {number} value */
  const measure = (value) => {
    knownLength.value = value;
    wrong.value = "";
  };
  // The first point stays where it is.
  const apply = () => {
    const [from, to] = tool?.points ?? [];
    if (!to) return say("Set two points first.");
    if (!knownLength.value) wrong.value = "Enter a distance above 0.";
    if (!knownLength.value || wrongIn(box.current)) return toWrong(box.current);
    const factor = knownLength.value / Math.hypot(to[0] - from[0], to[1] - from[1]);
    Object.assign(photo, {
      scale: photo.scale * factor, x: from[0] + (photo.x - from[0]) * factor, y: from[1] + (photo.y - from[1]) * factor,
    });
    editor.tool.leave();
    return say(t("The picture is now {width} by {height} {unit}.", { width: number(photo.scale * photo.width), height: number(photo.scale * photo.height), unit: editor.units() }));
  };
  const away = () => {
    box.current.querySelector("[type=file]").value = "";
    show(null);
    if (tool?.kind === "scale") editor.tool.leave();
  };
  return html`
    <details ref=${box} class="paste" data-testid="photo"><summary>Trace a photograph</summary><div class="stack">
      <${Frame} id="photograph" label="Picture" help="The picture stays in this browser. It is neither sent nor stored.">
        <input id="photograph" type="file" accept="image/*" aria-describedby="photograph-about" onChange=${load} /><//>
      ${photo && html`<div class="stack">
        <div class="fields">
          <${Slider} label="Opacity" value=${opacity.value} on=${fade} min=${0.1} max=${1} step=${0.05} />
          <${NumberField} label="Picture's left edge" value=${tidy(photo.x, 9)} on=${put("x")} aside />
          <${NumberField} label="Picture's lower edge" value=${tidy(photo.y, 9)} on=${put("y")} aside />
          <${NumberField} label="Length between the two points" name="known-length" value=${knownLength.value} on=${measure} error=${wrong.value}
            above=${0} optional aside /></div>
        <div class="toolbar">
          <${Button} aria-pressed=${String(tool?.kind === "scale")} onClick=${() => editor.tool.take("scale")}>Set two points<//>
          <${Button} kind="primary" onClick=${apply}>Apply the length<//>
          <${Button} onClick=${away}>Remove the picture<//></div></div>`}
    </div></details>`;
};
