"""Pieces that are cut by time: counts move, a kill costs a second, files and results are the same however it is cut."""

import os
import re
import signal
import sqlite3
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from campaign_jobs import flip
from waiting import allowed

from rocking.campaigns import Campaign, CampaignInterrupted, executors
from rocking.campaigns.chunks import Plan
from rocking.campaigns.ledger import Ledger
from rocking.campaigns.running import Remaining
from rocking.campaigns.status import Costs
from rocking.studies import HistoryTable

sys.path.insert(0, str(Path(__file__).parent))  # for the processes, too
from slow import Motions, product

pytestmark = pytest.mark.slow

PLAN = Plan("a" * 64, 1000, 300, "fast", "1.0")


@pytest.fixture
def short(monkeypatch):
    """Pieces of seven histories: every step is longer than it may be."""
    monkeypatch.setattr("rocking.campaigns.executors.PIECE", 0.0)
    monkeypatch.setattr("rocking.campaigns.executors.Pace.until", lambda self, first, last: min(first + 7, last))


def pieces(campaign):
    """Ends of the pieces that are recorded."""
    with Ledger(campaign.folder) as ledger:
        return [(record.first, record.last) for record in ledger.pieces()]


def stopped_after(campaign, count, **how):
    """Run until some pieces are recorded, and stop by Ctrl-C."""
    heard = []

    def stop(progress):
        heard.append(progress)
        if len(heard) == count + 1:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(CampaignInterrupted):
        campaign.run(**({"workers": 1} | how), progress=stop)


@pytest.mark.speed
def test_count_moves_within_seconds_and_a_kill_costs_one(tmp_path):
    """300 motions of 20 ms in one chunk of 6 s: a count every second or so, and hardly a motion made again."""
    motions = Motions(300, 0.02, tmp_path)
    campaign = Campaign.create(tmp_path / "c", product(motions))
    assert campaign.plan.chunks == 1
    seen: list[tuple[float, int]] = []
    start = time.perf_counter()

    def tell(progress):
        seen.append((time.perf_counter() - start, progress.done_histories))
        if progress.done_histories > 1200:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(CampaignInterrupted, match="of 3600 histories are safe"):
        campaign.run(workers=1, progress=tell)
    assert seen[1][0] < allowed(3.0)
    assert max(np.diff([at for at, _ in seen])) < allowed(3.0)  # a second each
    assert campaign.status().histories_done == seen[-1][1] > 1200
    campaign.run(workers=1)
    again = sum(count - 1 for count in Counter(motions.made()).values())
    assert again < 100  # what was begun when it was stopped: a second of it
    assert not (campaign.folder / "pieces").exists()


@pytest.mark.parametrize("seed", [None, 3])
def test_files_are_the_same_however_it_is_cut(campaign, finished, short, shards, seed):
    """Chunks in pieces of seven, stopped and gone on with: byte by byte the shards of an undisturbed campaign."""
    stopped_after(campaign, 4, order_seed=seed)
    assert pieces(campaign)
    assert campaign.status().histories_done == 28
    stopped_after(campaign, 9)
    campaign.run(workers=1, order_seed=seed)
    assert shards(campaign) == shards(finished)
    assert campaign.sha256() == finished.sha256()
    assert pieces(campaign) == []
    assert campaign.verify().is_complete


@pytest.mark.skipif(os.name == "nt", reason="this system does not fork")
def test_pieces_of_processes_are_the_same_files(tmp_path, work, finished, short, shards):
    """Two processes share one chunk, and chunks, in pieces."""
    for name, chunk in (("c", 50), ("d", 300)):
        campaign = Campaign.create(tmp_path / name, work, chunk)
        campaign.run("processes", workers=2, start_method="fork")
        assert campaign.sha256() == finished.sha256()
        if chunk == 50:
            assert shards(campaign) == shards(finished)


