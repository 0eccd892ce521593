"""The histories of an overturning map, made piece by piece from its axes: a map of any size needs no memory."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane.batch import Rows
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.studies.adaptive_grid import Plane
from rocking.studies.histories import Histories, hash_of
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import sides_of

_TIMES = ("peak_time", "overturning_time", "first_uplift")
_PROBES = 1024


@dataclass(frozen=True, eq=False)
class MapHistories(Histories):
    """Every restitution over the plane of two axes; the restitution changes slowest, x fastest.

    The engine runs with the motion as it is, and bodies that are quicker instead of a motion that is slower; `rescaled`
    turns the times of the results into those of the map.
    """

    planes: tuple[Plane, ...]  # the same axes, each with another restitution

    @classmethod
    def of(cls, planes: list[Plane]) -> "MapHistories":
        """Return the histories of a map."""
        question = planes[0].question
        made = cls(
            MotionList([question.motion]), tuple(planes),
            law=question.law, settings=question.settings, engine=question.engine,
        )  # fmt: skip
        for number, plane in enumerate(planes):
            # a map none of whose bodies can be made is refused as a whole; single cells of others are not
            plane.case(*made._points(made._probes(number)))
        return made

    @property
    def cells(self) -> int:
        """Number of points of the plane."""
        return int(self.planes[0].x.values.size * self.planes[0].y.values.size)

    @property
    def count(self) -> int:
        """Number of histories."""
        return self.cells * len(self.planes)

    def rows(self, first: int, last: int) -> Rows:
        """Return some of the rows, as the engine takes them.

        Returns the rows; NaN where there is no such body.
        """
        numbers = np.arange(first, last, dtype=np.int64)
        values, stretch = self._values(numbers)
        quick = {n: v * stretch if n in {"p_right", "p_left"} else v for n, v in values.items()}
        return Rows.of(last - first, 0, numbers, **quick)

    def rescaled(self, first: int, last: int, results: Arrays) -> Arrays:
        """Return results in the times of the map.

        Returns times [s] and velocities [rad/s] of the stretched motions.
        """
        _, stretch = self._values(np.arange(first, last, dtype=np.int64))
        found = {name: results[name] * stretch for name in _TIMES}
        return {**results, **found, "peak_velocity": results["peak_velocity"] / stretch}

    def content(self) -> dict[str, Any]:
        """Return axes, body, restitution, and the hash of rows spread over the map."""
        plane = self.planes[0]
        probes = [self._values(self._probes(k)) for k in range(len(self.planes))]
        tables = [np.stack([*(values[n] for n in sorted(values)), stretch]) for values, stretch in probes]
        return {
            "x": {"axis": plane.x.name, "values": hash_of(plane.x.values)},
            "y": {"axis": plane.y.name, "values": hash_of(plane.y.values)},
            "restitution": [each.question.parameters.label for each in self.planes],
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
        """Return what the engine is told of histories, and how their motion is stretched."""
        pieces = [self._of_plane(plane, numbers[numbers // self.cells == k]) for k, plane in enumerate(self.planes)]
        names = pieces[0][0]
        values = {name: np.concatenate([found[name] for found, _ in pieces]) for name in names}
        return values, np.concatenate([stretch for _, stretch in pieces])

    def _of_plane(self, plane: Plane, numbers: np.ndarray) -> tuple[dict[str, FloatArray], FloatArray]:
        if not numbers.size:
            sides = {name: values[:0] for name, values in sides_of([None]).items()}
            return {**sides, "scale": np.empty(0)}, np.empty(0)
        try:
            case = plane.case(*self._points(numbers))
        except InvalidValueError:  # none of these bodies can be made
            sides = {name: np.full(numbers.size, np.nan) for name in sides_of([None])}
            return {**sides, "scale": np.ones(numbers.size)}, np.ones(numbers.size)
        return case.values, case.stretch
