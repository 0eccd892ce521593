"""Pulses
======

All pulses and their effect on the same block. Acceleration, velocity, displacement and the times of all events are
exact. For users who need a motion with a formula.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write

# %%
# All pulses have the same peak [m/s2] and a similar duration. The last pulse is defined by its velocity, as
# near-fault pulses are.

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
outcomes = [rk.simulate(block, pulse, restitution="housner") for pulse in pulses]
for pulse, response in zip(pulses, outcomes, strict=True):
    print(f"{pulse.name:45s} {response.outcome.value}, {len(response.impacts)} impact(s)")

# %%
# The formulas can be evaluated at any time.

middle = pulses[2]
print(f"displacement after a sine of 1 s: {middle.displacement(1.0):.12f} m")
assert middle.velocity(1.0) == 0.0 or abs(middle.velocity(1.0)) < 1e-15
assert abs(middle.displacement(1.0) - 4.0 / (2.0 * np.pi)) < 1e-12  # a_p T^2 / (2 pi)

# %%
# Two pulses with the same peak and period have different effects on a block. The displacement of the ground during
# uplift is decisive.

with journal_style():
    figure, axes = new_figure(7.0, 5.6, rows=4, columns=3)
    for panel, pulse, response in zip(axes, pulses, outcomes, strict=False):
        time = np.linspace(0.0, pulse.duration, 400)
        panel.plot(time, pulse.acceleration(time), label="acceleration [m/s2]")
        panel.plot(time, 5.0 * pulse.velocity(time), "--", label="5 x velocity [m/s]")
        panel.plot(time, 5.0 * pulse.displacement(time), "-.", label="5 x displacement [m]")
        fell = response.outcome is rk.Outcome.OVERTURNED
        words = pulse.name.split(",")[0].removesuffix(" pulse").removesuffix(" wavelet")
        panel.set_title(
            f"{words}: {'overturns' if fell else 'stands'}", loc="left", color="#A23B00" if fell else "black"
        )
    for panel in axes[len(pulses) :]:
        panel.set_axis_off()
    axes[-1].legend(*axes[0].get_legend_handles_labels(), loc="center")
    axes[9].set_xlabel("time [s]")
write(figure, "pulses_of_every_kind.png")
