"""Independent engine of the contact bed: sums over all points, with integrators of SciPy.

This engine has no code in common with the fast engine. For laws without memory, it does not locate switches: forces use
maximum and minimum, and the error control of the integrator resolves the kinks. Only changes between sticking and
sliding are located.
"""

import math
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from rocking.conventions import BoolArray, FloatArray
from rocking.portable import dot
from rocking.restitution.bed.contact_bed import FrictionKind
from rocking.restitution.bed.laws import LawKind, force, stored
from rocking.restitution.bed.setup import END_AT_PEAK, SAMPLES, Run, Setup, named

Method = Literal["DOP853", "LSODA"]
Event = Callable[[float, FloatArray], float]

Y, THETA, U, W, OMEGA, TRAVEL, BED_LOSS, FRICTION_LOSS, IMPULSE, MOMENT, SHEAR, SLID, PAST = range(13)


class Field:
    """Right-hand side of the equations of an impact: state, losses and largest depths of the points."""

    def __init__(self, setup: Setup) -> None:
        self.setup = setup
        self.bed = setup.rigid.bed
        self.kind, self.coefficient, self.creep = self.bed.friction.numbers
        self.slip = 0

    def points(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return depths [m], rates of the depths [m/s] and forces [N] of all points."""
        positions, heights = self.bed.positions, self.bed.heights
        if self.bed.kinematics == "small":
            depth, rate = -(x[Y] - positions * x[THETA] + heights), -(x[W] - positions * x[OMEGA])
        else:
            s, c = math.sin(x[THETA]), math.cos(x[THETA])
            depth = -(x[Y] - positions * s + heights * c)  # Eq. 122
            rate = -(x[W] * c - x[U] * s - (positions * c + heights * s) * x[OMEGA])
        value = self.bed.shares * force(self.setup.law, depth, rate, x[PAST:])
        return depth, rate, value

    def forces(self, x: FloatArray) -> tuple[FloatArray, float, float]:
        """Return accelerations, shear force and normal force."""
        _, _, value = self.points(x)
        r, g, a = self.setup.rigid, self.setup.gravity, self.setup.push
        m, h, normal = r.mass, r.height, float(value.sum())
        moment, tilt = dot(value, self.bed.positions), dot(value, self.bed.heights)
        s, c = math.sin(x[THETA]), math.cos(x[THETA])
        turning = m * h * (g * s - a * c)
        if self.bed.kinematics == "small":
            along, across, turning = -m * a, normal - m * g, turning - moment
        else:
            along = m * g * s - m * a * c - normal * s - m * x[W] * x[OMEGA]
            across = normal * c - m * g * c - m * a * s + m * (x[U] + h * x[OMEGA]) * x[OMEGA]
            turning += -moment * c - tilt * s - m * h * x[W] * x[OMEGA]
        if self.held:
            turn = turning / (r.inertia + m * h * h)  # Eq. 123
            return np.array([0.0, across / m, turn]), m * h * turn - along, normal
        shear = -self.coefficient * normal
        shear *= self.slip if self.kind is FrictionKind.COULOMB else x[U] / math.hypot(x[U], self.creep)  # Eq. 124
        turn = (turning - h * (along + shear)) / r.inertia
        return np.array([(along + shear) / m - h * turn, across / m, turn]), shear, normal

    @property
    def held(self) -> bool:
        """True if the base sticks to the bed."""
        return self.kind is FrictionKind.STICKING or (self.kind is FrictionKind.COULOMB and self.slip == 0)

    def __call__(self, _: float, x: FloatArray) -> FloatArray:
        """Return the rates of the extended state."""
        accelerations, shear, normal = self.forces(x)
        depth, rate, value = self.points(x)
        s, c = (0.0, 1.0) if self.bed.kinematics == "small" else (math.sin(x[THETA]), math.cos(x[THETA]))
        sinking = np.where((depth >= x[PAST:]) & (rate > 0.0), rate, 0.0)
        return np.concatenate([
            [x[W] * c - x[U] * s, x[OMEGA], *accelerations, x[U] * c + x[W] * s],
            [self._bed_loss(depth, rate, value, x[PAST:]), 0.0 if self.held else -shear * x[U]],
            [normal, dot(value, self.bed.positions), shear, abs(x[U]) if normal > 0.0 else 0.0],
            sinking,
        ])  # fmt: skip

    def _bed_loss(self, depth: FloatArray, rate: FloatArray, value: FloatArray, past: FloatArray) -> float:
        law, shares = self.setup.law, self.bed.shares
        if law.kind is LawKind.PLASTIC:
            loading = (depth >= past) & (rate > 0.0) & (depth > 0.0)
            return float((shares * law.stiffness * depth * rate * (1.0 - law.rebound**2))[loading].sum())
        spring = shares * law.stiffness * np.maximum(depth, 0.0) ** law.exponent
        return float(((value - spring) * rate)[depth > 0.0].sum())

    def energy(self, x: FloatArray) -> tuple[float, float]:
        """Return the mechanical energy (including the elastic energy), and the elastic energy."""
        r = self.setup.rigid
        m, h, u = r.mass, r.height, x[U] + r.height * x[OMEGA]
        kinetic = 0.5 * m * (u * u + x[W] ** 2) + 0.5 * r.inertia * x[OMEGA] ** 2
        weight = m * self.setup.gravity * (x[Y] + h * (math.cos(x[THETA]) - 1.0))
        push = m * self.setup.push * (x[TRAVEL] + h * math.sin(x[THETA]))
        depth, _, _ = self.points(x)
        elastic = float((self.bed.shares * stored(self.setup.law, depth, x[PAST:])).sum())
        return kinetic + weight + push + elastic, elastic  # Eq. 125

    def settle(self, x: FloatArray, *, leaves: bool = False) -> None:
        """Set sticking or the direction of sliding of a base at rest."""
        if self.kind is not FrictionKind.COULOMB:
            return
        self.slip = 0
        _, shear, normal = self.forces(x)
        if leaves or abs(shear) > self.coefficient * normal:
            self.slip = -1 if shear > 0.0 else 1


def compute_one(setup: Setup, method: Method = "DOP853", tolerance: float | None = None) -> Run:
    """Compute one impact with its history."""
    from scipy.integrate import solve_ivp

    integrate: Any = solve_ivp  # the type stubs of solve_ivp do not allow callable objects
    field = Field(setup)
    x = np.concatenate([setup.state, np.zeros(7 + len(setup.rigid.bed.positions))])
    x[PAST:] = np.maximum(field.points(x)[0], 0.0)
    before = field.energy(x)[0]
    field.slip = int(np.sign(x[U]))
    if x[U] == 0.0:
        field.settle(x)
    scales, precision = _scales(setup), max(1e-3 * setup.tolerance if tolerance is None else tolerance, 1e-13)
    times, states, time, status, steps = [0.0], [x], 0.0, 2, 0
    while time < setup.longest and status == 2 and len(times) < 10**6:
        events = _events(field)
        run = integrate(
            field, (time, setup.longest), x, method=method, rtol=precision, atol=precision * scales,
            events=[event for event, _ in events], first_step=1e-3 * setup.depth / setup.speed,
        )  # fmt: skip
        steps += len(run.t) - 1
        times += run.t[1:].tolist()
        states += list(run.y.T[1:])
        time, x = float(run.t[-1]), run.y[:, -1].copy()
        event_code = next((code for zeros, (_, code) in zip(run.t_events, events, strict=True) if len(zeros)), None)
        if event_code is None:
            status = 2 if run.status == 0 else 4
            break
        if event_code < 0:
            x[U] = 0.0
            field.settle(x, leaves=field.slip == 0)
        else:
            status = event_code
    return _report(field, before, np.array(times), np.array(states), (status, steps))


def _events(field: Field) -> list[tuple[Event, int]]:
    """Return the events that end an interval, with their status; -1 for changes between sticking and sliding."""
    setup = field.setup
    events: list[tuple[Event, int]] = []

    def peak(_: float, x: FloatArray) -> float:
        return float(x[OMEGA]) if x[IMPULSE] > 0.0 else 1.0

    def topples(_: float, x: FloatArray) -> float:
        return setup.farthest - abs(float(x[THETA]))

    def parts(_: float, x: FloatArray) -> float:
        rate, value = field.points(x)[1:]
        pressing = value > 0.0
        slow = float(rate[pressing].max()) if pressing.any() else 0.0
        return slow - 1e-10 * setup.speed if setup.law.stiffness == 0.0 or not pressing.any() else 1.0

    def slides(_: float, x: FloatArray) -> float:
        if field.slip:
            return field.slip * float(x[U])
        shear, normal = field.forces(x)[1:]
        return float(field.coefficient * normal - abs(shear))

    if setup.end == END_AT_PEAK:
        events += [(peak, 0), (topples, 5)]
    else:
        events.append((parts, 1))
    if field.kind is FrictionKind.COULOMB:
        events.append((slides, -1))
    for event, _ in events:
        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    return events


def _scales(setup: Setup) -> FloatArray:
    d, v, b = setup.depth, setup.speed, setup.half_base
    impulse = setup.rigid.mass * v
    scales: list[float] = [d, d / b, v, v, v / b, d, setup.energy, setup.energy, impulse, impulse * b, impulse, d]
    return np.array(scales + [d] * len(setup.rigid.bed.positions))


def _report(field: Field, before: float, times: FloatArray, states: FloatArray, ended: tuple[int, int]) -> Run:
    setup, last = field.setup, states[-1]
    pointwise = np.array([field.points(x)[2] for x in states])
    shear = np.array([field.forces(x)[1] for x in states])
    pressing = pointwise > 0.0
    others = np.delete(pressing, setup.old_foot, axis=1).any(axis=1)
    rate = np.array([field.points(x)[1][setup.new_foot] for x in states])
    alone = ~np.delete(pressing, setup.new_foot, axis=1).any(axis=1) & (rate <= 1e-3 * setup.speed)
    touch = int(np.argmax(others)) if others.any() else -1
    released = np.flatnonzero(alone[touch:]) if touch >= 0 else np.array([], dtype=int)
    parting = touch + int(released[0]) if released.size else -1
    gain = states[parting] - states[touch] if parting >= 0 else np.zeros_like(last)
    after, elastic = field.energy(last)
    depth = max(float(field.points(x)[0].max()) for x in states)
    values = [
        *last[:5], times[-1], last[TRAVEL], last[BED_LOSS], last[FRICTION_LOSS], before, after, elastic,
        after + last[BED_LOSS] + last[FRICTION_LOSS] - before, pointwise.sum(axis=1).max(), depth,
        times[touch] if touch >= 0 else -1.0, times[parting] if parting >= 0 else -1.0,
        gain[IMPULSE], gain[MOMENT], gain[SHEAR], last[SLID],
    ]  # fmt: skip
    in_contact = np.asarray(pressing.any(axis=1))
    contacts = int(in_contact[0]) + int((in_contact[1:] & ~in_contact[:-1]).sum())
    samples = [
        times, states[:, TRAVEL], pointwise.sum(axis=1), shear, pointwise @ field.bed.positions,
        states[:, BED_LOSS], states[:, FRICTION_LOSS], *states[:, :5].T,
    ]  # fmt: skip
    counts = np.array([*ended, 0, 0, contacts, 0], dtype=np.int64)
    history = dict(zip(SAMPLES, samples, strict=True))
    return named(np.array(values), counts), history, pointwise, _intervals(times, pressing)


def _intervals(times: FloatArray, pressing: BoolArray) -> FloatArray:
    intervals: list[tuple[float, float, float]] = []
    for point, column in enumerate(pressing.T):
        change = np.diff(np.concatenate([[0], column.astype(np.int64), [0]]))
        ends = np.append(times, np.inf)
        intervals += [
            (float(point), float(ends[a]), float(ends[b]))
            for a, b in zip(*(np.flatnonzero(np.equal(change, k)) for k in (1, -1)), strict=True)
        ]
    return np.array(sorted(intervals, key=lambda f: f[2])).reshape(-1, 3)
