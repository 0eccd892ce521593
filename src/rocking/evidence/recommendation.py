"""Recommended restitution model of a body, with the evidence for and against all models."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Answer
from rocking.conventions import FEET, NORMAL_95, Foot, percent
from rocking.evidence._coefficient_table import CALIBRATED
from rocking.evidence.judgement import Judgement, Standing, TrackRecord
from rocking.exported import Exported
from rocking.outcome import Outcome

if TYPE_CHECKING:
    from rocking.tables import Table

LEGEND = (
    "kept: fraction of energy after two impacts, one on each foot. to half: impacts that halve the energy. bias, "
    "error: mean and root mean square of r minus the measurement."
)
"""Columns of the table, except the columns of r."""
APART = 3.92  # standard errors between two values, so that 97.5 % of measurements are nearer to the correct value


def product(coefficients: Mapping[str, float]) -> float:
    """Return the product of coefficients of landing feet [-]."""
    return math.prod(coefficients.values())


@dataclass(frozen=True, eq=False)
class ModelForBody:
    """A model for one body: coefficients, rank and limitations."""

    name: str  # name: model with its parameters; title: description of the model in one line
    title: str
    # rank: closest to the measurements, not resolved, further off, does not hold for this body, or not measured
    standing: Standing
    # theta_dot_after / theta_dot_before by landing foot or edge; empty if the model does not hold [-]
    coefficients: Mapping[str, float]
    # low, high: ends of the 95 % interval of one measured body, by foot; empty without measurements [-]
    low: Mapping[str, float] = field(default_factory=dict)
    high: Mapping[str, float] = field(default_factory=dict)
    # errors on the measurements of similar bodies; None if the model was not compared
    record: TrackRecord | None = None
    reasons: tuple[str, ...] = ()  # reasons why the model does not hold for this body
    concerns: tuple[str, ...] = ()  # known defects of the model for this body, with their size
    outcome: Outcome | None = None  # outcome under the motion; None without a motion
    peak_ratio: float = math.nan  # peak rotation / slenderness angle of its side, NaN without a motion [-]

    @property
    def energy_left(self) -> float:
        """Fraction of energy after two impacts, one on each foot; NaN if a coefficient is missing [-]."""
        return product(self.coefficients) ** 2 if len(self.coefficients) == len(FEET) else math.nan  # Eq. 113

    def scatter(self, foot: Foot) -> float:
        """Return the standard deviation of single measured bodies about the model, for landing on a foot [-]."""
        # the shorter side of the interval may be truncated at 0 or at the energy bound
        r = self.coefficients[foot]
        return max(self.high[foot] - r, r - self.low[foot]) / NORMAL_95

    @property
    def impacts_to_half(self) -> float:
        """Number of impacts that halve the energy, and the amplitude of small rotations; 0 if the body stops [-]."""
        kept = self.energy_left
        return 0.0 if kept == 0.0 else math.inf if kept >= 1.0 else 2.0 * math.log(0.5) / math.log(kept)

    @property
    def with_intervals(self) -> str:
        """Coefficients with their intervals as text; one entry if both feet have equal coefficients."""
        texts = [f"{self.coefficients[foot]:.4f} ({self.low[foot]:.4f} to {self.high[foot]:.4f})" for foot in FEET]
        return texts[0] if texts[0] == texts[1] else f"{texts[0]} on the left foot, {texts[1]} on the right foot"

    @property
    def plain(self) -> str:
        """Name and coefficients as text."""
        values = [f"{value:.4f}" for value in self.coefficients.values()]
        return f"{self.name} (r = {' and '.join(dict.fromkeys(values))})"

    def cell(self, landing: str) -> str:
        """Return the coefficient of a landing foot or edge with half of its interval, for a table."""
        if landing not in self.coefficients:
            return "-"
        half = f" +- {0.5 * (self.high[landing] - self.low[landing]):.3f}" if landing in self.low else ""
        return f"{self.coefficients[landing]:.4f}{half}"

    def answer(self) -> Answer:
        """Return the results of the model."""
        record = self.record
        return Answer({
            "model": self.name,
            "title": self.title,
            "standing": self.standing.value,
            "coefficient": self.coefficients,
            "coefficient_low": self.low,
            "coefficient_high": self.high,
            "energy_left": self.energy_left,
            "impacts_to_half": self.impacts_to_half,
            "bias": None if record is None else record.bias,
            "rmse": None if record is None else record.rmse,
            "loss_rmse": None if record is None else record.loss_rmse,
            "behind_closest": None if record is None else [record.behind.value, record.behind.low, record.behind.high],
            "reasons": self.reasons,
            "concerns": self.concerns,
            "outcome": None if self.outcome is None else self.outcome.name.lower(),
            "peak_ratio": self.peak_ratio,
        })  # fmt: skip


@dataclass(frozen=True, slots=True)
class Overturned:
    """Number of histories with overturning, for coefficients sampled about the recommended model."""

    count: int  # histories with overturning
    draws: int  # all histories
    low: float  # low, high: ends of the 95 % interval of the fraction [-]
    high: float

    def __str__(self) -> str:
        share = percent(self.count / self.draws)
        return f"{share} of {self.draws} samples overturn (95 % interval {percent(self.low)} to {percent(self.high)})"


@dataclass(frozen=True, eq=False, repr=False)
class Recommendation(Exported):
    """Recommended restitution model of a body, with its evidence.

    Parameters
    ----------
    body : Body or Solid
        The body.
    models : tuple of ModelForBody
        The calibrated default and all models, closest to the measurements first, excluded models last.
    judgement : Judgement or None
        Comparison with the measurements; None for a 3D body.
    outside : tuple of str
        Reasons why the body is outside the measured range; if any, the measurements exclude no model.
    notes : tuple of str
        Further limitations.
    prediction : str
        Model for a single value; empty without measurements.
    envelope : tuple of str
        Models for a decision: lowest and highest coefficient of the remaining models.
    overturned : Overturned or None
        Overturning under the motion with sampled coefficients; None without a motion.
    """

    body: Any
    models: tuple[ModelForBody, ...]
    judgement: Judgement | None
    outside: tuple[str, ...]
    notes: tuple[str, ...]
    prediction: str
    envelope: tuple[str, ...]
    overturned: Overturned | None = None

    def __getitem__(self, name: str) -> ModelForBody:
        match = next((candidate for candidate in self.models if candidate.name == name), None)
        if match is None:
            raise KeyError(f"{name!r} is none of {', '.join(candidate.name for candidate in self.models)}")
        return match

    @property
    def remaining(self) -> tuple[str, ...]:
        """Names of the models that hold for the body and are not excluded by measurements."""
        return tuple(candidate.name for candidate in self.models if self._remains(candidate))

    def _remains(self, candidate: ModelForBody) -> bool:
        is_set_aside = candidate.standing is Standing.SET_ASIDE and not self.outside
        return not (is_set_aside or candidate.standing is Standing.EXCLUDED)

    @property
    def evidence(self) -> tuple[str, ...]:
        """Sentences on the comparison with measurements, and on models that do not hold."""
        lines, judgement = [], self.judgement
        if judgement is not None:
            first = next(item for item in self.models if item.standing is Standing.CLOSEST)
            close, off = map(self._behind, (Standing.UNRESOLVED, Standing.SET_ASIDE))
            lines.append(
                f"Compared with {judgement.description}: the closest model is {first.name}, with an RMSE of r of "
                f"{first.record.rmse:.4f}."  # type: ignore[union-attr]
            )
            lines.append(
                f"Not distinguishable (95 %) from it: {close} (the paired bootstrap interval of the difference "
                f"includes zero, or the difference is below the rounding of the printed values, "
                f"{judgement.rounding:.4f}). Further off: {off}."
            )
            if self.outside and off != "none":
                lines.append("They are not excluded, because this body is outside the measured range.")
        lines += [f"{item.name} does not hold: {'; '.join(item.reasons)}." for item in self.models if item.reasons]
        lines += [f"{item.name}: {'; '.join(item.concerns)}." for item in self.models if item.concerns]
        lines += [f"Extrapolation: {item}." for item in self.outside]
        return (*lines, *self.notes)

    def _behind(self, standing: Standing) -> str:
        matches = [
            candidate for candidate in self.models if candidate.standing is standing and candidate.record is not None
        ]
        return ", ".join(f"{candidate.name} by {candidate.record.behind}" for candidate in matches) or "none"  # type: ignore[union-attr]

    @property
    def advice(self) -> tuple[str, ...]:
        """Sentences on the model for a single value, the models for a decision, and a decisive measurement."""
        if not self.envelope:
            return ("No coefficient is recommended.",)
        low, high = self[self.envelope[0]], self[self.envelope[-1]]
        number, steps = "Single value: there are no measurements to prefer a model.", []
        if self.prediction:
            reason = "" if self.prediction == CALIBRATED else " (the calibrated default is further off)"
            extrapolation = ", an extrapolation" if self.outside else ""
            number = (
                f"Single value: {self.prediction}, r = {self[self.prediction].with_intervals}{extrapolation}{reason}."
            )
            steps.append(f"sample r about {self.prediction} for each history")
        if low is high:
            steps.append(f"run {low.plain}, the only remaining model")
        else:
            steps.append(
                f"run {low.plain} and {high.plain} and report both; the other remaining models are between them, and "
                "the measurements do not distinguish them for this body"
            )
        return (number, f"Decision: {'; '.join(steps)}.", *self._verdict(), *self._settled(low, high))

    def _verdict(self) -> list[str]:
        draws = self.overturned
        if draws is None:
            return []
        remains = [candidate for candidate in self.models if self._remains(candidate)]
        overturned = [candidate.name for candidate in remains if candidate.outcome is Outcome.OVERTURNED]
        if len(remains) == 1:
            verb = "overturns" if overturned else "does not overturn"
            text = f"Under this motion the body {verb} with the only remaining model"
        else:
            text = f"Under this motion the body overturns with {len(overturned)} of the {len(remains)} remaining models"
            text += f" ({', '.join(overturned)})" if overturned else ""
        is_clear = (len(overturned) == len(remains) and draws.low > 0.95) or (not overturned and draws.high < 0.05)
        end = (
            "the result does not depend on the model"
            if is_clear
            else "the result depends on the model; report both outcomes"
        )
        return [f"{text}, and {draws}: {end}."]

    def _settled(self, low: ModelForBody, high: ModelForBody) -> list[str]:
        """Return a sentence on the measurement that distinguishes the models of the envelope."""
        if low is high:
            return ["A measured r of this body would replace all models."]
        difference, landing = max(
            (abs(high.coefficients[key] - low.coefficients[key]), key) for key in low.coefficients
        )
        text = f"Decisive measurement: r of this body{{}} with a standard error below {difference / APART:.2g}"
        if not self.prediction:
            return [text.format(",") + "."]
        spread = self[self.prediction].scatter("left" if landing == "left" else "right")
        if difference < 0.5 * spread:
            return [
                f"The choice has little effect: the remaining models differ by {difference:.2g} in r, and bodies "
                f"scatter by {spread:.2g}. A measured r of this body would replace all models."
            ]
        count = math.ceil((APART * spread / difference) ** 2)
        sample = f"the mean of {count} such bodies" if count > 1 else "any one such body"
        return [text.format("") + f", which replaces all models; or {sample}, because bodies scatter by {spread:.2g}."]

    @property
    def table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Heading and rows of text."""
        landings = list(dict.fromkeys(landing for candidate in self.models for landing in candidate.coefficients))
        same = all(len({f"{v:.12f}" for v in candidate.coefficients.values()}) <= 1 for candidate in self.models)
        columns = landings[:1] if same else landings
        head = ["model", *(["r"] if same else [f"r {landing}" for landing in columns])]
        head += ["kept", "to half", "bias", "error"] if self.judgement is not None else []
        head += ["standing", *(["peak", "ends"] if self.overturned else [])]
        rows = []
        for candidate in self.models:
            cells = [candidate.name, *map(candidate.cell, columns)]
            if self.judgement is not None:
                has_coefficients, record = bool(candidate.coefficients), candidate.record
                cells += (
                    [f"{100.0 * candidate.energy_left:.1f} %", f"{candidate.impacts_to_half:.1f}"]
                    if has_coefficients
                    else ["-", "-"]
                )
                cells += ["-", "-"] if record is None else [f"{record.bias:+.4f}", f"{record.rmse:.4f}"]
            cells.append(candidate.standing.value)
            if self.overturned:
                ends = "-" if candidate.outcome is None else candidate.outcome.name.lower().replace("_", " ")
                not_overturned = candidate.outcome not in (None, Outcome.OVERTURNED)
                cells += [f"{candidate.peak_ratio:.2f}" if not_overturned else "-", ends]
            rows.append(tuple(cells))
        return tuple(head), rows

    @property
    def _legend(self) -> str:
        peak = " peak: largest rotation over the slenderness angle." if self.overturned else ""
        return "" if self.judgement is None else f"r: coefficient and half of its 95 % interval; {LEGEND}{peak}"

    def __str__(self) -> str:
        head, rows = self.table
        widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in (head, *rows)]
        shown = [*(line.rstrip() for line in lines), *filter(None, [self._legend]), ""] if rows else []
        return "\n".join([*shown, *self.evidence, *self.advice])

    __repr__ = __str__

    def _repr_markdown_(self) -> str:
        head, rows = self.table
        lines = ["| " + " | ".join(row) + " |" for row in (head, ("---",) * len(head), *rows)]
        shown = [*lines, "", self._legend, ""] if rows else []
        return "\n".join([*shown, *(f"- {sentence}" for sentence in (*self.evidence, *self.advice))])

    def answer(self) -> Answer:
        """Return all results.

        Returns
        -------
        Answer
            Models, comparison with measurements, and advice.
        """
        judgement = self.judgement
        return Answer({
            "prediction": self.prediction or None,
            "envelope": self.envelope,
            "judged_by": None if judgement is None
            else {"measurements": len(judgement.rows), "rounding": judgement.rounding},
            "outside": self.outside,
            "notes": self.notes,
            "models": [candidate.answer() for candidate in self.models],
            "overturned": None if self.overturned is None else [self.overturned.count, self.overturned.draws],
            "evidence": self.evidence,
            "advice": self.advice,
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return a table with one row per model."""
        from rocking.tables import Column, Table, text_array

        def column(values: list[Any], meaning: str) -> Column:
            if any(isinstance(value, str) for value in values):
                return Column(text_array(values), "", meaning)
            return Column(np.array(values, dtype=np.float64), "1", meaning)

        rows = self.models
        landings = list(dict.fromkeys(landing for row in rows for landing in row.coefficients))
        columns = {
            "model": column([row.name for row in rows], "restitution model"),
            "standing": column([row.standing.value for row in rows], "rank compared with the measurements"),
        }
        for name, meaning in (("coefficients", "coefficient of restitution"), ("low", "2.5 %"), ("high", "97.5 %")):
            for landing in landings:
                values = [getattr(row, name).get(landing, math.nan) for row in rows]
                key = "coefficient" if name == "coefficients" else name
                columns[f"{key}_{landing.replace(' ', '_')}"] = column(values, f"{meaning}, landing on {landing}")
        columns["energy_left"] = column([row.energy_left for row in rows], "energy left after both feet")
        columns["impacts_to_half"] = column([row.impacts_to_half for row in rows], "impacts that halve the energy")
        for name, meaning in (("bias", "mean of model minus measurement"), ("rmse", "root mean square error of r")):
            values = [math.nan if row.record is None else getattr(row.record, name) for row in rows]
            columns[name] = column(values, meaning)
        for end in ("value", "low", "high"):
            values = [math.nan if row.record is None else getattr(row.record.behind, end) for row in rows]
            columns["behind" if end == "value" else f"behind_{end}"] = column(values, "rmse minus that of the closest")
        provenance = {
            "prediction": self.prediction,
            "envelope": ", ".join(self.envelope),
            "advice": " ".join(self.advice),
        }
        return Table("model", columns, provenance)
