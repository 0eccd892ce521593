"""The ledger of finished chunks, and the reading of their results. Only the campaign's process writes the ledger."""

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
    """Record of a finished chunk, or of a finished piece of a chunk."""

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
    """The ledger of a campaign: its records survive the process, the machine and a power failure."""

    def __init__(self, folder: Path, *, writable: bool = False) -> None:
        self._folder = folder
        self._database = _writable(folder / NAME) if writable else _readable(folder / NAME)

    def __enter__(self) -> "Ledger":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def begun(self) -> bool:
        """True if the tables exist; a new file has no tables for an instant."""
        (tables,) = self._database.execute("SELECT count(*) FROM sqlite_schema").fetchone()
        return bool(tables)

    @contextmanager
    def instant(self) -> Iterator[None]:
        """Read all queries at one instant, because another process may merge pieces between two queries."""
        self._database.execute("BEGIN")
        try:
            yield
        finally:
            self._database.execute("COMMIT")

    def record(self, record: LedgerEntry) -> None:
        """Record a chunk, which replaces its pieces; on return the record is on disk."""
        with self._database:
            self._database.execute("BEGIN")
            self._insert("chunks", record)
            self._database.execute("DELETE FROM pieces WHERE number = ?", (record.number,))

    def record_piece(self, record: LedgerEntry) -> None:
        """Record a piece of a chunk; on return the record is on disk."""
        self._insert("pieces", record)

    def _insert(self, table: str, record: LedgerEntry) -> None:
        row = (*record, _sum(record))
        self._database.execute(f"INSERT OR REPLACE INTO {table} VALUES ({', '.join('?' * len(row))})", row)

    def forget(self, name: str) -> None:
        """Remove the record of a chunk or piece with a damaged shard."""
        for table in ("chunks", "pieces"):
            self._database.execute(f"DELETE FROM {table} WHERE name = ?", (name,))

    def note(self, kind: str, number: int | None, detail: str) -> None:
        """Record an event."""
        self._database.execute(
            "INSERT INTO events (happened, what, chunk, detail) VALUES (datetime('now'), ?, ?, ?)",
            (kind, number, detail),
        )

    def records(self) -> Iterator[LedgerEntry]:
        """Return the finished chunks in order; a changed record is an error."""
        return self._records("SELECT * FROM chunks ORDER BY number")

    def pieces(self) -> Iterator[LedgerEntry]:
        """Return the finished pieces of incomplete chunks in order; a changed record is an error."""
        return self._records("SELECT * FROM pieces ORDER BY first")

    def _records(self, query: str) -> Iterator[LedgerEntry]:
        for *values, checked in self._database.execute(query):
            record = LedgerEntry(*values)
            if _sum(record) != checked:
                raise ledger_damaged(self._folder, f"row {record.number!r:.20} has changed")
            yield record

    def check(self, plan: Plan) -> None:
        """Refuse a ledger that is damaged or belongs to another campaign."""
        (state,) = self._database.execute("PRAGMA integrity_check(1)").fetchone()
        (version,) = self._database.execute("PRAGMA user_version").fetchone()
        if state != "ok" or version != FORMAT:
            reason = f"it is of version {version} of these files, not {FORMAT}" if state == "ok" else str(state)
            raise ledger_damaged(self._folder, " ".join(reason.split())[:120])
        complete = set()
        for record in self.records():
            complete.add(record.number)
            if record.number >= plan.chunks or plan.chunk(record.number)[:4] != record[:4]:
                reason = f"its chunk {record.number} is not of this campaign"
                raise ledger_damaged(self._folder, reason)
        end = 0
        for record in self.pieces():
            mine = record.number < plan.chunks and record.number not in complete
            if not mine or plan.chunk(record.number).piece(*record[1:3])[:4] != record[:4] or record.first < end:
                reason = f"its histories {record.first} to {record.last - 1} are not of this campaign, or there twice"
                raise ledger_damaged(self._folder, reason)
            end = record.last

    def finished(self) -> tuple[int, int]:
        """Return the number of finished chunks, and of finished histories including pieces."""
        query = f"SELECT (SELECT count(*) FROM chunks), (SELECT coalesce(sum(last - first), 0) FROM {_ALL})"
        chunks, histories = self._database.execute(query).fetchone()
        return int(chunks), int(histories)

    def effort(self) -> tuple[float, int]:
        """Return the time of all workers for finished chunks [s], and the number of further attempts."""
        query = "SELECT coalesce(sum(seconds), 0), coalesce(sum(attempts - 1), 0) FROM " + _ALL
        seconds, retries = self._database.execute(query).fetchone()
        return float(seconds), int(retries)

    def costs(self, count: int) -> Costs:
        """Return the costs of the finished histories."""
        costs = Costs(count)
        rows = self._database.execute(f"SELECT first, last, seconds FROM {_ALL}").fetchall()
        if rows:
            costs.add(*(np.array(column) for column in zip(*rows, strict=True)))
        return costs

    def events(self, kind: str) -> list[str]:
        """Return the events of a kind."""
        rows = self._database.execute("SELECT detail FROM events WHERE what = ? ORDER BY id", (kind,))
        return [str(detail) for (detail,) in rows]

    def close(self) -> None:
        """Close the file."""
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
        database.close()  # close now, because a later close would remove the log of the new ledger
        raise
    if fresh:
        sync_folder(path.parent)
    return database


