"""Results from a history in 3D of this engine or a peer, by equal rules."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmarks.spatial_cases import GRAVITY, Case
from rocking.conventions import FloatArray
from rocking.dynamics.rolling import SpatialBody, SpatialResponse, attitude

CLEAR, CLOSED = 2e-3, 1e-5  # a vertex has left the ground, has come back: shares of the size of the body
APART = 0.05  # impacts closer than this over p are one landing


@dataclass(frozen=True, eq=False)
class Track:
    """Attitude (s, x, y, z), angular velocity in body axes, centre of mass and its velocity, at times."""

    body: SpatialBody
    time: FloatArray
    quaternion: FloatArray
    spin: FloatArray
    centre: FloatArray
    velocity: FloatArray
    acceleration: FloatArray  # of the ground

    @cached_property
    def tilt(self) -> FloatArray:
        """Angle of the axis with the vertical [rad]."""
        return attitude.tilt(self.quaternion)

    @cached_property
    def up(self) -> FloatArray:
        """Vertical in body axes."""
        return np.asarray(attitude.matrix(self.quaternion)[:, 2])

    @cached_property
    def gaps(self) -> FloatArray:
        """Heights of the vertices over the lowest one [m]."""
        heights = self.up @ self.body.vertices.T
        return np.asarray(heights - heights.min(axis=1)[:, None])

    @cached_property
    def slip(self) -> float:
        """Largest drift of the lowest vertex from its touchdown during flights [m]."""
        turned = attitude.matrix(self.quaternion)
        places = self.centre[:, None, :] + np.einsum("nab,kb->nka", turned, self.body.vertices - self.body.centre)
        low = self.gaps.argmin(axis=1)
        ends = np.flatnonzero(np.diff(low)) + 1
        most = 0.0
        for a, b in zip([0, *ends], [*ends, low.size], strict=True):
            if self.tilt[a:b].max() > 0.01:
                path = places[a:b, low[a], :2]
                most = max(most, float(np.linalg.norm(path - path[0], axis=1).max()))
        return most

    @cached_property
    def potential(self) -> FloatArray:
        """Energy of height [J]."""
        return np.asarray(self.body.mass * GRAVITY * (self.centre[:, 2] - self.body.centre[2]))

    @cached_property
    def kinetic(self) -> FloatArray:
        """Kinetic energy relative to the ground [J]."""
        turning = 0.5 * np.einsum("na,ab,nb->n", self.spin, self.body.inertia, self.spin)
        return np.asarray(turning + 0.5 * self.body.mass * np.square(self.velocity).sum(axis=1))

    @cached_property
    def ledger(self) -> FloatArray:
        """Energy less the work of the ground: only contacts change it [J]."""
        power = -self.body.mass * (self.acceleration * self.velocity).sum(axis=1)
        work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(self.time) * (power[1:] + power[:-1]))])
        return np.asarray(self.kinetic + self.potential - work)

    def first_landing(self) -> float:
        """When a vertex that had left the ground first comes back; NaN if none does [s]."""
        size, earliest = self.body.size, math.inf
        for gap in self.gaps.T:
            clear = np.flatnonzero(gap > CLEAR * size)
            if clear.size:
                back = np.flatnonzero(gap[clear[0] :] < CLOSED * size)
                if back.size:
                    earliest = min(earliest, self._crossing(gap, int(clear[0] + back[0])))
        return earliest if earliest < math.inf else math.nan

    def _crossing(self, gap: FloatArray, k: int) -> float:
        """Time at which a gap closes, going on as before the sample at which it is seen closed [s]."""
        before, step = float(self.time[k - 1]), float(self.time[k] - self.time[k - 1])
        closing = gap[k - 2] - gap[k - 1]
        share = gap[k - 1] / closing if closing > 0.0 else 1.0
        return before + step * float(min(share, 2.0))

    def at(self, values: FloatArray, time: float) -> float:
        """A value between samples."""
        return float(np.interp(time, self.time, values))


@dataclass(frozen=True)
class Windows:
    """When to read energies: in the flights after the first and after the third landing of our history [s]."""

    first: float
    third: float


@dataclass(frozen=True)
class Measures:
    """Compared results.

    Time of the first landing [s], kinetic energy after it over that before it [-], peak tilt after it [degrees], energy
    loss of contacts up to the flight after the third landing over the overturning energy [-], outcome, direction of the
    largest tilt after the first landing, or of overturning [degrees], and slip of the pivot [mm].
    """

    landing: float
    kept: float
    peak: float
    lost: float
    fell: bool
    direction: float
    slip: float


def track_of(case: Case, response: SpatialResponse, step: float = 1e-4) -> Track:
    """Samples of our history, as a peer would give them."""
    time = np.arange(0.0, response.end, step)
    states = response.at(time)
    return Track(
        response.body,
        time,
        states.quaternion,
        states.body_velocity,
        states.point(response.body.centre),
        states.centre_velocity,
        case.acceleration(time),
    )


def windows(response: SpatialResponse) -> Windows:
    """Middles of the flights after landings; impacts close together, as of neighbouring corners, are one landing."""
    times = response.impacts["time"]
    apart = APART / response.body.frequency(GRAVITY)
    lasts = np.flatnonzero(np.diff(times, append=response.end) > apart)
    middles = [0.5 * (times[k] + (times[k + 1] if k + 1 < times.size else response.end)) for k in lasts]
    end = response.end
    return Windows(middles[0] if middles else end, middles[2] if len(middles) > 2 else end)


def measured(track: Track, when: Windows) -> Measures:
    """Return the results of a history."""
    body, landing = track.body, track.first_landing()
    overturned = bool(track.tilt[-1] > 1.0)
    after = (track.time > when.first) if math.isfinite(landing) else track.time >= 0.0
    peak_index = int(np.where(after, track.tilt, 0.0).argmax())
    direction = attitude.azimuth(track.quaternion[[peak_index]])[0]
    just = landing - 2.0 * (track.time[1] - track.time[0])
    spent = track.at(track.ledger, just) - track.at(track.ledger, when.first)
    kept = 1.0 - spent / track.at(track.kinetic, just)
    lost = (track.ledger[0] - track.at(track.ledger, when.third)) / (body.mass * GRAVITY * body.lift)
    return Measures(
        landing,
        kept,
        90.0 if overturned else math.degrees(track.tilt[peak_index]),
        float(lost),
        overturned,
        math.degrees(direction),
        1e3 * track.slip,
    )
