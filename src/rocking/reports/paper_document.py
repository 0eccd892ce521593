"""The report of `rocking paper`: what is recomputed, and what stands in the report, section by section."""

from collections.abc import Sequence
from dataclasses import dataclass

from rocking.evidence._claims import claims
from rocking.evidence._errata import Entry, Erratum, TableRow, errata, recomputed
from rocking.evidence._league import LeagueRow, league, verdict
from rocking.evidence.calibration import Calibration, Coverage, calibrate, coverage
from rocking.evidence.claim import FAILS, HOLDS, IN_PART, UNRESOLVED, Claim
from rocking.evidence.comparison import concordance, correlation, relative_error, zone
from rocking.evidence.explanation import Explanation, Ranked, explanation
from rocking.evidence.measurements import BANDS, GROUPS, datasets
from rocking.reports.document import (
    Block,
    Cell,
    Document,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    cell,
    made_with,
)  # fmt: skip
from rocking.restitution import Housner, Ked

MARK = {HOLDS: "good", IN_PART: "fair", FAILS: "bad"}

_COLUMNS = {"relative_error": "relative error", "housner": "r_H", "ked": "r_r (KED)"}

NO_FIGURE_4 = "Figure 4 of the paper is a photograph of the tested blocks and is not reproduced."

FIGURES = (
    ("figure_1", "Figure 1. The classical model: a block, its feet O and O', its centre of mass.", 62),
    (
        "figure_2",
        "Figure 2. KED stage by stage: kinetic energy per volume and velocities before the impact, after the "
        "vertical part is lost, after the part along O'S is lost, and after redistribution.",
        100,
    ),
    (
        "figure_3",
        "Figure 3. Slenderness against r: both models and Table 2; bars are |r_r - r_e|, as in the paper.",
        62,
    ),
    ("figure_5", "Figure 5. The same for the groups S, M and L of Table 3; S and L are moved sideways by 0.09.", 62),
    (
        "figure_6",
        "Figure 6. Relative errors of both models, Table 2, with zones I (< 1 %), II (1-5 %), III (> 5 %).",
        62,
    ),
    ("figure_7", "Figure 7. Relative errors for the groups (a) S, (b) M, (c) L.", 100),
    ("figure_8", "Figure 8. Absolute errors against mass, Table 3.", 62),
    ("figure_9", "Figure 9. Relative errors at equal slenderness for the three groups, both models.", 62),
)


TABLES = {
    "Table 1": ("table1",),
    "Table 2": ("table2",),
    "Table 3": ("S", "M", "L"),
}
"""The paper's tables and the data sets they hold."""

PRINTED_CORRELATION = {"table2": "0.946", "S": "0.998", "M": "0.996", "L": "0.998"}
"""Section 3.2 of the paper."""

_TITLES = {"table2": "Table 2", "S": "Table 3, S", "M": "Table 3, M", "L": "Table 3, L"}
_MODELS = (("Housner", Housner()), ("KED", Ked()))


@dataclass(frozen=True, eq=False, slots=True)
class Reproduction:
    """The paper, recomputed."""

    tables: dict[str, tuple[TableRow, ...]]  # Table to rows, printed beside recomputed
    claims: tuple[Claim, ...]  # every claim with its verdict
    errata: tuple[Erratum, ...]  # what recomputing found
    league: tuple[LeagueRow, ...]  # every model against every measurement
    calibration: Calibration  # the calibrated default
    coverage: Coverage  # how its intervals cover what they have not seen
    verdict: tuple[str, ...]  # what the evidence says, in words


def reproduce() -> Reproduction:
    """Recompute the paper."""
    standings = league()
    tables = {title: tuple(row for name in names for row in recomputed(name)) for title, names in TABLES.items()}
    return Reproduction(tables, claims(), errata(), standings, calibrate(), coverage(), verdict(standings))


