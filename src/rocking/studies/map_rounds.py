"""Histories of overturning maps in pieces, and boundaries of maps in rounds."""

import math
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking import quantities
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.content import hash_of
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError, located
from rocking.quantities import QUANTITIES
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane, RefinedMap, refined
from rocking.studies.boundaries import Polyline, checked, outlines
from rocking.studies.histories import Histories
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import modes_of, peak_ratio, quickened
from rocking.studies.study_plan import AdaptiveResult, Compute, DelegatedQuestion, Study
from rocking.tables import PIECE, Column, Table, prefixed, text_array

MOST_POINTS = 10_000_000  # largest number of points of a refined map, which needs less than 2 GiB of memory
_PROBES = 1024
# ratio of later histories to edges and bisections of a line across a map
_EDGES = (2.0, 12.0)


@dataclass(frozen=True, eq=False)
class MapHistories(Histories):
    """Every restitution over the plane of two axes. The restitution changes slowest, x fastest.

    Histories are not kept in memory. Instead of a slower motion, the engine uses the unstretched motion with faster
    bodies. `rescaled` converts the times of the results to the times of the map.
    """

    planes: tuple[Plane, ...]  # one plane per restitution, with equal axes

    @classmethod
    def of(cls, planes: list[Plane]) -> "MapHistories":
        """Return the histories of a map."""
        question = planes[0].question
        options: dict[str, Any] = {"law": question.law, "settings": question.settings, "engine": question.engine}
        histories = cls(MotionList([question.motion]), tuple(planes), **options)
        for number, plane in enumerate(planes):
            # a map without any possible body raises an error, but single cells may have no body
            plane.case(*histories._points(histories._probes(number)))
        return histories

    @property
    def cells(self) -> int:
        """Number of points of the plane."""
        return int(self.planes[0].x.values.size * self.planes[0].y.values.size)

    @property
    def count(self) -> int:
        """Number of histories."""
        return self.cells * len(self.planes)

    def rows(self, first: int, last: int) -> Rows:
        """Return a range of the rows for the engine. Impossible bodies are NaN."""
        numbers = np.arange(first, last, dtype=np.int64)
        values, stretch = self._values(numbers)
        return Rows.of(last - first, 0, numbers, **quickened(values, stretch))

    def rescaled(self, first: int, last: int, results: Arrays) -> Arrays:
        """Return results whose times [s] and velocities [rad/s] are those of the stretched motions."""
        _, stretch = self._values(np.arange(first, last, dtype=np.int64))
        times = {name: results[name] * stretch for name in quantities.TIMES}
        return {**results, **times, "peak_velocity": results["peak_velocity"] / stretch}

    def content(self) -> dict[str, Any]:
        """Return axes, body, restitution, and the hash of rows that are spread over the map."""
        plane = self.planes[0]
        probes = [self._values(self._probes(k)) for k in range(len(self.planes))]
        tables = [np.stack([*(values[n] for n in sorted(values)), stretch]) for values, stretch in probes]
        return {
            "x": {"axis": plane.x.name, "values": hash_of(plane.x.values)},
            "y": {"axis": plane.y.name, "values": hash_of(plane.y.values)},
            "restitution": [item.question.parameters.label for item in self.planes],
            "rows": [hash_of(table) for table in tables],
        }

    def _probes(self, number: int) -> np.ndarray:
        spread = np.unique(np.linspace(0, self.cells - 1, min(self.cells, _PROBES), dtype=np.int64))
        return spread + number * self.cells

    def _points(self, numbers: np.ndarray) -> tuple[FloatArray, FloatArray]:
        plane = self.planes[0]
        j, i = np.divmod(numbers % self.cells, plane.x.values.size)
        return plane.x.values[i], plane.y.values[j]

    def _values(self, numbers: np.ndarray) -> tuple[dict[str, FloatArray], FloatArray]:
        """Return the engine inputs of histories, and the stretch factors of their motion."""
        values, stretch = {name: np.full(numbers.size, np.nan) for name in sides_of([None])}, np.ones(numbers.size)
        values["scale"] = np.ones(numbers.size)
        for k, plane in enumerate(self.planes):
            own = numbers // self.cells == k
            if own.any():
                with suppress(InvalidValueError):  # no error if none of these bodies is possible
                    case = plane.case(*self._points(numbers[own]))
                    stretch[own] = case.stretch
                    for name, row in case.values.items():
                        values.setdefault(name, np.full(numbers.size, np.nan))[own] = row
        return values, stretch


