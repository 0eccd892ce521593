"""The job file of a campaign."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Seed, Text, in_list, key
from rocking.spec.motion_tables import MotionTable
from rocking.spec.questions.fragility import ExportTable, FragilityTable
from rocking.spec.questions.histories import HistoriesTable
from rocking.spec.questions.inventory import InventoryTable
from rocking.spec.questions.minimum_acceleration import MinimumTable
from rocking.spec.questions.overturning_map import MapTable
from rocking.spec.questions.rocking_spectrum import OWN_BLOCKS, SpectrumTable
from rocking.spec.restitution_tables import RestitutionTable
from rocking.spec.settings_tables import StudySettingsTable

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
    "rocking-spectrum": OWN_BLOCKS,
    "inventory": "the objects stand in the file that [inventory] names",
}

_MANY_BODIES = {"histories", "minimum-acceleration", *_OWN_BODIES}

_ANALYSES = [kind for kind, table in NEEDS.items() if table == "fragility"]

_ONLY = {
    "export.columns": "cloud",
    "export.measures": "cloud",
    "fragility.factor": "cloud",
    "fragility.tolerance": "incremental",
}

if TYPE_CHECKING:
    Kind = str
else:
    Kind = Literal[tuple(NEEDS)]


class CampaignTable(JobTable):
    """What the campaign is called and what it computes."""

    name: Text = key("what it is called", ...)
    kind: Kind = key("which study", ...)
    note: str | None = key("anything")
    chunk: int | None = key("histories that are kept together", None, ge=1, le=1 << 22)
    seed: Seed = key("seed of what is drawn", 0)


class CampaignDocument(JobTable):
    """A job file."""

    campaign: CampaignTable
    body: Annotated[list[dict[str, Any]], Field(min_length=1), BeforeValidator(in_list)] | None = None
    motions: Annotated[list[MotionTable], Field(min_length=1), BeforeValidator(in_list)]
    restitution: RestitutionTable = Field(default_factory=lambda: RestitutionTable(model="ked"))
    map: MapTable | None = None
    spectrum: SpectrumTable | None = None
    histories: HistoriesTable | None = None
    fragility: FragilityTable | None = None
    minimum: MinimumTable | None = None
    inventory: InventoryTable | None = None
    export: ExportTable | None = None
    settings: StudySettingsTable = Field(default_factory=StudySettingsTable)

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
                raise InvalidValueError(f'[{table}] does not go with kind = "{kind}", which takes [{wanted}]')
        if getattr(self, wanted) is None and kind not in {"histories", "cloud", "minimum-acceleration"}:
            raise InvalidValueError(f'[{wanted}] is missing, which kind = "{kind}" needs')
        if (self.body is None) != (kind in _OWN_BODIES):
            needed = "is missing" if self.body is None else f"makes no sense: {_OWN_BODIES[kind]}"
            raise InvalidValueError(f"[body] {needed}")
        if kind not in _MANY_BODIES and len(self.body or ()) > 1:
            raise InvalidValueError(f'[[body]] can be given once only with kind = "{kind}", got {len(self.body or ())}')
        if self.export is not None and kind not in _ANALYSES:
            raise InvalidValueError(f'[export] goes with {", ".join(_ANALYSES)}, this is "{kind}"')
        levels = None if self.fragility is None else self.fragility.levels
        if kind in _ANALYSES and (levels is None) != (kind == "cloud"):
            what = "is missing" if levels is None else "makes no sense: a cloud takes the motions as they are"
            raise InvalidValueError(f"fragility.levels {what}")
        for place, only in _ONLY.items():
            table, _, key = place.partition(".")
            if getattr(getattr(self, table), key, None) is not None and kind != only:
                raise InvalidValueError(f'{place} goes with kind = "{only}" only, this is "{kind}"')
        if kind == "inventory":
            self._inventory_fits()
        return self

    def _inventory_fits(self) -> None:
        odd = sorted(self.settings.model_fields_set - {"gravity", "friction"})
        if odd:
            raise InvalidValueError(
                f"settings.{odd[0]} does not go with an inventory, which takes gravity and friction only"
            )
        families = [table for table in self.motions if table.synthetic is not None]
        if any(table.pulse is not None for table in self.motions) or (families and len(self.motions) > 1):
            raise InvalidValueError("the motions of an inventory are records, or one family of synthetic ones alone")
        for table in families:
            odd = sorted({"pga", "pgv", "time_step"} & table.model_fields_set)
            if odd:
                raise InvalidValueError(
                    f"motions.{odd[0]} does not go with an inventory; how strong it is stands in [inventory]"
                )
        inventory = self.inventory
        if families and inventory is not None and inventory.pga is None and inventory.pgv is None:
            raise InvalidValueError('how strong is the shaking? [inventory] needs pga = "0.3g" or pgv = "25cm/s"')
