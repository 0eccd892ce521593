"""Curves with fewer samples: what is drawn keeps every extreme."""

from collections.abc import Sequence

import numpy as np

from rocking.conventions import FloatArray, IntArray


def thinned(curves: Sequence[FloatArray], points: int) -> IntArray:
    """Return which samples of some curves to keep, so that a picture of them loses nothing that can be seen.

    The samples are divided into equal runs, and of each run the lowest and the highest sample of every curve are
    kept. So every curve keeps its extremes, and between two kept samples it leaves the straight line by no more than
    it changes within two neighbouring runs, which are together 4 n / (points - 2) samples long for each curve.

    Parameters
    ----------
    curves : sequence of ndarray, shape (n,)
        Values at the same instants, finite.
    points : int
        How many samples to keep at most; at least 2 and 2 for each curve.

    Returns
    -------
    ndarray
        Increasing indices, the first and the last sample among them.
    """
    count = curves[0].size
    if count <= points:
        return np.arange(count)
    length = -(-count // max(1, (points - 2) // (2 * len(curves))))
    starts = np.arange(0, count, length)
    kept = [np.array([0, count - 1])]
    for curve in curves:
        rows = np.pad(curve, (0, starts.size * length - count), mode="edge").reshape(starts.size, length)
        kept += [np.minimum(starts + place, count - 1) for place in (rows.argmin(axis=1), rows.argmax(axis=1))]
    return np.unique(np.concatenate(kept))


def merged(time: FloatArray, instants: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return some times with further instants among them.

    Parameters
    ----------
    time : ndarray
        Increasing times [s].
    instants : ndarray
        Further times, of which those after the last one are left out [s].

    Returns
    -------
    time : ndarray
        Increasing, each once [s].
    added : ndarray
        Where the further instants are in it.
    """
    inside = np.unique(instants[(instants >= time[0]) & (instants <= time[-1])])
    whole = np.union1d(time, inside)
    return whole, np.searchsorted(whole, inside)
