"""Kill a campaign at random instants, resume it, and compare what is left with what it had acknowledged.

Run as a process of its own: it forks campaigns that are groups of processes, and kills them. What it finds it prints as
JSON. With --variant it breaks the campaign on purpose, so that the checks themselves can be checked.
"""

import argparse
import hashlib
import json
import os
import random
import shutil
import signal
import sqlite3
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

from workload import histories

from rocking.studies.campaign import Campaign, disk, executors, ledger, shard
from rocking.studies.campaign.chunks import Plan
from rocking.studies.campaign.errors import CampaignDamagedError, CampaignWorkerError

CHUNK = 500
GAVE_UP = 3
RUNS = {
    "serial": {"executor": "serial", "workers": 1},
    "fork": {"executor": "processes", "workers": 2, "start_method": "fork"},
    "spawn": {"executor": "processes", "workers": 2, "start_method": "spawn"},
}


def files(folder: Path) -> dict[str, str]:
    """SHA-256 of every file that has its final name."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted((folder / "shards").glob("*"))
        if not path.name.startswith(".")
    }


class Kills:
    """Campaigns that are killed, and what was found wrong."""

    def __init__(self, folder: Path, how: str, variant: str, seed: int) -> None:
        self.folder, self.how, self.variant = folder, how, variant
        self.random = random.Random(seed)
        self.work = histories()
        self.counts: Counter[str] = Counter()
        self.wrong: list[str] = []
        whole = Campaign.create(folder / "whole", self.work, CHUNK)
        whole.run("serial", workers=1)
        self.plan: Plan = whole.plan
        self.digest, self.files = whole.sha256(), files(whole.folder)
        start = time.perf_counter()
        os.waitpid(self.start(folder / "timed", os.open(os.devnull, os.O_WRONLY)), 0)
        self.duration = time.perf_counter() - start

    def start(self, folder: Path, told: int) -> int:
        """Begin or go on with a campaign in a process group of its own, which says what it has acknowledged."""
        process = os.fork()
        if process:
            return process
        code = 1
        try:
            os.setsid()
            tell_records(told)
            break_on_purpose(self.variant)
            there = (folder / "campaign.json").exists()
            campaign = Campaign.open(folder, self.work) if there else Campaign.create(folder, self.work, CHUNK)
            campaign.run(**RUNS[self.how])
            code = 0
        except CampaignWorkerError:  # three workers were killed at the same chunk: a stated limit
            code = GAVE_UP
        except Exception:  # noqa: BLE001 (a forked process ends here, whatever it was)
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)

    def campaign(self, folder: Path, wanted: int) -> None:
        """Kill one campaign again and again until it is finished, or there are enough kills."""
        acknowledged: dict[int, str] = {}
        while self.counts["kills"] < wanted:
            reading, writing = os.pipe()
            process = self.start(folder, writing)
            os.close(writing)
            killed = self.kill_later(process)
            with os.fdopen(reading) as told:
                for line in told.read().split("\n")[:-1]:  # a line that was cut short was not said
                    number, seal = line.split()
                    acknowledged[int(number)] = seal
            self.compare(folder, acknowledged)
            if not killed:
                self.finish(folder)
                return

    def kill_later(self, process: int) -> bool:
        """Wait for a random time, then kill the whole group; whether it was still at work."""
        low = 0.4 if self.how == "spawn" else 0.0  # spawned workers spend the first half on imports
        end = time.perf_counter() + self.random.uniform(low, low + 0.7) * self.duration
        while time.perf_counter() < end:
            found, status = os.waitpid(process, os.WNOHANG)
            if found:
                self.counts["ended by themselves"] += 1
                if status:
                    self.wrong.append(f"a campaign ended with status {status}")
                return False
            time.sleep(0.001)
        try:
            os.killpg(process, signal.SIGKILL)
        except ProcessLookupError:  # it has no group of its own yet
            os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        self.counts["kills"] += 1
        return True

    def compare(self, folder: Path, acknowledged: dict[int, str]) -> None:
        """What was acknowledged is in the ledger and on disk, and what is on disk under its name is whole."""
        recorded = self.recorded(folder)
        for number, seal in (acknowledged | recorded).items():
            path = folder / "shards" / f"{self.plan.chunk(number).name}.shard"
            if recorded.get(number) != seal:
                self.wrong.append(f"chunk {number} was acknowledged, and is not in the ledger")
            if not path.exists():
                self.wrong.append(f"chunk {number} is recorded, and has no shard")
        names = {f"{self.plan.chunk(k).name}.shard": k for k in range(self.plan.chunks)}
        there = files(folder)
        for name in there:
            try:
                number = names[name]
                shard.unpack((folder / "shards" / name).read_bytes(), self.plan.chunk(number), recorded.get(number))
            except (KeyError, CampaignDamagedError) as error:
                self.wrong.append(f"{name[:20]}: {error}")
        self.counts["acknowledged, checked"] += len(acknowledged)
        self.counts["killed while writing"] += any((folder / "shards").glob(".*.part"))
        self.counts["killed between shard and record"] += len(there) > len(recorded)
        self.counts["killed before the first record"] += not recorded

    @staticmethod
    def recorded(folder: Path) -> dict[int, str]:
        """What the ledger has, read from a copy by plain SQL."""
        if not (folder / "ledger.sqlite").exists():
            return {}
        with tempfile.TemporaryDirectory() as place:
            for path in folder.glob("ledger.sqlite*"):
                shutil.copy(path, place)
            database = sqlite3.connect(Path(place) / "ledger.sqlite")
            tables = [name for (name,) in database.execute("SELECT name FROM sqlite_schema")]
            rows = database.execute("SELECT number, seal FROM chunks").fetchall() if "chunks" in tables else []
            database.close()
            return dict(rows)

    def finish(self, folder: Path) -> None:
        """A campaign that is through equals the one that nobody killed, byte by byte."""
        self.counts["campaigns finished"] += 1
        if files(folder) != self.files:
            self.wrong.append("the shards differ from those of an uninterrupted campaign")
        if Campaign.open(folder, self.work).sha256() != self.digest:
            self.wrong.append("the results differ from those of an uninterrupted campaign")
        shutil.rmtree(folder)

    def kill_workers(self, folder: Path, wanted: int) -> None:
        """Kill single workers of one campaign while it runs; it finishes by itself, or says that it gave up."""
        status = GAVE_UP
        while status == GAVE_UP:
            status = self.kill_workers_once(folder, wanted)
            self.compare(folder, {})
            self.counts["gave up after three, resumed"] += status == GAVE_UP
        self.counts["retries"] += Campaign.status_of(folder).retries
        if status:
            self.wrong.append(f"a campaign ended with status {status}")
        else:
            self.finish(folder)

    def kill_workers_once(self, folder: Path, wanted: int) -> int:
        """Run a campaign, kill its workers; its status."""
        told = os.open(os.devnull, os.O_WRONLY)
        process = self.start(folder, told)
        os.close(told)
        children = Path(f"/proc/{process}/task/{process}/children")
        while not (ended := os.waitpid(process, os.WNOHANG))[0]:
            time.sleep(self.random.uniform(0.0, self.duration / 4))
            found = children.read_text().split() if children.exists() and self.counts["kills"] < wanted else []
            if len(found) > 1:
                os.kill(int(self.random.choice(found[-2:])), signal.SIGKILL)
                self.counts["kills"] += 1
        return os.waitstatus_to_exitcode(ended[1])


def tell_records(told: int) -> None:
    """Have every record told right after its commit."""
    commit = ledger.Ledger.record

    def record(self: ledger.Ledger, row: ledger.Record) -> None:
        commit(self, row)
        os.write(told, f"{row.number} {row.seal}\n".encode())

    ledger.Ledger.record = record


def break_on_purpose(variant: str) -> None:
    """Make the campaign careless: the checks must see it."""
    if variant == "in-place":
        disk.write_new = write_in_place
    if variant == "record-first":
        kept: list[tuple[Path, bytes]] = []
        commit = ledger.Ledger.record

        def keep(self: executors.Job, chunk: object, data: bytes, seconds: float, worker: str = "") -> executors.Done:
            kept.append((self.folder / f"{chunk.name}.shard", data))
            return executors.Done(chunk, shard.seal(data), len(data), seconds, "careless")

        def record(self: ledger.Ledger, row: ledger.Record) -> None:
            commit(self, row)
            for path, data in kept:
                path.write_bytes(data)
            kept.clear()

        executors.Job.keep, ledger.Ledger.record = keep, record


def write_in_place(path: Path, data: bytes) -> None:
    """Write under the final name, as most programs do."""
    with path.open("wb", buffering=0) as file:
        for first in range(0, len(data), 512):
            file.write(data[first : first + 512])


def main() -> None:
    """Kill, and say what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--how", choices=RUNS, default="serial")
    parser.add_argument("--variant", choices=("none", "in-place", "record-first"), default="none")
    parser.add_argument("--workers", action="store_true", help="kill single workers rather than the whole group")
    asked = parser.parse_args()
    kills = Kills(asked.folder, asked.how, asked.variant, asked.seed)
    number = 0
    while kills.counts["kills"] < asked.kills and not (kills.wrong and asked.variant != "none"):
        (kills.kill_workers if asked.workers else kills.campaign)(asked.folder / str(number), asked.kills)
        number += 1
    print(json.dumps({"wrong": kills.wrong, "duration": kills.duration, **kills.counts}))


if __name__ == "__main__":
    main()
