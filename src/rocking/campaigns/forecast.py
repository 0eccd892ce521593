"""What a campaign will take, before it is begun."""

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
# what an adaptive study keeps of a history, with what it takes for a moment; memory of a worker without work [bytes]
_KEPT, _BASE = 100, 150_000_000


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
    needed = left * width(histories.columns) + chunks * _BESIDE
    free = shutil.disk_usage(status.folder).free
    if free < needed:
        raise CampaignStorageError(
            "{needed:.0f} MB are needed, {free:.0f} MB are free", needed=needed / 1e6, free=free / 1e6,
            hint="make room first",
        ).at(str(status.folder))  # fmt: skip
    return Forecast(left, chunks, work, needed, free)


@dataclass(frozen=True)
class JobForecast:
    """What a job will take, an adaptive study in its first round."""

    histories: int
    chunks: int
    chunk: int  # histories in each
    rate: float  # histories of one core in a second [1/s]
    seconds: float  # time of the workers for all of them [s]
    between: tuple[float, float]  # bounds between which it probably is [s]
    memory: int  # of all workers together, of an adaptive study with all that its rounds keep, roughly [bytes]
    disk: int  # room for the results [bytes]
    free: int | None  # room that there is, where a folder is given [bytes]
    later: tuple[int, int] | None = None  # of an adaptive study, how many histories later rounds usually have


def job_forecast(job: "Job", workers: int = 1, folder: Path | None = None) -> JobForecast:
    """Return what a job will take, from histories that are computed for two seconds.

    Parameters
    ----------
    job : Job
        The job.
    workers : int
        How many cores.
    folder : Path, optional
        Where it is to be kept; nothing is written there.

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
    each, later = trial(histories), None if search is None else search.later(count)
    work = each.at(workers / count)
    memory = workers * (_BASE + 4 * size * chunk + _bytes_of(job.problem.motions))
    if search is not None and later is not None:
        memory += _KEPT * (count + int(search.kept * later[1]))
    return JobForecast(
        count, chunks, chunk, 1.0 / each.seconds, work.seconds, (work.low, work.high), memory,
        disk=size * count + 5000 * chunks,
        free=None if folder is None else _free(folder),
        later=later,
    )  # fmt: skip


def _bytes_of(motions: MotionSet) -> int:
    """Return the room that motions take which are held in memory [bytes]."""
    if not motions.in_memory:
        return MOTIONS_AT_ONCE * 8 * 8192
    return 3 * 8 * int(sum(np.size(getattr(motions[k], "acceleration", 0)) for k in range(len(motions))))


def _free(folder: Path) -> int:
    path = folder.resolve()
    return shutil.disk_usage(next(each for each in (path, *path.parents) if each.exists())).free


def trial(histories: Histories) -> Estimate:
    """Return what a history takes, from runs that are spread over all of them.

    A motion that has to be made is timed apart, and shared among all histories that it is for.

    Returns the mean of all histories, with twice its standard error.
    """
    count, synthetic = histories.count, not histories.motions.in_memory
    start = time.perf_counter()
    _timed(histories, 0, min(count, _WARM))  # motions are laid out, code is loaded
    middle = count // 2
    size = int(_SHARE / max(_timed(histories, middle, min(middle + _WARM, count)), 1e-9))
    size = max(1, min(size, _RUN, histories.together if synthetic else count, count))
    times: list[float] = []
    for place in range(1, _PLACES + 1):
        first = int(_spread(place) * (count - size + 1))
        first -= first % histories.together if synthetic else 0
        last = min(first + size, count)
        each = _timed(histories, first, last)
        if synthetic:  # the second time they are there
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
