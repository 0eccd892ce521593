"""What a measurement says: coefficients with intervals, what each impact took, what it agrees with, how sure it is."""

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
from rocking.identification.posterior import Mixture
from rocking.messages import Message
from rocking.quantities import Quantity
from rocking.restitution import RestitutionModel, implied, models

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.tables import Table

LEVELS = (0.5, 0.025, 0.975)
"""Of an estimate and its interval."""

_NOISES = {"times": "s", "rotation": "rad", "angular_velocity": "rad/s"}  # units of residuals
_SCATTERS = (
    "The coefficient of restitution is {mean}, from {count} impacts; from impact to impact it scatters by "
    "{scatter:.2g} %."
)
_SCATTERS_BELOW = (
    "The coefficient of restitution is {mean}, from {count} impacts; from impact to impact it scatters by less than "
    "{scatter:.2g} %."
)
_ENDS = (("value", "", ""), ("low", "_low", ", 2.5 % of it"), ("high", "_high", ", 97.5 % of it"))


@dataclass(frozen=True)
class IntervalEstimate:
    """A number with its 95 % interval.

    Parameters
    ----------
    value, low, high : float
        Median, 2.5 and 97.5 % of its posterior, in the unit of the number.

    Examples
    --------
    >>> print(IntervalEstimate(0.91171, 0.91154, 0.91186))
    0.91171 (0.91154 to 0.91186)
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return value and interval, in as many digits as its width asks for."""
        width = self.high - self.low
        how = f".{max(0, 1 - math.floor(math.log10(width)))}f" if 0.0 < width < math.inf else ".4g"
        return f"{self.value:{how}} ({self.low:{how}} to {self.high:{how}})"


def _ends(estimate: IntervalEstimate | None) -> dict[str, float] | None:
    return None if estimate is None else vars(estimate)


def estimated(mixture: Mixture, factor: float | None = None) -> IntervalEstimate:
    """Return the estimate of a distribution, or of factor times its exponential."""
    found = mixture.quantiles(*LEVELS)
    return IntervalEstimate(*(found if factor is None else (factor * math.exp(each) for each in found)))


@dataclass(frozen=True)
class Impact:
    """What one impact took."""

    number: int  # from zero; nothing is known of what the first one took
    time: float  # when it was, as it is computed [s]
    foot: Foot  # the foot on which the body lands
    speed: float  # angular velocity before it, without sign [rad/s]
    coefficient: IntervalEstimate  # theta_dot_after / theta_dot_before [-]


@dataclass(frozen=True)
class ModelComparison:
    """A model of restitution beside what was measured.

    Parameters
    ----------
    model : str
        Its name.
    coefficient : float
        What it says, as the geometric mean of both sides [-].
    within : bool
        Whether that is within the interval of the measured mean.
    bias : float
        What it says less what was measured [-].
    """

    model: str
    coefficient: float
    within: bool
    bias: float


