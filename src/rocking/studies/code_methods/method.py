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
    """Bodies seen from either foot, one row a body, right and left in a column each.

    Parameters
    ----------
    half_width, height : ndarray, shape (bodies, 2)
        Horizontal distance b from the foot to the centre of mass, and its height h [m].
    frequency_parameter : ndarray, shape (bodies, 2)
        Frequency parameter p [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].

    Examples
    --------
    >>> from rocking import Block
    >>> Stances.of([Block(width=0.5, height=2.0)]).slope.tolist()
    [[0.25, 0.25]]
    """

    half_width: FloatArray
    height: FloatArray
    frequency_parameter: FloatArray
    gravity: float = g

    @classmethod
    def of(cls, bodies: Sequence[Body], gravity: float = g) -> "Stances":
        """Return what the methods see of plane bodies.

        Parameters
        ----------
        bodies : sequence of Body
            The bodies.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Stances
            One row a body.
        """
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
    """Motions as the methods see them: peaks, and the spectrum of each.

    Parameters
    ----------
    motions : tuple of GroundMotion
        The motions.
    """

    motions: tuple[GroundMotion, ...]

    @classmethod
    def of(cls, motions: Any) -> "Shaking":
        """Return what the methods see of motions.

        Parameters
        ----------
        motions : MotionSet or sequence
            Records or pulses.

        Returns
        -------
        Shaking
            Their leading components, pulses sampled finely.
        """
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
        """Return pseudo-spectral accelerations.

        Parameters
        ----------
        periods : ndarray, shape (periods,)
            Natural periods [s].
        damping : float
            Damping ratio [-].

        Returns
        -------
        ndarray, shape (motions, periods)
            One row a motion [m/s2].
        """
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
        """Return the factor on every motion at which the method's limit is reached.

        Parameters
        ----------
        stances : Stances
            The bodies.
        shaking : Shaking
            The motions.

        Returns
        -------
        ndarray
            Of a shape that fits (motions, bodies, 2) [-].
        """

    def capacity(self, stances: Stances, shaking: Shaking) -> FloatArray:
        """Return the factor on every motion up to which the method calls a body safe: of its worse side.

        Parameters
        ----------
        stances : Stances
            The bodies.
        shaking : Shaking
            The motions.

        Returns
        -------
        ndarray, shape (motions, bodies)
            Factors; NaN where a body is outside the domain [-].
        """
        shape = (len(shaking.motions), *stances.slope.shape)
        return np.asarray(np.broadcast_to(self.of_sides(stances, shaking), shape).min(axis=2))
