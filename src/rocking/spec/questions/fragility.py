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

ANALYSES = ("fragility", "fragility-points", "fema-p58")  # exports of the curves of one restitution
MEASURES = "ims"  # export of the ranking of intensity measures

_DEFAULT_COLUMNS = ("magnitude", "ln distance_km")  # metadata for a sufficiency test, if all motions have them
_LOGARITHM = "ln "
_OF_ONE_KIND = {
    "export.columns": "cloud",
    "export.ims": "cloud",
    "fragility.scale": "cloud",
    "fragility.tolerance": "incremental",
}

_MEASURES = "measures of the page Names of values"


class ExportTable(JobTable):
    """Treatment of crossing curves, confidence intervals, and comparison of intensity measures."""

    crossing_curves: Literal["keep-uplift", "common-dispersion", "refuse"] = key(
        "treatment of crossing fragility curves", "keep-uplift"
    )
    bootstrap: Annotated[int, Field(ge=99, le=100_000)] | Literal[0] = key("number of bootstrap samples", 0)
    ims: Annotated[list[Text], Field(min_length=1)] | None = key(
        "intensity measures of the comparison", usual="default measures, and im", allowed=_MEASURES
    )
    columns: list[Text] | None = key(
        "metadata columns for the sufficiency test of the comparison", usual="magnitude, ln distance_km where stated",
        allowed="names of metadata of the records, or ln NAME",
    )  # fmt: skip


State = Annotated[str, Field(pattern="^(rocking|overturning|(yield|rupture)( of .+)?)$")]


