"""What a campaign will take, before it is begun."""

import shutil
import time
from dataclasses import dataclass

import numpy as np

from rocking.campaigns.chunks import Plan
from rocking.campaigns.disk import CampaignStorageError
from rocking.campaigns.status import NOISE, CampaignStatus, Estimate
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.studies.histories import Histories

BYTES = sum(np.dtype(kind).itemsize for kind in RESULTS.values())
"""Results of one history [bytes]."""

_BESIDE = 8192
_WARM = 4
_RUN = 2048
_SHARE = 0.1
_LONGEST = 2.0
_PLACES = 32


@dataclass(frozen=True)
class Forecast:
    """What a campaign will take."""

    histories: int  # how many remain
    chunks: int
    work: Estimate  # time of one core for them, from a sample spread over them
    needed: int  # room on the disk [bytes]
    free: int


def forecast(status: CampaignStatus, plan: Plan, histories: Histories) -> Forecast:
    """Compute a sample of the histories, and compare the room on the disk with what is needed."""
    left, chunks = status.histories - status.histories_done, status.chunks - status.chunks_done
    work = trial(histories).at(1.0 / left) if left else Estimate(0.0, 0.0, 0.0)
    needed = left * BYTES + chunks * _BESIDE
    free = shutil.disk_usage(status.folder).free
    if free < needed:
        raise CampaignStorageError(
            f"{status.folder}: {needed / 1e6:.0f} MB are needed, {free / 1e6:.0f} MB are free; make room first"
        )
    return Forecast(left, chunks, work, needed, free)


def trial(histories: Histories) -> Estimate:
    """Return what a history takes, from runs that are spread over all of them.

    A motion that has to be made is timed apart, and shared among all histories that it is for.

    Returns the mean of all histories, with twice its standard error.
    """
    count, made = histories.count, not histories.motions.in_memory
    start = time.perf_counter()
    _timed(histories, 0, min(count, _WARM))  # motions are laid out, code is loaded
    middle = count // 2
    size = int(_SHARE / max(_timed(histories, middle, min(middle + _WARM, count)), 1e-9))
    size = max(1, min(size, _RUN, histories.together if made else count, count))
    times: list[float] = []
    for place in range(1, _PLACES + 1):
        first = int(_spread(place) * (count - size + 1))
        first -= first % histories.together if made else 0
        last = min(first + size, count)
        each = _timed(histories, first, last)
        if made:  # the second time they are there
            again = _timed(histories, first, last)
            used = np.unique(histories.rows(first, last).motion).size
            each = again + max(0.0, each - again) * (last - first) / used * min(1.0, len(histories.motions) / count)
        times.append(each)
        if time.perf_counter() - start > _LONGEST or count == size:
            break
    best, number = float(np.mean(times)), len(times)
    doubt = 2.0 * float(np.std(times, ddof=1)) / number**0.5 if number > 1 else 0.5 * best
    return Estimate(best, max(0.0, (1.0 - NOISE) * best - doubt), (1.0 + NOISE) * best + doubt)


def _spread(place: int) -> float:
    """Return numbers that fill the space from nought to one evenly, however many are taken: 1/2, 1/4, 3/4, 1/8 ..."""
    return int(f"{place:b}"[::-1], 2) / 2.0 ** place.bit_length()


def _timed(histories: Histories, first: int, last: int) -> float:
    """Return the time of a history in a run of some of them [s]."""
    start = time.perf_counter()
    histories.run(first, last, threads=1)
    return (time.perf_counter() - start) / (last - first)
