"""What a campaign will take, before it is begun."""

import shutil
import time
from dataclasses import dataclass

import numpy as np

from rocking.dynamics.engine import RESULTS
from rocking.studies.campaign.chunks import Plan
from rocking.studies.campaign.errors import CampaignStorageError
from rocking.studies.campaign.fingerprint import kind_of
from rocking.studies.campaign.status import Status
from rocking.studies.histories import Histories

_BESIDE = 8192
_WARM = 4
_RUN = 2048
_SHARE = 0.2
_LONGEST = 2.0
_ORDER = (0, 4, 2, 6, 1, 5, 3, 7)
"""Places of the runs: those that are done when time is up are spread, too."""


@dataclass(frozen=True)
class Forecast:
    """What a campaign will take.

    Parameters
    ----------
    histories, chunks : int
        How many remain.
    seconds : float
        Time of one core for them, from a sample spread over them [s].
    needed, free : int
        Room on the disk [bytes].
    """

    histories: int
    chunks: int
    seconds: float
    needed: int
    free: int


def forecast(status: Status, plan: Plan, histories: Histories) -> Forecast:
    """Compute a sample of the histories, and compare the room on the disk with what is needed.

    Parameters
    ----------
    status : Status
        How far the campaign is.
    plan : Plan
        How it is cut.
    histories : Histories
        What it computes.

    Returns
    -------
    Forecast
        For what remains.

    Raises
    ------
    CampaignStorageError
        If the disk is too small.
    """
    left, chunks = status.histories - status.histories_done, status.chunks - status.chunks_done
    seconds = left * _seconds_each(histories, quick=kind_of(plan.engine) == "fast" and histories.motions.in_memory)
    needed = left * sum(np.dtype(kind).itemsize for kind in RESULTS.values()) + chunks * _BESIDE
    free = shutil.disk_usage(status.folder).free
    if free < needed:
        raise CampaignStorageError(
            f"{status.folder}: {needed / 1e6:.0f} MB are needed, {free / 1e6:.0f} MB are free; make room first"
        )
    return Forecast(left, chunks, seconds, needed, free)


def _seconds_each(histories: Histories, *, quick: bool) -> float:
    """Return the time of a history in runs that are as long as those of a campaign, spread over all of them."""
    count = histories.count
    _timed(histories, 0, min(count, _WARM))  # motions are laid out, code is loaded
    size = min(count, _RUN)
    if not quick:
        middle = count // 2
        size = max(1, min(size, int(_SHARE / _timed(histories, middle, min(middle + _WARM, count)))))
    spent, done = 0.0, 0
    for first in dict.fromkeys(place * (count - size) // (len(_ORDER) - 1) for place in _ORDER):
        spent += _timed(histories, first, first + size) * size
        done += size
        if spent > _LONGEST:
            break
    return spent / done


def _timed(histories: Histories, first: int, last: int) -> float:
    """Return the time of a history in a run of some of them [s]."""
    start = time.perf_counter()
    histories.run(first, last, threads=1)
    return (time.perf_counter() - start) / (last - first)
