"""Rounds under other executors, and what is said where a round stops, is damaged, or is not the last."""

import errno
import os
import sqlite3

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, axes, digests, finished, job

from rocking.campaigns import (
    CampaignDamagedError,
    CampaignIncompleteError,
    CampaignInterrupted,
    CampaignStorageError,
    CampaignWorkerError,
    DaskExecutor,
    Serial,
)
from rocking.campaigns.jobs import Job, JobFolder, answer, export, forecast, rounds, status_of, verified
from rocking.errors import InvalidValueError
from rocking.studies.adaptive_grid import absent, merged

MAP = job(
    "overturning-map", BODY, PULSE, "[restitution]\nvalue = 0.9\n", axes((1, 7, 50), (1, 9, 50)),
    "refine = 0\ntolerance = 0.01\n", chunk=1000,
)  # fmt: skip
SMALL = MAP.replace("count = 50", "count = 4").replace("refine = 0", "refine = 1")


def begun(path, words=SMALL):
    """A campaign of which nothing is computed."""
    return JobFolder.create(path, Job.of_text(words))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The larger map, by threads of this process."""
    return finished(tmp_path_factory.mktemp("whole") / "c", MAP)


@pytest.mark.slow
def test_spawned_processes(whole, tmp_path):
    """Three chunks of 1000 in the first round, by spawned processes: the bits of one thread."""
    folder = begun(tmp_path / "c", MAP)
    folder.run("processes", workers=3, start_method="spawn")
    assert digests(folder) == digests(whole)


@pytest.mark.slow
def test_cluster(whole, tmp_path):
    """The same by workers of a Dask cluster."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=1, threads_per_worker=4, processes=False, dashboard_address=None) as dask:
        folder = begun(tmp_path / "c", MAP)
        folder.run(DaskExecutor(dask.scheduler_address))
    assert digests(folder) == digests(whole)


def test_executors_are_tried_before_anything_is_computed(tmp_path):
    """No scheduler, no such executor: said at once, also where no round would have been sent to it."""
    pytest.importorskip("distributed")
    folder = begun(tmp_path / "c")
    with pytest.raises(CampaignWorkerError, match=r"the Dask scheduler at tcp://127\.0\.0\.1:1 does not respond"):
        folder.run(DaskExecutor("tcp://127.0.0.1:1", timeout=0.3))
    for who, workers in (("threads", None), ("serial", 0), (Serial(), 2)):
        with pytest.raises(InvalidValueError):
            folder.run(who, workers=workers)
    assert status_of(folder.path).status.histories_done == 0
    assert folder.run(Serial(1)).computed > 0


class Stopping(rounds.Rounds):
    """Runs two rounds, and stops within the third as its campaign would."""

    error: BaseException = CampaignInterrupted("stopped: all 1 chunks are safe; run the campaign again")

    def advance(self, campaign):
        """Raise in the third round."""
        if campaign.folder.name == "round-002":
            raise self.error
        super().advance(campaign)


def test_interruption_names_the_job(tmp_path, monkeypatch):
    """Ctrl-C within a round: the folder that is named is the one to resume, quoted where it has blanks."""
    folder = begun(tmp_path / "my map")
    monkeypatch.setattr(rounds, "Rounds", Stopping)
    with pytest.raises(CampaignInterrupted) as told:
        folder.run(workers=1)
    assert str(told.value) == (
        f"{folder.path}: stopped in round 3; nothing that was recorded before is lost; "
        f"go on with: rocking campaign resume '{folder.path}'"
    )
    with pytest.raises(CampaignIncompleteError, match="3 rounds so far, and more rounds may follow") as told:
        export(folder, tmp_path / "r.csv", "boundary")
    assert f"rocking campaign resume '{folder.path}'" in str(told.value)


def test_full_disk_names_the_job(tmp_path, monkeypatch):
    """The disk is full within a round: why, which round, and how to go on; nothing about chunks of an inner folder."""
    folder = begun(tmp_path / "c")
    cause = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    error = CampaignStorageError("inner: No space left on device; 0 of 1 chunks are safe; run the campaign again")
    error.__cause__ = cause
    monkeypatch.setattr(rounds, "Rounds", Stopping)
    monkeypatch.setattr(Stopping, "error", error)
    with pytest.raises(CampaignStorageError) as told:
        folder.run(workers=1)
    assert str(told.value).startswith(f"{folder.path}: {os.strerror(errno.ENOSPC)} in round 3; nothing that was")
    assert str(told.value).endswith(f"go on with: rocking campaign resume {folder.path}")


@pytest.mark.slow
def test_damaged_ledger_of_a_round_is_made_anew(tmp_path):
    """Status and answers say how to go on, and going on computes nothing again."""
    folder = finished(tmp_path / "c", SMALL)
    before = digests(folder)
    (folder.path / "round-001" / "ledger.sqlite").write_bytes(b"this is not what was written" * 40)
    for call in (lambda: status_of(folder.path), lambda: answer(folder)):
        with pytest.raises(CampaignDamagedError, match=r"sqlite is damaged .*; go on with: rocking campaign resume"):
            call()
    assert "round-001: ledger.sqlite is damaged" in verified(folder.path).damaged[0]
    assert folder.run(workers=1).computed == 0
    assert (verified(folder.path).is_complete, digests(folder)) == (True, before)


@pytest.mark.slow
def test_damaged_round_and_its_way_out(tmp_path):
    """A round's plan damaged: status, answers and runs say which folder to remove, and doing so is the way out."""
    folder = finished(tmp_path / "c", SMALL)
    before = digests(folder)
    inner = folder.path / "round-001"
    (inner / "campaign.json").write_bytes(b"this is not what was written" * 40)
    words = f"{inner}/campaign.json is damaged; remove {inner} and go on with: rocking campaign resume {folder.path}"
    for call in (lambda: status_of(folder.path), lambda: answer(folder), lambda: folder.run(workers=1)):
        with pytest.raises(CampaignDamagedError) as told:
            call()
        assert words in str(told.value)
        assert not isinstance(told.value, sqlite3.Error)
    for path in (*(inner / "shards").iterdir(), *(each for each in inner.iterdir() if each.is_file())):
        path.unlink()
    (inner / "shards").rmdir()
    inner.rmdir()
    assert JobFolder.open(folder.path).run(workers=1).computed == 1
    assert digests(folder) == before


def test_forecast_of_later_rounds(whole):
    """What later rounds had lies between what was forecast, and memory grows with the points."""
    told, first = status_of(whole.path).status, whole.campaign.plan.count
    low, high = forecast(whole.job).later
    assert low < told.histories - first < high
    large = forecast(Job.of_text(MAP.replace("count = 50", "count = 2000")))
    assert large.memory > forecast(whole.job).memory + 80 * 4_000_000
    with pytest.raises(InvalidValueError, match="up to 10000000 points, got 16000000"):
        Job.of_text(MAP.replace("count = 50", "count = 4000"))


def test_sets_of_sorted_numbers():
    """Differences and unions of sorted numbers are those of numpy, whatever is empty or given twice."""
    rng = np.random.default_rng(3)
    for size, other in ((0, 0), (0, 5), (7, 0), (40, 30), (200, 1)):
        keys, known = rng.integers(0, 60, size), np.unique(rng.integers(0, 60, other))
        new = absent(keys, known)
        assert np.array_equal(new, np.setdiff1d(keys, known))
        assert np.array_equal(merged(known, new), np.union1d(known, keys))
