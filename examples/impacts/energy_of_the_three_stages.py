"""Energy loss in the three stages of KED
======================================

The model of Mao et al. (2024) has three stages. The pictures show the distribution of the kinetic energy in the body
after each stage. For readers of the paper.
"""

import rocking as rk
from rocking.plots import energy_stages_picture, write

# %%
# A tapered pedestal with a hole: an outline [m], a density [kg/m3], a hole.

outline = rk.bodies.shapes.trapezoid(base=1.0, top=0.5, height=2.5)
hollow = [(0.4, 0.4), (0.6, 0.4), (0.6, 1.6), (0.4, 1.6)]
pedestal = rk.Section.from_points(outline, density=2700.0, holes=[hollow])

# %%
# First the vertical velocities are lost, then the components along the lines to the new foot. The remaining energy
# becomes rotation about the new foot.

balance = rk.restitution.energy_balance(pedestal, foot="right", angular_velocity=0.5)
for stage, fraction in balance.fractions.items():
    print(f"{stage:8s} {balance.totals[stage]:9.2f} J  {fraction:7.2%}")

fractions = list(balance.fractions.values())
assert fractions[0] == 1.0
assert fractions[0] > fractions[1] > fractions[2]
assert abs(fractions[2] - fractions[3]) < 1e-12

# %%
# The density of the kinetic energy and the velocities, before the impact and after each stage.

write(energy_stages_picture(pedestal), "energy_of_the_three_stages.png")
