"""Sets of synthetic motions
=========================

A family and a seed define a set of any size. Each motion is created at its first use. For fragility studies without a
database.
"""

import numpy as np

from rocking.motions import peak_ground_velocity
from rocking.plots import record_set_picture, write
from rocking.studies import SyntheticSet

# %%
# Families differ in the ratio of velocity and acceleration, which is important for rocking.

sets = {name: SyntheticSet(name, count=30, seed=1) for name in ("firm-ground", "soft-ground", "pulse-like")}
for name, motions in sets.items():
    ratio = [peak_ground_velocity(motion) / motion.peak for motion in motions]
    print(f"{name:12s} PGA {min(m.peak for m in motions):.2f} to {max(m.peak for m in motions):.2f} m/s2, ", end="")
    print(f"median PGV/PGA {np.median(ratio):.3f} s")

# %%
# A motion depends on family, seed and index only. A larger set begins with the motions of a smaller set. Each motion
# is scaled at its creation.

longer = SyntheticSet("soft-ground", count=1_000_000, seed=1)
assert (longer[29].acceleration == sets["soft-ground"][29].acceleration).all()
assert not np.array_equal(SyntheticSet("soft-ground", 30, seed=2)[29].acceleration, longer[29].acceleration)
assert all(abs(motion.peak - 3.0) < 1e-9 for motion in SyntheticSet("firm-ground", 5, seed=1, pga=3.0))

# %%
# Left: one point per motion. Right: the median spectra, and the range of the middle 68 % of the motions.

write(record_set_picture(sets, np.geomspace(0.05, 4.0, 30)), "synthetic_record_sets.png")
