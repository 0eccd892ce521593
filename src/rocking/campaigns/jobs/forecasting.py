"""What a job will take: time from a short trial, memory and disk."""

import math
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking.campaigns.forecast import trial
from rocking.campaigns.identity import usual_chunk
from rocking.campaigns.jobs.job import Job
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.motions.pulse import Pulse
from rocking.studies.histories import MOTIONS_AT_ONCE

BYTES = sum(np.dtype(kind).itemsize for kind in RESULTS.values())
"""Results of one history [bytes]."""

_KEPT = 100
"""What an adaptive study keeps of a history, with what it takes for a moment [bytes]."""

# histories of later rounds over those of the first, and over edges and halvings of a line across a map
_OF_SEARCHES = {"pulses": (2.0, 10.0), "records": (10.0, 100.0)}
_EDGES = (2.0, 12.0)

_BASE = 150_000_000


@dataclass(frozen=True)
class JobForecast:
    """What a job will take.

    Parameters
    ----------
    histories, chunks, chunk : int
        How many, in how many chunks, and how many in each.
    rate : float
        Histories of one core in a second [1/s].
    seconds : float
        Time of the workers for all of them [s].
    between : tuple of float
        Bounds between which it probably is [s].
    memory : int
        Memory of all workers together, of an adaptive study with all that its rounds keep, roughly [bytes].
    disk : int
        Room for the results [bytes].
    free : int or None
        Room that there is, where a folder is given [bytes].
    later : tuple of int, optional
        Of an adaptive study, whose other numbers are of the first round: between how many and how many histories the
        later rounds usually have.
    """

    histories: int
    chunks: int
    chunk: int
    rate: float
    seconds: float
    between: tuple[float, float]
    memory: int
    disk: int
    free: int | None
    later: tuple[int, int] | None = None


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
    Forecast
        Estimates.
    """
    histories = job.study.histories
    chunk = min(job.document.campaign.chunk or usual_chunk(histories), histories.count)
    chunks = -(-histories.count // chunk)
    each, later = trial(histories), _later(job)
    work = each.at(workers / histories.count)
    return JobForecast(
        histories.count,
        chunks,
        chunk,
        1.0 / each.seconds,
        work.seconds,
        (work.low, work.high),
        workers * (_BASE + 4 * BYTES * chunk + _motions(job)) + _held(job, later),
        BYTES * histories.count + 5000 * chunks,
        None if folder is None else shutil.disk_usage(_existing(folder)).free,
        later,
    )


def _later(job: Job) -> tuple[int, int] | None:
    """Return how many histories later rounds usually have: as jobs of many sizes had them."""
    if job.study.search is None:
        return None
    count, table = job.study.histories.count, job.document.map
    if table is None or table.refine is None:
        low, high = _OF_SEARCHES["pulses" if job.problem.motions[0].__class__ is Pulse else "records"]
        return int(low * count), int(high * count)
    # a line across the map, cut into edges of the finest level, each found, and halved until it is as short as asked
    edges = math.sqrt(count) * 2.0**table.refine
    each = edges * (2.0 + max(0.0, -math.log2(table.tolerance * edges)))
    return int(_EDGES[0] * each), int(_EDGES[1] * each)


def _held(job: Job, later: tuple[int, int] | None) -> int:
    """Return the room of what an adaptive study keeps of its rounds [bytes]."""
    if later is None:
        return 0
    kept = later[1] if job.document.map is None else later[1] // 4  # halvings of edges are forgotten
    return _KEPT * (job.study.histories.count + kept)


def _motions(job: Job) -> int:
    """Return the room that motions take which are held in memory [bytes]."""
    motions = job.problem.motions
    if not motions.in_memory:
        return MOTIONS_AT_ONCE * 8 * 8192
    samples = sum(np.size(getattr(motions[k], "acceleration", 0)) for k in range(len(motions)))
    return 3 * 8 * int(samples)


def _existing(folder: Path) -> Path:
    path = folder.resolve()
    while not path.exists():
        path = path.parent
    return path