def paper_document(result: Reproduction) -> Document:
    """Return the report."""
    sections: dict[str, Sequence[Block]] = {
        "Verdict": [Paragraph(sentence) for sentence in result.verdict],
        "Claims": _claims(result.claims),
        "League table": _league(result.league),
        "What explains the measurements": explanation_blocks(explanation()),
        "Calibrated default": _calibration(result),
        "Tables": [_paper_table(title, rows) for title, rows in result.tables.items()],
        "Figures": [Paragraph(NO_FIGURE_4), *(Picture(*figure) for figure in FIGURES)],
        "Correlations and error zones": error_blocks(),
        "Errata": _errata(result.errata),
    }
    return Document(
        "Mao et al. (2024), recomputed",
        "Coefficient of restitution of rocking bodies: every table, figure and claim of Buildings 14(7) 2119, "
        "doi:10.3390/buildings14072119, and all models against its 39 measurements",
        [ReportSection(title, blocks) for title, blocks in sections.items()],
        look_at=look_at(result),
        provenance=made_with(),
    )


def look_at(result: Reproduction) -> list[tuple[str, str]]:
    """Say what to look at first."""
    counts = {one: sum(c.verdict == one for c in result.claims) for one in (HOLDS, IN_PART, FAILS, UNRESOLVED)}
    found = sum(erratum.found for erratum in result.errata)
    best = result.league[0]
    return [
        (
            "Verdict",
            f"{len(result.verdict)} sentences made from the numbers; 'not resolved' where an interval includes zero",
        ),
        (
            "Claims",
            f"{len(result.claims)} claims: {counts[HOLDS]} hold, {counts[IN_PART]} in part, {counts[FAILS]} do not, "
            f"{counts[UNRESOLVED]} cannot be resolved from so few blocks",
        ),
        (
            "League table",
            f"{len(result.league)} models; the smallest error is that of {best.name}, RMSE {best.rmse:.4f}",
        ),
        ("Errata", f"{found} of {len(result.errata)} found by recomputing"),
    ]


def _claims(judged: Sequence[Claim]) -> list[Block]:
    rows = [
        [cell(one.section), cell(one.quote), cell(one.verdict, MARK.get(one.verdict, "plain")), cell(one.evidence),
         cell(one.test)]
        for one in judged
    ]  # fmt: skip
    header = ["section", "claim", "verdict", "number", "test"]
    return [ReportTable("Claims of sections 3 and 4", header, rows, stem="claims")]


def _errata(checked: Sequence[Erratum]) -> list[Block]:
    rows = [
        [cell(one.name), cell(one.statement), cell(one.evidence),
         cell("found" if one.found else "not found", "plain" if one.found else "bad")]
        for one in checked
    ]  # fmt: skip
    return [
        Paragraph("Each was found by computation on the printed tables; nothing is corrected in the data."),
        ReportTable("Errata", ["where", "what", "numbers", ""], rows, stem="errata"),
    ]


def _paper_table(title: str, rows: Sequence[TableRow]) -> ReportTable:
    keys = list(rows[0].entries)
    header = ["block or interface", "h/b", "r_e"]
    for key in keys:
        header += [f"{_COLUMNS[key]} printed", f"{_COLUMNS[key]} recomputed", "difference"]
    cells = []
    for row in rows:
        line = [cell(row.label), cell(f"{row.slenderness:g}"), cell(f"{row.measured:g}")]
        for key in keys:
            line += _pair(row.entries[key])
        cells.append(line)
    differing = sum(not entry.agrees for row in rows for entry in row.entries.values())
    total = len(rows) * len(keys)
    note = f"{total - differing} of {total} printed values agree in all their digits; the others are marked."
    return ReportTable(f"{title}, printed beside recomputed", header, cells, note, title.lower().replace(" ", "_"))


