r"""An impact on one or two feet: impulses by complementarity, with Newton's restitution and Coulomb's friction.

Per unit of mass, with the impulses ``P_n`` and ``P_t`` at feet that touch the ground,

    du = P_t,    dw = sum P_n,    j d(theta') = P_t r_z - sum P_n r_x,

and for every foot ``0 <= P_n  _|_  v_n(after) + e_N v_n(before) >= 0``, and ``P_t`` from ``-mu P_n Sgn(v_t(after))``
(Moreau 1988). Both feet are taken at the same instant. Flat on its base the body has one velocity along the ground, so
that only the sum of the ``P_t`` is determined: it is shared as the ``P_n`` are.
"""

from itertools import combinations
from typing import NamedTuple

from rocking.dynamics.contact.base import BOTH, LEFT, RIGHT, Footing
from rocking.dynamics.contact.state import PlanarState, along, away, kept, kinetic
from rocking.outcome import Status

_ROUNDING = 1e-13


class Struck(NamedTuple):
    """What an impact does."""

    state: PlanarState  # the state after it
    normal: dict[int, float]  # vertical impulse at each foot, per unit of mass [m/s]
    tangential: float  # sum of the impulses along the ground, per unit of mass [m/s]
    slip: int  # direction in which the feet slide while they are struck; 0 if they stick


def strike(footing: Footing, state: PlanarState, friction: float, bounce: dict[int, float]) -> Struck | Status:
    """Return what an impact does.

    friction: Coulomb's coefficient [-]; bounce: e_N of each foot that touches [-]. Returns the state after it with the
    impulses; a status where there is no solution, where two of them differ, or where energy would be created.
    """
    targets = {foot: -bounce[foot] * away(footing, state, foot) for foot in state.touching}  # Eq. 70
    speed = largest_speed(footing, state)
    # Eq. 20
    good = [s for s in _solutions(footing, state, friction, targets) if _valid(footing, s, friction, targets, speed)]
    if not good:
        return Status.NO_CONTACT_FORCE
    if any(_differ(footing, good[0].state, other.state, speed) for other in good[1:]):
        return Status.AMBIGUOUS
    if kinetic(footing, good[0].state) > kinetic(footing, state) * (1.0 + 10.0 * _ROUNDING):
        return Status.ENERGY_GAIN
    return good[0]


def largest_speed(footing: Footing, state: PlanarState) -> float:
    """Return the size of the velocities from which those of the feet are differences.

    Returns by which their rounding is measured [m/s].
    """
    return max(abs(state.u), abs(state.w), footing.size * abs(state.spin))


def _solutions(footing: Footing, state: PlanarState, friction: float, targets: dict[int, float]) -> list[Struck]:
    """Every choice of feet that take part and of how they slide, whether or not it is valid."""
    parts = [part for n in range(1, len(targets) + 1) for part in combinations(state.touching, n)]
    tried = (_try(footing, state, part, slip, friction, targets) for slip in (0, 1, -1) for part in parts)
    return [struck for struck in tried if struck is not None]


def _try(
    footing: Footing, state: PlanarState, feet: tuple[int, ...], slip: int, friction: float, targets: dict[int, float]
) -> Struck | None:
    pull = slip * friction if slip else 0.0
    if len(feet) == 2:
        return _on_both(footing, state, slip, pull, targets)
    if slip:
        return _sliding_on_one(footing, state, feet[0], slip, pull, targets[feet[0]])
    return _on_one(footing, state, feet[0], targets[feet[0]])


def _on_one(footing: Footing, state: PlanarState, foot: int, target: float) -> Struck:
    """Momentum about the foot is kept but for what the bounce takes."""
    r_x, r_z = footing.arm(foot, state.rotation)
    j = footing.inertia
    spin = (j * state.spin - r_z * state.u + r_x * (state.w - target)) / (j + r_x**2 + r_z**2)  # Eq. 71
    after = state._replace(u=-(r_z * spin), w=target + r_x * spin, spin=spin)
    return Struck(after, {foot: after.w - state.w}, after.u - state.u, 0)


def _sliding_on_one(
    footing: Footing, state: PlanarState, foot: int, slip: int, pull: float, target: float
) -> Struck | None:
    r_x, r_z = footing.arm(foot, state.rotation)
    level = r_x + pull * r_z
    stiff = 1.0 + r_x * level / footing.inertia
    if not stiff > 0.0:
        return None
    normal = (target - away(footing, state, foot)) / stiff  # Eq. 72
    spin = state.spin - normal * level / footing.inertia
    after = state._replace(u=state.u - pull * normal, w=target + r_x * spin, spin=spin)
    return Struck(after, {foot: normal}, -(pull * normal), slip)


def _on_both(footing: Footing, state: PlanarState, slip: int, pull: float, targets: dict[int, float]) -> Struck:
    left, right, base = footing.left, footing.right, footing.base
    spin = (targets[LEFT] - targets[RIGHT]) / base  # Eq. 73
    w = (targets[LEFT] * right + targets[RIGHT] * left) / base
    total = w - state.w
    u = state.u - pull * total if slip else footing.height * spin
    tangential = u - state.u
    turn = tangential * footing.height + footing.inertia * (spin - state.spin)
    normal = {LEFT: (total * right + turn) / base, RIGHT: (total * left - turn) / base}  # Eq. 73
    return Struck(state._replace(u=u, w=w, spin=spin), normal, tangential, slip)


def _valid(footing: Footing, struck: Struck, friction: float, targets: dict[int, float], speed: float) -> bool:
    slack = _ROUNDING * speed
    if not all(p >= -slack for p in struck.normal.values()):
        return False
    if not all(away(footing, struck.state, foot) >= target - slack for foot, target in targets.items()):
        return False
    if struck.slip:
        return struck.slip * along(footing, struck.state, next(iter(struck.normal))) >= -slack
    return abs(struck.tangential) <= friction * sum(struck.normal.values()) + slack * (1.0 + friction)


def _differ(footing: Footing, one: PlanarState, other: PlanarState, speed: float) -> bool:
    gap = max(abs(one.u - other.u), abs(one.w - other.w), footing.height * abs(one.spin - other.spin))
    return gap > 1e-8 * speed


def cleaned(footing: Footing, struck: Struck, stop: float) -> PlanarState:
    """Return the state after an impact with rounding taken out of velocities that are zero.

    stop: velocities of a foot below this are zero [m/s]. Returns the state; its feet are still those that touched
    before.
    """
    state = struck.state
    resting = tuple(foot for foot in state.touching if abs(away(footing, state, foot)) <= stop)
    if not resting:
        return state
    stick = abs(along(footing, state, resting[0])) <= stop
    if resting == BOTH:
        return kept(footing, state, resting, stick=stick)
    return kept(footing, state, resting, stick=stick)._replace(touching=state.touching)
