"""Histories of bodies with restraints, by the compiled or the reference engine."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.bodies.restrained import Restrained
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import Event, EventKind
from rocking.dynamics.restrained.devices import Device, RestraintEvent, check_path, devices_of, without_rounding
from rocking.dynamics.restrained.laws import Phase
from rocking.dynamics.restrained.reference import RestrainedReference, RestrainedTrajectory
from rocking.dynamics.restrained.settings import RestrainedSettings
from rocking.dynamics.settings import CompiledEngine, check_progress
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

RESULTS: dict[str, Any] = {
    "outcome": np.int8, "status": np.int8, "side": np.int8, "peak_rotation": np.float64, "peak_time": np.float64,
    "peak_velocity": np.float64, "overturning_time": np.float64, "first_uplift": np.float64, "impacts": np.int64,
    "uplifts": np.int64, "still_rocking": np.int8, "residual_rotation": np.float64,
}  # fmt: skip
"""Results of every history, with their types."""
RESTRAINT_RESULTS = (
    "largest_force", "smallest_force", "largest_elongation", "smallest_elongation", "plastic_elongation", "yield_count",
    "is_broken", "dissipated_energy",
)  # fmt: skip
"""Results of every restraint of a history."""
PHASES = (
    "elastic", "yields in tension", "yields in compression", "slack", "broken", "viscous", "sticks", "slips in tension",
    "slips in compression", "open", "tension", "compression", "contact", "released",
)  # fmt: skip
"""Names of phases by the codes of the compiled engine."""

_COMPILED = CompiledEngine(
    "rocking.dynamics._restrained",
    "the fast engine of restraints was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
    floats=("peak_rotation", "peak_time", "peak_velocity", "overturning_time", "first_uplift", "residual_rotation"),
    integers=("outcome", "status", "side", "impacts", "uplifts", "still_rocking"),
)
FAST = "fast (Taylor, order up to 30, compiled)"
_OUTCOMES, _STATUSES = list(Outcome), list(Status)
_PIECE = 1 << 14


@dataclass(frozen=True)
class RestrainedHistory:
    """Inputs of one history."""

    body: Restrained
    parameters: RockingParameters
    motion: int  # index of the motion
    start: tuple[float, float]  # theta [rad], theta' [rad/s]
    scale: float
    length: float  # duration [s]


def chosen(requested: str, law: ImpactLaw) -> str:
    """Return the name of the engine to use. The compiled engine requires constant coefficients."""
    if isinstance(law, ConstantRestitution) or requested == "reference":
        return _COMPILED.chosen(requested)
    if requested == "fast":
        raise InvalidValueError(
            "the fast engine does not support {law}; {parameter} must be {allowed}", parameter="engine",
            allowed="reference", value=requested, law=type(law).__name__,
        )  # fmt: skip
    return "reference"


def run(
    body: Restrained,
    parameters: RockingParameters,
    segments: Segments,
    settings: RestrainedSettings,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    stream: int = 0,
    engine: str = "auto",
) -> RestrainedTrajectory:
    """Return one history from theta [rad] and theta' [rad/s]."""
    rotation, velocity = start
    check_path(body, rotation, 0.0 if rotation else velocity)
    devices = devices_of(body, linear=settings.linear)
    if chosen(engine, parameters.law) == "reference":
        reference = RestrainedReference(parameters, body.mass, devices, segments, settings, scale, stream)
        return reference.run(*start)
    count, width = segments.count, len(devices)
    numbers = _numbers(body, parameters, settings.gravity, scale, start)
    choices = np.array([0, count, 0, width], np.int64)
    samples = np.zeros((3, count + 1))
    elongation, force, work = (np.zeros((count + 1, width)) for _ in range(3))
    integers, floats, written, of_body, of_restraints, peaks, states, contacts = library_of([segments]).trace(
        numbers, _laws(devices), choices, samples, elongation, force, work, **_common(settings)
    )
    for array in (samples.T, elongation, force, work):
        array[written:] = np.nan
    values = dict(zip(_COMPILED.integers, integers, strict=True)) | dict(zip(_COMPILED.floats, floats, strict=True))
    for device, state in zip(devices, states, strict=True):
        _restore(device, state)
    events = [
        Event(time, EventKind(int(kind)), int(side), before, after, r)
        for kind, time, side, before, after, r in np.reshape(of_body, (-1, 6)).tolist()
    ]
    changes = [
        RestraintEvent(time, int(index), PHASES[int(phase)], theta, e, before)
        for index, time, phase, theta, e, before in np.reshape(of_restraints, (-1, 6)).tolist()
    ]
    return RestrainedTrajectory(
        samples[0], samples[1], elongation, force, work, samples[2], devices, events, changes,
        [(time, theta) for time, theta in np.reshape(peaks, (-1, 2)).tolist()],
        [tuple(row) for row in np.reshape(contacts, (-1, 3 + width)).tolist()],
        _OUTCOMES[values["outcome"]], _STATUSES[values["status"]],
        **{name: values[name] for name in (
            "side", "peak_rotation", "peak_time", "peak_velocity", "overturning_time", "impacts", "uplifts",
        )},
        engine=FAST,
    )  # fmt: skip


