"""Fragility analyses: stripes, incremental and cloud."""

from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, ValidatorFunctionWrapHandler, WrapValidator
from pydantic_core import PydanticKnownError

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Numbers, Positive, Text, key


class ExportTable(JobTable):
    """How files are written, how often a study is repeated for intervals, and which measures are compared."""

    crossing: Literal["keep-uplift", "common-dispersion", "refuse"] = key(
        "treatment of curves that cross", "keep-uplift"
    )
    bootstrap: Annotated[int, Field(ge=99, le=100_000)] | Literal[0] = key("how often a study is repeated", 0)
    measures: Annotated[list[Text], Field(min_length=1)] | None = key("measures of intensity that are compared")
    columns: list[Text] | None = key("columns of the comparison")


def _one_state(value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
    """Return a limit state; what is none has one error, whatever the kinds of states are."""
    try:
        return validate(value)
    except ValidationError as error:
        if isinstance(value, str):
            raise InvalidValueError(
                f"must be a rotation over the slenderness angle, rocking or overturning, got {value!r:.60}"
            ) from error
        raise PydanticKnownError("greater_than", {"gt": 0}) from error


class FragilityTable(JobTable):
    """Measure, levels and limit states of a fragility analysis."""

    measure: Text = key("measure of intensity: pga, pgv, arias, sa(0.5) and more", "pga")
    levels: Numbers | None = key("levels of the measure [its unit]")
    states: list[Annotated[Positive | Literal["rocking", "overturning"], WrapValidator(_one_state)]] = key(
        "limit states: rotations over the slenderness angle [-], with rocking and overturning; where one of these two "
        "names is given, the given states alone",
        [0.5],
    )
    tolerance: float | None = key("width of the last brackets over the level [-]", None, ge=0.0, le=0.1)
    factor: Positive | None = key("factor on all motions of a cloud [-]")
