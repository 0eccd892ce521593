"""Runs of commands: checks, storage and queue of inputs, and return of answers and output files."""

import json
import os
import shutil
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import TypeAdapter

from rocking.errors import RockingError
from rocking.messages import Message
from rocking.motions.formats import formats
from rocking.restitution.from_file import file_of
from rocking_workbench.errors import NotFound, Refused, TooLarge, check_room, room_on_disk
from rocking_workbench.inputs import levels
from rocking_workbench.plain_text import safe_name, shown, toml_of
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.folder import DONE, RUNNING, WAITING, RunFolder, new_id
from rocking_workbench.runs.process import LOG, RunProcess
from rocking_workbench.runs.runner import Run, Runner
from rocking_workbench.settings import Limits

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

WITHOUT_FILE = "reproduce"  # command without input file, which writes a folder
QUESTION, NOTE, ANSWER, OWN = "question.toml", "state.json", "answer.json", ".own"
"""Files and folders of a run."""
_MOST_STARTS = 3  # largest number of starts of a run that ends together with the server
State = Literal["waiting", "running", "done", "refused", "stopped"]
_RENAMED = {
    "cor": "restitution", "minimum": "overturning-pga", "convert": "record convert", "motions": "record batch",
    "paper": "reproduce",
}  # fmt: skip
"""Commands of schema 1 that have other names now."""
FOLDER = "records"  # folder of a run for the files of a record set
MOST_QUESTIONS, MOST_WAITING, MOST_FILES = 500, 16, 1000
_ROOM = 32 << 20  # required free disk space for a run [bytes]
_OWN = {"matplotlibrc", NOTE, ANSWER, LOG, QUESTION, *(name for names in OUTPUTS.values() for name in names)}


@dataclass(frozen=True)
class HostedQuestion:
    """A run and its state."""

    id: Annotated[str, "identifier in URLs"]
    command: Command
    name: Annotated[str, "display name"]
    project: Annotated[str, "project of the run; empty if none"]
    asked: Annotated[str, "time in UTC"]
    state: State = "waiting"
    message: Annotated[str, "reason for a missing answer, or empty"] = ""
    refusal: Annotated[dict[str, Any] | None, "reason as an error with text and facts"] = None
    seconds: Annotated[float, "computing time [s]"] = 0.0
    files: Annotated[list[str], "files for export"] = field(default_factory=list)
    starts: int = 0  # number of starts
    format: Annotated[str, "additional output format of convert, or empty"] = ""

    @property
    def created(self) -> str:
        return self.asked


class QuestionFolder(RunFolder):
    """The folder of a run of a command."""

    NOTE: ClassVar = NOTE
    SCHEMA: ClassVar = 2
    FORMAT: ClassVar = TypeAdapter(HostedQuestion)

    def present(self, data: dict[str, Any]) -> dict[str, Any]:
        """Return the data of a note with the present name of its command."""
        return data | {"command": _RENAMED.get(str(data.get("command")), data.get("command"))}


@dataclass
class QuestionRun(Run):
    """A run of a command."""

    GONE = "run not found; it was deleted, or it is in another data folder"
    FULL: ClassVar = {"text": "{count} runs are queued; try again later", "seconds": 5}
    FILES = (NOTE,)
    NICE = 10
    SECONDS = 1800.0

    folder: QuestionFolder
    note: HostedQuestion

    @classmethod
    def opened(cls, path: Path) -> Self | None:
        """Return a run of an earlier server; a run with which several servers ended is refused."""
        folder = QuestionFolder(path)
        note = folder.read()
        if note is None or note.id != path.name:  # the note may be of a later version and is not changed
            return None
        run = cls(folder, note)
        if note.state == RUNNING and note.starts >= _MOST_STARTS:
            run.become("refused", f"the server ended {note.starts} times during the run; it may need more memory")
        elif note.state == RUNNING:
            run.become(WAITING)
        return run

    def begin(self) -> None:
        """Count the start before the process runs, because the process may end the server."""
        self.note = replace(self.note, starts=self.note.starts + 1)
        super().begin()

    def finish(self, process: RunProcess | None, *, closed: bool) -> None:
        """Set the final state, or queue the run for the next server."""
        shutil.rmtree(self.folder.path / OWN, ignore_errors=True)
        if self.cancelled:
            self.become("stopped", "stopped")
        elif process is not None and closed:  # do not count a start that ended in a regular shutdown
            self.become(WAITING, starts=self.note.starts - 1)
        elif process is not None:
            seconds = time.monotonic() - self.started
            refusal = None if process.code == 0 else self._refusal(seconds)
            names = [name.rpartition("=")[2] for name in output_files(self.note)]
            files = [name for name in names if (self.folder.path / name).is_file()]
            state, message = ("refused", refusal["message"]) if refusal else (DONE, "")
            self.become(state, message, refusal=refusal, seconds=seconds, files=files)

    def fail(self, reason: str) -> None:
        """Set the state of a run without a process."""
        self.become("refused", "the run could not start; check the free disk space and the log of the server")

    def _refusal(self, seconds: float) -> dict[str, Any]:
        """Return the reason for a missing answer as data."""
        if seconds > self.SECONDS:
            text = "the run exceeded {minutes:.0f} minutes; use the command line"
            return RockingError(Message(text, {"minutes": self.SECONDS / 60.0})).data()
        failed = "the run failed or exceeded its memory or time limit; its log is in the data folder"
        return self.folder.refusal() or RockingError(failed).data()


