"""Minimum overturning accelerations as campaigns: every motion with every restitution and body, searched together."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import AdaptiveResult
from rocking.campaigns.jobs.asked import Compute, NumberedTable, first_round
from rocking.campaigns.jobs.kinds.minimum_tables import tables_of
from rocking.campaigns.jobs.kinds.words import along, of_words
from rocking.campaigns.jobs.study import Study
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.fast_engine import Arrays, empty_results
from rocking.errors import InvalidValueError
from rocking.spec.construction import MOST_IN_MEMORY
from rocking.spec.document import MinimumTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.minimum_acceleration import Cases, Effort, searched
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import modes_of, peak_ratio, sides_of
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column


@dataclass(frozen=True)
class MinimumSearch:
    """A search for crossings that somebody else computes, round by round."""

    cases: Cases  # every motion with every restitution and body; the body changes fastest
    effort: Effort  # how closely to look
    motions: MotionList
    shape: tuple[int, int, int]  # numbers of motions, restitutions and bodies
    law: ImpactLaw  # how the coefficient changes from impact to impact
    options: dict[str, Any]  # settings and engine, as `Histories` takes them
    names: dict[str, list[str]]  # what the motions and the restitutions are called

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Return all crossings.

        Returns A tuple of `Transitions`, None where no history could be computed, and tables of them.
        """
        motion, _, body = np.unravel_index(np.arange(self.cases.uplift.size), self.shape)

        def run(values: dict[str, FloatArray], case: IntArray) -> Arrays:
            if case.size:
                # the draws of a body are the same at every amplitude, and those of a call with this motion alone
                told: dict[str, Any] = {"law": self.law, **self.options}
                found = compute(sampled(NumberedTable(self.motions, motion[case], values, body[case], **told)))
            else:
                found = empty_results(0)
            ratio = peak_ratio(found["peak_rotation"], values["alpha_right"], values["alpha_left"])
            return {**found, "mode": modes_of(found), "peak_ratio": ratio}

        crossings = searched(self.cases, self.effort, run)
        return AdaptiveResult(crossings, tables_of(crossings, self.cases, self.effort, self.shape, self.names))


def minimum_study(problem: StudyProblem) -> Study:
    """Return the study of minimum overturning accelerations.

    Returns of the first samples, over motion, restitution, body and point; its search asks for the others.
    """
    table = problem.document.minimum or MinimumTable()
    motions, settings = _held(problem), problem.settings
    with located("body"):
        all_parameters = [
            [RockingParameters.of_body(b, choice, settings.gravity) for b in problem.bodies]
            for choice in problem.restitutions.values()
        ]
    sides = [sides_of(row) for row in all_parameters]
    with located("minimum"):
        effort = Effort(table.points, table.levels, table.tolerance)
        cases = Cases.joined([
            Cases.of(motions[k], each, settings, table.lowest, table.highest)
            for k in range(len(motions)) for each in sides
        ])  # fmt: skip
    shape = (len(motions), len(problem.restitutions), len(problem.bodies))
    names = {"motion": [motions[k].name for k in range(len(motions))], "restitution": list(problem.restitutions)}
    options = {"settings": settings, "engine": problem.document.settings.engine}
    search = MinimumSearch(cases, effort, motions, shape, all_parameters[0][0].law, options, names)
    dims = dict(zip(("motion", "restitution", "body", "point"), (*shape, effort.points), strict=True))
    scale = cases.grid(effort.points).reshape(*dims.values())
    coordinates = {
        "motion": of_words("motion", names["motion"], "name of the motion"),
        "restitution": of_words("restitution", names["restitution"], "restitution"),
        "body": along("body", np.arange(len(problem.bodies)), "1", "number of the body in the job"),
        "scale": Column(scale, "1", "factor on the motion", dims=tuple(dims)),
    }
    told = {"points": effort.points, "levels": effort.levels, "tolerance": effort.tolerance}
    bodies = "; ".join(repr(body) for body in problem.bodies)[:4000]
    return Study(first_round(search), dims, coordinates, {**told, "bodies": bodies}, search=search)


def _held(problem: StudyProblem) -> MotionList:
    if len(problem.motions) > MOST_IN_MEMORY:
        raise InvalidValueError(f"motions: there may be up to {MOST_IN_MEMORY}, got {len(problem.motions)}")
    return MotionList([problem.motions[k] for k in range(len(problem.motions))])
