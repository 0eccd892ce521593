"""Which chunks are finished, kept by the process of the campaign alone, and results read piece by piece from them."""

import hashlib
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import FORMAT, Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignIncompleteError, ledger_damaged, sync_folder
from rocking.campaigns.executors import path_of
from rocking.campaigns.identity import SHARDS, Identity
from rocking.campaigns.status import Costs
from rocking.dynamics.plane.fast_engine import Arrays

NAME = "ledger.sqlite"
_ALL = "(SELECT * FROM chunks UNION ALL SELECT * FROM pieces)"
_TABLES = """
CREATE TABLE IF NOT EXISTS chunks (
    number INTEGER PRIMARY KEY, first INTEGER NOT NULL, last INTEGER NOT NULL, name TEXT NOT NULL UNIQUE,
    seal TEXT NOT NULL, size INTEGER NOT NULL, attempts INTEGER NOT NULL, seconds REAL NOT NULL,
    worker TEXT NOT NULL, finished TEXT NOT NULL, sum TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS pieces (
    number INTEGER NOT NULL, first INTEGER PRIMARY KEY, last INTEGER NOT NULL, name TEXT NOT NULL UNIQUE,
    seal TEXT NOT NULL, size INTEGER NOT NULL, attempts INTEGER NOT NULL, seconds REAL NOT NULL,
    worker TEXT NOT NULL, finished TEXT NOT NULL, sum TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS events (
    id INTEGER PRIMARY KEY, happened TEXT NOT NULL, what TEXT NOT NULL, chunk INTEGER, detail TEXT NOT NULL);
"""


class LedgerEntry(NamedTuple):
    """A finished chunk, or a piece of one."""

    number: int
    first: int
    last: int
    name: str
    seal: str
    size: int
    attempts: int
    seconds: float
    worker: str
    finished: str


