"""Taylor series of a body with restraints: rotation, elongations and rates of one step, by recursion."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import mul

from rocking.dynamics.restrained.laws import ForceLaw
from rocking.dynamics.restrained.levers import Lever

_SMALLEST = 1e-22

Poly = list[float]


@dataclass(frozen=True, slots=True)
class Equation:
    """Constants of the equation of motion about one foot."""

    side: int
    alpha: float  # [rad]
    p: float  # [rad/s]
    inertia: float  # moment of inertia about the foot [kg m2]
    linear: bool


@dataclass(slots=True)
class RestraintSeries:
    """Series of one restraint over x = t / h."""

    law: ForceLaw
    lever: Lever
    elongation: Poly = field(default_factory=list)  # [m]
    slope: Poly = field(default_factory=list)  # de/dtheta [m]
    rate: Poly = field(default_factory=list)  # de/dx [m]
    viscous: Poly = field(default_factory=list)  # viscous force [N]
    root: Poly = field(default_factory=list)  # |e'|^a
    is_viscous: bool = True  # False if the viscous force is omitted

    def moments(self, k: int, theta: Poly, sines: Poly, cosines: Poly, half: Poly, h: float) -> float:
        """Extend all series to the power k. Return coefficient k of the moment N de/dtheta [N m]."""
        law, lever, slope = self.law, self.lever, self.slope
        constant, stiffness = law.phase.constant, law.phase.stiffness
        if lever.is_linear:
            slope.append(0.0 if k else lever.at_rest)
            self.elongation.append(lever.at_rest * theta[k])
            moment = lever.at_rest * (stiffness * self.elongation[k] + (0.0 if k else constant))
        else:
            along = lever.along * sines[k] - lever.across * cosines[k]
            if lever.is_parallel:
                slope.append(along)
                self._extend_elongation(k, theta)
            elif lever.length:
                self._extend_slope(k, along, theta[0])
            else:
                slope.append(lever.radius * half[k])
                self._extend_elongation(k, theta)
            if lever.is_parallel:
                moment = constant * slope[k]
                moment += stiffness * sum(map(mul, self.elongation, slope[k::-1])) if stiffness else 0.0
            else:
                moment = (constant - stiffness * lever.length) * slope[k] + stiffness * along  # Eq. 347
        self.rate.append(sum((j + 1) * theta[j + 1] * slope[k - j] for j in range(k + 1)))
        if law.coefficient and self.is_viscous:
            self._extend_viscous(k, h)
            moment += sum(map(mul, self.viscous, slope[k::-1]))
        return moment

    def _extend_slope(self, k: int, along: float, theta: float) -> None:
        """Extend the slope, the quotient of arm and distance, L G = B sin theta - C cos theta."""
        e, lever = self.elongation, self.lever
        if k == 0:
            e.append(lever.elongation(theta))
            self.slope.append(along / (lever.length + e[0]))
            return
        e.append(self.rate[k - 1] / k)
        past = sum(e[j] * self.slope[k - j] for j in range(1, k + 1))
        self.slope.append((along - past) / (lever.length + e[0]))

    def _extend_elongation(self, k: int, theta: Poly) -> None:
        self.elongation.append(self.rate[k - 1] / k if k else self.lever.elongation(theta[0]))

    def _extend_viscous(self, k: int, h: float) -> None:
        """Extend the series of c |e'|^a sgn e' by its differential equation."""
        law, rate, root = self.law, self.rate, self.root
        if law.exponent == 1.0:
            self.viscous.append(law.coefficient * rate[k] / h)
            return
        a = law.exponent
        if k == 0:
            root.append(abs(rate[0] / h) ** a)
        else:
            total = sum((a * j - (k - j)) * rate[j] * root[k - j] for j in range(1, k + 1))
            root.append(total / (k * rate[0]))  # Eq. 348
        self.viscous.append(math.copysign(law.coefficient, rate[0]) * root[k])


def series(  # noqa: PLR0917 - the state and the ground in the order of the equation
    equation: Equation,
    theta: float,
    velocity: float,
    h: float,
    push: Sequence[float],
    weight: Sequence[float],
    restraints: Sequence[RestraintSeries],
    order: int,
) -> Poly:
    """Return the coefficients of theta over x = t / h. `push` is a_x / g, `weight` is 1 + a_z / g."""
    terms, to_top = [theta, velocity * h], equation.side * equation.alpha
    sines, cosines = [math.sin(theta)], [math.cos(theta)]
    half_sines, half = [math.sin(0.5 * theta)], [math.cos(0.5 * theta)]
    top_sine, top_cosine = math.sin(to_top), math.cos(to_top)
    falls: Poly = []
    arms: Poly = []
    floor, small, h2 = _SMALLEST * max(equation.alpha, abs(theta)), 0, h * h
    halves = any(not item.lever.length for item in restraints)
    ends_early = all(item.law.exponent == 1.0 or not item.is_viscous for item in restraints)
    for k in range(order - 1):
        if k:
            steps = [(j + 1) * terms[j + 1] / k for j in range(k)]
            sines.append(sum(map(mul, steps, cosines[k - 1 :: -1])))
            cosines.append(-sum(map(mul, steps, sines[k - 1 :: -1])))
            if halves:
                half_sines.append(0.5 * sum(map(mul, steps, half[k - 1 :: -1])))
                half.append(-0.5 * sum(map(mul, steps, half_sines[k - 1 :: -1])))
        if equation.linear:
            falls.append((0.0 if k else to_top) - terms[k])
            arms.append(0.0 if k else 1.0)
        else:
            falls.append(top_sine * cosines[k] - top_cosine * sines[k])
            arms.append(top_cosine * cosines[k] + top_sine * sines[k])
        moment = sum(map(mul, weight, falls[k::-1])) + sum(map(mul, push, arms[k::-1]))
        acceleration = -(equation.p**2) * moment
        for item in restraints:
            acceleration -= item.moments(k, terms, sines, cosines, half, h) / equation.inertia
        terms.append(h2 * acceleration / ((k + 1) * (k + 2)))  # Eq. 346
        small = small + 1 if abs(terms[-1]) <= floor and k >= len(push) + len(weight) else 0
        if small == 3 and ends_early:
            break
    return terms
