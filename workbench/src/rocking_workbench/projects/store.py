"""Projects in one database, with all saved states for undo, redo and history."""

import json
import secrets
import sqlite3
import threading
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

from rocking.campaigns.disk import sync_folder
from rocking.spec.schema import migrated_document
from rocking_workbench.errors import Conflict, NoRoom, NotFound, Refused, TooLarge
from rocking_workbench.plain_text import shown
from rocking_workbench.settings import Limits

MOST_PROJECTS = 1_000
MOST_STATES = 2_000  # largest number of states of a project; then the oldest states are deleted
LARGEST = 1 << 20  # largest project as JSON [bytes]
KEPT_DAYS = 90  # time in which a deleted project can be restored [d]
_FORMAT = 1
_TABLES = """
CREATE TABLE projects (
    id TEXT PRIMARY KEY, name TEXT NOT NULL, created TEXT NOT NULL, changed TEXT NOT NULL,
    version INTEGER NOT NULL, here INTEGER NOT NULL, deleted TEXT) STRICT;
CREATE TABLE states (
    project TEXT NOT NULL REFERENCES projects ON DELETE CASCADE, number INTEGER NOT NULL, before INTEGER, after INTEGER,
    words TEXT NOT NULL, time TEXT NOT NULL, document BLOB NOT NULL, PRIMARY KEY (project, number)) STRICT;
"""


@dataclass(frozen=True)
class Project:
    """A project."""

    id: Annotated[str, "identifier in URLs"]
    name: Annotated[str, "display name"]
    created: Annotated[str, "time in UTC"]
    changed: Annotated[str, "time of the last change in UTC"]
    version: Annotated[int, "number of changes"]  # a change must name the present version
    state: Annotated[int, "number of the current state"]
    can_undo: bool
    can_redo: bool
    deleted: Annotated[str | None, f"when, in UTC; it can be brought back for {KEPT_DAYS} days"]


@dataclass(frozen=True)
class ProjectState:
    """A saved state of a project."""

    number: int
    description: Annotated[str, "description of the change"]
    time: Annotated[str, "time in UTC"]
    here: Annotated[bool, "true for the current state"]


def _alone(method: Callable[..., Project]) -> Callable[..., Project]:
    """Lock the store until a change and its answer are complete."""

    @wraps(method)
    def locked(self: "ProjectStore", *args: Any, **named: Any) -> Project:
        with self.lock:
            return method(self, *args, **named)

    return locked


