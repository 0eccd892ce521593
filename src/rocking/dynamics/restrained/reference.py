"""The reference engine of a body with restraints: Taylor steps, and events as zeros of the series.

A change of phase of a restraint, a turning point and an impact end a step, so that every step is smooth.
"""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import Event, EventKind
from rocking.dynamics.plane.event_functions import NOTHING, Push, RestoringMoments, comes_to_rest
from rocking.dynamics.restrained.devices import BLOCKED, Device, RestraintEvent, blocked, moment_at_rest
from rocking.dynamics.restrained.series import Equation, Poly, RestraintSeries, series
from rocking.dynamics.restrained.settings import RestrainedSettings
from rocking.dynamics.taylor import first_fall, shifted, slope, value
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

_ORDER = 30
_STRETCH_END = 1.0 - 1e-13
_HALF_PI = 0.5 * math.pi
_TIE = 1e-11  # as a fraction of a step
_ROUNDING, _MOST_AT_ONCE = 1e-9, 1000
_AFTER = 30.0  # product of p and the time on ground at rest that determines the outcome
_SHORTER, _SHORTEST = 1e-4, 1e-20  # as fractions of a segment
_INSTANTS = 32  # instants per step at which the contact with a wall is recorded
_SINGULAR = 1e-14  # speed / (p alpha) near a turning point, for a damper with an exponent other than 1


class _Next(NamedTuple):
    x: float  # fraction of the step
    kind: str
    device: Device | None = None
    upwards: bool = False


@dataclass(slots=True)
class RestrainedTrajectory:
    """A history: states at the ends of all segments of the motion, and events."""

    rotation: FloatArray  # theta [rad], NaN after overturning; shape (segments + 1,)
    angular_velocity: FloatArray  # theta' [rad/s]
    elongation: FloatArray  # [m]; shape (segments + 1, restraints)
    force: FloatArray  # [N]
    restraint_work: FloatArray  # work done on restraints since the start [J]
    work: FloatArray  # work of the ground since the start [J]
    devices: list[Device]
    events: list[Event] = field(default_factory=list)  # events of the body, in order of time
    restraint_events: list[RestraintEvent] = field(default_factory=list)
    peaks: list[tuple[float, float]] = field(default_factory=list)  # turning points: time [s], theta [rad]
    contacts: list[tuple[float, ...]] = field(default_factory=list)  # t, theta, theta' and forces in contact with walls
    outcome: Outcome = Outcome.NO_UPLIFT
    status: Status = Status.GOOD
    side: int = 0  # side of overturning
    peak_rotation: float = 0.0  # [rad]
    peak_time: float = 0.0  # [s]
    peak_velocity: float = 0.0  # [rad/s]
    overturning_time: float = math.nan  # [s]
    impacts: int = 0
    uplifts: int = 0
    engine: str = f"reference (Taylor, order up to {_ORDER})"

    def cut(self, count: int) -> None:
        """Keep only the first `count` segments."""
        for name in ("rotation", "angular_velocity", "elongation", "force", "restraint_work", "work"):
            setattr(self, name, getattr(self, name)[: count + 1])

    @property
    def still_rocking(self) -> bool:
        """True if the body has not overturned and still moves at the last sample."""
        return self.outcome is Outcome.ROCKED and bool(self.rotation[-1] != 0.0 or self.angular_velocity[-1] != 0.0)

    @property
    def first_uplift(self) -> float:
        """Time of the first uplift from rest; NaN without uplift [s]."""
        return next((event.time for event in self.events if event.kind is EventKind.UPLIFT), math.nan)


