"""The doors to manifold3d: surfaces there and back, fewer faces, hollows."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid._changes import HELP, Changes
from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError

if TYPE_CHECKING:
    from manifold3d import Manifold

MOST_FACES = 200_000  # surfaces of more faces are simplified [-]
FINEST = 1e-4  # by how much of the size their hull may move then [-]
WORTH = 0.7  # it is done if no more than so much of the faces stays [-]
_MOST_DISTANCES = 20_000_000


def manifold(points: FloatArray, faces: IntArray) -> "Manifold":
    """Return a closed, oriented surface as manifold3d holds it."""
    from manifold3d import Error, Manifold, Mesh64

    found = Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64)))
    if found.status() != Error.NoError:
        raise GeometryError(f"the surface does not bound a volume (manifold3d: {found.status().name}); {HELP}")
    return found


def surface(of: "Manifold") -> tuple[FloatArray, IntArray]:
    """Return vertices [m] and faces."""
    mesh = of.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.asarray(mesh.tri_verts).astype(np.int64)


def decimated(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return a surface of many faces with fewer, its convex hull nowhere moved by more than 1e-4 of the size."""
    if len(faces) <= MOST_FACES or changes.allowed == "none":
        return points, faces
    bound = FINEST * float(np.ptp(points, axis=0).max())
    try:
        whole = manifold(points, faces)
    except GeometryError:  # faces that only touch: nothing is lost but speed
        return points, faces
    for share in (1.0, 0.5, 0.25, 0.1):
        fewer_points, fewer = surface(whole.simplify(share * bound))
        if len(fewer) > WORTH * len(faces):
            return points, faces
        moved = _hull_distance(points, fewer_points, bound)
        if moved <= bound:
            break
    else:
        return points, faces
    before, after = polyhedron_moments(points[faces]), polyhedron_moments(fewer_points[fewer])
    shift = float(np.linalg.norm(after.centre - before.centre))
    changes.say(
        f"simplified from {len(faces)} to {len(fewer)} faces, which moves the hull by at most {1000.0 * moved:.2g} mm "
        f"and the centre by {1000.0 * shift:.2g} mm",
        abs(after.mass - before.mass),
    )
    return fewer_points, fewer


def _hull_distance(points: FloatArray, fewer: FloatArray, enough: float) -> float:
    """How far the hull of points reaches out of that of others at most, if it is more than enough [m]."""
    from scipy.spatial import ConvexHull, cKDTree

    corners = points[ConvexHull(points).vertices]
    near = np.asarray(cKDTree(fewer).query(corners)[0])
    far = corners[near > enough]
    most = float(near[near <= enough].max(initial=0.0))
    if len(far):
        planes = np.unique(ConvexHull(fewer).equations.round(12), axis=0)
        for some in np.array_split(far, 1 + len(far) * len(planes) // _MOST_DISTANCES):
            most = max(most, float((some @ planes[:, :3].T + planes[:, 3]).max()))
    return most


_ROUND, _MOST_HOLLOWED, _COARSE = 12, 2000, (0.02, 0.05, 0.1, 0.2)


def hollowed(points: FloatArray, faces: IntArray, wall: float, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface with another one within, a wall [m] inside it: parts thinner than two walls stay solid."""
    # The hollow is where a ball whose radius is the wall finds room for its middle (the Minkowski difference). The ball
    # is a polyhedron, and the surface is simplified first, by up to a fifth of the wall; the radius makes up for both.
    from manifold3d import Manifold

    whole = manifold(points, faces)
    for share in _COARSE:
        coarse = whole.simplify(share * wall)
        if coarse.num_tri() <= _MOST_HOLLOWED:
            break
    ball = Manifold.sphere(1.0, _ROUND)
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    mean = float((directions @ surface(ball)[0].T).max(axis=1).mean())
    sunk = (float(whole.volume()) - float(coarse.volume())) / float(whole.surface_area())
    cavity = coarse.minkowski_difference(ball.scale([(wall - sunk) / mean] * 3))
    inner, inward = surface(cavity)
    if not len(inward):
        raise GeometryError(f"a wall of {wall:.4g} m leaves nothing hollow; is that its thickness in m?")
    void = percent(float(cavity.volume()) / float(whole.volume()))
    changes.note(f"hollow, {void} of it, within walls of {1000.0 * wall:.3g} mm, its bottom too, right to about 3 %")
    return np.concatenate([points, inner]), np.concatenate([faces, inward[:, ::-1] + len(points)])
