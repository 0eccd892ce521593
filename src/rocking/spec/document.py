"""What may stand in the file of a campaign or of a response. Imported only when one is read: it loads pydantic."""

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)
from pydantic_core import PydanticKnownError

from rocking.conventions import DEFAULT_FRICTION
from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Names, Numbers, Positive, Seed, Text, Values, in_list

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

if TYPE_CHECKING:
    Kind = str
else:
    Kind = Literal[tuple(NEEDS)]

OWN_BLOCKS = "a spectrum makes its own blocks; of a body, plane or in space, a map over semi_diagonal shows all sizes"
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
OF_FILES = {"format", "units", "time_step", "skip", "component", "vertical", "vertical_file", "process"}
"""Keys of a motion that are for record files only."""


def _key(description: str, usual: Any = None, **limits: Any) -> Any:
    """Return a field with what it means, which options and the documentation of keys repeat."""
    return Field(default=usual, description=description, **limits)


class RandomTable(JobTable):
    """A coefficient that is drawn: from a normal distribution, from values, or from what the measurements say."""

    mean: float | None = _key("mean of a normal distribution [-]", None, ge=0.0, le=1.0)
    deviation: float | None = _key("its standard deviation [-]", None, gt=0.0, le=1.0)
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=1.0)]], Field(min_length=2)] | None = _key("a sample [-]")
    posterior: Literal[True] | None = _key("what the published measurements say of the body")
    count: int | None = _key("how many values are drawn from the posterior", None, ge=2, le=1_000_000)
    each: Literal["impact", "history"] = _key("drawn anew for every impact, or once for a history", "impact")
    times: str | float = _key("a model or a factor that the values multiply", 1.0)
    seed: Seed | None = _key("seed of the draws; that of the campaign if not given")

    @model_validator(mode="after")
    def _one_distribution(self) -> "RandomTable":
        ways = ("mean", "deviation", "values", "posterior")
        stated = [name for name in ways if getattr(self, name) is not None]
        if stated not in (["mean", "deviation"], ["values"], ["posterior"]):
            names = " and ".join(stated) or "none"
            raise InvalidValueError(f"give mean and deviation, or values alone, or posterior alone; got {names}")
        if self.posterior is None and self.count is not None:
            raise InvalidValueError("count goes with posterior: how many values are drawn from it")
        if self.posterior and "times" in self.model_fields_set:
            raise InvalidValueError("times does not go with posterior, which is of the coefficient itself")
        return self


class RestitutionTable(JobTable):
    """What an impact costs."""

    model: Text | None = _key("a model as in rocking models, or my_file.py:MyModel")
    models: Annotated[list[Text], Field(min_length=1)] | None = _key("several, to compare; the first is the answer")
    value: float | None = _key("a coefficient, velocity after over before [-]", None, ge=0.0, le=10.0)
    values: Annotated[list[Annotated[float, Field(ge=0.0, le=10.0)]], Field(min_length=1)] | None = _key(
        "several coefficients [-]"
    )
    left: float | None = _key("coefficient of impacts onto the left foot [-]", None, ge=0.0, le=10.0)
    right: float | None = _key("coefficient of impacts onto the right foot [-]", None, ge=0.0, le=10.0)
    distribution: RandomTable | None = _key("a coefficient that is drawn: mean and deviation, values, or posterior")

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


class CampaignTable(JobTable):
    """What the campaign is called and what it computes."""

    name: Text = _key("what it is called", ...)
    kind: Kind = _key("which study", ...)
    note: str | None = _key("anything")
    chunk: int | None = _key("histories that are kept together", None, ge=1, le=1 << 22)
    seed: Seed = _key("seed of what is drawn", 0)


class FileKeys(JobTable):
    """Options of a record file: its format, unit and time step, and lines to skip."""

    format: Text | None = _key("format of the record file, if not found by content: see rocking formats")
    units: Text | None = _key("unit of the record where its file states none: m/s2, cm/s2, mm/s2, gal, g, g/10, mg")
    time_step: Positive | None = _key("step between samples where the file does not state it [s]")
    skip: int | None = _key("lines at the top of a text file that are passed over", None, ge=0, le=100_000)


