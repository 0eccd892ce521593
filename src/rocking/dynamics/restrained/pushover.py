"""Quasi-static pushover of a body with restraints: moment as a function of the rotation, monotonic or cyclic."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions
from rocking.answers import Answer, AnswerRows
from rocking.bodies.restrained import Restrained
from rocking.conventions import FloatArray
from rocking.dynamics.restrained.devices import Device, devices_of
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Pushover:
    """Moment of gravity and restraints along a path of rotations, without inertia and viscous forces.

    Parameters
    ----------
    body : Restrained
        The body with its restraints.
    rotation : ndarray
        Path of the rotation theta [rad].
    restoring_moment : ndarray
        Moment about the foot in contact against a positive rotation [N m].
    balancing_acceleration : ndarray
        Ground acceleration in equilibrium with this moment [m/s2].
    elongation, force : ndarray
        Elongation [m] and force [N] of each restraint, shape (rotations, restraints).
    restraint_work : ndarray
        Work done on each restraint [J], shape (rotations, restraints).
    dissipated : ndarray
        Energy dissipated by each restraint at the end [J].
    """

    body: Restrained
    rotation: FloatArray
    restoring_moment: FloatArray
    balancing_acceleration: FloatArray
    elongation: FloatArray
    force: FloatArray
    restraint_work: FloatArray
    dissipated: FloatArray

    def answer(self) -> Answer:
        """Return the results of the pushover.

        Returns
        -------
        Answer
            Rotations, moments and accelerations, and the energy dissipated by each restraint.
        """
        names = ("rotation", "restoring_moment", "balancing_acceleration")
        return Answer({
            "curves": AnswerRows({name: getattr(self, name) for name in names}),
            "restraints": AnswerRows({
                "restraint": [item.name for item in self.body.restraints],
                "dissipated_energy": self.dissipated.tolist(),
                "largest_force": self.force.max(axis=0).tolist(),
                "smallest_force": self.force.min(axis=0).tolist(),
            }),
        })  # fmt: skip

    def plot(self) -> "Figure":
        """Draw the moment, and the force of every restraint, over the rotation.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.
        """
        from rocking.plots import pushover_picture

        return pushover_picture(self)


def pushover(
    restrained: Restrained, rotation: Any, *, gravity: float = conventions.g, linear: bool = False
) -> Pushover:
    """Return the quasi-static moment of a body with restraints along a path of rotations.

    Parameters
    ----------
    restrained : Restrained
        The body with its restraints.
    rotation : array_like
        Path of the rotation theta from the upright body, for example up, back and up again [rad]. The path is monotonic
        between its points. When the rotation changes its sign, the path includes the upright position.
    gravity : float
        Acceleration of gravity [m/s2].
    linear : bool
        True for small rotations, as in `simulate`.

    Returns
    -------
    Pushover
        Moments, forces and energy along the path.

    Raises
    ------
    InvalidValueError
        If the body has another type, or a rotation is not within a quarter turn.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> wall = rk.Restrained(rk.Block(width=1.0, height=6.0, mass=4000.0), rk.Tendon(x=0.5, stiffness=500e3))
    >>> curve = rk.pushover(wall, np.linspace(0.0, 0.05, 6))
    >>> bool(np.all(np.diff(curve.restoring_moment[1:]) > 0.0))  # the tendon exceeds the decrease by gravity
    True
    """
    checks.of_kind("restrained", restrained, Restrained, "Restrained(body, restraints)")
    path = np.atleast_1d(checks.real_array("rotation", rotation, "rad"))
    if path.ndim != 1 or not np.all(np.abs(path) < 0.5 * math.pi):
        raise InvalidValueError(parameter="rotation", allowed="a row within a quarter turn [rad]", value=path.shape)
    devices, body = devices_of(restrained, linear=linear), restrained.body
    shape = (path.size, len(devices))
    moment, acceleration = np.zeros(path.size), np.zeros(path.size)
    elongation, force, work = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    before = 0.0
    for k, angle in enumerate(path.tolist()):
        if before * angle < 0.0:
            _drive(devices, 1 if before > 0.0 else -1, 0.0)
        side = 1 if angle > 0.0 or (angle == 0.0 and before > 0.0) else -1
        _drive(devices, side, angle)
        half = body.side("right" if side > 0 else "left", gravity)
        to_top = side * half.slenderness_angle - angle
        sine, cosine = (to_top, 1.0) if linear else (math.sin(to_top), math.cos(to_top))
        elongation[k], force[k] = [device.elongation for device in devices], [device.force() for device in devices]
        work[k] = [device.work for device in devices]
        held = sum(f * device.levers[side].slope(angle) for f, device in zip(force[k], devices, strict=True))
        moment[k] = half.mass * gravity * half.semi_diagonal * sine + held  # Eq. 355
        acceleration[k] = -moment[k] / (half.mass * half.semi_diagonal * cosine)
        before = angle
    dissipated = np.array([device.dissipated for device in devices])
    return Pushover(restrained, path, moment, acceleration, elongation, force, work, dissipated)


def _drive(devices: list[Device], side: int, angle: float) -> None:
    """Move all restraints to a rotation, including all changes of their phases."""
    for device in devices:
        end = device.levers[side].elongation(angle)
        direction = 1 if end > device.elongation else -1
        if end != device.elongation:
            device.law.settle(device.elongation, direction)
        while not device.law.phase.low <= end <= device.law.phase.high:
            phase = device.law.phase
            device.move(phase.high if direction > 0 else phase.low, 0.0)
            device.law.cross(device.elongation, upwards=direction > 0)
        device.move(end, 0.0)
