"""The cases in Bullet: rigid contacts by sequential impulses, once a step."""

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.spatial_cases import GRAVITY, Case
from benchmarks.spatial_tracks import Track
from rocking.conventions import FloatArray


@dataclass(frozen=True)
class Rules:
    """Settings of Bullet: time step [s], friction, solver iterations, corrected fraction of penetration."""

    step: float = 1e-4
    friction: float = 20.0
    iterations: int = 300
    recovery: float = 0.0


RUNS = (Rules(step=2e-4), Rules(), Rules(step=5e-5))
"""From which its own error is told; the last one counts."""


def installed() -> bool:
    """Whether it is there."""
    try:
        import_module("pybullet")
    except ImportError:
        return False
    return True


def run(case: Case, rules: Rules = Rules()) -> Track:
    """One history."""
    bullet = import_module("pybullet")
    client = bullet.connect(bullet.DIRECT)
    try:
        box = _scene(bullet, case, rules)
        time = rules.step * np.arange(1.0, round(case.duration / rules.step) + 1.0, dtype=np.float64)
        fields = -case.acceleration(time - 0.5 * rules.step)
        fields[:, 2] -= GRAVITY
        states = np.array([_step(bullet, box, field) for field in fields.tolist()])
    finally:
        bullet.disconnect(client)
    return _track(case, time, states)


def _scene(bullet: Any, case: Case, rules: Rules) -> int:
    """Return a box on a large flat box, with a new contact manifold at every time step."""
    bullet.setPhysicsEngineParameter(
        fixedTimeStep=rules.step,
        numSolverIterations=rules.iterations,
        numSubSteps=0,
        contactERP=rules.recovery,
        erp=rules.recovery,
        frictionERP=0.0,
        enableConeFriction=1,
        restitutionVelocityThreshold=0.0,
        solverResidualThreshold=1e-16,
        contactSlop=0.0,
        allowedCcdPenetration=0.0,
    )
    ground = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[50.0, 50.0, 1.0])
    floor = bullet.createMultiBody(0.0, ground, basePosition=[0.0, 0.0, -1.0])
    shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[0.5 * body for body in case.size])
    s, x, y, z = case.quaternion().tolist()
    box = int(bullet.createMultiBody(case.body.mass, shape, -1, case.centre().tolist(), [x, y, z, s]))
    bullet.changeDynamics(box, -1, localInertiaDiagonal=np.diag(case.body.inertia).tolist())
    for body in (floor, box):
        bullet.changeDynamics(
            body,
            -1,
            lateralFriction=rules.friction if body == box else 1.0,
            restitution=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            rollingFriction=0.0,
            spinningFriction=0.0,
        )
    bullet.changeDynamics(box, -1, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING)
    return box


def _step(bullet: Any, box: int, field: list[float]) -> tuple[float, ...]:
    bullet.setGravity(*field)
    bullet.stepSimulation()
    position, attitude = bullet.getBasePositionAndOrientation(box)
    velocity, spin = bullet.getBaseVelocity(box)
    return (*position, *attitude, *velocity, *spin)


def _track(case: Case, time: FloatArray, states: FloatArray) -> Track:
    from rocking.dynamics.rolling import attitude

    quaternion = states[:, [6, 3, 4, 5]]
    quaternion /= np.linalg.norm(quaternion, axis=1)[:, None]
    spin = np.einsum("nab,na->nb", attitude.matrix(quaternion), states[:, 10:13])
    return Track(case.body, time, quaternion, spin, states[:, :3], states[:, 7:10], case.acceleration(time))
