"""A body as the equations of motion see it: angle, frequency parameter and coefficient on either side."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot, percent
from rocking.dynamics.impact_laws import ConstantRestitution, DrawnRestitution, ImpactLaw
from rocking.errors import InvalidValueError
from rocking.restitution._implied import energy_bound
from rocking.restitution.registry import BOUND_ROUNDING, energy_refusal
from rocking.restitution.registry import coefficients_of as _coefficients_of

COMPLEMENTARITY = "complementarity alone"  # what restitution=None is called, with friction
UNIMPOSED = -1.0  # a coefficient that stands for none: impacts are plastic by complementarity, or as `bounce` says [-]

_SAID = 1e-4


# what rows call the properties of a `RockingSide`
_SHORT = {
    "alpha": "slenderness_angle", "p": "frequency_parameter", "r": "coefficient", "q": "inertia_ratio",
    "share": "share",
}  # fmt: skip


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
    share : float
        Lowest part of a distribution from which its law draws: 1, less where the rest would create energy [-].
    """

    slenderness_angle: float
    frequency_parameter: float
    semi_diagonal: float
    coefficient: float
    inertia_ratio: float = 0.75
    share: float = 1.0


@dataclass(frozen=True)
class RockingParameters:
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

    def largest(self, sign: float) -> float:
        """Return the largest coefficient that landing on a side can meet.

        Parameters
        ----------
        sign : float
            Above zero for the right, below for the left.

        Returns
        -------
        float
            Coefficient [-].
        """
        side, law = self.side(sign), self.law
        if drawn := _truncated(law):
            return side.coefficient * drawn.quantile(side.share, _foot(sign))
        return side.coefficient * law.largest

    def coefficient(self, sign: float, speed: float, stream: int, impact: int) -> float:
        """Return the coefficient of an impact.

        Parameters
        ----------
        sign : float
            Above zero for landing on the right, below for the left.
        speed : float
            Angular velocity before the impact, without its sign [rad/s].
        stream : int
            Number of the history.
        impact : int
            Impacts that the history has had before.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-].

        Raises
        ------
        InvalidValueError
            If a law of one's own gives a factor outside its range.
        """
        side, law = self.side(sign), self.law
        if drawn := _truncated(law):
            return side.coefficient * drawn.draw(stream, impact, _foot(sign), side.share)
        factor = law.factor(speed, stream, impact)
        if not 0.0 <= factor <= law.largest:
            raise InvalidValueError(
                "{law}.factor must be in [0, {largest:g}], its largest, got {factor}",
                law=type(law).__name__,
                largest=law.largest,
                factor=f"{factor!r}",
            )
        return side.coefficient * factor

    @classmethod
    def of_body(cls, body: Any, restitution: Any, gravity: float, *, may_be_none: bool = False) -> "RockingParameters":
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
        may_be_none : bool
            Whether the restitution may be None, as that of a body that may slide and hop: no coefficient is imposed,
            impacts are plastic by complementarity, or as `bounce` says.

        Returns
        -------
        RockingParameters
            The body as the equations see it; coefficients are `UNIMPOSED` where none is imposed.

        Raises
        ------
        InvalidValueError
            If it is no body, or a coefficient is negative, not finite, or would create energy.
        """
        checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
        law = restitution if isinstance(restitution, ImpactLaw) else ConstantRestitution()
        base = getattr(restitution, "times", 1.0) if isinstance(restitution, ImpactLaw) else restitution
        coefficients: Mapping[Foot, float]
        if may_be_none and is_none(base):
            coefficients, label = dict.fromkeys(FEET, UNIMPOSED), COMPLEMENTARITY
        else:
            coefficients, label = coefficients_of(base, body)
        made: dict[Foot, RockingSide] = {}
        for foot in FEET:
            most, side = energy_bound(body, foot), body.side(foot, gravity)
            share = _share(law, foot, coefficients[foot], most)
            if share < 1.0:
                plausibility.warn(plausibility.of_truncation(1.0 - share, foot, most))
            made[foot] = RockingSide(
                side.slenderness_angle,
                side.frequency_parameter,
                side.semi_diagonal,
                float(coefficients[foot]),
                body.mass * side.semi_diagonal**2 / side.moment_of_inertia,  # Eq. 27
                share,
            )
        return cls(made["right"], made["left"], law, _label(law, {foot: made[foot].share for foot in FEET}, label))


def is_none(restitution: Any) -> bool:
    """Whether no coefficient is imposed: None, or the word for it that files and options have."""
    return restitution is None or (isinstance(restitution, str) and restitution == COMPLEMENTARITY.split(maxsplit=1)[0])


def sides_of(bodies: Sequence[RockingParameters | None]) -> dict[str, FloatArray]:
    """Return alpha [rad], p [rad/s], r, q, share [-] of both sides of many bodies; NaN where there is no body."""
    return {
        f"{short}_{foot}": np.array([np.nan if body is None else getattr(getattr(body, foot), name) for body in bodies])
        for short, name in _SHORT.items()
        for foot in ("right", "left")
    }


def cut_of(law: ImpactLaw, body: Body) -> dict[Foot, float]:
    """Return the probability by foot that is cut off a law's distribution, where impacts would create energy [-]."""
    coefficients, _ = coefficients_of(getattr(law, "times", 1.0), body)
    return _cut(law, {foot: _share(law, foot, coefficients[foot], energy_bound(body, foot)) for foot in FEET})


