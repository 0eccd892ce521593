"""How often intervals of `identify` hold the truth: free rockings made up and heard badly, resumed where it stopped.

Of ten, nine are times of impacts with jitter, bounces, gaps and false ones, one an angular velocity with noise, an
offset and a drift. Sounds, clipped ones too, are tried by tests/verification/test_impact_sounds.py.

`make identification` makes 10,000 of them (half an hour), keeps every one in build/identification.jsonl, and prints the
coverage beside that of a constant coefficient fitted by least squares.
"""

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking as rk
from benchmarks.predictions import resumed
from rocking.identification import ImpactTimes, RotationSeries, identify
from rocking.identification.state_space import duration, rotation, speed

ROOT = Path(__file__).parents[1]
SIZE_ERROR, TILT, HALF = 0.01, math.radians(0.3), 0.03
"""Relative error of a length of the body; of the tilt of the floor; half the difference of ln r between the sides."""

SHORTEST, MOST = 0.08, 31


def rocked(random: np.random.Generator) -> dict[str, Any]:
    """Make one up: a body, what its impacts take, and when they are; it stands on its right foot first."""
    alpha, p, r = random.uniform(0.12, 0.35), random.uniform(1.5, 6.0), random.uniform(0.8, 0.95)
    truth: dict[str, Any] = {"alpha": alpha, "p": p, "r": r, "scatter": random.uniform(0.01, 0.03)}
    truth["half"] = HALF * random.normal()
    while True:
        tilt, peak = TILT * random.normal(), random.uniform(0.3, 0.9)
        real = alpha * math.exp(math.sqrt(2.0) * SIZE_ERROR * random.normal())
        p_real = p * math.exp(0.5 * SIZE_ERROR * random.normal())
        alphas = (real - tilt, real + tilt)
        if (made := _times(random, truth, peak, alphas, p_real)) is not None:
            return truth | {"tilt": tilt, "alphas": alphas, "p_real": p_real, "times": made[0], "speeds": made[1]}


