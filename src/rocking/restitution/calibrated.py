"""The calibrated default: a factor times the shifted-impulse model, with the posterior of published measurements."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.shifted_impulse import shifted

NAMES = ("eta", "k", "s", "gamma")
KEPT = Path(__file__).parent / "data" / "calibrated.npz"
"""Posterior of `rocking.evidence.calibrate_hierarchy`, written by `make calibration`. A test compares both."""


@lru_cache(maxsize=2)
def kept(path: Path) -> dict[str, Any]:
    """Return a stored posterior: samples, marginals, joint weights of eta and k, summary and further arrays.

    The function `arrays_of` in `rocking.evidence.calibration` writes the file.
    """
    with np.load(path, allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in stored.files}
    marginals = {name: (arrays.pop(f"{name}_grid"), arrays.pop(f"{name}_weight")) for name in NAMES}
    summary = {
        name: dict(zip(("mean", "sd", "low", "high"), values, strict=True))
        for name, values in zip(NAMES, arrays["summary"].tolist(), strict=True)
    }
    return {**arrays, "marginals": marginals, "summary": summary}


@dataclass(frozen=True)
class Calibrated(InertiaModel):
    """Expected coefficient of a body, from the posterior of the published measurements.

    The coefficient is the mean over a factor eta and an impulse position k. For the uncertainty of the coefficient and
    the scatter between bodies, see `rocking.evidence.restitution_distribution`.

    Examples
    --------
    >>> from rocking import Block
    >>> 0.935 < Calibrated().coefficient(Block(width=1.0, height=4.0)) < 0.945
    True
    """

    name = "calibrated"
    short_name = "calibrated default"
    colour, linestyle = "#5B6E79", (0, (7, 1, 2, 1))
    title = "fitted to the published measurements: a factor times a shifted impulse"
    reference = "this project, from the measurements in Mao et al. 2024, Buildings 14(7) 2119"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "the interface is similar to those of the measurements, from different laboratories and materials",
    )
    domain = "measured for rectangles with 1.5 <= h/b <= 9.75; an extrapolation elsewhere"
    known_defects = (
        "an empirical fit to 39 tests of small blocks, not a mechanical model",
        "independent of the interface of the body, which may lose more energy than its shape",
    )
    inertia_only = True
    sees_old_foot = False

    def __post_init__(self) -> None:
        """Set the limit for slender bodies, which is the mean factor."""
        object.__setattr__(self, "slender_limit", float(sum(weight * eta for eta, _, weight in _nodes())))

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the mean over the posterior [-]. The energy bound limits every node."""
        bound = np.sqrt(geometry.old_gyration / geometry.new_gyration)  # Eq. 29
        means = (weight * np.minimum(eta * shifted(geometry, k), bound) for eta, k, weight in _nodes())
        return np.asarray(sum(means))  # Eq. 293


def scatter(mean: FloatArray, floor: FloatArray | float, slope: FloatArray | float) -> FloatArray:
    """Return the standard deviation of measured coefficients about the prediction, floor (1 - mean)^slope [-]."""
    return np.asarray(floor * np.maximum(1.0 - mean, 1e-6) ** slope)  # Eq. 133


def drawn(geometry: ImpactGeometry, which: FloatArray, level: FloatArray) -> FloatArray:
    """Return random coefficients from the posterior of the measurements, within the energy bound [-].

    `which` is the position in the samples of the posterior, and `level` the probability within the scatter. Both are in
    [0, 1).
    """
    from scipy.special import ndtr, ndtri

    samples = kept(KEPT)["samples"]
    eta, k, floor, slope = samples[(which * len(samples)).astype(np.int64)].T
    bound = np.sqrt(geometry.old_gyration / geometry.new_gyration)  # Eq. 29
    mean = np.clip(eta * shifted(geometry, k), 0.0, bound)
    deviation = scatter(mean, floor, slope)
    low, high = ndtr(-mean / deviation), ndtr((bound - mean) / deviation)
    r = mean + deviation * ndtri(low + (high - low) * level)
    return np.asarray(np.round(np.clip(r, 0.0, bound), 12))  # rounded, because powers depend on the processor


@lru_cache(maxsize=1)
def _nodes() -> tuple[tuple[Any, ...], ...]:
    """Return mean factor, impulse position and weight for every position in the samples."""
    eta, k = kept(KEPT)["samples"][:, :2].T
    return tuple((eta[k == node].mean(), node, (k == node).mean()) for node in map(np.float64, sorted(set(k.tolist()))))