def _one_state(value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
    """Return a limit state. Raise a single error for an invalid value, not one error per allowed type."""
    try:
        return validate(value)
    except ValidationError as error:
        if isinstance(value, str):
            raise InvalidValueError(
                "must be rocking, overturning, yield, rupture, yield of NAME, rupture of NAME, or a rotation / "
                "slenderness angle, got {entry!r:.60}", entry=value,
            ) from error  # fmt: skip
        raise PydanticKnownError("greater_than", {"gt": 0}) from error


class FragilityTable(JobTable):
    """Intensity measure, intensity levels and limit states of a fragility analysis."""

    im: Text = key("intensity measure: pga, pgv, arias, sa(0.5) and more", "pga", allowed=_MEASURES)
    levels: Numbers | None = key(
        "intensity levels in the unit of im", usual="required; not allowed for kind = cloud",
        unit="unit of im", allowed="increasing numbers > 0",
    )  # fmt: skip
    limit_states: list[Annotated[Positive | State, WrapValidator(_one_state)]] = key(
        "limit states besides rocking and overturning: rotation / slenderness angle, yield, rupture",
        [0.5], allowed="numbers > 0, rocking, overturning, yield, rupture, yield of NAME, rupture of NAME",
    )  # fmt: skip
    tolerance: float | None = key(
        "relative width of the last intervals: width / level [-]", None, usual="1e-8", ge=0.0, le=0.1
    )
    scale: Positive | None = key("cloud analysis: scale factor [-]", usual="1")


class AnalysisQuestion(BodyQuestion):
    """A fragility analysis of one body."""

    needs_motions: ClassVar[bool] = True
    with_restraints: ClassVar[bool] = True
    of_files: ClassVar[dict[str, set[str]]] = {"export": {"bootstrap", "ims", "columns"}}

    fragility: FragilityTable = Field(default_factory=FragilityTable)
    export: ExportTable = Field(default_factory=ExportTable)

    @model_validator(mode="after")
    def _keys_of_its_kind(self) -> "AnalysisQuestion":
        if (self.fragility.levels is None) != (self.kind == "cloud"):
            extra = "{parameter} is not allowed: a cloud analysis uses the motions as recorded."
            text = "{parameter} is missing" if self.fragility.levels is None else extra
            raise InvalidValueError(text, parameter="fragility.levels")
        for path, kind in _OF_ONE_KIND.items():
            table, _, name = path.partition(".")
            if getattr(getattr(self, table), name) is not None and kind != self.kind:
                raise InvalidValueError(
                    '{parameter} is allowed with kind = "{expected}" only, got "{kind}".',
                    parameter=path, expected=kind, kind=self.kind,
                )  # fmt: skip
        return self

    @property
    def levels(self) -> FloatArray | None:
        """Intensity levels, in the unit of the intensity measure."""
        return None if self.fragility.levels is None else self.fragility.levels.numbers()

    @property
    def sizes(self) -> list[int]:
        """Numbers of motions, restitutions and levels."""
        return [*super().sizes, 1 if self.fragility.levels is None else self.fragility.levels.size]

    @property
    def elements(self) -> dict[str, int]:
        """Number of limit states."""
        return {"states": len(self.fragility.limit_states)}

    def analysis(
        self, problem: "StudyProblem", restitution: Any, motions: "MotionSet | None" = None
    ) -> "FragilityQuestion":
        """Return the analysis with one restitution. `motions` replaces the motions of the problem."""
        from rocking.studies.fragility.question import FragilityQuestion
        from rocking.studies.fragility.subject import Subject

        table, shaken = self.fragility, problem.motions if motions is None else motions
        return FragilityQuestion.of(
            Subject.of(problem.bodies[0], shaken, restitution, table.im, problem.options),
            self.kind, self.levels, tuple(table.limit_states), scale=table.scale, tolerance=table.tolerance,
        )  # fmt: skip

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the analysis. For stripes with several restitutions, return the comparison of the restitutions."""
        motions, body = problem.kept_motions, problem.only("bodies")  # computed once for all levels
        if len(problem.restitutions) == 1 or self.one_restitution:
            return self.analysis(problem, problem.only("restitutions"), motions).computed(threads, progress)
        from rocking.studies.sensitivity import fragility_sensitivity

        options = {**problem.stated, "threads": threads, "progress": progress}
        options |= {"im": self.fragility.im, "limit_states": tuple(self.fragility.limit_states)}
        return fragility_sensitivity(body, motions, self.levels, problem.restitutions, **options)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, level (except in clouds) and restitution (if several)."""
        from rocking.studies.sensitivity.restitutions import sampled
        from rocking.studies.study_plan import Study, along, labels_along, motions_along
        from rocking.tables import Column

        with located("fragility"):
            questions = {label: self.analysis(problem, analysis) for label, analysis in problem.restitutions.items()}
            # the products differ only in the data of the sides
            products = [question.histories for question in questions.values()]
            sides = {n: np.concatenate([analysis.sides[n] for analysis in products], axis=1) for n in products[0].sides}
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
            """Return the analysis of each restitution with its results."""
            return {
                label: analysis.answer({name: values[k :: len(questions)] for name, values in results.items()})
                for k, (label, analysis) in enumerate(questions.items())
            }

        return Study(sampled(merged), dims, coordinates, attributes, ("histories", *ANALYSES), finish)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of the exported curves."""
        from rocking.plots.fragility import fragility_picture
        from rocking.studies.fragility.curves import shown_curves

        analysis = finished.analysis(restitution)
        return fragility_picture(analysis, curves=shown_curves(analysis, self.export.crossing_curves))


class StripesQuestion(AnalysisQuestion):
    """Fragility of one body with every motion at every level."""

    kind: ClassVar[str] = "stripes"


class IncrementalQuestion(AnalysisQuestion):
    """Fragility of one body from all levels at which a motion begins or ceases to overturn it."""

    kind: ClassVar[str] = "incremental"
    one_restitution: ClassVar[bool] = True

    def analysis(
        self, problem: "StudyProblem", restitution: Any, motions: "MotionSet | None" = None
    ) -> "FragilityQuestion":
        """Return the analysis with one restitution. `motions` replaces the motions of the problem."""
        # [fragility] contains the tolerance of the search; [settings] contains the tolerance of the engine
        if "tolerance" in self.settings.stated():
            raise InvalidValueError("settings.tolerance is not allowed in an incremental analysis. Remove it.")
        return super().analysis(problem, restitution, motions)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of the levels of every motion."""
        from rocking.plots.fragility import incremental_dynamic_analysis_picture

        return incremental_dynamic_analysis_picture(finished.analysis(restitution))


class CloudQuestion(AnalysisQuestion):
    """Fragility of one body with the motions as recorded."""

    kind: ClassVar[str] = "cloud"
    one_restitution: ClassVar[bool] = True

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion and restitution (if several)."""
        from rocking.studies.motion_sets import MotionList

        study = super().study(problem)
        with located("export"):
            self.ims()
            if self.export.columns:
                self.columns(MotionList(problem.motions[0]))  # only the first motion is checked here
        return replace(study, exports=(*study.exports, MEASURES))

    def ims(self) -> list[str]:
        """Return the compared intensity measures: those in [export], or the default measures and `im`."""
        from rocking.motions.intensity import measure
        from rocking.studies.fragility.measure_comparison import DEFAULT_MEASURES

        named = self.export.ims
        names = [measure(name).name for name in named or [*DEFAULT_MEASURES, self.fragility.im]]
        duplicates = [name for name in names if names.count(name) > 1]
        if named is not None and duplicates:
            raise InvalidValueError("{name} appears twice in ims. Remove one.", parameter="ims", name=duplicates[0])
        return list(dict.fromkeys(names))

    def columns(self, motions: "MotionSet") -> dict[str, FloatArray]:
        """Return metadata of the motions as numbers: the columns in [export], or the default columns that exist.

        A name that begins with ``ln`` is the logarithm of the named column.
        """
        named = self.export.columns
        requested = _DEFAULT_COLUMNS if named is None else named
        columns: dict[str, list[float]] = {name: [] for name in requested}
        if len(columns) < len(requested):
            raise InvalidValueError(
                "A column appears twice in {names}. Remove one.", parameter="columns", names=", ".join(requested)
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
                            "{value} must be a number in the metadata of every motion, {reason} for motion {index}, "
                            "{motion!r:.60}. Its metadata: {names}.", parameter="columns", value=name,
                            reason=str(error), index=k, motion=motion.name, names=", ".join(metadata) or "none",
                        ) from error  # fmt: skip
                    del columns[name]
            if not columns:
                break
        return {name: np.array(values) for name, values in columns.items()}


def _number(name: str, metadata: Any) -> float:
    """Return a number of the metadata, or its logarithm. If there is no number, raise ValueError with the reason."""
    key = name.removeprefix(_LOGARITHM)
    if key not in metadata:
        raise ValueError("got no value")
    try:
        value = float(metadata[key])
    except ValueError as error:
        raise ValueError(f"got {metadata[key]!r:.40}") from error
    if not math.isfinite(value) or (name != key and value <= 0.0):
        raise ValueError(f"got {value:g}")
    return math.log(value) if name != key else value
