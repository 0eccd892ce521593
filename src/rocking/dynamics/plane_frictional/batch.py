"""Many histories of plane bodies with friction: rows of a study, and all combinations of `simulate_many`."""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, IntArray
from rocking.dynamics.combined import dataset_of, label_of, plane_inputs
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics_base import Combinations
from rocking.dynamics.parameters import UNIMPOSED
from rocking.dynamics.plane_frictional.base import PlaneBase, Start, state_at_start
from rocking.dynamics.plane_frictional.response import (
    AFTER,
    FINE,
    LONGER,
    ContactResponse,
    imposed_on,
    length_of,
    response_with_contact,
)
from rocking.dynamics.plane_frictional.settings import ContactSettings
from rocking.dynamics.rows import Rows
from rocking.dynamics.settings import BOUNCE_LAWS, CompiledEngine, check_progress, checked_friction, thread_count
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, of_results, overturned

if TYPE_CHECKING:
    import xarray as xr

NUMBERS = (
    "inertia", "height", "left", "right", "friction", "bounce", "imposed_left", "imposed_right", "scale", "end",
    "x", "rise", "rotation", "u", "w", "spin",
)  # fmt: skip
"""Columns of a history, besides motion, law and feet in contact.

The names are those of `PlaneBase`, `GroundContact` and `ContactState`. Coefficients that are not imposed are NaN. `end`
is the end of the history [s].
"""

FAST = "fast: Taylor series with events and complementarity, compiled"
REFERENCE = "reference: Taylor series with events and complementarity"

_COMPILED = CompiledEngine(
    "rocking.dynamics._contact",
    "the fast engine with friction was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
    "the reference engine runs instead, one history at a time",
    ("peak_rotation", "peak_time", "peak_velocity", "overturning_time", "first_uplift", "sliding_distance",
     "residual_displacement", "friction_usage", "end_time"),
    ("outcome", "status", "side", "impacts", "uplifts", "still_rocking", "impacts_replaced", "shocks", "steps"),
)  # fmt: skip
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen


def library_of(motions: Sequence[Segments]) -> Any:
    """Return motions in the form of the compiled engine."""
    data, offsets, size = [], [], 0
    for motion in motions:
        components = [motion.horizontal] if motion.vertical is None else [motion.horizontal, motion.vertical]
        offsets.append((size, motion.count, motion.degree + 1, len(components) - 1))
        data += [component.ravel() for component in components]
        size += sum(component.size for component in components)
    steps = np.array([motion.step for motion in motions])
    return module().Library(np.concatenate(data, dtype=np.float64), np.array(offsets, np.int64), steps)


def run_compiled(
    library: Any,
    values: dict[str, Any],
    motion: Any,
    touching: Any,
    *,
    settings: ContactSettings,
    threads: int,
) -> dict[str, np.ndarray]:
    """Return results by name for histories with columns `NUMBERS`. `motion` contains the indices of the motions."""
    # touching: feet in contact, as the sum of 1 (left) and 2 (right)
    bounce_law = BOUNCE_LAWS.index(settings.normal_restitution_law)
    columns = np.broadcast_arrays(*(values[name] for name in NUMBERS), motion, bounce_law, touching)
    numbers: FloatArray = np.column_stack([np.ravel(column) for column in columns[:-3]]).astype(np.float64)
    choices = np.column_stack([np.ravel(column) for column in columns[-3:]]).astype(np.int64)
    results, counts = _COMPILED.empty_tables(len(numbers))
    library.run(
        numbers, choices, results, counts, settings.gravity, settings.rest_speed, settings.tolerance,
        settings.most_events, threads,
    )  # fmt: skip
    return _COMPILED.columns_by_name(results, counts)


