"""End of a contact within a step: event functions and their zeros."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import HullGround, added, applied, dot, frame, length
from rocking.dynamics.frictional.motion import HullMode, Rates, State, StepResult, gap, point_velocity, slip_direction

CLOSED, _GRAZED = 1e-11, 1e-14  # gaps / size: limit for simultaneous landings, and limit for one landing
_FORCE = 1e-11  # acceleration / gravity below which a force counts as zero
_SLIP = 5e-6
MAX_ITERATIONS = 80


def stops_at(tolerance: float) -> float:
    """Return the speed / sqrt(g size) at which sliding stops. A slower vertex may stick.

    The square of this speed is the energy loss of a stop / (m g size).

    >>> stops_at(1e-12), stops_at(1e-6)
    (5e-06, 0.001)
    """
    return max(_SLIP, math.sqrt(tolerance))


Step = Callable[[float], StepResult]
"""Function from a fraction of a step to the result of the step up to this fraction."""


@dataclass(frozen=True)
class EventFunctions:
    """Functions that are positive as long as a contact lasts: heights, normal forces, friction margin, slip."""

    body: HullBody
    ground: HullGround
    mode: HullMode
    start: State
    span: float  # duration of the step [s]
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
        """Return the first zero as a fraction of the step, and the kind of its function."""
        fraction, event_kind = 1.0, ""
        for _, low, high, kind, i in sorted(self._sign_changes(result, to)):
            # stages are approximate, so that a negative value at a stage may belong to a slightly later zero
            for end in (min(high, fraction), fraction):
                if self._at(kind, i, to(end)) < 0.0:
                    fraction, event_kind = self._located(kind, i, (min(low, end), end), to), kind
                    break
        return fraction, event_kind

    def _sign_changes(self, result: StepResult, to: Step) -> Iterator[tuple[float, float, float, str, int]]:
        """Yield functions that become negative between samples: estimated zero, bracket, kind and vertex."""
        nodes = [node for node, _, _ in result.samples]
        for kind, i in self._functions(result):
            values = [self._value(kind, i, state, rates) for _, state, rates in result.samples]
            if values[0] < 0.0:
                # a vertex just after its release is on the ground within rounding
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
        """Return the zero of a function that is negative at the end of a bracket, by regula falsi (Illinois)."""
        low, high = bracket
        sizes = {"gap": 0.5 * _GRAZED * self.body.size, "shelf": CLOSED * self.body.size}
        close = sizes.get(kind, 1e-3 * self.stop if kind == "slip" else self.slack)
        at_low, at_high = self._at(kind, i, to(low)), self._at(kind, i, to(high))
        if at_low < 0.0 < low:
            low, high, at_high = 0.0, low, at_low
            at_low = self._at(kind, i, to(low))
        if at_low <= 0.0:
            # just after release: find a time with a positive gap
            for k in range(1, 20):
                value = self._at(kind, i, to(bracket[1] * 0.5**k))
                if value > 0.0:
                    low, at_low = bracket[1] * 0.5**k, value
                    break
                high, at_high = bracket[1] * 0.5**k, value
        at_low = max(at_low, 0.0)
        side = 0
        for _ in range(MAX_ITERATIONS):
            if at_high >= -close or high - low <= 1e-15:
                break
            # the target value is slightly below zero
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
        sliding = [i for i in contact.members if i not in contact.stuck]
        watched += [("slip", i) for i in sliding]
        watched += [("shelf", i) for i in sliding if self.ground.shelf is not None]
        initial, final = result.samples[0][1], result.state
        fastest = max(length(s.velocity) + body.size * length(s.spin) for s in (initial, final))
        reach = fastest * self.span
        up, high = frame(initial.attitude)[2], initial.position[2]
        up_after, high_after = frame(final.attitude)[2], final.position[2]
        for i, p in enumerate(body.points):
            if i not in contact.members and min(high + dot(up, p), high_after + dot(up_after, p)) < reach:
                watched.append(("gap", i))
        return watched

    def _value(self, kind: str, i: int, state: State, rates: Rates) -> float:
        """Return the value of an event function: a height, an acceleration or a speed."""
        if kind == "gap":
            height = gap(self.body, state, i) + _GRAZED * self.body.size
            position = added(state.position, 1.0, applied(frame(state.attitude), self.body.points[i]))
            return height if self.ground.under(position) or height > 0.0 else math.inf
        if kind == "shelf":
            return self.ground.inside(added(state.position, 1.0, applied(frame(state.attitude), self.body.points[i])))
        if rates.solution is None:
            return -1.0
        if kind == "normal":
            return rates.solution.normals[i] / self.body.mass + self.slack
        if kind == "stick":
            free = self.mode.friction * rates.solution.normals[i] - length(rates.solution.pulls[i])
            return free / self.body.mass + self.slack * (1.0 + self.mode.friction)
        speed = dot(slip_direction(self.body, self.start, self.mode, i), point_velocity(self.body, state, i))
        return speed + (2.0 if i in self.mode.starts else -1.0) * self.stop

    def _at(self, kind: str, i: int, result: StepResult) -> float:
        return self._value(kind, i, result.state, result.samples[-1][2])

    def _dip(self, i: int, result: StepResult, values: list[float]) -> float | None:
        """Return the fraction of the step at the minimum of a gap, from its rates at both ends; None without one."""
        (_, initial, _), (_, final, _) = result.samples[0], result.samples[-1]
        a, b = point_velocity(self.body, initial, i)[2], point_velocity(self.body, final, i)[2]
        return a / (a - b) if a < 0.0 < b and min(values) < self.body.size * 1e-3 else None
