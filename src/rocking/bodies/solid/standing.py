"""Poses of parts: equilibria, rings of bodies of revolution, stable poses, and views from the side."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from rocking.bodies.equilibria import Equilibria, Equilibrium, Ring, StablePose, equilibria, poses
from rocking.bodies.moments import SolidMoments
from rocking.bodies.section import Section
from rocking.bodies.solid.base import Base, RoundBase, SupportPolygon, hull
from rocking.bodies.solid.part import Part, footprint
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.surfaces import placed_points
from rocking.bodies.solid.turned import Turned
from rocking.conventions import Assumed, FloatArray, g
from rocking.errors import GeometryError
from rocking.messages import Message
from rocking.portable import applied, dot, norm, times

_ROUND = 1e-4
"""Smallest energy barrier / size of a body with round faces, above the barriers between 360 corners."""
_COAXIAL = 1e-9
_CHORDS = 4000
_CHORD = 0.02
_AHEAD = 1e-9


def equilibria_of(parts: Sequence[Part], moments: SolidMoments, size: float, min_barrier: float | None) -> Equilibria:
    """Return the equilibria of a rigid body from its parts."""
    corners = np.concatenate([placed_points(p.shape.hull_points(), p.rotation, p.translation) for p in parts])
    rounded = any(isinstance(part.shape, Turned) for part in parts)
    lowest_barrier = _ROUND * size * rounded if min_barrier is None else min_barrier
    faces = parts[0].shape.faces if len(parts) == 1 and isinstance(parts[0].shape, Polyhedron) else None
    result = equilibria(
        corners, moments.centre, moments.mass, faces=faces, min_barrier=lowest_barrier, standing=(0.0, 0.0, -1.0)
    )
    vertices = [
        placed_points(p.shape.vertices, p.rotation, p.translation)
        for p in parts
        if isinstance(p.shape, Polyhedron) and len(p.shape.vertices) > len(p.shape.hull_points())
    ]
    if vertices:  # points inside the hull can be near the ground
        result = replace(
            result, surface=np.concatenate([result.surface, *(vertex_set - result.centre for vertex_set in vertices)])
        )
    if not rounded:
        return result
    result = replace(result, notes=(*result.notes, Message("round faces are polygons with 360 corners")))
    axis = _axis(parts, moments.centre, size)
    return result if axis is None else _revolved(result, parts, axis)


def set_down(parts: Sequence[Part], pose: StablePose, size: float) -> tuple[list[Part], SupportPolygon | None]:
    """Return the parts in a pose, and its support polygon; None for a round base."""
    turn, c, up = pose.rotation, pose.centre, np.array([0.0, 0.0, pose.height])
    turned = [
        Part(p.shape, p.density, rotation=times(turn, p.rotation), translation=applied(turn, p.translation - c) + up)
        for p in parts
    ]
    on_rim = any(footprint(part, 0.0, _COAXIAL * size)[1] for part in turned)
    return turned, None if on_rim else hull(pose.support)


def stands(points: FloatArray, centre: FloatArray, tolerance: float) -> bool:
    """Return True if the centre of mass is above the hull of all points within a tolerance of the lowest point [m]."""
    low = points[points[:, 2] <= points[:, 2].min() + tolerance, :2]
    try:
        return hull(low).margin(centre[:2]) > 1e-12 * float(np.ptp(points, axis=0).max())
    except GeometryError:
        return False


def settled(points: FloatArray, centre: FloatArray) -> FloatArray:
    """Return the rotation from the present pose onto a stable facet of the hull."""
    # The downward ray from the centre of mass leaves the hull through a facet. The body is rotated onto this facet,
    # repeatedly, until the ray leaves through the lowest facet. Each rotation lowers the centre of mass from z /
    # cos(angle) to z.
    from scipy.spatial import ConvexHull

    equations = ConvexHull(points - centre).equations
    normals, distances = equations[:, :3], -equations[:, 3]
    down, lowest = np.array([0.0, 0.0, -1.0]), np.inf
    while True:
        ahead = normals @ down
        through = np.divide(distances, ahead, out=np.full(len(ahead), np.inf), where=ahead > _AHEAD)
        facet = int(np.argmin(through))
        if not distances[facet] < lowest * (1.0 - 1e-12):
            return poses.set_down(down)
        down, lowest = normals[facet], float(distances[facet])


def _axis(parts: Sequence[Part], centre: FloatArray, size: float) -> FloatArray | None:
    """Return the common axis of revolution of all parts, or None."""
    axis = parts[0].rotation[:, 2]
    for part in parts:
        if not isinstance(part.shape, Turned) or part.shape.half_axes[0] != part.shape.half_axes[1]:
            return None
        off = np.cross(part.translation - centre, axis)
        if np.abs(np.cross(part.rotation[:, 2], axis)).max() > _COAXIAL or np.abs(off).max() > _COAXIAL * size:
            return None
    return axis


def _revolved(equilibria_of_hull: Equilibria, parts: Sequence[Part], axis: FloatArray) -> Equilibria:
    """Return the equilibria of a body of revolution, with rings in place of equilibria off its axis."""
    profile = np.concatenate([_profile(part, axis, equilibria_of_hull.centre) for part in parts])
    curved = any(piece.arc for part in parts for piece in cast(Turned, part.shape).meridians)
    tolerance = _CHORD if curved else _COAXIAL

    def is_ring(equilibrium: Equilibrium) -> bool:
        return norm(np.cross(axis, equilibrium.down)) > tolerance

    rings = [
        _ring(equilibrium, axis, profile)
        for equilibrium in (*equilibria_of_hull.stable, *equilibria_of_hull.summits)
        if is_ring(equilibrium)
    ]
    points = [equilibrium for equilibrium in equilibria_of_hull.stable if not is_ring(equilibrium)]
    low = min([*(equilibrium_point.height for equilibrium_point in points), *(ring.height for ring in rings)])
    order = {
        equilibrium.number: i for i, equilibrium in enumerate([*points, *filter(is_ring, equilibria_of_hull.stable)])
    }

    def energy(height: float) -> float:
        return equilibria_of_hull.mass * g * (height - low)

    apart = Message(
        "{count} circle of equilibria is listed separately: the body of revolution can roll along it",
        {"count": len(rings)},
        "{count} circles of equilibria are listed separately: the body of revolution can roll along them",
    )
    return replace(
        equilibria_of_hull,
        stable=tuple(
            replace(equilibrium, number=order[equilibrium.number], energy=energy(equilibrium.height))
            for equilibrium in points
        ),
        saddles=(),
        summits=tuple(
            replace(equilibrium, energy=energy(equilibrium.height))
            for equilibrium in equilibria_of_hull.summits
            if not is_ring(equilibrium)
        ),
        rings=tuple(replace(ring, energy=energy(ring.height)) for ring in rings),
        notes=(*equilibria_of_hull.notes, apart),
        basins={facet: order[number] for facet, number in equilibria_of_hull.basins.items()},
        links=tuple((order[equilibrium], order[other], top) for equilibrium, other, top in equilibria_of_hull.links),
    )


def _profile(part: Part, axis: FloatArray, centre: FloatArray) -> FloatArray:
    shape = cast(Turned, part.shape)
    radius, height = shape.profile(_CHORDS)
    up = dot(part.rotation[:, 2], axis)
    return np.stack([shape.half_axes[0] * radius, dot(part.translation - centre, axis) + up * height], axis=1)


def _ring(equilibrium: Equilibrium, axis: FloatArray, profile: FloatArray) -> Ring:
    sign = 1.0 if equilibrium.kind == "stable" else -1.0
    start = math.acos(-dot(axis, equilibrium.down))
    low, high = max(start - _CHORD, 0.0), min(start + _CHORD, math.pi)

    def height(tilt: float) -> float:
        return sign * float((profile[:, 0] * math.sin(tilt) - profile[:, 1] * math.cos(tilt)).max())  # Eq. 248

    # ternary search, because the height has a kink at its minimum
    for _ in range(80):
        third = (high - low) / 3.0
        low, high = (low, high - third) if height(low + third) < height(high - third) else (low + third, high)
    return Ring("stable" if sign > 0.0 else "summit", 0.5 * (low + high), sign * height(0.5 * (low + high)), 0.0)


_AROUND = 64


def plane_body(parts: tuple[Part, ...], base: Base, moments: SolidMoments) -> Section:
    """Return the 2D body of parts on z = 0 that rocks about y, between the ends of the base along x."""
    feet = _feet(base)
    ground = np.array([[foot, 0.0, 0.0] for foot in feet])
    silhouette = np.concatenate([ground, *(_points(part) for part in parts)])[:, [0, 2]]
    silhouette[:, 1] = np.maximum(silhouette[:, 1], 0.0)  # points within the tolerance lie on the ground
    outline = hull(silhouette).vertices
    depth = Assumed(np.ptp([part.box()[:, 1] for part in parts]))  # extent of the solid, not a second base
    x, _, z = moments.centre.tolist()
    polar = float(moments.second[0, 0] + moments.second[2, 2])
    moments_of_section: dict[str, Any] = {"mass": moments.mass, "centre": (x, z), "moment_of_inertia": polar}
    return Section.from_points(outline, feet=feet, depth=depth, **moments_of_section)


def _feet(base: Base) -> tuple[float, float]:
    if isinstance(base, RoundBase):
        return float(base.centre[0]) - base.radius, float(base.centre[0]) + base.radius
    assert isinstance(base, SupportPolygon)
    return float(base.vertices[:, 0].min()), float(base.vertices[:, 0].max())


def _points(part: Part) -> FloatArray:
    """Return points with the convex hull of the part; round shapes are polygons with exact extremes."""
    shape = part.shape
    if isinstance(shape, Polyhedron):
        return placed_points(shape.vertices, part.rotation, part.translation)
    if not isinstance(shape, Turned):
        raise GeometryError("A {type} has no outline from the side.", type=type(shape).__name__)
    radius, height = shape.profile()
    u, v = shape.half_axes[0] * part.rotation[:, 0], shape.half_axes[1] * part.rotation[:, 1]
    extremes = [math.atan2(v[k], u[k]) + turn for k in (0, 2) for turn in (0.0, math.pi)]
    turns = np.concatenate([extremes, 2.0 * math.pi * np.arange(_AROUND) / _AROUND])
    circle = np.outer(np.cos(turns), u) + np.outer(np.sin(turns), v)
    axis = np.outer(height, part.rotation[:, 2])
    points: FloatArray = (axis[:, None] + radius[:, None, None] * circle + part.translation).reshape(-1, 3)
    return points
