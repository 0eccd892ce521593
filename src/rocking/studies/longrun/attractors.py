"""Attractors of long histories over a parameter."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.longrun.system import DEFAULTS, NONE, OVERTURNED, HarmonicRocking, Numerics, Periods, over_periods

LONGEST = 64  # periods of a periodic attractor that are recognised
CLOSURE = 1e-6  # of rotation / alpha and velocity / (alpha p)
REST, STICKING, PERIODIC, IRREGULAR, LOST, FAILURE = range(6)
KINDS = ("rest", "sticking", "periodic", "irregular", "overturned", "failed")
"""Kinds of long histories: at rest throughout, with rests in between, periodic, none of these, overturned, failed."""


def start_states(system: HarmonicRocking, states: Any) -> FloatArray:
    """Return time, rotation and velocity of phases [rad] and speeds / (alpha p) after an impact; at rest where NaN."""
    states = np.atleast_2d(states)
    times = (states[:, 0] - system.excitation.phase) / system.excitation.frequency
    starts = np.column_stack([times, np.zeros(len(states)), states[:, 1] * system.alpha * system.p])
    return np.where(np.isnan(starts), 0.0, starts)


def _classified(result: Periods, states: FloatArray) -> tuple[Any, Any]:
    """Return kind (index in `KINDS`) and period of histories from their scaled states."""
    kept = states.shape[1]
    kind = np.full(len(states), IRREGULAR)
    period = np.zeros(len(states), dtype=np.int64)
    for number in range(min(LONGEST, kept // 2), 0, -1):
        repeats = np.nanmax(np.abs(states[:, number:] - states[:, :-number]), axis=(1, 2), initial=0.0) < CLOSURE
        kind[repeats], period[repeats] = PERIODIC, number
    kind[(result.rests > 0) & (result.ending == NONE)] = STICKING
    kind[(result.impacts == 0) & (result.peak == 0.0)] = REST
    kind[result.ending == OVERTURNED] = LOST
    kind[(result.ending != NONE) & (result.ending != OVERTURNED)] = FAILURE
    period[(kind != PERIODIC) & (kind != STICKING)] = 0
    return kind, period


def diagram(
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
    return Periods(*(getattr(result, entry.name)[rows] for entry in fields(Periods)))


def _columns(system: HarmonicRocking, result: Periods, exponents: bool) -> dict[str, Any]:
    states = result.states / np.array([system.alpha, system.alpha * system.p])
    kind, period = _classified(result, states)
    columns = {
        "attractor": kind, "periods": period, "is_symmetric": _symmetric(system, result, period),
        "rotation_ratio": states[..., 0], "velocity_ratio": states[..., 1], "peak_ratio": result.peak,
        "impacts_per_period": result.impacts / states.shape[1],
    }  # fmt: skip
    if exponents:
        growth = result.growth[:, 0] / (states.shape[1] * system.excitation.period)
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
    counted = (period > 0) & (count > 0) & (count < time.shape[1])
    return (counted & (np.max(moments, axis=0) < CLOSURE * count)).astype(int)