class MotionKeys(FileKeys):
    """What one motion, or several, are made of."""

    synthetic: Text | None = _key("family of synthetic motions: firm-ground, soft-ground, point-source and more")
    component: Text | None = _key("horizontal component of the file, by name")
    vertical: Text | None = _key("vertical component, by name")
    vertical_file: Text | None = _key("file of the vertical component, where it has its own")
    process: Names | None = _key("steps that a record goes through: mean; bandpass:low=0.1,high=25; taper")
    scale: float = _key("factor on the acceleration of the ground [-]", 1.0)
    seed: Seed | None = _key("seed of the synthetic motions")
    pga: Positive | None = _key("peak ground acceleration to which synthetic motions are scaled [m/s2]")
    pgv: Positive | None = _key("peak ground velocity to which synthetic motions are scaled [m/s]")

    def _one_source(self, keys: dict[str, set[str]]) -> str:
        """Return the only source of the motion, after refusing keys of another."""
        source = self.chosen(*keys)
        stated = {name for name in self.model_fields_set if getattr(self, name) is not None}
        odd = sorted(stated & set().union(*keys.values()) - keys[source])
        if odd:
            raise InvalidValueError(
                f"{source} takes no {', '.join(odd)}; allowed beside it: {', '.join(sorted(keys[source]))}"
            )
        if self.scale == 0.0:
            raise InvalidValueError("scale must not be 0: nothing would move")
        return source


class OneMotionTable(MotionKeys):
    """One pulse, one record, or one motion of a synthetic family."""

    pulse: Text | None = _key("a pulse such as sine:amplitude=3,period=0.8")
    record: Text | None = _key("a record file")
    member: Annotated[int, Field(ge=0, lt=10_000_000)] | None = _key("which motion of the synthetic family, from 0")

    @model_validator(mode="after")
    def _whole(self) -> "OneMotionTable":
        self._check_sources()
        return self

    def _check_sources(self) -> None:
        own = {"seed", "member", "pga", "pgv", "time_step", "scale"}
        self._one_source({"pulse": {"scale"}, "record": {*OF_FILES, "scale"}, "synthetic": own})
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("motions can be scaled to pga or to pgv, not to both")


class _Along(JobTable):
    """A motion along each of the axes x, y and z of a body in space; z is up."""

    x: OneMotionTable | None = _key("motion along x")
    y: OneMotionTable | None = _key("motion along y")
    z: OneMotionTable | None = _key("motion along z, upwards")

    @property
    def components(self) -> dict[str, OneMotionTable]:
        """The motions by their axis; none where there is one motion alone."""
        along = {"x": self.x, "y": self.y, "z": self.z}
        return {axis: table for axis, table in along.items() if table is not None}

    def _check_components(self) -> None:
        """Refuse what does not go with components."""
        if odd := sorted(self.model_fields_set - {"x", "y", "z", "scale"}):
            raise InvalidValueError(f"{', '.join(odd)} stands with each of the motions along x, y and z")
        if self.x is not None and self.z is not None and (self.x.vertical or self.x.vertical_file):
            raise InvalidValueError("the vertical motion is given twice: beside the one along x, and along z")


class ComponentsTable(_Along, OneMotionTable):
    """One motion, or one along each of the axes x, y and z of a body in space; z is up."""

    def _check_sources(self) -> None:
        self._check_components() if self.components else super()._check_sources()


