/** Time histories as linked figures: rotation, velocity, ground, energy, forces. */
import { html, useMemo } from "/parts/preact.js";
import { highest } from "/app/extremes.js";
import { Figure } from "/charts/figure.js";
import { detailed } from "/charts/zoom.js";
import { sharesOf } from "/scene/sampled.js";
import { styleOf, wordsOf } from "/views/response-labels.js";
import { together } from "/views/response-series.js";
import { t } from "/app/words.js";

const TIME = { label: "time", unit: "s" };
const MOST_FRICTION = 3;
const FALL_SHOWN = 1.5;

// beyond the point of no return the body falls to the ground; rocking would not be visible at that scale
/** @param {Server.ResponseFacts} answer @param {(number | null)[]} values */
const untilFall = (answer, values) => {
  const shares = sharesOf(answer.series.rotation, answer.body);
  const falls = answer.outcome === "overturned";
  const fallen = falls ? shares.findIndex((share) => Math.abs(share) > FALL_SHOWN) : -1;
  return fallen < 0 ? values : values.map((value, k) => (k < fallen ? value : null));
};

/** @param {(number | null)[]} values */
const capped = (values) => values.map((value) => (value === null || value > MOST_FRICTION ? null : value));

// the lines of +1 and -1 are visible unless the rocking is small compared with them
/** @param {unknown} _ @param {number | null} low @param {number | null} high */
const rotationRange = (_, low, high) => {
  const most = Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0));
  const span = most > 0.25 ? Math.max(1.15, 1.05 * most) : 1.15 * most || 1;
  return [-span, span];
};

/** @type {{ key: "kinetic_energy" | "potential_energy" | "energy_lost" | "work_of_ground", label: string, colour: string, dash: number[] }[]} */
const ENERGIES = [
  { key: "kinetic_energy", label: "kinetic", colour: "#0070B2", dash: [] },
  { key: "potential_energy", label: "potential", colour: "#009960", dash: [8, 3, 2, 3] },
  { key: "energy_lost", label: "lost at impacts", colour: "#D96C00", dash: [6, 4] },
  { key: "work_of_ground", label: "work of the ground", colour: "#8A8A8A", dash: [2, 3] },
];

/** The response with the longest duration. @param {Server.ResponseFacts[]} answers */
export const longest = (answers) => {
  const ends = answers.map(({ series }) => series.time[series.time.length - 1]);
  return answers[ends.indexOf(highest(ends))];
};

/** A figure with a curve of each model.
 * @param {string} title @param {ChartAxis} y @param {(answer: Server.ResponseFacts) => (number | null)[]} values @returns {FigureKind} */
const ofEach = (title, y, values) => ({
  title,
  y,
  series: (answers) => answers.map(({ label }) => ({ label: wordsOf(label), ...styleOf(label) })),
  data: (answers) => together(answers, (answer) => untilFall(answer, values(answer))),
});

/** @type {{ [kind: string]: FigureKind }} */
const KINDS = {
  rotation: ofEach(
    "Rotation over slenderness angle", { label: "\u03b8/\u03b1", unit: "-", range: rotationRange },
    ({ series, body }) => sharesOf(series.rotation, body),
  ),
  velocity: ofEach("Angular velocity", { label: "", unit: "rad/s" }, ({ series }) => series.angular_velocity),
  ground: {
    title: "Acceleration of the ground",
    y: { label: "", unit: "m/s2" },
    series: () => [{ label: t("ground"), colour: "--mark-strong" }],
    data: (answers) => [longest(answers).series.time, longest(answers).series.ground_acceleration],
  },
  energy: {
    title: (lead) => t("Energy ({model})", { model: wordsOf(lead.label) }),
    y: { label: "", unit: "J" },
    series: () => ENERGIES,
    // the abscissa is the time of all figures
    data: (answers, lead) => [
      [...lead.series.time, longest(answers).series.time.at(-1) ?? null],
      ...ENERGIES.map(({ key }) => [...untilFall(lead, lead.series[key]), null]),
    ],
  },
  lost: ofEach("Energy lost at impacts", { label: "", unit: "J" }, ({ series }) => series.energy_lost),
  force: ofEach("Vertical contact force", { label: "", unit: "N" }, ({ series }) => series.vertical_force),
  friction: ofEach(
    "Friction demand without sliding", { label: "", unit: "-" }, ({ series }) => capped(series.friction_demand),
  ),
};

