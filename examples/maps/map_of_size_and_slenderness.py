"""Map of size and slenderness
===========================

One pulse and blocks of many sizes and slenderness ratios, each with its own coefficient of restitution. For
conservators with many objects and engineers with one earthquake.
"""

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import overturning_map_picture, write
from rocking.studies import boundary, map_sensitivity

# %%
# A sine of 0.5 g and 0.8 s. Uplift requires a ground acceleration above `g b / h`: here `h/b` of at least 2.

block = rk.Block(width=0.5, height=2.0)
pulse = rk.pulses.sine(amplitude=0.5 * conventions.g, period=0.8)
axes = ("semi_diagonal", np.geomspace(0.2, 10.0, 80)), ("slenderness_ratio", np.linspace(1.5, 9.0, 91))
compared = map_sensitivity(block, pulse, *axes, ["ked", "housner"])
found = compared.datasets["ked"]  # what overturning_map returns

falls = found["mode"] >= 0
largest = float(found["semi_diagonal"].where(falls.any("slenderness_ratio")).max())
print(f"{float(falls.mean()):.1%} of these blocks overturn, none of more than R = {largest:.2f} m")
lifted = (found["mode"] != -2).any("semi_diagonal")
assert bool((lifted == (found["slenderness_ratio"] > 2.0)).all())
assert float(found["semi_diagonal"].max()) > largest

# %%
# The effect of the choice between two models.

print(compared.verdict)
assert compared.flips_between("ked", "housner").count > 0

# %%
# Large blocks do not overturn, independent of their slenderness.

lines = boundary(block, pulse, *axes, restitution="ked", by="mode", tolerance=1e-4)
write(overturning_map_picture(found, lines), "map_of_size_and_slenderness.png")
