"""How parts can stand: equilibria, rings of what is turned; parts set down or let down, and seen from the side."""

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
from rocking.conventions import FloatArray, g
from rocking.errors import GeometryError
from rocking.messages import Message
from rocking.portable import applied, dot, norm, times

_ROUND = 1e-4
"""Least barrier that counts of a body with round faces, relative to its size: more than flats of 360 corners leave."""
_COAXIAL = 1e-9
_CHORDS = 4000
_CHORD = 0.02
_AHEAD = 1e-9


def equilibria_of(parts: Sequence[Part], moments: SolidMoments, size: float, min_barrier: float | None) -> Equilibria:
    """Return the equilibria of parts that are one rigid body."""
    corners = np.concatenate([placed_points(p.shape.hull_points(), p.rotation, p.translation) for p in parts])
    rounded = any(isinstance(part.shape, Turned) for part in parts)
    least = _ROUND * size * rounded if min_barrier is None else min_barrier
    faces = parts[0].shape.faces if len(parts) == 1 and isinstance(parts[0].shape, Polyhedron) else None
    found = equilibria(corners, moments.centre, moments.mass, faces=faces, min_barrier=least, standing=(0.0, 0.0, -1.0))
    whole = [
        placed_points(p.shape.vertices, p.rotation, p.translation)
        for p in parts
        if isinstance(p.shape, Polyhedron) and len(p.shape.vertices) > len(p.shape.hull_points())
    ]
    if whole:  # points inside the hull may be near the ground
        found = replace(found, surface=np.concatenate([found.surface, *(each - found.centre for each in whole)]))
    if not rounded:
        return found
    found = replace(found, notes=(*found.notes, Message("round faces are taken as those of 360 corners")))
    axis = _axis(parts, moments.centre, size)
    return found if axis is None else _revolved(found, parts, axis)


def set_down(parts: Sequence[Part], pose: StablePose, size: float) -> tuple[list[Part], SupportPolygon | None]:
    """Return parts turned so that they stand in a pose, and its support polygon; none where they have a round base."""
    turn, c, up = pose.rotation, pose.centre, np.array([0.0, 0.0, pose.height])
    turned = [
        Part(p.shape, p.density, rotation=times(turn, p.rotation), translation=applied(turn, p.translation - c) + up)
        for p in parts
    ]
    on_rim = any(footprint(part, 0.0, _COAXIAL * size)[1] for part in turned)
    return turned, None if on_rim else hull(pose.support)


def stands(points: FloatArray, centre: FloatArray, tolerance: float) -> bool:
    """Return whether the centre lies above the hull of the points that are within a tolerance of the lowest [m]."""
    low = points[points[:, 2] <= points[:, 2].min() + tolerance, :2]
    try:
        return hull(low).margin(centre[:2]) > 1e-12 * float(np.ptp(points, axis=0).max())
    except GeometryError:
        return False


def settled(points: FloatArray, centre: FloatArray) -> FloatArray:
    """Return the rotation that lets a body down, from as it is onto a facet of its hull that holds its centre."""
    # The ray from the centre downward leaves the hull through a facet; the body is turned onto that, and again, until
    # the ray leaves through the facet that it lies on. The centre comes lower each time: from z / cos(angle) to z.
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
    """Return the axis about which all parts are turned, if there is one."""
    axis = parts[0].rotation[:, 2]
    for part in parts:
        if not isinstance(part.shape, Turned) or part.shape.half_axes[0] != part.shape.half_axes[1]:
            return None
        off = np.cross(part.translation - centre, axis)
        if np.abs(np.cross(part.rotation[:, 2], axis)).max() > _COAXIAL or np.abs(off).max() > _COAXIAL * size:
            return None
    return axis


def _revolved(found: Equilibria, parts: Sequence[Part], axis: FloatArray) -> Equilibria:
    """Return the equilibria of a body of revolution: those off its axis stand for rings."""
    profile = np.concatenate([_profile(part, axis, found.centre) for part in parts])
    curved = any(piece.arc for part in parts for piece in cast(Turned, part.shape).meridians)
    off = _CHORD if curved else _COAXIAL

    def is_ring(one: Equilibrium) -> bool:
        return norm(np.cross(axis, one.down)) > off

    rings = [_ring(one, axis, profile) for one in (*found.stable, *found.summits) if is_ring(one)]
    points = [one for one in found.stable if not is_ring(one)]
    low = min([*(each.height for each in points), *(ring.height for ring in rings)])
    order = {one.number: i for i, one in enumerate([*points, *filter(is_ring, found.stable)])}

    def energy(height: float) -> float:
        return found.mass * g * (height - low)

    apart = Message(
        "{count} circle of equilibria is told apart from the others: a body of revolution rolls on it",
        {"count": len(rings)},
        "{count} circles of equilibria are told apart from the others: a body of revolution rolls on them",
    )
    return replace(
        found,
        stable=tuple(replace(one, number=order[one.number], energy=energy(one.height)) for one in points),
        saddles=(),
        summits=tuple(replace(one, energy=energy(one.height)) for one in found.summits if not is_ring(one)),
        rings=tuple(replace(ring, energy=energy(ring.height)) for ring in rings),
        notes=(*found.notes, apart),
        basins={facet: order[number] for facet, number in found.basins.items()},
        links=tuple((order[one], order[other], top) for one, other, top in found.links),
    )


def _profile(part: Part, axis: FloatArray, centre: FloatArray) -> FloatArray:
    shape = cast(Turned, part.shape)
    radius, height = shape.profile(_CHORDS)
    up = dot(part.rotation[:, 2], axis)
    return np.stack([shape.half_axes[0] * radius, dot(part.translation - centre, axis) + up * height], axis=1)


def _ring(one: Equilibrium, axis: FloatArray, profile: FloatArray) -> Ring:
    sign = 1.0 if one.kind == "stable" else -1.0
    start = math.acos(-dot(axis, one.down))
    low, high = max(start - _CHORD, 0.0), min(start + _CHORD, math.pi)

    def height(tilt: float) -> float:
        return sign * float((profile[:, 0] * math.sin(tilt) - profile[:, 1] * math.cos(tilt)).max())  # Eq. 248

    # by thirds: the height has a kink where it is least
    for _ in range(80):
        third = (high - low) / 3.0
        low, high = (low, high - third) if height(low + third) < height(high - third) else (low + third, high)
    return Ring("stable" if sign > 0.0 else "summit", 0.5 * (low + high), sign * height(0.5 * (low + high)), 0.0)


_AROUND = 64


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
        raise GeometryError("a {type} has no outline from the side", type=type(shape).__name__)
    radius, height = shape.profile()
    u, v = shape.half_axes[0] * part.rotation[:, 0], shape.half_axes[1] * part.rotation[:, 1]
    extremes = [math.atan2(v[k], u[k]) + turn for k in (0, 2) for turn in (0.0, math.pi)]
    turns = np.concatenate([extremes, 2.0 * math.pi * np.arange(_AROUND) / _AROUND])
    circle = np.outer(np.cos(turns), u) + np.outer(np.sin(turns), v)
    axis = np.outer(height, part.rotation[:, 2])
    points: FloatArray = (axis[:, None] + radius[:, None, None] * circle + part.translation).reshape(-1, 3)
    return points
