"""Ground motions in reports: intensity, source and processing steps."""

from collections.abc import Sequence
from dataclasses import replace

from rocking.answers import Display
from rocking.decision.prediction import Prediction
from rocking.motions.summary import MotionSummary, peak_names, provenance_rows
from rocking.quantities import QUANTITIES, Quantity, closely
from rocking.reports.document import Paragraph, ReportTable, answer_table, table

_MOST, _MOST_DOUBTS = 200, 8


def motion_sources(motions: Sequence[MotionSummary]) -> ReportTable:
    """Return the table of sources and processing steps of motions."""
    rows = provenance_rows(motions)
    note = f"{len(rows) - _MOST} more motions; the JSON output lists all." if len(rows) > _MOST else ""
    return table("", ["motion", "source and processing steps, in order"], rows[:_MOST], note)


def motion_doubts(motions: Sequence[MotionSummary]) -> list[Paragraph]:
    """Return the warnings about motions as paragraphs."""
    doubts = [(motion.name, doubt) for motion in motions for doubt in motion.doubts]
    shown = [Paragraph(f"{name}: {doubt}.", "Check the input:", "fair") for name, doubt in doubts[:_MOST_DOUBTS]]
    left = len(doubts) - len(shown)
    return [*shown, *([Paragraph(f"{left} more warnings about motions; the JSON output lists all.")] if left else [])]


def peak_display(motions: Sequence[MotionSummary], **own: Quantity) -> Display:
    """Return the display of peaks of ground or floor motions in g, with quantities of this table only."""
    labels = zip(("pga", "pgv"), peak_names(motion.support for motion in motions), strict=True)
    peaks = {name: replace(QUANTITIES[name], label=label, digits=".3g") for name, label in labels}
    return Display(acceleration="g", own=peaks | own)


def motion_table(prediction: Prediction) -> ReportTable:
    """Return the table of motions with the probabilities under every motion."""
    rows = [
        {
            "motion": motion.name, "pga": motion.peak, "pgv": motion.peak_velocity, "duration": motion.duration,
            **{name: float(chance.per_motion[k]) for name, chance in prediction.chances.items()},
        }
        for k, motion in enumerate(prediction.motions)
    ]  # fmt: skip
    chances = {name: replace(QUANTITIES["per_motion"], name=name) for name in prediction.chances}
    display = peak_display(prediction.motions, duration=closely(duration=".3g")["duration"], **chances)
    return answer_table("Probabilities under each motion", rows, display=display)
