"""A folder with a body, records and a table of outcomes: what is foreseen of each trial, and how good that was."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body, Solid
from rocking.bodies.formats import FORMATS
from rocking.errors import InvalidValueError, RockingError, located
from rocking.exported import Exported
from rocking.messages import by_key
from rocking.motions.integrals import peak_ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.prediction import Prediction, Validation, predict, score
from rocking.prediction._score import EVENTS, Outcomes, RefusedRow, Trial, column, is_outcomes
from rocking.spec.bodies import any_body_of
from rocking.spec.construction import motion_of
from rocking.spec.prediction import options_of
from rocking.spec.reading import InputFiles, checked, tables_in

if TYPE_CHECKING:
    from rocking.spec.documents.validation import ValidationDocument
    from rocking.tables import Table

_HOW = "a folder holds one body file, record files, and one table of outcomes"


def files_of(folder: Path) -> tuple[Path, Path]:
    """Return the one body file of a folder and its one table of outcomes, which names the records."""
    if not folder.is_dir():
        raise InvalidValueError("no such folder", hint=_HOW).at(str(folder))
    files = sorted(path for path in folder.iterdir() if path.is_file())
    seen = [path for path in files if path.suffix.lower() == ".csv" and is_outcomes(path)]
    bodies = [path for path in files if path.suffix.lower() in FORMATS]
    # a file that says everything may name another one as its body
    asked = [path for path in bodies if is_question(path)]
    body = _one(asked or bodies, folder, f"body file ({', '.join(FORMATS)})")
    return body, _one(seen, folder, "table of outcomes, a .csv file with the columns motion and overturned")


def is_question(path: Path) -> bool:
    """Return whether a file has a table [body] or [predict], rather than being a body. Never raises."""
    return bool({"body", "predict"} & set(tables_in(path) or ()))


def _one(paths: Sequence[Path], folder: Path, what: str) -> Path:
    if len(paths) != 1:
        got = ", ".join(path.name for path in paths) or "none"
        raise InvalidValueError("there must be one {content}, got {files:.200}", content=what, files=got, hint=_HOW).at(
            str(folder)
        )
    return paths[0]


@dataclass(frozen=True, eq=False)
class FolderValidation(Exported):
    """What was foreseen of the trials of a folder, and how good that was."""

    name: str  # of the body
    source: str  # name of the table of outcomes
    prediction: Prediction  # one motion each time that a record stands at another scale
    trials: tuple[Trial, ...]
    refused: tuple[RefusedRow, ...]
    ignored: tuple[str, ...]  # columns of the table that were not read
    repairs: tuple[str, ...]  # what a scan needed
    found: dict[str, Validation]  # by event, overturning first

    def answer(self) -> Answer:
        """Return everything that is shown."""
        return Answer({
            "body": repr(self.prediction.body),
            "assumed": self.prediction.assumed,
            "not_sampled": self.prediction.not_sampled,
            "motions": [each.answer() for each in self.prediction.motions],
            "inputs": self.prediction.inputs,
            "count": self.prediction.count,
            "histories": self.prediction.histories,
            "failed": self.prediction.failed,
            "trials": len(self.trials),
            "not_read": [f"{self.source}, line {each.line}: {each.reason}" for each in self.refused],
            "ignored": self.ignored,
            "events": {event: each.answer() for event, each in self.found.items()},
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return what files of it hold: one row a trial and event."""
        from rocking.tables import Column, Table, text_array

        pairs = [(event, k, trial) for event in self.found for k, trial in enumerate(self.trials)]
        columns = {
            "line": Column(np.array([trial.line for _, _, trial in pairs]), "1", f"line of {self.source}"),
            "motion": Column(text_array([trial.motion for _, _, trial in pairs]), "", "record files"),
            "scale": Column(np.array([trial.scale for _, _, trial in pairs]), "1", "factor on the acceleration"),
            "event": Column(text_array([event for event, _, _ in pairs]), "", "what was foreseen"),
            "outcome": Column(np.concatenate([each.outcome for each in self.found.values()]), "1", "1 if it happened"),
        }
        for name in next(iter(self.found.values())).probability:
            values = np.concatenate([each.probability[name] for each in self.found.values()])
            columns[name.replace(" ", "_")] = Column(values, "1", f"probability by the {name}")
        verdicts = {f"verdict_{event}": each.verdict for event, each in self.found.items()}
        return Table("trial", columns, {"body": repr(self.prediction.body), **verdicts})


