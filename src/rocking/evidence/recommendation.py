"""Which restitution model to use for a body, side by side with what speaks for and against every other."""

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
    "kept: energy left after two impacts, one onto each foot; to half: impacts that halve the energy; bias, error: "
    "mean and root mean square of r less the measurement."
)
"""What the columns of the table are, those of r apart."""
APART = 3.92  # standard errors between two values, so that 97.5 % of measurements lie nearer to the right one


def product(coefficients: Mapping[str, float]) -> float:
    """Return the product of coefficients, by the foot landed on [-]."""
    return math.prod(coefficients.values())


@dataclass(frozen=True, eq=False)
class ModelForBody:
    """A model and one body: what it gives, how it stands, what to know."""

    name: str  # name, title: name with parameters, and the model in one line
    title: str
    # closest to the measurements, not resolved from the closest, further off, does not hold for this body, or not
    # measured
    standing: Standing
    # theta_dot_after / theta_dot_before by the foot, or the edge, landed on; empty where there is none [-]
    coefficients: Mapping[str, float]
    # low, high: ends of the 95 % interval of one measured body, by foot; empty where nothing was measured [-]
    low: Mapping[str, float] = field(default_factory=dict)
    high: Mapping[str, float] = field(default_factory=dict)
    # errors on the measurements of bodies like this one; None where the model was not judged
    record: TrackRecord | None = None
    reasons: tuple[str, ...] = ()  # why the model does not hold for this body; empty if it does
    concerns: tuple[str, ...] = ()  # which of its known defects matters for this body, and how much
    outcome: Outcome | None = None  # how the body ends under the motion, if one was given
    peak_ratio: float = math.nan  # peak rotation over the slenderness angle of its side, NaN without a motion [-]

    @property
    def energy_left(self) -> float:
        """Share of the energy left after two impacts, one onto each foot; NaN where a coefficient is not known [-]."""
        return product(self.coefficients) ** 2 if len(self.coefficients) == len(FEET) else math.nan  # Eq. 113

    def scatter(self, foot: Foot) -> float:
        """Return how far one measured body may lie from the model onto a foot, as a standard deviation [-]."""
        # the shorter side may have been cut at 0 or at the energy bound
        r = self.coefficients[foot]
        return max(self.high[foot] - r, r - self.low[foot]) / NORMAL_95

    @property
    def impacts_to_half(self) -> float:
        """Impacts that halve the energy, and with it the amplitude of small rotations; 0 where the body stops [-]."""
        kept = self.energy_left
        return 0.0 if kept == 0.0 else math.inf if kept >= 1.0 else 2.0 * math.log(0.5) / math.log(kept)

    @property
    def with_intervals(self) -> str:
        """Coefficients with their intervals, in words; once, if both feet have the same."""
        found = [f"{self.coefficients[foot]:.4f} ({self.low[foot]:.4f} to {self.high[foot]:.4f})" for foot in FEET]
        return found[0] if found[0] == found[1] else f"{found[0]} onto the left foot, {found[1]} onto the right"

    @property
    def plain(self) -> str:
        """Name and coefficients alone, in words."""
        found = [f"{value:.4f}" for value in self.coefficients.values()]
        return f"{self.name} (r = {' and '.join(dict.fromkeys(found))})"

    def cell(self, place: str) -> str:
        """Return the coefficient at a place with half of its interval, for a table."""
        if place not in self.coefficients:
            return "-"
        half = f" +- {0.5 * (self.high[place] - self.low[place]):.3f}" if place in self.low else ""
        return f"{self.coefficients[place]:.4f}{half}"

    def answer(self) -> Answer:
        """Return what is shown of the model."""
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
    """How many histories overturn whose coefficients scatter as bodies do about the model for a number."""

    count: int  # of them
    draws: int  # all histories
    low: float  # low, high: ends of the 95 % interval of the share [-]
    high: float

    def __str__(self) -> str:
        share = percent(self.count / self.draws)
        return f"{share} of {self.draws} draws overturn (95 % interval {percent(self.low)} to {percent(self.high)})"