class RowsWithContact:
    """Motions in the form of the compiled engine with friction. `run` computes histories given as rows of a study."""

    def __init__(self, motions: Sequence[Segments], law: ImpactLaw, settings: ContactSettings, engine: str) -> None:
        if engine == "reference":
            raise InvalidValueError(
                'studies with friction need the compiled engine; engine="reference" is for simulate and simulate_many'
            )
        if not isinstance(law, ConstantRestitution):
            raise InvalidValueError(
                "with friction the coefficient of restitution must be constant within a history, got {law}",
                parameter="restitution", law=type(law).__name__,
            )  # fmt: skip
        self.motions, self.settings = motions, settings

    @cached_property
    def library(self) -> Any:
        """Motions in the form of the compiled engine."""
        return library_of(self.motions)

    def run(self, piece: Rows, threads: int) -> tuple[dict[str, np.ndarray], dict[str, int]]:
        """Return the results of a piece by their names in studies, and numbers of steps."""
        # r = `UNIMPOSED` is not imposed; if a friction is NaN, the friction of the settings applies; a row with another
        # r that is negative or not finite gets an error status
        values, motion = piece.values, piece.motion
        right, left = _side(values, "right", self.settings), _side(values, "left", self.settings)
        same = np.isclose(right["height"], left["height"], rtol=1e-6) & np.isclose(
            right["inertia"], left["inertia"], rtol=1e-6
        )
        coefficients = np.array([values[f"r_{foot}"] for foot in FEET])
        is_valid = np.all(((coefficients >= 0.0) & (coefficients <= 100.0)) | (coefficients == UNIMPOSED), axis=0)
        size = np.maximum(right["size"], left["size"])
        friction = np.where(np.isnan(values["friction"]), self.settings.friction, values["friction"])
        table: dict[str, Any] = {
            "inertia": np.where(same & is_valid, right["inertia"], np.nan), "height": right["height"],
            "left": left["half_width"], "right": right["half_width"],
            "friction": friction, "bounce": self.settings.normal_restitution,
            "imposed_left": _imposed(values["r_left"]), "imposed_right": _imposed(values["r_right"]),
            "scale": values["scale"], "end": self._ends(motion, size),
        } | dict.fromkeys(NUMBERS[10:], 0.0)  # fmt: skip
        touching = np.full(motion.size, 3)
        if values["rotation"].any() or values["velocity"].any():
            touching = _start(table, values["rotation"], values["velocity"])
        results = run_compiled(self.library, table, motion, touching, settings=self.settings, threads=threads)
        demand = {"friction_demand": results["friction_usage"] * friction}
        return results | demand, {"steps": int(results["steps"].sum())}

    def _ends(self, motion: np.ndarray, size: FloatArray) -> FloatArray:
        """Return the ends of the histories [s]."""
        number = np.clip(motion, 0, len(self.motions) - 1)
        duration, step, pulse = (
            np.array(values)[number]
            for values in zip(*((m.duration, m.step, m.degree > 1) for m in self.motions), strict=True)
        )
        slow = np.sqrt(size / self.settings.gravity)
        return ends_of(duration + AFTER * slow, step, pulse, slow)


def ends_of(length: Any, step: Any, pulse: Any, slow: Any) -> FloatArray:
    """Return the ends of histories [s].

    An end is at a sample of the reference engine, which divides pulses into finer steps.
    """
    # slow: sqrt(R / g) [s]
    with np.errstate(invalid="ignore"):
        step = np.where(pulse, step / np.maximum(1.0, np.ceil(step / (FINE * slow))), step)
        return np.asarray(np.maximum(1.0, np.ceil(length / step - 1e-9)) * step)


def _side(values: dict[str, FloatArray], foot: str, settings: ContactSettings) -> dict[str, FloatArray]:
    """Return R, h, b [m] and I_C / m [m2] of a side from alpha, p and q."""
    alpha, p, q = (values[f"{name}_{foot}"] for name in ("alpha", "p", "q"))
    with np.errstate(all="ignore"):  # an invalid row gets an error status
        size = settings.gravity * q / p**2  # Eq. 26
        inertia = size**2 * (1.0 / q - 1.0)  # Eq. 27
        return {"size": size, "height": size * np.cos(alpha), "half_width": size * np.sin(alpha), "inertia": inertia}


def _imposed(coefficient: FloatArray) -> FloatArray:
    """Return coefficients for the compiled engine, NaN if none is imposed."""
    return np.where(coefficient == UNIMPOSED, np.nan, coefficient)


