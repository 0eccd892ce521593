"""Files are whole or not there, in the order that outlives a power cut; one process runs a campaign at a time."""

import errno
import multiprocessing
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest
from waiting import HANG

from rocking.campaigns import Campaign, CampaignBusyError, CampaignDamagedError, CampaignStorageError, disk
from rocking.campaigns.disk import FolderLock, holder
from rocking.campaigns.ledger import Ledger

SAFE = ["write", "sync file", "rename", "sync folder", "record"]


def traced(monkeypatch):
    """What reaches the system, in order."""
    seen: list[str] = []

    def watch(owner, name, word):
        real = getattr(owner, name)

        def call(*args, **kwargs):
            seen.append(word(*args) if callable(word) else word)
            return real(*args, **kwargs)

        monkeypatch.setattr(owner, name, call)

    watch(os, "write", "write")
    watch(os, "fsync", lambda handle: "sync folder" if Path(f"/proc/self/fd/{handle}").is_dir() else "sync file")
    watch(Path, "replace", "rename")
    watch(Ledger, "record", "record")
    return seen


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="/proc tells folders from files")
def test_record_comes_after_what_it_promises(tmp_path, work, monkeypatch):
    """For each chunk: written, flushed, renamed, folder flushed, and only then recorded."""
    campaign = Campaign.create(tmp_path / "c", work, 100)
    seen = traced(monkeypatch)
    campaign.run(workers=1)
    assert "".join(seen).count("".join(SAFE)) == 3


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="/proc tells folders from files")
@pytest.mark.parametrize("missing", ["_write_through", "sync_folder"])
def test_missing_flush_is_seen(tmp_path, work, monkeypatch, missing):
    """Negative control: without either flush the same question has another answer."""
    campaign = Campaign.create(tmp_path / "c", work, 100)
    monkeypatch.setattr(disk, missing, lambda path, data=b"": path.write_bytes(data) if data else None)
    seen = traced(monkeypatch)
    campaign.run(workers=1)
    assert "".join(SAFE) not in "".join(seen)


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="/proc tells which folder it is")
def test_new_folders_last(tmp_path, monkeypatch):
    """Each folder that was made on the way is flushed into the one it is in, from above; one that was there, too."""
    seen: list[Path] = []
    real = os.fsync

    def watched(handle):
        seen.append(Path(f"/proc/self/fd/{handle}").readlink())
        real(handle)

    monkeypatch.setattr(os, "fsync", watched)
    disk.make_folder(tmp_path / "a" / "b" / "c")
    assert seen == [tmp_path, tmp_path / "a", tmp_path / "a" / "b"]
    disk.make_folder(tmp_path / "a" / "b" / "c")
    assert seen[3:] == [tmp_path / "a" / "b"]


def test_synchronous_is_full(tmp_path):
    """The ledger's own setting: write-ahead log, flushed at every commit."""
    with Ledger(tmp_path, writable=True) as ledger:
        assert ledger._database.execute("PRAGMA journal_mode").fetchone() == ("wal",)
        assert ledger._database.execute("PRAGMA synchronous").fetchone() == (2,)


def test_failed_write_leaves_nothing(tmp_path, monkeypatch):
    """When the disk is full, no file under the name and none under another."""

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OSError, match="No space left"):
        disk.write_new(tmp_path / "a", b"data")
    assert list(tmp_path.iterdir()) == []


def test_short_writes_are_carried_on(tmp_path, monkeypatch):
    """A system that takes a few bytes at a time gets all of them."""
    real = os.write
    monkeypatch.setattr(os, "write", lambda handle, data: real(handle, data[:3]))
    disk.write_new(tmp_path / "a", b"0123456789")
    assert (tmp_path / "a").read_bytes() == b"0123456789"


def test_set_aside_deletes_nothing(tmp_path):
    """Damaged files are numbered, so that a second one does not replace the first."""
    for k in (1, 2):
        (tmp_path / "a").write_text(str(k), encoding="utf-8")
        assert disk.set_aside(tmp_path / "a").name == f"a.damaged-{k}"
    assert [(tmp_path / f"a.damaged-{k}").read_text(encoding="utf-8") for k in (1, 2)] == ["1", "2"]


