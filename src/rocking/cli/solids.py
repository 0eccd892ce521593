"""`rocking restitution` of solids: coefficients of restitution after rocking about each edge of the base."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.answers import Answer, Display
from rocking.bodies.solid import Corner, Edge, RoundBase, Solid, SupportPolygon
from rocking.cli.numbers import recommendation_values, show_recommendation
from rocking.cli.page import Page
from rocking.quantities import closely
from rocking.restitution.space import SpatialModel, impact_in_space, spatial_model, spatial_models

PARALLEL = 1e-3  # tolerance of parallel edges [rad], because coordinates in files are rounded
MOST_EDGES = 16  # largest number of computed edges, which have the smallest slenderness angles
DIRECTIONS = 4  # number of rocking directions of a round base, from x towards y

ROUND_BASE = (
    "these values are valid only if the body is guided in one vertical plane; a free body rolls on its rim without "
    "impact; use `rocking simulate`"
)
"""Limit of a 2D coefficient of a round base."""

_MOST = 12  # largest number of printed corners of a base

_PLACES = ("edge_start", "edge_end", "base_vertices", "base_centre", "centre")
_GEOMETRY = (
    "edge", "edge_start", "edge_end", "slenderness_angle", "slenderness_ratio", "semi_diagonal", "frequency_parameter",
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class SolidAnswer:
    """A 3D body and its edges."""

    solid: Solid
    edges: list[dict[str, Any]]  # edges of the base, at most `MOST_EDGES`; directions of a round base
    gravity: float  # acceleration of gravity [m/s2]
    length: str  # unit of lengths
    recommendation: Any = None  # recommended model, with --recommend

    @classmethod
    def of(
        cls, solid: Solid, models: list[str] | None, gravity: float, length: str, recommendation: Any = None
    ) -> "SolidAnswer":
        """Compute the impacts at an acceleration of gravity [m/s2]."""
        gravity_value = checks.positive("gravity", gravity, "m/s2")
        chosen = [spatial_model(name) for name in models or spatial_models()]
        if solid.known is not None and models is None:
            chosen = [model for model in chosen if not model.needs_solid]
        return cls(solid, _edges(solid, chosen, gravity_value), gravity_value, length, recommendation)

    @property
    def left_out(self) -> int:
        """Number of edges without result: only edges with smaller slenderness angles are computed."""
        base = self.solid.base
        return len(base.vertices) - len(self.edges) if isinstance(base, SupportPolygon) else 0

    @property
    def notes(self) -> list[str]:
        """Limits of the coefficients, one sentence per limit."""
        shown = {name for edge in self.edges for name in edge["coefficients"]}
        excluded = [name for name in spatial_models() if spatial_model(name).needs_solid and name not in shown]
        reasons = [f"left out: {', '.join(excluded)}, which needs the distribution of mass"]
        notes = reasons if excluded and self.solid.known is not None else []
        return [ROUND_BASE, *notes] if isinstance(self.solid.base, RoundBase) else notes

    def answer(self) -> Answer:
        """Return the body and every edge with its coefficients."""
        return Answer({
            "body": self.solid.answer(),
            "gravity": self.gravity,
            "edges": self.edges,
            "edges_left_out": self.left_out,
            "notes": self.notes,
            **recommendation_values(self.recommendation),
        })  # fmt: skip

    def draw(self) -> Any:
        from rocking.plots.solid import solid_picture

        return solid_picture(self.solid)

    def write_glb(self, path: Path) -> None:
        from rocking.plots.space_glb import GltfFile

        file = GltfFile(self.solid)
        file.add_edges(self.edges)
        file.write(path)

    def write_csv(self, path: Path) -> None:
        from rocking.cli.exports import write_records

        write_records(path, [_record(edge, name) for edge in self.edges for name in edge["coefficients"]])

    def show(self, page: Page) -> None:
        answer, display = self.answer(), Display(self.length, own=closely(coefficient=".6f"))
        show_body(page, answer["body"], display)
        page.line()
        numbered = not isinstance(self.solid.base, RoundBase)
        page.line("Edges of rocking" if numbered else "Directions of rocking", "bold")
        shown = [_rounded(edge) for edge in self.edges]
        page.rows(shown, _GEOMETRY, display, most=len(shown), dense=False)
        page.line()
        page.line("Coefficient of restitution, angular velocity after / before", "bold")
        rows = []
        for edge in self.edges:
            results = edge["coefficients"].values()
            values = (f"{display.cell('coefficient', r['coefficient'])}{' !' if r['flags'] else ''}" for r in results)
            rows.append((edge["edge"], edge["lands_on"], *values))
        page.table(("from edge", "onto", *self.edges[0]["coefficients"]), rows, ("from edge", "onto"))
        if self.left_out:
            page.line(f"{self.left_out} edges with larger slenderness angles are left out", "dim")
        page.warn([*self._flags(), *self.notes])
        show_recommendation(page, self.recommendation)

    def _flags(self) -> list[str]:
        edges_of: dict[tuple[str, str], list[str]] = {}
        for edge in self.edges:
            for name, result in edge["coefficients"].items():
                for meaning in result["flags"].values():
                    edges_of.setdefault((name, meaning), []).append(edge["edge"])
        return [
            f"{name}, from {', '.join(edges[:_MOST])}{' ...' if len(edges) > _MOST else ''}: {sentence}"
            for (name, sentence), edges in edges_of.items()
        ]


def _edges(solid: Solid, models: list[SpatialModel], gravity: float) -> list[dict[str, Any]]:
    """Return every edge with the impact after rocking about this edge, as plain values."""
    base = solid.base
    if not isinstance(base, SupportPolygon):
        azimuths = [k * 2.0 * math.pi / DIRECTIONS for k in range(DIRECTIONS)]
        impacts = [(f"{math.degrees(t):.0f} deg", base.edge(t), "far side", base.edge(t + math.pi)) for t in azimuths]
        return [_edge(solid, *impact, models, gravity) for impact in impacts]
    edges, corners = base.edges, base.vertices.tolist()
    slender = sorted(range(len(edges)), key=lambda i: round(_arm(solid, edges[i])[0], 9))
    return [
        _edge(solid, str(i), edges[i], *_landing(base, i), models, gravity, corners[(i + 1) % len(corners)])
        for i in sorted(slender[:MOST_EDGES])
    ]


def _edge(
    solid: Solid,
    name: str,
    edge: Edge,
    onto: str,
    where: Edge | Corner,
    models: list[SpatialModel],
    gravity: float,
    end: list[float] | None = None,
) -> dict[str, Any]:
    """Return an edge with its impact; `end` is the second corner (x, y) [m], None for a round base."""
    alpha, semi_diagonal = _arm(solid, edge)
    inertia = float(edge.direction @ solid.inertia @ edge.direction) + solid.mass * semi_diagonal**2
    start = edge.point[:2].tolist()
    results = {m.name: impact_in_space(solid, -edge.direction, pivot=edge, onto=where, model=m) for m in models}
    return {
        "edge": name,
        "edge_start": start,
        "edge_end": start if end is None else end,
        "slenderness_angle": alpha,
        "slenderness_ratio": 1.0 / math.tan(alpha),
        "semi_diagonal": semi_diagonal,
        "frequency_parameter": math.sqrt(solid.mass * gravity * semi_diagonal / inertia),
        "lands_on": onto,
        "coefficients": {
            model: {
                "coefficient": result.coefficient,
                "energy_ratio": result.energy_ratio,
                "flags": {flag.name.lower(): flag.value for flag in result.flags},
            }
            for model, result in results.items()
        },
    }


def _arm(solid: Solid, edge: Edge) -> tuple[float, float]:
    """Return slenderness angle [rad] and distance of the centre of mass from the edge [m]."""
    arm = solid.centre - edge.point
    across = arm - edge.direction * float(arm @ edge.direction)
    return math.atan2(math.hypot(across[0], across[1]), across[2]), float(np.linalg.norm(across))


def _landing(base: SupportPolygon, which: int) -> tuple[str, Edge | Corner]:
    """Return the landing edge: the parallel edge on the opposite side, or otherwise the farthest corner."""
    edge, edges = base.edge(which), base.edges
    for number, other in enumerate(edges):
        if float(edge.direction @ other.direction) < -math.cos(PARALLEL):
            return f"edge {number}", other
    inward = np.array([-edge.direction[1], edge.direction[0]])
    depth = (base.vertices - edge.point[:2]) @ inward
    number = int(np.argmax(depth))
    return f"corner {number}", base.corners[number]


def _record(edge: dict[str, Any], name: str) -> dict[str, Any]:
    """Return an edge with one model as a row of a table."""
    result, start, end = edge["coefficients"][name], edge["edge_start"], edge["edge_end"]
    return {
        **{key: value for key, value in edge.items() if key not in {"coefficients", "edge_start", "edge_end"}},
        "edge_start": ", ".join(map(repr, start)),
        "edge_end": ", ".join(map(repr, end)),
        "model": name,
        "coefficient": result["coefficient"],
        "energy_ratio": result["energy_ratio"],
        "flags": " ".join(result["flags"]),
    }


def show_body(page: Page, body: Answer, display: Display) -> None:
    """Write mass, centre of mass, base and repairs of a 3D body."""
    from rocking.cli.numbers import body_line

    page.line(body_line(None, Answer(_rounded(body.values)), display, ("parts", "volume", "centre")))
    base = _rounded(body["base"])
    if corners := base.get("base_vertices"):
        listed = ", ".join(f"({display.cell('base_vertices', corner)})" for corner in corners[:_MOST])
        page.line(f"base: {len(corners)} corners, {listed}{' ...' if len(corners) > _MOST else ''} {display.length}")
    page.values(display.lines(base, ("base_radius", "base_centre")))
    for sentence in body["assumed"]:
        page.line(sentence)
    page.warn(body["repairs"])


def _rounded(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values with coordinates rounded to a nanometre."""
    arrays = {name: np.asarray(value) for name, value in values.items() if name in _PLACES and value is not None}
    return {**values, **{name: (array.round(9) + 0.0).tolist() for name, array in arrays.items()}}
