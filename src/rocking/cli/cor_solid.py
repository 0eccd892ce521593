"""`rocking cor` of solids: what it computes, prints and writes."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.solid import Base, Corner, Edge, RoundBase, Solid, SupportPolygon
from rocking.cli.inputs import refuse, solid_from, spelt
from rocking.cli.options import in_unit
from rocking.cli.output import check_files
from rocking.conventions import LENGTH_UNITS, g
from rocking.errors import GeometryError
from rocking.restitution.space import SpatialModel, SpatialRestitution, impact_in_space, spatial_model, spatial_models

PARALLEL = 1e-3
"""Edges of a mesh whose directions differ by less count as parallel: files round coordinates [rad]."""

MOST_EDGES = 16
"""Of a base with more edges those over which the body falls most easily are computed."""

DIRECTIONS = 4
"""Directions in which a round base is tipped, from x towards y."""

ROUND_BASE = (
    "a round base rolls round its rim and has no impact in one plane: these values hold only if the body is held to "
    "one vertical plane, and must not be used for one that is free; `rocking simulate` follows it as it rolls"
)
"""What must be known before a plane coefficient of a round base is used."""

_MOST = 12
"""Corners of a base that are printed."""


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

    solid: Solid  # the body, and what was done to read it
    edges: tuple[EdgeImpact, ...]  # edges of the base, at most `MOST_EDGES`; of a round one, directions
    gravity: float  # acceleration of gravity [m/s2]

    @property
    def left_out(self) -> int:
        """Number of edges that are less slender and not computed."""
        base = self.solid.base
        return len(base.vertices) - len(self.edges) if isinstance(base, SupportPolygon) else 0

    @classmethod
    def of(cls, solid: Solid, models: list[str] | None, gravity: float) -> "SolidAnswer":
        """Compute what is printed.

        gravity: acceleration of gravity [m/s2].
        """
        pull = checks.positive("gravity", gravity, "m/s2")
        asked = [spatial_model(name) for name in models or spatial_models()]
        return cls(solid, tuple(_edges(solid, asked, pull)), pull)


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
        "body": body_facts(answer.solid),
        "base": base_facts(answer.solid.base),
        "gravity_m_s2": answer.gravity,
        "edges": [edge_facts(edge) for edge in answer.edges],
        "edges_left_out": answer.left_out,
        "repairs": list(answer.solid.repairs),
    }


def body_facts(solid: Solid) -> dict[str, Any]:
    """Return mass and geometry of a body in space."""
    low, high = solid.box
    return {
        "kind": "Solid",
        "name": solid.name,
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


def notes(found: SolidAnswer) -> list[str]:
    """Return what limits the use of the coefficients.

    Returns one sentence each; none for a base with corners.
    """
    return [ROUND_BASE] if isinstance(found.solid.base, RoundBase) else []


def answer_of_solid(
    body: Path,
    size: dict[str, Any],
    told: dict[str, Any],
    asked: dict[str, Any],
    files: dict[str, Path | None],
    *,
    models: list[str] | None,
    gravity: float | None,
    as_json: bool,
) -> None:
    """Print, write and draw the coefficients of a body in space.

    body: TOML file with [solid], or a mesh; gravity: acceleration of gravity; the standard one if not given [m/s2].
    """
    refuse("a body in space has its size from its file", spelt(size))
    plane = {
        "--onto": None if asked["onto"] == "both" else asked["onto"],
        "--eta": None if asked["eta"] == 1.0 else asked["eta"],
        "--identities": asked["identities"],
        "--stages": files["stages"],
    }
    refuse("a body in space rocks about every edge of its base", plane)
    csv, picture = files["csv"], files["picture"]
    check_files(picture, csv)
    found = SolidAnswer.of(solid_from(body, **told), models, g if gravity is None else gravity)
    if csv is not None:
        write_csv(found, csv)
    if picture is not None:
        draw(found.solid, picture)
    if as_json:
        facts = json.loads(as_text(found))
        print(json.dumps({**facts, "notes": notes(found)}, indent=2, allow_nan=False))
        return
    show(found, told["unit"] or "m")
    for sentence in notes(found):
        print(f"! {sentence}")
    for path in filter(None, (csv, picture)):
        print(f"wrote {path}")


def show(answer: SolidAnswer, length: str = "m") -> None:
    """Print body, repairs, base, and edges with the coefficients of every model."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    show_body(answer.solid, length)
    console.print()
    console.print("Edges it may rock about" if _numbered(answer) else "Directions it may be tipped in", style="bold")
    console.print(_geometry(answer.edges, length))
    console.print()
    console.print("Coefficient of restitution, angular velocity after / before", style="bold")
    console.print(_coefficients(answer.edges))
    if answer.left_out:
        console.print(f"{answer.left_out} edges that are less slender are left out", style="dim")
    for sentence in _flags(answer):
        console.print(f"! {sentence}", style="yellow", markup=False)


