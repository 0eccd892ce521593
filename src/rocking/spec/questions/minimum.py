"""Minimum accelerations: all accelerations at which bodies begin or cease to overturn."""

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic import Field

from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Positive, key
from rocking.spec.question import BodyQuestion, Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.study_plan import Study


class MinimumTable(JobTable):
    """Range and precision of the search for accelerations at which a body begins or ceases to overturn."""

    min_pga: Positive | None = key("smallest PGA [m/s2]", usual="uplift acceleration")
    max_pga: Positive | None = key("largest PGA [m/s2]", usual="50 x uplift acceleration")
    samples: int = key("number of initial samples, with a constant ratio", 400, ge=2, le=1_000_000)
    bisections: int = key("number of bisections of intervals that may contain a further change", 4, ge=0, le=12)
    tolerance: float = key("relative width of the last intervals: width / acceleration [-]", 1e-12, ge=0.0, le=0.1)


class MinimumQuestion(BodyQuestion):
    """All accelerations at which bodies begin or cease to overturn under motions."""

    kind: ClassVar[str] = "minimum-acceleration"
    with_restraints: ClassVar[bool] = True
    several_bodies: ClassVar[bool] = True
    needs_motions: ClassVar[bool] = True

    minimum: MinimumTable = Field(default_factory=MinimumTable)

    @property
    def is_adaptive(self) -> bool:
        """True."""
        return True

    @property
    def sizes(self) -> list[int]:
        """Numbers of motions, bodies, restitutions and initial samples."""
        return [*super().sizes, self.minimum.samples]

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the `Transitions` of one body under one motion."""
        from rocking.studies import minimum_overturning_acceleration

        subject = (problem.only("bodies"), problem.only("motions"), problem.only("restitutions"))
        options = {**problem.stated, "threads": threads, "progress": progress, **vars(self.minimum)}
        return minimum_overturning_acceleration(*subject, **options)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study with its initial samples, over motion, restitution, body and point."""
        from rocking.dynamics.mechanics import mechanics_of
        from rocking.dynamics.parameters import sides_of
        from rocking.spec.construction import MOST_IN_MEMORY
        from rocking.studies.minimum_acceleration import Cases, Effort
        from rocking.studies.minimum_rounds import MinimumSearch
        from rocking.studies.study_plan import Study, along, first_round, labels_along
        from rocking.tables import Column

        table, settings = self.minimum, problem.settings
        if len(problem.motions) > MOST_IN_MEMORY:
            raise InvalidValueError(
                "At most {limit} motions are allowed, got {count}.", parameter="motions", limit=MOST_IN_MEMORY,
                count=len(problem.motions),
            )  # fmt: skip
        motions = problem.kept_motions
        with located("body"):
            make, laws = mechanics_of(settings).parameters, problem.restitutions.values()
            parameters = [[make(body, law, settings) for body in problem.bodies] for law in laws]
        sides = [sides_of(row) for row in parameters]
        with located("minimum"):
            effort = Effort(table.samples, table.bisections, table.tolerance)
            cases = Cases.joined([
                Cases.of(motions[k], sides_of_law, settings, table.min_pga, table.max_pga)
                for k in range(len(motions)) for sides_of_law in sides
            ])  # fmt: skip
        shape = (len(motions), len(problem.restitutions), len(problem.bodies))
        names = {"motion": [motions[k].name for k in range(len(motions))], "restitution": list(problem.restitutions)}
        options = {"settings": settings, "engine": self.settings.engine}
        search = MinimumSearch(cases, effort, motions, shape, parameters[0][0].law, options, names)
        dims = dict(zip(("motion", "restitution", "body", "point"), (*shape, effort.samples), strict=True))
        scale = cases.grid(effort.samples).reshape(*dims.values())
        coordinates = {
            "motion": labels_along("motion", names["motion"], "name of the motion"),
            "restitution": labels_along("restitution", names["restitution"], "restitution"),
            "body": along("body", np.arange(len(problem.bodies)), "1", "index of the body in the job"),
            "scale": Column(scale, "1", "scale factor of the motion", dims=tuple(dims)),
        }
        attributes = {
            "samples": effort.samples,
            "bisections": effort.bisections,
            "tolerance": effort.tolerance,
            "bodies": "; ".join(repr(body) for body in problem.bodies)[:4000],
        }
        exports = ("crossings", "minima", "histories")
        return Study(first_round(search), dims, coordinates, attributes, exports, search=search)

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return a figure with one panel per restitution. A panel has one lane per motion and body."""
        from rocking.plots.transitions import transitions_of_many_picture

        problem, several = finished.problem, len(finished.problem.bodies) > 1
        motions, bodies, labels = len(problem.motions), len(problem.bodies), list(problem.restitutions)
        lanes = [
            f"{problem.motions[k].name}, body {body}" if several else problem.motions[k].name
            for k in range(motions) for body in range(bodies)
        ]  # fmt: skip
        every = finished.answer.value  # order: the body changes fastest, then the restitution, then the motion
        rows = {
            label: [every[(k * len(labels) + number) * bodies + body] for k in range(motions) for body in range(bodies)]
            for number, label in enumerate(labels) if restitution in {None, label}
        }  # fmt: skip
        for label, row in rows.items():
            if None in row:
                raise InvalidValueError(
                    "No figure: no history of {lane} with restitution {restitution} has a result.",
                    lane=lanes[row.index(None)], restitution=label,
                )  # fmt: skip
        return transitions_of_many_picture(rows, lanes, lane_title="motion and body" if several else "motion")
