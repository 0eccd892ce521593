"""Programs of a user: solve_ivp of SciPy with events, and a loop of Runge-Kutta steps in numba."""

import math
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.engine_batch import STEP, Histories
from rocking.conventions import g

Verdicts = Callable[[], np.ndarray]
HALF_PI = 0.5 * math.pi


def falls(side: float, rotation: float, velocity: float, alpha: float, p: float) -> bool:
    """Return True if the body passes over its foot after the end of the ground motion."""
    outward = side * velocity
    passes = 0.5 * (velocity / p) ** 2 + math.cos(alpha - side * rotation) > 1.0
    beyond = side * rotation > alpha
    return not (outward < 0.0 and passes) if beyond else outward > 0.0 and passes


def scipy_events(batch: Histories, method: str = "DOP853", tolerance: float = 1e-8) -> Verdicts:
    """solve_ivp between events, restarted at uplifts and impacts."""
    return lambda: np.array([_scipy_one(batch, k, method, tolerance) for k in range(len(batch))])


def _scipy_one(batch: Histories, k: int, method: str, tolerance: float) -> bool:
    solve_ivp: Any = import_module("scipy.integrate").solve_ivp
    alpha, p, r = batch.alpha[k], batch.p[k], batch.r[k]
    record = batch.records[k] * (batch.scale[k] / g)
    times, end, limit = STEP * np.arange(record.size), STEP * (record.size - 1), math.tan(alpha)
    side, p2 = 1.0, p * p

    def rates(t: float, y: Any) -> tuple[float, float]:
        gap = alpha * side - y[0]
        at = t / STEP
        i = min(int(at), record.size - 2)
        push = record[i] + (at - i) * (record[i + 1] - record[i])
        return float(y[1]), float(-p2 * (math.sin(gap) + push * math.cos(gap)))

    def contact(_: float, y: Any) -> float:
        return float(side * y[0])

    def lies(_: float, y: Any) -> float:
        return HALF_PI - abs(float(y[0]))

    for event in (contact, lies):
        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]

    t, y, resting = 0.0, np.zeros(2), True
    while t < end:
        if resting:
            t, push = _next_uplift(times, record, t, limit)
            if t >= end:
                return False
            side, y, resting = -math.copysign(1.0, push), np.zeros(2), False
        solution = solve_ivp(
            rates, (t, end), y, method=method, rtol=tolerance, atol=tolerance * alpha, events=(contact, lies)
        )
        # an uplift that rounding takes back at once would go on for ever at the same instant
        t, y = max(float(solution.t[-1]), t + 1e-9), solution.y[:, -1]
        if solution.t_events[1].size:
            return True
        if solution.t_events[0].size:
            side, y = -side, np.array([0.0, r * y[1]])
            # slow, and held down: at rest
            resting = abs(y[1]) < 1e-3 * p * alpha and side * rates(t, (0.0, 0.0))[1] < 0.0
    return not resting and falls(side, y[0], y[1], alpha, p)


def _next_uplift(times: np.ndarray, record: np.ndarray, t: float, limit: float) -> tuple[float, float]:
    """Time and push of the next uplift of a body at rest."""
    first = int(t / STEP)
    now = float(np.interp(t, times, record))
    if abs(now) > limit:
        return t, now
    lifted = np.flatnonzero(np.abs(record[first + 1 :]) > limit)
    if not lifted.size:
        return float(times[-1]), 0.0
    k = first + 1 + int(lifted[0])
    a, b = record[k - 1], record[k]
    return float(times[k - 1] + STEP * (math.copysign(limit, b) - a) / (b - a)), float(b)


def numba_rk4(batch: Histories, substeps: int = 2) -> Verdicts:
    """Classical Runge-Kutta steps in compiled loops, one history after another; compiled before the clock starts."""
    numba = import_module("numba")
    flat = np.concatenate(batch.records)
    first = np.concatenate([[0], np.cumsum([record.size for record in batch.records])])
    compiled = {name: numba.njit(fastmath=True, inline="always")(function) for name, function in (("rk4", _rk4),)}
    loop = numba.njit(fastmath=True)(_loop)
    run = numba.njit(fastmath=True)(_all)
    arguments = (flat, first, batch.alpha, batch.p, batch.r, batch.scale / g, substeps, loop, compiled["rk4"])
    run(flat, first[:2], *arguments[2:])
    return lambda: np.asarray(run(*arguments))


def _rk4(th: float, om: float, side: float, p2: float, alpha: float, a: float, b: float, h: float) -> Any:  # noqa: PLR0917
    """One step of length h under a push that goes from a to b."""
    middle, top = 0.5 * (a + b), alpha * side
    gap = top - th
    k1 = -p2 * (math.sin(gap) + a * math.cos(gap))
    gap = top - (th + 0.5 * h * om)
    k2 = -p2 * (math.sin(gap) + middle * math.cos(gap))
    gap = top - (th + 0.5 * h * (om + 0.5 * h * k1))
    k3 = -p2 * (math.sin(gap) + middle * math.cos(gap))
    gap = top - (th + h * (om + 0.5 * h * k2))
    k4 = -p2 * (math.sin(gap) + b * math.cos(gap))
    return th + h * om + h * h / 6.0 * (k1 + k2 + k3), om + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def _loop(record: Any, alpha: float, p: float, r: float, factor: float, substeps: int, rk4: Any) -> bool:  # noqa: PLR0917
    """One history; impacts by linear interpolation, then the rest of the step on the other side."""
    limit, p2, slow = math.tan(alpha), p * p, 1e-3 * p * alpha
    th, om, side, resting = 0.0, 0.0, 1.0, True
    for k in range(record.size - 1):
        a0, rise, at = factor * record[k], factor * (record[k + 1] - record[k]), 0.0
        if resting:
            if abs(a0) <= limit and abs(a0 + rise) <= limit:
                continue
            at = 0.0 if abs(a0) > limit else (math.copysign(limit, a0 + rise) - a0) / rise
            side = -1.0 if a0 + at * rise > 0.0 else 1.0
            th, om, resting = 0.0, 0.0, False
        fraction = (1.0 - at) / substeps
        for _ in range(substeps):
            left = fraction
            for _ in range(8):  # impacts within a substep
                a = a0 + at * rise
                t1, o1 = rk4(th, om, side, p2, alpha, a, a + left * rise, left * STEP)
                if side * t1 >= 0.0:
                    th, om, at = t1, o1, at + left
                    break
                share = min(max(th / (th - t1), 0.0), 1.0)
                th, om, side = 0.0, r * (om + share * (o1 - om)), -side
                at, left = at + share * left, left - share * left
                if abs(om) < slow and abs(a0 + at * rise) < limit:
                    resting = True
                    break
            if resting:
                break
        if abs(th) > 1.57:
            return True
    if resting:
        return False
    outward, size = side * om, side * th
    passes = 0.5 * (om / p) ** 2 + math.cos(alpha - size) > 1.0
    return not (outward < 0.0 and passes) if size > alpha else outward > 0.0 and passes


def _all(  # noqa: PLR0913, PLR0917
    flat: Any, first: Any, alpha: Any, p: Any, r: Any, factor: Any, substeps: int, loop: Any, rk4: Any
) -> Any:
    out = np.zeros(first.size - 1, np.bool_)
    for k in range(first.size - 1):
        out[k] = loop(flat[first[k] : first[k + 1]], alpha[k], p[k], r[k], factor[k], substeps, rk4)
    return out
