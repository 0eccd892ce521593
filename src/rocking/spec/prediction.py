"""The problem of a prediction, an uncertain body with its motions, and the result."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import Body, Solid
from rocking.decision.prediction import Prediction, predict
from rocking.decision.prediction.mechanics import COMPLEMENTARITY, MEASURED
from rocking.decision.prediction.model_error import OFF, is_class
from rocking.errors import InvalidValueError, located
from rocking.spec.bodies import any_body_of, without_restraints
from rocking.spec.construction import components_of, motion_of, motions_of, restitutions_of
from rocking.spec.reading import InputFiles

if TYPE_CHECKING:
    from rocking.decision.assessment import BodyAssessment
    from rocking.spec.documents.prediction import AssessTable, PredictedBody, PredictionDocument


@dataclass(frozen=True)
class PredictionProblem:
    """Body, motions and options of a prediction."""

    body: Body | Solid
    motions: Any  # sequence of motions, or of components by axis
    options: dict[str, Any]  # keywords of `predict`

    @classmethod
    def of(cls, document: "PredictionDocument", inputs: InputFiles) -> "PredictionProblem":
        """Return the prediction problem that an input file defines.

        `inputs` records the files named in the input file.
        """
        with located("body"):
            body = without_restraints(any_body_of(document.body, inputs))
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
        """Return the assessment of the body with the options of the table."""
        from rocking.decision.assessment import assess
        from rocking.spec.restitution_tables import RestitutionTable

        ground = {"normal_restitution", "normal_restitution_law"}
        options = {name: value for name, value in self.options.items() if name not in ground}
        if refused := sorted(set(self.options) - set(options)):
            raise InvalidValueError(
                "An assessment does not accept {parameter}. Remove it.",
                parameter=f"settings.{refused[0]}",
            )  # fmt: skip
        predicted, restitutions = options.pop("restitution", None), table.restitutions
        if restitutions is not None:
            restitutions = [
                next(iter(restitutions_of(RestitutionTable(model=restitution), 0, [self.body], inputs).values()))
                if isinstance(restitution, str) and restitution != "calibrated"
                else restitution
                for restitution in restitutions
            ]
        if predicted is None and restitutions is not None and len(restitutions) == 1:
            predicted = MEASURED if restitutions[0] == "calibrated" else restitutions[0]
        return assess(
            self.body, self.motions, restitutions, predicted=predicted, margin=table.margin, threads=threads,
            progress=progress, **options,
        )  # fmt: skip

    def answer(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Prediction:
        return predict(self.body, self.motions, **self.options, threads=threads, progress=progress)


def options_of(document: "PredictedBody", body: Body | Solid, inputs: InputFiles) -> dict[str, Any]:
    """Return the keywords of `predict` from an input file."""
    from rocking.spec.restitution_tables import RestitutionTable

    ground = document.settings.model_dump(exclude_none=True, exclude={"engine"})
    options = {**document.predict.model_dump(exclude_none=True), **ground}
    if "pga" in options:
        from rocking.decision.inventory.hazard import IntensityLevel

        options["pga"] = IntensityLevel.of("PGA", options["pga"]).value
    if "axis" in options:
        options["azimuth"] = _azimuth(body, options.pop("axis"), document.predict.azimuth)
    error = options.get("model_error")
    if isinstance(error, str) and error != OFF and not is_class(error):
        options["model_error"] = str(inputs.file(error))
    model = options.get("restitution")
    if isinstance(model, str) and model not in {*MEASURED, COMPLEMENTARITY}:
        table = RestitutionTable(model=model)
        options["restitution"] = next(iter(restitutions_of(table, 0, [body], inputs).values()))
    return options


def _azimuth(body: Body | Solid, axis: Any, azimuth: Any) -> float:
    """Return the azimuth [rad] that turns an axis of the body file into the x component of the motion."""
    if azimuth is not None:
        raise InvalidValueError("Use predict.axis or predict.azimuth, not both.")
    turn = getattr(body, "turn", None)  # from the axes of a scan file
    if turn is None:
        raise InvalidValueError("{parameter} applies to scans only; use predict.azimuth", parameter="predict.axis")
    x, y, z = (turn @ np.array(axis, dtype=np.float64)).tolist()
    if not math.hypot(x, y) > abs(z):
        raise InvalidValueError(
            "{parameter} must be a horizontal direction of the upright body, got {value}", parameter="predict.axis",
            value=axis, hint="use the axes of the scan file",
        )  # fmt: skip
    return -math.atan2(y, x)
