"""Results of an identification: coefficients with intervals, impacts, comparison with models."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics import RandomRestitution
from rocking.errors import InvalidValueError, RockingError
from rocking.exported import Exported
from rocking.identification.design import Design
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.identification.next_impacts import NextImpacts
from rocking.identification.posterior import Mixture
from rocking.messages import Message, listed
from rocking.quantities import Quantity
from rocking.restitution import RestitutionModel, implied, models

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.tables import Table

LEVELS = (0.5, 0.025, 0.975)
"""Probabilities of an estimate and its interval."""

_NOISES = {"times": "s", "rotation": "rad", "angular_velocity": "rad/s"}  # unit of the residuals by kind of measurement
_SCATTERS = (
    "The coefficient of restitution is {mean}, from {count} impacts. It scatters by {scatter:.2g} % from impact to "
    "impact."
)
_SCATTERS_BELOW = (
    "The coefficient of restitution is {mean}, from {count} impacts. It scatters by less than {scatter:.2g} % from "
    "impact to impact."
)
_ENDS = (("value", "", ""), ("low", "_low", ", 2.5 % quantile"), ("high", "_high", ", 97.5 % quantile"))


@dataclass(frozen=True)
class IntervalEstimate:
    """A number with its 95 % interval.

    Parameters
    ----------
    value, low, high : float
        Median, 2.5 % and 97.5 % quantile of the posterior, in the unit of the number.

    Examples
    --------
    >>> print(IntervalEstimate(0.91171, 0.91154, 0.91186))
    0.91171 (0.91154 to 0.91186)
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return value and interval; the width of the interval determines the digits."""
        width = self.high - self.low
        how = f".{max(0, 1 - math.floor(math.log10(width)))}f" if 0.0 < width < math.inf else ".4g"
        return f"{self.value:{how}} ({self.low:{how}} to {self.high:{how}})"


def _ends(estimate: IntervalEstimate | None) -> dict[str, float] | None:
    return None if estimate is None else vars(estimate)


def estimated(mixture: Mixture, factor: float | None = None) -> IntervalEstimate:
    """Return the estimate of a distribution, or of its exponential times a factor."""
    quantiles = mixture.quantiles(*LEVELS)
    return IntervalEstimate(*(quantiles if factor is None else (factor * math.exp(quantile) for quantile in quantiles)))


@dataclass(frozen=True)
class Impact:
    """One impact with its coefficient of restitution."""

    number: int  # number of the impact, from zero; the coefficient of impact 0 is unknown
    time: float  # computed time [s]
    foot: Foot  # foot in contact after the impact
    speed: float  # absolute angular velocity before the impact [rad/s]
    coefficient: IntervalEstimate  # theta_dot_after / theta_dot_before [-]


@dataclass(frozen=True)
class ModelComparison:
    """A restitution model compared with the measurement.

    Parameters
    ----------
    model : str
        Name.
    coefficient : float
        Coefficient of the model, the geometric mean of both sides [-].
    within : bool
        True if the coefficient is within the interval of the measured mean.
    bias : float
        Coefficient of the model minus measured coefficient [-].
    """

    model: str
    coefficient: float
    within: bool
    bias: float


@dataclass(frozen=True)
class ForcedRocking:
    """Additional results from a rotation under a known ground motion."""

    clock: IntervalEstimate  # time by which the clock of the measurement is ahead of the clock of the motion [s]
    gain: IntervalEstimate  # measured rotation / true rotation [-]
    # coefficient of friction [-]; if not identified, only the low end is a number: a bound at 95 %
    friction: IntervalEstimate
    stretches: int  # number of sequences of half cycles that begin with a measured state
    excluded_half_cycles: int  # number of excluded half cycles, which rocking alone does not explain
    used: float  # used, measured: duration of the used half cycles, and of the measurement [s]
    measured: float
    # time after which a change of r by 1e-4 changes the response from rest by 10 % of its peak [s]; NaN if never
    predictable: float

    def answer(self) -> Answer:
        """Return the result for display."""
        return Answer({
            "clock": vars(self.clock), "gain": vars(self.gain), "friction": vars(self.friction),
            "stretches": self.stretches, "excluded_half_cycles": self.excluded_half_cycles, "used": self.used,
            "measured": self.measured, "predictable": self.predictable,
        })  # fmt: skip

    def __str__(self) -> str:
        """Return the result as sentences."""
        friction = (
            "Friction is not identified: sliding does not improve the fit. The coefficient of friction is at least "
            "{self.friction.low:.2g}."
        )
        if math.isfinite(self.friction.value):
            friction = f"The feet slid. The coefficient of friction is {self.friction}. r excludes the slip."
        prediction = "A difference of 1e-4 in r changes the response from rest by less than 10 % of its peak."
        if math.isfinite(self.predictable):
            prediction = (
                f"The response from rest is predictable up to {self.predictable:.3g} s. Later, a difference of 1e-4 "
                "in r changes it by more than 10 % of its peak."
            )
        return (
            f"Identified from {self.used:.3g} s of half cycles out of {self.measured:.3g} s, in {self.stretches} "
            f"sequences with a measured first state. {prediction} {friction}"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Identification(Exported):
    """Coefficients of restitution identified from a measurement of rocking.

    Parameters
    ----------
    source : str
        Source of the measurement.
    refused : tuple of str or Message
        Reasons for a refusal, if any. The numbers of a refused measurement are meaningless.
    doubts : tuple of str or Message
        Other doubts.
    mean : IntervalEstimate
        Coefficient of restitution, the geometric mean of both sides [-].
    coefficients : dict of str to IntervalEstimate
        Mean coefficient by foot in contact after the impact [-].
    scatter : IntervalEstimate
        Standard deviation of ln r from impact to impact. Value and lower end are 0 if the measurement agrees with a
        coefficient without scatter; the upper end assumes scatter [-].
    no_scatter : float
        Probability that the coefficient does not scatter; 0.2 before the measurement [-].
    frequency_parameter : IntervalEstimate
        p, the mean of both sides [rad/s].
    tilt : IntervalEstimate
        Tilt of the floor, clockwise [rad].
    trend, damping : IntervalEstimate or None
        Slope of ln r over ln of the speed, and damping ratio, if requested [-].
    impacts : tuple of Impact
        Coefficient of each impact.
    residuals : ndarray
        Measured minus computed values [s, rad or rad/s].
    noise : IntervalEstimate
        Standard deviation of the residuals.
    independent : float
        Number of independent measured values.
    p_value : float
        Posterior predictive probability of an equally steady change with the impact number [-].
    advantage : float
        Log likelihood ratio to times with a constant mean interval; NaN for a series [-].
    converged : bool
        True if the maximum of the posterior was found.
    impulse : dict of str to IntervalEstimate
        Impulse position k of the mean coefficients, by foot; 1 for Housner; empty without a body [-].
    models : tuple of ModelComparison
        Comparison with every restitution model, the closest first; empty without a body.
    designs : tuple of Design
        Experiments with this body, the most accurate first.
    _next : NextImpacts or None
        Distribution of the coefficients of the next impacts, for `law`; None for a refused measurement.
    measurement : ImpactTimes or RotationSeries
        The measurement.
    residual_times : ndarray
        Times of the residuals [s].
    quantiles : ndarray
        Quantiles of the mean coefficient of restitution, at equal steps of its probability [-].
    forced : ForcedRocking or None
        Additional results under a known ground motion.
    _common : float
        Standard deviation of ln of the mean due to the size of the body, common to all its trials [-].
    """

    source: str
    refused: tuple[str | Message, ...]
    doubts: tuple[str | Message, ...]
    mean: IntervalEstimate
    coefficients: dict[Foot, IntervalEstimate]
    scatter: IntervalEstimate
    no_scatter: float
    frequency_parameter: IntervalEstimate
    tilt: IntervalEstimate
    trend: IntervalEstimate | None
    damping: IntervalEstimate | None
    impacts: tuple[Impact, ...]
    residuals: FloatArray
    noise: IntervalEstimate
    independent: float
    p_value: float
    advantage: float
    converged: bool
    impulse: dict[Foot, IntervalEstimate]
    models: tuple[ModelComparison, ...]
    designs: tuple[Design, ...]
    _next: NextImpacts | None
    measurement: ImpactTimes | RotationSeries | None = None
    residual_times: FloatArray = field(default_factory=lambda: np.zeros(0))
    quantiles: FloatArray = field(default_factory=lambda: np.zeros(0))
    forced: ForcedRocking | None = None
    _common: float = 0.0

    @property
    def refusal(self) -> Message:
        """Reason for the missing coefficient."""
        return Message("No coefficient of restitution: {reasons}.", {"reasons": self.refused})

    @property
    def verdict(self) -> str:
        """The result as one sentence."""
        if self.refused:
            return self.refusal
        facts = {"mean": str(self.mean), "count": len(self.impacts)}
        if self.scatter.value == 0.0:
            return Message(_SCATTERS_BELOW, {**facts, "scatter": 100.0 * self.scatter.high})
        return Message(_SCATTERS, {**facts, "scatter": 100.0 * self.scatter.value})

    @property
    def scatter_text(self) -> str:
        """The scatter as text: a verb and a percentage, or an upper bound."""
        if self.scatter.value == 0.0:
            return f"scatters by less than {100.0 * self.scatter.high:.2g} %"
        return f"scatters by {100.0 * self.scatter.value:.2g} %"

    def __str__(self) -> str:
        """Return the verdict, both sides and the doubts."""
        sides = [] if self.refused else [f"Landing {foot}: {self.coefficients[foot]}." for foot in FEET]
        forced = [str(self.forced)] if self.forced and not self.refused else []
        return "\n".join([self.verdict, *sides, *forced, *map(str, self.doubts)])

    __repr__ = __str__

    def law(self, *, seed: int = 0) -> RandomRestitution:
        """Return a law of the next impacts: one draw of the uncertain coefficients, and the scatter at each impact.

        Each law samples the coefficients of both feet and the scatter once, from their joint posterior. If the
        tilt is unknown, the mean of both feet is more accurate than the coefficient of each foot. Therefore the draws
        of both feet are correlated. The coefficient of each impact then scatters about the draw of its foot. All
        histories of one law have the same draw. Laws with several seeds give the uncertainty of a response.

        Parameters
        ----------
        seed : int
            Random seed of the draw and of the scatter.

        Returns
        -------
        RandomRestitution
            A law for `simulate` and every study.

        Raises
        ------
        InvalidValueError
            If the measurement was refused.
        """
        if self.refused or self._next is None:
            raise InvalidValueError(
                "a refused identification gives no restitution law: {reason}", reason=self.refused[0]
            )
        return self._next.law(seed)

    def answer(self) -> Answer:
        """Return the result of the measurement for display.

        Returns
        -------
        Answer
            Coefficients, impacts, models and designs; for a refused measurement only the reasons.
        """
        texts = {
            "source": self.source, "verdict": self.verdict, "refused": self.refused, "doubts": self.doubts,
        }  # fmt: skip
        if self.refused:
            return Answer(texts)
        estimates = ("mean", "scatter", "frequency_parameter", "tilt", "trend", "noise")
        numbers = ("no_scatter", "independent", "p_value", "advantage", "residuals", "residual_times", "quantiles")
        unit = next(unit for name, unit in _NOISES.items() if getattr(self.measurement, name, None) is not None)
        own = (
            Quantity("mean", "1", "mean coefficient of restitution"),
            Quantity("noise", unit, "standard deviation of the residuals"),
            Quantity("residuals", unit, "measured minus computed values"),
            Quantity("quantiles", "1", "quantiles of the mean coefficient of restitution"),
        )
        return Answer({
            **texts, **{name: _ends(getattr(self, name)) for name in estimates},
            "damping_ratio": _ends(self.damping), **{name: getattr(self, name) for name in numbers},
            "coefficient": {foot: vars(estimate) for foot, estimate in self.coefficients.items()},
            "impulse_ratio": {foot: vars(estimate) for foot, estimate in self.impulse.items()},
            "converged": self.converged,
            "impacts": [{**vars(impact), "coefficient": vars(impact.coefficient)} for impact in self.impacts],
            "models": [vars(model) for model in self.models],
            "designs": [vars(design) for design in self.designs],
            "forced": self.forced and self.forced.answer(),
        }, {quantity.name: quantity for quantity in own})  # fmt: skip

    def plot(self, path: str | Path | None = None) -> "Figure":
        """Draw the measurement, the fit, the residuals, and the coefficient with the models.

        Parameters
        ----------
        path : str or Path, optional
            File for the picture: .png, .svg or .pdf.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        """
        from rocking.plots import identification_picture, write

        figure = identification_picture(self)
        if path is not None:
            write(figure, Path(path))
        return figure

    def report(self, path: str | Path, *, name: str = "", date: str = "") -> Path:
        """Write a report: result, picture, impacts, models, and method.

        Parameters
        ----------
        path : str or Path
            A document (.pdf), or a web page of one file (.html).
        name : str
            Name of the body.
        date : str
            Printed date of the report.

        Returns
        -------
        Path
            The file.
        """
        from rocking.reports import report

        return report(self, path, name=name, date=date)

    def exported(self) -> "Table":
        """Return a table with one row per impact, and tables of the models and the residuals."""
        from rocking.tables import Column, Table, text_array

        impacts = self.impacts
        columns = {
            "time": Column(np.array([impact.time for impact in impacts]), "s", "computed time of the impact"),
            "foot": Column(text_array([impact.foot for impact in impacts]), "", "foot in contact after the impact"),
            "speed": Column(
                np.array([impact.speed for impact in impacts]), "rad/s", "angular velocity before the impact"
            ),
        }
        for key, end, meaning in _ENDS:
            values = np.array([getattr(impact.coefficient, key) for impact in impacts])
            columns[f"coefficient{end}"] = Column(values, "1", f"coefficient of restitution{meaning}")
        compared = {
            "model": Column(text_array([model.model for model in self.models]), "", "model of restitution"),
            "model_coefficient": Column(
                np.array([model.coefficient for model in self.models]), "1", "coefficient of the model"
            ),
        }
        unit = "s" if isinstance(self.measurement, ImpactTimes) else ""
        left = {
            "residual_time": Column(self.residual_times, "s", "time of the measurement"),
            "residual": Column(self.residuals, unit, "measured minus computed"),
        }
        provenance: dict[str, Any] = {
            "source": self.source,
            "verdict": self.verdict,
            "doubts": listed(self.doubts),
        }
        for name in ("mean", "scatter", "frequency_parameter", "tilt"):
            provenance |= {f"{name}{end}": getattr(getattr(self, name), key) for key, end, _ in _ENDS}
        related = {"model": Table("model", compared), "sample": Table("sample", left)}
        return Table("impact", columns, provenance, related)


def impulses(body: Body, coefficients: dict[Foot, IntervalEstimate]) -> dict[Foot, IntervalEstimate]:
    """Return the impulse position k of each foot from the coefficients. A larger coefficient gives a smaller k."""
    ratios: dict[Foot, IntervalEstimate] = {}
    for foot, estimate in coefficients.items():
        value, high, low = (
            implied(body, r, foot=foot).impulse_ratio for r in (estimate.value, estimate.low, estimate.high)
        )
        ratios[foot] = IntervalEstimate(value, low, high)
    return ratios


def compared(body: Body, mean: IntervalEstimate) -> tuple[ModelComparison, ...]:
    """Return all restitution models without parameters, compared with the mean, the closest first."""
    comparisons = []
    for name, kind in models().items():
        try:
            model: RestitutionModel = kind()
            sides = [model.evaluate(body, foot=foot).coefficient for foot in FEET]
        except (TypeError, RockingError):  # the model requires a value, or does not apply to this body
            continue
        value = math.sqrt(sides[0] * sides[1])
        comparisons.append(ModelComparison(name, value, mean.low <= value <= mean.high, value - mean.value))
    return tuple(sorted(comparisons, key=lambda comparison: abs(comparison.bias)))


def mean_quantiles(mean: Mixture) -> FloatArray:
    """Return quantiles of the mean coefficient, from the distribution of its logarithm."""
    levels = (np.arange(65) + 0.5) / 65.0
    return np.exp(np.minimum(mean.quantiles(*levels), math.log(10.0)))
