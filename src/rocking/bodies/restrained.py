"""A plane body with restraints."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rocking import checks, conventions
from rocking.answers import Answer
from rocking.bodies.body import Body, Side, assumed_together
from rocking.bodies.restraints import Restraint, Wall
from rocking.conventions import Foot
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class Restrained:
    """A plane body with tendons, dampers, fuses, springs and walls, optionally on a sloping floor.

    Parameters
    ----------
    body : Body
        The body: Block, Section or MassPoints.
    restraints : sequence of Restraint
        Tendon, ViscousDamper, FrictionDamper, Fuse, Spring and Wall, in any number, also none. Restraints without a
        name receive a name.
    floor_slope : float
        Slope of the floor, positive if the floor rises to the right [rad]. The coordinates of body and restraints, and
        the rotations, are relative to the floor.

    Raises
    ------
    InvalidValueError
        If the body is not a plane body, two restraints have the same name, the law of a wall is not for this body, or
        the upright body is not stable on the slope.

    Notes
    -----
    The forces of restraints are finite. They give no impulse at an impact, and the restitution of the body applies
    (Dimitrakopoulos & DeJong 2012). Tests of walls with tendons and fuses report other energy losses at the impact.
    State the coefficient of restitution for such walls.

    Examples
    --------
    >>> import rocking as rk
    >>> wall = rk.Block(width=1.0, height=6.0, mass=4000.0)
    >>> tied = rk.Restrained(wall, [rk.Tendon(x=0.5, stiffness=500e3, prestress=20e3)])
    >>> tied.restraints[0].name, tied.mass
    ('tendon 1', 4000.0)
    """

    body: Body
    restraints: tuple[Restraint, ...]
    floor_slope: float = 0.0

    def __init__(
        self, body: Body, restraints: Sequence[Restraint] | Restraint = (), *, floor_slope: float = 0.0
    ) -> None:
        checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
        allowed = "Tendon, ViscousDamper, FrictionDamper, Fuse, Spring or Wall"
        checks.of_kind("restraints", restraints, (Restraint, Sequence), allowed)
        listed = [restraints] if isinstance(restraints, Restraint) else list(restraints)
        for restraint in listed:
            checks.of_kind("restraints", restraint, Restraint, allowed)
        right, left = (body.side(foot).slenderness_angle for foot in ("right", "left"))
        slope = checks.within(
            "floor_slope", floor_slope, -right, left, unit="rad", open_low=True, open_high=True,
            hint="the upright body is not stable on a steeper floor",
        )  # fmt: skip
        object.__setattr__(self, "floor_slope", slope)
        object.__setattr__(self, "body", body)
        object.__setattr__(self, "restraints", tuple(_named([restraint.placed_on(body) for restraint in listed])))

    @property
    def mass(self) -> float:
        """Mass of the body [kg]."""
        return self.body.mass

    @property
    def slenderness_angle(self) -> float:
        """Slenderness angle of a body with equal sides [rad]."""
        return self.body.slenderness_angle

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter of a body with equal sides, at standard gravity [rad/s]."""
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
        """Return the parameters of the body for rotation about one foot.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration of the body without restraints.
        """
        return self.body.side(foot, gravity)

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return the results of the body and its restraints.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Results of the body, and the law of each restraint.
        """
        return self.body.answer(gravity) | {
            "assumed": self.assumed,
            "floor_slope": self.floor_slope,
            "restraint_laws": [facts_of(restraint) for restraint in self.restraints],
        }


def without_walls(body: Any) -> None:
    """Raise an error for a body at a wall, in computations that do not check the contact force of the floor."""
    if any(isinstance(restraint, Wall) for restraint in getattr(body, "restraints", ())):
        raise InvalidValueError(
            "Many histories do not support walls, because they do not check the contact force of the floor. Use "
            "simulate.",
            parameter="restraints",
        )  # fmt: skip


def facts_of(restraint: Restraint) -> dict[str, Any]:
    """Return name, law, source, domain and constants of a restraint."""
    return {
        "restraint": restraint.name, "force_law": restraint.force_law, "law_source": restraint.source,
        "law_domain": restraint.domain, "ground_point": restraint.ends[0], "body_point": restraint.ends[1],
        "law_constants": ", ".join(f"{name} {_short(value)}" for name, value in restraint.constants.items()),
    }  # fmt: skip


def _short(value: Any) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _named(restraints: list[Restraint]) -> list[Restraint]:
    """Return the restraints with names. The default name is the kind and a number."""
    kinds = [restraint.kind for restraint in restraints]
    for k, restraint in enumerate(restraints):
        if not restraint.name:
            number = kinds[: k + 1].count(restraint.kind)
            object.__setattr__(restraint, "name", f"{restraint.kind.replace('_', ' ')} {number}")
    names = [restraint.name for restraint in restraints]
    for name in names:
        if names.count(name) > 1:
            raise InvalidValueError("two restraints have the name {value}", parameter="restraints", value=name)
    return restraints