class MotionTable(_Along, MotionKeys):
    """Records, pulses, a family of synthetic motions, or one motion along x, y and z of a body in space; z is up."""

    records: Names | None = _key("record files, a folder of them, a pattern such as *.at2, or a list in a .csv file")
    files: dict[Text, FileKeys] | None = _key(
        'options of single files, in place of those for all files: one table per file name, [motions.files."a.txt"]'
    )
    pulse: Names | None = _key("pulses such as sine:amplitude=3,period=0.8")
    count: Annotated[int, Field(ge=1, le=10_000_000)] | None = _key(
        "how many synthetic motions, or records chosen for a target"
    )
    target: Text | None = _key(
        "spectrum that records are scaled to: eurocode8:ag=0.25g,ground=C,type=1, asce7:sds=1g,sd1=0.6g,tl=8, a file"
    )
    periods: Annotated[list[Positive], Field(min_length=2, max_length=2)] | None = _key(
        "first and last period of a target that count, 0.1 and 2 if not given [s]"
    )
    mirrored: bool = _key("every record also with its horizontal components turned round", False)

    @model_validator(mode="after")
    def _whole(self) -> "MotionTable":
        if self.components:
            self._check_components()
            return self
        own = {"count", "seed", "pga", "pgv", "time_step"}
        chosen = {"target", "periods", "count"}
        of_records = {*OF_FILES, "files", *chosen, "scale", "mirrored"}
        source = self._one_source({"records": of_records, "pulse": {"scale"}, "synthetic": own})
        if source == "synthetic" and self.count is None:
            raise InvalidValueError("count is missing: how many synthetic motions?")
        if source == "records" and self.target is None and (odd := sorted(chosen & self.model_fields_set)):
            raise InvalidValueError(f"{odd[0]} of records goes with target, the spectrum that they are chosen for")
        return self

    @property
    def file_options(self) -> dict[str, dict[str, Any]]:
        """The options of single record files, by their names; keys that are not stated are absent."""
        return {name: table.model_dump(exclude_none=True) for name, table in (self.files or {}).items()}


class AxisTable(Values):
    """An axis of a map."""

    axis: Text = _key("what changes along it: frequency_ratio, pga, semi_diagonal and more", ...)


class MapTable(JobTable):
    """The two axes of a map, and how closely to follow the boundaries in it."""

    x: AxisTable = _key("axis, and its values in SI", ...)
    y: AxisTable = _key("the upright axis", ...)
    refine: int | None = _key("levels of refinement along boundaries, each of half the spacing", None, ge=0, le=12)
    boundary: Literal["verdict", "mode"] = _key("which boundaries: of overturning, or of all modes", "verdict")
    tolerance: float = _key("how closely boundaries are bisected [-]", 1e-10, ge=1e-15, le=0.1)

    @model_validator(mode="after")
    def _refined(self) -> "MapTable":
        odd = sorted({"boundary", "tolerance"} & self.model_fields_set)
        if odd and self.refine is None:
            raise InvalidValueError(
                f"{' and '.join(odd)} goes with refine, how often cells along boundaries are halved: give it"
            )
        return self


class MinimumTable(JobTable):
    """Where and how closely to look for the accelerations at which a body begins or ceases to overturn."""

    lowest: Positive | None = _key("where to begin; what lifts the body if not given [m/s2]")
    highest: Positive | None = _key("where to end; 50 times what lifts the body if not given [m/s2]")
    points: int = _key("first samples, in equal ratios", 400, ge=2, le=1_000_000)
    levels: int = _key("how often suspicious intervals are halved, 0 to 12", 4, ge=0, le=12)
    tolerance: float = _key("width of the last brackets over the acceleration [-]", 1e-12, ge=0.0, le=0.1)


class ThresholdsTable(JobTable):
    """Where one light ends and the next begins; what is left out is as in every report."""

    rocking: float | None = _key(
        "rotation over the slenderness angle that most motions may reach where it is green [-]"
    )
    overturning_green: float | None = _key("share of motions that may overturn it where it is green [-]")
    overturning_red: float | None = _key("share of motions from which on it is red [-]")
    level: float | None = _key("confidence of the shares' intervals [-]")
    low_consequence: float | None = _key("what the shares are multiplied by where a fall is of low consequence [-]")
    high_consequence: float | None = _key("the same where a fall is of high consequence; a fall weighs the inverse [-]")


class InventoryTable(JobTable):
    """A list of objects, and how strong the shaking is: a number with its unit, such as 0.3g."""

    objects: Text = _key("list as .xlsx, .ods or CSV: name, width, depth, height and more, each with its unit", ...)
    encoding: Text | None = _key("encoding of a CSV file, such as cp1252; told from the file if left out")
    columns: Text | dict[str, str] | None = _key(
        'what columns are, by their titles: "Objekt=name, Maß B=width_cm, Rahmenbreite="; nothing leaves one out; '
        "a title with a comma in quotation marks: '\"Höhe, gesamt\"=height_cm'"
    )
    pga: Text | None = _key("peak ground acceleration of every motion: 0.3g, 2.9m/s2")
    pgv: Text | None = _key("peak ground velocity in its place: 25cm/s, 0.25m/s")
    language: Text | None = _key("language of the report: en, de, it; that of the list's header if not given")
    thresholds: ThresholdsTable = Field(
        default_factory=ThresholdsTable, description="where one light ends and the next begins"
    )

    @model_validator(mode="after")
    def _one_level(self) -> "InventoryTable":
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("give pga or pgv, not both: motions are scaled to one of them")
        return self


