"""Histories for all combinations of plane bodies without friction, motions, scales, restitutions and starts."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.combined import dataset_of, label_of, plane_inputs
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics_base import Combinations
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.dynamics.plane.batch import RowsInPlane
from rocking.dynamics.plane.fast_engine import instruction_set
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.plane_frictional.base import Start, rocking_start
from rocking.dynamics.response import start_within
from rocking.dynamics.rows import Rows, law_of_rows, run_rows
from rocking.dynamics.settings import SHORTEST_STEP, thread_count
from rocking.errors import InvalidValueError
from rocking.outcome import contact_words, flags, overturned

if TYPE_CHECKING:
    import xarray as xr


def rocking_alone(cases: Combinations, settings: PlaneSettings) -> "xr.Dataset":
    """Return the outcome of all combinations of plane bodies without friction, with the integration error."""
    bodies, motions, scales, starts = plane_inputs(cases)
    restitutions = cases.restitutions
    laws = [item for item in restitutions if isinstance(item, ImpactLaw)]
    if laws and len(restitutions) > 1:
        raise InvalidValueError("a law that changes from impact to impact must be the only restitution of a call")
    law = laws[0] if laws else ConstantRestitution()
    all_parameters = [
        [RockingParameters.of_body(body, item, settings.gravity) for item in restitutions] for body in bodies
    ]
    states = np.array([rocking_start(item) for item in starts or [Start()]])
    for row in all_parameters if starts else ():
        for state in states.tolist():
            start_within(row[0], *state)
    shape = (len(bodies), len(motions), scales.size, len(restitutions), len(states))
    segments, threads, count = [m.segments() for m in motions], thread_count(cases.threads), int(np.prod(shape))
    rows, fixed = _pieces(all_parameters, scales, states, shape), law_of_rows(law)
    runner = RowsInPlane(segments, fixed, settings, cases.engine)
    results, work = run_rows(runner, law, count, rows, threads, cases.progress)
    if cases.twin:
        finer = replace(settings, longest_step=max(SHORTEST_STEP, 0.5 * settings.longest_step))
        halved = RowsInPlane([item.refined(2) for item in segments], fixed, finer, cases.engine)
        twin, _ = run_rows(halved, law, count, rows, threads)
        change = np.abs(np.abs(results["peak_rotation"]) - np.abs(twin["peak_rotation"]))  # NaN without two results
        flips = np.abs(overturned(results["outcome"]) - overturned(twin["outcome"]))
        results |= {"twin_change": change, "twin_flips": flips}
    results |= flags(results)
    labels = list(map(label_of, restitutions))
    if law.kind:  # use the label of the body with the strongest truncation
        labels = [min((row[0] for row in all_parameters), key=lambda p: min(p.left.share, p.right.share)).label]
    attributes = {
        "engine": f"fast ({instruction_set()})" if work else "reference",
        "contact": contact_words(results["lost_contact"]),
        "seed": getattr(law, "seed", 0),
        **{f"work_{k}": v for k, v in work.items()},
    }
    axes = {"scale": scales, "restitution": labels, "start": starts}
    return dataset_of(bodies, motions, axes, results, settings, attributes)


def _pieces(
    all_parameters: list[list[RockingParameters]], scales: FloatArray, states: FloatArray, shape: tuple[int, ...]
) -> Callable[[int, int], Rows]:
    both = sides_of([parameters for row in all_parameters for parameters in row])
    table = {name: values.reshape(shape[0], shape[3]) for name, values in both.items()}

    def rows(first: int, last: int) -> Rows:
        body, motion, factor, choice, start = np.unravel_index(np.arange(first, last), shape)
        values = {name: array[body, choice] for name, array in table.items()}
        values |= {"rotation": states[start, 0], "velocity": states[start, 1]}
        return Rows.of(last - first, motion, np.arange(first, last), scale=scales[factor], **values)

    return rows
