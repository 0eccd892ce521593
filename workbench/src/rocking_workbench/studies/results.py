"""Results of finished studies for the browser, by kind."""

import base64
import math
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from pydantic_core import to_json

from rocking.answers import AnswerRows
from rocking.campaigns import disk
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.messages import messages_of
from rocking.outcome import contact_words, lost_contact, mode_shares, mode_words
from rocking.quantities import Quantity, quantity
from rocking.spec.schema import SCHEMA
from rocking.studies import safe_islands
from rocking.studies.boundaries import chains, edge_numbers, segments
from rocking.studies.fragility.curves import Crossing, shown_curves
from rocking.version import __version__
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.study_folder import StudyFolder

NAME = f"result-{__version__}-{SCHEMA}.json"  # results of other versions may have other keys
_LARGEST = 20_000
_PACKED = 100_000  # smallest number of values of a map that are sent as bytes
_WHOLE = ("uint8", "int8", "uint16", "int16", "int32")
_FINE = 120


def plain(value: Any) -> Any:
    """Return tables and arrays as plain values, with None for values that are not finite."""
    match value:
        case dict():
            return {str(name): plain(item) for name, item in value.items()}
        case list() | tuple():
            return [plain(item) for item in value]
        case np.ndarray() | np.generic():
            if value.dtype.kind != "f" or np.isfinite(value).all():
                return value.tolist()
            return np.where(np.isfinite(value), value, np.array(None, dtype=object)).tolist()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def packed(values: np.ndarray) -> Any:
    """Return a large array as base64 bytes of the smallest type, a small array as a list.

    >>> packed(np.array([[2, 300]]))
    [[2, 300]]
    """
    if values.size < _PACKED:
        return plain(values)
    kind = "float32"
    if values.dtype.kind != "f":
        ends = np.array([values.min(), values.max()])
        kind = next(kind_of_number for kind_of_number in _WHOLE if (ends == ends.astype(kind_of_number)).all())
    data = base64.b64encode(values.astype(np.dtype(kind).newbyteorder("<")).tobytes()).decode()
    return {"kind": kind, "shape": values.shape, "base64": data}


def coordinate(study: OpenStudy, name: str) -> dict[str, Any]:
    """Return name, values and unit of a dimension of a study."""
    axis = study.job.study.coordinates[name]
    return {"name": name, "values": axis.values, "unit": axis.unit, "description": axis.meaning}


def coordinates(study: OpenStudy, **names: str) -> dict[str, Any]:
    """Return dimensions of a study by the keys of an answer."""
    return {key: coordinate(study, name) for key, name in names.items()}


def by_restitution(study: OpenStudy, name: str) -> np.ndarray:
    """Return a result with the restitution as its first dimension."""
    values, dims = study.results[name], list(study.job.study.dims)
    several = len(study.axes) < len(dims)
    return np.moveaxis(values, dims.index("restitution"), 0) if several else values[None]


def kept_result(folder: StudyFolder) -> bytes | None:
    """Return the stored result, or None."""
    try:
        return (folder.path / NAME).read_bytes()
    except OSError:
        return None


def keep_result(study: OpenStudy) -> bytes:
    """Compute and store the result of a finished study."""
    data = to_json(result_of(study))  # only the bytes are kept in memory
    disk.write_new(study.folder.path / NAME, data)
    return data


def minimum_result(study: OpenStudy) -> dict[str, Any]:
    """Return minimum overturning accelerations, `MinimumResult`."""
    return {**coordinates(study, motions="motion", bodies="body"), "tables": tables_of(study)}


def tables_of(study: OpenStudy) -> dict[str, Any]:
    """Return the tables of an adaptive study."""
    return {
        name: [
            {"name": title, "unit": column.unit, "description": column.meaning, "values": column.values}
            for title, column in table.columns.items()
        ]
        for name, table in study.answer.tables.items()
    }


def product_result(study: OpenStudy) -> dict[str, Any]:
    """Return the counts of outcomes, and median peaks, of a study of kind `histories`."""
    modes, peaks = by_restitution(study, "mode"), by_restitution(study, "peak_ratio")
    computed = modes != -3
    with warnings.catch_warnings():  # no median if all motions overturn the body
        warnings.simplefilter("ignore", RuntimeWarning)
        median = np.nanmedian(np.where(computed & (modes < 0), peaks, np.nan), axis=1)
    return {
        **coordinates(study, motions="motion", bodies="body", scales="scale", slenderness_angles="slenderness_angle"),
        "shares": [mode_shares(mode) for mode in modes],
        "cells": {
            "computed": computed.sum(axis=1),
            "lifted": (computed & (modes > -2)).sum(axis=1),
            "overturned": (modes >= 0).sum(axis=1),
            "median_peak": median,
        },
        **({"mode": modes, "peak": peaks} if modes.size <= _LARGEST else {}),
    }


