"""The engine of a body on an isolated base: Taylor steps of rotation and base, and events as zeros of the series."""

import math
from dataclasses import dataclass, field

import numpy as np

from rocking.bodies.isolated import Isolated
from rocking.conventions import FloatArray
from rocking.dynamics.isolated.impact import ImpactSystem
from rocking.dynamics.isolated.series import IsolatedSeries, SideConstants
from rocking.dynamics.isolated.settings import IsolatedSettings
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import Event, EventKind
from rocking.dynamics.taylor import first_fall, shifted, slope, turning_points, value
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

_HALF_PI = 0.5 * math.pi
_MOST_AT_ONCE = 100
_ROUNDING, _EARLY = 1e-9, 1e-6
SAMPLED = ("rotation", "angular_velocity", "displacement", "velocity", "acceleration", "work", "dissipated", "lost")


@dataclass(slots=True)
class IsolatedTrajectory:
    """A history: states at the ends of all stretches of the motion, and events."""

    samples: dict[str, FloatArray]  # by the names in `SAMPLED`, NaN after overturning, shape (stretches + 1,)
    events: list[Event] = field(default_factory=list)  # events of the body, in order of time
    base_velocities: list[tuple[float, float]] = field(default_factory=list)  # of impacts: before and after [m/s]
    peaks: list[tuple[float, float]] = field(default_factory=list)  # turning points: time [s], theta [rad]
    base_peaks: list[tuple[float, float]] = field(default_factory=list)  # extremes of the base: time [s], u [m]
    outcome: Outcome = Outcome.NO_UPLIFT
    status: Status = Status.GOOD
    side: int = 0  # side of overturning
    overturning_time: float = math.nan  # [s]
    least_force: float = math.inf  # smallest normal force on the body at the samples / its weight [-]
    least_base_force: float = math.inf  # smallest normal force on the base at the samples / weight of both [-]
    engine: str = f"reference (Taylor, order {IsolatedSeries.order})"

    @property
    def still_rocking(self) -> bool:
        """True if the body has not overturned and still moves at the last sample."""
        ends = self.samples["rotation"][-1], self.samples["angular_velocity"][-1]
        return self.outcome is Outcome.ROCKED and any(end != 0.0 for end in ends)


