"""A body on the vertices of its hull during a history: state, contacts and recorded results."""

import math
from typing import Any, NamedTuple

from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.contact_problem import FLIGHT, HullContact, Solution
from rocking.dynamics.frictional.event_functions import CLOSED, stops_at
from rocking.dynamics.frictional.ground import (
    HullGround,
    Vector,
    added,
    applied,
    cross,
    dot,
    frame,
    length,
    minus,
    scaled,
    unit,
)
from rocking.dynamics.frictional.history import HullEvent, HullEventKind, HullHistory
from rocking.dynamics.frictional.motion import (
    HullMode,
    State,
    slip_speed,
    valued,
)
from rocking.dynamics.frictional.restitution import law_of
from rocking.dynamics.frictional.settings import HullSettings
from rocking.outcome import Outcome, Status

_SLIDES = 1e-4  # speed / sqrt(g size); a slower vertex keeps its initial direction of sliding
_AHEAD = 1e-6  # delay / sqrt(size / g); the ground acceleration after this delay determines the next mode


class _Watched(NamedTuple):
    """State at the end of a step."""

    time: float
    up: Vector  # vertical in body axes [-]
    tilt: float  # cosine of the angle from the initial pose [-]
    rate: float  # rate of this cosine [1/s]


class HullState:
    """State of a history: pose, velocities, contact, and recorded results."""

    def __init__(
        self,
        body: HullBody,
        ground: HullGround,
        restitution: Any = "housner-3d",  # argument of `law_of`
        friction: float = math.inf,  # infinite for vertices that never slide [-]
        settings: HullSettings | None = None,
    ) -> None:
        self.body, self.ground, self.friction = body, ground, friction
        self.restitution, self.settings = restitution, settings or HullSettings()
        self.pace = math.sqrt(ground.gravity / body.size)
        self.speed = ground.gravity / self.pace  # sqrt(g size)
        self.slow = self.settings.rest_speed * self.speed
        stop = stops_at(self.settings.tolerance)
        self.stop, self.slides = stop * self.speed, max(_SLIDES, 2.0 * stop) * self.speed
        # gaps below CLOSED count as closed, and the energy of such a rise as zero
        self.rest = max(self.settings.rest_speed**2, CLOSED)
        self.weak = self.rest * body.mass * ground.gravity * body.size
        self.time, self.stretch = 0.0, 0
        self.length = 0.1 / self.pace  # length of the next step [s]
        self.mode = self._mode(FLIGHT, {})
        self.anchors: dict[int, Vector] = {}
        self.at_once, self.moment = 0, -1.0
        self.changes, self.since, self.gathered = 0, 0.0, -math.inf
        # contacts that ended at this time; True if one of their vertices leaves
        self.over: list[tuple[HullContact, bool]] = []
        self.struck: list[Solution] = []
        self.history = HullHistory()
        self.ended: Status | None = None

    def _start(self, state: State, horizon: float, initial_facet: int | None) -> None:
        """Set the initial state, and the pose from which the body rocks."""
        self.state = state
        self.until = max(horizon, self.ground.motion.end)
        up = frame(state.attitude)[2]
        self.under = self.body.under(up) if initial_facet is None else initial_facet
        self.initial_facet = self.history.initial_facet = self.under
        self.upright = scaled(-1.0, unit(self.body.facets[self.initial_facet]))
        self.watched = _Watched(self.time, up, dot(self.upright, up), 0.0)
        self.law = law_of(self.restitution, self.body, self.initial_facet)

    @property
    def _resting(self) -> bool:
        contact = self.mode.contact
        return len(contact.members) > 2 and len(contact.stuck) == len(contact.members)

    def _touching(self, reach: float = CLOSED) -> tuple[int, ...]:
        axes, position = frame(self.state.attitude), self.state.position
        indices = []
        for i, p in enumerate(self.body.points):
            at = added(position, 1.0, applied(axes, p))
            if at[2] <= reach * self.body.size and self.ground.under(at):
                indices.append(i)
        return tuple(indices)

    def _field(self) -> Vector:
        """Return gravity minus the ground acceleration after a short delay [m/s2]."""
        ahead = _AHEAD / self.pace
        if self.stretch >= self.ground.motion.count:
            return self.ground.weight
        return valued(self.ground.field(self.stretch, self.time, ahead), 1.0)

    def _mode(self, contact: HullContact, starts: dict[int, Vector]) -> HullMode:
        return HullMode(contact, self.friction, starts)

    def _slip(self, i: int) -> float:
        return slip_speed(self.body, self.state, i)

    def _keep(self) -> None:
        history = self.history
        self._watch()
        history.time.append(self.time)
        history.states.append(self.state)
        history.contacts.append(self.mode.contact)

    def _event(self, kind: HullEventKind, energy: float) -> None:
        self.history.events.append(HullEvent(self.time, kind, self.mode.contact, energy, energy))

    def _watch(self) -> None:
        """Record peaks, and the time at which the body leaves its pose.

        The body leaves its pose when the facet under its centre of mass leads to another pose.
        """
        history, axes = self.history, frame(self.state.attitude)
        up, tilt = axes[2], dot(self.upright, axes[2])
        last = _Watched(self.time, up, tilt, -dot(self.upright, cross(self.state.spin, up)))
        peaks = [(tilt, self.time)]
        span = self.time - self.watched.time
        if span > 0.0 and self.watched.rate < 0.0 < last.rate:
            # smallest cosine of the Hermite cubic between both times
            first, second, rise = self.watched.rate * span, last.rate * span, tilt - self.watched.tilt
            cubic, square = first + second - 2.0 * rise, 3.0 * rise - 2.0 * first - second
            slope = square + math.sqrt(max(square * square - 3.0 * cubic * first, 0.0))
            at = min(-first / slope, 1.0) if slope > 0.0 else 1.0
            between = self.watched.tilt + at * (first + at * (square + at * cubic))
            peaks.append((between, self.watched.time + at * span))
        history.min_cosine, history.peak_time = min((history.min_cosine, history.peak_time), *peaks)
        history.peak_spin = max(history.peak_spin, length(self.state.spin))
        under, poses = self.body.under(up), self.body.poses
        if poses[under] != poses[self.under] == poses[self.initial_facet]:
            difference = minus(self.body.facets[self.under], self.body.facets[under])
            before, after = dot(difference, self.watched.up), dot(difference, up)
            fraction = -before / (after - before) if after > before else 1.0
            history.overturning_time = self.watched.time + fraction * span
            x, y, _ = applied(axes, self.upright)
            history.direction = math.atan2(y, x)
        self.under, self.watched = under, last

    def _judged(self) -> HullHistory:
        history = self.history
        history.status = self.ended or Status.GOOD
        history.pose = self.body.poses[self.under]
        if self.ended is not None:
            history.outcome = Outcome.FAILED
        elif history.fell_off or history.pose != self.body.poses[self.initial_facet]:
            history.outcome = Outcome.OVERTURNED
        elif history.flew:
            history.outcome = Outcome.FLEW
        elif history.rocked:
            history.outcome = Outcome.ROCKED_AND_SLID if history.slid else Outcome.ROCKED
        elif history.slid:
            history.outcome = Outcome.SLID
        if history.outcome is Outcome.OVERTURNED:
            history.still_rocking = False
        else:
            history.overturning_time = history.direction = math.nan
        return history
