"""Sections of long histories, the attractors on them, and bifurcation diagrams."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.studies.longrun.system import (
    DEFAULTS,
    NONE,
    OVERTURNED,
    HarmonicRocking,
    Numerics,
    Parameter,
    Periods,
    over_periods,
)

if TYPE_CHECKING:
    import xarray as xr

LONGEST = 64  # periods of a periodic attractor that are recognised
CLOSURE = 1e-6  # of rotation over alpha and velocity over alpha p
REST, STICKING, PERIODIC, IRREGULAR, LOST, FAILURE = range(6)
KINDS = ("rest", "sticking", "periodic", "irregular", "overturned", "failed")
"""Kinds of long histories: at rest throughout, with rests in between, periodic, none of these, overturned, failed."""


def start_states(system: HarmonicRocking, phases: Any, speeds: Any) -> FloatArray:
    """Return time, rotation and velocity of all combinations of phase and speed over alpha p after an impact."""
    phase, speed = (grid.ravel() for grid in np.meshgrid(phases, speeds, indexing="ij"))
    times = (phase - system.excitation.phase) / system.excitation.frequency
    return np.column_stack([times, np.zeros(len(phase)), speed * system.alpha * system.p])


@dataclass(frozen=True, eq=False)
class PoincareSection:
    """States of long histories at a phase of the ground motion, or right after impacts.

    Parameters
    ----------
    at : {"period", "impact"}
        Where the states are taken.
    first, second : ndarray
        Rotation over alpha and velocity over alpha p at the ends of periods, shape (histories, states); NaN after the
        end of a history. After impacts: phase [rad], and velocity over alpha p, positive over the right foot.
    ending : ndarray of int
        Event that ended each history, 0 for none, shape (histories,).
    """

    at: str
    first: FloatArray
    second: FloatArray
    ending: Any


def poincare(
    system: HarmonicRocking,
    starts: FloatArray,
    *,
    cycles: int = 500,
    settled: int = 100,
    at: Literal["period", "impact"] = "period",
    numerics: Numerics = DEFAULTS,
) -> PoincareSection:
    """Return the section of long histories from times, rotations and velocities, shape (histories, 3)."""
    checks.one_of("at", at, ("period", "impact"))
    cycles, settled = checks.whole("cycles", cycles, 1), checks.whole("settled", settled, 0)
    most = 8 * cycles if at == "impact" else 0
    result = over_periods(system, starts, settled=settled, kept=cycles, most_impacts=most, numerics=numerics)
    rate = system.alpha * system.p
    if at == "period":
        return PoincareSection(at, result.states[..., 0] / system.alpha, result.states[..., 1] / rate, result.ending)
    phase = (result.hits[..., 0] * system.excitation.frequency + system.excitation.phase) % (2.0 * np.pi)
    return PoincareSection(at, phase, result.hits[..., 1] / rate, result.ending)


def classified(result: Periods, alpha: float, p: float, longest: int = LONGEST) -> tuple[Any, Any, Any]:
    """Return kind (index in `KINDS`), period and impacts per period of histories, with 2 * longest periods."""
    states = result.states / np.array([alpha, alpha * p])
    kept = states.shape[1]
    kind = np.full(len(states), IRREGULAR)
    period = np.zeros(len(states), dtype=np.int64)
    for number in range(min(longest, kept // 2), 0, -1):
        repeats = np.nanmax(np.abs(states[:, number:] - states[:, :-number]), axis=(1, 2), initial=0.0) < CLOSURE
        kind[repeats], period[repeats] = PERIODIC, number
    kind[(result.rests > 0) & (result.ending == NONE)] = STICKING
    kind[(result.impacts == 0) & (result.peak == 0.0)] = REST
    kind[result.ending == OVERTURNED] = LOST
    kind[(result.ending != NONE) & (result.ending != OVERTURNED)] = FAILURE
    period[(kind != PERIODIC) & (kind != STICKING)] = 0
    return kind, period, result.impacts / kept


def bifurcation(
    systems: HarmonicRocking | dict[str, HarmonicRocking],
    values: Sequence[float] | FloatArray,
    *,
    parameter: Parameter = "amplitude",
    starts: FloatArray | None = None,
    memory: Literal["none", "up", "down"] = "none",
    cycles: tuple[int, int] = (300, 200),
    exponents: bool = False,
    numerics: Numerics = DEFAULTS,
) -> "xr.Dataset":
    """Return the attractors of systems by name over the values of one parameter, as a dataset.

    The starts are times, rotations and velocities, shape (starts, 3), at rest by default.
    """
    import xarray as xr

    named = systems if isinstance(systems, dict) else {"": systems}
    values = checks.finite("values", values, "-", minimum=1)
    checks.increasing("values", values)
    checks.one_of("memory", memory, ("none", "up", "down"))
    settled, kept = checks.whole("cycles[0]", cycles[0], 0), checks.whole("cycles[1]", cycles[1], 1)
    starts = np.zeros((1, 3)) if starts is None else np.atleast_2d(checks.real_array("starts", starts))
    options: Any = {"memory": memory, "cycles": (settled, kept), "exponents": exponents, "numerics": numerics}
    states = np.broadcast_to(starts, (len(values), *starts.shape))
    tables = [arrays([system.changed(parameter, v) for v in values.tolist()], states, **options)
              for system in named.values()]  # fmt: skip
    data = {}
    for name in tables[0]:
        column = np.array([table[name] for table in tables])
        data[name] = (("system", parameter, "start", "cycle")[: column.ndim], column, _ATTRIBUTES[name])
    coordinates = {"system": list(named), parameter: values, "cycle": np.arange(settled, settled + kept)}
    return xr.Dataset(data, coordinates, {"kinds": list(KINDS), "memory": memory, "settled": settled})


def arrays(
    systems: Sequence[HarmonicRocking], starts: FloatArray, *, memory: str = "none", cycles: tuple[int, int],
    exponents: bool = False, numerics: Numerics = DEFAULTS,
) -> dict[str, Any]:  # fmt: skip
    """Return the attractors of systems from their starts, arrays of shape (systems, starts[, cycles])."""
    options = {
        "settled": cycles[0], "kept": cycles[1], "vectors": int(exponents), "most_impacts": 4 * LONGEST,
        "numerics": numerics,
    }  # fmt: skip
    results = _swept(list(systems), starts, memory, options)
    columns = [_columns(system, result, exponents) for system, result in zip(systems, results, strict=True)]
    return {name: np.array([column[name] for column in columns]) for name in columns[0]}


_ATTRIBUTES = {
    "rotation": {"units": "-", "long_name": "rotation / slenderness angle"},
    "velocity": {"units": "-", "long_name": "angular velocity / (slenderness angle x p)"},
    "kind": {"long_name": "kind of history"},
    "period": {"units": "-", "long_name": "periods of the ground motion"},
    "symmetric": {"long_name": "1 if a periodic history is symmetric"},
    "impacts": {"units": "-", "long_name": "impacts per period"},
    "peak": {"units": "-", "long_name": "largest rotation / slenderness angle"},
    "exponent": {"units": "1/s", "long_name": "largest Lyapunov exponent"},
}


def _swept(systems: list[HarmonicRocking], starts: FloatArray, memory: str, options: dict[str, Any]) -> list[Periods]:
    number = starts.shape[1]
    if memory == "none":
        every = [row for row in systems for _ in range(number)]
        everything = over_periods(every, starts.reshape(-1, starts.shape[-1]), **options)
        return [_cut(everything, slice(k * number, (k + 1) * number)) for k in range(len(systems))]
    results: list[Periods] = []
    states = np.full((number, 2), np.nan)
    order = 1 if memory == "up" else -1
    for system, first in zip(systems[::order], starts[::order], strict=True):
        again = np.isnan(states[:, :1])  # a body that has overturned starts again
        begin = np.column_stack([first[:, 0], np.where(again, first[:, 1:], states)])
        results.append(over_periods(system, begin, **options))
        states = np.where((results[-1].ending == NONE)[:, None], results[-1].states[:, -1], np.nan)
    return results if memory == "up" else results[::-1]


def _cut(result: Periods, rows: slice) -> Periods:
    return Periods(*(getattr(result, name)[rows] for name in Periods.__dataclass_fields__))


def _columns(system: HarmonicRocking, result: Periods, exponents: bool) -> dict[str, Any]:
    kind, period, impacts = classified(result, system.alpha, system.p)
    columns = {
        "rotation": result.states[..., 0] / system.alpha, "velocity": result.states[..., 1] / (system.alpha * system.p),
        "kind": kind, "period": period, "symmetric": _symmetric(system, result, period), "impacts": impacts,
        "peak": result.peak,
    }  # fmt: skip
    if exponents:
        growth = result.growth[:, 0] / (result.states.shape[1] * system.excitation.period)
        columns["exponent"] = np.where(kind <= STICKING, -np.inf, np.where(kind == LOST, np.nan, growth))
    return columns


def _symmetric(system: HarmonicRocking, result: Periods, period: Any) -> Any:
    """Return 1 for periodic histories whose impacts repeat on the other foot half a period later, else 0."""
    time, after = result.hits[..., 0], result.hits[..., 1]
    first = np.nanmin(time, axis=1, initial=np.inf, keepdims=True)
    inside = time < first + (period[:, None] - 1e-6) * system.excitation.period
    point = np.where(inside, after * np.exp(1j * system.excitation.frequency * time), 0.0) / (system.alpha * system.p)
    moments = [np.abs((np.sign(after) * point**n).sum(axis=1, where=inside)) for n in (1, 2)]
    count = inside.sum(axis=1)
    return ((period > 0) & (count > 0) & (count < time.shape[1]) & (np.max(moments, axis=0) < CLOSURE * count)).astype(
        int
    )
