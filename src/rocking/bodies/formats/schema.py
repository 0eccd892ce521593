"""What may stand in a TOML file of a body. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Any, Literal, Optional

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from rocking.bodies.formats.words import suggestion
from rocking.errors import InvalidValueError

Positive = Annotated[float, Field(gt=0.0)]
Mass = Annotated[float, Field(gt=0.0, le=1e36)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Ring = Annotated[list[Pair], Field(min_length=3)]
UnitName = Literal["m", "cm", "mm", "ft", "in"]
_FILE_UNIT = "[unit of the file]"


class StrictTable(BaseModel):
    """A table whose keys are all known; numbers are numbers, and finite."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, given: Any) -> Any:
        for key in given if isinstance(given, dict) else ():
            if key not in cls._names():
                raise cls._unknown(key)
        return given

    @classmethod
    def _names(cls) -> list[str]:
        return [field.alias or name for name, field in cls.model_fields.items()]

    @classmethod
    def _unknown(cls, key: str) -> InvalidValueError:
        return InvalidValueError("unknown key {key!r:.60}", key=key, hint=suggestion(key, cls._names()))


class KnownTable(StrictTable):
    """What is known of a body beside its shape."""

    mass: Mass | None = Field(None, description="mass, if known, in place of densities [kg]")
    centre: Pair | None = Field(
        None, description="centre of mass (x, y), if known; of a block from its lower left corner [unit of the file]"
    )
    moment_of_inertia: Positive | None = Field(
        None, description="polar moment about the centre of mass, if known [kg m2]"
    )


class ShapeTable(KnownTable):
    """What every section-like shape has beside its dimensions, in the file's unit and kg/m3."""

    depth: Positive | None = Field(None, description="depth out of the plane; 1 m if left out [unit of the file]")
    density: Positive | None = Field(None, description="density; 2400 if neither the file nor the user says [kg/m3]")
    feet: Pair | None = Field(
        None, description="positions of the left and right foot; the ends of the base if left out [unit of the file]"
    )


class BlockTable(ShapeTable):
    """A rectangle, on its corners or on feet within its base."""

    width: Positive = Field(description=f"full width {_FILE_UNIT}")
    height: Positive = Field(description=f"full height {_FILE_UNIT}")


BLOCK_KEYS = tuple(
    name for table in (BlockTable, ShapeTable, KnownTable) for name in table.__annotations__ if name != "feet"
)
"""Keys of a block in its short form, beside the unit."""


def _optional(*names: str, unit: str = _FILE_UNIT) -> Any:
    fields = {name: BlockTable.model_fields[name] for name in names}
    return {
        name: (
            Optional[field.rebuild_annotation()],  # noqa: UP045
            Field(None, description=(field.description or "").replace(_FILE_UNIT, unit)),
        )
        for name, field in fields.items()
    }


BlockInput: Any = create_model(
    "BlockInput",
    __base__=StrictTable,
    **_optional(*(name for name in BLOCK_KEYS if name not in KnownTable.model_fields)),
)
"""The sizes of a block in its short form, where another body may stand in their place."""

BlockSides: Any = create_model("BlockSides", __base__=StrictTable, **_optional("width", "height", unit="[m]"))
"""Width and height of a block, where its slenderness may stand in their place."""


class TrapezoidTable(ShapeTable):
    """A trapezoid, upright or leaning."""

    base: Positive = Field(description="width at the ground [unit of the file]")
    top: Positive = Field(description="width at the top [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")
    lean: float = Field(
        0.0, description="how far the middle of the top lies to the right of that of the base [unit of the file]"
    )


class EllipseTable(ShapeTable):
    """An ellipse as an inscribed polygon."""

    width: Positive = Field(description="full width [unit of the file]")
    height: Positive = Field(description="full height [unit of the file]")
    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(64, description="sides of the polygon in its place")


class RegularPolygonTable(ShapeTable):
    """A regular polygon on one of its sides."""

    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(description="number of sides")
    radius: Positive = Field(description="from the centre to a corner [unit of the file]")


class RegionTable(StrictTable):
    """A polygon, or the polygons of a text or of a file beside the body file."""

    outline: Ring | None = Field(None, description="corners, either way round [unit of the file]")
    holes: list[Ring] | None = Field(None, description="rings cut out [unit of the file]")
    wkt: str | None = Field(None, description="a POLYGON or MULTIPOLYGON, as text")
    geojson: str | None = Field(None, description="a file of GeoJSON beside the body file")
    dxf: str | None = Field(None, description="a drawing beside the body file")
    units: UnitName | None = Field(None, description="unit of that text or file, where it differs")
    layers: dict[str, Positive] | None = Field(None, description="densities by layer of the drawing [kg/m3]")
    density: Positive | None = Field(None, description="density of this region [kg/m3]")

    @model_validator(mode="after")
    def _one_source(self) -> "RegionTable":
        sources = [key for key in ("outline", "wkt", "geojson", "dxf") if getattr(self, key) is not None]
        if len(sources) != 1:
            keys = " and ".join(sources) or "none"
            raise InvalidValueError("a region has one of outline, wkt, geojson or dxf, got {keys}", keys=keys)
        for key, owners in (("holes", "outline"), ("units", "wkt geojson dxf"), ("layers", "dxf")):
            if getattr(self, key) is not None and sources[0] not in owners.split():
                raise InvalidValueError("{key} cannot stand beside {source}", key=key, source=sources[0])
        return self


