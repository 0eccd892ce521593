"""Adaptive grid between the values of two axes. It is refined only along changes of the mode."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, BoolArray, FloatArray, IntArray
from rocking.dynamics.mechanics import study_settings
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.studies.axis import Axis, axis_of, friction_beside, varied_name
from rocking.studies.question import Case, Question


@dataclass(frozen=True)
class Plane:
    """A question, and two axes along which the question varies."""

    question: Question  # body, motion, restitution and settings
    x: Axis  # x, y: the axes
    y: Axis

    def __post_init__(self) -> None:
        if self.x.sets == self.y.sets:
            raise InvalidValueError(
                "x and y must set different parameters, got {x} and {y}: both set {sets}", x=self.x.name, y=self.y.name,
                sets=self.x.sets,
            )  # fmt: skip
        for axis, other in ((self.x, self.y), (self.y, self.x)):
            axis.check(self.question)
            axis.check_beside(other)

    @classmethod
    def of(
        cls, body: Any, motion: Any, x: Any, y: Any, restitution: Any = DEFAULT_RESTITUTION, **options: Any
    ) -> "Plane":
        """Return a plane from user input. Options are gravity [m/s2], threads, engine and fields of `Settings`."""
        threads, engine = options.pop("threads", None), options.pop("engine", "auto")
        axes = axis_of(x), axis_of(y)
        options |= friction_beside(axes, options.get("friction"))
        settings = study_settings(body, options, options.pop("gravity", conventions.g))
        return cls(Question(body, motion, restitution, settings, threads, engine), *axes)

    def attributes(self, work: dict[str, int]) -> dict[str, Any]:
        """Return inputs, settings and work of the computation, as plain values."""
        attributes = self.question.attributes(work) | {"motion": varied_name(self.question.motion, (self.x, self.y))}
        if "friction" in {self.x.name, self.y.name}:
            del attributes["setting_friction"]
        return attributes

    def case(self, x: FloatArray, y: FloatArray) -> Case:
        """Return the variations at points. Bodies are set first, then restitution, time, amplitude and velocity."""
        case = Case.of(self.question, x.size)
        steps = sorted([(self.x, x), (self.y, y)], key=lambda step: step[0].stage)
        for axis, values in steps:
            if axis.stage == 0:
                case = axis.applied(case, values)
        case = case.settled()
        for axis, values in steps:
            if axis.stage > 0:
                case = axis.applied(case, values)
        return case

    def answers(
        self, x: FloatArray, y: FloatArray, stream: Any = None, progress: Callable[[int], None] | None = None
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results at points."""
        case = self.case(x, y)
        return self.question.run(case.values, case.stretch, stream, progress)

    def mesh(self) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of all pairs of values. The values of x vary fastest."""
        x, y = np.meshgrid(self.x.values, self.y.values)
        return x.ravel(), y.ravel()


MOST_LEVELS = 12  # spacing ratio 4096; for a finer boundary, use bisection
Label = Callable[[IntArray], Any]

# number of cells processed together; intermediate arrays need several times the memory of the results
_PIECE = 1 << 17


class AdaptiveGrid:
    """Points between the values of two axes, with results. Points are numbered in steps of the finest level."""

    def __init__(self, plane: Plane, levels: int, progress: Callable[[int], None] | None = None) -> None:
        levels = checks.whole("levels of refinement", levels, 0, MOST_LEVELS)
        if plane.question.law.kind == 2:
            raise InvalidValueError("a random restitution has no boundary to refine; sample it instead")
        self.plane, self.levels, self.progress = plane, levels, progress
        self.step = 1 << levels
        self.columns = (plane.x.values.size - 1) * self.step + 1
        self.rows = (plane.y.values.size - 1) * self.step + 1
        self.keys: IntArray = np.empty(0, np.int64)
        self.modes: IntArray = np.empty(0, np.int64)
        self.peaks: FloatArray = np.empty(0)

    def coordinates(self, i: IntArray, j: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of grid points. They are bit-exact for the values of the axes."""
        return self._between(self.plane.x, i), self._between(self.plane.y, j)

    def _between(self, axis: Axis, indices: IntArray) -> FloatArray:
        cells, fraction = indices >> self.levels, (indices & (self.step - 1)) / self.step
        above = np.minimum(cells + 1, axis.values.size - 1)
        return np.asarray(axis.values[cells] + fraction * (axis.values[above] - axis.values[cells]))

    def base(self) -> IntArray:
        """Return the indices (row times columns plus column) of the values of the axes, increasing."""
        i, j = np.arange(0, self.columns, self.step), np.arange(0, self.rows, self.step)
        return np.asarray((j[:, None] * self.columns + i).ravel())

    def compute(self, keys: IntArray) -> None:
        """Compute the unknown points in one batch."""
        new = absent(keys, self.keys)
        if not new.size:
            return
        results, _ = self.plane.answers(
            *self.coordinates(new % self.columns, new // self.columns), progress=self.progress
        )
        self.learn(new, results["mode"], results["peak_ratio"])

    def learn(self, keys: IntArray, modes: IntArray, peaks: FloatArray) -> None:
        """Add the modes and relative peaks [-] of new points."""
        if not self.keys.size:
            self.keys, self.modes, self.peaks = keys, modes, peaks
            return
        positions = np.searchsorted(self.keys, keys)
        self.keys = np.insert(self.keys, positions, keys)
        self.modes = np.insert(self.modes, positions, modes)
        self.peaks = np.insert(self.peaks, positions, peaks)

    def modes_at(self, i: IntArray, j: IntArray) -> IntArray:
        """Return the modes of points. Unknown modes are computed."""
        keys = j * self.columns + i
        self.compute(keys.ravel())
        return np.asarray(self.modes[np.searchsorted(self.keys, keys)])

    def corners(self, i: IntArray, j: IntArray, step: int) -> IntArray:
        """Return the modes at the corners of cells: lower left, lower right, upper right, upper left."""
        return self.modes_at(*_corners(i, j, step))

    def finest(self, label: Label) -> tuple[IntArray, IntArray]:
        """Subdivide cells with different corners, level by level.

        Return columns and rows of the finest of these cells.
        """
        self.compute(self.base())
        across, up = self.plane.x.values.size - 1, self.plane.y.values.size - 1
        j, i = (index * self.step for index in np.divmod(np.arange(across * up), max(across, 1)))
        i, j = self._differing(label, i, j, self.step)
        for level in range(1, self.levels + 1):
            half = self.step >> level  # Eq. 185
            i = (i[:, None] + np.array([0, half, 0, half])).ravel()
            j = (j[:, None] + np.array([0, 0, half, half])).ravel()
            i, j = self._differing(label, i, j, half)
        return i, j

    def _differing(self, label: Label, i: IntArray, j: IntArray, step: int) -> tuple[IntArray, IntArray]:
        """Return the cells with different corners. Unknown corners are computed in one batch."""
        pieces = [slice(first, first + _PIECE) for first in range(0, i.size, _PIECE)]
        new, mixed = [np.empty(0, np.int64)], [np.empty(0, np.bool_)]
        for piece in pieces:
            columns, rows = _corners(i[piece], j[piece], step)
            new.append(absent((rows * self.columns + columns).ravel(), self.keys))
        self.compute(np.concatenate(new))
        for piece in pieces:
            labels = label(self.corners(i[piece], j[piece], step))
            mixed.append(np.any(labels != labels[:, :1], axis=1))
        kept = np.concatenate(mixed)
        return i[kept], j[kept]


def absent(keys: IntArray, existing: IntArray) -> IntArray:
    """Return the keys that are not among the existing keys (`numpy.setdiff1d` for sorted existing keys)."""
    if existing.size:
        places = np.searchsorted(existing, keys)
        keys = keys[existing[np.minimum(places, existing.size - 1)] != keys]
    keys = np.sort(keys)
    return keys[np.append(True, keys[1:] != keys[:-1])] if keys.size else keys


def merged(existing: IntArray, new: IntArray) -> IntArray:
    """Return the union of two sets of increasing keys."""
    return np.insert(existing, np.searchsorted(existing, new), new)


def _corners(i: IntArray, j: IntArray, step: int) -> tuple[IntArray, IntArray]:
    """Return columns and rows of the corners of cells: lower left, lower right, upper right, upper left."""
    across, up = np.array([0, step, step, 0]), np.array([0, 0, step, step])
    return i[:, None] + across, j[:, None] + up


def verdicts(modes: IntArray) -> BoolArray:
    """Return True for modes of overturning. Callers must exclude failed points.

    >>> verdicts(np.array([-3, -2, -1, 0, 2])).tolist()
    [False, False, False, True, True]
    """
    return np.asarray(modes >= 0)


@dataclass(frozen=True, eq=False)
class RefinedMap:
    """Points of a map after refinement along the boundaries between modes."""

    x: FloatArray  # x, y: coordinates of all points, in the units of the axes
    y: FloatArray
    modes: IntArray  # -3 failed, -2 no uplift, -1 no overturning, n >= 0 overturned after n impacts
    peak_ratio: FloatArray  # peak rotation / slenderness angle [-]
    base: BoolArray  # True for points of the map before refinement


def refined(grid: AdaptiveGrid, modes: IntArray, peaks: FloatArray) -> tuple[RefinedMap, tuple[IntArray, IntArray]]:
    """Return the refinement of a computed map on a new grid, and the finest cells with different corners."""
    # the points of the map are first, in their order; `outlines` starts from the cells with different corners
    first = grid.base()
    grid.learn(first, np.asarray(modes, dtype=np.int64).ravel(), np.asarray(peaks, dtype=np.float64).ravel())
    cells = grid.finest(lambda modes: modes)
    own = np.zeros(grid.keys.size, dtype=np.bool_)
    own[np.searchsorted(grid.keys, first)] = True
    order = np.concatenate([np.flatnonzero(own), np.flatnonzero(~own)])  # points of the map first
    x, y = np.empty(order.size), np.empty(order.size)
    for start in range(0, order.size, _PIECE):  # intermediate arrays of coordinates need much memory
        rows = slice(start, start + _PIECE)
        keys = grid.keys[order[rows]]
        x[rows], y[rows] = grid.coordinates(keys % grid.columns, keys // grid.columns)
    base = np.arange(order.size) < first.size
    return RefinedMap(x, y, grid.modes[order], grid.peaks[order], base), cells


def refined_map(
    body: Body,
    motion: Motion,
    x: Axis | tuple[str, Any],
    y: Axis | tuple[str, Any],
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    levels: int = 3,
    gravity: float = conventions.g,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> RefinedMap:
    """Return the points of an overturning map that is refined along the boundaries between modes.

    Cells with different modes at their corners are divided into four, level by level, and only new points are
    computed. Regions that are narrower than a cell and contain no corner are not detected.

    Parameters
    ----------
    body, motion, x, y, restitution
        As for `rocking.overturning_map`; the restitution must not be random.
    levels : int
        Number of refinements [-]. A refinement halves the spacing.
    gravity, progress, **options
        As for `rocking.overturning_map`.

    Returns
    -------
    RefinedMap
        All points. The points of the map are first, with x varying fastest.
    """
    plane = Plane.of(body, motion, x, y, restitution, gravity=gravity, **options)
    results, _ = plane.answers(*plane.mesh(), progress=progress)
    return refined(AdaptiveGrid(plane, levels, progress), results["mode"], results["peak_ratio"])[0]