def _start(table: dict[str, Any], rotation: FloatArray, velocity: FloatArray) -> np.ndarray:
    """Add the state of bodies tilted about a foot without sliding to the table. Return the feet in contact as bits."""
    foot = np.where(rotation + np.where(rotation == 0.0, velocity, 0.0) < 0.0, -1.0, 1.0)
    lever = np.where(foot > 0.0, table["right"], -table["left"])
    with np.errstate(all="ignore"):
        sine, cosine, height = np.sin(rotation), np.cos(rotation), table["height"]
        arm = (lever * cosine - height * sine, -lever * sine - height * cosine)  # Eq. 58
        rise = lever * sine - 2.0 * height * np.sin(0.5 * rotation) ** 2  # Eq. 59
        table |= {
            "x": lever - arm[0], "rise": rise, "rotation": rotation,
            "u": -arm[1] * velocity, "w": arm[0] * velocity, "spin": velocity,
        }  # fmt: skip
    return np.where(rotation == 0.0, 3, np.where(foot > 0.0, 2, 1))


PIECE = 1 << 14
"""Histories per call of the fast engine."""


def many_with_contact(cases: Combinations, settings: ContactSettings) -> "xr.Dataset":
    """Return the results of all combinations of plane bodies."""
    bodies, motions, scales, starts = plane_inputs(cases)
    check_progress(cases.progress)
    threads, restitutions = thread_count(cases.threads), cases.restitutions
    for mu in cases.frictions[1:].tolist():
        checked_friction("friction", mu)
    if chosen(cases.engine) == "fast":
        imposed = [
            [imposed_on(body, restitution, settings) or (np.nan, np.nan) for restitution in restitutions]
            for body in bodies
        ]
        bases = [PlaneBase.of_body(body) for body in bodies]
        table = _Table(
            bases, motions, scales, np.array(imposed), cases.frictions, starts or [Start()], cases.duration, settings
        )
        results, engine = table.run(threads, cases.progress), FAST
    else:
        results, engine = _one_by_one(cases, bodies, motions, scales, starts or [Start()], settings), REFERENCE
    labels = list(map(label_of, restitutions))
    return dataset_of(
        bodies, motions, {"scale": scales, "restitution": labels, "friction": cases.frictions, "start": starts},
        results, settings,
        {
            "engine": engine, "normal_restitution": settings.normal_restitution,
            "normal_restitution_law": settings.normal_restitution_law,
            "duration": np.nan if cases.duration is None else cases.duration,
        },
    )  # fmt: skip


def _one_by_one(
    cases: Combinations, bodies: list[Body], motions: list[Motion], scales: FloatArray, starts: Sequence[Start],
    settings: ContactSettings,
) -> dict[str, np.ndarray]:  # fmt: skip
    rows = []
    combinations = product(bodies, motions, scales.tolist(), cases.restitutions, cases.frictions.tolist(), starts)
    for body, motion, scale, restitution, mu, start in combinations:
        with warnings.catch_warnings():  # the warning was already issued once
            warnings.simplefilter("ignore", PlausibilityWarning)
            response = response_with_contact(
                body, motion, restitution, replace(settings, friction=mu), start=start, scale=scale,
                duration=cases.duration,
            )  # fmt: skip
        rows.append(_row_of(response))
        if cases.progress is not None:
            cases.progress(1)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@dataclass(frozen=True)
