"""Taylor series of a rocking body on a base that moves, over a part of a stretch of the motion."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import mul
from typing import Self

from rocking.bodies.isolated import Isolated
from rocking.dynamics.parameters import RockingSide

Poly = list[float]


@dataclass(frozen=True, slots=True)
class SideConstants:
    """Constants of a body for rotation about one foot."""

    side: int  # +1 right, -1 left
    alpha: float  # slenderness angle [rad]
    static: float  # m R [kg m]
    inertia: float  # moment of inertia about the foot [kg m2]

    @classmethod
    def of(cls, side: int, mass: float, parameters: RockingSide) -> Self:
        """Return the constants of a side."""
        radius = parameters.semi_diagonal
        return cls(side, parameters.slenderness_angle, mass * radius, mass * radius**2 / parameters.inertia_ratio)

    def kinetic(self, theta: float, rate: float, v: float) -> float:
        """Return the kinetic energy of the rotation, with its product with the velocity of the base [J]."""
        cosine = math.cos(self.alpha - self.side * theta)
        return self.static * cosine * rate * v + 0.5 * self.inertia * rate**2


@dataclass
class IsolatedSeries:
    """Series of theta and u over x = t / duration. A recursion fills the fields after `gravity`."""

    order = 24  # highest power of theta and u

    body: Isolated
    constants: SideConstants | None  # of the foot in contact; None for a body at rest on the base
    slip: int  # direction of sliding; 0 for a base that sticks, or without friction
    state: tuple[float, float, float, float]  # theta, theta', u, u'
    duration: float  # [s]
    push: Poly  # acceleration of the ground [m/s2]
    lift: Poly  # vertical acceleration of the ground [m/s2]
    gravity: float  # [m/s2]
    rates: Poly = field(init=False, default_factory=list)  # theta' [rad/s]
    speeds: Poly = field(init=False, default_factory=list)  # u' [m/s]
    acceleration: Poly = field(init=False, default_factory=list)  # absolute acceleration of the base [m/s2]
    normal_force: Poly = field(init=False, default_factory=list)  # force of the ground on the base [N]
    holding_force: Poly = field(init=False, default_factory=list)  # friction that a base without slip needs [N]
    _across: Poly = field(
        init=False, default_factory=list
    )  # horizontal and vertical first moment about the foot [kg m]
    _along: Poly = field(init=False, default_factory=list)
    _square: Poly = field(init=False, default_factory=list)  # theta'^2
    _weighed: Poly = field(init=False, default_factory=list)
    _drive: Poly = field(init=False, default_factory=list)
    _divisor: Poly = field(init=False, default_factory=list)
    _turn: Poly = field(init=False, default_factory=list)  # theta''

    def __post_init__(self) -> None:
        theta, rate, u, v = self.state
        count = self.order - 1
        self._sticks, self._drag = bool(self.body.friction) and not self.slip, self.body.friction * self.slip
        self.push, self.lift = _padded(self.push, count), _padded(self.lift, count)
        self.weight = [self.gravity + self.lift[0], *self.lift[1:]]
        self.theta = [theta, rate * self.duration]
        self.u = [u, 0.0 if self._sticks else v * self.duration]
        self._cosines, self._sines = self._start()
        for k in range(count):
            self._add_rates(k)
            self._add_accelerations(k)

    def _add_rates(self, k: int) -> None:
        """Add term k of velocities and of first moments."""
        if k:
            self._extend(k)
        static = self.constants.static if self.constants else 0.0
        self.rates.append((k + 1) * self.theta[k + 1] / self.duration)
        self.speeds.append((k + 1) * self.u[k + 1] / self.duration)
        self._square.append(_at(k, self.rates, self.rates))
        self._across.append(static * self._cosines[k])
        self._along.append(static * self._sines[k])
        self._weighed.append(_at(k, self._along, self.weight))
        self._drive.append(self._across[k] + self._drag * self._along[k])

    def _add_accelerations(self, k: int) -> None:
        """Add term k of the accelerations and forces, and the next terms of theta and u."""
        total, inertia = self.body.mass + self.body.base_mass, self.constants.inertia if self.constants else 1.0
        spin, fall = _at(k, self._along, self._square), _at(k, self._across, self._square)
        spring = self.body.stiffness * self.u[k] + self.body.damping * self.speeds[k]
        if self._sticks:
            self.acceleration.append(self.push[k])
        else:
            self._divisor.append((0.0 if k else total) - _at(k, self._drive, self._across) / inertia)
            earlier = sum(map(mul, self._divisor[1:], self.acceleration[::-1]))
            force = spring + spin + self._drag * (total * self.weight[k] - fall)
            free = _at(k, self._drive, self._weighed) / inertia - force - earlier
            self.acceleration.append(free / self._divisor[0])  # Eq. 373
        self._turn.append(-(_at(k, self._across, self.acceleration) + self._weighed[k]) / inertia)  # Eq. 372
        self.normal_force.append(total * self.weight[k] + _at(k, self._along, self._turn) - fall)  # Eq. 374
        self.holding_force.append(-spring - total * self.push[k] - _at(k, self._across, self._turn) - spin)
        scale = self.duration**2 / ((k + 1) * (k + 2))
        self.theta.append(scale * self._turn[k] if self.constants else 0.0)
        self.u.append(0.0 if self._sticks else scale * (self.acceleration[k] - self.push[k]))

    def _start(self) -> tuple[Poly, Poly]:
        if self.constants is None:
            return [0.0], [0.0]
        angle = self.constants.alpha - self.constants.side * self.theta[0]
        return [math.cos(angle)], [self.constants.side * math.sin(angle)]

    def _extend(self, k: int) -> None:
        """Extend the cosine of the angle to the vertical, and the sine times the side."""
        steps = [(j + 1) * self.theta[j + 1] / k for j in range(k)]
        cosine = sum(map(mul, steps, self._sines[k - 1 :: -1]))
        self._sines.append(-sum(map(mul, steps, self._cosines[k - 1 :: -1])))
        self._cosines.append(cosine)

    def trusted(self, tolerance: float, alpha: float) -> float:
        """Return the fraction of the series over which the last terms are below the tolerance."""
        fraction, length = 1.0, self.gravity * self.duration**2 * 1e-6
        sizes = (self.theta, max(alpha, abs(self.theta[0]))), (self.u, max(length, *map(abs, self.u[:3])))
        for poly, size in sizes:
            for k in (len(poly) - 2, len(poly) - 1):
                if k * abs(poly[k]) > tolerance * size:
                    fraction = min(fraction, (tolerance * size / (k * abs(poly[k]))) ** (1.0 / k))
        return fraction

    def first(self, fraction: float) -> "IsolatedSeries":
        """Return the series over the first part of its duration."""
        if fraction == 1.0:
            return self
        shorter = object.__new__(IsolatedSeries)
        shorter.__dict__.update(self.__dict__)
        shorter.duration = fraction * self.duration
        for name, values in self.__dict__.items():
            if isinstance(values, list):
                setattr(shorter, name, [c * fraction**k for k, c in enumerate(values)])
        return shorter

    def works(self, until: float) -> tuple[float, float]:
        """Return the work of the ground, and the energy lost in the isolators, up to a fraction of the series."""
        n, body = self.body.mass + self.body.base_mass, self.body
        power = _product(self.push, _sum([n * c for c in self.speeds], _product(self._across, self.rates)))
        power = _sum(power, _product(self.lift, _product(self._along, self.rates)))
        loss = _product(self.speeds, [body.damping * c for c in self.speeds])
        if self.slip:
            drag = body.friction * self.slip
            loss = _sum(loss, _product(self.speeds, [drag * c for c in self.normal_force]))
        return -self._integral(power, until), self._integral(loss, until)  # Eq. 377

    def _integral(self, poly: Poly, until: float) -> float:
        return self.duration * sum(c * until ** (k + 1) / (k + 1) for k, c in enumerate(poly))

    def holding(self, side: SideConstants) -> Poly:
        """Return the restoring moment of a body at rest about one foot."""
        sine, cosine = side.static * math.sin(side.alpha), side.static * math.cos(side.alpha) * side.side
        return [sine * w + cosine * a for w, a in zip(self.weight, self.acceleration, strict=True)]  # Eq. 24

    def grip(self, sign: int) -> Poly:
        """Return the difference of the friction limit and the friction that a base without slip needs."""
        pairs = zip(self.normal_force, self.holding_force, strict=True)
        return [self.body.friction * normal - sign * held for normal, held in pairs]


def _padded(poly: Sequence[float], count: int) -> Poly:
    return [*poly, *[0.0] * (count - len(poly))][:count]


def _at(k: int, a: Poly, b: Poly) -> float:
    """Return term k of a product of series."""
    return float(sum(map(mul, a[: k + 1], b[k::-1])))


def _product(a: Poly, b: Poly) -> Poly:
    return [_at(k, a, b) for k in range(min(len(a), len(b)))]


def _sum(a: Poly, b: Poly) -> Poly:
    return [x + y for x, y in zip(a, b, strict=True)]
