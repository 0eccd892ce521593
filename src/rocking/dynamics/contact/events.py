"""Regimes, impacts and positions of a history, as arrays."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import LEFT, RIGHT, PlaneBase
from rocking.dynamics.contact.history import History
from rocking.dynamics.contact.mode import Mode

REGIME = np.dtype(
    [("start", "f8"), ("end", "f8"), ("regime", "U10"), ("feet", "U5"), ("slip", "i1"), ("distance", "f8")]
)
"""Fields of `ContactResponse.regimes`: [s], [s], name of a `Regime`, feet that carry, direction, [m] to the right."""

IMPACT = np.dtype(
    [
        ("time", "f8"), ("feet", "U5"), ("velocity_before", "f8"), ("velocity_after", "f8"), ("normal_left", "f8"),
        ("normal_right", "f8"), ("tangential_left", "f8"), ("tangential_right", "f8"), ("lost", "f8"), ("slips", "?"),
    ]
)  # fmt: skip
"""Fields of `ContactResponse.impacts`: [s], feet that touch, theta' [rad/s] twice, impulses [N s], [J], whether."""


def regimes_of(history: History, base: PlaneBase) -> np.ndarray:
    """Return the regimes of a history in order.

    Returns of type `REGIME`; intervals of no duration are left out.
    """
    changes = history.log.changes
    ends = [*(time for time, _ in changes[1:]), history.end][: len(changes)]
    rows = [
        (start, end, mode.regime.name, mode.carrier, mode.slip, _distance(history, base, mode, start, end))
        for (start, mode), end in zip(changes, ends, strict=True)
        if end > start
    ]
    return np.array(rows, dtype=REGIME)


def _distance(history: History, base: PlaneBase, mode: Mode, start: float, end: float) -> float:
    if not mode.slip:
        return 0.0
    (x_start, _, turned), (x_end, _, turned_on) = places_of(history, np.array([start, end])).tolist()
    foot = mode.feet[0]
    return float(x_end + base.arm(foot, turned_on)[0] - x_start - base.arm(foot, turned)[0])


def impacts_of(history: History, base: PlaneBase) -> np.ndarray:
    """Return the impacts of a history in order.

    Returns of type `IMPACT`. On a flat base only the sum of the impulses along the ground is determined; it is shared
    as the vertical impulses are.
    """
    rows = []
    for blow in history.log.blows:
        normal = {foot: blow.struck.normal.get(foot, 0.0) for foot in (LEFT, RIGHT)}
        total = sum(normal.values())
        part = {foot: blow.struck.tangential * n / total if total else 0.0 for foot, n in normal.items()}
        feet = Mode(tuple(sorted(blow.before.touching))).carrier
        impulses = [base.mass * p for p in (normal[LEFT], normal[RIGHT], part[LEFT], part[RIGHT])]
        lost = base.mass * blow.loss
        rows.append((blow.time, feet, blow.before.spin, blow.after.spin, *impulses, lost, blow.struck.slip != 0))
    return np.array(rows, dtype=IMPACT)


def places_of(history: History, time: FloatArray) -> FloatArray:
    """Return where the body is at some times.

    time: times within it [s]. Returns x [m], rise [m] and theta [rad] along the last axis; at an instant between two
    pieces the later one counts.
    """
    pieces = history.log.pieces
    if not pieces:
        return np.zeros((*time.shape, 3))
    starts = np.array([piece.start for piece in pieces])
    found = np.empty((*time.shape, 3))
    numbers = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(pieces) - 1)
    for place, k in np.ndenumerate(numbers):
        piece = pieces[int(k)]
        at = min(max((float(time[place]) - piece.start) / piece.course.unit, 0.0), piece.at)
        series = (piece.course.x, piece.course.rise, piece.course.rotation)
        found[place] = [np.polynomial.polynomial.polyval(at, c) for c in series]
    return found
