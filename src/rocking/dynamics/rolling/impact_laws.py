"""Angular velocity after a 3D impact: the interface, and its restitution models."""

import math
import numbers
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.rolling.body import SpatialBody
from rocking.errors import InvalidValueError
from rocking.portable import dot
from rocking.restitution.space import SpatialHousner, SpatialImpact, SpatialModel, spatial_model, spatial_models
from rocking.restitution.space.impact import NO_MATTER


@runtime_checkable
class SpatialImpactLaw(Protocol):
    """Interface of the 3D restitution. The engine chooses the contact, and the law returns the velocity after impact.

    Any object with the two members `label` and `velocity_after` is accepted.
    """

    @property
    def label(self) -> str:
        """Name in titles and tables."""
        ...

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the angular velocity after an impact.

        Parameters
        ----------
        body : SpatialBody
            The body.
        impact : SpatialImpact
            Angular velocity and pivot before the impact, corner or edge in contact after the impact, and the vertical,
            in body axes.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after the impact in body axes [rad/s]. It is along the edge for an impact on an edge.
        """
        ...


@dataclass(frozen=True)
class ModelLaw:
    """A model of `rocking.restitution.space` as the impact law of a history."""

    model: SpatialModel

    @property
    def label(self) -> str:
        return self.model.name

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the angular velocity of the model."""
        return self.model.turned(impact)


PLASTIC = SpatialHousner()
"""The plastic impact without slip: the orthogonal projection of the velocities in the kinetic metric."""


class FixedSpatial:
    """Fixed coefficient: the velocity has the direction of the projection, and ``|w+| = r |w-|`` as for plane bodies.

    The law never creates energy: it limits the energy of a body that lands on its longer lever. A vertex that only
    grazes the ground loses the same fraction of velocity, unlike in a real impact. Therefore, use this law for rotation
    about edges.
    """

    def __init__(self, coefficient: float) -> None:
        self.coefficient = checks.within("restitution", coefficient, 0.0, 1.0, hint="a larger value creates energy")

    @property
    def label(self) -> str:
        return f"{self.coefficient:.6g}"

    def velocity_after(self, body: SpatialBody, impact: SpatialImpact) -> FloatArray:
        """Return the scaled projection."""
        projected = PLASTIC.turned(impact)  # Eq. 1
        energy_after = body.kinetic(impact.onto.point, projected)
        if not energy_after > 0.0:
            return projected
        bound = body.kinetic(impact.pivot, impact.velocity) / energy_after
        square_ratio = self.coefficient**2 * dot(impact.velocity, impact.velocity) / dot(projected, projected)
        return np.asarray(math.sqrt(min(square_ratio, bound)) * projected)  # Eq. 101


def law_of(restitution: Any, body: SpatialBody | None = None) -> SpatialImpactLaw:
    """Return the impact law for the name of a model, a coefficient or a law."""
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
    """Return the description of an object that is not a law, with its missing members."""
    if isinstance(restitution, type):
        return f"the class {restitution.__name__}; use an object, {restitution.__name__}()"
    if type(restitution).__module__ == "builtins":
        return f"{restitution!r:.60}"
    missing = [name for name in ("label", "velocity_after") if not hasattr(restitution, name)]
    return f"a {type(restitution).__name__} object without {' and '.join(missing)}"
