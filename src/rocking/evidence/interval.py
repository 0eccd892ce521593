"""The interval beside a model's coefficient: how far one measured body may lie from it."""

from functools import lru_cache

import numpy as np

from rocking.bodies import Body
from rocking.conventions import NORMAL_95, Foot
from rocking.evidence.calibration import KEPT, PredictedCoefficient, fingerprint, geometry_of
from rocking.evidence.hierarchy import calibrate_hierarchy
from rocking.evidence.likelihood import fit_scatter
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.restitution import Calibrated, Fixed, RestitutionModel
from rocking.restitution.calibrated import kept, scatter


def interval_for(
    model: RestitutionModel, body: Body, *, onto: Foot = "right", measurements: DataSet | None = None
) -> PredictedCoefficient:
    """Return a model's coefficient with an interval from its own misfit to the measurements.

    The interval is the coefficient plus and minus the normal quantile of the scatter around the model's own
    predictions, bias included: it says how far one measured body may lie from this model. That of the calibrated
    default is of its posterior, for a body on an interface like none of those measured.

    Parameters
    ----------
    model : RestitutionModel
        Any model; a fixed coefficient takes the scatter of the calibrated default.
    body : Body
        The body.
    onto : {"left", "right"}
        The foot on which it lands.
    measurements : DataSet, optional
        What was measured; the 39 published ones if not given.

    Returns
    -------
    PredictedCoefficient
        Coefficient and interval, within [0, energy bound].
    """
    data = all_measurements() if measurements is None else measurements
    if isinstance(model, Calibrated):
        return calibrate_hierarchy(data).predict(body, onto=onto)
    _, bound = geometry_of(body, onto)
    r = np.asarray(model.coefficient(body, onto))
    if isinstance(model, Fixed):
        floor, slope = (calibrate_hierarchy().summary[name]["mean"] for name in ("s", "gamma"))
    else:
        floor, slope = _misfit(model.of_slenderness(data.slenderness).tobytes(), data)
    sd = scatter(r, floor, slope)
    reach = NORMAL_95 * sd
    top = np.maximum(bound, r)
    return PredictedCoefficient(r, np.clip(r - reach, 0.0, None), np.minimum(r + reach, top.reshape(())), sd)


@lru_cache(maxsize=1024)
def _misfit(predictions: bytes, data: DataSet) -> tuple[float, float]:
    predicted = np.frombuffer(predictions)
    stored = kept(KEPT)
    if stored["inputs"] == fingerprint(data):
        same = np.abs(stored["predictions"] - predicted).max(axis=1) < 1e-12
        if same.any():
            floor, slope = stored["misfits"][same][0].tolist()
            return floor, slope
    floor, slope, _ = fit_scatter(data, predicted)
    return floor, slope
