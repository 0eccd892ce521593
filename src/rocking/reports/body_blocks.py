"""The body in reports: its picture, its data, what was assumed of it, and the repairs of its mesh."""

from collections.abc import Callable
from typing import Any

from rocking.answers import Display
from rocking.bodies import Body, Solid
from rocking.bodies.body import assumed_rows
from rocking.plots.body import body_picture
from rocking.plots.solid import equilibria_picture
from rocking.reports.document import Block, Pair, Paragraph, Picture, ReportTable, table
from rocking.reports.response_document import body_table

Pictures = dict[str, Callable[[], Any]]


def body_blocks(body: Body | Solid, gravity: float) -> tuple[list[Block], Pictures]:
    """Return what a report shows of a body under a gravity [m/s2], and what draws its picture."""
    if isinstance(body, Body):
        pair = Pair(Picture("body", "The body on its feet O and O'"), body_table("", body, gravity))
        return [pair], {"body": lambda: body_picture(body)}
    pose = body.equilibria().settling((0.0, 0.0, -1.0))
    picture = Picture("body", "Energy barrier by direction; the support polygon; the body from its sides")
    return [picture, solid_table(body, gravity), *repairs_of(body)], {"body": lambda: equilibria_picture(body, pose)}


def repairs_of(body: Any) -> list[Block]:
    """Return the repairs of a mesh, one paragraph each."""
    return [Paragraph(each, "Mesh repair:", "fair") for each in getattr(body, "repairs", ())]


def solid_table(solid: Solid, gravity: float) -> ReportTable:
    """Return the data of a solid as it stands under a gravity [m/s2]."""
    found = solid.equilibria()
    pose = found.settling((0.0, 0.0, -1.0))
    values = {
        "size": found.hull.vertices.max(axis=0) - found.hull.vertices.min(axis=0), "mass": solid.mass,
        "centre_height": pose.height, "barrier_energy": solid.mass * gravity * pose.barrier, "barrier": pose.barrier,
    }  # fmt: skip
    size, mass, *lines = Display().lines(values, [*values], in_full=True)
    return table("", ["quantity", "value"], [size, mass, *assumed_rows(solid), *lines])
