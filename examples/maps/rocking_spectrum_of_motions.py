"""Rocking spectrum
================

A rocking spectrum is the peak rotation of blocks as a function of their size. This example uses two hundred motions and
shows their scatter. For engineers who compare sites or records.
"""

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import rocking_spectrum_picture, write
from rocking.studies import SyntheticSet, rocking_spectrum

# %%
# Two hundred synthetic motions of 0.3 g, three slenderness ratios, sixty sizes. The size is the period `2 pi / p`.

motions = SyntheticSet("point-source", count=200, seed=1, pga=0.3 * conventions.g)
angles, periods = np.arctan([1 / 4, 1 / 6, 1 / 8]), np.geomspace(0.8, 16.0, 60)
found = rocking_spectrum([motions[k] for k in range(len(motions))], angles, periods, "ked")

share = (found["mode"] >= 0).mean("motion")
for place, slenderness in enumerate((4, 6, 8)):
    one = share[place]
    most = periods[np.flatnonzero(one.values > 0.0).max(initial=0)]
    print(f"h/b = {slenderness}: up to {float(one.max()):.0%} of the motions overturn a block, none above {most:.2f} s")
# of equal slenderness the large block stands where the small one falls
assert (share.isel(period=-1) < 0.1).all()
assert float(share.isel(slenderness_angle=2, period=0)) > 0.9
# every motion exceeds g b / h, so every block is lifted
assert (found["mode"] != -2).all()

# %%
# Each point is one response.

one = found.isel(motion=3, slenderness_angle=1, period=20)
block = rk.Block.from_angle(angles[1], float(one["semi_diagonal"]))
assert rk.simulate(block, motions[3], "ked").peak_rotation == abs(float(one["peak_rotation"]))

# %%
# Medians, and bands from 16 % to 84 % of the motions. The strip below is the overturning fraction. A curve ends at a
# fraction of one half.

write(rocking_spectrum_picture(found), "rocking_spectrum_of_motions.png")
