"""Fragility analyses as campaigns: stripes, cloud with its intensity measures, and incremental."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.conventions import FloatArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.motions.intensity import measure
from rocking.spec.document import CampaignDocument, FragilityTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.fragility._incremental_dynamic_analysis import incremental_dynamic_plan
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_plan
from rocking.studies.fragility.cloud_analysis import cloud_plan
from rocking.studies.fragility.measure_comparison import DEFAULT_MEASURES
from rocking.studies.fragility.subject import Subject
from rocking.studies.histories import Product
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

ANALYSES = ("fragility", "fragility-points", "fema-p58")  # what can be exported of the curves of one restitution
MEASURES = "measures"  # what the ranking of intensity measures is called among the exports

USUAL_COLUMNS = ("magnitude", "ln distance_km")
"""Metadata that the sufficiency is tested against, where all motions have them and the job names none."""

_LOGARITHM = "ln "
Finish = Callable[[Arrays], Any]


def fragility_study(problem: StudyProblem) -> Study:
    """Return the study of a fragility analysis of one body: over motion, level save in clouds, several restitutions."""
    table = problem.document.fragility or FragilityTable()
    exports: tuple[str, ...] = ("histories", *ANALYSES)
    with located("fragility"):
        plans = {label: _plan(table, problem, restitution) for label, restitution in problem.restitutions.items()}
        products = [product for product, _ in plans.values()]  # the same but for their sides
        sides = {n: np.concatenate([each.sides[n] for each in products], axis=1) for n in products[0].sides}
        merged = replace(products[0], sides=sides)
    if problem.document.campaign.kind == "cloud":
        exports = (*exports, MEASURES)
        with located("export"):
            measures_of(problem.document)
            if problem.document.export is not None and problem.document.export.columns:
                columns_of(problem.document, MotionList(problem.motions[0]))  # of the motions only the first is asked
    levels = None if table.levels is None else table.levels.numbers()
    dims = {"motion": len(problem.motions)} | ({} if levels is None else {"level": levels.size})
    subject = Subject.of(problem.bodies[0], problem.motions, problem.restitution, table.measure, dict(problem.options))
    label = subject.label
    coordinates = {"motion": motions_along(problem.motions)}
    if levels is None:
        intensities = subject.measure.scaled(subject.intensities, table.factor or 1.0)
        coordinates["intensity"] = along("motion", intensities, label["units"], label["long_name"])
    else:
        coordinates["level"] = along("level", levels, label["units"], label["long_name"])
        scales = np.broadcast_to(merged.scales, (len(problem.motions), levels.size))
        coordinates["factor"] = Column(scales, "1", "factor on the motion", dims=("motion", "level"))
    if len(plans) > 1:
        dims["restitution"] = len(plans)
        coordinates["restitution"] = labels_along("restitution", plans, "restitution")
    attributes = {f"subject_{name}": value for name, value in subject.about().items() if name != "software"}

    def finish(results: Arrays) -> dict[str, Any]:
        """Hand every analysis its own of the results of all."""
        return {
            label: each({name: values[k :: len(plans)] for name, values in results.items()})
            for k, (label, (_, each)) in enumerate(plans.items())
        }

    return Study(sampled(merged), dims, coordinates, attributes, exports, finish)


def _plan(table: FragilityTable, problem: StudyProblem, restitution: Any) -> tuple[Product, Finish]:
    body, motions, kind = problem.bodies[0], problem.motions, problem.document.campaign.kind
    how = {"measure": table.measure, "states": tuple(table.states), **problem.options}
    if kind == "cloud":
        return cloud_plan(body, motions, restitution, factor=1.0 if table.factor is None else table.factor, **how)
    assert table.levels is not None  # the document refuses to be without
    if kind == "stripes":
        return multiple_stripe_plan(body, motions, table.levels.numbers(), restitution, **how)
    tolerance = 1e-8 if table.tolerance is None else table.tolerance
    # what is in [fragility] is the search's; that of [settings] is the reference engine's
    if "tolerance" in problem.document.settings.stated():
        raise InvalidValueError("settings.tolerance cannot be changed in an incremental analysis; leave it out")
    return incremental_dynamic_plan(
        body, motions, table.levels.numbers(), restitution, **(how | {"tolerance": tolerance})
    )


def measures_of(document: CampaignDocument) -> list[str]:
    """Return the measures of intensity that a job compares: those of [export], or the usual ones and its own."""
    named = None if document.export is None else document.export.measures
    own = "pga" if document.fragility is None else document.fragility.measure
    known = [measure(name).name for name in ([*DEFAULT_MEASURES, own] if named is None else named)]
    twice = [name for name in known if known.count(name) > 1]
    if named is not None and twice:
        raise InvalidValueError(f"measures: {twice[0]} is named twice")
    return list(dict.fromkeys(known))


def columns_of(document: CampaignDocument, motions: MotionSet) -> dict[str, FloatArray]:
    """Return numbers in the metadata of the motions: the columns of [export], or those of `USUAL_COLUMNS` there are.

    A name that begins with ``ln`` is the logarithm of what follows.
    """
    named = None if document.export is None else document.export.columns
    wanted = USUAL_COLUMNS if named is None else named
    columns: dict[str, list[float]] = {name: [] for name in wanted}
    if len(columns) < len(wanted):
        raise InvalidValueError(f"columns: one of {', '.join(wanted)} is named twice")
    for k in range(len(motions)):
        motion = motions[k]
        metadata = getattr(motion, "metadata", {})
        for name in list(columns):
            try:
                columns[name].append(_number(name, metadata))
            except ValueError as error:
                if named is not None:
                    raise InvalidValueError(
                        f"columns: {name!r:.60} must be a number of every motion, {error} of motion {k}, "
                        f"{motion.name!r:.60}, which knows {', '.join(metadata) or 'nothing'}"
                    ) from error
                del columns[name]
        if not columns:
            break
    return {name: np.array(values) for name, values in columns.items()}


def _number(name: str, metadata: Any) -> float:
    """Return a number of the metadata, or its logarithm; a ValueError says why there is none."""
    key = name.removeprefix(_LOGARITHM)
    if key not in metadata:
        raise ValueError("there is none")
    try:
        value = float(metadata[key])
    except ValueError as error:
        raise ValueError(f"got {metadata[key]!r:.40}") from error
    if not math.isfinite(value) or (name != key and value <= 0.0):
        raise ValueError(f"got {value:g}")
    return math.log(value) if name != key else value
