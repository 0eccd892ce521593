"""What may stand in a job file. Imported only when one is read: it loads pydantic."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from rocking.studies.campaign.chunks import LARGEST_CHUNK
from rocking.studies.job.restitution_tables import RestitutionTable
from rocking.studies.job.table import JobTable, Names, Numbers, Positive, Seed, Values, Words, in_list, refused

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
    most_impacts: int | None = None
    longest_step: float | None = None
    order: int | None = None
    tolerance: float | None = None
    engine: Literal["auto", "fast", "reference"] = "auto"


class Document(JobTable):
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
    def _fits_its_kind(self) -> "Document":
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
