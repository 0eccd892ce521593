"""Restitution of a 3D body with friction: impulse position of a landing, for all laws."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.equilibria.polytope import FLAT
from rocking.bodies.solid import Solid, SolidMoments, SupportPolygon
from rocking.dynamics.content import hash_of
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import Vector, added, applied, cross, dot, minus, scaled, unit
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.fast_engine import batch_law
from rocking.errors import InvalidValueError
from rocking.restitution.space.calibrated import CalibratedPosition
from rocking.restitution.space.impulse_position import impulse_position

MODELS = ("housner-3d", "ked-3d", "calibrated-3d")
"""Models of `rocking.restitution.space` for bodies with friction."""

ImpulseLaw = Callable[[Vector, Vector], float]
"""Impulse position k of a step from an old to a new point [-].

Points are relative to the centre of mass; k = 1 at the new point.
"""


@dataclass(frozen=True)
class FixedPosition:
    """Constant impulse position k of landings on the base: 0 at the middle of the step, 1 (Housner) at its end."""

    k: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "k", checks.within("k", self.k, 0.0, 1.0))

    def __str__(self) -> str:
        return f"impulse at k = {self.k:.3g}"


def law_of(restitution: Any, body: HullBody, base: int) -> ImpulseLaw:
    """Return the law of the impulse position from a model name, a fixed k, or the coefficient of a full landing."""
    # the law applies to the facet `base`; steps on other facets have k = 1
    law = law_on_hull(restitution)
    if isinstance(law, FixedPosition):
        return _on_base(body, base, lambda _step: law.k)
    if isinstance(law, float):
        return _on_base(body, base, _of_coefficient(body, base, law), math.inf)
    if law == "housner-3d":
        return lambda _old, _new: 1.0
    if law == "calibrated-3d":
        calibrated = position_on_base(body)
        return _on_base(body, base, lambda step: calibrated.at(np.array(step)), math.inf)
    position = impulse_position(mass_distribution(body))
    return _on_base(body, base, lambda step: position.at(np.array(step)))


def mass_distribution(body: HullBody) -> Solid:
    """Return the distribution of mass of a body for "ked-3d". Raise an error if only its moments are given."""
    if body.solid is None:
        raise InvalidValueError(
            "restitution 'ked-3d' needs the distribution of mass, but this body has moments only; give HullBody a solid"
        )
    return body.solid


@lru_cache(maxsize=256)
def position_on_base(body: HullBody) -> CalibratedPosition:
    """Return the impulse position of a landing on the base by the calibrated model. The result is cached."""
    base, (x, y, _) = body.footprint, body.centre.tolist()
    if base is None:
        if dot(unit(body.facets[body.base]), (0.0, 0.0, -1.0)) < 1.0 - 1e-12:
            raise InvalidValueError("restitution 'calibrated-3d' needs a body with a level base in its axes")
        corners = body.hull.vertices[body.hull.corners(body.base)][::-1]  # clockwise seen from below
        base = SupportPolygon(corners[:, :2] + [x, y])
    second = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    centre = np.array([x, y, body.hull.heights[body.base]])
    return CalibratedPosition(SolidMoments(body.mass, centre, second), base)


def _on_base(body: HullBody, base: int, position: Callable[[Vector], float], highest: float = 1.0) -> ImpulseLaw:
    """Limit a law to steps within the base and to k from 0 to `highest`; k <= 1 avoids tensile impulses."""
    normal, height = unit(body.facets[base]), float(body.hull.heights[base])

    def at(old: Vector, new: Vector) -> float:
        is_on_base = all(height - dot(normal, p) <= FLAT * body.size for p in (old, new))
        return min(max(position(minus(new, old)), 0.0), highest) if is_on_base else 1.0

    return at


def _of_coefficient(body: HullBody, base: int, r: float) -> Callable[[Vector], float]:
    """Return a function from a step to the position k that gives a landing of the full base the coefficient r."""
    corners = [body.points[i] for i in body.hull.corners(base)]
    up, height = scaled(-1.0, unit(body.facets[base])), float(body.hull.heights[base])

    def at(step: Vector) -> float:
        along = unit(added(step, -dot(step, up), up))
        edge = cross(up, along)
        reaches = [dot(along, p) for p in corners]
        new, old = max(reaches), -min(reaches)
        over_foot = dot(edge, applied(body.tensor, edge)) / body.mass + height**2
        distance = over_foot * (1.0 - r) / (r * new + old)  # Eq. 4
        return (2.0 * distance - (new - old)) / (new + old)  # Eq. 104

    return at


def impulse_point(law: ImpulseLaw, old: Vector, new: Vector) -> Vector:
    """Return the point of action of the impulse of a step from an old to a new point."""
    step = minus(new, old)
    if not math.sqrt(dot(step, step)) > 0.0:
        return new
    return added(new, -0.5 * (1.0 - law(old, new)), step)  # Eq. 254


def nearest(points: list[Vector], to: Vector) -> Vector:
    """Return the point of a vertex, an edge or a border of a facet that is nearest to another point."""
    if len(points) == 1:
        return points[0]
    best = points[0]
    for k, a in enumerate(points):
        b = points[(k + 1) % len(points)]
        along = minus(b, a)
        fraction = dot(minus(to, a), along) / dot(along, along)
        candidate = added(a, min(max(fraction, 0.0), 1.0), along)
        gap, best_gap = minus(candidate, to), minus(best, to)
        if dot(gap, gap) < dot(best_gap, best_gap):
            best = candidate
    return best


def law_on_hull(restitution: Any) -> str | float | FixedPosition:
    """Return a restitution in the form of the hull engine.

    >>> law_on_hull("ked"), law_on_hull(0.8)
    ('ked-3d', 0.8)
    """
    if isinstance(restitution, FixedPosition):
        return restitution
    law = batch_law(restitution)
    coefficient = getattr(law.law, "coefficient", None)
    if coefficient is not None:
        return float(coefficient)
    if law.label not in MODELS:
        raise InvalidValueError(
            "{parameter} of a body in space with friction must be {allowed}, got {value}", parameter="restitution",
            allowed=f"{', '.join(map(repr, MODELS))} or a coefficient from 0 to 1", value=law.label,
        )  # fmt: skip
    return law.label


@dataclass(frozen=True, eq=False)
class RestitutionOnHull(ConstantRestitution):
    """Restitution and body for rows. The rows contain only size, coefficient, friction and scale."""

    body: Any = None  # a Solid, or a body with a distribution of mass
    model: str | float = "ked-3d"
    frequency: float = 1.0  # p of the body under `gravity` [rad/s]; rows with another p have another size
    gravity: float = field(default=1.0)  # [m/s2]
    slenderness_angle: float = 1.0  # smallest slenderness angle over the edges of the base [rad]
    size: float = 1.0  # semi-diagonal R [m]

    @cached_property
    def on_hull(self) -> HullBody:
        """The body on the vertices of its hull. Raises an error if the model needs more data."""
        hull_body = HullBody.of(self.body)
        if self.model == "ked-3d":
            mass_distribution(hull_body)
        return hull_body

    @property
    def tabulated(self) -> bool:
        """True, because the fast engine supports this law."""
        return True

    @property
    def label(self) -> str:
        """Label: the model, or the coefficient."""
        return self.model if isinstance(self.model, str) else f"{self.model:.6g}"

    @classmethod
    def of(cls, body: Any, restitution: Any, gravity: float) -> "RestitutionOnHull":
        """Return the law of a body in space."""
        law = None if isinstance(restitution, ImpactLaw) else law_on_hull(restitution)
        if law is None or isinstance(law, FixedPosition):
            raise InvalidValueError(
                "{parameter} of a body in space in a study must be a model or one coefficient, got {law}",
                parameter="restitution", law=type(restitution).__name__,
            )  # fmt: skip
        spatial_body = SpatialBody.of(body)
        angle = math.atan2(spatial_body.reach, float(spatial_body.centre[2]))
        return cls(
            body=body, model=law, frequency=spatial_body.frequency(gravity), gravity=gravity, slenderness_angle=angle,
            size=spatial_body.size,
        )  # fmt: skip

    def content(self) -> dict[str, Any]:
        """Return mass, centre of mass, inertia and hull of the body, and the model, as plain values."""
        hull_body = self.on_hull
        arrays = {"centre": hull_body.centre, "inertia": hull_body.inertia, "hull": hull_body.hull.vertices}
        return {"model": self.model, "mass": hull_body.mass, **{name: hash_of(array) for name, array in arrays.items()}}
