"""Accuracy of predictions for rocks with hidden base, friction and restitution, simulated in MuJoCo.

`make virtual-rocks` makes 20 rocks, simulates each under 40 motions in MuJoCo (soft contacts, own time steps), predicts
the outcomes from the scan alone, and prints the scores. No parameter is fitted. The results are in
build/virtual_rocks.jsonl, and a later run continues.
"""

import sys
from importlib import import_module
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from benchmarks.predictions import ROOT, resumed
from benchmarks.spatial_mujoco import control, pushes
from rocking.bodies.equilibria import equilibria
from rocking.bodies.solid import Part, Polyhedron, Solid
from rocking.conventions import FloatArray
from rocking.decision.prediction import predict
from rocking.motions.integrals import peak_ground_velocity
from rocking.motions.synthetic import family
from rocking.statistics.scores import Forecasts, logistic_left_out

FRICTION, BASE, CENTRE, DAMPING = (0.3, 0.8), (-0.01, 0.005), (0.97, 1.03), (0.7, 3.0)
"""What is hidden: friction, the base as `predict` takes it over radius and height, the height of the centre, and the
damping of MuJoCo's contacts over critical, which stands for restitution."""

STEP, SOFT, AFTER, FALLEN = 5e-4, 2e-3, 4.0, 20.0
"""Time step and time constant of contacts [s], how long a rock is followed after the motion [s], and the tilt of what
has fallen [deg]."""

FAMILIES = ("firm-ground", "pulse-like")
SCALES = (0.3, 4.0)
"""Motions are scaled, so that some rocks stand and some fall: between these, all logarithms alike."""

SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -9.80665" cone="elliptic" impratio="100" integrator="Euler"/>
  <default>
    <geom condim="3" friction="{friction} 0 0" solref="{soft} {damping}" solimp="0.999 0.999 0.001 0.5 2"/>
  </default>
  <worldbody>
    <geom type="plane" size="50 50 1"/>
    <body><freejoint/><inertial pos="{centre}" mass="{mass}" fullinertia="{inertia}"/>{points}</body>
  </worldbody>
