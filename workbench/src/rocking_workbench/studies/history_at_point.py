"""The simulation of a point of a study, with inputs for further use."""

import tomllib
import warnings
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from rocking import Block, GroundMotion, Outcome, Response, simulate
from rocking.answers import Answer
from rocking.bodies import Body
from rocking.bodies.formats import body_to_toml
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.messages import Message
from rocking.motions.pulse import Motion
from rocking.motions.pulses import pulse, whole_or_number
from rocking.outcome import mode_words
from rocking.spec.construction import motions_of
from rocking.spec.reading import InputFiles
from rocking.spec.response import ResponseProblem
from rocking.studies.adaptive_grid import Plane
from rocking.studies.question import Question, changed_body
from rocking_workbench.api.response import response_answer
from rocking_workbench.errors import NotFound
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.results import plain

_ACROSS = {
    "rocking-spectrum": ("period", "slenderness_angle"),
    "stripes": ("level", "motion"),
    "incremental": ("level", "motion"),
    "cloud": ("motion", ""),
    "histories": ("scale", "body"),
    "minimum-acceleration": ("point", "body"),
}
"""Dimensions along x and y in the figure of a kind of study; for a map, its axes."""

_OF_RECORDS = ("format", "units", "time_step", "component", "vertical")
_OF_FAMILIES = ("pga", "pgv", "time_step")
_TIMES = {"period", "duration", "velocity"}
"""Parameters of pulses that scale with time at constant acceleration."""

_STARTS = {"rotation": "rotation", "angular_velocity": "velocity"}
"""Initial conditions, by the names of rows."""

_CLOSE = 1e-12
POINTS = 1000  # number of samples of the curves

_STORED = ("outcome", "mode", "impacts", "peak_rotation", "peak_ratio", "overturning_time")


@dataclass(frozen=True)
class HistoryPlace:
    """A history of a study."""

    number: int
    index: dict[str, int]  # index along every axis of the study, and always along ``motion``
    restitution: int  # index of the restitution among the compared restitutions

    @classmethod
    def of(cls, study: OpenStudy, x: int, y: int, restitution: int = 0, motion: int = 0) -> "HistoryPlace":
        """Return the simulation at a point of a study."""
        dims, choices = study.job.study.dims, len(study.job.problem.restitutions)
        across = _ACROSS.get(study.job.document.kind, study.axes[::-1])
        index = {"motion": motion} | dict(zip(across, (x, y), strict=False))
        sizes = {name: dims[name] for name in study.axes} | {"the restitution": choices}
        at = {name: index.get(name, 0) for name in study.axes} | {"the restitution": restitution}
        for name, size in sizes.items():
            if not 0 <= at[name] < size:
                raise NotFound(
                    "{name} must be in 0 ... {largest}, got {index}",
                    name=name,
                    largest=size - 1,
                    index=at[name],
                )
        places = [at[name] if name in study.axes else restitution for name in dims]
        number = int(np.ravel_multi_index(tuple(places), study.job.study.shape))
        return cls(number, {"motion": 0} | {name: at[name] for name in study.axes}, restitution)


@dataclass(frozen=True)
class Variation:
    """Inputs of one simulation."""

    body: Body
    table: dict[str, Any]  # body as a table of inputs
    label: str  # name of the restitution
    restitution: Any  # restitution as an argument of `simulate`
    choice: dict[str, Any] | None  # restitution as a table of inputs; None if not possible
    scale: float  # factor on the motion of the study [-]
    stretch: float = 1.0  # factor on the time of the motion [-]
    rotation: float = 0.0  # rotation [rad] and angular velocity [rad/s] at the start
    angular_velocity: float = 0.0

    @classmethod
    def of(cls, study: OpenStudy, point: HistoryPlace) -> "Variation":
        """Return the inputs of one simulation."""
        job = study.job
        label, restitution, choice = _choice(study, point)
        rows = job.study.histories.rows(point.number, point.number + 1)
        scale = float(rows.values["scale"][0])
        if getattr(restitution, "per_history", False):
            restitution = {side: float(rows.values[f"r_{side}"][0]) for side in ("left", "right")}
            choice = dict(restitution)
        if job.document.axes:
            body, table = job.problem.bodies[0], dict(job.document.bodies[0])
            return _on_map(cls(body, table, label, restitution, choice, scale), study, point)
        if not job.problem.bodies:
            angle, period = (job.study.coordinates[name].values for name in ("slenderness_angle", "semi_diagonal"))
            body = Block.from_angle(
                float(angle[point.index["slenderness_angle"]]), float(period[point.index["period"]])
            )
            return cls(body, body_table(body), label, restitution, choice, scale)
        number = point.index.get("body", 0)
        body, table = job.problem.bodies[number], dict(job.document.bodies[number])
        return cls(body, table, label, restitution, choice, scale)


