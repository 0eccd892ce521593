"""Measurements of a rocking body: times of impacts, rotations, angular velocities."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

_FEWEST, _MOST = 4, 2000


@dataclass(frozen=True, eq=False)
class ImpactTimes:
    """Times of the impacts of a freely rocking body.

    Parameters
    ----------
    times : ndarray
        At least 4 increasing times. Some times may be false, and impacts may be missing [s].
    sigma : float, optional
        Standard deviation of a time; fitted by default [s].
    probabilities : ndarray, optional
        Probability of each time to be an impact, above 0 and at most 1 [-].
    source : str
        Source of the measurement.
    doubts : tuple of str
        Doubts of the reader.
    loudness : ndarray, optional
        Amplitudes of a sound for figures: times [s] in the first column, amplitudes in the second [-].

    Raises
    ------
    InvalidValueError
        If there are fewer than 4 or more than 2000 times, or they do not increase, or a value is outside its range.

    Examples
    --------
    >>> ImpactTimes([0.0, 1.13, 2.09, 2.92], sigma=1e-4).times.size
    4
    """

    times: FloatArray
    sigma: float | None = None
    probabilities: FloatArray | None = None
    source: str = ""
    doubts: tuple[str, ...] = ()
    loudness: FloatArray | None = None

    def __post_init__(self) -> None:
        """Check the times."""
        times = _row("times", self.times, "s")
        if not _FEWEST <= times.size <= _MOST:
            raise InvalidValueError(
                "the number of impact times must be {fewest} to {most}, got {count}",
                fewest=_FEWEST,
                most=_MOST,
                count=times.size,
            )
        _increasing("times", times)
        object.__setattr__(self, "times", times)
        if self.sigma is not None:
            object.__setattr__(self, "sigma", checks.positive("sigma", self.sigma, "s"))
        if self.probabilities is not None:
            sure = _row("probabilities", self.probabilities, "-", times.size)
            if sure.min() <= 0.0 or sure.max() > 1.0:
                raise InvalidValueError(
                    "probabilities must be in (0, 1], got {smallest:g} to {largest:g}",
                    smallest=sure.min(),
                    largest=sure.max(),
                )
            object.__setattr__(self, "probabilities", sure)


@dataclass(frozen=True, eq=False)
class RotationSeries:
    """Measured time history of the rotation, of the angular velocity, or of both.

    Parameters
    ----------
    time : ndarray
        Increasing times [s].
    rotation : ndarray, optional
        Rotation, positive on the right foot; an offset and a drift are fitted [rad].
    angular_velocity : ndarray, optional
        Angular velocity, positive clockwise; an offset and a drift are fitted [rad/s].
    source : str
        Source of the measurement.
    doubts : tuple of str
        Doubts of the reader.
    from_acceleration : bool
        True if the rotation comes from an acceleration, which includes the ground acceleration.

    Raises
    ------
    InvalidValueError
        If both are missing, or a row differs in length from the times or is not finite.

    Examples
    --------
    >>> RotationSeries([0.0, 0.1, 0.2, 0.3], rotation=[0.02, 0.01, 0.0, -0.01]).time.size
    4
    """

    time: FloatArray
    rotation: FloatArray | None = None
    angular_velocity: FloatArray | None = None
    source: str = ""
    doubts: tuple[str, ...] = ()
    from_acceleration: bool = False

    def __post_init__(self) -> None:
        """Check the rows."""
        time = _row("time", self.time, "s")
        if time.size < _FEWEST:
            raise InvalidValueError(
                "a series must have {fewest} samples or more, got {count}", fewest=_FEWEST, count=time.size
            )
        _increasing("time", time)
        object.__setattr__(self, "time", time)
        if self.rotation is None and self.angular_velocity is None:
            raise InvalidValueError("a series needs rotation= [rad], angular_velocity= [rad/s], or both")
        for name, unit in (("rotation", "rad"), ("angular_velocity", "rad/s")):
            if (values := getattr(self, name)) is not None:
                object.__setattr__(self, name, _row(name, values, unit, time.size))


def white_noise(values: FloatArray) -> float:
    """Return the standard deviation of the noise of samples, from their second differences."""
    return float(np.median(np.abs(np.diff(values, 2)))) / (0.6745 * math.sqrt(6.0))


def _row(name: str, values: object, unit: str, size: int | None = None) -> FloatArray:
    row = np.array(checks.real_array(name, values, unit))
    if row.ndim != 1 or (size is not None and row.size != size):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {shape}", parameter=name,
            allowed=f"a row of {'numbers' if size is None else size} [{unit}]", shape=row.shape,
        )  # fmt: skip
    if not np.isfinite(row).all():
        bad = int(np.flatnonzero(~np.isfinite(row))[0])
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {value} at index {index}", parameter=name, allowed=f"finite [{unit}]",
            value=float(row[bad]), index=bad,
        )  # fmt: skip
    row.setflags(write=False)
    return row


def _increasing(name: str, times: FloatArray) -> None:
    if np.any(np.diff(times) <= 0.0):
        bad = int(np.flatnonzero(np.diff(times) <= 0.0)[0]) + 1
        raise InvalidValueError(
            "{parameter} must increase [s], got {value} after {before:g} at index {index}", parameter=name,
            value=float(times[bad]), before=float(times[bad - 1]), index=bad,
        )  # fmt: skip
