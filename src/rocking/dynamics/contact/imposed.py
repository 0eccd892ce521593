r"""A rocking impact with an imposed coefficient of restitution, and what friction makes of it.

A coefficient r says where the resultant of the impulses acts: without slip, moments about the centre give the distance

    s = (1 - r) (j + h^2) / (b_old + r b_new)

from the plumb line of the centre towards the new foot (Housner's r: at that foot, s = b_new; the shifted impulse: at
k b). That place is kept. Where the impact takes more friction than there is, ``P_t = -sigma mu P_n`` acts there and the
new foot slides off; with Housner's r this is the complementarity problem's own solution.
"""

from rocking.dynamics.contact.base import LEFT, RIGHT, PlaneBase
from rocking.dynamics.contact.impact_resolution import Struck
from rocking.dynamics.contact.state import ContactState, along, away, kinetic
from rocking.outcome import Status

_ROUNDING = 1e-12


def strike_with(base: PlaneBase, state: ContactState, foot: int, friction: float, r: float) -> Struck | Status | None:
    """Return what a rocking impact does when its coefficient of restitution is imposed.

    friction: Coulomb's coefficient [-]; r: theta_dot_after / theta_dot_before of the impact without slip [-]. Returns
    the state after it with the impulses; a status where energy would be created; None where an impulse at that place
    would pull, or press the old foot into the ground.
    """
    place = foot * (1.0 - r) * (base.inertia + base.height**2)
    place /= abs(base.lever(-foot)) + r * abs(base.lever(foot))  # Eq. 4
    speed = abs(away(base, state, foot)) + abs(along(base, state, foot))
    slack = _ROUNDING * speed
    found = _stuck(base, state, foot, place)
    if abs(found.tangential) > friction * sum(found.normal.values()) + slack:
        tried = [_slid(base, state, foot, place, slip, slip * friction) for slip in (1, -1)]
        valid = [s for s in tried if s is not None and s.slip * along(base, s.state, foot) >= -slack]
        if len(valid) != 1:
            return None
        found = valid[0]
    if sum(found.normal.values()) < -slack or away(base, found.state, -foot) < -slack:
        return None
    gained = kinetic(base, found.state) > kinetic(base, state) * (1.0 + _ROUNDING)
    return Status.ENERGY_GAIN if gained else found


def _stuck(base: PlaneBase, state: ContactState, foot: int, place: float) -> Struck:
    h, d, j = base.height, base.lever(foot), base.inertia
    spin = (j * state.spin + h * state.u + place * state.w) / (j + h * h + place * d)  # Eq. 74
    if abs(spin) <= _ROUNDING * abs(state.spin):
        spin = 0.0
    after = state._replace(u=h * spin, w=d * spin, spin=spin)
    return Struck(after, _shared(base, place, after.w - state.w), after.u - state.u, 0)


def _slid(base: PlaneBase, state: ContactState, foot: int, place: float, slip: int, pull: float) -> Struck | None:
    d = base.lever(foot)
    turn = (pull * base.height - place) / base.inertia
    stiff = 1.0 - d * turn
    if not stiff > 0.0:
        return None
    normal = (d * state.spin - state.w) / stiff  # Eq. 75
    spin = state.spin + turn * normal
    after = state._replace(u=state.u - pull * normal, w=d * spin, spin=spin)
    return Struck(after, _shared(base, place, normal), -(pull * normal), slip)


def _shared(base: PlaneBase, place: float, normal: float) -> dict[int, float]:
    """Both feet's parts of a resultant; beyond a foot the other one pulls."""
    return {
        LEFT: normal * (base.right - place) / base.width,
        RIGHT: normal * (base.left + place) / base.width,
    }
