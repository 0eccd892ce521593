"""Impact on a contact bed
=======================

A block lands on damped springs, and the coefficient of restitution is a result: it depends on the contact points, the
speed, and the unevenness of the base. For researchers who study the scatter of measured coefficients.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write
from rocking.studies.impact_laboratory import Laboratory, bed_speed_law, study

# %%
# Contact points: with two points, at the edges, the result is the classical value. More points reduce the energy
# loss.

by_points = study("points", [2, 3, 5, 11, 41])
print("r by contact points   ", by_points.coefficient.round(3).values)
assert abs(by_points.coefficient.values[0] - 0.7) < 2e-3
assert np.all(np.diff(by_points.coefficient.values[:5]) > 0.0)

# %%
# Landing speed, from increasing initial rotations (relative to alpha). The effect is small.

by_speed = study("release", [0.1, 0.3, 0.6], Laboratory(slenderness=3.0))
print("r by landing velocity ", by_speed.coefficient.round(3).values)

# %%
# Unevenness of the base: for a base of 0.2 m a hollow of 0.1 mm has an effect, and a hollow of 1 mm is close to two
# points.

hollow = study("amplitude", [0.0, 1e-4, 1e-3], shape="concave")
print("r by hollow of a base ", hollow.coefficient.round(3).values)

with journal_style():
    figure, axes = new_figure(7.0, 2.4, columns=3, sharey=True)
    axes[0].plot(by_points.points, by_points.coefficient, "o-")
    axes[1].plot(by_speed.landing_velocity, by_speed.coefficient, "o-")
    axes[2].plot(1e3 * hollow.amplitude, hollow.coefficient, "o-")
    for panel, words in zip(axes, ("contact points [-]", "landing velocity [rad/s]", "hollow [mm]"), strict=True):
        panel.set_xlabel(words)
    axes[0].set(ylabel="coefficient of restitution r [-]", ylim=(0.65, 1.0))
    axes[1].set_title("h/b = 3", loc="left")
write(figure, "impact_laboratory.png")

# %%
# The result is also a restitution model, and a velocity-dependent law for `rk.simulate` and `rk.free_rocking`.

block = rk.Block(width=0.2, height=0.4)
bed = rk.restitution.model("contact-bed", points=41)
print("the same as a model   ", round(bed.coefficient(block), 3))
assert abs(bed.coefficient(block) - by_points.coefficient.values[-1]) < 0.01

response = rk.free_rocking(block, 0.2, restitution=bed_speed_law(block, 400.0))
print("impacts of free rocking", len(response.impacts))