class ExportTable(JobTable):
    """How files are written, how often a study is repeated for intervals, and which measures are compared."""

    crossing: Literal["keep-uplift", "common-dispersion", "refuse"] = _key(
        "treatment of curves that cross", "keep-uplift"
    )
    bootstrap: Annotated[int, Field(ge=99, le=100_000)] | Literal[0] = _key("how often a study is repeated", 0)
    measures: Annotated[list[Text], Field(min_length=1)] | None = _key("measures of intensity that are compared")
    columns: list[Text] | None = _key("columns of the comparison")


class SpectrumTable(JobTable):
    """The blocks of rocking spectra."""

    slenderness_angles: Numbers = _key("slenderness angles alpha = atan(b/h) [rad]", ...)
    periods: Numbers = _key("periods 2 pi / p [s]", ...)
    scale: float = _key("factor on the acceleration of the ground [-]", 1.0)


_BOUNCE_LAW = (
    "with bounce: what it is the ratio of: normal velocities (newton), impulses, or, squared, energies (stronge)"
)


class HistoriesTable(JobTable):
    """What the histories of a campaign are made with, beside bodies, motions and restitutions."""

    scales: Numbers = Field(default_factory=lambda: Values(values=[1.0]), description="factors on the motions [-]")


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

    measure: Text = _key("measure of intensity: pga, pgv, arias, sa(0.5) and more", "pga")
    levels: Numbers | None = _key("levels of the measure [its unit]")
    states: list[Annotated[Positive | Literal["rocking", "overturning"], WrapValidator(_one_state)]] = _key(
        "limit states: rotations over the slenderness angle [-], with rocking and overturning; where one of these two "
        "names is given, the given states alone",
        [0.5],
    )
    tolerance: float | None = _key("width of the last brackets over the level [-]", None, ge=0.0, le=0.1)
    factor: Positive | None = _key("factor on all motions of a cloud [-]")


class PredictTable(JobTable):
    """What is not known of a body: a number, [low, high], more numbers, or a table of a distribution."""

    restitution: Any = _key('"measured" (usual), a model, "complementarity", or a coefficient [-]')
    friction: Any = _key("coefficient of friction; [0.3, 0.8] if not given [-]")
    base: Any = _key("how far feet lie inside of the drawn base; up to 2 % of its width if not given [m]")
    centre: Any = _key("factor on the height of the centre of mass; [0.97, 1.03] if not given [-]")
    polarity: Any = _key("1 as recorded, -1 mirrored; both alike if not given")
    azimuth: Any = _key("of the body's plane, with motions of two components; any if not given [rad]")
    sliding_beyond: Positive = _key("distance from which it is said to slide [m]", 0.01)
    pga: Text | None = _key("peak ground acceleration to which each motion is scaled: 0.3g, 2.9m/s2")
    count: int = _key("bodies drawn for each motion, a power of two", 128, ge=4, le=1 << 20)
    shares: bool = _key("find which input matters how much", True)
    seed: Seed = _key("seed of the draws", 0)


class MeasurementTable(JobTable):
    """What was measured of a body that rocks freely: a file, or a folder in which every file is a trial."""

    file: Text = Field(description="sound, video, table of times or rotations, or a folder of them")
    kind: str | None = _key("sound, video, times, rotation, displacement, angular velocity or acceleration")
    column: str | None = _key("name of the column, where a table has several")
    unit: str | None = _key("unit of the column, where the table states none")
    time_column: str | None = _key("name of the column of times; that called time if not given")
    time_unit: str | None = _key("unit of the times, s or ms, where the table states none")
    height: Positive | None = _key("height of the sensor above the base, for a displacement or an acceleration [m]")
    region: list[float] | None = _key(
        "of a video, where the body is at rest, if not found by what moves: left, top, width, height [pixels]"
    )
    frame_rate: Positive | None = _key("of a video played more slowly than it was taken, as it was taken [1/s]")


