"""Chunks and pieces that follow what the histories take: stops are soon, forecasts are right."""

import os
import signal
import threading
import time

import pytest
from waiting import allowed

from rocking.campaigns import Campaign, CampaignInterrupted
from rocking.campaigns.chunks import DEFAULT_CHUNK
from rocking.campaigns.executors import WorkerTask
from rocking.studies import HistoryTable

pytestmark = pytest.mark.speed


class Watched(HistoryTable):
    """Histories that may be slow, and remember the pieces that were asked for."""

    pause = 0.0

    def run(self, first, last, *, threads=None):
        if "pieces" in self.__dict__:
            self.__dict__["pieces"].append(last - first)
        time.sleep(self.pause * (last - first))
        return super().run(first, last, threads=threads)


class Slow(Watched):
    """Two milliseconds each."""

    pause = 0.002


def as_(kind, table, **changed):
    return kind(table.motions, table.motion, table.values, law=table.law, **changed)


def test_slow_histories_stop_soon(tmp_path, make):
    """Ctrl-C within a chunk of 20 s of histories of 2 ms each ends the run within 1.5 s, with a piece every 0.3 s."""
    work = as_(Slow, make(10_000))
    object.__setattr__(work, "pieces", pieces := [])
    campaign = Campaign.create(tmp_path / "c", work, 10_000)
    threading.Timer(0.8, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.perf_counter()
    with pytest.raises(CampaignInterrupted):
        campaign.run(workers=1)
    assert time.perf_counter() - start < 0.8 + allowed(0.3)
    assert pieces[0] == 64
    assert max(pieces) < 300


def test_quick_histories_come_in_large_pieces(tmp_path, make):
    """The fast engine is soon given as many at a time as it likes; the shard does not depend on it."""
    plain = make(60_000)
    work = as_(Watched, plain)
    object.__setattr__(work, "pieces", pieces := [])
    campaign = Campaign.create(tmp_path / "c", work, 60_000)
    campaign.run(workers=1)
    bare, found = plain.run(0, plain.count, threads=1), campaign.results()
    assert all(found[name].tobytes() == bare[name].tobytes() for name in bare)
    assert 4 * pieces[0] >= pieces[1] > pieces[0] == 64
    assert len(pieces) < 20
    assert max(pieces) <= DEFAULT_CHUNK


def test_the_pace_is_kept_from_chunk_to_chunk(tmp_path, make):
    """Only the first chunk begins with few histories at a time: small pieces leave most lanes of the engine idle."""
    work = as_(Watched, make(60_000))
    object.__setattr__(work, "pieces", pieces := [])
    Campaign.create(tmp_path / "c", work, 20_000).run(workers=1)
    assert pieces[0] == 64
    assert pieces.count(64) == 1
    assert len(pieces) < 20


def test_workers_ask_within_a_chunk(tmp_path, make):
    """A worker that is to stop leaves a slow chunk unfinished, soon."""
    work = as_(Slow, make(5000))
    plan = Campaign.create(tmp_path / "c", work, 5000).plan
    start = time.perf_counter()
    job = WorkerTask(work, plan.engine, plan.software, tmp_path)
    assert job.compute(plan.chunk(0), 1, lambda: time.perf_counter() - start > 0.5) is None
    assert time.perf_counter() - start < allowed(0.8)


def test_default_chunk_follows_the_engine(tmp_path, make):
    """65536 histories of the fast engine, 256 of the reference engine, whatever is asked for if it is."""
    assert Campaign.create(tmp_path / "a", make(70_000)).plan.size == 65536
    reference = as_(HistoryTable, make(300), engine="reference")
    assert Campaign.create(tmp_path / "b", reference).plan.size == 256
    assert Campaign.create(tmp_path / "c", reference, 17).plan.size == 17


@pytest.mark.parametrize(("kind", "count"), [(HistoryTable, 200_000), (Slow, 1200)])
def test_forecast_is_near(tmp_path, make, kind, count):
    """What a run takes is within a factor of 2 of the forecast: the machine is busy with other things now and then."""
    campaign = Campaign.create(tmp_path / "c", as_(kind, make(count)))
    told = campaign.check().work.seconds
    took = campaign.run(workers=1).seconds
    assert 0.5 < took / told < 2.0
