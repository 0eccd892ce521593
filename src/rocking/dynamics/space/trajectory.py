"""Histories as polynomials between events, states at any times, and what is kept of one while it runs."""

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.space import attitude, complementarity
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.complementarity import ContactSet
from rocking.dynamics.space.settings import SpaceSettings
from rocking.dynamics.taylor import slope, turning_points
from rocking.outcome import ContactMode, Outcome, Status
from rocking.portable import applied, dot, powers, times


class SpatialEventKind(Enum):
    """What happened."""

    UPLIFT = "lifted from rest"
    IMPACT = "impact"
    CHANGE = "change of contact without impact"
    REST = "came to rest"


@dataclass(frozen=True, eq=False, slots=True)
class SpatialEvent:
    """An uplift, an impact, a change of contact or a coming to rest."""

    time: float  # when [s]
    kind: SpatialEventKind  # what
    contact: ContactSet  # on what the body stands from then on
    before: float  # before, after: kinetic energy before and after [J]
    after: float
    # of an impact, vertical: at the vertex, at both ends of the edge, or as `supports` of a face [N s]
    impulses: FloatArray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False, slots=True)
class StepPiece:
    """A step of the engine."""

    start: float  # start, length: when it starts, and the unit of time of its series [s]
    length: float
    until: float  # where it ends, in that unit [-]
    # quaternions, velocities: attitude [-] and angular velocity in body axes [rad/s], coefficients by power; shape
    # (order + 1, 4)
    quaternions: FloatArray
    velocities: FloatArray
    places: FloatArray  # place of the pivot or contact on the ground, coefficients by power [m]; shape (n, 2)
    contact: ContactSet  # on what the body stands

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return self.start + self.until * self.length

    def at(self, share: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return attitude, angular velocity and place of the pivot; at these times (shape (n, 4))."""
        by_power = powers(share, max(len(self.quaternions), len(self.places)))
        made = [times(by_power[:, : len(c)], c) for c in (self.quaternions, self.velocities, self.places)]
        made[0] /= np.linalg.norm(made[0], axis=1)[:, None]
        return made[0], made[1], made[2]


@dataclass(frozen=True, eq=False)
class SpatialTrajectory:
    """A history."""

    pieces: list[StepPiece] = field(repr=False)  # in order of time, without gaps
    events: list[SpatialEvent] = field(repr=False)  # in order of time
    outcome: Outcome  # how it ended
    status: Status  # whether it could be computed
    # peak_tilt, peak_time: largest angle between the axis of the body and the vertical [rad], and when [s]
    peak_tilt: float
    peak_time: float
    # when the centre of mass passed over the contact for the last time; NaN if the body did not overturn [s]
    overturning_time: float
    fell_over: ContactSet | None  # the edge or vertex over which it overturned
    # for how long an end of an edge was held down although the ground would have had to pull there, because its
    # friction kept it from opening: there it slips in truth; or a rim nearly flat, which hops [s]
    held: float
    engine: str  # which engine, and how

    @property
    def impacts(self) -> list[SpatialEvent]:
        return [event for event in self.events if event.kind is SpatialEventKind.IMPACT]

    @property
    def direction(self) -> float:
        """Direction in which it lies, from x towards y; NaN if it did not overturn [rad]."""
        if self.outcome is not Outcome.OVERTURNED:
            return math.nan
        last = self.pieces[-1]
        return float(attitude.azimuth(last.at(np.array([last.until]))[0][0]))


@dataclass(frozen=True, eq=False)
class States:
    """A body at n instants."""

    body: SpatialBody
    quaternion: FloatArray  # attitude (s, x, y, z), body axes to axes of the ground [-]; shape (n, 4)
    body_velocity: FloatArray  # angular velocity in body axes [rad/s]; shape (n, 3)
    pivot: FloatArray  # A point on the ground, in body axes [m]; shape (n, 3)
    place: FloatArray  # the same point on the ground [m]; shape (n, 2)
    contact: IntArray  # number of the regime; shape (n,)

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotation matrices, shape (n, 3, 3) [-]."""
        return attitude.matrix(self.quaternion)

    @cached_property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity in axes of the ground, shape (n, 3) [rad/s]."""
        return applied(self.rotation, self.body_velocity)

    def point(self, point: FloatArray) -> FloatArray:
        """Return where a point of the body is; relative to the ground, which carries the origin along [m]."""
        moved = applied(self.rotation, point - self.pivot)
        moved[:, :2] += self.place
        return np.asarray(moved)

    @property
    def least_gap(self) -> FloatArray:
        """Height of the lowest vertex or point of the rim over the ground; below zero it would be inside [m]."""
        up = self.rotation[:, 2]
        if self.body.round:
            lowest = -self.body.radius * np.sqrt(np.square(up[:, :2]).sum(axis=1))
        else:
            lowest = times(up, self.body.vertices.T).min(axis=1)
        return np.asarray(lowest - (up * self.pivot).sum(axis=1))

    @property
    def centre_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, shape (n, 3) [m/s]."""
        local = attitude.cross(self.body_velocity, self.body.centre - self.pivot)
        return applied(self.rotation, local)

    @property
    def kinetic(self) -> FloatArray:
        """Kinetic energy relative to the ground [J]."""
        spin = (self.body_velocity * times(self.body_velocity, self.body.inertia)).sum(axis=1)
        return np.asarray(0.5 * spin + 0.5 * self.body.mass * np.square(self.centre_velocity).sum(axis=1))

    @property
    def rise(self) -> FloatArray:
        """How much higher the centre of mass is than at rest [m]."""
        up, arm = self.rotation[:, 2], self.body.centre - self.pivot
        sunk = 2.0 * np.square(self.quaternion[:, 1:3]).sum(axis=1)  # 1 - cos(tilt)
        return np.asarray((up[:, :2] * arm[:, :2]).sum(axis=1) - sunk * arm[:, 2])  # Eq. 86


def states_of(body: SpatialBody, trajectory: SpatialTrajectory, time: FloatArray) -> States:
    """Return the states of a history; at an impact, after it."""
    pieces = trajectory.pieces
    starts = np.array([piece.start for piece in pieces])
    place = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(pieces) - 1)
    parts = [np.empty((time.size, k)) for k in (4, 3, 3, 2)]
    modes = np.empty(time.size, dtype=np.int64)
    for k in np.unique(place):
        rows = np.flatnonzero(place == k) if k else place == 0
        piece = pieces[k]
        share = (
            np.clip((time[rows] - piece.start) / piece.length, 0.0, piece.until) if piece.length else 0.0 * time[rows]
        )
        q, w, where = piece.at(share)
        for target, values in zip(parts, (q, w, pivots(body, piece, q), where), strict=True):
            target[rows] = values
        modes[rows] = piece.contact.mode.code
    return States(body, parts[0], parts[1], parts[2], parts[3], modes)


