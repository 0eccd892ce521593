"""Long-run dynamics of one body with several restitution models as histories of a study."""

import json
import math
import os
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.dynamics.content import fields_of, hash_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.rows import Rows
from rocking.outcome import UNCOUNTED
from rocking.studies.histories import Histories, checked_range
from rocking.studies.longrun import attractors, basins
from rocking.studies.longrun import system as engine
from rocking.studies.longrun.attractors import start_states
from rocking.studies.longrun.continuation import Branch, branch_off, continue_orbit
from rocking.studies.longrun.exponents import LyapunovExponents, lyapunov_exponents
from rocking.studies.longrun.orbits import OrbitNotFoundError, PeriodicOrbit, symmetric_orbit
from rocking.studies.longrun.system import NONE, OVERTURNED, Harmonic, HarmonicRocking, Numerics, Parameter
from rocking.studies.longrun.thresholds import thresholds_of
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import changed_body
from rocking.studies.sensitivity.restitutions import label_of, named_restitutions
from rocking.studies.study_plan import Study, along, labels_along
from rocking.tables import Column

if TYPE_CHECKING:
    import xarray as xr

AXES = {
    "amplitude": "amplitude_ratio", "frequency": "frequency_ratio", "slenderness": "slenderness_ratio",
    "size": "semi_diagonal", "restitution": "coefficient",
}  # fmt: skip
"""Quantities of the axes of diagrams and branches."""
_OF_ORBITS = ("ground_phase", "speed_ratio", "multiplier", "peak_ratio")
BRANCH_POINTS = ("none", "fold", "pitchfork", "period doubling", "grazing")
_OUTCOMES = {"outcome": np.int8, "mode": np.int64}
_ENDED = {-3: 3, -2: 0, -1: 1, UNCOUNTED: 2}  # outcome by mode


