/** The impacts of one model in a table. */
import { el, fill } from "/app/dom.js";
import { selectField, tableOf } from "/app/fields.js";
import { chosenOf, look } from "/views/response-chosen.js";
import { wordsOf } from "/views/response-labels.js";

const COLUMNS = [
  { label: "No.", digits: 6 },
  { label: "Time", unit: "s", digits: 6 },
  { label: "Before", unit: "rad/s", digits: 5 },
  { label: "After", unit: "rad/s", digits: 5 },
  { label: "r", digits: 5 },
  { label: "Onto", numeric: false },
];
const MOST = 200;

const rowsOf = (impacts) =>
  impacts.map((one, k) => [
    k + 1, one.time_s, one.velocity_before_rad_s, one.velocity_after_rad_s, one.coefficient, one.onto,
  ]);

/** Returns the table of impacts with a choice of the model. */
export const impactsOf = (app) => {
  const place = el("div", { "data-testid": "impacts" });
  const which = selectField({ label: "Model", options: [], onChange: look });
  const element = el("div", { class: "impacts" }, which, place);
  let answers = [];
  const draw = () => {
    const chosen = chosenOf(answers.map(({ label }) => label));
    const answer = answers.find(({ label }) => label === chosen);
    if (!answer) return fill(place);
    which.value = answer.label;
    const rows = rowsOf(answer.impacts);
    const more = rows.length > MOST ? `; the first ${MOST} are shown, copying takes them all` : "";
    const count = `${rows.length} impact${rows.length === 1 ? "" : "s"}`;
    const caption = `${count} (${wordsOf(answer.label)})${more}`;
    const csv = () => app.download("table/impacts.csv", app.inputs.get(), "impacts.csv");
    const options = { caption, csv, testid: "impacts-table", copyRows: () => rows };
    return fill(place, tableOf(COLUMNS, rows.slice(0, MOST), options));
  };
  const show = (found) => {
    const before = answers.map(({ label }) => label).join("|");
    answers = found;
    if (found.map(({ label }) => label).join("|") !== before) {
      which.setOptions(found.map(({ label }) => ({ value: label, text: wordsOf(label) })));
    }
    draw();
  };
  return { element, show, draw };
};
