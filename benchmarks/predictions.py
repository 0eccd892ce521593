"""Accuracy of predictions for bodies with hidden base, friction and restitution; a run can be resumed.

`make predictions` predicts 2,000 bodies with 256 histories each (3 minutes), stores them in build/predictions.jsonl,
and prints scores, compared with a logistic in PGA and PGV and with a prediction that assumes a known friction.
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
"""Of the half width at most; and from below to above what keeps these bodies from sliding, so that it decides most."""

KEYS = ("said", "ignorant", "fell", "motion", "pga", "pgv")
"""Probability, that of the prediction that takes the friction for known, what happened, and under which motion."""


def foreseen(number: int, count: int, motions: int) -> dict[str, float]:
    """Return the probabilities of one body, its true outcome, and its ground motion, by `KEYS`.

    The outcome is a separate simulation of the body with its true feet.
    """
    random, which = np.random.default_rng([17, number]), number % motions
    shape = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.ricker, rk.pulses.antisymmetric_ricker)[which % 4]
    shaking = np.random.default_rng([71, which])
    motion = shape(shaking.uniform(2.0, 9.0), shaking.uniform(0.4, 1.2))
    height = random.uniform(0.8, 2.5)
    body = rk.Block(width=height * random.uniform(0.2, 0.35), height=height)
    left, right = random.uniform(0.0, BASE * body.half_width, 2)
    truly = body.with_feet(body.feet[0] + left, body.feet[1] - right)
    coefficient = float(np.clip(random.normal(*RESTITUTION.values()), 0.0, 1.0))
    coefficients = {foot: min(coefficient, energy_bound(truly, foot)) for foot in ("left", "right")}
    friction, sign = random.uniform(*FRICTION), 1.0 if random.random() < 0.5 else -1.0
    overturned = rk.simulate_many(
        truly, motion, coefficients, friction=friction, scale=sign, threads=1
    ).overturned.item()
    settings: dict[str, Any] = {"restitution": RESTITUTION, "base": (0.0, BASE * body.half_width), "centre": 1.0}
    settings |= {"offset": 0.0, "level": 0.0, "model_error": "off"}
    settings |= {"contributions": False, "seed": number, "threads": 1}
    predictions = [predict(body, motion, friction=mu, count=count, **settings) for mu in (FRICTION, TAKEN_FOR_KNOWN)]
    # a share of a finite sample is never quite certain
    probabilities = [
        (prediction.chances["overturning"].value * prediction.count + 0.5) / (prediction.count + 1.0)
        for prediction in predictions
    ]
    sampled = motion.sampled(0.005)
    return dict(
        zip(KEYS, (*probabilities, overturned, which, sampled.peak, peak_ground_velocity(sampled)), strict=True)
    )


def scored(rows: list[dict[str, float]]) -> dict[str, Forecasts]:
    """Return the scores of the predictions, of those that take the friction for known, and of the logistic."""
    predicted, ignorant, overturned, motion, pga, pgv = (np.array([row[key] for row in rows]) for key in KEYS)
    logistic = logistic_left_out(np.log(np.column_stack([pga, pgv])), overturned, motion)
    by_method = {"predict": predicted, "friction taken for known": ignorant, "logistic, a motion left out": logistic}
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
    rows = list(resumed(ROOT / "build" / "predictions.jsonl", cases, foreseen, __file__, count=count, motions=motions))
    forecasts = scored(rows)
    print("| forecast | Brier | logarithmic | balanced accuracy | calibration z |\n|---|---|---|---|---|")
    for name, forecast in forecasts.items():
        cells = [
            f"{s.value:.4f} ({s.low:.4f} to {s.high:.4f})"
            for s in (forecast.brier, forecast.logarithmic, forecast.balanced_accuracy)
        ]
        print(f"| {name} | {' | '.join(cells)} | {forecast.calibration:.2f} |")
    print("\n| said | happened | 95 % | bodies |\n|---|---|---|---|")
    for step in forecasts["predict"].reliability():
        print(f"| {step.predicted:.3f} | {step.observed:.3f} | {step.low:.3f} to {step.high:.3f} | {step.count} |")


if __name__ == "__main__":
    main()