def test_ledger_of_an_earlier_version_is_not_read(campaign):
    """Its rows have other columns, and it is told apart from a damaged one."""
    stopped_after(campaign, 3)
    with sqlite3.connect(campaign.folder / "ledger.sqlite") as database:
        database.execute("PRAGMA user_version = 1")
    database.close()
    assert "of version 1 of these files, not 2" in campaign.verify().damaged[0]


@pytest.mark.parametrize("harm", ["flip", "cut", "lose", "swap"])
def test_damaged_pieces_are_named_and_computed_again(campaign, finished, short, shards, harm):
    """A piece whose bits flipped, that was cut short, lost, or has the bytes of another one: not counted, mended."""
    stopped_after(campaign, 4)
    first, second, *_ = sorted((campaign.folder / "pieces").glob("*.shard"))
    data, other = first.read_bytes(), second.read_bytes()
    if harm == "flip":
        flip(first, 8 * 200 + 2)
    elif harm == "cut":
        first.write_bytes(data[:-1])
    elif harm == "lose":
        first.unlink()
    else:
        first.write_bytes(other)
    assert campaign.status().histories_done == 21
    assert first.name in campaign.status().broken[0]
    assert any(first.name in sentence for sentence in campaign.verify().damaged)
    assert first.name in campaign.run(workers=1).set_aside[0]
    assert shards(campaign) == shards(finished)


def test_pieces_make_the_ledger_anew(campaign, finished, short, shards):
    """Without its ledger a campaign adopts whole pieces, and throws away what does not belong to it."""
    stopped_after(campaign, 4)
    before = pieces(campaign)
    (campaign.folder / "ledger.sqlite").unlink()
    (campaign.folder / "pieces" / "letter.shard").write_bytes(b"mine")
    assert campaign.run(workers=1).adopted == len(before)
    assert shards(campaign) == shards(finished)
    assert not (campaign.folder / "pieces").exists()


