"""The reference engine: Taylor steps of variable order and length, and event times exact to rounding.

The reference engine computes one history at a time. It has no code in common with the fast engine, so that the two
engines verify each other. The order is up to 30, and the size of the last terms determines the length of a step.
Newton's method locates zeros between the zeros of the slope.
"""

import math
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.equations import Event, EventKind, Trajectory
from rocking.dynamics.plane.event_functions import NOTHING, Push, RestoringMoments, comes_to_rest
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.taylor import first_fall, last_fall, series, shifted, slope, turning_points, value
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

_ORDER = 30
_STRETCH_END = 1.0 - 1e-13


class _Ended(NamedTuple):
    outcome: Outcome
    status: Status = Status.GOOD


class Reference:
    """Reference engine of one history."""

    def __init__(
        self,
        parameters: RockingParameters,
        segments: Segments,
        settings: PlaneSettings,
        *,
        scale: float = 1.0,
        stream: int = 0,
        to_the_ground: bool = True,
    ) -> None:
        over_g = scale / settings.gravity
        vertical = np.zeros_like(segments.horizontal) if segments.vertical is None else segments.vertical
        if not (np.isfinite(segments.horizontal).all() and np.isfinite(vertical).all()):
            raise InvalidValueError(
                "ground accelerations must be finite [m/s2], got NaN or infinity; check the record for gaps"
            )
        self.push = Push(segments.step, segments.horizontal * over_g, vertical * over_g)
        self.parameters, self.settings, self.stream, self.to_the_ground = parameters, settings, stream, to_the_ground
        self.ground = RestoringMoments(parameters, self.push, linear=settings.linear)
        self.count = segments.count
        self.rotations = np.zeros(self.count + 1)
        self.velocities = np.zeros(self.count + 1)
        self.events: list[Event] = []
        self.side, self.u, self.rate = 0, 0.0, 0.0  # u = alpha - |theta| and its rate [rad/s]
        self.stretch, self.tau = 0, 0.0
        self.impacts = self.uplifts = 0
        self.peak, self.peak_time, self.fastest, self.truncation = 0.0, 0.0, 0.0, 0.0
        self.forces = self.forces_before = (math.inf, 0.0)  # smallest normal force / (m g), largest friction demand
        self.over_time = math.nan

        def extreme_to_end(extreme: FloatArray, reduce: np.ufunc) -> FloatArray:
            return np.append(reduce.accumulate(extreme[::-1])[::-1], 0.0)

        # from every segment to the end: largest push in both directions, and smallest gravity
        h, v = self.push.horizontal, self.push.vertical
        self.later_high = extreme_to_end(np.maximum(h[:, 0] + np.maximum(h[:, 1:], 0.0).sum(axis=1), 0.0), np.maximum)
        self.later_low = extreme_to_end(np.minimum(h[:, 0] + np.minimum(h[:, 1:], 0.0).sum(axis=1), 0.0), np.minimum)
        self.later_light = extreme_to_end(np.minimum(v[:, 0] + np.minimum(v[:, 1:], 0.0).sum(axis=1), 0.0), np.minimum)

    # ---- the course of a history ------------------------------------------------------------------------------------

    def run(self, rotation: float = 0.0, velocity: float = 0.0) -> Trajectory:
        """Return the history from theta [rad] and theta' [rad/s] at time zero."""
        self.rotations[0], self.velocities[0] = rotation, velocity
        ended = self._start(rotation, velocity)
        while ended is None:
            ended = self._step()
        return self._trajectory(ended)

    def _start(self, rotation: float, velocity: float) -> _Ended | None:
        turned = self.parameters.side(1 if rotation > 0.0 else -1).slenderness_angle
        upright = turned - abs(rotation) == turned  # rotation below the rounding of alpha
        self.side = 1 if rotation > 0.0 or (rotation == 0.0 and velocity > 0.0) else -1
        if upright and abs(velocity) <= NOTHING * self._p * self._alpha:
            return self._rest()
        self.u, self.rate = self._alpha - abs(rotation), -self.side * velocity
        self._raise_peak(abs(rotation), 0.0)
        if self.u < 0.0:  # the body starts beyond the top
            self._note_force(self.u, self.rate, *self._ground_at(0, 0.0))
            self.over_time, self.forces_before = 0.0, self.forces
        self.uplifts = 1
        self.events.append(Event(0.0, EventKind.UPLIFT, self.side))
        return self._impact(self.rate, 0.0) if upright and self.rate > 0.0 else None

    def _step(self) -> _Ended | None:
        """Advance to the end of the segment, or to an earlier event."""
        remaining = (1.0 - self.tau) * self.push.step
        push = shifted(self.push.horizontal[self.stretch].tolist(), self.tau, 1.0 - self.tau)
        weight = shifted(self.push.vertical[self.stretch].tolist(), self.tau, 1.0 - self.tau)
        push = [self.side * c for c in push]
        weight[0] += 1.0
        self._note_force(self.u, self.rate, push[0], weight[0])
        kappa = (self._p * remaining) ** 2
        linear = self.settings.linear
        terms = series(self.u, self.rate * remaining, kappa, push, weight, _ORDER, linear=linear)  # Eq. 14
        fraction = self._trusted_part(terms)
        if not fraction > 0.0:
            return _Ended(Outcome.FAILED, Status.NOT_FINITE)
        scaled = [c * fraction**k for k, c in enumerate(terms)]
        self.truncation += abs(scaled[-1]) + abs(scaled[-2])
        length = remaining * fraction
        gap = [self._alpha - self.u, *(-c for c in scaled[1:])]
        contact = self._contact(gap)
        if gap[0] + sum(max(c, 0.0) for c in gap[1:]) > abs(self.peak):
            for turn in turning_points(gap, 1.0 if contact is None else contact):
                self._raise_peak(value(gap, turn), self._now + turn * length)
        if contact is not None:
            return self._impact(-slope(gap, contact) / length, self.tau + contact * fraction * (1.0 - self.tau))
        return self._advance(scaled, length, 1.0 if fraction == 1.0 else self.tau + fraction * (1.0 - self.tau))

    def _trusted_part(self, terms: list[float]) -> float:
        """Return the fraction of the step over which the last terms are below the tolerance."""
        if not all(map(math.isfinite, terms)):
            return 0.0
        if len(terms) <= _ORDER:
            return 1.0
        bound = self.settings.tolerance * max(self._alpha, abs(self.u))
        fraction = 1.0
        for k in (len(terms) - 2, len(terms) - 1):
            if abs(terms[k]) > bound:
                fraction = min(fraction, (bound / abs(terms[k])) ** (1.0 / k))  # Eq. 52
        return fraction

    def _contact(self, gap: list[float]) -> float | None:
        """Return the next zero of |theta| within the step, excluding a zero at the start of the step."""
        if gap[0] > 0.0:
            return first_fall(gap)
        if gap[1] < 0.0:  # the last step ended on the ground, within rounding
            return 0.0
        if gap[1] > 0.0:
            return first_fall(gap[1:])
        tail = gap[2:]
        tail[0] = max(tail[0], 0.0)  # just after uplift, only rounding can make this value negative
        if tail[0] > 0.0:
            return first_fall(tail)
        return first_fall(tail[1:]) if tail[1] > 0.0 else None

    def _impact(self, speed: float, tau: float) -> _Ended | None:
        speed = max(speed, 0.0)
        time = (self.stretch + tau) * self.push.step
        self.fastest = max(self.fastest, speed)
        self._note_force(self._alpha, speed, *self._ground_at(self.stretch, tau))
        old, self.side = self.side, -self.side
        r = self.parameters.coefficient(self.side, speed, self.stream, self.impacts)
        after = r * speed  # Eq. 28
        self.impacts += 1
        self.events.append(Event(time, EventKind.IMPACT, self.side, -old * speed, -old * after, r))
        self.u, self.rate = self._alpha, -after
        self._move(tau)
        if self.impacts >= self.settings.most_events:
            return _Ended(Outcome.FAILED, Status.TOO_MANY_EVENTS)
        if self.stretch >= self.count:
            return self._conclude()
        args = (self.side, after, self.stretch, self.tau, self.settings.rest_speed)
        if comes_to_rest(self.parameters, self.ground, *args):
            self.events.append(Event(time, EventKind.REST, self.side))
            return self._rest()
        return None

    def _advance(self, terms: list[float], length: float, tau: float) -> _Ended | None:
        start, end = self.u, value(terms, 1.0)
        passing = last_fall(terms) if end < 0.0 else None
        if passing is not None or start >= 0.0 > end:
            at = (passing or 0.0) * length
            ground = self._ground_at(self.stretch, self.tau + at / self.push.step)
            self._note_force(0.0, slope(terms, passing or 0.0) / length, *ground)
            self.over_time, self.forces_before = self._now + at, self.forces
        self.u, self.rate = end, slope(terms, 1.0) / length
        self.fastest = max(self.fastest, abs(self.rate))
        if tau >= _STRETCH_END:  # a jump to rest may follow
            self._note_force(self.u, self.rate, *self._ground_at(self.stretch, 1.0))
        self._move(tau)
        if end < 0.0:
            gone = self._beyond_return()
            lies = self._alpha - end >= 0.5 * math.pi and (gone or not self.settings.linear)
            if lies or (gone and not self.to_the_ground):
                return _Ended(Outcome.OVERTURNED)
        return self._conclude() if self.stretch >= self.count else None

    def _rest(self) -> _Ended | None:
        """Keep the body at rest until the next uplift, or to the end."""
        uplift = self.ground.next_uplift(self.stretch, self.tau) if self.stretch < self.count else None
        rested = 1.0 + self.push.vertical[self.stretch : self.count if uplift is None else uplift[0]]
        min_force = min(rested[:, 0].min(initial=0.0), (rested.sum(axis=1) - rested.shape[1] + 1.0).min(initial=0.0))
        if min_force < 0.0:  # without horizontal push, the body stays at rest although the force is tensile
            self.forces = min(self.forces[0], float(min_force)), math.inf
        calm = _Ended(Outcome.ROCKED if self.uplifts or self.impacts else Outcome.NO_UPLIFT)
        if uplift is None:
            self.side = 0
            return calm
        self.stretch, tau, self.side = uplift
        self.u, self.rate = self._alpha, 0.0
        self._move(tau)
        if self.stretch >= self.count:
            return calm
        self.uplifts += 1
        self.events.append(Event(self._now, EventKind.UPLIFT, self.side))
        return None

    def _conclude(self) -> _Ended:
        """Return the outcome after the motion from the energy."""
        linear = self.settings.linear
        self._note_force(self.u, self.rate, *self._ground_at(self.count - 1, 1.0))
        self._raise_peak(self._alpha - self.u, self._now)
        top = float(equations.energy_at_top(self._alpha, linear=linear))
        e = float(equations.energy(self._alpha - self.u, self.rate, self._alpha, self._p, linear=linear))
        inward, passes = self.rate > 0.0, e > top
        if self.u < 0.0 and not (inward and passes):
            if not self.over_time >= 0.0:
                self.over_time, self.forces_before = self._now, self.forces
            return _Ended(Outcome.OVERTURNED)
        if not inward:
            if passes:  # on ground at rest, the force increases up to the top, unless the force is tensile or q < 0.3
                self._note_force(self.u, self.rate, 0.0, 1.0)
                self.over_time, self.forces_before = self._now, self.forces
                return _Ended(Outcome.OVERTURNED)
            self._raise_peak(float(equations.turning_rotation(e, self._alpha, linear=linear)), self._now)
        speed, impacts = self._p * math.sqrt(2.0 * max(e, 0.0)), self.impacts
        self.fastest = max(self.fastest, speed)
        for _ in range(2):
            self._note_force(self._alpha, speed, 0.0, 1.0)
            self.side = -self.side
            speed *= self.parameters.coefficient(self.side, speed, self.stream, self.impacts)
            self.impacts += 1
            e = 0.5 * (speed / self._p) ** 2
            self._note_force(self._alpha, speed, 0.0, 1.0)
            if e > float(equations.energy_at_top(self._alpha, linear=linear)):
                self.over_time, self.forces_before = self._now, self.forces
                return _Ended(Outcome.OVERTURNED)
            self._raise_peak(float(equations.turning_rotation(e, self._alpha, linear=linear)), self._now)
        self.impacts = impacts
        return _Ended(Outcome.ROCKED)

    # ---- details --------------------------------------------------------------------------------------------------

    @property
    def _alpha(self) -> float:
        return self.parameters.side(self.side).slenderness_angle

    @property
    def _p(self) -> float:
        return self.parameters.side(self.side).frequency_parameter

    @property
    def _now(self) -> float:
        return (self.stretch + self.tau) * self.push.step

    def _ground_at(self, stretch: int, tau: float) -> tuple[float, float]:
        """Return the push towards the foot in contact, and the effective weight, both divided by gravity [-]."""
        push = value(self.push.horizontal[stretch].tolist(), tau)
        lift = value(self.push.vertical[stretch].tolist(), tau)
        return self.side * push, 1.0 + lift

    def _note_force(self, u: float, rate: float, push: float, weight: float) -> None:
        """Update the extremes of force / weight: (1 + a_z / g) + z'' / g upwards, a_x / g + x'' / g horizontal."""
        sine, cosine = math.sin(u), math.cos(u)
        moment = weight * u + push if self.settings.linear else weight * sine + push * cosine  # u'' / p^2
        inertia_ratio, spin = self.parameters.side(self.side).inertia_ratio, rate / self._p
        spin *= spin  # `**` would raise an error if the result is infinite
        up = weight - inertia_ratio * (moment * sine + spin * cosine)  # Eq. 33
        along = push - inertia_ratio * (moment * cosine - spin * sine)  # Eq. 34
        min_force, demand = self.forces
        self.forces = min(min_force, up), max(demand, abs(along) / up) if up > 0.0 else math.inf  # Eq. 35

    def _move(self, tau: float) -> None:
        if tau < _STRETCH_END:
            self.tau = tau
            return
        self.stretch, self.tau = self.stretch + 1, 0.0
        self.rotations[self.stretch] = self.side * (self._alpha - self.u)
        self.velocities[self.stretch] = -self.side * self.rate

    def _raise_peak(self, size: float, time: float) -> None:
        if size > abs(self.peak):
            self.peak, self.peak_time = self.side * size, time

    def _beyond_return(self) -> bool:
        if self.rate > 0.0:
            return False
        back = max(self.side * self.later_high[self.stretch], self.side * self.later_low[self.stretch])
        weight = 1.0 + self.later_light[self.stretch]
        if self.settings.linear:
            return bool(weight > 0.0 and weight * -self.u > back)
        return bool(weight > 0.0 and weight * math.sin(-self.u) > back * math.cos(self.u))  # Eq. 36

    def _trajectory(self, ended: _Ended) -> Trajectory:
        over, good = ended.outcome is Outcome.OVERTURNED, ended.status is Status.GOOD
        if over or not good:
            self.rotations[self.stretch + 1 :] = np.nan
            self.velocities[self.stretch + 1 :] = np.nan
        min_force, demand = self.forces_before if over else self.forces
        rocked = good and min_force < math.inf
        peak, peak_time = (self.side * 0.5 * math.pi, self.over_time) if over else (self.peak, self.peak_time)
        return Trajectory(
            self.rotations,
            self.velocities,
            self.events,
            ended.outcome,
            ended.status,
            side=self.side if over else 0,
            peak_rotation=peak if good else math.nan,
            peak_time=peak_time if good else math.nan,
            peak_velocity=self.fastest if good else math.nan,
            overturning_time=self.over_time if over else math.nan,
            impacts=self.impacts,
            uplifts=self.uplifts,
            truncation=self.truncation if good else math.nan,
            least_force=min_force if rocked else math.nan,
            friction_demand=demand if rocked else math.nan,
            engine=f"reference (Taylor, order up to {_ORDER}, tolerance {self.settings.tolerance:g})",
        )
