"""The report of a prediction: what will become of the body, what decides it, and what was assumed."""

from pathlib import Path

from rocking.conventions import percent
from rocking.errors import InvalidValueError
from rocking.plots.prediction import prediction_picture
from rocking.prediction import Prediction
from rocking.reports.document import Document, Paragraph, Picture, ReportSection, ReportTable, table
from rocking.reports.render import write_report
from rocking.tables import target_of
from rocking.version import SOFTWARE

_MARKS = ((0.05, "good"), (0.5, "fair"))
_METHOD = (
    "Bodies that may be the one in question are drawn from what is known of it, each is followed under every motion, "
    "and those that overturn are counted. Intervals are of 95 %."
)


def prediction_report(found: Prediction, path: str | Path, *, name: str = "", date: str = "") -> Path:
    """Write the report of a prediction: verdict, picture, probabilities, what decides them, and what was assumed.

    Parameters
    ----------
    found : Prediction
        Of `rocking.prediction.predict`.
    path : str or Path
        A document (.pdf), or a web page of one file (.html).
    name : str
        What the body is called.
    date : str
        Day of the report, as it should be printed.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If it is no prediction, or the ending of the path is another.
    MissingExtraError
        If matplotlib, and typst (.pdf) or jinja2 (.html), are not installed.
    """
    known: object = found
    if not isinstance(known, Prediction):
        raise InvalidValueError(f"found must be a Prediction, got {found!r:.60}")
    target = target_of(path)
    write_report(prediction_document(found, name, date), {"prediction": lambda: prediction_picture(found)}, target)
    return target


def prediction_document(found: Prediction, name: str, date: str) -> Document:
    """Return the content of the report."""
    chance = found.chances["overturning"]
    mark = next((word for most, word in _MARKS if chance.high <= most), "bad")
    picture = Picture(
        "prediction", "How likely it overturns and rocks under each motion, and what decides whether it does"
    )
    sections = [
        ReportSection("What will become of it", [*map(Paragraph, found.sentences[1:]), picture, _motions(found)]),
        *([ReportSection("What decides it", [_shares(found)])] if found.shares else []),
        ReportSection("What is known, and what was assumed", [_inputs(found), *map(Paragraph, found.assumed)]),
        ReportSection("How it was computed", [Paragraph(_METHOD), Paragraph(_count(found))]),
    ]
    several = f"{len(found.motions)} motion{'' if len(found.motions) == 1 else 's'}"
    subtitle = f"Under {several}" + (f". {date}" if date else "")
    verdict = [Paragraph(found.verdict, "", mark)]
    return Document(name or "A body in an earthquake", subtitle, sections, verdict=verdict, footer=SOFTWARE)


def _motions(found: Prediction) -> ReportTable:
    rows = [
        (name, *(percent(float(chance.per_motion[k])) for chance in found.chances.values()))
        for k, name in enumerate(found.motions)
    ]
    return table("Probabilities under each motion", ["motion", *found.chances], rows)


def _shares(found: Prediction) -> ReportTable:
    rows = [
        (
            "motion" if name == "case" else name,
            f"{s.first:.2f}",
            f"{s.total:.2f}",
            f"{s.total_low:.2f} to {s.total_high:.2f}",
        )
        for name, s in sorted(found.shares.items(), key=lambda pair: -pair[1].total)
    ]
    note = "Sobol indices: shares of the variance of whether it overturns."
    return table("", ["what is not known", "alone [-]", "with the others [-]", "95 %"], rows, note)


def _inputs(found: Prediction) -> ReportTable:
    return table("", ["input", "drawn from"], found.inputs.items())


def _count(found: Prediction) -> str:
    failed = f", {found.failed} without a result" if found.failed else ""
    return f"{found.count} bodies under each motion, {found.histories} histories in all{failed}; seed {found.seed}."
