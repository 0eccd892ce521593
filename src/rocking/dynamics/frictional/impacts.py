"""Impacts of a body on the vertices of its hull."""

import math

from rocking.dynamics.frictional import contact_problem as contacts
from rocking.dynamics.frictional.contact_choice import LADDER, PILED, ContactChoice
from rocking.dynamics.frictional.contact_problem import HullContact, Problem, Solution
from rocking.dynamics.frictional.ground import (
    ZERO,
    Vector,
    added,
    applied,
    back,
    dot,
    frame,
    length,
    minus,
    unit,
)
from rocking.dynamics.frictional.history import HullEvent, HullEventKind
from rocking.dynamics.frictional.motion import (
    energies,
    levelled,
    point_velocity,
    problem_of,
)
from rocking.dynamics.frictional.restitution import impulse_point, nearest

_FLAT = 1e-6  # gap / size below which all corners of a facet land together


class HullImpacts(ContactChoice):
    """State of a history, with the computation of impacts."""

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
            if self.at_once > PILED:
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
        """Return the touching vertices.

        A facet that lands nearly flat is first rotated to flat, and all its corners touch.

        Otherwise, contact would first pass from corner to corner without energy loss, in an order that depends on
        rounding. Real faces are less flat than `_FLAT` times the size of the body.
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
        """Return the first candidate whose impulses satisfy all laws; None if there is none."""
        self.struck = [
            s for s in self._candidates(problem, touching, touching, {}) if self._energy(s) <= before * (1.0 + 1e-12)
        ]
        for slack in LADDER[:3]:
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

    def _calm(self) -> None:
        """Bring a body that moves slowly close to a facet to rest, if contact forces can keep the body at rest."""
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
