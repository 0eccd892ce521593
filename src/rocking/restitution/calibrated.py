"""The calibrated default: a factor times a shifted impulse, both as the published measurements leave them open."""

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
"""The posterior of `rocking.evidence.calibrate_hierarchy`, made by `make calibration`: a test asks whether it is."""


@lru_cache(maxsize=2)
def kept(path: Path) -> dict[str, Any]:
    """Return a posterior that is kept: samples, marginals, joint weights of eta and k, summary, and what else there is.

    It is what `arrays_of` in `rocking.evidence.calibration` has made.
    """
    with np.load(path, allow_pickle=False) as stored:
        found = {name: stored[name] for name in stored.files}
    marginals = {name: (found.pop(f"{name}_grid"), found.pop(f"{name}_weight")) for name in NAMES}
    summary = {
        name: dict(zip(("mean", "sd", "low", "high"), values, strict=True))
        for name, values in zip(NAMES, found["summary"].tolist(), strict=True)
    }
    return {**found, "marginals": marginals, "summary": summary}


@dataclass(frozen=True)
class Calibrated(InertiaModel):
    """What the published measurements say of a body: the expected coefficient, of all that the posterior holds likely.

    It is the mean over a factor eta and a position k of the impulse. What is not known of it, and how single bodies
    scatter about it, `rocking.evidence.restitution_distribution` draws.

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
        "the interface is like those of the measurements, of which laboratories and materials differ",
    )
    domain = "rectangles with 1.5 <= h/b <= 9.75 were measured; elsewhere it is an extrapolation"
    known_defects = (
        "is no mechanics: its numbers are those of 39 tests of small blocks",
        "does not know the interface of the body, which may cost more than its shape",
    )
    inertia_only = True
    sees_old_foot = False

    def __post_init__(self) -> None:
        """Take the limit of slender bodies, where only the factor is left."""
        object.__setattr__(self, "slender_limit", float(sum(weight * eta for eta, _, weight in _nodes())))

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the mean over the posterior, node by node within what energy allows."""
        bound = np.sqrt(geometry.old_gyration / geometry.new_gyration)  # Eq. 29
        means = (weight * np.minimum(eta * shifted(geometry, k), bound) for eta, k, weight in _nodes())
        return np.asarray(sum(means))  # Eq. 293


def scatter(mean: FloatArray, floor: FloatArray | float, slope: FloatArray | float) -> FloatArray:
    """Return the standard deviation of a measured coefficient around its prediction, floor (1 - mean)^slope [-]."""
    return np.asarray(floor * np.maximum(1.0 - mean, 1e-6) ** slope)  # Eq. 133


def drawn(geometry: ImpactGeometry, which: FloatArray, level: FloatArray) -> FloatArray:
    """Return coefficients drawn from all that the measurements leave open, each within what energy allows.

    Which of the posterior's samples it is, and at which probability of the scatter about that: numbers in [0, 1) [-].
    """
    from scipy.special import ndtr, ndtri

    samples = kept(KEPT)["samples"]
    eta, k, floor, slope = samples[(which * len(samples)).astype(np.int64)].T
    bound = np.sqrt(geometry.old_gyration / geometry.new_gyration)  # Eq. 29
    mean = np.clip(eta * shifted(geometry, k), 0.0, bound)
    deviation = scatter(mean, floor, slope)
    low, high = ndtr(-mean / deviation), ndtr((bound - mean) / deviation)
    r = mean + deviation * ndtri(low + (high - low) * level)
    return np.asarray(np.round(np.clip(r, 0.0, bound), 12))  # the same on processors whose powers end otherwise


@lru_cache(maxsize=1)
def _nodes() -> tuple[tuple[Any, ...], ...]:
    """Return the positions of the impulse among the samples, each with its mean factor before and its share behind."""
    eta, k = kept(KEPT)["samples"][:, :2].T
    return tuple((eta[k == node].mean(), node, (k == node).mean()) for node in map(np.float64, sorted(set(k.tolist()))))
