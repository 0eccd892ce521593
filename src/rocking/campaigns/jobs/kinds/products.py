"""Rocking spectra, inventories, and every motion with every body, scale and restitution, as campaigns."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body
from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.parameters import sides_of
from rocking.errors import InvalidValueError, located
from rocking.motions.summary import provenance_of
from rocking.spec.questions.histories import HistoriesTable
from rocking.spec.study import StudyProblem, inventory_of
from rocking.studies.histories import JoinedHistories, Product
from rocking.studies.inventory.assessment import assessment_plan
from rocking.studies.inventory.objects import DIRECTIONS
from rocking.studies.motion_sets import MotionList
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

_LONGEST = 1e100


def spectrum_study(problem: StudyProblem) -> Study:
    """Return the study of rocking spectra: over motion, slenderness angle and period, and several restitutions."""
    table = problem.document.spectrum
    assert table is not None  # the document refuses to be without
    angles = checks.positive_array("spectrum.slenderness_angles", table.slenderness_angles.numbers(), "rad")
    times = checks.positive_array("spectrum.periods", table.periods.numbers(), "s")
    for name, row in (("slenderness_angles", angles), ("periods", times)):
        if np.any(np.diff(row) <= 0.0):
            raise InvalidValueError(f"spectrum.{name} must increase from value to value")
    scale = checks.within("spectrum.scale", table.scale, -1e6, 1e6)
    if times.max() > _LONGEST:  # its square would be beyond all numbers
        raise InvalidValueError(f"spectrum.periods must be up to {_LONGEST:g} s, got {times.max():g}")
    sizes = 0.75 * problem.settings.gravity * (0.5 * times / np.pi) ** 2  # Eq. 180
    with located("spectrum"):
        blocks = [Block.from_angle(float(alpha), float(size)) for alpha in angles for size in sizes]
        product, attributes = _product(problem, blocks, np.array([scale]))
    dims = {"motion": len(problem.motions), "slenderness_angle": angles.size, "period": times.size}
    # a law changes it from impact to impact: there is no one coefficient to tell
    coefficient = np.where(isinstance(product.law, ConstantRestitution), product.sides["r_right"], np.nan)
    coordinates = {
        "motion": motions_along(problem.motions),
        "slenderness_angle": along("slenderness_angle", angles, "rad", "slenderness angle"),
        "period": along("period", times, "s", "2 pi / p"),
        "semi_diagonal": along("period", sizes, "m", "semi-diagonal R of the block"),
    }
    if len(problem.restitutions) > 1:
        dims["restitution"] = len(problem.restitutions)
        coordinates["restitution"] = labels_along("restitution", problem.restitutions, "restitution")
    coefficient = coefficient.reshape([*dims.values()][1:])
    coordinates["coefficient"] = Column(coefficient, "1", "coefficient of restitution", dims=tuple(dims)[1:])
    attributes["scale"] = scale
    if isinstance(problem.motions, MotionList):
        hashes = (item["sha256"] for item in problem.motions.description()["motions"])
        attributes["motion_sha256"] = "; ".join(hashes)
    return Study(sampled(product), dims, coordinates, attributes)


def product_study(problem: StudyProblem) -> Study:
    """Return the study of every motion with every body, scale and restitution."""
    scales = (problem.document.histories or HistoriesTable()).scales.numbers()
    bad = np.flatnonzero(np.abs(scales) > 1e6)
    if bad.size:
        raise InvalidValueError(f"histories.scales must be within 1e6, got {scales[bad[0]]:g} at index {bad[0]}")
    with located("body"):
        product, attributes = _product(problem, problem.bodies, scales)
    angle, frequency = product.sides["alpha_right"][:, 0], product.sides["p_right"][:, 0]
    motions = problem.motions
    coordinates = {
        "motion": motions_along(motions),
        "body": along("body", np.arange(len(problem.bodies)), "1", "number of the body in the job"),
        "scale": along("scale", scales, "1", "factor on the motion"),
        "restitution": labels_along("restitution", problem.restitutions, "restitution"),
        "slenderness_angle": along("body", angle, "rad", "slenderness angle of the right side"),
        "frequency_parameter": along("body", frequency, "rad/s", "frequency parameter of the right side"),
    }
    if isinstance(motions, MotionList):
        sources = ("; ".join(provenance_of(motions[k])) for k in range(len(motions)))
        coordinates["motion_provenance"] = labels_along("motion", sources, "where the motion comes from")
    sizes = (len(motions), len(problem.bodies), scales.size, len(problem.restitutions))
    dims = dict(zip(("motion", "body", "scale", "restitution"), sizes, strict=True))
    attributes["bodies"] = "; ".join(repr(body) for body in problem.bodies)[:4000]
    return Study(sampled(product), dims, coordinates, attributes)


def inventory_study(problem: StudyProblem) -> Study:
    """Return the study of an inventory: over motion, object, direction and the model of impact, those asked beside it.

    With friction or body files over object, model of impact, motion and direction.
    """
    objects, motions, limits, restitution = inventory_of(problem)
    hazard = motions(None)
    with located("inventory"):
        histories, finish, dims, items = assessment_plan(
            objects, hazard, restitution=restitution, thresholds=limits, gravity=problem.settings.gravity,
            friction=problem.settings.stated.get("friction"),
        )  # fmt: skip
    names = ("asked", "compared") if restitution is not None else ("calibrated", "housner", "ked")
    if isinstance(histories, JoinedHistories) and restitution is None:
        names = ("calibrated; ked in three dimensions", *names[1:])
    coordinates = {
        "motion": motions_along(histories.motions),
        "object": labels_along("object", (item.name for item in items), "name of the object"),
        "row": along("object", [item.row for item in items], "1", "line of the object in its file"),
        "number": labels_along("object", (item.number for item in items), "inventory number"),
        "note": labels_along("object", (item.note for item in items), "what the list notes"),
        "direction": labels_along("direction", DIRECTIONS, "direction of the shaking"),
        "restitution": labels_along("restitution", names, "model of impact"),
    }
    attributes = {"shaking": hazard.words(), "hazard": str(hazard.source), "objects": objects.source}
    return Study(histories, dims, coordinates, attributes, assess=finish)


def _product(problem: StudyProblem, bodies: Sequence[Body], scales: np.ndarray) -> tuple[Product, dict[str, Any]]:
    """Return bodies with every motion, scale and restitution, and what a Python call says of such a study."""
    settings, restitutions = problem.settings, list(problem.restitutions.values())
    make = mechanics_of(settings).parameters
    parameters = [[make(body, each, settings) for body in bodies] for each in restitutions]
    columns = [sides_of(row) for row in parameters]
    sides = {name: np.stack([column[name] for column in columns], axis=-1) for name in columns[0]}
    law, engine = parameters[0][0].law, problem.document.settings.engine
    stated = {f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in settings.stated.items()}
    attributes = {"seed": int(getattr(law, "seed", 0)), **stated}
    if len(restitutions) == 1:
        attributes["restitution"] = parameters[0][0].label
    return Product(problem.motions, sides, scales, law=law, settings=settings, engine=engine), attributes
