"""What may stand in a TOML body file, checked by pydantic."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False, strict=True)]
Point = tuple[Number, Number]
Ring = Annotated[list[Point], Field(min_length=3)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _Standing(_Table):
    density: Positive = 2400.0
    depth: Positive | None = None
    feet: Point | None = None


class BlockTable(_Table):
    """Table ``[block]``."""

    width: Positive
    height: Positive
    depth: Positive | None = None
    density: Positive = 2400.0


class TrapezoidTable(_Standing):
    """Table ``[trapezoid]``."""

    base: Positive
    top: Positive
    height: Positive
    lean: Number = 0.0


class EllipseTable(_Standing):
    """Table ``[ellipse]``."""

    width: Positive
    height: Positive
    sides: Annotated[int, Field(ge=3, le=100_000, strict=True)] = 64


class RegularPolygonTable(_Standing):
    """Table ``[regular_polygon]``."""

    sides: Annotated[int, Field(ge=3, le=100_000, strict=True)]
    radius: Positive


class RegionTable(_Table):
    """Table ``[[section.region]]``: an outline with holes, or a WKT text."""

    outline: Ring | None = None
    holes: list[Ring] = []
    wkt: str | None = None
    density: Positive = 2400.0


class SectionTable(_Table):
    """Table ``[section]``."""

    region: Annotated[list[RegionTable], Field(min_length=1)]
    feet: Point | None = None
    depth: Positive | None = None
    ground: Number = 0.0


class MassPointsTable(_Table):
    """Table ``[mass_points]``."""

    points: Annotated[list[Point], Field(min_length=1)]
    masses: Annotated[list[Positive], Field(min_length=1)]
    feet: Point


class BodyFile(_Table):
    """A whole body file: a unit and one table."""

    units: Literal["m", "cm", "mm", "ft", "in"]
    name: str = ""
    note: str = ""
    block: BlockTable | None = None
    trapezoid: TrapezoidTable | None = None
    ellipse: EllipseTable | None = None
    regular_polygon: RegularPolygonTable | None = None
    section: SectionTable | None = None
    mass_points: MassPointsTable | None = None

    @property
    def tables(self) -> dict[str, Any]:
        """The tables that are there."""
        names = ("block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}
