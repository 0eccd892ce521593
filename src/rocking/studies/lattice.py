"""A lattice between the values of two axes, ever finer, computed only where the mode changes."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.studies.axis import Axis
from rocking.studies.plane import Plane

MOST_LEVELS = 12
"""A spacing 4096 times finer: a boundary is better bisected than refined beyond it."""

Label = Callable[[IntArray], Any]


class Lattice:
    """Points between the values of two axes, numbered in steps of the finest level, and what is known of them.

    Parameters
    ----------
    plane : Plane
        The question and its axes.
    levels : int
        Levels of refinement; each halves the spacing.
    progress : callable, optional
        Called with the number of histories done since the last call.

    Raises
    ------
    InvalidValueError
        If the levels are not within [0, 12], or the restitution is drawn at random.
    """

    def __init__(self, plane: Plane, levels: int, progress: Callable[[int], None] | None = None) -> None:
        given: object = levels
        if isinstance(given, bool) or not isinstance(given, int) or not 0 <= given <= MOST_LEVELS:
            raise InvalidValueError(f"levels of refinement must be a whole number in [0, {MOST_LEVELS}], got {levels}")
        if plane.question.law.kind == 2:
            raise InvalidValueError("a restitution drawn at random has no boundary to refine; sample it instead")
        self.plane, self.levels, self.progress = plane, levels, progress
        self.step = 1 << levels
        self.columns = (plane.x.values.size - 1) * self.step + 1
        self.rows = (plane.y.values.size - 1) * self.step + 1
        self.keys: IntArray = np.empty(0, np.int64)
        self.modes: IntArray = np.empty(0, np.int64)
        self.peaks: FloatArray = np.empty(0)

    def coordinates(self, i: IntArray, j: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of lattice points; those of the axes' own values to the last bit.

        Parameters
        ----------
        i, j : ndarray of int
            Column and row.

        Returns
        -------
        x, y : ndarray
            In the units of the axes.
        """
        return self._between(self.plane.x, i), self._between(self.plane.y, j)

    def _between(self, axis: Axis, places: IntArray) -> FloatArray:
        whole, part = places >> self.levels, (places & (self.step - 1)) / self.step
        above = np.minimum(whole + 1, axis.values.size - 1)
        return np.asarray(axis.values[whole] + part * (axis.values[above] - axis.values[whole]))

    def base(self) -> tuple[IntArray, IntArray]:
        """Return the columns and rows of the axes' own values, those of x varying fastest.

        Returns
        -------
        i, j : ndarray of int
            One entry a point.
        """
        i, j = np.meshgrid(np.arange(0, self.columns, self.step), np.arange(0, self.rows, self.step))
        return i.ravel(), j.ravel()

    def compute(self, i: IntArray, j: IntArray) -> None:
        """Compute those of some points that are not known, in one batch.

        Parameters
        ----------
        i, j : ndarray of int
            Columns and rows.
        """
        new = np.setdiff1d(j * self.columns + i, self.keys)
        if not new.size:
            return
        found, _ = self.plane.answers(
            *self.coordinates(new % self.columns, new // self.columns), progress=self.progress
        )
        self.learn(new, found["mode"], found["peak_ratio"])

    def learn(self, keys: IntArray, modes: IntArray, peaks: FloatArray) -> None:
        """Take in what is known of new points.

        Parameters
        ----------
        keys : ndarray of int
            Their numbers: row times the number of columns, plus column.
        modes : ndarray of int
            Their modes.
        peaks : ndarray
            Their relative peaks [-].
        """
        keys, modes = np.concatenate([self.keys, keys]), np.concatenate([self.modes, modes])
        peaks = np.concatenate([self.peaks, peaks])
        order = np.argsort(keys, kind="stable")
        self.keys, self.modes, self.peaks = keys[order], modes[order], peaks[order]

    def modes_at(self, i: IntArray, j: IntArray) -> IntArray:
        """Return the modes of points, computing those that are not known.

        Parameters
        ----------
        i, j : ndarray of int
            Columns and rows, of any shape.

        Returns
        -------
        ndarray of int
            Modes, of the same shape.
        """
        self.compute(i.ravel(), j.ravel())
        return np.asarray(self.modes[np.searchsorted(self.keys, j * self.columns + i)])

    def corners(self, i: IntArray, j: IntArray, step: int) -> IntArray:
        """Return the modes at the corners of cells.

        Parameters
        ----------
        i, j : ndarray of int
            Columns and rows of the lower left corners.
        step : int
            Size of the cells.

        Returns
        -------
        ndarray of int, shape (cells, 4)
            Lower left, lower right, upper right, upper left.
        """
        across, up = np.array([0, step, step, 0]), np.array([0, 0, step, step])
        return self.modes_at(i[:, None] + across, j[:, None] + up)

    def finest(self, label: Label) -> tuple[IntArray, IntArray]:
        """Subdivide cells whose corners differ, level by level, and return those of the last level that differ.

        Parameters
        ----------
        label : callable
            What of the modes counts as different.

        Returns
        -------
        i, j : ndarray of int
            Columns and rows of the lower left corners.
        """
        self.compute(*self.base())
        cells = np.meshgrid(np.arange(0, self.columns - 1, self.step), np.arange(0, self.rows - 1, self.step))
        i, j = cells[0].ravel(), cells[1].ravel()
        for level in range(self.levels + 1):
            step = self.step >> level
            mixed = differing(label(self.corners(i, j, step)))
            i, j = i[mixed], j[mixed]
            if level < self.levels:
                half = step // 2
                i = (i[:, None] + np.array([0, half, 0, half])).ravel()
                j = (j[:, None] + np.array([0, 0, half, half])).ravel()
        return i, j


def differing(labels: Any) -> BoolArray:
    """Return which cells have corners that differ.

    Parameters
    ----------
    labels : ndarray, shape (cells, 4)
        Labels of the corners.

    Returns
    -------
    ndarray of bool
        One entry a cell.
    """
    return np.asarray(np.any(labels != labels[:, :1], axis=1))


def verdicts(modes: IntArray) -> BoolArray:
    """Return whether modes are of overturning.

    Parameters
    ----------
    modes : ndarray of int
        Modes.

    Returns
    -------
    ndarray of bool
        True for n >= 0; failed ones are False, and for the caller to set aside.

    Examples
    --------
    >>> verdicts(np.array([-3, -2, -1, 0, 2])).tolist()
    [False, False, False, True, True]
    """
    return np.asarray(modes >= 0)
