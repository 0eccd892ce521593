"""Rotations and angular velocities against time: what an observer of the whole motion, or of its peaks, sees."""

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

_STEP = 1e-7  # of ln of the speed
_MOST, _LOOKED_AT = 3000, 20_000
_FEWEST, _ROUNDS, _SCATTER = 3, 3, 0.03
_NOISES = 6.0  # below so many standard deviations of the noise nothing turns any more


@dataclass(frozen=True, eq=False)
class Row:
    """A measured quantity against time, and its noise beside that of the first."""

    kind: str  # rotation or angular_velocity
    time: FloatArray
    values: FloatArray
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class SampledSeries:
    """Rotations, angular velocities, or both, each with an offset and a drift that nobody knows."""

    rows: tuple[Row, ...]
    sides: IntArray

    @property
    def count(self) -> int:
        """Number of samples, without those that offset and drift take."""
        return sum(row.values.size - 2 for row in self.rows)

    def residuals(self, path: Path) -> tuple[FloatArray, FloatArray]:
        """Measured less computed values, of which a straight line in time is taken away."""
        found = [self._of_row(path, row) for row in self.rows]
        return np.concatenate([each[0] for each in found], axis=1), np.concatenate([each[1] for each in found], axis=1)

    def _of_row(self, path: Path, row: Row) -> tuple[FloatArray, FloatArray]:
        inner = path.times[:, 1:-1]
        k = (row.time[None, :, None] >= inner[:, None, :]).sum(axis=2)
        g = np.arange(len(k))[:, None]
        p, alpha = path.p[g, k], path.alpha[g, k]
        since = p * (row.time - path.times[g, k])
        sign = 1.0 - 2.0 * self.sides[k]

        def seen(y: FloatArray) -> tuple[FloatArray, FloatArray]:
            return state_space.rotation(since, y[g, k], alpha, state_space.duration(y, path.alpha)[g, k])

        angle, speed = seen(path.y)
        fall = np.sin(alpha - angle)
        angle_by_y, speed_by_y = (
            (b - a) / _STEP for a, b in zip((angle, speed), seen(path.y * (1.0 + _STEP)), strict=True)
        )
        # another slenderness angle is a shift in time and another speed: all disturbances obey one linear equation
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


def fit_series(series: RotationSeries, known: Knowledge) -> tuple[Posterior, tuple[Row, ...], float] | None:
    """Return the posterior, the rows and how many samples count; None if it does not cross its middle often enough."""
    crossings, first = impacts_of(series)
    if crossings.size < _FEWEST:
        return None
    known = replace(known, first=first)
    inside = np.flatnonzero((series.time > crossings[0]) & (series.time < crossings[-1]))
    inside = inside[:: int(np.ceil(inside.size / _MOST))]
    kinds = ((name, getattr(series, name)) for name in ("rotation", "angular_velocity"))
    rows = tuple(Row(kind, series.time[inside], each[inside]) for kind, each in kinds if each is not None)
    frequency = known.frequencies[0]
    if known.body is None:
        frequency = min(known.frequencies, key=lambda each: _misfit(each, crossings, known, rows))
    speeds = speeds_between(crossings, np.arange(crossings.size), known, frequency[0])
    model = known.model(known.sides(speeds.size), float(crossings[0]), speeds, frequency)
    spread = np.array([float(np.ptp(row.values)) * 0.02 for row in rows])
    begin: Callable[[FloatArray], FloatArray] = lambda s: start(model, speeds, s)  # noqa: E731
    impacts = crossings
    for _ in range(_ROUNDS):
        used = tuple(_away(row, impacts, float(s / spread[0])) for row, s in zip(rows, spread, strict=True))
        found = posterior(model, SampledSeries(used, model.sides), _SCATTER, Noise(float(spread[0])), begin)
        begin = partial(rescaled, found.u[0], _SCATTER)
        impacts = model.path(found.u, found.scatter).times[0]
        parts = np.split(found.residuals[0], np.cumsum([row.values.size for row in used])[:-1])
        each = [correlation(part) for part in parts]
        spread = np.array([
            row.scale * np.sqrt(one * (part @ part) / max(part.size - model.size, 1))
            for row, part, one in zip(used, parts, each, strict=True)
        ])  # fmt: skip
    used = tuple(_away(row, impacts, float(s / spread[0])) for row, s in zip(rows, spread, strict=True))
    found = posterior(model, SampledSeries(used, model.sides), None, Noise(float(spread[0])), begin)
    return found, used, float(sum(row.values.size / one for row, one in zip(used, each, strict=True)))


