"""Validation with a folder (body, records, observed outcomes): predictions of the trials, and scores."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body, Solid
from rocking.bodies.formats import FORMATS
from rocking.conventions import FloatArray, IntArray
from rocking.decision.prediction import Prediction, Validation, predict, score
from rocking.decision.prediction._predict import sampled_bodies
from rocking.decision.prediction._score import EVENTS, Outcomes, RefusedRow, Trial, column, is_outcomes
from rocking.decision.prediction.model_error import ModelError, hierarchy, is_class, kept_bodies
from rocking.decision.prediction.recalibration import WIDE, BodyTests, wide_samples
from rocking.errors import InvalidValueError, RockingError, located
from rocking.exported import Exported
from rocking.messages import Message, by_key
from rocking.motions.integrals import peak_ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.motions.pipeline import processed
from rocking.spec.array_file import SUFFIX, ArrayFile
from rocking.spec.bodies import any_body_of, without_restraints
from rocking.spec.construction import doubted_once, motion_of
from rocking.spec.prediction import options_of
from rocking.spec.reading import InputFiles, checked, tables_in

if TYPE_CHECKING:
    from rocking.spec.documents.validation import ValidationDocument
    from rocking.tables import Table

_HOW = "a folder contains one body file, record files or one array file (.npz), and one table of outcomes"


def files_of(folder: Path) -> tuple[Path, Path]:
    """Return the body file and the table of outcomes of a folder. The table names the records."""
    if not folder.is_dir():
        raise InvalidValueError("no such folder", hint=_HOW).at(str(folder))
    files = sorted(path for path in folder.iterdir() if path.is_file())
    outcome_tables = [path for path in files if path.suffix.lower() == ".csv" and is_outcomes(path)]
    bodies = [path for path in files if path.suffix.lower() in FORMATS]
    # an input file or a body file may name another file, such as a scan
    questions = [path for path in bodies if is_question(path)]
    if not questions:
        scans = {name for path in bodies for name in _named_files(tables_in(path))}
        bodies = [path for path in bodies if path.name not in scans]
    body = _only_file(questions or bodies, folder, f"body file ({', '.join(FORMATS)})")
    return body, _only_file(
        outcome_tables, folder, "table of outcomes, a .csv file with the columns motion and overturned"
    )


def is_question(path: Path) -> bool:
    """Return True if a file has a table [body] or [predict], False for a body file. Never raises an error."""
    return bool({"body", "predict"} & set(tables_in(path) or ()))


def _named_files(tables: Any) -> set[str]:
    """Return the files that the tables of a body file name."""
    if isinstance(tables, dict):
        own = {tables["file"]} if isinstance(tables.get("file"), str) else set()
        return own.union(*map(_named_files, tables.values()))
    return set[str]().union(*map(_named_files, tables)) if isinstance(tables, list) else set()


def _only_file(paths: Sequence[Path], folder: Path, content: str) -> Path:
    if len(paths) != 1:
        got = ", ".join(path.name for path in paths) or "none"
        raise InvalidValueError("Use one {content}, got {files:.200}", content=content, files=got, hint=_HOW).at(
            str(folder)
        )
    return paths[0]


@dataclass(frozen=True, eq=False)
class FolderValidation(Exported):
    """Predictions of the trials of a folder, and their scores."""

    name: str  # name of the body
    source: str  # name of the table of outcomes
    prediction: Prediction  # with one motion per record and scale
    trials: tuple[Trial, ...]
    refused: tuple[RefusedRow, ...]
    ignored: tuple[str, ...]  # ignored columns of the table
    repairs: tuple[str, ...]  # repairs of a scan
    scores: dict[str, Validation]  # scores by event, overturning first
    updated: "Update | None" = None

    def answer(self) -> Answer:
        """Return all results."""
        return Answer({
            "body": repr(self.prediction.body),
            "assumed": self.prediction.assumed,
            "not_sampled": self.prediction.not_sampled,
            "motions": [item.answer() for item in self.prediction.motions],
            "inputs": self.prediction.inputs,
            "count": self.prediction.count,
            "histories": self.prediction.histories,
            "failed": self.prediction.failed,
            "trials": len(self.trials),
            "not_read": [f"{self.source}, line {item.line}: {item.reason}" for item in self.refused],
            "ignored": self.ignored,
            "events": {event: item.answer() for event, item in self.scores.items()},
            "updated": None if self.updated is None else self.updated.answer(),
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return the exported table with one row per trial and event."""
        from rocking.tables import Column, Table, text_array

        pairs = [(event, k, trial) for event in self.scores for k, trial in enumerate(self.trials)]
        columns = {
            "line": Column(np.array([trial.line for _, _, trial in pairs]), "1", f"line of {self.source}"),
            "motion": Column(text_array([trial.motion for _, _, trial in pairs]), "", "record files"),
            "scale": Column(np.array([trial.scale for _, _, trial in pairs]), "1", "scale factor of the acceleration"),
            "event": Column(text_array([event for event, _, _ in pairs]), "", "predicted event"),
            "outcome": Column(np.concatenate([item.outcome for item in self.scores.values()]), "1", "1 if it occurred"),
        }
        for name in next(iter(self.scores.values())).probability:
            values = np.concatenate([validation.probability[name] for validation in self.scores.values()])
            columns[name.replace(" ", "_")] = Column(values, "1", f"probability by the {name}")
        verdicts = {f"verdict_{event}": validation.verdict for event, validation in self.scores.items()}
        return Table("trial", columns, {"body": repr(self.prediction.body), **verdicts})


