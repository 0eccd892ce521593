"""Three components of ground motion as polynomials on common stretches of time."""

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
    """Accelerations of the ground along x, y and z, from time zero on; at rest after the last stretch."""

    times: FloatArray  # ends of the stretches; the first one is zero [s]; shape (n + 1,)
    # accelerations over each stretch by power, over a unit of time that is the stretch [m/s2]; shape (n, 3, degree + 1)
    coefficients: FloatArray

    @property
    def count(self) -> int:
        return len(self.coefficients)

    @property
    def end(self) -> float:
        """When the ground comes to rest [s]."""
        return float(self.times[-1])

    def part(self, stretch: int, start: float, length: float) -> FloatArray:
        """Return accelerations by power over a part of a stretch, over a unit of time that is the part [m/s2]."""
        if stretch >= self.count:
            return np.zeros((3, 1))
        whole = self.times[stretch + 1] - self.times[stretch]
        to, width = (start - self.times[stretch]) / whole, length / whole
        if to == 0.0 and width == 1.0:
            return np.asarray(self.coefficients[stretch])
        return np.array([shifted(row.tolist(), to, width) for row in self.coefficients[stretch]])

    def at(self, time: FloatArray) -> FloatArray:
        """Return the accelerations at some times; where a motion jumps, the value after the jump [m/s2]."""
        inside = (time >= 0.0) & (time < self.end)
        k = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, max(self.count - 1, 0))
        if not self.count:
            return np.zeros((time.size, 3))
        tau = (time - self.times[k]) / (self.times[k + 1] - self.times[k])
        found = applied(self.coefficients[k], powers(tau, self.coefficients.shape[2]))
        return np.where(inside[:, None], found, 0.0)


def ground_of(
    x: Component = None, y: Component = None, vertical: Component = None, *, until: float = np.inf, scale: float = 1.0
) -> SpatialGround:
    """Return three motions [m/s2], or None, with one clock as one."""
    # until: when the ground stops, if before they end [s]
    rows = [_component(name, motion) for name, motion in (("x", x), ("y", y), ("vertical", vertical))]
    ends = [times for times, _ in rows if times.size]
    if not ends:
        return SpatialGround(np.zeros(1), np.zeros((0, 3, 1)))
    times = np.unique(np.concatenate(ends))
    least = min(float(np.diff(part).min()) for part in ends)
    times = times[np.concatenate([[True], np.diff(times) > _SAME * least])]
    times = times[: np.searchsorted(times, until * (1.0 - 1e-12), side="left") + 1]
    degree = max(part.shape[1] for _, part in rows)
    made = np.zeros((len(times) - 1, 3, degree))
    for which, (stops, polynomials) in enumerate(rows):
        if stops.size:
            made[:, which, : polynomials.shape[1]] = scale * _recut(stops, polynomials, times)
    return SpatialGround(times, made)


def _component(name: str, motion: Component) -> tuple[FloatArray, FloatArray]:
    if motion is None:
        return np.zeros(0), np.zeros((0, 1))
    checks.of_kind(name, motion, (GroundMotion, Pulse), "a GroundMotion, a pulse or None")
    along_z = name == "vertical" and isinstance(motion, GroundMotion)
    segments = motion.upright_segments() if along_z else motion.segments()  # type: ignore[union-attr]
    if segments.vertical is not None:
        raise InvalidValueError(
            "the {component} component must not have a vertical part of its own", component=name,
            hint="hand it over as vertical=GroundMotion(...)",
        )  # fmt: skip
    return np.asarray(np.arange(segments.count + 1) * segments.step, dtype=np.float64), segments.horizontal


def _recut(stops: FloatArray, polynomials: FloatArray, times: FloatArray) -> FloatArray:
    """Rewrite polynomials on the stretches between `times`."""
    made = np.zeros((len(times) - 1, polynomials.shape[1]))
    shared = min(len(stops), len(times)) - 1
    if np.array_equal(stops[: shared + 1], times[: shared + 1]):
        made[:shared] = polynomials[:shared]
        return made
    middles = 0.5 * (times[1:] + times[:-1])
    place = np.searchsorted(stops, middles) - 1
    for k, inner in enumerate(place):
        if inner >= len(polynomials):
            break
        whole = stops[inner + 1] - stops[inner]
        to, width = (times[k] - stops[inner]) / whole, (times[k + 1] - times[k]) / whole
        same = abs(to) < _SAME and abs(width - 1.0) < _SAME
        made[k] = polynomials[inner] if same else shifted(polynomials[inner].tolist(), to, width)
    return made
