"""Where a set of regions touches the ground, and whether feet may stand there."""

import math
from collections.abc import Sequence

import numpy as np

from rocking import checks
from rocking.bodies.body import Interval
from rocking.bodies.region import Region
from rocking.errors import GeometryError

GROUND_TOLERANCE = 1e-9
"""Vertices this close to the ground, relative to the body's size, stand on it."""


def extent_on_ground(regions: Sequence[Region], size: float) -> Interval:
    """Return the ends of the base: the outermost vertices on y = 0.

    regions: in the local frame, with the ground at y = 0 [m]; size: size of the body, which scales the tolerance [m].
    Returns left and right end [m].
    """
    tolerance = GROUND_TOLERANCE * size
    touching = np.concatenate([r.outline[np.abs(r.outline[:, 1]) <= tolerance, 0] for r in regions])
    return float(touching.min()), float(touching.max())


def flat_stretches(regions: Sequence[Region], size: float, feet: Interval) -> tuple[Interval, ...]:
    """Return the stretches of the ground that edges lie on, cut at the feet and merged.

    regions: in the local frame, with the ground at y = 0 [m]; size: size of the body, which scales the tolerance [m];
    feet: positions of the feet [m]. Returns left to right [m]; none if the body stands on points.
    """
    left, right = feet
    merged: list[Interval] = []
    for a, b in ((max(a, left), min(b, right)) for a, b in sorted(_edges(regions, GROUND_TOLERANCE * size))):
        if b <= a:
            continue
        if merged and a <= merged[-1][1] + GROUND_TOLERANCE * size:
            merged[-1] = (merged[-1][0], max(b, merged[-1][1]))
        else:
            merged.append((a, b))
    return tuple(merged)


def _edges(regions: Sequence[Region], tolerance: float) -> list[Interval]:
    found: list[Interval] = []
    for region in regions:
        x, y = region.outline.T
        low = np.abs(y) <= tolerance
        both = low & np.roll(low, -1)
        ends = zip(x[both].tolist(), np.roll(x, -1)[both].tolist(), strict=True)
        found += [(min(a, b), max(a, b)) for a, b in ends]
    return found


def placed_feet(base: Interval, size: float, origin: float, feet: tuple[float, float] | None) -> Interval:
    """Return the feet in the local frame, by default the ends of the base.

    base: ends of the base in the local frame [m]; size: size of the body, which scales the tolerance [m]; origin:
    position of the local frame in the user's coordinates [m]; feet: feet in the user's coordinates [m]. Returns left
    and right foot [m].
    """
    if feet is None:
        if base[1] - base[0] <= GROUND_TOLERANCE * size:
            raise GeometryError("the body touches the ground in one point only; it needs two feet to rock")
        return base
    try:
        left, right = feet
    except (TypeError, ValueError) as error:
        raise GeometryError("feet must be a pair (x_left, x_right) in m") from error
    left = checks.number("left foot", left, "m") - origin
    right = checks.number("right foot", right, "m") - origin
    if not left < right:
        raise GeometryError(f"the left foot must lie left of the right one, got {feet[0]:g} and {feet[1]:g} m")
    slack = GROUND_TOLERANCE * size + 4.0 * math.ulp(abs(origin))
    for name, x in (("left", left), ("right", right)):
        if not base[0] - slack <= x <= base[1] + slack:
            a, b = base[0] + origin, base[1] + origin
            raise GeometryError(
                f"the {name} foot must lie on the base, x in [{a:.9g}, {b:.9g}] m, got {x + origin:.9g}"
            )
    return max(left, base[0]), min(right, base[1])