def run_rows(
    histories: Sequence[RestrainedHistory],
    segments: Sequence[Segments],
    settings: RestrainedSettings,
    *,
    engine: str,
    threads: int,
    progress: Callable[[int], None] | None = None,
) -> tuple[str, dict[str, np.ndarray], dict[str, FloatArray]]:
    """Return the name of the engine, and the results of histories and of their restraints."""
    check_progress(progress)
    width = max(len(history.body.restraints) for history in histories)
    restraints = {name: np.full((len(histories), width), np.nan) for name in RESTRAINT_RESULTS}
    if chosen(engine, ConstantRestitution()) == "reference":
        results = {name: np.zeros(len(histories), dtype) for name, dtype in RESULTS.items()}
        for k, history in enumerate(histories):
            trajectory = _followed(history, segments[history.motion], settings)
            for name, value in _summary(trajectory).items():
                results[name][k] = value
            for i, device in enumerate(trajectory.devices):
                for name, value in device.summary.items():
                    restraints[name][k, i] = value
            if progress is not None:
                progress(1)
        return "reference", results, restraints
    library, floats, integers = library_of(segments), *_COMPILED.empty_tables(len(histories))
    for first in range(0, len(histories), _PIECE):
        piece = slice(first, min(first + _PIECE, len(histories)))
        _run_piece(library, histories[piece], segments, settings, threads, floats[piece], integers[piece], [
            values[piece] for values in restraints.values()
        ])  # fmt: skip
        if progress is not None:
            progress(piece.stop - first)
    extremes = (restraints[name] for name in RESTRAINT_RESULTS[:4])
    restraints["dissipated_energy"] = without_rounding(restraints["dissipated_energy"], *extremes)
    columns = _COMPILED.columns_by_name(floats, integers)
    return FAST, {name: columns[name].astype(dtype) for name, dtype in RESULTS.items()}, restraints


def _run_piece(  # noqa: PLR0917 - tables of inputs and results
    library: Any,
    histories: Sequence[RestrainedHistory],
    segments: Sequence[Segments],
    settings: RestrainedSettings,
    threads: int,
    floats: FloatArray,
    integers: IntArray,
    restraints: list[FloatArray],
) -> None:
    """Run a piece of many histories. The description of a body is passed once to the engine."""
    bodies = {id(history.body): history.body for history in histories}
    laws = {key: _laws(devices_of(body, linear=settings.linear)) for key, body in bodies.items()}
    starts = dict(zip(laws, np.cumsum([0, *map(len, laws.values())]).tolist(), strict=False))
    counts = [len(history.body.restraints) for history in histories]
    choices = np.array([
        (h.motion, max(1, math.ceil(h.length / segments[h.motion].step - 1e-9)), starts[id(h.body)], count)
        for h, count in zip(histories, counts, strict=True)
    ], np.int64)  # fmt: skip
    numbers = np.array([_numbers(h.body, h.parameters, settings.gravity, h.scale, h.start) for h in histories])
    described = np.full((sum(counts), len(RESTRAINT_RESULTS)), np.nan)
    library.run(
        numbers, np.concatenate(list(laws.values())), choices, floats, integers, described, **_common(settings),
        threads=threads,
    )  # fmt: skip
    row = np.repeat(np.arange(len(histories)), counts)
    column = np.concatenate([np.arange(count) for count in counts])
    for values, result in zip(restraints, described.T, strict=True):
        values[row, column] = result


