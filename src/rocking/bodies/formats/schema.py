"""What may stand in a TOML file of a body. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from rocking.bodies.formats.words import suggestion

Positive = Annotated[float, Field(gt=0.0)]
Mass = Annotated[float, Field(gt=0.0, le=1e36)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Ring = Annotated[list[Pair], Field(min_length=3)]
UnitName = Literal["m", "cm", "mm", "ft", "in"]


class StrictTable(BaseModel):
    """A table whose keys are all known; numbers are numbers, and finite."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, given: Any) -> Any:
        for key in given if isinstance(given, dict) else ():
            if key not in cls.model_fields:
                raise _refused("unknown_key", f"unknown key {key!r}{suggestion(key, cls.model_fields)}")
        return given


class ShapeTable(StrictTable):
    """What every section-like shape has beside its dimensions, in the file's unit and kg/m3."""

    density: Positive | None = None
    depth: Positive | None = None
    feet: Pair | None = None


class BlockTable(ShapeTable):
    """A rectangle; with feet it becomes a `Section`."""

    width: Positive
    height: Positive


class TrapezoidTable(ShapeTable):
    """A trapezoid, upright or leaning."""

    base: Positive
    top: Positive
    height: Positive
    lean: float = 0.0


class EllipseTable(ShapeTable):
    """An ellipse as an inscribed polygon."""

    width: Positive
    height: Positive
    sides: Annotated[int, Field(ge=3, le=100_000)] = 64


class RegularPolygonTable(ShapeTable):
    """A regular polygon on one of its sides."""

    sides: Annotated[int, Field(ge=3, le=100_000)]
    radius: Positive


class RegionTable(StrictTable):
    """A polygon, or the polygons of a text or of a file beside the body file."""

    outline: Ring | None = None
    holes: list[Ring] | None = None
    wkt: str | None = None
    geojson: str | None = None
    dxf: str | None = None
    units: UnitName | None = None
    layers: dict[str, Positive] | None = None
    density: Positive | None = None

    @model_validator(mode="after")
    def _one_source(self) -> "RegionTable":
        sources = [key for key in ("outline", "wkt", "geojson", "dxf") if getattr(self, key) is not None]
        if len(sources) != 1:
            got = " and ".join(sources) or "none"
            raise _refused("contradiction", f"a region has one of outline, wkt, geojson or dxf, got {got}")
        for key, owners in (("holes", "outline"), ("units", "wkt geojson dxf"), ("layers", "dxf")):
            if getattr(self, key) is not None and sources[0] not in owners.split():
                raise _refused("contradiction", f"{key} cannot stand beside {sources[0]}")
        return self


class SectionTable(StrictTable):
    """Regions, feet, depth and ground."""

    region: Annotated[list[RegionTable], Field(min_length=1)]
    depth: Positive | None = None
    feet: Pair | None = None
    ground: float = 0.0


class MassPointsTable(StrictTable):
    """Points, masses and feet, and where the base is flat."""

    points: Annotated[list[Pair], Field(min_length=1)]
    masses: Annotated[list[Mass], Field(min_length=1)]
    feet: Pair
    contact: list[Pair] | None = None


class BodyFile(StrictTable):
    """A body file: a unit, and one table that says what the body is."""

    units: UnitName
    name: str | None = None
    note: str | None = None
    block: BlockTable | None = None
    trapezoid: TrapezoidTable | None = None
    ellipse: EllipseTable | None = None
    regular_polygon: RegularPolygonTable | None = None
    section: SectionTable | None = None
    mass_points: MassPointsTable | None = None

    @model_validator(mode="after")
    def _one_body(self) -> "BodyFile":
        _check_one(self, "a body file", BODIES, "[{}]")
        return self


BODIES = ("block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points")
"""Tables that say what the body is."""


def _refused(kind: Literal["unknown_key", "contradiction"], words: str) -> PydanticCustomError:
    return PydanticCustomError(kind, "{words}", {"words": words})


def _check_one(table: StrictTable, owner: str, keys: tuple[str, ...], shown: str = "{}") -> None:
    present = [shown.format(key) for key in keys if getattr(table, key) is not None]
    if len(present) != 1:
        choice = ", ".join(map(shown.format, keys))
        raise _refused("contradiction", f"{owner} has exactly one of {choice}, got {' and '.join(present) or 'none'}")


Cut = Annotated[float, Field(ge=0.0)]
Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
MOST_PARTS = 500
"""A body may have so many parts: each is tried against each for overlaps."""


class BoxTable(StrictTable):
    """A box on z = 0, centred over the origin."""

    width: Positive
    depth: Positive
    height: Positive


class UprightTable(StrictTable):
    """A cylinder or a cone on z = 0, its axis through the origin."""

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


class EllipsoidTable(BoxTable):
    """An ellipsoid, or what level cuts leave of it, its lowest point on z = 0."""

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
    cylinder: UprightTable | None = None
    cone: UprightTable | None = None
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
        _check_one(self, "a part", SHAPES)
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
