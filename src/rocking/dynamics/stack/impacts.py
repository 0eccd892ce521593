"""Impact of a joint of a stack, without a history."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking import checks, conventions
from rocking.bodies.stack import Stack
from rocking.dynamics.stack.chain import Chain
from rocking.dynamics.stack.contact_choice import after_impact
from rocking.dynamics.stack.start import values_per_body
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class StackImpact:
    """Velocities and contacts after an impact of a joint.

    Parameters
    ----------
    angular_velocity : tuple of float
        theta' of every body after the impact, lowest first [rad/s].
    sides : tuple of int
        Corner in contact of every joint after the impact: 1 right, -1 left, 0 both.
    impulses : tuple of float
        Normal impulses of the corners in contact [N s].
    gap_velocities : tuple of float
        Normal velocities of these corners after the impact [m/s].
    energy_lost : float
        Lost kinetic energy [J].

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=2.0)
    >>> rk.dynamics.stack_impact(rk.Stack([block]), joint=1, sides=(1,), angular_velocity=(-1.0,)).sides
    (-1,)
    """

    angular_velocity: tuple[float, ...]
    sides: tuple[int, ...]
    impulses: tuple[float, ...]
    gap_velocities: tuple[float, ...]
    energy_lost: float


def stack_impact(
    stack: Stack,
    joint: int,
    sides: Sequence[int],
    angular_velocity: Sequence[float],
    rotation: float | Sequence[float] = 0.0,
) -> StackImpact:
    """Return the velocities after a plastic impact of one joint of a stack whose joints stick.

    The velocity after the impact is the projection of the velocity before the impact onto the velocities without
    interpenetration, in the norm of the kinetic energy (docs/theory/stacks.md). The projection is unique.

    Parameters
    ----------
    stack : Stack
        The stack.
    joint : int
        Number of the joint that closes; 1 is the joint on the ground.
    sides : sequence of int
        Corner of rotation of every joint before the impact: 1 right, -1 left, 0 closed.
    angular_velocity : sequence of float
        theta' of every body before the impact, lowest first [rad/s].
    rotation : float or sequence of float
        theta of every body [rad].

    Returns
    -------
    StackImpact
        Velocities, contacts, impulses and energy loss.

    Raises
    ------
    InvalidValueError
        If there is no such joint, or the number of values differs from the number of bodies.

    Examples
    --------
    >>> import rocking as rk
    >>> low, tall = rk.Block(width=2.0, height=1.0), rk.Block(width=1.0, height=4.0)
    >>> impact = rk.dynamics.stack_impact(rk.Stack([low, tall]), joint=1, sides=(1, 0), angular_velocity=(-1.0, -1.0))
    >>> impact.sides, round(68.0 * impact.angular_velocity[1], 9)  # the lower block stops
    ((0, -1), -83.0)
    """
    checks.of_kind("stack", stack, Stack, "a Stack")
    count = len(stack.bodies)
    index = checks.whole("joint", joint, 1, count) - 1
    corners = tuple(checks.whole("sides", side, -1, 1) for side in (sides if np.ndim(sides) else [sides]))
    if len(corners) != count:
        raise InvalidValueError(parameter="sides", allowed=f"{count} values of -1, 0 and 1", value=sides)
    chain = Chain.of(stack, conventions.g)
    rates = values_per_body("angular_velocity", angular_velocity, count)
    angles = values_per_body("rotation", rotation, count)
    flat = {k for k, side in enumerate(corners) if side == 0} | {index}
    solution = after_impact(chain, corners, angles, rates, flat)
    after = [solution.side_of(k) for k in range(count)]
    if any(side is None for side in after):
        raise InvalidValueError("both corners of a joint leave the contact after this impact")
    new = tuple((after[k] or 0) if k in flat else corners[k] for k in range(count))
    velocity = solution.motion[2::3]
    for k, side in enumerate(new):
        if side == 0:
            velocity[k] = velocity[k - 1] if k else 0.0
    lost = chain.energy(corners, angles, rates)[0] - chain.energy(new, angles, velocity)[0]
    normal = [k for k, row in enumerate(solution.rows) if row.is_one_sided]
    return StackImpact(
        tuple(velocity), new, tuple(solution.multipliers[k] for k in normal), tuple(solution.gaps[k] for k in normal),
        lost,
    )  # fmt: skip
