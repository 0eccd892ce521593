"""What a job will take: time from a short trial, memory and disk."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking.campaigns.forecast import BYTES, trial
from rocking.campaigns.identity import usual_chunk
from rocking.campaigns.jobs.job import Job
from rocking.studies.histories import MOTIONS_AT_ONCE
from rocking.studies.motion_sets import MotionSet

# what an adaptive study keeps of a history, with what it takes for a moment; memory of a worker without work [bytes]
_KEPT, _BASE = 100, 150_000_000


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


def forecast(job: Job, workers: int = 1, folder: Path | None = None) -> JobForecast:
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
    each, later = trial(histories), None if search is None else search.later(count)
    work = each.at(workers / count)
    memory = workers * (_BASE + 4 * BYTES * chunk + _bytes_of(job.problem.motions))
    if search is not None and later is not None:
        memory += _KEPT * (count + int(search.kept * later[1]))
    return JobForecast(
        count, chunks, chunk, 1.0 / each.seconds, work.seconds, (work.low, work.high), memory,
        disk=BYTES * count + 5000 * chunks,
        free=None if folder is None else shutil.disk_usage(_existing(folder)).free,
        later=later,
    )  # fmt: skip


def _bytes_of(motions: MotionSet) -> int:
    """Return the room that motions take which are held in memory [bytes]."""
    if not motions.in_memory:
        return MOTIONS_AT_ONCE * 8 * 8192
    return 3 * 8 * int(sum(np.size(getattr(motions[k], "acceleration", 0)) for k in range(len(motions))))


def _existing(folder: Path) -> Path:
    path = folder.resolve()
    return next(each for each in (path, *path.parents) if each.exists())
