"""How often intervals of `identify` hold the truth under a known ground motion: bodies made up, shaken and measured.

`python -m benchmarks.identification_forced` makes 1,000 of them (a quarter of an hour), keeps every one in
build/identification_forced.jsonl, goes on where it stopped, and prints the coverage. The truth is followed by the
engine of `simulate`, with r drawn anew at every impact; identification has an integrator of its own.
"""

import math
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtri

import rocking as rk
from benchmarks.predictions import resumed
from rocking.conventions import g
from rocking.dynamics import RandomRestitution
from rocking.identification import RotationSeries
from rocking.identification.forced import ForcedPosterior, answer, fit_forced
from rocking.identification.forced_model import MEAN, SAME_TIME, fitted
from rocking.identification.posterior import Knowledge
from rocking.motions.synthetic import family

ROOT = Path(__file__).parents[1]
FAMILIES = ("firm-ground", "soft-ground", "kanai-tajimi", "pulse-like")
SIZE_ERROR, TILT, HALF_ERROR, CLOCK = 0.01, math.radians(0.3), 0.03, 0.02
"""Relative error of a length; of the tilt; half the difference of ln r between the sides; of the clock [s]."""

NOISE, RATE, AFTER = 0.005, 200.0, 6.0  # over the largest value; samples a second; seconds after the motion


def shaken(number: int, kind: str = "rotation", clock: float = CLOCK) -> dict[str, Any]:
    """Make one up that rocks and stays standing: the body as it is believed to be, the motion, what was measured."""
    random = np.random.default_rng([18, 4, number])
    while True:
        truth = _followed(random)
        if truth is not None:
            break
    response, noise = truth["response"], random.normal(0.0, 1.0, 3)
    truth |= {"clock": clock * noise[0], "gain": math.exp(SIZE_ERROR * noise[1])}
    times = np.arange(0.0, response.time[-1] - 0.2, 1.0 / RATE)
    ground = np.clip(times - truth["clock"], 0.0, response.time[-1])
    values = response.at(ground)
    if kind == "angular_velocity":
        before, after = np.maximum(ground - 1e-4, 0.0), np.minimum(ground + 1e-4, response.time[-1])
        values = (response.at(after) - response.at(before)) / (after - before)
    size, drift = float(np.abs(values).max()), 0.02 if kind == "rotation" else 0.002
    values = truth["gain"] * values + size * (0.05 + drift * noise[2] * times / times[-1])
    values += NOISE * size * random.normal(size=times.size)
    return truth | {"series": RotationSeries(times, **{kind: values})}