def _away(row: Row, impacts: FloatArray, scale: float) -> Row:
    """Without the samples next to impacts, where an angular velocity jumps and a filter has rounded it."""
    near = np.abs(row.time[:, None] - impacts).min(axis=1) < 1.5 * float(np.median(np.diff(row.time)))
    return Row(row.kind, row.time[~near], row.values[~near], scale)


def impacts_of(series: RotationSeries) -> tuple[FloatArray, Foot]:
    """Return about when the body hits the ground, and the foot on which it stands after the first impact."""
    time, values, degree = series.time, series.rotation, 1
    if values is None:  # its integral, in which an offset and a drift are a line and a parabola
        turning = np.asarray(series.angular_velocity)
        steps = 0.5 * (turning[1:] + turning[:-1]) * np.diff(time)
        values, degree = np.concatenate([[0.0], np.cumsum(steps)]), 2
        values = values - np.median(turning) * (time - time[0])
    least = max(_NOISES * white_noise(values), 0.01 * float(np.ptp(values)))
    values = _about_middle(time, values, degree, least)
    ends = _changes(values, least)
    if ends.size == 0:
        return np.zeros(0), "right"
    crossings = []
    for low, high in ends:
        # the straight line through what lies between, where it is zero
        near = slice(max(low - 1, 0), high + 2)
        slope, level = np.polyfit(time[near] - time[low], values[near], 1)
        crossings.append(float(np.clip(time[low] - level / slope, time[low], time[high])))
    return np.array(crossings), "right" if values[ends[0][1]] > 0.0 else "left"


def _changes(values: FloatArray, least: float) -> IntArray:
    """Where it goes from beyond `least` on one side to beyond it on the other: last and first sample there."""
    beyond = np.flatnonzero(np.abs(values) > least)
    turns = np.flatnonzero(values[beyond[1:]] * values[beyond[:-1]] < 0.0)
    return np.column_stack([beyond[turns], beyond[turns + 1]])


def _about_middle(time: FloatArray, values: FloatArray, degree: int, least: float) -> FloatArray:
    """Take away a polynomial through where the body stands on both feet: halfway between neighbouring peaks."""
    peaks = _peaks(values, least)
    if peaks.size < 4:
        return np.asarray(values - np.median(values))
    tops = values[peaks]
    halfway, at = 0.25 * (tops[:-2] + tops[2:]) + 0.5 * tops[1:-1], time[peaks[1:-1]]
    weights = 1.0 / (np.abs(tops[2:] - tops[1:-1]) + np.abs(tops[1:-1] - tops[:-2]))  # large peaks lie far off
    return np.asarray(values - Polynomial.fit(at, halfway, min(degree, at.size - 1), w=weights)(time))


def _peaks(values: FloatArray, least: float) -> IntArray:
    """Where it turns, alternately up and down, each time by more than `least`."""
    found, way, low, high = [], 0, 0, 0
    for k in range(0, values.size, int(np.ceil(values.size / _LOOKED_AT))):
        low, high = (k if values[k] < values[low] else low), (k if values[k] > values[high] else high)
        if way <= 0 and values[k] - values[low] > least:
            found.append(low)
            way, high = 1, k
        elif way >= 0 and values[high] - values[k] > least:
            found.append(high)
            way, low = -1, k
    return np.array(found[1:], dtype=np.int64)  # the first is where it began


def _misfit(frequency: tuple[float, float], crossings: FloatArray, known: Knowledge, rows: tuple[Row, ...]) -> float:
    """How far the first half cycle is from what was measured, for a frequency parameter."""
    speeds = speeds_between(crossings, np.arange(crossings.size), known, frequency[0])
    model = known.model(known.sides(speeds.size), float(crossings[0]), speeds, frequency)
    path = model.path(start(model, speeds, np.array([_SCATTER])), np.array([_SCATTER]))
    residual = SampledSeries(rows, model.sides).residuals(path)[0]
    return float((residual**2).sum())


def correlation(residual: FloatArray) -> float:
    """Return the number of samples that count as one, from the correlation of neighbours."""
    centred = residual - residual.mean()
    total = float(centred @ centred)
    if total == 0.0:
        return 1.0
    found = 1.0
    for lag in range(1, min(residual.size // 4, 200)):
        each = float(centred[lag:] @ centred[:-lag]) / total
        if each < 0.05:
            break
        found += 2.0 * each
    return found
