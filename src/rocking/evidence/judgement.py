"""How models stand against measurements of bodies like one at hand, and which of them is closest.

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

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.evidence.comparison import FEWEST, Difference, bias, compare, loss_rmse, rmse
from rocking.evidence.hierarchy import unseen
from rocking.evidence.measurements import BANDS, DataSet
from rocking.restitution import RestitutionModel


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
    behind = compare(rows, r, closest)
    aside = behind.sign > 0 and behind.value > rounding
    standing = Standing.CLOSEST if first else Standing.SET_ASIDE if aside else Standing.UNRESOLVED
    return TrackRecord(standing, bias(r, rows.coefficient), behind.first, loss_rmse(r, rows.coefficient), behind)


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