def _readable(path: Path) -> sqlite3.Connection:
    """Open read-only if no process writes. The log exists only during a run or after a kill."""
    address = f"{path.absolute().as_uri()}?mode=ro"
    if path.with_name(f"{path.name}-wal").exists():
        try:
            return _connected(address)
        except sqlite3.OperationalError:  # in a read-only folder, newer records of the log are not visible
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
    last: int  # history after the last one
    results: Arrays  # results by the names in `Histories.columns`


def pieces(folder: Path, plan: Plan) -> Iterator[HistoryRange]:
    """Return the results of a finished campaign in the order of the histories, with one chunk in memory at a time."""
    seals = {chunk.number: seal for chunk, seal in _records(folder, plan) if not chunk.parent}
    if len(seals) < plan.chunks:
        raise CampaignIncompleteError(
            "{done} of {chunks} chunks are finished", done=len(seals), chunks=plan.chunks, hint="run the campaign"
        ).at(str(folder))
    for number in range(plan.chunks):
        chunk = plan.chunk(number)
        yield HistoryRange(chunk.first, chunk.last, _read(folder, chunk, seals[number]))


def digest(ranges: Iterator[HistoryRange]) -> str:
    """Return the SHA-256 of results, names and types. This hash does not depend on the chunk size."""
    columns: dict[str, Any] = {}
    for piece in ranges:
        for name, values in piece.results.items():
            column = columns.setdefault(f"{name} {values.dtype.name}", hashlib.sha256())
            column.update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes())
    text = "".join(f"{name} {column.hexdigest()}\n" for name, column in columns.items())
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Verification:
    """Result of reading all shards of a campaign."""

    histories: int
    verified: int  # histories with unchanged results
    chunks: int  # complete chunks with unchanged results
    # one sentence per recorded shard that is changed, incomplete, missing, or belongs to other histories, and one
    # sentence for an unreadable ledger
    damaged: tuple[str, ...]
    missing: tuple[tuple[int, int], ...]  # ranges of missing histories: first history, history after the last one

    @property
    def is_complete(self) -> bool:
        """True if all results exist and are unchanged."""
        return not self.damaged and not self.missing


def verified(folder: Path) -> Verification:
    """Read every recorded shard, and check that each history exists once."""
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
    verified_ranges: list[tuple[int, int]] = []
    chunks = 0
    for chunk, sealed in records:
        try:
            _read(folder, chunk, sealed)
        except CampaignDamagedError as error:
            if chunk.parent and not any(listed == chunk for listed, _ in _records(folder, plan)):
                return verified(folder)  # a running process has merged this piece meanwhile
            damaged.append(str(error))
        else:
            verified_ranges.append((chunk.first, chunk.last))
            chunks += not chunk.parent
    missing, end = [], 0
    for first, last in [*sorted(verified_ranges), (plan.count, plan.count)]:
        if end < first:
            missing.append((end, first))
        end = last
    done = sum(last - first for first, last in verified_ranges)
    return Verification(plan.count, done, chunks, tuple(damaged), tuple(missing))


def _records(folder: Path, plan: Plan) -> list[tuple[Chunk, str]]:
    """Return the recorded chunks and pieces with their seals."""
    if not (folder / NAME).exists():
        return []
    with Ledger(folder) as ledger, ledger.instant():
        if not ledger.begun:
            return []
        ledger.check(plan)
        # a piece with all histories of a chunk is the chunk
        entries = (*ledger.records(), *ledger.pieces())
        return [(plan.chunk(record.number).piece(record.first, record.last), record.seal) for record in entries]


def _read(folder: Path, chunk: Chunk, sealed: str) -> Arrays:
    path = path_of(folder / SHARDS, chunk)
    advice = "run the campaign again to compute it"
    try:
        return shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError as error:
        raise CampaignDamagedError("{path} is missing", path=path, hint=advice) from error
    except CampaignDamagedError as error:
        raise CampaignDamagedError("{reason}", reason=str(error), hint=advice).at(str(path)) from error
