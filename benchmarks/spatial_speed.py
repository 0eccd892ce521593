"""Histories of 20 s under one record of three components: our engines and MuJoCo, in one run, CPU time."""

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from benchmarks import spatial_mujoco, spatial_studies
from benchmarks.spatial_cases import DENSITY, GRAVITY, Case
from benchmarks.spatial_mujoco import Contact
from benchmarks.spatial_studies import GENERIC
from benchmarks.timing import cpu_seconds
from rocking.conventions import FloatArray
from rocking.dynamics import simulate
from rocking.dynamics.rolling import SpatialBody, SpatialResponse, attitude
from rocking.motions import GroundMotion
from rocking.motions.synthetic import GammaModulation, NonstationaryFilter, nonstationary_motion

SIZE = (0.6, 0.6, 2.4)
DURATION, STEP = 20.0, 0.01
WEAK, STRONG = 3.5, 9.0  # peak of the first component [m/s2]: lifts the box a little, nearly fells it
FEW, MANY, REPEATS = 8, 400, 5
GOAL = 200.0
SENSIBLE = 0.05  # largest error of the peak tilt after the first landing over the free cases [-]
FELL = 1.0  # tilt at the end [rad]


@cache
def record() -> tuple[GroundMotion, GroundMotion, GroundMotion]:
    """Three components of noise whose strength and frequency change; the first has a peak of 1 m/s2."""
    modulation = GammaModulation(a1=0.35, a2=2.6, a3=0.45)
    motions = [nonstationary_motion(modulation, NonstationaryFilter(), seed=k, duration=DURATION) for k in (11, 12, 13)]
    factors = np.array([1.0, 1.0, 0.5]) / np.abs(motions[0].acceleration).max()
    x, y, z = (GroundMotion(f * motion.acceleration, STEP) for f, motion in zip(factors, motions, strict=True))
    return x, y, z


def body() -> SpatialBody:
    """A box of 0.6 by 0.6 by 2.4 m."""
    return SpatialBody.box(*SIZE, density=DENSITY)


def scales(count: int) -> FloatArray:
    """Factors on the record."""
    return np.geomspace(WEAK, STRONG, count)


# ---- ours ------------------------------------------------------------------------------------------------------------


def reference(factors: FloatArray) -> list[SpatialResponse]:
    """Our engine in Python, one history after another."""
    x, y, z = record()
    common = {"gravity": GRAVITY, "duration": DURATION}
    return [simulate(body(), {"x": x, "y": y, "z": z}, "housner", scale=float(factor), **common) for factor in factors]


def batch_engine() -> Callable[..., Any] | None:
    """Our compiled engine, where it was built."""
    try:
        import_module("rocking.dynamics._spatial")
        function: Callable[..., Any] = import_module("rocking.dynamics.rolling.batch").batch_in_space
    except (ImportError, AttributeError):
        return None
    return function


def batched(factors: FloatArray) -> Any:
    """Our compiled engine on one thread."""
    engine = batch_engine()
    assert engine is not None
    return engine([body()], [record()], scales=factors, gravity=GRAVITY, duration=DURATION, threads=1)


# ---- MuJoCo ----------------------------------------------------------------------------------------------------------


class Fleet:
    """Histories in MuJoCo by one call of `rollout`: no Python between time steps, one thread, no pictures."""

    def __init__(self, contact: Contact, factors: FloatArray) -> None:
        self.model = spatial_mujoco.scene(SIZE, contact)
        when = contact.step * (np.arange(round(DURATION / contact.step)) + 0.5)
        shaking = [
            np.interp(when, STEP * np.arange(motion.acceleration.size), motion.acceleration) for motion in record()
        ]
        push = spatial_mujoco.control(spatial_mujoco.pushes(self.model, np.column_stack(shaking)))
        self.controls = factors[:, None, None] * push
        self.starts = np.repeat(spatial_mujoco.start(self.model, Case("at rest", SIZE))[None], factors.size, axis=0)

    def __call__(self) -> FloatArray:
        """States of all histories."""
        return spatial_mujoco.rollout(self.model, self.starts, self.controls)

    def tilts(self) -> FloatArray:
        """Tilts of all histories, shape (histories, steps) [rad]."""
        return np.array([attitude.tilt(states[:, 4:8]) for states in self()])


