/** Energy ledger: from the initial to the remaining energy, one bar per stage, losses hatched. */

import { svg } from "/app/dom.js";
import { percent } from "/app/format.js";
import { STAGE_WORDS } from "/drawing/stages-picture.js";
import { t } from "/app/words.js";

const ROW = 52;

/** Draw fractions {stage: fraction} as bars. @param {{ [stage: string]: number }} shares @param {{ width: number }} size */
export const ledgerPicture = (shares, { width }) => {
  const stages = Object.entries(shares);
  const height = stages.length * ROW + 4;
  const full = width - 2;
  return svg("svg", {
    class: "picture", viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "data-testid": "ledger",
    "aria-label": t("Kinetic energy: {shares}", { shares: stages.map(([name, share]) => `${t(name)} ${percent(share)}`).join(", ") }),
  },
    hatching(),
    stages.map(
      ([name, share], index) => oneBar(name, share, stages[index - 1]?.[1] ?? share, { full, y: index * ROW })
    ));
};

/** @param {string} name @param {number} share @param {number} before @param {{ full: number, y: number }} where */
const oneBar = (name, share, before, { full, y }) => {
  const [title, description] = STAGE_WORDS[name] ?? [name, ""];
  const lost = before - share;
  return svg("g", {},
    svg(
      "text", { x: 1, y: y + 14 }, svg("tspan", { class: "strong" }, title),
      full > 460 ? svg("tspan", { class: "soft", dx: 8 }, description) : null,
    ),
    svg("text", { x: full, y: y + 14, "text-anchor": "end", class: "figure" },
      lost > 1e-9 ? `${percent(share)} (\u2212${percent(lost)})` : percent(share)),
    svg("rect", { class: "bar-back", x: 1, y: y + 21, width: full, height: 18, rx: 4 }),
    svg("rect", { class: "bar-kept", x: 1, y: y + 21, width: Math.max(0, share * full), height: 18, rx: 4 }),
    lost > 1e-9 ? svg(
      "rect",
      {
        class: "bar-lost", x: 1 + share * full, y: y + 21, width: lost * full, height: 18, fill: "url(#lost)",
      },
    ) : null);
};

const hatching = () =>
  svg("defs", {}, svg("pattern", {
    id: "lost", width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)",
  },
    svg(
      "rect", { class: "hatch-paper", width: 6, height: 6 },
    ), svg("rect", { class: "hatch-ink", width: 2.5, height: 6 })));
