"""POST /api/response: responses for all selected restitutions, with thinned curves."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from fastapi import APIRouter, Request

from rocking import Outcome, Response
from rocking.answers import Answer
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.dense_output import DenseOutput
from rocking.dynamics.plane.energy_balance import energies, forces
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.motions import Pulse, ground_displacement
from rocking.motions.summary import motion_answer
from rocking.plots.animation_scene import DrawnShape, fall_of
from rocking.reports.body_facts import outline_answer
from rocking.reports.response_facts import ModelAgreement
from rocking.restitution.headline import headline
from rocking.spec.response import ResponseProblem
from rocking_workbench.answers import Foot, JsonAnswer, Units, answered, shape
from rocking_workbench.api.body import BodyFacts, DrawnBody
from rocking_workbench.errors import TooLarge
from rocking_workbench.inputs import ResponseRequest, problem_from
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import state_of
from rocking_workbench.work import heavy

router = APIRouter(prefix="/api", tags=["response"])
MOST_SAMPLES = 500_000  # largest number of samples for forces and energy

MOST_TOGETHER = 3_000_000
"""Samples of all responses of one problem, including samples after overturning."""

_NEWTON_STEPS = 8


MotionSummaryAnswer: Any = shape(
    "MotionSummaryAnswer",
    "The ground motion.",
    "name support provenance[] scale duration peak_ground_acceleration peak_ground_velocity warnings[]",
    kind=Literal["record", "pulse"],
)
LastState: Any = shape(
    "LastState",
    "The last state of a body that still rocks at the end.",
    "time rotation angular_velocity unfinished",
)
Impact: Any = shape(
    "Impact",
    "One impact.",
    "time velocity_before velocity_after coefficient",
    foot=(str, "impact foot"),
)
ResponseSeries: Any = shape(
    "ResponseSeries",
    "Curves of a response with equal lengths; each pixel keeps its extremes.",
    "time[] rotation[] angular_velocity[] kinetic_energy[] potential_energy[] work_of_ground[] energy_lost[] "
    "vertical_force[] ground_acceleration[] ground_displacement[]",
    friction_demand=(list[float | None], "friction demand; null if no friction is sufficient"),
    samples_shown=int,
    samples=(int, "states of the response: samples, events, and where it turns round"),
)
FallAnswer: Any = shape(
    "FallAnswer",
    "Fall after the end of the curves, until a corner touches the ground.",
    "time[] rotation[]",
    lying=tuple[float, float],
)
Coefficients: Any = shape(
    "Coefficients", "Coefficient of restitution by the foot landed on.", left=(float, "[-]"), right=(float, "[-]")
)
ResponseFacts: Any = shape(
    "ResponseFacts",
    "The response under one restitution: the keys of `rocking simulate --json`, with label and curves.",
    "initial_rotation restitution engine gravity summary peak_rotation peak_ratio uplift_times[] "
    "energy_closure friction warnings[]",
    label=(str, "the restitution"),
    body=BodyFacts,
    motion=(MotionSummaryAnswer | None, "null for free rocking"),
    coefficient=(Coefficients, "coefficient of restitution by the foot landed on"),
    linear=bool,
    outcome=(Literal["no_uplift", "rocked", "overturned"], "outcome"),
    side=(Foot | None, "side to which the body overturned; null if it did not"),
    overturning_time=(float | None, "null if the body does not overturn"),
    still_rocking=bool,
    last_state=(LastState | None, "null if the body rests or has overturned at the end"),
    lost_contact=bool,
    impacts=list[Impact],
    error_estimate=(float | None, "null if another step changes the outcome"),
    friction_assumed=bool,
    friction_demand=(float | None, "null if no friction suffices"),
    friction_of_motion=(float | None, "null if no friction suffices"),
    friction_of_impacts=(float | None, "null if no friction suffices"),
    least_force=(float | None, "null if the body does not rock"),
    series=ResponseSeries,
    fall=FallAnswer,
)
NoResponse: Any = shape("NoResponse", "Reason for a missing response.", label=(str, "the restitution"), error=str)
VerdictFacts: Any = shape(
    "VerdictFacts",
    "Effect of the choice of the model.",
    decides=bool,
    sentence=str,
    headline=(str, "the restitution model of the first answer, with the reason"),
    doubts=(list[str], "about the computation"),
)
ResponseAnswered: Any = shape(
    "ResponseAnswered",
    "Responses for all selected restitutions.",
    answers=list[ResponseFacts | NoResponse],
    verdict=VerdictFacts,
    body=DrawnBody,
    motion=(MotionSummaryAnswer | None, "null for free rocking"),
    units=Units,
)


@router.post(
    "/response",
    summary="Response of the body",
    responses=answered(ResponseAnswered, "One answer per restitution, and a common verdict."),
)
async def response(request: Request, inputs: ResponseRequest) -> JsonAnswer:
    """Return the keys of `rocking simulate --json` for every restitution, in the order of the request.

    `series` contains the extremes of every curve in `points` intervals, between both times of `window` if stated.
    `series` includes the states before and after every impact, and at every peak. `verdict` compares the outcomes of
    the models. A restitution without a response for this body has `label` and `error`.
    """
    return JsonAnswer(await heavy(request, _answer, inputs, state_of(request).records))


def _answer(inputs: ResponseRequest, records: RecordStore) -> Answer:
    is_stated = inputs.restitution != ResponseRequest.model_fields["restitution"].default
    problem = problem_from(inputs, records)
    return responses_answer(problem, inputs.points, inputs.body.name, inputs.window, is_stated=is_stated)


def responses_answer(
    problem: ResponseProblem, points: int, name: str | None = None, window: tuple[float, float] | None = None,
    *, is_stated: bool = False,
) -> Answer:  # fmt: skip
    """Return the responses for all restitutions; `window` is the time window of the curves [s].

    `is_stated` is True if the input states the restitution.
    """
    assert not isinstance(problem.motion, dict)  # motions of the page have one component
    answers = responses_of(problem)
    verdict = ModelAgreement.of(
        {label: response for label, response in answers.items() if isinstance(response, Response)}
    )
    return Answer({
        "answers": [
            {"label": label, "error": response}
            if isinstance(response, str)
            else response_answer(label, response, problem, points, window)
            for label, response in answers.items()
        ],
        "verdict": {
            "decides": verdict.models_differ, "sentence": verdict.verdict, "doubts": list(verdict.doubts),
            "headline": headline(next(iter(answers)), is_stated=is_stated),
        },
        "body": problem.body.answer(problem.settings.gravity) | outline_answer(problem.body) | {"name": name},
        "motion": motion_answer(problem.motion, problem.scale),
    })  # fmt: skip


def responses_of(problem: ResponseProblem) -> dict[str, Response | str]:
    """Return responses by label, with reasons for missing responses; without any response, raise an error."""
    answers: dict[str, Response | str] = {}
    samples = 0
    for label, restitution in problem.restitutions.items():
        answers[label] = response = _tried(problem, restitution)
        samples += response.segments.count if isinstance(response, Response) else 0
        if samples > MOST_TOGETHER:
            raise TooLarge(
                "{answered} of {count} responses have {steps} steps in total, {limit} are allowed",
                answered=len(answers), count=len(problem.restitutions), steps=samples, limit=MOST_TOGETHER,
                hint="use fewer restitutions, a longer time step, or the command line",
            )  # fmt: skip
    reasons = [reason for reason in answers.values() if isinstance(reason, str)]
    if len(reasons) == len(answers):
        raise InvalidValueError(reasons[0])
    return answers


def response_answer(
    label: str, response: Response, problem: ResponseProblem, points: int, window: tuple[float, float] | None = None
) -> Answer:
    """Return one response with label, curves and fall."""
    lying = DrawnShape.of(response.body).lying
    fall = fall_of(response, lying)
    return response.answer(problem.assumed_friction) | {
        "label": label,
        "series": response_series(response, points, window),
        "fall": {"time": fall.time[1:], "rotation": fall.rotation[1:], "lying": lying},
    }


def _tried(problem: ResponseProblem, restitution: Any) -> Response | str:
    try:
        response: Response = problem.answer(restitution)
    except InvalidValueError as error:
        return str(error)
    if response.outcome is Outcome.FAILED:
        return Message("there is no response: {reason}", {"reason": response.status.value})
    if response.time.size > MOST_SAMPLES:
        return (
            f"the response has {response.time.size} samples, more than the {MOST_SAMPLES} that are shown here; "
            "a motion with longer steps, a smaller body, or the command line"
        )
    return response


def response_series(response: Response, points: int, window: tuple[float, float] | None = None) -> dict[str, Any]:
    """Return the curves of a response, `ResponseSeries`, in a time window [s]."""
    states, curves = _states(response)
    kept = thinned(states, list(curves.values()), points, window)
    time = states[kept]
    return {
        "time": time,
        **{name: values[kept] for name, values in curves.items()},
        "ground_displacement": _moved(response, time),
        "samples_shown": int(time.size),
        "samples": int(states.size),
    }


def _states(response: Response) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return times and curves. Values after a jump have the next larger floating-point time."""
    dense_output = response.dense_output
    curves = _at_both_ends(response, dense_output)
    jumps = np.any([np.append(True, pairs[1:, 0] != pairs[:-1, 1]) for pairs in curves.values()], axis=0)
    turns, x = _turns(dense_output)
    late = np.nextafter(dense_output.start, np.inf)
    late[0] = dense_output.start[0]
    # for equal times, the first state is kept: the state before an event
    time = np.concatenate([dense_output.end, late[jumps], dense_output.start[turns] + x * dense_output.length[turns]])
    time, chosen = np.unique(time, return_index=True)
    turned = {
        "rotation": (dense_output.quintics()[turns] * x[:, None] ** np.arange(6)).sum(axis=1),
        "angular_velocity": np.zeros(x.size),
    }
    columns = {}
    for name, pairs in curves.items():
        between = turned.get(name, pairs[turns, 0] + x * (pairs[turns, 1] - pairs[turns, 0]))
        columns[name] = np.concatenate([pairs[:, 1], pairs[jumps, 0], between])[chosen]
    return time, columns


