"""3D models by the impulse position of a landing of the full base, for every direction (Eq. 104).

The position k is an analytic function of the azimuth of the step between azimuths at which a foot changes. Polynomials
interpolate a few exact values between these azimuths.
"""

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import ClassVar

import numpy as np

from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid import Part, RoundBase, Solid, SupportPolygon
from rocking.bodies.solid.base import Base
from rocking.bodies.solid.sampling import samples
from rocking.conventions import FloatArray
from rocking.portable import applied, dot
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.integrals import exact_moment, height_squared
from rocking.restitution.space.model import SpatialFlag, SpatialModel

HIGHEST = 32  # largest degree of the polynomials

_SAME, _CONVERGED, _NEGLIGIBLE = 1e-9, 1e-10, 1e-7
_ARCS = 8
_PIECE = 4096  # points per block; a block fits in the cache


@dataclass(frozen=True, eq=False)
class BaseLanding:
    """Landing of the full base in one direction, from the old foot onto the new foot."""

    edge: FloatArray  # unit vector along the new foot [-]; shape (3,)
    offset: float  # distance of the new foot from the origin, in the direction of the step [m]
    over_foot: float  # moment of inertia about the line through the foot of the plumb line [kg m2]
    old_lever: float  # distance of the old foot from the plumb line [m]
    new_lever: float  # distance of the new foot from the plumb line [m]


