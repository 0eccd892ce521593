"""The history behind a point of a picture: what was computed there, as inputs that anybody can go on with."""

import tomllib
import warnings
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.app.api.response import answer_facts
from rocking.app.errors import NotFound
from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results import meaning, plain
from rocking.bodies import Block, Body
from rocking.bodies.formats.body_writer import body_to_toml
from rocking.dynamics import simulate
from rocking.dynamics.response import Motion, Response
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.pulses import pulse
from rocking.outcome import Outcome
from rocking.spec.construction import motions_of
from rocking.spec.reading import InputFiles
from rocking.spec.response import ResponseProblem
from rocking.studies.adaptive_grid import Plane
from rocking.studies.axis import RestitutionAxis, axis_of
from rocking.studies.question import Question
from rocking.studies.variations import changed_body

if TYPE_CHECKING:
    from rocking.spec.document import MotionTable

_ACROSS = {
    "rocking-spectrum": ("period", "slenderness_angle"),
    "stripes": ("level", "motion"),
    "incremental": ("level", "motion"),
    "cloud": ("motion", ""),
    "histories": ("scale", "body"),
    "minimum-acceleration": ("point", "body"),
}
"""Dimensions of a kind that the picture has along x and y; those of a map are its axes."""

_OF_RECORDS = ("format", "units", "time_step", "component", "vertical")
_OF_FAMILIES = ("pga", "pgv", "time_step")
_TIMES = {"period", "duration", "velocity"}
"""Parameters of pulses that grow with their time while the acceleration stays."""

_CLOSE = 1e-12
POINTS = 1000
"""Samples of the curves."""

_STORED = {
    "outcome": "outcome",
    "mode": "mode",
    "impacts": "impacts",
    "peak_rotation": "peak_rotation_rad",
    "peak_ratio": "peak_rotation_over_alpha",
    "overturning_time": "overturning_time_s",
}


@dataclass(frozen=True)
class HistoryPlace:
    """A history of a study."""

    number: int
    index: dict[str, int]  # its place along every axis of the study, and along ``motion`` also where there is only one
    restitution: int  # number of the restitution among those that are compared

    @classmethod
    def of(cls, study: OpenStudy, x: int, y: int, restitution: int = 0, motion: int = 0) -> "HistoryPlace":
        """Return the history at a point of a picture."""
        dims, choices = study.job.job.study.dims, len(study.job.job.problem.restitutions)
        across = across_of(study)
        index = {"motion": motion} | {across[0]: x, across[1]: y}
        sizes = {name: dims[name] for name in study.axes} | {"the restitution": choices}
        at = {name: index.get(name, 0) for name in study.axes} | {"the restitution": restitution}
        for name, size in sizes.items():
            if not 0 <= at[name] < size:
                raise NotFound(f"{name} must be a number from 0 to {size - 1}, got {at[name]}")
        places = [at[name] if name in study.axes else restitution for name in dims]
        number = int(np.ravel_multi_index(tuple(places), study.job.job.study.shape))
        return cls(number, {"motion": 0} | {name: at[name] for name in study.axes}, restitution)


def across_of(study: OpenStudy) -> tuple[str, str]:
    """Return the dimensions that a picture of a study has along x and y.

    Returns names of dimensions; empty where the picture has only one.
    """
    kind = str(study.job.job.document.campaign.kind)
    if kind in _ACROSS:
        return _ACROSS[kind]
    y, x = study.axes
    return x, y


@dataclass(frozen=True)
class Variation:
    """What a history is made of."""

    body: Body
    table: dict[str, Any]  # the same, as inputs tell it
    label: str  # the restitution in words
    restitution: Any  # the same, as `simulate` takes it
    choice: dict[str, Any] | None  # the same, as inputs tell it; None where they cannot
    scale: float  # factor on the motion as the study has it [-]
    stretch: float = 1.0  # factor on its time [-]

    @classmethod
    def of(cls, study: OpenStudy, place: HistoryPlace) -> "Variation":
        """Return what a history is made of."""
        job = study.job.job
        label, restitution, choice = _choice(study, place)
        rows = job.study.histories.rows(place.number, place.number + 1)
        scale = float(rows.values["scale"][0])
        if getattr(restitution, "per_history", False):
            drawn = {side: float(rows.values[f"r_{side}"][0]) for side in ("left", "right")}
            restitution, choice = drawn, dict(drawn)
        if job.document.map is not None:
            made = cls(job.problem.bodies[0], _table(study, 0), label, restitution, choice, scale)
            return _on_map(made, study, place)
        if job.document.spectrum is not None:
            angle, period = (job.study.coordinates[name].values for name in ("slenderness_angle", "semi_diagonal"))
            body = Block.from_angle(
                float(angle[place.index["slenderness_angle"]]), float(period[place.index["period"]])
            )
            return cls(body, body_table(body), label, restitution, choice, scale)
        number = place.index.get("body", 0)
        return cls(job.problem.bodies[number], _table(study, number), label, restitution, choice, scale)