def _on_map(variation: Variation, study: OpenStudy, point: HistoryPlace) -> Variation:
    """Return the inputs of a cell of a map."""
    job = study.job
    x, y = job.document.axes
    question = Question(variation.body, job.problem.motions[0], variation.restitution, job.problem.settings)
    case = Plane(question, x, y).case(*(axis.values[point.index[axis.name]][None] for axis in (x, y)))
    geometry = {name: float(values[0]) for name, values in case.geometry.items()}
    body = changed_body(variation.body, geometry)
    start: dict[str, Any] = {name: float(case.sides.get(row, [0.0])[0]) for name, row in _STARTS.items()}
    variation = replace(variation, scale=float(case.scale[0]), stretch=float(case.stretch[0]), **start)
    if geometry:
        variation = replace(variation, body=body, table=body_table(body))
    if "restitution" in {x.name, y.name}:
        value = float(case.sides["r_right"][0])
        variation = replace(variation, label=f"{value!r}", restitution=value, choice={"value": value})
    return variation


def body_table(body: Body) -> dict[str, Any]:
    """Return a body as a table of inputs, in m and kg/m3."""
    table = tomllib.loads(body_to_toml(body))
    return {"units": table["units"], **table["block"]} if "block" in table else table


def _choice(study: OpenStudy, point: HistoryPlace) -> tuple[str, Any, dict[str, Any] | None]:
    """Return label, restitution and its table of inputs."""
    table, number = study.job.document.restitution, point.restitution
    label, restitution = list(study.job.problem.restitutions.items())[number]
    tables: list[dict[str, Any] | None] = [{"model": table.model}] if table.model else []
    tables += [{"model": word} for word in table.models or []]
    tables += [{"value": value} for value in ([] if table.value is None else [table.value]) + (table.values or [])]
    if table.left is not None:
        tables.append({"left": table.left, "right": table.right})
    tables.append(None)  # inputs cannot contain a sampled coefficient per impact
    return label, restitution, tables[number]


def _motion_at(study: OpenStudy, number: int, stretch: float) -> tuple[Motion, dict[str, Any] | None, float]:
    """Return a motion with stretched time, its table of inputs or None, and its scale."""
    index = number
    for table in study.job.document.motions:
        if index < table.size:
            break
        index -= table.size
    if table.pulse is not None:
        text = stretched_words(table.pulse[index], stretch)
        return pulse(text), {"pulse": text}, table.scale
    if table.records is not None:
        name = table.records[index]
        alone = table.model_copy(update={"records": [name], "scale": 1.0})
        motion = motions_of([alone], InputFiles(study.folder.path))[0]
        source: dict[str, Any] = {"record": PurePosixPath(name).parent.name, "file_name": PurePosixPath(name).name}
        keys: tuple[str, ...] = _OF_RECORDS
        scale = table.scale
    else:
        motion = study.job.problem.motions[number]
        source = {"synthetic": table.synthetic, "seed": table.seed or 0, "member": index}
        keys, scale = _OF_FAMILIES, 1.0
    source |= {key: getattr(table, key) for key in keys if getattr(table, key) is not None}
    if stretch == 1.0:
        return motion, source, scale
    assert isinstance(motion, GroundMotion)  # pulses were handled before
    return replace(motion, time_step=motion.time_step * stretch), None, scale


