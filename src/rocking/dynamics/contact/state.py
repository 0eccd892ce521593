"""Position and velocity of the body relative to the ground, and which feet touch it."""

from typing import NamedTuple

from rocking.dynamics.contact.base import BOTH, PlaneBase


class ContactState(NamedTuple):
    """Where the body is and how it moves."""

    # x, rise, rotation: displacement of the centre of mass to the right [m] and upwards [m] from where it stood, and
    # theta [rad]
    x: float = 0.0
    rise: float = 0.0
    rotation: float = 0.0
    u: float = 0.0  # u, w, spin: their rates [m/s, m/s, rad/s]
    w: float = 0.0
    spin: float = 0.0
    touching: tuple[int, ...] = BOTH  # feet that touch the ground, exactly


def along(base: PlaneBase, state: ContactState, foot: int) -> float:
    """Return the velocity of a foot along the ground.

    Returns v_t, to the right; exactly zero where the foot was made to stick [m/s].
    """
    return state.u + base.arm(foot, state.rotation)[1] * state.spin  # Eq. 60


def away(base: PlaneBase, state: ContactState, foot: int) -> float:
    """Return the velocity of a foot away from the ground.

    Returns v_n, upwards; exactly zero where the foot was put to rest [m/s].
    """
    return state.w - base.arm(foot, state.rotation)[0] * state.spin  # Eq. 61


def kept(base: PlaneBase, state: ContactState, feet: tuple[int, ...], *, stick: bool) -> ContactState:
    """Return the state with rounding taken out of what the contacts fix.

    Returns with ``v_n = 0``, and ``v_t = 0`` if they stick, exactly.
    """
    if not feet:
        return state
    if len(feet) == 2:
        u = 0.0 if stick else along(base, state, feet[0])
        return ContactState(state.x, 0.0, 0.0, u, 0.0, 0.0, feet)
    (foot,) = feet
    r_x, r_z = base.arm(foot, state.rotation)
    u = -(r_z * state.spin) if stick else state.u
    return state._replace(rise=base.rise_on(foot, state.rotation), u=u, w=r_x * state.spin)


def kinetic(base: PlaneBase, state: ContactState) -> float:
    """Return the kinetic energy in the frame of the ground, per unit of mass.

    Returns ``(x'^2 + z'^2 + (I_C / m) theta'^2) / 2`` [J/kg].
    """
    return 0.5 * (state.u**2 + state.w**2 + base.inertia * state.spin**2)  # Eq. 62
