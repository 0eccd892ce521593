"""One process runs a campaign at a time, and a killed one keeps nobody out."""

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rocking.campaigns import Campaign, CampaignBusyError
from rocking.campaigns.disk import FolderLock, holder
from rocking.studies import HistoryTable

HOLD = """
import sys, time
from pathlib import Path
from rocking.campaigns.disk import FolderLock
with FolderLock(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def holding(folder: Path) -> subprocess.Popen[str]:
    process = subprocess.Popen([sys.executable, "-c", HOLD, str(folder)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    return process


def test_second_resumer_is_told_who_runs_it(finished: Campaign) -> None:
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


def test_two_threads_of_one_process_exclude_each_other(tmp_path: Path) -> None:
    """The lock belongs to the one who took it, not to the process."""
    with FolderLock(tmp_path), pytest.raises(CampaignBusyError), FolderLock(tmp_path):
        pass
    with FolderLock(tmp_path):
        assert holder(tmp_path) == f"process {os.getpid()} on {os.uname().nodename}"
    assert holder(tmp_path) is None


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
def test_forked_child_does_not_hold_on(tmp_path: Path) -> None:
    """A child that outlives the holder does not keep the folder busy."""
    with FolderLock(tmp_path):
        child = os.fork()
        if not child:
            signal.pause()
            os._exit(0)
    try:
        deadline = time.monotonic() + 10.0  # the child must have run at all
        while holder(tmp_path) and time.monotonic() < deadline:
            time.sleep(0.01)
        assert holder(tmp_path) is None
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def test_creation_is_exclusive(tmp_path: Path, work: HistoryTable) -> None:
    """Nobody can create a campaign in a folder where one is being made."""
    (tmp_path / "c").mkdir()
    with FolderLock(tmp_path / "c"), pytest.raises(CampaignBusyError):
        Campaign.create(tmp_path / "c", work)
