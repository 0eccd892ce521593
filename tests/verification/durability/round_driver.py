"""Kill an adaptive campaign at random instants, resume it, and compare its rounds with those of one left alone.

Run as a process of its own: it forks campaigns and kills them. What it finds it prints as JSON. --variant breaks
campaigns on purpose, so that the checks themselves can be checked.
"""

import argparse
import json
import os
import random
import shutil
import signal
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from rocking.campaigns import Campaign, disk, ledger
from rocking.campaigns.identity import Identity
from rocking.campaigns.jobs import Job, JobFolder, answer, status_of
from rocking.errors import RockingError

JOB = """[campaign]
name = "killed again and again"
kind = "overturning-map"
chunk = 60
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=0.6"
[map]
x = { axis = "frequency_ratio", from = 1, to = 7, count = 12 }
y = { axis = "amplitude_ratio", from = 1, to = 9, count = 12 }
refine = 2
tolerance = 1e-3
"""


def rounds(folder: Path) -> dict[str, str]:
    """Hash of the results of every round."""
    plans = {path: Identity.read(path).plan for path in sorted(folder.glob("round-*"))}
    return {path.name: ledger.digest(ledger.pieces(path, plan)) for path, plan in plans.items()}


class Kills:
    """Campaigns in rounds that are killed, and what was found wrong."""

    def __init__(self, folder: Path, variant: str, seed: int) -> None:
        self.folder, self.variant, self.random = folder, variant, random.Random(seed)
        self.job = Job.of_text(JOB)
        self.counts: Counter[str] = Counter()
        self.wrong: list[str] = []
        whole = JobFolder.create(folder / "whole", self.job)
        start = time.perf_counter()
        whole.run(workers=1)
        self.duration = time.perf_counter() - start
        self.rounds, self.lines = rounds(whole.path), self.vertices(whole)

    @staticmethod
    def vertices(folder: JobFolder) -> bytes:
        """The polylines, to the last bit."""
        return b"".join(line.points.tobytes() for line in answer(folder).value[1])

    def start(self, folder: Path, told: int) -> int:
        """Begin or go on with a campaign in a process of its own, which says what it has acknowledged."""
        process = os.fork()
        if process:
            return process
        code = 1
        try:
            tell_records(told)
            if self.variant == "in-place":
                disk.write_new = lambda path, data: path.open("wb", buffering=0).write(data[: len(data) // 2])
            there = (folder / "job.toml").exists()
            made = JobFolder.open(folder) if there else JobFolder.create(folder, self.job)
            made.run(workers=1)
            code = 0
        except RockingError:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)

    def campaign(self, folder: Path, wanted: int) -> None:
        """Kill one campaign again and again until it is finished, or there are enough kills."""
        safe = 0
        while True:
            reader, writer = os.pipe()
            process = self.start(folder, writer)
            os.close(writer)
            killed = self.counts["kills"] < wanted and self.kill_later(process)
            if not killed and os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]):
                self.wrong.append("a campaign ended by itself, with an error")
                return
            with os.fdopen(reader, "rb") as told:
                safe += len(told.read())
            try:
                self.compare(folder, safe)
                if not killed:
                    self.finish(folder)
            except RockingError as error:  # what was left cannot be read
                self.wrong.append(str(error))
            if not killed or self.wrong:
                return

    def kill_later(self, process: int) -> bool:
        """Wait for a random time, then kill; whether it was still at work."""
        time.sleep(self.random.uniform(0.0, 0.6) * self.duration)
        if os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            return False
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        self.counts["kills"] += 1
        return True

    def compare(self, folder: Path, safe: int) -> None:
        """As many chunks as were acknowledged are there, and whole; a finished round has the bits of a quiet one."""
        self.counts["acknowledged, checked"] += safe
        if not (folder / "job.toml").exists():
            return
        found = status_of(folder)
        done = 0 if found.status is None else found.status.chunks_done
        if done < safe:
            self.wrong.append(f"{safe} chunks were acknowledged, {done} are there")
        self.counts["killed between rounds"] += found.status is not None and found.status.chunks == done
        for path in sorted(folder.glob("round-*")):
            if (path / "campaign.json").exists() and Campaign.status_of(path).complete:
                digest = ledger.digest(ledger.pieces(path, Identity.read(path).plan))
                if digest != self.rounds.get(path.name):
                    self.wrong.append(f"{path.name} differs from that of an uninterrupted campaign")

    def finish(self, folder: Path) -> None:
        """A campaign that is through equals the one that nobody killed."""
        self.counts["campaigns finished"] += 1
        if rounds(folder) != self.rounds or self.vertices(JobFolder.open(folder)) != self.lines:
            self.wrong.append("the results differ from those of an uninterrupted campaign")
        shutil.rmtree(folder)


def tell_records(told: int) -> None:
    """Have a byte told right after every commit."""
    commit = ledger.Ledger.record

    def record(self: ledger.Ledger, row: ledger.LedgerEntry) -> None:
        commit(self, row)
        os.write(told, b".")

    ledger.Ledger.record = record


def main() -> None:
    """Kill, and say what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--variant", choices=("none", "in-place"), default="none")
    asked = parser.parse_args()
    kills = Kills(asked.folder, asked.variant, asked.seed)
    number = 0
    while (kills.counts["kills"] < asked.kills or not number) and not kills.wrong:
        kills.campaign(asked.folder / str(number), asked.kills)
        number += 1
    print(json.dumps({"wrong": kills.wrong, "rounds": len(kills.rounds), "duration": kills.duration, **kills.counts}))


if __name__ == "__main__":
    main()
