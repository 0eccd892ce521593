"""Checks of the moments of parts, and known moments, which replace the moments of the parts."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.part import Part, rotation_about
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.surfaces import grid_points, vector
from rocking.conventions import FloatArray
from rocking.errors import GeometryError
from rocking.messages import Message
from rocking.portable import applied, times

_SLACK = 1e-6
_DIRECTIONS = 64

ASSUMED = Message(
    "inertia assumed: along each axis its ratio to the largest possible value in the bounding box is that of the parts"
)


def known_moments(
    parts: Sequence[Part], part_moments: SolidMoments, centre: FloatArray | None, inertia: Any
) -> SolidMoments:
    """Return the moments of parts, with known values in place of the computed values."""
    # The centre of mass is in the frame of the parts [m]. The inertia is the tensor about the centre of mass, or the
    # principal moments along x, y and z [kg m2]. For an unknown inertia, the second moment along each axis is scaled
    # like the largest possible value ``m (c - low) (high - c)``. low and high are the ends of the body on this axis.
    centre_of_mass = part_moments.centre if centre is None else centre
    boxes = np.array([part.box() for part in parts])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    if not ((low < centre_of_mass) & (centre_of_mass < high)).all():
        raise _misplaced(centre_of_mass - low, high - low)
    if inertia is None:
        fraction = np.sqrt(
            (centre_of_mass - low)
            * (high - centre_of_mass)
            / ((part_moments.centre - low) * (high - part_moments.centre))
        )
        moments = SolidMoments(part_moments.mass, centre_of_mass, part_moments.second * np.outer(fraction, fraction))
    else:
        moments = SolidMoments(part_moments.mass, centre_of_mass, _second(inertia))
    fraction = _reached(parts, moments, low, high - low, is_stated=inertia is not None)
    if fraction < 1.0 and inertia is None:  # an assumed inertia must be possible for the body
        return SolidMoments(part_moments.mass, centre_of_mass, moments.second * fraction)
    return moments


def _second(inertia: Any) -> FloatArray:
    """Return the second moments of an inertia, ``tr(I)/2 1 - I`` [kg m2]."""
    tensor = checks.real_array("inertia", inertia, "kg m2")
    tensor = np.diag(tensor) if tensor.shape == (3,) else tensor
    if (
        tensor.shape != (3, 3)
        or not np.isfinite(tensor).all()
        or np.abs(tensor - tensor.T).max() > _SLACK * abs(np.trace(tensor))
    ):
        raise GeometryError(
            "inertia must be a symmetric tensor of 3 x 3 finite numbers about the centre of mass [kg m2], or the "
            "moments about x, y and z if these are principal axes"
        )
    second = 0.5 * float(np.trace(tensor)) * np.eye(3) - 0.5 * (tensor + tensor.T)
    spread = np.linalg.eigvalsh(second)
    if spread[2] <= 0.0 or spread[0] < -_SLACK * spread[2]:
        raise GeometryError(
            "{parameter} violates the triangle inequality: each of the principal moments {moments} kg m2 must be at "
            "most the sum of the other two", parameter="inertia", moments=str(np.linalg.eigvalsh(tensor)),
            hint="check the sign of the products of inertia",
        )  # fmt: skip
    return second


def _reached(
    parts: Sequence[Part], moments: SolidMoments, lowest: FloatArray, size: FloatArray, *, is_stated: bool
) -> float:
    """Return the largest factor, at most 1, on the second moments that is possible for masses within the hull."""
    # The limit in every direction is ``m (c - low) (high - c)`` (R. Bhatia, C. Davis, "A better bound on the
    # variance", 2000). The check has 64 directions. A centre outside the hull is an error. With is_stated, a factor
    # below 1 is an error too.
    fraction = 1.0
    for direction in _directions():
        frame = _frame(direction)
        ends = np.array(
            [
                part.shape.extent(times(frame, part.rotation))[:, 2] + applied(frame, part.translation)[2]
                for part in parts
            ]
        )
        low, high = float(ends[:, 0].min()), float(ends[:, 1].max())
        position = float(direction @ moments.centre)
        if not low < position < high:
            raise _misplaced(moments.centre - lowest, size)
        moment, limit = (
            float(direction @ moments.second @ direction),
            moments.mass * (position - low) * (high - position),
        )
        if is_stated and moment > limit * (1.0 + _SLACK):
            raise GeometryError(
                "{parameter} is impossible for masses within the body: along {axis} the second moment must be at most "
                "{limit:.6g} kg m2, got {moment:.6g}", parameter="inertia", axis=_at(direction), limit=limit,
                moment=moment,
                hint="check the unit, and that the inertia is about the centre of mass",
            )  # fmt: skip
        fraction = min(fraction, limit / moment if moment > 0.0 else 1.0)
    return fraction


def _directions() -> list[FloatArray]:
    """Return the axes and directions with a uniform distribution over half a sphere [-]."""
    index = np.arange(_DIRECTIONS - 3) + 0.5
    z, turn = index / len(index), math.pi * (1.0 + math.sqrt(5.0)) * index
    radius = np.sqrt(1.0 - z * z)
    return [*np.eye(3), *np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)]


def _frame(direction: FloatArray) -> FloatArray:
    """Return a rotation from a direction with z >= 0 to z."""
    axis = np.array([direction[1], -direction[0], 0.0])
    if not axis.any():
        return np.eye(3)
    return rotation_about(axis, math.acos(min(1.0, float(direction[2]))))


def _misplaced(position: FloatArray, size: FloatArray) -> GeometryError:
    return GeometryError(
        "the centre of mass must lie within the convex hull of the body, in its box of {size} m, got {centre} m from "
        "the lowest corner of the box", size=_at(size), centre=_at(position),
        hint="check the origin and the unit",
    )  # fmt: skip


def _at(values: FloatArray) -> str:
    return f"({', '.join(f'{x:.4g}' for x in values.tolist())})"


def checked_centre(centre: Any, origin: FloatArray) -> FloatArray:
    """Return a centre of mass (x, y, z) in the frame of the parts [m]."""
    return vector("centre", centre) - origin


def similar(moments: SolidMoments, matrix: FloatArray, size: float, density: float) -> SolidMoments:
    """Return the moments after a rotation or a reflection, with scale factors of lengths and densities [-]."""
    weight = density * size**3
    second = times(times(matrix, moments.second), matrix.T) * (weight * size**2)
    return SolidMoments(moments.mass * weight, applied(matrix, moments.centre) * size, second)


GRID = 20  # points along each side of the common box of two parts; smaller overlaps are not detected
_SHARED = 1e-9


def check_disjoint(parts: Sequence[Part]) -> None:
    """Refuse overlapping parts; common faces are allowed."""
    # two parts overlap if any of 20 x 20 x 20 points in the common box of both lies inside both
    boxes = np.array([part.box() for part in parts])
    for i in range(len(parts)):
        for j in range(i + 1, len(parts)):
            low, high = np.maximum(boxes[i, 0], boxes[j, 0]), np.minimum(boxes[i, 1], boxes[j, 1])
            if (high - low > _SHARED * np.ptp(boxes[[i, j]], axis=(0, 1)).max()).all():
                _check_pair(parts, (i, j), low, high)


def _check_pair(parts: Sequence[Part], pair: tuple[int, int], low: FloatArray, high: FloatArray) -> None:
    points = grid_points(low, high, GRID)
    common = points[parts[pair[0]].contains(points)]
    count = int(parts[pair[1]].contains(common).sum()) if len(common) else 0
    if count:
        volume = count / GRID**3 * float((high - low).prod())
        raise GeometryError(
            "parts {first} and {second} overlap over about {volume:.3g} m3", first=pair[0], second=pair[1],
            volume=volume,
            hint="use parts without common volume: cut one of them",
        )  # fmt: skip


_PART_SLACK = 1e-6

_CAUSE = "check the surface for self-intersections and inverted faces"


def check_possible(parts: Sequence[Part]) -> None:
    """Refuse parts with moments that are impossible for masses inside their box and hull."""
    # Conditions: The volume is > 0. The centre of mass lies in the box, and for a mesh in the convex hull. The second
    # moments J are not negative (triangle inequality of the inertia ``tr(J) 1 - J``). Along each axis they are at most
    # ``m (c - low) (high - c)``, the limit for masses between low and high with the centre of mass c (R. Bhatia, C.
    # Davis, "A better bound on the variance", 2000).
    for number, part in enumerate(parts):
        fault = _impossible(part.moments(), part.box()) or _out_of_hull(part)
        if fault:
            raise GeometryError(
                "part {number} {fault}", number=number, fault=fault,
                hint="check the surface for self-intersections and inverted faces",
            )  # fmt: skip


def _impossible(moments: SolidMoments, box: FloatArray) -> str:
    low, high = box
    slack = _PART_SLACK * float((high - low).max())
    if not (np.isfinite(moments.mass) and np.isfinite(moments.centre).all() and np.isfinite(moments.second).all()):
        return "has moments that are not finite"
    if moments.mass <= 0.0:
        return f"must have a mass > 0 kg, got {moments.mass:g}"
    if (moments.centre < low - slack).any() or (moments.centre > high + slack).any():
        return f"has its centre at {_at(moments.centre)} m, outside its box {_at(low)} to {_at(high)} m"
    principal = np.asarray(np.linalg.eigvalsh(moments.second), dtype=np.float64)
    if principal[0] < -_PART_SLACK * abs(principal[2]) or principal[2] <= 0.0:
        return (
            f"has negative principal second moments {_at(principal)} kg m2: its inertia violates the triangle "
            "inequality"
        )
    limit = moments.mass * ((moments.centre - low) * (high - moments.centre) + slack * (high - low + slack))
    if (np.diag(moments.second) > limit).any():
        return (
            f"has second moments {_at(np.diag(moments.second))} kg m2 along x, y, z, above the limit for masses in its "
            f"box, {_at(limit)} kg m2"
        )
    return ""


def _out_of_hull(part: Part) -> str:
    if type(part.shape) is not Polyhedron:
        return ""
    from scipy.spatial import QhullError

    vertices, centre = part.shape.vertices, part.shape.moments().centre
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    try:
        planes = part.shape.hull.equations
    except QhullError:  # the body is too flat for a hull, so only the box is checked
        return ""
    distance = float((planes[:, :3] @ (centre - middle) + planes[:, 3]).max())
    if distance > _PART_SLACK * float(np.ptp(vertices, axis=0).max()):
        return f"has its centre {distance:.3g} m outside its convex hull"
    return ""