def pivots(body: SpatialBody, piece: StepPiece, quaternions: FloatArray) -> FloatArray:
    """Return points on the ground, in body axes: the pivot, or the lowest points of the rim of a rolling body [m]."""
    if piece.contact.mode is not ContactMode.ROLLING:
        return np.broadcast_to(piece.contact.pivot, (len(quaternions), 3))
    level = attitude.matrix(quaternions)[:, 2, :2]
    low = -body.radius * level / np.linalg.norm(level, axis=1)[:, None]
    return np.column_stack([low, np.zeros(len(low))])


_HALVINGS = 60


class IntegrationState:
    """The record of a history."""

    def __init__(self, body: SpatialBody, settings: SpaceSettings) -> None:
        self.body, self.settings = body, settings
        self.pieces: list[StepPiece] = []
        self.events: list[SpatialEvent] = []
        self.peak, self.peak_time = 0.0, 0.0
        self.held = 0.0
        self.over_time = math.nan
        self.over: ContactSet | None = None

    def add(
        self, piece: StepPiece, until: float, up: FloatArray, pivot: FloatArray, vertical: FloatArray | None = None
    ) -> None:
        """Keep a step, ended at `until` of its length."""
        # vertical: series of the cosine of the tilt, None of a body at rest
        if until > 0.0 or not self.pieces:
            self.pieces.append(replace(piece, until=until))
        if vertical is None:
            return
        self._raise_peak(piece, until, vertical)
        if not _leaning_over(self.body, up, pivot) > 0.0:
            self.over_time, self.over = math.nan, None
        elif math.isnan(self.over_time):
            self.over_time, self.over = self._passing(piece, until), piece.contact

    def ended(
        self, time: float, quaternion: FloatArray, velocity: FloatArray, pivot: FloatArray, final: bool | None
    ) -> tuple[Outcome, Status] | None:
        """Return outcome and status of a history that lies or lacks the energy to overturn; None if it goes on."""
        up = attitude.matrix(quaternion)[2]
        if up[2] <= 0.0:
            self.over_time = time if math.isnan(self.over_time) else self.over_time
            return Outcome.OVERTURNED, Status.GOOD
        if final is False:
            return None
        body, settings = self.body, self.settings
        energy = body.kinetic(pivot, velocity) + body.mass * settings.gravity * complementarity.rise(body, pivot, up)
        inside = not _leaning_over(body, up, pivot) > 0.0
        if final is None or (inside and energy < body.mass * settings.gravity * body.lift):
            return Outcome.ROCKED, Status.GOOD
        return None

    def falls(self, pivot: FloatArray, up: FloatArray) -> Outcome:
        """Return what a loss of contact means: a body whose centre is beyond its support falls."""
        return Outcome.OVERTURNED if _leaning_over(self.body, up, pivot) > 0.0 else Outcome.FAILED

    def trajectory(self, outcome: Outcome, status: Status) -> SpatialTrajectory:
        """Return what was kept."""
        failed, over = outcome is Outcome.FAILED, outcome is Outcome.OVERTURNED
        return SpatialTrajectory(
            pieces=self.pieces,
            events=self.events,
            outcome=outcome,
            status=status,
            peak_tilt=math.nan if failed else 0.5 * math.pi if over else self.peak,
            peak_time=math.nan if failed else self.over_time if over else self.peak_time,
            overturning_time=self.over_time if over else math.nan,
            fell_over=self.over if over else None,
            held=self.held,
            engine=f"reference (Taylor, order up to {self.settings.order}, tolerance {self.settings.tolerance:g})",
        )

    def _raise_peak(self, piece: StepPiece, until: float, vertical: FloatArray) -> None:
        """Tilt at both ends, and where it turns inside."""
        share = [0.0, until]
        terms = vertical.tolist()
        if slope(terms, 0.0) < 0.0 < slope(terms, until):
            share += turning_points(terms, until)
        found = attitude.tilt(piece.at(np.array(share))[0])
        best = int(np.argmax(found))
        if found[best] > self.peak:
            self.peak, self.peak_time = float(found[best]), piece.start + share[best] * piece.length

    def _passing(self, piece: StepPiece, until: float) -> float:
        """When the centre of mass passed over the contact, within a step."""
        low, high = 0.0, until
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            up = attitude.matrix(piece.at(np.array([middle]))[0][0])[2]
            beyond = _leaning_over(self.body, up, complementarity.touching_point(self.body, piece.contact, up)) > 0.0
            low, high = (low, middle) if beyond else (middle, high)
        return piece.start + high * piece.length


def _leaning_over(body: SpatialBody, up: FloatArray, pivot: FloatArray) -> float:
    """Above zero where the centre of mass is beyond the contact, in the direction in which the body leans."""
    arm = body.centre - pivot
    # horizontal parts of arm and axis: a . b - (a . Z)(b . Z)
    return float(arm[2] - dot(up, arm) * up[2])  # Eq. 87
