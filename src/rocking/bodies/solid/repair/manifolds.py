"""Surfaces as Manifold of manifold3d, and back."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies.solid.repair.log import HELP
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError

if TYPE_CHECKING:
    from manifold3d import Manifold


def manifold(points: FloatArray, faces: IntArray) -> "Manifold":
    """Return a closed, oriented surface as a Manifold of manifold3d."""
    from manifold3d import Error, Manifold, Mesh64

    body = Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64)))
    if body.status() != Error.NoError:
        raise GeometryError(
            "The surface does not bound a volume (manifold3d: {status})", status=body.status().name, hint=HELP
        )
    return body


def triangles_of(body: "Manifold") -> tuple[FloatArray, IntArray]:
    """Return vertices [m] and faces of a Manifold."""
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.asarray(mesh.tri_verts).astype(np.int64)