def _pair(entry: Entry) -> list[Cell]:
    mark = "plain" if entry.agrees else "bad"
    digits = max(entry.digits, 4)
    return [
        cell(f"{entry.printed:.{entry.digits}f}", mark),
        cell(f"{entry.recomputed:.{digits}f}", mark),
        cell("" if entry.agrees else f"{entry.difference:+.1e}", mark),
    ]


def _league(rows: Sequence[LeagueRow]) -> list[Block]:
    whole = ["model", "fitted", "RMSE", "95 % bootstrap", "bias", "loss", "log loss", "Lin", "LOO", "LOG", "BIC"]
    groups = ["Table 1" if name == "table1" else name for name in GROUPS]
    split = ["model", *groups, *(name for name, _, _ in BANDS), "RMSE minus KED's, 95 %"]
    return [
        Paragraph(
            "RMSE and bias (model minus experiment) of r; errors of the energy loss 1 - r^2, absolute and logarithmic; "
            "Lin's concordance; leave-one-out (LOO) and leave-one-data-set-out (LOG) RMSE; BIC with the rounding in "
            "the likelihood and a scatter that grows with the loss (lower is better)."
        ),
        ReportTable(
            "All models, all 39 measurements",
            whole,
            [_league_row(row) for row in rows],
            "Bootstrap: 4000 resamples of specimens within their data sets, fixed seed; fitted values are kept.",
            "league",
        ),
        ReportTable(
            "RMSE of r by data set and slenderness band",
            split,
            [_split_row(row) for row in rows],
            stem="league_by_band",
        ),
        Picture("league", "Error of every model with its bootstrap interval."),
        Picture("models_and_measurements", "All models against all measurements, in r and in energy loss."),
    ]


def _league_row(row: LeagueRow) -> list[Cell]:
    numbers = (row.loss_rmse, row.log_loss_rmse, row.concordance, row.leave_one_out, row.leave_group_out)
    return [
        cell(row.name),
        cell(row.fitted),
        cell(f"{row.rmse:.4f}"),
        cell(f"{row.rmse_low:.4f} - {row.rmse_high:.4f}"),
        cell(f"{row.bias:+.4f}"),
        *(cell(f"{number:.{digits}f}") for number, digits in zip(numbers, (4, 3, 3, 4, 4), strict=True)),
        cell(f"{row.bic:.1f}"),
    ]


def _split_row(row: LeagueRow) -> list[Cell]:
    low, high = row.ahead_of_ked
    mark = "good" if high < 0.0 else "bad" if low > 0.0 else "plain"
    values = [*row.by_group.values(), *row.by_band.values()]
    return [cell(row.name), *(cell(f"{value:.4f}") for value in values), cell(f"{low:+.4f} to {high:+.4f}", mark)]


def _calibration(result: Reproduction) -> list[Block]:
    summary = result.calibration.summary
    words = {
        "eta": "interface factor",
        "k": "impulse position over half base",
        "s": "scatter scale",
        "gamma": "power of the loss in the scatter",
    }
    rows = [
        [cell(name), cell(words[name]), *(cell(f"{fact[key]:.4f}") for key in ("mean", "sd", "low", "high"))]
        for name, fact in summary.items()
    ]
    return [
        Paragraph(
            f"The default is {result.calibration.model().label}: an interface factor times the shifted impulse. Its "
            "interval is the posterior predictive one for a single measured body, with a scatter s (1 - r)^gamma. "
            f"{result.coverage.sentence}"
        ),
        ReportTable("Posterior", ["parameter", "meaning", "mean", "sd", "2.5 %", "97.5 %"], rows, stem="calibration"),
        Picture("calibration", "Posterior of eta and k, and the predictive band with all measurements."),
    ]