def _on_map(made: Variation, study: OpenStudy, place: HistoryPlace) -> Variation:
    """Return the variation of a cell of a map: its axes change it."""
    job = study.job.job
    assert job.document.map is not None  # asked before
    axes = {side: axis_of((table.axis, table.numbers())) for side, table in (
        ("x", job.document.map.x), ("y", job.document.map.y),
    )}  # fmt: skip
    question = Question(made.body, job.problem.motions[0], made.restitution, job.problem.settings)
    at = {side: axis.values[place.index[axis.name]][None] for side, axis in axes.items()}
    case = Plane(question, axes["x"], axes["y"]).case(at["x"], at["y"])
    geometry = {name: float(values[0]) for name, values in case.geometry.items()}
    body = changed_body(made.body, geometry)
    made = replace(made, scale=float(case.scale[0]), stretch=float(case.stretch[0]))
    if geometry:
        made = replace(made, body=body, table=body_table(body))
    if any(isinstance(axis, RestitutionAxis) for axis in axes.values()):
        value = float(case.sides["r_right"][0])
        made = replace(made, label=f"{value!r}", restitution=value, choice={"value": value})
    return made


def body_table(body: Body) -> dict[str, Any]:
    """Return a body as inputs tell it.

    Returns in m and kg/m3; the same to the last bit, but for sections that were scaled.
    """
    told = tomllib.loads(body_to_toml(body))
    return {"units": told["units"], **told["block"]} if "block" in told else told


def _table(study: OpenStudy, number: int) -> dict[str, Any]:
    return dict((study.job.job.document.body or [])[number])


def _choice(study: OpenStudy, place: HistoryPlace) -> tuple[str, Any, dict[str, Any] | None]:
    """Return label, restitution, and what inputs say of it."""
    table, number = study.job.job.document.restitution, place.restitution
    label, restitution = list(study.job.job.problem.restitutions.items())[number]
    told: list[dict[str, Any] | None] = [{"model": table.model}] if table.model else []
    told += [{"model": word} for word in table.models or []]
    told += [{"value": value} for value in ([] if table.value is None else [table.value]) + (table.values or [])]
    if table.left is not None:
        told.append({"left": table.left, "right": table.right})
    told.append(None)  # a draw at every impact: its number is not among the inputs
    return label, restitution, told[number]


def valid(variation: Variation) -> bool:
    """Return whether a history could be computed at all.

    Returns false where the coefficient would create energy.
    """
    value = variation.restitution
    return not isinstance(value, float) or bool(np.isfinite(value))


@dataclass(frozen=True)
class ChosenMotion:
    """One motion of a study."""

    motion: Motion  # the motion, without the factor of its table
    told: dict[str, Any] | None  # how inputs name it; None where they cannot
    scale: float  # the factor of its table [-]

    @classmethod
    def of(cls, study: OpenStudy, number: int, stretch: float) -> "ChosenMotion":
        """Return a motion of a study.

        stretch: factor on its time [-].
        """
        table, place = _found(study, number)
        if table.pulse is not None:
            return cls._of_pulse(table, place, stretch)
        if table.records is not None:
            return cls._of_record(table, place, stretch, study)
        told = {"synthetic": table.synthetic, "seed": table.seed or 0, "member": place}
        told |= {name: getattr(table, name) for name in _OF_FAMILIES if getattr(table, name) is not None}
        made = _stretched(study.job.job.problem.motions[number], stretch)
        return cls(made, told if stretch == 1.0 else None, 1.0)

    @classmethod
    def _of_pulse(cls, table: "MotionTable", place: int, stretch: float) -> "ChosenMotion":
        assert table.pulse is not None  # asked before
        words = stretched_words(table.pulse[place], stretch)
        return cls(pulse(words), {"pulse": words}, table.scale)

    @classmethod
    def _of_record(cls, table: "MotionTable", place: int, stretch: float, study: OpenStudy) -> "ChosenMotion":
        assert table.records is not None  # asked before
        name = table.records[place]
        alone = table.model_copy(update={"records": [name], "scale": 1.0})
        motion = _stretched(motions_of([alone], InputFiles(study.folder.path))[0], stretch)
        path = PurePosixPath(name)
        told: dict[str, Any] = {"record": path.parent.name, "file_name": path.name}
        told |= {key: getattr(table, key) for key in _OF_RECORDS if getattr(table, key) is not None}
        return cls(motion, told if stretch == 1.0 else None, table.scale)