class Ledger:
    """The ledger of a campaign: what it has recorded outlives the process, the machine and a power cut."""

    def __init__(self, folder: Path, *, writable: bool = False) -> None:
        self._folder = folder
        self._database = _writable(folder / NAME) if writable else _readable(folder / NAME)

    def __enter__(self) -> "Ledger":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def begun(self) -> bool:
        """Whether its tables are there: for an instant after its file is made they are not."""
        (tables,) = self._database.execute("SELECT count(*) FROM sqlite_schema").fetchone()
        return bool(tables)

    @contextmanager
    def instant(self) -> Iterator[None]:
        """Read as of one instant: between two questions another process may make a chunk of its pieces."""
        self._database.execute("BEGIN")
        try:
            yield
        finally:
            self._database.execute("COMMIT")

    def record(self, record: LedgerEntry) -> None:
        """Acknowledge a chunk, which takes the place of its pieces; on return this is on disk."""
        with self._database:
            self._database.execute("BEGIN")
            self._insert("chunks", record)
            self._database.execute("DELETE FROM pieces WHERE number = ?", (record.number,))

    def record_piece(self, record: LedgerEntry) -> None:
        """Acknowledge a piece of a chunk; on return this is on disk."""
        self._insert("pieces", record)

    def _insert(self, table: str, record: LedgerEntry) -> None:
        row = (*record, _sum(record))
        self._database.execute(f"INSERT OR REPLACE INTO {table} VALUES ({', '.join('?' * len(row))})", row)

    def forget(self, name: str) -> None:
        """Take a chunk or a piece back: its shard turned out to be damaged."""
        for table in ("chunks", "pieces"):
            self._database.execute(f"DELETE FROM {table} WHERE name = ?", (name,))

    def note(self, what: str, number: int | None, detail: str) -> None:
        """Write down what happened."""
        self._database.execute(
            "INSERT INTO events (happened, what, chunk, detail) VALUES (datetime('now'), ?, ?, ?)",
            (what, number, detail),
        )

    def records(self) -> Iterator[LedgerEntry]:
        """Return the finished chunks, in order; none that was changed behind the ledger's back."""
        return self._records("SELECT * FROM chunks ORDER BY number")

    def pieces(self) -> Iterator[LedgerEntry]:
        """Return the finished pieces of chunks that are not whole yet, in order; none that was changed."""
        return self._records("SELECT * FROM pieces ORDER BY first")

    def _records(self, query: str) -> Iterator[LedgerEntry]:
        for *values, checked in self._database.execute(query):
            record = LedgerEntry(*values)
            if _sum(record) != checked:
                raise ledger_damaged(self._folder, f"row {record.number!r:.20} has changed")
            yield record

    def check(self, plan: Plan) -> None:
        """Refuse a ledger that is damaged or of another campaign."""
        (state,) = self._database.execute("PRAGMA integrity_check(1)").fetchone()
        (version,) = self._database.execute("PRAGMA user_version").fetchone()
        if state != "ok" or version != FORMAT:
            why = f"it is of version {version} of these files, not {FORMAT}" if state == "ok" else str(state)
            raise ledger_damaged(self._folder, " ".join(why.split())[:120])
        whole = set()
        for record in self.records():
            whole.add(record.number)
            if record.number >= plan.chunks or plan.chunk(record.number)[:4] != record[:4]:
                why = f"its chunk {record.number} is not of this campaign"
                raise ledger_damaged(self._folder, why)
        end = 0
        for record in self.pieces():
            mine = record.number < plan.chunks and record.number not in whole
            if not mine or plan.chunk(record.number).piece(*record[1:3])[:4] != record[:4] or record.first < end:
                why = f"its histories {record.first} to {record.last - 1} are not of this campaign, or there twice"
                raise ledger_damaged(self._folder, why)
            end = record.last

    def finished(self) -> tuple[int, int]:
        """Return how many chunks are finished, and how many histories, those in pieces too."""
        query = f"SELECT (SELECT count(*) FROM chunks), (SELECT coalesce(sum(last - first), 0) FROM {_ALL})"
        chunks, histories = self._database.execute(query).fetchone()
        return int(chunks), int(histories)

    def effort(self) -> tuple[float, int]:
        """Return the seconds of all workers for what is finished, and the attempts beyond the first."""
        query = "SELECT coalesce(sum(seconds), 0), coalesce(sum(attempts - 1), 0) FROM " + _ALL
        seconds, retries = self._database.execute(query).fetchone()
        return float(seconds), int(retries)

    def costs(self, count: int) -> Costs:
        """Return what the histories have taken that are finished."""
        costs = Costs(count)
        rows = self._database.execute(f"SELECT first, last, seconds FROM {_ALL}").fetchall()
        if rows:
            costs.add(*(np.array(column) for column in zip(*rows, strict=True)))
        return costs

    def events(self, what: str) -> list[str]:
        """Return what happened of a kind."""
        rows = self._database.execute("SELECT detail FROM events WHERE what = ? ORDER BY id", (what,))
        return [str(detail) for (detail,) in rows]

    def close(self) -> None:
        """Let go of the file."""
        self._database.close()


def _writable(path: Path) -> sqlite3.Connection:
    fresh = not path.exists()
    database = sqlite3.connect(path, timeout=30.0, isolation_level=None)
    try:
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = FULL")
        database.execute("PRAGMA fullfsync = ON")
        (version,) = database.execute("PRAGMA user_version").fetchone()
        if version == 0:
            database.executescript(f"BEGIN IMMEDIATE; {_TABLES} PRAGMA user_version = {FORMAT}; COMMIT;")
    except sqlite3.DatabaseError:
        database.close()  # now: later it would remove the log of the ledger that takes its place
        raise
    if fresh:
        sync_folder(path.parent)
    return database


def _readable(path: Path) -> sqlite3.Connection:
    """Open without writing a byte where nobody writes: the log is there only while somebody does, or was killed."""
    address = f"{path.absolute().as_uri()}?mode=ro"
    if path.with_name(f"{path.name}-wal").exists():
        try:
            return _connected(address)
        except sqlite3.OperationalError:  # in a folder that cannot be written: what the log has beyond is not seen
            if not path.exists():
                raise
    return _connected(f"{address}&immutable=1")


def _connected(address: str) -> sqlite3.Connection:
    database = sqlite3.connect(address, timeout=5.0, isolation_level=None, uri=True)
    database.execute("SELECT name FROM sqlite_schema")
    return database


def _sum(record: LedgerEntry) -> str:
    return hashlib.sha256(repr(tuple(record)).encode()).hexdigest()[:32]


