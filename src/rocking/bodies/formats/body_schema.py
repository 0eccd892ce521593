"""What may stand in a TOML body file. Imported only when one is read: it loads pydantic."""

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
        found = [f"[{key}]" for key in BODIES if getattr(self, key) is not None]
        if len(found) != 1:
            choice = ", ".join(f"[{key}]" for key in BODIES)
            raise _refused(
                "contradiction", f"a body file has exactly one of {choice}, got {' and '.join(found) or 'none'}"
            )
        return self


BODIES = ("block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points")
"""Tables that say what the body is."""


def _refused(kind: Literal["unknown_key", "contradiction"], words: str) -> PydanticCustomError:
    return PydanticCustomError(kind, "{words}", {"words": words})
