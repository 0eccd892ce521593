/** What draws on the board beside the vertices: the pen, dimensions, arcs, mirrors, a photograph. */

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
  pen: "Click, or move the cursor with the arrow keys and press Space: one point after another. Enter, or a click on the first, closes the outline; Escape leaves.",
  scale: "Set two points on the picture whose distance is known; arrow keys and Space do it too.",
};

/** What a point and a key do while a tool is held: the arrow keys move a cursor, Space sets a point where it stands.
 * @param {Editor} editor */
export const createTool = (editor) => {
  const held = () => /** @type {NonNullable<Editor["state"]["tool"]>} */ (editor.state.tool);
  /** @param {string} words */
  const say = (words) => (editor.told.value = words);
  const tell = () => {
    const { points, cursor } = held();
    const count = points.length;
    say(cursor ? t("{count} points set; the cursor stands at x {x}, y {y} {unit}.", { count, x: number(cursor[0], 7), y: number(cursor[1], 7), unit: editor.units() })
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
    if (points.length < 3) return say("An outline needs three points.");
    leave();
    say(use(editor, points) ?? t("{count} points added.", { count: points.length }));
    return editor.board.focus();
  };
  const measured = () => {
    if (held().points.length < 2) return say("Two points are needed.");
    say("Now type how far apart they are, and apply it.");
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
    editor.tool.say("Left is right now.");
  };
  return html`
    <${Button} aria-pressed=${String(editor.state.tool?.kind === "pen")} onClick=${() => editor.tool.take("pen")}>Pen<//>
    <${Button} onClick=${mirror}>Mirror<//>`;
};

/** What becomes of the points of the pen. @param {{ editor: Editor }} props */
export const PenEnds = ({ editor: { state, tool } }) => html`
  <div class="toolbar" hidden=${state.tool?.kind !== "pen"}>
    <${Button} kind="primary" onClick=${() => tool.close()}>Close as body<//>
    <${Button} onClick=${() => tool.close(asRegion)}>Close as region<//>
    <${Button} onClick=${() => tool.close(asHole)}>Close as hole<//>
    <${Button} onClick=${tool.leave}>Leave<//></div>`;

/** The edge after the chosen vertex: its dimensions, as an arc, as a mirror. @param {{ editor: Editor }} props */
export const EdgePart = ({ editor }) => {
  const box = useRef(null);
  const [rise, off, wrong] = [null, null, ""].map(useSignal);
  const { place } = editor.state;
  const { length, angle } = model.edgeAt(editor.regions(), place);
  /** @param {string} key */
  const change = (key) => (/** @type {number} */ value) => {
    const now = model.edgeAt(editor.regions(), place);
    editor.change(model.withEdge(editor.regions(), place, { ...now, [key]: value }, tidy));
  };
  const fixed = () => {
    if (length === 0) editor.tool.say("Both ends of this edge are at one place.");
    return length > 0;
  };
  const arc = () => {
    if (!fixed()) return undefined;
    if (!rise.value) wrong.value = "How far does the arc rise? A number other than 0.";
    if (!rise.value || wrongIn(box.current)) return toWrong(box.current);
    const made = model.withArc(editor.regions(), place, rise.value, off.value ?? Math.abs(rise.value) / 100, tidy);
    if (!made) return editor.tool.say("That needs more than 1000 chords: let it be further off the arc.");
    editor.change(made.regions);
    return editor.tool.say(t("An arc of {count} chords, at most {length} {unit} off.", { count: made.chords, length: number(made.error), unit: editor.units() }));
  };
  /** @param {number | null} value */
  const rises = (value) => {
    rise.value = value;
    wrong.value = "";
  };
  const of = Object.values(place).join();
  return html`
    <details class="paste" data-testid="edge"><summary>The edge after the chosen vertex</summary><div class="stack">
      <div class="fields">
        <${NumberField} key=${`length ${of}`} label="Edge length" value=${tidy(length, 9)} on=${change("length")} above=${0}
          help="From the chosen vertex to the next, which moves." />
        <${NumberField} key=${`angle ${of}`} label="Edge angle" unit="°" value=${tidy(angle, 9)} on=${change("angle")}
          help="From the horizontal, counter-clockwise." /></div>
      <div ref=${box} class="fields">
        <${NumberField} label="Rise of the arc" value=${rise.value} on=${rises} error=${wrong.value} optional aside
          help="Out of the body; less than 0: into it." />
        <${NumberField} label="At most off the arc" value=${off} above=${0} optional aside help="Empty: a hundredth of the rise." /></div>
      <div class="toolbar"><${Button} onClick=${arc}>Make it an arc<//>
        <${Button} onClick=${() => fixed() && editor.change(model.doubled(editor.regions(), place, tidy))}>Double over this edge<//></div>
    </div></details>`;
};

/** A photograph to draw on. It stays in this browser: it is drawn from the file itself, and nothing of it is sent or kept.
 * @param {{ editor: Editor }} props */
export const PhotoPart = ({ editor }) => {
  const { state: { photo, tool }, tool: { say } } = editor;
  const [box, opacity, known, wrong] = [useRef(null), useSignal(0.6), useSignal(null), useSignal("")];
  /** @param {any} next */
  const show = (next) => {
    if (editor.state.photo) URL.revokeObjectURL(editor.state.photo.url);
    editor.state.photo = next;
    editor.tell();
  };
  /** @param {any} event */
  const load = async ({ target: { files: [given] } }) => {
    if (!given) return;
    const [url, image] = [URL.createObjectURL(given), new Image()];
    image.src = url;
    try {
      await image.decode();
    } catch {
      URL.revokeObjectURL(url);
      say("This file is no picture that the browser can show.");
      return;
    }
    const around = boxOf(editor.regions().flatMap((/** @type {Region} */ each) => each.outline));
    const [width, height] = [image.naturalWidth, image.naturalHeight];
    say("The picture is as high as the body. Give it a scale.");
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
    known.value = value;
    wrong.value = "";
  };
  // The first point stays where it is.
  const apply = () => {
    const [from, to] = tool?.points ?? [];
    if (!to) return say("Two points are needed.");
    if (!known.value) wrong.value = "How far apart are they? A number above 0.";
    if (!known.value || wrongIn(box.current)) return toWrong(box.current);
    const factor = known.value / Math.hypot(to[0] - from[0], to[1] - from[1]);
    Object.assign(photo, {
      scale: photo.scale * factor, x: from[0] + (photo.x - from[0]) * factor, y: from[1] + (photo.y - from[1]) * factor,
    });
    editor.tool.leave();
    return say(t("The picture is {width} by {height} {unit} now.", { width: number(photo.scale * photo.width), height: number(photo.scale * photo.height), unit: editor.units() }));
  };
  const away = () => {
    box.current.querySelector("[type=file]").value = "";
    show(null);
    if (tool?.kind === "scale") editor.tool.leave();
  };
  return html`
    <details ref=${box} class="paste" data-testid="photo"><summary>Trace a photograph</summary><div class="stack">
      <${Frame} id="photograph" label="Picture" help="It stays in this browser: nothing of it is sent or kept.">
        <input id="photograph" type="file" accept="image/*" aria-describedby="photograph-about" onChange=${load} /><//>
      ${photo && html`<div class="stack">
        <div class="fields">
          <${Slider} label="Opacity" value=${opacity.value} on=${fade} min=${0.1} max=${1} step=${0.05} />
          <${NumberField} label="Picture's left edge" value=${tidy(photo.x, 9)} on=${put("x")} aside />
          <${NumberField} label="Picture's lower edge" value=${tidy(photo.y, 9)} on=${put("y")} aside />
          <${NumberField} label="Length between the two points" name="known-length" value=${known.value} on=${measure} error=${wrong.value}
            above=${0} optional aside /></div>
        <div class="toolbar">
          <${Button} aria-pressed=${String(tool?.kind === "scale")} onClick=${() => editor.tool.take("scale")}>Set two points<//>
          <${Button} kind="primary" onClick=${apply}>Apply the length<//>
          <${Button} onClick=${away}>Take the picture away<//></div></div>`}
    </div></details>`;
};