class SectionTable(KnownTable):
    """Regions, feet, depth and ground."""

    region: Annotated[list[RegionTable], Field(min_length=1)] = Field(
        description="the regions, one table [[section.region]] each"
    )
    depth: Positive | None = Field(None, description="depth out of the plane [unit of the file]")
    feet: Pair | None = Field(None, description="positions of the left and right foot [unit of the file]")
    ground: float = Field(0.0, description="height of the ground [unit of the file]")


class MassPointsTable(StrictTable):
    """Points, masses and feet, and where the base is flat."""

    points: Annotated[list[Pair], Field(min_length=1)] = Field(description="positions [unit of the file]")
    masses: Annotated[list[Mass], Field(min_length=1)] = Field(description="their masses [kg]")
    feet: Pair = Field(description="positions of the left and right foot [unit of the file]")
    contact: list[Pair] | None = Field(
        None, description="stretches of the ground where the base is flat [unit of the file]"
    )


class BodyFile(StrictTable):
    """A body file: a unit, and one table that says what the body is."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = Field(None, description="what the body is called")
    note: str | None = Field(None, description="anything")
    block: BlockTable | None = Field(None, description="what the body is, one a file")
    trapezoid: TrapezoidTable | None = Field(None, description="what the body is, one a file")
    ellipse: EllipseTable | None = Field(None, description="what the body is, one a file")
    regular_polygon: RegularPolygonTable | None = Field(None, description="what the body is, one a file")
    section: SectionTable | None = Field(None, description="what the body is, one a file")
    mass_points: MassPointsTable | None = Field(None, description="what the body is, one a file")

    @classmethod
    def _unknown(cls, key: str) -> InvalidValueError:
        if key in SHAPES:
            return InvalidValueError(
                "unknown key {key!r} outside of a part: write [[solid.part]] in a line above [solid.part.{key}]",
                key=key,
            )
        tables = [name for name, table in TABLES.items() if key in table.model_fields]
        if not tables:
            return super()._unknown(key)
        others = f"other tables with {key} are {', '.join(f'[{name}]' for name in tables[1:])}" if tables[1:] else ""
        return InvalidValueError(
            "unknown key {key!r} outside of a table: write [{table}] in a line above {key}", key=key, table=tables[0],
            hint=others,
        )  # fmt: skip

    @model_validator(mode="after")
    def _one_body(self) -> "BodyFile":
        _check_one(self, "a body file", BODIES, "[{}]")
        return self


TABLES: dict[str, type[StrictTable]] = {
    "block": BlockTable, "trapezoid": TrapezoidTable, "ellipse": EllipseTable, "regular_polygon": RegularPolygonTable,
    "section": SectionTable, "mass_points": MassPointsTable,
}  # fmt: skip
BODIES = tuple(TABLES)
"""Tables that say what the body is."""


def _check_one(table: StrictTable, owner: str, keys: tuple[str, ...], shown: str = "{}") -> None:
    present = [shown.format(key) for key in keys if getattr(table, key) is not None]
    if len(present) != 1:
        choice = ", ".join(map(shown.format, keys))
        raise InvalidValueError(
            "{owner} has exactly one of {choice}, got {keys}", owner=owner, choice=choice,
            keys=" and ".join(present) or "none",
        )  # fmt: skip


Cut = Annotated[float, Field(ge=0.0)]
Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
MOST_PARTS = 500  # a body may have so many parts: each is tried against each for overlaps


class BoxTable(StrictTable):
    """A box on z = 0, centred over the origin."""

    width: Positive = Field(description="along x [unit of the file]")
    depth: Positive = Field(description="along y [unit of the file]")
    height: Positive = Field(description="along z, upwards [unit of the file]")


class UprightTable(StrictTable):
    """A cylinder or a cone on z = 0, its axis through the origin."""

    diameter: Positive = Field(description="diameter, of a cone at the ground [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")


class FrustumTable(StrictTable):
    """A cone cut off level."""

    lower_diameter: Positive = Field(description="diameter below [unit of the file]")
    upper_diameter: Positive = Field(description="diameter above [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")


class SphereTable(StrictTable):
    """A sphere, or what level cuts leave of it, its lowest point on z = 0."""

    diameter: Positive = Field(description="diameter [unit of the file]")
    cut_below: Cut = Field(0.0, description="height cut off below [unit of the file]")
    cut_above: Cut = Field(0.0, description="height cut off above [unit of the file]")


class EllipsoidTable(BoxTable):
    """An ellipsoid, or what level cuts leave of it, its lowest point on z = 0."""

    cut_below: Cut = Field(0.0, description="height cut off below [unit of the file]")
    cut_above: Cut = Field(0.0, description="height cut off above [unit of the file]")


class ExtrusionTable(StrictTable):
    """A plan outline with holes, drawn up from z = 0."""

    outline: Ring = Field(description="corners of the plan [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")
    holes: list[Ring] | None = Field(None, description="rings cut out [unit of the file]")


class RevolutionTable(StrictTable):
    """A profile of (radius, height) turned about the z axis."""

    profile: Annotated[list[Pair], Field(min_length=2)] = Field(
        description="points (radius, height), from below [unit of the file]"
    )


class MeshTable(StrictTable):
    """A surface mesh in a file beside the body file."""

    file: str = Field(description="STL, OBJ, PLY, GLB or XYZ beside the body file")
    units: UnitName | None = Field(None, description="its unit, where it differs from that of the file")
    up: Literal["z", "y"] | Triple = Field("z", description="which axis or direction of the mesh points upwards")
    weld_tolerance: Positive | None = Field(None, description="corners this close are one [unit of the file]")
    repair: Literal["none", "safe", "all"] = Field("safe", description="what may be mended, and is said")
    surface: Literal["faces", "wrap", "hull"] = Field(
        "faces", description="its faces, or a skin over its points, or their hull"
    )
    wall: Positive | None = Field(None, description="how thick it is, where it is hollow [unit of the file]")
    inner_parts: Literal["refuse", "solid", "cavity"] = Field(
        "refuse", description="closed parts inside another one and wound like it: refused, solid or cavities"
    )


class TurnTable(StrictTable):
    """A turn about an axis through the origin, counter-clockwise seen against it."""

    axis: Triple = Field(description="direction of the axis")
    degrees: float = Field(description="angle [degrees]")


class PartTable(StrictTable):
    """One shape of one material: turned, in the order that is written, then moved."""

    box: BoxTable | None = Field(None, description="a shape, one a part")
    cylinder: UprightTable | None = Field(None, description="a shape, one a part")
    cone: UprightTable | None = Field(None, description="a shape, one a part")
    frustum: FrustumTable | None = Field(None, description="a shape, one a part")
    sphere: SphereTable | None = Field(None, description="a shape, one a part")
    ellipsoid: EllipsoidTable | None = Field(None, description="a shape, one a part")
    extrusion: ExtrusionTable | None = Field(None, description="a shape, one a part")
    revolution: RevolutionTable | None = Field(None, description="a shape, one a part")
    mesh: MeshTable | None = Field(None, description="a shape, one a part")
    density: Positive | None = Field(None, description="density of this part [kg/m3]")
    turned: list[TurnTable] | None = Field(None, description="turns, one after the other")
    at: Triple | None = Field(None, description="where its origin is moved then [unit of the file]")

    @model_validator(mode="after")
    def _one_shape(self) -> "PartTable":
        _check_one(self, "a part", SHAPES)
        return self


SHAPES = ("box", "cylinder", "cone", "frustum", "sphere", "ellipsoid", "extrusion", "revolution", "mesh")
"""Tables that say which shape a part has."""


class SolidTable(StrictTable):
    """Parts, and on what they stand."""

    part: Annotated[list[PartTable], Field(min_length=1, max_length=MOST_PARTS)] = Field(
        description="the parts, one table [[solid.part]] each"
    )
    base: Annotated[list[Pair], Field(min_length=3)] | None = Field(
        None, description="points (x, y) that it stands on; its corners on the ground if left out [unit of the file]"
    )
    ground: float | None = Field(None, description="height of the ground [unit of the file]")
    base_tolerance: Positive | None = Field(
        None, description="corners this close to the ground stand on it [unit of the file]"
    )
    mass: Mass | None = Field(None, description="mass, if known, in place of densities [kg]")
    centre: Triple | None = Field(None, description="centre of mass (x, y, z), if known [unit of the file]")
    inertia: Annotated[list[float | Triple], Field(min_length=3, max_length=3)] | None = Field(
        None, description="inertia about the centre of mass: three rows, or the three moments about x, y, z [kg m2]"
    )


class SolidDocument(StrictTable):
    """A file of a body in space: a unit and the table [solid]."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = Field(None, description="what the body is called")
    note: str | None = Field(None, description="anything")
    solid: SolidTable = Field(description="parts, and on what they stand")
