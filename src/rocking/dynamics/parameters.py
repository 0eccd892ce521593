"""Parameters of the equations of motion: slenderness angle, frequency parameter and coefficient of each side."""

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

COMPLEMENTARITY = "complementarity alone"  # label of restitution=None with friction
UNIMPOSED = -1.0  # no coefficient: complementarity with plastic impacts, or `normal_restitution` [-]

_NEGLIGIBLE = 1e-4


# column names of the properties of a `RockingSide` in rows
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
        Slenderness angle alpha [rad].
    frequency_parameter : float
        p [rad/s].
    semi_diagonal : float
        R [m].
    coefficient : float
        theta_dot_after / theta_dot_before when the body lands on this side [-].
    inertia_ratio : float
        m R^2 / I_o, with the moment of inertia I_o about the foot; 3/4 for a rectangle [-].
    share : float
        Lower fraction of the distribution that is sampled [-]. It is below 1 if larger values would create energy.
    """

    slenderness_angle: float
    frequency_parameter: float
    semi_diagonal: float
    coefficient: float
    inertia_ratio: float = 0.75
    share: float = 1.0


@dataclass(frozen=True)
class RockingParameters:
    """Parameters of both sides, and the law of the coefficient of restitution.

    Parameters
    ----------
    right, left : RockingSide
        The sides. At a positive rotation, the body turns about the right foot.
    law : ImpactLaw
        Factor on the coefficients.
    label : str
        Text that describes the restitution.
    """

    right: RockingSide
    left: RockingSide
    law: ImpactLaw
    label: str

    def side(self, sign: float) -> RockingSide:
        """Return the side of the foot about which the body turns at a rotation of this sign.

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
        """Return the largest coefficient of restitution that the impact law gives on a side.

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
        if distribution := _truncated(law):
            return side.coefficient * distribution.quantile(side.share, _foot(sign))
        return side.coefficient * law.largest

    def smallest(self, sign: float) -> float:
        """Return the smallest coefficient of restitution that the impact law gives on a side.

        Parameters
        ----------
        sign : float
            Above zero for the right, below for the left.

        Returns
        -------
        float
            Coefficient; 0 for a user-defined law without a table [-].
        """
        side, law = self.side(sign), self.law
        if isinstance(law, DrawnRestitution):
            return side.coefficient * law.quantile(0.0, _foot(sign))
        return side.coefficient * law.smallest

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
            Number of earlier impacts of the history.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-].

        Raises
        ------
        InvalidValueError
            If a user-defined law returns a factor outside its range.
        """
        side, law = self.side(sign), self.law
        if distribution := _truncated(law):
            return side.coefficient * distribution.draw(stream, impact, _foot(sign), side.share)
        factor = law.factor(speed, stream, impact)
        if not 0.0 <= factor <= law.largest:
            raise InvalidValueError(
                "{law}.factor() must return a number in [0, {largest:g}], got {factor}",
                law=type(law).__name__,
                largest=law.largest,
                factor=f"{factor!r}",
            )
        return side.coefficient * factor

    @classmethod
    def of_body(cls, body: Any, restitution: Any, gravity: float, *, may_be_none: bool = False) -> "RockingParameters":
        """Return the parameters of a body, including the coefficients of restitution.

        Parameters
        ----------
        body : Body
            The body.
        restitution : str, RestitutionModel, float, pair of float, mapping or ImpactLaw
            A model or its name; one coefficient, or one per foot as ``{"left": .., "right": ..}``; or a law that
            varies from impact to impact.
        gravity : float
            Acceleration of gravity [m/s2].
        may_be_none : bool
            True if the restitution may be None, for a body with friction. Complementarity then gives plastic impacts,
            or impacts with `normal_restitution`.

        Returns
        -------
        RockingParameters
            The parameters. Coefficients that are not imposed have the value `UNIMPOSED`.

        Raises
        ------
        InvalidValueError
            If the body has another type, or if a coefficient is negative, not finite, or would create energy.
        """
        checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
        law = restitution if isinstance(restitution, ImpactLaw) else ConstantRestitution()
        base = getattr(restitution, "times", 1.0) if isinstance(restitution, ImpactLaw) else restitution
        coefficients: Mapping[Foot, float]
        if may_be_none and is_none(base):
            coefficients, label = dict.fromkeys(FEET, UNIMPOSED), COMPLEMENTARITY
        else:
            coefficients, label = coefficients_of(base, body)
        sides: dict[Foot, RockingSide] = {}
        for foot in FEET:
            bound, side = energy_bound(body, foot), body.side(foot, gravity)
            share = _share(law, foot, coefficients[foot], bound)
            if share < 1.0:
                plausibility.warn(plausibility.of_truncation(1.0 - share, foot, bound))
            sides[foot] = RockingSide(
                side.slenderness_angle,
                side.frequency_parameter,
                side.semi_diagonal,
                float(coefficients[foot]),
                body.mass * side.semi_diagonal**2 / side.moment_of_inertia,  # Eq. 27
                share,
            )
        return cls(sides["right"], sides["left"], law, _label(law, {foot: sides[foot].share for foot in FEET}, label))


