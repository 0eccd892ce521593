"""What is said of responses."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers import Answer, DrawnBody, Foot


class RockingSideAnswer(Answer):
    """One side of the body as its equation of motion has it."""

    slenderness_angle_rad: float = Field(description="alpha [rad]")
    frequency_parameter_rad_s: float = Field(description="p [rad/s]")
    semi_diagonal_m: float = Field(description="R [m]")
    coefficient: float = Field(description="of restitution where it lands on this foot [-]")


class RockingSides(Answer):
    """One entry for each foot."""

    left: RockingSideAnswer
    right: RockingSideAnswer


class RockingBody(Answer):
    """The body as its equations of motion have it."""

    kind: str = Field(description="class of the body in Python")
    mass_kg: float = Field(description="[kg]")
    assumed: list[str] = Field(description="what nobody gave and was assumed, in sentences")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")
    sides: RockingSides


class MovedFacts(Answer):
    """What moved the ground."""

    kind: Literal["record", "pulse"]
    name: str
    scale: float = Field(description="factor on the motion [-]")
    duration_s: float = Field(description="[s]")
    peak_acceleration_m_s2: float = Field(description="scaled [m/s2]")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")


class StillRocking(Answer):
    """The last state of a body that does not yet rest when the computation ends."""

    time_s: float = Field(description="[s]")
    rotation_rad: float = Field(description="theta [rad]")
    angular_velocity_rad_s: float = Field(description="[rad/s]")
    sentence: str = Field(description="the same in words")


class ImpactFacts(Answer):
    """One impact."""

    time_s: float = Field(description="[s]")
    velocity_before_rad_s: float = Field(description="[rad/s]")
    velocity_after_rad_s: float = Field(description="[rad/s]")
    coefficient: float = Field(description="of restitution [-]")
    onto: str = Field(description="foot on which the body lands")


class FrictionFacts(Answer):
    """Friction that rocking without slip takes."""

    given: float = Field(description="coefficient of friction that was given, or assumed [-]")
    assumed: bool = Field(description="whether nobody gave it")
    of_motion: float | None = Field(description="demand while it rocks; null if no friction suffices [-]")
    of_impacts: float | None = Field(description="demand at impacts; null if no friction suffices [-]")


class ResponseSeries(Answer):
    """The curves of a response: one entry of each for every time; every dot of a picture has its extremes."""

    time: list[float] = Field(description="[s]")
    rotation: list[float] = Field(description="theta [rad]")
    velocity: list[float] = Field(description="angular velocity [rad/s]")
    kinetic: list[float] = Field(description="kinetic energy [J]")
    potential: list[float] = Field(description="potential energy over that at rest [J]")
    work: list[float] = Field(description="work of the ground so far [J]")
    lost: list[float] = Field(description="energy that impacts have cost so far [J]")
    friction_demand: list[float | None] = Field(description="null where no friction suffices [-]")
    vertical_force: list[float] = Field(description="of the ground on the body [N]")
    ground_acceleration: list[float] = Field(description="[m/s2]")
    ground_displacement: list[float] = Field(description="[m]")
    shown: int = Field(description="samples here")
    of: int = Field(description="states of the response: samples, events, and where it turns round")


class FallAnswer(Answer):
    """How a fall goes on after the curves end, by the same equation of motion, until a corner meets the ground."""

    time: list[float] = Field(description="[s]")
    rotation: list[float] = Field(description="theta [rad]")
    lying: tuple[float, float] = Field(description="theta where it lies on its left and on its right side [rad]")


class ResponseFacts(Answer):
    """The response under one restitution: the keys of `rocking simulate --json`, with label and curves."""

    label: str = Field(description="the restitution")
    body: RockingBody
    motion: MovedFacts | None = Field(description="null for free rocking")
    initial_rotation_rad: float = Field(description="[rad]")
    restitution: str
    engine: str = Field(description="which one ran")
    gravity_m_s2: float = Field(description="[m/s2]")
    linear: bool = Field(description="whether the equations were linearised")
    outcome: Literal["no_uplift", "rocked", "overturned"]
    summary: str = Field(description="the outcome in a sentence")
    overturned_to: Foot | None
    overturning_time_s: float | None = Field(description="null if it stands [s]")
    peak_rotation_rad: float = Field(description="a quarter turn if it overturned [rad]")
    peak_rotation_over_alpha: float = Field(description="over the slenderness angle of that side [-]")
    still_rocking: StillRocking | None = Field(description="null where it rests or has overturned at the end")
    lost_contact: bool = Field(description="whether the ground would have to pull, so that the verdict assumes contact")
    uplifts_s: list[float] = Field(description="times at which it leaves the ground [s]")
    impacts: list[ImpactFacts]
    energy_closure: float = Field(description="energy that does not add up, over the largest energy [-]")
    error_estimate_rad: float | None = Field(description="of the peak; null if another step changes the outcome [rad]")
    friction: FrictionFacts
    least_vertical_force: float = Field(alias="least_vertical_force_N", description="of the ground on the body [N]")
    warnings: list[str] = Field(description="sentences; none if pure rocking is credible")
    series: ResponseSeries
    fall: FallAnswer


class NoResponse(Answer):
    """Why one of the restitutions has no response."""

    label: str = Field(description="the restitution")
    error: str = Field(description="one sentence")


class VerdictFacts(Answer):
    """Whether the choice of the model decides."""

    decides: bool
    sentence: str


class ResponseAnswered(Answer):
    """How the body rocks, under every restitution that was chosen."""

    answers: list[ResponseFacts | NoResponse]
    verdict: VerdictFacts
    body: DrawnBody
    motion: MovedFacts | None = Field(description="null for free rocking")
