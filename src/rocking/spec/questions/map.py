"""Overturning maps: the outcomes of one body under one motion over two parameters."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import model_validator

from rocking.errors import InvalidValueError, located
from rocking.messages import Parameter
from rocking.spec.fields import JobTable, Text, Values, key
from rocking.spec.question import BodyQuestion, Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.axis import Axis
    from rocking.studies.study_plan import Study


class AxisTable(Values):
    """An axis of a map."""

    axis: Text = key(
        "quantity on the axis: frequency_ratio, pga, semi_diagonal and more", ..., allowed="an axis of a map"
    )


_INCREASING = "a quantity of the page Names of values, and increasing values"


class MapTable(JobTable):
    """The two axes of a map, and the refinement of its boundaries."""

    x: AxisTable = key("horizontal axis: quantity, and values in SI units", ..., unit="SI", allowed=_INCREASING)
    y: AxisTable = key("vertical axis: quantity, and values in SI units", ..., unit="SI", allowed=_INCREASING)
    refine: int | None = key(
        "number of refinements along boundaries, each halves the spacing", None, usual="no refinement", ge=0, le=12
    )
    boundary: Literal["verdict", "mode"] = key("boundaries of overturning only, or of all modes", "verdict")
    tolerance: float = key("relative width of the last intervals of the bisection [-]", 1e-10, ge=1e-15, le=0.1)

    @model_validator(mode="after")
    def _refined(self) -> "MapTable":
        odd = sorted({"boundary", "tolerance"} & self.model_fields_set)
        if odd and self.refine is None:
            raise InvalidValueError(
                "{keys} requires the key refine. Add refine, the number of refinements along boundaries.",
                keys=" and ".join(odd),
            )
        return self


class MapQuestion(BodyQuestion):
    """The outcomes of one body under one motion over two parameters."""

    kind: ClassVar[str] = "overturning-map"
    with_restraints: ClassVar[bool] = True
    of_files: ClassVar[dict[str, set[str]]] = {"map": {"boundary", "tolerance"}}

    map: MapTable

    @property
    def axes(self) -> "tuple[Axis, ...]":
        """Axes x and y."""
        from rocking.studies.axis import axis_of

        axes = []
        for name, table in (("x", self.map.x), ("y", self.map.y)):
            with located(f"map.{name}"):
                axes.append(axis_of((table.axis, table.numbers())))
        return tuple(axes)

    @property
    def is_adaptive(self) -> bool:
        """True if the map is refined."""
        return self.map.refine is not None

    @property
    def sizes(self) -> list[int]:
        """Numbers of points along x and y, and of restitutions."""
        return [self.map.x.size, self.map.y.size, self.choices]

    @property
    def later_histories(self) -> int:
        """Estimated number of histories along the boundaries."""
        refine = self.map.refine or 0
        return 4 * (self.map.x.size + self.map.y.size) * 2**refine * self.choices if refine else 0

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the map as `MapArrays`. With several restitutions, return their comparison."""
        from rocking.studies._overturning_map import map_arrays

        options = {**problem.stated, "threads": threads, "progress": progress}
        x, y = self.axes
        subject = (problem.only("bodies"), problem.only("motions"), x, y)
        if len(problem.restitutions) == 1:
            return map_arrays(*subject, problem.restitution, refine=self.map.refine, **options)
        if self.map.refine is not None:
            refine = Parameter("map.refine", "map.refine")
            raise InvalidValueError("{refine} accepts one restitution model.", refine=refine)
        from rocking.studies.sensitivity import map_sensitivity

        return map_sensitivity(*subject, problem.restitutions, **options)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over restitution (if several), y and x."""
        from rocking.studies.adaptive_grid import Plane
        from rocking.studies.map_rounds import MapHistories, MapSearch
        from rocking.studies.question import Question
        from rocking.studies.sensitivity.restitutions import sampled
        from rocking.studies.study_plan import Study, along, labels_along

        if len(problem.motions) != 1:
            raise InvalidValueError(
                "A map accepts one motion, got {count}.", parameter="motions", count=len(problem.motions)
            )
        subject, (x, y) = (problem.bodies[0], problem.motions[0]), self.axes
        with located("map"):
            questions = [
                Question(*subject, restitution, problem.settings, None, self.settings.engine)
                for restitution in problem.restitutions.values()
            ]
            if len(questions) > 1 and "restitution" in {x.name, y.name}:
                raise InvalidValueError(
                    "restitution cannot be an axis in a comparison of restitutions; leave one model"
                )
            planes = [Plane(question, x, y) for question in questions]
            histories = MapHistories.of(planes)
        several = {"restitution": len(planes)} if len(planes) > 1 else {}
        # attributes as in `overturning_map`, without the engine (in the provenance) and the restitutions (a dimension)
        attributes = {k: v for k, v in planes[0].attributes({}).items() if k not in {"software", "engine", *several}}
        coordinates = {axis.name: along(axis.name, axis.values, axis.unit, axis.meaning) for axis in (y, x)}
        if several:
            coordinates["restitution"] = labels_along("restitution", problem.restitutions, "restitution")
        dims = several | {y.name: y.values.size, x.name: x.values.size}
        study = Study(sampled(histories), dims, coordinates, attributes, rescale=histories.rescaled)
        if self.map.refine is None:
            return study
        search = MapSearch.of(study, planes, self.map.refine, self.map.boundary, self.map.tolerance)
        return replace(study, search=search, exports=("histories", "refined", "boundary"))

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of the map. If the map is refined, the figure shows the boundaries."""
        from rocking.plots.overturning_map import overturning_map_picture

        lines = finished.answer.value[1] if self.is_adaptive else ()
        return overturning_map_picture(finished.dataset(restitution), lines)
