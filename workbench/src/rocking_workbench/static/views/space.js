/** 3D: a scan, its repairs, its stable poses, the restitution of its edges, and its response. */

import { html, render, useRef, useSignal } from "/parts/preact.js";
import { number, parseNumber } from "/app/format.js";
import { createQuestions, motionOf } from "/questions/asking.js";
import { Button, Choice, Field, sentence } from "/parts/fields.js";
import { Drawing, FileDrop, QuestionView, recordEndings, useForm } from "/questions/parts.js";
import { Edges } from "/space/edges.js";
import { MotionScene } from "/space/motion.js";
import { Standing } from "/space/standing.js";
import { t, userText } from "/app/words.js";

const SCANS = ".stl,.obj,.ply,.glb,.xyz,.toml";
const ASKED = [["equilibria", "stable poses"], ["restitution", "coefficient of restitution by edge"], ["simulate", "response to a motion"]];
/** @type {{ [command: string]: string }} */
const TITLES = { equilibria: "Stable poses: {name}", restitution: "Edges: {name}", simulate: "Response: {name}" };
const UNITS = [["", "as in the file"], ["mm", "mm"], ["cm", "cm"], ["m", "m"], ["in", "in"], ["ft", "ft"]];
const UP = [["", "default (z; GLB: y)"], ["z", "z"], ["y", "y"], ["x", "x"], ["-z", "z, upside down"]];
/** @type {{ [axis: string]: number[] | undefined }} */
const AXES = { x: [1, 0, 0], "-z": [0, 0, -1] };
const REPAIRS = [["", "safe repairs"], ["none", "none (\"none\"): open meshes are refused"], ["all", "all repairs (\"all\")"]];
const SURFACES = [["", "faces of the mesh"], ["wrap", "skin over the points (\"wrap\")"], ["hull", "convex hull of the points (\"hull\")"]];
const INNER = [["", "refused (\"refuse\")"], ["solid", "solid (\"solid\")"], ["cavity", "cavities (\"cavity\")"]];
const SHAKEN = [["x", "the motion of this project, along x"], ["y", "the motion of this project, along y"], ["records", "records along x, y and z"]];
const LAWS = [
  ["calibrated-3d", "calibrated model (calibrated-3d)"], ["ked-3d", "kinetic energy distribution (ked-3d)"],
  ["housner-3d", "Housner's (housner-3d)"], ["", "a coefficient"],
];

const OWN = "project"; // chosen in place of a scan
const FIRST = {
  files: [], chosen: "", analysis: "equilibria", units: "", up: "", repair: "", surface: "", inner: "", density: "", pose: null,
  shaken: "x", friction: "0.4", law: "calibrated-3d", coefficient: "0.8", times: "1", recordUnits: "", along_x: [], along_y: [], along_z: [],
};
const BODY = ["files", "chosen", "analysis", "units", "up", "repair", "surface", "inner", "density"];
const MOVES = ["shaken", "friction", "law", "coefficient", "times", "recordUnits"];

/** Scan of the analysis: the selected one, or the last; none if the body of the project is used.
 * @param {any} form @returns {SentFile | undefined} */
