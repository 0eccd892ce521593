"""Impacts on one or two feet: impulses by complementarity, or by a process with an increasing impulse at one point.

The laws of Newton, Poisson and Stronge, and the impact without collision, are in docs/theory/contact.md.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product
from typing import NamedTuple

from rocking import checks
from rocking.dynamics.plane_frictional.base import (
    BOTH,
    LEFT,
    RIGHT,
    ContactState,
    PlaneBase,
    along,
    away,
    kept,
    kinetic,
)
from rocking.dynamics.settings import BOUNCE_LAWS
from rocking.outcome import Status


@dataclass(frozen=True)
class GroundContact:
    """Friction and restitution at the contact of feet and ground.

    Parameters
    ----------
    friction : float
        Coulomb's coefficient mu [-], equal for sticking and sliding.
    bounce : float
        Coefficient e of normal restitution, 0 for plastic impacts [-].
    restitution : tuple of float, optional
        Imposed coefficients theta_dot_after / theta_dot_before for landing left and right [-]. They replace the
        complementarity problem at rocking impacts.
    bounce_law : {"newton", "poisson", "stronge"}
        Definition of `bounce`: ratio of normal velocities (Newton), ratio of normal impulses (Poisson), or square root
        of the ratio of the work of the normal impulses (Stronge 1990). With friction, the laws of Newton and Poisson
        may create energy or have no solution. Stronge's law, which never creates energy, then replaces them.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    friction: float
    bounce: float = 0.0
    restitution: tuple[float, float] | None = None
    bounce_law: str = "newton"

    def __post_init__(self) -> None:
        checks.within("friction", self.friction, 0.0, 1e6, hint="1e6 for feet that never slide")
        hint = "a ratio of velocities, impulses or, squared, of energies; at 1 bounces never end"
        checks.within("bounce", self.bounce, 0.0, 1.0, open_high=True, hint=hint)
        object.__setattr__(self, "bounce_law", checks.one_of("bounce_law", self.bounce_law, BOUNCE_LAWS))

    @property
    def is_lossless(self) -> bool:
        """True if the imposed coefficients conserve energy at rocking impacts, so that the body never rests."""
        return self.restitution is not None and self.restitution[0] * self.restitution[1] >= 1.0


_ROUNDING = 1e-13


class Struck(NamedTuple):
    """Result of an impact."""

    state: ContactState  # state after the impact
    normal: dict[int, float]  # vertical impulse at each foot, per unit of mass [m/s]
    tangential: float  # sum of the impulses along the ground, per unit of mass [m/s]
    slip: int  # direction of sliding during the impact; 0 if the feet stick


def strike(base: PlaneBase, state: ContactState, friction: float, bounce: dict[int, float]) -> Struck | Status:
    """Return the result of an impact. `bounce` contains the coefficient e_N by foot [-]."""
    # the result is a status if there is no solution, if there are two different solutions, or if energy increases
    solutions = list(placed(base, state, friction, bounce))
    if not solutions:
        return Status.NO_CONTACT_FORCE
    speed = largest_speed(base, state)
    first_state = solutions[0].state
    for other in (struck.state for struck in solutions[1:]):
        gap = max(
            abs(first_state.u - other.u), abs(first_state.w - other.w), base.height * abs(first_state.spin - other.spin)
        )
        if gap > 1e-8 * speed:
            return Status.AMBIGUOUS
    if kinetic(base, first_state) > kinetic(base, state) * (1.0 + 10.0 * _ROUNDING):
        return Status.ENERGY_GAIN
    return solutions[0]


def placed(base: PlaneBase, state: ContactState, friction: float, bounce: dict[int, float]) -> Iterator[Struck]:
    """Return all solutions of Newton's and Coulomb's laws, sticking before sliding. `bounce` is e by foot [-]."""
    targets = {foot: -bounce[foot] * away(base, state, foot) for foot in state.touching}  # Eq. 70
    speed = largest_speed(base, state)
    # Eq. 20
    return (s for s in _solutions(base, state, friction, targets) if _valid(base, s, friction, targets, speed))


def cleared(base: PlaneBase, struck: Struck, before: ContactState) -> bool:
    """Return True if no foot in contact moves into the ground after an impact."""
    slack = _ROUNDING * largest_speed(base, before)
    return all(away(base, struck.state, foot) >= -slack for foot in before.touching)


