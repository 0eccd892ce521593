"""Ground motions in reports: intensity, source and processing steps."""

from collections.abc import Sequence

from rocking.motions.summary import MotionSummary, peak_names, provenance_rows
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
