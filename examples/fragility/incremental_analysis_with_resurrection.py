"""Incremental analysis with two definitions
=========================================

A stronger motion does not always overturn a body that a weaker motion overturns. Therefore an incremental analysis has
two definitions of fragility, which differ. For researchers who compare studies.
"""

import math

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import incremental_dynamic_analysis_picture, write
from rocking.studies import SyntheticSet, fragility_analysis

# %%
# First a case with a closed form: a full sine of three times the frequency parameter, `r = 0.9`, slender-linear
# equations.

block = rk.Block(width=0.4, height=1.6)
sine = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * block.frequency_parameter))
unit = conventions.g * block.slenderness_angle
one = fragility_analysis(block, sine, np.linspace(1.0, 4.0, 31) * unit, 0.9, linear=True, analysis="incremental")
for interval in one.intervals:
    print(f"one sine overturns from {interval.start / unit:.6f} to {interval.end / unit:.6f} times g alpha")
first, second = one.intervals
assert abs(first.end / unit / 3.48466273332249203 - 1.0) < 1e-7
assert abs(second.start / unit / 3.6311498724447945014 - 1.0) < 1e-7

# %%
# Then thirty synthetic motions, each at forty levels.

motions = list(SyntheticSet("point-source", count=30, seed=2))
found = fragility_analysis(
    rk.Block(width=0.3, height=1.5), motions, np.geomspace(0.15, 1.5, 40) * conventions.g, 0.9, analysis="incremental"
)
for name, words in found.definitions.items():
    fit = found.fits["overturned"] if name == "fraction" else found.first_crossing_fit
    print(f"{words}\n    median {fit.median / conventions.g:.3f} g, dispersion {fit.dispersion:.2f}")
assert found.first_crossing_fit.median < found.fits["overturned"].median

again = found.resurrected(0.01)
print(f"{len(again)} of {len(motions)} motions leave it standing over more than 1 % of a level above one that fells it")
assert again
passed = np.searchsorted(np.sort(found.first_crossings), found.levels, side="right") / len(motions)
assert (passed >= found.fractions - 1e-12).all()  # what stands again has crossed before

# %%
# Blue: levels without overturning above a level with overturning. Right: the two definitions.

write(incremental_dynamic_analysis_picture(found), "incremental_analysis_with_resurrection.png")
