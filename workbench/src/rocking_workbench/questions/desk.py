"""All runs of a data folder: queued, running, finished or stopped; interrupted runs restart."""

import json
import logging
import os
import secrets
import shutil
import subprocess
import sys
import threading
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import TypeAdapter

from rocking.campaigns.disk import write_new
from rocking.errors import RockingError
from rocking.messages import Message
from rocking.motions.formats import formats
from rocking.restitution.from_file import file_of
from rocking_workbench.errors import Busy, NotFound, Refused, TooLarge, check_room, room_on_disk
from rocking_workbench.inputs import levels
from rocking_workbench.plain_text import safe_name, shown, toml_of
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits
from rocking_workbench.work import kill

Command = Literal[
    "assess", "predict", "identify", "inventory", "record convert", "record batch", "overturning-pga", "equilibria",
    "restitution", "simulate", "reproduce",
]  # fmt: skip
OUTPUTS: dict[str, tuple[str, ...]] = {
    "assess": ("picture.svg", "report.pdf", "report.html"),
    "predict": ("picture.svg", "report.pdf", "table.csv"),
    "identify": ("picture.svg", "report.pdf", "table.xlsx"),
    "equilibria": ("picture.svg", "space.glb", "table.csv"),
    "restitution": ("picture.svg", "space.glb", "table.csv"),
    "simulate": ("picture.svg", "space.glb", "table.csv"),
    "inventory": ("inventory.html", "inventory.pdf", "inventory.xlsx", "inventory.csv"),
    "record convert": ("picture.svg", "record.csv", "provenance.json"),
    "record batch": ("picture.svg", "table.csv", "table.xlsx"),
    "overturning-pga": ("picture.svg", "table.csv"),
    "reproduce": ("report.html", "report.pdf", "results.json"),
}
"""Commands and their output files."""

WITHOUT_FILE = "reproduce"  # the command that takes none, and writes a folder
FOLDER = "records"  # of a question, in which the files of a set are
MOST_QUESTIONS, MOST_WAITING, MOST_FILES = 500, 16, 1000
_SECONDS = 1800.0  # longest time of a question [s]
_IDLE = 900.0  # so long a process waits for the next question [s]
_ROOM = 32 << 20  # that a question may need on the disk [bytes]
_MOST_STARTS = 3  # restarts of a run after an end of the server
QUESTION, _NOTE, _ANSWER, _LOG = "question.toml", "state.json", "answer.json", "log.txt"
_OWN = {"matplotlibrc", _NOTE, _ANSWER, _LOG, QUESTION, *(name for names in OUTPUTS.values() for name in names)}
State = Literal["waiting", "running", "done", "refused", "stopped"]


@dataclass(frozen=True)
class HostedQuestion:
    """A run and its state."""

    id: Annotated[str, "identifier in URLs"]
    command: Command
    name: Annotated[str, "display name"]
    project: Annotated[str, "project of the item; empty if none"]
    asked: Annotated[str, "time in UTC"]
    state: State = "waiting"
    message: Annotated[str, "reason for a missing answer, or empty"] = ""
    refusal: Annotated[dict[str, Any] | None, "reason as an error with text and facts"] = None
    seconds: Annotated[float, "computing time [s]"] = 0.0
    files: Annotated[list[str], "files for export"] = field(default_factory=list)
    starts: int = 0  # number of starts
    format: Annotated[str, "additional output format of convert, or empty"] = ""


_QUESTION = TypeAdapter(HostedQuestion)
SCHEMA = 2  # of the notes on the disk; without a number it is 1
_RENAMED = {
    "cor": "restitution", "minimum": "overturning-pga", "convert": "record convert", "motions": "record batch",
    "paper": "reproduce",
}  # fmt: skip
"""Commands of schema 1 that have another name since."""
_LOG_OF_SERVER = logging.getLogger(__name__)