def stretched_words(words: str, stretch: float) -> str:
    """Return a pulse whose time is stretched while its acceleration stays, in words.

    stretch: factor on its time [-]. Returns the words of the stretched pulse; the same words where nothing is
    stretched.

    >>> stretched_words("sine:amplitude=3,period=0.5", 2.0)
    'sine:amplitude=3,period=1.0'
    """
    if stretch == 1.0:
        return words
    name, _, tail = words.partition(":")
    pairs = [tuple(part.strip() for part in item.partition("=")[::2]) for item in filter(None, tail.split(","))]
    changed = [(key, repr(float(value) * stretch) if key in _TIMES else value) for key, value in pairs]
    made = f"{name}:{','.join(f'{key}={value}' for key, value in changed)}"
    before, after = pulse(words), pulse(made)
    if abs(after.duration / (stretch * before.duration) - 1.0) + abs(after.peak / before.peak - 1.0) > _CLOSE:
        raise ArithmeticError(f"{made} is not {words} stretched by {stretch!r}")
    return made


def _found(study: OpenStudy, number: int) -> tuple["MotionTable", int]:
    """Return the table that a motion stands in, and its place there."""
    left = number
    for table in study.job.job.document.motions:
        size = int(table.count or 0) or len(table.records or []) or len(table.pulse or [])
        if left < size:
            return table, left
        left -= size
    raise IndexError(number)


def _stretched(motion: Motion, stretch: float) -> Motion:
    if stretch == 1.0 or isinstance(motion, Pulse):
        return motion
    assert isinstance(motion, GroundMotion)  # there is nothing else
    return replace(motion, time_step=motion.time_step * stretch)


def cell_of(study: OpenStudy, place: HistoryPlace, points: int = POINTS) -> dict[str, Any]:
    """Return the history behind a point of a picture.

    Returns ``stored``: what the study has of it, to the last digit; ``inputs``: what to ask for the same history, null
    where inputs cannot say it; ``answer``: the response, null where there is none; ``difference_rad``: of the peak
    rotations of both, which take other steps to the same accuracy; ``note``: a sentence on what is missing.
    """
    told: dict[str, Any] = {"stored": stored(study, place), "inputs": None, "answer": None, "difference_rad": None}
    try:
        variation = Variation.of(study, place)
        if not valid(variation):
            return told | {"note": "the coefficient of this cell would create energy: nothing was computed"}
        motion = ChosenMotion.of(study, place.index["motion"], variation.stretch)
        question, response = _responded(study, place, variation, motion)
    except InvalidValueError as error:
        return told | {"note": str(error)}
    note = _why_not(variation, motion)
    told |= {"inputs": None if note else _inputs(study, variation, motion), "note": note}
    if response.outcome is Outcome.FAILED:
        return told | {"note": f"there is no response: {response.status.value}"}
    difference = abs(response.peak_rotation - abs(told["stored"]["peak_rotation_rad"]))
    return told | {
        "answer": answer_facts(variation.label, response, question, points),
        "difference_rad": difference,
    }


def stored(study: OpenStudy, place: HistoryPlace) -> dict[str, Any]:
    """Return what a study has of a history.

    Returns Number, outcome, mode, meaning, impacts, peaks and time of overturning, as they were computed.
    """
    history = study.history(place.number)
    found = {key: plain(history[name]) for name, key in _STORED.items()}
    return {"history": place.number, "meaning": meaning(found["mode"]), **found}


def _responded(
    study: OpenStudy, place: HistoryPlace, variation: Variation, motion: ChosenMotion
) -> tuple[ResponseProblem, Response]:
    job = study.job.job
    scale, engine = variation.scale * motion.scale, job.document.settings.engine
    asked = ResponseProblem(
        variation.body,
        motion.motion,
        {variation.label: variation.restitution},
        job.problem.settings,
        engine,
        scale=scale,
    )
    how = {**asked.settings.stated, "engine": engine, "stream": place.number}
    with warnings.catch_warnings():  # the answer shows its doubts
        warnings.simplefilter("ignore", PureRockingWarning)
        return asked, simulate(asked.body, motion.motion, variation.restitution, scale=scale, **how)


def _why_not(variation: Variation, motion: ChosenMotion) -> str:
    """Return why inputs cannot say this history; empty where they can."""
    if motion.told is None:
        return (
            f"the time of the motion is stretched by {variation.stretch:.6g} here, which inputs cannot say of a motion "
            "that is no pulse; the response is the one with the stretched motion"
        )
    if variation.choice is None:
        return "the coefficient is drawn at every impact, by the number of the history, which inputs do not have"
    return ""


def _inputs(study: OpenStudy, variation: Variation, motion: ChosenMotion) -> dict[str, Any]:
    assert motion.told is not None  # asked before
    settings = study.job.job.document.settings.model_dump(exclude_unset=True, exclude_none=True)
    made = {
        "body": variation.table,
        "motion": motion.told | {"scale": variation.scale * motion.scale},
        "restitution": variation.choice,
    }
    return made | ({"settings": settings} if settings else {})
