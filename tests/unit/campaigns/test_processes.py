"""Worker processes: any of them may die, none of them decides; what is missing for others is said."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from waiting import HANG

from rocking.campaigns import Campaign, CampaignWorkerError, DaskExecutor, Progress, identity
from rocking.campaigns.executors import WorkerTask
from rocking.dynamics.plane import fast_engine
from rocking.errors import MissingExtraError

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="workers are forked, so that they can be made to fail"),
]
nameless = lambda: 0  # noqa: E731 (pickle refuses it in another way than a local one)
FORK: dict[str, Any] = {"executor": "processes", "start_method": "fork"}


def breaking(monkeypatch, what):
    """Have workers do something bad before a chunk."""
    compute = WorkerTask.compute

    def broken(self, chunk, *args):
        what(chunk)
        return compute(self, chunk, *args)

    monkeypatch.setattr(WorkerTask, "compute", broken)


def test_worker_that_dies_once_costs_nothing(campaign, tmp_path, work, monkeypatch):
    """kill -9 in the middle of a chunk: it is computed again by another worker, which is told and recorded."""
    marker = tmp_path / "died"

    def die_once(chunk):
        if chunk.number == 3 and not marker.exists():
            marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)

    breaking(monkeypatch, die_once)
    seen: list[Progress] = []
    summary = campaign.run(**FORK, workers=2, progress=seen.append)
    assert summary.computed == 6
    assert len(summary.retries) == seen[-1].retries == campaign.status().retries == 1
    assert "by SIGKILL" in summary.retries[0]
    bare = work.run(0, work.count, threads=1)
    assert all(campaign.results()[name].tobytes() == bare[name].tobytes() for name in bare)


def test_chunk_that_kills_every_worker_is_named(campaign, monkeypatch):
    """Three deaths of the same chunk end the run with its histories; the others that were done are safe."""
    breaking(monkeypatch, lambda chunk: os.kill(os.getpid(), signal.SIGTERM) if chunk.number == 4 else None)
    with pytest.raises(CampaignWorkerError, match=r"3 workers ended .* of histories 200 to 249, .* by SIGTERM"):
        campaign.run(**FORK, workers=2)
    assert campaign.verify().damaged == ()
    monkeypatch.undo()
    assert campaign.run(workers=1).computed < 6


def test_error_in_a_worker_is_told(campaign, monkeypatch):
    """What a worker raises is raised where the campaign runs, with the histories, and is not tried again."""

    def fail(_):
        raise ZeroDivisionError("by nought")

    breaking(monkeypatch, fail)
    with pytest.raises(CampaignWorkerError, match="histories 0 to 49 failed: ZeroDivisionError: by nought"):
        campaign.run(**FORK, workers=1)


def test_worker_without_the_engine_is_refused(campaign, monkeypatch):
    """Results of two engines are never mixed."""
    breaking(monkeypatch, lambda _: setattr(fast_engine, "chosen", lambda *_: "reference"))
    with pytest.raises(
        CampaignWorkerError, match="this worker has the reference engine, but the campaign needs the fast"
    ):
        campaign.run(**FORK, workers=1)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("_fingerprint", lambda *_: "0" * 16, "results of this worker differ in the last digits: .* fast, 0000"),
        ("software", lambda: "9.9", r"this worker has version 9\.9, but the campaign started with"),
    ],
)
def test_worker_of_other_bits_is_refused(campaign, monkeypatch, name, value, words):
    """Another version, or an engine of other last digits, writes nothing into chunks that are named for this one."""
    breaking(monkeypatch, lambda _: setattr(identity, name, value))
    with pytest.raises(CampaignWorkerError, match=words):
        campaign.run(**FORK, workers=1)
    assert not list((campaign.folder / "shards").iterdir())


def test_histories_that_cannot_be_sent_are_refused(campaign, work):
    """What cannot be pickled has a sentence."""
    for unsendable in (threading.Lock(), nameless, lambda: 0):
        object.__setattr__(work, "listener", unsendable)
        with pytest.raises(CampaignWorkerError, match="cannot be sent to a process"):
            campaign.run("processes", workers=1)


@pytest.mark.parametrize("start_method", ["fork", "forkserver"])
def test_idle_workers_stay(campaign, start_method):
    """Workers that wait for more than their patience are still there: under a fork server, too."""
    summary = campaign.run(
        "processes", workers=1, start_method=start_method, progress=lambda p: time.sleep(1.3 * (p.chunks_done == 1))
    )
    assert (summary.computed, summary.retries) == (6, ())


ORPHANS = """
import multiprocessing, os, signal, sys, time
sys.path.insert(0, sys.argv[2])
from conftest import made
from rocking.campaigns import Campaign

def die(progress):
    if progress.chunks_done == 3:
        print(*[child.pid for child in multiprocessing.active_children()], flush=True)
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    Campaign.create(sys.argv[1], made(100_000), 50).run("processes", workers=3, start_method=sys.argv[3], progress=die)
"""


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="/proc tells the dead from the living")
@pytest.mark.parametrize("start_method", ["fork", "forkserver"])
def test_orphans_end(tmp_path, start_method):
    """When the campaign's process is killed alone, its workers end by themselves, however they were started."""
    (tmp_path / "run.py").write_text(ORPHANS, encoding="utf-8")
    arguments = [str(tmp_path / "c"), str(Path(__file__).parent), start_method]
    command = [sys.executable, str(tmp_path / "run.py"), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=False)
    assert done.returncode == -signal.SIGKILL
    left, deadline = list(map(int, done.stdout.split())), time.monotonic() + HANG
    assert left
    while (left := [pid for pid in left if alive(pid)]) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert left == []


def alive(process):
    """Whether a process runs: not gone, and no zombie."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_no_worker_stays(tmp_path, work, monkeypatch):
    """After a run, one that failed, and one that was interrupted, all processes are gone."""
    Campaign.create(tmp_path / "c", work, 50).run(**FORK, workers=3)
    assert multiprocessing.active_children() == []

    def leave(_):
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError):
        Campaign.create(tmp_path / "d", work, 50).run(**FORK, workers=3, progress=leave)
    assert multiprocessing.active_children() == []


def test_work_is_taken_as_it_is_needed(tmp_path, work):
    """However many chunks there are, few are waiting: two a worker."""
    from rocking.campaigns.processes import Processes

    campaign = Campaign.create(tmp_path / "c", work, 5)
    taken = finished = most = 0

    def chunks():
        nonlocal taken
        for k in range(campaign.plan.chunks):
            taken += 1
            yield campaign.plan.chunk(k)

    job = WorkerTask(work, campaign.plan.engine, campaign.plan.software, campaign.folder / "shards")
    for _ in Processes(2, "fork").run(job, chunks(), lambda: False, lambda *_: None):
        finished += 1
        most = max(most, taken - finished)
    assert finished == 60
    assert most <= 4


def test_missing_dask_has_a_sentence(tmp_path, work, monkeypatch):
    """The extra is named."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r'needs distributed: pip install "rocking\[dask\]"'):
        Campaign.create(tmp_path / "c", work).run(DaskExecutor("tcp://127.0.0.1:9"))
