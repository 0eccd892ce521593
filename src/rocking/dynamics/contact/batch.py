"""Rows of studies with friction: what they tell of a body is all that its sliding, hopping and flying takes."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.contact.fast_engine import NUMBERS, library_of, run_compiled
from rocking.dynamics.parameters import UNIMPOSED
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

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
