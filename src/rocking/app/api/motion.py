"""POST /api/motion: what a motion is and how strong."""

from typing import Any

import numpy as np
from fastapi import APIRouter, Request

from rocking.app.answers import JsonAnswer
from rocking.app.api.response import thinned
from rocking.app.question import motion_from
from rocking.app.records import RecordStore
from rocking.app.schemas.answers import MotionAnswered, answered
from rocking.app.schemas.inputs import MotionAsked
from rocking.app.settings import state_of
from rocking.app.work import Remembered, heavy
from rocking.conventions import FloatArray
from rocking.motions.intensity import Measure
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import SHORTEST_PERIOD, response_spectrum
from rocking.plots.traces import Traces, fine_samples, traces
from rocking.reports.motion_facts import measures_of, motion_facts

router = APIRouter(prefix="/api", tags=["motion"])

_ABOUT = """\
The keys of `rocking motion --json` but its spectrum; `series` as drawn over `points` dots, each with the extremes of
every curve, between the two times of `window` if given; `spectrum` at 100 periods for 5 % damping; `measures` as a
list."""

_HELD: Remembered[JsonAnswer] = Remembered(32)

DAMPING = 0.05
_LONGEST, _SHORTEST, _COUNT = 10.0, 0.03, 100


@router.post(
    "/motion",
    summary="What a motion is",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(MotionAnswered, "The motion."),
)
async def motion(request: Request, asked: MotionAsked) -> JsonAnswer:
    """Answer with facts, curves, spectrum and measures."""
    return await heavy(request, _answer, asked, state_of(request).records)


def _answer(asked: MotionAsked, records: RecordStore) -> JsonAnswer:
    if asked.motion.record is not None:
        records.get(asked.motion.record)  # what was deleted is gone, even if its answer is still held
    return _HELD.get(asked.model_dump_json(exclude_unset=True), lambda: JsonAnswer(_facts(asked, records)))


def _facts(asked: MotionAsked, records: RecordStore) -> dict[str, Any]:
    chosen = motion_from(asked.motion, records)
    moved = chosen if asked.motion.scale == 1.0 else chosen.scaled(asked.motion.scale)
    samples, curves = fine_samples(moved), traces(moved)
    measures = measures_of(moved, samples, curves)
    return {
        **motion_facts(moved, samples, measures),
        "scale": asked.motion.scale,
        "peak_acceleration_m_s2": moved.peak,
        "series": _series(curves, samples.vertical if isinstance(moved, GroundMotion) else None, moved, asked),
        "spectrum": _spectrum(samples) if asked.spectrum else None,
        "measures": [_measure(key, one) for key, one in measures.items()],
    }


def _series(curves: Traces, vertical: FloatArray | None, moved: Any, asked: MotionAsked) -> dict[str, Any]:
    columns = {name: getattr(curves, name) for name in ("acceleration", "velocity", "displacement")}
    if vertical is not None:
        columns["vertical"] = np.interp(curves.time, moved.time, vertical)
    kept = thinned(curves.time, list(columns.values()), asked.points, asked.window)
    found: dict[str, Any] = {name: values[kept].tolist() for name, values in columns.items()}
    return {"time": curves.time[kept].tolist(), **found, "shown": int(kept.size), "of": int(curves.time.size)}


def _spectrum(samples: GroundMotion) -> dict[str, Any]:
    shortest = max(_SHORTEST, SHORTEST_PERIOD * samples.time_step)
    periods = np.geomspace(shortest, max(_LONGEST, 2.0 * shortest), _COUNT)
    found = response_spectrum(samples, periods, DAMPING)
    return {
        "damping_ratio": found.damping,
        "period": found.periods.tolist(),
        "acceleration": found.pseudo_acceleration.tolist(),
        "velocity": found.pseudo_velocity.tolist(),
        "displacement": found.displacement.tolist(),
        "absolute_acceleration": found.absolute_acceleration.tolist(),
    }


def _measure(key: str, one: Measure) -> dict[str, Any]:
    return {"name": key, "value": one.value, "unit": one.unit, "words": one.name}
