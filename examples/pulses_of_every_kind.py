"""Pulses of every kind
====================

Every pulse of the catalogue, with exact acceleration, velocity and displacement, and what it does to a block.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking.plots import write
from rocking.plots.style import new_figure

block = rk.Block(width=0.5, height=2.0)
pulses = [
    rk.pulses.rectangular(4.0, duration=0.3),
    rk.pulses.half_sine(4.0, period=1.0),
    rk.pulses.sine(4.0, period=1.0),
    rk.pulses.cosine(4.0, period=1.0),
    rk.pulses.type_a(4.0, period=1.0),
    rk.pulses.type_b(4.0, period=1.0),
    rk.pulses.type_c(4.0, period=1.0, n=1),
    rk.pulses.ricker(4.0, period=1.0),
    rk.pulses.antisymmetric_ricker(4.0, period=1.0),
    rk.pulses.mavroeidis_papageorgiou(velocity=0.6, period=1.0, cycles=2.0, phase=0.5),
]
figure, axes = new_figure(7.0, 9.0, rows=5, columns=2)
for axis, pulse in zip(axes, pulses, strict=True):
    time = np.linspace(0.0, pulse.duration, 400)
    for label, values in (
        ("a [m/s2]", pulse.acceleration),
        ("10 v [m/s]", pulse.velocity),
        ("10 d [m]", pulse.displacement),
    ):
        axis.plot(time, values(time) * (1.0 if label[0] == "a" else 10.0), label=label)
    outcome = rk.simulate(block, pulse, restitution="housner")
    axis.set_title(f"{pulse.name}\n{outcome.outcome.value}, {len(outcome.impacts)} impacts", fontsize=7, loc="left")
    print(f"{pulse.name:60s} {outcome.summary}")
axes[0].legend(fontsize=6)
for axis in axes:
    axis.tick_params(labelsize=7)
    axis.locator_params(axis="x", nbins=6)
for axis in axes[-2:]:
    axis.set_xlabel("time [s]")

middle = pulses[2]
assert middle.velocity(1.0) == 0.0 or abs(middle.velocity(1.0)) < 1e-15
assert abs(middle.displacement(1.0) - 4.0 / (2.0 * np.pi)) < 1e-12  # a_p T^2 / (2 pi)
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(figure, folder / "pulses_of_every_kind.png")
