"""Accuracy of predictions for plane bodies with unknown inputs, as in real tests; a run can be resumed.

Base, centre of mass, level of the floor, friction and restitution of each body are sampled in the prediction. The
angles and the size of the true body have errors. In the prediction these errors are model error only. The outcome is a
simulation of the true geometry.

`make predictions` predicts 2,000 bodies with 256 histories each, stores them in build/predictions.jsonl, and prints the
scores. It compares them with a logistic curve in PGA and PGV, with a prediction that assumes a known friction, and with
a prediction of an exact scan: without errors of the centre of mass, the level and the model.
"""

import hashlib
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import rocking as rk
from rocking.decision.prediction import predict
from rocking.motions.integrals import peak_ground_velocity
from rocking.restitution._implied import energy_bound
from rocking.statistics.scores import Forecasts, logistic_left_out

ROOT = Path(__file__).parents[1]
RESTITUTION = {"mean": 0.88, "deviation": 0.04}
BASE, FRICTION, TAKEN_FOR_KNOWN = 0.1, (0.1, 0.8), 0.45
"""Largest inset of a foot / half width, range of the friction from sliding to none, and assumed friction [-]."""

CENTRE, OFFSET, LEVEL = (0.97, 1.03), 0.03, 0.006
"""Factor on the height of the centre of mass, its largest horizontal offset / half width [-], largest slope [rad]."""

UPLIFT, BARRIER = 0.1, 0.2
"""Standard deviations of ln of the factors on uplift acceleration and energy barrier, bodies and repeated tests [-]."""

EXACT_SCAN = {"centre": 1.0, "offset": 0.0, "level": 0.0, "model_error": "off"}
WITH_ERRORS = {
    "centre": CENTRE, "level": (-LEVEL, LEVEL),
    "model_error": {"mean": [0.0, 0.0], "covariance": [[UPLIFT**2, 0.0], [0.0, BARRIER**2]]},
}  # fmt: skip
KEYS = ("predicted", "known_friction", "exact_scan", "overturned", "motion", "pga", "pgv")
"""Probabilities by three sets of inputs, outcome, motion number, and peaks of the motion [m/s2, m/s]."""


def predicted_and_observed(number: int, count: int, motions: int) -> dict[str, float]:
    """Return the probabilities of overturning of one body, its outcome, and its ground motion, by `KEYS`."""
    random, which = np.random.default_rng([17, number]), number % motions
    shape = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.ricker, rk.pulses.antisymmetric_ricker)[which % 4]
    shaking = np.random.default_rng([71, which])
    motion = shape(shaking.uniform(2.0, 9.0), shaking.uniform(0.4, 1.2))
    height = random.uniform(0.8, 2.5)
    body = rk.Block(width=height * random.uniform(0.2, 0.35), height=height)
    true = true_body(body, random)
    coefficient = float(np.clip(random.normal(*RESTITUTION.values()), 0.0, 1.0))
    coefficients = {foot: min(coefficient, energy_bound(true, foot)) for foot in ("left", "right")}
    friction, sign = random.uniform(*FRICTION), 1.0 if random.random() < 0.5 else -1.0
    overturned = rk.simulate_many(true, motion, coefficients, friction=friction, scale=sign, threads=1)
    stated: dict[str, Any] = {"restitution": RESTITUTION, "base": (0.0, BASE * body.half_width), "count": count}
    stated |= {"contributions": False, "seed": number, "threads": 1}
    with_errors = WITH_ERRORS | {"offset": (-OFFSET * body.half_width, OFFSET * body.half_width)}
    inputs = ((FRICTION, with_errors), (TAKEN_FOR_KNOWN, with_errors), (FRICTION, EXACT_SCAN))
    predictions = [predict(body, motion, friction=mu, **stated, **errors) for mu, errors in inputs]
    # the fraction of a finite sample is not exactly zero or one
    probabilities = [
        (prediction.chances["overturning"].value * prediction.count + 0.5) / (prediction.count + 1.0)
        for prediction in predictions
    ]
    sampled = motion.sampled(0.005)
    peaks = sampled.peak, peak_ground_velocity(sampled)
    return dict(zip(KEYS, (*probabilities, overturned.overturned.item(), which, *peaks), strict=True))


