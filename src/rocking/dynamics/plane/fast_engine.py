"""The fast engine of pure rocking: availability, input and output arrays, and one history with all samples."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.dynamics.plane.equations import Event, EventKind, Trajectory
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.settings import ENGINES, CompiledEngine
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

Arrays = dict[str, Any]

RESULTS: dict[str, Any] = {
    "outcome": np.int8, "status": np.int8, "side": np.int8,
    "peak_rotation": np.float64, "peak_time": np.float64, "peak_velocity": np.float64,
    "overturning_time": np.float64, "first_uplift": np.float64, "truncation": np.float64,
    "impacts": np.int64, "uplifts": np.int64, "least_force": np.float64, "friction_demand": np.float64,
    "still_rocking": np.int8,
}  # fmt: skip
"""Results of the fast engine for every history, with their types."""


_NOT_FINITE = "ground accelerations must be finite [m/s2], got NaN or infinity in a motion; check the record for gaps"
_COMPILED = CompiledEngine(
    "rocking.dynamics._engine",
    "the fast engine was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
)
available, module = _COMPILED.available, _COMPILED.module
instruction_sets, instruction_set = _COMPILED.instruction_sets, _COMPILED.instruction_set


def chosen(requested: str, law: ImpactLaw | None = None) -> str:
    """Return the name of the engine to use. Issue a warning if "auto" selects the slow engine."""
    if law is None or law.tabulated or requested == "reference":
        return _COMPILED.chosen(requested)
    if checks.one_of("engine", requested, ENGINES) == "fast":
        raise InvalidValueError(
            "the fast engine does not support {law}; {parameter} must be {allowed}", parameter="engine",
            allowed="reference", value=requested, law=type(law).__name__,
        )  # fmt: skip
    return "reference"


def library_of(segments: Sequence[Segments]) -> Any:
    """Return motions in the form of the engine.

    All motions have the same degree; either all motions have a vertical component, or none.
    """
    if not segments:
        raise InvalidValueError("motions must contain at least one motion, got none")
    degree = segments[0].degree
    vertical = any(s.vertical is not None for s in segments)
    if degree not in {1, 7} or any(s.degree != degree for s in segments):
        raise InvalidValueError("motions in one batch must be all records or all pulses; sample the pulses")
    if degree > 1 and vertical:
        raise InvalidValueError("a pulse cannot have a vertical component; sample it")
    columns = degree + 1 if degree > 1 else 1 + vertical
    data = np.empty((sum(s.count + 2 for s in segments), columns))
    offsets = np.empty((3, len(segments)), np.int64)
    row_count = 0
    with np.errstate(invalid="ignore", over="ignore"):  # numbers that are not finite raise an error below
        for k, motion in enumerate(segments):
            rows, before, still = _write_motion(motion, data[row_count:])
            offsets[:, k] = row_count * columns, before, still
            row_count += rows
    steps = np.array([s.step for s in segments])
    return module().Library(data[:row_count].ravel(), degree, vertical, *offsets, steps)


def _write_motion(segments: Segments, rows: FloatArray) -> tuple[int, int, int]:
    """Write a motion into the first rows.

    Return the numbers of rows, segments before a jump, and segments after it.
    """
    count, still = segments.count, 0
    if segments.degree > 1:
        rows[:count] = segments.horizontal
        if not np.isfinite(rows[:count]).all():
            raise InvalidValueError(_NOT_FINITE)
        return count, count, 0
    components = [segments.horizontal] if segments.vertical is None else [segments.horizontal, segments.vertical]
    if len(components) < rows.shape[1]:
        rows[: count + 1, 1] = 0.0
    joined = [_continuous(lines, rows[: count + 1, k]) for k, lines in enumerate(components)]
    if not all(joined):
        before = _jump(components, rows[: count + 1], segments.step)
        still = count - before
        rows[before] = [lines[before - 1].sum() for lines in components] + [0.0] * (rows.shape[1] - len(components))
        rows[before + 1 : count + 2] = 0.0
    return count + (2 if still else 1), count - still, still


def _continuous(lines: FloatArray, samples: FloatArray) -> bool:
    """Write the samples at the ends of lines. Return True if the lines are continuous."""
    samples[:-1], samples[-1] = lines[:, 0], lines[-1, 0] + lines[-1, 1]
    return bool(_gaps(lines, samples).max(initial=0.0) <= _allowed(samples) < math.inf)


def _gaps(lines: FloatArray, samples: FloatArray) -> FloatArray:
    """Return the gaps between consecutive lines."""
    gaps = lines[:-1, 1] + samples[:-2]
    gaps -= samples[1:-1]
    return np.abs(gaps, out=gaps)


def _allowed(samples: FloatArray) -> float:
    """Return the largest gap that rounding can explain."""
    return 1e-14 * float(max(samples.max(), -samples.min()))


def _jump(components: list[FloatArray], samples: FloatArray, step: float) -> int:
    """Return the number of segments before the jump to rest. Raise an error for other jumps."""
    if not all(np.isfinite(x).all() for x in (*components, samples)):
        raise InvalidValueError(_NOT_FINITE)
    columns = zip(components, samples.T, strict=False)
    jumps = np.flatnonzero(np.any([_gaps(lines, x) > _allowed(x) for lines, x in columns], axis=0))
    before = int(jumps[0]) + 1
    if jumps.size > 1 or any(np.any(lines[before:]) for lines in components):
        raise InvalidValueError(
            "the fast engine needs records without jumps between samples, got {jumps}, the first after {time:g} s",
            jumps=jumps.size, time=before * step, hint='use engine="reference"',
        )  # fmt: skip
    return before


def empty_results(count: int, types: Mapping[str, Any] = RESULTS) -> Arrays:
    """Return empty arrays for the results of histories by name, filled with NaN or 0."""
    return {
        name: np.full(count, np.nan if np.issubdtype(dtype, np.floating) else 0, dtype) for name, dtype in types.items()
    }


def common(settings: PlaneSettings, law: ImpactLaw) -> Arrays:
    """Return the arguments that all calls of the fast engine share."""
    return {
        "kind": law.kind, "at": law.at, "value": law.factors.ravel(), "seed": law.seed,
        "gravity": settings.gravity, "longest_step": settings.longest_step, "rest": settings.rest_speed,
        "most_impacts": settings.most_events, "linear": settings.linear, "isa": instruction_set(),
    }  # fmt: skip


_ORDER = 8
_OUTCOMES, _STATUSES = list(Outcome), list(Status)


def run(
    parameters: RockingParameters,
    segments: Segments,
    settings: PlaneSettings,
    *,
    engine: str = "auto",
    scale: float = 1.0,
    stream: int = 0,
    rotation: float = 0.0,
    velocity: float = 0.0,
) -> Trajectory:
    """Return one history by the requested engine.

    The fast engine gives the same bits for one history and for a batch.
    """
    engine_name = chosen(engine, parameters.law)
    if engine != "reference" and settings.order != _ORDER:
        raise InvalidValueError(
            "{parameter} must be {allowed} for one history, got {value}: orders 4 and 6 apply only to batches "
            "(simulate_many), nonlinear equations and motions without a vertical component", parameter="order",
            allowed=_ORDER, value=settings.order,
        )  # fmt: skip
    if engine_name == "reference":
        from rocking.dynamics.plane.reference import Reference

        return Reference(parameters, segments, settings, scale=scale, stream=stream).run(rotation, velocity)
    library, out = library_of([segments]), empty_results(1)
    rows = sides_of([parameters]) | {
        "scale": np.array([scale]), "rotation": np.array([rotation]), "velocity": np.array([velocity]),
        "motion": np.zeros(1, np.int64), "key": np.array([stream], np.int64),
    }  # fmt: skip
    rotations, velocities = np.zeros(segments.count + 1), np.zeros(segments.count + 1)
    arguments = common(settings, parameters.law)
    raw_events = module().run_single(
        library, rows, out, to_the_ground=True, rotation=rotations, velocity=velocities, **arguments
    )
    results = {name: values[0].item() for name, values in out.items()}
    results |= {"outcome": _OUTCOMES[results["outcome"]], "status": _STATUSES[results["status"]]}
    if results["outcome"] in {Outcome.OVERTURNED, Outcome.FAILED}:  # values after the last event were not computed
        written = np.flatnonzero((rotations != 0.0) | (velocities != 0.0))
        latest = int(max((event[0] for event in raw_events), default=0.0) / segments.step)
        after = max(written[-1] if written.size else 0, latest) + 1
        rotations[after:] = velocities[after:] = np.nan
    order = 6 if _uses_order_six(parameters, segments, settings, scale) else _ORDER
    # a single history uses the kernels of AVX2, because wider registers have no effect
    kernels = "avx2" if arguments["isa"] == "avx512" and order == _ORDER else arguments["isa"]
    events = [Event(t, EventKind(kind), side, before, then, r) for t, kind, side, before, then, r in raw_events]
    for name in ("first_uplift", "still_rocking"):  # properties of the trajectory
        del results[name]
    return Trajectory(rotations, velocities, events, engine=f"fast (Taylor, order {order}, {kernels})", **results)


def _uses_order_six(parameters: RockingParameters, segments: Segments, settings: PlaneSettings, scale: float) -> bool:
    """Return True if the engine uses order 6 because the time step of a record is short."""
    if segments.degree != 1 or settings.linear:
        return False
    components = [component for component in (segments.horizontal, segments.vertical) if component is not None]
    strength = sum(float(np.abs([component[:, 0], component.sum(axis=1)]).max()) for component in components)
    p = max(parameters.right.frequency_parameter, parameters.left.frequency_parameter)
    reach = (settings.longest_step**9 / 7200.0) ** (1.0 / 7.0)  # Eq. 54
    return bool(p * segments.step * max(1.0, abs(scale / settings.gravity) * strength) ** 0.6 < reach)
