"""Tables of the coefficient of restitution."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Seed, Text, key

_OF_MODEL = "computed by model"
_ONE = "one of mean with deviation, values, posterior is required"


class RandomTable(JobTable):
    """A sampled coefficient of restitution: normal distribution, list of values, or posterior of the measurements."""

    mean: float | None = key("mean of a normal distribution [-]", None, usual=_ONE, ge=0.0, le=1.0)
    deviation: float | None = key(
        "standard deviation of the normal distribution [-]", None, usual="required with mean", gt=0.0, le=1.0
    )
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=1.0)]], Field(min_length=2)] | None = key(
        "sample of values, each with equal probability [-]", usual=_ONE
    )
    posterior: Literal[True] | None = key(
        "posterior distribution for this body from the published measurements", usual=_ONE
    )
    count: int | None = key(
        "number of values sampled from the posterior", None, usual="all quantiles", ge=2, le=1_000_000
    )
    each: Literal["impact", "history"] = key("new sample for every impact, or for every history", "impact")
    times: str | float = key(
        "model or number that is multiplied by the sampled values", 1.0, allowed="a name from `rocking models`, or > 0"
    )
    seed: Seed | None = key("random seed", usual="seed of the campaign")

    @model_validator(mode="after")
    def _one_distribution(self) -> "RandomTable":
        ways = ("mean", "deviation", "values", "posterior")
        stated = [name for name in ways if getattr(self, name) is not None]
        if stated not in (["mean", "deviation"], ["values"], ["posterior"]):
            names = " and ".join(stated) or "none"
            raise InvalidValueError("Use mean and deviation, or values, or posterior. Got {keys}.", keys=names)
        if self.posterior is None and self.count is not None:
            raise InvalidValueError("count is allowed with posterior only.")
        if self.posterior and "times" in self.model_fields_set:
            raise InvalidValueError("Use times or posterior, not both.")
        return self


class RestitutionTable(JobTable):
    """Coefficient of restitution: models, values, or a distribution."""

    model: Text | None = key(
        "restitution model: a name from rocking models, or my_file.py:MyModel", usual="calibrated",
        allowed="a name from `rocking models`, a number, or FILE.py:CLASS",
    )  # fmt: skip
    models: Annotated[list[Text], Field(min_length=1)] | None = key(
        "restitution models to compare, the first gives the main result", usual="model alone",
        allowed="1 or more entries as for model",
    )  # fmt: skip
    value: float | None = key(
        "coefficient of restitution: velocity after impact / velocity before [-]",
        None,
        usual=_OF_MODEL,
        ge=0.0,
        le=10.0,
    )
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=10.0)]], Field(min_length=1)] | None = key(
        "coefficients of restitution to compare [-]", usual="none besides models"
    )
    left: float | None = key(
        "coefficient of restitution for impacts on the left foot [-]", None, usual=_OF_MODEL, ge=0.0, le=10.0
    )
    right: float | None = key(
        "coefficient of restitution for impacts on the right foot [-]", None, usual=_OF_MODEL, ge=0.0, le=10.0
    )
    distribution: RandomTable | None = key(
        "sampled coefficient of restitution: mean and deviation, values, or posterior", usual="not sampled"
    )

    @model_validator(mode="after")
    def _one_choice(self) -> "RestitutionTable":
        if (self.left is None) != (self.right is None):
            raise InvalidValueError("Use left and right together, one coefficient for each foot.")
        choices = {"model": "model", "value": "value", "distribution": "distribution", "left": "left"}
        if self.models is None and self.values is None:
            self.chosen(*choices)
        elif any(getattr(self, name) is not None for name in choices):
            raise InvalidValueError(
                "models and values are not allowed together with model, value, distribution, left or right."
            )
        return self