def _followed(random: np.random.Generator) -> dict[str, Any] | None:
    height, alpha, e = random.uniform(0.3, 3.0), random.uniform(0.12, 0.3), random.uniform(-0.12, 0.12)
    width, centre = height * math.tan(alpha), 0.5 * height * random.uniform(0.9, 1.1)
    body = rk.Block(width=width, height=height, centre=(width * (0.5 + e), centre))
    across, up = np.exp(SIZE_ERROR * random.normal(size=2))
    real = rk.Block(width=width * across, height=height * up, centre=(width * across * (0.5 + e), centre * up))
    truth: dict[str, Any] = {"r": random.uniform(0.82, 0.95), "half": HALF_ERROR * random.normal()}
    truth |= {"scatter": random.uniform(0.01, 0.03), "tilt": TILT * random.normal()}
    kind = family(FAMILIES[random.integers(4)])
    motion = kind.make(
        kind.parameters(random.uniform(size=len(kind.distributions))), int(random.integers(1 << 30)), kind.time_step
    )
    lifts = g / max(real.side(foot).slenderness_ratio for foot in ("left", "right"))
    motion = motion.scaled(random.uniform(1.3, 3.0) * lifts / motion.peak)
    draws = truth["scatter"] * ndtri((np.arange(1025) + 0.5) / 1025)
    by_side = {
        foot: np.exp(math.log(truth["r"]) + s * truth["half"] + draws) for foot, s in (("right", 1), ("left", -1))
    }
    # a floor that falls to the right is one that is level, under a gravity that leans to the right
    rest = np.zeros(int(AFTER / motion.time_step))
    pushed = np.concatenate([motion.acceleration, rest]) - g * math.sin(truth["tilt"])
    floor = rk.GroundMotion(
        pushed, motion.time_step, vertical=np.full(pushed.size, g * (math.cos(truth["tilt"]) - 1.0))
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        response = rk.simulate(
            real, floor, RandomRestitution(by_side, int(random.integers(1 << 30))), duration=floor.duration
        )
    sides = response.parameters.right, response.parameters.left
    if min(side.share for side in sides) < 1.0:  # draws that would create energy were cut off: the mean is another
        return None
    if response.outcome.name != "ROCKED" or response.impacts.size < 6 or response.peak_rotation < 0.1 * alpha:
        return None
    return truth | {"body": body, "motion": motion, "response": response}


def identified(number: int, kind: str = "rotation") -> dict[str, Any]:
    """Return whether intervals of one hold the truth, and whether that of a constant coefficient does."""
    case = shaken(number, kind)
    known = Knowledge.of(case["body"], SIZE_ERROR, TILT, 2.0 * HALF_ERROR, trend=False, damping=False, first="right")
    began = time.process_time()
    fit = fit_forced(case["series"], known, case["motion"], (0.0, CLOCK))
    found = None if fit is None else answer(fit)
    row: dict[str, Any] = {"seconds": time.process_time() - began, "refused": found is None or bool(found.refused)}
    if fit is None or found is None or found.forced is None or found.refused:
        return row | {"why": [] if found is None else list(found.refused)}
    true = {
        "mean": (found.mean, case["r"]), "scatter": (found.scatter, case["scatter"]),
        "right": (found.coefficients["right"], case["r"] * math.exp(case["half"])),
        "left": (found.coefficients["left"], case["r"] * math.exp(-case["half"])),
        "clock": (found.forced.clock, case["clock"]), "gain": (found.forced.gain, case["gain"]),
        "tilt": (found.tilt, case["tilt"]),
    }  # fmt: skip
    row |= {name: bool(each.low <= value <= each.high) for name, (each, value) in true.items()}
    row |= {"width": found.mean.high - found.mean.low, "impacts": len(found.impacts), "odd": found.forced.odd}
    return row | {
        "constant": constant_holds(fit, case["r"]),
        "foreseen": found.forced.foreseen,
        "doubts": list(found.doubts),
    }


def constant_holds(found: ForcedPosterior, r: float) -> bool:
    """Whether the interval of one r for all impacts holds the truth: the same, with hardly any scatter."""
    fixed = ForcedPosterior(
        found.problem, fitted(found.problem, found.fit.x, found.noise, 1e-3, SAME_TIME), found.noise
    )
    mixture, at = fixed.shared((MEAN, 1.0)), int(np.argmin(np.abs(fixed.scatter - 1e-3)))
    return bool(abs(mixture.means[at] - math.log(r)) <= 1.96 * mixture.deviations[at])


def coverage(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return shares of intervals that hold the truth, of measurements refused, and times."""
    kept = [row for row in rows if not row["refused"]]
    names = ("mean", "right", "left", "scatter", "clock", "gain", "tilt", "constant", "width", "impacts", "odd")
    share = {name: float(np.mean([row[name] for row in kept])) for name in names}
    return share | {
        "refused": 1.0 - len(kept) / len(rows), "seconds": float(np.mean([row["seconds"] for row in rows])),
    }  # fmt: skip


def main(cases: int = 1000) -> None:
    """Print the coverage."""
    rows = list(
        resumed(ROOT / "build" / "identification_forced.jsonl", cases, identified, __file__, ("identification",))
    )
    for name, value in coverage(rows).items():
        print(f"| {name} | {value:.4f} |")


if __name__ == "__main__":
    main()
