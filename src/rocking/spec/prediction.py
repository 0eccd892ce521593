"""A body of which not everything is known, and what moves it: the problem of a prediction, and its answer."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rocking.bodies import Body, Solid
from rocking.errors import InvalidValueError, located
from rocking.prediction import Prediction, predict
from rocking.prediction.mechanics import COMPLEMENTARITY, MEASURED
from rocking.spec.bodies import any_body_of
from rocking.spec.construction import components_of, motion_of, motions_of, restitutions_of
from rocking.spec.reading import InputFiles

if TYPE_CHECKING:
    from rocking.assessment import BodyAssessment
    from rocking.spec.documents.prediction import AssessTable, PredictedBody, PredictionDocument


@dataclass(frozen=True)
class PredictionProblem:
    """Everything that a prediction depends on."""

    body: Body | Solid
    motions: Any  # by number
    options: dict[str, Any]  # as `predict` takes them

    @classmethod
    def of(cls, document: "PredictionDocument", inputs: InputFiles) -> "PredictionProblem":
        """Return what a file describes; inputs: files that it may name."""
        with located("body"):
            body = any_body_of(document.body, inputs)
        motions: Any
        if document.motion is None:
            motions = motions_of(document.motions, inputs, paired=True)
        else:
            alone = document.motion
            with located("motion"):
                motions = [components_of(alone, inputs) or {"x": motion_of(alone, inputs).scaled(alone.scale)}]
        return cls(body, motions, options_of(document, body, inputs))

    def assessed(
        self, table: "AssessTable", inputs: InputFiles, progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> "BodyAssessment":  # fmt: skip
        """Return whether the body stands, with what else was asked for."""
        from rocking.assessment import assess
        from rocking.spec.restitution_tables import RestitutionTable

        ground = {"normal_restitution", "normal_restitution_law"}
        options = {name: value for name, value in self.options.items() if name not in ground}
        if odd := sorted(set(self.options) - set(options)):
            raise InvalidValueError(
                "{parameter} does not go with an assessment, whose histories do not bounce",
                parameter=f"settings.{odd[0]}",
            )  # fmt: skip
        predicted, given = options.pop("restitution", None), table.restitutions
        if given is not None:
            given = [
                next(iter(restitutions_of(RestitutionTable(model=each), 0, [self.body], inputs).values()))
                if isinstance(each, str) and each != "calibrated"
                else each
                for each in given
            ]
        if predicted is None and given is not None and len(given) == 1:
            predicted = MEASURED if given[0] == "calibrated" else given[0]
        return assess(
            self.body, self.motions, given, predicted=predicted, margin=table.margin, threads=threads,
            progress=progress, **options,
        )  # fmt: skip

    def answer(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Prediction:
        return predict(self.body, self.motions, **self.options, threads=threads, progress=progress)


def options_of(document: "PredictedBody", body: Body | Solid, inputs: InputFiles) -> dict[str, Any]:
    """Return what a file says of a body that is not known exactly, as `predict` takes it."""
    from rocking.spec.restitution_tables import RestitutionTable

    ground = document.settings.model_dump(exclude_none=True, exclude={"engine"})
    options = {**document.predict.model_dump(exclude_none=True), **ground}
    if "pga" in options:
        from rocking.studies.inventory.hazard import IntensityLevel

        options["pga"] = IntensityLevel.of("PGA", options["pga"]).value
    model = options.get("restitution")
    if isinstance(model, str) and model not in {*MEASURED, COMPLEMENTARITY}:
        table = RestitutionTable(model=model)
        options["restitution"] = next(iter(restitutions_of(table, 0, [body], inputs).values()))
    return options
