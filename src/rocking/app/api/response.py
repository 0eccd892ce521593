"""POST /api/response: how the body rocks under every restitution that was chosen, with curves thinned for drawing."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from fastapi import APIRouter, Request

from rocking.app.answers import JsonAnswer
from rocking.app.errors import TooLarge
from rocking.app.question import Question, question_of
from rocking.app.records import RecordStore
from rocking.app.schemas.answers import answered
from rocking.app.schemas.inputs import ResponseAsked
from rocking.app.schemas.response_answers import ResponseAnswered
from rocking.app.settings import state_of
from rocking.app.work import heavy
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.dense_output import DenseOutput
from rocking.dynamics.plane.energy_balance import energies, forces
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.motions.integrals import ground_displacement
from rocking.motions.pulse import Pulse
from rocking.outcome import Outcome
from rocking.plots.animation_scene import DrawnShape, fall_of
from rocking.reports.body_facts import body_facts, outline_facts
from rocking.reports.response_facts import ModelAgreement, finite, moved_facts, response_facts

router = APIRouter(prefix="/api", tags=["response"])
_ABOUT = """\
One answer for every restitution, in the order in which they were chosen: the keys of `rocking simulate --json`, and
`series` as drawn over `points` dots, each with the extremes of every curve, between the two times of `window` if given;
states just before and just after every impact, and where the body turns round, are among them. `verdict` says
whether the choice of the model decides. A restitution that has no response for this body has `label` and `error`."""
MOST_SAMPLES = 500_000
"""Samples of a response whose forces and energy are computed here."""

MOST_TOGETHER = 3_000_000
"""Samples of all responses of one question, those after an overturning among them: they are computed as well."""

_NEWTON_STEPS = 8


@router.post(
    "/response",
    summary="How the body rocks",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(ResponseAnswered, "One answer for every restitution, and what they say together."),
)
async def response(request: Request, inputs: ResponseAsked) -> JsonAnswer:
    """Answer with responses, verdict, outline and motion."""
    return JsonAnswer(await heavy(request, _answer, inputs, state_of(request).records))


def _answer(inputs: ResponseAsked, records: RecordStore) -> dict[str, Any]:
    return ResponseAnswers.of(question_of(inputs, records)).facts(inputs.points, inputs.body.name, inputs.window)


@dataclass(frozen=True, slots=True)
class ResponseAnswers:
    """What every restitution makes of one question."""

    question: Question
    found: dict[str, Response | str]  # by label: the response, or why there is none

    @classmethod
    def of(cls, question: Question) -> "ResponseAnswers":
        """Compute the responses.

        Returns at least one of them is there.
        """
        found: dict[str, Response | str] = {}
        samples = 0
        for label, choice in question.restitutions.items():
            found[label] = tried = _tried(question, choice)
            samples += tried.segments.count if isinstance(tried, Response) else 0
            _refuse_long(samples, len(found), len(question.restitutions))
        reasons = [reason for reason in found.values() if isinstance(reason, str)]
        if len(reasons) == len(found):
            raise InvalidValueError(reasons[0])
        return cls(question, found)

    @property
    def responses(self) -> dict[str, Response]:
        """The responses that are there, by label."""
        return {label: one for label, one in self.found.items() if isinstance(one, Response)}

    def facts(self, points: int, name: str | None = None, window: tuple[float, float] | None = None) -> dict[str, Any]:
        """Return the answer of the API.

        window: the part of the time that is drawn [s].
        """
        asked, verdict = self.question, ModelAgreement.of(self.responses)
        return {
            "answers": [
                {"label": label, "error": one}
                if isinstance(one, str)
                else answer_facts(label, one, asked, points, window)
                for label, one in self.found.items()
            ],
            "verdict": {"decides": verdict.decides, "sentence": verdict.sentence},
            "body": {"name": name, **body_facts(asked.body, asked.settings.gravity), **outline_facts(asked.body)},
            "motion": moved_facts(asked.motion, asked.scale),
        }


def answer_facts(
    label: str, response: Response, question: Question, points: int, window: tuple[float, float] | None = None
) -> dict[str, Any]:
    """Return one response as the API tells it.

    window: the part of the time that is drawn [s]. Returns what `rocking.reports.response_facts.response_facts` says,
    with ``label``, ``series`` and ``fall``.
    """
    facts = response_facts(response, question.assumed_friction)
    series = response_series(response, points, window)
    return {"label": label, **facts, "series": series, "fall": fall_series(response)}


def _refuse_long(samples: int, done: int, asked: int) -> None:
    if samples > MOST_TOGETHER:
        raise TooLarge(
            f"{done} of {asked} responses together take {samples} steps, more than the {MOST_TOGETHER} that are "
            "computed at once; fewer restitutions, a motion with longer steps, or the command line"
        )


def _tried(question: Question, restitution: Any) -> Response | str:
    try:
        response = question.answer(restitution)
    except InvalidValueError as error:
        return str(error)
    if response.outcome is Outcome.FAILED:
        return f"there is no response: {response.status.value}"
    if response.time.size > MOST_SAMPLES:
        return (
            f"the response has {response.time.size} samples, more than the {MOST_SAMPLES} that are shown here; "
            "a motion with longer steps, a smaller body, or the command line"
        )
    return response


def response_series(response: Response, points: int, window: tuple[float, float] | None = None) -> dict[str, Any]:
    """Return the curves of a response.

    window: the part of the time that is drawn [s]. Returns ``time``, ``rotation``, ``velocity``, ``kinetic``,
    ``potential``, ``work``, ``lost``, ``friction_demand`` (None where it is infinite), ``vertical_force``,
    ``ground_acceleration``, ``ground_displacement``: SI units; and ``shown`` of how many states (``of``): samples,
    events with the states before and after them, and where the body turns round.
    """
    whole, curves = _states(response)
    kept = thinned(whole, list(curves.values()), points, window)
    time, columns = whole[kept], {name: values[kept].tolist() for name, values in curves.items()}
    return {
        "time": time.tolist(),
        **columns,
        "friction_demand": [finite(value) for value in columns["friction_demand"]],
        "ground_displacement": _moved(response, time).tolist(),
        "shown": int(time.size),
        "of": int(whole.size),
    }


def fall_series(response: Response) -> dict[str, Any]:
    """Return how the fall of a response goes on after its curves end.

    Returns ``time`` [s] and ``rotation`` [rad], empty if there is no more to fall; ``lying``: the rotations at which
    the body lies on its left and on its right side [rad].
    """
    lying = DrawnShape.of(response.body).lying
    fall = fall_of(response, lying)
    return {"time": fall.time[1:].tolist(), "rotation": fall.rotation[1:].tolist(), "lying": list(lying)}


def _states(response: Response) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return times and curves; what comes after a jump stands the smallest step of time after it."""
    dense_output = response.dense_output
    curves = _at_both_ends(response, dense_output)
    jumps = np.any([np.append(True, each[1:, 0] != each[:-1, 1]) for each in curves.values()], axis=0)
    turns, x = _turns(dense_output)
    late = np.nextafter(dense_output.start, np.inf)
    late[0] = dense_output.start[0]
    # of those at one instant the first stays: the state before an event, at it
    time = np.concatenate([dense_output.end, late[jumps], dense_output.start[turns] + x * dense_output.length[turns]])
    time, chosen = np.unique(time, return_index=True)
    turned = {
        "rotation": (dense_output.quintics()[turns] * x[:, None] ** np.arange(6)).sum(axis=1),
        "velocity": np.zeros(x.size),
    }
    columns = {}
    for name, each in curves.items():
        between = turned.get(name, each[turns, 0] + x * (each[turns, 1] - each[turns, 0]))
        columns[name] = np.concatenate([each[:, 1], each[jumps, 0], between])[chosen]
    return time, columns