class IsolatedReference:
    """Engine of one history on an isolated base."""

    def __init__(
        self, body: Isolated, parameters: RockingParameters, segments: Segments, settings: IsolatedSettings,
        scale: float = 1.0, stream: int = 0,
    ) -> None:  # fmt: skip
        self.body, self.parameters, self.settings, self.stream = body, parameters, settings, stream
        self.step, self.count = segments.step, segments.horizontal.shape[0]
        vertical = np.zeros_like(segments.horizontal) if segments.vertical is None else segments.vertical
        self.horizontal, self.vertical = scale * segments.horizontal, scale * vertical
        self.sides = {sign: SideConstants.of(sign, body.mass, parameters.side(sign)) for sign in (1, -1)}
        self.out = IsolatedTrajectory({name: np.zeros(self.count + 1) for name in SAMPLED})
        self.side = self.slip = 0  # foot in contact, 0 at rest; direction of sliding, 0 for a base that sticks
        self.theta = self.rate = self.u = self.v = self.acceleration = 0.0
        self.work = self.dissipated = self.lost = 0.0
        self.stretch, self.tau, self.at_once, self.ended = 0, 0.0, 0, False

    @property
    def now(self) -> float:
        """Present time [s]."""
        return (self.stretch + self.tau) * self.step

    def run(self, rotation: float = 0.0, velocity: float = 0.0) -> IsolatedTrajectory:
        """Return the history from theta [rad] and theta' [rad/s] at time zero, with the base at rest."""
        self.theta, self.rate = rotation, velocity
        if rotation or velocity:
            self._lift(1 if rotation > 0.0 or (rotation == 0.0 and velocity > 0.0) else -1)
        first = self._series(1.0 - self.tau)
        self._choose_slip(first)
        self.acceleration = first.acceleration[0]
        self._sample(0)
        while not self.ended:
            self._advance()
        return self.out

    def _series(self, width: float) -> IsolatedSeries:
        """Return the series of the motion over a part of the stretch."""
        push = shifted(self.horizontal[self.stretch].tolist(), self.tau, width)
        lift = shifted(self.vertical[self.stretch].tolist(), self.tau, width)
        side = self.sides[self.side] if self.side else None
        state = self.theta, self.rate, self.u, self.v
        return IsolatedSeries(self.body, side, self.slip, state, width * self.step, push, lift, self.settings.gravity)

    def _advance(self) -> None:
        """Advance to the end of the stretch, of the accuracy of the series, or to an earlier event."""
        width = 1.0 - self.tau
        terms = self._series(width)
        if self._released(terms):
            return None
        if not all(map(math.isfinite, terms.theta + terms.u)):
            return self._end(Outcome.FAILED, Status.NOT_FINITE)
        terms = terms.first(terms.trusted(self.settings.tolerance, self.parameters.right.slenderness_angle))
        x, kind = min([(1.0, ""), *self._events(terms)])
        self.at_once = 0 if x > 0.0 else self.at_once + 1
        if self.at_once > _MOST_AT_ONCE:
            return self._end(Outcome.FAILED, Status.STUCK)
        self._note_peaks(terms, x)
        if self.side:
            alpha, side = self.sides[self.side].alpha, self.side
            passage = first_fall([alpha - side * terms.theta[0], *(-side * c for c in terms.theta[1:])])
            if passage is not None and passage <= x:
                self.out.overturning_time = self.now + passage * terms.duration
        work, dissipated = terms.works(x)
        self.work, self.dissipated = self.work + work, self.dissipated + dissipated
        self.theta, self.rate = value(terms.theta, x), slope(terms.theta, x) / terms.duration
        self.u, self.v = value(terms.u, x), slope(terms.u, x) / terms.duration
        self.acceleration = value(terms.acceleration, x)
        below, total = value(terms.normal_force, x), self.body.mass + self.body.base_mass
        self.out.least_base_force = min(self.out.least_base_force, below / (total * self.settings.gravity))
        if self.side:
            force = below - self.body.base_mass * value(terms.weight, x)
            self.out.least_force = min(self.out.least_force, force / (self.body.mass * self.settings.gravity))
        self.tau += x * terms.duration / self.step
        if self.tau >= 1.0 - 1e-13:
            self.stretch, self.tau = self.stretch + 1, 0.0
            self._sample(self.stretch)
            if self.stretch >= self.count:
                return self._finish()
        if kind:
            getattr(self, f"_{kind}")()
        return None

    # ---- events -----------------------------------------------------------------------------------------------------

    def _events(self, terms: IsolatedSeries) -> list[tuple[float, str]]:
        """Return the first event of each kind, as a fraction of the series."""
        side, theta = self.side, terms.theta
        gaps: list[tuple[str, list[float]]] = []
        if side:
            gaps.append(("impact", [side * c for c in theta]))
            gaps.append(("lie", [_HALF_PI - side * theta[0], *(-side * c for c in theta[1:])]))
        else:
            gaps += [("lift_right", terms.holding(self.sides[1])), ("lift_left", terms.holding(self.sides[-1]))]
        if self.slip:
            gaps.append(("stop", [self.slip * (k + 1) * c for k, c in enumerate(terms.u[1:])]))
        elif self.body.friction:
            gaps += [("slide", terms.grip(1)), ("slide", terms.grip(-1))]
        return [(x, kind) for kind, gap in gaps for x in _falls(gap)]

    def _released(self, terms: IsolatedSeries) -> bool:
        """Release body or base if the present state does not hold it. Return True after a change."""
        if self.side == 0:
            for sign in (1, -1):
                if terms.holding(self.sides[sign])[0] < 0.0:
                    self._lift(sign)
                    self._choose_slip(self._series(1.0 - self.tau))
                    return True
        if self.body.friction and not self.slip:
            self._choose_slip(terms)
            return self.slip != 0
        return False

    def _lift_right(self) -> None:
        self._lift(1)

    def _lift_left(self) -> None:
        self._lift(-1)

    def _lift(self, side: int) -> None:
        self.side = side
        self.out.outcome = Outcome.ROCKED
        self.out.events.append(Event(self.now, EventKind.UPLIFT, side))

    def _stop(self) -> None:
        self.v = 0.0
        self._slide()

    def _slide(self) -> None:
        """Choose between sticking and sliding for a base without velocity."""
        self.slip = 0
        self._choose_slip(self._series(1.0 - self.tau))

    def _choose_slip(self, terms: IsolatedSeries) -> None:
        """Choose the direction of sliding from the velocity of the base, or from the force that would hold the base."""
        if not self.body.friction:
            return
        if self.v:
            self.slip = 1 if self.v > 0.0 else -1
            return
        sign = 1 if terms.holding_force[0] > 0.0 else -1
        grip, limit = terms.grip(sign), _ROUNDING * self.body.friction * terms.normal_force[0]
        self.slip = sign if grip[0] < -limit or (grip[0] <= limit and grip[1] < 0.0) else 0

    def _impact(self) -> None:
        old, side, before = self.side, -self.side, (self.rate, self.v)
        energy = self._kinetic(old)
        r = self.parameters.coefficient(side, abs(self.rate), self.stream, len(self.out.base_velocities))
        landing = self.parameters.side(side)
        system = ImpactSystem.of(side, self.body, self.parameters.side(old), landing)
        self.theta = 0.0
        self.rate, self.v = system.after(self.rate, self.v, r)
        speed = side * self.rate
        rests = speed <= self.settings.rest_speed * landing.frequency_parameter * landing.slenderness_angle
        self.side, self.slip = 0, 0
        if speed <= 0.0 or (rests and self._holds()):
            if not self.body.friction or self.v:
                self.v += self.body.mass * system.height * self.rate / (self.body.mass + self.body.base_mass)
            self.rate = 0.0
        else:
            self.side = side
        ratio = self.rate / before[0] if before[0] else 0.0
        self.out.events.append(Event(self.now, EventKind.IMPACT, side, before[0], self.rate, ratio))
        self.out.base_velocities.append((before[1], self.v))
        self.lost += energy - self._kinetic(side)
        self._choose_slip(self._series(1.0 - self.tau))
        if len(self.out.events) >= self.settings.most_events:
            self._end(Outcome.FAILED, Status.TOO_MANY_EVENTS)

    def _holds(self) -> bool:
        """Return True if the present acceleration of the base does not lift a body at rest."""
        terms = self._series(1.0 - self.tau)
        return all(terms.holding(self.sides[sign])[0] > 0.0 for sign in (1, -1))

    def _kinetic(self, side: int) -> float:
        total = self.body.mass + self.body.base_mass
        return self.sides[side].kinetic(self.theta, self.rate, self.v) + 0.5 * total * self.v**2

    def _lie(self) -> None:
        self.out.side = self.side
        self._end(Outcome.OVERTURNED)

    def _finish(self) -> None:
        self.out.overturning_time = math.nan
        self._end(self.out.outcome)

    def _end(self, outcome: Outcome, status: Status = Status.GOOD) -> None:
        self.ended, self.out.outcome, self.out.status = True, outcome, status
        for values in self.out.samples.values():
            values[self.stretch + 1 :] = math.nan

    # ---- results ----------------------------------------------------------------------------------------------------

    def _note_peaks(self, terms: IsolatedSeries, until: float) -> None:
        for peaks, poly, moves in ((self.out.peaks, terms.theta, self.side), (self.out.base_peaks, terms.u, True)):
            if moves and any(poly[1:]):
                times = turning_points(poly, until)
                peaks += [(self.now + x * terms.duration, value(poly, x)) for x in times if x > _EARLY]

    def _sample(self, index: int) -> None:
        state = (self.theta, self.rate, self.u, self.v, self.acceleration, self.work, self.dissipated, self.lost)
        for name, number in zip(SAMPLED, state, strict=True):
            self.out.samples[name][index] = number


def _falls(poly: list[float]) -> list[float]:
    """Return the first x in [0, 1] at which a polynomial becomes negative, if any. A zero at the start is ignored."""
    if poly[0] > _ROUNDING * max(map(abs, poly)):
        x = first_fall(poly)
        return [] if x is None else [x]
    while len(poly) > 1 and abs(poly[0]) <= _ROUNDING * max(map(abs, poly[1:])):
        poly = poly[1:]
    x = first_fall(poly) if poly[0] > 0.0 else 0.0 if poly[0] < 0.0 else None
    return [] if x is None else [x]
