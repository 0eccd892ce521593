"""The event-driven engine of stacks of one or two bodies whose joints stick.

Between events the bodies turn about corners of the joints. An event ends a step, and the step is computed again up to
the event.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from rocking.bodies.stack import Stack
from rocking.conventions import FEET
from rocking.dynamics.stack.chain import Chain, JointForce, Sides, Vector
from rocking.dynamics.stack.contact_choice import CornerSolution, after_impact, under_forces
from rocking.dynamics.stack.settings import StackSettings
from rocking.dynamics.stack.trajectory import CLOSES, IMPACT, OPENS, PEAK, StackEvent, StackTrajectory
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

STEPS_OF_REFERENCE = 40.0  # longest step over that of time stepping
_STAGES = [[float(value) for value in row[:k]] for k, row in enumerate(DOP853.A)]
_NODES, _WEIGHTS = [float(value) for value in DOP853.C], [float(value) for value in DOP853.B]
_HALVINGS, _HALF_PI = 60, 0.5 * math.pi
_NORMAL = 1e-10  # tensile normal force of a closed corner, over the weight of the stack, that rounding explains

State = tuple[float, ...]  # theta of every body, theta' of every body, work of the ground
_Next = tuple[float, Callable[[], None]]  # time from the start of the step [s], and action


@dataclass
class _Extremes:
    opening: list[float]
    normal: list[float]
    ratio: list[float]
    slip_time: list[float]


@dataclass
class StackReference:
    """A history of one or two bodies, from rotations [rad] and angular velocities [rad/s]."""

    stack: Stack
    segments: Segments
    settings: StackSettings
    scale: float = 1.0
    time: float = 0.0
    sides: Sides = ()
    state: State = ()
    lost: float = 0.0
    status: Status = Status.GOOD
    events: list[StackEvent] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.chain = Chain.of(self.stack, self.settings.gravity)
        self.count = self.chain.count
        weight = [math.fsum(self.chain.mass[k:]) * self.settings.gravity for k in range(self.count)]
        self.weight = weight
        sides = [[self.stack.side_above(k, foot, self.settings.gravity) for foot in FEET] for k in range(self.count)]
        self.slow = [
            self.settings.rest_speed * min(s.frequency_parameter * s.slenderness_angle for s in pair) for pair in sides
        ]
        nan = [math.nan] * self.count
        self.extremes = _Extremes([0.0] * self.count, [math.inf] * self.count, [0.0] * self.count, nan)
        radii = [body.side(foot).semi_diagonal for body in self.stack.bodies for foot in FEET]
        unit = math.sqrt(min(radii) / self.settings.gravity)
        self.longest = STEPS_OF_REFERENCE * self.settings.longest_step * unit

    def run(self, rotation: Sequence[float], rates: Sequence[float]) -> StackTrajectory:
        """Return the history over all segments of the motion, until the bodies rest or overturn."""
        self._begin(rotation, rates)
        samples = [self._sample()]
        self.index, self.start = 0, 0.0
        self._note_extremes()
        is_free = not self.segments.moving
        fallen = -1
        for index in range(self.segments.count):
            self._follow(index)
            samples.append(self._sample())
            fallen = self._fallen()
            if fallen >= 0 or self.status is not Status.GOOD or (is_free and not any(self.sides)):
                break
        return self._result(samples, fallen)

    def _begin(self, rotation: Sequence[float], rates: Sequence[float]) -> None:
        openings = [a - b for a, b in zip(rotation, [0.0, *rotation], strict=False)]
        speeds = [a - b for a, b in zip(rates, [0.0, *rates], strict=False)]
        self.sides = tuple(_sign(opening) or _sign(speed) for opening, speed in zip(openings, speeds, strict=True))
        self.state = (*map(float, rotation), *map(float, rates), 0.0)

    def _follow(self, index: int) -> None:
        """Compute one segment of the motion."""
        self.index, self.start = index, index * self.segments.step
        end = (index + 1) * self.segments.step
        self._open_unsupported()
        while self.time < end and self.status is Status.GOOD and self._fallen() < 0:
            left = end - self.time
            steps = max(1, math.ceil(left / self.longest - 1e-9))
            step = left / steps
            state = self._advanced(step)
            first = self._first_event(step, state)
            length, action = first or (step, None)
            after = state if action is None else self._advanced(length)
            self._note_peaks(length, after)
            self.state, self.time = after, end if action is None and steps == 1 else self.time + length
            self._note_extremes()
            if action is not None:
                action()
                self._note_extremes()
            if len(self.events) > self.settings.most_events:
                self.status = Status.TOO_MANY_EVENTS

    # The next event

    def _first_event(self, step: float, state: State) -> _Next | None:
        events = []
        forces = self._forces(state, step)
        for joint, side in enumerate(self.sides):
            if side and side * _opening(state, joint) < 0.0:
                events.append(self._closing(joint, side, step))
            tensile = [c for c in (-1, 1) if _at_corner(forces[joint], c) < -_NORMAL * self.weight[0]]
            events += [self._unloading(joint, corner, step) for corner in ([] if side else tensile)]
        return min(events, key=lambda event: event[0], default=None)

    def _closing(self, joint: int, side: int, step: float) -> _Next:
        at = _root(lambda x: side * _opening(self._advanced(x), joint), step)
        return (step, partial(self._close, joint)) if at is None else (at, partial(self._land, joint))

    def _unloading(self, joint: int, corner: int, step: float) -> _Next:
        at = _root(lambda x: _at_corner(self._forces(self._advanced(x), x)[joint], corner), step)
        return at or 0.0, partial(self._open, joint, -corner)

    def _note_peaks(self, step: float, after: State) -> None:
        """Record the turning points of a step."""
        start, state = self.time, self.state
        for joint, side in enumerate(self.sides):
            before, last = (side * _opening(s[self.count :], joint) for s in (state, after))
            if before > 0.0 > last:
                at = self._turning(joint, side, step)
                if at is not None:
                    self.state, self.time = self._advanced(at), start + at
                    self._note_extremes()
                    self._note(joint, PEAK, self.sides, self._rates)
                    self.state, self.time = state, start

    def _turning(self, joint: int, side: int, step: float) -> float | None:
        return _root(lambda x: side * _opening(self._advanced(x)[self.count :], joint), step)

    # Events

    def _land(self, joint: int) -> None:
        flat = {k for k, side in enumerate(self.sides) if side == 0} | {joint}
        self._equal_rotation(joint)
        solution = after_impact(self.chain, self.sides, self._rotation, self._rates, flat)
        sides, rates = list(self.sides), [solution.motion[3 * k + 2] for k in range(self.count)]
        for k in range(self.count):
            side = solution.side_of(k)
            if side is None or (k not in flat and side != sides[k]):
                self.status = Status.LOST_CONTACT
                return
            if k in flat:
                sides[k] = side
        self._change(joint, IMPACT, tuple(sides), rates, solution)
        for k in flat:
            if self.sides[k] and abs(_opening(self._rates, k)) <= self.slow[k]:  # Eq. 363
                self._close(k)
        self._open_unsupported()

    def _close(self, joint: int) -> None:
        """Close a joint that chatters. The energy of the relative rotation is lost."""
        self._equal_rotation(joint)
        sides = tuple(0 if k == joint else side for k, side in enumerate(self.sides))
        flat = {k for k, side in enumerate(sides) if side == 0}
        solution = after_impact(self.chain, self.sides, self._rotation, self._rates, flat, keeps_contact=True)
        self._change(joint, CLOSES, sides, [solution.motion[3 * k + 2] for k in range(self.count)], solution)

    def _open(self, joint: int, side: int) -> None:
        sides = tuple(side if k == joint else own for k, own in enumerate(self.sides))
        self._change(joint, OPENS, sides, self._rates, None)

    def _open_unsupported(self) -> None:
        """Open the closed joints in which the forces of a jump of the acceleration are tensile."""
        forces = self._forces(self.state, 0.0)
        closed = [k for k, side in enumerate(self.sides) if side == 0]
        if all(min(forces[k].left, forces[k].right) >= -_NORMAL * self.weight[0] for k in closed):
            return
        solution = under_forces(self.chain, self.sides, self._rotation, self._rates, self._ground(0.0))
        for joint in closed:
            side = solution.side_of(joint)
            if side is None:
                self.status = Status.LOST_CONTACT
            elif side:
                self._open(joint, side)

    def _change(
        self, joint: int, kind: str, sides: Sides, rates: Sequence[float], solution: CornerSolution | None
    ) -> None:
        before, rotation, old = self._rates, self._rotation, self.sides
        rates = list(rates)
        for k, side in enumerate(sides):
            if side == 0:
                rates[k] = rates[k - 1] if k else 0.0
        if solution is not None:
            energies = [self.chain.energy(s, rotation, r)[0] for s, r in ((old, before), (sides, rates))]
            self.lost += energies[0] - energies[1]
        self.sides, self.state = sides, (*rotation, *rates, self.state[-1])
        self._note(joint, kind, old, before)

    def _note(self, joint: int, kind: str, sides: Sides, before: Sequence[float]) -> None:
        self.events.append(
            StackEvent(self.time, joint, kind, sides, self.sides, self._rotation, tuple(before), self._rates)
        )

    def _equal_rotation(self, joint: int) -> None:
        rotation = list(self._rotation)
        rotation[joint] = rotation[joint - 1] if joint else 0.0
        for k in range(joint + 1, self.count):
            if self.sides[k] == 0:
                rotation[k] = rotation[k - 1]
        self.state = (*rotation, *self.state[self.count :])

    # Motion

    @property
    def _rotation(self) -> tuple[float, ...]:
        return self.state[: self.count]

    @property
    def _rates(self) -> tuple[float, ...]:
        return self.state[self.count : 2 * self.count]

    def _ground(self, after: float) -> Vector:
        tau = (self.time + after - self.start) / self.segments.step
        values = []
        for polynomials in (self.segments.horizontal, self.segments.vertical):
            value = 0.0
            for coefficient in () if polynomials is None else polynomials[self.index][::-1].tolist():
                value = value * tau + coefficient
            values.append(self.scale * value)
        return values[0], values[1]

    def _forces(self, state: State, after: float) -> list[JointForce]:
        n = self.count
        return self.chain.forces(self.sides, state[:n], state[n : 2 * n], self._ground(after))

    def _derivative(self, state: State, after: float) -> list[float]:
        n, ground = self.count, self._ground(after)
        rotation, rates = state[:n], state[n : 2 * n]
        if not any(self.sides):
            return [0.0] * len(state)
        second = self.chain.angular_accelerations(self.sides, rotation, rates, ground)
        power = 0.0
        for mass, (vx, vz) in zip(self.chain.mass, self.chain.velocities(self.sides, rotation, rates), strict=True):
            power -= mass * (ground[0] * vx + ground[1] * vz)
        return [*rates, *second, power]

    def _advanced(self, step: float) -> State:
        """Return the state after a step of the eighth-order method of Dormand and Prince."""
        if not any(self.sides):
            return self.state
        slopes: list[list[float]] = []
        for node, row in zip(_NODES, _STAGES, strict=False):
            slopes.append(self._derivative(_moved(self.state, slopes, row, step), node * step))
        return _moved(self.state, slopes, _WEIGHTS, step)

    def _fallen(self) -> int:
        angles = [abs(angle) for angle in self._rotation]
        return next((k for k, angle in enumerate(angles) if angle >= _HALF_PI), -1)

    # Results

    def _note_extremes(self) -> None:
        extremes, friction = self.extremes, self.stack.friction
        for k, force in enumerate(self._forces(self.state, 0.0)):
            extremes.opening[k] = max(extremes.opening[k], abs(_opening(self.state, k)))
            extremes.normal[k] = min(extremes.normal[k], force.normal / self.weight[k])
            ratio = abs(force.tangential) / force.normal if force.normal > 0.0 else math.inf
            extremes.ratio[k] = max(extremes.ratio[k], ratio)
            if ratio > friction[k] and math.isnan(extremes.slip_time[k]):
                extremes.slip_time[k] = self.time

    def _sample(self) -> list[float]:
        rotation, rates = self._rotation, self._rates
        energy = self.chain.energy(self.sides, rotation, rates)
        centres = [value for centre in self.chain.positions(self.sides, rotation)[1] for value in centre]
        return [self.time, *rotation, *rates, *centres, self.state[-1], *energy, self.lost]

    def _result(self, samples: list[list[float]], fallen: int) -> StackTrajectory:
        n, table, extremes = self.count, np.array(samples), self.extremes
        opened = any(event.kind in {OPENS, IMPACT} for event in self.events) or bool(np.any(table[:, 1 : 2 * n + 1]))
        outcome = Outcome.ROCKED if opened else Outcome.NO_UPLIFT
        outcome = Outcome.OVERTURNED if fallen >= 0 else outcome
        trajectory = StackTrajectory(
            table[:, 0], table[:, 1 : n + 1], table[:, n + 1 : 2 * n + 1],
            table[:, 2 * n + 1 : 4 * n + 1].reshape(-1, n, 2), np.zeros((len(table), n)), table[:, -4], table[:, -3],
            table[:, -2], table[:, -1], np.array(extremes.opening), np.zeros(n), np.array(extremes.normal),
            np.array(extremes.ratio), np.array(extremes.slip_time), self.events,
            outcome if self.status is Status.GOOD else Outcome.FAILED, self.status, fallen,
            self.time if fallen >= 0 else math.nan,
        )  # fmt: skip
        trajectory.still_rocking = fallen < 0 and any(self.sides)
        return trajectory


def _moved(state: State, slopes: list[list[float]], weights: list[float], step: float) -> State:
    result = []
    for k, value in enumerate(state):
        change = 0.0
        for slope, weight in zip(slopes, weights, strict=True):
            change += slope[k] * weight
        result.append(value + step * change)
    return tuple(result)


def _opening(values: Sequence[float], joint: int) -> float:
    """Return the relative rotation of a joint, or its rate."""
    return values[joint] - (values[joint - 1] if joint else 0.0)


def _at_corner(force: JointForce, corner: int) -> float:
    return force.left if corner < 0 else force.right


def _sign(value: float) -> int:
    return (value > 0.0) - (value < 0.0)


def _root(function: Callable[[float], float], step: float) -> float | None:
    """Return the zero in a step at whose end a function is negative; None if the function is positive nowhere."""
    high = step
    for _ in range(_HALVINGS):
        low = 0.5 * high
        if function(low) > 0.0:
            return float(brentq(function, low, high, xtol=1e-16, rtol=1e-15))
        high = low
    return None
