"""What an impact costs a body in space, edge by edge of its base, under every model."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.formats import SolidFile
from rocking.bodies.solid import Base, Corner, Edge, RoundBase, Solid, SupportPolygon
from rocking.errors import GeometryError
from rocking.restitution.spatial import SpatialModel, SpatialRestitution, impact_in_space, spatial_model, spatial_models

PARALLEL = 1e-3
"""Edges of a mesh whose directions differ by less count as parallel: files round coordinates [rad]."""

MOST_EDGES = 16
"""Of a base with more edges those over which the body falls most easily are computed."""

DIRECTIONS = 4
"""Directions in which a round base is tipped, from x towards y."""


@dataclass(frozen=True, slots=True, eq=False)
class EdgeImpact:
    """One edge of a base, the body that turns about it, and what follows when it falls back."""

    name: str  # number of the edge, or direction of the point of a round base
    edge: Edge  # where it turns
    # corners (x, y) of the edge; the point of a round base twice [m]
    ends: tuple[tuple[float, float], tuple[float, float]]
    onto: str  # what it lands on when it falls back
    # slenderness_angle, semi_diagonal, frequency_parameter: alpha [rad], R [m] and p = sqrt(m g R / I) [rad/s] of the
    # turn about the edge
    slenderness_angle: float
    semi_diagonal: float
    frequency_parameter: float
    results: dict[str, SpatialRestitution]  # by model


@dataclass(frozen=True, slots=True, eq=False)
class SolidAnswer:
    """A body in space and its edges."""

    file: SolidFile  # the body, and what was done to read it
    edges: tuple[EdgeImpact, ...]  # edges of the base, at most `MOST_EDGES`; of a round one, directions
    gravity: float  # acceleration of gravity [m/s2]

    @property
    def left_out(self) -> int:
        """Number of edges that are less slender and not computed."""
        base = self.file.solid.base
        return len(base.vertices) - len(self.edges) if isinstance(base, SupportPolygon) else 0

    @classmethod
    def of(cls, file: SolidFile, models: list[str] | None, gravity: float) -> "SolidAnswer":
        """Compute what is printed.

        gravity: acceleration of gravity [m/s2].
        """
        pull = checks.positive("gravity", gravity, "m/s2")
        asked = [spatial_model(name) for name in models or spatial_models()]
        return cls(file, tuple(_edges(file.solid, asked, pull)), pull)


def _edges(solid: Solid, models: list[SpatialModel], gravity: float) -> list[EdgeImpact]:
    base = solid.base
    if isinstance(base, SupportPolygon):
        edges = base.edges
        slender = sorted(range(len(edges)), key=lambda i: round(_arm(solid, edges[i])[0], 9))
        chosen = sorted(slender[:MOST_EDGES])
        return [_edge(solid, str(i), edges[i], _landing(base, i), models, gravity) for i in chosen]
    turns = [k * 2.0 * math.pi / DIRECTIONS for k in range(DIRECTIONS)]
    return [
        _edge(solid, f"{math.degrees(t):.0f} deg", base.edge(t), ("far side", base.edge(t + math.pi)), models, gravity)
        for t in turns
    ]


def _edge(
    solid: Solid, name: str, edge: Edge, landing: tuple[str, Edge | Corner], models: list[SpatialModel], gravity: float
) -> EdgeImpact:
    onto, where = landing
    slenderness_angle, semi_diagonal = _arm(solid, edge)
    inertia = float(edge.direction @ solid.inertia @ edge.direction) + solid.mass * semi_diagonal**2
    return EdgeImpact(
        name,
        edge,
        _ends(solid.base, name, edge),
        onto,
        slenderness_angle,
        semi_diagonal,
        math.sqrt(solid.mass * gravity * semi_diagonal / inertia),
        {m.name: impact_in_space(solid, -edge.direction, pivot=edge, onto=where, model=m) for m in models},
    )


def _arm(solid: Solid, edge: Edge) -> tuple[float, float]:
    """Return slenderness angle [rad] and distance of the centre from the edge [m]."""
    arm = solid.centre - edge.point
    across = arm - edge.direction * float(arm @ edge.direction)
    return math.atan2(math.hypot(across[0], across[1]), across[2]), float(np.linalg.norm(across))


def _landing(base: SupportPolygon, which: int) -> tuple[str, Edge | Corner]:
    """Return what lands: the parallel edge on the far side, or without one the corner farthest from the edge."""
    edge, edges = base.edge(which), base.edges
    for number, other in enumerate(edges):
        if float(edge.direction @ other.direction) < -math.cos(PARALLEL):
            return f"edge {number}", other
    inward = np.array([-edge.direction[1], edge.direction[0]])
    depth = (base.vertices - edge.point[:2]) @ inward
    number = int(np.argmax(depth))
    return f"corner {number}", base.corners[number]


def _ends(base: Base, name: str, edge: Edge) -> tuple[tuple[float, float], tuple[float, float]]:
    point = (float(edge.point[0]), float(edge.point[1]))
    if not isinstance(base, SupportPolygon):
        return point, point
    x, y = base.vertices[(int(name) + 1) % len(base.vertices)].tolist()
    return point, (x, y)


def solid_facts(answer: SolidAnswer) -> dict[str, Any]:
    """Return everything that is said of a body in space, as plain values.

    Returns ``body``, ``base``, ``edges`` with ``coefficients`` by model, ``edges_left_out``, ``repairs``,
    ``gravity_m_s2``.
    """
    return {
        "body": body_facts(answer.file),
        "base": base_facts(answer.file.solid.base),
        "gravity_m_s2": answer.gravity,
        "edges": [edge_facts(edge) for edge in answer.edges],
        "edges_left_out": answer.left_out,
        "repairs": list(answer.file.repairs),
    }


def body_facts(file: SolidFile) -> dict[str, Any]:
    """Return mass and geometry of a body in space."""
    solid = file.solid
    low, high = solid.box
    return {
        "kind": "Solid",
        "name": file.name,
        "parts": len(solid.local_parts),
        "mass_kg": solid.mass,
        "assumed": list(solid.assumed),
        "warnings": list(solid.doubts),
        "volume_m3": solid.volume,
        "size_m": (high - low).tolist(),
        "centre_m": solid.centre.tolist(),
        "centre_height_m": float(solid.centre[2] - solid.ground),
        "inertia_kg_m2": solid.inertia.tolist(),
    }


def base_facts(base: Base) -> dict[str, Any]:
    """Return on what a body stands.

    Returns ``polygon`` with ``vertices_m``, or ``circle`` with ``centre_m`` and ``radius_m``.
    """
    if isinstance(base, SupportPolygon):
        return {"kind": "polygon", "vertices_m": base.vertices.tolist()}
    if isinstance(base, RoundBase):
        return {"kind": "circle", "centre_m": base.centre.tolist(), "radius_m": base.radius}
    raise GeometryError(f"a base is a polygon or a circle, got {base!r:.60}")


def edge_facts(edge: EdgeImpact) -> dict[str, Any]:
    """Return one edge as plain values.

    Returns Geometry, what it lands on, and by model ``coefficient``, ``energy_ratio`` and ``flags``.
    """
    return {
        "edge": edge.name,
        "from_m": list(edge.ends[0]),
        "to_m": list(edge.ends[1]),
        "slenderness_angle_rad": edge.slenderness_angle,
        "slenderness_ratio": 1.0 / math.tan(edge.slenderness_angle),
        "semi_diagonal_m": edge.semi_diagonal,
        "frequency_parameter_rad_s": edge.frequency_parameter,
        "lands_on": edge.onto,
        "coefficients": {
            name: {
                "coefficient": found.coefficient,
                "energy_ratio": found.energy_ratio,
                "flags": {flag.name.lower(): flag.value for flag in found.flags},
            }
            for name, found in edge.results.items()
        },
    }
