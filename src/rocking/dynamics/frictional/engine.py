"""Reference engine of a body on the vertices of its hull: steps, and event times exact to rounding."""

import math
from dataclasses import replace

from rocking.dynamics.frictional.contact_choice import STRIKES
from rocking.dynamics.frictional.event_functions import MAX_ITERATIONS, EventFunctions
from rocking.dynamics.frictional.ground import (
    ZERO,
    Vector,
    applied,
    frame,
)
from rocking.dynamics.frictional.history import HullEventKind, HullHistory
from rocking.dynamics.frictional.impacts import HullImpacts
from rocking.dynamics.frictional.motion import (
    State,
    StepResult,
    energies,
    point_velocity,
    slip_speed,
    step,
    valued,
)
from rocking.outcome import Status

_PATIENCE = 100.0
_PATH = (1.0 / 12.0, 10.0 / 21.0, 5.0 / 12.0, 1.0 / 42.0)


class HullEngine(HullImpacts):
    """Reference engine of one history.

    >>> from rocking.bodies.solid import Solid, box
    >>> from rocking.dynamics.frictional.body import HullBody
    >>> from rocking.dynamics.frictional.ground import HullGround
    >>> from rocking.dynamics.frictional.motion import standing
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> HullEngine(body, HullGround(slope=0.2)).run(standing(body), 0.1).outcome.value
    'stayed at rest without uplift'
    """

    def run(self, state: State, horizon: float = 0.0, initial_facet: int | None = None) -> HullHistory:
        """Return the history from a state.

        The history ends when the body rests after the motion and the horizon, or at a time limit.

        `initial_facet` is the facet on which the body stood before the tilt, by default the facet under its centre of
        mass.
        """
        self._start(state, horizon, initial_facet)
        if any(point_velocity(self.body, state, i)[2] < -STRIKES * self.speed for i in self._touching()):
            self._impact()
        else:
            self._choose(self._touching())
        self._keep()
        while self.ended is None and not self._over():
            if self._resting:
                self._rest()
            else:
                self._step()
        return self._judged()

    def _over(self) -> bool:
        if self.state.position[2] < -2.0 * self.body.size:
            self.history.fell_off = True
            return True
        if self.time < self.until:
            return False
        if self._resting:
            return True
        self.history.still_rocking = self.time > self.until + _PATIENCE / self.pace
        return self.history.still_rocking

    def _slide(self, result: StepResult, span: float) -> None:
        """Add the path of the vertex with the largest slip.

        The rule over the four stored stages is exact for cubics.
        """
        sliding_vertices = [i for i in self.mode.contact.members if i not in self.mode.contact.stuck]
        paths = [
            sum(w * slip_speed(self.body, s, i) for w, (_, s, _) in zip(_PATH, result.samples, strict=True))
            for i in sliding_vertices
        ]
        self.history.sliding_distance += span * max(paths, default=0.0)

    def _rest(self) -> None:
        """Keep the body at rest to the end of the segment, or until the ground motion moves the body."""
        if self.stretch >= self.ground.motion.count:
            self._hold(self.until)
            return
        end = float(self.ground.motion.times[self.stretch + 1])
        span = end - self.time
        if self.mode.pulled:
            pause = min(1e-3 / self.pace, span)
            self.stretch += pause == span
            self._hold(end if pause == span else self.time + pause)
            self._choose(self._touching())
            return
        coefficients = self.ground.field(self.stretch, self.time, span)
        marks = [1.0] if len(coefficients) < 3 else [k / 8.0 for k in range(1, 9)]
        before = 0.0
        for mark in marks:
            if self._stands(valued(coefficients, mark)) < 0.0:
                low, high = before, mark
                for _ in range(MAX_ITERATIONS):
                    middle = 0.5 * (low + high)
                    low, high = (low, middle) if self._stands(valued(coefficients, middle)) < 0.0 else (middle, high)
                self._hold(self.time + high * span)
                self._event(HullEventKind.UPLIFT, 0.0)
                slips = self._slips(valued(coefficients, high)) < 0.0
                self._choose(self._touching(), self.mode.contact, leaves=not slips)
                return
            before = mark
        self._hold(end)
        self.stretch += 1

    def _hold(self, until: float) -> None:
        self.time = until
        self._keep()

    def _stands(self, pull: Vector) -> float:
        """Return the smallest margin of rest, against tipping over the border or against sliding."""
        axes, points = frame(self.state.attitude), self.body.points
        members = self.mode.contact.members
        margin = min(-pull[2], self._slips(pull))
        for k, i in enumerate(members):
            a, b = applied(axes, points[i]), applied(axes, points[members[(k + 1) % len(members)]])
            x, y = b[0] - a[0], b[1] - a[1]
            size = math.hypot(x, y)
            inward = (-y / size, x / size)
            inside = -(a[0] * inward[0] + a[1] * inward[1])
            tips = -inside * pull[2] - a[2] * (pull[0] * inward[0] + pull[1] * inward[1])  # Eq. 94
            margin = min(margin, tips / self.body.size)
        return margin

    def _slips(self, pull: Vector) -> float:
        """Return the friction margin of a base at rest; negative for sliding."""
        return math.inf if math.isinf(self.friction) else -self.friction * pull[2] - math.hypot(pull[0], pull[1])

    def _step(self) -> None:
        body, start = self.body, self.state
        self.history.steps += 1
        moving = self.stretch < self.ground.motion.count
        remaining = (float(self.ground.motion.times[self.stretch + 1]) if moving else math.inf) - self.time
        span = min(self.length, remaining)
        if span < remaining < 2.0 * span:
            span = 0.5 * remaining
        coefficients = self.ground.field(self.stretch, self.time, span)

        def to(fraction: float) -> StepResult:
            return step(body, start, self.mode, coefficients, (span, fraction), self.pace)

        result = to(1.0)
        if not math.isfinite(result.error):
            self._shorten(span)
            return
        if any(rates.solution is None for _, _, rates in result.samples):
            if span * self.pace > 1e-9:
                self.length = 0.25 * span
            else:
                self._shocked(self._touching())
            return
        fast = max((slip_speed(body, result.state, i) for i in self.mode.starts), default=0.0) / self.slides
        if fast > 2.0 and span * self.pace > 2e-3:
            # the direction of a vertex that starts to slide is constant
            self.length = span * max(1.5 / fast, 0.1)
            return
        growth = 0.9 * (self.settings.tolerance / max(result.error, 1e-300)) ** 0.2
        if result.error > self.settings.tolerance and span * self.pace > 1e-10:
            self.length = span * max(0.1, growth)
            return
        self._pace_on(span, growth, cut=span == remaining)
        fraction, kind = EventFunctions(body, self.ground, self.mode, start, span, self.stop).first(result, to)
        if kind:
            result = to(fraction)
        self._slide(result, fraction * span)
        self.time = self.time + fraction * span
        if not kind and span == remaining:
            self.stretch += 1
            self.time = float(self.ground.motion.times[self.stretch])
        self.state = result.state
        self._settle_on(self.mode.contact)
        self._keep()
        self._end(kind)

    def _shorten(self, span: float) -> None:
        """Retry with a tenth of the step, because a stage has overflowed.

        Forces of a large friction may cause an overflow.
        """
        self.length = 0.1 * span
        if span * self.pace <= 1e-10:
            self.ended = Status.NOT_FINITE

    def _pace_on(self, span: float, growth: float, *, cut: bool) -> None:
        """Set the length of the next step. `cut` is True if a sample of the motion ended this step."""
        base = max(span, self.length if cut else 0.0) if growth > 1.0 else span
        self.length = min(base * min(max(growth, 0.3), 4.0), 0.2 / self.pace)

    def _end(self, kind: str) -> None:
        """Handle the end of a step: the event of a kind ends the mode, or the mode continues."""
        if any(self._slip(i) > self.slides for i in self.mode.starts):
            slow = {i: d for i, d in self.mode.starts.items() if self._slip(i) <= self.slides}
            self.mode = replace(self.mode, starts=slow)
        if kind == "gap":
            self._impact()
        elif kind:
            self._event(HullEventKind.CHANGE, energies(self.body, self.state, ZERO)[0])
            exclude = self.mode.contact if kind != "slip" else None
            self._choose(self._touching(), exclude, leaves=kind in ("normal", "shelf"))
            self._keep()
        elif self.mode.pulled:
            self._choose(self._touching())
