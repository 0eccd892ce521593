"""Processing a motion
===================

Baseline, filter, trim, resample, rotate and scale: every step is noted in the motion's provenance.
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

east = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=3)
north = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=4)
along, across = rotated(east, north, np.radians(30.0))
print(f"RotD50 {rotd_pga(east, north, 50.0):.3f}, RotD100 {rotd_pga(east, north, 100.0):.3f} m/s2")
assert rotd_pga(east, north, 100.0) >= max(along.peak, across.peak) * (1.0 - 1e-3)  # angles in whole degrees

clean = bandpassed(demeaned(along), 0.1, 10.0)
shorter = padded(trimmed_to_significant(clean), before=0.5, after=2.0)
finer = resampled(shorter, 0.005)
target = scaled_to(finer, "pgv", 0.5)
for line in target.provenance:
    print(" -", line)
assert abs(intensity_measures(target)["pgv"].value - 0.5) < 1e-12
stiff = scaled_to(finer, "sa(0.5)", 6.0)
assert abs(spectral_acceleration(stiff, 0.5) - 6.0) < 1e-9
