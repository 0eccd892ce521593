"""Motions of a batch: components that share their samples are joined at once, others stretch by stretch."""

from collections.abc import Sequence

import numpy as np

from rocking.dynamics.space.ground import Component, SpatialGround, ground_of
from rocking.motions.motion import GroundMotion


def joined(components: tuple[Component, ...], until: float) -> SpatialGround:
    """Return up to three components as one motion, the same as `ground_of` gives.

    until: when the ground is taken to stop, if that is before the motions end [s].

    >>> joined((GroundMotion([0.0, 1.0, 0.0], 0.5), None), np.inf).coefficients[:, 0].tolist()
    [[0.0, 1.0], [1.0, -1.0]]
    """
    if not _alike([part for part in components if part is not None]):
        return ground_of(*components, until=until)
    parts = [(which, part.segments()) for which, part in enumerate(components) if part is not None]
    count = max(segments.count for _, segments in parts)
    times = np.asarray(np.arange(count + 1) * parts[0][1].step, dtype=np.float64)
    made = np.zeros((count, 3, 2))
    for which, segments in parts:
        made[: segments.count, which] = segments.horizontal
    kept = int(np.searchsorted(times, until * (1.0 - 1e-12), side="left")) + 1
    return SpatialGround(times[:kept], made[: kept - 1])


def _alike(components: Sequence[Component]) -> bool:
    """Whether they are records with one step, and without a vertical part of their own."""
    if not components or not all(isinstance(part, GroundMotion) and part.vertical is None for part in components):
        return False
    return len({part.time_step for part in components if isinstance(part, GroundMotion)}) == 1
