"""What a code method is, and what it is told: bodies seen from either foot, and motions."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, BoolArray, FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.components import leading
from rocking.motions.intensity import MEASURES, RockingScale, sampled
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import response_spectrum


@dataclass(frozen=True)
class BodySides:
    """Bodies seen from either foot, one row a body, right and left in a column each."""

    half_width: FloatArray  # horizontal distance b from the foot to the centre of mass [m]
    height: FloatArray  # height h of the centre of mass [m]
    frequency_parameter: FloatArray  # p [rad/s]
    gravity: float = g  # [m/s2]

    @classmethod
    def of(cls, bodies: Sequence[Body], gravity: float = g) -> "BodySides":
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
    def inertia(self) -> FloatArray:
        """Moment of inertia about the foot over m h^2 [-]."""
        h, p = self.height, self.frequency_parameter
        return np.asarray(self.gravity * np.hypot(self.half_width, h) / (p * h) ** 2)

    @property
    def symmetric(self) -> BoolArray:
        """Whether both feet of each body are equally far from its centre."""
        right, left = self.half_width.T
        return np.asarray(np.isclose(right, left, rtol=1e-9, atol=0.0))

    @property
    def rectangle(self) -> BoolArray:
        """Whether each body rocks as a rectangle does: symmetric, and about a foot 4/3 m R^2."""
        like = np.isclose(self.inertia, 4.0 / 3.0 * (1.0 + self.slope**2), rtol=1e-6)
        return np.asarray(self.symmetric & like.all(axis=1))

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

    @cached_property
    def vertical(self) -> BoolArray:
        """Whether each motion has a vertical part, of shape (motions, 1)."""
        parts = [getattr(each, "vertical", None) for each in self.motions]
        return np.array([[part is not None and bool(np.any(part))] for part in parts])

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
    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Return the factor on every motion at which the limit is reached.

        Parameters
        ----------
        sides, shaking
            As for `capacity`.

        Returns
        -------
        ndarray
            Of a shape that fits (motions, bodies, 2) [-].
        """

    def holds(self, sides: BodySides, shaking: Shaking) -> BoolArray:
        """Return whether a body under a motion is in the domain.

        Parameters
        ----------
        sides, shaking
            As for `capacity`.

        Returns
        -------
        ndarray
            Of a shape that fits (motions, bodies); throughout if a method does not say otherwise.
        """
        return np.ones((1, 1), dtype=np.bool_)

    def capacity(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Return the factor on every motion up to which a body is called safe.

        Parameters
        ----------
        sides : BodySides
            Bodies, as ``BodySides.of(bodies)``.
        shaking : Shaking
            Motions, as ``Shaking.of(motions)``.

        Returns
        -------
        ndarray, shape (motions, bodies)
            Of the worse side; NaN outside the domain [-].
        """
        shape = (len(shaking.motions), *sides.slope.shape)
        worse = np.broadcast_to(self.of_sides(sides, shaking), shape).min(axis=2)
        return np.where(self.holds(sides, shaking), worse, np.nan)