def spectrum_result(study: OpenStudy) -> dict[str, Any]:
    """Return rocking spectra."""
    from rocking.plots.rocking_spectrum import fractiles

    job = study.job
    modes, coefficient = by_restitution(study, "mode"), job.study.coordinates["coefficient"].values
    curves = []
    for k, label in enumerate(job.problem.restitutions):
        spectra = study.dataset(k)
        for index, angle in enumerate(job.study.coordinates["slenderness_angle"].values):
            low, middle, high = fractiles(spectra, index)
            mode = modes[k][:, index]
            with np.errstate(invalid="ignore"):  # NaN without a computed value
                share = (mode >= 0).sum(axis=0) / (mode != -3).sum(axis=0)
            curves.append({
                "restitution": label, "angle": angle, "low": low, "median": middle, "high": high, "overturned": share,
                "coefficient": coefficient[index, :, k] if coefficient.ndim > 2 else coefficient[index],
            })  # fmt: skip
    return {
        **coordinates(study, x="period", angles="slenderness_angle", motions="motion", semi_diagonals="semi_diagonal"),
        "curves": curves,
        "shares": [mode_shares(mode) for mode in modes],
    }


def outcomes_result(study: OpenStudy) -> dict[str, Any]:
    """Return the outcomes of a study without a picture, `OutcomesResult`."""
    coordinates = study.job.study.coordinates
    return {
        "dimensions": [coordinate(study, name) for name in study.axes if name in coordinates],
        "shares": [mode_shares(mode) for mode in by_restitution(study, "mode")],
        "tables": findings_of(study) if study.job.study.search is None else tables_of(study),
    }


def findings_of(study: OpenStudy) -> dict[str, Any]:
    """Return the summary of a study as a table, or no table for a study without a summary."""
    dataset = study.job.study.dataset(study.results)
    columns = AnswerRows.of_records(study.question.findings(study.job.problem, dataset)).columns
    about = {name: quantity(name) or Quantity(name, "", "") for name in columns}
    return {"findings": [
        {"name": about[name].heading, "unit": about[name].unit, "description": about[name].meaning, "values": values}
        for name, values in columns.items()
    ]} if columns else {}  # fmt: skip


def map_result(study: OpenStudy) -> dict[str, Any]:
    """Return an overturning map."""
    axes = coordinates(study, y=study.axes[0], x=study.axes[1])
    x, y = (np.asarray(axes[side]["values"], dtype=np.float64) for side in ("x", "y"))
    modes, about = by_restitution(study, "mode"), study.job.study.attributes
    return {
        **axes,
        "outcome": packed(by_restitution(study, "outcome")),
        "mode": packed(modes),
        "mode_words": {mode: mode_words(mode) for mode in np.unique(modes).tolist()},
        "peak": packed(by_restitution(study, "peak_ratio")),
        "impacts": packed(by_restitution(study, "impacts")),
        "shares": [mode_shares(mode) for mode in modes],
        "islands": [list(safe_islands(study.dataset(k)).sentences) for k in range(len(modes))],
        "contours": [contours_of(mode >= 0, x, y, is_known=mode != -3) for mode in modes],
        "body": str(about.get("body", "")),
        "motion": str(about.get("motion", "")),
        "tables": {} if study.job.study.search is None else tables_of(study),
    }


def contours_of(
    inside: np.ndarray, x: FloatArray, y: FloatArray, is_known: np.ndarray | None = None
) -> list[list[list[float]]]:
    """Return polylines of x and y between inside and outside; closed lines repeat their first point."""
    if min(inside.shape) < 2:
        return []
    corners = _corners(inside)
    mixed = np.flatnonzero(
        corners.any(axis=1) & ~corners.all(axis=1) & (True if is_known is None else _corners(is_known).all(axis=1))
    )
    j, i = np.divmod(mixed, inside.shape[1] - 1)
    joined = segments(corners[mixed], edge_numbers(i, j, inside.shape[1]), np.zeros(mixed.size, dtype=bool))
    return [_middles(np.array(chain), x, y).tolist() for chain in chains(joined)]


def _corners(grid: np.ndarray) -> np.ndarray:
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)


