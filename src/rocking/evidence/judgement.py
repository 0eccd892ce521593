"""How models stand against measurements of bodies like one at hand, who is closest, and a recommendation in words.

The rule, which nothing but the measurements decides:

1. Judged by are the measurements in the slenderness bands in which the sides of the body lie; all measurements where
   those are of fewer than five specimens.
2. Models stand as they are, nothing fitted. The calibrated default stands by predictions of calibrations that have not
   seen the measurement's group: its data set and interface.
3. A model is set aside if its root mean square error of r is above that of the closest by a paired bootstrap interval
   that does not include zero (`rocking.evidence.comparison`), and by more than the rounding of the printed digits. What
   is left is not resolved.
4. Intervals are of pairs and not corrected for their number: of eight models that are equally good one is set aside by
   chance more often than once in twenty.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FEET, FloatArray, IntArray
from rocking.evidence._coefficient_table import CALIBRATED
from rocking.evidence.comparison import FEWEST, Difference, bias, compare, loss_rmse, rmse
from rocking.evidence.hierarchy import unseen
from rocking.evidence.measurements import BANDS, DataSet
from rocking.outcome import Outcome
from rocking.restitution import RestitutionModel

if TYPE_CHECKING:
    from rocking.evidence.recommendation import ModelForBody, Recommendation


class Standing(Enum):
    """Where a model stands; the value is what a user reads."""

    CLOSEST = "closest"
    UNRESOLVED = "not resolved"
    SET_ASIDE = "further off"
    EXCLUDED = "does not hold"
    UNJUDGED = "not measured"


@dataclass(frozen=True, slots=True)
class TrackRecord:
    """What the measurements of bodies like one at hand say of a model."""

    standing: Standing
    bias: float  # mean of model minus measurement [-]
    rmse: float  # rmse, loss_rmse: root mean square errors of r, and of the energy loss 1 - r^2 [-]
    loss_rmse: float
    behind: Difference  # rmse less that of the closest, with its 95 % interval [-]


@dataclass(frozen=True, slots=True, eq=False)
class Judgement:
    """How models stand against measurements."""

    rows: DataSet  # the measurements that count
    words: str  # which they are
    rounding: float  # root mean square of the half widths that printed digits leave open [-]
    calibrated: TrackRecord
    models: tuple[TrackRecord, ...]  # in the order of the models


def judge(models: Sequence[RestitutionModel], ratios: tuple[float, ...], data: DataSet) -> Judgement:
    """Judge models for a body; ratios: slenderness of its sides [-]."""
    chosen, words = _like(ratios, data)
    rows = data.rows(chosen.tolist())
    predicted = [unseen(data)[chosen], *(model.of_slenderness(rows.slenderness) for model in models)]
    rounding = rmse(0.5 * rows.high, 0.5 * rows.low)
    errors = [rmse(r, rows.coefficient) for r in predicted]
    closest = errors.index(min(errors))
    records = tuple(_record(rows, r, predicted[closest], rounding, k == closest) for k, r in enumerate(predicted))
    return Judgement(rows, words, rounding, records[0], records[1:])


def _record(rows: DataSet, r: FloatArray, closest: FloatArray, rounding: float, first: bool) -> TrackRecord:
    found = compare(rows, r, closest)
    behind = Difference(found.first - found.second, found.low, found.high)
    aside = behind.sign > 0 and behind.value > rounding
    standing = Standing.CLOSEST if first else Standing.SET_ASIDE if aside else Standing.UNRESOLVED
    return TrackRecord(standing, bias(r, rows.coefficient), found.first, loss_rmse(r, rows.coefficient), behind)


def _like(ratios: tuple[float, ...], data: DataSet) -> tuple[IntArray, str]:
    """Return the numbers of the measurements that count, and in words which they are."""
    bands = [band for band in BANDS if any(band[1] < ratio <= band[2] for ratio in ratios)]
    inside = np.zeros(len(data), dtype=bool)
    for _, low, high in bands:
        inside |= (data.slenderness > low) & (data.slenderness <= high)
    chosen = np.flatnonzero(inside)
    specimens = {(data.group[i], data.labels[i]) for i in chosen.tolist()}
    if len(specimens) < FEWEST:
        return np.arange(len(data)), f"all {len(data)} measurements"
    return chosen, f"the {len(chosen)} of {len(data)} measurements with {' or '.join(band[0] for band in bands)}"


LEGEND = (
    "kept: energy left after two impacts, one onto each foot; to half: impacts that halve the energy; bias, error: "
    "mean and root mean square of r less the measurement."
)
"""What the columns of the table are, those of r apart."""

APART = 3.92  # standard errors between two values, so that 97.5 % of measurements lie nearer to the right one


def evidence(made: "Recommendation") -> list[str]:
    """Return what the measurements say of the models, and which do not hold."""
    lines, judged = [], made.judgement
    if judged is not None:
        first = next(each for each in made.models if each.standing is Standing.CLOSEST)
        close, off = (_behind(made, standing) for standing in (Standing.UNRESOLVED, Standing.SET_ASIDE))
        lines.append(
            f"Judged by {judged.words}: closest is {first.name}, with a root mean square error of r of "
            f"{first.record.rmse:.4f}."  # type: ignore[union-attr]
        )
        lines.append(
            f"Not resolved from it: {close or 'none'} (the 95 % paired bootstrap interval of the difference includes "
            f"zero, or the difference is below the rounding of what was printed, {judged.rounding:.4f}). "
            f"Further off: {off or 'none'}."
        )
        if made.outside and off:
            lines.append("They are not set aside for this body, which is outside of what was measured.")
    lines += [f"{each.name} does not hold: {'; '.join(each.reasons)}." for each in made.models if each.reasons]
    lines += [f"{each.name}: {'; '.join(each.concerns)}." for each in made.models if each.concerns]
    lines += [f"Extrapolation: {each}." for each in made.outside]
    return [*lines, *made.notes]


def _behind(made: "Recommendation", standing: Standing) -> str:
    found = [each for each in made.models if each.standing is standing and each.record is not None]
    return ", ".join(f"{each.name} by {each.record.behind}" for each in found)  # type: ignore[union-attr]


def advice(made: "Recommendation") -> list[str]:
    """Return what to use, and what would settle it."""
    if not made.envelope:
        return ["No coefficient is recommended."]
    lines, low, high = [], made[made.envelope[0]], made[made.envelope[-1]]
    if made.prediction:
        row = made[made.prediction]
        values = _values(row)
        why = "" if row.name == CALIBRATED else ", because the calibrated default is further off"
        how = ", an extrapolation" if made.outside else ""
        lines.append(f"For a number: {row.name}, r = {values}{how}{why}.")
    else:
        lines.append("For a number: nothing measured prefers a model.")
    steps = [f"let r scatter about {made.prediction} from history to history"] if made.prediction else []
    if low is high:
        steps.append(f"run {low.name} ({_plain(low)}), beside which no model remains")
    else:
        steps.append(
            f"run {low.name} ({_plain(low)}) and {high.name} ({_plain(high)}) and report both: what remains lies "
            "between them, and none of it is resolved better for this body"
        )
    lines.append(f"For a decision: {'; '.join(steps)}.")
    return [*lines, *_verdict(made), *_settled(made, low, high)]


def _verdict(made: "Recommendation") -> list[str]:
    share = made.overturned
    if share is None:
        return []
    remains = [each for each in made.models if each.name in made.remaining]
    over = [each.name for each in remains if each.outcome is Outcome.OVERTURNED]
    if len(remains) == 1:
        words = f"Under this motion it {'overturns' if over else 'does not overturn'} by the one model that remains"
    else:
        words = f"Under this motion {len(over)} of the {len(remains)} models that remain overturn it"
        words += f" ({', '.join(over)})" if over else ""
    sure = (len(over) == len(remains) and share.low > 0.95) or (not over and share.high < 0.05)
    end = "the choice of the model does not decide" if sure else "the coefficient decides: report both verdicts"
    return [f"{words}, and {share}: {end}."]


def _settled(made: "Recommendation", low: "ModelForBody", high: "ModelForBody") -> list[str]:
    """Say what a measurement must be, to tell the models of the envelope apart."""
    if low is high:
        return ["r measured on this body would replace every model."]
    apart, place = max((abs(high.coefficients[key] - low.coefficients[key]), key) for key in low.coefficients)
    if not made.prediction:
        return [f"What would settle it: r measured on this body, with a standard error below {apart / APART:.2g}."]
    spread = made[made.prediction].scatter("left" if place == "left" else "right")
    if apart < 0.5 * spread:
        return [
            f"The choice hardly matters: what remains differs by {apart:.2g} in r, and bodies scatter by {spread:.2g}; "
            "r measured on this body would replace every model."
        ]
    count = math.ceil((APART * spread / apart) ** 2)
    many = f"the mean of {count} such bodies" if count > 1 else "any one such body"
    return [
        f"What would settle it: r measured on this body with a standard error below {apart / APART:.2g}, which then "
        f"replaces every model; or {many}, since they scatter by {spread:.2g}."
    ]


def _values(row: "ModelForBody") -> str:
    found = [f"{row.coefficients[foot]:.4f} ({row.low[foot]:.4f} to {row.high[foot]:.4f})" for foot in FEET]
    return found[0] if found[0] == found[1] else f"{found[0]} onto the left foot, {found[1]} onto the right"


def _plain(row: "ModelForBody") -> str:
    found = [f"{value:.4f}" for value in row.coefficients.values()]
    return f"r = {' and '.join(dict.fromkeys(found))}"


def table(made: "Recommendation") -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return heading and rows of the models side by side."""
    places = list(dict.fromkeys(place for each in made.models for place in each.coefficients))
    same = all(len({f"{v:.12f}" for v in each.coefficients.values()}) <= 1 for each in made.models)
    shown = places[:1] if same else places
    head = ["model", *(["r"] if same else [f"r {place}" for place in shown])]
    judged = made.judgement is not None
    head += ["kept", "to half", "bias", "error"] if judged else []
    head += ["standing", *(["peak", "ends"] if made.overturned else [])]
    rows = []
    for each in made.models:
        cells = [each.name]
        cells += [_with_interval(each, place) for place in shown]
        if judged:
            known = bool(each.coefficients)
            cells += [f"{100.0 * each.energy_left:.1f} %", f"{each.impacts_to_half:.1f}"] if known else ["-", "-"]
            cells += _errors(each)
        cells.append(each.standing.value)
        if made.overturned:
            ends = "-" if each.outcome is None else each.outcome.name.lower().replace("_", " ")
            stood = each.outcome not in (None, Outcome.OVERTURNED)
            cells += [f"{each.peak_ratio:.2f}" if stood else "-", ends]
        rows.append(tuple(cells))
    return tuple(head), rows


def legend(made: "Recommendation") -> str:
    """Return what the columns of the table are; nothing of a body in space."""
    peak = " peak: largest rotation over the slenderness angle." if made.overturned else ""
    return "" if made.judgement is None else f"r: coefficient and half of its 95 % interval; {LEGEND}{peak}"


def _with_interval(each: "ModelForBody", place: str) -> str:
    if place not in each.coefficients:
        return "-"
    half = f" +- {0.5 * (each.high[place] - each.low[place]):.3f}" if place in each.low else ""
    return f"{each.coefficients[place]:.4f}{half}"


def _errors(each: "ModelForBody") -> list[str]:
    return ["-", "-"] if each.record is None else [f"{each.record.bias:+.4f}", f"{each.record.rmse:.4f}"]
