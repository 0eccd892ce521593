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

from rocking.campaigns import Campaign, CampaignDamagedError, CampaignWorkerError, disk, executors, ledger
from rocking.campaigns import chunks as shard
from rocking.campaigns import executors as pace

CHUNK = 500
PIECE, CUT = 130, "KILL_DRIVER_CUTS"
"""Histories of a piece, where chunks are computed in pieces: as if these took a second."""
GAVE_UP = 3
RUNS = {
    "serial": {"executor": "serial", "workers": 1},
    "fork": {"executor": "processes", "workers": 2, "start_method": "fork"},
    "spawn": {"executor": "processes", "workers": 2, "start_method": "spawn"},
}


def files(folder):
    """SHA-256 of every file that has its final name."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted((folder / "shards").glob("*"))
        if not path.name.startswith(".")
    }


class Kills:
    """Campaigns that are killed, and what was found wrong."""

    def __init__(self, folder, how, variant, seed, pieces):
        self.folder, self.how, self.variant = folder, how, variant
        self.random = random.Random(seed)
        self.work = histories()
        self.counts: Counter[str] = Counter()
        self.wrong: list[str] = []
        whole = Campaign.create(folder / "whole", self.work, CHUNK)
        whole.run("serial", workers=1)
        self.plan = whole.plan
        self.digest, self.files = whole.sha256(), files(whole.folder)
        self.known = {}
        if pieces:
            os.environ[CUT] = "yes"  # for processes that do not inherit what this one does
            cut_in_pieces()
        start = time.perf_counter()
        os.waitpid(self.start(folder / "timed", os.open(os.devnull, os.O_WRONLY)), 0)
        self.duration = time.perf_counter() - start

    def start(self, folder, told):
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

    def campaign(self, folder, wanted):
        """Kill one campaign again and again until it is finished, or there are enough kills."""
        acknowledged = {}
        while self.counts["kills"] < wanted:
            reading, writing = os.pipe()
            process = self.start(folder, writing)
            os.close(writing)
            with os.fdopen(reading, "rb", buffering=0) as told:
                killed, records = self.kill_later(process, told)
                for line in (records + told.read()).decode().split("\n")[:-1]:  # a line that was cut short was not said
                    number, first, last, seal = line.split()
                    chunk = self.plan.chunk(int(number)).piece(int(first), int(last))
                    self.known[chunk.name] = chunk
                    acknowledged[chunk.name] = seal
            self.compare(folder, acknowledged)
            if not killed:
                self.finish(folder)
                return

    def kill_later(self, process, told):
        """Wait for a random number of records, then a random time, and kill the group; was it at work, what it told."""
        wanted, records = self.random.choice((0, 1, 1, 2)), b""
        while records.count(b"\n") < wanted and (more := told.read(4096)):
            records += more
        low = 0.4 if self.how == "spawn" and not wanted else 0.0  # spawned workers spend the first half on imports
        share = 1 / self.plan.chunks if wanted else 1.0
        end = time.perf_counter() + self.random.uniform(low, low + 0.7) * share * self.duration
        while True:
            found, status = os.waitpid(process, os.WNOHANG)
            if found:
                self.counts["ended by themselves"] += 1
                if status:
                    self.wrong.append(f"a campaign ended with status {status}")
                return False, records
            if time.perf_counter() >= end:
                break
            time.sleep(0.001)
        try:
            os.killpg(process, signal.SIGKILL)
        except ProcessLookupError:  # it has no group of its own yet
            os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        self.counts["kills"] += 1
        return True, records

    def compare(self, folder, acknowledged):
        """What was acknowledged is in the ledger and on disk, and what is on disk under its name is whole."""
        recorded = self.recorded(folder)
        whole = {chunk.name for chunk, _ in recorded.values() if not chunk.parent}
        kept = {name: seal for name, (_, seal) in recorded.items()}
        for name, seal in (acknowledged | kept).items():
            chunk = recorded[name][0] if name in recorded else self.known[name]
            if chunk.parent in whole:  # a piece, which has become part of its chunk
                continue
            what = f"histories {chunk.first} to {chunk.last - 1}"
            if kept.get(name) != seal:
                self.wrong.append(f"{what} were acknowledged, and are not in the ledger")
            if not executors.path_of(folder / "shards", chunk).exists():
                self.wrong.append(f"{what} are recorded, and have no shard")
        there = [*(folder / "shards").glob("*.shard"), *(folder / "pieces").glob("*.shard")]
        for path in there:
            try:
                data = path.read_bytes()
                first, last = shard.range_of(data)
                chunk = self.plan.chunk(first // CHUNK).piece(first, last)
                shard.unpack(data, chunk, kept.get(chunk.name))
            except CampaignDamagedError as error:
                self.wrong.append(f"{path.name[:20]}: {error}")
        done = sum(chunk.last - chunk.first for chunk, _ in recorded.values())
        self.counts["killed within a chunk"] += done % CHUNK != 0
        self.counts["acknowledged, checked"] += len(acknowledged)
        self.counts["killed while writing"] += any((folder / "shards").glob(".*.part"))
        self.counts["killed between shard and record"] += len(there) > len(recorded)
        self.counts["killed before the first record"] += not recorded

    def recorded(self, folder):
        """What the ledger has, read from a copy by plain SQL."""
        if not (folder / "ledger.sqlite").exists():
            return {}
        with tempfile.TemporaryDirectory() as place:
            for path in folder.glob("ledger.sqlite*"):
                shutil.copy(path, place)
            database = sqlite3.connect(Path(place) / "ledger.sqlite")
            tables = {name for (name,) in database.execute("SELECT name FROM sqlite_schema")} & {"chunks", "pieces"}
            rows = [
                row for table in tables for row in database.execute(f"SELECT number, first, last, seal FROM {table}")
            ]
            database.close()
        found = [(self.plan.chunk(number).piece(first, last), seal) for number, first, last, seal in rows]
        return {chunk.name: (chunk, seal) for chunk, seal in found}

    def finish(self, folder):
        """A campaign that is through equals the one that nobody killed, byte by byte."""
        self.counts["campaigns finished"] += 1
        if files(folder) != self.files:
            self.wrong.append("the shards differ from those of an uninterrupted campaign")
        if Campaign.open(folder, self.work).sha256() != self.digest:
            self.wrong.append("the results differ from those of an uninterrupted campaign")
        shutil.rmtree(folder)

    def kill_workers(self, folder, wanted):
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

    def kill_workers_once(self, folder, wanted):
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


def cut_in_pieces():
    """Have pieces end after some histories, rather than after a second."""
    pace.PIECE = 0.0
    pace.Pace.until = lambda self, first, last: min(first + PIECE, last)


def tell_records(told):
    """Have every record told right after its commit."""
    for name in ("record", "record_piece"):

        def record(self, row, commit: object = getattr(ledger.Ledger, name)):
            commit(self, row)
            os.write(told, f"{row.number} {row.first} {row.last} {row.seal}\n".encode())

        setattr(ledger.Ledger, name, record)


def break_on_purpose(variant):
    """Make the campaign careless: the checks must see it."""
    if variant == "in-place":
        disk.write_new = write_in_place
    if variant == "record-first":
        kept = []
        commit = ledger.Ledger.record

        def keep(self, chunk, data, seconds, worker=""):
            kept.append((self.folder / f"{chunk.name}.shard", data))
            return executors.Done(chunk, shard.seal(data), len(data), seconds, "careless")

        def record(self, row):
            commit(self, row)
            for path, data in kept:
                path.write_bytes(data)
            kept.clear()

        executors.WorkerTask.keep, ledger.Ledger.record = keep, record


def write_in_place(path, data):
    """Write under the final name, as most programs do."""
    with path.open("wb", buffering=0) as file:
        for first in range(0, len(data), 512):
            file.write(data[first : first + 512])


def main():
    """Kill, and say what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--how", choices=RUNS, default="serial")
    parser.add_argument("--variant", choices=("none", "in-place", "record-first"), default="none")
    parser.add_argument("--pieces", action="store_true", help="compute chunks in pieces")
    parser.add_argument("--workers", action="store_true", help="kill single workers rather than the whole group")
    asked = parser.parse_args()
    kills = Kills(asked.folder, asked.how, asked.variant, asked.seed, asked.pieces)
    number = 0
    while kills.counts["kills"] < asked.kills and not (kills.wrong and asked.variant != "none"):
        (kills.kill_workers if asked.workers else kills.campaign)(asked.folder / str(number), asked.kills)
        number += 1
    print(json.dumps({"wrong": kills.wrong, "duration": kills.duration, **kills.counts}))


if CUT in os.environ:
    cut_in_pieces()
if __name__ == "__main__":
    main()
