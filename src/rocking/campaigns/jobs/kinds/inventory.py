"""Inventories as campaigns: every object in both directions under every motion, with two models of impact."""

from rocking.campaigns.jobs.kinds.words import along, of_motions, of_words
from rocking.campaigns.jobs.study import Study
from rocking.errors import InvalidValueError
from rocking.spec.document import InventoryTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.inventory.assessment import assessment_plan
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.lights import Thresholds
from rocking.studies.inventory.objects import DIRECTIONS
from rocking.studies.inventory.reading import Inventory, read_inventory
from rocking.studies.motion_sets import SyntheticSet


def inventory_study(problem: StudyProblem) -> Study:
    """Return the study of an inventory.

    Returns over motion, object, direction and the model of impact: the one asked for and the one beside it.
    """
    table = problem.document.inventory
    assert table is not None  # the document refuses to be without
    if len(problem.restitutions) > 1:
        raise InvalidValueError("restitution: an inventory takes one; that of Housner stands beside it")
    try:
        limits = Thresholds(**table.thresholds.model_dump(exclude_none=True))
    except InvalidValueError as error:  # which begins with the key
        raise InvalidValueError(f"inventory.thresholds.{error}") from error
    with located("inventory"):
        objects, hazard = _objects(table, problem), _hazard(table, problem)
        product, finish, items = assessment_plan(
            objects, hazard, restitution=problem.restitution, thresholds=limits, gravity=problem.settings.gravity
        )
    dims = dict(
        zip(("motion", "object", "direction", "restitution"), (len(hazard.motions), len(items), 2, 2), strict=True)
    )
    coordinates = {
        "motion": of_motions(product.motions),
        "object": of_words("object", (item.name for item in items), "name of the object"),
        "row": along("object", [item.row for item in items], "1", "line of the object in its file"),
        "direction": of_words("direction", DIRECTIONS, "direction of the shaking"),
        "restitution": of_words("restitution", ("asked", "compared"), "model of impact"),
    }
    told = {"shaking": hazard.words(), "hazard": hazard.source, "objects": objects.source}
    return Study(product, dims, coordinates, told, assess=finish)


def _objects(table: InventoryTable, problem: StudyProblem) -> Inventory:
    return read_inventory(problem.inputs.file(table.objects), table.encoding)


def _hazard(table: InventoryTable, problem: StudyProblem) -> Hazard:
    words = {"PGA": table.pga, "PGV": table.pgv}
    level = next((IntensityLevel.of(kind, word) for kind, word in words.items() if word is not None), None)
    motions = problem.motions
    if isinstance(motions, SyntheticSet):
        assert level is not None  # the document refuses to be without
        return Hazard.of_family(motions.family, level, count=motions.count, seed=motions.seed)
    records = [motions[k] for k in range(len(motions))]
    return Hazard.of_records(records, level)  # type: ignore[arg-type]  # pulses are refused by the document
