"""Which mode follows: complementarity of contact forces and motions, all modes tried.

With one pair of feet there are at most nine modes, so that the complementarity problem is solved by trying each; what
Lemke's algorithm would find is among them, and unlike it the trial also sees where there are two solutions or none.
"""

from itertools import chain, combinations
from typing import NamedTuple

from rocking.dynamics.contact.base import ContactState, Mode, PlaneBase, along, away
from rocking.dynamics.contact.event_functions import consistent, event_functions
from rocking.dynamics.contact.mode_series import GroundSeries, ModeSeries, mode_series
from rocking.outcome import Status

TOLERANCE = 1e-12
_LADDER = (TOLERANCE, 1e-10, 1e-8)
_ORDER = 8
_SAME = 1e-6


def candidates(base: PlaneBase, state: ContactState) -> list[Mode]:
    """Return the modes that the velocities allow: most feet first, those that stick before those that slide."""
    resting = [foot for foot in state.touching if away(base, state, foot) == 0.0]
    subsets = chain.from_iterable(combinations(resting, n) for n in range(len(resting), 0, -1))
    found = []
    for feet in subsets:
        speed = along(base, state, feet[0])
        if speed == 0.0:
            found.append(Mode(feet))
        found += [Mode(feet, slip) for slip in (1, -1) if slip * speed >= 0.0]
    return [*found, Mode(())]


class NextMode(NamedTuple):
    """The mode that follows."""

    mode: Mode
    tolerance: float  # below it, over their scale, coefficients counted as zero [-]
    alone: bool = True  # whether no other one is possible that moves the body differently


def choose(base: PlaneBase, state: ContactState, ground: GroundSeries, friction: float) -> NextMode | Status:
    """Return the mode that follows a state, a status if there is none."""
    # of several the first: contacts last, and stick, where they can
    weight = weight_of(ground)
    tried = [(mode, mode_series(base, state, mode, ground, friction, _ORDER)) for mode in candidates(base, state)]
    possible = [(m, c, event_functions(base, m, c, friction, weight)) for m, c in tried if c.stiff > 0.0]
    for tolerance in _LADDER:
        good = [(m, c) for m, c, found in possible if consistent(found, 1.0, tolerance)]  # Eq. 20
        if good:
            same = all(_agree(good[0][1], other, base.size) for _, other in good[1:])
            return NextMode(good[0][0], tolerance, same)
    return Status.NO_CONTACT_FORCE


def weight_of(ground: GroundSeries) -> float:
    """Return the acceleration that contact forces are measured by; |g + a_z| + |a_x|, and at least a little [m/s2]."""
    return max(abs(ground.lift[0]) + abs(ground.push[0]), 1e-3)


def _agree(one: ModeSeries, other: ModeSeries, size: float) -> bool:
    """Whether two modes start alike, as they do where an event function is just zero."""
    gap = max(
        abs(one.rotation[2] - other.rotation[2]) * size, abs(one.x[2] - other.x[2]), abs(one.rise[2] - other.rise[2])
    )
    reach = max(abs(one.rotation[2]) * size, abs(one.x[2]), abs(one.rise[2]), 1e-9 * size)
    return bool(gap <= _SAME * reach or gap <= 1e-9 * size)