def stretched_words(text: str, stretch: float) -> str:
    """Return the text of a pulse with its time multiplied by a factor [-] and its acceleration unchanged."""
    if stretch == 1.0:
        return text
    name, _, tail = text.partition(":")
    pairs = [tuple(word.strip() for word in item.partition("=")[::2]) for item in filter(None, tail.split(","))]
    changed = [(key, repr(whole_or_number(key, value) * stretch) if key in _TIMES else value) for key, value in pairs]
    stretched = f"{name}:{','.join(f'{key}={value}' for key, value in changed)}"
    before, after = pulse(text), pulse(stretched)
    if abs(after.duration / (stretch * before.duration) - 1.0) + abs(after.peak / before.peak - 1.0) > _CLOSE:
        raise ArithmeticError(f"{stretched} is not {text} stretched by {stretch!r}")
    return stretched


def cell_of(study: OpenStudy, point: HistoryPlace, points: int = POINTS) -> dict[str, Any]:
    """Return the simulation of a point, `HistoryAnswer`."""
    # ``difference`` is the difference between the peak rotation of the study and that of the response, which has other
    # time steps of equal accuracy
    cell: dict[str, Any] = {
        **Answer({"stored": stored(study, point), "answer": None, "difference": None}).plain(), "inputs": None,
    }  # fmt: skip
    if "friction" in study.job.problem.settings.stated:
        return cell | {"note": "time histories with friction are not shown here; use `rocking simulate --friction`"}
    try:
        variation = Variation.of(study, point)
        if isinstance(variation.restitution, float) and not np.isfinite(variation.restitution):
            return cell | {"note": "the coefficient of this cell would create energy; it was not computed"}
        motion, source, scale = _motion_at(study, point.index["motion"], variation.stretch)
        problem, response = _responded(study, point, variation, motion, scale * variation.scale)
    except InvalidValueError as error:
        return cell | {"note": str(error)}
    note = _why_not(variation, source)
    if not note:
        settings = study.job.document.settings.model_dump(exclude_unset=True, exclude_none=True)
        moved = {**(source or {}), "scale": variation.scale * scale}
        inputs = {"body": variation.table, "motion": moved, "restitution": variation.choice}
        cell["inputs"] = inputs | ({"settings": settings} if settings else {})
    cell["note"] = note
    if response.outcome is Outcome.FAILED:
        return cell | {"note": Message("there is no response: {reason}", {"reason": response.status.value})}
    difference = abs(response.peak_rotation - abs(cell["stored"]["peak_rotation"]))
    answer = response_answer(variation.label, response, problem, points)
    document = Answer({"stored": cell["stored"], "answer": answer, "difference": difference}).plain()
    return cell | document


def stored(study: OpenStudy, point: HistoryPlace) -> dict[str, Any]:
    """Return the stored results of a simulation, `StoredHistory`."""
    history = study.history(point.number)
    results = {name: plain(history[name]) for name in _STORED}
    return {"history": point.number, "meaning": mode_words(results["mode"]), **results}


def _responded(
    study: OpenStudy, point: HistoryPlace, variation: Variation, motion: Motion, scale: float
) -> tuple[ResponseProblem, Response]:
    job, engine = study.job, study.job.document.settings.engine
    problem = ResponseProblem(
        variation.body, motion, {variation.label: variation.restitution}, job.problem.settings, engine, scale=scale
    )
    start = {name: getattr(variation, name) for name in _STARTS}
    options = {**problem.settings.stated, "engine": engine, "stream": point.number, **start}
    with warnings.catch_warnings():  # the answer contains the warnings
        warnings.simplefilter("ignore", PureRockingWarning)
        return problem, simulate(variation.body, motion, variation.restitution, scale=scale, **options)


def _why_not(variation: Variation, source: dict[str, Any] | None) -> str:
    """Return the reason why inputs cannot express this simulation, or an empty text."""
    if source is None:
        return (
            f"the time of the motion is stretched by {variation.stretch:.6g} here, which inputs cannot say of a motion "
            "that is no pulse; the response is the one with the stretched motion"
        )
    if variation.rotation or variation.angular_velocity:
        return "inputs with a motion cannot contain an initial rotation or an initial angular velocity"
    if variation.choice is None:
        return "the coefficient is sampled at every impact, which inputs cannot contain"
    return ""
