"""The report of `rocking paper`: what stands in it, section by section."""

from collections.abc import Sequence

from rocking.evidence._claims import FAILS, HOLDS, IN_PART, UNRESOLVED, Claim
from rocking.evidence._league import LeagueRow
from rocking.evidence.explanation import explanation
from rocking.evidence.measurements import BANDS, GROUPS
from rocking.evidence.tables import Entry, TableRow
from rocking.reports.document import Cell, Document, Paragraph, Picture, ReportSection, ReportTable, cell
from rocking.reports.error_tables import error_blocks
from rocking.reports.explanation_blocks import explanation_blocks
from rocking.reports.provenance import made_with
from rocking.reports.reproduction import Reproduction

MARK = {HOLDS: "good", IN_PART: "fair", FAILS: "bad"}

_COLUMNS = {"relative_error": "relative error", "housner": "r_H", "ked": "r_r (KED)"}

NO_FIGURE_4 = "Figure 4 of the paper is a photograph of the tested blocks and is not reproduced."

FIGURES = (
    ("figure_1", "Figure 1. The classical model: a block, its feet O and O', its centre of mass.", False),
    (
        "figure_2",
        "Figure 2. KED stage by stage: kinetic energy per volume and velocities before the impact, after the "
        "vertical part is lost, after the part along O'S is lost, and after redistribution.",
        True,
    ),
    (
        "figure_3",
        "Figure 3. Slenderness against r: both models and Table 2; bars are |r_r - r_e|, as in the paper.",
        False,
    ),
    ("figure_5", "Figure 5. The same for the groups S, M and L of Table 3; S and L are moved sideways by 0.09.", False),
    (
        "figure_6",
        "Figure 6. Relative errors of both models, Table 2, with zones I (< 1 %), II (1-5 %), III (> 5 %).",
        False,
    ),
    ("figure_7", "Figure 7. Relative errors for the groups (a) S, (b) M, (c) L.", True),
    ("figure_8", "Figure 8. Absolute errors against mass, Table 3.", False),
    ("figure_9", "Figure 9. Relative errors at equal slenderness for the three groups, both models.", False),
)


def paper_document(result: Reproduction) -> Document:
    """Return the report."""
    return Document(
        "Mao et al. (2024), recomputed",
        "Coefficient of restitution of rocking bodies: every table, figure and claim of Buildings 14(7) 2119, "
        "doi:10.3390/buildings14072119, and all models against its 39 measurements",
        look_at(result),
        [
            ReportSection("Verdict", [Paragraph(sentence) for sentence in result.verdict]),
            ReportSection("Claims", _claims(result.claims)),
            ReportSection("League table", _league(result)),
            ReportSection("What explains the measurements", explanation_blocks(explanation())),
            ReportSection("Calibrated default", _calibration(result)),
            ReportSection("Tables", [_paper_table(title, rows) for title, rows in result.tables.items()]),
            ReportSection("Figures", [Paragraph(NO_FIGURE_4), *(Picture(*figure) for figure in FIGURES)]),
            ReportSection("Correlations and error zones", error_blocks()),
            ReportSection("Errata", _errata(result)),
        ],
        made_with(),
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


def _claims(found: Sequence[Claim]) -> list[ReportTable]:
    rows = [
        [
            cell(claim.section),
            cell(claim.quote),
            cell(claim.verdict, MARK.get(claim.verdict, "plain")),
            cell(claim.evidence),
            cell(claim.test),
        ]
        for claim in found
    ]
    return [
        ReportTable(
            "Claims of sections 3 and 4", ["section", "claim", "verdict", "number", "test"], rows, stem="claims"
        )
    ]


def _errata(result: Reproduction) -> list[Paragraph | ReportTable]:
    rows = [
        [
            cell(each.name),
            cell(each.statement),
            cell(each.evidence),
            cell("found" if each.found else "not found", "plain" if each.found else "bad"),
        ]
        for each in result.errata
    ]
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


def _league(result: Reproduction) -> list[Paragraph | ReportTable | Picture]:
    rows = result.league
    return [
        Paragraph(
            "RMSE and bias (model minus experiment) of r; errors of the energy loss 1 - r^2, absolute and logarithmic; "
            "Lin's concordance; leave-one-out (LOO) and leave-one-data-set-out (LOG) RMSE; BIC with the rounding in "
            "the likelihood and a scatter that grows with the loss (lower is better)."
        ),
        ReportTable(
            "All models, all 39 measurements",
            [
                "model",
                "fitted",
                "RMSE",
                "95 % bootstrap",
                "bias",
                "loss",
                "log loss",
                "Lin",
                "LOO",
                "LOG",
                "BIC",
            ],
            [_league_row(row) for row in rows],
            "Bootstrap: 4000 resamples of specimens within their data sets, fixed seed; fitted values are kept.",
            "league",
        ),
        ReportTable(
            "RMSE of r by data set and slenderness band",
            [
                "model",
                *("Table 1" if name == "table1" else name for name in GROUPS),
                *(name for name, _, _ in BANDS),
                "RMSE minus KED's, 95 %",
            ],
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


def _calibration(result: Reproduction) -> list[Paragraph | ReportTable | Picture]:
    facts = result.calibration.summary
    words = {
        "eta": "interface factor",
        "k": "impulse position over half base",
        "s": "scatter scale",
        "gamma": "power of the loss in the scatter",
    }
    rows = [
        [cell(name), cell(words[name]), *(cell(f"{fact[key]:.4f}") for key in ("mean", "sd", "low", "high"))]
        for name, fact in facts.items()
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
