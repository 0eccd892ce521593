"""What a campaign will take, before it is begun."""

import shutil
import time
from dataclasses import dataclass

import numpy as np

from rocking.dynamics.engine import RESULTS
from rocking.studies.campaign.chunks import Plan
from rocking.studies.campaign.errors import CampaignStorageError
from rocking.studies.campaign.status import Status
from rocking.studies.histories import Histories

_SAMPLE = 512
_BESIDE = 8192


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
    sample = np.unique(np.linspace(0, plan.count - 1, _SAMPLE, dtype=np.int64))
    start = time.perf_counter()
    for number in sample:
        histories.run(int(number), int(number) + 1, threads=1)
    left, chunks = status.histories - status.histories_done, status.chunks - status.chunks_done
    seconds = (time.perf_counter() - start) / sample.size * left
    needed = left * sum(np.dtype(kind).itemsize for kind in RESULTS.values()) + chunks * _BESIDE
    free = shutil.disk_usage(status.folder).free
    if free < needed:
        raise CampaignStorageError(
            f"{status.folder}: {needed / 1e6:.0f} MB are needed, {free / 1e6:.0f} MB are free; make room first"
        )
    return Forecast(left, chunks, seconds, needed, free)