def is_none(restitution: Any) -> bool:
    """Return True if no coefficient is imposed: None, or the text for None in files and options."""
    return restitution is None or (isinstance(restitution, str) and restitution == COMPLEMENTARITY.split(maxsplit=1)[0])


def sides_of(bodies: Sequence[RockingParameters | None]) -> dict[str, FloatArray]:
    """Return alpha [rad], p [rad/s], r, q and share [-] of both sides of many bodies; NaN if a body is None."""
    return {
        f"{short}_{foot}": np.array([np.nan if body is None else getattr(getattr(body, foot), name) for body in bodies])
        for short, name in _SHORT.items()
        for foot in ("right", "left")
    }


def cut_of(law: ImpactLaw, body: Body) -> dict[Foot, float]:
    """Return the probability of the values of a law that would create energy and are truncated, by foot [-]."""
    coefficients, _ = coefficients_of(getattr(law, "times", 1.0), body)
    return _cut(law, {foot: _share(law, foot, coefficients[foot], energy_bound(body, foot)) for foot in FEET})


def cut_words(cut: Mapping[Foot, float]) -> str:
    """Return a text on the truncated probability for the end of a label; empty below 0.0001."""
    texts = [f"{percent(cut[foot])} onto {foot}" for foot in FEET if cut[foot] > _NEGLIGIBLE]
    if texts and cut["left"] == cut["right"]:
        texts = [percent(cut["left"])]
    return f" (of the distribution {' and '.join(texts)} cut off, where impacts would create energy)" if texts else ""


def _foot(sign: float) -> Foot:
    return "right" if sign > 0.0 else "left"


def _truncated(law: ImpactLaw) -> DrawnRestitution | None:
    return law if isinstance(law, DrawnRestitution) and law.truncates else None


def _share(law: ImpactLaw, foot: Foot, r: float, bound: float) -> float:
    """Return the fraction of a distribution below the energy bound of a side.

    Raise an error if other laws exceed the bound.
    """
    distribution = _truncated(law)
    largest = r * (distribution.quantile(1.0, foot) if distribution else law.largest)
    if largest <= bound * (1.0 + BOUND_ROUNDING):
        return 1.0
    if distribution:
        share = distribution.share_within(bound / r, foot)
        plausibility.of_truncation(1.0 - share, foot, bound)  # raises an error for an almost empty distribution
        return share
    raise energy_refusal(foot, bound, largest)


def _cut(law: ImpactLaw, shares: Mapping[Foot, float]) -> dict[Foot, float]:
    before = law.cut if isinstance(law, DrawnRestitution) else (0.0, 0.0)
    return {foot: 1.0 - (1.0 - cut) * shares[foot] for foot, cut in zip(FEET, before, strict=True)}


def _label(law: ImpactLaw, shares: Mapping[Foot, float], base: str) -> str:
    """Return the label of a restitution, with the truncated probability of the distribution."""
    if law.kind <= 0:
        return f"{type(law).__name__} times {base}" if law.kind < 0 else base
    if not isinstance(law, DrawnRestitution):
        return f"of the speed: {law.factors.min():.4g} to {law.largest:.4g} times {base}"
    left, right = (f"{law.table(foot)[0]:.4g} to {law.quantile(shares[foot], foot):.4g}" for foot in FEET)
    ends = left if left == right else f"left {left}, right {right},"
    return f"at random: {ends} times {base}{cut_words(_cut(law, shares))}"


def coefficients_of(restitution: Any, body: Body) -> tuple[dict[Foot, float], str]:
    """Return the coefficients for landing left and right [-], and their label. None selects complementarity."""
    if is_none(restitution):
        raise InvalidValueError(
            "{parameter}={value} needs friction; give friction= or a restitution model",
            parameter="restitution", value=restitution,
        )  # fmt: skip
    return _coefficients_of(restitution, body)