def _at_both_ends(response: Response, dense_output: DenseOutput) -> dict[str, FloatArray]:
    """Return all curves at both ends of every interval."""
    mass, settings = response.body.mass, response.settings
    kinetic, potential, work, lost = energies(dense_output, mass, settings)
    _, vertical, demand = forces(dense_output, settings.gravity)
    return {
        "rotation": dense_output.rotation,
        "angular_velocity": dense_output.velocity,
        "kinetic_energy": kinetic,
        "potential_energy": potential,
        "work_of_ground": work,
        "energy_lost": lost,
        "friction_demand": demand,
        "vertical_force": mass * vertical,
        "ground_acceleration": dense_output.push,
    }


def _turns(dense_output: DenseOutput) -> tuple[np.ndarray, FloatArray]:
    """Return intervals with a reversal of the rotation, and the position of the reversal in them, from 0 to 1."""
    at = np.flatnonzero(dense_output.velocity[:, 0] * dense_output.velocity[:, 1] < 0.0)
    c, (start, end) = dense_output.quintics()[at], dense_output.velocity[at].T
    x, power = start / (start - end), np.arange(6)
    for _ in range(_NEWTON_STEPS):
        slope = (c[:, 1:] * power[1:] * x[:, None] ** power[:5]).sum(axis=1)
        bend = (c[:, 2:] * (power[2:] * power[1:5]) * x[:, None] ** power[:4]).sum(axis=1)
        x = np.clip(x - np.divide(slope, bend, out=np.zeros_like(x), where=bend != 0.0), 0.0, 1.0)
    return at, x


