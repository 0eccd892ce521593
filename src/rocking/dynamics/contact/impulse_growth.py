"""An impact as a process: the impulse at one place grows, sliding or sticking, through compression and restitution.

Routh (1905) and Keller (1986): with the normal impulse p as the time of the impact, and f the impulse along the ground
for one of it, the velocities of the place change at constant rates between changes of f,

    dv_n/dp = A_nn + f A_nt,    dv_t/dp = A_nt + f A_tt,    f = -mu sgn(v_t), or -A_nt / A_tt where it sticks.

Compression ends where v_n = 0. Poisson's law lets the impulse grow by e of what compression took, Stronge's until e^2
of its work is given back; only the latter never creates energy. A foot that slides where A_nn - sgn(v_t) mu A_nt <= 0,
so that no force obeys Coulomb's law (Painleve 1895), is struck without an approach: its impulse grows until it sticks.
"""

import math

from rocking.dynamics.contact.base import LEFT, RIGHT, ContactState, PlaneBase, along, away, kinetic
from rocking.dynamics.contact.impact_resolution import (
    GroundContact,
    Struck,
    cleared,
    largest_speed,
    placed,
    strike,
)
from rocking.outcome import Status

_ROUNDING, _ALMOST = 1e-13, 1e-6


def impact_of(
    base: PlaneBase, state: ContactState, law: GroundContact, bounce: dict[int, float]
) -> tuple[Struck | Status, bool]:
    """Return what an impact does, and whether Stronge's law had to stand in for the one that was asked for."""
    # it does where that one has no solution, two of them, or would create energy. bounce: e of each foot [-]
    if law.bounce_law == "newton":
        found = strike(base, state, law.friction, bounce)
    else:
        found = _grown(base, state, law.friction, bounce, law.bounce_law)
    if isinstance(found, Struck):
        return found, False
    return _grown(base, state, law.friction, bounce, "stronge"), True


def shock(base: PlaneBase, state: ContactState, law: GroundContact) -> Struck | Status:
    """Return what a foot does that slides where no contact force is possible: the impact without collision."""
    for foot in state.touching:
        speed = along(base, state, foot)
        if speed == 0.0 or away(base, state, foot) != 0.0:
            continue
        arm = base.arm(foot, state.rotation)
        normal, mixed, _ = _inverse_masses(base, arm)
        if normal - math.copysign(law.friction, speed) * mixed > _ALMOST:
            continue
        own = (0.0 if law.bounce_law == "newton" else law.bounce, law.bounce_law)
        for e, name in (own, (0.0, "stronge")):
            found = _grow(base, state, arm, law.friction, e, name, shocked=True)
            struck = found._replace(normal={foot: found.normal[0]})
            if _fine(base, state, struck):
                return struck
    return Status.NO_CONTACT_FORCE


def _grown(
    base: PlaneBase, state: ContactState, friction: float, bounce: dict[int, float], law: str
) -> Struck | Status:
    """At the foot that lands; where the other one would be pressed down, where the plastic impact has its resultant."""
    falling = [foot for foot in state.touching if away(base, state, foot) < 0.0]
    if len(falling) == 1:
        (foot,) = falling
        found = _grow(base, state, base.arm(foot, state.rotation), friction, bounce[foot], law)
        struck = found._replace(normal={foot: found.normal[0]})
        if cleared(base, struck, state):
            return struck if _fine(base, state, struck) else Status.ENERGY_GAIN
    plastic = next(placed(base, state, friction, dict.fromkeys(state.touching, 0.0)), None)
    if plastic is None:
        return Status.NO_CONTACT_FORCE
    left, right = plastic.normal.get(LEFT, 0.0), plastic.normal.get(RIGHT, 0.0)
    e = max(bounce.values())
    if e > 0.0 and left > 0.0 and right > 0.0:
        place = (left * base.lever(LEFT) + right * base.lever(RIGHT)) / (left + right)
        found = _grow(base, state, (place, -base.height), friction, e, law)
        total = found.normal[0]
        shared = {LEFT: total * left / (left + right), RIGHT: total * right / (left + right)}
        struck = found._replace(normal=shared)
        if _fine(base, state, struck):
            return struck
    return plastic if _fine(base, state, plastic) else Status.ENERGY_GAIN


def _fine(base: PlaneBase, before: ContactState, struck: Struck) -> bool:
    """Whether no energy is created and no foot pressed into the ground."""
    gained = kinetic(base, struck.state) > kinetic(base, before) * (1.0 + 10.0 * _ROUNDING)
    return not gained and cleared(base, struck, before)


def _inverse_masses(base: PlaneBase, arm: tuple[float, float]) -> tuple[float, float, float]:
    """A_nn, A_nt and A_tt of a place [-]."""
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
    """Let the impulse at one place grow; the impulses are of the place 0."""
    r_x, r_z = arm
    nn, nt, tt = _inverse_masses(base, arm)
    v_n, v_t = state.w - r_x * state.spin, state.u + r_z * state.spin
    if abs(v_t) <= _ROUNDING * largest_speed(base, state):
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


def _slip(v_t: float, drift: float, most: float) -> int:
    """Direction in which a place slides, or starts to slide where friction cannot hold it."""
    if v_t:
        return 1 if v_t > 0.0 else -1
    return 0 if abs(drift) <= most else 1 if drift > 0.0 else -1
