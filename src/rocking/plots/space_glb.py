"""A 3D body as glTF (.glb) for 3D programs and the web page: surface, stable poses and motion."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from rocking.bodies.equilibria import Equilibria, StablePose
from rocking.bodies.solid import RoundBase, Solid, SupportPolygon
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.surfaces import TriangleSurface, placed_points
from rocking.conventions import FloatArray
from rocking.dynamics.frictional.response import HullResponse
from rocking.plots.animation_hull import HullScene
from rocking.version import SOFTWARE

_TYPES = {np.dtype(np.float32): 5126, np.dtype(np.uint32): 5125, np.dtype(np.uint8): 5121}
_SHAPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_Z_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # rotation from z upwards to y upwards, the convention of glTF
_ROUND = 90  # number of corners of a round base
_FEW, _DIVISIONS = 10_000, 8  # minimum number of flat faces (split for colours), divisions of round surfaces


class GltfFile:
    """A 3D body and its results as one glTF file."""

    # `extras` contains quantities that glTF does not define: in m and s, z upwards, from the centre of mass in body
    # axes
    def __init__(self, solid: Solid) -> None:
        self.solid = solid
        self.binary = bytearray()
        self.document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": SOFTWARE}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"name": "ground", "rotation": _Z_UP, "children": [1]}],
            "accessors": [], "bufferViews": [],
        }  # fmt: skip
        moments = solid.local_moments
        triangles = _triangles(solid) - moments.centre
        self.points, faces = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
        self.attributes = {"POSITION": self._add(self.points.astype(np.float32), bounds=True)}
        indices = self._add(faces.astype(np.uint32).ravel())
        self.document["meshes"] = [{"primitives": [{"attributes": self.attributes, "indices": indices}]}]
        name, centre = solid.name or "body", moments.centre
        self.document["nodes"].append({"name": name, "mesh": 0, "translation": [0.0, 0.0, float(centre[2])]})
        corners = corners_of(solid) - centre
        self.extras: dict[str, Any] = {"height": float(centre[2]), "base": corners.tolist()}
        if len(patches := _patches(solid)):
            self.extras["mended"] = self._add((patches - centre).reshape(-1, 3).astype(np.float32))

    def add_equilibria(self, equilibria: Equilibria, pose: StablePose) -> None:
        """Add stable poses, saddles and summits, and heights of the centre of mass above the lowest points."""
        heights = equilibria.height(self.points)
        low, high = equilibria.stable[0].height, float(heights.max())
        self.attributes["COLOR_0"] = self._add(_coloured((heights - low) / (high - low)))
        self.extras |= {
            "stands_in": pose.number, "landscape": [low, high],
            "poses": [
                {
                    "turn": _quaternion(member.rotation), "height": member.height, "energy": member.energy,
                    "barrier": member.barrier if np.isfinite(member.barrier) else None,
                    "support": member.support.tolist(),
                    "up_in_file": (-self.solid.turn.T @ member.down).tolist(),
                }
                for member in equilibria.stable
            ],
            "marks": [
                {
                    "kind": member.kind, "position": (member.points.mean(axis=0) - equilibria.centre).tolist(),
                    "height": member.height, "energy": member.energy,
                }
                for member in (*equilibria.stable, *equilibria.saddles, *equilibria.summits)
            ],
        }  # fmt: skip

    def add_edges(self, edges: list[dict[str, Any]]) -> None:
        """Add edges of the base, with the numbers that `rocking restitution` uses."""
        from_centre = np.array([*self.solid.centre[:2], 0.0])
        height = -self.extras["height"]

        def vertex(corner: list[float]) -> list[float]:
            return (np.array([*corner, height]) - from_centre).tolist()  # type: ignore[no-any-return]

        self.extras["edges"] = [
            {"name": edge["edge"], "from": vertex(edge["edge_start"]), "to": vertex(edge["edge_end"])} for edge in edges
        ]

    def add_motion(self, response: HullResponse) -> None:
        """Add the motion as an animation, the tilt, and the vertices of the hull."""
        scene = HullScene.of(response)
        quaternion = np.roll(scene.quaternion, -1, axis=1)  # the scalar is last, the convention of glTF
        quaternion[1:] *= np.cumprod(np.where((quaternion[1:] * quaternion[:-1]).sum(axis=1) < 0.0, -1.0, 1.0))[:, None]
        time = self._add(scene.time.astype(np.float32), bounds=True)
        samplers = [
            {"input": time, "output": self._add(values.astype(np.float32))} for values in (quaternion, scene.centre)
        ]
        channels = [
            {"sampler": k, "target": {"node": 1, "path": path}} for k, path in enumerate(("rotation", "translation"))
        ]
        self.document["animations"] = [{"samplers": samplers, "channels": channels}]
        node = self.document["nodes"][1]
        node["rotation"], node["translation"] = quaternion[0].tolist(), scene.centre[0].tolist()
        self.extras["tilt"] = self._add(scene.tilt.astype(np.float32))
        self.extras["hull"] = self._add(scene.points.astype(np.float32))

    def write(self, path: Path) -> None:
        """Write the file."""
        self.document |= {"buffers": [{"byteLength": len(self.binary)}], "extras": {"rocking": self.extras}}
        text = json.dumps(self.document, allow_nan=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        length = 28 + len(text) + len(self.binary)
        head = struct.pack("<4sII I4s", b"glTF", 2, length, len(text), b"JSON")
        path.write_bytes(head + text + struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)

    def _add(self, values: np.ndarray, *, bounds: bool = False) -> int:
        """Add an array to the file, one row per element. Return the index of the accessor."""
        data, kind = np.ascontiguousarray(values), _TYPES[values.dtype]
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": data.nbytes}
        accessor: dict[str, Any] = {
            "bufferView": len(self.document["bufferViews"]), "componentType": kind, "count": len(data),
            "type": _SHAPES[1 if data.ndim == 1 else data.shape[1]],
        }  # fmt: skip
        if data.dtype == np.uint8:
            accessor["normalized"] = True
        if bounds:
            accessor |= {name: np.atleast_1d(getattr(data, name)(axis=0)).tolist() for name in ("min", "max")}
        self.binary += data.tobytes() + bytes(-data.nbytes % 4)
        self.document["bufferViews"].append(view)
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1


def _triangles(solid: Solid) -> FloatArray:
    pieces = []
    for surface in (surface for solid_part in solid.local_parts for surface in solid_part.surfaces()):
        if not isinstance(surface, TriangleSurface):
            pieces.append(surface.triangles(_DIVISIONS))
            continue
        cells = surface.cells()
        while len(cells) < _FEW:
            cells = surface.split(cells)
        pieces.append(cells)
    return np.concatenate(pieces)


def _patches(solid: Solid) -> FloatArray:
    """Return the triangles of closed holes, in the frame of the body."""
    return np.concatenate([
        placed_points(solid_part.shape.patches, solid_part.rotation, solid_part.translation)
        for solid_part in solid.local_parts if isinstance(solid_part.shape, Polyhedron)
    ] or [np.empty((0, 3, 3))])  # fmt: skip


def corners_of(solid: Solid) -> FloatArray:
    """Return the corners of the base of a body, or points on a round base [m]."""
    base = solid.local_base
    if isinstance(base, SupportPolygon):
        return np.column_stack([base.vertices, np.zeros(len(base.vertices))])
    phi = 2.0 * np.pi * np.arange(_ROUND) / _ROUND
    circle = base if isinstance(base, RoundBase) else RoundBase(np.zeros(2), 0.0)
    flat = circle.centre + circle.radius * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    return np.column_stack([flat, np.zeros(_ROUND)])


def _coloured(share: FloatArray) -> np.ndarray:
    """Return the colours of the picture of the equilibria in linear RGB, the convention of glTF."""
    from matplotlib import colormaps

    seen = colormaps["cividis"](np.clip(share, 0.0, 1.0))
    light = np.where(seen <= 0.04045, seen / 12.92, ((seen + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
    light[:, 3] = 1.0
    return np.round(255.0 * light).astype(np.uint8)


def _quaternion(turn: FloatArray) -> list[float]:
    """Return the quaternion of a rotation, with the scalar last."""
    # rotation about the horizontal axis (t12 - t21, ...) / (2 s) with s^2 = (1 + trace) / 4; half a turn about x in the
    # limit
    scalar = 0.5 * np.sqrt(max(0.0, 1.0 + float(np.trace(turn))))
    if scalar < 1e-9:
        return [1.0, 0.0, 0.0, 0.0]
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / (4.0 * scalar)
    quaternion = np.array([*axis, scalar])
    return (quaternion / np.linalg.norm(quaternion)).tolist()  # type: ignore[no-any-return]
