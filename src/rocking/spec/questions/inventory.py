"""Inventories: ratings of the objects of a list."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Text, key
from rocking.spec.question import Progress, StudyQuestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.decision.inventory import Inventory, Thresholds
    from rocking.decision.inventory.hazard import Hazard
    from rocking.spec.study import StudyProblem
    from rocking.studies.study_plan import Study


class ThresholdsTable(JobTable):
    """Limits between the ratings green, amber and red."""

    rocking: float | None = key(
        "green: largest rotation / slenderness angle under most motions [-]", allowed="> 0, <= 1"
    )
    overturning_green: float | None = key(
        "green: largest fraction of motions that overturn the object [-]", allowed="> 0, < 1"
    )
    overturning_red: float | None = key(
        "red: smallest fraction of motions that overturn the object [-]", allowed=">= overturning_green, <= 1"
    )
    level: float | None = key("confidence level of the intervals of the fractions [-]", allowed=">= 0.5, < 1")
    low_consequence: float | None = key(
        "multiplier of both fractions for an object of low consequence [-]", allowed=">= 1, <= 100"
    )
    high_consequence: float | None = key(
        "multiplier of both fractions for an object of high consequence [-]", allowed="> 0, <= 1"
    )


_LEVEL = "records are not scaled; required for synthetic motions"


class InventoryTable(JobTable):
    """A list of objects, and the intensity of the ground motions."""

    objects: Text = key(
        "list of objects as .xlsx, .ods or CSV: name, width, depth, height and more, with units in the header", ...,
        allowed="an existing file",
    )  # fmt: skip
    encoding: Text | None = key(
        "encoding of a CSV file, such as cp1252", usual="detected from the file", allowed="a codec of Python"
    )
    map_columns: Text | dict[str, str] | None = key(
        'meaning of columns by title: "Objekt=name, Maß B=width_cm, Rahmenbreite=". An empty meaning ignores the '
        "column. Quote a title with a comma: '\"Höhe, gesamt\"=height_cm'",
        usual="meaning from the titles", allowed="title=column pairs",
    )  # fmt: skip
    pga: Text | None = key(
        "peak ground acceleration of every motion: 0.3g, 2.9m/s2", usual=_LEVEL, unit="stated with the number",
        allowed="a number > 0 with unit",
    )  # fmt: skip
    pgv: Text | None = key(
        "peak ground velocity of every motion, in place of pga: 25cm/s, 0.25m/s", usual=_LEVEL,
        unit="stated with the number", allowed="a number > 0 with unit",
    )  # fmt: skip
    language: Text | None = key(
        "language of the report: en, de, it, zh", usual="language of the header of the list", allowed="en, de, it, zh"
    )
    thresholds: ThresholdsTable = Field(
        default_factory=ThresholdsTable,
        description="limits between the ratings green, amber and red",
        json_schema_extra={"usual": "defaults of its keys"},
    )

    @model_validator(mode="after")
    def _one_level(self) -> "InventoryTable":
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("Use pga or pgv, not both.")
        return self


class InventoryQuestion(StudyQuestion):
    """Ratings of the objects of a list."""

    kind: ClassVar[str] = "inventory"
    without_body: ClassVar[str] = "the objects are in the file inventory.objects"
    names_files: ClassVar[bool] = True

    inventory: InventoryTable

    @model_validator(mode="after")
    def _shaken_as_a_list_is(self) -> "InventoryQuestion":
        if odd := sorted(self.settings.model_fields_set - {"gravity", "friction"}):
            raise InvalidValueError(
                "{parameter} is not allowed in an inventory. Allowed: gravity, friction.",
                parameter=f"settings.{odd[0]}",
            )  # fmt: skip
        families = [table for table in self.motions if table.synthetic is not None]
        if any(table.pulse is not None for table in self.motions) or (families and len(self.motions) > 1):
            raise InvalidValueError("The motions of an inventory must be records, or one family of synthetic motions.")
        for table in families:
            if odd := sorted({"pga", "pgv", "time_step"} & table.model_fields_set):
                raise InvalidValueError(
                    "{parameter} is not allowed in an inventory", parameter=f"motions.{odd[0]}",
                    hint="set inventory.pga or inventory.pgv",
                )  # fmt: skip
        if families and self.inventory.pga is None and self.inventory.pgv is None:
            raise InvalidValueError(
                'The intensity level is missing. Add pga = "0.3g" or pgv = "25cm/s" to [inventory].'
            )
        return self

    def read(
        self, problem: "StudyProblem"
    ) -> "tuple[Inventory, Callable[[Progress], Hazard], Thresholds, Any]":  # fmt: skip
        """Return the objects, a function that computes the motions, the rating limits and the stated restitution."""
        from rocking.decision.inventory import Thresholds, read_inventory
        from rocking.decision.inventory.hazard import SEED, Hazard, IntensityLevel
        from rocking.studies.motion_sets import SyntheticSet

        table, motions = self.inventory, problem.motions
        if len(problem.restitutions) > 1:
            raise InvalidValueError("An inventory accepts one restitution model. It compares the model with Housner.")
        stated = problem.restitution if "restitution" in self.model_fields_set else None
        with located("inventory.thresholds"):
            limits = Thresholds(**table.thresholds.model_dump(exclude_none=True))
        with located("inventory"):
            folder = Path(table.objects).parent
            objects = read_inventory(
                problem.inputs.file(table.objects),
                table.encoding,
                lambda name: problem.inputs.file((folder / name).as_posix()),
                table.map_columns,
                table.language,
            )
            texts = {"PGA": table.pga, "PGV": table.pgv}
            level = next((IntensityLevel.of(kind, text) for kind, text in texts.items() if text is not None), None)

        def hazard(progress: Progress = None) -> Hazard:
            with located("inventory"):
                if isinstance(motions, SyntheticSet):
                    assert level is not None  # the class of the study ensures a level
                    own = self.motions[0].seed
                    seed = SEED if own is None else own  # the same default as on the command line
                    return Hazard.of_family(motions.family, level, count=motions.count, seed=seed, progress=progress)
                return Hazard.of_records([motions[k] for k in range(len(motions))], level)

        return objects, hazard, limits, stated

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the `Assessment` of the list."""
        from rocking.decision.inventory import assess

        objects, hazard, limits, restitution = self.read(problem)
        settings = problem.settings
        return assess(
            objects, hazard(progress), restitution=restitution, thresholds=limits, gravity=settings.gravity,
            friction=settings.stated.get("friction"), threads=threads,
        )  # fmt: skip

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, object, direction and restitution model.

        With friction or body files, the order is object, restitution model, motion, direction.
        """
        from rocking.decision.inventory.assessment import DEFAULT_MODELS, assessment_plan
        from rocking.decision.inventory.objects import DIRECTIONS
        from rocking.studies.study_plan import Study, along, labels_along, motions_along

        objects, motions, limits, restitution = self.read(problem)
        hazard = motions(None)
        with located("inventory"):
            histories, finish, dims, items = assessment_plan(
                objects, hazard, restitution=restitution, thresholds=limits, gravity=problem.settings.gravity,
                friction=problem.settings.stated.get("friction"),
            )  # fmt: skip
        names = ("asked", "compared") if restitution is not None else DEFAULT_MODELS
        coordinates = {
            "motion": motions_along(histories.motions),
            "object": labels_along("object", (item.name for item in items), "name of the object"),
            "row": along("object", [item.row for item in items], "1", "row number of the object in its file"),
            "number": labels_along("object", (item.number for item in items), "inventory number"),
            "note": labels_along("object", (item.note for item in items), "note in the list"),
            "direction": labels_along("direction", DIRECTIONS, "direction of the ground motion"),
            "restitution": labels_along("restitution", names, "restitution model"),
        }
        attributes = {"shaking": hazard.words(), "hazard": str(hazard.source), "objects": objects.source}
        return Study(histories, dims, coordinates, attributes, assess=finish)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of the ratings."""
        from rocking.plots.inventory import inventory_picture

        return inventory_picture(finished.assessment)
