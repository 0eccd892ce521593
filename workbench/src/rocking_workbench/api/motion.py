"""POST /api/motion: properties and intensity of a motion."""

from typing import Any, Literal

import numpy as np
from fastapi import APIRouter, Request
from pydantic import Field

from rocking import GroundMotion
from rocking.answers import Answer
from rocking.motions import ResponseSpectrum, response_spectrum
from rocking.motions.spectrum import SHORTEST_PERIOD
from rocking.plots.labels import fine_samples, traces
from rocking.reports.response_facts import measures_of, record_answer, spectrum_answer
from rocking_workbench.answers import JsonAnswer, Units, answered, shape
from rocking_workbench.api.response import thinned
from rocking_workbench.inputs import MotionRequest, motion_from
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import state_of
from rocking_workbench.work import Remembered, heavy

router = APIRouter(prefix="/api", tags=["motion"])
_HELD: Remembered[JsonAnswer] = Remembered(32)

DAMPING = 0.05  # damping ratio of the spectrum [-]

_LONGEST, _SHORTEST, _COUNT = 10.0, 0.03, 100

MotionSeries: Any = shape(
    "MotionSeries",
    "Curves of a motion, with equal numbers of samples and all extremes.",
    "time[] acceleration[]",
    velocity=(list[float], "velocity"),
    displacement=(list[float], "displacement"),
    vertical_acceleration=(list[float] | None, Field(None, description="null without a vertical component [m/s2]")),
    samples_shown=int,
    samples=int,
)
SpectrumFacts: Any = shape(
    "SpectrumFacts",
    "The response of oscillators to a motion.",
    "damping_ratio period[] pseudo_acceleration[] pseudo_velocity[] spectral_displacement[] absolute_acceleration[]",
)
MeasureFacts: Any = shape(
    "MeasureFacts",
    "One intensity measure.",
    name=(str, "short name: pga, pgv, ..."),
    description=str,
)
MotionAnswered: Any = shape(
    "MotionAnswered",
    "Properties, intensity and curves of a motion.",
    "name duration warnings[] provenance[] peak_ground_acceleration",
    kind=Literal["record", "pulse"],
    format=str | None,
    event=str | None,
    station=str | None,
    component=str | None,
    vertical_component=str | None,
    file_unit=(str | None, "unit of the file; the answer is in SI"),
    samples=(int | None, "of a record"),
    time_step=(float | None, "of a record"),
    peak_vertical_acceleration=float | None,
    intensity=(dict[str, float], "measures by their names, in their units"),
    scale=(float, "factor on the motion, which is in every number here"),
    series=MotionSeries,
    spectrum=(SpectrumFacts | None, "null if not requested"),
    measures=list[MeasureFacts],
    units=Units,
)


@router.post("/motion", summary="Properties of a motion", responses=answered(MotionAnswered, "The motion."))
async def motion(request: Request, inputs: MotionRequest) -> JsonAnswer:
    """Return the keys of `rocking record show --json` except its spectrum.

    `series` contains the extremes of every curve in `points` intervals, between both times of `window` if stated.
    `spectrum` has 100 periods and 5 % damping. `measures` is a list.
    """
    return await heavy(request, _answer, inputs, state_of(request).records)


def _answer(inputs: MotionRequest, records: RecordStore) -> JsonAnswer:
    if inputs.motion.record is not None:
        records.get(inputs.motion.record)  # raises an error for a deleted record, even if its answer is cached
    return _HELD.get(inputs.model_dump_json(exclude_unset=True), lambda: JsonAnswer(_facts(inputs, records)))


def _facts(inputs: MotionRequest, records: RecordStore) -> Answer:
    motion = motion_from(inputs.motion, records)
    moved = motion if inputs.motion.scale == 1.0 else motion.scaled(inputs.motion.scale)
    samples, curves = fine_samples(moved), traces(moved)
    measures = measures_of(moved, samples, curves)
    columns = {name: getattr(curves, name) for name in ("acceleration", "velocity", "displacement")}
    if isinstance(moved, GroundMotion) and samples.vertical is not None:
        columns["vertical_acceleration"] = np.interp(curves.time, moved.time, samples.vertical)
    kept = thinned(curves.time, list(columns.values()), inputs.points, inputs.window)
    columns = {"time": curves.time, **columns}
    return record_answer(moved, samples, measures) | {
        "name": motion.name,  # name of the unscaled motion
        "scale": inputs.motion.scale,
        "peak_ground_acceleration": moved.peak,
        "series": {
            **{name: values[kept] for name, values in columns.items()},
            "samples_shown": int(kept.size),
            "samples": int(curves.time.size),
        },
        "spectrum": spectrum_answer(spectrum_of(samples)) if inputs.spectrum else None,
        "measures": [{"name": key, "description": measure.name} for key, measure in measures.items()],
    }


def spectrum_of(samples: GroundMotion) -> ResponseSpectrum:
    """Return the response spectrum of the figure: 100 periods, 5 % damping."""
    shortest = max(_SHORTEST, SHORTEST_PERIOD * samples.time_step)
    return response_spectrum(samples, np.geomspace(shortest, max(_LONGEST, 2.0 * shortest), _COUNT), DAMPING)
