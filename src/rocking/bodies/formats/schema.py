"""Tables of a body file in TOML. Loads pydantic: import only to read a file."""

from functools import partial
from typing import Annotated, Any, Literal, Optional

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from rocking.bodies.formats.words import suggestion
from rocking.errors import InvalidValueError

Positive = Annotated[float, Field(gt=0.0)]
Cut = Annotated[float, Field(ge=0.0)]
Mass = Annotated[float, Field(gt=0.0, le=1e36)]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
Hardening = Annotated[float, Field(ge=0.0, lt=1.0)]
Exponent = Annotated[float, Field(ge=0.05, le=5.0)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Ring = Annotated[list[Pair], Field(min_length=3)]
UnitName = Literal["m", "cm", "mm", "ft", "in"]
_FILE_UNIT = "[unit of the file]"


def key(
    description: str, default: Any = None, *, usual: str = "", allowed: str = "", unit: str = "", **limits: Any
) -> Any:
    """Return a field with its meaning. The help of options and the manual show the meaning.

    The manual also shows `usual`, the value without the key, `allowed`, and `unit`, where types and limits lack them.
    """
    facts = {"usual": usual, "allowed": allowed, "unit": unit}
    stated: dict[str, Any] = {name: text for name, text in facts.items() if text}
    return Field(default=default, description=description, json_schema_extra=stated or None, **limits)


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

    mass: Mass | None = key("known mass, in place of densities [kg]", usual="density x volume")
    centre: Pair | None = key(
        "known centre of mass (x, y), of a block from its lower left corner [unit of the file]",
        usual="computed from shape and densities", allowed="2 numbers, a point inside the body",
    )  # fmt: skip
    moment_of_inertia: Positive | None = key(
        "known polar moment about the centre of mass [kg m2]", usual="computed from shape and densities"
    )


class ShapeTable(KnownTable):
    """Depth, density and feet of a 2D shape."""

    depth: Positive | None = key("depth, across the motion [unit of the file]", usual="1 m")
    density: Positive | None = key("density [kg/m3]", usual="2400")
    feet: Pair | None = key(
        "positions of the left and right foot [unit of the file]", usual="ends of the base",
        allowed="2 increasing numbers within the base",
    )  # fmt: skip


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
    lean: float = key(
        "offset of the middle of the top to the right of the middle of the base [unit of the file]", 0.0,
        allowed="any with the centre of mass between the feet",
    )  # fmt: skip


class EllipseTable(ShapeTable):
    """An ellipse as an inscribed polygon."""

    width: Positive = Field(description="full width [unit of the file]")
    height: Positive = Field(description="full height [unit of the file]")
    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(64, description="number of sides of the polygon")


class RegularPolygonTable(ShapeTable):
    """A regular polygon on one of its sides."""

    sides: Annotated[int, Field(ge=3, le=100_000)] = Field(description="number of sides")
    radius: Positive = Field(description="radius from the centre to a corner [unit of the file]")


_SOURCE = "one of outline, wkt, geojson, dxf is required"
_IN_FOLDER = "a file in the folder of the body file or below"


class RegionTable(StrictTable):
    """A polygon, or the polygons of a text or a file."""

    outline: Ring | None = key(
        "corners, clockwise or counter-clockwise [unit of the file]", usual=_SOURCE, allowed="3 or more points (x, y)"
    )
    holes: list[Ring] | None = key(
        "outlines of holes [unit of the file]", allowed="outlines of 3 or more points (x, y) inside the region"
    )
    wkt: str | None = key("POLYGON or MULTIPOLYGON as text", usual=_SOURCE, allowed="valid polygons")
    geojson: str | None = key("GeoJSON file, relative to the body file", usual=_SOURCE, allowed=_IN_FOLDER)
    dxf: str | None = key("DXF drawing, relative to the body file", usual=_SOURCE, allowed=_IN_FOLDER)
    units: UnitName | None = key("unit of the text or file, if different from the body file", usual="unit of the file")
    layers: dict[str, Positive] | None = key(
        "densities by layer of the drawing [kg/m3]", usual="all layers with `density`", allowed="layers = numbers > 0"
    )
    density: Positive | None = key("density of this region [kg/m3]", usual="2400")

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
    depth: Positive | None = key("depth out of the plane [unit of the file]", usual="1 m")
    feet: Pair | None = key(
        "positions of the left and right foot [unit of the file]", usual="ends of the base",
        allowed="2 increasing numbers within the base",
    )  # fmt: skip
    ground: float = key(
        "height of the ground [unit of the file]", 0.0, allowed="the height of the lowest corner of the section"
    )


class MassPointsTable(StrictTable):
    """Points, masses, feet and contact intervals."""

    points: Annotated[list[Pair], Field(min_length=1)] = key(
        "positions (x, y) of the points [unit of the file]", ..., allowed="1 or more points (x, y)"
    )
    masses: Annotated[list[Mass], Field(min_length=1)] = key(
        "masses of the points [kg]", ..., allowed="one number > 0 per point"
    )
    feet: Pair = key("positions of the left and right foot [unit of the file]", ..., allowed="2 increasing numbers")
    contact: list[Pair] | None = key(
        "contact intervals of the base with the ground [unit of the file]", usual="from foot to foot",
        allowed="intervals [left, right] with left < right",
    )  # fmt: skip


class FrameTable(StrictTable):
    """Equal columns under a rigid beam. The other table of the body describes a column."""

    columns: Annotated[int, Field(ge=1, le=100_000)] = Field(description="number of columns")
    beam_mass: Annotated[float, Field(ge=0.0, le=1e36)] = Field(
        description="mass of the beam and of everything that moves with the beam [kg]"
    )
    beam_on: Literal["corner", "hinge"] = Field(
        "corner",
        description="support of the beam: the corner of each column opposite to its foot in contact, or a hinge at the "
        "middle of its top",
    )


class IsolatorTable(StrictTable):
    """A base on isolators below the body. Without stiffness, damping and friction, the base is on rollers."""

    base_mass: Positive = Field(description="mass of the base [kg]")
    period: Positive | None = key("period of body and base on the springs, without rocking [s]", usual="no springs")
    damping_ratio: Annotated[float, Field(ge=0.0, le=1.0)] | None = key(
        "damping ratio of body and base, with period [-]", usual="0"
    )
    stiffness: Cut | None = key("horizontal stiffness of the isolators, instead of period [N/m]", usual="0")
    damping: Cut | None = key("coefficient of the dashpot, instead of damping_ratio [N s/m]", usual="0")
    friction: Annotated[float, Field(ge=0.0, le=10.0)] | None = key(
        "coefficient of friction between base and ground [-]", usual="0"
    )


_OF_STIFFNESS = "stiffness in its place"


class RestraintTable(StrictTable):
    """A restraint between the ground and a point of the body."""

    kind: Literal["tendon", "viscous_damper", "friction_damper", "fuse", "spring", "wall"] = Field(
        description="kind of the restraint"
    )
    name: str | None = key("name in results", usual="kind and number", allowed="any text: a label of results")
    x: float | None = key(
        "position on the base, x as for the feet [unit of the file]",
        usual="x, or ground and point, is required; wall: the end of the body on its side",
        allowed="any: also outside the base",
    )  # fmt: skip
    length: Cut | None = key("distance of the anchor below the base at x [unit of the file]", usual="0")
    ground: Pair | None = key(
        "fixed point (x, z) on the ground; replaces x [unit of the file]", usual="x, or ground and point, is required"
    )
    point: Pair | None = key(
        "attachment point (x, z) on the upright body [unit of the file]", usual="x, or ground and point, is required"
    )
    stiffness: Cut | None = key(
        "tendon, fuse, spring, wall: stiffness [N/m]",
        usual="required; of a tendon or area, modulus and free_length; not for a rigid wall",
    )
    area: Positive | None = key("tendon: cross section [m2]", usual=_OF_STIFFNESS)
    modulus: Positive | None = key("tendon: modulus of elasticity [Pa]", usual=_OF_STIFFNESS)
    free_length: Positive | None = key("tendon: length between the anchors [unit of the file]", usual=_OF_STIFFNESS)
    prestress: Cut | None = key("tendon: tensile force while the body is upright [N]", usual="0")
    loss: Fraction | None = key("tendon: fraction of the prestress lost before the motion [-]", usual="0")
    yield_force: Positive | None = key("tendon, fuse: largest elastic force [N]", usual="elastic without limit")
    hardening: Hardening | None = key("tendon, fuse: stiffness after yielding / stiffness [-]", usual="0")
    rupture_elongation: Positive | None = key(
        "tendon: elongation from the prestressed state at rupture [unit of the file]", usual="no rupture"
    )
    stroke: Positive | None = key("fuse: elongation at fracture [unit of the file]", usual="no fracture")
    tension_only: bool | None = key("fuse: true for a bar that buckles without force", usual="false")
    coefficient: Cut | None = key("viscous_damper: coefficient c [N (s/m)^a]", usual="required of a viscous_damper")
    exponent: Exponent | None = key("viscous_damper: exponent a [-]", usual="1")
    slip_force: Cut | None = key("friction_damper: slip force [N]", usual="required of a friction_damper")
    gap: Cut | None = key("spring, wall: displacement without force [unit of the file]", usual="0")
    action: Literal["both", "tension", "compression"] | None = key("spring: direction of the force", usual="both")
    side: Literal["left", "right"] | None = key("wall: side of the body at the wall", usual="required of a wall")
    height: Positive | None = key(
        "wall: height of the point of the body that touches the wall [unit of the file]", usual="top of the body"
    )
    damping: Cut | None = key("wall: coefficient of the dashpot [N s/m]", usual="0")
    law: Literal["compliant", "plastic", "sorrentino"] | None = key("wall: force law", usual="compliant")


LENGTHS_OF_RESTRAINTS = (
    "x", "length", "ground", "point", "free_length", "rupture_elongation", "stroke", "gap", "height",
)  # fmt: skip
"""Keys of `RestraintTable` in the unit of the file."""


_body = partial(key, usual="one table of the body is required")


class BodyFile(StrictTable):
    """A body file: a unit, and one table of the body."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = key("name of the body", allowed="any text: a label of results")
    note: str | None = key("free text", allowed="any text: not used in computations")
    block: BlockTable | None = _body("rectangular block")
    trapezoid: TrapezoidTable | None = _body("trapezoid")
    ellipse: EllipseTable | None = _body("ellipse")
    regular_polygon: RegularPolygonTable | None = _body("regular polygon")
    section: SectionTable | None = _body("section of one or more polygons")
    mass_points: MassPointsTable | None = _body("body of mass points")
    frame: FrameTable | None = key("beam and number of columns; the other table of the body describes a column")
    isolator: IsolatorTable | None = key("base on isolators below the body")
    restraint: list[RestraintTable] | None = key("restraints, one table per restraint")
    floor_slope: float | None = key(
        "slope of the floor, positive if the floor rises to the right [rad]", usual="0",
        allowed="any slope with a stable upright body",
    )  # fmt: skip

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


NotBelowZero = Annotated[float, Field(ge=0.0)]
_OF_JOINTS = "one number, or one number per joint, lowest joint first"


class StackTable(StrictTable):
    """2D bodies on each other, lowest first, and the joints below them."""

    body: Annotated[list[dict[str, Any]], Field(min_length=1, max_length=100)] = key(
        "bodies, one table [[stack.body]] per body with one table of the body, as in a body file", ...,
        allowed="1 to 100 tables with block, trapezoid, regular_polygon or section; mass_points at the top",
    )  # fmt: skip
    friction: NotBelowZero | list[NotBelowZero] | None = key(
        "coefficient of friction of the joints [-]", usual="no sliding", allowed=_OF_JOINTS
    )
    restitution: Fraction | list[Fraction] = key(
        "coefficient of normal restitution of the joints [-]", 0.0, allowed=f"{_OF_JOINTS}, below 1"
    )
    offsets: float | list[float] = key(
        "distance of the middle of the feet from the middle of the top edge below [unit of the file]", 0.0,
        allowed="one number, or one number per body above the lowest body",
    )  # fmt: skip


class StackDocument(StrictTable):
    """A file of bodies on each other: a unit and the table [stack]."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = key("name of the stack", allowed="any text: a label of results")
    note: str | None = key("free text", allowed="any text: not used in computations")
    stack: StackTable = Field(description="bodies and joints")


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

    outline: Ring = key("corners of the plan [unit of the file]", ..., allowed="3 or more points (x, y)")
    height: Positive = Field(description="height [unit of the file]")
    holes: list[Ring] | None = key(
        "outlines of holes [unit of the file]", allowed="outlines of 3 or more points (x, y) inside the plan"
    )


class RevolutionTable(StrictTable):
    """A profile of points (radius, height) rotated about the z axis."""

    profile: Annotated[list[Pair], Field(min_length=2)] = key(
        "points (radius, height), from bottom to top [unit of the file]", ...,
        allowed="2 or more points, radii >= 0, the last above the first",
    )  # fmt: skip


class MeshTable(StrictTable):
    """A surface mesh from a file."""

    file: str = key("STL, OBJ, PLY, GLB or XYZ file, relative to the body file", ..., allowed=_IN_FOLDER)
    units: UnitName | None = key("unit of the mesh, if different from the body file", usual="unit of the file")
    up: Literal["z", "y"] | Triple = key("axis or direction of the mesh that points upwards", "z")
    weld_tolerance: Positive | None = key(
        "largest distance of corners that are merged [unit of the file]",
        usual="equal corners only; 1e-6 x size in an open surface",
    )  # fmt: skip
    repair: Literal["none", "safe", "all"] = Field("safe", description="allowed repairs, which are reported")
    surface: Literal["faces", "wrap", "hull"] = Field(
        "faces", description="surface of the body: faces of the mesh, skin around its points, or convex hull"
    )
    wall: Positive | None = key("wall thickness of a hollow body [unit of the file]", usual="a solid body")
    inner_parts: Literal["refuse", "solid", "cavity"] = Field(
        "refuse",
        description="treatment of closed parts inside another part, if the faces of both have the same orientation",
    )


class TurnTable(StrictTable):
    """A rotation about an axis through the origin, counter-clockwise against the axis direction."""

    axis: Triple = key("direction of the rotation axis", ..., allowed="3 numbers, not all zero")
    degrees: float = key("rotation angle [degrees]", ..., allowed="any: full turns are allowed")


_shape = partial(key, usual="one shape is required")


class PartTable(StrictTable):
    """A part: exactly one shape of one material, with rotations and a translation."""

    box: BoxTable | None = _shape("box")
    cylinder: UprightTable | None = _shape("cylinder")
    cone: UprightTable | None = _shape("cone")
    frustum: FrustumTable | None = _shape("frustum of a cone")
    sphere: SphereTable | None = _shape("sphere, optionally with horizontal cuts")
    ellipsoid: EllipsoidTable | None = _shape("ellipsoid, optionally with horizontal cuts")
    extrusion: ExtrusionTable | None = _shape("vertical extrusion of a plan outline")
    revolution: RevolutionTable | None = _shape("body of revolution about the z axis")
    mesh: MeshTable | None = _shape("surface mesh from a file")
    density: Positive | None = key("density of this part [kg/m3]", usual="2400")
    turned: list[TurnTable] | None = key("rotations of the part, in this order", usual="no rotation")
    at: Triple | None = key(
        "position of the part origin after the rotations [unit of the file]", usual="no translation",
        allowed="3 numbers, each at most 1e8 x the size of the part",
    )  # fmt: skip

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
    base: Annotated[list[Pair], Field(min_length=3)] | None = key(
        "points (x, y) of the base [unit of the file]", usual="all corners on the ground",
        allowed="3 or more points (x, y)",
    )  # fmt: skip
    ground: float | None = key(
        "height of the ground [unit of the file]", usual="height of the lowest point",
        allowed="the height of the lowest point of the body",
    )  # fmt: skip
    base_tolerance: Positive | None = key(
        "largest height of base corners above the ground [unit of the file]", usual="1e-9 x size of the body"
    )
    mass: Mass | None = key("known mass, in place of densities [kg]", usual="density x volume")
    centre: Triple | None = key(
        "known centre of mass (x, y, z) [unit of the file]", usual="computed from shapes and densities",
        allowed="3 numbers, a point inside the body",
    )  # fmt: skip
    inertia: Annotated[list[float | Triple], Field(min_length=3, max_length=3)] | None = key(
        "known inertia about the centre of mass: three rows, or the moments about x, y, z [kg m2]",
        usual="computed from shapes and densities",
        allowed="3 numbers, or 3 rows of 3 numbers, possible for a rigid body",
    )  # fmt: skip


class SolidDocument(StrictTable):
    """A file of a 3D body: a unit and the table [solid]."""

    units: UnitName = Field(description="unit of all lengths")
    name: str | None = key("name of the body", allowed="any text: a label of results")
    note: str | None = key("free text", allowed="any text: not used in computations")
    solid: SolidTable = Field(description="parts, base and ground of the body")
