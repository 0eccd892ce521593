"""What every restitution model in space is: an angular velocity after the impact, and where it comes from."""

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
    """What a user must know about an impact in space; the value is the sentence."""

    STOPS = "the model's equation turns the body into the ground: it does not step onto the new edge but stops"
    PENETRATES = (
        "the base would go through the ground beside the new corner: the body lands on more than this corner, "
        "and an impact with complementarity has to find out on what"
    )
    CUT = (
        "the base is so narrow in this direction that the model would have the impulse beyond the new foot, where the "
        "ground would have to pull: it is taken at the foot, as Housner has it"
    )
    PULLS = "the ground would have to pull: the body does not come to stand on this corner or edge"


@dataclass(frozen=True, eq=False)
class SpatialRestitution:
    """What a model says about an impact in space.

    Parameters
    ----------
    model : SpatialModel
        The model.
    impact : SpatialImpact
        The impact.
    raw_velocity : ndarray, shape (3,)
        Angular velocity that the model's equation gives [rad/s].
    velocity : ndarray, shape (3,)
        Angular velocity after the impact; zero where the body stops [rad/s].
    flags : tuple of SpatialFlag
        What a user must know.
    """

    model: "SpatialModel"
    impact: SpatialImpact
    raw_velocity: FloatArray
    velocity: FloatArray
    flags: tuple[SpatialFlag, ...] = ()

    @property
    def coefficient(self) -> float:
        """Magnitude of the angular velocity after the impact over that before [-]."""
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
        """Kinetic energy after over before [-]."""
        return self.energy_after / self.energy_before


class SpatialModel(ABC):
    """One model of what an impact costs a body in space.

    Attributes
    ----------
    name : str
        Name in the registry.
    title : str
        The model in one line.
    reference : str
        Publication with DOI, or the derivation in this project.
    assumptions, known_defects : tuple of str
        What the model takes for granted, and where that is known to fail.
    domain : str
        Impacts it holds for.
    needs_solid : bool
        Whether it needs the distribution of mass, beyond mass, centre and inertia.
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
        """Return what the model's equation gives about the corner or edge that the body lands on, in any attitude.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity, along the edge if the body lands on one [rad/s].
        """

    def flags(self, impact: SpatialImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return what a user must know of this model's answer.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.
        velocity : ndarray, shape (3,)
            Angular velocity after it [rad/s].

        Returns
        -------
        tuple of SpatialFlag
            None by default.
        """
        return ()

    def turned(self, impact: SpatialImpact) -> FloatArray:
        """Return `angular_velocity`, checked.

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
            If the model does not give finite numbers.
        """
        raw = self.angular_velocity(impact)
        if not np.isfinite(raw).all():
            raise InvalidValueError(
                "model {model} gives {velocity} rad/s for this impact", model=self.name, velocity=raw.tolist()
            )
        return raw

    def after(self, impact: SpatialImpact) -> SpatialRestitution:
        """Return what the model says about an impact of a body that stands upright.

        Parameters
        ----------
        impact : SpatialImpact
            The impact, with its matter: the flags tell where the base goes. For a body that leans, or one known by
            its moments alone, there is `turned`.

        Returns
        -------
        SpatialRestitution
            Angular velocity with flags.

        Raises
        ------
        InvalidValueError
            If the body leans or has no matter, or the model does not give finite numbers.
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
    """Return the least vertical velocity of the base of an upright body that turns about its landing point [m/s]."""
    solid, origin = impact.standing_solid
    base = solid.local_base
    points = base.vertices if isinstance(base, SupportPolygon) else middle_of_base(solid)[None, :2]
    arms = points - (impact.onto.point - origin)[:2]
    least = float((velocity[0] * arms[:, 1] - velocity[1] * arms[:, 0]).min())
    return least - base.radius * norm(velocity[:2]) if isinstance(base, RoundBase) else least


def middle_of_base(solid: Solid) -> FloatArray:
    """Return the middle of the base in the solid's own frame [m]."""
    base = solid.local_base
    if isinstance(base, RoundBase):
        flat = base.centre
    else:
        flat = base.vertices.mean(axis=0) if isinstance(base, SupportPolygon) else solid.local_moments.centre
    return np.array([flat[0], flat[1], 0.0])