/** Legend of the marks; `whose`: model of the impact ticks.
 * @param {Server.ResponseFacts[]} answers @param {string} whose */
export const marksWords = (answers, whose) => [
  t("Ticks on the axis: impacts of {model}; dashed: the slenderness angles.", { model: whose }),
  ...(answers.some(({ outcome }) => outcome === "overturned") ? [t("Curves of an overturning body end at {rotation} \u03b1.", { rotation: FALL_SHOWN })] : []),
  t("Drag across a chart to zoom in. Double-click to show the full duration."),
].join(" ");

/** Figures of some kinds; `lead` has the energy, `ticked` the impacts, `closeup` has the visible interval with its detailed curves.
 * @param {{ kinds: string[], answers: Server.ResponseFacts[], lead?: string, ticked: Server.ResponseFacts[], closeup: any, friction: number, time: Time }} props */
export const Figures = ({ kinds, answers, lead, ticked, closeup, friction, time }) => {
  const shown = useMemo(() => answers.map((answer) => {
    const detail = closeup?.answers?.find((/** @type {any} */ { label }) => label === answer.label)?.series;
    return detail ? { ...answer, series: detailed(answer.series, detail) } : answer;
  }), [answers, closeup]);
  const first = shown.find(({ label }) => label === lead) ?? shown[0];
  const rows = useMemo(() => ticked.map(({ label, impacts }) =>
    ({ colour: styleOf(label).colour, at: impacts.map(({ time: at }) => at) })), [ticked]);
  return kinds.map((kind) => html`<${OneFigure} key=${kind} kind=${kind} answers=${shown} lead=${first} rows=${rows}
    ticked=${ticked.length === 1 ? wordsOf(ticked[0].label) : "each model in its colour"}
    interval=${closeup?.window ?? null} friction=${friction} time=${time} height=${innerHeight > 1300 ? 320 : 220} />`);
};

/** @type {Words} */
const DASHED = { rotation: "Dashed: the slenderness angles.", friction: "Dashed: the assumed friction." };

/** @param {{ kind: string, answers: Server.ResponseFacts[], lead: Server.ResponseFacts, rows: Ticks[], ticked: string, interval: Point | null, friction: number, time: Time, height: number }} props */
const OneFigure = ({ kind, answers, lead, rows, ticked, interval, friction, time, height }) => {
  const { title, y, series, data } = KINDS[kind];
  // the range includes the given friction
  const held = kind === "friction" && { range: (/** @type {unknown} */ _, /** @type {number} */ low, /** @type {number | null} */ high) => [0, 1.1 * Math.max(high ?? 0, friction)], of: friction };
  const shape = {
    title: typeof title === "string" ? title : title(lead), x: TIME, y: { ...y, ...held }, series: series(answers), height,
  };
  const columns = useMemo(() => data(answers, lead), [answers, lead]);
  const marks = useMemo(() => ({
    ticks: rows,
    horizontal: kind === "rotation" ? [-1, 1] : kind === "friction" ? [friction] : [],
    description: [rows.some(({ at }) => at.length) && t("Ticks on the axis: impacts of {model}.", { model: ticked }), t(DASHED[kind] ?? "")].filter(Boolean).join(" "),
  }), [rows, friction, ticked]);
  return html`<${Figure} shape=${shape} data=${columns} interval=${interval} marks=${marks} time=${time} testid=${`chart-${kind}`} />`;
};
