"""Long-run dynamics under harmonic ground motion: bifurcation diagrams, periodic orbits, exponents, basins."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Numbers, Positive, Values, in_list, key
from rocking.spec.motion_tables import MotionTable
from rocking.spec.question import BodyQuestion

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.longrun.study import Task
    from rocking.studies.longrun.system import HarmonicRocking
    from rocking.studies.study_plan import Study

Sweep = Literal["none", "up", "down"]


def _words(stated: Any) -> Any:
    return stated.split(",") if isinstance(stated, str) else stated


class LongRunTable(JobTable):
    """The options of a task for each restitution."""

    def task(self, seed: int) -> "Task":
        """Return the task of the table, with a seed of its random states."""
        raise NotImplementedError


class HarmonicTable(LongRunTable):
    """Harmonic ground motion."""

    amplitude: Positive = key("peak ground acceleration / uplift acceleration g tan alpha [-]", 1.5)
    frequency: Positive = key("circular frequency of the ground motion / p [-]", 3.0)


class BifurcationTable(HarmonicTable):
    """Bifurcation diagram: ground motion, axis, initial states and numbers of periods."""

    axis: Literal["amplitude", "frequency", "slenderness", "size", "restitution"] = key(
        "axis: amplitude or frequency ratio, slenderness h/b, semi-diagonal or coefficient of restitution", "amplitude"
    )
    values: Numbers = Field(
        default_factory=lambda: Values.model_validate({"from": 0.2, "to": 4.0, "count": 191}),
        description="increasing values of the axis",
        json_schema_extra={"usual": "0.2 to 4", "allowed": "increasing numbers > 0"},
    )
    starts: int = key("number of initial states: one at rest, others random", 4, ge=1, le=10_000)
    sweeps: Annotated[list[Sweep], Field(min_length=1, max_length=3), BeforeValidator(_words)] = key(
        "sweeps with memory: none, up, down", ["none"]
    )
    settled: int = key("periods before the stored periods", 300, ge=0, le=1_000_000)
    kept: int = key("number of stored periods", 128, ge=1, le=100_000)
    exponents: bool = key("largest Lyapunov exponents", True)

    @model_validator(mode="after")
    def _increase(self) -> "BifurcationTable":
        if np.any(np.diff(self.values.numbers()) <= 0.0):
            raise InvalidValueError("{parameter} must increase from value to value", parameter="values")
        return self

    def task(self, seed: int) -> "Task":
        """Return the diagram."""
        from rocking.studies.longrun.study import Diagram, random_states

        states, cycles = random_states(self.starts, seed), (self.settled, self.kept)
        return Diagram(self.axis, self.values.numbers(), states, tuple(self.sweeps), cycles, self.exponents)


class LyapunovTable(HarmonicTable):
    """Lyapunov exponents: ground motion, orbits and numbers of periods."""

    orbits: int = key("number of orbits with random initial states", 64, ge=1, le=100_000)
    settled: int = key("number of periods before the growth is counted", 500, ge=60, le=1_000_000)
    kept: int = key("number of periods with counted growth", 1000, ge=1, le=10_000_000)

    def task(self, seed: int) -> "Task":
        """Return the orbits."""
        from rocking.studies.longrun.study import Exponents

        return Exponents(self.orbits, self.settled, self.kept, seed)


class BasinsTable(LongRunTable):
    """Basins of overturning: ground motion, initial states after an impact, number of impacts."""

    amplitudes: Numbers = Field(
        default_factory=lambda: Values(values=[1.5]),
        description="peak ground acceleration / uplift acceleration [-]",
        json_schema_extra={"usual": "1.5", "allowed": "numbers > 0"},
    )
    frequency: Positive = key("circular frequency of the ground motion / p [-]", 3.0)
    phases: int = key("number of phases of the ground motion at the impact", 100, ge=1, le=20_000)
    speeds: int = key("number of speeds after the impact; 0 for a start at rest", 100, ge=0, le=20_000)
    highest: Positive = key("upper end of the speeds / (alpha p) [-]", 2.0)
    impacts: int = key("number of impacts", 120, ge=1, le=1_000_000)
    small: float = key("speed / (alpha p) below which a motion counts as small [-]", 0.02, ge=0.0, le=1.0)
    check: bool = key("repeat with 30 times the step error, to detect uncertain states", True)

    def task(self, seed: int) -> "Task":
        """Return the cells."""
        from rocking.studies.longrun.basins import cells
        from rocking.studies.longrun.study import Cells

        grid = cells(self.phases, self.speeds, self.highest)
        return Cells(self.amplitudes.numbers(), *grid, self.impacts, self.small, self.check)


class OrbitsTable(HarmonicTable):
    """Periodic orbits: ground motion of the first orbit, parameter of the branches and its limits."""

    axis: Literal["amplitude", "frequency", "restitution"] = key("parameter of the branches", "amplitude")
    lowest: Positive = key("lower limit of the parameter [-]", 0.01)
    highest: Positive = key("upper limit of the parameter [-]", 10.0)
    doublings: int = key("number of branches that branch off in turn: pitchfork, then period doublings", 2, ge=0, le=8)
    points: int = key("number of orbits of each branch in files and pictures", 400, ge=16, le=100_000)

    def task(self, seed: int) -> "Task":
        """Return the branches."""
        from rocking.studies.longrun.study import Branches

        return Branches(self.axis, (self.lowest, self.highest), self.doublings, self.points)


class LongRunQuestion(BodyQuestion):
    """A study of one plane body under harmonic ground motion."""

    motions: Annotated[list[MotionTable], Field(max_length=0), BeforeValidator(in_list)] = Field(default_factory=list)

    def task(self) -> "Task":
        """Return the task for each restitution."""
        task: Task = self.own.task(self.campaign.seed)
        return task

    @property
    def own(self) -> Any:
        """The table of this study."""
        return getattr(self, self.own_table())

    @property
    def sizes(self) -> list[int]:
        """Restitutions, and length of each dimension."""
        return [self.choices, *self.task().shape]

    def systems(self, problem: "StudyProblem") -> "dict[str, HarmonicRocking]":
        """Return body and ground motion with each restitution."""
        from rocking.dynamics.plane.settings import PlaneSettings
        from rocking.studies.longrun import HarmonicRocking

        settings, (body,) = problem.settings, problem.bodies
        if not isinstance(settings, PlaneSettings):
            raise InvalidValueError("long-run dynamics needs a plane body without friction")
        ratios = (getattr(self.own, "amplitude", 1.0), self.own.frequency)
        options = {"linear": settings.linear, "gravity": settings.gravity}
        with located("restitution"):
            return {
                label: HarmonicRocking.of_ratios(body, *ratios, restitution=law, **options)
                for label, law in problem.restitutions.items()
            }

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over restitution and the dimensions of the task."""
        from rocking.studies.longrun.study import long_run_study

        with located(self.own_table()):
            return long_run_study(self.systems(problem), self.task())

    def findings(self, problem: "StudyProblem", dataset: "xr.Dataset") -> list[dict[str, Any]]:
        """Return the summary of each restitution, as values by the names of quantities."""
        task, rows = self.task(), []
        for k, (label, system) in enumerate(self.systems(problem).items()):
            one = dataset.isel(restitution=k) if "restitution" in dataset.dims else dataset
            rows += [{"restitution": label, **row} for row in task.findings(system, one)]
        return rows

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Draw one panel per restitution."""
        from rocking.plots import long_run

        labels = [restitution] if restitution else list(finished.problem.restitutions)
        picture = getattr(long_run, f"{self.kind}_picture")
        figure: Figure = picture({label: finished.dataset(label) for label in labels})
        return figure


class BifurcationQuestion(LongRunQuestion):
    """Attractors of a body under harmonic ground motion over one parameter."""

    kind: ClassVar[str] = "bifurcation"

    bifurcation: BifurcationTable = Field(default_factory=BifurcationTable)


class LyapunovQuestion(LongRunQuestion):
    """Lyapunov exponents of a body under harmonic ground motion."""

    kind: ClassVar[str] = "lyapunov"

    lyapunov: LyapunovTable = Field(default_factory=LyapunovTable)


class BasinsQuestion(LongRunQuestion):
    """Basins of overturning of a body under harmonic ground motion, and their erosion."""

    kind: ClassVar[str] = "basins"

    basins: BasinsTable = Field(default_factory=BasinsTable)


class OrbitsQuestion(LongRunQuestion):
    """Branches of periodic orbits of a body under harmonic ground motion, and their bifurcations."""

    kind: ClassVar[str] = "orbits"

    orbits: OrbitsTable = Field(default_factory=OrbitsTable)
