"""Regime after a sudden ground acceleration of a body at rest: Shenton's map (1996; docs/theory/contact.md)."""

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane_frictional.base import LEFT, RIGHT, ContactState, PlaneBase
from rocking.dynamics.plane_frictional.event_functions import NextMode, choose
from rocking.dynamics.plane_frictional.mode_series import GroundSeries
from rocking.errors import InvalidValueError
from rocking.outcome import Regime


def friction_demand(body: Body, acceleration: float) -> float:
    """Return the friction demand of a body at the start of rocking.

    Parameters
    ----------
    body : Body
        The body.
    acceleration : float
        Horizontal acceleration of the ground / gravity [-]. It must exceed b / h of the foot of rotation.

    Returns
    -------
    float
        Coefficient of friction [-]. With a smaller coefficient, the foot slides.

    Raises
    ------
    InvalidValueError
        If the acceleration is too small for uplift.

    Examples
    --------
    >>> from rocking import Block
    >>> round(friction_demand(Block(width=1.0, height=4.0), 0.5), 11)
    0.30985915493
    """
    push = checks.number("acceleration", acceleration)
    base = PlaneBase.of_body(body)
    lever, height = abs(base.lever(LEFT if push > 0.0 else RIGHT)), base.height
    if not abs(push) * height >= lever:
        raise InvalidValueError(
            "acceleration must be at least b / h = {slenderness:g} for uplift, got {acceleration:g}",
            slenderness=lever / height,
            acceleration=push,
        )
    spin = (abs(push) * height - lever) / (base.inertia + lever**2 + height**2)
    return abs(abs(push) - height * spin) / (1.0 + lever * spin)  # Eq. 76


def regime_at_start(
    body: Body, acceleration: float, friction: float, *, vertical: float = 0.0, gravity: float = conventions.g
) -> Regime:
    """Return the regime at the start of motion of a body at rest, by complementarity.

    Parameters
    ----------
    body : Body
        The body.
    acceleration : float
        Horizontal acceleration of the ground / gravity [-].
    friction : float
        Coulomb's coefficient [-].
    vertical : float
        Vertical acceleration of the ground / gravity, positive upwards [-].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    Regime
        The regime.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or no contact force is possible.

    Examples
    --------
    >>> from rocking import Block
    >>> regime_at_start(Block(width=1.0, height=4.0), 0.5, 0.3).name
    'SLIDE_ROCK'
    """
    base = PlaneBase.of_body(body)
    gravity = checks.positive("gravity", gravity, "m/s2")
    push, lift = checks.number("acceleration", acceleration), checks.number("vertical", vertical)
    mu = checks.within("friction", friction, 0.0, 1e6)
    ground = GroundSeries([push * gravity], [gravity + lift * gravity], float(np.sqrt(base.size / gravity)))
    mode = choose(base, ContactState(), ground, mu)
    if not isinstance(mode, NextMode):
        raise InvalidValueError(
            "no contact force with friction {friction:g} and acceleration {acceleration:g}; reduce one of them",
            friction=mu, acceleration=push,
        )  # fmt: skip
    return mode.mode.regime


def analytic_regime(body: Body, acceleration: float, friction: float) -> Regime:
    """Return the regime at the start of motion of a body at rest, by Shenton's boundaries.

    Parameters
    ----------
    body : Body
        The body.
    acceleration : float
        Horizontal acceleration of the ground / gravity [-].
    friction : float
        Coulomb's coefficient [-].

    Returns
    -------
    Regime
        The regime. On a boundary, the regime with less motion.
    """
    base = PlaneBase.of_body(body)
    push = checks.number("acceleration", acceleration)
    slender = abs(base.lever(LEFT if push > 0.0 else RIGHT)) / base.height
    if abs(push) <= min(friction, slender):
        return Regime.REST
    if friction < slender:
        return Regime.SLIDE
    return Regime.ROCK if friction >= friction_demand(body, push) else Regime.SLIDE_ROCK  # Eq. 77


def regime_map(body: Body, accelerations: FloatArray, frictions: FloatArray) -> IntArray:
    """Return the map of regimes at the start, by complementarity.

    Parameters
    ----------
    body : Body
        The body.
    accelerations, frictions : ndarray
        Horizontal accelerations / gravity, and coefficients of friction [-].

    Returns
    -------
    ndarray, shape (frictions, accelerations)
        `Regime.code`.
    """
    rows = [[regime_at_start(body, a, mu).code for a in accelerations.tolist()] for mu in frictions.tolist()]
    return np.array(rows, dtype=np.int64)
