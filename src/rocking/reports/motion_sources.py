"""Ground motions in reports: intensity, source and processing steps."""

from collections.abc import Sequence

from rocking.motions.summary import GROUND, MotionSummary, peak_name, provenance_rows
from rocking.reports.document import ReportTable, table

_MOST = 200


def motion_sources(found: Sequence[MotionSummary]) -> ReportTable:
    """Return the table of the source and the processing steps of motions."""
    rows = provenance_rows(found)
    note = f"{len(rows) - _MOST} more motions; the JSON output lists all." if len(rows) > _MOST else ""
    return table("", ["motion", "source and processing steps, in order"], rows[:_MOST], note)


def peak_heads(found: Sequence[MotionSummary]) -> list[str]:
    """Return the heads of the columns of peak acceleration and velocity, on the ground or on a floor."""
    supports = {each.support for each in found}
    on_floors = GROUND not in supports
    support = next(iter(supports)) if on_floors else GROUND
    mixed = not on_floors and len(supports) > 1
    names = [peak_name(support, quantity) + ("/PF" + quantity if mixed else "") for quantity in "AV"]
    return [f"{names[0]} [g]", f"{names[1]} [m/s]"]
