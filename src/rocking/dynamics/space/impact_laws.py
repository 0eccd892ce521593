"""What an impact leaves of an angular velocity: the interface, and the models of restitution behind it."""

import math
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from rocking import checks
from rocking.bodies.solid import Corner, Edge
from rocking.conventions import FloatArray
from rocking.dynamics.space.body import SpatialBody
from rocking.errors import InvalidValueError
from rocking.portable import dot
from rocking.restitution.space import SpatialHousner, SpatialModel, spatial_model
from rocking.restitution.space.impact import NO_MATTER, UP, LeaningImpact


@runtime_checkable
class SpatialImpactLaw(Protocol):
    """What an impact costs in space; the engine finds which points stay on the ground, a law how fast the body goes on.

    Any object with these two members serves.
    """

    @property
    def label(self) -> str:
        """What to call it in titles and tables."""
        ...

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the angular velocity after an impact.

        Parameters
        ----------
        body : SpatialBody
            The body.
        before, after : ndarray, shape (3,)
            Pivots before and after, in body axes [m].
        axis : ndarray, shape (3,), optional
            Unit vector of the edge about which the body turns afterwards; None for a vertex [-].
        up : ndarray, shape (3,)
            Vertical in body axes [-].
        velocity : ndarray, shape (3,)
            Angular velocity before, in body axes [rad/s].

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in body axes; along `axis` if there is one [rad/s].
        """
        ...


@dataclass(frozen=True)
class ModelLaw:
    """A model of `rocking.restitution.space` as the law of a history."""

    model: SpatialModel

    @property
    def label(self) -> str:
        """Name of the model."""
        return self.model.name

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the angular velocity after that the model gives, in body axes [rad/s]."""
        onto = Corner(after) if axis is None else Edge(after, axis)
        return self.model.turned(LeaningImpact(body.moments, velocity, before, onto, up, body.matter))


PLASTIC = ModelLaw(SpatialHousner())
"""The plastic impact without slip on the points that stay; it does not ask where up is."""


def projected(
    body: SpatialBody, before: FloatArray, after: FloatArray, axis: FloatArray | None, velocity: FloatArray
) -> FloatArray:
    """Return the plastic impact without slip: the orthogonal projection of the velocities in the kinetic metric.

    The impulse acts at the new pivot B, so angular momentum about B stays: ``I_B w+ = I_C w- + m rho_B x (w- x
    rho_A)``; about an edge its component along the edge.

    before, after: pivots before and after, in body axes [m]; axis: unit vector of the new edge; None for a vertex [-];
    velocity: angular velocity before, in body axes [rad/s]. Returns angular velocity after, in body axes [rad/s].

    >>> box = SpatialBody.box(1.0, 1.0, 4.0)  # corner to opposite corner: 59 / 71
    >>> diagonal = np.array([1.0, -1.0, 0.0])
    >>> ratio = projected(box, box.vertices[0], box.vertices[2], None, diagonal) / 59.0 * 71.0
    >>> bool(np.abs(ratio - diagonal).max() < 1e-14)
    True
    """
    return PLASTIC.velocity_after(body, before, after, axis, UP, velocity)  # Eq. 1


class FixedSpatial:
    """The direction of the projection, and r of the angular velocity: ``|w+| = r |w-|``, as in the plane.

    It is a ratio of magnitudes in every impact, from an edge to the parallel one as from a corner to any other, and
    never creates energy: a body that lands on its longer lever keeps at most what it had.

    A vertex that only grazes the ground costs this share as well, which no real impact does: for bodies that turn about
    edges, not for wobbling ones.

    coefficient: r, from 0 to 1 [-].
    """

    def __init__(self, coefficient: float) -> None:
        self.coefficient = checks.within("restitution", coefficient, 0.0, 1.0, hint="more would create energy")

    @property
    def label(self) -> str:
        """The coefficient."""
        return f"{self.coefficient:.6g}"

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the scaled projection; angular velocity after, in body axes [rad/s]."""
        made = projected(body, before, after, axis, velocity)
        left = body.kinetic(after, made)
        if not left > 0.0:
            return made
        bound = body.kinetic(before, velocity) / left
        wanted = self.coefficient**2 * dot(velocity, velocity) / dot(made, made)
        return np.asarray(math.sqrt(min(wanted, bound)) * made)  # Eq. 101


def law_of(restitution: Any, body: SpatialBody | None = None) -> SpatialImpactLaw:
    """Return an impact law.

    >>> law_of("ked-3d", SpatialBody.box(1.0, 1.0, 4.0)).label
    'ked-3d'
    """
    if isinstance(restitution, (str, SpatialModel)):
        model = spatial_model(restitution)
        if model.needs_solid and body is not None and body.matter is None:
            raise InvalidValueError(f"restitution {model.name!r}: {NO_MATTER}")
        return ModelLaw(model)
    if isinstance(restitution, type):
        raise InvalidValueError(f"restitution must be a law, not its class, got {restitution!r:.60}")
    return restitution if isinstance(restitution, SpatialImpactLaw) else FixedSpatial(restitution)