@dataclass(frozen=True)
class Mode:
    """A way to run MuJoCo: largest and median error of the peak tilt over the free cases, wrong ends of them [-]."""

    words: str
    contact: Contact
    worst: float
    middle: float
    wrong: int

    @property
    def sensible(self) -> bool:
        """Whether a user could believe it."""
        return self.wrong == 0 and self.worst <= SENSIBLE

    @property
    def says(self) -> str:
        """Its error in words."""
        return f"peak tilt of {len(GENERIC)} free cases off by {self.middle:.1%} (median), {self.worst:.1%} (largest)"


def mode(description: str, contact: Contact) -> Mode:
    """Find the error of a way to run MuJoCo."""
    setting = spatial_studies.Setting(
        "MuJoCo", description, contact.step, lambda c: spatial_mujoco.run(c, contact), True
    )
    peaks = [row["peak"] for row in spatial_studies.shown(setting, GENERIC)]
    good = [peak for peak in peaks if math.isfinite(peak)]
    return Mode(description, contact, max(good), statistics.median(good), len(peaks) - len(good))


def quick(step: float) -> Contact:
    """Contacts as stiff as the step allows, and all else as quick as it goes: pyramid of friction, implicitfast."""
    return Contact(step, cone="pyramidal", ratio=1.0, tolerance=1e-8, integrator="implicitfast")


def modes() -> list[Mode]:
    """Defaults, and contacts that are tuned for impacts at falling steps."""
    candidates = [
        mode(f"all defaults, {1e3 * s:g} ms", replace(spatial_studies.defaults(s), integrator="implicitfast"))
        for s in (2e-3, 1e-3)
    ]
    candidates += [mode(f"tuned, quick, {1e3 * s:g} ms", quick(s)) for s in (2e-3, 1e-3, 5e-4, 2.5e-4)]
    return candidates + [mode(f"tuned, {1e3 * s:g} ms", Contact(s)) for s in (2e-3, 1e-3, 5e-4, 2.5e-4)]


def scatter() -> str:
    """Return the scatter of histories due to the time step or the engine, as a sentence: medians over the scales."""
    factors = scales(FEW)
    coarse, fine = (Fleet(Contact(step), factors).tilts().max(axis=1) for step in (5e-4, 2.5e-4))
    mine = np.array([response.peak_tilt for response in reference(factors)])
    words = (
        f"MuJoCo at 0.5 and at 0.25 ms {_apart(coarse, fine):.0%}, MuJoCo at 0.25 ms and ours {_apart(fine, mine):.0%}"
    )
    if batch_engine() is None:
        return words
    both = batched(factors)["peak_tilt"].ravel()
    return f"{words}, our batched and our reference engine {_apart(both, mine):.1e}"


def _apart(left: FloatArray, right: FloatArray) -> float:
    return float(np.median(np.abs(left / right - 1.0)))


# ---- all in turn -----------------------------------------------------------------------------------------------------


def times(chosen: list[Mode], repeats: int = REPEATS) -> dict[str, float]:
    """Median CPU seconds a history, all in turn; "batch" and "reference" are ours."""
    works: dict[str, tuple[Callable[[], object], int]] = {
        selected.words: (Fleet(selected.contact, scales(FEW)), FEW) for selected in chosen
    }
    works["reference"] = (lambda: reference(scales(FEW)[::3]), scales(FEW)[::3].size)
    if batch_engine() is not None:
        works["batch"] = (lambda: batched(scales(MANY)), MANY)
        batched(scales(FEW))
    spent: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(repeats):
        for name, (work, count) in works.items():
            spent[name].append(cpu_seconds(work) / count)
    return {name: statistics.median(values) for name, values in spent.items()}
