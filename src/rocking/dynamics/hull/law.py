"""What an impact costs a body in space with friction, and the law of studies, which knows the body."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from rocking.dynamics.content import hash_of
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.fast_engine import batch_law
from rocking.errors import InvalidValueError


def law_on_hull(restitution: Any) -> str | float:
    """Return a restitution as the hull engine takes it.

    >>> law_on_hull("ked"), law_on_hull(0.8)
    ('ked-3d', 0.8)
    """
    law = batch_law(restitution)
    coefficient = getattr(law.law, "coefficient", None)
    if coefficient is not None:
        return float(coefficient)
    if law.label not in ("housner-3d", "ked-3d"):
        raise InvalidValueError(
            f"restitution of a body in space with friction must be 'housner-3d', 'ked-3d' or a coefficient from 0 to "
            f"1, got {law.label!r:.60}"
        )
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
        """The body on the vertices of its hull."""
        return HullBody.of(self.body)

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
        if isinstance(restitution, ImpactLaw):
            raise InvalidValueError(
                f"a body in space takes a model or one coefficient in a study, got {type(restitution).__name__}"
            )
        law, made = law_on_hull(restitution), SpatialBody.of(body)
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
