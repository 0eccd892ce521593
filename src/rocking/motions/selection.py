"""Records chosen and scaled so that their spectra come close to a target."""

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

POINTS = 25  # periods at which spectra are compared, in equal ratios
MOST = 4.0  # factor beyond which, or below whose inverse, a record is not scaled unless another one is given [-]


@dataclass(frozen=True, eq=False)
class Selection:
    """Records that were chosen and scaled, and how close they come."""

    records: RecordSet  # the scaled records, the closest first
    factors: FloatArray  # on each of them [-]
    misfits: FloatArray  # root mean square over the periods of ln(spectrum / target), of each [-]
    periods: FloatArray  # where spectra were compared [s]
    target: TargetSpectrum  # what they were compared with
    spectra: FloatArray  # PSA of the scaled records: RotD50 of two components, else that of the one [m/s2]

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
        """Least ratio of the arithmetic mean to the target; Eurocode 8 asks for 0.9 [-]."""
        return float((self.spectra.mean(axis=0) / self.target(self.periods)).min())

    @property
    def sentence(self) -> str:
        """How close they come, in words."""
        low, high = float(self.periods[0]), float(self.periods[-1])
        return (
            f"{len(self.records)} records scaled by {self.factors.min():.3g} to {self.factors.max():.3g} to "
            f"{self.target.name}, {low:g} to {high:g} s: misfit of each {self.misfits.min():.2f} to "
            f"{self.misfits.max():.2f}, of their mean {self.misfit:.2f} (ln); mean/target {self.least:.2f} at least"
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
    """Choose the records whose scaled spectra are closest to a target.

    Each record is scaled by the factor that makes the mean of ln(spectrum / target) over the periods zero, which is the
    factor of least squares; those of the smallest root mean square are chosen.

    Parameters
    ----------
    records : RecordSet or iterable of Components
        What there is to choose from.
    target : str or TargetSpectrum
        As in `target_spectrum`.
    count : int, optional
        How many are wanted; all if not given.
    periods : tuple of float
        First and last period that count [s].
    most : float
        Largest factor, and inverse of the smallest; records that need more are not taken [-].
    workers : int
        Processes that compute the spectra of many records.
    progress : callable, optional
        Called with the number of records that were looked at since.

    Returns
    -------
    Selection
        The records, scaled.

    Raises
    ------
    InvalidValueError
        If fewer records than wanted can be scaled so, or the target is not known at the periods.

    Examples
    --------
    >>> from rocking.motions.motion import GroundMotion
    >>> wave = GroundMotion(np.sin(np.linspace(0.0, 60.0, 600)), 0.01, name="wave")
    >>> pair = [Components(wave.scaled(factor), None, None) for factor in (1.0, 2.0)]
    >>> found = selected(pair, "eurocode8:ag=2m/s2", periods=(0.3, 2.0))
    >>> [round(float(ratio), 9) for ratio in found.factors / found.factors[0]]
    [1.0, 0.5]
    """
    wanted = target_spectrum(target)
    low, high = (checks.positive("periods", each, "s") for each in periods)
    if not low < high:
        raise InvalidValueError(
            "{parameter} must be the first and the last, got {low:g} and {high:g} s", parameter="periods", low=low,
            high=high,
        )  # fmt: skip
    most = checks.within("most", most, 1.0, np.inf)
    grid = np.geomspace(low, high, POINTS)
    level, given = wanted(grid), [one for one in records if one.x is not None or one.y is not None]
    spectrum = partial(spectrum_of, periods=grid, damping=wanted.damping)
    spectra = np.array(list(mapped(spectrum, given, workers, progress)))
    with np.errstate(divide="ignore"):
        apart = np.log(spectra.reshape(-1, POINTS) / level)
    factors = np.exp(-apart.mean(axis=1))  # Eq. 309
    misfits = np.sqrt(((apart - apart.mean(axis=1, keepdims=True)) ** 2).mean(axis=1))  # Eq. 310
    allowed = np.flatnonzero(np.isfinite(misfits) & (factors <= most) & (factors >= 1.0 / most))
    number = allowed.size if count is None else checks.whole("count", count, 1)
    if allowed.size < max(number, 1):
        raise InvalidValueError(
            "{wanted} of {count} records are wanted, and {available} come to {target} with factors of {low:g} to "
            "{high:g}", wanted=number or 1, count=len(given), available=allowed.size, target=wanted.name,
            low=1.0 / most, high=most, hint="allow larger ones, or give more records",
        )  # fmt: skip
    best = allowed[np.argsort(misfits[allowed], kind="stable")][:number]
    scaled = tuple(_scaled(given[k], float(factors[k]), wanted.name) for k in best)
    kept = RecordSet(scaled, getattr(records, "left_out", ()))
    return Selection(kept, factors[best], misfits[best], grid, wanted, spectra[best] * factors[best, None])


def spectrum_of(record: Components, periods: FloatArray, damping: float = 0.05) -> FloatArray:
    """Return RotD50 of a record with two horizontal components, else the spectrum of the one [m/s2]."""
    if record.x is not None and record.y is not None:
        return np.asarray(rotd_spectrum(record.x, record.y, periods, damping, 50.0)[0], dtype=np.float64)
    return response_spectrum(record.leading, periods, damping).pseudo_acceleration


def _scaled(record: Components, factor: float, target: str) -> Components:
    def scale(part: Any) -> Any:
        made = part.scaled(factor)
        return replace(made, provenance=(*part.provenance, f"multiplied by {factor!r}, which is closest to {target}"))

    return record.each(scale)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt((values**2).mean()))