def library_of(segments: Sequence[Segments]) -> Any:
    """Return motions in the form of the compiled engine."""
    parts: list[FloatArray] = []
    places, first = [], 0
    for motion in segments:
        rows = [motion.horizontal] if motion.vertical is None else [motion.horizontal, motion.vertical]
        places.append((first, motion.count, motion.degree + 1, len(rows) - 1))
        parts += [row.ravel() for row in rows]
        first += sum(row.size for row in rows)
    data = np.concatenate(parts)
    if not np.isfinite(data).all():
        raise InvalidValueError(
            "ground accelerations must be finite [m/s2], got NaN or infinity; check the record for gaps"
        )
    steps = np.array([motion.step for motion in segments])
    return _COMPILED.module().Library(data, np.array(places, np.int64), steps)


def _common(settings: RestrainedSettings) -> dict[str, Any]:
    return {
        "gravity": settings.gravity, "rest_speed": settings.rest_speed, "tolerance": settings.tolerance,
        "most_events": settings.most_events, "linear": settings.linear,
    }  # fmt: skip


def _numbers(
    body: Restrained, parameters: RockingParameters, gravity: float, scale: float, start: tuple[float, float]
) -> FloatArray:
    """Return alpha, p, I, m g R and r of both sides, the scale and the start."""
    sides: list[float] = []
    for side in (parameters.right, parameters.left):
        inertia = body.mass * side.semi_diagonal**2 / side.inertia_ratio
        unit = body.mass * gravity * side.semi_diagonal
        sides += [side.slenderness_angle, side.frequency_parameter, inertia, unit, side.coefficient]
    return np.array([*sides, scale, *start])


def _laws(devices: list[Device]) -> FloatArray:
    """Return law and levers of the restraints, one row per restraint."""
    rows = [
        [*device.law.row(), *(value for side in (1, -1) for value in device.levers[side].row())] for device in devices
    ]
    return np.array(rows).reshape(len(devices), 13)


def _restore(device: Device, state: tuple[Any, ...]) -> None:
    """Set a restraint to its state at the end of a history."""
    phase, plastic, yields, lost, work, elongation, rate, *extremes, start_energy = state
    law = device.law
    law.plastic, law.yields, law.lost = plastic, int(yields), lost
    law.phase = Phase("broken") if PHASES[phase] == "broken" else law.named(PHASES[phase])
    device.work, device.elongation, device.rate, device.start_energy = work, elongation, rate, start_energy
    device.largest_force, device.smallest_force, device.largest_elongation, device.smallest_elongation = extremes


def _followed(history: RestrainedHistory, motion: Segments, settings: RestrainedSettings) -> RestrainedTrajectory:
    """Return one of many histories by the reference engine."""
    count = max(1, math.ceil(history.length / motion.step - 1e-9))
    return run(
        history.body, history.parameters, motion.extended(history.length).first(count), settings, history.start,
        scale=history.scale, engine="reference",
    )  # fmt: skip


def _summary(trajectory: RestrainedTrajectory) -> dict[str, Any]:
    """Return the results of one history by the names of `RESULTS`."""
    codes = {"outcome": trajectory.outcome.code, "status": trajectory.status.code}
    last = trajectory.rotation[np.isfinite(trajectory.rotation)][-1]
    values = {name: getattr(trajectory, name) for name in RESULTS if name not in {*codes, "residual_rotation"}}
    return codes | values | {"residual_rotation": last}
