"""Correlations and error zones of both models, data set by data set."""

from rocking.evidence.agreement import concordance, correlation, relative_error, zone
from rocking.evidence.measurements import datasets
from rocking.reports.document import Cell, Paragraph, ReportTable, cell
from rocking.restitution import Housner, Ked

PRINTED_CORRELATION = {"table2": "0.946", "S": "0.998", "M": "0.996", "L": "0.998"}
"""Section 3.2 of the paper."""

_TITLES = {"table2": "Table 2", "S": "Table 3, S", "M": "Table 3, M", "L": "Table 3, L"}
_MODELS = (("Housner", Housner()), ("KED", Ked()))


def error_blocks() -> list[Paragraph | ReportTable]:
    """Return correlations, concordances and zones as report blocks.

    Returns one table of measures, one of relative errors.
    """
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
            [row for name in _TITLES for row in _rows(name)],
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


def _rows(name: str) -> list[list[Cell]]:
    data = datasets()[name]
    errors = [relative_error(model.of_slenderness(data.slenderness), data.coefficient) for _, model in _MODELS]
    found = []
    for i in range(len(data)):
        line = [cell(_TITLES[name]), cell(data.labels[i]), cell(f"{data.slenderness[i]:g}")]
        for error in errors:
            where = zone(error)[i]
            line += [cell(f"{100.0 * float(error[i]):.2f} %"), cell(where, "bad" if where == "III" else "plain")]
        found.append(line)
    return found
