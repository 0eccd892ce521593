"""What is said of an impact."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer
from rocking.app.schemas.answers.body import DrawnBody, Foot, Point


class Shares(Answer):
    """Kinetic energy that each stage of KED leaves, over the energy before the impact."""

    before: float = Field(description="1 [-]")
    stage_1: float = Field(alias="stage 1", description="after the vertical part is lost [-]")
    stage_2: float = Field(alias="stage 2", description="after the part along O'S is lost [-]")
    after: float = Field(description="after the impact [-]")


class CoefficientFacts(Answer):
    """One model's answer for one body."""

    model: str = Field(description="name of the model with its parameters, or calibrated")
    coefficient_of_restitution: float = Field(description="theta_dot_after / theta_dot_before, of velocities [-]")
    low_95: float = Field(description="lower end of the 95 % interval for a single measured body [-]")
    high_95: float = Field(description="upper end of the 95 % interval for a single measured body [-]")
    impulse_ratio_k: float = Field(description="distance of the impulse over the lever of the new foot [-]")
    impulse_x_m: float = Field(description="where the impulse acts on the ground [m]")
    energy_loss: float = Field(description="share of the kinetic energy that the impact costs [-]")
    friction_demand: float = Field(description="friction coefficient below which the foot slips at the impact [-]")
    admissible: bool = Field(description="whether one impulse on the base can do it without creating energy")
    warnings: list[str] = Field(description="sentences; none if all is well")


class Stage(Answer):
    """One stage of the impact."""

    name: Literal["before", "stage 1", "stage 2", "after"]
    words: str
    energy_joule: float = Field(alias="energy_J", description="kinetic energy that it leaves [J]")
    share: float = Field(description="the same over the energy before the impact [-]")
    velocity_m_s: list[Point] = Field(description="velocity x and y at each of the points [m/s]")


class Stages(Answer):
    """The three stages of KED for an impact at 1 rad/s."""

    velocity_before_rad_s: float = Field(description="angular velocity [rad/s]")
    velocity_after_rad_s: float = Field(description="angular velocity [rad/s]")
    points_m: list[Point] = Field(description="where the velocities are given, x and y [m]")
    stages: list[Stage]


class MeasuredPoint(Answer):
    """One published measurement."""

    group: str
    label: str
    slenderness_ratio: float = Field(description="h/b [-]")
    slenderness_angle_rad: float = Field(description="[rad]")
    coefficient: float = Field(description="of restitution [-]")
    low: float = Field(description="least value that the printed digits leave open [-]")
    high: float = Field(description="largest value that the printed digits leave open [-]")


class Measured(Answer):
    """The published measurements."""

    source: str
    points: list[MeasuredPoint]


class ModelCurve(Answer):
    """The coefficient of homogeneous rectangles under one model."""

    model: str
    slenderness_ratio: list[float] = Field(description="h/b [-]")
    coefficient: list[float] = Field(description="of restitution [-]")


class ImpactWarning(Answer):
    """A sentence, and the models that it is about."""

    words: str
    models: list[str]


ByFoot = dict[Foot, list[CoefficientFacts]]


class ImpactAnswered(Answer):
    """What an impact costs, by the foot on which the body lands; of two equal feet only the right one is told."""

    body: DrawnBody
    ked_energy_shares: dict[Foot, Shares]
    coefficients: ByFoot = Field(description="every model, the calibrated default first")
    identities: dict[str, dict[str, bool]] = Field(description="empty here; `rocking cor --identities --json` fills it")
    titles: dict[str, str] = Field(description="name of a model to its title")
    measured: Measured
    curves: list[ModelCurve]
    stages: dict[Foot, Stages]
    warnings: list[ImpactWarning]
