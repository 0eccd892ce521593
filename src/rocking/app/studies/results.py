"""What the browser is told of a finished study, by its kind."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.app.answers import JsonAnswer
from rocking.app.studies.finished import OpenStudy
from rocking.app.studies.study_folder import StudyFolder
from rocking.campaigns import disk
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.outcome import contact_words, lost_contact
from rocking.studies.boundaries import chains, edge_numbers, segments
from rocking.version import __version__

MODES = {-3: "not computed", -2: "not lifted", -1: "rocks, stays standing", 0: "overturns without impact"}
"""Ways to end in words; n > 0 overturns after n impacts."""

NAME = f"result-{__version__}.json"
"""Another version may tell other things."""

_LARGEST = 20_000
_FINE = 120
_WIDE = 0.01


def plain(values: Any) -> Any:
    """Return an array as lists, with None where there is no finite number."""
    array = np.asarray(values)
    if array.dtype.kind != "f" or np.isfinite(array).all():
        return array.tolist()
    return np.where(np.isfinite(array), array, np.array(None, dtype=object)).tolist()


def meaning(mode: int) -> str:
    """Return a way to end in words.

    >>> meaning(-1), meaning(1)
    ('rocks, stays standing', 'overturns after 1 impact')
    """
    return MODES.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def shares(modes: np.ndarray) -> list[dict[str, Any]]:
    """Return how many histories end in which way, by mode."""
    found, counts = np.unique(modes, return_counts=True)
    return [
        {"mode": mode, "meaning": meaning(mode), "count": count, "share": count / modes.size}
        for mode, count in zip(found.tolist(), counts.tolist(), strict=True)
    ]


def coordinate(study: OpenStudy, name: str) -> dict[str, Any]:
    """Return what is known of a dimension of a study."""
    found = study.job.job.study.coordinates[name]
    return {"name": name, "values": plain(found.values), "unit": found.unit, "words": found.meaning}


def by_restitution(study: OpenStudy, name: str) -> np.ndarray:
    """Return a result with the restitution as its first dimension, also where there is only one."""
    values, dims = study.results[name], list(study.job.job.study.dims)
    several = len(study.axes) < len(dims)
    return np.moveaxis(values, dims.index("restitution"), 0) if several else values[None]


def kept_result(folder: StudyFolder) -> bytes | None:
    """Return the result that was kept."""
    try:
        return (folder.path / NAME).read_bytes()
    except OSError:
        return None


def keep_result(study: OpenStudy) -> bytes:
    """Make the result of a finished study, and keep it."""
    data = bytes(JsonAnswer(result_of(study)).body)
    disk.write_new(study.folder.path / NAME, data)
    return data


def minimum_result(study: OpenStudy) -> dict[str, Any]:
    """Return minimum overturning accelerations, `MinimumResult`."""
    return {"motions": coordinate(study, "motion"), "bodies": coordinate(study, "body"), "tables": tables_of(study)}


def tables_of(study: OpenStudy) -> dict[str, Any]:
    """Return the tables of an adaptive study."""
    return {
        name: [
            {"name": title, "unit": each.unit, "words": each.meaning, "values": plain(each.values)}
            for title, each in table.columns.items()
        ]
        for name, table in study.answer.tables.items()
    }


def product_result(study: OpenStudy) -> dict[str, Any]:
    """Return the counts of plain histories."""
    modes, peaks = by_restitution(study, "mode"), by_restitution(study, "peak_ratio")
    known = modes != -3
    standing = np.where(known & (modes < 0), peaks, np.nan)
    result: dict[str, Any] = {
        "motions": coordinate(study, "motion"),
        "bodies": coordinate(study, "body"),
        "scales": coordinate(study, "scale"),
        "slenderness_angles": coordinate(study, "slenderness_angle"),
        "shares": [shares(each) for each in modes],
        "cells": {
            "computed": known.sum(axis=1).tolist(),
            "lifted": (known & (modes > -2)).sum(axis=1).tolist(),
            "overturned": (modes >= 0).sum(axis=1).tolist(),
            "median_peak": plain(_median(standing)),
        },
    }
    if modes.size <= _LARGEST:
        result |= {"mode": modes.tolist(), "peak": plain(peaks)}
    return result


def _median(values: np.ndarray) -> np.ndarray:
    """Return the median over the motions; NaN where there is none."""
    rows = np.sort(values, axis=1)  # NaN comes last
    count = np.isfinite(rows).sum(axis=1)
    low, high = (np.maximum(place, 0)[:, None] for place in ((count - 1) // 2, count // 2))
    last = rows.shape[1] - 1
    pair = [np.take_along_axis(rows, np.minimum(place, last), 1)[:, 0] for place in (low, high)]
    return np.where(count > 0, 0.5 * (pair[0] + pair[1]), np.nan)


def spectrum_result(study: OpenStudy) -> dict[str, Any]:
    """Return rocking spectra."""
    from rocking.plots.rocking_spectrum import fractiles

    job = study.job.job
    angles = coordinate(study, "slenderness_angle")
    modes = by_restitution(study, "mode")
    coefficient = job.study.coordinates["coefficient"].values
    curves = []
    for k, label in enumerate(job.problem.restitutions):
        found = study.dataset(k)
        for place, angle in enumerate(angles["values"]):
            low, middle, high = fractiles(found, place)
            mode = modes[k][:, place]
            with np.errstate(invalid="ignore"):  # where nothing could be computed there is no share
                share = (mode >= 0).sum(axis=0) / (mode != -3).sum(axis=0)
            curves.append({
                "restitution": label, "angle": angle, "low": plain(low), "median": plain(middle), "high": plain(high),
                "overturned": plain(share),
                "coefficient": plain(coefficient[place, :, k] if coefficient.ndim > 2 else coefficient[place]),
            })  # fmt: skip
    return {
        "x": coordinate(study, "period"),
        "angles": angles,
        "motions": coordinate(study, "motion"),
        "semi_diagonals": coordinate(study, "semi_diagonal"),
        "curves": curves,
        "shares": [shares(each) for each in modes],
    }


def map_result(study: OpenStudy) -> dict[str, Any]:
    """Return an overturning map."""
    y, x = (coordinate(study, name) for name in study.axes)
    modes = by_restitution(study, "mode")
    axes = np.asarray(x["values"], dtype=np.float64), np.asarray(y["values"], dtype=np.float64)
    about = study.job.job.study.attributes
    return {
        "x": x,
        "y": y,
        "outcome": by_restitution(study, "outcome").tolist(),
        "mode": modes.tolist(),
        "mode_words": {str(mode): meaning(mode) for mode in np.unique(modes).tolist()},
        "peak": plain(by_restitution(study, "peak_ratio")),
        "impacts": by_restitution(study, "impacts").tolist(),
        "shares": [shares(each) for each in modes],
        "contours": [contours_of(each >= 0, *axes, known=each != -3) for each in modes],
        "body": str(about.get("body", "")),
        "motion": str(about.get("motion", "")),
        "tables": {} if study.job.job.study.search is None else tables_of(study),
    }


def contours_of(
    inside: np.ndarray, x: FloatArray, y: FloatArray, known: np.ndarray | None = None
) -> list[list[list[float]]]:
    """Return the polylines of x and y halfway between what is inside and what is not; closed ones end where they begin.

    >>> inside = np.array([[False, False, False], [False, True, False], [False, False, False]])
    >>> (ring,) = contours_of(inside, np.arange(3.0), np.arange(3.0))
    >>> ring[0] == ring[-1], sorted(ring[1:])
    (True, [[0.5, 1.0], [1.0, 0.5], [1.0, 1.5], [1.5, 1.0]])
    """
    if min(inside.shape) < 2:
        return []
    corners = _corners(inside)
    mixed = np.flatnonzero(
        corners.any(axis=1) & ~corners.all(axis=1) & (True if known is None else _corners(known).all(axis=1))
    )
    j, i = np.divmod(mixed, inside.shape[1] - 1)
    joined = segments(corners[mixed], edge_numbers(i, j, inside.shape[1]), np.zeros(mixed.size, dtype=bool))
    return [_points(np.array(chain), x, y) for chain in chains(joined)]


def _corners(grid: np.ndarray) -> np.ndarray:
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)


def _points(edges: np.ndarray, x: FloatArray, y: FloatArray) -> list[list[float]]:
    """Return the middles of edges, numbered as `edge_numbers` does."""
    j, i = np.divmod(edges // 2, x.size)
    upright = edges % 2 == 1
    right = np.minimum(i + 1, x.size - 1)
    above = np.minimum(j + 1, y.size - 1)
    across = np.where(upright, x[i], 0.5 * (x[i] + x[right]))
    along = np.where(upright, 0.5 * (y[j] + y[above]), y[j])
    return np.stack([across, along], axis=-1).tolist()  # type: ignore[no-any-return]


def fragility_result(study: OpenStudy) -> dict[str, Any]:
    """Return a fragility analysis."""
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
    facts = {
        "levels": levels.tolist(),
        "trials": np.asarray(found.trials).tolist(),
        "failed": int(getattr(found, "stripes", found).failed),
        "states": list(found.counts),
        "points": {name: _curve_points(found, name) for name in found.counts},
        "fits": {name: _fit(fit) for name, fit in fits.items()},
        "curves": {name: _curve(fit, fine) for name, fit in fits.items() if fit.exists},
        "sentences": [f"{name}: {fit.verdict}" for name, fit in fits.items()],
    }
    analysis: dict[str, Any] = _finite(facts | _more(found))
    return analysis


def _fine(levels: FloatArray) -> FloatArray:
    low, high = float(levels[0]), float(levels[-1])
    if high <= low:
        low, high = 0.5 * low, 2.0 * high
    if high / low > 10.0:
        return np.geomspace(low / 1.15, 1.15 * high, _FINE)
    return np.linspace(max(low - 0.06 * (high - low), 1e-3 * low), high + 0.06 * (high - low), _FINE)


def _curve_points(found: Any, name: str) -> dict[str, Any]:
    from rocking.plots.fragility import gathered
    from rocking.statistics.counts import share_interval

    counted = (np.asarray(part, dtype=np.float64) for part in (found.counts[name], found.trials))
    at, reached, trials = gathered(np.asarray(found.levels, dtype=np.float64), *counted)
    share = reached / trials
    ends = [share_interval(s * n, n) for s, n in zip(share.tolist(), trials.tolist(), strict=True)]
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


_BY_KIND: dict[str, Callable[[OpenStudy], dict[str, Any]]] = {
    "overturning-map": map_result,
    "minimum-acceleration": minimum_result,
    "rocking-spectrum": spectrum_result,
    "stripes": fragility_result,
    "incremental": fragility_result,
    "cloud": fragility_result,
    "histories": product_result,
}


def result_of(study: OpenStudy) -> dict[str, Any]:
    """Return the result of a finished study."""
    document = study.job.job.document
    kind = str(document.campaign.kind)
    head = {"id": study.id, "kind": kind, "name": str(document.campaign.name), "contact": _contact(study, kind)}
    return {**head, "restitutions": list(study.job.job.problem.restitutions), **_BY_KIND[kind](study)}


def _contact(study: OpenStudy, kind: str) -> str:
    """In how many histories the ground would have to pull; empty if in none."""
    if kind != "minimum-acceleration":
        return contact_words(lost_contact(study.raw))
    searches = [found.lost_contact for found in study.answer.value if found is not None]
    return contact_words(np.concatenate(searches or [np.empty(0)]))
