"""What may stand in the document of one response. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Any

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from rocking.conventions import DEFAULT_FRICTION
from rocking.studies.job.restitution_tables import RestitutionTable
from rocking.studies.job.table import JobTable, Positive, Seed, Words, refused
from rocking.studies.job.tables import SettingsTable

SOURCES = ("pulse", "record", "synthetic")
"""Keys of a motion, of which one is needed."""

_OWN = {
    "pulse": {"scale"},
    "record": {"format", "units", "time_step", "component", "vertical", "scale"},
    "synthetic": {"seed", "member", "pga", "pgv", "time_step", "scale"},
}


class ResponseTable(JobTable):
    """How the body starts, and on what it stands."""

    free: Annotated[float | None, Field(description="first rotation over the slenderness angle [-]")] = None
    friction: float = Field(
        gt=0.0, default_factory=lambda: DEFAULT_FRICTION, description="between body and ground; 0.5 is assumed [-]"
    )


class OneMotionTable(JobTable):
    """One pulse, one record, or one motion of a synthetic family."""

    pulse: Words | None = None
    record: Words | None = None
    synthetic: Words | None = None
    format: Words | None = None
    units: Words | None = None
    time_step: Positive | None = None
    component: Words | None = None
    vertical: Words | None = None
    scale: float = 1.0
    seed: Seed | None = None
    member: Annotated[int, Field(ge=0, lt=10_000_000)] | None = None
    pga: Positive | None = None
    pgv: Positive | None = None

    @model_validator(mode="after")
    def _one_source(self) -> "OneMotionTable":
        source = self.chosen(*SOURCES)
        given = self.model_fields_set - {name for name in self.model_fields_set if getattr(self, name) is None}
        odd = sorted(given & set().union(*_OWN.values()) - _OWN[source])
        if odd:
            raise refused(f"{source} takes no {', '.join(odd)}; allowed beside it: {', '.join(sorted(_OWN[source]))}")
        if self.scale == 0.0:
            raise refused("scale must not be 0: nothing would move")
        if self.pga is not None and self.pgv is not None:
            raise refused("motions can be scaled to pga or to pgv, not to both")
        return self


class ResponseTables(JobTable):
    """What every document of a response has, wherever its body and motion come from."""

    restitution: RestitutionTable = RestitutionTable(model="ked")
    response: ResponseTable = ResponseTable()
    settings: SettingsTable = SettingsTable()

    @model_validator(mode="after")
    def _coefficient_of_one_history(self) -> "ResponseTables":
        drawn = self.restitution.distribution
        if drawn is not None and drawn.each == "history":
            raise refused('restitution.distribution.each must be "impact" for one history, got "history"')
        return self


def check_start(moved: bool, free: float | None) -> None:
    """Refuse a document that has neither or both of a motion and a first rotation.

    free: first rotation over the slenderness angle [-].
    """
    words = ""
    if moved and free is not None:
        words = "give a motion or response.free, not both"
    if not moved and free is None:
        words = "what moves the body? Give a motion, or response.free (such as 0.5) for free rocking"
    if words:
        raise PydanticCustomError("contradiction", "{words}", {"words": words})


class Document(ResponseTables):
    """A file that describes one response."""

    response: ResponseTable
    body: dict[str, Any]
    motion: OneMotionTable | None = None

    @model_validator(mode="after")
    def _moves(self) -> "Document":
        check_start(self.motion is not None, self.response.free)
        return self
