"""Fifty random hulls under ground motion: the compiled engine of hulls and MuJoCo, one core each, in CPU time.

MuJoCo runs at the largest time step with outcomes equal to those of half of it in 95 % of the hulls. The engine of
hulls runs at two tolerances, compared with a tolerance of 1e-10. The ratio is the median over the histories that rock
at least a fifth of the time in MuJoCo.
"""

import sys
import time
from dataclasses import dataclass
from importlib import import_module
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from benchmarks import spatial_mujoco, table
from benchmarks.table import Row
from rocking.conventions import FloatArray, g
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import HullGround, frame
from rocking.dynamics.frictional.histories import hull_histories
from rocking.dynamics.frictional.motion import standing
from rocking.dynamics.frictional.settings import HullSettings
from rocking.motions import GroundMotion

BATCH = 50
COUNT, SHAKEN, DURATION, DT = 50, 6.0, 10.0, 0.01
FRICTION, GOAL, AGREE, MOVES = 0.6, 100.0, 0.95, 0.2
STEPS = tuple(8e-3 * 0.5**k for k in range(8))
SETTINGS, CLOSE, CLOSEST = (HullSettings(tolerance=t) for t in (1e-5, 1e-8, 1e-10))
SCENE = """
<mujoco>
  <compiler inertiafromgeom="false" balanceinertia="false"/>
  <option timestep="{step}" gravity="0 0 -{gravity}" cone="elliptic" impratio="{ratio}"
          iterations="100" tolerance="1e-14"/>
  <default>
    <geom condim="3" friction="{friction} 0 0" solref="{soft} {damping}" solimp="{stiff} {stiff} 0.001 0.5 2"/>
  </default>
  <asset><mesh name="hull" vertex="{vertices}" inertia="convex"/></asset>
  <worldbody>
    <geom type="plane" size="50 50 1"/>
    <body pos="0 0 {height}"><freejoint/>
      <inertial pos="0 0 0" mass="{mass}" fullinertia="{inertia}"/>
      <geom type="mesh" mesh="hull"/>
    </body>
  </worldbody>
</mujoco>
"""


@dataclass(frozen=True)
class Case:
    """A hull in its pose with the lowest centre of mass, and the acceleration of the ground every `DT` [m/s2]."""

    body: HullBody
    acceleration: FloatArray

    @property
    def ground(self) -> HullGround:
        """Ground motion of the engine."""
        return HullGround(*(GroundMotion(a, DT) for a in self.acceleration.T))


def cases() -> list[Case]:
    """The hulls, each with a motion of its own: ten sines from 0.5 to 3 Hz, the vertical component a third."""
    rng, drawn_cases = np.random.default_rng(2026), []
    t = np.arange(0.0, SHAKEN, DT)
    for _ in range(COUNT):
        body = _hull(rng)
        waves = np.zeros((t.size, 3))
        for k, peak in enumerate(rng.uniform(0.3, 1.0) * g * np.array([1.0, 1.0, 0.33])):
            phases, rates = rng.uniform(0.0, 2.0 * np.pi, 10), rng.uniform(0.5, 3.0, 10)
            sines = np.sin(2.0 * np.pi * t[:, None] * rates + phases).sum(axis=1) * np.sin(np.pi * t / SHAKEN) ** 2
            waves[:, k] = peak * sines / np.abs(sines).max()
        drawn_cases.append(Case(body, waves))
    return drawn_cases


def _hull(rng: np.random.Generator) -> HullBody:
    """A random hull with the mass properties of its tetrahedra, upright on its lowest pose."""
    points = rng.normal(size=(int(rng.integers(8, 20)), 3))
    points *= [0.3, 0.3, 0.6] * rng.uniform(0.6, 1.0, (len(points), 1)) / np.linalg.norm(points, axis=1)[:, None]
    origin, mass, first, second = points.mean(axis=0), 0.0, np.zeros(3), np.zeros((3, 3))
    for corners in points[ConvexHull(points).simplices] - origin:
        volume, total = abs(np.linalg.det(corners)) / 6.0, corners.sum(axis=0)
        mass, first = mass + volume, first + volume * total / 4.0
        second += volume / 20.0 * (corners.T @ corners + np.outer(total, total))
    first /= mass
    second -= mass * np.outer(first, first)
    body = HullBody(points, 2500.0 * mass, first + origin, 2500.0 * (np.trace(second) * np.eye(3) - second))
    stable = [k for k in range(len(body.facets)) if body.hull.stable[k]]
    facet = int(rng.choice(stable))
    turn = np.array(frame(standing(body, facet=facet).attitude))
    return HullBody(body.vertices @ turn.T, body.mass, turn @ body.centre, turn @ body.inertia @ turn.T)


