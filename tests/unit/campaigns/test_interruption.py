"""Ctrl-C and SIGTERM: a stop within a second, with what is finished recorded."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from waiting import HANG

from rocking.campaigns import Campaign, CampaignInterrupted
from rocking.campaigns.executors import Interruption

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
