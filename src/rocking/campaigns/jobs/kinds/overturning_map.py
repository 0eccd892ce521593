"""Overturning maps as campaigns."""

from dataclasses import replace

from rocking.campaigns.jobs.kinds.map_histories import MapHistories
from rocking.campaigns.jobs.kinds.refined_map import MapSearch
from rocking.campaigns.jobs.kinds.words import along, of_words
from rocking.campaigns.jobs.study import Study
from rocking.errors import InvalidValueError
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem, axes_of
from rocking.studies.adaptive_grid import Plane
from rocking.studies.axis import RestitutionAxis
from rocking.studies.question import Question
from rocking.studies.sensitivity.restitutions import sampled


def map_study(problem: StudyProblem) -> Study:
    """Return the study of an overturning map.

    Returns over y and x, and the restitution before them where there are several.
    """
    table = problem.document.map
    assert table is not None  # the document refuses to be without
    if len(problem.motions) != 1:
        raise InvalidValueError(f"motions: a map is of one motion, got {len(problem.motions)}")
    axes = axes_of(table)
    engine = problem.document.settings.engine
    with located("map"):
        questions = [
            Question(problem.bodies[0], problem.motions[0], choice, problem.settings, None, engine)
            for choice in problem.restitutions.values()
        ]
        if len(questions) > 1 and any(isinstance(axis, RestitutionAxis) for axis in axes):
            raise InvalidValueError("restitution cannot be an axis where it is what is compared; leave one model")
        planes = [Plane(question, *axes) for question in questions]
        histories = MapHistories.of(planes)
    x, y = axes
    several = {"restitution": len(planes)} if len(planes) > 1 else {}
    coordinates = {axis.name: along(axis.name, axis.values, axis.unit, axis.words) for axis in (y, x)}
    if several:
        coordinates["restitution"] = of_words("restitution", problem.restitutions, "restitution")
    attributes = {"body": repr(problem.bodies[0]), "motion": problem.motions[0].name}
    study = Study(
        sampled(histories),
        several | {y.name: y.values.size, x.name: x.values.size},
        coordinates,
        attributes,
        rescale=histories.rescaled,
    )
    return study if table.refine is None else replace(study, search=MapSearch.of(study, planes, table))
