"""Overturning maps refined along their boundaries, with the boundaries as polylines, as campaigns in rounds."""

from dataclasses import dataclass

import numpy as np

from rocking.campaigns.jobs.answer import AdaptiveResult
from rocking.campaigns.jobs.asked import AskedQuestion, Compute
from rocking.campaigns.jobs.study import Study
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.quantities import QUANTITIES
from rocking.spec.document import MapTable
from rocking.spec.reading import located
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane, RefinedMap, refine
from rocking.studies.boundaries import Polyline, checked, outlines
from rocking.studies.question import modes_of, peak_ratio
from rocking.tables import PIECE, Column, Table, text_array

MOST_POINTS = 10_000_000
"""Points of a map that is refined: they take less than 2 GiB of memory."""


@dataclass(frozen=True)
class MapSearch:
    """A refined map that somebody else computes, round by round: the map, its levels, the bisections of its edges."""

    study: Study  # the map before refinement: the first round
    plane: Plane  # the question and its axes
    levels: int  # levels of refinement
    by: str  # what is outlined
    tolerance: float  # width of the last brackets over the coordinate [-]

    @classmethod
    def of(cls, study: Study, planes: list[Plane], table: MapTable) -> "MapSearch":
        """Return the search that a job asks for, checked."""
        assert table.refine is not None  # asked before
        if len(planes) > 1:
            raise InvalidValueError(
                "map.refine is for one restitution: each has boundaries of its own; make a job of each"
            )
        points = planes[0].x.values.size * planes[0].y.values.size
        if points > MOST_POINTS:
            raise InvalidValueError(
                f"map.refine is for maps of up to {MOST_POINTS} points, which are in memory together, got {points}; "
                "take fewer points, and one level more: it halves the spacing"
            )
        with located("map.refine"):
            tolerance = checked(planes[0], table.boundary, table.tolerance)
            AdaptiveGrid(planes[0], table.refine)
        return cls(study, planes[0], table.refine, table.boundary, tolerance)

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Return the points and the polylines.

        Returns A pair of `RefinedMap` and a list of `Polyline`, and tables of them.
        """
        modes, peaks = self._base(compute(self.study.histories))
        plane = Plane(AskedQuestion.of(self.plane.question, compute), self.plane.x, self.plane.y)
        lattice = AdaptiveGrid(plane, self.levels)
        points, cells = refine(lattice, modes, peaks)
        lines = outlines(lattice, cells, self.by, self.tolerance)
        tables = {"refined": _points(points, plane), "boundary": _vertices(lines, plane)}
        told = {"refine": self.levels, "boundary": self.by, "boundary_tolerance": self.tolerance}
        return AdaptiveResult((points, lines), tables, {**told, "polylines": len(lines)})

    def _base(self, found: Arrays) -> tuple[IntArray, FloatArray]:
        """Return modes and relative peaks of the map."""
        count = self.study.histories.count
        modes, peaks = np.empty(count, np.int64), np.empty(count)
        for first in range(0, count, PIECE):
            last = min(first + PIECE, count)
            piece = {name: values[first:last] for name, values in found.items()}
            sides = self.study.histories.rows(first, last).values
            modes[first:last] = modes_of(piece)
            peaks[first:last] = peak_ratio(piece["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        return modes, peaks


def _points(points: RefinedMap, plane: Plane) -> Table:
    x, y = plane.x, plane.y
    mode, ratio = QUANTITIES["mode"], QUANTITIES["peak_ratio"]
    columns = {
        x.name: Column(points.x, x.unit, x.words, "refined_x"),
        y.name: Column(points.y, y.unit, y.words, "refined_y"),
        "mode": Column(points.modes, mode.unit, mode.meaning, "refined_mode"),
        "peak_ratio": Column(points.peak_ratio, ratio.unit, ratio.meaning, "refined_peak_ratio"),
        "base": Column(
            points.base.astype(np.int64), "1", "1 for points of the map itself, 0 for new ones", "refined_base"
        ),
    }
    return Table("point", columns)


def _vertices(lines: list[Polyline], plane: Plane) -> Table:
    x, y = plane.x, plane.y
    sizes = [len(line.points) for line in lines]
    points = np.concatenate([np.empty((0, 2)), *(line.points for line in lines)])
    modes = np.concatenate([np.empty((0, 2), np.int64), *(line.modes for line in lines)])
    number = np.repeat(np.arange(len(lines)), sizes)
    closed = np.repeat(np.array([line.closed for line in lines], np.int64), sizes)
    regions = text_array([line.region for line in lines for _ in line.points])
    unit, meaning = QUANTITIES["mode"].unit, QUANTITIES["mode"].meaning
    columns = {
        "line": Column(number, "1", "number of the polyline", "boundary_line"),
        "region": Column(regions, "1", "what lies inside", "boundary_region"),
        "closed": Column(closed, "1", "1 if the polyline ends where it starts", "boundary_closed"),
        x.name: Column(points[:, 0], x.unit, x.words, "boundary_x"),
        y.name: Column(points[:, 1], y.unit, y.words, "boundary_y"),
        "mode_outside": Column(modes[:, 0], unit, f"outside: {meaning}", "boundary_mode_outside"),
        "mode_inside": Column(modes[:, 1], unit, f"inside: {meaning}", "boundary_mode_inside"),
    }
    return Table("vertex", columns)
