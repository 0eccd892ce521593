"""Cavity of a surface at a wall thickness."""

import numpy as np

from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.repair.manifolds import manifold, triangles_of
from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError

_ROUND = 12  # number of segments of the ball around its equator [-]
_MOST_HOLLOWED = 2000  # largest number of faces without further simplification [-]
_COARSE = (0.02, 0.05, 0.1, 0.2)  # tolerances of the simplification / wall thickness, tried in this order [-]


def hollow_out(points: FloatArray, faces: IntArray, wall: float, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return the surface with a cavity at the wall thickness [m]; parts thinner than two walls stay solid."""
    # The cavity is the set of possible centres of a ball with the wall thickness as radius (Minkowski difference). The
    # ball is a polyhedron, and the surface is simplified by up to a fifth of the wall. The radius corrects for both.
    from manifold3d import Manifold

    body = manifold(points, faces)
    for fraction in _COARSE:
        coarse = body.simplify(fraction * wall)
        if coarse.num_tri() <= _MOST_HOLLOWED:
            break
    ball = Manifold.sphere(1.0, _ROUND)
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    mean = float((directions @ triangles_of(ball)[0].T).max(axis=1).mean())
    sunk = (float(body.volume()) - float(coarse.volume())) / float(body.surface_area())
    cavity = coarse.minkowski_difference(ball.scale([(wall - sunk) / mean] * 3))
    inner, inward = triangles_of(cavity)
    if not len(inward):
        raise GeometryError(
            "A wall of {wall:.4g} m leaves no cavity", wall=wall, hint="check that the wall thickness is in m"
        )
    void = percent(float(cavity.volume()) / float(body.volume()))
    log.add_note(f"cavity of {void} of the volume (accuracy 3 %) for walls and bottom of {1000.0 * wall:.3g} mm")
    return np.concatenate([points, inner]), np.concatenate([faces, inward[:, ::-1] + len(points)])
