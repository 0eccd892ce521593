"""Three components of ground motion as polynomials on common segments of time."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.taylor import shifted
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.portable import applied, powers

Component = GroundMotion | Pulse | None

_SAME = 1e-9


@dataclass(frozen=True, eq=False)
class SpatialGround:
    """Accelerations of the ground along x, y and z from time zero. The ground is at rest after the last segment."""

    times: FloatArray  # ends of the segments [s], starting with zero; shape (n + 1,)
    # accelerations over every segment by power [m/s2]; the unit of time is the segment; shape (n, 3, degree + 1)
    coefficients: FloatArray

    @property
    def count(self) -> int:
        return len(self.coefficients)

    @property
    def end(self) -> float:
        """End of the motion [s]."""
        return float(self.times[-1])

    def segment(self, stretch: int, start: float, length: float) -> FloatArray:
        """Return accelerations by power over a part of a segment [m/s2]. This part is the unit of time."""
        if stretch >= self.count:
            return np.zeros((3, 1))
        duration = self.times[stretch + 1] - self.times[stretch]
        offset, width = (start - self.times[stretch]) / duration, length / duration
        if offset == 0.0 and width == 1.0:
            return np.asarray(self.coefficients[stretch])
        return np.array([shifted(row.tolist(), offset, width) for row in self.coefficients[stretch]])

    def at(self, time: FloatArray) -> FloatArray:
        """Return the accelerations at times [s], shape (n, 3) [m/s2]. At a jump, the value after the jump."""
        inside = (time >= 0.0) & (time < self.end)
        k = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, max(self.count - 1, 0))
        if not self.count:
            return np.zeros((time.size, 3))
        tau = (time - self.times[k]) / (self.times[k + 1] - self.times[k])
        accelerations = applied(self.coefficients[k], powers(tau, self.coefficients.shape[2]))
        return np.where(inside[:, None], accelerations, 0.0)


def ground_of(
    x: Component = None, y: Component = None, vertical: Component = None, *, until: float = np.inf, scale: float = 1.0
) -> SpatialGround:
    """Return up to three motions [m/s2] on common segments. None means a component at rest."""
    # until: end of the ground motion [s], if earlier than the end of the records
    rows = [_component(name, motion) for name, motion in (("x", x), ("y", y), ("vertical", vertical))]
    ends = [times for times, _ in rows if times.size]
    if not ends:
        return SpatialGround(np.zeros(1), np.zeros((0, 3, 1)))
    times = np.unique(np.concatenate(ends))
    min_step = min(float(np.diff(pieces).min()) for pieces in ends)
    times = times[np.concatenate([[True], np.diff(times) > _SAME * min_step])]
    times = times[: np.searchsorted(times, until * (1.0 - 1e-12), side="left") + 1]
    degree = max(pieces.shape[1] for _, pieces in rows)
    coefficients = np.zeros((len(times) - 1, 3, degree))
    for axis, (stops, polynomials) in enumerate(rows):
        if stops.size:
            coefficients[:, axis, : polynomials.shape[1]] = scale * _recut(stops, polynomials, times)
    return SpatialGround(times, coefficients)


def _component(name: str, motion: Component) -> tuple[FloatArray, FloatArray]:
    if motion is None:
        return np.zeros(0), np.zeros((0, 1))
    checks.of_kind(name, motion, (GroundMotion, Pulse), "a GroundMotion, a pulse or None")
    along_z = name == "vertical" and isinstance(motion, GroundMotion)
    segments = motion.upright_segments() if along_z else motion.segments()  # type: ignore[union-attr]
    if segments.vertical is not None:
        raise InvalidValueError(
            "the component {component} must not have a vertical part", component=name,
            hint="use vertical=GroundMotion(...)",
        )  # fmt: skip
    return np.asarray(np.arange(segments.count + 1) * segments.step, dtype=np.float64), segments.horizontal


def _recut(stops: FloatArray, polynomials: FloatArray, times: FloatArray) -> FloatArray:
    """Rewrite polynomials on the segments between `times`."""
    result = np.zeros((len(times) - 1, polynomials.shape[1]))
    common = min(len(stops), len(times)) - 1
    if np.array_equal(stops[: common + 1], times[: common + 1]):
        result[:common] = polynomials[:common]
        return result
    middles = 0.5 * (times[1:] + times[:-1])
    indices = np.searchsorted(stops, middles) - 1
    for k, inner in enumerate(indices):
        if inner >= len(polynomials):
            break
        duration = stops[inner + 1] - stops[inner]
        offset, width = (times[k] - stops[inner]) / duration, (times[k + 1] - times[k]) / duration
        same = abs(offset) < _SAME and abs(width - 1.0) < _SAME
        result[k] = polynomials[inner] if same else shifted(polynomials[inner].tolist(), offset, width)
    return result
