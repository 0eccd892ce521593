"""Report of `rocking reproduce`: recomputed results, and content of the report by section."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import repeat
from typing import Any

from rocking.answers import Answer
from rocking.evidence._claims import claims
from rocking.evidence._errata import Entry, Erratum, TableRow, agreement, errata, recomputed
from rocking.evidence._league import LeagueRow, league, verdict
from rocking.evidence.bed_fit import Explanation, Ranked, explanation
from rocking.evidence.calibration import Calibration, Coverage, calibrate, calibrate_on, coverage
from rocking.evidence.claims_of_errors import FAILS, HOLDS, IN_PART, Claim, tally
from rocking.evidence.comparison import concordance, correlation, relative_error, zone
from rocking.evidence.hierarchy import (
    HierarchicalCalibration,
    LeftOut,
    calibrate_hierarchy,
    hierarchy_answer,
    left_out_groups,
    sentence_of,
)
from rocking.evidence.measurements import BANDS, DataSet, all_measurements, datasets
from rocking.reports.document import (
    Block,
    Cell,
    Document,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    answer_table,
    software_and_data,
)
from rocking.reports.document import table as report_table
from rocking.restitution import Housner, Ked

MARK = {HOLDS: "good", IN_PART: "fair", FAILS: "bad"}

_COLUMNS = {"measured": "r_e", "relative_error": "relative error", "housner": "r_H", "ked": "r_r (KED)"}

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
"""Tables of the paper and their data sets."""

PRINTED_CORRELATION = {"table2": "0.946", "S": "0.998", "M": "0.996", "L": "0.998"}  # section 3.2 of the paper
_TITLES = {"table2": "Table 2", "S": "Table 3, S", "M": "Table 3, M", "L": "Table 3, L"}
_MODELS = (("Housner", Housner()), ("KED", Ked()))


@dataclass(frozen=True, eq=False, slots=True)
class Reproduction:
    """The paper, recomputed."""

    tables: dict[str, tuple[TableRow, ...]]  # rows by table, printed and recomputed
    claims: tuple[Claim, ...]  # claims with verdicts
    errata: tuple[Erratum, ...]  # differences found by recomputing
    league: tuple[LeagueRow, ...]  # all models compared with all measurements
    calibration: Calibration  # the calibrated default, with independent measurements
    coverage: Coverage  # coverage of the intervals for data not used in the fit
    hierarchy: HierarchicalCalibration  # calibration with effects of laboratories, interfaces and blocks
    left_out: tuple[LeftOut, ...]  # groups compared with predictions from the other groups
    data: DataSet  # measurements for the ranking and the calibrations
    verdict: tuple[str, ...]  # conclusions as sentences

    def answer(self) -> Answer:
        """Return all numbers of the reproduction, and their provenance."""
        covered = {name: list(counts) for name, counts in self.coverage.by_group.items()}
        return Answer({
            "verdict": self.verdict,
            "claims": [
                {"section": c.section, "claim": c.quote, "verdict": c.verdict, "evidence": c.evidence, "test": c.test}
                for c in self.claims
            ],
            "errata": [asdict(erratum) for erratum in self.errata],
            "tables": {title: list(map(_row_answer, rows)) for title, rows in self.tables.items()},
            "league": [row.answer() for row in self.league],
            "model": self.calibration.model().label,
            "calibration": self.calibration.summary,
            "covered": {"one_by_one": [self.coverage.one_by_one, self.coverage.rows], "by_data_set": covered},
            "hierarchy": hierarchy_answer(self.hierarchy, self.left_out),
            "provenance": software_and_data(),
        })  # fmt: skip


def _row_answer(row: TableRow) -> dict[str, Any]:
    sides = ("printed", "recomputed", "agrees")
    values = {side: {key: getattr(entry, side) for key, entry in row.entries.items()} for side in sides}
    return {"label": row.label, "slenderness_ratio": row.slenderness, "coefficient": row.measured, **values}


def reproduce(measurements: DataSet | None = None) -> Reproduction:
    """Recompute the paper. `measurements` are data for ranking and calibration, by default those of the paper."""
    data = all_measurements() if measurements is None else measurements
    standings = league(measurements=data)
    tables = {title: tuple(row for name in names for row in recomputed(name)) for title, names in TABLES.items()}
    calibration = calibrate() if data is all_measurements() else calibrate_on(data)
    return Reproduction(
        tables, claims(), errata(), standings, calibration, coverage(data), calibrate_hierarchy(data),
        left_out_groups(data), data, verdict(standings, data),
    )  # fmt: skip


def paper_document(result: Reproduction) -> Document:
    """Return the report."""
    sections: dict[str, Sequence[Block]] = {
        "Verdict": [Paragraph(sentence) for sentence in result.verdict],
        "Claims": _claims(result.claims),
        "League table": _league(result),
        "Explanations of the measurements": explanation_blocks(explanation()),
        "Calibrated default": _calibration(result),
        "Tables": [_paper_table(title, rows) for title, rows in result.tables.items()],
        "Figures": [Paragraph(NO_FIGURE_4), *(Picture(*figure) for figure in FIGURES)],
        "Correlations and error zones": _correlations(),
        "Errata": _errata(result.errata),
    }
    return Document(
        "Mao et al. (2024), recomputed",
        "Coefficient of restitution of rocking bodies: every table, figure and claim of Buildings 14(7) 2119, "
        "doi:10.3390/buildings14072119, and all models against its 39 measurements",
        [ReportSection(title, blocks) for title, blocks in sections.items()],
        look_at=look_at(result),
        provenance=software_and_data(),
    )


def look_at(result: Reproduction) -> list[tuple[str, str]]:
    """Return the main points: a short name and a sentence per point."""
    found_count = sum(erratum.is_confirmed for erratum in result.errata)
    best = result.league[0]
    return [
        (
            "Verdict",
            f"{len(result.verdict)} sentences from the numbers; 'not resolved' if an interval includes zero",
        ),
        ("Claims", tally(result.claims)),
        (
            "League table",
            f"{len(result.league)} models; the smallest error is that of {best.name}, RMSE {best.rmse:.4f}",
        ),
        ("Errata", f"{found_count} of {len(result.errata)} found by recomputing"),
    ]


def _claims(claims: Sequence[Claim]) -> list[Block]:
    rows = [
        (claim.section, claim.quote, Cell(claim.verdict, MARK.get(claim.verdict, "plain")), claim.evidence, claim.test)
        for claim in claims
    ]
    header = ["section", "claim", "verdict", "number", "test"]
    return [Paragraph(f"{tally(claims)}."), report_table("Claims of sections 3 and 4", header, rows, stem="claims")]


def _errata(errata: Sequence[Erratum]) -> list[Block]:
    verdicts = {True: Cell("found"), False: Cell("not found", "bad")}
    rows = [
        (erratum.name, erratum.statement, erratum.evidence, verdicts[bool(erratum.is_confirmed)]) for erratum in errata
    ]
    return [
        Paragraph("Each erratum follows from computation on the printed tables. The data are not corrected."),
        report_table("Errata", ["location", "erratum", "numbers", ""], rows, stem="errata"),
    ]


def _paper_table(title: str, rows: Sequence[TableRow]) -> ReportTable:
    keys = list(rows[0].entries)
    columns = [f"{_COLUMNS[key]} {which}" for key in keys for which in ("printed", "recomputed")]
    measured_header = () if "measured" in keys else ("r_e",)
    header = ["block or interface", "h/b", *measured_header]
    for printed, recomputed_ in zip(columns[::2], columns[1::2], strict=True):
        header += [printed, recomputed_, "difference"]
    cells = [
        [
            row.label, f"{row.slenderness:g}", *(f"{row.measured:g}" for _ in measured_header),
            *(x for key in keys for x in _pair(row.entries[key])),
        ]
        for row in rows
    ]  # fmt: skip
    note = f"{agreement(rows)}. Values that differ are marked."
    return report_table(f"{title}, printed and recomputed", header, cells, note, title.lower().replace(" ", "_"))


def _pair(entry: Entry) -> list[Cell]:
    numbers = f"{entry.printed:.{entry.digits}f}", f"{entry.recomputed:.{max(entry.digits, 4)}f}"
    difference = "" if entry.agrees else f"{entry.difference:+.1e}"
    return [Cell(text, "plain" if entry.agrees else "bad") for text in (*numbers, difference)]


def _league(result: Reproduction) -> list[Block]:
    rows, count = result.league, len(result.data)
    names = (
        "model",
        "fitted",
        "rmse",
        "bias",
        "loss_rmse",
        "log_loss_rmse",
        "concordance",
        "leave_one_out",
        "leave_group_out",
        "bic",
    )
    groups = ["Table 1" if name == "table1" else name for name in rows[0].by_group]
    split = ["model", *groups, *(name for name, _, _ in BANDS), "RMSE minus KED's, 95 %"]
    return [
        Paragraph(
            "Columns: RMSE and bias (model minus experiment) of r, absolute and logarithmic errors of the energy loss "
            "1 - r^2, Lin's concordance, and RMSE with one measurement (LOO) or one data set (LOG) left out. BIC "
            "(lower is better) includes the rounding in the likelihood and a scatter that grows with the loss."
        ),
        answer_table(
            f"All models, all {count} measurements",
            [{**row.answer().values, "model": row.name, "fitted": row.fitted} for row in rows],
            names,
            "Bootstrap: 4000 resamples of specimens within their data sets, fixed seed, without new fits.",
            "league",
        ),
        report_table(
            "RMSE of r by data set and slenderness band", split, map(_split_row, rows), stem="league_by_band"
        ),
        Picture("league", "Error of every model with its bootstrap interval."),
        Picture("models_and_measurements", "All models against all measurements, in r and in energy loss."),
    ]  # fmt: skip


def _split_row(row: LeagueRow) -> list[object]:
    low, high = row.ahead_of_ked
    mark = "good" if high < 0.0 else "bad" if low > 0.0 else "plain"
    values = [*row.by_group.values(), *row.by_band.values()]
    return [row.name, *(f"{value:.4f}" for value in values), Cell(f"{low:+.4f} to {high:+.4f}", mark)]


def _calibration(result: Reproduction) -> list[Block]:
    meanings = {
        "eta": "interface factor",
        "k": "impulse position over half base",
        "s": "scatter scale",
        "gamma": "power of the loss in the scatter",
    }
    both = (("Posterior", "calibration", result.calibration), ("Hierarchical posterior", "hierarchy", result.hierarchy))
    posteriors = [
        report_table(title, ["parameter", "meaning", "mean", "sd", "2.5 %", "97.5 %"], [
            (name, meanings[name], *(f"{fact[key]:.4f}" for key in ("mean", "sd", "low", "high")))
            for name, fact in posterior.summary.items()
        ], stem=stem)
        for title, stem, posterior in both
    ]  # fmt: skip
    groups = [
        (
            group.name,
            group.measurements,
            group.inside,
            f"{group.interval_width:.3f}",
            f"{group.probability:.3f}",
            "yes" if group.within else "no",
        )
        for group in result.left_out
    ]
    return [
        Paragraph(
            f"The default is {result.calibration.model().label}: an interface factor times the shifted impulse. The "
            "interval is the posterior predictive interval of a single measured body, with a scatter s (1 - r)^gamma. "
            f"{result.coverage.sentence}"
        ),
        posteriors[0],
        Paragraph(sentence_of(result.hierarchy, result.left_out)),
        posteriors[1],
        report_table(
            "Groups left out of the hierarchical calibration",
            ["group", "measurements", "inside", "mean width", "probability of a lower mean", "mean within 95 %"],
            groups,
            stem="left_out_groups",
        ),
        Picture("calibration", "Posterior of eta and k, and the predictive band with all measurements."),
    ]


def _correlations() -> list[Block]:
    """Return correlations, concordances and zones of both models, by data set."""
    return [
        Paragraph(
            "Relative errors are |r_e - r| / r_e, as in the paper; zone I is below 1 %, II from 1 to 5 %, III above. "
            "The correct r_H are used. Pearson's correlation hardly differs between the models; Lin's concordance does."
        ),
        report_table(
            "Correlation, concordance and zones",
            ["data", "model", "correlation printed", "correlation", "Lin", "zone I", "zone II", "zone III", "largest"],
            [_measures(name, title, model) for name in _TITLES for title, model in _MODELS],
            stem="correlations_and_zones",
        ),
        report_table(
            "Relative errors and zones of Figures 6 and 7",
            ["data", "block or interface", "h/b", "Housner", "zone", "KED", "zone"],
            [row for name in _TITLES for row in _errors(name)],
            stem="relative_errors",
        ),
    ]


def _measures(name: str, title: str, model: Housner | Ked) -> list[object]:
    data = datasets()[name]
    r = model.of_slenderness(data.slenderness)
    error = relative_error(r, data.coefficient)
    zones, printed = zone(error), PRINTED_CORRELATION[name] if title == "KED" else ""
    measures = f"{correlation(r, data.coefficient):.4f}", f"{concordance(r, data.coefficient):.4f}"
    largest = f"{100.0 * float(error.max()):.1f} %"
    return [
        _TITLES[name],
        title,
        printed,
        *measures,
        *(zones.count(zone_name) for zone_name in ("I", "II", "III")),
        largest,
    ]


def _errors(name: str) -> list[list[object]]:
    data = datasets()[name]
    errors = [relative_error(model.of_slenderness(data.slenderness), data.coefficient) for _, model in _MODELS]
    rows: list[list[object]] = []
    for i in range(len(data)):
        row: list[object] = [_TITLES[name], data.labels[i], f"{data.slenderness[i]:g}"]
        for error in errors:
            zone_name = zone(error)[i]
            row += [f"{100.0 * float(error[i]):.2f} %", Cell(zone_name, "bad" if zone_name == "III" else "plain")]
        rows.append(row)
    return rows


def explanation_blocks(compared: Explanation) -> list[Block]:
    """Return the sections on explanations of the measurements."""
    header = [
        "explanation", "statement", "points", "fitted", "RMSE", "BIC", "BIC minus best", "left-out score",
        "score minus one bed",
    ]  # fmt: skip
    return [
        *(Paragraph(sentence) for sentence in compared.verdict),
        Paragraph(
            "The contact bed resolves an impact in time on springs and dashpots along the base. Each explanation is "
            "fitted to the 39 measurements by maximum likelihood of the printed digits, with a scatter "
            "s (1 - r)^gamma. BIC counts its parameters, the number of contact points and the two parameters of the "
            "scatter. The left-out score is the sum over the measurements of the log probability of each measurement "
            "by a fit without this measurement."
        ),
        report_table(
            "Explanations of the measurements by the contact bed",
            header,
            map(_explanation, compared.ranked, repeat(compared.unresolved)),
            "Score minus one bed: with the standard error over the measurements.",
            "explanations",
        ),
        Picture("bed_dependence", "Coefficient of restitution of the contact bed: slenderness, hardness, damping."),
        Picture(
            "explanations",
            "BIC minus the best BIC, and left-out score minus that of one common bed, with two standard errors.",
        ),
        Picture("explanation_residuals", "Residuals of one common bed and of the best explanation."),
    ]


def _explanation(ranked: Ranked, best: tuple[str, ...]) -> list[object]:
    fit = ranked.fit
    fitted = ", ".join(f"{name} = {value:.4g}" for name, value in fit.values.items())
    scores = f"{fit.rmse:.4f}", f"{fit.bic:.1f}", f"{ranked.behind:.1f}", f"{ranked.score:.1f}"
    name = Cell(ranked.name, "good" if ranked.name in best else "plain")
    return [name, fit.physics.sentence, fit.points, fitted, *scores, f"{ranked.gain:+.1f} +- {ranked.gain_error:.1f}"]