class QuestionDesk:
    """Thread-safe queue of runs, each in its own folder."""

    def __init__(self, folder: Path, stores: tuple[RecordStore, ...], limits: Limits) -> None:
        self.folder = Path(folder) / "questions"
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._stores, self._limits = stores, limits
        self._changed = threading.Condition(threading.RLock())
        self._questions = {run.id: run for run in self._kept()}
        self._line = [run.id for run in sorted(self._questions.values(), key=_age) if run.state == "waiting"]
        self._process: tuple[str, subprocess.Popen[bytes]] | None = None
        self._ahead: tuple[subprocess.Popen[bytes], dict[str, str]] | None = None  # of the next one, and around it
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="questions", daemon=True)
        self._thread.start()

    def ask(
        self,
        command: Command,
        tables: dict[str, Any],
        files: Mapping[str, str],
        name: str = "",
        project: str = "",
        format: str = "",
    ) -> HostedQuestion:
        """Queue a run; files: hashes of uploaded files, by their names in the tables."""
        if command not in OUTPUTS:
            raise Refused(parameter="command", allowed=f"one of {', '.join(OUTPUTS)}", value=command)
        if format and (command != "record convert" or format not in formats()):
            raise Refused(
                "{parameter} is allowed with convert only, one of {names}", parameter="format",
                names=", ".join(formats()),
            )  # fmt: skip
        if command == WITHOUT_FILE and (tables or files):
            raise Refused(
                "{command} accepts no tables and no files",
                command=command,
            )  # fmt: skip
        refuse_outside(tables)
        paths = self._paths(files)
        with self._changed:
            if len(self._line) >= MOST_WAITING:
                raise Busy("{count} runs are queued; try again later", count=len(self._line), seconds=5)
            if len(self._questions) >= MOST_QUESTIONS:
                raise TooLarge(
                    "up to {limit} runs are stored", limit=MOST_QUESTIONS,
                    hint="delete items that are no longer needed",
                )  # fmt: skip
        check_room(self.folder, _ROOM, self._limits.questions_bytes, "questions")
        now = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        question = HostedQuestion(secrets.token_hex(8), command, shown(name or command), project, now, format=format)
        folder = self.folder / question.id
        try:
            with room_on_disk():
                (folder / FOLDER).mkdir(mode=0o700, parents=True)
                for word, source in paths.items():
                    _link(source, folder / word)
                (folder / QUESTION).write_text(toml_of(tables), encoding="utf-8")
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        with self._changed:
            self._become(question)
            self._line.append(question.id)
            self._changed.notify_all()
        return question

    def all(self) -> list[HostedQuestion]:
        """Return all runs, newest first."""
        with self._changed:
            return sorted(self._questions.values(), key=_age, reverse=True)

    def get(self, question: str) -> HostedQuestion:
        with self._changed:
            run = self._questions.get(question)
        if run is None:
            raise NotFound("run not found; it was deleted, or it is in another data folder")
        return run

    def answer(self, question: str) -> bytes | None:
        """Return the answer as JSON, or None."""
        run = self.get(question)
        return (self.folder / run.id / _ANSWER).read_bytes() if run.state == "done" else None

    def tables(self, question: str) -> str:
        """Return the inputs of a run as an input file."""
        return (self.folder / self.get(question).id / QUESTION).read_text(encoding="utf-8")

    def file(self, question: str, name: str) -> Path:
        """Return the path of an output file."""
        run = self.get(question)
        if name not in run.files:
            raise NotFound(
                "unknown file {name!r:.40}; the run has {files}", name=name,
                files=", ".join(run.files) or "none",
            )  # fmt: skip
        return self.folder / run.id / name

    def stop(self, question: str) -> HostedQuestion:
        """Stop a running or queued run."""
        with self._changed:
            run = self.get(question)
            if run.state not in {"waiting", "running"}:
                return run
            if run.id in self._line:
                self._line.remove(run.id)
            self._become(replace(run, state="stopped", message="stopped"))
            if self._process is not None and self._process[0] == run.id:
                kill(self._process[1])
        return self.get(question)

    def delete(self, question: str) -> None:
        """Delete a run and its answer."""
        run = self.stop(question)
        with self._changed:
            self._questions.pop(run.id, None)
        shutil.rmtree(self.folder / run.id, ignore_errors=True)

    def close(self) -> None:
        """Stop the current run; it restarts with the next server."""
        with self._changed:
            self._closed = True
            if self._process is not None:
                kill(self._process[1])
            self._let_go()
            self._changed.notify_all()
        self._thread.join(10.0)

    def _kept(self) -> list[HostedQuestion]:
        """Return the runs of an earlier server; an interrupted run is queued."""
        runs = []
        for folder in list(self.folder.iterdir()):
            try:
                question = _QUESTION.validate_python(_migrated(json.loads((folder / _NOTE).read_bytes())))
            except FileNotFoundError:  # half written when that server ended
                if not folder.is_symlink():
                    shutil.rmtree(folder, ignore_errors=True)
                continue
            except (OSError, ValueError):  # possibly of a later version: kept unchanged
                continue
            if question.id == folder.name:
                if question.state == "running" and question.starts >= _MOST_STARTS:
                    message = f"the server ended {question.starts} times during the run; it may need more memory"
                    question = replace(question, state="refused", message=message)
                runs.append(replace(question, state="waiting") if question.state == "running" else question)
        return runs

    def _paths(self, files: Mapping[str, str]) -> dict[str, Path]:
        if len(files) > MOST_FILES:
            raise TooLarge("a run accepts up to {limit} files, got {count}", limit=MOST_FILES, count=len(files))
        paths = {}
        for word, sha in files.items():
            plain = word.removeprefix(f"{FOLDER}/")
            if plain != safe_name(plain, "file") or word.lower() in {*_OWN, FOLDER}:
                raise Refused(
                    "a file name must be plain, such as {example!r}, got {name!r:.60}",
                    example=safe_name(word, "file"), name=word,
                )  # fmt: skip
            if word.startswith("record."):
                raise Refused("{name!r:.60} is reserved for output; rename the file", name=word)
            paths[word] = self._path(sha)
        return paths

    def _path(self, sha: str) -> Path:
        for store in self._stores:
            with suppress(NotFound):
                return store.path(sha)
        raise NotFound("file {hash}... is not stored here; send it again", hash=str(sha)[:12])

    def _become(self, question: HostedQuestion) -> None:
        with self._changed:
            self._questions[question.id] = question
        with suppress(OSError):  # full disk: computed again after a restart
            write_new(self.folder / question.id / _NOTE, json.dumps({"schema": SCHEMA, **asdict(question)}).encode())

    def _work(self) -> None:
        """Compute the queued runs one after another."""
        while True:
            with self._changed:
                while not self._line and not self._closed:
                    if not self._changed.wait(_IDLE):
                        self._let_go()
                if self._closed:
                    return
                run = self._questions.get(self._line.pop(0))
                if run is None:
                    continue
                question = replace(run, state="running", starts=run.starts + 1)
                self._become(question)
            try:
                self._run(question)
            except Exception:  # noqa: BLE001 - a full disk, no more processes: the next question is answered all the same
                _LOG_OF_SERVER.exception("question %s could not be run", question.id)
                self._fail(question)

    def prepare(self) -> None:
        """Start the process of the next run in advance, to load its modules."""
        with self._changed, suppress(OSError):
            if self._closed or (self._ahead and self._ahead[0].poll() is None and self._ahead[1] == os.environ):
                return
            self._let_go()
            self._ahead = self._start(), dict(os.environ)

    def _let_go(self) -> None:
        with self._changed:
            if self._ahead is not None:
                _end(self._ahead[0])
            self._ahead = None

    def _start(self) -> subprocess.Popen[bytes]:
        cache = self.folder.with_name("cache")  # cache of libraries
        cache.mkdir(mode=0o700, exist_ok=True)
        nothing = subprocess.DEVNULL
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "rocking_workbench.questions.child"],
            stdin=subprocess.PIPE, stdout=nothing, stderr=nothing, start_new_session=True,
            env={**os.environ, "MPLCONFIGDIR": str(cache), "PYTHONUNBUFFERED": "1"},
        )  # fmt: skip

    def _run(self, question: HostedQuestion) -> None:
        folder, begun = self.folder / question.id, datetime.now(UTC)
        own = folder / ".own"
        own.mkdir(mode=0o700, exist_ok=True)
        job = {
            "folder": str(folder), "file": QUESTION, "answer": _ANSWER, "log": _LOG, "own": own.name,
            "arguments": _command(question),
        }  # fmt: skip
        for name in (_ANSWER, _LOG):
            (folder / name).write_bytes(b"")
        with self._changed:
            self.prepare()
            ahead, self._ahead = self._ahead, None
            process = self._start() if ahead is None else ahead[0]
            self._process = (question.id, process)
            if self._closed or self._state(question.id) == "stopped":
                kill(process)
        try:
            with suppress(OSError):  # ended: see its exit code
                process.stdin.write(json.dumps(job).encode() + b"\n")  # type: ignore[union-attr]
                process.stdin.flush()  # type: ignore[union-attr]
            code = process.wait(_SECONDS)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            _end(process)
        shutil.rmtree(own, ignore_errors=True)
        with self._changed:
            self._process = None
            if self._state(question.id) in {"stopped", None}:
                return
            if self._closed:  # regular shutdown: do not count this start
                self._become(replace(question, state="waiting", starts=question.starts - 1))
                return
            seconds = (datetime.now(UTC) - begun).total_seconds()
            names = [name.rpartition("=")[2] for name in _written(question)]
            there = [name for name in names if (folder / name).is_file()]
            state, refusal = ("done", None) if code == 0 else ("refused", _refusal(folder, code))
            message = refusal["message"] if refusal else ""
            self._become(
                replace(question, state=state, message=message, refusal=refusal, seconds=seconds, files=there)  # type: ignore[arg-type]
            )

    def _fail(self, question: HostedQuestion) -> None:
        with self._changed:
            self._process = None
            if self._state(question.id) == "running":
                message = "the run could not start; check the free disk space and the log of the server"
                self._become(replace(question, state="refused", message=message))

    def _state(self, question: str) -> str | None:
        """Return the state of a run; None if deleted."""
        with self._changed:
            run = self._questions.get(question)
        return None if run is None else run.state