def show_body(solid: Solid, length: str = "m") -> None:
    """Print mass, centre, base and repairs of a body in space."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    x, y, z = (solid.centre - [0.0, 0.0, solid.ground]).tolist()
    size = " x ".join(f"{side / LENGTH_UNITS[length]:.4g}" for side in (solid.box[1] - solid.box[0]).tolist())
    parts = len(solid.local_parts)
    console.print(
        f"{solid.name}: {size} {length}, {parts} part{'s' * (parts > 1)}, mass {solid.mass:.6g} kg, "
        f"volume {solid.volume:.6g} m3",
        markup=False,
    )
    middle = f"x = {_rounded(x, length)} {length}, y = {_rounded(y, length)} {length}"
    console.print(f"centre of mass at {middle}, {in_unit(z, length, '.5g')} above the ground")
    console.print(_base(solid, length), markup=False)
    for sentence in solid.assumed:
        console.print(sentence, markup=False)
    for sentence in solid.repairs:
        console.print(f"! {sentence}", style="yellow", markup=False)


def as_text(answer: SolidAnswer) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys where a quantity has one.
    """
    return json.dumps(solid_facts(answer), indent=2, allow_nan=False)


def write_csv(answer: SolidAnswer, path: Path) -> None:
    """Write edges and coefficients as one CSV file."""
    from rocking.tables import Column, Table, text_array, to_csv

    records = [_record(edge, name) for edge in answer.edges for name in edge.results]
    columns = {name: Column(text_array([record[name] for record in records]), "") for name in records[0]}
    to_csv(Table("coefficient", columns), path)


def draw(solid: Solid, path: Path) -> None:
    """Draw the body on its base."""
    from rocking.plots.solid import solid_picture
    from rocking.plots.style import write

    write(solid_picture(solid), path)


def _record(edge: EdgeImpact, name: str) -> dict[str, Any]:
    facts = edge_facts(edge)
    found = facts.pop("coefficients")[name]
    start, end = facts.pop("from_m"), facts.pop("to_m")
    places = {"from_x_m": start[0], "from_y_m": start[1], "to_x_m": end[0], "to_y_m": end[1]}
    return {
        **facts,
        **places,
        "model": name,
        "coefficient_of_restitution": found["coefficient"],
        "energy_ratio": found["energy_ratio"],
        "flags": " ".join(found["flags"]),
    }


def _numbered(answer: SolidAnswer) -> bool:
    return not isinstance(answer.solid.base, RoundBase)


def _base(solid: Solid, length: str) -> str:
    base = solid.base
    if isinstance(base, RoundBase):
        x, y = base.centre.tolist()
        middle = f"({_rounded(x, length)}, {_rounded(y, length)}) {length}"
        return f"base: a circle of radius {in_unit(base.radius, length, '.5g')} about {middle}"
    vertices = getattr(base, "vertices", None)
    points = [] if vertices is None else vertices.tolist()
    listed = ", ".join(f"({_rounded(x, length)}, {_rounded(y, length)})" for x, y in points[:_MOST])
    return f"base: {len(points)} corners, {listed}{' ...' if len(points) > _MOST else ''} {length}"


def _rounded(place: float, length: str) -> str:
    # a nanometre is rounding
    return f"{(round(place, 9) + 0.0) / LENGTH_UNITS[length]:.5g}"


def _geometry(edges: tuple[EdgeImpact, ...], length: str) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    places = (f"from (x, y) {length}", f"to (x, y) {length}")
    for word in ("edge", *places, "alpha rad", "deg", "h/b", f"R {length}", "p rad/s"):
        table.add_column(word, justify="left" if word == "edge" else "right")
    for edge in edges:
        ends = (f"{_rounded(x, length)}, {_rounded(y, length)}" for x, y in edge.ends)
        table.add_row(
            edge.name,
            *ends,
            f"{edge.slenderness_angle:.4f}",
            f"{math.degrees(edge.slenderness_angle):.2f}",
            f"{1.0 / math.tan(edge.slenderness_angle):.3f}",
            f"{edge.semi_diagonal / LENGTH_UNITS[length]:.{4 if length == 'm' else 2}f}",
            f"{edge.frequency_parameter:.4f}",
        )
    return table


def _coefficients(edges: tuple[EdgeImpact, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("from edge")
    table.add_column("onto")
    for name in edges[0].results:
        table.add_column(name, justify="right")
    for edge in edges:
        found = (f"{one.coefficient:.6f}{' !' if one.flags else ''}" for one in edge.results.values())
        table.add_row(edge.name, edge.onto, *found)
    return table


def _flags(answer: SolidAnswer) -> list[str]:
    told: dict[tuple[str, str], list[str]] = {}
    for edge in answer.edges:
        for name, found in edge.results.items():
            for flag in found.flags:
                told.setdefault((name, flag.value), []).append(edge.name)
    return [
        f"{name}, from {', '.join(edges[:_MOST])}{' ...' if len(edges) > _MOST else ''}: {sentence}"
        for (name, sentence), edges in told.items()
    ]
