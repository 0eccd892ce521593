"""Bodies under harmonic ground motion for tests of long-run dynamics, and their bifurcations.

Amplitudes are a / (g tan alpha) of a rectangle, or a / (g alpha) of a slender body; frequencies over p; H Housner,
K KED.
"""

import numpy as np

from rocking import Block, MassPoints, simulate
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.motions.pulse import Sinusoids
from rocking.studies.longrun.continuation import branch_off, continue_orbit
from rocking.studies.longrun.orbits import symmetric_orbit
from rocking.studies.longrun.system import HarmonicRocking

ANYTHING = (0.0, 100.0)
LEANING = MassPoints([[-0.48, 0.0], [0.52, 0.0], [0.5, 4.0], [-0.5, 4.0]], [1.0] * 4, feet=(-0.48, 0.52))
BY_SPEED = SpeedRestitution(at=[0.0, 5.0], factors=[1.0, 0.6], times=0.9)
MODELS = {"H": "housner", "K": "ked"}


def system_of(slenderness, amplitude, frequency, restitution, **options):
    """Return a rectangle under harmonic ground motion."""
    body = Block(width=1.0, height=float(slenderness))
    return HarmonicRocking.of_ratios(body, amplitude, frequency, restitution=restitution, **options)


def grid(phases, speeds):
    """Return all combinations of phases and speeds, shape (2, combinations)."""
    return np.stack(np.meshgrid(phases, speeds, indexing="ij")).reshape(2, -1)


def is_kind(kind):
    """Return a test of the kind of a bifurcation."""
    return lambda item: item.kind == kind


def cascade(system, doublings):
    """Return fold, pitchfork and period doublings of the symmetric orbit."""
    orbit = symmetric_orbit(system)
    fold = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold")).first("fold")
    pitchfork = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork")).first("pitchfork")
    bifurcations = [fold, pitchfork]
    for step in (0.03, 0.01, 0.003, 0.001)[:doublings]:
        branch = branch_off(bifurcations[-1], ANYTHING, step=step, stop=is_kind("period doubling"))
        bifurcations.append(branch.first("period doubling"))
    return bifurcations


def response_by_reference(system, phase, speed, side, duration):
    """Return the response after a start on one foot, by the reference engine in pure Python."""
    motion, rate = system.excitation, system.alpha * system.p
    wave = (motion.amplitude, motion.frequency, phase)
    ground = Sinusoids("harmonic", (wave,), duration, motion.amplitude, motion.amplitude, motion.period)
    return simulate(
        system.body, ground, system.restitution, angular_velocity=side * speed * rate, duration=duration,
        linear=system.linear, gravity=system.gravity, engine="reference", rest_speed=0.0,
    )  # fmt: skip
