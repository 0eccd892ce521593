"""Asymmetric statue
=================

A leaning statue on a pedestal with its feet set in: two directions, two coefficients, one energy bound.
"""

import rocking as rk
from rocking import conventions

pedestal = rk.Region(rk.bodies.shapes.rectangle(0.8, 0.6), density=2700.0)
figure = rk.Region([(0.15, 0.6), (0.60, 0.6), (0.72, 1.9), (0.45, 2.3), (0.28, 1.9)], density=2400.0)
statue = rk.Section([pedestal, figure], feet=(0.05, 0.75), depth=0.6)

for foot in ("left", "right"):
    side = statue.side(foot)
    print(
        f"{foot} foot: h/b = {side.slenderness_ratio:.3f}, p = {side.frequency_parameter:.3f} rad/s, "
        f"uplift at {side.uplift_acceleration / conventions.g:.3f} g"
    )

there = rk.coefficient_of_restitution(statue, "housner", onto="right")
back = rk.coefficient_of_restitution(statue, "housner", onto="left")
print(f"Housner: onto the right foot {there:.6f}, onto the left {back:.6f}, product {there * back:.6f}")
assert there != back
assert there * back <= 1.0

for check in rk.restitution.identity_report(statue, rk.restitution.Ked()):
    print(check.sentence)
