"""What is said of a body."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer
from rocking.app.schemas.body import BodyInput

Point = tuple[float, float]
"""x and y [m]."""

Foot = Literal["left", "right"]
"""Where a body stands or lands."""


class SideFacts(Answer):
    """What one side of a body decides: it stands on this foot and turns about it."""

    slenderness_ratio: float = Field(description="height of the centre over its lever, h/b [-]")
    slenderness_angle_rad: float = Field(description="alpha = atan(b/h) [rad]")
    semi_diagonal_m: float = Field(description="distance R of the centre from the foot [m]")
    frequency_parameter_rad_s: float = Field(description="p [rad/s]")
    uplift_acceleration_m_s2: float = Field(description="ground acceleration that lifts it, g tan(alpha) [m/s2]")


class Sides(Answer):
    """One entry for each foot."""

    left: SideFacts
    right: SideFacts


class Polygon(Answer):
    """A region of one density."""

    outline: list[Point] = Field(description="vertices x, y [m]")
    holes: list[list[Point]] = Field(description="vertices x, y of every hole [m]")
    density: float = Field(description="[kg/m3]")


class BodyFacts(Answer):
    """Mass, centre, feet, and what each side decides."""

    kind: str = Field(description="class of the body in Python")
    mass_kg: float = Field(description="mass [kg]")
    centre_m: Point = Field(description="centre of mass, x and y [m]")
    feet_m: Point = Field(description="x of the left and of the right foot [m]")
    moment_of_inertia_kg_m2: float = Field(description="about the centre of mass [kg m2]")
    gravity_m_s2: float = Field(description="acceleration of gravity [m/s2]")
    assumed: list[str] = Field(description="what nobody gave and was assumed, in sentences")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")
    sides: Sides


class DrawnBody(BodyFacts):
    """A body with the outline that draws it."""

    name: str | None = Field(description="what the user calls it")
    outline: list[Polygon] = Field(description="polygons; none for mass points and for ellipses")
    points: list[tuple[float, float, float]] = Field(description="mass points: x [m], y [m], mass [kg]")
    centre: Point = Field(description="centre of mass, x and y [m]")
    base: Point = Field(description="x of the left and of the right foot [m]")
    ground: float = Field(description="y of the ground [m]")
    contact: list[Point] = Field(description="stretches of the base that touch the ground, from x to x [m]")


class DescribedBody(DrawnBody):
    """A body, and what a user should know of it."""

    warnings: list[str] = Field(description="sentences; none if all is well")


class BodyInFile(DescribedBody):
    """What a body file holds."""

    body: BodyInput = Field(description="the body as it stands in the inputs")
