"""Bodies and motions as the tables that the compiled engine takes."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.ground import SpatialGround
from rocking.errors import InvalidValueError
from rocking.restitution.space.impulse_position import HIGHEST, impulse_position

MOST_CORNERS = 64
"""Most vertices of a base that the compiled engine takes."""

KEPT = 117
"""Moments of a vertex or an edge for what ked-3d-point keeps: 9, 27 and 81."""

_ROUNDING = 1e-9

BODY, ROW, RESULTS, COUNTS = 17, 10, 9, 9
"""Columns of the tables."""


def body_table(bodies: Sequence[SpatialBody | None], gravity: float) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return bodies as numbers.

    gravity: acceleration of gravity [m/s2]. Returns numbers: Mass, frequency, size, lift, radius, centre, inertia; NaN
    where there is no body (shape (n, 17)); corners: first vertex and number of vertices; no vertices for a round base
    (shape (n, 2)); vertices: vertices of all of them [m] (shape (m, 2)).
    """
    numbers, corners = np.full((len(bodies), BODY), np.nan), np.zeros((len(bodies), 2), np.int64)
    points: list[FloatArray] = []
    used = 0
    for k, body in enumerate(bodies):
        if body is None:
            continue
        count = len(body.vertices)
        if count > MOST_CORNERS:
            raise InvalidValueError(
                f"a base must have at most {MOST_CORNERS} vertices in a batch, got {count}; a round base is a radius, "
                'and engine="reference" takes any number'
            )
        scalars = (body.mass, body.frequency(gravity), body.size, body.lift, body.radius)
        numbers[k] = np.concatenate([scalars, body.centre, body.inertia.ravel()])
        corners[k] = used, count
        points.append(body.vertices[:, :2])
        used += count
    vertices = np.concatenate(points) if points else np.zeros((0, 2))
    return numbers, corners, np.ascontiguousarray(vertices)


def kept_table(bodies: Sequence[SpatialBody | None]) -> FloatArray:
    """Return the moments of the mass that ked-3d-point needs, for every vertex and then every edge of every body.

    Returns 117 numbers each; NaN for a body whose distribution of mass is not known [kg, kg m, kg m2].
    """
    rows: list[FloatArray] = []
    for body in bodies:
        if body is not None and body.round:
            raise InvalidValueError(
                "ked-3d-point on a round base lands on any point of its rim: no moments there; take ked-3d, or "
                'engine="reference" takes it'
            )
        if body is None:
            continue
        if body.matter is None:
            rows.append(np.full(2 * len(body.vertices) * KEPT, np.nan))
        else:
            rows.append(_kept(body))
    return np.concatenate(rows) if rows else np.zeros(0)


def position_table(bodies: Sequence[SpatialBody | None]) -> tuple[IntArray, FloatArray]:
    """Return where the impulse of a landing of the whole base acts, which ked-3d needs.

    Returns places: first interval and number of intervals; none for a body whose distribution of mass is not known
    (shape (n, 2)); positions: first and last azimuth of an interval [rad], and the coefficients of k over it [-] (shape
    (m, 3 + HIGHEST)).
    """
    places = np.zeros((len(bodies), 2), np.int64)
    rows: list[list[float]] = []
    for number, body in enumerate(bodies):
        if body is None or body.matter is None:
            continue
        position = impulse_position(body.matter.placed[0])
        places[number] = len(rows), len(position.breaks) - 1
        for k, ends in enumerate(pairwise(position.breaks)):
            row = [*ends, *position.piece(k)]
            rows.append(row + [0.0] * (HIGHEST + 3 - len(row)))
    return places, np.array(rows).reshape(-1, HIGHEST + 3)


def _kept(body: SpatialBody) -> FloatArray:
    from rocking.bodies.solid import Corner, Edge
    from rocking.restitution.space.integrals import kept_moments

    assert body.matter is not None
    solid, origin = body.matter.placed
    places = body.vertices - origin
    places[np.abs(places[:, 2]) <= _ROUNDING * solid.size, 2] = 0.0
    corners = [Corner(place) for place in places]
    edges = [Edge(place, along) for place, along in zip(places, body.edges, strict=True)]
    landings: list[Corner | Edge] = [*corners, *edges]
    made = []
    for onto in landings:
        moments = kept_moments(solid, onto)
        made += [moments.second.ravel(), moments.third.ravel(), moments.fourth.ravel()]
    return np.concatenate(made)


def motion_table(grounds: Sequence[SpatialGround]) -> tuple[int, IntArray, FloatArray, FloatArray]:
    """Return motions as numbers.

    Returns degree: of all of them: 1 or 7; places: first time, first acceleration, number of stretches (shape (n, 3));
    times: ends of the stretches of all of them [s]; accelerations: by motion, stretch, power and axis [m/s2].
    """
    most = max(ground.coefficients.shape[2] for ground in grounds) - 1
    if most > 7:
        raise InvalidValueError(f"motions must be polynomials of degree at most 7, got {most}; sample them")
    degree = 1 if most <= 1 else 7
    places = np.zeros((len(grounds), 3), np.int64)
    times, rows = [], []
    at, first = 0, 0
    for k, ground in enumerate(grounds):
        made = np.zeros((ground.count, degree + 1, 3))
        made[:, : ground.coefficients.shape[2]] = ground.coefficients.transpose(0, 2, 1)
        places[k] = at, first, ground.count
        at, first = at + len(ground.times), first + made.size
        times.append(ground.times)
        rows.append(made.ravel())
    return degree, places, np.concatenate(times), np.concatenate(rows)
