"""Fragility analyses of one body: stripes, incremental and cloud."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, ValidationError, ValidatorFunctionWrapHandler, WrapValidator, model_validator
from pydantic_core import PydanticKnownError

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Numbers, Positive, Text, key
from rocking.spec.question import BodyQuestion, Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.fragility.question import FragilityQuestion
    from rocking.studies.motion_sets import MotionSet
    from rocking.studies.study_plan import Study

ANALYSES = ("fragility", "fragility-points", "fema-p58")  # what can be exported of the curves of one restitution
MEASURES = "ims"  # what the ranking of intensity measures is called among the exports

_USUAL_COLUMNS = ("magnitude", "ln distance_km")  # metadata of a sufficiency test, where all motions have them
_LOGARITHM = "ln "
_OF_ONE_KIND = {
    "export.columns": "cloud",
    "export.ims": "cloud",
    "fragility.scale": "cloud",
    "fragility.tolerance": "incremental",
}


class ExportTable(JobTable):
    """How files are written, how often a study is repeated for intervals, and which measures are compared."""

    crossing_curves: Literal["keep-uplift", "common-dispersion", "refuse"] = key(
        "treatment of curves that cross", "keep-uplift"
    )
    bootstrap: Annotated[int, Field(ge=99, le=100_000)] | Literal[0] = key("how often a study is repeated", 0)
    ims: Annotated[list[Text], Field(min_length=1)] | None = key("intensity measures that are compared")
    columns: list[Text] | None = key("columns of the comparison")


def _one_state(value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
    """Return a limit state; what is none has one error, whatever the kinds of states are."""
    try:
        return validate(value)
    except ValidationError as error:
        if isinstance(value, str):
            raise InvalidValueError(
                "must be a rotation over the slenderness angle, rocking or overturning, got {entry!r:.60}", entry=value
            ) from error
        raise PydanticKnownError("greater_than", {"gt": 0}) from error


class FragilityTable(JobTable):
    """Measure, levels and limit states of a fragility analysis."""

    im: Text = key("intensity measure: pga, pgv, arias, sa(0.5) and more", "pga")
    levels: Numbers | None = key("levels of the measure [its unit]")
    limit_states: list[Annotated[Positive | Literal["rocking", "overturning"], WrapValidator(_one_state)]] = key(
        "limit states: rotation / slenderness angle [-]; rocking and overturning are added unless one of them is given",
        [0.5],
    )
    tolerance: float | None = key("width of the last brackets over the level [-]", None, ge=0.0, le=0.1)
    scale: Positive | None = key("scale factor of all motions of a cloud [-]")


class AnalysisQuestion(BodyQuestion):
    """A fragility analysis of one body."""

    needs_motions: ClassVar[bool] = True
    of_files: ClassVar[dict[str, set[str]]] = {"export": {"bootstrap", "ims", "columns"}}

    fragility: FragilityTable = Field(default_factory=FragilityTable)
    export: ExportTable = Field(default_factory=ExportTable)

    @model_validator(mode="after")
    def _keys_of_its_kind(self) -> "AnalysisQuestion":
        if (self.fragility.levels is None) != (self.kind == "cloud"):
            senseless = "{parameter} makes no sense: a cloud takes the motions as they are"
            text = "{parameter} is missing" if self.fragility.levels is None else senseless
            raise InvalidValueError(text, parameter="fragility.levels")
        for path, kind in _OF_ONE_KIND.items():
            table, _, name = path.partition(".")
            if getattr(getattr(self, table), name) is not None and kind != self.kind:
                raise InvalidValueError(
                    '{parameter} goes with kind = "{expected}" only, this is "{kind}"', parameter=path, expected=kind,
                    kind=self.kind,
                )  # fmt: skip
        return self

    @property
    def levels(self) -> FloatArray | None:
        """Levels of the measure."""
        return None if self.fragility.levels is None else self.fragility.levels.numbers()

    @property
    def sizes(self) -> list[int]:
        """Motions, restitutions and levels."""
        return [*super().sizes, 1 if self.fragility.levels is None else self.fragility.levels.size]

    @property
    def elements(self) -> dict[str, int]:
        """Limit states."""
        return {"states": len(self.fragility.limit_states)}

    def analysis(
        self, problem: "StudyProblem", restitution: Any, motions: "MotionSet | None" = None
    ) -> "FragilityQuestion":
        """Return the analysis with one restitution; motions: the same ones, kept in memory."""
        from rocking.studies.fragility.question import FragilityQuestion
        from rocking.studies.fragility.subject import Subject

        table, shaken = self.fragility, problem.motions if motions is None else motions
        return FragilityQuestion.of(
            Subject.of(problem.bodies[0], shaken, restitution, table.im, problem.options),
            self.kind, self.levels, tuple(table.limit_states), scale=table.scale, tolerance=table.tolerance,
        )  # fmt: skip

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the analysis; stripes with several restitutions are compared."""
        motions, body = problem.kept_motions, problem.only("bodies")  # made once, for every level
        if len(problem.restitutions) == 1 or self.one_restitution:
            return self.analysis(problem, problem.only("restitutions"), motions).computed(threads, progress)
        from rocking.studies.sensitivity import fragility_sensitivity

        options = {**problem.stated, "threads": threads, "progress": progress}
        options |= {"im": self.fragility.im, "limit_states": tuple(self.fragility.limit_states)}
        return fragility_sensitivity(body, motions, self.levels, problem.restitutions, **options)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, level save in clouds, and several restitutions."""
        from rocking.studies.sensitivity.restitutions import sampled
        from rocking.studies.study_plan import Study, along, labels_along, motions_along
        from rocking.tables import Column

        with located("fragility"):
            questions = {label: self.analysis(problem, each) for label, each in problem.restitutions.items()}
            products = [question.histories for question in questions.values()]  # the same but for their sides
            sides = {n: np.concatenate([each.sides[n] for each in products], axis=1) for n in products[0].sides}
            merged = replace(products[0], sides=sides)
        question = next(iter(questions.values()))
        label, levels = question.subject.label, question.levels
        dims, coordinates = {"motion": len(problem.motions)}, {"motion": motions_along(problem.motions)}
        along_levels = ("intensity", "motion") if self.kind == "cloud" else ("level", "level")
        coordinates[along_levels[0]] = along(along_levels[1], levels, label["units"], label["long_name"])
        if self.kind != "cloud":
            dims["level"] = levels.size
            scales = np.broadcast_to(merged.scales, (len(problem.motions), levels.size))
            coordinates["scale"] = Column(scales, "1", "scale factor of the motion", dims=("motion", "level"))
        if len(questions) > 1:
            dims["restitution"] = len(questions)
            coordinates["restitution"] = labels_along("restitution", questions, "restitution")
        attributes = {
            f"subject_{name}": value for name, value in question.subject.about().items() if name != "software"
        }

        def finish(results: dict[str, Any]) -> dict[str, Any]:
            """Hand every analysis its own of the results of all."""
            return {
                label: each.answer({name: values[k :: len(questions)] for name, values in results.items()})
                for k, (label, each) in enumerate(questions.items())
            }

        return Study(sampled(merged), dims, coordinates, attributes, ("histories", *ANALYSES), finish)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Draw the curves that are exported."""
        from rocking.plots.fragility import fragility_picture
        from rocking.studies.fragility.curves import shown_curves

        analysis = finished.analysis(restitution)
        return fragility_picture(analysis, curves=shown_curves(analysis, self.export.crossing_curves))


