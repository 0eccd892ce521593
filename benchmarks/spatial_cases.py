"""Twenty boxes that rock on their corners after a release, a push or under ground motion; for engines and peers."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics import free_rocking, simulate
from rocking.dynamics.rolling import SpatialBody, SpatialResponse, SpatialStart, attitude
from rocking.motions import GroundMotion

GRAVITY = 9.81
STEP = 0.005
DENSITY = 1000.0
Shape = tuple[float, float, float]


@dataclass(frozen=True)
class Case:
    """A box (width, depth, height [m]), its initial state, and its duration.

    The initial tilt is a fraction of the slenderness angle over the corner, towards an azimuth [degrees]. `pulses` are
    the amplitudes of a sine of `period` [s] in x, y and z, as fractions of gravity, y a quarter of a period later.
    """

    name: str
    size: Shape
    lean: float = 0.0
    azimuth: float = 0.0
    pulses: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float = 0.5
    duration: float = 5.0

    @property
    def body(self) -> SpatialBody:
        """The box."""
        return SpatialBody.box(*self.size, density=DENSITY)

    @property
    def tilt(self) -> float:
        """Initial tilt [rad]."""
        width, depth, height = self.size
        return self.lean * math.atan2(math.hypot(width, depth), height)

    @property
    def shaken(self) -> bool:
        """Whether the ground moves."""
        return any(self.pulses)

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Of the ground, shape (n, 3) [m/s2]."""
        components = [np.interp(time, STEP * np.arange(component.size), component) for component in self.samples()]
        return np.column_stack(components)

    def samples(self) -> list[FloatArray]:
        """Components of the acceleration every `STEP` [m/s2]."""
        time = np.arange(0.0, self.duration, STEP)
        components = []
        for amplitude, late in zip(self.pulses, (0.0, 0.25, 0.1), strict=True):
            phase = time / self.period - late
            wave = np.sin(2.0 * np.pi * phase) * ((phase >= 0.0) & (phase <= 1.0))
            components.append(GRAVITY * amplitude * wave)
        return components

    def quaternion(self) -> FloatArray:
        """Attitude at the start (s, x, y, z) [-]."""
        towards = math.radians(self.azimuth)
        return np.asarray(attitude.turn([-math.sin(towards), math.cos(towards), 0.0], self.tilt))

    def centre(self) -> FloatArray:
        """Centre of mass at the start; the lowest corner is at its position before the tilt [m]."""
        body, turned = self.body, attitude.matrix(self.quaternion())
        low = body.vertices[int((body.vertices @ turned[2]).argmin())]
        return np.asarray(low + turned @ (body.centre - low))

    def ours(self, restitution: object = "housner-3d") -> SpatialResponse:
        """Response of this engine."""
        common = {
            "start": SpatialStart(self.tilt, math.radians(self.azimuth)),
            "gravity": GRAVITY,
            "duration": self.duration,
        }
        if not self.shaken:
            return free_rocking(self.body, restitution=restitution, **common)
        x, y, z = (GroundMotion(component, STEP) for component in self.samples())
        return simulate(self.body, {"x": x, "y": y, "z": z}, restitution, **common)


CASES = (
    # corner to corner, and the same a little aside
    Case("square 1:1:4, diagonal", (1.0, 1.0, 4.0), 0.5, 45.0),
    Case("square 1:1:4, 40 degrees", (1.0, 1.0, 4.0), 0.5, 40.0),
    Case("square 1:1:4, 30 degrees", (1.0, 1.0, 4.0), 0.5, 30.0),
    Case("square 1:1:4, 15 degrees", (1.0, 1.0, 4.0), 0.5, 15.0),
    Case("square 1:1:4, high lean", (1.0, 1.0, 4.0), 0.9, 25.0),
    Case("square 1:1:3, 30 degrees", (1.0, 1.0, 3.0), 0.6, 30.0),
    Case("square 1:1:2, 30 degrees", (1.0, 1.0, 2.0), 0.5, 30.0),
    Case("square 1:1:1.5, 20 degrees", (1.0, 1.0, 1.5), 0.5, 20.0),
    Case("small 0.2:0.2:0.8, 30 degrees", (0.2, 0.2, 0.8), 0.5, 30.0, duration=3.0),
    Case("oblong 1:2:4, 30 degrees", (1.0, 2.0, 4.0), 0.4, 30.0),
    Case("oblong 1:2:4, 60 degrees", (1.0, 2.0, 4.0), 0.4, 60.0),
    Case("oblong 0.6:1:3, 50 degrees", (0.6, 1.0, 3.0), 0.5, 50.0),
    Case("slab 0.3:1.2:3, 20 degrees", (0.3, 1.2, 3.0), 0.25, 20.0),
    Case("slender 0.5:0.5:5, 35 degrees", (0.5, 0.5, 5.0), 0.6, 35.0),
    # shaken
    Case("lean and pulse in x", (1.0, 1.0, 4.0), 0.3, 30.0, (0.3, 0.0, 0.0)),
    Case("lean and pulses in x, y", (1.0, 1.0, 4.0), 0.3, 20.0, (0.2, 0.3, 0.0)),
    Case("at rest, pulses in x, y", (1.0, 1.0, 4.0), 0.0, 0.0, (0.45, 0.35, 0.0)),
    Case("at rest, pulses in x, y, z", (0.8, 1.2, 3.6), 0.0, 0.0, (0.4, 0.5, 0.3)),
    Case("felled by pulses in x, y", (0.5, 0.5, 3.0), 0.0, 0.0, (0.5, 0.4, 0.0), 0.9),
    Case("lean and long pulses", (0.6, 0.6, 3.0), 0.5, 30.0, (0.4, 0.2, 0.0), 0.8),
)
