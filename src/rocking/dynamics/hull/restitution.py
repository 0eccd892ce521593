"""What an impact costs a body in space with friction, and where the impulse of a landing acts, for any law."""

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
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.ground import Vector, added, applied, cross, dot, minus, scaled, unit
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.fast_engine import batch_law
from rocking.errors import InvalidValueError
from rocking.restitution.space.calibrated import CalibratedPosition
from rocking.restitution.space.impulse_position import impulse_position

MODELS = ("housner-3d", "ked-3d", "calibrated-3d")
"""Models of `rocking.restitution.space` that friction does not exclude."""

ImpulseLaw = Callable[[Vector, Vector], float]
"""Position k of the impulse of a step between two points of the body, from its centre of mass; 1 at the new one [-]."""


@dataclass(frozen=True)
class FixedPosition:
    """Position k of the impulse of every landing on the base: 0 at the middle of the step, 1 (Housner) at its end."""

    k: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "k", checks.within("k", self.k, 0.0, 1.0))

    def __str__(self) -> str:
        return f"impulse at k = {self.k:.3g}"


def law_of(restitution: Any, body: HullBody, base: int) -> ImpulseLaw:
    """Return k of every step, from the name of a model, a k, or the coefficient of a landing of the whole base."""
    # the base is the facet to which the law belongs: steps elsewhere take k = 1
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
    position = impulse_position(spread_of(body))
    return _on_base(body, base, lambda step: position.at(np.array(step)))


def spread_of(body: HullBody) -> Solid:
    """Return the distribution of mass of a body, which "ked-3d" needs; refused where its moments alone are known."""
    if body.solid is None:
        raise InvalidValueError(
            "restitution 'ked-3d' needs the distribution of mass, and of this body moments alone are known: give the"
            " HullBody its solid"
        )
    return body.solid


@lru_cache(maxsize=256)
def position_on_base(body: HullBody) -> CalibratedPosition:
    """Return the impulse position of a landing on the base by the calibrated model, kept for the body."""
    base, (x, y, _) = body.footprint, body.centre.tolist()
    if base is None:
        if dot(unit(body.facets[body.base]), (0.0, 0.0, -1.0)) < 1.0 - 1e-12:
            raise InvalidValueError("restitution 'calibrated-3d' needs a body on a level base, in its own axes")
        corners = body.hull.vertices[body.hull.corners(body.base)][::-1]  # clockwise seen from below
        base = SupportPolygon(corners[:, :2] + [x, y])
    second = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    centre = np.array([x, y, body.hull.heights[body.base]])
    return CalibratedPosition(SolidMoments(body.mass, centre, second), base)


def _on_base(body: HullBody, base: int, position: Callable[[Vector], float], highest: float = 1.0) -> ImpulseLaw:
    """Keep a law to steps within the base, and k from 0 to 1, where no force pulls; a stated loss may be larger."""
    normal, height = unit(body.facets[base]), float(body.hull.heights[base])

    def at(old: Vector, new: Vector) -> float:
        lies = all(height - dot(normal, p) <= FLAT * body.size for p in (old, new))
        return min(max(position(minus(new, old)), 0.0), highest) if lies else 1.0

    return at


def _of_coefficient(body: HullBody, base: int, r: float) -> Callable[[Vector], float]:
    """Return where, in the direction of a step, the impulse of a landing of the whole base gives one coefficient."""
    corners = [body.points[i] for i in body.hull.corners(base)]
    up, height = scaled(-1.0, unit(body.facets[base])), float(body.hull.heights[base])

    def at(step: Vector) -> float:
        along = unit(added(step, -dot(step, up), up))
        edge = cross(up, along)
        reaches = [dot(along, p) for p in corners]
        new, old = max(reaches), -min(reaches)
        over_foot = dot(edge, applied(body.tensor, edge)) / body.mass + height**2
        ahead = over_foot * (1.0 - r) / (r * new + old)  # Eq. 4
        return (2.0 * ahead - (new - old)) / (new + old)  # Eq. 104

    return at


def place_of(law: ImpulseLaw, old: Vector, new: Vector) -> Vector:
    """Return where the impulse of a step acts."""
    step = minus(new, old)
    if not math.sqrt(dot(step, step)) > 0.0:
        return new
    return added(new, -0.5 * (1.0 - law(old, new)), step)  # Eq. 254


def nearest(points: list[Vector], to: Vector) -> Vector:
    """Return the point of a vertex, an edge or a facet (by its border) that is nearest to another one."""
    if len(points) == 1:
        return points[0]
    best = points[0]
    for k, a in enumerate(points):
        b = points[(k + 1) % len(points)]
        along = minus(b, a)
        share = dot(minus(to, a), along) / dot(along, along)
        found = added(a, min(max(share, 0.0), 1.0), along)
        gap, least = minus(found, to), minus(best, to)
        if dot(gap, gap) < dot(least, least):
            best = found
    return best


def law_on_hull(restitution: Any) -> str | float | FixedPosition:
    """Return a restitution as the hull engine takes it.

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
    """What an impact costs a body in space, and the body: its rows say size, coefficient, friction and scale alone."""

    body: Any = None  # a Solid, or what knows of which it is made
    model: str | float = "ked-3d"
    frequency: float = 1.0  # of the body under `gravity`: what rows of other sizes are compared with [rad/s]
    gravity: float = field(default=1.0)  # [m/s2]
    slenderness_angle: float = 1.0  # the least over the edges of its base [rad]
    size: float = 1.0  # R [m]

    @cached_property
    def on_hull(self) -> HullBody:
        """The body on the vertices of its hull; refused where the model needs to know more of it."""
        made = HullBody.of(self.body)
        if self.model == "ked-3d":
            spread_of(made)
        return made

    @property
    def tabulated(self) -> bool:
        """True: its engine knows it."""
        return True

    @property
    def label(self) -> str:
        """The model, or the coefficient."""
        return self.model if isinstance(self.model, str) else f"{self.model:.6g}"

    @classmethod
    def of(cls, body: Any, restitution: Any, gravity: float) -> "RestitutionOnHull":
        """Return the law of a body in space."""
        law = None if isinstance(restitution, ImpactLaw) else law_on_hull(restitution)
        if law is None or isinstance(law, FixedPosition):
            raise InvalidValueError(
                "a body in space takes a model or one coefficient in a study, got {law}", parameter="restitution",
                law=type(restitution).__name__,
            )  # fmt: skip
        made = SpatialBody.of(body)
        angle = math.atan2(made.reach, float(made.centre[2]))
        return cls(
            body=body, model=law, frequency=made.frequency(gravity), gravity=gravity, slenderness_angle=angle,
            size=made.size,
        )  # fmt: skip

    def content(self) -> dict[str, Any]:
        """Return mass, centre, inertia and hull of the body, and the model."""
        made = self.on_hull
        arrays = {"centre": made.centre, "inertia": made.inertia, "hull": made.hull.vertices}
        return {"model": self.model, "mass": made.mass, **{name: hash_of(each) for name, each in arrays.items()}}
