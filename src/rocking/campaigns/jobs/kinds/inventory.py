"""Inventories as campaigns: every object in both directions under every motion, with two models of impact."""

from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem, inventory_of
from rocking.studies.inventory.assessment import assessment_plan
from rocking.studies.inventory.objects import DIRECTIONS


def inventory_study(problem: StudyProblem) -> Study:
    """Return the study of an inventory.

    Returns over motion, object, direction and the model of impact: the one asked for and the one beside it.
    """
    objects, motions, limits = inventory_of(problem)
    hazard = motions(None)
    with located("inventory"):
        product, finish, items = assessment_plan(
            objects, hazard, restitution=problem.restitution, thresholds=limits, gravity=problem.settings.gravity
        )
    dims = dict(
        zip(("motion", "object", "direction", "restitution"), (len(hazard.motions), len(items), 2, 2), strict=True)
    )
    coordinates = {
        "motion": motions_along(product.motions),
        "object": labels_along("object", (item.name for item in items), "name of the object"),
        "row": along("object", [item.row for item in items], "1", "line of the object in its file"),
        "direction": labels_along("direction", DIRECTIONS, "direction of the shaking"),
        "restitution": labels_along("restitution", ("asked", "compared"), "model of impact"),
    }
    told = {"shaking": hazard.words(), "hazard": hazard.source, "objects": objects.source}
    return Study(product, dims, coordinates, told, assess=finish)