@dataclass(frozen=True, eq=False, repr=False)
class Recommendation(Exported):
    """Which restitution model to use for a body, and how sure that is.

    Parameters
    ----------
    body : Body or Solid
        The body.
    models : tuple of ModelForBody
        The calibrated default and every model, closest to the measurements first, what does not hold last.
    judgement : Judgement or None
        By which measurements they were judged; None for a body in space.
    outside : tuple of str
        Why the body is outside of what was measured, so that the measurements set no model aside; empty if it is not.
    notes : tuple of str
        What else is not known.
    prediction : str
        The model for a number; empty where nothing was measured.
    envelope : tuple of str
        The models for a decision, of the lowest and of the highest coefficient of those that remain.
    overturned : Overturned or None
        Under the motion, with coefficients that scatter; None without one.
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
        found = next((each for each in self.models if each.name == name), None)
        if found is None:
            raise KeyError(f"{name!r} is none of {', '.join(each.name for each in self.models)}")
        return found

    @property
    def remaining(self) -> tuple[str, ...]:
        """Names of the models that hold and that nothing sets aside."""
        return tuple(each.name for each in self.models if self._remains(each))

    def _remains(self, each: ModelForBody) -> bool:
        aside = each.standing is Standing.SET_ASIDE and not self.outside
        return not (aside or each.standing is Standing.EXCLUDED)

    @property
    def evidence(self) -> tuple[str, ...]:
        """What the measurements say of the models, and which do not hold, in sentences."""
        lines, judged = [], self.judgement
        if judged is not None:
            first = next(each for each in self.models if each.standing is Standing.CLOSEST)
            close, off = map(self._behind, (Standing.UNRESOLVED, Standing.SET_ASIDE))
            lines.append(
                f"Judged by {judged.words}: closest is {first.name}, with a root mean square error of r of "
                f"{first.record.rmse:.4f}."  # type: ignore[union-attr]
            )
            lines.append(
                f"Not resolved from it: {close} (the 95 % paired bootstrap interval of the difference includes zero, "
                f"or the difference is below the rounding of what was printed, {judged.rounding:.4f}). "
                f"Further off: {off}."
            )
            if self.outside and off != "none":
                lines.append("They are not set aside for this body, which is outside of what was measured.")
        lines += [f"{each.name} does not hold: {'; '.join(each.reasons)}." for each in self.models if each.reasons]
        lines += [f"{each.name}: {'; '.join(each.concerns)}." for each in self.models if each.concerns]
        lines += [f"Extrapolation: {each}." for each in self.outside]
        return (*lines, *self.notes)

    def _behind(self, standing: Standing) -> str:
        found = [each for each in self.models if each.standing is standing and each.record is not None]
        return ", ".join(f"{each.name} by {each.record.behind}" for each in found) or "none"  # type: ignore[union-attr]

    @property
    def advice(self) -> tuple[str, ...]:
        """What to use, for a number and for a decision, and what would settle it, in sentences."""
        if not self.envelope:
            return ("No coefficient is recommended.",)
        low, high = self[self.envelope[0]], self[self.envelope[-1]]
        number, steps = "For a number: nothing measured prefers a model.", []
        if self.prediction:
            why = "" if self.prediction == CALIBRATED else ", because the calibrated default is further off"
            how = ", an extrapolation" if self.outside else ""
            number = f"For a number: {self.prediction}, r = {self[self.prediction].with_intervals}{how}{why}."
            steps.append(f"let r scatter about {self.prediction} from history to history")
        if low is high:
            steps.append(f"run {low.plain}, beside which no model remains")
        else:
            steps.append(
                f"run {low.plain} and {high.plain} and report both: what remains lies between them, and none of it is "
                "resolved better for this body"
            )
        return (number, f"For a decision: {'; '.join(steps)}.", *self._verdict(), *self._settled(low, high))

    def _verdict(self) -> list[str]:
        share = self.overturned
        if share is None:
            return []
        remains = [each for each in self.models if self._remains(each)]
        over = [each.name for each in remains if each.outcome is Outcome.OVERTURNED]
        if len(remains) == 1:
            words = f"Under this motion it {'overturns' if over else 'does not overturn'} by the one model that remains"
        else:
            words = f"Under this motion {len(over)} of the {len(remains)} models that remain overturn it"
            words += f" ({', '.join(over)})" if over else ""
        sure = (len(over) == len(remains) and share.low > 0.95) or (not over and share.high < 0.05)
        end = "the choice of the model does not decide" if sure else "the coefficient decides: report both verdicts"
        return [f"{words}, and {share}: {end}."]

    def _settled(self, low: ModelForBody, high: ModelForBody) -> list[str]:
        """Say what a measurement must be, to tell the models of the envelope apart."""
        if low is high:
            return ["r measured on this body would replace every model."]
        apart, place = max((abs(high.coefficients[key] - low.coefficients[key]), key) for key in low.coefficients)
        words = f"What would settle it: r measured on this body{{}} with a standard error below {apart / APART:.2g}"
        if not self.prediction:
            return [words.format(",") + "."]
        spread = self[self.prediction].scatter("left" if place == "left" else "right")
        if apart < 0.5 * spread:
            return [
                f"The choice hardly matters: what remains differs by {apart:.2g} in r, and bodies scatter by "
                f"{spread:.2g}; r measured on this body would replace every model."
            ]
        count = math.ceil((APART * spread / apart) ** 2)
        many = f"the mean of {count} such bodies" if count > 1 else "any one such body"
        return [words.format("") + f", which then replaces every model; or {many}, since they scatter by {spread:.2g}."]

    @property
    def table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Heading and rows of words."""
        places = list(dict.fromkeys(place for each in self.models for place in each.coefficients))
        same = all(len({f"{v:.12f}" for v in each.coefficients.values()}) <= 1 for each in self.models)
        shown = places[:1] if same else places
        head = ["model", *(["r"] if same else [f"r {place}" for place in shown])]
        head += ["kept", "to half", "bias", "error"] if self.judgement is not None else []
        head += ["standing", *(["peak", "ends"] if self.overturned else [])]
        rows = []
        for each in self.models:
            cells = [each.name, *map(each.cell, shown)]
            if self.judgement is not None:
                known, record = bool(each.coefficients), each.record
                cells += [f"{100.0 * each.energy_left:.1f} %", f"{each.impacts_to_half:.1f}"] if known else ["-", "-"]
                cells += ["-", "-"] if record is None else [f"{record.bias:+.4f}", f"{record.rmse:.4f}"]
            cells.append(each.standing.value)
            if self.overturned:
                ends = "-" if each.outcome is None else each.outcome.name.lower().replace("_", " ")
                stood = each.outcome not in (None, Outcome.OVERTURNED)
                cells += [f"{each.peak_ratio:.2f}" if stood else "-", ends]
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
        return "\n".join([*shown, *(f"- {each}" for each in (*self.evidence, *self.advice))])

    def answer(self) -> Answer:
        """Return everything that is shown.

        Returns
        -------
        Answer
            Models, measurements that judge them, and advice.
        """
        judged = self.judgement
        return Answer({
            "prediction": self.prediction or None,
            "envelope": self.envelope,
            "judged_by": None if judged is None else {"measurements": len(judged.rows), "rounding": judged.rounding},
            "outside": self.outside,
            "notes": self.notes,
            "models": [each.answer() for each in self.models],
            "overturned": None if self.overturned is None else [self.overturned.count, self.overturned.draws],
            "evidence": self.evidence,
            "advice": self.advice,
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return one row a model."""
        from rocking.tables import Column, Table, text_array

        def column(values: list[Any], meaning: str) -> Column:
            if any(isinstance(value, str) for value in values):
                return Column(text_array(values), "", meaning)
            return Column(np.array(values, dtype=np.float64), "1", meaning)

        each = self.models
        places = list(dict.fromkeys(place for row in each for place in row.coefficients))
        columns = {
            "model": column([row.name for row in each], "restitution model"),
            "standing": column([row.standing.value for row in each], "how it stands against the measurements"),
        }
        for name, meaning in (("coefficients", "coefficient of restitution"), ("low", "2.5 %"), ("high", "97.5 %")):
            for place in places:
                values = [getattr(row, name).get(place, math.nan) for row in each]
                key = "coefficient" if name == "coefficients" else name
                columns[f"{key}_{place.replace(' ', '_')}"] = column(values, f"{meaning}, landing on {place}")
        columns["energy_left"] = column([row.energy_left for row in each], "energy left after both feet")
        columns["impacts_to_half"] = column([row.impacts_to_half for row in each], "impacts that halve the energy")
        for name, meaning in (("bias", "mean of model minus measurement"), ("rmse", "root mean square error of r")):
            values = [math.nan if row.record is None else getattr(row.record, name) for row in each]
            columns[name] = column(values, meaning)
        for end in ("value", "low", "high"):
            values = [math.nan if row.record is None else getattr(row.record.behind, end) for row in each]
            columns["behind" if end == "value" else f"behind_{end}"] = column(values, "rmse less that of the closest")
        provenance = {
            "prediction": self.prediction,
            "envelope": ", ".join(self.envelope),
            "advice": " ".join(self.advice),
        }
        return Table("model", columns, provenance)
