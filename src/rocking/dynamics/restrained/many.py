"""All combinations of bodies with restraints, motions, scales, restitutions and starts."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, quantities
from rocking.bodies.restrained import Restrained, without_walls
from rocking.conventions import FloatArray
from rocking.dynamics.combined import dataset_of, label_of, plane_inputs
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.mechanics_base import Combinations
from rocking.dynamics.plane_frictional.base import Start, rocking_start
from rocking.dynamics.response import start_within
from rocking.dynamics.restrained.devices import parameters_of
from rocking.dynamics.restrained.engines import RESTRAINT_RESULTS, RESULTS, RestrainedHistory, run_rows
from rocking.dynamics.restrained.settings import RestrainedSettings
from rocking.dynamics.settings import thread_count
from rocking.errors import InvalidValueError
from rocking.outcome import of_results, overturned

if TYPE_CHECKING:
    import xarray as xr

COLUMNS = (*RESULTS, *RESTRAINT_RESULTS, "overturned")
AFTER = 15.0  # product of p and the duration after the motion


def many_with_restraints(cases: Combinations, settings: RestrainedSettings) -> "xr.Dataset":
    """Return the outcome of all combinations, with extremes of all restraints."""
    bodies, motions, scales, starts = plane_inputs(cases, (Restrained,))
    for body in bodies:
        without_walls(body)
    restitutions = cases.restitutions
    if any(isinstance(item, ImpactLaw) for item in restitutions):
        raise InvalidValueError(
            "{parameter} must be constant for many bodies with restraints", parameter="restitution",
            value=label_of(restitutions[0]),
        )  # fmt: skip
    if cases.duration is not None:
        checks.positive("duration", cases.duration, "s")
    table: Any = [[parameters_of(body, item, settings.gravity) for item in restitutions] for body in bodies]
    states = [rocking_start(item) for item in starts or [Start()]]
    for row in table:
        for state in states:
            start_within(row[0], *state)
    shape = (len(bodies), len(motions), scales.size, len(restitutions), len(states))
    histories = []
    for body, motion, scale, choice, start in np.ndindex(shape):
        parameters = table[body][choice]
        slow = min(parameters.right.frequency_parameter, parameters.left.frequency_parameter)
        length = cases.duration or motions[motion].duration + AFTER / slow
        histories.append(
            RestrainedHistory(bodies[body], parameters, motion, states[start], float(scales[scale]), length)
        )
    segments = [motion.segments() for motion in motions]
    engine, results, restraints = run_rows(
        histories, segments, settings, engine=cases.engine, threads=thread_count(cases.threads), progress=cases.progress
    )
    results["overturned"] = overturned(results["outcome"])
    results["still_rocking"] = of_results(results["outcome"], results["still_rocking"])
    axes = {"scale": scales, "restitution": list(map(label_of, restitutions)), "start": starts}
    dataset = dataset_of(bodies, motions, axes, results, settings, {"engine": engine})
    return _with_restraints(dataset, restraints, bodies)


def _with_restraints(dataset: "xr.Dataset", values: dict[str, FloatArray], bodies: list[Any]) -> "xr.Dataset":
    """Add the results of restraints to the dataset. They have one more dimension, padded with NaN."""
    dims = (*dataset["outcome"].dims, "restraint")
    shape = (*dataset["outcome"].shape, -1)
    for name, array in values.items():
        dataset[name] = (dims, array.reshape(shape), quantities.attributes(name))
    names = max((body.restraints for body in bodies), key=len)
    return dataset.assign_coords(restraint=[item.name for item in names])