class ImpulsePosition(ABC):
    """Impulse position k as a function of the landing direction, for a landing on the full base."""

    # breaks: azimuths at which a foot changes, in order [rad]

    def __init__(self, moments: SolidMoments, base: Base) -> None:
        self.moments, self.base, self.size = moments, base, base.size
        self.height = float(moments.centre[2] - base.height)
        self.breaks = _breaks(base)
        self._pieces: dict[int, list[float]] = {}

    @abstractmethod
    def coefficient(self, landing: BaseLanding) -> float:
        """Return the coefficient of restitution of a landing of the full base [-]."""

    def at(self, step: FloatArray) -> float:
        """Return k of the landing in a direction, in the frame of the solid [-]; above 1 beyond the new foot."""
        angle, breaks = math.atan2(float(step[1]), float(step[0])), self.breaks
        if angle < breaks[0]:
            angle += 2.0 * math.pi
        index = min(bisect_right(breaks, angle) - 1, len(breaks) - 2)
        low, high = breaks[index : index + 2]
        return _value(self.piece(index), (2.0 * angle - low - high) / (high - low))

    def of_step(self, step: FloatArray) -> float:
        """Return k of a step in the frame of the body [-]; 1 for a step of length zero."""
        return self.at(step) if float(np.abs(step).max()) > _ROUNDING * self.size else 1.0

    def piece(self, index: int) -> list[float]:
        """Return Chebyshev coefficients of k between the azimuth `index` of `breaks` and the next azimuth."""
        if index not in self._pieces:
            low, high = self.breaks[index : index + 2]
            self._pieces[index] = self._fitted(0.5 * (low + high), 0.5 * (high - low))
        return self._pieces[index]

    def table(self) -> list[list[float]]:
        """Return one row per piece: first and last azimuth [rad], and `HIGHEST` + 1 coefficients."""
        rows = [[*ends, *self.piece(k)] for k, ends in enumerate(pairwise(self.breaks))]
        return [row + [0.0] * (HIGHEST + 3 - len(row)) for row in rows]

    def exact(self, angle: float) -> float:
        """Return k of the landing at an azimuth from x towards y [rad], without interpolation [-]."""
        moments, x, y = self.moments, math.cos(angle), math.sin(angle)
        edge = np.array([-y, x, 0.0])
        new, old = (_reach(self.base, sign * x, sign * y) for sign in (1.0, -1.0))
        middle = float(moments.centre[0]) * x + float(moments.centre[1]) * y
        b_new, b_old, mass = new - middle, old + middle, moments.mass
        over_foot = float((edge * (moments.inertia * edge).sum(axis=1)).sum()) + mass * self.height**2
        r = self.coefficient(BaseLanding(edge, new, over_foot, b_old, b_new))
        ahead = over_foot * (1.0 - r) / (mass * (r * b_new + b_old))  # Eq. 4
        return (2.0 * ahead - (b_new - b_old)) / (b_new + b_old)  # Eq. 104

    def _fitted(self, middle: float, half: float) -> list[float]:
        degree, values = 4, [self.exact(middle + half * math.cos(math.pi * j / 4)) for j in range(5)]
        coefficients = _coefficients(values)
        while degree < HIGHEST and max(map(abs, coefficients[-2:])) > _CONVERGED * max(1.0, *map(abs, values)):
            degree *= 2
            nodes = [math.cos(math.pi * j / degree) for j in range(degree + 1)]
            values = [self.exact(middle + half * nodes[j]) if j % 2 else values[j // 2] for j in range(degree + 1)]
            coefficients = _coefficients(values)
        return coefficients


class KedPosition(ImpulsePosition):
    """Position k of the impulse by the energy balance of Mao et al. (2024)."""

    def __init__(self, solid: Solid) -> None:
        super().__init__(solid.local_moments, solid.local_base)
        self.solid, self.size = solid, solid.size

    def coefficient(self, landing: BaseLanding) -> float:
        """Return the square root of the ratio of kinetic energies after and before the impact [-]."""
        projected = self._projected(landing.edge, landing.offset)
        total = landing.over_foot + self.moments.mass * landing.new_lever**2
        return math.sqrt(max(projected, 0.0) / total)  # Eq. 17, Mao et al. 2024

    def _projected(self, edge: FloatArray, offset: float) -> float:
        """Return the numerator of Eq. 17 about a level line at an offset from the origin of the frame of the solid."""
        total, point = 0.0, np.array([offset * edge[1], -offset * edge[0], 0.0])
        for part in self.solid.local_parts:
            exact = exact_moment(part, point, edge)
            total += exact if exact is not None else _of_cloud(_cloud(part), edge, offset)
        return total


@lru_cache(maxsize=256)
def impulse_position(solid: Solid) -> KedPosition:
    """Return the impulse position by KED. Results are cached by solid."""
    return KedPosition(solid)


def _breaks(base: Base) -> list[float]:
    if isinstance(base, SupportPolygon):
        normals = [math.atan2(-float(along.direction[0]), float(along.direction[1])) for along in base.edges]
        candidates = sorted(math.remainder(angle + turn, 2.0 * math.pi) for angle in normals for turn in (0.0, math.pi))
    else:
        candidates = [2.0 * math.pi * (j / _ARCS - 0.5) for j in range(_ARCS)]
    angles = [candidates[0]]
    angles += [angle for last, angle in pairwise(candidates) if angle - last > _SAME]
    if angles[0] + 2.0 * math.pi - angles[-1] <= _SAME:
        angles.pop()
    return [*angles, angles[0] + 2.0 * math.pi]


def _reach(base: Base, x: float, y: float) -> float:
    """Return the distance from the origin to the line that touches the base in a direction [m]."""
    if isinstance(base, SupportPolygon):
        return float((base.vertices[:, 0] * x + base.vertices[:, 1] * y).max())
    assert isinstance(base, RoundBase)
    return float(base.centre[0]) * x + float(base.centre[1]) * y + base.radius


@lru_cache(maxsize=16)
def _cloud(part: Part) -> FloatArray:
    # z^4/(t^2 + z^2) is homogeneous about any line on the ground; for all directions, it is rough only for small z
    shape, top = part.shape, float(part.box()[1][2])
    negligible = _NEGLIGIBLE * shape.moments().mass * top * top
    batches = samples(shape.surfaces(part.rotation, part.translation), _height, negligible, height_squared)
    rows = [np.column_stack([points, part.density * areas]) for points, areas in batches]
    return np.ascontiguousarray(np.concatenate(rows).T)


def _of_cloud(cloud: FloatArray, edge: FloatArray, offset: float) -> float:
    """Return ``Int z^4/(t^2 + z^2) dm = sum z^4/(t^2 + z^2) (s . dA)/5`` by Gauss points of the surface."""
    terms = np.empty(cloud.shape[1])
    for first in range(0, terms.size, _PIECE):
        x, y, z, ax, ay, az = cloud[:, first : first + _PIECE]
        across, along = x * edge[1] - y * edge[0] - offset, x * edge[0] + y * edge[1]
        cone = across * (ax * edge[1] - ay * edge[0]) + along * (ax * edge[0] + ay * edge[1]) + z * az
        square = z * z
        distance = np.maximum(across * across + square, 1e-300)
        terms[first : first + _PIECE] = cone * square * square / distance
    return 0.2 * float(terms.sum())  # Eq. 107


def _height(points: FloatArray) -> FloatArray:
    return np.abs(points[:, 2])


def _coefficients(values: list[float]) -> list[float]:
    """Return Chebyshev coefficients from values at cos(pi j/n)."""
    n = len(values) - 1
    ends = [0.5 if j in {0, n} else 1.0 for j in range(n + 1)]
    coefficients = []
    for k in range(n + 1):
        total = sum(w * v * math.cos(math.pi * j * k / n) for j, (w, v) in enumerate(zip(ends, values, strict=True)))
        coefficients.append(2.0 * ends[k] * total / n)
    return coefficients


def _value(coefficients: list[float], x: float) -> float:
    """Return the value of a Chebyshev series by Clenshaw's recurrence."""
    current = previous = 0.0
    for coefficient in reversed(coefficients[1:]):
        current, previous = 2.0 * x * current - previous + coefficient, current
    return x * current - previous + coefficients[0]


_ROUNDING = 1e-12


class ImpulsePositionModel(SpatialModel):
    """Base class of models that conserve angular momentum about a point between the old and the new pivot."""

    highest: ClassVar[float] = 1.0  # largest k; 1 is the new foot (Housner's model)

    @abstractmethod
    def position(self, impact: SpatialImpact) -> ImpulsePosition:
        """Return the impulse position of landings of the full base.

        Parameters
        ----------
        impact : SpatialImpact
            Impact of the body.

        Returns
        -------
        ImpulsePosition
            Position k by the direction of the step.
        """

    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        """Return the velocity from angular momentum about the impulse position, or along an edge [rad/s]."""
        step, axis = _step(impact), impact.edge
        k = min(self.position(impact).of_step(step), self.highest)
        velocity = _velocity_about(impact, step, k)
        if k < 1.0 and _push(impact, velocity) < 0.0:
            velocity = _velocity_about(impact, step, 1.0)
        after = 0.5 * dot(velocity, applied(impact.inertia, velocity))
        if after > impact.energy:
            velocity = velocity * math.sqrt(impact.energy / after)
        return velocity if axis is None else dot(velocity, axis) * axis

    def flags(self, impact: SpatialImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return the flag of a tensile contact force."""
        scale = impact.moments.mass * impact.speed * float(np.abs(impact.moments.centre).max())
        return (SpatialFlag.PULLS,) * bool(_push(impact, velocity) < -_ROUNDING * scale)


@dataclass(frozen=True)
class SpatialKed(ImpulsePositionModel):
    """Kinetic energy distribution with an impulse position, for steps of any length between any pivots.

    The paper gives the energy loss of a landing of the full base. From this loss follows the impulse position, k times
    half the distance between the feet (`ImpulsePosition`). k is limited to 1, the new foot, because the contact force
    would be tensile beyond. The model uses this k, not the coefficient, for a step from any pivot P to any pivot Q. The
    impulse acts at ``X = (P + Q)/2 + k (Q - P)/2``. Angular momentum about X is conserved (about an edge, its
    component): ``I_C w+ + m rho_X x (w+ x rho_Q) = I_C w- + m rho_X x (w- x rho_P)``.

    A rectangle that lands on its edge has the coefficient of the paper. A step of length zero has no loss. The loss of
    n small steps is 1/n of the loss of one large step, so that a rim rolls without loss.

    The closure is an assumption of this project, not of the paper.
    """

    name = "ked-3d"
    title = "momentum about the impulse position of the paper's energy balance (this project's closure)"
    reference = "Mao, Deng, Shen & Wang 2024, doi:10.3390/buildings14072119, closed by momentum in this project"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "a landing of the full base has the loss of the paper, by one impulse between the old and the new foot",
        "a smaller step has its impulse at the same fraction of the step, that of the direction of the step in the "
        "upright body",
        "for a position beyond the new foot, or a tensile impulse, the impulse acts at the new foot (Housner)",
    )
    needs_solid = True
    domain = (
        "every impact on one corner or edge, in any attitude; the paper publishes homogeneous rectangles in the plane"
    )
    known_defects = (
        "for a landing of the full base all defects of KED in the plane; with feet so narrow that k exceeds 1 the "
        "coefficient of the paper is not reached, which a flag reports",
        "the assumptions that the fraction is equal for small and large steps, and that the tilt at the landing has "
        "no influence, are not verified",
        "very squat bodies (k below 0.3) would gain energy in rare steps; the velocity is then limited by the energy",
        "equal to Housner's model onto an edge through the old pivot, and onto the full base",
    )

    def position(self, impact: SpatialImpact) -> ImpulsePosition:
        """Return the position by the energy balance of the paper."""
        return impulse_position(impact.solid)

    def flags(self, impact: SpatialImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return the flags of a limited k and of a tensile contact force."""
        return (SpatialFlag.CUT,) * self.cut(impact.solid, _step(impact)) + super().flags(impact, velocity)

    def cut(self, solid: Solid, step: FloatArray) -> bool:
        """Return True if k of a step is limited, because the base is too narrow in this direction for the loss.

        Parameters
        ----------
        solid : Solid
            The body.
        step : ndarray, shape (3,)
            Vector from the old to the new pivot, in the axes of the solid [m].

        Returns
        -------
        bool
            True if the impulse position is beyond the new foot and is moved to the new foot.
        """
        return impulse_position(solid).of_step(step) > 1.0 + _ROUNDING


def _step(impact: SpatialImpact) -> FloatArray:
    """Return the vector from the old pivot to the landing point, perpendicular to a landing edge [m]."""
    step = impact.onto.point - impact.pivot
    return step if impact.edge is None else step - dot(step, impact.edge) * impact.edge


def _velocity_about(impact: SpatialImpact, step: FloatArray, k: float) -> FloatArray:
    """Return the velocity from angular momentum about X, at (1 - k)/2 of the step behind the landing point [rad/s]."""
    arm, back = impact.moments.centre, 0.5 * (1.0 - k) * impact.moments.mass * step
    momentum = impact.angular_momentum + _cross(back, _centre_velocity(impact))
    inertia = impact.inertia + dot(back, arm) * np.eye(3) - arm[:, None] * back  # Eq. 103
    if impact.edge is not None:
        return impact.edge * (dot(impact.edge, momentum) / dot(impact.edge, applied(inertia, impact.edge)))
    # Cramer's rule for a matrix that is not symmetric; it gives equal bits on all processors
    a, b, c = inertia.T
    volume = dot(a, _cross(b, c))
    return np.array([dot(momentum, _cross(*pair)) for pair in ((b, c), (c, a), (a, b))]) / volume  # Eq. 103


def _centre_velocity(impact: SpatialImpact) -> FloatArray:
    return _cross(impact.velocity, impact.moments.centre + impact.onto.point - impact.pivot)


def _push(impact: SpatialImpact, velocity: FloatArray) -> float:
    """Return the vertical impulse of the ground [N s]."""
    change = _cross(velocity, impact.moments.centre) - _centre_velocity(impact)
    return impact.moments.mass * dot(impact.up, change)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    x, y, z = a.tolist()
    u, v, w = b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