def largest_speed(base: PlaneBase, state: ContactState) -> float:
    """Return the scale of the velocities of the feet [m/s]. It determines the rounding errors of these velocities."""
    return max(abs(state.u), abs(state.w), base.size * abs(state.spin))


def _solutions(base: PlaneBase, state: ContactState, friction: float, targets: dict[int, float]) -> Iterator[Struck]:
    """Yield the results of all combinations of feet and directions of sliding, including invalid results."""
    for slip, n in product((0, 1, -1), range(1, len(targets) + 1)):
        pull = slip * friction
        for feet in combinations(state.touching, n):
            if n == 2:
                yield _on_both(base, state, slip, pull, targets)
            elif not slip:
                yield _on_one(base, state, feet[0], targets[feet[0]])
            elif (struck := _sliding_on_one(base, state, feet[0], slip, pull, targets[feet[0]])) is not None:
                yield struck


def _on_one(base: PlaneBase, state: ContactState, foot: int, target: float) -> Struck:
    """Return the impact on a sticking foot. The angular momentum about the foot changes only by the bounce."""
    r_x, r_z = base.arm(foot, state.rotation)
    j = base.inertia
    spin = (j * state.spin - r_z * state.u + r_x * (state.w - target)) / (j + r_x**2 + r_z**2)  # Eq. 71
    after = state._replace(u=-(r_z * spin), w=target + r_x * spin, spin=spin)
    return Struck(after, {foot: after.w - state.w}, after.u - state.u, 0)


def _sliding_on_one(
    base: PlaneBase, state: ContactState, foot: int, slip: int, pull: float, target: float
) -> Struck | None:
    r_x, r_z = base.arm(foot, state.rotation)
    level = r_x + pull * r_z
    stiff = 1.0 + r_x * level / base.inertia
    if not stiff > 0.0:
        return None
    normal = (target - away(base, state, foot)) / stiff  # Eq. 72
    spin = state.spin - normal * level / base.inertia
    after = state._replace(u=state.u - pull * normal, w=target + r_x * spin, spin=spin)
    return Struck(after, {foot: normal}, -(pull * normal), slip)


def _on_both(base: PlaneBase, state: ContactState, slip: int, pull: float, targets: dict[int, float]) -> Struck:
    left, right, width = base.left, base.right, base.width
    spin = (targets[LEFT] - targets[RIGHT]) / width  # Eq. 73
    w = (targets[LEFT] * right + targets[RIGHT] * left) / width
    total = w - state.w
    u = state.u - pull * total if slip else base.height * spin
    tangential = u - state.u
    turn = tangential * base.height + base.inertia * (spin - state.spin)
    normal = {LEFT: (total * right + turn) / width, RIGHT: (total * left - turn) / width}  # Eq. 73
    return Struck(state._replace(u=u, w=w, spin=spin), normal, tangential, slip)


def _valid(base: PlaneBase, struck: Struck, friction: float, targets: dict[int, float], speed: float) -> bool:
    slack = _ROUNDING * speed
    if not all(p >= -slack for p in struck.normal.values()):
        return False
    if not all(away(base, struck.state, foot) >= target - slack for foot, target in targets.items()):
        return False
    if struck.slip:
        return struck.slip * along(base, struck.state, next(iter(struck.normal))) >= -slack
    return abs(struck.tangential) <= friction * sum(struck.normal.values()) + slack * (1.0 + friction)


def cleaned(base: PlaneBase, struck: Struck, stop: float) -> ContactState:
    """Return the state after an impact. Velocities of the feet below `stop` [m/s] become exactly zero."""
    state = struck.state
    resting = tuple(foot for foot in state.touching if abs(away(base, state, foot)) <= stop)
    if not resting:
        return state
    stick = abs(along(base, state, resting[0])) <= stop
    if resting == BOTH:
        return kept(base, state, resting, stick=stick)
    return kept(base, state, resting, stick=stick)._replace(touching=state.touching)


_IMPOSED_ROUNDING = 1e-12


