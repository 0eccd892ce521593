"""Files are whole or not there, in the order that outlives a power cut; one process runs a campaign; full disks."""

import errno
import multiprocessing
import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
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
        (sqlite3.SQLITE_FULL, CampaignStorageError, "all is safe; free disk space"),
        (sqlite3.SQLITE_READONLY, CampaignStorageError, "allow writing"),
        (sqlite3.SQLITE_IOERR_FSYNC, CampaignStorageError, "run the campaign again"),
        (sqlite3.SQLITE_BUSY, CampaignBusyError, "another process uses the ledger"),
        (sqlite3.SQLITE_CORRUPT, CampaignDamagedError, "run the campaign again"),
        (sqlite3.SQLITE_NOTADB, CampaignDamagedError, "rebuilds the ledger from the shards"),
    ],
)
def test_database_errors_have_sentences(tmp_path, code, kind, words):
    """What SQLite says becomes one of three errors, each with the way out."""
    error = sqlite3.OperationalError("it says")
    error.sqlite_errorcode = code
    with pytest.raises(kind, match=words), disk.guarded(tmp_path, lambda: "all is safe"):
        raise error


@pytest.mark.slow
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


@pytest.mark.slow
def test_second_resumer_is_told_who_runs_it(finished):
    """Two at once: the second one gets a sentence with process and machine, and harms nothing; after kill -9 it may."""
    before = finished.sha256()
    with holding(finished.folder) as process:
        with pytest.raises(CampaignBusyError, match=rf"process {process.pid} on .* runs this campaign; wait until"):
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


TRY = """
import sys
sys.path.insert(0, sys.argv[2])
from conftest import made
from rocking.campaigns import Campaign, CampaignStorageError
folder, chunk = sys.argv[1], 500
try:
    campaign = Campaign.open(folder, made(20_000))
except Exception:
    campaign = Campaign.create(folder, made(20_000), chunk)
try:
    campaign.run(workers=1)
except CampaignStorageError as error:
    print("REFUSED", error)
print("DONE", campaign.status().chunks_done, len(campaign.verify().damaged))
"""
HERE = Path(__file__).parent


def tried(script, timeout=HANG):
    """What a shell script says that has a file system of its own; it calls $TRY with the folder."""
    call = f'{sys.executable} -c "$CODE" "$1" {HERE}'
    command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-ec", f"attempt() {{ {call}; }}\n{script}"]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=timeout, env={**os.environ, "CODE": TRY}, check=False
    )
    return done.stdout + done.stderr


def can_mount(folder):
    if shutil.which("unshare") is None:
        return False
    return "yes" in tried(f"mount -t tmpfs -o size=1m none {folder} && echo yes")


@pytest.mark.slow
@pytest.mark.parametrize("call", range(1, 8))
def test_disk_full_at_any_file(campaign, tmp_path, work, monkeypatch, call, shards):
    """Whichever write is the first to fail, what was recorded before stays, and a later run finishes the same bytes."""
    whole = Campaign.create(tmp_path / "whole", work, 50)
    whole.run(workers=1)
    real, calls = disk._write_through, []

    def filling(path, data):
        calls.append(path)
        if len(calls) >= call:
            path.write_bytes(data[:100])
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(path, data)

    monkeypatch.setattr(disk, "_write_through", filling)
    if call <= 6:
        sentence = f"No space left on device; {call - 1} of 6 chunks are safe; free disk .* run the campaign again"
        with pytest.raises(CampaignStorageError, match=sentence):
            campaign.run(workers=1)
    else:
        campaign.run(workers=1)
    assert campaign.status().chunks_done == call - 1
    assert campaign.verify().damaged == ()
    monkeypatch.setattr(disk, "_write_through", real)
    assert campaign.run(workers=1).resumed == call - 1
    assert (shards(campaign), campaign.sha256()) == (shards(whole), whole.sha256())


@pytest.mark.slow
@pytest.mark.parametrize("code", [errno.EROFS, errno.EACCES, errno.EDQUOT, errno.EIO, errno.EFBIG])
def test_disk_that_refuses_from_workers(campaign, monkeypatch, code):
    """What goes wrong in a worker process is said where the campaign runs."""

    def refuse(*_):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(disk, "write_new", refuse)
    with pytest.raises(CampaignStorageError, match=f"{os.strerror(code)}; 0 of 6 chunks are safe"):
        campaign.run("processes", workers=2, start_method="fork")


def test_file_size_limit_of_the_system(campaign):
    """A limit that the system enforces: files may not grow beyond 40 kB, as on a quota."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
    try:
        with pytest.raises(CampaignStorageError, match="run the campaign again"):
            campaign.run(workers=1)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert campaign.run(workers=1).computed == 6


@pytest.mark.slow
def test_real_full_disk(tmp_path):
    """On a file system of 1 MB a campaign of 1.5 MB stops with a sentence; with more room it goes on and finishes."""
    room = tmp_path / "room"
    room.mkdir()
    if not can_mount(room):
        pytest.skip("this user cannot make a file system")
    said = tried(
        f"mount -t tmpfs -o size=1m none {room}; attempt {room}/c; mount -o remount,size=8m {room}; attempt {room}/c"
    )
    first, second, third = said.strip().splitlines()
    assert "REFUSED" in first
    assert "chunks are safe; free disk space" in first
    done, wrong = map(int, second.split()[1:])
    assert 0 < done < 40
    assert wrong == 0
    assert f"{done} of 40 chunks are safe" in first
    assert third == "DONE 40 0"


@pytest.mark.slow
def test_real_read_only_disk(finished, tmp_path):
    """On a file system that became read-only nothing is computed or lost, and results can still be read."""
    room = tmp_path / "room"
    room.mkdir()
    if not can_mount(room):
        pytest.skip("this user cannot make a file system")
    said = tried(
        f"mount -t tmpfs -o size=1m none {room}; attempt {room}/c; mount -o remount,ro,size=8m {room}; attempt {room}/c"
    )
    lines = said.strip().splitlines()
    assert "Read-only file system" in lines[2]
    assert lines[3] == lines[1]


def refused_as_nobody(finished):
    """0 if another user can read it, and is refused to run it."""
    child = os.fork()
    if not child:
        code = 1
        try:
            os.setuid(65534)
            readable = finished.status().chunks_done == 6 and len(finished.sha256()) == 64
            try:
                finished.run(workers=1)
            except CampaignStorageError as error:
                code = 0 if "Permission denied" in str(error) and readable else 2
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become somebody else")
def test_folder_of_somebody_else(work):
    """A user who may not write the folder is told so; status and results can still be had."""
    with tempfile.TemporaryDirectory() as room:  # the test's own folder is closed to others
        Path(room).chmod(0o755)
        finished = Campaign.create(Path(room) / "c", work, 50)
        finished.run(workers=1)
        assert refused_as_nobody(finished) == 0