def true_body(body: rk.Block, random: np.random.Generator) -> rk.MassPoints:
    """Return the body with its true insets, centre of mass, slope of the floor, angles and size.

    The slope is a change of the angles from the vertical. Two equal masses have the inertia of the block.
    """
    insets = random.uniform(0.0, BASE * body.half_width, 2)
    offset, slope = random.uniform(-OFFSET, OFFSET) * body.half_width, random.uniform(-LEVEL, LEVEL)
    uplift, barrier = np.exp(random.normal(0.0, (UPLIFT, BARRIER)))
    size = barrier / uplift**2
    height = 0.5 * body.height * random.uniform(*CENTRE)
    signs = np.array([1.0, -1.0])
    angles = uplift * (np.arctan((body.half_width - insets + signs * offset) / height) + signs * slope)
    nominal = np.arctan(body.half_width / height)
    true_height = size * np.hypot(body.half_width, height) * np.cos(uplift * nominal)
    left, right = true_height * np.tan(angles)
    radius = size * np.hypot(body.width, body.height) / np.sqrt(12.0)
    return rk.MassPoints([(-radius, true_height), (radius, true_height)], [0.5, 0.5], feet=(-left, right))


def scored(rows: list[dict[str, float]]) -> dict[str, Forecasts]:
    """Return the scores of the predictions by their inputs, and of a logistic curve from the other motions."""
    columns = {key: np.array([row[key] for row in rows]) for key in KEYS}
    overturned, motion = columns["overturned"], columns["motion"]
    logistic = logistic_left_out(np.log(np.column_stack([columns["pga"], columns["pgv"]])), overturned, motion)
    by_method = {
        "predict": columns["predicted"],
        "assumed friction": columns["known_friction"],
        "exact scan": columns["exact_scan"],
        "logistic curve of the other motions": logistic,
    }
    return {name: Forecasts(probabilities, overturned, motion) for name, probabilities in by_method.items()}


def resumed(
    path: Path,
    cases: int,
    made: Callable[..., dict[str, Any]],
    source: str,
    rooms: tuple[str, ...] = ("prediction", "dynamics/plane_frictional", "dynamics/frictional", "evidence"),
    **settings: int,
) -> Iterator[dict[str, Any]]:
    """Yield every case, from the file of an earlier run unless the code has changed."""
    folders = [ROOT / "src" / "rocking" / room for room in rooms]
    sources = sorted([Path(source), *(file for folder in folders for file in folder.rglob("*.py"))])
    digest = hashlib.sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()
    head = json.dumps({"sources": digest, **settings})
    lines = path.read_text("utf-8").splitlines() if path.exists() else []
    kept = lines[1:] if lines[:1] == [head] else []
    if kept and not kept[-1].endswith("}"):
        kept.pop()  # it was stopped while it wrote
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join([head, *kept]) + "\n", "utf-8")
    yield from map(json.loads, kept[:cases])
    with path.open("a", encoding="utf-8") as file:
        for number in range(len(kept), cases):
            row = made(number, **settings)
            file.write(f"{json.dumps(row)}\n")
            file.flush()
            yield row


def main(cases: int = 2000, count: int = 256, motions: int = 100) -> None:
    """Print the scores."""
    rows = list(
        resumed(
            ROOT / "build" / "predictions.jsonl", cases, predicted_and_observed, __file__, count=count, motions=motions
        )
    )
    forecasts = scored(rows)
    print("| forecast | Brier | logarithmic | balanced accuracy | calibration z |\n|---|---|---|---|---|")
    for name, forecast in forecasts.items():
        cells = [
            f"{s.value:.4f} ({s.low:.4f} to {s.high:.4f})"
            for s in (forecast.brier, forecast.logarithmic, forecast.balanced_accuracy)
        ]
        print(f"| {name} | {' | '.join(cells)} | {forecast.calibration:.2f} |")
    print("\n| predicted | observed | 95 % | bodies |\n|---|---|---|---|")
    for step in forecasts["predict"].reliability():
        print(f"| {step.predicted:.3f} | {step.observed:.3f} | {step.low:.3f} to {step.high:.3f} | {step.count} |")


if __name__ == "__main__":
    main()
