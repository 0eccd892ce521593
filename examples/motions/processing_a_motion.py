"""Processing of a record
======================

Two raw components are corrected step by step. The provenance of the motion contains each step. For engineers who
prepare records for an analysis.
"""

import numpy as np

import rocking as rk
from rocking.motions import (
    bandpassed,
    demeaned,
    intensity_measures,
    padded,
    resampled,
    rotated,
    rotd_pga,
    scaled_to,
    spectral_acceleration,
    trimmed_to_significant,
)  # fmt: skip
from rocking.plots import ground_motion_picture, write

# %%
# Two horizontal components, rotated by 30 degrees. RotD50 and RotD100 are the median and the largest peak over all
# directions.

east = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=3)
north = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=4)
along, across = rotated(east, north, np.radians(30.0))
print(f"RotD50 {rotd_pga(east, north, 50.0):.3f}, RotD100 {rotd_pga(east, north, 100.0):.3f} m/s2")
assert rotd_pga(east, north, 100.0) >= max(along.peak, across.peak) * (1.0 - 1e-3)  # angles in whole degrees

# %%
# Baseline correction, filter, the significant segment with zero padding, a finer time step, and a peak velocity of
# 0.5 m/s.

clean = bandpassed(demeaned(along), 0.1, 10.0)
shorter = padded(trimmed_to_significant(clean), before=0.5, after=2.0)
finer = resampled(shorter, 0.005)
target = scaled_to(finer, "pgv", 0.5)
for line in target.provenance:
    print(" -", line)
assert abs(intensity_measures(target)["pgv"].value - 0.5) < 1e-12

# %%
# A motion can be scaled to any measure, such as the spectral acceleration at a period.

stiff = scaled_to(finer, "sa(0.5)", 6.0)
print(f"Sa(0.5 s) = {spectral_acceleration(stiff, 0.5):.3f} m/s2")
assert abs(spectral_acceleration(stiff, 0.5) - 6.0) < 1e-9

# %%
# The picture shows the effect of the cut: the motion does not end at rest, and its displacement drifts. A rocking
# body depends on the acceleration only. Use the displacements of `clean`, which ends at rest.

write(ground_motion_picture(target), "processing_a_motion.png")
