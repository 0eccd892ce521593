"""Coverage of the intervals of `identify` under a known ground motion, for synthetic measurements.

`python -m benchmarks.identification_forced` makes 1,000 measurements (a quarter of an hour) and 100 with sliding feet,
stores them in build/identification_forced.jsonl and build/identification_friction.jsonl, resumes an earlier run, and
prints the coverage. The engines of `simulate` compute the true response with a random r per impact; identification has
a separate integrator.
"""

import math
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtri

import rocking as rk
from benchmarks.predictions import resumed
from rocking.conventions import FloatArray, g
from rocking.dynamics import RandomRestitution
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.plane_frictional.base import ContactState, Mode, PlaneBase
from rocking.dynamics.plane_frictional.engine import ContactEngine
from rocking.dynamics.plane_frictional.impact_resolution import GroundContact
from rocking.dynamics.plane_frictional.response import ContactResponse
from rocking.identification import RotationSeries
from rocking.identification.forced import answer, fit_forced
from rocking.identification.forced_friction import with_sliding
from rocking.identification.forced_model import MEAN, SAME_TIME, fitted
from rocking.identification.forced_posterior import ForcedPosterior
from rocking.identification.posterior import Knowledge
from rocking.identification.results import IntervalEstimate, estimated
from rocking.motions.synthetic import family

ROOT = Path(__file__).parents[1]
FAMILIES = ("firm-ground", "soft-ground", "kanai-tajimi", "pulse-like")
SIZE_ERROR, TILT, HALF_ERROR, CLOCK = 0.01, math.radians(0.3), 0.03, 0.02
"""Relative error of a length; of the tilt; half the difference of ln r between the sides; of the clock [s]."""

PULSES = 0.3  # of the motions, where bodies slide
NOISE, RATE, AFTER = 0.005, 200.0, 6.0  # over the largest value; samples a second; seconds after the motion


def shaken(number: int, kind: str = "rotation", clock: float = CLOCK, *, friction: bool = False) -> dict[str, Any]:
    """Return a synthetic body that rocks without overturning: assumed body, motion, measurement."""
    random = np.random.default_rng([18, 5 if friction else 4, number])
    while True:
        truth = (_slid if friction else _followed)(random)
        if truth is not None:
            break
    response, noise = truth["response"], random.normal(0.0, 1.0, 3)
    truth |= {"clock": clock * noise[0], "gain": math.exp(SIZE_ERROR * noise[1])}
    times = np.arange(0.0, response.time[-1] - 0.2, 1.0 / RATE)
    ground = np.clip(times - truth["clock"], 0.0, response.time[-1])

    def rotation(at: FloatArray) -> FloatArray:
        return np.asarray(response.at(at)[:, 2] if friction else response.at(at))

    values = rotation(ground)
    if kind == "angular_velocity":
        before, after = np.maximum(ground - 1e-4, 0.0), np.minimum(ground + 1e-4, response.time[-1])
        values = (rotation(after) - rotation(before)) / (after - before)
    size, drift = float(np.abs(values).max()), 0.02 if kind == "rotation" else 0.002
    values = truth["gain"] * values + size * (0.05 + drift * noise[2] * times / times[-1])
    values += NOISE * size * random.normal(size=times.size)
    return truth | {"series": RotationSeries(times, **{kind: values})}


def _bodies(random: np.random.Generator) -> tuple[rk.Block, rk.Block, dict[str, Any]]:
    """Return the assumed body, the true body, and its coefficients."""
    height, alpha, e = random.uniform(0.3, 3.0), random.uniform(0.12, 0.3), random.uniform(-0.12, 0.12)
    width, centre = height * math.tan(alpha), 0.5 * height * random.uniform(0.9, 1.1)
    body = rk.Block(width=width, height=height, centre=(width * (0.5 + e), centre))
    across, up = np.exp(SIZE_ERROR * random.normal(size=2))
    real = rk.Block(width=width * across, height=height * up, centre=(width * across * (0.5 + e), centre * up))
    truth: dict[str, Any] = {"r": random.uniform(0.82, 0.95), "half": HALF_ERROR * random.normal()}
    truth |= {"scatter": random.uniform(0.01, 0.03), "tilt": TILT * random.normal(), "alpha": alpha}
    return body, real, truth


