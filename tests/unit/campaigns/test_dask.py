"""A real Dask cluster with several workers, one of which dies."""

import os
import signal

import pytest

from rocking.campaigns import Campaign, CampaignWorkerError, DaskExecutor
from rocking.errors import InvalidValueError

pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("default")  # those of the cluster are not ours

nameless = lambda: 0  # noqa: E731 (pickle refuses it in another way than a local one)


@pytest.fixture(scope="module")
def cluster():
    """Three worker processes of one thread, which are restarted when they die."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None, memory_limit=None) as made:
        yield made


def test_cluster_gives_the_same_files(cluster, finished, campaign, shards):
    """Three workers, shuffled: byte by byte the shards of a serial run."""
    summary = campaign.run(DaskExecutor(cluster.scheduler_address), order_seed=3)
    assert summary.computed == 6
    assert shards(campaign) == shards(finished)


@pytest.mark.parametrize(
    ("where", "name", "value", "words"),
    [
        ("identity", "_fingerprint", "lambda *_: '0' * 16", "this worker computes other last digits: .* fast, 0000"),
        ("identity", "software", "lambda: '9.9'", r"this worker has version 9\.9, the campaign was begun with"),
    ],
)
def test_worker_of_other_bits_is_refused(cluster, campaign, where, name, value, words):
    """A worker with another version, or of other last digits, is told so, and writes nothing."""
    from distributed import Client

    place = f"import rocking.campaigns.{where} as place; "
    with Client(cluster, set_as_default=False) as client:
        client.run(exec, f"{place}place.kept = place.{name}; place.{name} = {value}")
        try:
            with pytest.raises(CampaignWorkerError, match=words):
                campaign.run(DaskExecutor(cluster.scheduler_address))
        finally:
            client.run(exec, f"{place}place.{name} = place.kept")
    assert not list((campaign.folder / "shards").iterdir())


def test_worker_that_dies_costs_nothing(cluster, tmp_path, make):
    """kill -9 of one of the workers while chunks are on their way: nothing is lost, and the results are the same."""
    work = make(60_000)
    campaign = Campaign.create(tmp_path / "c", work, 500)
    killed = []

    def kill(progress):
        if progress.chunks_done in {10, 40} and len(killed) < 2:
            victim = next(iter(cluster.workers.values()))
            killed.append(victim.pid)
            os.kill(victim.pid, signal.SIGKILL)

    campaign.run(DaskExecutor(cluster.scheduler_address), progress=kill)
    assert len(killed) == 2
    bare, found = work.run(0, work.count, threads=1), campaign.results()
    assert all(found[name].tobytes() == bare[name].tobytes() for name in bare)


def test_histories_that_cannot_be_sent_are_refused(cluster, campaign, work):
    """What cannot be pickled has the sentence that processes have."""
    object.__setattr__(work, "listener", nameless)
    with pytest.raises(CampaignWorkerError, match="cannot be sent to a process"):
        campaign.run(DaskExecutor(cluster.scheduler_address))


def test_no_scheduler_has_a_sentence(campaign):
    """An address where nobody answers, and what is no address."""
    with pytest.raises(CampaignWorkerError, match="no Dask scheduler answers at"):
        campaign.run(DaskExecutor("tcp://127.0.0.1:9", timeout=0.5))
    with pytest.raises(InvalidValueError, match="address must be that of a scheduler"):
        DaskExecutor("")
