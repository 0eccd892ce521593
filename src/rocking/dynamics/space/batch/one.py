"""One history of the reference engine as a row of a batch."""

import math

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space import attitude
from rocking.dynamics.space.trajectory import SpatialEventKind, SpatialTrajectory
from rocking.outcome import ContactMode, Outcome


def results_of(found: SpatialTrajectory) -> tuple[FloatArray, list[int]]:
    """Return the row of a history.

    Returns results: the floats of a row, in order; NaN without result (shape (9,)).
    """
    last, events = found.pieces[-1], found.events
    failed, over = found.outcome is Outcome.FAILED, found.outcome is Outcome.OVERTURNED
    first = events[0].time if events else math.nan
    spin = math.nan if failed else max(_fastest(found), 0.0)
    direction = float(attitude.azimuth(last.at(np.array([last.until]))[0][0])) if over else math.nan
    lost = sum(event.before - event.after for event in found.impacts)
    results = np.array(
        [found.peak_tilt, found.peak_time, spin, found.overturning_time, direction, first, last.end, found.held, lost]
    )
    contact = found.fell_over
    number = -1 if contact is None or not contact.points else contact.points[0]
    uplifts = sum(event.kind is SpatialEventKind.UPLIFT for event in events)
    status, mode = found.status.code, -1 if contact is None else contact.mode.code
    counts = [found.outcome.code, status, mode, number]
    still = found.outcome is Outcome.ROCKED and last.contact.mode is not ContactMode.REST
    return results, [*counts, len(found.impacts), uplifts, len(events), len(found.pieces), int(still)]


def _fastest(found: SpatialTrajectory) -> float:
    ends = [float(np.linalg.norm(piece.at(np.array([0.0, piece.until]))[1], axis=1).max()) for piece in found.pieces]
    return max(ends, default=0.0)
