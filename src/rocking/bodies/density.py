"""Density of a body at points: what the fields and pictures sample."""

from functools import singledispatch

import numpy as np

from rocking.bodies.block import Block
from rocking.bodies.body import Body
from rocking.bodies.section import Section
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError


@singledispatch
def density_at(body: Body, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the density of a body at points.

    x, y: points in the user's coordinates, of one shape [m]. Returns Density, zero outside the body [kg/m3].

    >>> density_at(Block(width=1.0, height=2.0, density=1000.0), np.array([0.5, 1.5]), np.array([1.0, 1.0])).tolist()
    [1000.0, 0.0]
    """
    raise InvalidValueError(f"a {type(body).__name__} body has no density field")


@density_at.register
def _(body: Block, x: FloatArray, y: FloatArray) -> FloatArray:
    inside = (x >= 0.0) & (x <= body.width) & (y >= 0.0) & (y <= body.height)
    return np.where(inside, body.density, 0.0)


@density_at.register
def _(body: Section, x: FloatArray, y: FloatArray) -> FloatArray:
    import shapely

    local_x, local_y = np.asarray(x) - body.origin_x, np.asarray(y) - body.ground
    density = np.zeros(np.broadcast_shapes(local_x.shape, local_y.shape))
    for region in body.regions:
        polygon = shapely.Polygon(region.outline, region.holes)
        shapely.prepare(polygon)
        density[shapely.intersects_xy(polygon, local_x, local_y)] = region.density
    return density