class QuestionDesk:
    """Thread-safe list of runs of commands, each in its own folder."""

    def __init__(
        self, folder: Path, stores: tuple[RecordStore, ...], limits: Limits, runner: Runner | None = None
    ) -> None:
        self.folder = Path(folder) / "questions"
        self._stores, self._limits = stores, limits
        self._ahead: RunProcess | None = None  # process of the next run
        self.runner = runner or Runner()
        self.runner.at_idle = self._let_go
        self.runner.add(QuestionRun, self.folder, MOST_WAITING, self._start)

    def ask(
        self,
        command: Command,
        tables: dict[str, Any],
        files: Mapping[str, str],
        name: str = "",
        project: str = "",
        format: str = "",
    ) -> HostedQuestion:
        """Queue a run; `files` contains hashes of uploaded files, by their names in the tables."""
        if command not in OUTPUTS:
            raise Refused(parameter="command", allowed=f"one of {', '.join(OUTPUTS)}", value=command)
        if format and (command != "record convert" or format not in formats()):
            raise Refused(
                "{parameter} is allowed with record convert only, and must be one of {names}", parameter="format",
                names=", ".join(formats()),
            )  # fmt: skip
        if command == WITHOUT_FILE and (tables or files):
            raise Refused("{command} accepts no tables and no files", command=command)
        refuse_outside(tables)
        paths = self._paths(files)
        now = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        note = HostedQuestion(new_id(), command, shown(name or command), project, now, format=format)
        return self.runner.enter(QuestionRun, lambda: self._new_run(note, tables, paths)).note

    def _new_run(self, note: HostedQuestion, tables: dict[str, Any], paths: dict[str, Path]) -> QuestionRun:
        """Store the inputs and the note of a run."""
        if len(self.runner.published[QuestionRun]) >= MOST_QUESTIONS:
            raise TooLarge(
                "up to {limit} runs are stored", limit=MOST_QUESTIONS,
                hint="delete items that are no longer needed",
            )  # fmt: skip
        check_room(self.folder, _ROOM, self._limits.questions_bytes, "questions")
        folder = QuestionFolder(self.folder / note.id)
        with room_on_disk(), folder.new():
            (folder.path / FOLDER).mkdir(mode=0o700)
            for word, source in paths.items():
                folder.keep(word, source)
            (folder.path / QUESTION).write_text(toml_of(tables), encoding="utf-8")
            folder.write(note)
        return QuestionRun(folder, note)

    def all(self) -> list[HostedQuestion]:
        """Return all runs, newest first."""
        return list(self.runner.published[QuestionRun].values())

    def get(self, question: str) -> HostedQuestion:
        return self.runner.get(QuestionRun, question).note

    def answer(self, question: str) -> bytes | None:
        """Return the answer as JSON, or None."""
        run = self.runner.get(QuestionRun, question)
        return (run.folder.path / ANSWER).read_bytes() if run.note.state == DONE else None

    def tables(self, question: str) -> str:
        """Return the inputs of a run as an input file."""
        return (self.runner.get(QuestionRun, question).folder.path / QUESTION).read_text(encoding="utf-8")

    def file(self, question: str, name: str) -> Path:
        """Return the path of an output file."""
        run = self.runner.get(QuestionRun, question)
        if name not in run.note.files:
            raise NotFound(
                "unknown file {name!r:.40}; the run has {files}", name=name,
                files=", ".join(run.note.files) or "none",
            )  # fmt: skip
        return run.folder.path / name

    def stop(self, question: str) -> HostedQuestion:
        """Stop a running or queued run."""
        run = self.runner.get(QuestionRun, question)
        self.runner.stop(run)
        return run.note

    def delete(self, question: str) -> None:
        """Delete a run and its answer."""
        self.runner.delete(self.runner.get(QuestionRun, question))

    def close(self) -> None:
        """Stop the current run, which restarts with the next server."""
        self.runner.close()
        self._let_go()

    def prepare(self) -> None:
        """Start the process of the next run in advance, so that the process loads its modules."""
        with self.runner.lock, suppress(OSError):
            ahead = self._ahead
            if self.runner.closed or (ahead and ahead.code is None and ahead.environment == os.environ):
                return
            self._let_go()
            self._ahead = self._process()
            self.runner.changed()

    def _let_go(self) -> None:
        with self.runner.lock:
            if self._ahead is not None:
                self._ahead.stop()
            self._ahead = None

    def _process(self) -> RunProcess:
        cache = self.folder.with_name("cache")  # cache of libraries
        cache.mkdir(mode=0o700, exist_ok=True)
        module, nice = "rocking_workbench.questions.child", QuestionRun.NICE
        return RunProcess(module, nice=nice, grace=0.0, MPLCONFIGDIR=str(cache))

    def _start(self, run: QuestionRun) -> RunProcess:
        folder = run.folder.path
        (folder / OWN).mkdir(mode=0o700, exist_ok=True)
        for name in (ANSWER, LOG):
            (folder / name).write_bytes(b"")
        self.prepare()
        process, self._ahead = self._ahead or self._process(), None
        files = {"file": QUESTION, "answer": ANSWER, "log": LOG, "own": OWN}
        job = {"folder": str(folder), **files, "arguments": command_line(run.note)}
        process.send(json.dumps(job).encode())
        return process

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


def refuse_outside(tables: dict[str, Any]) -> None:
    """Refuse texts of a run that name code, or paths outside its folder."""
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


def output_files(question: HostedQuestion) -> list[str]:
    """Return the output files of a run, as values of --output."""
    form = question.format
    return [*OUTPUTS[question.command], *([f"{form}=record{formats()[form].suffixes[0]}"] if form else [])]


def command_line(question: HostedQuestion) -> list[str]:
    """Return the command line of a run."""
    if question.command == WITHOUT_FILE:
        return [*question.command.split(), "--json", "--output", "."]
    outputs = [word for name in output_files(question) for word in ("--output", name)]
    return [*question.command.split(), QUESTION, "--json", *outputs]
