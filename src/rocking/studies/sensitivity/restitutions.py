"""Restitutions of a sensitivity study, with unique names."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics.content import full_name
from rocking.dynamics.impact_laws import ConstantRestitution, DrawnRestitution, ImpactLaw, RandomRestitution
from rocking.dynamics.parameters import COMPLEMENTARITY, cut_words
from rocking.dynamics.rows import Rows, drawn_rows
from rocking.errors import InvalidValueError
from rocking.restitution import RestitutionModel, model
from rocking.studies.histories import Histories, described_law


def named_restitutions(restitutions: Any) -> dict[str, Any]:
    """Return restitutions by name: models, coefficients [-], pairs by side, laws. A sequence gets names."""
    if isinstance(restitutions, Mapping):
        pairs = [(str(name), choice) for name, choice in restitutions.items()]
        if set(restitutions) == set(FEET):
            raise InvalidValueError("A mapping of left and right is one restitution. Use a list of restitutions.")
        for _, choice in pairs:
            label_of(choice)
    elif isinstance(restitutions, Sequence) and not isinstance(restitutions, str):
        pairs = [(label_of(choice), choice) for choice in restitutions]
    else:
        raise InvalidValueError(parameter="restitutions", allowed="a list or a dict of choices", value=restitutions)
    if len(pairs) < 2:
        raise InvalidValueError(parameter="restitutions", allowed="at least two choices", value=len(pairs))
    names = [name for name, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidValueError(
            "two restitutions have the name {name!r}. Use different names: {{name: choice}}.", name=twice
        )
    return dict(pairs)


def label_of(choice: Any) -> str:
    """Return the name of a choice of restitution. None is allowed with friction."""
    if choice is None:
        return COMPLEMENTARITY
    if isinstance(choice, (str, RestitutionModel)):
        return model(choice).label
    if isinstance(choice, DrawnRestitution):
        return _drawn(choice)
    if isinstance(choice, ImpactLaw):
        return type(choice).__name__ + _times(getattr(choice, "times", 1.0))
    if isinstance(choice, Mapping):
        if set(choice) != set(FEET):
            raise InvalidValueError(
                'restitution by side must be {{"left": r, "right": r}}, got {value}',
                parameter="restitution",
                value=choice,
            )
        return ", ".join(f"{foot} {checks.number(f'restitution[{foot!r}]', choice[foot]):.6g}" for foot in FEET)
    return f"{checks.number('restitution', choice):.6g}"


def _drawn(law: DrawnRestitution) -> str:
    unit = "history" if law.per_history else "impact"
    quantiles = [[law.quantile(probability, foot) for probability in (0.025, 0.5, 0.975)] for foot in FEET]
    of_feet = [f"{middle:.4g} [{low:.4g}, {high:.4g}]" for low, middle, high in quantiles]
    sides = of_feet[0] if law.factors.ndim == 1 else f"left {of_feet[0]}, right {of_feet[1]}"
    cut = cut_words(dict(zip(FEET, law.cut, strict=True)))
    return f"drawn per {unit}, {sides}, seed {law.seed}{_times(law.times)}{cut}"


def _times(base: Any) -> str:
    return "" if isinstance(base, (int, float)) and base == 1.0 else f" times {label_of(base)}"


_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


class SampledRestitution(DrawnRestitution):
    """A coefficient that is sampled once per history and used for all its impacts. r is uncertain, not random.

    The sample depends only on the seed and on the index of the history. Many histories are sampled before the
    computation, and can use both engines. A single response uses the reference engine. For a sample per impact, use
    `RandomRestitution`. Samples above the energy bound of a side are limited, and both sides use one random number, see
    `rocking.dynamics.impact_laws.DrawnRestitution`.

    Parameters
    ----------
    factors, seed, times, cut
        As for `RandomRestitution`.

    Raises
    ------
    InvalidValueError
        If the quantiles decrease or are outside [0, 1] (by side: outside [0, 10]), or if the seed is not a whole number
        from 0 to 2^64 - 1.

    Examples
    --------
    >>> law = SampledRestitution.normal(0.9, 0.02, seed=1)
    >>> bool(law.factor(1.0, 5, 0) == law.factor(2.0, 5, 3) == law.draws([5])[0])
    True
    """

    per_history: ClassVar[bool] = True

    @classmethod
    def of_law(cls, law: RandomRestitution) -> "SampledRestitution":
        """Return a law with the same distribution that is sampled per history instead of per impact.

        Parameters
        ----------
        law : RandomRestitution
            The law with a sample per impact.

        Returns
        -------
        SampledRestitution
            Law with quantiles, seed and base of `law`.

        Raises
        ------
        InvalidValueError
            If the law has another type.
        """
        checks.of_kind("law", law, RandomRestitution, "a RandomRestitution")
        return cls(law.factors, law.seed, law.times, law.cut)

    def content(self) -> dict[str, Any]:
        """Return the seed and the hashes of the tables, or the fields of a user-defined dataclass."""
        return self._tables() if type(self) is SampledRestitution else super().content()

    def draws(self, numbers: Any, foot: Foot | None = None, share: Any = 1.0) -> FloatArray:
        """Return the samples of many histories. They are bit-identical to `draw`.

        Parameters
        ----------
        numbers : array_like of int
            Indices of histories.
        foot : {"left", "right"}, optional
            The foot of the landing, for a law with two tables.
        share : float or array_like
            Probability of the lower part of the distribution that is sampled [-].

        Returns
        -------
        ndarray
            Coefficients or factors [-].
        """
        u, table = share * uniforms(self.seed, numbers), self.table(foot)  # Eq. 41
        above = np.clip(
            np.searchsorted(self.at, u, side="right"), 1, self.at.size - 1
        )  # the fraction `share` of an impossible body is NaN
        low, high = table[above - 1], table[above]
        return np.asarray(low + (high - low) * ((u - self.at[above - 1]) / (self.at[above] - self.at[above - 1])))


@dataclass(frozen=True, eq=False)
class SampledHistories(Histories):
    """Histories whose coefficients are multiplied by one sample per history, from the index of the history."""

    base: Histories  # the histories; if r = 1 on both sides, the sample is the coefficient
    draw: SampledRestitution  # distribution of the factors on the rows of the base

    @classmethod
    def of(cls, base: Histories, draw: SampledRestitution) -> "SampledHistories":
        """Return histories with samples that multiply the coefficients of the base."""
        histories: object = base
        if not isinstance(histories, Histories) or not isinstance(draw, SampledRestitution):
            raise InvalidValueError(
                "arguments must be Histories and a SampledRestitution, got {histories!r:.40} and {sample!r:.40}",
                histories=base,
                sample=draw,
            )  # fmt: skip
        if isinstance(histories, SampledHistories):
            raise InvalidValueError(
                "These histories already have sampled restitutions. Use the histories without samples (base)."
            )
        law = ConstantRestitution() if isinstance(base.law, SampledRestitution) else base.law
        return cls(base.motions, base, draw, law=law, settings=base.settings, engine=base.engine)

    @property
    def count(self) -> int:
        return self.base.count

    @property
    def together(self) -> int:
        """Number of consecutive histories of one motion."""
        return self.base.together

    def rows(self, first: int, last: int) -> Rows:
        """Return the rows of the base, with coefficients multiplied by the samples."""
        return drawn_rows(self.base.rows(first, last), self.draw)

    def content(self) -> dict[str, Any]:
        """Return the content of the base, and the distribution with its seed."""
        base = {"class": full_name(type(self.base)), "content": self.base.content()}
        return {"base": base, "draw": described_law(self.draw)}


def sampled(histories: Histories) -> Histories:
    """Return histories for the fast engine. A law with one sample per history is applied to the rows."""
    return SampledHistories.of(histories, histories.law) if isinstance(histories.law, SampledRestitution) else histories


def uniforms(seed: int, numbers: Any, impact: int = 0) -> FloatArray:
    """Return numbers in [0, 1) by seed, history and impact. They are bit-identical to `impact_laws.uniform`."""
    keys = np.atleast_1d(np.asarray(numbers))
    if keys.dtype.kind not in "iu":
        raise InvalidValueError(
            "{parameter} must be whole numbers of histories, got {dtype} {numbers!r:.40}", parameter="numbers",
            dtype=keys.dtype, numbers=numbers,
        )  # fmt: skip
    counter = np.uint64(int(checks.within("impact", impact, 0, 2**53)))
    bits = _mixed(_mixed(_mixed(np.full(1, seed, np.uint64)) + keys.astype(np.uint64)) + counter)  # Eq. 43
    return np.asarray((bits >> np.uint64(11)).astype(np.float64) * 2.0**-53)


def _mixed(z: Any) -> Any:
    """Return Splitmix64 of 64-bit words. The overflow is intended."""
    z = z + _GOLDEN
    z = (z ^ (z >> np.uint64(30))) * _FIRST
    z = (z ^ (z >> np.uint64(27))) * _SECOND
    return z ^ (z >> np.uint64(31))
