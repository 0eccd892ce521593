"""Folders of invented trials: synthetic records, and simulations whose friction, base and restitution are hidden."""

import csv

import numpy as np

import rocking as rk
from rocking.restitution._implied import energy_bound

BODY = rk.Block(width=0.4, height=1.6)
TOML = "[body]\nunits = 'm'\nwidth = 0.4\nheight = 1.6\n[predict]\nfriction = [0.1, 0.8]\ncount = 32\n"
TOML += "restitution = { mean = 0.88, deviation = 0.04 }\nbase = [0.0, 0.02]\ncentre = 1.0\nmodel_error = 'off'\n"
TOML += "[motion]\nunits = 'm/s2'\n"
SCALES = (0.6, 1.0, 1.7)
FEW = ("--set", "predict.count=16")


def outcome_folder(folder, motions=24, *, shuffled=False, trials=2):
    """Fill a folder; shuffled: the negative control, in which what was seen belongs to other trials."""
    random, rows = np.random.default_rng(17), []
    shapes = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.ricker, rk.pulses.antisymmetric_ricker)
    for k in range(motions):
        record = shapes[k % 4](random.uniform(2.0, 6.0), random.uniform(0.3, 1.4)).sampled(0.01)
        lines = (f"{0.01 * n:.2f} {a:.9g}" for n, a in enumerate(record.acceleration.tolist()))
        (folder / f"record_{k}.txt").write_text("\n".join(lines), "utf-8")
        for scale in SCALES:
            rows += [(f"record_{k}.txt", scale, *seen(record, scale, random)) for _ in range(trials)]
    if shuffled:
        order = random.permutation(len(rows))
        rows = [(*row[:2], *rows[other][2:]) for row, other in zip(rows, order, strict=True)]
    with (folder / "outcomes.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([("motion", "scale", "overturned", "rocked"), *rows])
    (folder / "body.toml").write_text(TOML, "utf-8")
    return folder


def seen(record, scale, random):
    """Return whether a body with what is hidden of it overturned, and whether it rocked."""
    left, right = random.uniform(0.0, 0.02, 2)
    truly = BODY.with_feet(BODY.feet[0] + left, BODY.feet[1] - right)
    r = float(np.clip(random.normal(0.88, 0.04), 0.0, 1.0))
    r = {foot: min(r, energy_bound(truly, foot)) for foot in ("left", "right")}
    sign = random.choice([-1.0, 1.0])
    found = rk.simulate_many(
        truly, record, r, friction=random.uniform(0.1, 0.8), scale=sign * scale, threads=1
    ).squeeze()
    return int(found.overturned), int(float(found.peak_rotation) != 0.0)
