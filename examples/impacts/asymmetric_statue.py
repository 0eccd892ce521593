"""Asymmetric statue
=================

A body without symmetry has two slenderness angles, two uplift accelerations, and two coefficients of restitution. For
conservators and engineers with bodies that are not rectangles.
"""

import rocking as rk
from rocking import conventions
from rocking.plots import body_picture, write

# %%
# A section consists of regions: an outline [m], `y` upwards from the ground, and a density [kg/m3]. The feet are the
# points of contact. Here they are inside the edges of the pedestal.

pedestal = rk.Region(rk.bodies.shapes.rectangle(0.8, 0.6), density=2700.0)
figure = rk.Region([(0.15, 0.6), (0.60, 0.6), (0.72, 1.9), (0.45, 2.3), (0.28, 1.9)], density=2400.0)
statue = rk.Section([pedestal, figure], feet=(0.05, 0.75), depth=0.6)
write(body_picture(statue), "asymmetric_statue.png")

# %%
# Each foot has its own slenderness, frequency parameter and uplift acceleration.

for foot in ("left", "right"):
    side = statue.side(foot)
    print(
        f"{foot} foot: h/b = {side.slenderness_ratio:.3f}, p = {side.frequency_parameter:.3f} rad/s, "
        f"uplift at {side.uplift_acceleration / conventions.g:.3f} g"
    )

# %%
# The energy losses on the right and the left foot differ. The energy limits the product of both coefficients: it is
# at most one.

there = rk.coefficient_of_restitution(statue, "housner", foot="right")
back = rk.coefficient_of_restitution(statue, "housner", foot="left")
print(f"Housner: onto the right foot {there:.6f}, onto the left {back:.6f}, product {there * back:.6f}")
assert there != back
assert there * back <= 1.0

# %%
# The identities of a model depend on the body. The model of Mao et al. (2024) violates two of them for this body,
# because it depends on more than mass, centre of mass and inertia.

for check in rk.restitution.identity_report(statue, rk.restitution.Ked()):
    print(check.sentence)
