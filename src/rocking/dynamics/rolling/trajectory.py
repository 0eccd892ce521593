"""Histories as polynomials between events, states at any time, and record of a history."""

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.rolling import attitude, complementarity
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.complementarity import ContactSet
from rocking.dynamics.rolling.settings import SpaceSettings
from rocking.dynamics.taylor import slope, turning_points
from rocking.outcome import ContactMode, Outcome, Status
from rocking.portable import applied, dot, powers, times


class SpatialEventKind(Enum):
    """Kind of an event of a 3D body."""

    UPLIFT = "lifted from rest"
    IMPACT = "impact"
    CHANGE = "change of contact without impact"
    REST = "came to rest"


@dataclass(frozen=True, eq=False, slots=True)
class SpatialEvent:
    """An uplift, an impact, a change of contact or the start of rest."""

    time: float  # [s]
    kind: SpatialEventKind
    contact: ContactSet  # contact after the event
    before: float  # kinetic energy before and after [J]
    after: float
    # vertical impulses of an impact [N s]: at the vertex, at both ends of the edge, or in the form of `supports`
    impulses: FloatArray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False, slots=True)
class StepPiece:
    """Step of the engine."""

    # start of the step, and unit of time of the series [s]
    start: float
    length: float
    until: float  # end of the step in this unit [-]
    # quaternions, velocities: attitude [-] and angular velocity in body axes [rad/s], coefficients by power; shape
    # (order + 1, 4)
    quaternions: FloatArray
    velocities: FloatArray
    places: FloatArray  # position of the pivot or contact on the ground [m], coefficients by power; shape (n, 2)
    contact: ContactSet

    @property
    def end(self) -> float:
        """End of the step [s]."""
        return self.start + self.until * self.length

    def at(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return attitude (n, 4), angular velocity (n, 3) and position of the pivot (n, 2) at fractions of the unit."""
        by_power = powers(fraction, max(len(self.quaternions), len(self.places)))
        values = [times(by_power[:, : len(c)], c) for c in (self.quaternions, self.velocities, self.places)]
        values[0] /= np.linalg.norm(values[0], axis=1)[:, None]
        return values[0], values[1], values[2]


@dataclass(frozen=True, eq=False)
class SpatialTrajectory:
    """Result of the engine: pieces, events and outcome."""

    pieces: list[StepPiece] = field(repr=False)  # in order of time, without gaps
    events: list[SpatialEvent] = field(repr=False)  # in order of time
    outcome: Outcome
    status: Status
    # largest angle between the axis of the body and the vertical [rad], and its time [s]
    peak_tilt: float
    peak_time: float
    # last passage of the centre of mass over the contact [s]; NaN without overturning
    overturning_time: float
    overturned_over: ContactSet | None  # edge or vertex of overturning
    # total time [s] with a tensile force, at an end of an edge that friction keeps closed (a real end slips) or at a
    # nearly flat rim (a real rim hops)
    held: float
    engine: str  # engine and method

    @property
    def impacts(self) -> list[SpatialEvent]:
        return [event for event in self.events if event.kind is SpatialEventKind.IMPACT]

    @property
    def direction(self) -> float:
        """Direction of overturning, from x towards y; NaN without overturning [rad]."""
        if self.outcome is not Outcome.OVERTURNED:
            return math.nan
        last = self.pieces[-1]
        return float(attitude.azimuth(last.at(np.array([last.until]))[0][0]))


@dataclass(frozen=True, eq=False)
class States:
    """States of a body at n instants."""

    body: SpatialBody
    quaternion: FloatArray  # attitude (s, x, y, z), body axes to axes of the ground [-]; shape (n, 4)
    body_velocity: FloatArray  # angular velocity in body axes [rad/s]; shape (n, 3)
    pivot: FloatArray  # a point on the ground, in body axes [m]; shape (n, 3)
    ground_point: FloatArray  # position of this point on the ground [m]; shape (n, 2)
    contact: IntArray  # code of the regime; shape (n,)

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotation matrices, shape (n, 3, 3) [-]."""
        return attitude.matrix(self.quaternion)

    @cached_property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity in axes of the ground, shape (n, 3) [rad/s]."""
        return applied(self.rotation, self.body_velocity)

    def point(self, point: FloatArray) -> FloatArray:
        """Return the position of a point of the body relative to the ground [m], shape (n, 3)."""
        moved = applied(self.rotation, point - self.pivot)
        moved[:, :2] += self.ground_point
        return np.asarray(moved)

    @property
    def min_gap(self) -> FloatArray:
        """Height of the lowest vertex or point of the rim over the ground [m]; negative for penetration."""
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
        """Rise of the centre of mass above its position at rest [m]."""
        up, arm = self.rotation[:, 2], self.body.centre - self.pivot
        sunk = 2.0 * np.square(self.quaternion[:, 1:3]).sum(axis=1)  # 1 - cos(tilt)
        return np.asarray((up[:, :2] * arm[:, :2]).sum(axis=1) - sunk * arm[:, 2])  # Eq. 86


def states_of(body: SpatialBody, trajectory: SpatialTrajectory, time: FloatArray) -> States:
    """Return the states of a history at times. At an impact, the state after the impact."""
    pieces = trajectory.pieces
    starts = np.array([piece.start for piece in pieces])
    indices = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(pieces) - 1)
    columns = [np.empty((time.size, k)) for k in (4, 3, 3, 2)]
    modes = np.empty(time.size, dtype=np.int64)
    for k in np.unique(indices):
        rows = np.flatnonzero(indices == k) if k else indices == 0
        piece = pieces[k]
        fraction = (
            np.clip((time[rows] - piece.start) / piece.length, 0.0, piece.until) if piece.length else 0.0 * time[rows]
        )
        q, w, positions = piece.at(fraction)
        for target, values in zip(columns, (q, w, pivots(body, piece, q), positions), strict=True):
            target[rows] = values
        modes[rows] = piece.contact.mode.code
    return States(body, columns[0], columns[1], columns[2], columns[3], modes)


def pivots(body: SpatialBody, piece: StepPiece, quaternions: FloatArray) -> FloatArray:
    """Return the contact points in body axes [m]: the pivot, or the lowest points of a rolling rim."""
    if piece.contact.mode is not ContactMode.ROLLING:
        return np.broadcast_to(piece.contact.pivot, (len(quaternions), 3))
    level = attitude.matrix(quaternions)[:, 2, :2]
    low = -body.radius * level / np.linalg.norm(level, axis=1)[:, None]
    return np.column_stack([low, np.zeros(len(low))])


_BISECTIONS = 60


class IntegrationState:
    """Record of a history."""

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
        """Add a step that ends at the fraction `until` of its length."""
        # vertical: series of the cosine of the tilt; None for a body at rest
        if until > 0.0 or not self.pieces:
            self.pieces.append(replace(piece, until=until))
        if vertical is None:
            return
        self._raise_peak(piece, until, vertical)
        if not _beyond_contact(self.body, up, pivot) > 0.0:
            self.over_time, self.over = math.nan, None
        elif math.isnan(self.over_time):
            self.over_time, self.over = self._passing(piece, until), piece.contact

    def ended(
        self, time: float, quaternion: FloatArray, velocity: FloatArray, pivot: FloatArray, final: bool | None
    ) -> tuple[Outcome, Status] | None:
        """Return outcome and status of a body that has fallen or cannot overturn any more; None otherwise."""
        up = attitude.vertical(quaternion)
        if up[2] <= 0.0:
            self.over_time = time if math.isnan(self.over_time) else self.over_time
            return Outcome.OVERTURNED, Status.GOOD
        if final is False:
            return None
        body, settings = self.body, self.settings
        energy = body.kinetic(pivot, velocity) + body.mass * settings.gravity * complementarity.rise(body, pivot, up)
        inside = not _beyond_contact(body, up, pivot) > 0.0
        if final is None or (inside and energy < body.mass * settings.gravity * body.lift):
            return Outcome.ROCKED, Status.GOOD
        return None

    def outcome_of_flight(self, pivot: FloatArray, up: FloatArray) -> Outcome:
        """Return the outcome after a loss of contact: overturning if the centre of mass is beyond the support."""
        return Outcome.OVERTURNED if _beyond_contact(self.body, up, pivot) > 0.0 else Outcome.FAILED

    def trajectory(self, outcome: Outcome, status: Status) -> SpatialTrajectory:
        """Return the result of the engine."""
        failed, over = outcome is Outcome.FAILED, outcome is Outcome.OVERTURNED
        return SpatialTrajectory(
            pieces=self.pieces,
            events=self.events,
            outcome=outcome,
            status=status,
            peak_tilt=math.nan if failed else 0.5 * math.pi if over else self.peak,
            peak_time=math.nan if failed else self.over_time if over else self.peak_time,
            overturning_time=self.over_time if over else math.nan,
            overturned_over=self.over if over else None,
            held=self.held,
            engine=f"reference (Taylor, order up to {self.settings.order}, tolerance {self.settings.tolerance:g})",
        )

    def _raise_peak(self, piece: StepPiece, until: float, vertical: FloatArray) -> None:
        """Update the peak with the tilt at both ends and at turning points of a step."""
        instants = [0.0, until]
        terms = vertical.tolist()
        if slope(terms, 0.0) < 0.0 < slope(terms, until):
            instants += turning_points(terms, until)
        tilts = attitude.tilt(piece.at(np.array(instants))[0])
        index = int(np.argmax(tilts))
        if tilts[index] > self.peak:
            self.peak, self.peak_time = float(tilts[index]), piece.start + instants[index] * piece.length

    def _passing(self, piece: StepPiece, until: float) -> float:
        """Return the time of the passage of the centre of mass over the contact within a step [s]."""
        low, high = 0.0, until
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            up = attitude.vertical(piece.at(np.array([middle]))[0][0])
            beyond = _beyond_contact(self.body, up, complementarity.touching_point(self.body, piece.contact, up)) > 0.0
            low, high = (low, middle) if beyond else (middle, high)
        return piece.start + high * piece.length


def _beyond_contact(body: SpatialBody, up: FloatArray, pivot: FloatArray) -> float:
    """Return a value > 0 if the centre of mass is beyond the contact in the direction of tilt [m]."""
    arm = body.centre - pivot
    # product of the horizontal parts of arm and axis: a . b - (a . Z)(b . Z)
    return float(arm[2] - dot(up, arm) * up[2])  # Eq. 87
