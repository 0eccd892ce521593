"""How a body of a batch stands at time zero."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space import attitude
from rocking.portable import applied


@dataclass(frozen=True)
class SpatialStart:
    """Initial conditions of a body in space; what is not finite or outside its range gives the row a status.

    Parameters
    ----------
    tilt : float
        How far the body leans [rad].
    azimuth : float
        In which direction, from x towards y [rad].
    yaw : float
        Rotation about the vertical before that [rad].
    angular_velocity : tuple of float
        In axes of the ground [rad/s].

    Examples
    --------
    >>> SpatialStart(tilt=0.1).quaternion.round(4).tolist()
    [0.9988, 0.0, 0.05, 0.0]
    """

    tilt: float = 0.0
    azimuth: float = 0.0
    yaw: float = 0.0
    angular_velocity: Any = (0.0, 0.0, 0.0)

    @property
    def valid(self) -> bool:
        """Whether the numbers are finite and within their ranges."""
        spin = np.asarray(self.angular_velocity, dtype=np.float64)
        numbers = [self.tilt, self.azimuth, self.yaw]
        return bool(
            spin.shape == (3,)
            and np.isfinite(spin).all()
            and all(math.isfinite(value) for value in numbers)
            and 0.0 <= self.tilt < 0.5 * math.pi
        )

    @property
    def quaternion(self) -> FloatArray:
        """Attitude, body axes to axes of the ground, shape (4,) [-]."""
        leaning = attitude.turn([-math.sin(self.azimuth), math.cos(self.azimuth), 0.0], self.tilt)
        return attitude.product(leaning, attitude.turn([0.0, 0.0, 1.0], self.yaw))

    @property
    def body_velocity(self) -> FloatArray:
        """Angular velocity in body axes, shape (3,) [rad/s]."""
        return applied(attitude.matrix(self.quaternion).T, np.asarray(self.angular_velocity, dtype=np.float64))