def _migrated(note: Any) -> dict[str, Any]:
    """Return the note of a question of any schema as one of the present schema."""
    if not isinstance(note, dict) or (schema := note.pop("schema", 1)) not in range(1, SCHEMA + 1):
        raise ValueError
    command = note.get("command")
    return note if schema == SCHEMA else note | {"command": _RENAMED.get(str(command), command)}


def _written(question: HostedQuestion) -> list[str]:
    """Return the output files of a run, as values of --output."""
    form = question.format
    return [*OUTPUTS[question.command], *([f"{form}=record{formats()[form].suffixes[0]}"] if form else [])]


def _command(question: HostedQuestion) -> list[str]:
    """Return the command line of a run."""
    if question.command == WITHOUT_FILE:
        return [*question.command.split(), "--json", "--output", "."]
    outputs = [word for name in _written(question) for word in ("--output", name)]
    return [*question.command.split(), QUESTION, "--json", *outputs]


def refuse_outside(tables: dict[str, Any]) -> None:
    """Refuse texts of a run that name code or paths outside its folder."""
    for level in levels(tables):
        for word in level:
            if not isinstance(word, str):
                continue
            if file_of(word.strip()):
                raise Refused(
                    "{name!r:.60} names a code file, which is not allowed here", name=word, hint="use the command line"
                )
            if word.startswith(("/", "\\", "~")) or ".." in word.replace("\\", "/").split("/") or word[1:3] == ":\\":
                raise Refused("{name!r:.60} is a path; send the file and use its name only", name=word)


def _refusal(folder: Path, code: int | None) -> dict[str, Any]:
    """Return the reason for a missing answer as data."""
    if code is None:
        message = Message(
            ("the run exceeded {minutes:.0f} minutes; use the command line"),
            {"minutes": _SECONDS / 60.0},
        )
        return RockingError(message).data()
    log = (folder / _LOG).read_text(encoding="utf-8", errors="replace").replace(f"{folder}{os.sep}", "")
    for line in reversed(log.splitlines()):
        with suppress(ValueError, TypeError, KeyError):
            refusal: dict[str, Any] = json.loads(line)["error"]
            return refusal
    return RockingError("the run failed or exceeded its memory or time limit; its log is in the data folder").data()


def _link(source: Path, target: Path) -> None:
    """Link or copy an uploaded file into a run."""
    try:
        target.hardlink_to(source)
    except OSError:
        shutil.copyfile(source, target)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and close its input."""
    kill(process)
    process.wait()
    with suppress(OSError):
        process.stdin.close()  # type: ignore[union-attr]


def _age(question: HostedQuestion) -> tuple[str, str]:
    return question.asked, question.id