class RestrainedReference:
    """Reference engine of one history with restraints."""

    def __init__(  # noqa: PLR0917 - a history and its inputs
        self,
        parameters: RockingParameters,
        mass: float,
        devices: list[Device],
        segments: Segments,
        settings: RestrainedSettings,
        scale: float = 1.0,
        stream: int = 0,
    ) -> None:
        over_g = scale / settings.gravity
        vertical = np.zeros_like(segments.horizontal) if segments.vertical is None else segments.vertical
        self.push = Push(segments.step, segments.horizontal * over_g, vertical * over_g)
        self.parameters, self.settings, self.stream, self.mass = parameters, settings, stream, mass
        self.count, self.devices = segments.count, devices
        self.blocked = blocked(devices)
        self.equations = {side: self._equation(side) for side in (1, -1)}
        shape = (self.count + 1, len(devices))
        self.out = RestrainedTrajectory(
            np.zeros(self.count + 1), np.zeros(self.count + 1), np.zeros(shape), np.zeros(shape), np.zeros(shape),
            np.zeros(self.count + 1), devices,
        )  # fmt: skip
        self.side, self.theta, self.rate, self.direction = 0, 0.0, 0.0, 0  # direction: sign of theta'
        self.stretch, self.tau, self.work = 0, 0.0, 0.0
        self.ended, self.at_once = False, 0
        self._ground: RestoringMoments | None = None

    def _equation(self, side: int) -> Equation:
        half, mass = self.parameters.side(side), self.mass
        inertia = mass * half.semi_diagonal**2 / half.inertia_ratio
        return Equation(side, half.slenderness_angle, half.frequency_parameter, inertia, self.settings.linear)

    def run(self, rotation: float = 0.0, velocity: float = 0.0) -> RestrainedTrajectory:
        """Return the history from theta [rad] and theta' [rad/s] at time zero."""
        self.side = 1 if rotation > 0.0 or (rotation == 0.0 and velocity > 0.0) else -1
        self.theta, self.rate = rotation, velocity
        for device in self.devices:
            device.load(device.levers[self.side].elongation(rotation))
        self._start()
        while not self.ended:
            self._step()
        return self.out

    def _start(self) -> None:
        upright = abs(self.theta) <= 1e-16
        if upright and abs(self.rate) <= NOTHING * self.equation.p * self.equation.alpha:
            self.theta = self.rate = 0.0
            self._sample(0)
            return self._rest()
        self._sample(0)
        self.out.uplifts = 1
        self._note(EventKind.UPLIFT)
        self._peak()
        return self._turn() if self.rate == 0.0 else self._head(1 if self.rate > 0.0 else -1)

    @property
    def equation(self) -> Equation:
        """Equation of motion about the foot in contact."""
        return self.equations[self.side]

    @property
    def now(self) -> float:
        """Present time [s]."""
        return (self.stretch + self.tau) * self.push.step

    # ---- one step ---------------------------------------------------------------------------------------------------

    def _step(self, width: float = 1.0) -> None:
        """Advance by a part of the segment, or to an earlier event."""
        width = min(width, 1.0 - self.tau)
        h, is_singular = width * self.push.step, self._is_singular()
        push = shifted(self.push.horizontal[self.stretch].tolist(), self.tau, width)
        weight = shifted(self.push.vertical[self.stretch].tolist(), self.tau, width)
        weight[0] += 1.0
        items = [RestraintSeries(device.law, device.levers[self.side]) for device in self.devices]
        for item in items:
            item.is_viscous = item.law.exponent == 1.0 or (not is_singular and item.lever.slope(self.theta) != 0.0)
        terms = series(self.equation, self.theta, self.rate, h, push, weight, items, _ORDER)
        if is_singular:
            return self._pass_turn(terms, h, width)
        fraction = self._trusted_part(terms, h)
        if not fraction > 0.0:  # near a turning point with a power-law damper
            too_short = width < _SHORTEST or not any(item.root for item in items)
            return self._end(Outcome.FAILED, Status.NOT_FINITE) if too_short else self._step(_SHORTER * width)
        event = self._first_event(terms, items, fraction, h)
        x = fraction if event is None else event.x * fraction
        self.at_once = 0 if x > 0.0 else self.at_once + 1
        if self.at_once > _MOST_AT_ONCE:
            return self._end(Outcome.FAILED, Status.STUCK)
        self._add_work(terms, items, x, h, push, weight)
        if any(device.law.phase.name == "contact" for device in self.devices):
            self._note_contact(terms, items, x, width)
        self.theta, self.rate = value(terms, x), slope(terms, x) / h
        self.out.peak_velocity = max(self.out.peak_velocity, abs(self.rate))
        self._carry(event)
        self._move(self.tau + x * width)
        if event is not None and not self.ended:
            self._act(event)
        return None

    def _trusted_part(self, terms: Poly, h: float) -> float:
        """Return the fraction of the step over which the last terms are below the tolerance."""
        if not all(map(math.isfinite, terms)):
            return 0.0
        if len(terms) <= _ORDER:
            return 1.0
        equation, fraction = self.equation, 1.0
        bound = self.settings.tolerance * max(equation.alpha, abs(self.theta))
        for k in (len(terms) - 2, len(terms) - 1):
            for size, power in ((abs(terms[k]), k), (k * abs(terms[k]) / (h * equation.p), k - 1)):
                if size > bound:
                    fraction = min(fraction, (bound / size) ** (1.0 / power))  # Eq. 52
        return fraction

    def _first_event(self, terms: Poly, items: list[RestraintSeries], fraction: float, h: float) -> _Next | None:
        theta, side = _scaled(terms, fraction), self.side
        rate = [self.direction * k * c for k, c in enumerate(theta)][1:]
        events = [_Next(x, "impact") for x in _falls([side * c for c in theta])]
        events += [_Next(x, "lies") for x in _falls([_HALF_PI - side * theta[0], *(-side * c for c in theta[1:])])]
        for device, item in zip(self.devices, items, strict=True):
            phase = device.law.phase
            for limit, sign in ((phase.high, -1.0), (phase.low, 1.0)):
                if abs(limit) < math.inf:
                    gap = _scaled(item.elongation, fraction, sign)
                    gap[0] = sign * (device.elongation - limit)
                    events += [_Next(x, "limit", device, upwards=sign < 0.0) for x in _falls(gap)]
            if margin := device.law.margin(item.elongation, [c / h for c in item.rate]):
                ends = _falls(_scaled(margin, fraction))
                events += [_Next(x, "limit", device, upwards=phase.name == "contact") for x in ends]
            if phase.direction and item.slope[0]:
                events += [
                    _Next(x, "lever", device)
                    for x in _falls(_scaled(item.slope, fraction, math.copysign(1.0, item.slope[0])))
                ]
        events += [_Next(x, "turn") for x in _falls(rate)]
        # a phase limit that is reached at the impact is part of the impact
        return min(events, key=lambda event: event.x - _TIE * (event.kind == "impact"), default=None)

    def _add_work(
        self, terms: Poly, items: list[RestraintSeries], x: float, h: float, push: Poly, weight: Poly
    ) -> None:
        """Add the work of the ground and the work of viscous forces over a part of the step."""
        g, equation, side = self.settings.gravity, self.equation, self.parameters.side(self.side)
        unit = self.mass * g * side.semi_diagonal
        terms, push, weight = (_scaled(poly, x) for poly in (terms, push, weight))
        rates = [(k + 1) * c for k, c in enumerate(terms[1:])]
        to_top = [self.side * equation.alpha - terms[0], *(-c for c in terms[1:])]
        sines, cosines = (to_top, [1.0]) if equation.linear else _sine_cosine(to_top)
        lift = [weight[0] - 1.0, *weight[1:]]
        power = _product(_sum(_product(push, cosines), _product(lift, sines)), rates)
        self.work -= unit * _integral(power)  # Eq. 351
        for device, item in zip(self.devices, items, strict=True):
            if item.viscous:
                device.work += x * _integral(_product(_scaled(item.viscous, x), _scaled(item.rate, x)))

    def _note_contact(self, terms: Poly, items: list[RestraintSeries], x: float, width: float) -> None:
        """Record time, state and forces at instants of a step in contact with a wall."""
        for k in range(self.rate == 0.0, _INSTANTS + 1):
            y = x * k / _INSTANTS
            forces = [
                item.law.phase.force(value(item.elongation, y)) + (value(item.viscous, y) if item.viscous else 0.0)
                for item in items
            ]
            for device, force in zip(self.devices, forces, strict=True):
                device.note_force(min(force, 0.0) if device.law.phase.name == "contact" else force)
            time, h = self.now + y * width * self.push.step, width * self.push.step
            self.out.contacts.append((time, value(terms, y), slope(terms, y) / h, *forces))

    # ---- next to a turning point with a damper of a power --------------------------------------------------------

    def _is_singular(self) -> bool:
        if all(device.law.exponent == 1.0 or not device.law.coefficient for device in self.devices):
            return False
        return abs(self.rate) < _SINGULAR * self.equation.p * self.equation.alpha

    def _pass_turn(self, terms: Poly, h: float, width: float) -> None:
        """Leave or reach a turning point without the damper, because the power law has no series at this point."""
        first, second, third = [*terms, 0.0, 0.0][1:4]
        if reaches := first * second < 0.0:
            x = min(1.0, -0.5 * first / second)
        else:
            speed = 1.01 * _SINGULAR * self.equation.p * self.equation.alpha * h
            root = abs(second) + math.sqrt(second**2 + 3.0 * abs(third) * speed)
            x = min(1.0, speed / root) if root else 1.0  # Eq. 356
        self.theta, self.rate = value(terms, x), 0.0 if reaches else slope(terms, x) / h
        self._carry(None)
        self._move(self.tau + x * width)
        if reaches and not self.ended:
            self._turn()

    # ---- events -----------------------------------------------------------------------------------------------------

    def _act(self, event: _Next) -> None:
        device = event.device
        if event.kind == "impact":
            return self._impact()
        if event.kind == "lies":
            return self._end(Outcome.OVERTURNED)
        if device is None:
            return self._turn()
        before = device.force()
        if event.kind == "limit":
            device.law.cross(device.elongation, upwards=event.upwards)
        else:
            device.law.settle(device.elongation, -device.law.phase.direction)
        return self._note_phase(device, before)

    def _impact(self) -> None:
        self._lose_contact_angle()
        self.theta, before = 0.0, self.rate
        speed, old = abs(before), self.side
        out = self.out
        if -old in self.blocked:
            r = self.blocked[-old]
        else:
            self.side = -old
            r = self.parameters.coefficient(self.side, speed, self.stream, out.impacts)
        self.rate = r * before + 0.0  # Eq. 28; not -0 after a stop
        out.impacts += 1
        out.events.append(Event(self.now, EventKind.IMPACT, self.side, before, self.rate, r))
        if out.impacts >= self.settings.most_events:
            return self._end(Outcome.FAILED, Status.TOO_MANY_EVENTS)
        if self.stretch >= self.count:
            return None if self.ended else self._end(Outcome.ROCKED)
        for device in self.devices:
            device.elongation = 0.0
        if self._decays(abs(r) * speed):
            out.events.append(Event(self.now, EventKind.REST, self.side))
            self.rate = 0.0
            for device in self.devices:
                device.rate = 0.0
            return self._rest()
        return self._head(self.side)

    def _decays(self, after: float) -> bool:
        exact = self.blocked or any(device.law.slip_force for device in self.devices)
        rest_speed = 0.0 if exact else self.settings.rest_speed
        return comes_to_rest(self.parameters, self._holding(), self.side, after, self.stretch, self.tau, rest_speed)

    def _head(self, direction: int) -> None:
        """Choose the phases of all restraints for a sign of theta'."""
        self.direction = direction
        for device in self.devices:
            arm = device.levers[self.side].slope(self.theta)
            before, phase = device.force(), device.law.phase
            device.law.settle(device.elongation, int(math.copysign(1, arm * direction)) if arm else 0)
            device.rate = arm * self.rate
            if device.law.phase.name == "contact" and device.force() > 0.0:
                device.law.cross(device.elongation, upwards=True)
            if device.law.phase is not phase:
                self._note_phase(device, before)

    def _turn(self) -> None:
        """Reverse the motion at a turning point, or hold the body there by friction."""
        self.rate = 0.0
        if self.stretch >= self.count and self.side * self._acceleration_at(self.stretch, self.tau) < 0.0:
            self._peak()
            return self._end(Outcome.ROCKED)
        self._peak()
        self.out.peaks.append((self.now, self.theta))
        for device in self.devices:
            device.rate = 0.0
        acceleration, limit = self._acceleration_at(self.stretch, self.tau), self._friction()
        if abs(acceleration) > limit:
            return self._head(1 if acceleration > 0.0 else -1)
        return self._hold(limit)  # Eq. 352

    def _hold(self, limit: float) -> None:
        """Hold the body at a rotation until the moment exceeds the friction."""
        while self.stretch < self.count:
            rows = [self._acceleration_at(self.stretch, x) for x in (self.tau, 1.0)]
            poly = self._acceleration_series()
            if max(map(abs, rows)) > limit or len(poly) > 2:
                tail = shifted(poly, self.tau, 1.0 - self.tau)
                falls = [
                    (x, sign)
                    for sign in (1, -1)
                    for x in _falls([limit - sign * tail[0], *(-sign * c for c in tail[1:])])
                ]
                if falls:
                    x, sign = min(falls)
                    self._move(self.tau + x * (1.0 - self.tau))
                    if self.ended:
                        return None
                    return self._head(sign)
            self._move(1.0)
        return None

    def _rest(self) -> None:
        """Keep the body at rest until the next uplift, or to the end."""
        if self.ended:
            return None
        ground = self._holding()
        both = [ground.held(side, min(self.stretch, self.count - 1), self.tau) for side in (1, -1)]
        if max(both) < 0.0:
            return self._end(Outcome.FAILED, Status.LOST_CONTACT)
        uplift = ground.next_uplift(self.stretch, self.tau)
        until = self.count if uplift is None else uplift[0]
        while self.stretch < until:
            self._move(1.0)
        return None if uplift is None else self._lift(uplift[1], uplift[2])

    def _lift(self, tau: float, side: int) -> None:
        """Start an uplift at an instant of the segment."""
        self.side = side
        self._move(tau)
        if self.ended:
            return None
        self.out.uplifts += 1
        self._note(EventKind.UPLIFT)
        return self._head(side)

    def _holding(self) -> RestoringMoments:
        """Return the restoring moments, including restraints in their present state."""
        more = {}
        for side in (1, -1):
            half = self.parameters.side(side)
            unit = self.mass * self.settings.gravity * half.semi_diagonal
            more[side] = moment_at_rest(self.devices, side) / unit + BLOCKED * (side in self.blocked)  # Eq. 353
        if self._ground is None or self._ground.more != more:
            self._ground = RestoringMoments(self.parameters, self.push, linear=self.settings.linear, more=more)
        return self._ground

    # ---- details ----------------------------------------------------------------------------------------------------

    def _acceleration(self, push: float, weight: float) -> float:
        """Return theta'' without viscous forces and friction [rad/s2]."""
        equation = self.equation
        to_top = equation.side * equation.alpha - self.theta
        sine, cosine = (to_top, 1.0) if equation.linear else (math.sin(to_top), math.cos(to_top))
        moment = 0.0
        for device in self.devices:
            if not device.law.slip_force:
                moment += device.levers[self.side].slope(self.theta) * device.law.phase.force(device.elongation)
        return -(equation.p**2) * (weight * sine + push * cosine) - moment / equation.inertia

    def _acceleration_at(self, stretch: int, tau: float) -> float:
        k = min(stretch, len(self.push.horizontal) - 1)
        push, lift = (value(rows[k].tolist(), tau) for rows in (self.push.horizontal, self.push.vertical))
        return self._acceleration(push, 1.0 + lift)

    def _acceleration_series(self) -> Poly:
        """Return theta'' at the present rotation as a polynomial over the segment."""
        push, lift = (rows[self.stretch].tolist() for rows in (self.push.horizontal, self.push.vertical))
        still = self._acceleration(0.0, 0.0)
        push_slope, weight_slope = self._acceleration(1.0, 0.0) - still, self._acceleration(0.0, 1.0) - still
        poly = [push_slope * a + weight_slope * b for a, b in zip(push, lift, strict=True)]
        poly[0] += still + weight_slope
        return poly

    def _friction(self) -> float:
        """Return the largest theta'' that friction resists [rad/s2]."""
        arms = (device.law.slip_force * abs(device.levers[self.side].slope(self.theta)) for device in self.devices)
        return sum(arms) / self.equation.inertia

    def _carry(self, event: _Next | None) -> None:
        """Move all restraints to the present rotation of the body."""
        if event is not None and event.kind == "impact":
            self.theta = 0.0
        if event is not None and event.kind == "turn":
            self.rate = 0.0
        for device in self.devices:
            lever = device.levers[self.side]
            device.move(lever.elongation(self.theta), lever.slope(self.theta) * self.rate)
        over, alpha = self.side * self.theta > self.equation.alpha, self.out.overturning_time
        if over and math.isnan(alpha):
            self.out.overturning_time = self.now
        elif not over:
            self.out.overturning_time = math.nan

    def _lose_contact_angle(self) -> None:
        self.out.overturning_time = math.nan

    def _note(self, kind: EventKind) -> None:
        self.out.events.append(Event(self.now, kind, self.side))

    def _note_phase(self, device: Device, before: float) -> None:
        index = self.devices.index(device)
        phase = device.law.phase.name
        self.out.restraint_events.append(RestraintEvent(self.now, index, phase, self.theta, device.elongation, before))
        device.note()

    def _peak(self) -> None:
        if abs(self.theta) > abs(self.out.peak_rotation):
            self.out.peak_rotation, self.out.peak_time = self.theta, self.now

    def _move(self, tau: float) -> None:
        if tau < _STRETCH_END:
            self.tau = tau
            return None
        self.stretch, self.tau = self.stretch + 1, 0.0
        if self.stretch <= self.count:
            self._sample(self.stretch)
        if self.stretch == self.count:
            return self._finish()
        if self.stretch > self.count and (not self._may_overturn() or self.stretch >= len(self.push.horizontal)):
            return self._end(Outcome.ROCKED)
        return None

    def _sample(self, k: int) -> None:
        out = self.out
        out.rotation[k], out.angular_velocity[k], out.work[k] = self.theta, self.rate, self.work
        for i, device in enumerate(self.devices):
            out.elongation[k, i], out.force[k, i] = device.elongation, device.force()
            out.restraint_work[k, i] = device.work

    def _finish(self) -> None:
        self._peak()
        if (
            self.theta != 0.0
            and self.rate == 0.0
            and abs(self._acceleration_at(self.count - 1, 1.0)) <= self._friction()
        ):
            return self._end(Outcome.HELD)
        if not self._may_overturn():
            return self._end(Outcome.ROCKED if self.out.uplifts or self.out.impacts else Outcome.NO_UPLIFT)
        # zero samples after the ground motion, to determine the outcome
        still = np.zeros((math.ceil(_AFTER / (self.equation.p * self.push.step)), self.push.horizontal.shape[1]))
        rows = (np.vstack([self.push.horizontal, still]), np.vstack([self.push.vertical, still]))
        self.push = Push(self.push.step, *rows)
        return None

    def _may_overturn(self) -> bool:
        """Return True if the rotation exceeds the slenderness angle or increases."""
        outwards = self.side * self.rate > 0.0
        return self.theta != 0.0 and (outwards or self.side * self.theta > self.equation.alpha)

    def _end(self, outcome: Outcome, status: Status = Status.GOOD) -> None:
        out = self.out
        self.ended, out.outcome, out.status = True, outcome, status
        if outcome is Outcome.OVERTURNED:
            out.side, out.peak_rotation = self.side, self.side * _HALF_PI
            out.peak_time = out.overturning_time
        else:
            out.overturning_time = math.nan
        if outcome in {Outcome.OVERTURNED, Outcome.FAILED}:
            for array in (out.rotation, out.angular_velocity, out.elongation, out.force, out.work, out.restraint_work):
                array[min(self.stretch, self.count) + 1 :] = np.nan


