/** The history of one cell of a map. */
import { batch, html, signal } from "/parts/preact.js";
import { Figure } from "/charts/figure.js";
import { Button, stopped } from "/parts/fields.js";
import { t, userText } from "/app/words.js";

/** Beyond this fraction of alpha the body has fallen, and the rest of its curve would be invisible. */
const MOST = 2;
const KEYS = ["body", "motion", "restitution", "response", "settings"];
const SHAPE = {
  title: "Rotation",
  x: { label: "time", unit: "s" },
  y: { label: "rotation / \u03b1", unit: "" },
  height: 200,
  series: [{ label: "rotation / \u03b1", colour: "--accent" }],
};

/** Data of a cell: show(aim, k, kept) requests them, open() loads a kept cell into the step Response.
 * @param {App} app @param {Server.StudyFacts} study */
export const createCell = (app, study) => {
  const summary = signal("Click a cell of the map.");
  const data = signal(null); // of the last visible curve
  const curve = signal(false);
  const opens = signal(false);
  /** @type {any} */
  let inputs = null;
  let busy = false;
  /** @type {{ aim: Cell, k: number, kept: boolean } | null} */
  let next = null;

  const open = () => {
    if (!opens.value) return;
    // missing keys of the cell must be absent, not null
    const there = KEYS.filter((key) => inputs[key] !== undefined && inputs[key] !== null);
    const cell = /** @type {any} */ (Object.fromEntries(there.map((key) => [key, inputs[key]])));
    app.inputs.lend(cell, t("a cell of \u201c{study}\u201d", { study: userText(study.name) }));
    app.go("response");
  };
  /** @param {Server.HistoryAnswer} history @param {boolean} kept */
  const took = (history, kept) => {
    ({ inputs } = history);
    opens.value = Boolean(inputs) && kept && next === null;
    summary.value = kept ? wordsOf(history) : `${wordsOf(history)} ${t("Click the cell or press Enter to keep its time history.")}`;
    curve.value = Boolean(history.answer);
    if (history.answer) data.value = [history.answer.series.time, shareOf(history.answer).map((share) => (Math.abs(share) > MOST ? null : share))];
  };
  const ask = async () => {
    if (busy || !next) return;
    busy = true;
    const { aim, k, kept } = next;
    next = null;
    opens.value = false;
    try {
      const query = { x: aim.ix, y: aim.iy, restitution: k };
      const history = await app.call(`/api/studies/${study.id}/cell`, { method: "GET", query });
      batch(() => took(history, kept));
    } catch (error) {
      summary.value = error.message;
    }
    busy = false;
    ask();
  };
  /** @param {Cell} aim @param {number} k @param {boolean} kept */
  const show = (aim, k, kept) => {
    next = { aim, k, kept };
    opens.value = false;
    ask();
  };
  return { description: summary, data, curve, opens, show, open };
};

/** The panel of a cell. @param {{ cell: ReturnType<typeof createCell> }} props */
export const Cell = ({ cell: { description: text, data, curve, opens, open } }) => html`
  <div class="cell-history" data-testid="cell-history">
    <h3>Time history of a cell</h3>
    <p class="quiet" data-testid="cell-words">${text.value}</p>
    <div hidden=${!curve.value}>${data.value && html`<${Figure} shape=${SHAPE} data=${data.value} />`}</div>
    <div class="toolbar"><${Button} kind="primary" disabled=${!opens.value} onClick=${open}>Open in Response<//></div>
  </div>`;

/** @param {Server.HistoryAnswer} found */
const wordsOf = ({ stored, answer, note }) => {
  const impacts = t(["{count} impact", "{count} impacts"], { count: stored.impacts });
  return [stopped(answer ? answer.summary : impacts), note ? stopped(note) : ""].join(" ");
};

/** @param {Server.ResponseFacts} answer */
const shareOf = (answer) => {
  const [left, right] = /** @type {Foot[]} */ (["left", "right"]).map((foot) => answer.body.sides[foot].slenderness_angle);
  return answer.series.rotation.map((theta) => theta / (theta > 0 ? right : left));
};
