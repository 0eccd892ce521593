"""Fragility, as the browser draws it: points with their intervals, curves with their bands, verdicts."""

from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import coordinate, plain
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

_FINE = 120
_WIDE = 0.01


def fragility_result(study: OpenStudy) -> dict[str, Any]:
    """Return a fragility analysis.

    Returns ``measure`` (name, unit, words), ``motions``, ``definition``, ``uplift``; ``analyses``: for every
    restitution levels, trials, states, ``points`` (by state: x, reached, trials, share, low, high), ``fits`` (by
    state), ``curves`` (by state: x, probability, low, high) and sentences.
    """
    analyses = study.analyses
    first = next(iter(analyses.values()))
    measure = first.subject.measure
    threshold = first.subject.uplift_threshold
    return {
        "measure": {"name": measure.name, "unit": measure.unit, "words": measure.words},
        "motions": coordinate(study, "motion"),
        "definition": first.definition,
        "uplift_threshold": None if threshold is None else float(threshold),
        "analyses": [{"restitution": label, **_analysis(one)} for label, one in analyses.items()],
    }


def _analysis(found: Any) -> dict[str, Any]:
    levels = np.asarray(found.levels, dtype=np.float64)
    fine = _fine(levels)
    fits = {name: fit for name, fit in found.fits.items() if fit is not None}
    told = {
        "levels": levels.tolist(),
        "trials": np.asarray(found.trials).tolist(),
        "failed": int(getattr(found, "stripes", found).failed),
        "states": list(found.counts),
        "points": {name: _points(found, name) for name in found.counts},
        "fits": {name: _fit(fit) for name, fit in fits.items()},
        "curves": {name: _curve(fit, fine) for name, fit in fits.items() if fit.exists},
        "sentences": [f"{name}: {fit.verdict}" for name, fit in fits.items()],
    }
    made: dict[str, Any] = _finite(told | _more(found))
    return made


def _fine(levels: FloatArray) -> FloatArray:
    low, high = float(levels[0]), float(levels[-1])
    if high <= low:
        low, high = 0.5 * low, 2.0 * high
    if high / low > 10.0:
        return np.geomspace(low / 1.15, 1.15 * high, _FINE)
    return np.linspace(max(low - 0.06 * (high - low), 1e-3 * low), high + 0.06 * (high - low), _FINE)


def _points(found: Any, name: str) -> dict[str, Any]:
    from rocking.plots.fragility import gathered
    from rocking.studies.sensitivity.differences import share_interval

    counted = (np.asarray(part, dtype=np.float64) for part in (found.counts[name], found.trials))
    at, reached, trials = gathered(np.asarray(found.levels, dtype=np.float64), *counted)
    share = reached / trials
    ends = [share_interval(s, n) for s, n in zip(share.tolist(), trials.tolist(), strict=True)]
    return {
        "x": at.tolist(),
        "reached": reached.tolist(),
        "trials": trials.tolist(),
        "share": share.tolist(),
        "low": [low for low, _ in ends],
        "high": [high for _, high in ends],
    }


def _fit(fit: Any) -> dict[str, Any]:
    scarce = fit.counts.scarcity if fit.counts.is_clustered else ""
    return {**fit.summary(), "exists": fit.exists, "intervals_hold": fit.exists and not scarce, "scarcity": scarce}


def _curve(fit: Any, fine: FloatArray) -> dict[str, Any]:
    curve = {"x": fine.tolist(), "probability": fit.probability(fine).tolist(), "low": None, "high": None}
    try:
        low, high = fit.band(fine, 0.95, "profile" if fit.counts.cluster_trials is None else "bootstrap")
    except InvalidValueError as error:
        # a curve of few motions has no band: the points show how little is known
        return {**curve, "band": str(error)}
    return {**curve, "low": low.tolist(), "high": high.tolist(), "band": "95 % of the curve at each level"}


def _more(found: Any) -> dict[str, Any]:
    """Return what only a cloud or an incremental analysis has."""
    if hasattr(type(found), "regression"):
        try:
            line = found.regression
        except InvalidValueError as error:
            return {"regression": None, "regression_words": str(error)}
        names = ("slope", "scatter", "determination", "count")
        cloud = {"x": found.motion_levels, "rotation": found.responses.rotation, "outcome": found.responses.outcome}
        points = {name: plain(values) for name, values in cloud.items()}
        return {"regression": {name: getattr(line, name) for name in names}, "cloud": points}
    if not hasattr(type(found), "first_crossings"):
        return {}
    fit, whole = found.first_crossing_fit, int(found.complete.sum())
    again = len(found.resurrected()), len(found.resurrected(_WIDE))
    return {
        "definitions": found.definitions,
        "first_crossings": plain(found.first_crossings),
        "first_crossing": None if fit is None else fit.summary(),
        "intervals": [{"motion": i.motion, "start": i.start, "end": i.end} for i in found.intervals],
        "resurrection": (
            f"{again[0]} of {whole} motion{'s' * (whole != 1)} left it standing at levels above one that overturns "
            f"it, {again[1]} of them over more than 1 % of the level."
        ),
    }


def _finite(value: Any) -> Any:
    """Return plain values with None where there is no finite number."""
    if isinstance(value, dict):
        return {str(name): _finite(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(one) for one in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not np.isfinite(value) else value
