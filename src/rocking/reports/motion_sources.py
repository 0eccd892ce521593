"""Ground motions in reports: intensity, source and processing steps."""

from collections.abc import Sequence

from rocking.conventions import g, percent
from rocking.motions.summary import MotionSummary, peak_names, provenance_rows
from rocking.prediction import Prediction
from rocking.reports.document import ReportTable, table

_MOST = 200


def motion_sources(found: Sequence[MotionSummary]) -> ReportTable:
    """Return the table of the source and the processing steps of motions."""
    rows = provenance_rows(found)
    note = f"{len(rows) - _MOST} more motions; the JSON output lists all." if len(rows) > _MOST else ""
    return table("", ["motion", "source and processing steps, in order"], rows[:_MOST], note)


def peak_heads(found: Sequence[MotionSummary]) -> list[str]:
    """Return the heads of the columns of peak acceleration and velocity, on the ground or on a floor."""
    acceleration, velocity = peak_names(each.support for each in found)
    return [f"{acceleration} [g]", f"{velocity} [m/s]"]


def motion_table(found: Prediction) -> ReportTable:
    """Return motions with the probabilities under each."""
    rows = [
        (motion.name, f"{motion.peak / g:.3g}", f"{motion.peak_velocity:.3g}", f"{motion.duration:.3g}",
         *(percent(round(float(chance.per_motion[k]), 4)) for chance in found.chances.values()))
        for k, motion in enumerate(found.motions)
    ]  # fmt: skip
    head = ["motion", *peak_heads(found.motions), "duration [s]", *found.chances]
    return table("Probabilities under each motion", head, rows)