@dataclass(frozen=True)
class ValidationProblem:
    """A body, what shook it, and what was seen."""

    body: Body | Solid
    options: dict[str, Any]  # as `predict` takes them
    outcomes: Outcomes
    trials: tuple[Trial, ...]  # of which all records could be read
    refused: tuple[RefusedRow, ...]
    clusters: tuple[str, ...]  # record files of each trial: components of one file are of one motion
    motions: dict[tuple[Any, float], dict[str, GroundMotion]]  # by files and scale
    name: str

    @classmethod
    def of(cls, document: "ValidationDocument", files: tuple[Path, Path], inputs: InputFiles) -> "ValidationProblem":
        """Return what a folder says; files: its body file, and its table of outcomes."""
        with located("body"):
            body = any_body_of(document.body, inputs)
        if document.predict.pga is not None:
            raise InvalidValueError("predict.pga is not allowed in a validation: its motions are those that were seen")
        outcomes = Outcomes.read(files[1])
        records = _Records(inputs, document.motion.model_dump(exclude_none=True, exclude={"scale"}))
        trials, refused, motions = list[Trial](), list(outcomes.refused), dict[Any, Any]()
        for trial in outcomes.trials:
            try:
                motions[trial.files, trial.scale] = records.motion(trial)
                trials.append(trial)
            except RockingError as error:
                refused.append(RefusedRow(trial.line, error.spelt(by_key)))
        refused.sort(key=lambda each: each.line)
        if not trials:
            why = f"line {refused[0].line}: {refused[0].reason}" if refused else "it has no rows"
            raise InvalidValueError("no row could be taken", hint=why).at(outcomes.source)
        options = {**options_of(document, body, inputs), "contributions": False}
        name = files[0].stem
        clusters = tuple(" ".join(records.place(word)["record"] for _, word in trial.files) for trial in trials)
        return cls(body, options, outcomes, tuple(trials), tuple(refused), clusters, motions, name)

    def answer(
        self, progress: Callable[[int], None] | None = None, threads: int | None = None
    ) -> FolderValidation:  # fmt: skip
        """Foresee every trial from the body alone, then score it."""
        several = list(self.motions.values())
        found = predict(self.body, several, **self.options, threads=threads, progress=progress)
        number = {key: k for k, key in enumerate(self.motions)}
        which = np.array([number[trial.files, trial.scale] for trial in self.trials])
        names = np.array(self.clusters)
        pga, pgv = np.array([_peaks(motion) for motion in several]).T[:, which]
        scored = {}
        for event in EVENTS.values():
            seen = column(self.trials, event)
            said = found.chances[event].per_motion[which]
            if event == "overturning" or not np.isnan(seen).all():
                with located(self.outcomes.source, "file"):
                    scored[event] = score(
                        said, seen, names, pga=pga, pgv=pgv, count=found.count, event=event, seed=found.seed
                    )
        repairs = tuple(getattr(self.body, "repairs", ()))
        return FolderValidation(
            self.name, self.outcomes.source, found, self.trials, self.refused, self.outcomes.ignored, repairs, scored
        )


class _Records:
    """Records by the word that names them, each read once; what is wrong with one is kept too."""

    def __init__(self, inputs: InputFiles, keys: dict[str, Any]) -> None:
        self._inputs, self._keys, self._read = inputs, keys, dict[str, GroundMotion | RockingError]()

    def motion(self, trial: Trial) -> dict[str, GroundMotion]:
        motion = {}
        for axis, word in trial.files:
            if word not in self._read:
                try:
                    self._read[word] = self._record(word)
                except RockingError as error:
                    self._read[word] = error
            record = self._read[word]
            if isinstance(record, RockingError):
                raise record
            motion[axis] = record.scaled(trial.scale)
        return motion

    def _record(self, word: str) -> GroundMotion:
        from rocking.spec.motion_tables import OneMotionTable

        own = self.place(word)
        if not (self._inputs.folder / own["record"]).is_file():
            raise InvalidValueError(
                "{record}: no such record file in {folder}", record=own["record"], folder=self._inputs.folder
            )
        record = motion_of(checked(OneMotionTable, {**self._keys, **own}), self._inputs)
        assert isinstance(record, GroundMotion)
        if record.peak == 0.0:
            raise InvalidValueError("{motion} is zero throughout: nothing moves", motion=word)
        return record

    def place(self, word: str) -> dict[str, str]:
        """Return the file that a word names, and the component behind #."""
        path, mark, component = word.rpartition("#")
        if mark and not (self._inputs.folder / word).is_file():
            return {"record": path, "component": component}
        return {"record": word}


def _peaks(motion: dict[str, GroundMotion]) -> tuple[float, float]:
    """Return PGA [m/s2] and PGV [m/s], of two components the larger."""
    level = [each for axis, each in motion.items() if axis != "z"]
    return max(each.peak for each in level), max(map(peak_ground_velocity, level))
