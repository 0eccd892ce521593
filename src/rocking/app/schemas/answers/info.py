"""What there is to choose from."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer


class EngineFacts(Answer):
    """Which engine computes histories."""

    name: str
    instruction_set: str | None


class ParameterFacts(Answer):
    """What a model or a pulse takes."""

    unit: str
    words: str
    default: float | Literal["unlimited"] | None = Field(
        description='in `unit`; "unlimited" where it is infinite, null where one must be given'
    )


class ModelFacts(Answer):
    """A restitution model."""

    name: str
    label: str
    title: str
    citation: str
    summary: str
    assumptions: list[str]
    domain: str
    known_defects: list[str]
    parameters: dict[str, ParameterFacts]


class PulseFacts(Answer):
    """A kind of pulse."""

    summary: str
    parameters: dict[str, ParameterFacts]


class FamilyFacts(Answer):
    """A family of synthetic motions."""

    name: str
    title: str
    summary: str
    generator: str
    time_step_s: float = Field(description="[s]")


class FormatFacts(Answer):
    """A format of record files."""

    name: str
    title: str
    suffixes: list[str]
    states_unit: bool
    states_time_step: bool
    notes: str


class UnitNames(Answer):
    """Units that may be said."""

    length: list[str]
    acceleration: list[str]


class Quantity(Answer):
    """An intensity measure, or an axis of a map."""

    name: str
    words: str
    unit: str


class KindOfStudy(Answer):
    """A kind of study, and the table that its job has of its own."""

    name: str
    table: str


class Info(Answer):
    """What there is to choose from."""

    version: str
    engine: EngineFacts
    gravity_m_s2: float = Field(description="where nothing else is said [m/s2]")
    models: list[ModelFacts]
    pulses: dict[str, PulseFacts]
    families: list[FamilyFacts]
    formats: list[FormatFacts]
    units: UnitNames
    measures: list[Quantity]
    axes: list[Quantity]
    study_kinds: list[KindOfStudy]
    limits: dict[str, float] = Field(
        description="how much one server takes; the names say what: bytes [B], seconds [s], counts"
    )