def error_blocks() -> list[Block]:
    """Return correlations, concordances and zones of both models, data set by data set."""
    return [
        Paragraph(
            "Relative errors are |r_e - r| / r_e, as in the paper; zone I is below 1 %, II from 1 to 5 %, III above. "
            "The true r_H are used. Pearson's correlation hardly tells the models apart; Lin's concordance does."
        ),
        ReportTable(
            "Correlation, concordance and zones",
            ["data", "model", "correlation printed", "correlation", "Lin", "zone I", "zone II", "zone III", "largest"],
            [_measures(name, word, model) for name in _TITLES for word, model in _MODELS],
            stem="correlations_and_zones",
        ),
        ReportTable(
            "Relative errors and zones of Figures 6 and 7",
            ["data", "block or interface", "h/b", "Housner", "zone", "KED", "zone"],
            [row for name in _TITLES for row in _errors(name)],
            stem="relative_errors",
        ),
    ]


def _measures(name: str, word: str, model: Housner | Ked) -> list[Cell]:
    data = datasets()[name]
    r = model.of_slenderness(data.slenderness)
    error = relative_error(r, data.coefficient)
    zones = zone(error)
    return [
        cell(_TITLES[name]),
        cell(word),
        cell(PRINTED_CORRELATION[name] if word == "KED" else ""),
        cell(f"{correlation(r, data.coefficient):.4f}"),
        cell(f"{concordance(r, data.coefficient):.4f}"),
        *(cell(zones.count(each)) for each in ("I", "II", "III")),
        cell(f"{100.0 * float(error.max()):.1f} %"),
    ]


def _errors(name: str) -> list[list[Cell]]:
    data = datasets()[name]
    errors = [relative_error(model.of_slenderness(data.slenderness), data.coefficient) for _, model in _MODELS]
    rows = []
    for i in range(len(data)):
        line = [cell(_TITLES[name]), cell(data.labels[i]), cell(f"{data.slenderness[i]:g}")]
        for error in errors:
            where = zone(error)[i]
            line += [cell(f"{100.0 * float(error[i]):.2f} %"), cell(where, "bad" if where == "III" else "plain")]
        rows.append(line)
    return rows


def explanation_blocks(compared: Explanation) -> list[Block]:
    """Return what explains the measurements."""
    header = [
        "explanation", "what it says", "points", "fitted", "RMSE", "BIC", "behind", "left-out score", "over one bed",
    ]  # fmt: skip
    return [
        *(Paragraph(sentence) for sentence in compared.verdict),
        Paragraph(
            "The contact bed resolves an impact in time on springs and dashpots along the base. Each explanation is "
            "fitted to the 39 measurements by maximum likelihood of the printed digits, with a scatter "
            "s (1 - r)^gamma; BIC counts its parameters, the number of contact points and the two of the scatter. The "
            "left-out score is the sum over the measurements of the logarithm of the probability of each by a fit that "
            "has not seen it."
        ),
        ReportTable(
            "Explanations of the measurements by the contact bed",
            header,
            [_explanation(each, compared.unresolved) for each in compared.ranked],
            "Over one bed: with its standard error over the measurements.",
            "explanations",
        ),
        Picture("bed_dependence", "Coefficient of restitution of the contact bed: slenderness, hardness, damping."),
        Picture(
            "explanations",
            "BIC above the best, and left-out score above that of one bed for all, with two standard errors.",
        ),
        Picture("explanation_residuals", "What one bed and the best explanation leave over."),
    ]


def _explanation(each: Ranked, best: tuple[str, ...]) -> list[Cell]:
    fit = each.fit
    fitted = ", ".join(f"{name} = {value:.4g}" for name, value in fit.values.items())
    return [
        cell(each.name, "good" if each.name in best else "plain"),
        cell(fit.physics.sentence),
        cell(str(fit.points)),
        cell(fitted),
        cell(f"{fit.rmse:.4f}"),
        cell(f"{fit.bic:.1f}"),
        cell(f"{each.behind:.1f}"),
        cell(f"{each.score:.1f}"),
        cell(f"{each.gain:+.1f} +- {each.gain_error:.1f}"),
    ]
