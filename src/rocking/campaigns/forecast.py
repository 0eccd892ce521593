"""Forecast of the time and disk space of a campaign."""

import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rocking.campaigns.chunks import Plan, width
from rocking.campaigns.disk import CampaignStorageError
from rocking.campaigns.identity import usual_chunk
from rocking.campaigns.status import NOISE, CampaignStatus, Estimate
from rocking.studies.histories import MOTIONS_AT_ONCE, Histories
from rocking.studies.motion_sets import MotionSet

if TYPE_CHECKING:
    from rocking.campaigns.jobs.job import Job

_BESIDE = 8192
_WARM = 4
_RUN = 2048
_SHARE = 0.1
_LONGEST = 2.0
_PLACES = 32
# memory of an adaptive study per history; memory of an idle worker [bytes]
_KEPT, _BASE = 100, 150_000_000


@dataclass(frozen=True)
class Forecast:
    """Remaining time and disk space of a campaign."""

    histories: int  # number of remaining histories
    chunks: int
    work: Estimate  # computing time on one core, from a sample of the histories
    needed: int  # required disk space [bytes]
    free: int


def forecast(status: CampaignStatus, plan: Plan, histories: Histories) -> Forecast:
    """Return the forecast from a sample of the histories; too little disk space is an error."""
    left, chunks = status.histories - status.histories_done, status.chunks - status.chunks_done
    work = trial(histories).at(1.0 / left) if left else Estimate(0.0, 0.0, 0.0)
    needed = left * width(histories.columns) + chunks * _BESIDE
    free = shutil.disk_usage(status.folder).free
    if free < needed:
        raise CampaignStorageError(
            "the campaign needs {needed:.0f} MB, but only {free:.0f} MB are free", needed=needed / 1e6, free=free / 1e6,
            hint="free disk space first",
        ).at(str(status.folder))  # fmt: skip
    return Forecast(left, chunks, work, needed, free)


@dataclass(frozen=True)
class JobForecast:
    """Forecast of a job; for an adaptive study, of its first round."""

    histories: int
    chunks: int
    chunk: int  # histories per chunk
    rate: float  # histories per second and core [1/s]
    seconds: float  # total time of the workers [s]
    between: tuple[float, float]  # probable bounds of the time [s]
    memory: int  # approximate memory of all workers and rounds [bytes]
    disk: int  # disk space of the results [bytes]
    free: int | None  # free disk space of a given folder [bytes]
    later: tuple[int, int] | None = None  # usual range of histories in later rounds of an adaptive study


def job_forecast(job: "Job", workers: int = 1, folder: Path | None = None) -> JobForecast:
    """Return the forecast of a job from two seconds of computation.

    Parameters
    ----------
    job : Job
        The job.
    workers : int
        Number of cores.
    folder : Path, optional
        Folder of the campaign; nothing is written there.

    Returns
    -------
    JobForecast
        Estimates.
    """
    histories, search = job.study.histories, job.study.search
    count = histories.count
    chunk = min(job.document.campaign.chunk or usual_chunk(histories), count)
    chunks = -(-count // chunk)
    size = width(histories.columns)
    cost, later = trial(histories), None if search is None else search.later(count)
    work = cost.at(workers / count)
    memory = workers * (_BASE + 4 * size * chunk + _bytes_of(job.problem.motions))
    if search is not None and later is not None:
        memory += _KEPT * (count + int(search.kept * later[1]))
    return JobForecast(
        count, chunks, chunk, 1.0 / cost.seconds, work.seconds, (work.low, work.high), memory,
        disk=size * count + 5000 * chunks,
        free=None if folder is None else _free(folder),
        later=later,
    )  # fmt: skip


def _bytes_of(motions: MotionSet) -> int:
    """Return the memory of the motions [bytes]."""
    if not motions.in_memory:
        return MOTIONS_AT_ONCE * 8 * 8192
    return 3 * 8 * int(sum(np.size(getattr(motions[k], "acceleration", 0)) for k in range(len(motions))))


def _free(folder: Path) -> int:
    path = folder.resolve()
    return shutil.disk_usage(next(parent for parent in (path, *path.parents) if parent.exists())).free


def trial(histories: Histories) -> Estimate:
    """Return the mean time of a history, from runs distributed over all histories.

    The generation of a motion is timed separately, and divided by its number of histories. The interval is twice the
    standard error.
    """
    count, synthetic = histories.count, not histories.motions.in_memory
    start = time.perf_counter()
    _timed(histories, 0, min(count, _WARM))  # this run includes the start-up: loading of motions and code
    middle = count // 2
    size = int(_SHARE / max(_timed(histories, middle, min(middle + _WARM, count)), 1e-9))
    size = max(1, min(size, _RUN, histories.together if synthetic else count, count))
    times: list[float] = []
    for trial_number in range(1, _PLACES + 1):
        first = int(_spread(trial_number) * (count - size + 1))
        first -= first % histories.together if synthetic else 0
        last = min(first + size, count)
        cost = _timed(histories, first, last)
        if synthetic:  # the first run generates the motions, the second run finds them in memory
            again = _timed(histories, first, last)
            used = np.unique(histories.rows(first, last).motion).size
            cost = again + max(0.0, cost - again) * (last - first) / used * min(1.0, len(histories.motions) / count)
        times.append(cost)
        if time.perf_counter() - start > _LONGEST or count == size:
            break
    best, number = float(np.mean(times)), len(times)
    doubt = 2.0 * float(np.std(times, ddof=1)) / number**0.5 if number > 1 else 0.5 * best
    return Estimate(best, max(0.0, (1.0 - NOISE) * best - doubt), (1.0 + NOISE) * best + doubt)


def _spread(number: int) -> float:
    """Return numbers that fill the interval from 0 to 1 evenly: 1/2, 1/4, 3/4, 1/8 ..."""
    return int(f"{number:b}"[::-1], 2) / 2.0 ** number.bit_length()


def _timed(histories: Histories, first: int, last: int) -> float:
    """Return the time per history of a run [s]."""
    start = time.perf_counter()
    histories.run(first, last, threads=1)
    return (time.perf_counter() - start) / (last - first)