const scanOf = ({ files, chosen }) => (chosen === OWN ? undefined : files.find((/** @type {SentFile} */ { sha }) => sha === chosen) ?? files.at(-1));

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, ...Object.keys(TITLES));
  render(html`<${Space} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

/** @param {{ app: App, questions: Questions }} props */
const Space = ({ app, questions }) => {
  const form = useForm(app, "space", FIRST);
  const [files, chosen, command, units, up, repair, surface, inner, density] = BODY.map((name) => form.at(name));
  const [shaken, friction, law, coefficient, times, recordUnits] = MOVES.map((name) => form.at(name));
  const records = Object.fromEntries(["x", "y", "z"].map((axis) => [axis, form.at(`along_${axis}`)]));
  const pose = form.at("pose"); // {number, up}: upward direction in the pose, in the axes of the file
  /** @type {Signal<Wrong>} */
  const wrong = useSignal("");
  const scan = scanOf(form.value);
  /** @param {string} sha */
  const choose = (sha) => {
    chosen.value = sha;
    pose.value = null; // the pose belongs to the previous scan
  };
  const scans = {
    get value() { return files.value; },
    set value(next) {
      const added = next.filter((/** @type {SentFile} */ { sha }) => files.value.every((/** @type {SentFile} */ file) => file.sha !== sha));
      files.value = next;
      if (added.length) choose(added.at(-1).sha);
    },
  };
  /** @param {Event} event */
  const ask = (event) => {
    event.preventDefault();
    const inputs = app.inputs.get();
    const body = chosen.value === OWN ? { table: inputs.body, missing: app.faults.sentence({ inputs: true }) } : bodyOf(scan, {
      units: units.value, up: pose.value?.up ?? AXES[up.value] ?? up.value, repair: repair.value, surface: surface.value,
      inner_parts: inner.value, density: density.value.trim(),
    });
    const moves = command.value === "simulate";
    const motion = moves ? shakenBy(app, shaken.value, records, recordUnits.value.trim(), times.value) : { tables: {}, files: {} };
    const held = parseNumber(friction.value) ?? NaN;
    const kept = parseNumber(coefficient.value) ?? NaN;
    wrong.value = body.missing || (moves && !(held > 0) && { key: "friction", text: "Enter a friction above 0." })
      || (moves && !law.value && !(kept >= 0 && kept <= 1) && { key: "value", text: "Enter a coefficient from 0 to 1." }) || motion.missing || "";
    if (wrong.value) return;
    const name = scan?.name ?? (inputs.body.name || app.project.here.value.name);
    const tables = {
      body: body.table, ...motion.tables,
      ...(moves || held > 0 ? { response: { friction: held } } : {}),
      ...(moves ? { restitution: law.value ? { model: law.value } : { value: kept } } : {}),
      ...(inputs.settings ? { settings: inputs.settings } : {}),
    };
    const sent = scan ? { [scan.name]: scan.sha } : {};
    questions.ask(tables, { ...sent, ...motion.files }, t(TITLES[command.value], { name: userText(name) }), { command: command.value });
  };
  /** @param {number} number_ @param {number[]} direction */
  const goOn = (number_, direction) => {
    pose.value = { number: number_, up: direction };
    app.say(t("The next run uses the body in pose {pose}.", { pose: number_ }));
  };
  // The component is created once. A new component would redraw the scene at every typed character.
  const Found = useRef((/** @type {any} */ { answer, question }) => html`
    <${Answer} key=${question.id} answer=${answer} question=${question} onPose=${goOn} />`).current;
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Found}
      title="3D"
      lead="Analysis of a scanned body in 3D: mesh repairs, stable poses, and response with rocking, sliding and overturning.">
      <${FileDrop} label="Drop a scan here, or" adds accept=${SCANS} files=${scans} questions=${questions} app=${app}
        help="STL, OBJ, PLY or GLB, points alone (PLY, XYZ), or a body file (TOML); up to 32 MiB." />
      <${Choice} label="Body" value=${chosen.value} on=${choose} chosen=${scan?.sha ?? chosen.value} options=${[
        ...(files.value.length ? files.value.map((/** @type {SentFile} */ { name, sha }) => [sha, name]) : [["", "a scan"]]), [OWN, "the body of this project"]]} />
      ${chosen.value === OWN ? html`<p class="field-help">Block or section, extruded over its depth.</p>` : html`
      <${Choice} label="Unit of the file" name="units" value=${units} options=${UNITS} help="STL, OBJ and PLY files contain no unit." />
      ${pose.value ? html`<p class="space-pose">${t("Pose {pose} of the last result.", { pose: pose.value.number })}
          <${Button} kind="quiet" onClick=${() => (pose.value = null)}>As in the file<//></p>`
        : html`<${Choice} label="Up" value=${up} options=${UP} help="The body settles from this orientation." />`}
      <${Field} label="Density" name="density" unit="kg/m\u00b3" value=${density} inputmode="decimal" help="Empty: concrete." />
      <details><summary>Mesh repairs</summary>
        <${Choice} label="Repairs" value=${repair} options=${REPAIRS} help="Safe: at most 1 % of the volume, and a shift of the centre of mass of 0.5 % of the size." />
        <${Choice} label="Surface" value=${surface} options=${SURFACES} />
        <${Choice} label="Inner closed parts" value=${inner} options=${INNER} help="Inner parts with the same winding as the outer part." />
      </details>`}
      <${Choice} label="Analysis" value=${command} options=${ASKED} />
      ${command.value === "simulate" && html`
        <${Choice} label="Ground motions" value=${shaken} options=${SHAKEN} />
        ${shaken.value === "records" && html`
          ${Object.entries(records).map(([axis, sent]) => html`<${FileDrop} key=${axis} name=${axis} label=${t("A record along {axis}, or", { axis })}
            accept=${recordEndings(app)} files=${sent} questions=${questions} app=${app} help=${axis === "z" ? "Positive upward." : ""} />`)}
          <${Field} label="Unit of the accelerations" name="record units" value=${recordUnits} help="Only for files without a unit: g, m/s2, cm/s2." />`}
        <${Field} label="Scale factor" name="times" value=${times} inputmode="decimal" />
        <${Field} label="Friction" name="friction" value=${friction} inputmode="decimal" help="Friction coefficient. The body can slide, lift off and overturn." />
        <${Choice} label="Impacts" value=${law} options=${LAWS} />
        ${!law.value && html`<${Field} label="Coefficient of restitution" name="value" value=${coefficient} inputmode="decimal" help="From 0 to 1." />`}`}
    <//>`;
};

