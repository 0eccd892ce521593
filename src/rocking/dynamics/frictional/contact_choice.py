"""Choice of the contact: the first set of touching vertices with forces that satisfy all laws."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product as product_of

from rocking.dynamics.frictional import contact_problem as contacts
from rocking.dynamics.frictional.contact_problem import FLIGHT, HullContact, Problem, Solution
from rocking.dynamics.frictional.ground import (
    ZERO,
    Vector,
    added,
    applied,
    back,
    cross,
    frame,
    unit,
)
from rocking.dynamics.frictional.motion import (
    energies,
    levelled,
    point_velocity,
    problem_of,
    sliding,
)
from rocking.dynamics.frictional.state import HullState
from rocking.outcome import Status

STRIKES = 5e-10  # speed / sqrt(g size) above which a history starts with an impact
LADDER = (1e-11, 1e-9, 1e-7, 1e-5)
PILED, _STUCK = 30, 200
# largest number of changes of contact within a duration; unit of the duration: sqrt(size / g)
_CROWD, _CROWDED = 12, 1e-2
# limits of converging vertices in an accumulation: gap / size, and opening speed / sqrt(g size)
_GATHERED, _GATHERING = 1e-7, 1e-4


class ContactChoice(HullState):
    """State of a history, with the choice of the contact."""

    def _choose(
        self,
        touching: tuple[int, ...],
        exclude: HullContact | None = None,
        closed: tuple[int, ...] = (),
        *,
        leaves: bool = False,
    ) -> None:
        """Choose the contact: the first candidate with forces that satisfy all laws.

        `exclude` is the contact that has just ended. `leaves` is True if one of the vertices of this contact leaves, so
        that neither sticking nor sliding keeps all of its vertices. `closed` contains vertices stopped by an impact.
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
        # a slowly leaving vertex may stay in contact only together with vertices at rest
        at_rest = {i for i in closing if i in closed or point_velocity(body, state, i)[2] <= STRIKES * self.speed}
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
        """Return the first candidate that satisfies all laws. Contacts that ended at this time are tried last."""

        def ended(contact: HullContact, level: int) -> bool:
            return any(
                set(contact.members) == set(c.members)
                and ((leaves and level == 0) or set(contact.stuck) == set(c.stuck))
                for c, leaves in (self.over if level < 2 else ())
            )

        levels = range(3 if self.over and self.friction < math.inf else 1)
        for level, slack in product_of(levels, LADDER):
            for solution in candidates:
                if not ended(solution.contact, level) and contacts.valid(
                    problem, solution, near, slack * self.ground.gravity
                ):
                    return solution
        return None

    def _crowded(self) -> bool:
        """Return True if changes of contact accumulate at one time."""
        if self.time - self.since > _CROWDED / self.pace:
            self.changes, self.since = 0, self.time
        self.changes += not self.mode.pulled
        return self.changes > _CROWD or self.at_once > PILED

    def _gather(self) -> None:
        """End an accumulation of events at one time: bring the converging vertices into contact at rest."""
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
        """Yield candidates in this order: sticking before sliding, larger before smaller faces, flight last."""
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

    def _settle_on(self, contact: HullContact, still: tuple[int, ...] = ()) -> None:
        """Correct drift and rounding errors of attitude, position and velocities.

        `still` contains vertices without slip.
        """
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

    def _pile(self, touching: tuple[int, ...]) -> None:
        """Stop the largest face by a plastic impact, even if impulses are tensile."""
        axes = frame(self.state.attitude)
        problem = Problem(self.body, axes, back(axes, self.state.velocity), self.state.spin, 0.0)
        members = next(contacts.faces(problem, touching), ())
        solution = contacts.linear(problem, HullContact(members, members), list(members), {}) if members else None
        if solution is not None:
            self.state = self.state._replace(velocity=applied(axes, solution.linear), spin=solution.angular)

    def _shocked(self, touching: tuple[int, ...]) -> None:
        """Stop sliding vertices by an impact if no contact force is possible (Painleve paradox)."""
        before = energies(self.body, self.state, ZERO)[0]
        self._pile(touching)
        self.history.lost += before - energies(self.body, self.state, ZERO)[0]
        self._choose(touching, closed=touching)

    def _guarded(self) -> bool:
        self.at_once = self.at_once + 1 if self.time <= self.moment else 0
        self.moment = self.time
        if self.at_once > _STUCK:
            self.ended = Status.STUCK
        if len(self.history.events) > self.settings.most_events:
            self.ended = Status.TOO_MANY_EVENTS
        return self.ended is not None
