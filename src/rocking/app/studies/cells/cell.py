"""The history behind a point: what is stored of it, its inputs, and how the body rocks there."""

import warnings
from typing import Any

from rocking.app.api.answers import answer_facts
from rocking.app.question import Question
from rocking.app.studies.cells.motions import ChosenMotion
from rocking.app.studies.cells.place import Place
from rocking.app.studies.cells.variation import Variation, valid
from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import meaning, plain
from rocking.dynamics.histories import simulate
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.outcome import Outcome

POINTS = 1000
"""Samples of the curves."""

_STORED = {
    "outcome": "outcome",
    "mode": "mode",
    "impacts": "impacts",
    "peak_rotation": "peak_rotation_rad",
    "peak_ratio": "peak_rotation_over_alpha",
    "overturning_time": "overturning_time_s",
}


def cell_of(study: OpenStudy, place: Place, points: int = POINTS) -> dict[str, Any]:
    """Return the history behind a point of a picture.

    Returns ``stored``: what the study has of it, to the last digit; ``inputs``: what to ask for the same history, null
    where inputs cannot say it; ``answer``: the response, null where there is none; ``difference_rad``: of the peak
    rotations of both, which take other steps to the same accuracy; ``note``: a sentence on what is missing.
    """
    told: dict[str, Any] = {"stored": stored(study, place), "inputs": None, "answer": None, "difference_rad": None}
    try:
        variation = Variation.of(study, place)
        if not valid(variation):
            return told | {"note": "the coefficient of this cell would create energy: nothing was computed"}
        motion = ChosenMotion.of(study, place.index["motion"], variation.stretch)
        question, response = _responded(study, place, variation, motion)
    except InvalidValueError as error:
        return told | {"note": str(error)}
    note = _why_not(variation, motion)
    told |= {"inputs": None if note else _inputs(study, variation, motion), "note": note}
    if response.outcome is Outcome.FAILED:
        return told | {"note": f"there is no response: {response.status.value}"}
    difference = abs(response.peak_rotation - abs(told["stored"]["peak_rotation_rad"]))
    return told | {
        "answer": answer_facts(variation.label, response, question, points),
        "difference_rad": difference,
    }


def stored(study: OpenStudy, place: Place) -> dict[str, Any]:
    """Return what a study has of a history.

    Returns Number, outcome, mode, meaning, impacts, peaks and time of overturning, as they were computed.
    """
    history = study.history(place.number)
    found = {key: plain(history[name]) for name, key in _STORED.items()}
    return {"history": place.number, "meaning": meaning(found["mode"]), **found}


def _responded(study: OpenStudy, place: Place, variation: Variation, motion: ChosenMotion) -> tuple[Question, Response]:
    job = study.job.job
    scale, engine = variation.scale * motion.scale, job.document.settings.engine
    asked = Question(
        variation.body, motion.motion, {variation.label: variation.restitution}, job.parts.settings, engine, scale=scale
    )
    how = {**vars(asked.settings), "engine": engine, "key": place.number}
    with warnings.catch_warnings():  # the answer shows its doubts
        warnings.simplefilter("ignore", PureRockingWarning)
        return asked, simulate(asked.body, motion.motion, variation.restitution, scale=scale, **how)


def _why_not(variation: Variation, motion: ChosenMotion) -> str:
    """Return why inputs cannot say this history; empty where they can."""
    if motion.told is None:
        return (
            f"the time of the motion is stretched by {variation.stretch:.6g} here, which inputs cannot say of a motion "
            "that is no pulse; the response is the one with the stretched motion"
        )
    if variation.choice is None:
        return "the coefficient is drawn at every impact, by the number of the history, which inputs do not have"
    return ""


def _inputs(study: OpenStudy, variation: Variation, motion: ChosenMotion) -> dict[str, Any]:
    assert motion.told is not None  # asked before
    settings = study.job.job.document.settings.model_dump(exclude_unset=True, exclude_none=True)
    made = {
        "body": variation.table,
        "motion": motion.told | {"scale": variation.scale * motion.scale},
        "restitution": variation.choice,
    }
    return made | ({"settings": settings} if settings else {})