def model_of(body: HullBody, step: float) -> Any:
    """The hull in MuJoCo."""
    contact, mujoco = spatial_mujoco.Contact(step=step), import_module("mujoco")
    points, i = np.array(body.points), np.array(body.tensor)

    def words(values: Any) -> str:
        return " ".join(f"{v:.17g}" for v in np.ravel(values))

    text = {
        "step": step, "gravity": g, "ratio": contact.ratio, "friction": FRICTION, "soft": contact.steps * step,
        "damping": contact.damping, "stiff": contact.stiff, "vertices": words(points), "mass": body.mass,
        "height": -points[:, 2].min(), "inertia": words([i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]),
    }  # fmt: skip
    return mujoco.MjModel.from_xml_string(SCENE.format(**text))


def peer(case: Case, step: float) -> tuple[bool, float, float]:
    """Return overturning in MuJoCo, the fraction of time with rocking, CPU time [s]."""
    model = model_of(case.body, step)
    steps = round(DURATION / step)
    at = step * (np.arange(steps) + 0.5)
    t = DT * np.arange(len(case.acceleration))
    field = np.column_stack([np.interp(at, t, a, right=0.0) for a in case.acceleration.T])
    start = np.zeros(1 + model.nq + model.nv)
    start[1 : 1 + model.nq] = model.qpos0
    controls = spatial_mujoco.control(spatial_mujoco.pushes(model, field))
    began = time.process_time()
    states = spatial_mujoco.rollout(model, start[None], controls[None])[0]
    spent = time.process_time() - began
    w, x, y, z = states[:, 4:8].T
    up = np.column_stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)])
    poses = case.body.poses
    overturned = poses[case.body.under(tuple(up[-1].tolist()))] != poses[case.body.under((0.0, 0.0, 1.0))]
    turns = np.linalg.norm(states[:, 11:14], axis=1) > 0.02
    return overturned, float(turns.mean()), spent


def ours(case: Case, settings: HullSettings, count: int = BATCH) -> tuple[bool, float]:
    """Whether it overturns by the compiled engine of hulls, CPU time [s]: of one history in a batch."""
    choices = {"friction": FRICTION, "horizon": DURATION, "settings": settings, "engine": "fast", "threads": 1}
    began = time.process_time()
    batch = hull_histories(case.body, case.ground, scales=np.ones(count), **choices)
    return bool(batch.overturned.flat[0] == 1.0), (time.process_time() - began) / count


def main() -> bool:
    """Print and keep the comparison; whether the goal was met."""
    hulls = cases()
    mine = {s.tolerance: [ours(case, s) for case in hulls] for s in (SETTINGS, CLOSE)}
    mine[CLOSEST.tolerance] = [ours(case, CLOSEST, 1) for case in hulls]
    rows = []
    for tolerance in (SETTINGS.tolerance, CLOSE.tolerance):
        spent, same = np.median([t for _, t in mine[tolerance]]), _alike(mine[tolerance], mine[CLOSEST.tolerance])
        rows.append(Row(f"a history of {DURATION:g} s", f"tolerance {tolerance:g}", f"{1e3 * spent:.2f} ms", "-"))
        rows.append(Row("verdicts alike", f"tolerance {CLOSEST.tolerance:g}", f"{same:.0%}", "-"))
    if spatial_mujoco.installed():
        rows += against_mujoco(hulls, mine)
    else:
        rows.append(Row("the same", "MuJoCo", "skipped: mujoco is not installed", "-"))
    text = [
        "# Speed of bodies on the vertices of their hull",
        "",
        f"{COUNT} random hulls with a motion of their own; CPU time of one core, in one run; made by",
        "`python -m benchmarks hull`.",
        "",
        f"{table.machine()}.",
        f"{table.versions('numpy', 'mujoco')}.",
        "",
        *table.lines(rows),
    ]
    table.keep("RESULTS-hull.md", text)
    return all(row.met is not False for row in rows)


def against_mujoco(hulls: list[Case], mine: dict[float, list[tuple[bool, float]]]) -> list[Row]:
    """Outcomes and CPU time compared with MuJoCo at its required time step."""
    coarse = [peer(case, STEPS[0]) for case in hulls]
    for step, half in pairwise(STEPS):
        fine = [peer(case, half) for case in hulls]
        agree = _alike(coarse, fine)
        against = f"MuJoCo at {1e3 * step:g} ms ({agree:.0%} of verdicts as at half of it)"
        if agree >= AGREE:
            break
        coarse = fine
    rocks = [k for k, (_, share, _) in enumerate(coarse) if share >= MOVES]
    rows = [Row("verdicts alike", against, f"{_alike(coarse, mine[SETTINGS.tolerance]):.0%}", "-")]
    for tolerance, goal in ((SETTINGS.tolerance, GOAL), (CLOSE.tolerance, None)):
        ratio = float(np.median([coarse[k][2] / mine[tolerance][k][1] for k in rocks]))
        name = f"a history that rocks, tolerance {tolerance:g} (median of {len(rocks)})"
        bound = (f">= {goal:.0f} times", ratio >= goal) if goal else ("-",)
        rows.append(Row(name, against, f"{ratio:.1f} times faster", *bound))
    return rows


def _alike(left: list[Any], right: list[Any]) -> float:
    return float(np.mean([a[0] == b[0] for a, b in zip(left, right, strict=True)]))


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