def cut_words(cut: Mapping[Foot, float]) -> str:
    """Return what is cut off of a distribution, for the end of a label; nothing below a ten-thousandth."""
    said = [f"{percent(cut[foot])} onto {foot}" for foot in FEET if cut[foot] > _SAID]
    if said and cut["left"] == cut["right"]:
        said = [percent(cut["left"])]
    return f" (of the distribution {' and '.join(said)} cut off, where impacts would create energy)" if said else ""


def _foot(sign: float) -> Foot:
    return "right" if sign > 0.0 else "left"


def _truncated(law: ImpactLaw) -> DrawnRestitution | None:
    return law if isinstance(law, DrawnRestitution) and law.truncates else None


def _share(law: ImpactLaw, onto: Foot, r: float, most: float) -> float:
    """Part of a distribution within the energy bound of a side; what cannot be cut there is refused beyond it."""
    drawn = _truncated(law)
    largest = r * (drawn.quantile(1.0, onto) if drawn else law.largest)
    if largest <= most * (1.0 + BOUND_ROUNDING):
        return 1.0
    if drawn:
        share = drawn.share_within(most / r, onto)
        plausibility.of_truncation(1.0 - share, onto, most)  # refuses what next to nothing is left of
        return share
    raise energy_refusal(onto, most, largest)


def _cut(law: ImpactLaw, shares: Mapping[Foot, float]) -> dict[Foot, float]:
    before = law.cut if isinstance(law, DrawnRestitution) else (0.0, 0.0)
    return {foot: 1.0 - (1.0 - cut) * shares[foot] for foot, cut in zip(FEET, before, strict=True)}


def _label(law: ImpactLaw, shares: Mapping[Foot, float], base: str) -> str:
    """Return the restitution in words, with what is cut off of its distribution."""
    if law.kind <= 0:
        return f"{type(law).__name__} times {base}" if law.kind < 0 else base
    if not isinstance(law, DrawnRestitution):
        return f"of the speed: {law.factors.min():.4g} to {law.largest:.4g} times {base}"
    left, right = (f"{law.table(foot)[0]:.4g} to {law.quantile(shares[foot], foot):.4g}" for foot in FEET)
    ends = left if left == right else f"left {left}, right {right},"
    return f"at random: {ends} times {base}{cut_words(_cut(law, shares))}"


def coefficients_of(restitution: Any, body: Body) -> tuple[dict[Foot, float], str]:
    """Return the coefficients for landing left and right, and their label [-]; None leaves them to complementarity."""
    if is_none(restitution):
        raise InvalidValueError(
            "{parameter}={value} leaves impacts to complementarity, which needs friction=: give it, or a model",
            parameter="restitution", value=restitution,
        )  # fmt: skip
    return _coefficients_of(restitution, body)
