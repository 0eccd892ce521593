"""A body as the equations of motion see it: angle, frequency parameter and coefficient on either side."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.conventions import FEET
from rocking.dynamics.impact_law import ConstantRestitution, ImpactLaw
from rocking.errors import InvalidValueError
from rocking.restitution import RestitutionModel, model

# rounding in I_O and r together
_ROUNDING = 1e-9


@dataclass(frozen=True)
class RockingSide:
    """One side of a rocking body.

    Parameters
    ----------
    slenderness_angle : float
        Angle alpha [rad].
    frequency_parameter : float
        p [rad/s].
    semi_diagonal : float
        R [m].
    coefficient : float
        theta_dot_after / theta_dot_before when the body lands on this side [-].
    inertia_ratio : float
        m R^2 / I_o, with the moment of inertia I_o about the foot; 3/4 for a rectangle [-].
    """

    slenderness_angle: float
    frequency_parameter: float
    semi_diagonal: float
    coefficient: float
    inertia_ratio: float = 0.75


@dataclass(frozen=True)
class Rocker:
    """Both sides, and how the coefficient changes from impact to impact.

    Parameters
    ----------
    right, left : RockingSide
        The sides; a positive rotation stands on the right one.
    law : ImpactLaw
        Factor on the coefficients.
    label : str
        The restitution in words.
    """

    right: RockingSide
    left: RockingSide
    law: ImpactLaw
    label: str

    def side(self, sign: float) -> RockingSide:
        """Return the side that a rotation of this sign stands on.

        Parameters
        ----------
        sign : float
            Above zero for the right, below for the left.

        Returns
        -------
        RockingSide
            The side.
        """
        return self.right if sign > 0.0 else self.left

    @classmethod
    def of_body(cls, body: Body, restitution: Any, gravity: float) -> "Rocker":
        """Return a body with its coefficients of restitution.

        Parameters
        ----------
        body : Body
            The body.
        restitution : str, RestitutionModel, float, pair of float, mapping or ImpactLaw
            A model or its name; one coefficient; one for landing left and one for landing right, as
            ``{"left": .., "right": ..}``; or a law for what changes from impact to impact.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Rocker
            The body as the equations see it.

        Raises
        ------
        InvalidValueError
            If it is no body, or a coefficient is negative, not finite, or would create energy.
        """
        if not isinstance(body, Body):
            raise InvalidValueError(f"body must be a Block, Section or MassPoints, got {body!r:.60}")
        law = restitution if isinstance(restitution, ImpactLaw) else ConstantRestitution()
        base = getattr(restitution, "times", 1.0) if isinstance(restitution, ImpactLaw) else restitution
        coefficients, label = coefficients_of(base, body)
        if law.kind > 0:
            how = ("", "of the speed", "at random")[law.kind]
            label = f"{how}: {law.factors.min():.4g} to {law.largest:.4g} times {label}"
        elif law.kind < 0:
            label = f"{type(law).__name__} times {label}"
        sides = {foot: body.side(foot, gravity) for foot in FEET}
        for foot, other in (("left", "right"), ("right", "left")):
            most = math.sqrt(sides[other].moment_of_inertia / sides[foot].moment_of_inertia)  # type: ignore[index]
            r = coefficients[foot] * law.largest
            if r > most * (1.0 + _ROUNDING):
                raise InvalidValueError(
                    f"the coefficient of restitution onto the {foot} foot must be in [0, {most:.6g}], got {r:.6g}: "
                    "the impact would create energy"
                )
        made = {
            foot: RockingSide(
                side.slenderness_angle,
                side.frequency_parameter,
                side.semi_diagonal,
                float(coefficients[foot]),
                body.mass * side.semi_diagonal**2 / side.moment_of_inertia,
            )
            for foot, side in sides.items()
        }
        return cls(made["right"], made["left"], law, label)


def coefficients_of(restitution: Any, body: Body) -> tuple[dict[str, float], str]:
    """Return the coefficients for landing left and right, and what to call them.

    Parameters
    ----------
    restitution : str, RestitutionModel, float or mapping
        A model or its name, one coefficient, or one for each foot.
    body : Body
        The body.

    Returns
    -------
    coefficients : dict of str to float
        By foot [-].
    label : str
        For titles and tables.

    Raises
    ------
    InvalidValueError
        If it is none of these.
    """
    if isinstance(restitution, (str, RestitutionModel)):
        found = model(restitution)
        return {foot: found.coefficient(body, foot) for foot in FEET}, found.label
    if isinstance(restitution, Mapping):
        if set(restitution) != set(FEET):
            raise InvalidValueError(f'restitution by side is {{"left": r, "right": r}}, got {restitution!r:.60}')
        pair: dict[str, float] = {foot: _coefficient(f"restitution[{foot!r}]", restitution[foot]) for foot in FEET}
        return pair, f"left {pair['left']:.6g}, right {pair['right']:.6g}"
    r = _coefficient("restitution", restitution)
    return dict.fromkeys(FEET, r), f"{r:.6g}"


def _coefficient(name: str, value: Any) -> float:
    r = checks.within(name, value, 0.0, 10.0, hint="a ratio of velocities; a percentage?")
    plausibility.warn(plausibility.of_coefficient(r))
    return r