def _at_both_ends(response: Response, dense_output: DenseOutput) -> dict[str, FloatArray]:
    """Return every curve at the start and at the end of every interval."""
    mass, settings = response.body.mass, response.settings
    kinetic, potential, work, lost = energies(dense_output, mass, settings)
    _, vertical, demand = forces(dense_output, settings.gravity)
    return {
        "rotation": dense_output.rotation,
        "velocity": dense_output.velocity,
        "kinetic": kinetic,
        "potential": potential,
        "work": work,
        "lost": lost,
        "friction_demand": demand,
        "vertical_force": mass * vertical,
        "ground_acceleration": dense_output.push,
    }


def _turns(dense_output: DenseOutput) -> tuple[np.ndarray, FloatArray]:
    """Return in which intervals the body turns round, and where within them, from 0 to 1."""
    at = np.flatnonzero(dense_output.velocity[:, 0] * dense_output.velocity[:, 1] < 0.0)
    c, (start, end) = dense_output.quintics()[at], dense_output.velocity[at].T
    x, power = start / (start - end), np.arange(6)
    for _ in range(_NEWTON_STEPS):
        slope = (c[:, 1:] * power[1:] * x[:, None] ** power[:5]).sum(axis=1)
        bend = (c[:, 2:] * (power[2:] * power[1:5]) * x[:, None] ** power[:4]).sum(axis=1)
        x = np.clip(x - np.divide(slope, bend, out=np.zeros_like(x), where=bend != 0.0), 0.0, 1.0)
    return at, x


def _moved(response: Response, time: FloatArray) -> FloatArray:
    """Return the displacement of the ground, which is taken to stay where the motion ends."""
    motion = response.motion
    if motion is None:
        return np.zeros_like(time)
    if isinstance(motion, Pulse):
        return response.scale * motion.displacement(np.minimum(time, motion.duration))
    return response.scale * np.interp(time, motion.time, ground_displacement(motion))


def thinned(
    time: FloatArray, curves: Sequence[FloatArray], points: int, window: tuple[float, float] | None = None
) -> IntArray:
    """Return which samples of some curves to keep, so that a picture of them loses nothing that can be seen.

    The time that is shown is divided into equal runs, one for each dot of the picture. Of each run its first and its
    last sample and the lowest and the highest of every curve are kept, and one where a curve has no number: what is
    drawn covers the same dots as all samples would (Jugel et al. 2014, Proc. VLDB 7:797), whatever happens within one.

    Returns increasing indices; all in the window where it has no more than two samples for each run.
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
        known = np.isfinite(curve[inside])
        kept += [_ends_of_runs(curve, inside[rows], run[rows]) for rows in (known, ~known)]
    return np.unique(np.concatenate(kept))


def _ends_of_runs(curve: FloatArray, rows: IntArray, run: IntArray) -> IntArray:
    """Return the rows of the lowest and the highest value in every run."""
    order = np.lexsort((curve[rows], run))
    starts = np.flatnonzero(np.diff(run[order], prepend=-2, append=-2)[:-1])
    last = np.append(starts[1:], order.size)[: starts.size] - 1
    return np.asarray(rows[order[np.concatenate([starts, last])]])