def _moved(response: Response, time: FloatArray) -> FloatArray:
    """Return the displacement of the ground, which is constant after the end of the motion."""
    motion = response.motion
    if motion is None:
        return np.zeros_like(time)
    if isinstance(motion, Pulse):
        return response.scale * motion.displacement(np.minimum(time, motion.duration))
    return response.scale * np.interp(time, motion.time, ground_displacement(motion))


def thinned(
    time: FloatArray, curves: Sequence[FloatArray], points: int, window: tuple[float, float] | None = None
) -> IntArray:
    """Return the indices of samples for a figure without a visible difference from all samples.

    The time range is divided into equal intervals, one per pixel. Each interval keeps its first and last sample, the
    samples of the lowest and highest value of every curve, and one sample without a number. The curve covers the same
    pixels as all samples (Jugel et al. 2014, Proc. VLDB 7:797).

    The indices increase. With at most two samples per interval, all samples of the window are kept.
    """
    first, last = (time[0], time[-1]) if window is None else window
    begin, end = np.searchsorted(time, first, side="right") - 1, np.searchsorted(time, last) + 1
    inside = np.arange(max(begin, 0), min(end, time.size))
    if inside.size <= 2 * points:
        return inside
    run = np.clip((time[inside] - first) / (last - first) * points, -1, points).astype(np.int64)
    ends = np.flatnonzero(np.diff(run))
    kept = [inside[[0, -1]], inside[ends], inside[ends + 1]]
    for curve in curves:
        finite = np.isfinite(curve[inside])
        kept += [_ends_of_runs(curve, inside[rows], run[rows]) for rows in (finite, ~finite)]
    return np.unique(np.concatenate(kept))


def _ends_of_runs(curve: FloatArray, rows: IntArray, run: IntArray) -> IntArray:
    """Return the rows of the lowest and the highest value in every group of successive rows."""
    order = np.lexsort((curve[rows], run))
    starts = np.flatnonzero(np.diff(run[order], prepend=-2, append=-2)[:-1])
    last = np.append(starts[1:], order.size)[: starts.size] - 1
    return np.asarray(rows[order[np.concatenate([starts, last])]])
