"""A real Dask cluster with several workers; one that dies is killed in tests/verification."""

import pytest

from rocking.campaigns import CampaignWorkerError, DaskExecutor
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


@pytest.mark.slow
def test_cluster_gives_the_same_files(cluster, finished, campaign, shards):
    """Three workers, shuffled: byte by byte the shards of a serial run."""
    summary = campaign.run(DaskExecutor(cluster.scheduler_address), order_seed=3)
    assert summary.computed == 6
    assert shards(campaign) == shards(finished)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("_fingerprint", "lambda *_: '0' * 16", "results of this worker differ in the last digits: .* fast, 0000"),
        ("software", "lambda: '9.9'", r"this worker has version 9\.9, but the campaign started with"),
    ],
)
def test_worker_of_other_bits_is_refused(cluster, campaign, name, value, words):
    """A worker with another version, or of other last digits, is told so, and writes nothing."""
    from distributed import Client

    place = "import rocking.campaigns.identity as place; "
    with Client(cluster, set_as_default=False) as client:
        client.run(exec, f"{place}place.kept = place.{name}; place.{name} = {value}")
        try:
            with pytest.raises(CampaignWorkerError, match=words):
                campaign.run(DaskExecutor(cluster.scheduler_address))
        finally:
            client.run(exec, f"{place}place.{name} = place.kept")
    assert not list((campaign.folder / "shards").iterdir())


def test_histories_that_cannot_be_sent_are_refused(cluster, campaign, work):
    """What cannot be pickled has the sentence that processes have."""
    object.__setattr__(work, "listener", nameless)
    with pytest.raises(CampaignWorkerError, match="cannot be sent to a process"):
        campaign.run(DaskExecutor(cluster.scheduler_address))


def test_no_scheduler_has_a_sentence(campaign):
    """An address where nobody answers, and what is no address."""
    with pytest.raises(CampaignWorkerError, match=r"the Dask scheduler at .* does not respond"):
        campaign.run(DaskExecutor("tcp://127.0.0.1:9", timeout=0.5))
    with pytest.raises(InvalidValueError, match="address must be the address of a scheduler"):
        DaskExecutor("")
