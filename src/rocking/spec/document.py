"""What may stand in the file of a campaign or of a response. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from rocking.conventions import DEFAULT_FRICTION
from rocking.spec.fields import JobTable, Names, Numbers, Positive, Seed, Values, Words, in_list, refused
from rocking.studies.histories import LARGEST_CHUNK

Kind = Literal[
    "overturning-map", "minimum-acceleration", "rocking-spectrum", "stripes", "incremental", "cloud", "inventory",
    "histories",
]  # fmt: skip
NEEDS: dict[str, str] = {
    "overturning-map": "map",
    "minimum-acceleration": "minimum",
    "rocking-spectrum": "spectrum",
    "stripes": "fragility",
    "incremental": "fragility",
    "cloud": "fragility",
    "inventory": "inventory",
    "histories": "histories",
}
"""The table that a kind of campaign has of its own."""

_OWN_BODIES = {
    "rocking-spectrum": "a spectrum makes its own blocks",
    "inventory": "the objects stand in the file that [inventory] names",
}
_MANY_BODIES = {"histories", "minimum-acceleration", *_OWN_BODIES}
_ANALYSES = [kind for kind, table in NEEDS.items() if table == "fragility"]
SOURCES = ("pulse", "record", "synthetic")
"""Keys of a motion, of which one is needed."""

_OWN = {
    "pulse": {"scale"},
    "record": {"format", "units", "time_step", "component", "vertical", "scale"},
    "synthetic": {"seed", "member", "pga", "pgv", "time_step", "scale"},
}


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


class CampaignTable(JobTable):
    """What the campaign is called and what it computes."""

    name: Words
    kind: Kind
    note: str | None = None
    chunk: Annotated[int, Field(ge=1, le=LARGEST_CHUNK)] | None = None
    seed: Seed = 0


class MotionTable(JobTable):
    """Records, pulses, or a family of synthetic motions."""

    records: Names | None = None
    pulse: Names | None = None
    synthetic: Words | None = None
    format: Words | None = None
    units: Words | None = None
    time_step: Positive | None = None
    component: Words | None = None
    vertical: Words | None = None
    scale: float = 1.0
    count: Annotated[int, Field(ge=1, le=10_000_000)] | None = None
    seed: Seed | None = None
    pga: Positive | None = None
    pgv: Positive | None = None

    @model_validator(mode="after")
    def _one_source(self) -> "MotionTable":
        source = self.chosen("records", "pulse", "synthetic")
        own = {
            "records": {"format", "units", "time_step", "component", "vertical", "scale"},
            "pulse": {"scale"},
            "synthetic": {"count", "seed", "pga", "pgv", "time_step"},
        }[source]
        odd = sorted(self.model_fields_set - own - {source})
        if odd:
            raise refused(f"{source} takes no {', '.join(odd)}; allowed beside it: {', '.join(sorted(own))}")
        if source == "synthetic" and self.count is None:
            raise refused("count is missing: how many synthetic motions?")
        if self.scale == 0.0:
            raise refused("scale must not be 0: nothing would move")
        return self


class AxisTable(Values):
    """An axis of a map."""

    axis: Words


class MapTable(JobTable):
    """The two axes of a map, and how closely to follow the boundaries in it."""

    x: AxisTable
    y: AxisTable
    refine: Annotated[int, Field(ge=0, le=12)] | None = None
    boundary: Literal["verdict", "mode"] = "verdict"
    tolerance: Annotated[float, Field(ge=1e-15, le=0.1)] = 1e-10

    @model_validator(mode="after")
    def _refined(self) -> "MapTable":
        odd = sorted({"boundary", "tolerance"} & self.model_fields_set)
        if odd and self.refine is None:
            raise refused(f"{' and '.join(odd)} goes with refine, how often cells along boundaries are halved: give it")
        return self


class MinimumTable(JobTable):
    """Where and how closely to look for crossings: accelerations [m/s2]."""

    lowest: Positive | None = None
    highest: Positive | None = None
    points: Annotated[int, Field(ge=2, le=1_000_000)] = 400
    levels: Annotated[int, Field(ge=0, le=12)] = 4
    tolerance: Annotated[float, Field(ge=0.0, le=0.1)] = 1e-12


class ThresholdsTable(JobTable):
    """Where one light ends and the next begins; what is left out is as in every report."""

    rocking: float | None = None
    overturning_green: float | None = None
    overturning_red: float | None = None
    level: float | None = None


class InventoryTable(JobTable):
    """A list of objects, and how strong the shaking is: a number with its unit, such as 0.3g."""

    objects: Words
    encoding: Words = "utf-8-sig"
    pga: Words | None = None
    pgv: Words | None = None
    thresholds: ThresholdsTable = ThresholdsTable()

    @model_validator(mode="after")
    def _one_level(self) -> "InventoryTable":
        if self.pga is not None and self.pgv is not None:
            raise refused("give pga or pgv, not both: motions are scaled to one of them")
        return self


class ExportTable(JobTable):
    """How files are written, how often a study is repeated for intervals, and which measures are compared."""

    crossing: Literal["refuse", "common-dispersion"] = "refuse"
    bootstrap: Annotated[int, Field(ge=99, le=100_000)] | Literal[0] = 0
    measures: Annotated[list[Words], Field(min_length=1)] | None = None
    columns: list[Words] | None = None


class SpectrumTable(JobTable):
    """The blocks of rocking spectra: slenderness angles [rad] and periods 2 pi/p [s]."""

    slenderness_angles: Numbers
    periods: Numbers
    scale: float = 1.0


class HistoriesTable(JobTable):
    """Factors on the motions [-]."""

    scales: Numbers = Values(values=[1.0])


class FragilityTable(JobTable):
    """Measure, levels [its unit] and states of a fragility analysis."""

    measure: Words = "pga"
    levels: Numbers | None = None
    states: list[Positive] = Field(default=[0.5])
    tolerance: Annotated[float, Field(ge=0.0, le=0.1)] | None = None
    factor: Positive | None = None


class SettingsTable(JobTable):
    """How to integrate: what is left out has its usual value."""

    gravity: Positive | None = None
    linear: bool | None = None
    rest_speed: float | None = None
    most_events: int | None = None
    longest_step: float | None = None
    order: int | None = None
    tolerance: float | None = None
    engine: Literal["auto", "fast", "reference"] = "auto"


class CampaignDocument(JobTable):
    """A job file."""

    campaign: CampaignTable
    body: Annotated[list[dict[str, Any]], Field(min_length=1), BeforeValidator(in_list)] | None = None
    motions: Annotated[list[MotionTable], Field(min_length=1), BeforeValidator(in_list)]
    restitution: RestitutionTable = RestitutionTable(model="ked")
    map: MapTable | None = None
    spectrum: SpectrumTable | None = None
    histories: HistoriesTable | None = None
    fragility: FragilityTable | None = None
    minimum: MinimumTable | None = None
    inventory: InventoryTable | None = None
    export: ExportTable | None = None
    settings: SettingsTable = SettingsTable()

    @property
    def is_adaptive(self) -> bool:
        """Whether what is computed next depends on what was found."""
        refined = self.map is not None and self.map.refine is not None
        return refined or self.campaign.kind == "minimum-acceleration"

    @model_validator(mode="after")
    def _fits_its_kind(self) -> "CampaignDocument":
        kind, wanted = self.campaign.kind, NEEDS[self.campaign.kind]
        for table in dict.fromkeys(NEEDS.values()):
            if table != wanted and getattr(self, table) is not None:
                raise refused(f'[{table}] does not go with kind = "{kind}", which takes [{wanted}]')
        if getattr(self, wanted) is None and kind not in {"histories", "cloud", "minimum-acceleration"}:
            raise refused(f'[{wanted}] is missing, which kind = "{kind}" needs')
        if (self.body is None) != (kind in _OWN_BODIES):
            needed = "is missing" if self.body is None else f"makes no sense: {_OWN_BODIES[kind]}"
            raise refused(f"[body] {needed}")
        if kind not in _MANY_BODIES and len(self.body or ()) > 1:
            raise refused(f'[[body]] can be given once only with kind = "{kind}", got {len(self.body or ())}')
        if self.export is not None and kind not in _ANALYSES:
            raise refused(f'[export] goes with {", ".join(_ANALYSES)}, this is "{kind}"')
        odd = sorted({"measures", "columns"} & (set() if self.export is None else self.export.model_fields_set))
        if odd and kind != "cloud":
            raise refused(f'export.{odd[0]} goes with kind = "cloud" only, this is "{kind}"')
        if kind in _ANALYSES:
            self._analysis_fits(kind, self.fragility or FragilityTable())
        if kind == "inventory":
            self._inventory_fits()
        return self

    def _inventory_fits(self) -> None:
        odd = sorted(self.settings.model_fields_set - {"gravity"})
        if odd:
            raise refused(f"settings.{odd[0]} does not go with an inventory, which takes gravity only")
        families = [table for table in self.motions if table.synthetic is not None]
        if any(table.pulse is not None for table in self.motions) or (families and len(self.motions) > 1):
            raise refused("the motions of an inventory are records, or one family of synthetic ones alone")
        for table in families:
            odd = sorted({"pga", "pgv", "time_step"} & table.model_fields_set)
            if odd:
                raise refused(f"motions.{odd[0]} does not go with an inventory; how strong it is stands in [inventory]")
        told = self.inventory
        if families and told is not None and told.pga is None and told.pgv is None:
            raise refused('how strong is the shaking? [inventory] needs pga = "0.3g" or pgv = "25cm/s"')

    @staticmethod
    def _analysis_fits(kind: str, table: FragilityTable) -> None:
        if (table.levels is None) != (kind == "cloud"):
            what = "is missing" if table.levels is None else "makes no sense: a cloud takes the motions as they are"
            raise refused(f"fragility.levels {what}")
        if table.factor is not None and kind != "cloud":
            raise refused(f'fragility.factor goes with kind = "cloud" only, this is "{kind}"')
        if table.tolerance is not None and kind != "incremental":
            raise refused(f'fragility.tolerance goes with kind = "incremental" only, this is "{kind}"')


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


class ResponseDocument(ResponseTables):
    """A file that describes one response."""

    response: ResponseTable
    body: dict[str, Any]
    motion: OneMotionTable | None = None

    @model_validator(mode="after")
    def _moves(self) -> "ResponseDocument":
        check_start(self.motion is not None, self.response.free)
        return self
