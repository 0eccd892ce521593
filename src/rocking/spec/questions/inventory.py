"""Inventories: which objects of a list stay standing."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Text, key
from rocking.spec.question import Progress, StudyQuestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.inventory import Inventory, Thresholds
    from rocking.studies.inventory.hazard import Hazard
    from rocking.studies.study_plan import Study


class ThresholdsTable(JobTable):
    """Where one light ends and the next begins; what is left out is as in every report."""

    rocking: float | None = key("rotation over the slenderness angle that most motions may reach where it is green [-]")
    overturning_green: float | None = key("share of motions that may overturn it where it is green [-]")
    overturning_red: float | None = key("share of motions from which on it is red [-]")
    level: float | None = key("confidence of the shares' intervals [-]")
    low_consequence: float | None = key("what the shares are multiplied by where a fall is of low consequence [-]")
    high_consequence: float | None = key("the same where a fall is of high consequence; a fall weighs the inverse [-]")


class InventoryTable(JobTable):
    """A list of objects, and how strong the shaking is: a number with its unit, such as 0.3g."""

    objects: Text = key("list as .xlsx, .ods or CSV: name, width, depth, height and more, each with its unit", ...)
    encoding: Text | None = key("encoding of a CSV file, such as cp1252; told from the file if left out")
    map_columns: Text | dict[str, str] | None = key(
        'what columns are, by their titles: "Objekt=name, Maß B=width_cm, Rahmenbreite="; nothing leaves one out; '
        "a title with a comma in quotation marks: '\"Höhe, gesamt\"=height_cm'"
    )
    pga: Text | None = key("peak ground acceleration of every motion: 0.3g, 2.9m/s2")
    pgv: Text | None = key("peak ground velocity in its place: 25cm/s, 0.25m/s")
    language: Text | None = key("language of the report: en, de, it, zh; that of the list's header if not given")
    thresholds: ThresholdsTable = Field(
        default_factory=ThresholdsTable, description="where one light ends and the next begins"
    )

    @model_validator(mode="after")
    def _one_level(self) -> "InventoryTable":
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("Use pga or pgv, not both.")
        return self


class InventoryQuestion(StudyQuestion):
    """Which objects of a list stay standing."""

    kind: ClassVar[str] = "inventory"
    without_body: ClassVar[str] = "the objects stand in the file that [inventory] names"
    names_files: ClassVar[bool] = True

    inventory: InventoryTable

    @model_validator(mode="after")
    def _shaken_as_a_list_is(self) -> "InventoryQuestion":
        if odd := sorted(self.settings.model_fields_set - {"gravity", "friction"}):
            raise InvalidValueError(
                "{parameter} does not go with an inventory, which takes gravity and friction only",
                parameter=f"settings.{odd[0]}",
            )  # fmt: skip
        families = [table for table in self.motions if table.synthetic is not None]
        if any(table.pulse is not None for table in self.motions) or (families and len(self.motions) > 1):
            raise InvalidValueError("the motions of an inventory are records, or one family of synthetic ones alone")
        for table in families:
            if odd := sorted({"pga", "pgv", "time_step"} & table.model_fields_set):
                raise InvalidValueError(
                    "{parameter} does not go with an inventory", parameter=f"motions.{odd[0]}",
                    hint="how strong it is stands in [inventory]",
                )  # fmt: skip
        if families and self.inventory.pga is None and self.inventory.pgv is None:
            raise InvalidValueError(
                'The intensity level is missing. Add pga = "0.3g" or pgv = "25cm/s" to [inventory].'
            )
        return self

    def read(
        self, problem: "StudyProblem"
    ) -> "tuple[Inventory, Callable[[Progress], Hazard], Thresholds, Any]":  # fmt: skip
        """Return the objects, what makes their motions, the limits of the ratings, and the stated model."""
        from rocking.studies.inventory import Thresholds, read_inventory
        from rocking.studies.inventory.hazard import SEED, Hazard, IntensityLevel
        from rocking.studies.motion_sets import SyntheticSet

        table, motions = self.inventory, problem.motions
        if len(problem.restitutions) > 1:
            raise InvalidValueError("restitution: an inventory takes one; that of Housner stands beside it")
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
                    assert level is not None  # the question refuses to be without
                    own = self.motions[0].seed
                    seed = SEED if own is None else own  # as on the command line
                    return Hazard.of_family(motions.family, level, count=motions.count, seed=seed, progress=progress)
                return Hazard.of_records([motions[k] for k in range(len(motions))], level)

        return objects, hazard, limits, stated

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the `Assessment` of the list."""
        from rocking.studies.inventory import assess

        objects, hazard, limits, restitution = self.read(problem)
        settings = problem.settings
        return assess(
            objects, hazard(progress), restitution=restitution, thresholds=limits, gravity=settings.gravity,
            friction=settings.stated.get("friction"), threads=threads,
        )  # fmt: skip

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, object, direction and the model of impact, those asked beside it.

        With friction or body files over object, model of impact, motion and direction.
        """
        from rocking.studies.inventory.assessment import DEFAULT_MODELS, assessment_plan
        from rocking.studies.inventory.objects import DIRECTIONS
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
            "row": along("object", [item.row for item in items], "1", "line of the object in its file"),
            "number": labels_along("object", (item.number for item in items), "inventory number"),
            "note": labels_along("object", (item.note for item in items), "what the list notes"),
            "direction": labels_along("direction", DIRECTIONS, "direction of the shaking"),
            "restitution": labels_along("restitution", names, "model of impact"),
        }
        attributes = {"shaking": hazard.words(), "hazard": str(hazard.source), "objects": objects.source}
        return Study(histories, dims, coordinates, attributes, assess=finish)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Draw the ratings of the objects."""
        from rocking.plots.inventory import inventory_picture

        return inventory_picture(finished.assessment)
