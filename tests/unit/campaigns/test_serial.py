"""Chunks that are written while the next one is computed: a plain loop would record the same; Ctrl-C."""

import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from waiting import HANG, allowed

from rocking.campaigns import Campaign, CampaignInterrupted, Executor, Serial
from rocking.campaigns.executors import Interruption, WorkerTask
from rocking.studies import HistoryTable


class Hooked(HistoryTable):
    """Histories that call a function with their first number before they are computed, if they are given one."""

    def run(self, first, last, *, threads=None):
        self.__dict__.get("hook", int)(first)
        return super().run(first, last, threads=threads)


class Plain(Executor):
    """Computes, writes and hands over one chunk after another: what overlaps must do the same."""

    def run(self, job, chunks, stop, retried):
        for chunk in chunks:
            data = job.compute(chunk, 1, stop)
            if data is None:
                return
            yield job.keep(chunk, data, 1.0)


@pytest.fixture
def hooked(work):
    """The 300 histories with a hook."""

    def give(hook):
        made = Hooked(work.motions, work.motion, work.values, law=work.law)
        object.__setattr__(made, "hook", hook)
        return made

    return give


def soon(event):
    """Wait for what must happen; not for ever."""
    if not event.wait(HANG):
        raise AssertionError("it did not happen")


def rows(campaign):
    """What the ledger has, but for times."""
    with sqlite3.connect(campaign.folder / "ledger.sqlite") as database:
        names = "number, first, last, name, seal, size, attempts, worker"
        found = database.execute(f"SELECT {names} FROM chunks ORDER BY number").fetchall()
    database.close()
    return found


def computing():
    """Threads of campaigns that are there."""
    return [each.name for each in threading.enumerate() if each.name.startswith("campaign")]


@pytest.fixture(autouse=True)
def _no_thread_is_left():
    yield
    assert computing() == []


@pytest.mark.parametrize("seed", [None, 4])
def test_shards_and_ledger_are_those_of_a_plain_loop(tmp_path, work, shards, seed):
    """The bytes of every shard, and all of the ledger but its times, in whatever order; uneven chunks."""
    both = [Campaign.create(tmp_path / name, work, 70) for name in ("overlapping", "plain")]
    told: list[list[int]] = [[], []]
    for campaign, executor, heard in zip(both, (Serial(1), Plain()), told, strict=True):
        campaign.run(executor, order_seed=seed, progress=lambda p, heard=heard: heard.append(p.done_histories))
    assert shards(both[0]) == shards(both[1])
    assert len(shards(both[0])) == 5
    assert rows(both[0]) == rows(both[1])
    assert told[0] == told[1]


