"""A body in plain values: mass, centre, feet, what each side decides, and its outline."""

from typing import Any

import numpy as np

from rocking.bodies import Block, Body, MassPoints, Section
from rocking.conventions import FEET, FloatArray, Foot

_MOST_VERTICES = 2000
"""Vertices of a ring that is drawn."""


def body_facts(body: Body, gravity: float) -> dict[str, Any]:
    """Return what is said of a body.

    gravity: acceleration of gravity [m/s2].
    """
    return {
        "kind": type(body).__name__,
        "mass_kg": body.mass,
        "centre_m": body.centre,
        "feet_m": body.feet,
        "moment_of_inertia_kg_m2": body.moment_of_inertia,
        "gravity_m_s2": gravity,
        "assumed": list(body.assumed),
        "warnings": list(body.doubts),
        "sides": {foot: side_facts(body, foot, gravity) for foot in FEET},
    }


def side_facts(body: Body, foot: Foot, gravity: float) -> dict[str, float]:
    """Return what one side of a body decides.

    gravity: acceleration of gravity [m/s2].
    """
    side = body.side(foot, gravity)
    return {
        "slenderness_ratio": side.slenderness_ratio,
        "slenderness_angle_rad": side.slenderness_angle,
        "semi_diagonal_m": side.semi_diagonal,
        "frequency_parameter_rad_s": side.frequency_parameter,
        "uplift_acceleration_m_s2": side.uplift_acceleration,
    }


def outline_facts(body: Body) -> dict[str, Any]:
    """Return what draws a body, in the user's coordinates.

    Returns ``outline``: polygons with holes [m] and density [kg/m3], rings of more than 2000 vertices thinned;
    ``points``: x, y [m] and mass [kg] of mass points; ``centre``; ``base``: both feet; ``ground``: its height;
    ``contact``: stretches of the base that touch [m].
    """
    shift = body.origin_x
    points = np.column_stack([body.points, body.masses]).tolist() if isinstance(body, MassPoints) else []
    return {
        "outline": _polygons(body),
        "points": points,
        "centre": list(body.centre),
        "base": list(body.feet),
        "ground": body.ground,
        "contact": [[shift + a, shift + b] for a, b in body.local_contact],
    }


def _polygons(body: Body) -> list[dict[str, Any]]:
    whole = body.to_section() if isinstance(body, Block) else body
    if not isinstance(whole, Section):
        return []
    shift = np.array([whole.origin_x, whole.ground])
    found = []
    for region in whole.regions:
        outline, *holes = (_drawn(ring + shift) for ring in region.rings)
        found.append({"outline": outline, "holes": holes, "density": region.density})
    return found


def _drawn(ring: FloatArray) -> list[list[float]]:
    chosen = ring if len(ring) <= _MOST_VERTICES else ring[:: -(-len(ring) // _MOST_VERTICES)]
    made: list[list[float]] = chosen.tolist()
    return made
