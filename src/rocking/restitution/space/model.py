"""Base classes of 3D restitution models: angular velocity after the impact, reference and defects."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

import numpy as np

from rocking.bodies.solid import RoundBase, Solid, SupportPolygon
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import applied, dot, norm
from rocking.restitution.space.impact import SpatialImpact

_TOUCH = 1e-12


class SpatialFlag(Enum):
    """Warning about a 3D impact. The value is a sentence for reports."""

    STOPS = "the model rotates the body into the ground: the body stops and does not step onto the new edge"
    PENETRATES = (
        "the base would penetrate the ground near the new corner: the body lands on more than this corner; "
        "use an impact with complementarity"
    )
    CUT = (
        "the base is so narrow in this direction that the impulse position of the model is beyond the new foot, where "
        "the contact force is tensile: the impulse is moved to the foot, as in Housner's model"
    )
    PULLS = "the contact force becomes tensile: the body does not stay on this corner or edge"


@dataclass(frozen=True, eq=False)
class SpatialRestitution:
    """Result of a model for a 3D impact.

    Parameters
    ----------
    model : SpatialModel
        The model.
    impact : SpatialImpact
        The impact.
    raw_velocity : ndarray, shape (3,)
        Angular velocity by the equation of the model [rad/s].
    velocity : ndarray, shape (3,)
        Angular velocity after the impact [rad/s]; zero for a body that stops.
    flags : tuple of SpatialFlag
        Warnings about the impact.
    """

    model: "SpatialModel"
    impact: SpatialImpact
    raw_velocity: FloatArray
    velocity: FloatArray
    flags: tuple[SpatialFlag, ...] = ()

    @property
    def coefficient(self) -> float:
        """Ratio of the magnitudes of the angular velocity after and before the impact [-]."""
        return norm(self.velocity) / self.impact.speed

    @property
    def energy_before(self) -> float:
        """Kinetic energy before the impact [J]."""
        return self.impact.energy

    @property
    def energy_after(self) -> float:
        """Kinetic energy after the impact [J]."""
        return 0.5 * dot(self.velocity, applied(self.impact.inertia, self.velocity))

    @property
    def energy_ratio(self) -> float:
        """Ratio of the kinetic energies after and before the impact [-]."""
        return self.energy_after / self.energy_before


class SpatialModel(ABC):
    """Base class of 3D restitution models.

    Attributes
    ----------
    name : str
        Name in the registry.
    title : str
        The model in one line.
    reference : str
        Publication with DOI, or the derivation in this project.
    assumptions, known_defects : tuple of str
        Assumptions of the model, and cases in which they are known to fail.
    domain : str
        Impacts to which the model applies.
    needs_solid : bool
        True if the model needs the distribution of mass in addition to mass, centre of mass and inertia.
    """

    name: ClassVar[str]
    title: ClassVar[str] = ""
    reference: ClassVar[str] = "not stated"
    assumptions: ClassVar[tuple[str, ...]] = ()
    domain: ClassVar[str] = "not stated"
    known_defects: ClassVar[tuple[str, ...]] = ()
    needs_solid: ClassVar[bool] = False

    @abstractmethod
    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        """Return the angular velocity by the equation of the model, about the corner or edge of landing.

        The body may have any attitude.


        Parameters
        ----------
        impact : SpatialImpact
            The impact.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity; along the edge for a landing on an edge [rad/s].
        """

    def flags(self, impact: SpatialImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return warnings about the result of this model.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.
        velocity : ndarray, shape (3,)
            Angular velocity after the impact [rad/s].

        Returns
        -------
        tuple of SpatialFlag
            Empty by default.
        """
        return ()

    def turned(self, impact: SpatialImpact) -> FloatArray:
        """Return `angular_velocity`. Raise an error if a value is not finite.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity [rad/s].

        Raises
        ------
        InvalidValueError
            If a value is not finite.
        """
        raw = self.angular_velocity(impact)
        if not np.isfinite(raw).all():
            raise InvalidValueError(
                "model {model} must give finite values, got {velocity} rad/s", model=self.name, velocity=raw.tolist()
            )
        return raw

    def after(self, impact: SpatialImpact) -> SpatialRestitution:
        """Return the result of the model for an impact of an upright body.

        Parameters
        ----------
        impact : SpatialImpact
            The impact. The flags need its matter. For a tilted body, or a body with moments only, use `turned`.

        Returns
        -------
        SpatialRestitution
            Angular velocity with flags.

        Raises
        ------
        InvalidValueError
            If the body is tilted or has no matter, or if a value is not finite.
        """
        solid, _ = impact.standing_solid
        raw = self.turned(impact)
        flags = self.flags(impact, raw)
        if least_rise(impact, raw) >= -_TOUCH * impact.speed * solid.size:
            return SpatialRestitution(self, impact, raw, raw, flags)
        if impact.edge is not None:
            return SpatialRestitution(self, impact, raw, np.zeros(3), (*flags, SpatialFlag.STOPS))
        return SpatialRestitution(self, impact, raw, raw, (*flags, SpatialFlag.PENETRATES))


def least_rise(impact: SpatialImpact, velocity: FloatArray) -> float:
    """Return the smallest vertical velocity of the base [m/s] of an upright body that turns about its landing point."""
    solid, origin = impact.standing_solid
    base = solid.local_base
    points = base.vertices if isinstance(base, SupportPolygon) else middle_of_base(solid)[None, :2]
    arms = points - (impact.onto.point - origin)[:2]
    min_rise = float((velocity[0] * arms[:, 1] - velocity[1] * arms[:, 0]).min())
    return min_rise - base.radius * norm(velocity[:2]) if isinstance(base, RoundBase) else min_rise


def middle_of_base(solid: Solid) -> FloatArray:
    """Return the middle of the base in the frame of the solid [m]."""
    base = solid.local_base
    if isinstance(base, RoundBase):
        flat = base.centre
    else:
        flat = base.vertices.mean(axis=0) if isinstance(base, SupportPolygon) else solid.local_moments.centre
    return np.array([flat[0], flat[1], 0.0])
