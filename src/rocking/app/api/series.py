"""Curves with fewer samples: every dot of a picture keeps its extremes."""

from collections.abc import Sequence

import numpy as np

from rocking.conventions import FloatArray, IntArray


def thinned(
    time: FloatArray, curves: Sequence[FloatArray], points: int, window: tuple[float, float] | None = None
) -> IntArray:
    """Return which samples of some curves to keep, so that a picture of them loses nothing that can be seen.

    The time that is shown is divided into equal runs, one for each dot of the picture. Of each run its first and its
    last sample and the lowest and the highest of every curve are kept, and one where a curve has no number: what is
    drawn covers the same dots as all samples would (Jugel et al. 2014, Proc. VLDB 7:797), whatever happens within one.

    Returns increasing indices; all in the window where it has no more than two samples for each run.
    """
    first, last = (time[0], time[-1]) if window is None else window
    begin, end = np.searchsorted(time, first, side="right") - 1, np.searchsorted(time, last) + 1
    inside = np.arange(max(begin, 0), min(end, time.size))
    if inside.size <= 2 * points:
        return inside
    run = np.clip((time[inside] - first) / (last - first) * points, -1, points).astype(np.int64)
    ends = np.flatnonzero(np.diff(run))
    kept = [inside[[0, -1]], inside[ends], inside[ends + 1]]
    for curve in curves:
        known = np.isfinite(curve[inside])
        kept += [_ends_of_runs(curve, inside[rows], run[rows]) for rows in (known, ~known)]
    return np.unique(np.concatenate(kept))


def _ends_of_runs(curve: FloatArray, rows: IntArray, run: IntArray) -> IntArray:
    """Return the rows of the lowest and the highest value in every run."""
    order = np.lexsort((curve[rows], run))
    starts = np.flatnonzero(np.diff(run[order], prepend=-2, append=-2)[:-1])
    last = np.append(starts[1:], order.size)[: starts.size] - 1
    return np.asarray(rows[order[np.concatenate([starts, last])]])