@dataclass(frozen=True, eq=False)
class Task(ABC):
    """A computation for each system; its fields are plain values and arrays."""

    is_cut: ClassVar[bool] = False  # True if any of its rows can be computed alone

    @property
    @abstractmethod
    def columns(self) -> dict[str, Any]:
        """Types of the results, by their names."""

    @property
    @abstractmethod
    def coordinates(self) -> dict[str, Column]:
        """Columns along the dimensions, in order."""

    @abstractmethod
    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        """Return the results of rows of one system; all rows if it is not cut."""

    def findings(self, system: HarmonicRocking, results: "xr.Dataset") -> list[dict[str, Any]]:
        """Return the summary of the results of one system, as values by the names of quantities."""
        return []

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each dimension."""
        return tuple(len(column.values) for column in self.coordinates.values())

    @property
    def size(self) -> int:
        """Number of rows of each system."""
        return int(np.prod(self.shape))


def _of_modes(modes: Any) -> Arrays:
    """Return outcome and mode of histories."""
    outcome = np.select([modes == mode for mode in _ENDED], list(_ENDED.values()))
    return {"outcome": outcome.astype(np.int8), "mode": modes.astype(np.int64)}


@dataclass(frozen=True, eq=False)
class Diagram(Task):
    """A bifurcation diagram; rows are sections at the ends of periods."""

    axis: str
    values: FloatArray
    starts: FloatArray  # phase [rad] and speed after an impact / (alpha p) of the initial states; NaN at rest
    sweeps: tuple[str, ...] = ("none",)
    cycles: tuple[int, int] = (300, 200)
    exponents: bool = True

    @property
    def columns(self) -> dict[str, Any]:
        whole = dict.fromkeys(("attractor", "periods", "is_symmetric"), np.int8)
        parts = ("rotation_ratio", "velocity_ratio", "impacts_per_period", "peak_ratio")
        exponent = ("exponent",) if self.exponents else ()
        return {**_OUTCOMES, **whole, **dict.fromkeys((*parts, *exponent), np.float64)}

    @property
    def coordinates(self) -> dict[str, Column]:
        return {
            "sweep": labels_along("sweep", self.sweeps, "direction of the sweep; none without memory"),
            AXES[self.axis]: Column.of(AXES[self.axis], self.values),
            "initial_state": along("initial_state", np.arange(len(self.starts)), "1", "index of the initial state"),
            "period_number": along("period_number", np.arange(sum(self.cycles))[self.cycles[0] :], "1", "period"),
        }

    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        systems = [_at(system, self.axis, value) for value in self.values.tolist()]
        options: Any = {"cycles": self.cycles, "exponents": self.exponents, "numerics": numerics}
        starts = np.array([start_states(system, self.starts) for system in systems])
        sweeps = [attractors.diagram(systems, starts, memory=memory, **options) for memory in self.sweeps]
        whole = {name: np.stack([sweep[name] for sweep in sweeps]) for name in sweeps[0]}
        modes = np.array([-2, -1, -1, -1, UNCOUNTED, -3])[whole["attractor"]]
        return {
            name: np.broadcast_to(values if values.ndim == 4 else values[..., None], self.shape).reshape(-1)
            for name, values in {**_of_modes(modes), **whole}.items()
        }

    def findings(self, system: HarmonicRocking, results: "xr.Dataset") -> list[dict[str, Any]]:
        first = results.isel(period_number=0)
        attractor = first["attractor"].values
        fractions = {f"fraction_{name}": float((attractor == k).mean()) for k, name in enumerate(attractors.KINDS[:5])}
        axis = AXES[self.axis]
        values = np.broadcast_to(first[axis].values[:, None], attractor.shape)
        lowest = {}
        for name, flags in (("multiperiod", first["periods"].values > 1), ("irregular", attractor == 3),
                            ("overturned", attractor == 4)):  # fmt: skip
            lowest[f"lowest_{name}"] = float(values[flags].min()) if flags.any() else None
        largest = {"exponent": float(first["exponent"].max())} if self.exponents else {}
        return [{**fractions, **lowest, **largest}]


def _at(system: HarmonicRocking, axis: str, value: float) -> HarmonicRocking:
    """Return a system with another value of an axis; slenderness keeps the ratios, size keeps the ground motion."""
    if axis == "size":
        return replace(system, body=changed_body(system.body, {"semi_diagonal": value}))
    if axis != "slenderness":
        return system.changed(axis, value)  # type: ignore[arg-type]
    body = changed_body(system.body, {"slenderness_angle": math.atan(1.0 / checks.positive("slenderness", value))})
    ratios = (system.amplitude_ratio, system.frequency_ratio)
    options = {"restitution": system.restitution, "linear": system.linear, "gravity": system.gravity}
    return HarmonicRocking.of_ratios(body, *ratios, **options)


def random_states(number: int, seed: int) -> FloatArray:
    """Return a start at rest, NaN, and random phases [rad] and speeds / (alpha p), below 1, after an impact."""
    draws = np.random.default_rng(seed).random((number, 2)) * [2.0 * math.pi, 1.0]
    draws[0] = np.nan
    return draws


@dataclass(frozen=True, eq=False)
class SectionTask(Task):
    """Poincare sections; rows are states at the ends of periods, or after impacts."""

    starts: FloatArray
    cycles: tuple[int, int] = (100, 500)
    at: str = "period"

    @property
    def columns(self) -> dict[str, Any]:
        first = "rotation_ratio" if self.at == "period" else "ground_phase"
        return {first: np.float64, "velocity_ratio": np.float64, **_OUTCOMES}

    @property
    def coordinates(self) -> dict[str, Column]:
        number = self.cycles[1] * (1 if self.at == "period" else 8)
        return {
            "initial_state": along("initial_state", np.arange(len(self.starts)), "1", "index of the initial state"),
            "period_number": along("period_number", np.arange(number), "1", f"number of the {self.at}"),
        }

    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        settled, kept = self.cycles
        most = self.shape[1] if self.at == "impact" else 0
        starts = start_states(system, self.starts)
        options: Any = {"settled": settled, "kept": kept, "most_impacts": most, "numerics": numerics}
        result = engine.over_periods(system, starts, **options)
        section = result.states / system.alpha
        if most:
            phase = (result.hits[..., 0] * system.excitation.frequency + system.excitation.phase) % (2.0 * np.pi)
            section = np.stack([phase, result.hits[..., 1] / system.alpha], axis=2)
        modes = np.where(result.ending == OVERTURNED, UNCOUNTED, np.where(result.ending == NONE, -1, -3))
        names = list(self.columns)
        values = {names[0]: section[..., 0].reshape(-1), names[1]: section[..., 1].reshape(-1) / system.p}
        return {**values, **_of_modes(np.repeat(modes, self.shape[1]))}


@dataclass(frozen=True, eq=False)
class Exponents(Task):
    """Lyapunov exponents; rows are orbits."""

    orbits: int = 64
    settled: int = 1500
    kept: int = 1500
    seed: int = 0

    @property
    def columns(self) -> dict[str, Any]:
        return {**_OUTCOMES, **dict.fromkeys(("exponent", "second_exponent", "impact_rate"), np.float64)}

    @property
    def coordinates(self) -> dict[str, Column]:
        return {"orbit": along("orbit", np.arange(self.orbits), "1", "index of the orbit")}

    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        options: Any = {name: getattr(self, name) for name in ("orbits", "settled", "kept", "seed")}
        result = lyapunov_exponents(system, **options, numerics=numerics)
        exponents = result.by_orbit.T
        modes = np.where(np.isnan(exponents[0]), UNCOUNTED, -1)
        values = {"exponent": exponents[0], "second_exponent": exponents[1], "impact_rate": result.impact_rate}
        return {**_of_modes(modes), **values}

    def findings(self, system: HarmonicRocking, results: "xr.Dataset") -> list[dict[str, Any]]:
        by_orbit = np.column_stack([results[name].values for name in ("exponent", "second_exponent")])
        exponents = LyapunovExponents(system, by_orbit, results["impact_rate"].values, np.nan)
        (mean, second), error = exponents.values.tolist(), float(exponents.standard_errors[0])
        return [{
            "exponent": mean, "exponent_error": error, "exponent_over_p": mean / system.p, "second_exponent": second,
            "orbits_counted": len(exponents.finite), "orbits_sticking": exponents.sticking,
            "orbits_overturned": exponents.overturned,
        }]  # fmt: skip


@dataclass(frozen=True, eq=False)
class Cells(Task):
    """Basins of overturning at one or several amplitudes; rows are initial states after an impact."""

    amplitudes: FloatArray
    phases: FloatArray
    speeds: FloatArray
    impacts: int = 120
    small: float = 0.02
    check: bool = True

    is_cut: ClassVar[bool] = True

    @property
    def columns(self) -> dict[str, Any]:
        return {**_OUTCOMES, "final_state": np.int8, "is_uncertain": np.int8}

    @property
    def coordinates(self) -> dict[str, Column]:
        return {
            "amplitude_ratio": Column.of("amplitude_ratio", self.amplitudes),
            "ground_phase": Column.of("ground_phase", self.phases),
            "speed_ratio": Column.of("speed_ratio", self.speeds),
        }

    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        places = np.unravel_index(np.arange(first, last), self.shape)
        kinds = np.empty((2, last - first), np.int8)
        for number in np.unique(places[0]):
            rows = places[0] == number
            where = (system.changed("amplitude", float(self.amplitudes[number])), self.phases[places[1][rows]],
                     self.speeds[places[2][rows]])  # fmt: skip
            options: Any = {"impacts": self.impacts, "small": self.small, "numerics": numerics, "check": self.check}
            kinds[:, rows] = basins.checked_ends(*where, **options)
        modes = np.array([UNCOUNTED, -1, -1, -3])[kinds[0]]
        return {**_of_modes(modes), "final_state": kinds[0], "is_uncertain": (kinds[0] != kinds[1]).astype(np.int8)}

    def findings(self, system: HarmonicRocking, results: "xr.Dataset") -> list[dict[str, Any]]:
        rows = []
        for amplitude, kinds, uncertain in zip(
            self.amplitudes, results["final_state"].values, results["is_uncertain"].values, strict=True
        ):
            safe, low, high = basins.basin_stability(kinds)
            rows.append({
                "amplitude_ratio": float(amplitude), "stability": safe, "stability_low": low, "stability_high": high,
                **{f"cells_{name}": int((kinds == k).sum()) for k, name in enumerate(basins.KINDS)},
                "cells_uncertain": int(uncertain.sum()), "box_dimension": basins.box_dimension(kinds),
            })  # fmt: skip
        return rows


@dataclass(frozen=True, eq=False)
class Branches(Task):
    """Branches of periodic orbits: the symmetric one, and those that branch off it in turn; rows are orbits."""

    axis: str
    limits: tuple[float, float]
    doublings: int = 2
    points: int = 400

    def __post_init__(self) -> None:
        checks.increasing("limits", np.array(self.limits))

    @property
    def columns(self) -> dict[str, Any]:
        values = (AXES[self.axis], *_OF_ORBITS)
        codes = ("impacts_of_orbit", "is_stable", "branch_point")
        return {**_OUTCOMES, **dict.fromkeys(values, np.float64), **dict.fromkeys(codes, np.int8)}

    @property
    def coordinates(self) -> dict[str, Column]:
        return {
            "branch": along("branch", np.arange(self.doublings + 1), "1", "branch; 0 is the symmetric one"),
            "orbit_number": along(
                "orbit_number", np.arange(self.points), "1", "orbit along the branch, bifurcations first"
            ),
        }

    def rows(self, system: HarmonicRocking, first: int, last: int, numerics: Numerics) -> Arrays:
        columns = {name: np.zeros(self.shape, kind) for name, kind in self.columns.items()}
        columns["mode"][:], columns["outcome"][:] = -3, 3
        for name in (AXES[self.axis], *_OF_ORBITS):
            columns[name][:] = np.nan
        for number, branch in enumerate(self.branches(system)):
            marked = [(point.orbit, point.kind) for point in branch.bifurcations[: self.points // 2]]
            picked = np.linspace(0, len(branch.orbits) - 1, self.points - len(marked)).round().astype(int)
            for k, (orbit, kind) in enumerate(marked + [(branch.orbits[j], "none") for j in picked]):
                for name, value in _of_orbit(orbit, branch.parameter, kind).items():
                    columns[name][number, k] = value
        return {name: values.reshape(-1) for name, values in columns.items()}

    def branches(self, system: HarmonicRocking) -> list[Branch]:
        """Return the branches that exist."""
        parameter: Any = self.axis
        branch = _both_ways(symmetric_orbit(system), self.limits, parameter)
        branches = [branch]
        for kind in ("pitchfork", *["period doubling"] * (self.doublings - 1))[: self.doublings]:
            try:
                bifurcation = branches[-1].first(kind)
                branches.append(branch_off(bifurcation, self.limits, parameter=parameter, most=500))
            except OrbitNotFoundError:
                break
        return branches

    def findings(self, system: HarmonicRocking, results: "xr.Dataset") -> list[dict[str, Any]]:
        names = ("branch", "branch_point", AXES[self.axis], "ground_phase", "speed_ratio", "impacts_of_orbit")
        return [
            {name: BRANCH_POINTS[int(point[name])] if name == "branch_point" else point[name].item() for name in names}
            for branch in range(self.doublings + 1)
            for point in (results.isel(branch=branch, orbit_number=k) for k in range(self.points // 2))
            if int(point["branch_point"])
        ]


def _both_ways(orbit: PeriodicOrbit, limits: tuple[float, float], parameter: Parameter) -> Branch:
    """Return the branch through an orbit, from its end at lower values, beyond a fold, to that at higher ones."""
    ways = [continue_orbit(orbit, limits, parameter=parameter, increasing=up) for up in (False, True)]
    return Branch(
        parameter, [*ways[0].orbits[:0:-1], *ways[1].orbits], [*ways[0].bifurcations[::-1], *ways[1].bifurcations]
    )


def _of_orbit(orbit: PeriodicOrbit, parameter: Parameter, kind: str) -> dict[str, float]:
    return {
        AXES[parameter]: orbit.system.value(parameter), "ground_phase": orbit.phase, "speed_ratio": orbit.speed,
        "multiplier": float(np.abs(orbit.multipliers).max()), "peak_ratio": orbit.peak,
        "impacts_of_orbit": orbit.impacts, "is_stable": orbit.is_stable, "branch_point": BRANCH_POINTS.index(kind),
        "mode": -1, "outcome": 1,
    }  # fmt: skip


@dataclass(frozen=True, eq=False)
class LongRunHistories(Histories):
    """Rows of a task for several systems, one system after the other."""

    motions: MotionList = field(default_factory=MotionList.empty)
    systems: tuple[HarmonicRocking, ...] = ()
    task: Task = field(kw_only=True)

    @property
    def columns(self) -> dict[str, Any]:
        return self.task.columns

    @property
    def count(self) -> int:
        return len(self.systems) * self.task.size

    def rows(self, first: int, last: int) -> Rows:
        """Return rows without values: the task computes them from their numbers."""
        return Rows.of(last - first, 0, np.arange(first, last), **dict.fromkeys(_SIDES, np.nan))

    def content(self) -> dict[str, Any]:
        """Return systems and task as plain values, and a hash of the last digits of the engine."""
        systems = [
            {"arrays": [hash_of(values) for values in (system.sides, system.sine, system.factors)],
             "linear": system.linear, "body": repr(system.body)} for system in self.systems
        ]  # fmt: skip
        task = {"kind": type(self.task).__name__, **fields_of(self.task)}
        return {"systems": systems, "task": task, "digits": _digits()}

    def run(self, first: int, last: int, *, threads: int | None = None) -> Arrays:
        """Return the results of some rows; those of a task that is not cut are kept for the next call."""
        checked_range(first, last, self.count)
        numerics = Numerics(threads=threads or os.cpu_count() or 1)
        ends = [first, *(n * self.task.size for n in range(len(self.systems) + 1) if first < n * self.task.size < last),
                last]  # fmt: skip
        parts = [self._part(low, high, numerics) for low, high in pairwise(ends)]
        return {
            name: np.concatenate([part[name] for part in parts]).astype(kind) for name, kind in self.columns.items()
        }

    def _part(self, first: int, last: int, numerics: Numerics) -> Arrays:
        number, low = divmod(first, self.task.size)
        high = low + last - first
        system = self.systems[min(number, len(self.systems) - 1)]
        if self.task.is_cut:
            return self.task.rows(system, low, high, numerics)
        kept: dict[int, Any] = self._kept
        if number not in kept:
            kept.clear()
            kept[number] = self.task.rows(system, 0, self.task.size, numerics)
        return {name: values[low:high] for name, values in kept[number].items()}


_SIDES = [f"{name}_{foot}" for name in ("alpha", "p", "r") for foot in ("right", "left")]


@cache
def _digits() -> str:
    """Return a hash of results of this machine: other processors may compute other last digits."""
    from rocking.bodies import Block

    system = HarmonicRocking.of_ratios(Block(width=1.0, height=2.0), 1.5, 2.0, restitution=0.9)
    flights = engine.over_impacts(system, np.linspace(0.1, 6.0, 8), 0.5, 3)
    return hash_of(np.column_stack([flights.speed, flights.jacobian.reshape(-1, 4)]))


def long_run_study(systems: Mapping[str, HarmonicRocking], task: Task) -> Study:
    """Return the study of a task for systems by the label of their restitution."""
    several = len(systems) > 1
    labels = {"restitution": labels_along("restitution", systems, "restitution")} if several else {}
    coordinates = labels | {name: replace(column, dims=(name,)) for name, column in task.coordinates.items()}
    dims = {name: len(column.values) for name, column in coordinates.items()}
    first = next(iter(systems.values()))
    attributes = {
        "body": repr(first.body), "amplitude_ratio": first.amplitude_ratio, "frequency_ratio": first.frequency_ratio,
        "frequency_parameter": first.p, "slenderness_angle": first.alpha, "linear": int(first.linear),
        "gravity": first.gravity, **({} if several else {"restitution": next(iter(systems))}),
    }  # fmt: skip
    if "amplitude_ratio" in {*task.coordinates, *task.columns}:
        attributes["thresholds"] = json.dumps({label: thresholds_of(system) for label, system in systems.items()})
    return Study(LongRunHistories(systems=tuple(systems.values()), task=task), dims, coordinates, attributes)


def systems_of(
    body: Body, excitation: Harmonic, restitution: Any = DEFAULT_RESTITUTION, *, linear: bool = False,
    gravity: float = conventions.g,
) -> dict[str, HarmonicRocking]:  # fmt: skip
    """Return systems by label of the restitution; a list or mapping of restitutions gives several."""
    checks.of_kind("excitation", excitation, Harmonic, "a Harmonic")
    several = isinstance(restitution, list | tuple) or (
        isinstance(restitution, Mapping) and set(restitution) != set(conventions.FEET)
    )
    laws = named_restitutions(restitution) if several and len(restitution) > 1 else None
    if laws is None:
        only = next(iter(restitution)) if several else restitution
        laws = {label_of(only): only}
    return {name: HarmonicRocking(body, excitation, law, linear, gravity) for name, law in laws.items()}
