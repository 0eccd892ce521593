"""Engines of rows with friction: what rows tell of a body is all that its sliding, hopping and flying takes."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.parameters import UNIMPOSED
from rocking.dynamics.settings import BOUNCE_LAWS, CompiledEngine, Settings
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

NUMBERS = (
    "inertia", "height", "left", "right", "friction", "bounce", "imposed_left", "imposed_right", "scale", "end",
    "x", "rise", "rotation", "u", "w", "spin",
)  # fmt: skip
"""What makes a history, beside its motion, its law and the feet that touch: as `PlaneBase`, `GroundContact`,
`ContactState` name it; imposed coefficients are NaN where there are none, `end` is how long to follow it [s]."""

FAST = "fast: Taylor series with events and complementarity, compiled"
REFERENCE = "reference: Taylor series with events and complementarity"

_COMPILED = CompiledEngine(
    "rocking.dynamics._contact",
    "the fast engine with friction was not built: it takes a C++17 compiler when rocking is installed (in a checkout, "
    "`make engine`)",
    "the reference engine runs instead, one history at a time",
    ("peak_rotation", "peak_time", "peak_velocity", "overturning_time", "first_uplift", "sliding_distance",
     "residual_displacement", "friction_usage", "end_time"),
    ("outcome", "status", "side", "impacts", "uplifts", "still_rocking", "impacts_replaced", "shocks", "steps"),
)  # fmt: skip
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen


def library_of(motions: Sequence[Segments]) -> Any:
    """Return motions as the compiled engine keeps them."""
    data, places, used = [], [], 0
    for motion in motions:
        parts = [motion.horizontal] if motion.vertical is None else [motion.horizontal, motion.vertical]
        places.append((used, motion.count, motion.degree + 1, len(parts) - 1))
        data += [part.ravel() for part in parts]
        used += sum(part.size for part in parts)
    steps = np.array([motion.step for motion in motions])
    return module().Library(np.concatenate(data, dtype=np.float64), np.array(places, np.int64), steps)


def run_compiled(
    library: Any,
    values: dict[str, Any],
    motion: Any,
    bounce_law: str,
    touching: Any,
    *,
    settings: Settings,
    threads: int,
) -> dict[str, np.ndarray]:
    """Return results by name of histories of `NUMBERS`; motion: their numbers."""
    # touching: 1 for the left foot plus 2 for the right
    columns = np.broadcast_arrays(*(values[name] for name in NUMBERS), motion, BOUNCE_LAWS.index(bounce_law), touching)
    numbers: FloatArray = np.column_stack([np.ravel(each) for each in columns[:-3]]).astype(np.float64)
    choices = np.column_stack([np.ravel(each) for each in columns[-3:]]).astype(np.int64)
    results, counts = _COMPILED.room(len(numbers))
    library.run(
        numbers, choices, results, counts, settings.gravity, settings.rest_speed, settings.tolerance,
        settings.most_events, threads,
    )  # fmt: skip
    return _COMPILED.named(results, counts)


FINE, AFTER = 0.1, 15.0
"""sqrt(g / R) times the step between samples of a pulse's response, and times what is followed after the motion."""


