"""Selection and scaling of records by a target spectrum."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.components import Components
from rocking.motions.formats.record_set import RecordSet, mapped
from rocking.motions.spectrum import response_spectrum, rotd_spectrum
from rocking.motions.target_spectra import TargetSpectrum, target_spectrum

POINTS = 25  # number of periods of the comparison, with equal ratios
MOST = 4.0  # default largest scale factor, and inverse of the smallest scale factor [-]


@dataclass(frozen=True, eq=False)
class Selection:
    """Selected and scaled records, with their misfits."""

    records: RecordSet  # the scaled records, by increasing misfit
    factors: FloatArray  # scale factors of the records [-]
    misfits: FloatArray  # RMS over the periods of ln(spectrum / target), one value per record [-]
    periods: FloatArray  # periods of the comparison [s]
    target: TargetSpectrum
    spectra: FloatArray  # PSA of the scaled records [m/s2]: RotD50 of two components, or PSA of a single component

    @property
    def mean(self) -> FloatArray:
        """Geometric mean of the spectra [m/s2]."""
        return np.asarray(np.exp(np.log(self.spectra).mean(axis=0)), dtype=np.float64)

    @property
    def misfit(self) -> float:
        """Root mean square over the periods of ln(mean / target) [-]."""
        return _rms(np.log(self.mean / self.target(self.periods)))

    @property
    def least(self) -> float:
        """Smallest ratio of the arithmetic mean to the target [-]. Eurocode 8 requires 0.9."""
        return float((self.spectra.mean(axis=0) / self.target(self.periods)).min())

    @property
    def sentence(self) -> str:
        """Summary of factors and misfits."""
        low, high = float(self.periods[0]), float(self.periods[-1])
        return (
            f"{len(self.records)} records scaled by {self.factors.min():.3g} to {self.factors.max():.3g} to "
            f"{self.target.name}, {low:g} to {high:g} s: misfits {self.misfits.min():.2f} to "
            f"{self.misfits.max():.2f}, of the mean {self.misfit:.2f} (ln); mean/target at least {self.least:.2f}"
        )


def selected(
    records: Iterable[Components],
    target: Any,
    count: int | None = None,
    periods: tuple[float, float] = (0.1, 2.0),
    *,
    most: float = MOST,
    workers: int = 1,
    progress: Callable[[int], None] | None = None,
) -> Selection:
    """Select the records with the smallest misfit to a target spectrum after scaling.

    The scale factor of a record is the least-squares solution: the mean of ln(spectrum / target) over the periods is
    zero. The records with the smallest root mean square of ln(spectrum / target) are selected.

    Parameters
    ----------
    records : RecordSet or iterable of Components
        Records to select from.
    target : str or TargetSpectrum
        As in `target_spectrum`.
    count : int, optional
        Number of selected records. By default, all records.
    periods : tuple of float
        First and last period of the comparison [s].
    most : float
        Largest scale factor, and inverse of the smallest scale factor [-]. Other records are rejected.
    workers : int
        Number of processes.
    progress : callable, optional
        Called with the number of newly processed records.

    Returns
    -------
    Selection
        Selected records, scaled.

    Raises
    ------
    InvalidValueError
        If too few records have allowed factors, or the target does not cover the periods.

    Examples
    --------
    >>> from rocking.motions.motion import GroundMotion
    >>> wave = GroundMotion(np.sin(np.linspace(0.0, 60.0, 600)), 0.01, name="wave")
    >>> pair = [Components(wave.scaled(factor), None, None) for factor in (1.0, 2.0)]
    >>> selection = selected(pair, "eurocode8:ag=2m/s2", periods=(0.3, 2.0))
    >>> [round(float(ratio), 9) for ratio in selection.factors / selection.factors[0]]
    [1.0, 0.5]
    """
    spectrum = target_spectrum(target)
    low, high = (checks.positive("periods", period, "s") for period in periods)
    if not low < high:
        raise InvalidValueError(
            "{parameter} must be the first and the last period in increasing order, got {low:g} and {high:g} s",
            parameter="periods", low=low, high=high,
        )  # fmt: skip
    most = checks.within("most", most, 1.0, np.inf)
    grid = np.geomspace(low, high, POINTS)
    target_values, candidates = (
        spectrum(grid),
        [record for record in records if record.x is not None or record.y is not None],
    )
    compute = partial(spectrum_of, periods=grid, damping=spectrum.damping)
    spectra = np.array(list(mapped(compute, candidates, workers, progress)))
    with np.errstate(divide="ignore"):
        residuals = np.log(spectra.reshape(-1, POINTS) / target_values)
    factors = np.exp(-residuals.mean(axis=1))  # Eq. 309
    misfits = np.sqrt(((residuals - residuals.mean(axis=1, keepdims=True)) ** 2).mean(axis=1))  # Eq. 310
    allowed = np.flatnonzero(np.isfinite(misfits) & (factors <= most) & (factors >= 1.0 / most))
    number = allowed.size if count is None else checks.whole("count", count, 1)
    if allowed.size < max(number, 1):
        raise InvalidValueError(
            "{wanted} of {count} records are requested, but only {available} match {target} with factors of {low:g} to "
            "{high:g}", wanted=number or 1, count=len(candidates), available=allowed.size, target=spectrum.name,
            low=1.0 / most, high=most, hint="allow larger factors, or add records",
        )  # fmt: skip
    best = allowed[np.argsort(misfits[allowed], kind="stable")][:number]
    scaled = tuple(_scaled(candidates[k], float(factors[k]), spectrum.name) for k in best)
    kept = RecordSet(scaled, getattr(records, "left_out", ()))
    return Selection(kept, factors[best], misfits[best], grid, spectrum, spectra[best] * factors[best, None])


def spectrum_of(record: Components, periods: FloatArray, damping: float = 0.05) -> FloatArray:
    """Return RotD50 of a record with two horizontal components, or the spectrum of its single component [m/s2]."""
    if record.x is not None and record.y is not None:
        return np.asarray(rotd_spectrum(record.x, record.y, periods, damping, 50.0)[0], dtype=np.float64)
    return response_spectrum(record.leading, periods, damping).pseudo_acceleration


def _scaled(record: Components, factor: float, target: str) -> Components:
    def scale(component: Any) -> Any:
        scaled = component.scaled(factor)
        return replace(
            scaled, provenance=(*component.provenance, f"multiplied by {factor!r}, the closest fit to {target}")
        )

    return record.each(scale)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt((values**2).mean()))