def _synthetic(random: np.random.Generator) -> rk.GroundMotion:
    kind = family(FAMILIES[random.integers(4)])
    return kind.make(
        kind.parameters(random.uniform(size=len(kind.distributions))), int(random.integers(1 << 30)), kind.time_step
    )


def _scaled(random: np.random.Generator, motion: rk.GroundMotion, real: rk.Block) -> rk.GroundMotion:
    lifts = g / max(real.side(foot).slenderness_ratio for foot in ("left", "right"))
    return motion.scaled(random.uniform(1.3, 3.0) * lifts / motion.peak)


def _floor(motion: rk.GroundMotion, tilt: float) -> rk.GroundMotion:
    """Return the motion on a level floor that is equivalent to a fall to the right, with inclined gravity."""
    still = np.zeros(int(AFTER / motion.time_step))
    pushed = np.concatenate([motion.acceleration, still]) - g * math.sin(tilt)
    return rk.GroundMotion(pushed, motion.time_step, vertical=np.full(pushed.size, g * (math.cos(tilt) - 1.0)))


def _followed(random: np.random.Generator) -> dict[str, Any] | None:
    body, real, truth = _bodies(random)
    motion = _scaled(random, _synthetic(random), real)
    draws = truth["scatter"] * ndtri((np.arange(1025) + 0.5) / 1025)
    by_side = {
        foot: np.exp(math.log(truth["r"]) + s * truth["half"] + draws) for foot, s in (("right", 1), ("left", -1))
    }
    floor = _floor(motion, truth["tilt"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        response = rk.simulate(
            real, floor, RandomRestitution(by_side, int(random.integers(1 << 30))), duration=floor.duration
        )
    sides = response.parameters.right, response.parameters.left
    if min(side.share for side in sides) < 1.0:  # draws that would create energy were cut off: the mean is another
        return None
    if response.outcome.name != "ROCKED" or response.impacts.size < 6 or response.peak_rotation < 0.1 * truth["alpha"]:
        return None
    return truth | {"body": body, "motion": motion, "response": response}


class DrawnContact(ContactEngine):
    """Sliding, hopping and rocking, with random coefficients of restitution at every impact."""

    def draws_from(self, random: np.random.Generator, truth: dict[str, Any]) -> "DrawnContact":
        """Return it with the law of the draws."""
        self.random, self.truth, self.drawn = random, truth, []
        return self

    def _struck(self, before: ContactState, mode: Mode) -> Any:
        r, half, scatter = (self.truth[name] for name in ("r", "half", "scatter"))
        left, right = (r * math.exp(s * half + scatter * self.random.normal()) for s in (-1, 1))
        self.drawn += [left, right]
        self.law = replace(self.law, restitution=(left, right))
        return super()._struck(before, mode)


def _slid(random: np.random.Generator) -> dict[str, Any] | None:
    """The same with feet that slide for a millimetre at least, under pulses too."""
    body, real, truth = _bodies(random)
    truth["friction"] = random.uniform(0.15, 0.6)
    if random.uniform() < PULSES:
        p = real.side("right").frequency_parameter
        kind = rk.pulses.sine if random.uniform() < 0.5 else rk.pulses.ricker
        pulse = kind(amplitude=1.0, period=random.uniform(0.6, 2.5) / p * 2)
        motion = pulse.sampled(pulse.duration / 400)
        motion = rk.GroundMotion(np.concatenate([np.zeros(100), motion.acceleration, [0.0]]), motion.time_step)
    else:
        motion = _synthetic(random)
    motion = _scaled(random, motion, real)
    floor, base = _floor(motion, truth["tilt"]), PlaneBase.of_body(real)
    law, settings = GroundContact(truth["friction"]), PlaneSettings()
    engine = DrawnContact(base, floor.segments(), law, settings).draws_from(random, truth)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        response = ContactResponse(real, floor, base, law, settings, floor.segments(), 1.0, engine.run(), "")
    if max(engine.drawn, default=1.0) >= 1.0 or response.outcome.name in {"OVERTURNED", "FAILED"}:
        return None
    if len(response.impacts) < 6 or np.abs(response.rotation).max() < 0.1 * truth["alpha"]:
        return None
    return truth | {"body": body, "motion": motion, "response": response} if response.sliding_distance > 1e-3 else None


def slid(number: int) -> dict[str, Any]:
    """Return the same of a body whose feet slide."""
    return identified(number, friction=True)


def identified(number: int, kind: str = "rotation", *, friction: bool = False, slides: bool = True) -> dict[str, Any]:
    """Return whether intervals of one hold the truth, and whether that of a constant coefficient does.

    friction: whether its feet slide; slides: whether this is thought of.
    """
    case = shaken(number, kind, friction=friction)
    prior = Knowledge.checked(
        case["body"], SIZE_ERROR, TILT, 2.0 * HALF_ERROR, trend=False, damping=False, first="right"
    )
    began = time.process_time()
    fit = fit_forced(case["series"], prior, case["motion"], (0.0, CLOCK))
    said = (
        None if fit is None else with_sliding(fit) if slides else (fit, IntervalEstimate(math.nan, 0.0, math.nan), ())
    )
    found = None if fit is None or said is None else answer(*said, fit)
    row: dict[str, Any] = {"seconds": time.process_time() - began, "refused": found is None or bool(found.refused)}
    if fit is None or found is None or found.forced is None or found.refused:
        return row | {"why": [] if found is None else list(found.refused)}
    true = {
        "mean": (found.mean, case["r"]), "scatter": (found.scatter, case["scatter"]),
        "right": (found.coefficients["right"], case["r"] * math.exp(case["half"])),
        "left": (found.coefficients["left"], case["r"] * math.exp(-case["half"])),
        "clock": (found.forced.clock, case["clock"]), "gain": (found.forced.gain, case["gain"]),
        "tilt": (found.tilt, case["tilt"]),
        # of feet that held all coefficients above what was needed are the truth
        "friction": (found.forced.friction, case.get("friction", fit.problem.demand(fit.fit.x))),
        "held": (estimated(fit.shared((MEAN, 1.0)), 1.0), case["r"]),  # by feet that are believed to hold
    }  # fmt: skip
    row |= {name: bool(estimate.low <= value and not value > estimate.high) for name, (estimate, value) in true.items()}
    row |= {
        "width": found.mean.high - found.mean.low,
        "impacts": len(found.impacts),
        "odd": found.forced.excluded_half_cycles,
    }
    row |= {"constant": constant_holds(fit, case["r"]), "foreseen": found.forced.predictable}
    told, true_friction = found.forced.friction, case.get("friction", math.inf)
    row |= {"identified": math.isfinite(told.value), "told": [told.value, told.low, told.high], "true": true_friction}
    return row | {"doubts": list(found.doubts)}


def constant_holds(posterior: ForcedPosterior, r: float) -> bool:
    """Whether the interval of one r for all impacts holds the truth: the same, with hardly any scatter."""
    fixed = ForcedPosterior(
        posterior.problem, fitted(posterior.problem, posterior.fit.x, posterior.noise, 1e-3, SAME_TIME), posterior.noise
    )
    mixture, at = fixed.shared((MEAN, 1.0)), int(np.argmin(np.abs(fixed.scatter - 1e-3)))
    return bool(abs(mixture.means[at] - math.log(r)) <= 1.96 * mixture.deviations[at])


def coverage(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return coverage of intervals, fraction of refused measurements, and times."""
    kept = [row for row in rows if not row["refused"]]
    names = "mean", "right", "left", "scatter", "clock", "gain", "tilt", "friction", "identified", "held", "constant"
    names += "width", "impacts", "odd"
    share = {name: float(np.mean([row[name] for row in kept])) for name in names}
    return share | {
        "refused": 1.0 - len(kept) / len(rows), "seconds": float(np.mean([row["seconds"] for row in rows])),
    }  # fmt: skip


def main(cases: int = 1000) -> None:
    """Print the coverage."""
    for kind, count, compute in (("forced", cases, identified), ("friction", cases // 10, slid)):
        path = ROOT / "build" / f"identification_{kind}.jsonl"
        for name, value in coverage(list(resumed(path, count, compute, __file__, ("identification",)))).items():
            print(f"| {kind}: {name} | {value:.4f} |")


if __name__ == "__main__":
    main()