@dataclass(frozen=True)
class MapSearch:
    """Rounds of a refined map: the map, its refinements, and the bisections of its edges."""

    study: Study  # first round: the map before refinement
    plane: Plane  # the question and its axes
    levels: int  # levels of refinement
    by: str  # "verdict" or "mode"
    tolerance: float  # width of the last brackets over the coordinate [-]
    kept: float = field(default=0.25, init=False)  # bisections of edges are not kept

    @classmethod
    def of(cls, study: Study, planes: list[Plane], levels: int, by: str, tolerance: float) -> "MapSearch":
        """Return the checked search of a map."""
        if len(planes) > 1:
            raise InvalidValueError("map.refine accepts one restitution. Use one job per restitution.")
        points = planes[0].x.values.size * planes[0].y.values.size
        if points > MOST_POINTS:
            raise InvalidValueError(
                "{parameter} accepts maps of up to {limit} points, got {points}",
                parameter="map.refine", limit=MOST_POINTS, points=points,
                hint="Use fewer points and one more refinement, which halves the spacing.",
            )  # fmt: skip
        with located("map.refine"):
            tolerance = checked(planes[0], by, tolerance)
            AdaptiveGrid(planes[0], levels)
        return cls(study, planes[0], levels, by, tolerance)

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Return a pair of `RefinedMap` and list of `Polyline`, and the tables of both."""
        modes, peaks = self._base(compute(self.study.histories))
        plane = Plane(DelegatedQuestion.of(self.plane.question, compute), self.plane.x, self.plane.y)
        lattice = AdaptiveGrid(plane, self.levels)
        points, cells = refined(lattice, modes, peaks)
        lines = outlines(lattice, cells, self.by, self.tolerance)
        tables = {"refined": _points(points, plane), "boundary": _vertices(lines, plane)}
        attributes = {"refine": self.levels, "boundary": self.by, "boundary_tolerance": self.tolerance}
        return AdaptiveResult((points, lines), tables, {**attributes, "polylines": len(lines)})

    def later(self, first: int) -> tuple[int, int]:
        """Return the usual range of the number of histories of later rounds.

        A line across the map crosses edges of the finest level. Every crossed edge is located and bisected to the
        tolerance.
        """
        edges = math.sqrt(first) * 2.0**self.levels
        histories = edges * (2.0 + max(0.0, -math.log2(self.tolerance * edges)))
        return int(_EDGES[0] * histories), int(_EDGES[1] * histories)

    def _base(self, results: Arrays) -> tuple[IntArray, FloatArray]:
        """Return modes and relative peaks of the map."""
        count = self.study.histories.count
        modes, peaks = np.empty(count, np.int64), np.empty(count)
        for first in range(0, count, PIECE):
            last = min(first + PIECE, count)
            piece = {name: values[first:last] for name, values in results.items()}
            sides = self.study.histories.rows(first, last).values
            modes[first:last] = modes_of(piece)
            peaks[first:last] = peak_ratio(piece["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        return modes, peaks


def _points(points: RefinedMap, plane: Plane) -> Table:
    columns = {
        plane.x.name: Column(points.x, plane.x.unit, plane.x.meaning, "x"),
        plane.y.name: Column(points.y, plane.y.unit, plane.y.meaning, "y"),
        "mode": Column.of("mode", points.modes),
        "peak_ratio": Column.of("peak_ratio", points.peak_ratio),
        "base": Column(points.base.astype(np.int64), "1", "1 for points of the map itself, 0 for new ones"),
    }
    return Table("point", prefixed("refined", columns))


def _vertices(lines: list[Polyline], plane: Plane) -> Table:
    x, y, mode = plane.x, plane.y, QUANTITIES["mode"]
    sizes = [len(line.points) for line in lines]
    points = np.concatenate([np.empty((0, 2)), *(line.points for line in lines)])
    modes = np.concatenate([np.empty((0, 2), np.int64), *(line.modes for line in lines)])
    closed = np.repeat(np.array([line.closed for line in lines], np.int64), sizes)
    regions = text_array([line.region for line in lines for _ in line.points])
    columns = {
        "line": Column(np.repeat(np.arange(len(lines)), sizes), "1", "number of the polyline"),
        "region": Column(regions, "1", "region inside"),
        "closed": Column(closed, "1", "1 if the polyline ends where it starts"),
        x.name: Column(points[:, 0], x.unit, x.meaning, "x"),
        y.name: Column(points[:, 1], y.unit, y.meaning, "y"),
        "mode_outside": Column(modes[:, 0], mode.unit, f"outside: {mode.meaning}"),
        "mode_inside": Column(modes[:, 1], mode.unit, f"inside: {mode.meaning}"),
    }
    return Table("vertex", prefixed("boundary", columns))
