"""A motion as tables: its curves, its intensity measures, its response spectrum."""

import numpy as np

from rocking.app.takeaway.table_files import column, table
from rocking.dynamics.response import Motion
from rocking.motions.integrals import ground_displacement, ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import SHORTEST_PERIOD, response_spectrum
from rocking.plots.traces import fine_samples, traces
from rocking.reports.motion_facts import measures_of
from rocking.tables import Table

DAMPING = 0.05
"""Damping ratio of the spectrum [-]."""

_LONGEST, _SHORTEST, _COUNT = 10.0, 0.03, 100


def motion_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return time, acceleration, velocity and displacement; those of a pulse as its formulas give them."""
    if isinstance(motion, GroundMotion):
        curves = {"acceleration": motion.acceleration, "velocity": ground_velocity(motion)}
        curves |= {"displacement": ground_displacement(motion)}
        time = motion.time
    else:
        fine = traces(motion)
        time = fine.time
        curves = {"acceleration": fine.acceleration, "velocity": fine.velocity, "displacement": fine.displacement}
    units = {"acceleration": "m/s2", "velocity": "m/s", "displacement": "m"}
    columns = {"time": column("s", time), **{name: column(units[name], each) for name, each in curves.items()}}
    if isinstance(motion, GroundMotion) and motion.vertical is not None:
        columns["vertical_acceleration"] = column("m/s2", motion.vertical)
    return table(columns, about)


def measures_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return the intensity measures of a motion."""
    found = measures_of(motion, fine_samples(motion))
    columns = {
        "motion": column("", [motion.name] * len(found)),
        "key": column("", list(found)),
        "measure": column("", [one.name for one in found.values()]),
        "value": column("unit of its row", [one.value for one in found.values()]),
        "unit": column("", ["1" if one.unit == "-" else one.unit for one in found.values()]),
    }
    return table(columns, about)


def spectrum_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return the response spectrum of a motion for 5 % damping."""
    samples = fine_samples(motion)
    # the periods of the picture on the screen
    shortest = max(_SHORTEST, SHORTEST_PERIOD * samples.time_step)
    periods = np.geomspace(shortest, max(_LONGEST, 2.0 * shortest), _COUNT)
    found = response_spectrum(samples, periods, DAMPING)
    columns = {
        "period": column("s", found.periods),
        "pseudo_acceleration": column("m/s2", found.pseudo_acceleration),
        "pseudo_velocity": column("m/s", found.pseudo_velocity),
        "displacement": column("m", found.displacement),
        "absolute_acceleration": column("m/s2", found.absolute_acceleration),
    }
    return table(columns, {**about, "damping ratio": repr(DAMPING)})
