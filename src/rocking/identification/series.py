"""Rotations and angular velocities against time: residuals of a whole time history, and detection of impacts."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.polynomial import Polynomial

from rocking.conventions import FloatArray, Foot, IntArray
from rocking.identification import state_space
from rocking.identification.association import speeds_between, start
from rocking.identification.measurement import RotationSeries, white_noise
from rocking.identification.posterior import Knowledge, Noise, Posterior, posterior, rescaled
from rocking.identification.state_space import Path

_STEP = 1e-7  # change of ln of the speed for derivatives
_MAX_SAMPLES, _MAX_SEARCHED = 3000, 20_000
_MIN_CROSSINGS, _ROUNDS, _SCATTER = 3, 3, 0.03
_NOISES = 6.0  # number of standard deviations of the noise below which a rotation is noise


@dataclass(frozen=True, eq=False)
class Row:
    """A measured quantity against time, and the ratio of its noise to the noise of the first quantity."""

    kind: str  # "rotation" or "angular_velocity"
    time: FloatArray
    values: FloatArray
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class SampledSeries:
    """Rotations, angular velocities, or both, each with an unknown offset and drift."""

    rows: tuple[Row, ...]
    sides: IntArray

    @property
    def count(self) -> int:
        """Number of samples, minus the number of values for offset and drift."""
        return sum(row.values.size - 2 for row in self.rows)

    def residuals(self, path: Path) -> tuple[FloatArray, FloatArray]:
        """Return measured minus computed values without their linear trend in time, with slopes."""
        residuals, slopes = zip(*(self._of_row(path, row) for row in self.rows), strict=True)
        return np.concatenate(residuals, axis=1), np.concatenate(slopes, axis=1)

    def _of_row(self, path: Path, row: Row) -> tuple[FloatArray, FloatArray]:
        inner = path.times[:, 1:-1]
        k = (row.time[None, :, None] >= inner[:, None, :]).sum(axis=2)
        g = np.arange(len(k))[:, None]
        p, alpha = path.p[g, k], path.alpha[g, k]
        since = p * (row.time - path.times[g, k])
        sign = 1.0 - 2.0 * self.sides[k]

        def response(y: FloatArray) -> tuple[FloatArray, FloatArray]:
            return state_space.rotation(since, y[g, k], alpha, state_space.duration(y, path.alpha)[g, k])

        angle, speed = response(path.y)
        fall = np.sin(alpha - angle)
        angle_by_y, speed_by_y = (
            (b - a) / _STEP for a, b in zip((angle, speed), response(path.y * (1.0 + _STEP)), strict=True)
        )
        # a change of the slenderness angle shifts the time and changes the speed; both obey one linear equation
        begun = (2.0 * np.sin(0.5 * path.alpha) * path.y)[g, k]
        mixed = (np.cos(0.5 * path.alpha) * (1.0 / path.y - path.y))[g, k]
        if row.kind == "rotation":
            value, by_since, by_y = angle, speed, angle_by_y
            by_alpha = 1.0 - (speed + mixed * angle_by_y) / begun
        else:
            value, by_since, by_y = p * speed, -p * fall, p * speed_by_y
            by_alpha = p * (fall - mixed * speed_by_y) / begun
        slopes = (
            by_since[..., None] * (since[..., None] * path.p_slopes - p[..., None] * path.time_slopes[g, k])
            + by_y[..., None] * path.y_slopes[g, k]
            + by_alpha[..., None] * path.alpha_slopes[g, k]
        )
        if row.kind != "rotation":
            slopes = slopes + value[..., None] * path.p_slopes
        line = np.linalg.qr(np.column_stack([np.ones(row.time.size), row.time - row.time.mean()]))[0]
        residual = row.values - sign * value
        residual = residual - (residual @ line) @ line.T
        slopes = sign[..., None] * slopes
        slopes = slopes - line @ (line.T @ slopes)  # Eq. 275
        return residual / row.scale, slopes / row.scale


def fit_series(series: RotationSeries, prior: Knowledge) -> tuple[Posterior, tuple[Row, ...], float] | None:
    """Return the posterior, the rows and the effective number of samples; None for fewer than three crossings."""
    crossings, first = find_impacts(series)
    if crossings.size < _MIN_CROSSINGS:
        return None
    prior = replace(prior, first=first)
    inside = np.flatnonzero((series.time > crossings[0]) & (series.time < crossings[-1]))
    inside = inside[:: int(np.ceil(inside.size / _MAX_SAMPLES))]
    kinds = ((name, getattr(series, name)) for name in ("rotation", "angular_velocity"))
    rows = tuple(Row(kind, series.time[inside], values[inside]) for kind, values in kinds if values is not None)
    frequency = prior.frequencies[0]
    if prior.body is None:
        frequency = min(prior.frequencies, key=lambda guess: _misfit(guess, crossings, prior, rows))
    speeds = speeds_between(crossings, np.arange(crossings.size), prior, frequency[0])
    model = prior.model(prior.sides(speeds.size), float(crossings[0]), speeds, frequency)
    spread = np.array([float(np.ptp(row.values)) * 0.02 for row in rows])
    first_guess: Callable[[FloatArray], FloatArray] = lambda s: start(model, speeds, s)  # noqa: E731
    impacts = crossings
    for _ in range(_ROUNDS):
        used = tuple(
            _without_impact_samples(row, impacts, float(s / spread[0])) for row, s in zip(rows, spread, strict=True)
        )
        fit = posterior(model, SampledSeries(used, model.sides), _SCATTER, Noise(float(spread[0])), first_guess)
        first_guess = partial(rescaled, fit.u[0], _SCATTER)
        impacts = model.path(fit.u, fit.scatter).times[0]
        residuals_by_row = np.split(fit.residuals[0], np.cumsum([row.values.size for row in used])[:-1])
        lengths = [correlation(residuals) for residuals in residuals_by_row]
        spread = np.array([
            row.scale * np.sqrt(length * (residuals @ residuals) / max(residuals.size - model.size, 1))
            for row, residuals, length in zip(used, residuals_by_row, lengths, strict=True)
        ])  # fmt: skip
    used = tuple(
        _without_impact_samples(row, impacts, float(s / spread[0])) for row, s in zip(rows, spread, strict=True)
    )
    fit = posterior(model, SampledSeries(used, model.sides), None, Noise(float(spread[0])), first_guess)
    return fit, used, float(sum(row.values.size / length for row, length in zip(used, lengths, strict=True)))


def _without_impact_samples(row: Row, impacts: FloatArray, scale: float) -> Row:
    """Return the row without samples near impacts, where a filter rounds the angular velocity."""
    near = np.abs(row.time[:, None] - impacts).min(axis=1) < 1.5 * float(np.median(np.diff(row.time)))
    return Row(row.kind, row.time[~near], row.values[~near], scale)


def find_impacts(series: RotationSeries) -> tuple[FloatArray, Foot]:
    """Return approximate times of impacts, and the foot in contact after the first impact."""
    time, values, degree = series.time, series.rotation, 1
    if values is None:  # use the integral of the velocity; its offset and drift become a line and a parabola
        turning = np.asarray(series.angular_velocity)
        steps = 0.5 * (turning[1:] + turning[:-1]) * np.diff(time)
        values, degree = np.concatenate([[0.0], np.cumsum(steps)]), 2
        values = values - np.median(turning) * (time - time[0])
    threshold = max(_NOISES * white_noise(values), 0.01 * float(np.ptp(values)))
    values = _about_middle(time, values, degree, threshold)
    ends = _changes(values, threshold)
    if ends.size == 0:
        return np.zeros(0), "right"
    crossings = []
    for low, high in ends:
        # zero of the straight line through the samples between both ends
        near = slice(max(low - 1, 0), high + 2)
        slope, level = np.polyfit(time[near] - time[low], values[near], 1)
        crossings.append(float(np.clip(time[low] - level / slope, time[low], time[high])))
    return np.array(crossings), "right" if values[ends[0][1]] > 0.0 else "left"


def _changes(values: FloatArray, threshold: float) -> IntArray:
    """Return the last and first sample beyond the threshold at each change of sign."""
    beyond = np.flatnonzero(np.abs(values) > threshold)
    turns = np.flatnonzero(values[beyond[1:]] * values[beyond[:-1]] < 0.0)
    return np.column_stack([beyond[turns], beyond[turns + 1]])


def _about_middle(time: FloatArray, values: FloatArray, degree: int, threshold: float) -> FloatArray:
    """Return values without a polynomial through the midpoints between neighbouring peaks."""
    peaks = _peaks(values, threshold)
    if peaks.size < 4:
        return np.asarray(values - np.median(values))
    tops = values[peaks]
    halfway, at = 0.25 * (tops[:-2] + tops[2:]) + 0.5 * tops[1:-1], time[peaks[1:-1]]
    # small weights, because midpoints of large peaks are inaccurate
    weights = 1.0 / (np.abs(tops[2:] - tops[1:-1]) + np.abs(tops[1:-1] - tops[:-2]))
    return np.asarray(values - Polynomial.fit(at, halfway, min(degree, at.size - 1), w=weights)(time))


def _peaks(values: FloatArray, threshold: float) -> IntArray:
    """Return the turning points, alternately high and low, with changes above the threshold."""
    peaks, direction, low, high = [], 0, 0, 0
    for k in range(0, values.size, int(np.ceil(values.size / _MAX_SEARCHED))):
        low, high = (k if values[k] < values[low] else low), (k if values[k] > values[high] else high)
        if direction <= 0 and values[k] - values[low] > threshold:
            peaks.append(low)
            direction, high = 1, k
        elif direction >= 0 and values[high] - values[k] > threshold:
            peaks.append(high)
            direction, low = -1, k
    return np.array(peaks[1:], dtype=np.int64)  # the first turning point is the start


def _misfit(frequency: tuple[float, float], crossings: FloatArray, prior: Knowledge, rows: tuple[Row, ...]) -> float:
    """Return the misfit of a frequency parameter."""
    speeds = speeds_between(crossings, np.arange(crossings.size), prior, frequency[0])
    model = prior.model(prior.sides(speeds.size), float(crossings[0]), speeds, frequency)
    path = model.path(start(model, speeds, np.array([_SCATTER])), np.array([_SCATTER]))
    residual = SampledSeries(rows, model.sides).residuals(path)[0]
    return float((residual**2).sum())


def correlation(residual: FloatArray) -> float:
    """Return the number of samples per independent sample, from the correlation of neighbours."""
    centred = residual - residual.mean()
    total = float(centred @ centred)
    if total == 0.0:
        return 1.0
    length = 1.0
    for lag in range(1, min(residual.size // 4, 200)):
        coefficient = float(centred[lag:] @ centred[:-lag]) / total
        if coefficient < 0.05:
            break
        length += 2.0 * coefficient
    return length
