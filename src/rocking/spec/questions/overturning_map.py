"""Overturning maps."""

from typing import Literal

from pydantic import model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Text, Values, key


class AxisTable(Values):
    """An axis of a map."""

    axis: Text = key("what changes along it: frequency_ratio, pga, semi_diagonal and more", ...)


class MapTable(JobTable):
    """The two axes of a map, and how closely to follow the boundaries in it."""

    x: AxisTable = key("axis, and its values in SI", ...)
    y: AxisTable = key("the upright axis", ...)
    refine: int | None = key("levels of refinement along boundaries, each of half the spacing", None, ge=0, le=12)
    boundary: Literal["verdict", "mode"] = key("which boundaries: of overturning, or of all modes", "verdict")
    tolerance: float = key("how closely boundaries are bisected [-]", 1e-10, ge=1e-15, le=0.1)

    @model_validator(mode="after")
    def _refined(self) -> "MapTable":
        odd = sorted({"boundary", "tolerance"} & self.model_fields_set)
        if odd and self.refine is None:
            raise InvalidValueError(
                f"{' and '.join(odd)} goes with refine, how often cells along boundaries are halved: give it"
            )
        return self