def strike_with(base: PlaneBase, state: ContactState, foot: int, friction: float, r: float) -> Struck | Status | None:
    """Return the result of a rocking impact with an imposed coefficient of restitution."""
    # r: theta_dot_after / theta_dot_before of the impact without slip [-]
    # The result is a status for an energy gain, and None for a tensile impulse or an old foot pressed into the ground.
    lever = foot * (1.0 - r) * (base.inertia + base.height**2)
    lever /= abs(base.lever(-foot)) + r * abs(base.lever(foot))  # Eq. 4
    speed = abs(away(base, state, foot)) + abs(along(base, state, foot))
    slack = _IMPOSED_ROUNDING * speed
    struck = _stuck(base, state, foot, lever)
    if abs(struck.tangential) > friction * sum(struck.normal.values()) + slack:
        sliding = [_slid(base, state, foot, lever, slip, slip * friction) for slip in (1, -1)]
        valid = [s for s in sliding if s is not None and s.slip * along(base, s.state, foot) >= -slack]
        if len(valid) != 1:
            return None
        struck = valid[0]
    if sum(struck.normal.values()) < -slack or away(base, struck.state, -foot) < -slack:
        return None
    is_gain = kinetic(base, struck.state) > kinetic(base, state) * (1.0 + _IMPOSED_ROUNDING)
    return Status.ENERGY_GAIN if is_gain else struck


def _stuck(base: PlaneBase, state: ContactState, foot: int, lever: float) -> Struck:
    h, d, j = base.height, base.lever(foot), base.inertia
    spin = (j * state.spin + h * state.u + lever * state.w) / (j + h * h + lever * d)  # Eq. 74
    if abs(spin) <= _IMPOSED_ROUNDING * abs(state.spin):
        spin = 0.0
    after = state._replace(u=h * spin, w=d * spin, spin=spin)
    return Struck(after, _shared(base, lever, after.w - state.w), after.u - state.u, 0)


def _slid(base: PlaneBase, state: ContactState, foot: int, lever: float, slip: int, pull: float) -> Struck | None:
    d = base.lever(foot)
    turn = (pull * base.height - lever) / base.inertia
    stiff = 1.0 - d * turn
    if not stiff > 0.0:
        return None
    normal = (d * state.spin - state.w) / stiff  # Eq. 75
    spin = state.spin + turn * normal
    after = state._replace(u=state.u - pull * normal, w=d * spin, spin=spin)
    return Struck(after, _shared(base, lever, normal), -(pull * normal), slip)


def _shared(base: PlaneBase, lever: float, normal: float) -> dict[int, float]:
    """Return the impulses of both feet for a resultant at a lever.

    If it is beyond a foot, the other impulse is tensile.
    """
    return {
        LEFT: normal * (base.right - lever) / base.width,
        RIGHT: normal * (base.left + lever) / base.width,
    }


_GROWTH_ROUNDING, _ALMOST = 1e-13, 1e-6


def impact_of(
    base: PlaneBase, state: ContactState, law: GroundContact, bounce: dict[int, float]
) -> tuple[Struck | Status, bool]:
    """Return the result of an impact, and True if Stronge's law replaces the requested law."""
    # Stronge's law replaces a law with no solution, two solutions or an energy gain; bounce: e by foot [-]
    if law.bounce_law == "newton":
        struck = strike(base, state, law.friction, bounce)
    else:
        struck = _grown(base, state, law.friction, bounce, law.bounce_law)
    if isinstance(struck, Struck):
        return struck, False
    return _grown(base, state, law.friction, bounce, "stronge"), True


def shock(base: PlaneBase, state: ContactState, law: GroundContact) -> Struck | Status:
    """Return the impact without collision of a sliding foot for which no contact force is possible."""
    for foot in state.touching:
        speed = along(base, state, foot)
        if speed == 0.0 or away(base, state, foot) != 0.0:
            continue
        arm = base.arm(foot, state.rotation)
        normal, mixed, _ = _inverse_masses(base, arm)
        if normal - math.copysign(law.friction, speed) * mixed > _ALMOST:
            continue
        options = (0.0 if law.bounce_law == "newton" else law.bounce, law.bounce_law)
        for e, name in (options, (0.0, "stronge")):
            grown = _grow(base, state, arm, law.friction, e, name, shocked=True)
            struck = grown._replace(normal={foot: grown.normal[0]})
            if _fine(base, state, struck):
                return struck
    return Status.NO_CONTACT_FORCE


