"""All accelerations at which the verdict changes, in order: stronger is not always worse."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.loss_of_contact import contact_words

Interval = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where a body under a motion of growing amplitude begins and ceases to overturn.

    Every stretch of amplitudes, overturning or surviving, that is wider than `resolution` has been sampled. Narrower
    ones have been looked for where the peak rotation comes close to the top, has a maximum, overturning takes
    longest, or the way of overturning changes; that is a search, not a proof. Under a record thinner stretches may lie
    anywhere: below the minimum it has been searched again and again, to `resolution_below`.

    Parameters
    ----------
    acceleration : ndarray
        Peak ground accelerations of the crossings, increasing [m/s2].
    ratio : ndarray
        The same over `uplift_acceleration` [-].
    scale : ndarray
        The same as factors on the motion [-].
    modes : ndarray of int, shape (n, 2)
        How the body ends just below and just above: -2 not lifted, -1 survived, n >= 0 overturned after n impacts.
    width : ndarray
        Widths of the brackets; the crossings are their middles [m/s2].
    lowest, highest : float
        Range that was searched [m/s2].
    uplift_acceleration : float
        Ground acceleration that lifts the body: g tan alpha, or g alpha in the linear equations [m/s2].
    resolution : float
        Relative spacing of the first samples [-].
    starts_overturned : bool
        Whether the lowest acceleration overturns already.
    samples, failed : int
        Histories that were computed, and those that have no result; a bracket stays wide where one failed.
    resolution_below : float
        Widest relative gap between samples below the minimum; NaN if there is no minimum [-].
    lost_contact : ndarray
        1 for histories in which the ground would have to pull, 0 for others, NaN for those that have no result [-].
    """

    acceleration: FloatArray
    ratio: FloatArray
    scale: FloatArray
    modes: IntArray
    width: FloatArray
    lowest: float
    highest: float
    uplift_acceleration: float
    resolution: float
    starts_overturned: bool
    samples: int
    failed: int
    resolution_below: float = math.nan
    lost_contact: FloatArray = field(default_factory=lambda: np.empty(0), repr=False)

    def __len__(self) -> int:
        """Return the number of crossings."""
        return int(self.acceleration.size)

    @property
    def contact(self) -> str:
        """In how many of the histories the ground would have to pull, as a sentence; empty if in none."""
        return contact_words(self.lost_contact)

    @property
    def minimum(self) -> float | None:
        """Least acceleration that overturns, of those sampled; under a record thinner stretches may lie below [m/s2].

        None if none in the range overturns, or its lowest does already.
        """
        return None if self.starts_overturned or not len(self) else float(self.acceleration[0])

    @property
    def certain(self) -> float | None:
        """Acceleration above which all that were sampled overturn; under a record thinner gaps may lie above [m/s2].

        None if the highest survives.
        """
        if not len(self):
            return self.lowest if self.starts_overturned else None
        return float(self.acceleration[-1]) if self.modes[-1, 1] >= 0 else None

    @property
    def safe_intervals(self) -> tuple[Interval, ...]:
        """Stretches of the range in which the body survives, the first up to the minimum [m/s2]."""
        return self._stretches(overturned=False)

    @property
    def overturning_intervals(self) -> tuple[Interval, ...]:
        """Stretches of the range in which the body overturns [m/s2]."""
        return self._stretches(overturned=True)

    def _stretches(self, *, overturned: bool) -> tuple[Interval, ...]:
        ends = [self.lowest, *self.acceleration.tolist(), self.highest]
        falls = [self.starts_overturned, *(self.modes[:, 1] >= 0).tolist()]
        pairs = pairwise(ends)
        return tuple(pair for pair, fall in zip(pairs, falls, strict=True) if fall == overturned)
