"""What may stand in a job file about the restitution. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rocking.studies.job.table import JobTable, Seed, Words, refused


class RandomTable(JobTable):
    """A coefficient that is drawn: from a normal distribution, from values, or from what the measurements say."""

    mean: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    deviation: Annotated[float, Field(gt=0.0, le=1.0)] | None = None
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=1.0)]], Field(min_length=2)] | None = None
    posterior: Literal[True] | None = None
    count: Annotated[int, Field(ge=2, le=1_000_000)] | None = None
    each: Literal["impact", "history"] = "impact"
    times: str | float = 1.0
    seed: Seed | None = None

    @model_validator(mode="after")
    def _one_distribution(self) -> "RandomTable":
        names = ("mean", "deviation", "values", "posterior")
        given = [name for name in names if getattr(self, name) is not None]
        if given not in (["mean", "deviation"], ["values"], ["posterior"]):
            told = " and ".join(given) or "none"
            raise refused(f"give mean and deviation, or values alone, or posterior alone; got {told}")
        if self.posterior is None and self.count is not None:
            raise refused("count goes with posterior: how many values are drawn from it")
        if self.posterior and "times" in self.model_fields_set:
            raise refused("times does not go with posterior, which is of the coefficient itself")
        return self


class RestitutionTable(JobTable):
    """What an impact costs."""

    model: Words | None = None
    models: Annotated[list[Words], Field(min_length=1)] | None = None
    value: Annotated[float, Field(ge=0.0, le=10.0)] | None = None
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=10.0)]], Field(min_length=1)] | None = None
    left: Annotated[float, Field(ge=0.0, le=10.0)] | None = None
    right: Annotated[float, Field(ge=0.0, le=10.0)] | None = None
    distribution: RandomTable | None = None

    @model_validator(mode="after")
    def _one_choice(self) -> "RestitutionTable":
        if (self.left is None) != (self.right is None):
            raise refused("left and right go together: one coefficient for each foot")
        choices = {"model": "model", "value": "value", "distribution": "distribution", "left": "left"}
        if self.models is None and self.values is None:
            self.chosen(*choices)
        elif any(getattr(self, name) is not None for name in choices):
            raise refused("models and values stand alone, without model, value, distribution, left and right")
        return self