class IdentifyTable(JobTable):
    """What is known beside a measurement; everything that is left out has its usual value."""

    size_error: float | None = _key("standard deviation of a length of the body, relative; 0.01 if not given [-]")
    tilt: float | list[float] | None = _key(
        "standard deviation of the tilt of the floor, or [tilt, deviation], clockwise; 0.0052 if not given [rad]"
    )
    asymmetry: float | None = _key("standard deviation of ln r landing right less left; 0.06 if not given [-]")
    trend: bool | None = _key("fit a change of r with the speed")
    damping: bool | None = _key("fit damping between impacts")
    clock: float | list[float] | None = _key(
        "under a motion: standard deviation of the clock against that of the motion, or [ahead, deviation]; 0.02 [s]"
    )
    first: Literal["left", "right"] | None = _key("foot on which it stands after the first impact, of times")


class AssessTable(JobTable):
    """What is asked of an assessment, and what stands on its report."""

    restitutions: list[Any] | None = _key("models and coefficients of the histories; all models if not given")
    margin: Positive = _key("factor on the motions that remedies must hold [-]", 1.0)
    project: Text | None = _key("what the project is called")
    author: Text | None = _key("who signs")
    date: Text | None = _key("day of the report; today if not given")


class SettingsTable(JobTable):
    """How to integrate: what is left out has its usual value."""

    gravity: Positive | None = _key("acceleration of gravity [m/s2]")
    linear: bool | None = _key("slender-linear equations")
    rest_speed: float | None = _key("speed below which a motion ends at once [-]")
    most_events: int | None = _key("a history with more impacts and changes of contact is stopped")
    longest_step: float | None = _key("longest Taylor step as p times time [-]")
    order: int | None = _key("order of the Taylor series")
    tolerance: float | None = _key("bound on the last two terms of a Taylor step [-]")
    engine: Literal["auto", "fast", "reference"] = _key("which engine computes", "auto")

    def stated(self) -> dict[str, Any]:
        """Return what was stated, without the engine, as `Settings` takes it."""
        return self.model_dump(exclude={"engine"}, exclude_none=True)


class StudySettingsTable(SettingsTable):
    """How to integrate: what is left out has its usual value. Friction is of studies; one history has its own table."""

    friction: float | None = _key("coefficient of friction, with which bodies slide, hop and fly [-]", None, ge=0.0)
    bounce: float | None = _key("with friction: coefficient of normal restitution, from 0 [-]", None, ge=0.0)
    bounce_law: Literal["newton", "poisson", "stronge"] | None = _key(_BOUNCE_LAW)


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


class ResponseTable(JobTable):
    """How the body starts, and on what it stands."""

    free: float | None = _key(
        "no motion: initial rotation over the slenderness angle, of a solid towards x; negative to the left, or -x [-]"
    )
    friction: float | None = _key("coefficient of friction, which lets the body slide, hop and fly [-]", None, gt=0.0)
    bounce: float | None = _key("with friction: coefficient of normal restitution, from 0 [-]", None, ge=0.0)
    bounce_law: Literal["newton", "poisson", "stronge"] | None = _key(_BOUNCE_LAW)
    start_height: float | None = _key(
        "with friction: initial height of the lowest point, from which the body drops [m]", None, ge=0.0
    )
    start_velocity: list[float] | None = _key(
        "with friction: initial velocity of the lowest point; x and up for a plane body, x, y and up for a solid [m/s]"
    )
    assumed_friction: float = Field(
        gt=0.0,
        default_factory=lambda: DEFAULT_FRICTION,
        description="without friction: what pure rocking is compared with; 0.5 if not given [-]",
    )

    @property
    def dropped(self) -> bool:
        """Whether the body starts above the ground, or in motion."""
        return bool(self.start_height) or any(self.start_velocity or ())


class ResponseTables(JobTable):
    """What every document of a response has, wherever its body and motion come from."""

    restitution: RestitutionTable = Field(default_factory=lambda: RestitutionTable(model="ked"))
    response: ResponseTable = Field(default_factory=ResponseTable)
    settings: SettingsTable = Field(default_factory=SettingsTable)

    @model_validator(mode="after")
    def _coefficient_of_one_history(self) -> "ResponseTables":
        drawn = self.restitution.distribution
        if drawn is not None and drawn.each == "history":
            raise InvalidValueError('restitution.distribution.each must be "impact" for one history, got "history"')
        return self


