"""The reference engine of a body on the vertices of its hull: steps, events to rounding, contact by complementarity."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product as product_of
from typing import Any, NamedTuple

from rocking.dynamics.hull import contact_problem as contacts
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.contact_problem import FLIGHT, HullContact, Problem, Solution
from rocking.dynamics.hull.event_functions import CLOSED, HALVINGS, EventFunctions, stops_at
from rocking.dynamics.hull.ground import (
    ZERO,
    HullGround,
    Vector,
    added,
    applied,
    back,
    cross,
    dot,
    frame,
    length,
    minus,
    scaled,
    unit,
)
from rocking.dynamics.hull.history import HullEvent, HullEventKind, HullHistory
from rocking.dynamics.hull.motion import (
    HullMode,
    State,
    StepResult,
    energies,
    levelled,
    point_velocity,
    problem_of,
    sliding,
    slip_speed,
    step,
    valued,
)
from rocking.dynamics.hull.restitution import law_of, nearest, place_of
from rocking.dynamics.hull.settings import HullSettings
from rocking.outcome import Outcome, Status

_SLIDES = 1e-4  # speed over sqrt(g size) below which a vertex still slides as it started, if not below twice a stop
_STRIKES = 5e-10  # speed over sqrt(g size) from which a history begins with an impact
_LADDER = (1e-11, 1e-9, 1e-7, 1e-5)
_AHEAD = 1e-6  # how much later, over sqrt(size / g), the ground decides which mode starts
_PILED, _STUCK = 30, 200
_FLAT = 1e-6  # gaps over the size, below all of which a facet lands with all its corners
_CROWD, _CROWDED = 12, 1e-2  # changes of contact, and the time over sqrt(size / g) within which they are too many
# what they close in on: gaps over the size, and speeds over sqrt(g size) away from the ground
_GATHERED, _GATHERING = 1e-7, 1e-4
_PATIENCE = 100.0
_PATH = (1.0 / 12.0, 10.0 / 21.0, 5.0 / 12.0, 1.0 / 42.0)


class _Watched(NamedTuple):
    """The end of a step."""

    time: float
    up: Vector  # in axes of the body
    tilt: float  # cosine of the angle from the pose at the beginning
    rate: float  # of that [1/s]


class HullEngine:
    """The reference engine; one object follows one history.

    >>> from rocking.bodies.solid import Solid, box
    >>> from rocking.dynamics.hull.motion import standing
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> HullEngine(body, HullGround(slope=0.2)).run(standing(body), 0.1).outcome.value
    'stayed at rest: the ground never lifted it'
    """

    def __init__(
        self,
        body: HullBody,
        ground: HullGround,
        restitution: Any = "housner-3d",  # as `law_of` takes it
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
        # gaps below CLOSED are none, nor is the energy that lifts the body by less
        self.rest = max(self.settings.rest_speed**2, CLOSED)
        self.weak = self.rest * body.mass * ground.gravity * body.size
        self.time, self.stretch = 0.0, 0
        self.length = 0.1 / self.pace  # of the next step
        self.mode = self._mode(FLIGHT, {})
        self.anchors: dict[int, Vector] = {}
        self.at_once, self.moment = 0, -1.0
        self.changes, self.since, self.gathered = 0, 0.0, -math.inf
        self.over: list[tuple[HullContact, bool]] = []  # what has ended at this moment, and whether a vertex leaves
        self.struck: list[Solution] = []
        self.history = HullHistory()
        self.ended: Status | None = None

    # ---- the course of a history ------------------------------------------------------------------------------------

    def run(self, state: State, horizon: float = 0.0, stood: int | None = None) -> HullHistory:
        """Return the history from a state; it ends at rest after the motion and the horizon, or when patience ends.

        stood: facet on which the body stood before it was tilted; if not given, that under its centre of mass.
        """
        self.state = state
        self.until = max(horizon, self.ground.motion.end)
        up = frame(state.attitude)[2]
        self.stood = self.under = self.history.stood = self.body.under(up) if stood is None else stood
        self.upright = scaled(-1.0, unit(self.body.facets[self.stood]))
        self.watched = _Watched(self.time, up, dot(self.upright, up), 0.0)
        self.law = law_of(self.restitution, self.body, self.stood)
        if any(point_velocity(self.body, state, i)[2] < -_STRIKES * self.speed for i in self._touching()):
            self._impact()
        else:
            self._choose(self._touching())
        self._keep()
        while self.ended is None and not self._over():
            if self._resting:
                self._rest()
            else:
                self._step()
        return self._judged()

    @property
    def _resting(self) -> bool:
        contact = self.mode.contact
        return len(contact.members) > 2 and len(contact.stuck) == len(contact.members)

    def _over(self) -> bool:
        if self.state.place[2] < -2.0 * self.body.size:
            self.history.fell = True
            return True
        if self.time < self.until:
            return False
        if self._resting:
            return True
        self.history.still_rocking = self.time > self.until + _PATIENCE / self.pace
        return self.history.still_rocking

    def _judged(self) -> HullHistory:
        made = self.history
        made.status = self.ended or Status.GOOD
        made.pose = self.body.poses[self.under]
        if self.ended is not None:
            made.outcome = Outcome.FAILED
        elif made.fell or made.pose != self.body.poses[self.stood]:
            made.outcome = Outcome.OVERTURNED
        elif made.flew:
            made.outcome = Outcome.FLEW
        elif made.rocked:
            made.outcome = Outcome.ROCKED_AND_SLID if made.slid else Outcome.ROCKED
        elif made.slid:
            made.outcome = Outcome.SLID
        if made.outcome is Outcome.OVERTURNED:
            made.still_rocking = False
        else:
            made.overturning_time = made.direction = math.nan
        return made

    def _watch(self) -> None:
        """Note peaks, and when the vertical through the centre of mass leaves a facet that leads to the first pose."""
        made, axes = self.history, frame(self.state.attitude)
        up, tilt = axes[2], dot(self.upright, axes[2])
        last = _Watched(self.time, up, tilt, -dot(self.upright, cross(self.state.spin, up)))
        peaks = [(tilt, self.time)]
        span = self.time - self.watched.time
        if span > 0.0 and self.watched.rate < 0.0 < last.rate:
            # the least cosine of Hermite's cubic
            first, second, rise = self.watched.rate * span, last.rate * span, tilt - self.watched.tilt
            cubic, square = first + second - 2.0 * rise, 3.0 * rise - 2.0 * first - second
            slope = square + math.sqrt(max(square * square - 3.0 * cubic * first, 0.0))
            at = min(-first / slope, 1.0) if slope > 0.0 else 1.0
            between = self.watched.tilt + at * (first + at * (square + at * cubic))
            peaks.append((between, self.watched.time + at * span))
        made.least_cosine, made.peak_time = min((made.least_cosine, made.peak_time), *peaks)
        made.peak_spin = max(made.peak_spin, length(self.state.spin))
        under, poses = self.body.under(up), self.body.poses
        if poses[under] != poses[self.under] == poses[self.stood]:
            apart = minus(self.body.facets[self.under], self.body.facets[under])
            before, after = dot(apart, self.watched.up), dot(apart, up)
            share = -before / (after - before) if after > before else 1.0
            made.overturning_time = self.watched.time + share * span
            x, y, _ = applied(axes, self.upright)
            made.direction = math.atan2(y, x)
        self.under, self.watched = under, last

    def _slide(self, result: StepResult, span: float) -> None:
        """Add the path of the vertex that slides most: exact for cubics at the four stages that are kept."""
        loose = [i for i in self.mode.contact.members if i not in self.mode.contact.stuck]
        paths = [
            sum(w * slip_speed(self.body, s, i) for w, (_, s, _) in zip(_PATH, result.samples, strict=True))
            for i in loose
        ]
        self.history.sliding_distance += span * max(paths, default=0.0)

    # ---- rest -------------------------------------------------------------------------------------------------------

    def _rest(self) -> None:
        """Rest to the end of the stretch, or until the ground tips or moves the body."""
        if self.stretch >= self.ground.motion.count:
            self._hold(self.until)
            return
        end = float(self.ground.motion.times[self.stretch + 1])
        span = end - self.time
        if self.mode.pulled:
            part = min(1e-3 / self.pace, span)
            self.stretch += part == span
            self._hold(end if part == span else self.time + part)
            self._choose(self._touching())
            return
        coefficients = self.ground.field(self.stretch, self.time, span)
        marks = [1.0] if len(coefficients) < 3 else [k / 8.0 for k in range(1, 9)]
        before = 0.0
        for mark in marks:
            if self._stands(valued(coefficients, mark)) < 0.0:
                low, high = before, mark
                for _ in range(HALVINGS):
                    middle = 0.5 * (low + high)
                    low, high = (low, middle) if self._stands(valued(coefficients, middle)) < 0.0 else (middle, high)
                self._hold(self.time + high * span)
                self._event(HullEventKind.UPLIFT, 0.0)
                slips = self._slips(valued(coefficients, high)) < 0.0
                self._choose(self._touching(), self.mode.contact, leaves=not slips)
                return
            before = mark
        self._hold(end)
        self.stretch += 1

    def _hold(self, until: float) -> None:
        self.time = until
        self._keep()

    def _stands(self, pull: Vector) -> float:
        """Least distance of the centre of pressure from the border, times the pull, and what friction leaves over."""
        axes, points = frame(self.state.attitude), self.body.points
        members = self.mode.contact.members
        least = min(-pull[2], self._slips(pull))
        for k, i in enumerate(members):
            a, b = applied(axes, points[i]), applied(axes, points[members[(k + 1) % len(members)]])
            x, y = b[0] - a[0], b[1] - a[1]
            size = math.hypot(x, y)
            inward = (-y / size, x / size)
            inside = -(a[0] * inward[0] + a[1] * inward[1])
            tips = -inside * pull[2] - a[2] * (pull[0] * inward[0] + pull[1] * inward[1])  # Eq. 94
            least = min(least, tips / self.body.size)
        return least

    def _slips(self, pull: Vector) -> float:
        """Return what friction leaves over on a base at rest; below zero it slides."""
        return math.inf if math.isinf(self.friction) else -self.friction * pull[2] - math.hypot(pull[0], pull[1])

    # ---- a step -----------------------------------------------------------------------------------------------------

    def _step(self) -> None:
        body, start = self.body, self.state
        self.history.steps += 1
        moving = self.stretch < self.ground.motion.count
        left = (float(self.ground.motion.times[self.stretch + 1]) if moving else math.inf) - self.time
        whole = min(self.length, left)
        if whole < left < 2.0 * whole:
            whole = 0.5 * left
        coefficients = self.ground.field(self.stretch, self.time, whole)

        def to(part: float) -> StepResult:
            return step(body, start, self.mode, coefficients, (whole, part), self.pace)

        result = to(1.0)
        if not math.isfinite(result.error):
            self._shorten(whole)
            return
        if any(rates.found is None for _, _, rates in result.samples):
            if whole * self.pace > 1e-9:
                self.length = 0.25 * whole
            else:
                self._shocked(self._touching())
            return
        fast = max((slip_speed(body, result.state, i) for i in self.mode.starts), default=0.0) / self.slides
        if fast > 2.0 and whole * self.pace > 2e-3:
            # the direction of what only starts to slide is that of its start
            self.length = whole * max(1.5 / fast, 0.1)
            return
        growth = 0.9 * (self.settings.tolerance / max(result.error, 1e-300)) ** 0.2
        if result.error > self.settings.tolerance and whole * self.pace > 1e-10:
            self.length = whole * max(0.1, growth)
            return
        self._pace_on(whole, growth, cut=whole == left)
        part, kind = EventFunctions(body, self.ground, self.mode, start, whole, self.stop).first(result, to)
        if kind:
            result = to(part)
        self._slide(result, part * whole)
        self.time = self.time + part * whole
        if not kind and whole == left:
            self.stretch += 1
            self.time = float(self.ground.motion.times[self.stretch])
        self.state = result.state
        self._settle_on(self.mode.contact)
        self._keep()
        self._end(kind)

    def _shorten(self, whole: float) -> None:
        """Take a tenth of a step whose first stages leave all bounds, as the forces of a large friction can."""
        self.length = 0.1 * whole
        if whole * self.pace <= 1e-10:
            self.ended = Status.NOT_FINITE

    def _pace_on(self, whole: float, growth: float, *, cut: bool) -> None:
        """Set the length of the next step; cut: whether a sample of the motion has cut this one."""
        base = max(whole, self.length if cut else 0.0) if growth > 1.0 else whole
        self.length = min(base * min(max(growth, 0.3), 4.0), 0.2 / self.pace)

    def _end(self, kind: str) -> None:
        """Let the mode go on, or end by what has fallen below zero."""
        if any(self._slip(i) > self.slides for i in self.mode.starts):
            slow = {i: d for i, d in self.mode.starts.items() if self._slip(i) <= self.slides}
            self.mode = replace(self.mode, starts=slow)
        if kind == "gap":
            self._impact()
        elif kind:
            self._event(HullEventKind.CHANGE, energies(self.body, self.state, ZERO)[0])
            exclude = self.mode.contact if kind != "slip" else None
            self._choose(self._touching(), exclude, leaves=kind in ("normal", "shelf"))
            self._keep()
        elif self.mode.pulled:
            self._choose(self._touching())

    # ---- contact ----------------------------------------------------------------------------------------------------

    def _touching(self, reach: float = CLOSED) -> tuple[int, ...]:
        axes, place = frame(self.state.attitude), self.state.place
        found = []
        for i, p in enumerate(self.body.points):
            at = added(place, 1.0, applied(axes, p))
            if at[2] <= reach * self.body.size and self.ground.under(at):
                found.append(i)
        return tuple(found)

    def _field(self) -> Vector:
        """Return gravity less the acceleration of the ground, a moment later."""
        ahead = _AHEAD / self.pace
        if self.stretch >= self.ground.motion.count:
            return self.ground.weight
        return valued(self.ground.field(self.stretch, self.time, ahead), 1.0)

    def _mode(self, contact: HullContact, starts: dict[int, Vector]) -> HullMode:
        return HullMode(contact, self.friction, starts)

    def _choose(
        self,
        touching: tuple[int, ...],
        exclude: HullContact | None = None,
        closed: tuple[int, ...] = (),
        *,
        leaves: bool = False,
    ) -> None:
        """Choose what stays on the ground: the first candidate whose forces obey every law.

        exclude: the contact that has just ended; closed: vertices that an impact has stopped; leaves: whether one of
        its vertices leaves, so that no way of sticking or sliding keeps all of them.
        """
        if self.ended is not None or self._guarded():
            return
        if not self.at_once or closed:
            self.over = []
        if exclude is not None:
            self.over.append((exclude, leaves))
        crowded = self._crowded()
        if crowded and self.time > self.gathered:
            self._gather()
            return
        body, state = self.body, self.state
        near = tuple(i for i in touching if i in closed or point_velocity(body, state, i)[2] <= self.slow)
        problem = problem_of(body, state, self._field(), self.friction)
        problem.bias = {i: cross(state.spin, cross(state.spin, p)) for i, p in enumerate(body.points)}
        moving = {}
        for i in near if self.friction < math.inf else ():
            if self._slip(i) > 3.0 * self.stop:
                x, y, _ = point_velocity(body, state, i)
                moving[i] = back(problem.axes, unit((x, y, 0.0)))
        # what leaves slowly stays beside what is at rest, not in its place
        still = {i for i in near if i in closed or point_velocity(body, state, i)[2] <= _STRIKES * self.speed}
        every = self._candidates(problem, touching, near, moving)
        candidates = [c for c in every if not (still and c.contact.members) or still.intersection(c.contact.members)]
        found = None if crowded else self._lawful(problem, candidates, near)
        if found is not None:
            self._take(problem, found, moving)
            return
        if moving and not self.mode.pulled and not crowded:
            self._shocked(near)
            return
        best = contacts.least_pull(problem, candidates, near, 1e-9 * self.ground.gravity)
        best = candidates[0] if (crowded or best is None) and candidates[0].contact.members else best
        if best is None:
            self.ended = Status.NO_CONTACT_FORCE
            return
        self.history.held += best.contact != self.mode.contact or not self.mode.pulled
        self._take(problem, best, moving)
        self.mode = replace(self.mode, pulled=True)

    def _lawful(self, problem: Problem, candidates: list[Solution], near: tuple[int, ...]) -> Solution | None:
        """Return the first candidate that obeys every law; what has ended at this moment as a last resort."""

        def ended(contact: HullContact, level: int) -> bool:
            return any(
                set(contact.members) == set(c.members)
                and ((leaves and level == 0) or set(contact.stuck) == set(c.stuck))
                for c, leaves in (self.over if level < 2 else ())
            )

        levels = range(3 if self.over and self.friction < math.inf else 1)
        for level, slack in product_of(levels, _LADDER):
            for found in candidates:
                if not ended(found.contact, level) and contacts.valid(
                    problem, found, near, slack * self.ground.gravity
                ):
                    return found
        return None

    def _crowded(self) -> bool:
        """Whether changes of contact follow each other without end."""
        if self.time - self.since > _CROWDED / self.pace:
            self.changes, self.since = 0, self.time
        self.changes += not self.mode.pulled
        return self.changes > _CROWD or self.at_once > _PILED

    def _gather(self) -> None:
        """Bring to an end what accumulates at one moment: what it closes in on touches, and is at rest there."""
        again = self.time <= self.gathered + _CROWDED / self.pace
        self.gathered, self.changes, self.at_once = self.time, 0, 0
        before = sum(energies(self.body, self.state, self.ground.weight))
        touching = self._touching((10.0 if again else 1.0) * _GATHERED)
        slow = _GATHERING * self.speed
        near = tuple(i for i in touching if abs(point_velocity(self.body, self.state, i)[2]) <= slow)
        border = contacts.outline(problem_of(self.body, self.state, ZERO, 0.0), near)
        still = tuple(i for i in border if self._slip(i) <= self.slides)
        self._settle_on(HullContact(border), still)
        self.history.lost += before - sum(energies(self.body, self.state, self.ground.weight))
        self._choose(near, closed=near)

    def _candidates(
        self, problem: Problem, touching: tuple[int, ...], near: tuple[int, ...], moving: dict[int, Vector]
    ) -> Iterator[Solution]:
        """Yield what may stay: first what sticks wherever it does not slide yet, larger faces first; flight last."""
        states = []
        for members in contacts.faces(problem, touching, near):
            still = tuple(i for i in members if i not in moving)
            ways = contacts.friction_states(members, still)
            ways = (way for way in ways if self.friction < math.inf or way.stuck == members)
            for way in ways:
                # a facet that slides as a whole comes before what edges and single vertices do
                slides = len(still) - len(way.stuck)
                rank = 0 if slides == 0 else 1 if len(members) > 2 and not way.stuck else slides + 1
                states.append((rank, way))
        for _, contact in sorted(states, key=lambda state: state[0]):
            known = {i: moving[i] for i in contact.members if i in moving and i not in contact.stuck}
            found = sliding(problem, contact, known, 1e-5 * self.ground.gravity if problem.bias else 0.0)
            if found is not None:
                yield found
        flight = contacts.solve(problem, FLIGHT, {})
        assert flight is not None
        yield flight

    def _take(self, problem: Problem, found: Solution, moving: dict[int, Vector]) -> None:
        slow = [i for i in found.directions if i not in moving or self._slip(i) <= self.slides]
        starts = {i: applied(problem.axes, found.directions[i]) for i in slow}
        made, axes = self.history, problem.axes
        if len(self.mode.contact.members) > 2 > len(found.contact.members) - 1:
            made.first_uplift = made.first_uplift if made.uplifts else self.time
            made.uplifts += 1
        self.mode = self._mode(found.contact, starts)
        self.anchors = {
            i: added(self.state.place, 1.0, applied(axes, self.body.points[i])) for i in found.contact.stuck
        }
        before = energies(self.body, self.state, ZERO)[0]
        self._settle_on(found.contact, tuple(i for i in found.contact.members if i not in moving))
        self.history.lost += before - energies(self.body, self.state, ZERO)[0]
        self.length = min(self.length, 0.1 / self.pace)
        made.flew |= not found.contact.members
        made.slid |= any(i not in found.contact.stuck for i in found.contact.members)
        made.rocked |= 0 < len(found.contact.members) < 3
        if self._resting:
            self.state = self.state._replace(velocity=ZERO, spin=ZERO)

    def _slip(self, i: int) -> float:
        return slip_speed(self.body, self.state, i)

    def _settle_on(self, contact: HullContact, still: tuple[int, ...] = ()) -> None:
        """Take drift and rounding out of the attitude, the place and the velocities; still: which have no slip."""
        if not contact.members:
            return
        body, members = self.body, contact.members
        attitude = self.state.attitude
        for _ in range(2 if len(members) > 1 else 0):
            attitude = levelled(body, attitude, members)
        axes = frame(attitude)
        first = applied(axes, body.points[(contact.stuck or members)[0]])
        x, y, _ = self.state.place
        if contact.stuck:
            anchor = self.anchors[contact.stuck[0]]
            x, y = anchor[0] - first[0], anchor[1] - first[1]
        state = self.state._replace(place=(x, y, -first[2]), attitude=attitude)
        problem = Problem(body, axes, back(axes, state.velocity), state.spin, 0.0)
        whole = HullContact(members, still or contact.stuck)
        found = contacts.linear(problem, whole, list(members), dict.fromkeys(members, ZERO))
        if found is not None:
            state = state._replace(velocity=applied(axes, found.linear), spin=found.angular)
        self.state = state

    # ---- impacts ----------------------------------------------------------------------------------------------------

    def _impact(self) -> None:
        """Resolve the impact of all vertices that touch."""
        body, old = self.body, self.mode.contact.members
        touching = self._flattened(self._touching())
        before = energies(body, self.state, ZERO)[0]
        axes = frame(self.state.attitude)
        problem = Problem(body, axes, back(axes, self.state.velocity), self.state.spin, self.friction)
        found = None
        for law in (True, False):
            problem.places = self._places(touching, old) if law and old else {}
            found = self._struck(problem, touching, before)
            if self.at_once > _PILED:
                found, self.struck = None, []
                break
            if found is not None or not problem.places:
                break
            self.history.replaced += 1
        if found is None:
            self.history.held += 1
            found = contacts.least_pull(problem, self.struck, touching, 1e-9 * self._fastest(problem))
        if found is None:
            self._pile(touching)
        else:
            self.state = self.state._replace(velocity=applied(axes, found.linear), spin=found.angular)
        after = energies(body, self.state, ZERO)[0]
        self.history.lost += before - after
        closed = found.contact.members if found is not None else touching
        self._choose(touching, closed=closed)
        self._calm()
        self.history.events.append(HullEvent(self.time, HullEventKind.IMPACT, self.mode.contact, before, after))
        self._keep()

    def _flattened(self, touching: tuple[int, ...]) -> tuple[int, ...]:
        """Return what touches, with all of a facet that lands nearly flat, which is laid flat for that.

        The corners that carry pass the motion on from one to the next in the last moment of such a landing, at first
        without loss, in an order that rounding decides. Real faces are not flat to `_FLAT` of the size of a body.
        """
        body, state, near = self.body, self.state, self._touching(_FLAT)
        if len(near) < 3 or len(near) == len(touching):
            return touching
        axes, carry = frame(state.attitude), self.mode.contact.members
        flat = min(range(len(body.facets)), key=lambda k: dot(unit(body.facets[k]), axes[2]))
        corners = tuple(int(i) for i in body.hull.corners(flat))
        rises = (i not in carry and point_velocity(body, state, i)[2] > 0.0 for i in corners)  # Eq. 328
        if not set(corners) <= set(near) or any(rises):
            return touching
        attitude, kept = state.attitude, body.points[(carry or corners)[0]]
        fixed = added(state.place, 1.0, applied(axes, kept))
        for _ in range(2):
            attitude = levelled(body, attitude, corners)
        x, y, _height = minus(fixed, applied(frame(attitude), kept))
        low = applied(frame(attitude), body.points[corners[0]])[2]
        self.state = state._replace(place=(x, y, -low), attitude=attitude)
        before, after = (energies(body, each, self.ground.weight)[1] for each in (state, self.state))
        self.history.lost += before - after
        return tuple(sorted({*touching, *corners}))

    def _places(self, touching: tuple[int, ...], old: tuple[int, ...]) -> dict[int, Vector]:
        points = self.body.points
        stood = [points[i] for i in old]
        landing = [i for i in touching if i not in old]
        places = {i: place_of(self.law, nearest(stood, points[i]), points[i]) for i in landing}
        return {i: place for i, place in places.items() if place != points[i]}

    def _struck(self, problem: Problem, touching: tuple[int, ...], before: float) -> Solution | None:
        """Return the first candidate whose impulses obey every law; None where there is none."""
        self.struck = [
            s for s in self._candidates(problem, touching, touching, {}) if self._energy(s) <= before * (1.0 + 1e-12)
        ]
        for slack in _LADDER[:3]:
            for found in self.struck:
                if contacts.valid(problem, found, touching, slack * self._fastest(problem)):
                    return found
        return None

    def _fastest(self, problem: Problem) -> float:
        return length(problem.linear) + self.body.size * length(problem.angular)

    def _energy(self, found: Solution) -> float:
        """Return the kinetic energy after an impact [J]."""
        w = found.angular
        return 0.5 * (self.body.mass * dot(found.linear, found.linear) + dot(w, applied(self.body.tensor, w)))

    def _pile(self, touching: tuple[int, ...]) -> None:
        """Make the largest face stick by a plastic impact, pulled or not."""
        axes = frame(self.state.attitude)
        problem = Problem(self.body, axes, back(axes, self.state.velocity), self.state.spin, 0.0)
        members = next(contacts.faces(problem, touching), ())
        found = contacts.linear(problem, HullContact(members, members), list(members), {}) if members else None
        if found is not None:
            self.state = self.state._replace(velocity=applied(axes, found.linear), spin=found.angular)

    def _shocked(self, touching: tuple[int, ...]) -> None:
        """Let vertices that slide stick at once where no force is possible (Painleve)."""
        before = energies(self.body, self.state, ZERO)[0]
        self._pile(touching)
        self.history.lost += before - energies(self.body, self.state, ZERO)[0]
        self._choose(touching, closed=touching)

    def _calm(self) -> None:
        """Lay a body flat that hardly moves above a facet, if the ground holds it there."""
        near = self._touching(10.0 * self.rest)
        if self._resting or len(near) < 3 or self.ended is not None:
            return
        state, lost, anchors = self.state, self.history.lost, self.anchors
        before = sum(energies(self.body, state, self.ground.weight))
        problem = problem_of(self.body, state, self._field(), math.inf)
        members = next(contacts.faces(problem, near))
        held = contacts.solve(problem, HullContact(members, members), {}) if len(members) > 2 else None
        if held is None or not min(held.normals.values()) > 0.0:
            return
        slides = any(self._slip(i) > self.stop for i in near)
        for stuck in (members, ()) if slides else (members,):
            self.anchors = {i: added(state.place, 1.0, applied(problem.axes, self.body.points[i])) for i in stuck}
            self._settle_on(HullContact(members, stuck))
            if before - sum(energies(self.body, self.state, self.ground.weight)) <= self.weak:
                self._choose(near, closed=near)
                self.history.lost = lost + before - sum(energies(self.body, self.state, self.ground.weight))
                return
            self.state, self.anchors = state, anchors

    # ---- small parts ------------------------------------------------------------------------------------------------

    def _keep(self) -> None:
        made = self.history
        self._watch()
        made.time.append(self.time)
        made.states.append(self.state)
        made.contacts.append(self.mode.contact)

    def _event(self, kind: HullEventKind, energy: float) -> None:
        self.history.events.append(HullEvent(self.time, kind, self.mode.contact, energy, energy))

    def _guarded(self) -> bool:
        self.at_once = self.at_once + 1 if self.time <= self.moment else 0
        self.moment = self.time
        if self.at_once > _STUCK:
            self.ended = Status.STUCK
        if len(self.history.events) > self.settings.most_events:
            self.ended = Status.TOO_MANY_EVENTS
        return self.ended is not None
