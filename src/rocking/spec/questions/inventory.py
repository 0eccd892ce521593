"""Inventories."""

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Text, key


class ThresholdsTable(JobTable):
    """Where one light ends and the next begins; what is left out is as in every report."""

    rocking: float | None = key("rotation over the slenderness angle that most motions may reach where it is green [-]")
    overturning_green: float | None = key("share of motions that may overturn it where it is green [-]")
    overturning_red: float | None = key("share of motions from which on it is red [-]")
    level: float | None = key("confidence of the shares' intervals [-]")
    low_consequence: float | None = key("what the shares are multiplied by where a fall is of low consequence [-]")
    high_consequence: float | None = key("the same where a fall is of high consequence; a fall weighs the inverse [-]")


class InventoryTable(JobTable):
    """A list of objects, and how strong the shaking is: a number with its unit, such as 0.3g."""

    objects: Text = key("list as .xlsx, .ods or CSV: name, width, depth, height and more, each with its unit", ...)
    encoding: Text | None = key("encoding of a CSV file, such as cp1252; told from the file if left out")
    columns: Text | dict[str, str] | None = key(
        'what columns are, by their titles: "Objekt=name, Maß B=width_cm, Rahmenbreite="; nothing leaves one out; '
        "a title with a comma in quotation marks: '\"Höhe, gesamt\"=height_cm'"
    )
    pga: Text | None = key("peak ground acceleration of every motion: 0.3g, 2.9m/s2")
    pgv: Text | None = key("peak ground velocity in its place: 25cm/s, 0.25m/s")
    language: Text | None = key("language of the report: en, de, it; that of the list's header if not given")
    thresholds: ThresholdsTable = Field(
        default_factory=ThresholdsTable, description="where one light ends and the next begins"
    )

    @model_validator(mode="after")
    def _one_level(self) -> "InventoryTable":
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("give pga or pgv, not both: motions are scaled to one of them")
        return self
