"""What every restitution model in space is: an angular velocity after the impact, and where it comes from."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

import numpy as np

from rocking.bodies.solid import Edge
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import applied, dot, norm
from rocking.restitution.space.impact import RigidImpact, SpatialImpact

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
    def on_corner(self, impact: RigidImpact) -> FloatArray:
        """Return the angular velocity about the corner that the body lands on.

        Parameters
        ----------
        impact : RigidImpact
            The impact, onto a `Corner`.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity [rad/s].
        """

    @abstractmethod
    def on_edge(self, impact: RigidImpact, direction: FloatArray) -> float:
        """Return the angular velocity about the edge that the body lands on.

        Parameters
        ----------
        impact : RigidImpact
            The impact, onto an `Edge`.
        direction : ndarray, shape (3,)
            Unit vector along the edge [-].

        Returns
        -------
        float
            Angular velocity along the direction [rad/s].
        """

    def flags(self, impact: RigidImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return what a user must know of this model's answer.

        Parameters
        ----------
        impact : RigidImpact
            The impact.
        velocity : ndarray, shape (3,)
            Angular velocity after it [rad/s].

        Returns
        -------
        tuple of SpatialFlag
            None by default.
        """
        return ()

    def turned(self, impact: RigidImpact) -> FloatArray:
        """Return the angular velocity that the model's equation gives, in any attitude of the body.

        Parameters
        ----------
        impact : RigidImpact
            The impact.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity, along the edge if the body lands on one [rad/s].

        Raises
        ------
        InvalidValueError
            If the model does not give finite numbers.
        """
        if isinstance(impact.onto, Edge):
            raw = self.on_edge(impact, impact.onto.direction) * impact.onto.direction
        else:
            raw = self.on_corner(impact)
        if not np.isfinite(raw).all():
            raise InvalidValueError(f"model {self.name} gives {raw.tolist()} rad/s for this impact")
        return raw

    def after(self, impact: SpatialImpact) -> SpatialRestitution:
        """Return what the model says about an impact.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.

        Returns
        -------
        SpatialRestitution
            Angular velocity with flags.

        Raises
        ------
        InvalidValueError
            If the model does not give finite numbers.
        """
        raw = self.turned(impact)
        said = self.flags(impact, raw)
        sinks = impact.rise(raw) < -_TOUCH * impact.speed * impact.solid.size
        if sinks and isinstance(impact.onto, Edge):
            return SpatialRestitution(self, impact, raw, np.zeros(3), (*said, SpatialFlag.STOPS))
        return SpatialRestitution(self, impact, raw, raw, (*said, SpatialFlag.PENETRATES) if sinks else said)
