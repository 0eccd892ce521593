"""The same bits whatever the workers, the size of the chunks, the order, the way processes start, and interruptions."""

import dataclasses
import itertools
import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from engines import built

from rocking.campaigns import Campaign, CampaignInterrupted
from rocking.dynamics import RandomRestitution

sys.path.insert(0, str(Path(__file__).parent / "durability"))
from workload import histories

sys.path.pop(0)

pytestmark = [
    pytest.mark.verifies(
        "same bits", "one run of the engine without a campaign", control="test_negative_control", room="campaigns"
    ),
    built,
]
COUNT = 2500
FORK = {"executor": "processes", "start_method": "fork"}
unforked = pytest.mark.skipif(os.name == "nt", reason="this system does not fork")


@pytest.fixture(scope="module")
def work():
    return histories(COUNT)


@pytest.fixture(scope="module")
def bare(work):
    """What the engine gives without any campaign."""
    found = work.run(0, COUNT, threads=1)
    assert min(np.bincount(found["outcome"], minlength=3)[:3]) > COUNT / 20  # worth it: all three outcomes
    return found


def stop_at(chunks):
    """Ctrl-C, once, when so many chunks are there."""
    asked = []

    def stop(progress):
        if progress.chunks_done == chunks and not asked:
            asked.append(chunks)
            signal.raise_signal(signal.SIGINT)

    return stop


def same(campaign, bare):
    found = campaign.results()
    return all(found[name].tobytes() == values.tobytes() for name, values in bare.items())


@pytest.mark.slow
@unforked
@pytest.mark.parametrize("workers", [1, 2, 4, 8])
@pytest.mark.parametrize("chunk", [1, 7, 64, 1000])
def test_workers_and_chunks_do_not_matter(tmp_path, work, bare, workers, chunk):
    """1, 2, 4 and 8 workers, chunks of 1, 7, 64 and 1000, each in an order of its own: the bits of a bare run."""
    if chunk == 1:
        work = histories(120)
        bare = work.run(0, 120, threads=1)
    campaign = Campaign.create(tmp_path / "c", work, chunk)
    campaign.run(**FORK, workers=workers, order_seed=workers)
    assert same(campaign, bare)


@pytest.mark.slow
@pytest.mark.parametrize("chunk", [1, 7, 64, 1000])
def test_hash_does_not_depend_on_the_size(tmp_path, chunk):
    """The hash of the results is the same for all sizes, serially and threaded."""
    few = histories(200)
    campaign, whole = Campaign.create(tmp_path / "c", few, chunk), Campaign.create(tmp_path / "d", few)
    campaign.run("serial", workers=2, order_seed=5)
    whole.run("serial", workers=1)
    assert campaign.sha256() == whole.sha256()


@pytest.mark.slow
@pytest.mark.parametrize("start_method", ["spawn", "fork", "forkserver"])
def test_start_of_processes_does_not_matter(tmp_path, work, bare, start_method):
    """Processes spawned, forked, and forked from a server: the bits of a bare run."""
    if os.name == "nt" and start_method != "spawn":
        pytest.skip("this system does not fork")
    campaign = Campaign.create(tmp_path / "c", work, 200)
    campaign.run("processes", workers=2, start_method=start_method)
    assert same(campaign, bare)


@pytest.mark.slow
def test_interruptions_do_not_matter(tmp_path, work, bare):
    """Stopped after every third chunk, and gone on with by changing executors and orders."""
    campaign = Campaign.create(tmp_path / "c", work, 100)
    runs = [{"workers": 1}, {"workers": 2, "order_seed": 7}]
    runs += [FORK | {"workers": 2, "order_seed": 2}] if os.name != "nt" else []
    stops = 0
    while not campaign.status().complete:
        start = campaign.status().chunks_done
        try:
            campaign.run(**runs[stops % len(runs)], progress=stop_at(start + 3))
        except CampaignInterrupted:
            stops += 1
    assert stops >= 4
    assert same(campaign, bare)


WORKERS, CHUNKS, METHODS = (1, 2, 4, 8), (1, 7, 64, 1000), ("fork", "spawn")
PRODUCT = list(itertools.product(METHODS, WORKERS, CHUNKS, (False, True), (False, True)))
SELECTION = [
    (method, workers, CHUNKS[(k + shift) % 4], bool((k + shift) % 2), bool(k // 2 ^ shift))
    for shift, method in enumerate(METHODS)
    for k, workers in enumerate(WORKERS)
]


def of_case(folder, case, work):
    """Run a campaign in one of the ways: start method, workers, chunk, shuffled or not, resumed or not."""
    method, workers, chunk, shuffled, resumed = case
    campaign = Campaign.create(folder, work, chunk)
    how = {"executor": "processes", "start_method": method, "workers": workers}
    half = max(1, campaign.plan.chunks // 2)
    if resumed:
        with pytest.raises(CampaignInterrupted):
            campaign.run(**how, order_seed=11 if shuffled else None, progress=stop_at(half))
    campaign.run(**how, order_seed=5 if shuffled else None)
    return campaign


@pytest.fixture(scope="module")
def by_chunk():
    """Histories for each size of chunks, two chunks or more of each, and what the engine gives of them."""
    made = {count: histories(count) for count in (60, 1200)}
    found = {count: (work, work.run(0, count, threads=1)) for count, work in made.items()}
    return {chunk: found[60 if chunk < 60 else 1200] for chunk in CHUNKS}


def check(folder, cases, by_chunk):
    for k, case in enumerate(cases):
        work, bare = by_chunk[case[2]]
        assert same(of_case(folder / f"{k}", case, work), bare), case


@pytest.mark.verifies("behaviour")
def test_the_selection_holds_every_value_and_every_pair():
    """What is run below: all workers with both ways of starting, every chunk, order and interruption."""
    assert {case[:2] for case in SELECTION} == set(itertools.product(METHODS, WORKERS))
    assert {case[2] for case in SELECTION} == set(CHUNKS)
    for method in METHODS:
        assert {case[3] for case in SELECTION if case[0] == method} == {False, True}
        assert {case[4] for case in SELECTION if case[0] == method} == {False, True}
    assert len(set(PRODUCT)) == 2 * 4 * 4 * 2 * 2


@pytest.mark.slow
@unforked
@pytest.mark.parametrize("method", METHODS)
def test_selection_of_the_matrix(tmp_path, by_chunk, method):
    """Workers, chunks, start, order and resume, each value at least once: the bits of a bare run."""
    check(tmp_path, [case for case in SELECTION if case[0] == method], by_chunk)


@unforked
@pytest.mark.skipif("ROCKING_CAMPAIGN" not in os.environ, reason="takes minutes: set ROCKING_CAMPAIGN=1")
@pytest.mark.parametrize("workers", WORKERS)
@pytest.mark.parametrize("method", METHODS)
def test_the_whole_matrix(
    tmp_path, by_chunk, method, workers
):  # fmt: skip
    """Every combination of workers, chunks, start, order and resume: the bits of a bare run."""
    check(tmp_path, [case for case in PRODUCT if case[:2] == (method, workers)], by_chunk)


@pytest.mark.verifies("negative control", "a law with another seed")
def test_negative_control(tmp_path, work, bare):
    """The comparison sees a law with another seed: it is not the case that anything passes."""
    law = RandomRestitution.normal(0.95, 0.02, seed=4)
    campaign = Campaign.create(tmp_path / "c", dataclasses.replace(work, law=law), 1000)
    campaign.run(workers=1)
    assert not same(campaign, bare)
