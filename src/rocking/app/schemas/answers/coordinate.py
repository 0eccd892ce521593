"""What the results of all studies share."""

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer

Number = float | None
"""Null where there is no finite number."""


class Coordinate(Answer):
    """A dimension of a study."""

    name: str
    values: list[float | int | str | None] = Field(description="in `unit`; null where a value is not finite")
    unit: str
    words: str


class Result(Answer):
    """What every result tells."""

    id: str
    name: str
    restitutions: list[str]
    contact: str = Field("", description="in how many histories the ground would have to pull; empty if in none")
