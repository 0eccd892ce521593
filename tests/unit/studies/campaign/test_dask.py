"""A real Dask cluster with several workers, one of which dies."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rocking.errors import InvalidValueError
from rocking.studies import Table
from rocking.studies.campaign import Campaign, CampaignWorkerError, DaskExecutor, Progress

pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("default")  # those of the cluster are not ours


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Three worker processes of one thread, which are restarted when they die."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None, memory_limit=None) as made:
        yield made


def test_cluster_gives_the_same_files(
    cluster: Any, finished: Campaign, tmp_path: Path, work: Table, shards: Any
) -> None:
    """Three workers, shuffled: byte by byte the shards of a serial run."""
    campaign = Campaign.create(tmp_path / "c", work, 50)
    summary = campaign.run(DaskExecutor(cluster.scheduler_address), order_seed=3)
    assert summary.computed == 6
    assert shards(campaign) == shards(finished)


def test_worker_that_dies_costs_nothing(cluster: Any, tmp_path: Path, make: Any) -> None:
    """kill -9 of one of the workers while chunks are on their way: nothing is lost, and the results are the same."""
    work = make(60_000)
    campaign = Campaign.create(tmp_path / "c", work, 500)
    killed = []

    def kill(progress: Progress) -> None:
        if progress.chunks_done in {10, 40} and len(killed) < 2:
            victim = next(iter(cluster.workers.values()))
            killed.append(victim.pid)
            os.kill(victim.pid, signal.SIGKILL)

    campaign.run(DaskExecutor(cluster.scheduler_address), progress=kill)
    assert len(killed) == 2
    bare, found = work.run(0, work.count, threads=1), campaign.results()
    assert all(found[name].tobytes() == bare[name].tobytes() for name in bare)


def test_no_scheduler_has_a_sentence(tmp_path: Path, work: Table) -> None:
    """An address where nobody answers, and what is no address."""
    campaign = Campaign.create(tmp_path / "c", work, 50)
    with pytest.raises(CampaignWorkerError, match="no Dask scheduler answers at"):
        campaign.run(DaskExecutor("tcp://127.0.0.1:9", timeout=0.5))
    with pytest.raises(InvalidValueError, match="address must be that of a scheduler"):
        DaskExecutor("")