def _falls(poly: Poly) -> list[float]:
    """Return the first x in [0, 1] at which a polynomial becomes negative, if any. A zero at the start is ignored."""
    if poly[0] > 0.0:
        x = first_fall(poly)
    else:
        tail = poly[1:]
        while len(tail) > 1 and -_ROUNDING * max(map(abs, tail[1:])) <= tail[0] <= 0.0:
            tail = tail[1:]  # just after a release, only rounding can make these values negative
        x = None if not tail else 0.0 if tail[0] < 0.0 else first_fall(tail)
    return [] if x is None else [x]


def _product(a: Poly, b: Poly) -> Poly:
    """Return the product of two series, up to the order of the longer series."""
    count = max(len(a), len(b))
    result = [0.0] * count
    for i, left in enumerate(a):
        if left:
            for j, right in enumerate(b[: count - i]):
                result[i + j] += left * right
    return result


def _sum(a: Poly, b: Poly) -> Poly:
    longer, shorter = (a, b) if len(a) >= len(b) else (b, a)
    return [*(x + y for x, y in zip(longer, shorter, strict=False)), *longer[len(shorter) :]]


def _integral(poly: Poly) -> float:
    """Return the integral of a polynomial from 0 to 1."""
    return sum(c / (k + 1) for k, c in enumerate(poly))


def _scaled(poly: Poly, x: float, sign: float = 1.0) -> Poly:
    return [sign * c * x**k for k, c in enumerate(poly)]


def _sine_cosine(angle: Poly) -> tuple[Poly, Poly]:
    """Return the series of the sine and cosine of a series."""
    sines, cosines = [math.sin(angle[0])], [math.cos(angle[0])]
    for k in range(1, len(angle)):
        steps = [(j + 1) * angle[j + 1] / k for j in range(k)]
        sines.append(sum(a * b for a, b in zip(steps, cosines[k - 1 :: -1], strict=True)))
        cosines.append(-sum(a * b for a, b in zip(steps, sines[k - 1 :: -1], strict=True)))
    return sines, cosines
