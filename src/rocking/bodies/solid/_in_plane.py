"""A body in space seen from the side: its silhouette as a plane body with the same moments."""

import math
from typing import Any

import numpy as np

from rocking.bodies.moments import SolidMoments
from rocking.bodies.section import Section
from rocking.bodies.solid.base import Base, RoundBase, SupportPolygon, hull
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.shape import placed_points
from rocking.bodies.solid.turned import Turned
from rocking.conventions import FloatArray
from rocking.errors import GeometryError

_ROUND = 64


def plane_body(parts: tuple[Part, ...], base: Base, moments: SolidMoments) -> Section:
    """Return parts on z = 0 with a base and moments as they rock about y, from edge to edge of the base along x."""
    feet = _feet(base)
    ground = np.array([[foot, 0.0, 0.0] for foot in feet])
    seen = np.concatenate([ground, *(_points(part) for part in parts)])[:, [0, 2]]
    seen[:, 1] = np.maximum(seen[:, 1], 0.0)  # what lies within the tolerance of the base stands on it
    outline = hull(seen).vertices
    depth = float(np.ptp([part.box()[:, 1] for part in parts]))
    x, _, z = moments.centre.tolist()
    polar = float(moments.second[0, 0] + moments.second[2, 2])
    known: dict[str, Any] = {"mass": moments.mass, "centre": (x, z), "moment_of_inertia": polar}
    return Section.from_points(outline, feet=feet, depth=depth, **known)


def _feet(base: Base) -> tuple[float, float]:
    if isinstance(base, RoundBase):
        return float(base.centre[0]) - base.radius, float(base.centre[0]) + base.radius
    assert isinstance(base, SupportPolygon)
    return float(base.vertices[:, 0].min()), float(base.vertices[:, 0].max())


def _points(part: Part) -> FloatArray:
    """Return points with the convex hull of the part; of round ones polygons with exact extremes."""
    shape = part.shape
    if isinstance(shape, Polyhedron):
        return placed_points(shape.vertices, part.rotation, part.translation)
    if not isinstance(shape, Turned):
        raise GeometryError(f"a {type(shape).__name__} has no outline from the side")
    radius, height = shape.profile()
    u, v = shape.half_axes[0] * part.rotation[:, 0], shape.half_axes[1] * part.rotation[:, 1]
    extremes = [math.atan2(v[k], u[k]) + turn for k in (0, 2) for turn in (0.0, math.pi)]
    turns = np.concatenate([extremes, 2.0 * math.pi * np.arange(_ROUND) / _ROUND])
    circle = np.outer(np.cos(turns), u) + np.outer(np.sin(turns), v)
    axis = np.outer(height, part.rotation[:, 2])
    points: FloatArray = (axis[:, None] + radius[:, None, None] * circle + part.translation).reshape(-1, 3)
    return points
