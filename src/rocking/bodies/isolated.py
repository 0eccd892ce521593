"""A plane body on an isolated base."""

import math
from dataclasses import dataclass
from typing import Any

from rocking import checks, conventions
from rocking.answers import Answer
from rocking.bodies.body import Body, Side, assumed_together
from rocking.bodies.frame import refuse_frame
from rocking.conventions import Foot
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class Isolated:
    """A plane body on a base that moves horizontally on isolators.

    The isolators are a spring and a dashpot, stated by period and damping ratio or by stiffness and damping, and a
    sliding surface with Coulomb friction. Without any of these values, the base is on rollers.

    Parameters
    ----------
    body : Body
        The body: Block, Section or MassPoints.
    base_mass : float
        Mass of the base [kg].
    period : float, optional
        Period of the spring with body and base, without rocking [s].
    damping_ratio : float, optional
        Damping ratio of this oscillator, with `period` [-].
    stiffness : float, optional
        Horizontal stiffness of the isolators, instead of `period` [N/m].
    damping : float, optional
        Coefficient of the dashpot, instead of `damping_ratio` [N s/m].
    friction : float
        Coefficient of friction between base and ground [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or a period is stated together with a stiffness or damping.

    Examples
    --------
    >>> import rocking as rk
    >>> bust = rk.Block(width=0.5, height=2.0, mass=1000.0)
    >>> isolated = rk.Isolated(bust, base_mass=1000.0, period=2.0, damping_ratio=0.1)
    >>> round(isolated.stiffness), round(isolated.damping)
    (19739, 1257)
    """

    body: Body
    base_mass: float
    stiffness: float
    damping: float
    friction: float

    def __init__(
        self,
        body: Body,
        base_mass: float,
        *,
        period: float | None = None,
        damping_ratio: float | None = None,
        stiffness: float | None = None,
        damping: float | None = None,
        friction: float = 0.0,
    ) -> None:
        checks.of_kind("body", refuse_frame(body), Body, "a Block, Section or MassPoints")
        base_mass = checks.positive("base_mass", base_mass, "kg")
        if period is not None:
            if stiffness is not None or damping is not None:
                raise InvalidValueError("Use period and damping_ratio, or stiffness and damping, not both.")
            frequency = 2.0 * math.pi / checks.positive("period", period, "s")
            total = body.mass + base_mass
            stiffness = total * frequency**2
            ratio = 0.0 if damping_ratio is None else checks.within("damping_ratio", damping_ratio, 0.0, 1.0)
            damping = 2.0 * ratio * frequency * total
        elif damping_ratio is not None:
            raise InvalidValueError("{parameter} needs a period", parameter="damping_ratio", value=damping_ratio)
        values = {
            "body": body, "base_mass": base_mass,
            "stiffness": checks.within("stiffness", 0.0 if stiffness is None else stiffness, 0.0, 1e18, unit="N/m"),
            "damping": checks.within("damping", 0.0 if damping is None else damping, 0.0, 1e18, unit="N s/m"),
            "friction": checks.within("friction", friction, 0.0, 10.0),
        }  # fmt: skip
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def mass(self) -> float:
        """Mass of the body without the base [kg]."""
        return self.body.mass

    @property
    def slenderness_angle(self) -> float:
        """Slenderness angle of a body with equal sides [rad]."""
        return self.body.slenderness_angle

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter of a body with equal sides on fixed ground, at standard gravity [rad/s]."""
        return self.body.frequency_parameter

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumed values of the body, as texts."""
        return assumed_together([self.body], affects_rotations=True)

    @property
    def densities(self) -> tuple[float, ...]:
        """Densities of the parts of the body; empty for mass points [kg/m3]."""
        return self.body.densities

    def side(self, foot: Foot, gravity: float = conventions.g) -> Side:
        """Return the parameters of the body on fixed ground for rotation about one foot.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration.
        """
        return self.body.side(foot, gravity)

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return the results of the body and of its base.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Results of the body, and mass, stiffness, damping and friction of the base.
        """
        names = ("base_mass", "stiffness", "damping", "base_friction")
        values = (self.base_mass, self.stiffness, self.damping, self.friction)
        return self.body.answer(gravity) | dict(zip(names, values, strict=True))


def fixed_base(body: Any) -> Any:
    """Return a body without its isolated base."""
    return body.body if isinstance(body, Isolated) else body