def _grown(
    base: PlaneBase, state: ContactState, friction: float, bounce: dict[int, float], law: str
) -> Struck | Status:
    """Return an impact with an increasing impulse at the foot of landing, or at the resultant of the plastic impact."""
    falling = [foot for foot in state.touching if away(base, state, foot) < 0.0]
    if len(falling) == 1:
        (foot,) = falling
        grown = _grow(base, state, base.arm(foot, state.rotation), friction, bounce[foot], law)
        struck = grown._replace(normal={foot: grown.normal[0]})
        if cleared(base, struck, state):
            return struck if _fine(base, state, struck) else Status.ENERGY_GAIN
    plastic = next(placed(base, state, friction, dict.fromkeys(state.touching, 0.0)), None)
    if plastic is None:
        return Status.NO_CONTACT_FORCE
    left, right = plastic.normal.get(LEFT, 0.0), plastic.normal.get(RIGHT, 0.0)
    e = max(bounce.values())
    if e > 0.0 and left > 0.0 and right > 0.0:
        lever = (left * base.lever(LEFT) + right * base.lever(RIGHT)) / (left + right)
        grown = _grow(base, state, (lever, -base.height), friction, e, law)
        total = grown.normal[0]
        normal = {LEFT: total * left / (left + right), RIGHT: total * right / (left + right)}
        struck = grown._replace(normal=normal)
        if _fine(base, state, struck):
            return struck
    return plastic if _fine(base, state, plastic) else Status.ENERGY_GAIN


def _fine(base: PlaneBase, before: ContactState, struck: Struck) -> bool:
    """Return True if energy does not increase and no foot is pressed into the ground."""
    is_gain = kinetic(base, struck.state) > kinetic(base, before) * (1.0 + 10.0 * _GROWTH_ROUNDING)
    return not is_gain and cleared(base, struck, before)


def _inverse_masses(base: PlaneBase, arm: tuple[float, float]) -> tuple[float, float, float]:
    """Return the inverse masses A_nn, A_nt and A_tt at an arm [-]."""
    r_x, r_z = arm
    return 1.0 + r_x * r_x / base.inertia, -(r_x * r_z) / base.inertia, 1.0 + r_z * r_z / base.inertia


def _grow(
    base: PlaneBase,
    state: ContactState,
    arm: tuple[float, float],
    friction: float,
    e: float,
    law: str,
    *,
    shocked: bool = False,
) -> Struck:
    """Return the impact with an increasing impulse at one point. Key 0 of `normal` means this point."""
    r_x, r_z = arm
    nn, nt, tt = _inverse_masses(base, arm)
    v_n, v_t = state.w - r_x * state.spin, state.u + r_z * state.spin
    if abs(v_t) <= _GROWTH_ROUNDING * largest_speed(base, state):
        v_t = 0.0
    normal = tangential = work = owed = 0.0
    restitution, slip = False, 0
    while True:
        slip = _slip(v_t, nt, friction * tt)
        f = -slip * friction if slip else -nt / tt
        up, drift = nn + f * nt, nt + f * tt if slip else 0.0  # Eq. 236
        stops = -v_t / drift if v_t * drift < 0.0 else math.inf
        if not restitution:
            ends = -v_n / up if up > 0.0 and not shocked else math.inf
        elif law == "poisson":
            ends = owed
        else:
            ends = 2.0 * owed / (v_n + math.sqrt(v_n * v_n + 2.0 * up * owed))  # Eq. 238
        shocked = False
        p = min(stops, ends)
        done = (v_n + 0.5 * up * p) * p
        normal, tangential = normal + p, tangential + f * p
        v_n, v_t = v_n + up * p, 0.0 if stops < ends else v_t + drift * p
        work, owed = work - done, owed - (p if law == "poisson" else done)
        if stops < ends:
            continue
        owed = e * normal if law == "poisson" else e * e * work  # Eq. 237, 238
        if restitution or not owed > 0.0:
            break
        restitution, v_n = True, 0.0
    spin = state.spin + (tangential * r_z - normal * r_x) / base.inertia
    after = state._replace(u=state.u + tangential, w=state.w + normal, spin=spin)
    return Struck(after, {0: normal}, tangential, slip)


def _slip(v_t: float, drift: float, capacity: float) -> int:
    """Return the direction of sliding of a point.

    For a point without slip, the direction in which slip starts, or 0.
    """
    if v_t:
        return 1 if v_t > 0.0 else -1
    return 0 if abs(drift) <= capacity else 1 if drift > 0.0 else -1
