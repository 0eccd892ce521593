"""What a code method is, and what it is told: bodies seen from either foot, and motions."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.components import leading
from rocking.motions.intensity import MEASURES, RockingScale, sampled
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import response_spectrum


@dataclass(frozen=True)
class Stances:
    """Bodies seen from either foot, one row a body, right and left in a column each."""

    half_width: FloatArray  # horizontal distance b from the foot to the centre of mass [m]
    height: FloatArray  # height h of the centre of mass [m]
    frequency_parameter: FloatArray  # p [rad/s]
    gravity: float = g  # [m/s2]

    @classmethod
    def of(cls, bodies: Sequence[Body], gravity: float = g) -> "Stances":
        """Return what the methods see of plane bodies; gravity: [m/s2]."""
        for body in bodies:
            if not isinstance(body, Body):
                raise InvalidValueError(
                    f"code methods know plane bodies, got {body!r:.60}; a solid stands in a plane by in_plane(azimuth)"
                )
        sides = [[body.side(foot, gravity) for foot in FEET[::-1]] for body in bodies]
        names = "half_width", "centre_height", "frequency_parameter"
        b, h, p = (np.array([[getattr(side, name) for side in pair] for pair in sides]) for name in names)
        return cls(b, h, p, gravity)

    @property
    def slope(self) -> FloatArray:
        """The ratio b / h, the tangent of the slenderness angle [-]."""
        return self.half_width / self.height

    @property
    def angle(self) -> FloatArray:
        """Slenderness angle [rad]."""
        return np.arctan(self.slope)

    @property
    def uplift(self) -> FloatArray:
        """Horizontal acceleration that lifts a body about the foot [m/s2]."""
        return self.gravity * self.slope


@dataclass(frozen=True)
class Shaking:
    """Motions as the methods see them: peaks, and the spectrum of each."""

    motions: tuple[GroundMotion, ...]

    @classmethod
    def of(cls, motions: Any) -> "Shaking":
        """Return what the methods see of motions: leading components, pulses sampled finely."""
        return cls(tuple(sampled(leading(motions[k])) for k in range(len(motions))))

    def _peaks(self, name: str) -> FloatArray:
        return MEASURES[name].values(self.motions, RockingScale())[:, None, None]

    @cached_property
    def acceleration(self) -> FloatArray:
        """PGA, of shape (motions, 1, 1) [m/s2]."""
        return self._peaks("pga")

    @cached_property
    def velocity(self) -> FloatArray:
        """PGV, of shape (motions, 1, 1) [m/s]."""
        return self._peaks("pgv")

    def spectra(self, periods: FloatArray, damping: float) -> FloatArray:
        """Return pseudo-spectral accelerations of every motion [m/s2] at periods [s] and a damping ratio [-]."""
        return np.array([response_spectrum(each, periods, damping).pseudo_acceleration for each in self.motions])


class CodeMethod(ABC):
    """One published way to tell without a history whether a body overturns.

    Its class attributes say where it stands and how sure we are of the reading; a body that is not symmetric is
    judged on either side, and the worse one counts.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    reference: ClassVar[str]  # with clause or equation
    domain: ClassVar[str]
    reading: ClassVar[str]  # how sure we are that this is what the source says
    example: ClassVar[str] = "none of the source was at hand"  # with what numbers of the source it was compared

    @abstractmethod
    def of_sides(self, stances: Stances, shaking: Shaking) -> FloatArray:
        """Return the factor on every motion at which the limit is reached.

        Parameters
        ----------
        stances, shaking
            As for `capacity`.

        Returns
        -------
        ndarray
            Of a shape that fits (motions, bodies, 2) [-].
        """

    def capacity(self, stances: Stances, shaking: Shaking) -> FloatArray:
        """Return the factor on every motion up to which a body is called safe.

        Parameters
        ----------
        stances : Stances
            Bodies, as ``Stances.of(bodies)``.
        shaking : Shaking
            Motions, as ``Shaking.of(motions)``.

        Returns
        -------
        ndarray, shape (motions, bodies)
            Of the worse side; NaN outside the domain [-].
        """
        shape = (len(shaking.motions), *stances.slope.shape)
        return np.asarray(np.broadcast_to(self.of_sides(stances, shaking), shape).min(axis=2))