def _middles(edges: np.ndarray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the middles of edges, with the numbers of `edge_numbers`."""
    (j, i), upright = np.divmod(edges // 2, x.size), edges % 2
    return np.stack([0.5 * (x[i] + x[i + 1 - upright]), 0.5 * (y[j] + y[j + upright])], axis=-1)


def fragility_result(study: OpenStudy) -> dict[str, Any]:
    """Return a fragility analysis."""
    first, question = next(iter(study.analyses.values())), study.question
    measure = first.subject.measure
    unit = "" if measure.unit == "1" else measure.unit
    return {
        "im": {"name": measure.name, "unit": measure.unit, "description": measure.description},
        "motions": coordinate(study, "motion"),
        "definition": first.definition,
        "uplift_threshold": first.subject.uplift_threshold,
        "analyses": [
            {"restitution": label, **_analysis(analysis, question.export.crossing_curves, unit)}
            for label, analysis in study.analyses.items()
        ],
    }


def _analysis(analysis: Any, crossing_curves: Crossing, unit: str) -> dict[str, Any]:
    from rocking.plots.fragility import fractions_of

    shown = shown_curves(analysis, crossing_curves)
    shared = {} if shown is None else shown.shared
    levels = np.asarray(analysis.levels, dtype=np.float64)
    fits = {name: fit for name, fit in analysis.fits.items() if fit is not None}
    return {
        "levels": levels,
        "trials": np.asarray(analysis.trials),
        "failed": int(getattr(analysis, "stripes", analysis).failed),
        "states": list(analysis.counts),
        "points": {name: fractions_of(analysis, name) for name in analysis.counts},
        "adjusted": "" if shown is None else shown.adjusted,
        "fits": {name: _fit(fit, shared.get(name)) for name, fit in fits.items()},
        "curves": {name: _curve(fit, _fine(levels), shared.get(name)) for name, fit in fits.items() if fit.exists},
        "verdicts": {name: fit.verdict_in(unit) for name, fit in fits.items()},
        "common": list(shared),
        **(_cloud(analysis) if hasattr(type(analysis), "regression") else {}),
        **(_incremental(analysis) if hasattr(type(analysis), "first_crossings") else {}),
    }


def _fine(levels: FloatArray) -> FloatArray:
    low, high = float(levels[0]), float(levels[-1])
    if high <= low:
        low, high = 0.5 * low, 2.0 * high
    if high / low > 10.0:
        return np.geomspace(low / 1.15, 1.15 * high, _FINE)
    return np.linspace(max(low - 0.06 * (high - low), 1e-3 * low), high + 0.06 * (high - low), _FINE)


def _fit(fit: Any, shared: Any) -> dict[str, Any]:
    scarce = fit.counts.scarcity if fit.counts.is_clustered else ""
    if shared is not None:
        facts = {"exists": True, "intervals_hold": False, "scarcity": ""}
        return {**fit.summary(), **shared.facts, **facts}
    return {**fit.summary(), "exists": fit.exists, "intervals_hold": fit.exists and not scarce, "scarcity": scarce}


def _curve(fit: Any, fine: FloatArray, shared: Any) -> dict[str, Any]:
    if shared is not None:
        drawn = {"x": fine, "probability": shared.probability(fine), "low": None, "high": None}
        return {**drawn, "band": "no band: the curve has a common dispersion with other states"}
    curve = {"x": fine, "probability": fit.probability(fine), "low": None, "high": None}
    try:
        low, high = fit.band(fine, 0.95, "profile" if fit.counts.cluster_trials is None else "bootstrap")
    except InvalidValueError as error:
        # too few motions for a confidence band; the application shows the points
        return {**curve, "band": str(error)}
    return {**curve, "low": low, "high": high, "band": "95 % of the curve at each level"}


def _cloud(analysis: Any) -> dict[str, Any]:
    try:
        line = analysis.regression
    except InvalidValueError as error:
        return {"regression": None, "regression_words": str(error)}
    responses = analysis.responses
    return {
        "regression": {name: getattr(line, name) for name in ("slope", "scatter", "determination", "count")},
        "cloud": {"x": analysis.motion_levels, "rotation": responses.rotation, "outcome": responses.outcome},
    }


def _incremental(analysis: Any) -> dict[str, Any]:
    fit = analysis.first_crossing_fit
    return {
        "definitions": analysis.definitions,
        "first_crossings": analysis.first_crossings,
        "first_crossing": None if fit is None else fit.summary(),
        "intervals": [{"motion": i.motion, "start": i.start, "end": i.end} for i in analysis.intervals],
        "resurrection": analysis.resurrection,
    }


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
    document = study.job.document
    kind = document.kind
    if kind == "minimum-acceleration":
        lost = [np.empty(0), *(step.lost_contact for step in study.answer.value if step is not None)]
        contact = contact_words(np.concatenate(lost))
    else:
        contact = contact_words(lost_contact(study.raw))
    head = {"id": study.id, "kind": kind, "name": str(document.campaign.name), "contact": contact}
    result: dict[str, Any] = plain(
        {**head, "restitutions": list(study.job.problem.restitutions), **_BY_KIND.get(kind, outcomes_result)(study)}
    )
    return {**result, "messages": messages_of(result)}
