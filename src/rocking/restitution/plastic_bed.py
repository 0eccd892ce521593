"""A body that lands on a bed of plastic springs: its motion while the bed pushes, stretch by stretch of the base."""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from rocking.conventions import FloatArray

# The contact ends exponentially: once the tip is this slow, relative to the start, nothing more happens.
_AT_REST = 1e-14
_STOPPED = 1e-9
_RELATIVE, _ABSOLUTE = 1e-13, 1e-16
_LONGEST = 1e4
_STEPS = 1_000_000

_State = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Landing:
    """How a body leaves a bed."""

    # end of the base that leaves the bed last, or the foot if that is nearer, over the lever of the new foot [-]
    end: float
    velocity: float  # angular velocity then, over the one before; zero where the body stops [-]


def land(kappa: float, back: float, stretches: FloatArray) -> Landing:
    """Return how a body leaves the bed, for levers in units of the new one.

    The state is (v, omega, Int v dt, Int omega dt): a point x of the base descends while omega x > v, and is pushed
    with k_w times its indentation as long. Where the edge v / omega of the pressure passes an end of a stretch, the
    equations have a kink: there the integration stops and begins anew.

    kappa: m b_new^2 / (I_C + m h^2) [-]; back: lever of the old foot [-]; stretches: where the base touches, from the
    old foot (-back) to the new one (1) [-].
    """
    bed = _Bed(kappa, stretches)
    state: _State = (-back, 1.0, 0.0, 0.0)
    part = bed.first_part(-back)
    while True:
        path = _Path(bed, part)
        state = path.follow(state)
        if path.towards == 0:
            return Landing(bed.end, 0.0 if state[1] < _STOPPED else state[1])
        part += path.towards


class _Bed:
    """Force and moment of the springs, by the part of the base in which the pressure ends."""

    def __init__(self, kappa: float, stretches: FloatArray) -> None:
        self.stretches: list[list[float]] = stretches.tolist()
        self.edges = [edge for stretch in self.stretches for edge in stretch]
        self.last = len(self.edges) - 1
        self.end = min(self.edges[-1], 1.0)
        # the stiffness of the bed only scales time: a contact of any size then takes about as long
        self.push = 1.0 / sum(far - near for near, far in self.stretches)
        self.turn = -kappa * self.push

    def whole(self, part: int) -> _State:
        """Return length, first and second moment of the stretches beyond a part."""
        full = self.stretches[(part + 1) // 2 :]
        return tuple(sum((far**n - near**n) / n for near, far in full) for n in (1, 2, 3))

    def first_part(self, edge: float) -> int:
        """Return in which part of the base the pressure ends at first."""
        part = bisect_right(self.edges, edge)
        if part == 0 or self.edges[part - 1] != edge:
            return part
        # it starts on the end of a stretch, and moves to where the first push drives it
        length, first, second = self.whole(part - 1)
        return part if self.push * (first - edge * length) >= edge * self.turn * (second - edge * first) else part - 1


class _Path:
    """The motion as long as the pressure ends in one part of the base."""

    def __init__(self, bed: _Bed, part: int) -> None:
        self._bed = bed
        self._inside = part % 2 == 1
        self._far = bed.edges[part] if self._inside else 0.0
        self._whole = bed.whole(part)
        self._lower = bed.edges[part - 1] if part > 0 else None
        self._upper = bed.edges[part] if part < bed.last else None
        self._kept: list[tuple[float, _State]] = []
        self.towards = 0

    def follow(self, state: _State) -> _State:
        """Return the state where the edge of the pressure leaves the part, or where the contact ends."""
        self._kept = [(0.0, state)]
        last = self._integrated(state, _LONGEST, watched=True)
        if self.towards == 0:
            return last
        return self._at_edge(self._upper if self.towards > 0 else self._lower)

    def _rates(self) -> Callable[[float, FloatArray], _State]:
        push, turn, inside, end = self._bed.push, self._bed.turn, self._inside, self._far
        length, first, second = self._whole

        def rates(_: float, state: FloatArray) -> _State:
            v, omega, y, theta = state.tolist()
            if not inside:
                force, moment = theta * first - y * length, theta * second - y * first
                return force * push, moment * turn, v, omega
            edge = v / omega if omega > 0.0 else end
            reach = end - edge
            lever = first + 0.5 * reach * (end + edge)
            inertia = second + reach * (end * end + end * edge + edge * edge) / 3.0
            return (theta * lever - y * (length + reach)) * push, (theta * inertia - y * lever) * turn, v, omega

        return rates

    def _watch(self, time: float, found: FloatArray) -> Literal[-1, 0]:
        v, omega, *_ = state = tuple(found.tolist())
        if time == 0.0:
            return 0
        self._kept = [*self._kept[-1:], (time, state)]
        if self._upper is not None and v > self._upper * omega:
            self.towards = 1
        elif self._lower is not None and v < self._lower * omega:
            self.towards = -1
        over = omega < _STOPPED or self._bed.end * omega - v <= _AT_REST
        return -1 if self.towards or over else 0

    def _at_edge(self, edge: float | None) -> _State:
        """Return the state at an edge that was passed in the last step."""
        from scipy.optimize import brentq

        (start, before), (stop, _) = self._kept

        def ahead(time: float) -> float:
            v, omega, *_ = self._integrated(before, time - start) if time > start else before
            return v - (edge or 0.0) * omega

        if ahead(start) * ahead(stop) >= 0.0:  # it lies on the edge already, but for rounding
            return before
        time = float(brentq(ahead, start, stop, xtol=1e-15, rtol=1e-14))
        return self._integrated(before, time - start) if time > start else before

    def _integrated(self, state: _State, time: float, *, watched: bool = False) -> _State:
        from scipy.integrate import ode

        run = ode(self._rates()).set_integrator("dop853", rtol=_RELATIVE, atol=_ABSOLUTE, nsteps=_STEPS)
        if watched:
            run.set_solout(self._watch)
        run.set_initial_value(list(state), 0.0)
        return tuple(run.integrate(time).tolist())
