"""What parts of a body may not contradict, and moments that somebody measured in place of those of the parts."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.part import Part, rotation_about
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.surfaces import vector
from rocking.conventions import FloatArray
from rocking.errors import GeometryError
from rocking.messages import Message
from rocking.portable import applied, times

_SLACK = 1e-6
_DIRECTIONS = 64

ASSUMED = Message(
    "inertia assumed: along each axis the share of the most that its box allows about the known centre of mass that "
    "the body of its parts has"
)


def known_moments(parts: Sequence[Part], own: SolidMoments, centre: FloatArray | None, inertia: Any) -> SolidMoments:
    """Return the moments of parts with what is known in place of their own."""
    # centre: in the frame of the parts [m]; inertia: tensor about the centre of mass, or principal moments along x, y
    # and z [kg m2]. An inertia that is not known comes from second moments scaled along each axis as the greatest that
    # masses between the ends of the body can have, ``m (c - low) (high - c)``.
    place = own.centre if centre is None else centre
    boxes = np.array([part.box() for part in parts])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    if not ((low < place) & (place < high)).all():
        raise _misplaced(place - low, high - low)
    if inertia is None:
        share = np.sqrt((place - low) * (high - place) / ((own.centre - low) * (high - own.centre)))
        found = SolidMoments(own.mass, place, own.second * np.outer(share, share))
    else:
        found = SolidMoments(own.mass, place, _second(inertia))
    share = _reached(parts, found, low, high - low, given=inertia is not None)
    if share < 1.0 and inertia is None:  # what is assumed is no more than the body can have
        return SolidMoments(own.mass, place, found.second * share)
    return found


def _second(inertia: Any) -> FloatArray:
    """Return the second moments that an inertia means, ``tr(I)/2 1 - I`` [kg m2]."""
    tensor = checks.real_array("inertia", inertia, "kg m2")
    tensor = np.diag(tensor) if tensor.shape == (3,) else tensor
    if (
        tensor.shape != (3, 3)
        or not np.isfinite(tensor).all()
        or np.abs(tensor - tensor.T).max() > _SLACK * abs(np.trace(tensor))
    ):
        raise GeometryError(
            "inertia must be a symmetric tensor of 3 x 3 finite numbers [kg m2] about the centre of mass, or the "
            "moments about x, y and z where these are principal axes"
        )
    second = 0.5 * float(np.trace(tensor)) * np.eye(3) - 0.5 * (tensor + tensor.T)
    spread = np.linalg.eigvalsh(second)
    if spread[2] <= 0.0 or spread[0] < -_SLACK * spread[2]:
        raise GeometryError(
            "{parameter} breaks the triangle inequality: of the principal moments {moments} kg m2 none may exceed the "
            "sum of the other two", parameter="inertia", moments=str(np.linalg.eigvalsh(tensor)),
            hint="are products of inertia of the other sign?",
        )  # fmt: skip
    return second


def _reached(parts: Sequence[Part], found: SolidMoments, lowest: FloatArray, size: FloatArray, *, given: bool) -> float:
    """Return which share of the second moments masses within the hull can have; refuse a centre outside of it."""
    # In every direction they are at most ``m (c - low) (high - c)`` (R. Bhatia, C. Davis, "A better bound on the
    # variance", 2000); 64 directions are tried. given: refuse less than all of them.
    share = 1.0
    for direction in _directions():
        frame = _frame(direction)
        ends = np.array(
            [
                part.shape.extent(times(frame, part.rotation))[:, 2] + applied(frame, part.translation)[2]
                for part in parts
            ]
        )
        low, high = float(ends[:, 0].min()), float(ends[:, 1].max())
        at = float(direction @ found.centre)
        if not low < at < high:
            raise _misplaced(found.centre - lowest, size)
        spread, most = float(direction @ found.second @ direction), found.mass * (at - low) * (high - at)
        if given and spread > most * (1.0 + _SLACK):
            raise GeometryError(
                "{parameter} is more than any mass within the body can have: along {axis} the second moment must be "
                "at most {limit:.6g} kg m2, got {moment:.6g}", parameter="inertia", axis=_at(direction), limit=most,
                moment=spread,
                hint="it is about the centre of mass: was it taken about another point, or in other units?",
            )  # fmt: skip
        share = min(share, most / spread if spread > 0.0 else 1.0)
    return share


def _directions() -> list[FloatArray]:
    """Return the axes and directions spread evenly over half a sphere [-]."""
    number = np.arange(_DIRECTIONS - 3) + 0.5
    z, turn = number / len(number), math.pi * (1.0 + math.sqrt(5.0)) * number
    flat = np.sqrt(1.0 - z * z)
    return [*np.eye(3), *np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)]


def _frame(direction: FloatArray) -> FloatArray:
    """Return a rotation that takes a direction with z >= 0 to z."""
    axis = np.array([direction[1], -direction[0], 0.0])
    if not axis.any():
        return np.eye(3)
    return rotation_about(axis, math.acos(min(1.0, float(direction[2]))))


def _misplaced(place: FloatArray, size: FloatArray) -> GeometryError:
    return GeometryError(
        "the centre of mass must lie within the convex hull of the body, in its box of {size} m, got {centre} m from "
        "the lowest corner of that", size=_at(size), centre=_at(place),
        hint="was it measured from another origin, or in another unit?",
    )  # fmt: skip


def _at(values: FloatArray) -> str:
    return f"({', '.join(f'{x:.4g}' for x in values.tolist())})"


def checked_centre(centre: Any, origin: FloatArray) -> FloatArray:
    """Return a centre of mass (x, y, z) in the frame of the parts [m]."""
    return vector("centre", centre) - origin


def similar(known: SolidMoments, matrix: FloatArray, size: float, density: float) -> SolidMoments:
    """Return moments under a rotation or a mirror, all lengths times size and all densities times density [-]."""
    weight = density * size**3
    second = times(times(matrix, known.second), matrix.T) * (weight * size**2)
    return SolidMoments(known.mass * weight, applied(matrix, known.centre) * size, second)


GRID = 20  # points along each side of the box that two parts share; smaller overlaps than its cells may pass
_SHARED = 1e-9


def check_disjoint(parts: Sequence[Part]) -> None:
    """Refuse parts that overlap; shared faces are welcome."""
    # two parts overlap if any of 20 x 20 x 20 points in the common box of both lies inside both
    boxes = np.array([part.box() for part in parts])
    for i in range(len(parts)):
        for j in range(i + 1, len(parts)):
            low, high = np.maximum(boxes[i, 0], boxes[j, 0]), np.minimum(boxes[i, 1], boxes[j, 1])
            if (high - low > _SHARED * np.ptp(boxes[[i, j]], axis=(0, 1)).max()).all():
                _check_pair(parts, (i, j), low, high)


def _check_pair(parts: Sequence[Part], pair: tuple[int, int], low: FloatArray, high: FloatArray) -> None:
    share = (np.arange(GRID) + 0.5) / GRID
    grid = np.stack(np.meshgrid(share, share, share, indexing="ij"), axis=-1).reshape(-1, 3)
    points = low + (high - low) * grid
    common = points[parts[pair[0]].contains(points)]
    count = int(parts[pair[1]].contains(common).sum()) if len(common) else 0
    if count:
        volume = count / GRID**3 * float((high - low).prod())
        raise GeometryError(
            "parts {first} and {second} overlap over about {volume:.3g} m3", first=pair[0], second=pair[1],
            volume=volume,
            hint="a solid is the sum of parts that do not share any volume: cut one where the other lies",
        )  # fmt: skip


_PART_SLACK = 1e-6

_CAUSE = "does its surface pass through itself, or look inward in part?"


def check_possible(parts: Sequence[Part]) -> None:
    """Refuse parts whose moments are not those of any mass inside their box and hull."""
    # The volume is above zero; the centre lies in the box, and for a mesh in the convex hull; the second moments J are
    # nowhere negative, which is the triangle inequality of the inertia ``tr(J) 1 - J``; and along each axis they are at
    # most ``m (c - low) (high - c)``, the greatest that masses between low and high with the centre c can have (R.
    # Bhatia, C. Davis, "A better bound on the variance", 2000).
    for number, part in enumerate(parts):
        words = _impossible(part.moments(), part.box()) or _out_of_hull(part)
        if words:
            raise GeometryError("part {number} {fault}", number=number, fault=words, hint=_CAUSE)


def _impossible(found: SolidMoments, box: FloatArray) -> str:
    low, high = box
    slack = _PART_SLACK * float((high - low).max())
    if not (np.isfinite(found.mass) and np.isfinite(found.centre).all() and np.isfinite(found.second).all()):
        return "has moments that are not finite"
    if found.mass <= 0.0:
        return f"has the mass {found.mass:g} kg, which must be above zero"
    if (found.centre < low - slack).any() or (found.centre > high + slack).any():
        return f"has its centre at {_at(found.centre)} m, outside its box {_at(low)} to {_at(high)} m"
    spread = np.asarray(np.linalg.eigvalsh(found.second), dtype=np.float64)
    if spread[0] < -_PART_SLACK * abs(spread[2]) or spread[2] <= 0.0:
        return (
            f"has principal second moments {_at(spread)} kg m2, which must not be negative: its inertia breaks the "
            "triangle inequality"
        )
    most = found.mass * ((found.centre - low) * (high - found.centre) + slack * (high - low + slack))
    if (np.diag(found.second) > most).any():
        return (
            f"has second moments {_at(np.diag(found.second))} kg m2 along x, y, z, more than any mass in its box can "
            f"have, {_at(most)} kg m2"
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
    except QhullError:  # too flat for a hull: the box has spoken
        return ""
    beyond = float((planes[:, :3] @ (centre - middle) + planes[:, 3]).max())
    if beyond > _PART_SLACK * float(np.ptp(vertices, axis=0).max()):
        return f"has its centre {beyond:.3g} m outside its convex hull"
    return ""