@pytest.mark.parametrize(
    ("code", "kind", "words"),
    [
        (sqlite3.SQLITE_FULL, CampaignStorageError, "all is safe; make room"),
        (sqlite3.SQLITE_READONLY, CampaignStorageError, "allow writing"),
        (sqlite3.SQLITE_IOERR_FSYNC, CampaignStorageError, "run the campaign again"),
        (sqlite3.SQLITE_BUSY, CampaignBusyError, "another process holds the ledger"),
        (sqlite3.SQLITE_CORRUPT, CampaignDamagedError, "run the campaign again"),
        (sqlite3.SQLITE_NOTADB, CampaignDamagedError, "its shards make it anew"),
    ],
)
def test_database_errors_have_sentences(tmp_path, code, kind, words):
    """What SQLite says becomes one of three errors, each with the way out."""
    error = sqlite3.OperationalError("it says")
    error.sqlite_errorcode = code
    with pytest.raises(kind, match=words), disk.guarded(tmp_path, lambda: "all is safe"):
        raise error


@pytest.mark.parametrize(
    ("kind", "words"), [(FileNotFoundError, (2, "no chart")), (OSError, ("odd",)), (sqlite3.OperationalError, ("x",))]
)
@pytest.mark.parametrize("executor", [{"workers": 1}, {"executor": "processes", "start_method": "fork", "workers": 1}])
def test_errors_of_the_progress_are_not_the_disks(campaign, kind, words, executor):
    """What the function raises that is told of the progress comes out as it is; what was recorded is safe."""
    error = kind(*words)

    def tell(progress):
        if progress.chunks_done == 2:
            raise error

    with pytest.raises(kind) as found:
        campaign.run(**executor, progress=tell)
    assert found.value is error
    assert campaign.status().chunks_done == 2
    summary = campaign.run(workers=1)
    assert summary.resumed - summary.adopted == 2


def test_errors_of_the_listener_stay_what_they_are(tmp_path):
    """A closed pipe behind the progress is not the disk's fault."""
    with pytest.raises(BrokenPipeError), disk.guarded(tmp_path, lambda: ""):
        raise BrokenPipeError


HOLD = """
import sys, time
from pathlib import Path
from rocking.campaigns.disk import FolderLock
with FolderLock(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def holding(folder):
    process = subprocess.Popen([sys.executable, "-c", HOLD, str(folder)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    return process


def test_second_resumer_is_told_who_runs_it(finished):
    """Two at once: the second one gets a sentence with process and machine, and harms nothing; after kill -9 it may."""
    before = finished.sha256()
    with holding(finished.folder) as process:
        with pytest.raises(CampaignBusyError, match=rf"process {process.pid} on .* runs this campaign; wait for it"):
            finished.run()
        assert str(process.pid) in str(finished.status().running)
        process.kill()
    assert finished.status().running is None
    assert finished.run().computed == 0
    assert finished.sha256() == before


def test_two_threads_of_one_process_exclude_each_other(tmp_path):
    """The lock belongs to the one who took it, not to the process."""
    with FolderLock(tmp_path), pytest.raises(CampaignBusyError), FolderLock(tmp_path):
        pass
    with FolderLock(tmp_path):
        assert holder(tmp_path) == f"process {os.getpid()} on {os.uname().nodename}"
    assert holder(tmp_path) is None


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
def test_forked_child_does_not_hold_on(tmp_path):
    """A child that outlives the holder does not keep the folder busy."""
    with FolderLock(tmp_path):
        child = os.fork()
        if not child:
            signal.pause()
            os._exit(0)
    try:
        deadline = time.monotonic() + HANG  # the child must have run at all
        while holder(tmp_path) and time.monotonic() < deadline:
            time.sleep(0.01)
        assert holder(tmp_path) is None
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def test_creation_is_exclusive(tmp_path, work):
    """Nobody can create a campaign in a folder where one is being made."""
    (tmp_path / "c").mkdir()
    with FolderLock(tmp_path / "c"), pytest.raises(CampaignBusyError):
        Campaign.create(tmp_path / "c", work)
