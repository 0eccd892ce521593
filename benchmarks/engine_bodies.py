"""General-purpose rigid-body codes on the batch: they simulate contacts, without a rocking model."""

from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.engine_batch import STEP, Histories
from benchmarks.engine_peers import Verdicts
from rocking.conventions import g

SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{g}" cone="elliptic"/>
  <default><geom condim="3" friction="10 0.001 0.0001" solref="{soft} 1" solimp="0.999 0.999 0.001"/></default>
  <worldbody>
    <geom type="plane" size="1000 1000 1"/>
    <body pos="0 0 {h}">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
      <geom type="box" size="{b} {b} {h}" density="1000"/>
    </body>
  </worldbody>
</mujoco>
"""


def mujoco_boxes(batch: Histories, step: float = 1e-3) -> Verdicts:
    """MuJoCo: a box on a plane, held in one plane by its joints; the ground's acceleration as a tilt of gravity."""
    mujoco = import_module("mujoco")
    scenes = []
    for size, alpha in zip(batch.size, batch.alpha, strict=True):
        shape = {"b": size * np.sin(alpha), "h": size * np.cos(alpha)}
        scenes.append(mujoco.MjModel.from_xml_string(SCENE.format(step=step, soft=2.0 * step, g=g, **shape)))

    def one(k: int) -> bool:
        scene, state = scenes[k], mujoco.MjData(scenes[k])
        gravity, rotation = scene.opt.gravity, state.qpos
        for push in _pushes(batch, k, step):
            gravity[0] = -push
            mujoco.mj_step(scene, state)
            if abs(rotation[2]) > 1.5:
                return True
        return bool(abs(rotation[2]) > batch.alpha[k])

    return lambda: np.array([one(k) for k in range(len(batch))])


def pymunk_boxes(batch: Histories, step: float = 1e-3) -> Verdicts:
    """Pymunk (Chipmunk): a polygon on a segment."""
    pymunk = import_module("pymunk")

    def one(k: int) -> bool:
        b, h = batch.size[k] * np.sin(batch.alpha[k]), batch.size[k] * np.cos(batch.alpha[k])
        space: Any = pymunk.Space()
        space.iterations, space.collision_slop = 50, 1e-5 * h
        body = pymunk.Body(1.0, (b * b + h * h) / 3.0)
        body.position = 0.0, h
        box = pymunk.Poly(body, [(-b, -h), (b, -h), (b, h), (-b, h)])
        ground = pymunk.Segment(space.static_body, (-1e3, -1.0), (1e3, -1.0), 1.0)
        box.friction = ground.friction = 10.0
        space.add(body, box, ground)
        for push in _pushes(batch, k, step):
            space.gravity = -push, -g
            space.step(step)
            if abs(body.angle) > 1.5:
                return True
        return bool(abs(body.angle) > batch.alpha[k])

    return lambda: np.array([one(k) for k in range(len(batch))])


def _pushes(batch: Histories, k: int, step: float) -> list[float]:
    """Acceleration in the middle of every step [m/s2]."""
    record = batch.records[k] * batch.scale[k]
    times = STEP * np.arange(record.size)
    values: list[float] = np.interp(np.arange(0.5 * step, times[-1], step), times, record).tolist()
    return values
