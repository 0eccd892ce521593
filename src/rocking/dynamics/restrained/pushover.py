"""Quasi-static pushover of a body with restraints: moment as a function of the rotation, monotonic or cyclic."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions
from rocking.answers import Answer, AnswerRows
from rocking.bodies.restrained import Restrained
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.restrained.devices import Device, check_path, devices_of
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
        Path of the rotation theta [rad]. If the given path changes the foot, the upright position occurs twice: with
        the values about the previous foot, and with the values about the next foot.
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

    def __repr__(self) -> str:
        largest = int(np.argmax(np.abs(self.restoring_moment)))
        angles = np.degrees([self.rotation.min(), self.rotation.max()])
        return (
            f"<Pushover: rotation {angles[0]:.4g} to {angles[1]:.4g} deg, largest restoring moment "
            f"{self.restoring_moment[largest]:.4g} N m at {math.degrees(self.rotation[largest]):.4g} deg, "
            f"{self.dissipated.sum():.4g} J dissipated>"
        )

    def answer(self) -> Answer:
        """Return the curves of the pushover, and forces and energy of the restraints, with units.

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

    def plot(self, path: str | Path | None = None) -> "Figure":
        """Draw the moment over the rotation, and the force of every restraint over its elongation.

        Parameters
        ----------
        path : str or Path, optional
            File for the picture: .png, .svg or .pdf.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        RockingError
            If the path has another extension.
        """
        from rocking.plots import pushover_picture, write

        figure = pushover_picture(self)
        if path is not None:
            write(figure, path)
        return figure


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
        between its points. An upright body at the start rests on the foot of the first rotation. If the path changes
        the foot, the result contains the upright position twice, with the moments about both feet.
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
    >>> bool(np.all(np.diff(curve.restoring_moment) > 0.0))  # the tendon exceeds the decrease by gravity
    True
    >>> rk.pushover(wall, [0.05, -0.05]).rotation.tolist()
    [0.05, 0.0, 0.0, -0.05]
    """
    checks.of_kind("restrained", restrained, Restrained, "Restrained(body, restraints)")
    path = np.atleast_1d(checks.real_array("rotation", rotation, "rad"))
    if path.ndim != 1 or not path.size or not np.all(np.abs(path) < 0.5 * math.pi):
        raise InvalidValueError(parameter="rotation", allowed="a row within a quarter turn [rad]", value=path.shape)
    check_path(restrained, *path.tolist())
    devices, body = devices_of(restrained, linear=linear), restrained.body
    angles, sides = _with_upright(path)
    shape = (angles.size, len(devices))
    moment, acceleration = np.zeros(angles.size), np.zeros(angles.size)
    elongation, force, work = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    for k, (angle, side) in enumerate(zip(angles.tolist(), sides.tolist(), strict=True)):
        _drive(devices, side, angle)
        if not angle and (k == 0 or sides[k - 1] != side):
            _lift(devices, side)
        half = body.side("right" if side > 0 else "left", gravity)
        to_top = side * half.slenderness_angle + restrained.floor_slope - angle
        sine, cosine = (to_top, 1.0) if linear else (math.sin(to_top), math.cos(to_top))
        elongation[k], force[k] = [device.elongation for device in devices], [device.force() for device in devices]
        work[k] = [device.work for device in devices]
        held = sum(f * device.levers[side].slope(angle) for f, device in zip(force[k], devices, strict=True))
        moment[k] = half.mass * gravity * half.semi_diagonal * sine + held  # Eq. 355
        acceleration[k] = -moment[k] / (half.mass * half.semi_diagonal * cosine)
    dissipated = np.array([device.dissipated for device in devices])
    return Pushover(restrained, angles, moment, acceleration, elongation, force, work, dissipated)


def _with_upright(path: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the path with the upright position before and after each change of the foot, and the side of each point.

    >>> [values.tolist() for values in _with_upright(np.array([0.0, 0.1, 0.0, -0.1]))]
    [[0.0, 0.1, 0.0, 0.0, -0.1], [1, 1, 1, -1, -1]]
    """
    side = int(next((np.sign(angle) for angle in path if angle), 1))
    points: list[tuple[float, int]] = []
    for angle in path.tolist():
        if angle * side < 0.0:
            if points[-1][0]:
                points.append((0.0, side))
            elif not points[-2][0]:  # the path contains the upright position twice
                points.pop()
            side = -side
            points.append((0.0, side))
        points.append((angle, side))
    angles, sides = zip(*points, strict=True)
    return np.array(angles), np.array(sides)


def _lift(devices: list[Device], side: int) -> None:
    """Choose the phases of all restraints for uplift about a foot."""
    for device in devices:
        if slope := side * device.levers[side].at_rest:
            device.law.settle(device.elongation, 1 if slope > 0.0 else -1)


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
