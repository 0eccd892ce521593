"""What an impact leaves of an angular velocity: the interface, and the models of restitution behind it."""

import math
import numbers
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.space.body import SpatialBody
from rocking.errors import InvalidValueError
from rocking.portable import dot
from rocking.restitution.space import SpatialHousner, SpatialImpact, SpatialModel, spatial_model, spatial_models
from rocking.restitution.space.impact import NO_MATTER


@runtime_checkable
class SpatialImpactLaw(Protocol):
    """What an impact costs in space; the engine finds which points stay on the ground, a law how fast the body goes on.

    Any object with these two members serves.
    """

    @property
    def label(self) -> str:
        """What to call it in titles and tables."""
        ...

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the angular velocity after an impact.

        Parameters
        ----------
        body : SpatialBody
            The body.
        impact : SpatialImpact
            Angular velocity and pivot before, the corner or edge that stays, and the vertical, in axes of the body.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in axes of the body; along the edge if there is one [rad/s].
        """
        ...


@dataclass(frozen=True)
class ModelLaw:
    """A model of `rocking.restitution.space` as the law of a history."""

    model: SpatialModel

    @property
    def label(self) -> str:
        return self.model.name

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the angular velocity that the model gives."""
        return self.model.turned(impact)


PLASTIC = SpatialHousner()
"""The plastic impact without slip: the orthogonal projection of the velocities in the kinetic metric."""


class FixedSpatial:
    """The direction of the projection, and r of the angular velocity: ``|w+| = r |w-|``, as in the plane.

    It never creates energy: a body that lands on its longer lever keeps at most what it had. A vertex that only grazes
    the ground costs this share as well, which no real impact does: for bodies that turn about edges, not for wobblers.
    """

    def __init__(self, coefficient: float) -> None:
        self.coefficient = checks.within("restitution", coefficient, 0.0, 1.0, hint="more would create energy")

    @property
    def label(self) -> str:
        return f"{self.coefficient:.6g}"

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the scaled projection."""
        made = PLASTIC.turned(impact)  # Eq. 1
        left = body.kinetic(impact.onto.point, made)
        if not left > 0.0:
            return made
        bound = body.kinetic(impact.pivot, impact.velocity) / left
        wanted = self.coefficient**2 * dot(impact.velocity, impact.velocity) / dot(made, made)
        return np.asarray(math.sqrt(min(wanted, bound)) * made)  # Eq. 101


def law_of(restitution: Any, body: SpatialBody | None = None) -> SpatialImpactLaw:
    """Return an impact law of a word, a coefficient or a law."""
    if isinstance(restitution, (str, SpatialModel)):
        model = spatial_model(restitution)
        if model.needs_solid and body is not None and body.matter is None:
            raise InvalidValueError("{parameter} {value}: " + NO_MATTER, parameter="restitution", value=model.name)
        return ModelLaw(model)
    if isinstance(restitution, SpatialImpactLaw) and not isinstance(restitution, type):
        return restitution
    if isinstance(restitution, (bool, np.bool_)) or not isinstance(restitution, numbers.Real):
        raise InvalidValueError(
            "restitution of a body in space must be one of {models}, a coefficient, or an object "
            "with label and velocity_after, got {problem}",
            models=", ".join(spatial_models()),
            problem=_lacking(restitution),
        )
    return FixedSpatial(float(restitution))


def _lacking(restitution: object) -> str:
    """Return what an object is that is no law, and what it lacks."""
    if isinstance(restitution, type):
        return f"the class {restitution.__name__}: create an object, {restitution.__name__}()"
    if type(restitution).__module__ == "builtins":
        return f"{restitution!r:.60}"
    missing = [name for name in ("label", "velocity_after") if not hasattr(restitution, name)]
    return f"a {type(restitution).__name__} object without {' and '.join(missing)}"