class ProjectStore:
    """All projects of a data folder; thread-safe."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        path = Path(folder) / "projects.sqlite"
        fresh = not path.exists()
        if fresh:
            path.touch(mode=0o600)
        self.lock = threading.RLock()
        self._database = sqlite3.connect(path, timeout=30.0, isolation_level=None, check_same_thread=False)
        for setting in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON", "secure_delete = ON"):
            self._database.execute(f"PRAGMA {setting}")
        (page,) = self._database.execute("PRAGMA page_size").fetchone()
        self._database.execute(f"PRAGMA max_page_count = {limits.projects_bytes // page}")
        (version,) = self._database.execute("PRAGMA user_version").fetchone()
        if version == 0:
            self._database.executescript(f"BEGIN IMMEDIATE; {_TABLES} PRAGMA user_version = {_FORMAT}; COMMIT;")
        elif version > _FORMAT:
            self._database.close()
            raise Refused(
                "{file} was written by a later version of rocking; use that version, or another data folder (--data)",
                file=path.name,
            )
        if fresh:
            sync_folder(path.parent)
        with self._changing() as database:
            long_ago = _instant(datetime.now(UTC) - timedelta(days=KEPT_DAYS))
            database.execute("DELETE FROM projects WHERE deleted < ?", (long_ago,))

    def close(self) -> None:
        """Close the database."""
        with self.lock:
            self._database.close()

    def all(self, *, deleted: bool = False) -> list[Project]:
        """Return all projects, last changed first, or the deleted projects."""
        with self.lock:
            rows = self._database.execute(
                f"{_PROJECT} WHERE p.deleted IS {'NOT ' * deleted}NULL ORDER BY p.changed DESC, p.rowid DESC"
            ).fetchall()
        return [_project(row) for row in rows]

    def get(self, project: str) -> Project:
        """Return a project, including deleted projects."""
        with self.lock:
            row = self._database.execute(f"{_PROJECT} WHERE p.id = ?", (project,)).fetchone()
        if row is None:
            raise NotFound("project not found; it was deleted, or it is in another data folder")
        return _project(row)

    def document(self, project: str, state: int | None = None) -> dict[str, Any]:
        """Return the content of a project, now or in an earlier state."""
        with self.lock:
            number = self.get(project).state if state is None else state
            row = self._database.execute(
                "SELECT document FROM states WHERE project = ? AND number = ?", (project, number)
            ).fetchone()
        if row is None:
            raise NotFound("the project has no state {number}", number=number, hint="the oldest states are removed")
        return migrated_document(json.loads(zlib.decompress(row[0])))

    def history(self, project: str) -> list[ProjectState]:
        """Return all stored states of a project, newest first."""
        with self.lock:
            here = self.get(project).state
            rows = self._database.execute(
                "SELECT number, words, time FROM states WHERE project = ? ORDER BY number DESC", (project,)
            ).fetchall()
        return [ProjectState(number, description, time, number == here) for number, description, time in rows]

    @_alone
    def create(self, name: str, document: dict[str, Any], description: str = "begun") -> Project:
        """Create a project."""
        now, project, packed = _instant(), secrets.token_hex(8), _packed(document)
        with self._changing() as database:
            (count,) = database.execute("SELECT count(*) FROM projects WHERE deleted IS NULL").fetchone()
            if count >= MOST_PROJECTS:
                raise TooLarge(
                    "up to {limit} projects are stored",
                    limit=MOST_PROJECTS,
                    hint="delete items that are no longer needed",
                )
            database.execute("INSERT INTO projects VALUES (?, ?, ?, ?, 1, 1, NULL)", (project, _name(name), now, now))
            database.execute(
                "INSERT INTO states VALUES (?, 1, NULL, NULL, ?, ?, ?)", (project, description, now, packed)
            )
        return self.get(project)

    @_alone
    def save(self, project: str, version: int, document: dict[str, Any], description: str) -> Project:
        """Save a new state of a project after its current state."""
        packed = _packed(document)
        with self._followed(project, version) as (database, now, saved):
            (last,) = database.execute("SELECT max(number) FROM states WHERE project = ?", (project,)).fetchone()
            database.execute(
                "INSERT INTO states VALUES (?, ?, ?, NULL, ?, ?, ?)",
                (project, last + 1, saved.state, shown(description), now, packed),
            )
            self._lead(project, saved.state, last + 1)
            database.execute(
                "DELETE FROM states WHERE project = ? AND number <= ? AND number <> ?",
                (project, last + 1 - MOST_STATES, last + 1),
            )
        return self.get(project)

    @_alone
    def undo(self, project: str, version: int) -> Project:
        """Restore the previous state."""
        return self._step(project, version, "before", "there is no earlier state")

    @_alone
    def redo(self, project: str, version: int) -> Project:
        """Restore the state that was undone last."""
        return self._step(project, version, "after", "there is no later state")

    @_alone
    def restore(self, project: str, version: int, state: int) -> Project:
        """Save an earlier state of a project as a new state."""
        return self.save(project, version, self.document(project, state), f"as in state {state}")

    @_alone
    def rename(self, project: str, version: int, name: str) -> Project:
        """Rename a project."""
        new_name = _name(name)
        with self._followed(project, version) as (database, _, _):
            database.execute("UPDATE projects SET name = ? WHERE id = ?", (new_name, project))
        return self.get(project)

    @_alone
    def delete(self, project: str) -> Project:
        """Delete a project, which can be restored for a limited time."""
        self.get(project)
        with self._changing() as database:
            database.execute(
                "UPDATE projects SET deleted = ?, version = version + 1 WHERE id = ? AND deleted IS NULL",
                (_instant(), project),
            )
        return self.get(project)

    @_alone
    def bring_back(self, project: str) -> Project:
        """Restore a deleted project."""
        self.get(project)
        with self._changing() as database:
            database.execute(
                "UPDATE projects SET deleted = NULL, version = version + 1 WHERE id = ? AND deleted IS NOT NULL",
                (project,),
            )
        return self.get(project)

    def _step(self, project: str, version: int, way: str, nowhere: str) -> Project:
        with self._followed(project, version) as (database, _, saved):
            if not (saved.can_undo if way == "before" else saved.can_redo):
                raise Refused(nowhere)
            (number,) = database.execute(
                f"SELECT {way} FROM states WHERE project = ? AND number = ?", (project, saved.state)
            ).fetchone()
            if way == "before":
                self._lead(project, number, saved.state)
            database.execute("UPDATE projects SET here = ? WHERE id = ?", (number, project))
        return self.get(project)

    def _lead(self, project: str, before: int, after: int) -> None:
        """Store the next state of a state for redo, and make the next state current."""
        self._database.execute("UPDATE states SET after = ? WHERE project = ? AND number = ?", (after, project, before))
        self._database.execute("UPDATE projects SET here = ? WHERE id = ?", (after, project))

    @contextmanager
    def _followed(self, project: str, version: int) -> Iterator[tuple[sqlite3.Connection, str, Project]]:
        """Change a project if its version is current."""
        with self._changing() as database:
            saved, now = self.get(project), _instant()
            if saved.deleted is not None:
                raise Conflict("the project is deleted; restore it first")
            if saved.version != version:
                raise Conflict("the project was changed in another tab or browser; load it again")
            yield database, now, saved
            database.execute("UPDATE projects SET version = version + 1, changed = ? WHERE id = ?", (now, project))

    @contextmanager
    def _changing(self) -> Iterator[sqlite3.Connection]:
        """Change the database in one transaction."""
        with self.lock:
            try:
                self._database.execute("BEGIN IMMEDIATE")
                try:
                    yield self._database
                    self._database.execute("COMMIT")
                except BaseException:
                    if self._database.in_transaction:
                        self._database.execute("ROLLBACK")
                    raise
            except sqlite3.OperationalError as error:
                raise NoRoom(
                    "the project cannot be saved: {reason}", reason=str(error),
                    hint="Check the free disk space, the access rights of the folder and the number of projects.",
                ) from error  # fmt: skip


_PROJECT = """
SELECT p.id, p.name, p.created, p.changed, p.version, p.here, s.before IS NOT NULL AND b.number IS NOT NULL,
       s.after IS NOT NULL AND a.number IS NOT NULL, p.deleted
FROM projects p JOIN states s ON s.project = p.id AND s.number = p.here
LEFT JOIN states b ON b.project = p.id AND b.number = s.before
LEFT JOIN states a ON a.project = p.id AND a.number = s.after
"""


def _project(row: tuple[Any, ...]) -> Project:
    project, name, created, changed, version, here, undo, redo, deleted = row
    return Project(project, name, created, changed, version, here, bool(undo), bool(redo), deleted)


def _name(name: str) -> str:
    if not name.strip():
        raise Refused("a project needs a name")
    return shown(name)


def _packed(document: dict[str, Any]) -> bytes:
    data = json.dumps(document, allow_nan=False, separators=(",", ":")).encode()
    if len(data) > LARGEST:
        raise TooLarge(
            "a project may contain {limit} MiB without its records, got {size:.1f}; simplify the outline, or use a "
            "body file", limit=LARGEST >> 20, size=len(data) / 2**20,
        )  # fmt: skip
    return zlib.compress(data)


def _instant(time: datetime | None = None) -> str:
    return (time or datetime.now(UTC)).isoformat(timespec="milliseconds").replace("+00:00", "Z")
