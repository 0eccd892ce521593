"""How often intervals of `identify` hold the truth: free rockings made up and heard badly, resumed where it stopped.

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
from rocking.identification import ImpactTimes, identify
from rocking.identification.half_cycles import duration, speed

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
        if (times := _times(random, truth, peak, (real - tilt, real + tilt), p_real)) is not None:
            return truth | {"tilt": tilt, "times": times}


def _times(
    random: np.random.Generator, truth: dict[str, Any], peak: float, alpha: tuple[float, float], p: float
) -> NDArray[np.float64] | None:
    y = math.sqrt(1.0 - (math.sin(0.5 * alpha[0] * (1.0 - peak)) / math.sin(0.5 * alpha[0])) ** 2)
    turning, side, times = y * 2.0 * math.sin(0.5 * alpha[0]), 0, [0.0]
    while len(times) < MOST:
        y = turning / (2.0 * math.sin(0.5 * alpha[side]))
        if y >= 1.0:
            return None  # it would overturn
        taken = float(duration(np.array(y), np.array(alpha[side]))) / p
        if taken < SHORTEST:
            break
        times.append(times[-1] + taken)
        side = 1 - side
        mean = math.log(truth["r"]) + truth["half"] * (1.0 - 2.0 * side)
        turning *= math.exp(mean + truth["scatter"] * random.normal())
    return np.array(times) if len(times) > 5 else None


def listened(random: np.random.Generator, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Hear impacts: with jitter, bounces behind three of ten, 4 % missed, one in ten that is none."""
    n = times.size
    noisy = times + 10.0 ** random.uniform(-4.3, -3.0) * random.normal(size=n)
    heard, bounced = random.random(n) > 0.04, random.random(n) < 0.3
    false = random.uniform(times[0] - 0.5, times[-1] + 0.5, random.poisson(0.1 * n))
    return np.unique(np.concatenate([noisy[heard], (noisy + random.uniform(0.004, 0.03, n))[bounced & heard], false]))


def identified(number: int) -> dict[str, Any]:
    """Return whether intervals of one hold the truth, what it took, and what a constant coefficient says."""
    random = np.random.default_rng([18, number])
    truth = rocked(random)
    heard = listened(random, truth["times"])
    radius = 3.0 * 9.80665 / (4.0 * truth["p"] ** 2)
    body = rk.Block(width=2.0 * radius * math.sin(truth["alpha"]), height=2.0 * radius * math.cos(truth["alpha"]))
    began = time.process_time()
    found = identify(ImpactTimes(heard), body, size_error=SIZE_ERROR, tilt=TILT, asymmetry=2.0 * HALF)
    taken = time.process_time() - began
    row = {"seconds": taken, "refused": bool(found.refused), "constant": constant_holds(truth)}
    if found.refused:
        return row
    row["mean"] = found.mean.low <= truth["r"] <= found.mean.high
    row["scatter"] = found.scatter.low <= truth["scatter"] <= found.scatter.high
    return row | {"width": found.mean.high - found.mean.low}


def constant_holds(truth: dict[str, Any]) -> bool:
    """Whether one constant r, fitted by least squares to the undisturbed times, has the truth in its interval.

    ln y_n is a straight line in n for it, and jitter is all that it knows: the errors of neighbouring times, 0.1 ms.
    """
    intervals, p = np.diff(truth["times"]), truth["p"]
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