class StripesQuestion(AnalysisQuestion):
    """The fragility of one body: every motion at every level."""

    kind: ClassVar[str] = "stripes"


class IncrementalQuestion(AnalysisQuestion):
    """The fragility of one body: every level at which a motion begins or ceases to overturn it."""

    kind: ClassVar[str] = "incremental"
    one_restitution: ClassVar[bool] = True

    def analysis(
        self, problem: "StudyProblem", restitution: Any, motions: "MotionSet | None" = None
    ) -> "FragilityQuestion":
        """Return the analysis with one restitution; motions: the same ones, kept in memory."""
        # the tolerance of [fragility] is the search's; that of [settings] is the engine's
        if "tolerance" in self.settings.stated():
            raise InvalidValueError("settings.tolerance cannot be changed in an incremental analysis; leave it out")
        return super().analysis(problem, restitution, motions)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Draw the levels of every motion."""
        from rocking.plots.fragility import incremental_dynamic_analysis_picture

        return incremental_dynamic_analysis_picture(finished.analysis(restitution))


class CloudQuestion(AnalysisQuestion):
    """The fragility of one body: the motions as they are."""

    kind: ClassVar[str] = "cloud"
    one_restitution: ClassVar[bool] = True

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, and several restitutions."""
        from rocking.studies.motion_sets import MotionList

        study = super().study(problem)
        with located("export"):
            self.ims()
            if self.export.columns:
                self.columns(MotionList(problem.motions[0]))  # of the motions only the first is asked
        return replace(study, exports=(*study.exports, MEASURES))

    def ims(self) -> list[str]:
        """Return the measures of intensity that are compared: those of [export], or the usual ones and its own."""
        from rocking.motions.intensity import measure
        from rocking.studies.fragility.measure_comparison import DEFAULT_MEASURES

        named = self.export.ims
        known = [measure(name).name for name in named or [*DEFAULT_MEASURES, self.fragility.im]]
        twice = [name for name in known if known.count(name) > 1]
        if named is not None and twice:
            raise InvalidValueError("ims: {name} is named twice", parameter="ims", name=twice[0])
        return list(dict.fromkeys(known))

    def columns(self, motions: "MotionSet") -> dict[str, FloatArray]:
        """Return numbers in the metadata of the motions: the columns of [export], or the usual ones there are.

        A name that begins with ``ln`` is the logarithm of what follows.
        """
        named = self.export.columns
        wanted = _USUAL_COLUMNS if named is None else named
        columns: dict[str, list[float]] = {name: [] for name in wanted}
        if len(columns) < len(wanted):
            raise InvalidValueError(
                "columns: one of {names} is named twice", parameter="columns", names=", ".join(wanted)
            )
        for k in range(len(motions)):
            motion = motions[k]
            metadata = getattr(motion, "metadata", {})
            for name in list(columns):
                try:
                    columns[name].append(_number(name, metadata))
                except ValueError as error:
                    if named is not None:
                        raise InvalidValueError(
                            "columns: {value} must be a number of every motion, {reason} of motion {index}, "
                            "{motion!r:.60}, which knows {names}", parameter="columns", value=name, reason=str(error),
                            index=k, motion=motion.name, names=", ".join(metadata) or "nothing",
                        ) from error  # fmt: skip
                    del columns[name]
            if not columns:
                break
        return {name: np.array(values) for name, values in columns.items()}


def _number(name: str, metadata: Any) -> float:
    """Return a number of the metadata, or its logarithm; a ValueError says why there is none."""
    key = name.removeprefix(_LOGARITHM)
    if key not in metadata:
        raise ValueError("there is none")
    try:
        value = float(metadata[key])
    except ValueError as error:
        raise ValueError(f"got {metadata[key]!r:.40}") from error
    if not math.isfinite(value) or (name != key and value <= 0.0):
        raise ValueError(f"got {value:g}")
    return math.log(value) if name != key else value
