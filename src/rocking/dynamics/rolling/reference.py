"""The 3D reference engine: Taylor steps, event times exact to rounding, contact by complementarity."""

import math
from collections.abc import Iterable

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.rolling import attitude, complementarity, event_functions, rolling
from rocking.dynamics.rolling.attitude import cross
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.complementarity import ContactSet, Continuation, SpatialState, of_forces
from rocking.dynamics.rolling.event_functions import Step
from rocking.dynamics.rolling.ground import SpatialGround
from rocking.dynamics.rolling.impact_laws import SpatialImpactLaw
from rocking.dynamics.rolling.impact_resolution import CLOSED, laid_down, landed, rim_landed, settled, started, stuck
from rocking.dynamics.rolling.rolling import RollingFlow
from rocking.dynamics.rolling.settings import SpaceSettings
from rocking.dynamics.rolling.trajectory import (
    IntegrationState,
    SpatialEvent,
    SpatialEventKind,
    SpatialTrajectory,
    StepPiece,
)
from rocking.outcome import ContactMode, Outcome, Status
from rocking.portable import applied, norm

_PULL = 1e-9
_STUCK, _PILED = 100, 60
_PATIENCE, _MAX_LATE_STEPS = 300.0, 10_000  # limits after the end of a history: p x time, and number of steps


Ending = tuple[Outcome, Status] | None  # end of a history; None before the end


