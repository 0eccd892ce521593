"""When a contact ends within a step: what must stay above zero, and where it falls below."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.ground import HullGround, added, applied, dot, frame, length
from rocking.dynamics.hull.motion import HullMode, Rates, State, StepResult, gap, point_velocity, slip_direction

CLOSED, _GRAZED = 1e-11, 1e-14  # gaps over the size: of vertices that land together, and at which one lands
_FORCE = 1e-11  # acceleration over gravity below which a force counts as zero
_SLIP = 5e-6
HALVINGS = 80


def stops_at(tolerance: float) -> float:
    """Return the speed over sqrt(g size) at which sliding stops, and below which a vertex may stick.

    Its square is what a stop costs over m g size.

    >>> stops_at(1e-12), stops_at(1e-6)
    (5e-06, 0.001)
    """
    return max(_SLIP, math.sqrt(tolerance))


Step = Callable[[float], StepResult]
"""The step up to a part of it."""


@dataclass(frozen=True)
class EventFunctions:
    """What must stay above zero while a contact lasts: heights, normal forces, friction left over, slip."""

    body: HullBody
    ground: HullGround
    mode: HullMode
    start: State
    span: float  # of the whole step [s]
    stop: float  # speed at which sliding stops [m/s]

    @property
    def speed(self) -> float:
        """Return sqrt(g size)."""
        return self.ground.gravity / math.sqrt(self.ground.gravity / self.body.size)

    @property
    def slack(self) -> float:
        """Return the acceleration below which a force counts as zero."""
        return _FORCE * self.ground.gravity

    def first(self, result: StepResult, to: Step) -> tuple[float, str]:
        """Return when the first margin falls below zero: part of the step, kind of the margin."""
        part, first = 1.0, ""
        for _, low, high, kind, i in sorted(self._fallen(result, to)):
            # stages lie beside the motion: what is below zero there may fall a little later
            for end in (min(high, part), part):
                if self._at(kind, i, to(end)) < 0.0:
                    part, first = self._located(kind, i, (min(low, end), end), to), kind
                    break
        return part, first

    def _fallen(self, result: StepResult, to: Step) -> Iterator[tuple[float, float, float, str, int]]:
        """Yield margins that fall below zero between samples: about where, the bracket, kind and vertex."""
        nodes = [node for node, _, _ in result.samples]
        for kind, i in self._functions(result):
            values = [self._value(kind, i, state, rates) for _, state, rates in result.samples]
            if values[0] < 0.0:
                # a vertex that has just left is on the ground but for rounding
                rises = point_velocity(self.body, self.start, i)[2] >= -1e-12 * self.speed
                if kind != "gap" or not rises:
                    yield 0.0, 0.0, 0.0, kind, i
                    continue
                values[0] = 0.0
            below = next((k for k, value in enumerate(values) if value < 0.0), 0)
            dip = self._dip(i, result, values) if kind == "gap" and not below else None
            if below:
                a, b, low, high = values[below - 1], values[below], nodes[below - 1], nodes[below]
                yield low + (high - low) * a / (a - b), low, high, kind, i
            elif dip is not None and self._at("gap", i, to(dip)) < 0.0:
                yield 0.9 * dip, 0.0, dip, kind, i

    def _located(self, kind: str, i: int, bracket: tuple[float, float], to: Step) -> float:
        """Return the zero of a margin that is below zero at the end of a bracket, by regula falsi (Illinois)."""
        low, high = bracket
        sizes = {"gap": 0.5 * _GRAZED * self.body.size, "shelf": CLOSED * self.body.size}
        close = sizes.get(kind, 1e-3 * self.stop if kind == "slip" else self.slack)
        at_low, at_high = self._at(kind, i, to(low)), self._at(kind, i, to(high))
        if at_low < 0.0 < low:
            low, high, at_high = 0.0, low, at_low
            at_low = self._at(kind, i, to(low))
        if at_low <= 0.0:
            # it has just left: where is it above the ground?
            for k in range(1, 20):
                value = self._at(kind, i, to(bracket[1] * 0.5**k))
                if value > 0.0:
                    low, at_low = bracket[1] * 0.5**k, value
                    break
                high, at_high = bracket[1] * 0.5**k, value
        at_low = max(at_low, 0.0)
        side = 0
        for _ in range(HALVINGS):
            if at_high >= -close or high - low <= 1e-15:
                break
            # aims a little below zero
            middle = low + (high - low) * (at_low + 0.5 * close) / (at_low - at_high)
            middle = middle if low < middle < high else 0.5 * (low + high)
            value = self._at(kind, i, to(middle))
            if value < 0.0:
                high, at_high, at_low = middle, value, at_low * (0.5 if side < 0 else 1.0)
                side = -1
            else:
                low, at_low, at_high = middle, value, at_high * (0.5 if side > 0 else 1.0)
                side = 1
        return high

    def _functions(self, result: StepResult) -> list[tuple[str, int]]:
        contact, body = self.mode.contact, self.body
        watched = [("normal", i) for i in contact.members if not self.mode.pulled]
        if not math.isinf(self.mode.friction) and not self.mode.pulled:
            watched += [("stick", i) for i in contact.stuck]
        loose = [i for i in contact.members if i not in contact.stuck]
        watched += [("slip", i) for i in loose]
        watched += [("shelf", i) for i in loose if self.ground.shelf is not None]
        one, two = result.samples[0][1], result.state
        fastest = max(length(s.velocity) + body.size * length(s.spin) for s in (one, two))
        reach = fastest * self.span
        up, high = frame(one.attitude)[2], one.place[2]
        after, later = frame(two.attitude)[2], two.place[2]
        for i, p in enumerate(body.points):
            if i not in contact.members and min(high + dot(up, p), later + dot(after, p)) < reach:
                watched.append(("gap", i))
        return watched

    def _value(self, kind: str, i: int, state: State, rates: Rates) -> float:
        """Return what must not fall below zero: a height, an acceleration or a speed."""
        if kind == "gap":
            height = gap(self.body, state, i) + _GRAZED * self.body.size
            place = added(state.place, 1.0, applied(frame(state.attitude), self.body.points[i]))
            return height if self.ground.under(place) or height > 0.0 else math.inf
        if kind == "shelf":
            return self.ground.inside(added(state.place, 1.0, applied(frame(state.attitude), self.body.points[i])))
        if rates.found is None:
            return -1.0
        if kind == "normal":
            return rates.found.normals[i] / self.body.mass + self.slack
        if kind == "stick":
            free = self.mode.friction * rates.found.normals[i] - length(rates.found.pulls[i])
            return free / self.body.mass + self.slack * (1.0 + self.mode.friction)
        speed = dot(slip_direction(self.body, self.start, self.mode, i), point_velocity(self.body, state, i))
        return speed + (2.0 if i in self.mode.starts else -1.0) * self.stop

    def _at(self, kind: str, i: int, result: StepResult) -> float:
        return self._value(kind, i, result.state, result.samples[-1][2])

    def _dip(self, i: int, result: StepResult, values: list[float]) -> float | None:
        """Return where a gap is least within a step, by its values and rates at the ends; None where it is not."""
        (_, one, _), (_, two, _) = result.samples[0], result.samples[-1]
        a, b = point_velocity(self.body, one, i)[2], point_velocity(self.body, two, i)[2]
        return a / (a - b) if a < 0.0 < b and min(values) < self.body.size * 1e-3 else None