def check_start(moved: bool, start: ResponseTable) -> None:
    """Refuse a document in which nothing moves the body, and one with both a motion and an initial rotation."""
    if moved and start.free is not None:
        raise InvalidValueError("give a motion or response.free, not both")
    if not moved and start.free is None and not start.dropped:
        raise InvalidValueError("what moves the body? Give a motion, or response.free (such as 0.5) for free rocking")


class ResponseDocument(ResponseTables):
    """A file that describes one response."""

    body: dict[str, Any]
    motion: ComponentsTable | None = None

    @model_validator(mode="after")
    def _moves(self) -> "ResponseDocument":
        check_start(self.motion is not None, self.response)
        return self


class PredictedBody(JobTable):
    """A body, what is not known of it, and how to integrate."""

    predict: PredictTable = Field(default_factory=PredictTable)
    body: dict[str, Any]
    settings: StudySettingsTable = Field(default_factory=StudySettingsTable)

    @model_validator(mode="after")
    def _one_engine(self) -> "PredictedBody":
        odd = sorted(self.settings.model_fields_set - {"gravity", "friction", "bounce", "bounce_law"})
        if odd:
            raise InvalidValueError(f"settings.{odd[0]} does not go with a prediction, which has one engine")
        if "friction" in self.settings.model_fields_set & self.predict.model_fields_set:
            raise InvalidValueError("predict.friction and settings.friction say the same: leave one out")
        return self


class PredictionDocument(PredictedBody):
    """A file that asks how likely a body is to overturn."""

    motion: ComponentsTable | None = None
    motions: Annotated[list[MotionTable], BeforeValidator(in_list)] = Field(default_factory=list)

    @model_validator(mode="after")
    def _whole(self) -> "PredictionDocument":
        if (self.motion is None) == (not self.motions):
            raise InvalidValueError("give [[motions]], or [motion] with x and y, and not both")
        return self


class AssessmentDocument(PredictionDocument):
    """A file that asks whether a body stands, and what to do about it."""

    assess: AssessTable = Field(default_factory=AssessTable)


class RecordDocument(JobTable):
    """A file that says how one record is read and corrected."""

    motion: ComponentsTable


class RecordSetDocument(JobTable):
    """A file that says how a set of records is read, corrected and chosen."""

    motions: Annotated[list[MotionTable], Field(min_length=1, max_length=1), BeforeValidator(in_list)]

    @model_validator(mode="after")
    def _of_records(self) -> "RecordSetDocument":
        if self.motions[0].records is None:
            raise InvalidValueError("motions.records is missing: a set is one of records")
        return self


class ValidationDocument(PredictedBody):
    """A file beside a table of outcomes: the body, what is not known of it, and how its records are read."""

    motion: MotionKeys = Field(default_factory=MotionKeys)

    @model_validator(mode="after")
    def _of_files(self) -> "ValidationDocument":
        known = OF_FILES - {"vertical_file"}
        if odd := sorted(self.motion.model_fields_set - known):
            raise InvalidValueError(
                f"[motion] takes {', '.join(sorted(known))} here, got {odd[0]}; outcomes name the rest"
            )
        return self


class IdentificationDocument(JobTable):
    """A file that asks what a measurement says of the coefficient of restitution."""

    body: dict[str, Any] | None = None
    measurement: MeasurementTable
    motion: OneMotionTable | None = None
    identify: IdentifyTable = Field(default_factory=IdentifyTable)

    @model_validator(mode="before")
    @classmethod
    def _pairs(cls, stated: Any) -> Any:
        known = stated.get("identify") if isinstance(stated, dict) else None
        known = known if isinstance(known, dict) else {}
        for name in {"tilt", "clock"} & set(known):
            pair = given if isinstance(given := known[name], list) else [given, 0.0]
            if len(pair) != 2 or not all(type(each) in {int, float} and abs(each) < math.inf for each in pair):
                raise InvalidValueError(
                    f"identify.{name} is one number, or a value and its deviation, got {given!r:.60}"
                )
        return stated

    @model_validator(mode="after")
    def _of_two_clocks(self) -> "IdentificationDocument":
        if self.identify.clock is not None and self.motion is None:
            raise InvalidValueError("identify.clock goes with [motion]: it is of both clocks")
        return self
