/** The history of one cell of a map. */
import { el, fill } from "/app/dom.js";
import { button } from "/app/fields.js";
import { lineChart } from "/charts/line.js";
import { number } from "/app/format.js";

/** Beyond this share of alpha a body lies on the ground, and its curve would hide what went before. */
const MOST = 2;
const KEYS = ["body", "motion", "restitution", "response", "settings"];

/** Panel of one cell: show(aim, k, kept), open() in the step Response, for a cell that is kept. */
export const cellHistory = (app, study) => {
  const title = el("h3", {}, "History of a cell");
  const words = el("p", { class: "quiet", "data-testid": "cell-words" }, "Click a cell of the map.");
  const chartPlace = el("div", { hidden: true });
  let chart = null;
  let inputs = null;
  let busy = false;
  let next = null;

  const open = () => {
    if (!inputs || go.disabled) return;
    // what the cell does not have must be absent, not null
    const there = KEYS.filter((key) => inputs[key] !== undefined && inputs[key] !== null);
    const cell = Object.fromEntries(there.map((key) => [key, inputs[key]]));
    app.inputs.lend(cell, `a cell of \u201c${study.name}\u201d`);
    app.go("response");
  };
  const go = button({ text: "Open in Response", kind: "primary", onClick: open });
  go.disabled = true;

  const draw = ({ answer }) => {
    chartPlace.hidden = false;
    chart ??= lineChart(chartPlace, {
      title: "Rotation",
      x: { label: "time", unit: "s" },
      y: { label: "rotation / \u03b1", unit: "" },
      height: 200,
      series: [{ label: "rotation / \u03b1", colour: "--accent" }],
    });
    chart.setData([
      answer.series.time,
      shareOf(answer).map((share) => (Math.abs(share) > MOST ? null : share)),
    ]);
  };
  const ask = async () => {
    if (busy || !next) return;
    busy = true;
    const { aim, k, kept } = next;
    next = null;
    go.disabled = true;
    try {
      const found = await app.call(`/api/studies/${study.id}/cell`, {
        method: "GET",
        query: { x: aim.ix, y: aim.iy, restitution: k },
      });
      inputs = found.inputs;
      go.disabled = !inputs || !kept || next !== null;
      fill(words, wordsOf(found), kept ? "" : " Click the cell, or press Enter, to keep it.");
      if (found.answer) draw(found);
      else chartPlace.hidden = true;
    } catch (error) {
      fill(words, error.message);
      go.disabled = true;
    }
    busy = false;
    ask();
  };
  return {
    node: el(
      "div",
      { class: "cell-history", "data-testid": "cell-history" },
      title,
      words,
      chartPlace,
      el("div", { class: "toolbar" }, go),
    ),
    show: (aim, k, kept) => {
      next = { aim, k, kept };
      go.disabled = true;
      ask();
    },
    open,
    destroy: () => chart?.destroy(),
  };
};

const wordsOf = ({ stored, answer, note }) => {
  const impacts = `${number(stored.impacts)} impact${stored.impacts === 1 ? "" : "s"}`;
  return [answer ? `${answer.summary}.` : `${impacts}.`, note ? `${note}.` : ""].join(" ");
};

const shareOf = (answer) => {
  const [left, right] = ["left", "right"].map((foot) => answer.body.sides[foot].slenderness_angle_rad);
  return answer.series.rotation.map((theta) => theta / (theta > 0 ? right : left));
};
