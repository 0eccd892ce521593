"""The top edge of a body that carries another body or a beam."""

import numpy as np

from rocking.bodies.block import Block
from rocking.bodies.body import Body
from rocking.bodies.section import Section
from rocking.errors import GeometryError

_FLAT = 1e-9  # largest height of a vertex below the top edge, over the height of the body


def top_edge(body: Body) -> tuple[float, float]:
    """Return the ends of the horizontal top edge in the local frame [m]. All vertices at the top are on this edge."""
    left, low, right, high = body.local_box
    if isinstance(body, Block):
        return left, right
    if isinstance(body, Section):
        room, ends, edges = _FLAT * (right - left), list[float](), list[list[float]]()
        for region in body.regions:
            tops = region.outline[:, 1] >= high - _FLAT * (high - low)
            ends += region.outline[tops, 0].tolist()
            pairs = np.column_stack([region.outline[:, 0], np.roll(region.outline[:, 0], -1)])
            edges += np.sort(pairs[tops & np.roll(tops, -1)]).tolist()
        reach = min(ends)
        for start, end in sorted(edges):
            reach = max(reach, end) if start <= reach + room else reach
        if reach > min(ends) + room and reach >= max(ends) - room:
            return float(min(ends)), float(max(ends))
    raise GeometryError("{type} below another body needs a horizontal top edge", type=type(body).__name__)
