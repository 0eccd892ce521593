"""Fragility analyses as campaigns: stripes, cloud with its intensity measures, and incremental."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.conventions import FloatArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError, located
from rocking.motions.intensity import measure
from rocking.spec.document import CampaignDocument
from rocking.spec.study import StudyProblem, fragility_question
from rocking.studies.fragility.measure_comparison import DEFAULT_MEASURES
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

ANALYSES = ("fragility", "fragility-points", "fema-p58")  # what can be exported of the curves of one restitution
MEASURES = "measures"  # what the ranking of intensity measures is called among the exports

USUAL_COLUMNS = ("magnitude", "ln distance_km")
"""Metadata that the sufficiency is tested against, where all motions have them and the job names none."""

_LOGARITHM = "ln "


def fragility_study(problem: StudyProblem) -> Study:
    """Return the study of a fragility analysis of one body: over motion, level save in clouds, several restitutions."""
    exports: tuple[str, ...] = ("histories", *ANALYSES)
    with located("fragility"):
        questions = {label: fragility_question(problem, each) for label, each in problem.restitutions.items()}
        products = [question.histories for question in questions.values()]  # the same but for their sides
        sides = {n: np.concatenate([each.sides[n] for each in products], axis=1) for n in products[0].sides}
        merged = replace(products[0], sides=sides)
    question = next(iter(questions.values()))
    label, levels = question.subject.label, question.levels
    dims, coordinates = {"motion": len(problem.motions)}, {"motion": motions_along(problem.motions)}
    if question.analysis == "cloud":
        exports = (*exports, MEASURES)
        with located("export"):
            measures_of(problem.document)
            if problem.document.export is not None and problem.document.export.columns:
                columns_of(problem.document, MotionList(problem.motions[0]))  # of the motions only the first is asked
        coordinates["intensity"] = along("motion", levels, label["units"], label["long_name"])
    else:
        dims["level"] = levels.size
        coordinates["level"] = along("level", levels, label["units"], label["long_name"])
        scales = np.broadcast_to(merged.scales, (len(problem.motions), levels.size))
        coordinates["factor"] = Column(scales, "1", "factor on the motion", dims=("motion", "level"))
    if len(questions) > 1:
        dims["restitution"] = len(questions)
        coordinates["restitution"] = labels_along("restitution", questions, "restitution")
    attributes = {f"subject_{name}": value for name, value in question.subject.about().items() if name != "software"}

    def finish(results: Arrays) -> dict[str, Any]:
        """Hand every analysis its own of the results of all."""
        return {
            label: each.answer({name: values[k :: len(questions)] for name, values in results.items()})
            for k, (label, each) in enumerate(questions.items())
        }

    return Study(sampled(merged), dims, coordinates, attributes, exports, finish)


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
