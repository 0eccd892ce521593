"""Reference engine of a body on the vertices of its hull: steps, events to rounding, contact by complementarity."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product as product_of
from typing import Any, NamedTuple

from rocking.dynamics.frictional import contact_problem as contacts
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.contact_problem import FLIGHT, HullContact, Problem, Solution
from rocking.dynamics.frictional.event_functions import CLOSED, MAX_ITERATIONS, EventFunctions, stops_at
from rocking.dynamics.frictional.ground import (
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
from rocking.dynamics.frictional.history import HullEvent, HullEventKind, HullHistory
from rocking.dynamics.frictional.motion import (
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
from rocking.dynamics.frictional.restitution import impulse_point, law_of, nearest
from rocking.dynamics.frictional.settings import HullSettings
from rocking.outcome import Outcome, Status

_SLIDES = 1e-4  # speed over sqrt(g size) up to which a vertex keeps its initial direction of sliding
_STRIKES = 5e-10  # speed over sqrt(g size) above which a history starts with an impact
_LADDER = (1e-11, 1e-9, 1e-7, 1e-5)
_AHEAD = 1e-6  # delay, over sqrt(size / g), at which the ground acceleration determines the next mode
_PILED, _STUCK = 30, 200
_FLAT = 1e-6  # gap over the size below which all corners of a facet land together
_CROWD, _CROWDED = 12, 1e-2  # largest number of changes of contact within a time over sqrt(size / g)
# limits of such vertices: gaps over the size, and opening speeds over sqrt(g size)
_GATHERED, _GATHERING = 1e-7, 1e-4
_PATIENCE = 100.0
_PATH = (1.0 / 12.0, 10.0 / 21.0, 5.0 / 12.0, 1.0 / 42.0)


class _Watched(NamedTuple):
    """State at the end of a step."""

    time: float
    up: Vector  # vertical in body axes [-]
    tilt: float  # cosine of the angle from the initial pose [-]
    rate: float  # rate of this cosine [1/s]


class HullEngine:
    """Reference engine of one history.

    >>> from rocking.bodies.solid import Solid, box
    >>> from rocking.dynamics.frictional.motion import standing
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> HullEngine(body, HullGround(slope=0.2)).run(standing(body), 0.1).outcome.value
    'stayed at rest without uplift'
    """

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
        self.over: list[tuple[HullContact, bool]] = []  # contacts that ended at this time, and True if a vertex leaves
        self.struck: list[Solution] = []
        self.history = HullHistory()
        self.ended: Status | None = None

    # ---- the course of a history ------------------------------------------------------------------------------------

    def run(self, state: State, horizon: float = 0.0, initial_facet: int | None = None) -> HullHistory:
        """Return the history from a state; it ends at rest after the motion and the horizon, or at a time limit.

        initial_facet: facet on which the body stood before the tilt; by default that under its centre of mass.
        """
        self.state = state
        self.until = max(horizon, self.ground.motion.end)
        up = frame(state.attitude)[2]
        self.under = self.body.under(up) if initial_facet is None else initial_facet
        self.initial_facet = self.history.initial_facet = self.under
        self.upright = scaled(-1.0, unit(self.body.facets[self.initial_facet]))
        self.watched = _Watched(self.time, up, dot(self.upright, up), 0.0)
        self.law = law_of(self.restitution, self.body, self.initial_facet)
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
        if self.state.position[2] < -2.0 * self.body.size:
            self.history.fell_off = True
            return True
        if self.time < self.until:
            return False
        if self._resting:
            return True
        self.history.still_rocking = self.time > self.until + _PATIENCE / self.pace
        return self.history.still_rocking

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

    def _watch(self) -> None:
        """Record peaks, and the time at which the facet under the centre of mass leads to another pose."""
        history, axes = self.history, frame(self.state.attitude)
        up, tilt = axes[2], dot(self.upright, axes[2])
        last = _Watched(self.time, up, tilt, -dot(self.upright, cross(self.state.spin, up)))
        peaks = [(tilt, self.time)]
        span = self.time - self.watched.time
        if span > 0.0 and self.watched.rate < 0.0 < last.rate:
            # the smallest cosine of Hermite's cubic
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

    def _slide(self, result: StepResult, span: float) -> None:
        """Add the path of the vertex with the largest slip: exact for cubics at the four stored stages."""
        sliding_vertices = [i for i in self.mode.contact.members if i not in self.mode.contact.stuck]
        paths = [
            sum(w * slip_speed(self.body, s, i) for w, (_, s, _) in zip(_PATH, result.samples, strict=True))
            for i in sliding_vertices
        ]
        self.history.sliding_distance += span * max(paths, default=0.0)

    # ---- rest -------------------------------------------------------------------------------------------------------

    def _rest(self) -> None:
        """Rest to the end of the stretch, or until the ground motion moves the body."""
        if self.stretch >= self.ground.motion.count:
            self._hold(self.until)
            return
        end = float(self.ground.motion.times[self.stretch + 1])
        span = end - self.time
        if self.mode.pulled:
            pause = min(1e-3 / self.pace, span)
            self.stretch += pause == span
            self._hold(end if pause == span else self.time + pause)
            self._choose(self._touching())
            return
        coefficients = self.ground.field(self.stretch, self.time, span)
        marks = [1.0] if len(coefficients) < 3 else [k / 8.0 for k in range(1, 9)]
        before = 0.0
        for mark in marks:
            if self._stands(valued(coefficients, mark)) < 0.0:
                low, high = before, mark
                for _ in range(MAX_ITERATIONS):
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
        """Return the smallest margin of rest: moment of the pressure about the border, or friction."""
        axes, points = frame(self.state.attitude), self.body.points
        members = self.mode.contact.members
        margin = min(-pull[2], self._slips(pull))
        for k, i in enumerate(members):
            a, b = applied(axes, points[i]), applied(axes, points[members[(k + 1) % len(members)]])
            x, y = b[0] - a[0], b[1] - a[1]
            size = math.hypot(x, y)
            inward = (-y / size, x / size)
            inside = -(a[0] * inward[0] + a[1] * inward[1])
            tips = -inside * pull[2] - a[2] * (pull[0] * inward[0] + pull[1] * inward[1])  # Eq. 94
            margin = min(margin, tips / self.body.size)
        return margin

    def _slips(self, pull: Vector) -> float:
        """Return the friction margin of a base at rest; negative for sliding."""
        return math.inf if math.isinf(self.friction) else -self.friction * pull[2] - math.hypot(pull[0], pull[1])

    # ---- a step -----------------------------------------------------------------------------------------------------

    def _step(self) -> None:
        body, start = self.body, self.state
        self.history.steps += 1
        moving = self.stretch < self.ground.motion.count
        remaining = (float(self.ground.motion.times[self.stretch + 1]) if moving else math.inf) - self.time
        span = min(self.length, remaining)
        if span < remaining < 2.0 * span:
            span = 0.5 * remaining
        coefficients = self.ground.field(self.stretch, self.time, span)

        def to(fraction: float) -> StepResult:
            return step(body, start, self.mode, coefficients, (span, fraction), self.pace)

        result = to(1.0)
        if not math.isfinite(result.error):
            self._shorten(span)
            return
        if any(rates.solution is None for _, _, rates in result.samples):
            if span * self.pace > 1e-9:
                self.length = 0.25 * span
            else:
                self._shocked(self._touching())
            return
        fast = max((slip_speed(body, result.state, i) for i in self.mode.starts), default=0.0) / self.slides
        if fast > 2.0 and span * self.pace > 2e-3:
            # the direction of a vertex that starts to slide is constant
            self.length = span * max(1.5 / fast, 0.1)
            return
        growth = 0.9 * (self.settings.tolerance / max(result.error, 1e-300)) ** 0.2
        if result.error > self.settings.tolerance and span * self.pace > 1e-10:
            self.length = span * max(0.1, growth)
            return
        self._pace_on(span, growth, cut=span == remaining)
        fraction, kind = EventFunctions(body, self.ground, self.mode, start, span, self.stop).first(result, to)
        if kind:
            result = to(fraction)
        self._slide(result, fraction * span)
        self.time = self.time + fraction * span
        if not kind and span == remaining:
            self.stretch += 1
            self.time = float(self.ground.motion.times[self.stretch])
        self.state = result.state
        self._settle_on(self.mode.contact)
        self._keep()
        self._end(kind)

    def _shorten(self, span: float) -> None:
        """Retry with a tenth of a step whose stages overflow, which forces of a large friction may cause."""
        self.length = 0.1 * span
        if span * self.pace <= 1e-10:
            self.ended = Status.NOT_FINITE

    def _pace_on(self, span: float, growth: float, *, cut: bool) -> None:
        """Set the length of the next step; cut: True if a sample of the motion ended this step."""
        base = max(span, self.length if cut else 0.0) if growth > 1.0 else span
        self.length = min(base * min(max(growth, 0.3), 4.0), 0.2 / self.pace)

    def _end(self, kind: str) -> None:
        """Continue the mode, or end it by the event of a kind."""
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

    def _choose(
        self,
        touching: tuple[int, ...],
        exclude: HullContact | None = None,
        closed: tuple[int, ...] = (),
        *,
        leaves: bool = False,
    ) -> None:
        """Choose the contact: the first candidate with forces that satisfy all laws.

        exclude: the contact that has just ended; closed: vertices stopped by an impact; leaves: True if one of its
        vertices leaves, so that neither sticking nor sliding keeps all of them.
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
        closing = tuple(i for i in touching if i in closed or point_velocity(body, state, i)[2] <= self.slow)
        problem = problem_of(body, state, self._field(), self.friction)
        problem.bias = {i: cross(state.spin, cross(state.spin, p)) for i, p in enumerate(body.points)}
        moving = {}
        for i in closing if self.friction < math.inf else ():
            if self._slip(i) > 3.0 * self.stop:
                x, y, _ = point_velocity(body, state, i)
                moving[i] = back(problem.axes, unit((x, y, 0.0)))
        # a slowly leaving vertex may stay in addition to vertices at rest, not instead of them
        at_rest = {i for i in closing if i in closed or point_velocity(body, state, i)[2] <= _STRIKES * self.speed}
        options = self._candidates(problem, touching, closing, moving)
        candidates = [
            c for c in options if not (at_rest and c.contact.members) or at_rest.intersection(c.contact.members)
        ]
        solution = None if crowded else self._lawful(problem, candidates, closing)
        if solution is not None:
            self._take(problem, solution, moving)
            return
        if moving and not self.mode.pulled and not crowded:
            self._shocked(closing)
            return
        best = contacts.min_tension(problem, candidates, closing, 1e-9 * self.ground.gravity)
        best = candidates[0] if (crowded or best is None) and candidates[0].contact.members else best
        if best is None:
            self.ended = Status.NO_CONTACT_FORCE
            return
        self.history.held += best.contact != self.mode.contact or not self.mode.pulled
        self._take(problem, best, moving)
        self.mode = replace(self.mode, pulled=True)

    def _lawful(self, problem: Problem, candidates: list[Solution], near: tuple[int, ...]) -> Solution | None:
        """Return the first candidate that satisfies all laws; contacts that ended at this time come last."""

        def ended(contact: HullContact, level: int) -> bool:
            return any(
                set(contact.members) == set(c.members)
                and ((leaves and level == 0) or set(contact.stuck) == set(c.stuck))
                for c, leaves in (self.over if level < 2 else ())
            )

        levels = range(3 if self.over and self.friction < math.inf else 1)
        for level, slack in product_of(levels, _LADDER):
            for solution in candidates:
                if not ended(solution.contact, level) and contacts.valid(
                    problem, solution, near, slack * self.ground.gravity
                ):
                    return solution
        return None

    def _crowded(self) -> bool:
        """Return True if changes of contact accumulate."""
        if self.time - self.since > _CROWDED / self.pace:
            self.changes, self.since = 0, self.time
        self.changes += not self.mode.pulled
        return self.changes > _CROWD or self.at_once > _PILED

    def _gather(self) -> None:
        """End an accumulation of events at one time: the converging vertices are put in contact at rest."""
        is_repeated = self.time <= self.gathered + _CROWDED / self.pace
        self.gathered, self.changes, self.at_once = self.time, 0, 0
        before = sum(energies(self.body, self.state, self.ground.weight))
        touching = self._touching((10.0 if is_repeated else 1.0) * _GATHERED)
        slow = _GATHERING * self.speed
        near = tuple(i for i in touching if abs(point_velocity(self.body, self.state, i)[2]) <= slow)
        border = contacts.outline(problem_of(self.body, self.state, ZERO, 0.0), near)
        sticking = tuple(i for i in border if self._slip(i) <= self.slides)
        self._settle_on(HullContact(border), sticking)
        self.history.lost += before - sum(energies(self.body, self.state, self.ground.weight))
        self._choose(near, closed=near)

    def _candidates(
        self, problem: Problem, touching: tuple[int, ...], near: tuple[int, ...], moving: dict[int, Vector]
    ) -> Iterator[Solution]:
        """Yield candidates: sticking before sliding, larger faces before smaller ones, flight last."""
        states = []
        for members in contacts.faces(problem, touching, near):
            sticking = tuple(i for i in members if i not in moving)
            options = contacts.friction_states(members, sticking)
            options = (option for option in options if self.friction < math.inf or option.stuck == members)
            for option in options:
                # a fully sliding facet comes before edges and single vertices
                slides = len(sticking) - len(option.stuck)
                rank = 0 if slides == 0 else 1 if len(members) > 2 and not option.stuck else slides + 1
                states.append((rank, option))
        for _, contact in sorted(states, key=lambda state: state[0]):
            given_directions = {i: moving[i] for i in contact.members if i in moving and i not in contact.stuck}
            solution = sliding(problem, contact, given_directions, 1e-5 * self.ground.gravity if problem.bias else 0.0)
            if solution is not None:
                yield solution
        flight = contacts.solve(problem, FLIGHT, {})
        assert flight is not None
        yield flight

    def _take(self, problem: Problem, solution: Solution, moving: dict[int, Vector]) -> None:
        slow_vertices = [i for i in solution.directions if i not in moving or self._slip(i) <= self.slides]
        starts = {i: applied(problem.axes, solution.directions[i]) for i in slow_vertices}
        history, axes = self.history, problem.axes
        if len(self.mode.contact.members) > 2 > len(solution.contact.members) - 1:
            history.first_uplift = history.first_uplift if history.uplifts else self.time
            history.uplifts += 1
        self.mode = self._mode(solution.contact, starts)
        self.anchors = {
            i: added(self.state.position, 1.0, applied(axes, self.body.points[i])) for i in solution.contact.stuck
        }
        before = energies(self.body, self.state, ZERO)[0]
        self._settle_on(solution.contact, tuple(i for i in solution.contact.members if i not in moving))
        self.history.lost += before - energies(self.body, self.state, ZERO)[0]
        self.length = min(self.length, 0.1 / self.pace)
        history.flew |= not solution.contact.members
        history.slid |= any(i not in solution.contact.stuck for i in solution.contact.members)
        history.rocked |= 0 < len(solution.contact.members) < 3
        if self._resting:
            self.state = self.state._replace(velocity=ZERO, spin=ZERO)

    def _slip(self, i: int) -> float:
        return slip_speed(self.body, self.state, i)

    def _settle_on(self, contact: HullContact, still: tuple[int, ...] = ()) -> None:
        """Correct drift and rounding of attitude, position and velocities; still: vertices without slip."""
        if not contact.members:
            return
        body, members = self.body, contact.members
        attitude = self.state.attitude
        for _ in range(2 if len(members) > 1 else 0):
            attitude = levelled(body, attitude, members)
        axes = frame(attitude)
        first = applied(axes, body.points[(contact.stuck or members)[0]])
        x, y, _ = self.state.position
        if contact.stuck:
            anchor = self.anchors[contact.stuck[0]]
            x, y = anchor[0] - first[0], anchor[1] - first[1]
        state = self.state._replace(position=(x, y, -first[2]), attitude=attitude)
        problem = Problem(body, axes, back(axes, state.velocity), state.spin, 0.0)
        sticking_contact = HullContact(members, still or contact.stuck)
        solution = contacts.linear(problem, sticking_contact, list(members), dict.fromkeys(members, ZERO))
        if solution is not None:
            state = state._replace(velocity=applied(axes, solution.linear), spin=solution.angular)
        self.state = state

    # ---- impacts ----------------------------------------------------------------------------------------------------

    def _impact(self) -> None:
        """Resolve the impact of all touching vertices."""
        body, old = self.body, self.mode.contact.members
        touching = self._touching_with_facet(self._touching())
        before = energies(body, self.state, ZERO)[0]
        axes = frame(self.state.attitude)
        problem = Problem(body, axes, back(axes, self.state.velocity), self.state.spin, self.friction)
        solution = None
        for law in (True, False):
            problem.force_points = self._impulse_points(touching, old) if law and old else {}
            solution = self._struck(problem, touching, before)
            if self.at_once > _PILED:
                solution, self.struck = None, []
                break
            if solution is not None or not problem.force_points:
                break
            self.history.replaced += 1
        if solution is None:
            self.history.held += 1
            solution = contacts.min_tension(problem, self.struck, touching, 1e-9 * self._fastest(problem))
        if solution is None:
            self._pile(touching)
        else:
            self.state = self.state._replace(velocity=applied(axes, solution.linear), spin=solution.angular)
        after = energies(body, self.state, ZERO)[0]
        self.history.lost += before - after
        closed = solution.contact.members if solution is not None else touching
        self._choose(touching, closed=closed)
        self._calm()
        self.history.events.append(HullEvent(self.time, HullEventKind.IMPACT, self.mode.contact, before, after))
        self._keep()

    def _touching_with_facet(self, touching: tuple[int, ...]) -> tuple[int, ...]:
        """Return the touching vertices, with all corners of a facet that lands nearly flat, after its rotation to flat.

        In such a landing, contact passes from corner to corner at first without loss, in an order that depends on
        rounding. Real faces are not flat to `_FLAT` of the size of a body.
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
        attitude, reference_point = state.attitude, body.points[(carry or corners)[0]]
        fixed = added(state.position, 1.0, applied(axes, reference_point))
        for _ in range(2):
            attitude = levelled(body, attitude, corners)
        x, y, _height = minus(fixed, applied(frame(attitude), reference_point))
        low = applied(frame(attitude), body.points[corners[0]])[2]
        self.state = state._replace(position=(x, y, -low), attitude=attitude)
        before, after = (energies(body, snapshot, self.ground.weight)[1] for snapshot in (state, self.state))
        self.history.lost += before - after
        return tuple(sorted({*touching, *corners}))

    def _impulse_points(self, touching: tuple[int, ...], old: tuple[int, ...]) -> dict[int, Vector]:
        points = self.body.points
        old_points = [points[i] for i in old]
        landing = [i for i in touching if i not in old]
        impulse_points = {i: impulse_point(self.law, nearest(old_points, points[i]), points[i]) for i in landing}
        return {i: point for i, point in impulse_points.items() if point != points[i]}

    def _struck(self, problem: Problem, touching: tuple[int, ...], before: float) -> Solution | None:
        """Return the first candidate with impulses that satisfy all laws; None without one."""
        self.struck = [
            s for s in self._candidates(problem, touching, touching, {}) if self._energy(s) <= before * (1.0 + 1e-12)
        ]
        for slack in _LADDER[:3]:
            for solution in self.struck:
                if contacts.valid(problem, solution, touching, slack * self._fastest(problem)):
                    return solution
        return None

    def _fastest(self, problem: Problem) -> float:
        return length(problem.linear) + self.body.size * length(problem.angular)

    def _energy(self, solution: Solution) -> float:
        """Return the kinetic energy after an impact [J]."""
        w = solution.angular
        return 0.5 * (self.body.mass * dot(solution.linear, solution.linear) + dot(w, applied(self.body.tensor, w)))

    def _pile(self, touching: tuple[int, ...]) -> None:
        """Stop the largest face by a plastic impact, also with tensile impulses."""
        axes = frame(self.state.attitude)
        problem = Problem(self.body, axes, back(axes, self.state.velocity), self.state.spin, 0.0)
        members = next(contacts.faces(problem, touching), ())
        solution = contacts.linear(problem, HullContact(members, members), list(members), {}) if members else None
        if solution is not None:
            self.state = self.state._replace(velocity=applied(axes, solution.linear), spin=solution.angular)

    def _shocked(self, touching: tuple[int, ...]) -> None:
        """Stop sliding vertices at once where no contact force is possible (Painleve)."""
        before = energies(self.body, self.state, ZERO)[0]
        self._pile(touching)
        self.history.lost += before - energies(self.body, self.state, ZERO)[0]
        self._choose(touching, closed=touching)

    def _calm(self) -> None:
        """Bring a body with small motion above a facet to rest on it, if the contact forces allow it."""
        near = self._touching(10.0 * self.rest)
        if self._resting or len(near) < 3 or self.ended is not None:
            return
        state, lost, anchors = self.state, self.history.lost, self.anchors
        before = sum(energies(self.body, state, self.ground.weight))
        problem = problem_of(self.body, state, self._field(), math.inf)
        members = next(contacts.faces(problem, near))
        resting = contacts.solve(problem, HullContact(members, members), {}) if len(members) > 2 else None
        if resting is None or not min(resting.normals.values()) > 0.0:
            return
        slides = any(self._slip(i) > self.stop for i in near)
        for stuck in (members, ()) if slides else (members,):
            self.anchors = {i: added(state.position, 1.0, applied(problem.axes, self.body.points[i])) for i in stuck}
            self._settle_on(HullContact(members, stuck))
            if before - sum(energies(self.body, self.state, self.ground.weight)) <= self.weak:
                self._choose(near, closed=near)
                self.history.lost = lost + before - sum(energies(self.body, self.state, self.ground.weight))
                return
            self.state, self.anchors = state, anchors

    # ---- details --------------------------------------------------------------------------------------------------

    def _keep(self) -> None:
        history = self.history
        self._watch()
        history.time.append(self.time)
        history.states.append(self.state)
        history.contacts.append(self.mode.contact)

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
