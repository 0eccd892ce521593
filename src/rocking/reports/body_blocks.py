"""The body in reports: picture, data, assumed data, and repairs of the mesh."""

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
    """Return the blocks of a body under a gravity [m/s2], and the functions that draw its pictures."""
    if isinstance(body, Body):
        pair = Pair(Picture("body", "The body on its feet O and O'"), body_table("", body, gravity))
        return [pair], {"body": lambda: body_picture(body)}
    pose = body.equilibria().settling((0.0, 0.0, -1.0))
    picture = Picture("body", "Energy barrier by direction; the support polygon; the body from its sides")
    return [picture, solid_table(body, gravity), *repairs_of(body)], {"body": lambda: equilibria_picture(body, pose)}


def repairs_of(body: Any) -> list[Block]:
    """Return one paragraph per repair of a mesh."""
    return [Paragraph(repair, "Mesh repair:", "fair") for repair in getattr(body, "repairs", ())]


def solid_table(solid: Solid, gravity: float) -> ReportTable:
    """Return the data of a solid in its initial pose under a gravity [m/s2]."""
    equilibria = solid.equilibria()
    pose = equilibria.settling((0.0, 0.0, -1.0))
    values = {
        "size": equilibria.hull.vertices.max(axis=0) - equilibria.hull.vertices.min(axis=0), "mass": solid.mass,
        "centre_height": pose.height, "barrier_energy": solid.mass * gravity * pose.barrier, "barrier": pose.barrier,
    }  # fmt: skip
    size, mass, *lines = Display().lines(values, [*values], in_full=True)
    return table("", ["quantity", "value"], [size, mass, *assumed_rows(solid), *lines])
