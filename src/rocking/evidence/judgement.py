"""Comparison of models with measurements of similar bodies, and rank of each model.

The rule uses only the measurements:

1. The measurements are those in the slenderness bands of the sides of the body, or all measurements if these bands
   have fewer than five specimens.
2. Models are not fitted. The calibrated default is compared by predictions of calibrations without the group of the
   measurement, which is its data set and interface.
3. A model is excluded if its root mean square error of r exceeds that of the closest model by a paired bootstrap
   interval without zero (`rocking.evidence.comparison`), and by more than the rounding of the printed digits. The other
   models are not resolved.
4. Intervals apply to pairs without correction for their number: of eight equally good models, one is excluded by
   chance in more than 5 % of cases.
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
    """Rank of a model; the value is the text for users."""

    CLOSEST = "closest"
    UNRESOLVED = "not resolved"
    SET_ASIDE = "further off"
    EXCLUDED = "does not hold"
    UNJUDGED = "not measured"


@dataclass(frozen=True, slots=True)
class TrackRecord:
    """Errors of a model on the measurements of similar bodies."""

    standing: Standing
    bias: float  # mean of model minus measurement [-]
    rmse: float  # rmse, loss_rmse: root mean square errors of r, and of the energy loss 1 - r^2 [-]
    loss_rmse: float
    behind: Difference  # RMSE minus the RMSE of the closest model, with its 95 % interval [-]


@dataclass(frozen=True, slots=True, eq=False)
class Judgement:
    """Ranks of models compared with measurements."""

    rows: DataSet  # measurements of the comparison
    description: str  # description of these measurements
    rounding: float  # root mean square of the half widths of rounding [-]
    calibrated: TrackRecord
    models: tuple[TrackRecord, ...]  # records in the order of the models


def judge(models: Sequence[RestitutionModel], ratios: tuple[float, ...], data: DataSet) -> Judgement:
    """Compare models with measurements for a body; `ratios` are the slenderness ratios of its sides [-]."""
    selected, description = _like(ratios, data)
    rows = data.rows(selected.tolist())
    predicted = [unseen(data)[selected], *(model.of_slenderness(rows.slenderness) for model in models)]
    rounding = rmse(0.5 * rows.high, 0.5 * rows.low)
    errors = [rmse(r, rows.coefficient) for r in predicted]
    closest = errors.index(min(errors))
    records = tuple(_record(rows, r, predicted[closest], rounding, k == closest) for k, r in enumerate(predicted))
    return Judgement(rows, description, rounding, records[0], records[1:])


def _record(rows: DataSet, r: FloatArray, closest: FloatArray, rounding: float, first: bool) -> TrackRecord:
    behind = compare(rows, r, closest)
    aside = behind.sign > 0 and behind.value > rounding
    standing = Standing.CLOSEST if first else Standing.SET_ASIDE if aside else Standing.UNRESOLVED
    return TrackRecord(standing, bias(r, rows.coefficient), behind.first, loss_rmse(r, rows.coefficient), behind)


def _like(ratios: tuple[float, ...], data: DataSet) -> tuple[IntArray, str]:
    """Return the indices of the measurements for the comparison, and their description."""
    bands = [band for band in BANDS if any(band[1] < ratio <= band[2] for ratio in ratios)]
    inside = np.zeros(len(data), dtype=bool)
    for _, low, high in bands:
        inside |= (data.slenderness > low) & (data.slenderness <= high)
    selected = np.flatnonzero(inside)
    specimens = {(data.group[i], data.labels[i]) for i in selected.tolist()}
    if len(specimens) < FEWEST:
        return np.arange(len(data)), f"all {len(data)} measurements"
    return selected, f"the {len(selected)} of {len(data)} measurements with {' or '.join(band[0] for band in bands)}"