</mujoco>
"""
POINT = 1e-4


def rock(number: int) -> Solid:
    """Return a rough rock on a face of its hull with the nearest edge at a distance of 0.08 to 0.35 of the height."""
    random = np.random.default_rng([5, number])
    while True:
        points = random.normal(size=(60, 3))
        points *= random.uniform(0.85, 1.0, (60, 1)) / np.linalg.norm(points, axis=1, keepdims=True)
        points *= 0.5 * np.array([random.uniform(0.35, 0.7), random.uniform(0.35, 0.7), random.uniform(0.6, 1.2)])
        faces = outward(points)
        moments = Polyhedron(points, faces).moments()
        for pose in equilibria(points, moments.centre, 1.0).stable[::-1]:
            if 0.08 <= pose.edge_distances.min() / pose.height <= 0.35:
                stood = (points - moments.centre) @ pose.rotation.T
                return Solid(Part(Polyhedron(stood - [0.0, 0.0, stood[:, 2].min()], faces), 2650.0))


def outward(points: FloatArray) -> Any:
    """Return the triangles of a hull, counter-clockwise seen from outside."""
    hull = ConvexHull(points)
    a, b, c = points[hull.simplices.T]
    turned = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    return np.where(turned[:, None], hull.simplices[:, ::-1], hull.simplices)


def motion(number: int) -> dict[str, Any]:
    """Return two components of a motion, scaled."""
    random = np.random.default_rng([6, number])
    kind, scale = FAMILIES[number % len(FAMILIES)], float(np.exp(random.uniform(*np.log(SCALES))))
    x, y = (family(kind).motion(100 + number, k).scaled(scale) for k in range(2))
    return {"x": x, "y": y}


def fell(solid: Solid, motions: list[dict[str, Any]], random: np.random.Generator) -> list[float]:
    """Return the overturning of a rock with its hidden properties under each motion, in MuJoCo."""
    mujoco = import_module("mujoco")
    moments, equilibria = solid.local_moments, solid.equilibria()
    pose, height = equilibria.settling((0.0, 0.0, -1.0)), moments.centre[2]
    radius = np.linalg.norm(pose.support, axis=1).mean()
    points = equilibria.hull.vertices.copy()  # from the centre of mass
    base = random.uniform(BASE[0] * radius, min(BASE[1] * height, 0.005))
    low = points[:, 2] + height <= max(base, 1e-9)
    if base > 0.0:
        points[low, 2] = -height
    else:
        points[low, :2] *= 1.0 + base / np.linalg.norm(points[low, :2], axis=1, keepdims=True)
    points[:, 2] += height
    inertia = moments.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    balls = [
        f'<geom type="sphere" size="{POINT}" pos="{x} {y} {z + POINT}"/>'
        for x, y, z in points[ConvexHull(points).vertices]
    ]
    names = {
        "step": STEP, "soft": SOFT, "friction": random.uniform(*FRICTION), "damping": random.uniform(*DAMPING),
        "centre": f"0 0 {height * random.uniform(*CENTRE)}", "mass": moments.mass,
        "inertia": " ".join(map(str, inertia)),
        "points": "".join(balls),
    }  # fmt: skip
    model = mujoco.MjModel.from_xml_string(SCENE.format(**names))
    rollout, data, ended = import_module("mujoco.rollout").rollout, mujoco.MjData(model), []
    for shaking in motions:
        time = STEP * (np.arange(round((shaking["x"].duration + AFTER) / STEP)) + 0.5)
        ground = np.zeros((time.size, 3))
        for axis, component in enumerate(shaking.values()):
            ground[:, axis] = np.interp(time, component.time, component.acceleration, right=0.0)
        start = np.zeros((1, 1 + model.nq + model.nv))
        start[0, 4] = 1.0
        push = control(pushes(model, ground))[None]
        state, _ = rollout(model, data, start, push, control_spec=int(mujoco.mjtState.mjSTATE_XFRC_APPLIED))
        _, x, y, _ = state[0, -1, 4:8]
        ended.append(float(1.0 - 2.0 * (x * x + y * y) < np.cos(np.radians(FALLEN))))
    return ended


def foreseen(number: int, count: int, motions: int) -> dict[str, Any]:
    """Return the prediction for a rock under each motion, and its outcomes."""
    solid, shaken = rock(number), [motion(k) for k in range(motions)]
    # what a scan says, which way the rock stands, and nothing else
    prediction = predict(solid, shaken, azimuth=0.0, count=count, contributions=False, seed=number)
    peaks = [[components["x"].peak, peak_ground_velocity(components["x"])] for components in shaken]
    probabilities = prediction.chances["overturning"].per_motion
    return {
        "said": probabilities.tolist(),
        "fell": fell(solid, shaken, np.random.default_rng([7, number])),
        "peaks": peaks,
    }


def scored(rows: list[dict[str, Any]]) -> dict[str, Forecasts]:
    """Return the scores of the predictions, and of a logistic in PGA and PGV that has not seen the motion."""
    probabilities, happened = (np.concatenate([row[key] for row in rows]) for key in ("said", "fell"))
    peaks = np.concatenate([row["peaks"] for row in rows])
    which = np.tile(np.arange(len(rows[0]["said"])), len(rows))
    logistic = logistic_left_out(np.log(peaks), happened, which)
    return {
        "predict": Forecasts(probabilities, happened, which),
        "logistic, a motion left out": Forecasts(logistic, happened, which),
    }


def main(rocks: int = 20, count: int = 32, motions: int = 40) -> None:
    """Print the scores of each rock and of all rocks."""
    path = ROOT / "build" / "virtual_rocks.jsonl"
    rows = list(resumed(path, rocks, foreseen, __file__, count=count, motions=motions))
    print("| rock | fell | balanced accuracy |\n|---|---|---|")
    for k, row in enumerate(rows):
        forecasts = Forecasts(row["said"], row["fell"])
        right = forecasts.balanced_accuracy if 0 < sum(row["fell"]) < len(row["fell"]) else forecasts.accuracy
        cell = f"{right.value:.3f} ({right.low:.3f} to {right.high:.3f})"
        print(f"| {k} | {sum(row['fell']):.0f} of {len(row['fell'])} | {cell} |")
    print("\n| forecast | balanced accuracy | Brier | calibration z |\n|---|---|---|---|")
    for name, forecasts in scored(rows).items():
        scores = (forecasts.balanced_accuracy, forecasts.brier)
        cells = " | ".join(f"{s.value:.3f} ({s.low:.3f} to {s.high:.3f})" for s in scores)
        print(f"| {name} | {cells} | {forecasts.calibration:.1f} |")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