class _Table:
    """All combinations of bodies, motions, scales, restitutions, frictions and starts, for the fast engine."""

    bases: Sequence[PlaneBase]
    motions: Sequence[GroundMotion | Pulse]
    scales: FloatArray
    imposed: FloatArray  # coefficients by body, restitution, and foot of landing (left, right) [-]
    friction: FloatArray
    starts: Sequence[Start]
    duration: float | None
    settings: ContactSettings

    def run(self, threads: int, progress: Callable[[int], None] | None) -> dict[str, np.ndarray]:
        """Return the columns of `_row_of`, computed in pieces."""
        segments = [motion.segments() for motion in self.motions]
        library = library_of(segments)
        numbers = [(base.inertia, base.height, base.left, base.right) for base in self.bases]
        states = [[state_at_start(start, base) for start in self.starts] for base in self.bases]
        state = np.array([[initial[:6] for initial in row] for row in states])
        touching = np.array(
            [[sum(1 if foot < 0 else 2 for foot in initial.touching) for initial in row] for row in states]
        )
        ends = self._ends(segments)
        shape = (
            len(self.bases), len(self.motions), self.scales.size, self.imposed.shape[1], self.friction.size,
            len(self.starts),
        )  # fmt: skip
        count, pieces = int(np.prod(shape)), []
        for first in range(0, count, PIECE):
            last = min(first + PIECE, count)
            body, motion, scale, choice, mu, start = np.unravel_index(np.arange(first, last), shape)
            values: dict[str, Any] = dict(zip(NUMBERS[:4], np.array(numbers)[body].T, strict=True))
            values |= {"friction": self.friction[mu], "scale": self.scales[scale]}
            values["bounce"] = self.settings.normal_restitution
            values |= dict(zip(("imposed_left", "imposed_right"), self.imposed[body, choice].T, strict=True))
            values |= dict(zip(NUMBERS[10:], state[body, start].T, strict=True))
            values = {name: np.broadcast_to(column, body.shape) for name, column in values.items()}
            feet, ends_of_rows = touching[body, start], [end[body, motion] for end in ends]
            pieces.append(self._followed(library, values, motion, feet, ends_of_rows, threads))
            if progress is not None:
                progress(last - first)
        return _columns({name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]})

    def _ends(self, segments: Sequence[Segments]) -> list[FloatArray]:
        """Return the possible durations of histories [s], shortest first, as arrays over body and motion."""
        return [
            np.array([
                [ends_of(length_of(motion, slow, self.duration, after), segment.step, isinstance(motion, Pulse), slow)
                 for motion, segment in zip(self.motions, segments, strict=True)]
                for slow in (math.sqrt(base.size / self.settings.gravity) for base in self.bases)
            ])
            for after in ((AFTER, *LONGER) if self.duration is None else (AFTER,))
        ]  # fmt: skip

    def _followed(
        self, library: Any, values: dict[str, Any], motion: IntArray, feet: IntArray, ends: list[FloatArray],
        threads: int,
    ) -> dict[str, np.ndarray]:  # fmt: skip
        """Return results of rows.

        A history that still rocks at its end is computed to the next end, unless this run fails.
        """

        def computed(rows: IntArray, end: FloatArray) -> dict[str, np.ndarray]:
            own = {name: column[rows] for name, column in values.items()} | {"end": end[rows]}
            return run_compiled(library, own, motion[rows], feet[rows], settings=self.settings, threads=threads)

        results = computed(np.arange(motion.size), ends[0])
        rows = np.flatnonzero(~(values["imposed_left"] * values["imposed_right"] >= 1.0))  # NaN means no coefficient
        for end in ends[1:]:
            rows = rows[results["still_rocking"][rows] == 1]
            if not rows.size:
                break
            longer = computed(rows, end)
            good = longer["outcome"] != Outcome.FAILED.code
            rows = rows[good]
            for name, column in longer.items():
                results[name][rows] = column[good]
        return results


_COUNTED = ("impacts", "still_rocking", "impacts_replaced", "shocks")
_MEASURED = ("peak_rotation", "sliding_distance", "residual_displacement", "friction_usage")
COLUMNS = ("outcome", "status", "side", "overturned", "overturning_time", *_MEASURED, *_COUNTED)


def _columns(results: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    outcome = results["outcome"]
    return {
        **{name: results[name] for name in ("outcome", "status", "side")},
        "overturned": overturned(outcome),
        "overturning_time": results["overturning_time"],
        **{name: results[name] for name in _MEASURED},
        **{name: of_results(outcome, results[name]) for name in _COUNTED},
    }


def _row_of(response: ContactResponse) -> dict[str, float]:
    """Return the results of one history; NaN if there is no result."""
    good = response.outcome is not Outcome.FAILED
    rotation = response.rotation
    side = np.sign(rotation[np.argmax(np.abs(rotation))]) if rotation.size else 0.0
    measured = {
        "peak_rotation": side * response.peak_rotation,
        "sliding_distance": response.sliding_distance,
        "residual_displacement": response.trajectory.last_x,
        "friction_usage": response.friction_usage,
        "impacts": len(response.impacts),
        "still_rocking": float(response.still_rocking),
        "impacts_replaced": response.trajectory.replaced,
        "shocks": response.trajectory.shocks,
    }
    return {
        "outcome": response.outcome.code,
        "status": response.status.code,
        "side": int(side) if response.outcome is Outcome.OVERTURNED else 0,
        "overturned": float(overturned(np.array(response.outcome.code))),
        "overturning_time": response.overturning_time,
        **{name: float(value) if good else np.nan for name, value in measured.items()},
    }