class RowsWithContact:
    """Motions as the compiled engine with friction keeps them, and histories under them as rows of a study."""

    def __init__(self, motions: Sequence[Segments], settings: Settings, engine: str) -> None:
        if engine == "reference":
            raise InvalidValueError(
                'studies with friction run on the compiled engine; engine="reference" is for simulate and simulate_many'
            )
        self.motions, self.settings = motions, settings

    @cached_property
    def library(self) -> Any:
        """Motions as the compiled engine keeps them."""
        return library_of(self.motions)

    def run(self, values: dict[str, FloatArray], motion: np.ndarray, threads: int) -> dict[str, np.ndarray]:
        """Return the results of some rows by the names that studies know; NaN for what this mechanics has not."""
        # values: the keys of `ROWS`; a coefficient r that is `UNIMPOSED` is not imposed, a friction that is NaN is that
        # of the settings; rows of another r below zero, or not finite, are refused by themselves
        right, left = _side(values, "right", self.settings), _side(values, "left", self.settings)
        same = np.isclose(right["height"], left["height"], rtol=1e-6) & np.isclose(
            right["inertia"], left["inertia"], rtol=1e-6
        )
        coefficients = np.array([values[f"r_{foot}"] for foot in FEET])
        known = np.all(((coefficients >= 0.0) & (coefficients <= 100.0)) | (coefficients == UNIMPOSED), axis=0)
        size = np.maximum(right["size"], left["size"])
        usual = np.nan if self.settings.friction is None else self.settings.friction
        friction = np.where(np.isnan(values["friction"]), usual, values["friction"])
        table: dict[str, Any] = {
            "inertia": np.where(same & known, right["inertia"], np.nan), "height": right["height"],
            "left": left["half_width"], "right": right["half_width"],
            "friction": friction, "bounce": self.settings.bounce,
            "imposed_left": _imposed(values["r_left"]), "imposed_right": _imposed(values["r_right"]),
            "scale": values["scale"], "end": self._ends(motion, size),
        } | dict.fromkeys(NUMBERS[10:], 0.0)  # fmt: skip
        touching = np.full(motion.size, 3)
        if values["rotation"].any() or values["velocity"].any():
            touching = _start(table, values["rotation"], values["velocity"])
        found = run_compiled(
            self.library, table, motion, self.settings.bounce_law, touching, settings=self.settings, threads=threads
        )
        return found | {
            "friction_demand": found["friction_usage"] * friction,
            "truncation": np.full(motion.size, np.nan), "least_force": np.full(motion.size, np.nan),
        }  # fmt: skip

    def _ends(self, motion: np.ndarray, size: FloatArray) -> FloatArray:
        """When the histories end [s]."""
        number = np.clip(motion, 0, len(self.motions) - 1)
        duration, step, pulse = (
            np.array(each)[number]
            for each in zip(*((m.duration, m.step, m.degree > 1) for m in self.motions), strict=True)
        )
        slow = np.sqrt(size / self.settings.gravity)
        return ends_of(duration + AFTER * slow, step, pulse, slow)


def ends_of(length: Any, step: Any, pulse: Any, slow: Any) -> FloatArray:
    """Return when histories end: on a sample of what the reference engine follows, which cuts pulses finer [s]."""
    # slow: sqrt(R / g) [s]
    with np.errstate(invalid="ignore"):
        step = np.where(pulse, step / np.maximum(1.0, np.ceil(step / (FINE * slow))), step)
        return np.asarray(np.maximum(1.0, np.ceil(length / step - 1e-9)) * step)


def _side(values: dict[str, FloatArray], foot: str, settings: Settings) -> dict[str, FloatArray]:
    """Return what alpha, p and q say of a side: R, h, b [m], and I_C / m [m2]."""
    alpha, p, q = (values[f"{name}_{foot}"] for name in ("alpha", "p", "q"))
    with np.errstate(all="ignore"):  # a row that is no body is refused by itself
        size = settings.gravity * q / p**2  # Eq. 26
        inertia = size**2 * (1.0 / q - 1.0)  # Eq. 27
        return {"size": size, "height": size * np.cos(alpha), "half_width": size * np.sin(alpha), "inertia": inertia}


def _imposed(coefficient: FloatArray) -> FloatArray:
    """Return coefficients as the compiled engine takes them, NaN where none is imposed."""
    return np.where(coefficient == UNIMPOSED, np.nan, coefficient)


def _start(table: dict[str, Any], rotation: FloatArray, velocity: FloatArray) -> np.ndarray:
    """Put bodies on the foot that they lean on, which does not slide; returns which feet touch, as bits."""
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
