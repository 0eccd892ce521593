"""Tables of a body file in TOML. Loads pydantic: import only to read a file."""

from typing import Annotated, Any, Literal, Optional

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from rocking.bodies.formats.words import suggestion
from rocking.errors import InvalidValueError

Positive = Annotated[float, Field(gt=0.0)]
Cut = Annotated[float, Field(ge=0.0)]
Mass = Annotated[float, Field(gt=0.0, le=1e36)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Ring = Annotated[list[Pair], Field(min_length=3)]
UnitName = Literal["m", "cm", "mm", "ft", "in"]
_FILE_UNIT = "[unit of the file]"


class StrictTable(BaseModel):
    """Base class of tables. Unknown keys and numbers that are not finite are errors."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, table: Any) -> Any:
        for key in table if isinstance(table, dict) else ():
            if key not in cls._names():
                raise cls._unknown(key)
        return table

    @classmethod
    def _names(cls) -> list[str]:
        return [field.alias or name for name, field in cls.model_fields.items()]

    @classmethod
    def _unknown(cls, key: str) -> InvalidValueError:
        return InvalidValueError("unknown key {key!r:.60}", key=key, hint=suggestion(key, cls._names()))


class KnownTable(StrictTable):
    """Known mass, centre of mass and moment of inertia."""

    mass: Mass | None = Field(None, description="known mass, in place of densities [kg]")
    centre: Pair | None = Field(
        None, description="known centre of mass (x, y), of a block from its lower left corner [unit of the file]"
    )
    moment_of_inertia: Positive | None = Field(None, description="known polar moment about the centre of mass [kg m2]")


class ShapeTable(KnownTable):
    """Depth, density and feet of a 2D shape."""

    depth: Positive | None = Field(None, description="depth, across the motion, default 1 m [unit of the file]")
    density: Positive | None = Field(None, description="density, default 2400 [kg/m3]")
    feet: Pair | None = Field(
        None, description="positions of the left and right foot, default: ends of the base [unit of the file]"
    )


class BlockTable(ShapeTable):
    """A rectangle with feet at its corners or within its base."""

    width: Positive = Field(description=f"full width, along the motion {_FILE_UNIT}")
    height: Positive = Field(description=f"full height {_FILE_UNIT}")


BLOCK_KEYS = tuple(
    name for table in (BlockTable, ShapeTable, KnownTable) for name in table.__annotations__ if name != "feet"
)
"""Keys of a block in its short form, without the unit."""


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
"""Optional sizes of a block in its short form, if another body is allowed too."""

BlockSides: Any = create_model("BlockSides", __base__=StrictTable, **_optional("width", "height", unit="[m]"))
"""Optional width and height of a block, if slenderness is allowed too."""


class TrapezoidTable(ShapeTable):
    """A symmetric or inclined trapezoid."""

    base: Positive = Field(description="width at the ground [unit of the file]")
    top: Positive = Field(description="width at the top [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")
    lean: float = Field(
        0.0, description="offset of the middle of the top to the right of the middle of the base [unit of the file]"
    )


class EllipseTable(ShapeTable):
    """An ellipse as an inscribed polygon."""

    width: Positive = Field(description="full width [unit of the file]")
    height: Positive = Field(description="full height [unit of the file]")
    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(64, description="number of sides of the polygon")


class RegularPolygonTable(ShapeTable):
    """A regular polygon on one of its sides."""

    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(description="number of sides")
    radius: Positive = Field(description="radius from the centre to a corner [unit of the file]")


class RegionTable(StrictTable):
    """A polygon, or the polygons of a text or a file."""

    outline: Ring | None = Field(None, description="corners, clockwise or counter-clockwise [unit of the file]")
    holes: list[Ring] | None = Field(None, description="outlines of holes [unit of the file]")
    wkt: str | None = Field(None, description="POLYGON or MULTIPOLYGON as text")
    geojson: str | None = Field(None, description="GeoJSON file, relative to the body file")
    dxf: str | None = Field(None, description="DXF drawing, relative to the body file")
    units: UnitName | None = Field(None, description="unit of the text or file, if different from the body file")
    layers: dict[str, Positive] | None = Field(None, description="densities by layer of the drawing [kg/m3]")
    density: Positive | None = Field(None, description="density of this region [kg/m3]")

    @model_validator(mode="after")
    def _one_source(self) -> "RegionTable":
        sources = [key for key in ("outline", "wkt", "geojson", "dxf") if getattr(self, key) is not None]
        if len(sources) != 1:
            keys = " and ".join(sources) or "none"
            raise InvalidValueError("A region needs one of outline, wkt, geojson or dxf, got {keys}.", keys=keys)
        for key, owners in (("holes", "outline"), ("units", "wkt geojson dxf"), ("layers", "dxf")):
            if getattr(self, key) is not None and sources[0] not in owners.split():
                raise InvalidValueError("{key} is not allowed with {source}.", key=key, source=sources[0])
        return self


class SectionTable(KnownTable):
    """Regions, feet, depth and ground of a section."""

    region: Annotated[list[RegionTable], Field(min_length=1)] = Field(
        description="regions, one table [[section.region]] per region"
    )
    depth: Positive | None = Field(None, description="depth out of the plane [unit of the file]")
    feet: Pair | None = Field(None, description="positions of the left and right foot [unit of the file]")
    ground: float = Field(0.0, description="height of the ground [unit of the file]")


class MassPointsTable(StrictTable):
    """Points, masses, feet and contact intervals."""

    points: Annotated[list[Pair], Field(min_length=1)] = Field(
        description="positions (x, y) of the points [unit of the file]"
    )
    masses: Annotated[list[Mass], Field(min_length=1)] = Field(description="masses of the points [kg]")
    feet: Pair = Field(description="positions of the left and right foot [unit of the file]")
    contact: list[Pair] | None = Field(
        None, description="contact intervals of the base with the ground [unit of the file]"
    )


class RestraintTable(StrictTable):
    """A restraint between the ground and a point of the body."""

    kind: Literal["tendon", "viscous_damper", "friction_damper", "fuse", "spring"] = Field(
        description="kind of the restraint"
    )
    name: str | None = Field(None, description="name in results, default: kind and number")
    x: float | None = Field(None, description="position on the base, x as for the feet [unit of the file]")
    length: Cut | None = Field(None, description="distance of the anchor below the base at x [unit of the file]")
    ground: Pair | None = Field(None, description="fixed point (x, z) on the ground; replaces x [unit of the file]")
    point: Pair | None = Field(None, description="attachment point (x, z) on the upright body [unit of the file]")
    stiffness: Cut | None = Field(None, description="tendon, fuse, spring: stiffness [N/m]")
    area: Positive | None = Field(None, description="tendon: cross section [m2]")
    modulus: Positive | None = Field(None, description="tendon: modulus of elasticity [Pa]")
    free_length: Positive | None = Field(None, description="tendon: length between the anchors [unit of the file]")
    prestress: Cut | None = Field(None, description="tendon: tensile force while the body is upright [N]")
    loss: Cut | None = Field(None, description="tendon: fraction of the prestress lost before the motion [-]")
    yield_force: Positive | None = Field(None, description="tendon, fuse: largest elastic force [N]")
    hardening: Cut | None = Field(None, description="tendon, fuse: stiffness after yielding / stiffness [-]")
    rupture_elongation: Positive | None = Field(
        None, description="tendon: elongation from the prestressed state at rupture [unit of the file]"
    )
    stroke: Positive | None = Field(None, description="fuse: elongation at fracture [unit of the file]")
    tension_only: bool | None = Field(None, description="fuse: true for a bar that buckles without force")
    coefficient: Cut | None = Field(None, description="viscous_damper: coefficient c [N (s/m)^a]")
    exponent: Positive | None = Field(None, description="viscous_damper: exponent a, default 1 [-]")
    slip_force: Cut | None = Field(None, description="friction_damper: slip force [N]")
    gap: Cut | None = Field(None, description="spring: elongation without force [unit of the file]")
    action: Literal["both", "tension", "compression"] | None = Field(None, description="spring: direction of the force")


LENGTHS_OF_RESTRAINTS = ("x", "length", "ground", "point", "free_length", "rupture_elongation", "stroke", "gap")
"""Keys of `RestraintTable` in the unit of the file."""


class BodyFile(StrictTable):
    """A body file: a unit, and one table of the body."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = Field(None, description="name of the body")
    note: str | None = Field(None, description="free text")
    block: BlockTable | None = Field(None, description="rectangular block")
    trapezoid: TrapezoidTable | None = Field(None, description="trapezoid")
    ellipse: EllipseTable | None = Field(None, description="ellipse")
    regular_polygon: RegularPolygonTable | None = Field(None, description="regular polygon")
    section: SectionTable | None = Field(None, description="section of one or more polygons")
    mass_points: MassPointsTable | None = Field(None, description="body of mass points")
    restraint: list[RestraintTable] | None = Field(None, description="restraints, one table per restraint")

    @classmethod
    def _unknown(cls, key: str) -> InvalidValueError:
        if key in SHAPES:
            return InvalidValueError(
                "Key {key!r} is not allowed outside a part. Write [[solid.part]] in a line above [solid.part.{key}].",
                key=key,
            )
        tables = [name for name, table in TABLES.items() if key in table.model_fields]
        if not tables:
            return super()._unknown(key)
        others = f"other tables with {key}: {', '.join(f'[{name}]' for name in tables[1:])}" if tables[1:] else ""
        return InvalidValueError(
            "Key {key!r} is not allowed outside a table. Write [{table}] in a line above {key}",
            key=key, table=tables[0], hint=others,
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
"""A body file contains exactly one of these tables."""


def _check_one(table: StrictTable, owner: str, keys: tuple[str, ...], shown: str = "{}") -> None:
    present = [shown.format(key) for key in keys if getattr(table, key) is not None]
    if len(present) != 1:
        choice = ", ".join(map(shown.format, keys))
        raise InvalidValueError(
            "{owner} needs exactly one of {choice}, got {keys}", owner=owner, choice=choice,
            keys=" and ".join(present) or "none",
        )  # fmt: skip


Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
MOST_PARTS = 500  # largest number of parts; the time of the check for overlaps is proportional to its square


class BoxTable(StrictTable):
    """A box on z = 0, centred over the origin."""

    width: Positive = Field(description="width along x [unit of the file]")
    depth: Positive = Field(description="depth along y [unit of the file]")
    height: Positive = Field(description="height along z [unit of the file]")


class UprightTable(StrictTable):
    """A cylinder or a cone on z = 0 with the z axis as its axis."""

    diameter: Positive = Field(description="diameter of the cylinder, or of the base of the cone [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")


class FrustumTable(StrictTable):
    """A frustum of a cone on z = 0 with the z axis as its axis."""

    lower_diameter: Positive = Field(description="diameter of the base [unit of the file]")
    upper_diameter: Positive = Field(description="diameter of the top [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")


class SphereTable(StrictTable):
    """A sphere, optionally with horizontal cuts, with its lowest point on z = 0."""

    diameter: Positive = Field(description="diameter of the sphere [unit of the file]")
    cut_below: Cut = Field(0.0, description="height of the removed cap at the bottom [unit of the file]")
    cut_above: Cut = Field(0.0, description="height of the removed cap at the top [unit of the file]")


class EllipsoidTable(BoxTable):
    """An ellipsoid, optionally with horizontal cuts, with its lowest point on z = 0."""

    cut_below: Cut = Field(0.0, description="height of the removed cap at the bottom [unit of the file]")
    cut_above: Cut = Field(0.0, description="height of the removed cap at the top [unit of the file]")


class ExtrusionTable(StrictTable):
    """A vertical extrusion of a plan outline with holes, from z = 0."""

    outline: Ring = Field(description="corners of the plan [unit of the file]")
    height: Positive = Field(description="height [unit of the file]")
    holes: list[Ring] | None = Field(None, description="outlines of holes [unit of the file]")


class RevolutionTable(StrictTable):
    """A profile of points (radius, height) rotated about the z axis."""

    profile: Annotated[list[Pair], Field(min_length=2)] = Field(
        description="points (radius, height), from bottom to top [unit of the file]"
    )


class MeshTable(StrictTable):
    """A surface mesh from a file."""

    file: str = Field(description="STL, OBJ, PLY, GLB or XYZ file, relative to the body file")
    units: UnitName | None = Field(None, description="unit of the mesh, if different from the body file")
    up: Literal["z", "y"] | Triple = Field("z", description="axis or direction of the mesh that points upwards")
    weld_tolerance: Positive | None = Field(
        None, description="largest distance of corners that are merged [unit of the file]"
    )
    repair: Literal["none", "safe", "all"] = Field("safe", description="allowed repairs, which are reported")
    surface: Literal["faces", "wrap", "hull"] = Field(
        "faces", description="surface of the body: faces of the mesh, skin around its points, or convex hull"
    )
    wall: Positive | None = Field(None, description="wall thickness of a hollow body [unit of the file]")
    inner_parts: Literal["refuse", "solid", "cavity"] = Field(
        "refuse", description="treatment of closed parts inside another part with the same orientation"
    )


class TurnTable(StrictTable):
    """A rotation about an axis through the origin, counter-clockwise against the axis direction."""

    axis: Triple = Field(description="direction of the rotation axis")
    degrees: float = Field(description="rotation angle [degrees]")


class PartTable(StrictTable):
    """A part: exactly one shape of one material, with rotations and a translation."""

    box: BoxTable | None = Field(None, description="box")
    cylinder: UprightTable | None = Field(None, description="cylinder")
    cone: UprightTable | None = Field(None, description="cone")
    frustum: FrustumTable | None = Field(None, description="frustum of a cone")
    sphere: SphereTable | None = Field(None, description="sphere, optionally with horizontal cuts")
    ellipsoid: EllipsoidTable | None = Field(None, description="ellipsoid, optionally with horizontal cuts")
    extrusion: ExtrusionTable | None = Field(None, description="vertical extrusion of a plan outline")
    revolution: RevolutionTable | None = Field(None, description="body of revolution about the z axis")
    mesh: MeshTable | None = Field(None, description="surface mesh from a file")
    density: Positive | None = Field(None, description="density of this part [kg/m3]")
    turned: list[TurnTable] | None = Field(None, description="rotations of the part, in this order")
    at: Triple | None = Field(None, description="position of the part origin after the rotations [unit of the file]")

    @model_validator(mode="after")
    def _one_shape(self) -> "PartTable":
        _check_one(self, "a part", SHAPES)
        return self


SHAPES = ("box", "cylinder", "cone", "frustum", "sphere", "ellipsoid", "extrusion", "revolution", "mesh")
"""A part contains exactly one of these tables."""


class SolidTable(StrictTable):
    """Parts, base and ground of a 3D body."""

    part: Annotated[list[PartTable], Field(min_length=1, max_length=MOST_PARTS)] = Field(
        description="parts, one table [[solid.part]] per part"
    )
    base: Annotated[list[Pair], Field(min_length=3)] | None = Field(
        None, description="points (x, y) of the base, default: all corners on the ground [unit of the file]"
    )
    ground: float | None = Field(None, description="height of the ground [unit of the file]")
    base_tolerance: Positive | None = Field(
        None, description="largest height of base corners above the ground [unit of the file]"
    )
    mass: Mass | None = Field(None, description="known mass, in place of densities [kg]")
    centre: Triple | None = Field(None, description="known centre of mass (x, y, z) [unit of the file]")
    inertia: Annotated[list[float | Triple], Field(min_length=3, max_length=3)] | None = Field(
        None, description="known inertia about the centre of mass: three rows, or the moments about x, y, z [kg m2]"
    )


class SolidDocument(StrictTable):
    """A file of a 3D body: a unit and the table [solid]."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = Field(None, description="name of the body")
    note: str | None = Field(None, description="free text")
    solid: SolidTable = Field(description="parts, base and ground of the body")