def _times(
    random: np.random.Generator, truth: dict[str, Any], peak: float, alpha: tuple[float, float], p: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    y = math.sqrt(1.0 - (math.sin(0.5 * alpha[0] * (1.0 - peak)) / math.sin(0.5 * alpha[0])) ** 2)
    turning, side, times, speeds = y * 2.0 * math.sin(0.5 * alpha[0]), 0, [0.0], []
    while len(times) < MOST:
        y = turning / (2.0 * math.sin(0.5 * alpha[side]))
        if y >= 1.0:
            return None  # it would overturn
        taken = float(duration(np.array(y), np.array(alpha[side]))) / p
        if taken < SHORTEST:
            break
        times.append(times[-1] + taken)
        speeds.append(y)
        side = 1 - side
        mean = math.log(truth["r"]) + truth["half"] * (1.0 - 2.0 * side)
        turning *= math.exp(mean + truth["scatter"] * random.normal())
    return (np.array(times), np.array(speeds)) if len(times) > 5 else None


def listened(random: np.random.Generator, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Hear impacts: with jitter, bounces behind three of ten, 4 % missed, one in ten that is none."""
    n = times.size
    noisy = times + 10.0 ** random.uniform(-4.3, -3.0) * random.normal(size=n)
    heard, bounced = random.random(n) > 0.04, random.random(n) < 0.3
    false = random.uniform(times[0] - 0.5, times[-1] + 0.5, random.poisson(0.1 * n))
    return np.unique(np.concatenate([noisy[heard], (noisy + random.uniform(0.004, 0.03, n))[bounced & heard], false]))


def turned(random: np.random.Generator, truth: dict[str, Any]) -> RotationSeries:
    """Measure the angular velocity at 200 Hz, with noise of 1 % of its peak, an offset and a drift of up to 5 %."""
    edges = truth["times"]
    time = np.arange(0.002, edges[-1] - 0.002, 0.005)
    k = np.searchsorted(edges, time, side="right") - 1
    alpha, side = np.array(truth["alphas"])[k % 2], 1.0 - 2.0 * (k % 2)
    y, p = truth["speeds"][k], truth["p_real"]
    turning = side * p * rotation(p * (time - edges[k]), y, alpha)[1]
    most = float(np.abs(turning).max())
    line = random.uniform(-0.05, 0.05, 2) * most
    noise = 0.01 * most * random.normal(size=time.size)
    return RotationSeries(time, angular_velocity=turning + noise + line[0] + line[1] * time / time[-1])


def identified(number: int) -> dict[str, Any]:
    """Return whether intervals of one hold the truth, what it took, and what a constant coefficient says."""
    random = np.random.default_rng([18, number])
    truth = rocked(random)
    drifts = number % 10 == 9
    radius = 3.0 * 9.80665 / (4.0 * truth["p"] ** 2)
    body = rk.Block(width=2.0 * radius * math.sin(truth["alpha"]), height=2.0 * radius * math.cos(truth["alpha"]))
    began = time.process_time()
    measured = turned(random, truth) if drifts else ImpactTimes(listened(random, truth["times"]))
    found = identify(measured, body, size_error=SIZE_ERROR, tilt=TILT, asymmetry=2.0 * HALF)
    taken = time.process_time() - began
    row = {
        "drifts": drifts,
        "seconds": taken,
        "refused": bool(found.refused),
        "constant": constant_holds(number, truth),
    }
    if found.refused:
        return row
    row["mean"] = found.mean.low <= truth["r"] <= found.mean.high
    row["scatter"] = found.scatter.low <= truth["scatter"] <= found.scatter.high
    return row | {"width": found.mean.high - found.mean.low}


def constant_holds(number: int, truth: dict[str, Any]) -> bool:
    """Whether one constant r, fitted by least squares, has the truth in its interval where impacts scatter alone.

    Sides are equal, the floor is level, the body known, and nothing is missed or disturbed: ln y_n is a straight line
    in n, and jitter is all that the fit knows, the errors of neighbouring times. (With sides that differ and a tilt it
    holds the truth in 49 %: they widen the interval, and the slope hardly feels what alternates.)
    """
    random, made = np.random.default_rng([19, number]), None
    while made is None:
        made = _times(random, truth | {"half": 0.0}, random.uniform(0.3, 0.9), (truth["alpha"],) * 2, truth["p"])
    intervals, p = np.diff(made[0]), truth["p"]
    alpha = np.full(intervals.size, truth["alpha"])
    ln_y = np.log(speed(p * intervals, alpha))
    by_time = p / np.sinh(p * intervals)  # of ln y
    spread = np.sqrt(2.0) * 1e-4 * by_time
    n = np.arange(intervals.size)
    design = np.column_stack([np.ones_like(ln_y), n]) / spread[:, None]
    covariance = np.linalg.inv(design.T @ design)
    slope = (covariance @ design.T @ (ln_y / spread))[1]
    chi = np.sqrt(
        max(np.sum((ln_y / spread - design @ (covariance @ design.T @ (ln_y / spread))) ** 2), 0.0) / (n.size - 2)
    )
    return bool(abs(slope - math.log(truth["r"])) <= 1.96 * chi * np.sqrt(covariance[1, 1]))


def coverage(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return shares of intervals that hold the truth, of measurements refused, and times."""
    kept = [row for row in rows if not row["refused"]]
    share = {name: float(np.mean([row[name] for row in kept])) for name in ("mean", "scatter", "width")}
    seconds = [row["seconds"] for row in rows]
    return share | {
        "constant": float(np.mean([row["constant"] for row in rows])),
        "refused": 1.0 - len(kept) / len(rows), "seconds": float(np.mean(seconds)), "longest": float(np.max(seconds)),
    }  # fmt: skip


def main(cases: int = 10000) -> None:
    """Print the coverage."""
    rooms = ("identification",)
    rows = list(resumed(ROOT / "build" / "identification.jsonl", cases, identified, __file__, rooms))
    for name, value in coverage(rows).items():
        print(f"| {name} | {value:.4f} |")


if __name__ == "__main__":
    main()
