"""The cases in MuJoCo: soft contacts solved as a convex problem, semi-implicit steps."""

from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.spatial_cases import DENSITY, GRAVITY, Case
from benchmarks.spatial_tracks import Track
from rocking.conventions import FloatArray

SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{gravity}" cone="{cone}" impratio="{ratio}" integrator="{integrator}"
          iterations="{iterations}" tolerance="{tolerance}"/>
  <default>
    <geom condim="3" friction="{friction} 0 0" solref="{soft} {damping}" solimp="{stiff} {stiff} 0.001 0.5 2"/>
  </default>
  <worldbody>
    <geom type="plane" size="50 50 1"/>
    <body pos="0 0 {z}"><freejoint/><geom type="box" size="{x} {y} {z}" density="{density}"/></body>
  </worldbody>
</mujoco>
"""


@dataclass(frozen=True)
class Contact:
    """How MuJoCo is run: step [s], impedance, time constant of contacts in steps, friction, solver.

    With the critical damping of its default a corner that lands between two steps hops by a few per cent of its speed;
    with three times as much it stays down.
    """

    step: float = 1e-4
    stiff: float = 0.9999
    steps: float = 4.0
    damping: float = 3.0
    friction: float = 0.8
    ratio: float = 100.0
    cone: str = "elliptic"
    integrator: str = "Euler"
    iterations: int = 100
    tolerance: float = 1e-14

    def at(self, step: float) -> "Contact":
        """The same at another step; contacts stiffen with its inverse square."""
        return replace(self, step=step)


RUNS = (Contact(), Contact(stiff=0.99), Contact(step=5e-5))
"""From which its own error is told; the last one counts."""


def installed() -> bool:
    """Whether it is there."""
    try:
        import_module("mujoco.rollout")
    except ImportError:
        return False
    return True


def scene(size: tuple[float, float, float], contact: Contact) -> Any:
    """A box on a plane."""
    x, y, z = (0.5 * length for length in size)
    values = {**vars(contact), "soft": contact.steps * contact.step, "gravity": GRAVITY, "density": DENSITY}
    return import_module("mujoco").MjModel.from_xml_string(SCENE.format(**values, x=x, y=y, z=z))


def start(model: Any, case: Case) -> FloatArray:
    """State that `rollout` takes: time, place and attitude, velocities."""
    state = np.zeros(1 + model.nq + model.nv)
    state[1:4], state[4:8] = case.centre(), case.quaternion()
    return state


def pushes(model: Any, acceleration: FloatArray) -> FloatArray:
    """Forces on the centre of mass as seen from the ground: a gravity field the other way, shape (n, 6) [N]."""
    forces = np.zeros((len(acceleration), 6))
    forces[:, :3] = -float(model.body_mass[1]) * acceleration
    return forces


def control(push: FloatArray) -> FloatArray:
    """Forces on the box as `rollout` takes them: the row of the world comes before that of the box."""
    return np.concatenate([np.zeros_like(push), push], axis=-1)


def rollout(model: Any, starts: FloatArray, controls: FloatArray) -> FloatArray:
    """States after every step, shape (histories, steps, state); one thread."""
    mujoco = import_module("mujoco")
    result = import_module("mujoco.rollout").rollout(
        model, mujoco.MjData(model), starts, controls, control_spec=int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)
    )
    return np.asarray(result[0])


def run(case: Case, contact: Contact = Contact()) -> Track:
    """One history."""
    model = scene(case.size, contact)
    time = contact.step * np.arange(1.0, round(case.duration / contact.step) + 1.0, dtype=np.float64)
    push = pushes(model, case.acceleration(time - 0.5 * contact.step))
    states = rollout(model, start(model, case)[None], control(push)[None])[0]
    return Track(
        case.body, time, states[:, 4:8], states[:, 11:14], states[:, 1:4], states[:, 8:11], case.acceleration(time)
    )