def test_next_chunk_is_computed_while_one_is_written(tmp_path, hooked, monkeypatch):
    """A chunk is written only once the next one is at work, which goes on only once it is recorded; none beyond it."""
    begun = [threading.Event() for _ in range(7)]
    recorded = [threading.Event() for _ in range(7)]
    keep, ahead = WorkerTask.keep, []

    def note(first):
        begun[first // 50].set()
        if first:
            soon(recorded[first // 50 - 1])

    def careful(self, chunk, *rest):
        if chunk.number < 5:
            soon(begun[chunk.number + 1])
        ahead.append(sum(event.is_set() for event in begun) - chunk.number)
        return keep(self, chunk, *rest)

    def tell(progress):
        if progress.chunks_done:
            recorded[progress.chunks_done - 1].set()

    monkeypatch.setattr(WorkerTask, "keep", careful)
    campaign = Campaign.create(tmp_path / "c", hooked(note), 50)
    assert campaign.run(workers=1, progress=tell).computed == 6
    assert ahead == [2, 2, 2, 2, 2, 1]


def test_error_comes_after_the_chunk_before_it_is_recorded(tmp_path, hooked):
    """The third chunk fails before the second one is recorded: that is recorded and told, then the error is raised."""
    failed, told = threading.Event(), []

    def fail(first):
        if first == 100:
            failed.set()
            raise ZeroDivisionError("of the user")

    def tell(progress):
        if progress.chunks_done == 2:
            soon(failed)
        told.append(progress.chunks_done)

    campaign = Campaign.create(tmp_path / "c", hooked(fail), 50)
    with pytest.raises(ZeroDivisionError, match="of the user"):
        campaign.run(workers=1, progress=tell)
    assert told == [0, 1, 2]
    assert campaign.status().chunks_done == 2


@pytest.mark.parametrize("fails", [False, True])
def test_stop_discards_what_was_begun_too_early(tmp_path, hooked, shards, fails):
    """A stop is asked while the second chunk is recorded and the third one computed: two stay, whatever that gave."""
    third = threading.Event()
    fail = fails

    def note(first):
        if first == 100:
            third.set()
            if fail:
                raise ZeroDivisionError("of the user")

    def stop(progress):
        if progress.chunks_done == 2:
            soon(third)
            time.sleep(0.05)  # it is through, too
            os.kill(os.getpid(), signal.SIGINT)

    campaign = Campaign.create(tmp_path / "c", hooked(note), 50)
    with pytest.raises(CampaignInterrupted, match="stopped: 2 of 6 chunks are safe"):
        campaign.run(workers=1, progress=stop)
    assert campaign.status().chunks_done == len(shards(campaign)) == 2
    fail = False
    summary = campaign.run(workers=1)
    assert (summary.resumed, summary.adopted, summary.computed) == (2, 0, 4)


def test_stop_within_the_last_piece_of_a_chunk_keeps_it(tmp_path, hooked):
    """A stop while nothing but a last piece is computed: the chunk is whole, and recorded."""

    def stop(first):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.3)

    campaign = Campaign.create(tmp_path / "c", hooked(stop), 50)
    with pytest.raises(CampaignInterrupted, match="stopped: 1 of 6 chunks are safe"):
        campaign.run(workers=1)
    assert campaign.status().chunks_done == 1


def test_second_ctrl_c_is_raised_where_the_campaign_runs(tmp_path, hooked):
    """It does not wait for the chunk to be kept; lock and thread are let go of, and a later run finishes."""
    impatient = True

    def stop(first):
        for _ in range(2 * impatient):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.5)

    campaign = Campaign.create(tmp_path / "c", hooked(stop), 50)
    with pytest.raises(KeyboardInterrupt) as told:
        campaign.run(workers=1)
    assert told.type is KeyboardInterrupt
    assert campaign.status().chunks_done == 0
    assert computing() == []
    impatient = False
    assert campaign.run(workers=1).computed == 6


@pytest.mark.speed
@pytest.mark.parametrize("where", ["listener", "disk"])
def test_error_beside_a_long_chunk_is_raised_soon(tmp_path, make, monkeypatch, where):
    """The next chunk, of 10 s, is left at its next piece when the one before it cannot be told or written."""
    plain = make(4000)
    slow = Hooked(plain.motions, plain.motion, plain.values, law=plain.law)
    object.__setattr__(slow, "hook", lambda first: time.sleep(0.005 if first >= 2000 else 0.0))
    campaign = Campaign.create(tmp_path / "c", slow, 2000)
    monkeypatch.setattr("rocking.campaigns.executors._ASK", 0.0)  # a history at a time

    def fail(*given):
        if where == "disk" or given[0].done_histories:
            raise ZeroDivisionError(where)

    if where == "disk":
        monkeypatch.setattr(WorkerTask, "keep", fail)
    start = time.perf_counter()
    with pytest.raises(ZeroDivisionError, match=where):
        campaign.run(workers=1, progress=fail if where == "listener" else None)
    assert time.perf_counter() - start < allowed(1.0)
    assert (campaign.status().histories_done > 0) == (where == "listener")


def test_executor_that_is_closed_early_waits_for_its_thread(tmp_path, hooked):
    """Whoever takes one chunk and leaves finds one shard and no thread; chunks are drawn by the caller's own thread."""
    drew: list[threading.Thread] = []
    second, ended = threading.Event(), threading.Event()

    def linger(first):
        if first == 50:
            second.set()
            time.sleep(0.2)
            ended.set()

    work = hooked(linger)
    plan = Campaign.create(tmp_path / "c", work, 50).plan

    def chunks():
        for number in range(plan.chunks):
            drew.append(threading.current_thread())
            yield plan.chunk(number)

    job = WorkerTask(work, plan.engine, plan.software, tmp_path)
    finished: Any = Serial(1).run(job, chunks(), lambda: False, lambda chunk, why: None)
    assert next(finished).chunk == plan.chunk(0)
    soon(second)
    finished.close()
    assert ended.is_set()
    assert computing() == []
    assert drew == [threading.current_thread()] * 2
    assert len(list(tmp_path.glob("*.shard"))) == 1


@pytest.mark.skipif(np.__version__.startswith("1."), reason="numpy 1 has its rules by thread, which a context has not")
def test_rules_of_the_caller_hold_for_the_histories(tmp_path, hooked):
    """What NumPy does about an overflow is a matter of the thread: it is that of whoever runs the campaign."""
    campaign = Campaign.create(tmp_path / "c", hooked(lambda first: np.exp(np.float64(1e4))), 50)
    with np.errstate(over="raise"), pytest.raises(FloatingPointError, match="overflow"):
        campaign.run(workers=1)
    with np.errstate(over="ignore"):
        assert campaign.run(workers=1).computed == 6


RUN = """
import sys
sys.path.insert(0, sys.argv[2])
from conftest import made
from rocking.campaigns import Campaign, CampaignInterrupted
if __name__ == "__main__":
    campaign = Campaign.create(sys.argv[1], made(1_000_000), int(sys.argv[3]))
    told = lambda p: p.chunks_done == int(sys.argv[5]) and print("going", flush=True)
    try:
        campaign.run(sys.argv[4], workers=2, progress=told)
    except CampaignInterrupted as stop:
        print(stop, flush=True)
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_stop_records_what_is_finished(tmp_path, work, number):
    """A signal in the middle: the exception says what is safe, later runs go on, old handlers are back."""
    whole = Campaign.create(tmp_path / "whole", work, 50)
    whole.run(workers=1)
    campaign, before = Campaign.create(tmp_path / "c", work, 50), signal.getsignal(number)

    def stop(progress):
        if progress.chunks_done == 2:
            os.kill(os.getpid(), number)

    with pytest.raises(CampaignInterrupted, match=r"stopped: 2 of 6 chunks are safe in .*; run the campaign again"):
        campaign.run(workers=1, progress=stop)
    assert campaign.status().chunks_done == 2
    assert signal.getsignal(number) is before
    summary = campaign.run(workers=1)
    assert (summary.resumed, summary.computed) == (2, 4)
    assert campaign.sha256() == whole.sha256()


def test_interruption_is_no_ordinary_error():
    """What goes on after errors does not go on after Ctrl-C."""
    assert issubclass(CampaignInterrupted, KeyboardInterrupt)
    assert not issubclass(CampaignInterrupted, Exception)


def test_second_signal_is_not_held_back():
    """Who presses Ctrl-C twice means it."""
    with Interruption() as interruption:
        os.kill(os.getpid(), signal.SIGINT)
        assert interruption.requested()
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.slow
@pytest.mark.parametrize(
    ("executor", "chunk", "after"), [("serial", 5000, 2), ("serial", 1_000_000, 0), ("processes", 5000, 2)]
)
def test_ctrl_c_of_a_terminal_stops(tmp_path, executor, chunk, after, shards):
    """The whole group gets SIGINT, as from a terminal: one sentence, no traceback, even within a large chunk."""
    script = tmp_path / "run.py"
    script.write_text(RUN, encoding="utf-8")
    arguments = [str(tmp_path / "c"), str(Path(__file__).parent), str(chunk), executor, str(after)]
    process = subprocess.Popen(
        [sys.executable, str(script), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline() == "going\n"
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=HANG)
    assert err == ""
    assert out.splitlines()[-1].startswith("stopped: ")
    status = Campaign.status_of(tmp_path / "c")
    assert after <= status.chunks_done < 200
    assert len(list((tmp_path / "c" / "shards").glob("*.shard"))) >= status.chunks_done