class SpatialReference:
    """Reference engine of one history."""

    def __init__(
        self, body: SpatialBody, ground: SpatialGround, law: SpatialImpactLaw, settings: SpaceSettings
    ) -> None:
        self.body, self.ground, self.law, self.settings = body, ground, law, settings
        self.p = body.frequency(settings.gravity)
        self.slow = settings.rest_speed * math.sqrt(settings.gravity * body.size)
        self.weak = settings.rest_speed**2 * body.mass * settings.gravity * body.lift
        self.pull = _PULL * settings.gravity
        self.flows: dict[tuple[ContactMode, tuple[int, ...]], rolling.PivotFlow] = {}
        self.rolling = RollingFlow(body)
        self.time, self.stretch = 0.0, 0
        self.ground_point = np.zeros(2)
        self.touching: tuple[int, ...] = ()
        self.at_once, self.moment = 0, -1.0  # number of consecutive events at one time, and this time
        self.late = 0  # number of steps after the end
        self.landing = False  # True while a round base falls flat
        self.sticks = False  # True after an accumulation of impacts on this edge; its ends are then not released

    # ---- the course of a history ------------------------------------------------------------------------------------

    def run(self, quaternion: FloatArray, velocity: FloatArray, horizon: float) -> SpatialTrajectory:
        """Return the history from an attitude on the ground."""
        # horizon: duration [s]; extended if the outcome is not yet determined
        self.horizon = horizon
        self.integration_state = IntegrationState(self.body, self.settings)
        self.quaternion, self.velocity = attitude.normalised(quaternion), velocity
        self._start()
        ended: Ending = None
        while ended is None:
            ended = self._rest() if self.contact.mode is ContactMode.REST else self._move()
        return self.integration_state.trajectory(*ended)

    def _start(self) -> None:
        contact, touching = started(self.body, self.velocity, self._up)
        self.contact = contact
        # the body is tilted from the upright position, in which the origins of base and ground coincide
        self.ground_point = applied(attitude.matrix(attitude.flat(self.quaternion)), contact.pivot)[:2]
        if contact.mode is ContactMode.REST or len(touching) == len(self.body.vertices) > 0:
            self.quaternion = attitude.flat(self.quaternion)
        self.touching = tuple(i for i in touching if i not in contact.points)
        if self.touching and not np.any(self.velocity):
            continuations = of_forces(self.body, self._state(), touching, self.contact)
            if continuations:
                self._stand(continuations[0].contact, touching)
        if self.contact.mode is not ContactMode.REST:
            self._note(SpatialEventKind.UPLIFT, 0.0, self._kinetic())

    def _rest(self) -> Ending:
        """Keep the body at rest until the next uplift, or to the end."""
        self.velocity = np.zeros(3)
        rotation = attitude.matrix(self.quaternion)
        tau = 0.0
        if self.stretch < self.ground.count:
            begin, end = self.ground.times[self.stretch : self.stretch + 2]
            tau = (self.time - begin) / (end - begin)
        position = self.stretch, tau
        uplift = event_functions.next_uplift(self.body, self.ground, rotation, self.settings.gravity, position)
        if uplift is None:
            self._add_rest(max(self.horizon, self.ground.end, self.time))
            return Outcome.ROCKED if self.integration_state.events else Outcome.NO_UPLIFT, Status.GOOD
        self.stretch, tau, edges = uplift
        begin, end = self.ground.times[self.stretch : self.stretch + 2]
        self._add_rest(max(float(begin + tau * (end - begin)), self.time))
        lifted = event_functions.lifted(self.body, self._state(), edges)
        if lifted is None:
            return Outcome.FAILED, Status.LOST_CONTACT
        self._stand(lifted, range(len(self.body.vertices)))
        self._note(SpatialEventKind.UPLIFT, 0.0, 0.0)
        return self._guard()

    def _move(self) -> Ending:
        """Advance to the end of the step, or to an earlier event."""
        step, piece, is_last = self._step()
        self.late += self._final is not False
        if step is None or piece is None:
            return Outcome.FAILED, Status.NOT_FINITE
        landing = event_functions.first_contact(self.body, self.contact, step, self.touching)
        forces = event_functions.vertical_forces(self.body, self.contact, step)
        release = event_functions.first_release(self.body, self.contact, step, forces)
        rim_event = None
        if self.body.round:
            rim_event = event_functions.rim_events(self.body, self.contact, step, landing=self.landing)
        is_held = False  # True if contact persists in spite of a tensile force
        if release is not None:
            nearly_flat = event_functions.nearly_flat(self.body, rolling.value(step.up, release[0]))
            is_held = self.sticks if release[1] >= 0 else nearly_flat
        release = None if is_held else release
        self.sticks &= is_held
        arrival = min(
            [1.0, *(e[0] for e in (landing, release) if e is not None), *([] if rim_event is None else [rim_event])]
        )
        self._arrive(piece, arrival, step.up[:, 2], is_last=is_last and arrival == 1.0)
        if self._up[2] <= 0.0:  # the body has fallen before any other event
            return self._ended()
        if landing is not None and landing[0] == arrival:
            return self._impact(landing[1])
        if rim_event is not None and rim_event == arrival:
            return self._rim()
        if release is not None and release[0] == arrival:
            return self._released(release[1])
        return self._stepped(step, arrival, forces, held=is_held)

    def _stepped(self, step: Step, at: float, forces: event_functions.Forces, *, held: bool) -> Ending:
        """Check the state at the end of a step without an event."""
        pulls = self.contact.mode is ContactMode.EDGE
        pulls = pulls and min(event_functions.end_forces(forces, at)) < -self.pull
        self.integration_state.held += step.length if pulls or held else 0.0
        self.touching = ()
        if self.body.round and event_functions.nearly_flat(self.body, self._up) and self._weak:
            flat = laid_down(self.body, self._state())
            if flat is not None:
                return self._land(flat, ())
        return self._ended()

    # ---- a step -----------------------------------------------------------------------------------------------------

    def _step(self) -> tuple[Step | None, StepPiece | None, bool]:
        rate = self.p + norm(self.velocity)
        if self.contact.mode is ContactMode.ROLLING:
            up = self._up
            # at most half of the fall to the flat position, near which the contact moves fast around the rim
            rate += 2.0 * norm(cross(up, self.velocity)[:2]) / norm(up[:2])
        length, is_last = self.settings.longest_step / rate, False
        if self.stretch < self.ground.count:
            remaining = float(self.ground.times[self.stretch + 1]) - self.time
            length, is_last = min(length, remaining), length >= remaining
        elif self.time < self.horizon:
            length = min(length, self.horizon - self.time)
        field = -self.ground.segment(self.stretch, self.time, length)
        field[2, 0] -= self.settings.gravity
        order = min(max(rolling.terms_needed(1.5 * rate * length, 40), field.shape[1] + 2), self.settings.order)
        places = self.ground_point[None, :]
        if self.contact.mode is ContactMode.ROLLING:
            state = self.quaternion, self.velocity, self.ground_point
            q, w, up, places = self.rolling.series(state, length, field, order)
        else:
            q, w, up = self._flow().series(self.quaternion, self.velocity, length, field, order)
        fraction = rolling.trusted_part(q, w, length, self.settings.tolerance)
        if not fraction > 0.0:
            return None, None, False
        q, w, up, places = (rolling.stretched(c, fraction) for c in (q, w, up, places))
        field = rolling.stretched(field.T, fraction).T
        heading = (
            np.zeros(3) if self.contact.axis is None else applied(attitude.matrix(self.quaternion), self.contact.axis)
        )
        step = Step(length * fraction, w, up, field, heading)
        return (
            step,
            StepPiece(self.time, length * fraction, 1.0, q, w, places, self.contact),
            is_last and fraction == 1.0,
        )

    def _flow(self) -> rolling.PivotFlow:
        key = self.contact.mode, self.contact.points
        if not self.contact.points:
            return rolling.PivotFlow(self.body, self.contact.pivot)
        if key not in self.flows:
            self.flows[key] = rolling.PivotFlow(self.body, self.contact.pivot, self.contact.axis)
        return self.flows[key]

    def _arrive(self, piece: StepPiece, at: float, vertical: FloatArray, *, is_last: bool) -> None:
        self.quaternion = attitude.normalised(rolling.value(piece.quaternions, at))
        self.velocity = rolling.value(piece.velocities, at)
        self.ground_point = rolling.value(piece.places, at)
        self.integration_state.add(piece, at, self._up, self._pivot, vertical)
        self.time = piece.start + at * piece.length
        if is_last:
            self.stretch += 1
            self.time = float(self.ground.times[self.stretch])

    def _add_rest(self, until: float) -> None:
        rows = self.quaternion[None], np.zeros((1, 3)), self.ground_point[None]
        self.integration_state.add(
            StepPiece(self.time, until - self.time, 1.0, *rows, self.contact), 1.0, self._up, self._pivot
        )
        self.time = until

    # ---- events -----------------------------------------------------------------------------------------------------

    def _impact(self, vertex: int) -> Ending:
        body = self.body
        arms = body.vertices - self.contact.pivot
        gaps, rates = applied(arms, self._up), applied(cross(self.velocity, arms), self._up)
        closed = {vertex, *self.contact.points, *np.flatnonzero(gaps <= CLOSED * body.size).tolist()}
        near = gaps.max() <= event_functions.FLAT * body.size
        flat = near and rates.max() <= CLOSED * body.size * norm(self.velocity)  # Eq. 328
        if self.contact.mode is ContactMode.EDGE or len(closed) > 2 or flat:
            closed = set(range(len(body.vertices)))
        touching, height = tuple(sorted(closed)), 0.0
        if len(touching) == len(body.vertices):
            height = self._potential()
            self.quaternion = attitude.flat(self.quaternion)
        piled = self.at_once > _PILED
        choice = stuck(body, self._state(), touching) if piled else landed(body, self._state(), touching, self.law)
        return self._land(choice, touching, height, piled=piled)

    def _rim(self) -> Ending:
        up = self._up
        rolls, sine = self.contact.mode is ContactMode.ROLLING, math.hypot(up[0], up[1])
        if not rolls and sine > (event_functions.LANDING if self.landing else 0.5 * event_functions.START_ROLLING):
            self.contact, self.landing = complementarity.rolling(self.contact), False
            return self._guard()
        if rolls and sine > 0.5 * event_functions.LANDING:
            direction = event_functions.lands_flat(up, self.velocity)
            if direction is not None:
                self._stand(complementarity.rim(self.body, direction))
                self.landing = True
            return self._guard()
        self.landing = False
        state = self._state()
        if rolls:
            self.contact = complementarity.rim(self.body, state.pivot[:2])  # nearly flat base: fixed contact point
            return self._guard()
        self.quaternion = attitude.flat(self.quaternion)
        return self._land(rim_landed(self.body, state, self.law), ())

    def _land(
        self, choice: Continuation, touching: tuple[int, ...], height: float = 0.0, *, piled: bool = False
    ) -> Ending:
        """Continue after an impact. `height` is the potential energy lost when the base becomes flat [J]."""
        before = self._kinetic() + (self._potential() if self.contact.mode is ContactMode.ROLLING else height)
        self._stand(choice.contact)
        self.velocity = choice.velocity
        if piled:
            self.sticks, touching = choice.contact.mode is ContactMode.EDGE, ()
        else:
            choice = settled(self.body, self._state(), choice, touching, self.slow, weak=self._weak)
        self._stand(choice.contact, touching)
        self.velocity = choice.velocity
        self._note(SpatialEventKind.IMPACT, before, self._kinetic(), choice.supports)
        if choice.contact.mode is ContactMode.REST and not piled:
            self._note(SpatialEventKind.REST, 0.0, 0.0)
        return self._guard()

    def _released(self, end_index: int) -> Ending:
        if end_index < 0:
            return self.integration_state.outcome_of_flight(self._pivot, self._up), Status.LOST_CONTACT
        stays, leaves = self.contact.points[1 - end_index], self.contact.points[end_index]
        self._stand(complementarity.vertex(self.body, stays), (leaves,))
        energy = self._kinetic()
        self._note(SpatialEventKind.CHANGE, energy, energy)
        return self._guard()

    def _note(self, kind: SpatialEventKind, before: float, after: float, impulses: FloatArray | None = None) -> None:
        pushes = np.zeros(0) if impulses is None else impulses
        self.integration_state.events.append(SpatialEvent(self.time, kind, self.contact, before, after, pushes))

    def _guard(self) -> Ending:
        self.at_once = self.at_once + 1 if self.time <= self.moment else 0
        self.moment = self.time
        if self.at_once > _STUCK or len(self.integration_state.events) > self.settings.most_events:
            return Outcome.FAILED, Status.TOO_MANY_EVENTS
        # a base with many vertices may have no step without impact; therefore, the outcome is also checked here
        if self._final is False or self.contact.mode is ContactMode.REST:
            return None
        return self._ended()

    def _ended(self) -> Ending:
        return self.integration_state.ended(self.time, self.quaternion, self.velocity, self._pivot, self._final)

    # ---- details --------------------------------------------------------------------------------------------------

    def _stand(self, contact: ContactSet, touching: Iterable[int] = ()) -> None:
        """Change the contact: move the pivot, correct rounding of the attitude, store the other touching points."""
        rotation = attitude.matrix(self.quaternion)
        self.ground_point = self.ground_point + applied(rotation, contact.pivot - self._pivot)[:2]
        if contact.mode is ContactMode.REST:
            self.quaternion = attitude.flat(self.quaternion)
        elif contact.axis is not None:
            self.quaternion = attitude.levelled(self.quaternion, contact.axis)
        self.contact = contact
        self.touching = tuple(i for i in touching if i not in contact.points)

    @property
    def _up(self) -> FloatArray:
        return attitude.vertical(self.quaternion)

    @property
    def _pivot(self) -> FloatArray:
        return complementarity.touching_point(self.body, self.contact, self._up)

    @property
    def _final(self) -> bool | None:
        """True after the end of the motion; None after the longest allowed extension."""
        end = max(self.horizon, self.ground.end)
        if self.time > end + _PATIENCE / self.p or self.late > _MAX_LATE_STEPS:
            return None
        return self.time >= end

    def _state(self) -> SpatialState:
        field = -self.ground.segment(self.stretch, self.time, 1.0)[:, 0]
        field[2] -= self.settings.gravity
        axis, rotation = self.contact.axis, attitude.matrix(self.quaternion)
        along = np.zeros(3) if axis is None else self.contact.length * axis
        return SpatialState(self._pivot, self.velocity, self._up, applied(rotation.T, field), along)

    def _kinetic(self) -> float:
        return self.body.kinetic(self._pivot, self.velocity)

    def _potential(self) -> float:
        return self.body.mass * self.settings.gravity * complementarity.rise(self.body, self._pivot, self._up)

    @property
    def _weak(self) -> bool:
        """True if the energy is negligible. The absolute value is used, so that a falling body is excluded."""
        return self._kinetic() + abs(self._potential()) < self.weak