@dataclass(frozen=True)
class ForcedRocking:
    """What else a rotation under a known ground motion says, and how far it says anything."""

    clock: IntervalEstimate  # by how much the clock of the measurement is ahead of that of the motion [s]
    gain: IntervalEstimate  # measured over true rotation [-]
    # coefficient of friction; where it is not identified only the low end is a number, a bound at 95 % [-]
    friction: IntervalEstimate
    stretches: int  # how often the half cycles begin anew, in a state that was measured and with no impact before them
    half_cycles_left_out: int  # half cycles that were left out, since rocking alone does not explain them
    used: float  # used, measured: duration of the half cycles that were used, and of the measurement [s]
    measured: float
    # when a difference of 1e-4 in r changes what follows from rest by a tenth of its peak; NaN if never [s]
    predictable: float

    def answer(self) -> Answer:
        """Return what is shown of it."""
        return Answer({
            "clock": vars(self.clock), "gain": vars(self.gain), "friction": vars(self.friction),
            "stretches": self.stretches, "half_cycles_left_out": self.half_cycles_left_out, "used": self.used,
            "measured": self.measured, "predictable": self.predictable,
        })  # fmt: skip

    def __str__(self) -> str:
        """Return it in sentences."""
        friction = (
            "Friction is not identified: feet that slid would explain what was measured no better than feet that held; "
            f"it is {self.friction.low:.2g} at least."
        )
        if math.isfinite(self.friction.value):
            friction = f"The feet slid; the coefficient of friction is {self.friction}. r is told without the slip."
        told = "From rest a difference of 1e-4 in r changes the motion nowhere by a tenth of its peak."
        if math.isfinite(self.predictable):
            told = (
                f"From rest the motion is told up to {self.predictable:.3g} s only: beyond, a difference of 1e-4 in r "
                "changes it by more than a tenth of its peak."
            )
        return (
            f"Identified from {self.used:.3g} s of half cycles out of {self.measured:.3g} s, begun anew in "
            f"{self.stretches} measured states. {told} {friction}"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Identification(Exported):
    """What a measurement of rocking says about restitution.

    Parameters
    ----------
    source : str
        Where the measurement comes from.
    refused : tuple of str or Message
        Why it is no rocking, or none that this model knows; numbers of a measurement that is refused mean nothing.
    doubts : tuple of str or Message
        What else there is to say against it.
    mean : IntervalEstimate
        Coefficient of restitution, the geometric mean of both sides [-].
    coefficients : dict of str to IntervalEstimate
        Mean coefficient by the foot on which the body lands [-].
    scatter : IntervalEstimate
        Standard deviation of ln r from impact to impact. Value and lower end are 0 where the measurement agrees with a
        coefficient that does not scatter; the upper end is that of one that does [-].
    no_scatter : float
        Probability that the coefficient does not scatter; 0.2 before the measurement [-].
    frequency_parameter : IntervalEstimate
        p, the mean of both sides [rad/s].
    tilt : IntervalEstimate
        Of the floor, clockwise [rad].
    trend, damping : IntervalEstimate or None
        Slope of ln r over ln of the speed, and damping ratio, if they were asked for [-].
    impacts : tuple of Impact
        What each impact took.
    residuals : ndarray
        Measured less computed values [s, rad or rad/s].
    noise : IntervalEstimate
        Standard deviation of these.
    independent : float
        Number of measured values that count.
    p_value : float
        Posterior predictive: how often impacts of the model change as steadily with their number as these [-].
    advantage : float
        ln of how much likelier the measurement is than as times with a constant mean interval; NaN of a series [-].
    converged : bool
        Whether the maximum of the posterior was found.
    impulse : dict of str to IntervalEstimate
        Position k of the impulse that the mean coefficients imply, by foot, 1 Housner's; empty without a body [-].
    models : tuple of ModelComparison
        Every model of restitution beside it, the closest first; empty without a body.
    designs : tuple of Design
        Experiments with this body, the most telling first.
    _next : dict of str to ndarray
        Quantiles of what the next impact takes, by foot, for `law` [-].
    measurement : ImpactTimes or RotationSeries
        What was measured.
    residual_times : ndarray
        When what `residuals` are of was measured [s].
    quantiles : ndarray
        Quantiles of the mean coefficient of restitution, at equal steps of its probability [-].
    forced : ForcedRocking or None
        What else there is of a measurement under a known ground motion.
    _common : float
        Standard deviation of ln of the mean that comes from the size of the body, common to all its trials [-].
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
    _next: dict[Foot, FloatArray]
    measurement: ImpactTimes | RotationSeries | None = None
    residual_times: FloatArray = field(default_factory=lambda: np.zeros(0))
    quantiles: FloatArray = field(default_factory=lambda: np.zeros(0))
    forced: ForcedRocking | None = None
    _common: float = 0.0

    @property
    def refusal(self) -> Message:
        """Why there is no coefficient."""
        return Message("No coefficient of restitution: {reasons}.", {"reasons": self.refused})

    @property
    def verdict(self) -> str:
        """What was found, in a sentence."""
        if self.refused:
            return self.refusal
        facts = {"mean": str(self.mean), "count": len(self.impacts)}
        if self.scatter.value == 0.0:
            return Message(_SCATTERS_BELOW, {**facts, "scatter": 100.0 * self.scatter.high})
        return Message(_SCATTERS, {**facts, "scatter": 100.0 * self.scatter.value})

    @property
    def scatter_text(self) -> str:
        """The scatter as text: a verb and a percentage; an upper bound where no scatter is more likely than some."""
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
        """Return what the next impacts of this body will take, with the scatter and with what is not known.

        Parameters
        ----------
        seed : int
            Seed of the draws.

        Returns
        -------
        RandomRestitution
            A law for `simulate` and every study.

        Raises
        ------
        InvalidValueError
            If the measurement was refused.
        """
        if self.refused:
            raise InvalidValueError(
                "there is no law of a measurement that was refused: {reason}", reason=self.refused[0]
            )
        return RandomRestitution(self._next, seed)

    def answer(self) -> Answer:
        """Return what is shown of the measurement.

        Returns
        -------
        Answer
            Coefficients, impacts, models and designs; of a refused measurement the reasons alone.
        """
        words = {
            "source": self.source, "verdict": self.verdict, "refused": self.refused, "doubts": self.doubts,
        }  # fmt: skip
        if self.refused:
            return Answer(words)
        estimates = ("mean", "scatter", "frequency_parameter", "tilt", "trend", "noise")
        numbers = ("no_scatter", "independent", "p_value", "advantage", "residuals", "residual_times", "quantiles")
        unit = next(unit for name, unit in _NOISES.items() if getattr(self.measurement, name, None) is not None)
        own = (
            Quantity("mean", "1", "mean coefficient of restitution"),
            Quantity("noise", unit, "standard deviation of the residuals"),
            Quantity("residuals", unit, "measured less computed values"),
            Quantity("quantiles", "1", "quantiles of the mean coefficient of restitution"),
        )
        return Answer({
            **words, **{name: _ends(getattr(self, name)) for name in estimates},
            "damping_ratio": _ends(self.damping), **{name: getattr(self, name) for name in numbers},
            "coefficient": {foot: vars(each) for foot, each in self.coefficients.items()},
            "impulse_ratio": {foot: vars(each) for foot, each in self.impulse.items()},
            "converged": self.converged,
            "impacts": [{**vars(each), "coefficient": vars(each.coefficient)} for each in self.impacts],
            "models": [vars(each) for each in self.models],
            "designs": [vars(each) for each in self.designs],
            "forced": self.forced and self.forced.answer(),
        }, {each.name: each for each in own})  # fmt: skip

    def plot(self, path: str | Path | None = None) -> "Figure":
        """Draw what was measured, the fit, what is left over, and the coefficient with the models beside it.

        Parameters
        ----------
        path : str or Path, optional
            Where to write the picture, too: .png, .svg or .pdf.

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
        """Write a report: verdict, picture, what each impact took, the models, and how it was found.

        Parameters
        ----------
        path : str or Path
            A document (.pdf), or a web page of one file (.html).
        name : str
            What the body is called.
        date : str
            Day of the report, as it should be printed.

        Returns
        -------
        Path
            The file.
        """
        from rocking.reports import report

        return report(self, path, name=name, date=date)

    def exported(self) -> "Table":
        """Return one row an impact, the models and what is left over beside them."""
        from rocking.tables import Column, Table, text_array

        of = self.impacts
        columns = {
            "time": Column(np.array([each.time for each in of]), "s", "when it was, as computed"),
            "foot": Column(text_array([each.foot for each in of]), "", "foot on which the body lands"),
            "speed": Column(np.array([each.speed for each in of]), "rad/s", "angular velocity before it"),
        }
        for key, end, meaning in _ENDS:
            values = np.array([getattr(each.coefficient, key) for each in of])
            columns[f"coefficient{end}"] = Column(values, "1", f"coefficient of restitution{meaning}")
        compared = {
            "model": Column(text_array([each.model for each in self.models]), "", "model of restitution"),
            "model_coefficient": Column(np.array([each.coefficient for each in self.models]), "1", "by the model"),
        }
        unit = "s" if isinstance(self.measurement, ImpactTimes) else ""
        left = {
            "measured_at": Column(self.residual_times, "s", "when it was measured"),
            "left_over": Column(self.residuals, unit, "measured less computed"),
        }
        provenance: dict[str, Any] = {
            "source": self.source,
            "verdict": self.verdict,
            "doubts": "; ".join(map(str, self.doubts)),
        }
        for name in ("mean", "scatter", "frequency_parameter", "tilt"):
            provenance |= {f"{name}{end}": getattr(getattr(self, name), key) for key, end, _ in _ENDS}
        beside = {"model": Table("model", compared), "sample": Table("sample", left)}
        return Table("impact", columns, provenance, beside)


def impulses(body: Body, coefficients: dict[Foot, IntervalEstimate]) -> dict[Foot, IntervalEstimate]:
    """Where the impulse acts that coefficients imply; the larger the coefficient, the smaller k."""
    found: dict[Foot, IntervalEstimate] = {}
    for foot, each in coefficients.items():
        value, high, low = (implied(body, r, foot=foot).impulse_ratio for r in (each.value, each.low, each.high))
        found[foot] = IntervalEstimate(value, low, high)
    return found


def compared(body: Body, mean: IntervalEstimate) -> tuple[ModelComparison, ...]:
    """Every model that needs no number beside what was measured, the closest first."""
    found = []
    for name, kind in models().items():
        try:
            model: RestitutionModel = kind()
            sides = [model.evaluate(body, foot=foot).coefficient for foot in FEET]
        except (TypeError, RockingError):  # it takes a number, or does not hold for this body
            continue
        value = math.sqrt(sides[0] * sides[1])
        found.append(ModelComparison(name, value, mean.low <= value <= mean.high, value - mean.value))
    return tuple(sorted(found, key=lambda each: abs(each.bias)))


def next_impact(mean: Mixture, scatter: FloatArray | float) -> FloatArray:
    """Quantiles of the coefficient of another impact; without scatter, of the mean."""
    spread = Mixture(mean.weights, mean.means, np.hypot(mean.deviations, scatter))
    levels = (np.arange(65) + 0.5) / 65.0
    return np.exp(np.minimum(spread.quantiles(*levels), math.log(10.0)))  # Eq. 274
