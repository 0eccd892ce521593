"""Boundary of overturning in the plane of two parameters, as polylines with bisected vertices."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.outcome import UNCOUNTED
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane, absent, merged, verdicts
from rocking.studies.axis import Axis
from rocking.studies.question import FAILED

Inside = Callable[[IntArray], BoolArray]

# number of bisections to neighbouring float64 numbers
_MOST_ROUNDS = 60


@dataclass(frozen=True, eq=False)
class Polyline:
    """A polyline of the boundary of a region."""

    # vertices x, y on edges of the grid, in units of the axes; the last vertex of a closed polyline is its first vertex
    points: FloatArray
    # modes outside and inside the region at the vertices: -2 no uplift, -1 no overturning, n >= 0 overturned after n
    # impacts
    modes: IntArray
    region: str  # region inside: ``overturned``, or ``overturned after n impacts``
    axes: tuple[str, str]  # names of the axes

    @property
    def closed(self) -> bool:
        """True if the last vertex is the first vertex."""
        return len(self.points) > 2 and bool((self.points[0] == self.points[-1]).all())


def boundary(  # noqa: PLR0913 - users set every one of them
    body: Body,
    motion: Motion,
    x: Axis | tuple[str, Any],
    y: Axis | tuple[str, Any],
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    by: str = "verdict",
    levels: int = 0,
    tolerance: float = 1e-10,
    gravity: float = conventions.g,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> list[Polyline]:
    """Return the boundary of overturning in the plane of two parameters.

    If the two ends of an edge of the grid have different outcomes, the boundary crosses this edge at one point, which
    bisection determines. Two crossings of one edge are not detected. Therefore, regions narrower than a cell may be
    missed, and a narrow strip without overturning between two modes may appear in pieces. In a cell with opposite
    overturned corners (a saddle), the centre is computed. If the centre overturns, the overturned corners are
    connected, otherwise they are separated.

    Parameters
    ----------
    body, motion, x, y, restitution
        As for `rocking.overturning_map`. Axes need at least two values, and the restitution must not be random.
    by : {"verdict", "mode"}
        Outline all overturning ("verdict"), or overturning by the number of impacts ("mode"). With "mode", the line
        between two modes appears twice.
    levels : int
        Number of refinements of the grid [-]. A refinement halves the spacing.
    tolerance : float
        Width of the last bracket along an edge, over the coordinate [-].
    gravity, progress, **options
        As for `rocking.overturning_map`.

    Returns
    -------
    list of Polyline
        The boundary; empty without overturning. Cells with a failed corner are omitted.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the axes do not fit the body, the motion or each other.

    Examples
    --------
    >>> import rocking as rk
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.half_sine(amplitude=3.0, period=0.6)
    >>> lines = boundary(block, pulse, ("frequency_ratio", [2.0, 3.0]), ("amplitude_ratio", [1.5, 3.0]), 0.9)
    >>> len(lines), lines[0].modes[0].tolist()
    (1, [-1, 0])
    """
    plane = Plane.of(body, motion, x, y, restitution, gravity=gravity, **options)
    tolerance = checked(plane, by, tolerance)
    grid = AdaptiveGrid(plane, levels, progress)
    # always refined by mode, because a narrow strip without overturning is between two modes before corners reach the
    # strip
    return outlines(grid, grid.finest(lambda modes: modes), by, tolerance)


def checked(plane: Plane, by: str, tolerance: float) -> float:
    """Check the options of a boundary. Return the relative width of the last brackets [-]."""
    if by not in {"verdict", "mode"}:
        raise InvalidValueError(parameter="by", allowed='"verdict" or "mode"', value=by)
    for axis in (plane.x, plane.y):
        if axis.values.size < 2:
            raise InvalidValueError(
                "{parameter} must have at least 2 values, since a boundary lies between two values, got 1",
                parameter=axis.name,
            )
    return checks.within("tolerance", tolerance, 1e-15, 0.1)


def outlines(grid: AdaptiveGrid, seeds: tuple[IntArray, IntArray], by: str, tolerance: float) -> list[Polyline]:
    """Return the boundary on a refined grid, exact to a relative width [-]."""
    if by == "verdict":
        return _outlined(grid, verdicts, "overturned", tolerance, seeds)
    polylines: list[Polyline] = []
    for n in np.unique(grid.modes[grid.modes >= 0]).tolist():
        region = "overturned" if n == UNCOUNTED else f"overturned after {n} impacts"
        polylines += _outlined(grid, partial(np.equal, n), region, tolerance, seeds)
    return polylines


def _outlined(
    grid: AdaptiveGrid, inside: Inside, region: str, tolerance: float, seeds: tuple[IntArray, IntArray]
) -> list[Polyline]:
    """Return the outline of a region. The search starts from seed cells."""
    i, j = _cells_passed(grid, inside, seeds)
    if not i.size:
        return []
    corners = inside(grid.corners(i, j, 1))
    centre = np.zeros(i.size, dtype=np.bool_)  # True if the centre of a saddle is inside
    saddle = crossed_edges(corners).all(axis=1)
    if saddle.any():
        ends = grid.coordinates(i[saddle], j[saddle]), grid.coordinates(i[saddle] + 1, j[saddle] + 1)
        x, y = (0.5 * (low + high) for low, high in zip(*ends, strict=True))
        centre[saddle] = inside(grid.plane.answers(x, y, progress=grid.progress)[0]["mode"])
    joined = segments(corners, edge_numbers(i, j, grid.columns), centre)
    numbers, names = np.unique(joined), (grid.plane.x.name, grid.plane.y.name)
    points, modes = bisected(grid, inside, numbers, tolerance)
    lines = [np.searchsorted(numbers, chain) for chain in chains(joined)]
    return [Polyline(points[vertices], modes[vertices], region, names) for vertices in lines]


def _cells_passed(grid: AdaptiveGrid, inside: Inside, seeds: tuple[IntArray, IntArray]) -> tuple[IntArray, IntArray]:
    """Return all finest cells on the boundary, including cells that the refinement does not reach."""
    i, j = seeds
    boundary_cells, visited = np.empty(0, np.int64), np.empty(0, np.int64)
    new = absent(j * grid.columns + i, visited)
    while new.size:
        i, j = new % grid.columns, new // grid.columns
        corners = grid.corners(i, j, 1)
        good = (corners != FAILED).all(axis=1)
        i, j, crossed = i[good], j[good], crossed_edges(inside(corners[good]))
        visited = merged(visited, new)
        passed = crossed.any(axis=1)
        i, j, crossed = i[passed], j[passed], crossed[passed]
        boundary_cells = merged(boundary_cells, j * grid.columns + i)
        cell, edge = np.nonzero(crossed)
        right, up = np.array([(0, -1), (1, 0), (0, 1), (-1, 0)]).T  # steps to the cells below, right, above, left
        i, j = i[cell] + right[edge], j[cell] + up[edge]
        within = (i >= 0) & (j >= 0) & (i < grid.columns - 1) & (j < grid.rows - 1)
        new = absent(j[within] * grid.columns + i[within], visited)
    return boundary_cells % grid.columns, boundary_cells // grid.columns


def bisected(grid: AdaptiveGrid, inside: Inside, numbers: IntArray, tolerance: float) -> tuple[FloatArray, IntArray]:
    """Return the crossings of the boundary of a region with edges of a grid, and the modes outside and inside."""
    # one batch per bisection
    upright = numbers % 2 == 1
    i, j = (numbers // 2) % grid.columns, (numbers // 2) // grid.columns
    ends = [(i, j), (i + ~upright, j + upright)]
    points = np.stack([np.stack(grid.coordinates(*end), axis=1) for end in ends], axis=1)
    modes = np.stack([grid.modes_at(*end) for end in ends], axis=1)
    swap = inside(modes[:, 0])  # the end outside is first, the end inside is second
    points[swap], modes[swap] = points[swap][:, ::-1], modes[swap][:, ::-1]
    along = np.where(upright, 1, 0)
    rows = np.arange(numbers.size)
    for _ in range(_MOST_ROUNDS):
        low, high = points[rows, 0, along[rows]], points[rows, 1, along[rows]]
        rows = rows[np.abs(high - low) > tolerance * np.maximum(np.abs(low), np.abs(high))]  # Eq. 184
        if not rows.size:
            break
        middle = points[rows].mean(axis=1)
        mode = grid.plane.answers(middle[:, 0], middle[:, 1], progress=grid.progress)[0]["mode"]
        side = inside(mode).astype(np.int64)
        points[rows, side], modes[rows, side] = middle, mode
    return points.mean(axis=1), modes


# edges of a cell by number: bottom, right, top, left; corners: lower left, lower right, upper right, upper left
_ENDS = ((0, 1), (1, 2), (3, 2), (0, 3))


def crossed_edges(inside: BoolArray) -> BoolArray:
    """Return True for edges of cells with one end inside and one outside."""
    return np.stack([inside[:, a] != inside[:, b] for a, b in _ENDS], axis=1)


def edge_numbers(i: IntArray, j: IntArray, columns: int) -> IntArray:
    """Return the indices of the edges of cells: twice the index of the left or lower end, plus 1 if vertical."""
    lowest = 2 * (j * columns + i)
    return np.stack([lowest, lowest + 3, lowest + 2 * columns, lowest + 1], axis=1)


def segments(inside: BoolArray, edges: IntArray, centre: BoolArray) -> IntArray:
    """Return the segments of a boundary in the cells, as indices of the crossed edges at both ends."""
    # in a saddle (opposite inside corners), the inside corners are connected if the centre is inside; otherwise the
    # outside corners are connected
    crossed = crossed_edges(inside)
    count = crossed.sum(axis=1)
    plain = edges[count == 2][crossed[count == 2]].reshape(-1, 2)
    saddle = count == 4
    around_right = (inside[saddle, 0] == centre[saddle])[:, None]
    bottom, right, top, left = edges[saddle].T
    first = np.where(around_right, np.stack([bottom, right], 1), np.stack([bottom, left], 1))
    second = np.where(around_right, np.stack([top, left], 1), np.stack([top, right], 1))
    return np.concatenate([plain, first, second])


def chains(joined: IntArray) -> list[list[int]]:
    """Return the polylines of segments, open polylines first. Closed polylines repeat the first edge at the end."""
    neighbours: dict[int, list[int]] = {}
    for a, b in joined.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    starts = [edge for edge, near in neighbours.items() if len(near) == 1]
    visited: set[int] = set()
    lines = [_chain_from(start, neighbours, visited) for start in (*starts, *neighbours) if start not in visited]
    return [chain for chain in lines if len(chain) > 1]


def _chain_from(start: int, neighbours: dict[int, list[int]], visited: set[int]) -> list[int]:
    chain, last = [start], start
    visited.add(start)
    while True:
        last = next((edge for edge in neighbours[last] if edge not in visited), last)
        if last in visited:
            break
        visited.add(last)
        chain.append(last)
    closed = len(chain) > 2 and start in neighbours[last]
    return [*chain, start] if closed else chain