class HistoryRange(NamedTuple):
    """Results of some histories."""

    first: int
    last: int  # not included
    results: Arrays  # by the names of `Histories.columns`


def pieces(folder: Path, plan: Plan) -> Iterator[HistoryRange]:
    """Return the results of a finished campaign in the order of the histories, one chunk in memory at a time."""
    seals = {chunk.number: seal for chunk, seal in _records(folder, plan) if not chunk.of}
    if len(seals) < plan.chunks:
        raise CampaignIncompleteError(
            "{done} of {chunks} chunks are finished", done=len(seals), chunks=plan.chunks, hint="run the campaign"
        ).at(str(folder))
    for number in range(plan.chunks):
        chunk = plan.chunk(number)
        yield HistoryRange(chunk.first, chunk.last, _read(folder, chunk, seals[number]))


def digest(ranges: Iterator[HistoryRange]) -> str:
    """Return the SHA-256 of results, names and types; it does not depend on how they are cut."""
    columns: dict[str, Any] = {}
    for piece in ranges:
        for name, values in piece.results.items():
            each = columns.setdefault(f"{name} {values.dtype.name}", hashlib.sha256())
            each.update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes())
    text = "".join(f"{name} {each.hexdigest()}\n" for name, each in columns.items())
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Verification:
    """The state of a campaign's results, each of which was read."""

    histories: int
    verified: int  # histories whose results are there, to the last bit as they were written
    chunks: int  # whole chunks among the latter
    # a sentence for each shard that the ledger has and that is changed, cut short, of other histories, or missing; one
    # for a ledger that cannot be read, without which nothing counts
    damaged: tuple[str, ...]
    missing: tuple[tuple[int, int], ...]  # histories that are not there: first, last (not included)

    @property
    def whole(self) -> bool:
        """Whether all results are there, and are what was written."""
        return not self.damaged and not self.missing


def verified(folder: Path) -> Verification:
    """Read every shard that the ledger has, and see that they hold all histories, and none of them twice."""
    with disk.guarded(folder):
        plan = Identity.read(folder).plan
        try:
            with disk.guarded(folder):
                records = _records(folder, plan)
        except CampaignDamagedError as error:
            return Verification(plan.count, 0, 0, (str(error),), ())
        return _verified(folder, plan, records)


def _verified(folder: Path, plan: Plan, records: list[tuple[Chunk, str]]) -> Verification:
    damaged: list[str] = []
    there: list[tuple[int, int]] = []
    chunks = 0
    for chunk, sealed in records:
        try:
            _read(folder, chunk, sealed)
        except CampaignDamagedError as error:
            if chunk.of and not any(each == chunk for each, _ in _records(folder, plan)):
                return verified(folder)  # meanwhile whoever runs it has made a chunk of it
            damaged.append(str(error))
        else:
            there.append((chunk.first, chunk.last))
            chunks += not chunk.of
    missing, end = [], 0
    for first, last in [*sorted(there), (plan.count, plan.count)]:
        if end < first:
            missing.append((end, first))
        end = last
    done = sum(last - first for first, last in there)
    return Verification(plan.count, done, chunks, tuple(damaged), tuple(missing))


def _records(folder: Path, plan: Plan) -> list[tuple[Chunk, str]]:
    """Return the chunks and pieces that the ledger has, with their seals; it refuses those that overlap."""
    if not (folder / NAME).exists():
        return []
    with Ledger(folder) as ledger, ledger.instant():
        if not ledger.begun:
            return []
        ledger.check(plan)
        # a chunk's piece that is all of it is the chunk
        every = (*ledger.records(), *ledger.pieces())
        return [(plan.chunk(each.number).piece(each.first, each.last), each.seal) for each in every]


def _read(folder: Path, chunk: Chunk, sealed: str) -> Arrays:
    path = path_of(folder / SHARDS, chunk)
    advice = "run the campaign again: it is computed anew"
    try:
        return shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError as error:
        raise CampaignDamagedError("{path} is missing", path=path, hint=advice) from error
    except CampaignDamagedError as error:
        raise CampaignDamagedError("{reason}", reason=str(error), hint=advice).at(str(path)) from error
