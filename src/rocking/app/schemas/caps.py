"""How large a body and a question may be, so that every answer comes within about a second."""

import re
from typing import Literal

import numpy as np

from rocking.app.problems import TooLarge
from rocking.bodies import Body
from rocking.bodies.formats.body_schema import Document

MOST_REGIONS = 250
MOST_HOLES = 500
MOST_VERTICES = 10_000
MOST_POINTS = 10_000
MOST_STRETCHES = 40
MOST_RESTITUTIONS = 24
MOST_RECORD_SAMPLES = 2_000_000
MOST_DRAWING_BYTES = 4 << 20
MOST_ENTITIES = 20_000

_X_IN_DXF = re.compile(rb"^[ \t]*10[ \t]*\r?$", re.MULTILINE)

_ENTITY_IN_DXF = re.compile(rb"^[ \t]*0[ \t]*\r?$", re.MULTILINE)

_MINISEED = re.compile(rb"\d{6}[DRQM][ \0]")

CAPS = {
    "regions": MOST_REGIONS,
    "holes": MOST_HOLES,
    "vertices": MOST_VERTICES,
    "mass_points": MOST_POINTS,
    "contact_stretches": MOST_STRETCHES,
    "restitutions": MOST_RESTITUTIONS,
    "record_samples": MOST_RECORD_SAMPLES,
    "drawing_bytes": MOST_DRAWING_BYTES,
    "drawing_entities": MOST_ENTITIES,
}
"""What one body and one question may hold, as the API tells it."""


def refuse_more(count: int, most: int, what: str, way_out: str = "") -> None:
    """Refuse more of something than one answer takes."""
    if count > most:
        raise TooLarge(f"{what.format(most=most)}, got {count}" + (f"; {way_out}" if way_out else ""))


def check_size(given: Document) -> None:
    """Refuse a body that is too large, before anything is made of it."""
    regions, holes, vertices = _polygons(given)
    refuse_more(regions, MOST_REGIONS, "a section holds up to {most} regions", "join those of one density")
    refuse_more(holes, MOST_HOLES, "a section holds up to {most} holes", "leave out the small ones")
    refuse_more(vertices, MOST_VERTICES, "outlines and holes hold up to {most} vertices", "simplify the outline")
    points = given.mass_points
    held = 0 if points is None else max(len(points.points), len(points.masses), len(points.contact or ()))
    refuse_more(held, MOST_POINTS, "a body holds up to {most} points with mass")


def check_file(content: bytes, name: str) -> None:
    """Refuse a body file that holds far more than a body may have, before it is read."""
    drawing = name.lower().endswith(".dxf")
    if drawing:
        way_out = "save only the outline in a drawing of its own"
        refuse_more(len(content), MOST_DRAWING_BYTES, "a drawing has up to {most} bytes", way_out)
        refuse_more(len(_ENTITY_IN_DXF.findall(content)), MOST_ENTITIES, "a drawing has up to {most} parts", way_out)
    # a drawing may hold much that is no outline; in text a comma or a bracket stands before every point
    points = len(_X_IN_DXF.findall(content)) // 4 if drawing else max(content.count(b","), content.count(b"[")) // 3
    refuse_more(points, MOST_VERTICES, "a body file may describe up to {most} vertices", "simplify the outlines")


def check_record(content: bytes) -> None:
    """Refuse a record file of far more numbers than a record has, before any of them is read."""
    if _MINISEED.match(content):
        check_samples(_packed_samples(content))
        return
    if len(content) <= MOST_RECORD_SAMPLES or b"\0" in content:
        return
    octets = np.frombuffer(content, dtype=np.uint8)
    between = (octets <= 32) | np.isin(octets, (44, 59))  # white space, comma, semicolon
    check_samples(int(np.count_nonzero(between[:-1] & ~between[1:])) + int(not between[0]))


def _packed_samples(content: bytes) -> int:
    """Return how many samples the headers of a miniSEED file announce, and not one fewer than are decoded."""
    found = 0
    for head in _MINISEED.finditer(content):
        years = content[head.start() + 20 : head.start() + 22]
        order: Literal["big", "little"] = "big" if 1900 <= int.from_bytes(years, "big") <= 2200 else "little"
        found += int.from_bytes(content[head.start() + 30 : head.start() + 32], order)
    return found


def check_samples(count: int) -> None:
    """Refuse a record of too many samples."""
    what = "a record holds up to {most} numbers"
    refuse_more(count, MOST_RECORD_SAMPLES, what, "cut it, or leave out columns; Python reads longer ones")


def check_contact(body: Body) -> Body:
    """Return a body, unless its base touches the ground in too many places."""
    what = "a base touches the ground in up to {most} separate stretches"
    refuse_more(len(body.local_contact), MOST_STRETCHES, what, "leave out those that are no feet")
    return body


def size_of(given: Document) -> int:
    """Return how much there is to compute with."""
    return _polygons(given)[-1] + (len(given.mass_points.points) if given.mass_points else 0)


def _polygons(given: Document) -> tuple[int, int, int]:
    regions = holes = vertices = 0
    for region in given.section.region if given.section else ():
        words = region.wkt or ""
        # every polygon of a text begins with two brackets, and commas stand between its points
        polygons = 1 if region.outline is not None else max(1, words.count("(("))
        regions += polygons
        holes += len(region.holes or ()) + max(0, words.count(",(") + words.count(", (") - polygons + 1)
        rings = [region.outline or [], *(region.holes or ())]
        vertices += sum(map(len, rings)) + (words.count(",") + 1 if words else 0)
    for shape in (given.ellipse, given.regular_polygon):
        vertices += shape.sides if shape is not None else 0
    return regions, holes, vertices