/** Table of the body, with given values only; missing: required values.
 * @param {SentFile | undefined} scan @param {{ units: string, density: string, [key: string]: any }} options @returns {{ table?: any, missing?: Wrong }} */
const bodyOf = (scan, options) => {
  if (!scan) return { missing: { key: "files", text: "Add a scan." } };
  const kind = scan.name.replace(/^.*\./s, "").toLowerCase();
  if (!options.units && !["glb", "toml"].includes(kind)) return { missing: { key: "units", text: t("{format} files contain no unit. Choose the unit.", { format: kind.toUpperCase() }) } };
  const density = options.density ? parseNumber(options.density) : null;
  if (options.density && !(Number(density) > 0)) return { missing: { key: "density", text: "Enter a density above 0." } };
  const stated = Object.entries({ ...options, density }).filter(([, value]) => value !== null && value !== "");
  return { table: { file: scan.name, ...Object.fromEntries(stated) } };
};

/** Ground motion along the axes, its files, and missing inputs.
 * @param {App} app @param {string} shaken @param {{ [axis: string]: { value: SentFile[] } }} records @param {string} units @param {string} times @returns {Shaking} */
const shakenBy = (app, shaken, records, units, times) => {
  const scale = parseNumber(times);
  if (scale === null || scale === 0) return { missing: { key: "times", text: "Enter a scale factor other than 0." } };
  if (shaken !== "records") {
    const motion = motionOf(app.inputs.get());
    const missing = app.faults.sentence({ inputs: true }) || (motion ? "" : "This project has no motion. Choose a motion, or add records.");
    if (missing || !motion) return { missing };
    return { tables: { motion: { [shaken]: motion.tables.motion, scale } }, files: motion.files };
  }
  const sent = Object.entries(records).filter(([, signal]) => signal.value.length)
    .map(/** @returns {[string, SentFile]} */ ([axis, signal]) => [axis, signal.value[0]]);
  const along = Object.fromEntries(sent.map(([axis, file]) => [axis, { record: file.name, ...(units ? { units } : {}) }]));
  return {
    tables: { motion: { ...along, scale } }, files: Object.fromEntries(sent.map(([, file]) => [file.name, file.sha])),
    missing: sent.length ? "" : { key: "x", text: "Add a record." },
  };
};

/** @param {Given & { onPose: (pose: number, up: number[]) => unknown }} given */
const Answer = ({ answer, question, onPose }) => {
  const scan = html`<${Taken} body=${answer.body} repairs=${answer.body.repairs} own=${!/^file = /m.test(question.toml)} />`;
  if (question.command === "equilibria") return html`<${Standing} question=${question} answer=${answer} onPose=${onPose}>${scan}<//>`;
  if (question.command === "restitution") return html`<${Edges} question=${question} answer=${answer}>${scan}<//>`;
  return html`
    <p class=${`verdict ${answer.outcome === "overturned" ? "bad" : "good"}`} data-testid="verdict">${sentence(answer.summary)}</p>
    <${MotionScene} question=${question} answer=${answer} />
    <p>${t("Largest tilt {tilt}\u00b0, impacts: {impacts}, largest sliding distance {distance} mm.", { tilt: number((answer.peak_tilt * 180) / Math.PI, 4), impacts: answer.impacts.length, distance: number(1000 * answer.sliding_distance, 3) })}</p>
    <${Drawing} question=${question} alt="Tilt, direction and energy over time" />
    ${scan}`;
};

/** @param {{ body: any, repairs: string[], own: boolean }} props */
const Taken = ({ body, repairs, own }) => {
  const size = body.size.map((/** @type {number} */ length) => number(1000 * length, 4)).join(" \u00d7 ");
  return html`
  <h3>${own ? "The body" : "The scan"}</h3>
  <p>${t("{size} mm, {mass} kg, centre of mass {height} mm above the ground.", { size, mass: number(body.mass, 4), height: number(1000 * body.centre_height, 4) })}</p>
  <ul class="space-repairs" aria-label="Repairs">
    ${repairs.length ? repairs.map((repair) => html`<li key=${repair}>${sentence(repair)}</li>`) : html`<li>No repairs were needed.</li>`}
    ${[...body.assumed, ...body.warnings].map((/** @type {string} */ note) => html`<li key=${note}>${sentence(note)}</li>`)}
  </ul>`;
};
