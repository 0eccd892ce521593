"""The report of the inputs as a PDF."""

from functools import partial

from rocking.app.takeaway.asked import Evaluation
from rocking.app.takeaway.drawing import drawn
from rocking.app.takeaway.inputs_file import commands, fingerprint, inputs_as_toml
from rocking.app.takeaway.pictures import figure_of
from rocking.app.takeaway.plain_text import plain_line
from rocking.motions.intensity import Measure
from rocking.plots.traces import fine_samples
from rocking.reports.motion_facts import measures_of
from rocking.reports.render import response_pdf
from rocking.reports.response_document import PICTURES, ReportResults, response_document
from rocking.reports.response_document import ReportSubject as About


def report_of(asked: Evaluation, date: str) -> bytes:
    """Return the report as PDF."""
    moved = asked.inputs.motion is not None
    found = ReportResults(
        asked.impact,
        asked.motion if moved else None,
        _measures(asked) if moved else {},
        asked.responses,
        asked.refused,
        asked.question.assumed_friction,
    )
    inputs, told = asked.inputs, asked.about
    about = About(
        asked.name, date, inputs_as_toml(inputs), [plain_line(each, 2000) for each in commands(inputs)],
        fingerprint(inputs), told["software"],
    )  # fmt: skip
    stems = [stem for stem in PICTURES if moved or stem != "motion"]
    pictures = {stem: drawn(partial(figure_of, stem, asked), "svg") for stem in stems}
    return response_pdf(response_document(about, found), pictures)


def _measures(asked: Evaluation) -> dict[str, Measure]:
    return measures_of(asked.motion, fine_samples(asked.motion))
