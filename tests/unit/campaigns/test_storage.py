"""Full disks and folders that cannot be written: a sentence, nothing lost, and it goes on afterwards."""

import errno
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from waiting import HANG

from rocking.campaigns import Campaign, CampaignStorageError, disk

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
        sentence = f"No space left on device; {call - 1} of 6 chunks are safe; make room .* run the campaign again"
        with pytest.raises(CampaignStorageError, match=sentence):
            campaign.run(workers=1)
    else:
        campaign.run(workers=1)
    assert campaign.status().chunks_done == call - 1
    assert campaign.verify().damaged == ()
    monkeypatch.setattr(disk, "_write_through", real)
    assert campaign.run(workers=1).resumed == call - 1
    assert (shards(campaign), campaign.sha256()) == (shards(whole), whole.sha256())


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
    assert "chunks are safe; make room" in first
    done, wrong = map(int, second.split()[1:])
    assert 0 < done < 40
    assert wrong == 0
    assert f"{done} of 40 chunks are safe" in first
    assert third == "DONE 40 0"


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
