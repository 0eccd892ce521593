"""Inventories as campaigns: every object in both directions under every motion, with two models of impact."""

from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.errors import InvalidValueError
from rocking.spec.document import InventoryTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.inventory.assessment import assessment_plan
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.lights import Thresholds
from rocking.studies.inventory.objects import DIRECTIONS
from rocking.studies.inventory.reading import read_inventory
from rocking.studies.motion_sets import SyntheticSet


def inventory_study(problem: StudyProblem) -> Study:
    """Return the study of an inventory: over motion, object, direction and model of impact, asked for and beside it."""
    table = problem.document.inventory
    assert table is not None  # the document refuses to be without
    if len(problem.restitutions) > 1:
        raise InvalidValueError("restitution: an inventory takes one; that of Housner stands beside it")
    try:
        limits = Thresholds(**table.thresholds.model_dump(exclude_none=True))
    except InvalidValueError as error:  # which begins with the key
        raise InvalidValueError(f"inventory.thresholds.{error}") from error
    with located("inventory"):
        objects, hazard = read_inventory(problem.inputs.file(table.objects), table.encoding), _hazard(table, problem)
        product, finish, items = assessment_plan(
            objects, hazard, restitution=problem.restitution, thresholds=limits, gravity=problem.settings.gravity
        )
    sizes = (len(hazard.motions), len(items), 2, 2)
    dims = dict(zip(("motion", "object", "direction", "restitution"), sizes, strict=True))
    coordinates = {
        "motion": motions_along(product.motions),
        "object": labels_along("object", (item.name for item in items), "name of the object"),
        "row": along("object", [item.row for item in items], "1", "line of the object in its file"),
        "direction": labels_along("direction", DIRECTIONS, "direction of the shaking"),
        "restitution": labels_along("restitution", ("asked", "compared"), "model of impact"),
    }
    attributes = {"shaking": hazard.words(), "hazard": hazard.source, "objects": objects.source}
    return Study(product, dims, coordinates, attributes, assess=finish)


def _hazard(table: InventoryTable, problem: StudyProblem) -> Hazard:
    strength = {"PGA": table.pga, "PGV": table.pgv}
    level = next((IntensityLevel.of(kind, text) for kind, text in strength.items() if text is not None), None)
    motions = problem.motions
    if isinstance(motions, SyntheticSet):
        assert level is not None  # the document refuses to be without
        return Hazard.of_family(motions.family, level, count=motions.count, seed=motions.seed)
    records = [motions[k] for k in range(len(motions))]
    return Hazard.of_records(records, level)  # type: ignore[arg-type]  # pulses are refused by the document
