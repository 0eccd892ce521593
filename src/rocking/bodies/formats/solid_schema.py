"""What may stand in a TOML file of a body in space. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from rocking.bodies.formats.body_schema import Pair, Positive, Ring, StrictTable, UnitName

Cut = Annotated[float, Field(ge=0.0)]
Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
MOST_PARTS = 500
"""A body may have so many parts: each is tried against each for overlaps."""


class BoxTable(StrictTable):
    """A box on z = 0, centred over the origin."""

    width: Positive
    depth: Positive
    height: Positive


class CylinderTable(StrictTable):
    """An upright cylinder on z = 0, its axis through the origin."""

    diameter: Positive
    height: Positive


class ConeTable(StrictTable):
    """An upright cone on z = 0."""

    diameter: Positive
    height: Positive


class FrustumTable(StrictTable):
    """A cone cut off level."""

    lower_diameter: Positive
    upper_diameter: Positive
    height: Positive


class SphereTable(StrictTable):
    """A sphere, or what level cuts leave of it, its lowest point on z = 0."""

    diameter: Positive
    cut_below: Cut = 0.0
    cut_above: Cut = 0.0


class EllipsoidTable(StrictTable):
    """An ellipsoid, or what level cuts leave of it, its lowest point on z = 0."""

    width: Positive
    depth: Positive
    height: Positive
    cut_below: Cut = 0.0
    cut_above: Cut = 0.0


class ExtrusionTable(StrictTable):
    """A plan outline with holes, drawn up from z = 0."""

    outline: Ring
    height: Positive
    holes: list[Ring] | None = None


class RevolutionTable(StrictTable):
    """A profile of (radius, height) turned about the z axis."""

    profile: Annotated[list[Pair], Field(min_length=2)]


class MeshTable(StrictTable):
    """A surface mesh in a file beside the body file."""

    file: str
    units: UnitName | None = None
    up: Literal["z", "y"] = "z"
    weld_tolerance: Positive | None = None
    fill_holes: bool = False


class TurnTable(StrictTable):
    """A turn about an axis through the origin, counter-clockwise seen against it."""

    axis: Triple
    degrees: float


class PartTable(StrictTable):
    """One shape of one material: turned, in the order that is written, then moved."""

    box: BoxTable | None = None
    cylinder: CylinderTable | None = None
    cone: ConeTable | None = None
    frustum: FrustumTable | None = None
    sphere: SphereTable | None = None
    ellipsoid: EllipsoidTable | None = None
    extrusion: ExtrusionTable | None = None
    revolution: RevolutionTable | None = None
    mesh: MeshTable | None = None
    density: Positive | None = None
    turned: list[TurnTable] | None = None
    at: Triple | None = None

    @model_validator(mode="after")
    def _one_shape(self) -> "PartTable":
        found = [name for name in SHAPES if getattr(self, name) is not None]
        if len(found) != 1:
            words = f"a part has exactly one of {', '.join(SHAPES)}, got {' and '.join(found) or 'none'}"
            raise PydanticCustomError("contradiction", "{words}", {"words": words})
        return self


SHAPES = ("box", "cylinder", "cone", "frustum", "sphere", "ellipsoid", "extrusion", "revolution", "mesh")
"""Tables that say which shape a part has."""


class SolidTable(StrictTable):
    """Parts, and on what they stand."""

    part: Annotated[list[PartTable], Field(min_length=1, max_length=MOST_PARTS)]
    base: Annotated[list[Pair], Field(min_length=3)] | None = None
    ground: float | None = None
    base_tolerance: Positive | None = None


class SolidDocument(StrictTable):
    """A file of a body in space: a unit and the table [solid]."""

    units: UnitName
    name: str | None = None
    note: str | None = None
    solid: SolidTable
