"""Synthetic record sets
=====================

Sets of motions by family and seed: a study that needs nobody's records.
"""

from pathlib import Path

import numpy as np

from rocking.motions import peak_ground_velocity
from rocking.plots import record_set_picture, write
from rocking.studies import SyntheticSet

sets = {name: SyntheticSet(name, count=30, seed=1) for name in ("firm-ground", "soft-ground", "pulse-like")}
for name, motions in sets.items():
    ratio = [peak_ground_velocity(motion) / motion.peak for motion in motions]
    print(f"{name:12s} PGA {min(m.peak for m in motions):.2f} to {max(m.peak for m in motions):.2f} m/s2, ", end="")
    print(f"median PGV/PGA {np.median(ratio):.3f} s")

# a motion depends on family, seed and number alone: a larger set begins with those of a smaller one
longer = SyntheticSet("soft-ground", count=1_000_000, seed=1)
assert (longer[29].acceleration == sets["soft-ground"][29].acceleration).all()
assert not np.array_equal(SyntheticSet("soft-ground", 30, seed=2)[29].acceleration, longer[29].acceleration)
# scaled as they are made
assert all(abs(motion.peak - 3.0) < 1e-9 for motion in SyntheticSet("firm-ground", 5, seed=1, pga=3.0))

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(record_set_picture(sets, np.geomspace(0.05, 4.0, 30)), folder / "synthetic_record_sets.png")
