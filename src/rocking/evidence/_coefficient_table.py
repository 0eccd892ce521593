"""One body with all models: coefficient with its interval for a new measurement, and implied quantities."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body
from rocking.conventions import NORMAL_95, Foot
from rocking.evidence.calibration import CALIBRATED_RANGE, KEPT, PredictedCoefficient, fingerprint, geometry_of
from rocking.evidence.hierarchy import calibrate_hierarchy
from rocking.evidence.likelihood import fit_scatter
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.messages import Message
from rocking.restitution import Calibrated, Fixed, Implication, RestitutionModel, implied, model, models
from rocking.restitution.calibrated import kept, scatter


def interval_for(
    model: RestitutionModel, body: Body, *, foot: Foot = "right", measurements: DataSet | None = None
) -> PredictedCoefficient:
    """Return a model's coefficient with an interval from its own misfit to the measurements.

    The interval is the coefficient plus and minus the normal quantile of the scatter around the model's own
    predictions, with its bias. It applies to one measured body. The interval of the calibrated default is from its
    posterior, for a body on a new interface.

    Parameters
    ----------
    model : RestitutionModel
        Any model; a fixed coefficient has the scatter of the calibrated default.
    body : Body
        The body.
    foot : {"left", "right"}
        Landing foot.
    measurements : DataSet, optional
        Measurements; default: the 39 published coefficients.

    Returns
    -------
    PredictedCoefficient
        Coefficient and interval, within [0, energy bound].
    """
    data = all_measurements() if measurements is None else measurements
    if isinstance(model, Calibrated):
        return calibrate_hierarchy(data).predict(body, foot=foot)
    _, bound = geometry_of(body, foot)
    r = np.asarray(model.coefficient(body, foot))
    if isinstance(model, Fixed):
        floor, slope = (calibrate_hierarchy().summary[name]["mean"] for name in ("s", "gamma"))
    else:
        floor, slope = _misfit(model, data)
    sd = scatter(r, floor, slope)
    reach = NORMAL_95 * sd
    top = np.maximum(bound, r)
    return PredictedCoefficient(r, np.clip(r - reach, 0.0, None), np.minimum(r + reach, top.reshape(())), sd)


def _misfit(model: RestitutionModel, data: DataSet) -> tuple[float, float]:
    """Return the scatter of the measurements around a model; for unfitted models from stored values."""
    first, *misfit = _kept_misfits(data).get(model.label, (math.nan,))
    # a compared prediction detects another model with the same label
    if abs(first - model.of_slenderness(data.slenderness[:1])[0]) < 1e-12:
        return misfit[0], misfit[1]
    return _fitted(model.of_slenderness(data.slenderness).tobytes(), data)


@lru_cache(maxsize=8)
def _kept_misfits(data: DataSet) -> dict[str, list[float]]:
    """Return the stored first prediction and scatter of models, by label."""
    stored = kept(KEPT)
    if stored["inputs"] != fingerprint(data):
        return {}
    rows = np.column_stack([stored["predictions"][:, 0], stored["misfits"]]).tolist()
    return dict(zip(stored["labels"].tolist(), rows, strict=True))


@lru_cache(maxsize=1024)
def _fitted(predictions: bytes, data: DataSet) -> tuple[float, float]:
    floor, slope, _ = fit_scatter(data, np.frombuffer(predictions))
    return floor, slope


CALIBRATED = Calibrated.name


@dataclass(frozen=True, slots=True)
class CoefficientRow:
    """Result of one model for one body."""

    name: str  # name of the model with its parameters, or "calibrated"
    title: str  # description of the model in one line
    coefficient: float  # theta_dot_after / theta_dot_before [-]
    low: float  # low, high: 95 % interval for a single measured body, from the residuals on the measurements [-]
    high: float
    implication: Implication  # impulse position, friction, energy loss
    warnings: tuple[str, ...]  # limitations of the coefficient

    @property
    def half_interval(self) -> float:
        """Half the width of the interval [-]."""
        return 0.5 * (self.high - self.low)

    def answer(self) -> Answer:
        """Return the model's coefficient, its interval and implied quantities."""
        implied = self.implication
        return Answer({
            "model": self.name, "coefficient": self.coefficient,
            "coefficient_low": self.low, "coefficient_high": self.high,
            "impulse_ratio": implied.impulse_ratio, "impulse_position": implied.impulse_x,
            "energy_loss": implied.energy_loss, "friction_demand": implied.friction_demand,
            "admissible": implied.admissible, "warnings": self.warnings,
        })  # fmt: skip


def default_models() -> list[RestitutionModel]:
    """Return all registered models without a required value, the calibrated default first."""
    return [model(name) for name in sorted(models(), key=lambda name: name != CALIBRATED) if name != "fixed"]


def coefficient_table(
    body: Body,
    which: Sequence[RestitutionModel] | None = None,
    *,
    foot: Foot = "right",
) -> tuple[CoefficientRow, ...]:
    """Return the coefficients of a body with all models, with intervals and implied quantities.

    Parameters
    ----------
    body : Body
        The body.
    which : sequence of RestitutionModel, optional
        Models of the table; default: all registered models.
    foot : {"left", "right"}
        Landing foot.

    Returns
    -------
    tuple of CoefficientRow
        One row per model, the calibrated default first.

    Examples
    --------
    >>> from rocking import Block
    >>> rows = coefficient_table(Block(width=1.0, height=4.0))
    >>> rows[0].name, [round(row.coefficient, 6) for row in rows if row.name == "housner"]
    ('calibrated', [0.911765])
    """
    chosen = [candidate for candidate in which or default_models() if not isinstance(candidate, Calibrated)]
    return tuple(_row(body, foot, candidate) for candidate in (Calibrated(), *map(model, chosen)))


def _row(body: Body, foot: Foot, row_model: RestitutionModel) -> CoefficientRow:
    interval, evaluated = interval_for(row_model, body, foot=foot), row_model.evaluate(body, foot)
    warnings: tuple[str, ...] = tuple(flag.value for flag in evaluated.flags)
    if isinstance(row_model, Calibrated) and (outside := outside_evidence(body, foot)):
        warnings = (*warnings, outside)
    value, low, high = evaluated.coefficient, float(interval.low), float(interval.high)
    implication = implied(body, value, foot=foot)
    objections = (*warnings, *implication.objections)
    return CoefficientRow(row_model.label, row_model.title, value, low, high, implication, objections)


def outside_evidence(body: Body, foot: Foot = "right") -> str:
    """Return a warning for a body outside the measured range of slenderness; empty inside this range."""
    low, high = CALIBRATED_RANGE
    ratio = body.side(foot).slenderness_ratio
    if low <= ratio <= high:
        return ""
    return Message(
        "h/b = {ratio:.3g} is outside the measured range {low:g} to {high:g}; the interval is an extrapolation",
        {"ratio": ratio, "low": low, "high": high},
    )
