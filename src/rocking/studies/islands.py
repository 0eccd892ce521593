"""Safe islands: regions of a map without overturning, which are surrounded by overturning or above overturning."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.studies._overturning_map import MapArrays
from rocking.studies.question import FAILED, UNLIFTED

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Island:
    """A connected region without overturning that contains no point without uplift."""

    label: int  # number of the island in `Islands.labels`, from 1
    cells: int  # number of points of the map in the island
    area: float  # area in the units of the axes; a point covers half the distance to its neighbours
    x: tuple[float, float]  # x, y: smallest and largest coordinates
    y: tuple[float, float]
    # True if overturning surrounds the island; otherwise the island reaches the edge of the map or a failed point
    enclosed: bool
    # modes of overturning around the island; between two modes, a strip that is too thin for the grid may continue
    modes: tuple[int, ...]
    still_rocking: (
        int  # number of points with rocking at the end of the computation, where later overturning is possible
    )

    @property
    def is_between_modes(self) -> bool:
        """True if the island is between two modes of overturning."""
        return self.enclosed and len(self.modes) > 1


@dataclass(frozen=True, eq=False)
class Islands:
    """All safe islands of a map."""

    labels: IntArray  # number of the island at every point of the map; 0 outside islands
    islands: tuple[Island, ...]  # the largest first
    axes: tuple[str, str]  # names of the axes, x and y

    definition = "A safe island is a region of cells that do not overturn, surrounded by overturning within the map."

    @property
    def sentences(self) -> tuple[str, ...]:
        """Number of islands, definition, and undecided points as sentences."""
        if not self.islands:
            return (Message.joined(["No safe islands.", self.definition]),)
        cells = sum(island.cells for island in self.islands)
        facts = {"count": len(self.islands), "cells": cells, "total": self.labels.size}
        messages = [
            Message.joined([Message("Safe islands: {count}, with {cells} of {total} cells.", facts), self.definition])
        ]
        still = sum(island.still_rocking for island in self.islands)
        if still:
            messages.append(
                Message(
                    "Cells still rocking at the end of the computation: {still} of {cells}; later overturning "
                    "is possible.",
                    {"still": still, "cells": cells},
                )
            )
        between = sum(island.is_between_modes for island in self.islands)
        if between:
            messages.append(
                Message(
                    "Islands between two modes of overturning: {between} of {count}; on a finer map they may "
                    "be parts of one strip.",
                    {"between": between, "count": len(self.islands)},
                )
            )
        return tuple(messages)

    def __len__(self) -> int:
        return len(self.islands)

    def __getitem__(self, index: int) -> Island:
        return self.islands[index]


def safe_islands(overturning: "xr.Dataset | MapArrays", *, enclosed: bool = True) -> Islands:
    """Return the regions without overturning that are not connected to the region without uplift.

    Diagonal points are neighbours, so that the grid does not divide an inclined strip.

    Parameters
    ----------
    overturning : xarray.Dataset
        Result of `overturning_map`.
    enclosed : bool
        If True, return only regions that overturning surrounds within the map. A strip without overturning separates
        two modes of overturning. If the strip is thinner than the grid, the grid divides it
        (`Island.is_between_modes`).

    Returns
    -------
    Islands
        The islands, the largest first.

    Raises
    ------
    InvalidValueError
        If the dataset is not a map.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> from rocking.studies._overturning_map import overturning_map
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> x, y = ("frequency_ratio", np.linspace(2.5, 4.0, 7)), ("amplitude_ratio", np.linspace(0.5, 10.0, 39))
    >>> overturning = overturning_map(block, pulse, x, y, 0.85)
    >>> len(safe_islands(overturning, enclosed=False)), len(safe_islands(overturning))
    (1, 0)
    """
    modes, x, y, axes = _read(overturning)
    still = np.nan_to_num(np.asarray(overturning["still_rocking"], np.float64)) if _has(overturning) else 0.0 * modes
    labels = connected((modes < 0) & (modes != FAILED))
    apart = np.arange(labels.max(initial=0) + 1) > 0
    apart[labels[modes == UNLIFTED]] = False
    near = _grown(modes == FAILED, outside=True)  # points on the edge of the map, or next to a failed point
    areas = np.outer(_lengths(y), _lengths(x))
    islands = []
    for label in np.flatnonzero(apart).tolist():
        mask = labels == label
        rows, columns = np.nonzero(mask)
        free = not bool(near[mask].any())  # all neighbours overturn in this case
        if free or not enclosed:
            ring = np.unique(modes[_grown(mask) & ~mask])
            spans = (float(x[columns.min()]), float(x[columns.max()])), (float(y[rows.min()]), float(y[rows.max()]))
            around, going = tuple(ring[ring >= 0].tolist()), int(still[mask].sum())
            islands.append(Island(label, rows.size, float(areas[mask].sum()), *spans, free, around, going))
    islands.sort(key=lambda island: (-island.area, island.label))
    numbers = np.zeros(apart.size, dtype=np.int64)
    numbers[[island.label for island in islands]] = np.arange(1, len(islands) + 1)
    return Islands(numbers[labels], tuple(replace(island, label=k) for k, island in enumerate(islands, 1)), axes)


def connected(survived: BoolArray) -> IntArray:
    """Return the region number of every point: from 1 in row order, 0 outside. Diagonal points are connected."""
    # equal to `scipy.ndimage.label`, whose import takes as long as a map of 6 by 6 points
    steps = np.diff(survived.astype(np.int8), axis=1, prepend=0, append=0)
    row, first = np.nonzero(steps == 1)  # runs of survival along the rows
    last = np.nonzero(steps == -1)[1] - 1
    root = list(range(row.size))

    def end(run: int) -> int:
        while root[run] != run:
            root[run] = run = root[root[run]]
        return run

    width = survived.shape[1] + 1  # runs of the previous row that touch have ends within one column
    offsets = row * width
    low = np.searchsorted(offsets + last, offsets - width + first - 1)
    high = np.searchsorted(offsets + first, offsets - width + last + 1, side="right")
    for run, (start, stop) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
        for other in range(start, stop):
            smaller, larger = sorted((end(run), end(other)))
            root[larger] = smaller
    _, number = np.unique([end(run) for run in range(row.size)], return_inverse=True)
    labels = np.zeros(survived.shape, dtype=np.int64)
    labels[survived] = np.repeat(number + 1, last - first + 1)
    return labels


def _grown(mask: BoolArray, *, outside: bool = False) -> BoolArray:
    """Return the points of a mask and all their neighbours, including diagonal ones."""
    padded = np.pad(mask, 1, constant_values=outside)
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).any(axis=(2, 3)))


def safe_beyond_overturning(overturning: "xr.Dataset", along: str | None = None) -> "xr.DataArray":
    """Return the points without overturning for which a smaller value on one axis has overturning.

    Parameters
    ----------
    overturning : xarray.Dataset
        Result of `overturning_map`.
    along : str, optional
        Name of the axis; default: y.

    Returns
    -------
    xarray.DataArray
        True for points without overturning that are above overturning.

    Raises
    ------
    InvalidValueError
        If the dataset is not a map, or does not have this axis.
    """
    modes, _, _, axes = _read(overturning)
    along = axes[1] if along is None else checks.one_of("along", along, axes)
    fallen = np.maximum.accumulate(modes >= 0, axis=1 if along == axes[0] else 0)
    beyond: xr.DataArray = overturning["mode"].copy(data=fallen & (modes < 0) & (modes != FAILED))
    return beyond.rename("safe_beyond_overturning").assign_attrs(
        units="1", long_name=f"survives beyond overturning along {along}"
    )


def _has(overturning: Any) -> bool:
    """Return True if a map contains `still_rocking`."""
    return "still_rocking" in (overturning.variables if isinstance(overturning, MapArrays) else overturning)


def _read(overturning: Any) -> tuple[IntArray, FloatArray, FloatArray, tuple[str, str]]:
    if isinstance(overturning, MapArrays):
        first, second = overturning.axes
        return overturning["mode"], first.values, second.values, (first.name, second.name)
    mode = overturning["mode"] if hasattr(overturning, "data_vars") and "mode" in overturning else None
    if mode is None or mode.ndim != 2:
        raise InvalidValueError(
            "a map is a dataset with a mode over two axes, got {kind}", kind=type(overturning).__name__
        )
    along_y, along_x = (str(name) for name in mode.dims)
    x, y = (np.asarray(overturning[name].values) for name in (along_x, along_y))
    return np.asarray(mode.values), x, y, (along_x, along_y)


def _lengths(values: FloatArray) -> FloatArray:
    """Return the lengths that the values cover."""
    middles = 0.5 * (values[1:] + values[:-1])
    return np.diff(np.concatenate([values[:1], middles, values[-1:]]))