@dataclass(frozen=True, eq=False)
class Update:
    """Model error of a body after its tests. The scores of an earthquake use the tests of all other earthquakes."""

    error: ModelError
    left_out: Validation

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences: factors, their source, and the verdict on the left-out earthquakes."""
        facts = {"factors": self.error.text, "source": self.error.source}
        return (
            Message("Updated model error: {factors} ({source}).", facts),
            Message(
                "Prediction of each earthquake with factors from the other earthquakes: {verdict}",
                {"verdict": self.left_out.verdict},
            ),
        )

    def answer(self) -> Answer:
        """Return the factors and the scores."""
        return Answer({
            "model_error": self.error.text, "source": self.error.source, "sentences": self.sentences,
            "events": {"overturning": self.left_out.answer()},
        })  # fmt: skip


@dataclass(frozen=True)
class ValidationProblem:
    """A body, its motions, and the observed outcomes."""

    body: Body | Solid
    options: dict[str, Any]  # keywords of `predict`
    outcomes: Outcomes
    trials: tuple[Trial, ...]  # with readable records
    refused: tuple[RefusedRow, ...]
    # earthquake of each trial, or its record files; all components of one file have the same cluster
    clusters: tuple[str, ...]
    motions: dict[tuple[Any, float], dict[str, GroundMotion]]  # motions by axis, for record files and scale
    name: str

    @classmethod
    def of(cls, document: "ValidationDocument", files: tuple[Path, Path], inputs: InputFiles) -> "ValidationProblem":
        """Return the validation problem of a folder. `files` contains its body file and its table of outcomes."""
        with located("body"):
            body = without_restraints(any_body_of(document.body, inputs))
        if document.predict.pga is not None:
            raise InvalidValueError("predict.pga is not allowed in a validation. Use the scale column of the outcomes.")
        outcomes = Outcomes.read(files[1])
        records = _Records(inputs, document.motion.model_dump(exclude_none=True, exclude={"scale"}))
        trials, refused, motions = list[Trial](), list(outcomes.refused), dict[Any, Any]()
        for trial in outcomes.trials:
            try:
                motions[trial.files, trial.scale] = records.motion(trial)
                trials.append(trial)
            except RockingError as error:
                refused.append(RefusedRow(trial.line, error.spelt(by_key)))
        refused.sort(key=lambda row: row.line)
        if not trials:
            reason = f"line {refused[0].line}: {refused[0].reason}" if refused else "the table is empty"
            raise InvalidValueError("No row is usable", hint=reason).at(outcomes.source)
        options = {**options_of(document, body, inputs), "contributions": False}
        name = files[0].stem
        clusters = tuple(trial.earthquake or records.files(trial) for trial in trials)
        return cls(body, options, outcomes, tuple(trials), tuple(refused), clusters, motions, name)

    def answer(
        self, progress: Callable[[int], None] | None = None, threads: int | None = None, *, update: bool = False
    ) -> FolderValidation:  # fmt: skip
        """Predict every trial from the body alone and score the predictions; with `update`, update the model error."""
        motions = list(self.motions.values())
        prediction = predict(self.body, motions, **self.options, threads=threads, progress=progress)
        index_of_key = {key: k for k, key in enumerate(self.motions)}
        motion_index = np.array([index_of_key[trial.files, trial.scale] for trial in self.trials])
        names = np.array(self.clusters)
        pga, pgv = np.array([_peaks(motion) for motion in motions]).T[:, motion_index]
        scored = {}
        for event in EVENTS.values():
            observed = column(self.trials, event)
            probabilities = prediction.chances[event].per_motion[motion_index]
            if event == "overturning" or not np.isnan(observed).all():
                with located(self.outcomes.source, "file"):
                    scored[event] = score(
                        probabilities,
                        observed,
                        names,
                        pga=pga,
                        pgv=pgv,
                        count=prediction.count,
                        event=event,
                        seed=prediction.seed,
                    )
        repairs = tuple(getattr(self.body, "repairs", ()))
        return FolderValidation(
            self.name,
            self.outcomes.source,
            prediction,
            self.trials,
            self.refused,
            self.outcomes.ignored,
            repairs,
            scored,
            self._updated(scored["overturning"], motion_index, pga, pgv, prediction, threads) if update else None,
        )

    def _updated(
        self, scored: Validation, motion_index: IntArray, pga: FloatArray, pgv: FloatArray, prediction: Prediction,
        threads: int | None,
    ) -> Update:  # fmt: skip
        """Return the model error updated with the tests, and the scores of left-out earthquakes."""
        mechanics = sampled_bodies(self.body, list(self.motions.values()), self.options | {"model_error": WIDE})
        logarithms, overturned = wide_samples(mechanics, prediction.count, prediction.seed, threads)
        stated, names = self.options.get("model_error"), np.array(self.clusters)
        prior = hierarchy(kept_bodies(), stated if is_class(stated) else mechanics.kind)
        tests = BodyTests(logarithms[motion_index], overturned[motion_index], scored.outcome, names)
        left_out = score(tests.left_out(prior), scored.outcome, names, pga=pga, pgv=pgv, seed=prediction.seed)
        return Update(tests.error(prior), left_out)


class _Records:
    """Records by their text in the table of outcomes. Every record is read once; errors are stored too."""

    def __init__(self, inputs: InputFiles, keys: dict[str, Any]) -> None:
        self._inputs, self._keys, self._read = inputs, keys, dict[str, GroundMotion | RockingError]()

    @cached_property
    def _arrays(self) -> ArrayFile | None:
        """The array file of the folder; None if there is none."""
        paths = sorted(path for path in self._inputs.folder.iterdir() if path.suffix.lower() == SUFFIX)
        if len(paths) > 1:
            raise InvalidValueError(
                "Use one {content}, got {files:.200}", content="array file (.npz)",
                files=", ".join(path.name for path in paths), hint=_HOW,
            ).at(str(self._inputs.folder))  # fmt: skip
        return ArrayFile(self._inputs.file(paths[0].name)) if paths else None

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

    def files(self, trial: Trial) -> str:
        """Return the record files of a trial."""
        return " ".join(self._file_and_component(word)["record"] for _, word in trial.files)

    def _record(self, word: str) -> GroundMotion:
        record = self._in_file(word)
        if record.peak == 0.0:
            raise InvalidValueError("The acceleration of {motion} is zero at all times.", motion=word)
        return record

    def _in_file(self, word: str) -> GroundMotion:
        from rocking.spec.motion_tables import OneMotionTable

        own = self._file_and_component(word)
        if not (self._inputs.folder / own["record"]).is_file():
            if self._arrays is not None:
                return self._in_arrays(self._arrays, word)
            raise InvalidValueError("no such file").at(own["record"])
        record = motion_of(checked(OneMotionTable, {**self._keys, **own}), self._inputs)
        assert isinstance(record, GroundMotion)
        return record

    def _in_arrays(self, arrays: ArrayFile, word: str) -> GroundMotion:
        """Return a motion of the array file after its processing steps."""
        if odd := sorted(set(self._keys) - {"units", "time_step", "process"}):
            raise InvalidValueError("[motion] accepts units, time_step and process with an array file, got {key}",
                                    key=odd[0])  # fmt: skip

        return doubted_once(lambda: processed(arrays.motion(word, self._keys), self._keys.get("process") or ()), word)  # type: ignore[no-any-return]

    def _file_and_component(self, word: str) -> dict[str, str]:
        """Return record file and component of the text FILE#COMPONENT."""
        path, mark, component = word.rpartition("#")
        if mark and not (self._inputs.folder / word).is_file():
            return {"record": path, "component": component}
        return {"record": word}


def _peaks(motion: dict[str, GroundMotion]) -> tuple[float, float]:
    """Return the PGA [m/s2] and the PGV [m/s] of the horizontal component with the larger value."""
    horizontal = [component for axis, component in motion.items() if axis != "z"]
    return max(component.peak for component in horizontal), max(map(peak_ground_velocity, horizontal))
