"""Plain histories: how many of them end in which way, by motion, body, scale and restitution."""

from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import by_restitution, coordinate, plain, shares

_LARGEST = 20_000


def product_result(study: OpenStudy) -> dict[str, Any]:
    """Return the counts of plain histories.

    Returns ``motions``, ``bodies``, ``scales``, ``slenderness_angles``; ``shares`` by restitution; ``cells``: for every
    restitution, body and scale how many motions lift and overturn, and the median of the peak rotation over alpha of
    those that do not overturn; ``mode`` and ``peak`` of every history where there are at most 20,000.
    """
    modes, peaks = by_restitution(study, "mode"), by_restitution(study, "peak_ratio")
    known = modes != -3
    standing = np.where(known & (modes < 0), peaks, np.nan)
    told: dict[str, Any] = {
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
        told |= {"mode": modes.tolist(), "peak": plain(peaks)}
    return told


def _median(values: np.ndarray) -> np.ndarray:
    """Return the median over the motions; NaN where there is none."""
    rows = np.sort(values, axis=1)  # NaN comes last
    count = np.isfinite(rows).sum(axis=1)
    low, high = (np.maximum(place, 0)[:, None] for place in ((count - 1) // 2, count // 2))
    last = rows.shape[1] - 1
    pair = [np.take_along_axis(rows, np.minimum(place, last), 1)[:, 0] for place in (low, high)]
    return np.where(count > 0, 0.5 * (pair[0] + pair[1]), np.nan)