def test_killed_before_pieces_are_joined(campaign, finished, short, shards, monkeypatch):
    """All pieces of a chunk are there, and it is not: the next run joins them; after it is, the leftovers go."""
    from rocking.campaigns import running

    with monkeypatch.context() as patched:
        patched.setattr(running.shard, "unpack", lambda *_: 1 // 0)
        with pytest.raises(ZeroDivisionError):
            campaign.run(workers=1)
    assert {50, 100} & {last for _, last in pieces(campaign)}
    with monkeypatch.context() as patched:
        patched.setattr(Ledger, "record", lambda *_: 1 // 0)
        with pytest.raises(ZeroDivisionError):
            campaign.run(workers=1)
    assert len(shards(campaign)) == 1
    assert campaign.run(workers=1).adopted == 1
    assert shards(campaign) == shards(finished)
    assert not (campaign.folder / "pieces").exists()


def test_rows_of_pieces_that_were_meddled_with_are_refused(campaign, short):
    """An edited row, and pieces that overlap, are damage."""
    stopped_after(campaign, 3)
    good = (campaign.folder / "ledger.sqlite").read_bytes()
    with Ledger(campaign.folder, writable=True) as ledger:
        last = list(ledger.pieces())[-1]
        over = campaign.plan.chunk(0).piece(last.first + 1, last.last + 1)
        ledger.record_piece(last._replace(first=over.first, last=over.last, name=over.name))
    assert "not of this campaign, or there twice" in campaign.verify().damaged[0]
    (campaign.folder / "ledger.sqlite").write_bytes(good)
    with sqlite3.connect(campaign.folder / "ledger.sqlite") as database:
        database.execute("UPDATE pieces SET last = last + 1")
    database.close()
    assert re.search(r"row .* has changed", campaign.verify().damaged[0])


@pytest.mark.skipif(os.name == "nt", reason="this system does not fork")
def test_each_motion_is_made_once_by_who_needs_it(tmp_path):
    """Two processes share one chunk of 100 motions: each motion is made once, and each process makes some."""
    motions = Motions(100, 0.01, tmp_path)
    histories = product(motions)
    campaign = Campaign.create(tmp_path / "c", histories)
    campaign.run("processes", workers=2, start_method="fork")
    made = Counter(motions.made())
    assert set(made) == set(range(100))
    assert max(made.values()) == 1
    assert sum(path.stat().st_size > 0 for path in tmp_path.glob("made-*")) == 2


def test_scattered_motions_are_kept(tmp_path):
    """Histories whose motions are in no order, in steps of a few: no motion is made twice while there is room."""
    motions = Motions(40, 0.0, tmp_path)
    values = {
        f"{n}_{side}": np.array([v]) for n, v in (("alpha", 0.3), ("p", 2.0), ("r", 0.9)) for side in ("right", "left")
    }
    work = HistoryTable(motions, np.random.default_rng(1).integers(0, 40, 600), values)
    for first in range(0, 600, 10):
        work.run(first, first + 10, threads=1)
    assert max(Counter(motions.made()).values()) == 1


def given_out(remaining, rate, workers=2):
    """Play workers that do so many histories a second, and keep what is done after one: all of that, in turn."""
    out, done = [], []
    while True:
        while len(out) < workers and (piece := next(remaining, None)) is not None:
            out.append(piece)
        if not out:
            return done
        asked = out.pop(0)
        part = asked.piece(asked.first, min(asked.last, asked.first + rate))
        remaining.back(part, (part.last - part.first) / rate)
        done.append(part)


@pytest.mark.parametrize("workers", [1, 2, 7])
@pytest.mark.parametrize("rate", [1, 13, 1000])
def test_what_remains_is_handed_out_once(workers, rate):
    """Whatever was done before, however far workers come: every history once, none in two chunks."""
    before = {1: [PLAN.chunk(1).piece(310, 350), PLAN.chunk(1).piece(500, 520)]}
    order = np.array([3, 1, 0])
    remaining = Remaining(PLAN, order, before, 10, Costs(1000), sharers=lambda: workers)
    done = given_out(remaining, rate, workers)
    numbers = Counter(k for each in done for k in range(each.first, each.last))
    assert max(numbers.values()) == 1
    assert set(numbers) == set(range(1000)) - set(range(600, 900)) - set(range(310, 350)) - set(range(500, 520))
    assert all(PLAN.chunk(each.number).piece(each.first, each.last) == each for each in done)


def test_slow_work_is_shared_evenly():
    """One chunk of slow histories among four: none is given more than its share, the last ones get one each."""
    plan = Plan("a" * 64, 64, 64, "reference", "1.0")
    remaining = Remaining(plan, np.array([0]), {}, 1, Costs(64), sharers=lambda: 4)
    first = [next(remaining) for _ in range(4)]
    assert max(each.last - each.first for each in first) <= 8
    for each in first:
        remaining.back(each.piece(each.first, each.first + 1), 1.0)
    rest = given_out(remaining, 1, 4)
    assert len(rest) == 60


def test_pieces_end_between_motions():
    """Where histories of a motion stand together, pieces end with the last one of a motion."""
    remaining = Remaining(PLAN, np.array([0, 1, 2, 3]), {}, 12, Costs(1000), sharers=lambda: 3)
    ends = {each.last for each in given_out(remaining, 24, 3)}
    assert {end % 12 for end in ends - {1000}} == {0}


def test_custom_executors_need_not_cut(tmp_path, work, short, finished):
    """Whoever computes a piece and keeps it has done what an executor must."""

    class Mine(executors.Executor):
        def run(self, job, chunks, stop, retried):
            while (chunk := next(chunks, None)) is not None:
                data = job.compute(chunk, 1, stop)
                assert data is not None
                yield job.keep(chunk, data, 0.5)

    campaign = Campaign.create(tmp_path / "c", work, 120)
    campaign.run(Mine())
    assert campaign.sha256() == finished.sha256()
