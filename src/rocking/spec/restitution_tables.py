"""Tables of the coefficient of restitution."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Seed, Text, key


class RandomTable(JobTable):
    """A coefficient that is drawn: from a normal distribution, from values, or from what the measurements say."""

    mean: float | None = key("mean of a normal distribution [-]", None, ge=0.0, le=1.0)
    deviation: float | None = key("its standard deviation [-]", None, gt=0.0, le=1.0)
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=1.0)]], Field(min_length=2)] | None = key("a sample [-]")
    posterior: Literal[True] | None = key("what the published measurements say of the body")
    count: int | None = key("how many values are drawn from the posterior", None, ge=2, le=1_000_000)
    each: Literal["impact", "history"] = key("drawn anew for every impact, or once for a history", "impact")
    times: str | float = key("a model or a factor that the values multiply", 1.0)
    seed: Seed | None = key("seed of the draws; that of the campaign if not given")

    @model_validator(mode="after")
    def _one_distribution(self) -> "RandomTable":
        ways = ("mean", "deviation", "values", "posterior")
        stated = [name for name in ways if getattr(self, name) is not None]
        if stated not in (["mean", "deviation"], ["values"], ["posterior"]):
            names = " and ".join(stated) or "none"
            raise InvalidValueError(
                "give mean and deviation, or values alone, or posterior alone; got {keys}", keys=names
            )
        if self.posterior is None and self.count is not None:
            raise InvalidValueError("count goes with posterior: how many values are drawn from it")
        if self.posterior and "times" in self.model_fields_set:
            raise InvalidValueError("times does not go with posterior, which is of the coefficient itself")
        return self


class RestitutionTable(JobTable):
    """What an impact costs."""

    model: Text | None = key("a model as in rocking models, or my_file.py:MyModel")
    models: Annotated[list[Text], Field(min_length=1)] | None = key("several, to compare; the first is the answer")
    value: float | None = key("a coefficient, velocity after over before [-]", None, ge=0.0, le=10.0)
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=10.0)]], Field(min_length=1)] | None = key(
        "several coefficients [-]"
    )
    left: float | None = key("coefficient of impacts onto the left foot [-]", None, ge=0.0, le=10.0)
    right: float | None = key("coefficient of impacts onto the right foot [-]", None, ge=0.0, le=10.0)
    distribution: RandomTable | None = key("a coefficient that is drawn: mean and deviation, values, or posterior")

    @model_validator(mode="after")
    def _one_choice(self) -> "RestitutionTable":
        if (self.left is None) != (self.right is None):
            raise InvalidValueError("left and right go together: one coefficient for each foot")
        choices = {"model": "model", "value": "value", "distribution": "distribution", "left": "left"}
        if self.models is None and self.values is None:
            self.chosen(*choices)
        elif any(getattr(self, name) is not None for name in choices):
            raise InvalidValueError("models and values stand alone, without model, value, distribution, left and right")
        return self
