"""Two workers of a Dask cluster share a campaign whose time is in its motions; one that dies takes nothing with it."""

import os
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rocking.campaigns import Campaign, DaskExecutor, Progress
from rocking.dynamics.plane import fast_engine
from rocking.studies import SyntheticSet

sys.path.insert(0, str(Path(__file__).parents[1] / "unit" / "campaigns"))  # for the workers, too
from slow import Motions, product

pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.verifies(room="campaigns"),
    pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built"),
    pytest.mark.filterwarnings("default"),  # those of the cluster are not ours
]

MOTIONS = int(os.environ.get("ROCKING_DASK_MOTIONS", "0"))
"""Synthetic motions of a job that takes minutes: 4000 make 48,000 histories."""


def cluster(workers: int) -> Any:
    from distributed import LocalCluster

    return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None, memory_limit=None)


@pytest.fixture
def two() -> Iterator[Any]:
    with cluster(2) as made:
        yield made


def files(campaign: Campaign) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (campaign.folder / "shards").glob("*.shard")}


def took(campaign: Campaign, workers: int) -> float:
    """Wall time from the first piece to the last one: what it takes to start a cluster is not the campaign's."""
    from distributed import Client

    seen: list[tuple[float, int]] = []
    with cluster(workers) as made, Client(made, set_as_default=False) as client:
        client.run(__import__, "rocking.campaigns")
        campaign.run(
            DaskExecutor(made.scheduler_address),
            progress=lambda p: seen.append((time.perf_counter(), p.done_histories)),
        )
    (start, first), (end, last) = seen[1], seen[-1]
    return (end - start) / (last - first) * last


@pytest.mark.speed
@pytest.mark.verifies("same bits", "one worker", within="the same file, 1.5 times as fast at least")
def test_two_workers_share_one_chunk(tmp_path: Path) -> None:
    """120 motions of 0.1 s in one chunk: nearly twice as fast as one worker, no motion twice, the same file."""
    spent, made = {}, {}
    for workers in (1, 2):
        (tmp_path / f"{workers}").mkdir()
        motions = Motions(120, 0.1, tmp_path / f"{workers}")
        campaign = Campaign.create(tmp_path / f"c{workers}", product(motions))
        assert campaign.plan.chunks == 1
        spent[workers] = took(campaign, workers)
        made[workers] = files(campaign)
        assert max(Counter(motions.made()).values()) == 1
        assert sum(path.stat().st_size > 0 for path in (tmp_path / f"{workers}").glob("made-*")) == workers
    assert made[1] == made[2]
    print(f"one worker {spent[1]:.1f} s, two {spent[2]:.1f} s: {spent[1] / spent[2]:.2f} times")
    assert spent[1] / spent[2] > 1.5  # 1.9 on a quiet machine; a busy one delays what is beside the motions


@pytest.mark.verifies("damage", "kill -9 of one of two workers, and a serial run")
def test_one_of_two_workers_is_killed_half_way(tmp_path: Path, two: Any) -> None:
    """kill -9 of a worker at half of the histories: it ends by itself, with the bytes of a serial run."""
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    alone = Campaign.create(tmp_path / "c1", product(Motions(300, 0.0, tmp_path / "a")))
    alone.run(workers=1)
    motions = Motions(300, 0.02, tmp_path / "b")
    campaign = Campaign.create(tmp_path / "c2", product(motions))
    killed: list[int] = []

    def kill(progress: Progress) -> None:
        if progress.done_histories >= progress.total // 2 and not killed:
            killed.append(next(iter(two.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    campaign.run(DaskExecutor(two.scheduler_address), progress=kill)
    assert killed
    assert files(campaign) == files(alone)
    again = sum(count - 1 for count in Counter(motions.made()).values())
    assert again < 150  # what it had at hand: two pieces of a second each
    assert campaign.verify().is_complete


@pytest.mark.verifies(
    "same bits", "one worker, and two of which one is killed", within="the same file, 1.7 times as fast at least"
)
@pytest.mark.skipif(not MOTIONS, reason="takes minutes on cores of its own: set ROCKING_DASK_MOTIONS=4000")
def test_synthetic_motions_on_two_workers(tmp_path: Path) -> None:
    """Real synthetic motions, 12 histories each: two workers 1.7 times one; with one of them killed, the same file."""
    work = product(SyntheticSet("point-source", MOTIONS, seed=1, pga=3.0))
    spent, made = {}, []
    for workers in (1, 2):
        campaign = Campaign.create(tmp_path / f"c{workers}", work)
        spent[workers] = took(campaign, workers)
        made.append(files(campaign))
    campaign, killed = Campaign.create(tmp_path / "killed", work), []
    with cluster(2) as there:

        def kill(progress: Progress) -> None:
            if progress.done_histories >= progress.total // 2 and not killed:
                killed.append(next(iter(there.workers.values())).pid)
                os.kill(killed[0], signal.SIGKILL)

        campaign.run(DaskExecutor(there.scheduler_address), progress=kill)
    assert killed
    print(f"{work.count} histories: one worker {spent[1]:.1f} s, two {spent[2]:.1f} s: {spent[1] / spent[2]:.2f} times")
    assert made[0] == made[1] == files(campaign)
    assert spent[1] / spent[2] > 1.7
