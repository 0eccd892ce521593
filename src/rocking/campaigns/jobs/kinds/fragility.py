"""Fragility analyses as campaigns: stripes, cloud and incremental."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from rocking.campaigns.jobs.kinds.words import along, of_motions, of_words
from rocking.campaigns.jobs.measured import check_told
from rocking.campaigns.jobs.study import Study
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.spec.document import FragilityTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.fragility._incremental_dynamic_analysis import incremental_dynamic_plan
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_plan
from rocking.studies.fragility.cloud_analysis import cloud_plan
from rocking.studies.fragility.subject import Subject
from rocking.studies.histories import Product
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

Finish = Callable[[Arrays], Any]


def fragility_study(problem: StudyProblem) -> Study:
    """Return the study of a fragility analysis, of one body.

    Returns over motion and level (a cloud: over motion), and the restitution where there are several.
    """
    table = problem.document.fragility or FragilityTable()
    with located("fragility"):
        plans = {label: _plan(table, problem, choice) for label, choice in problem.restitutions.items()}
        products = [product for product, _ in plans.values()]
        merged = _merged(products)
    if problem.document.campaign.kind == "cloud":
        with located("export"):
            check_told(problem.document, problem.motions)
    levels = None if table.levels is None else table.levels.numbers()
    dims = {"motion": len(problem.motions)} | ({} if levels is None else {"level": levels.size})
    subject = Subject.of(problem.bodies[0], problem.motions, problem.restitution, table.measure, dict(problem.options))
    label = subject.label
    coordinates = {"motion": of_motions(problem.motions)}
    if levels is None:
        found = subject.measure.scaled(subject.intensities, table.factor or 1.0)
        coordinates["intensity"] = along("motion", found, label["units"], label["long_name"])
    else:
        coordinates["level"] = along("level", levels, label["units"], label["long_name"])
        scales = np.broadcast_to(merged.scales, (len(problem.motions), levels.size))
        coordinates["factor"] = Column(scales, "1", "factor on the motion", dims=("motion", "level"))
    if len(plans) > 1:
        dims["restitution"] = len(plans)
        coordinates["restitution"] = of_words("restitution", plans, "restitution")
    finishes = {label: finish for label, (_, finish) in plans.items()}
    about = {f"subject_{name}": value for name, value in subject.about().items() if name != "software"}
    return Study(sampled(merged), dims, coordinates, about, finish=_Finish(finishes))


class _Finish:
    """Hands every analysis its own of the results of all."""

    def __init__(self, finishes: dict[str, Finish]) -> None:
        self._finishes = finishes

    def __call__(self, arrays: Arrays) -> dict[str, Any]:
        """Return the analysis of every restitution."""
        step = len(self._finishes)
        return {
            label: finish({name: values[k::step] for name, values in arrays.items()})
            for k, (label, finish) in enumerate(self._finishes.items())
        }


def _plan(table: FragilityTable, problem: StudyProblem, choice: Any) -> tuple[Product, Finish]:
    body, motions, kind = problem.bodies[0], problem.motions, problem.document.campaign.kind
    how = {"measure": table.measure, "states": tuple(table.states), **problem.options}
    if kind == "cloud":
        return cloud_plan(body, motions, choice, factor=1.0 if table.factor is None else table.factor, **how)
    assert table.levels is not None  # the document refuses to be without
    if kind == "stripes":
        return multiple_stripe_plan(body, motions, table.levels.numbers(), choice, **how)
    tolerance = 1e-8 if table.tolerance is None else table.tolerance
    # what is in [fragility] is the search's; that of [settings] is the reference engine's
    if how["tolerance"] != type(problem.settings)().tolerance:
        raise InvalidValueError("settings.tolerance cannot be changed in an incremental analysis; leave it out")
    return incremental_dynamic_plan(body, motions, table.levels.numbers(), choice, **(how | {"tolerance": tolerance}))


def _merged(products: list[Product]) -> Product:
    """Return one product of all restitutions; everything else of them is the same."""
    sides = {name: np.concatenate([p.sides[name] for p in products], axis=1) for name in products[0].sides}
    return replace(products[0], sides=sides)
