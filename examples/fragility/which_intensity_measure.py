"""Comparison of intensity measures
================================

Which intensity measure is suitable for a fragility curve: PGA, PGV, Arias intensity? A good measure has a small scatter
of the response and is sufficient. The result depends on the size of the body. For researchers and engineers who
select records.
"""

import math

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.motions import scaled_to
from rocking.plots import measures_picture, write
from rocking.studies import SyntheticSet, compare_measures, fragility_analysis

# %%
# Distant earthquakes, each scaled to a peak from 1.1 to 2.5 times the uplift acceleration. All of them cause rocking.
# Magnitude and distance are metadata.

made = list(SyntheticSet("point-source", count=150, seed=1))
levels = np.random.default_rng(1).uniform(1.1, 2.5, len(made)) * 0.2 * conventions.g
motions = [scaled_to(motion, "pga", level) for motion, level in zip(made, levels, strict=True)]
metadata = {
    "magnitude": [float(motion.metadata["magnitude"]) for motion in motions],
    "ln distance": [math.log(float(motion.metadata["distance_km"])) for motion in motions],
}
measures = ["pga", "pgv", "p pgv/(g tan alpha)", "pgv/pga", "sa(1.0)", "arias", "cav"]

# %%
# The same cabinet in two sizes. Efficiency is the scatter about the line; a small scatter is better. A small p-value
# means that magnitude or distance contain additional information.

ranked = {}
for height in (0.5, 4.0):
    found = fragility_analysis(
        rk.Block(width=0.2 * height, height=height), motions, restitution="ked", analysis="cloud"
    )
    ranked[height] = compare_measures(found, measures, metadata)
    print(f"height {height} m: {ranked[height].scores[0].rocked} of {len(motions)} rocked but did not overturn")
    for score in ranked[height].scores:
        p_values = ", ".join(f"p({name}) {value:.2g}" for name, value in score.sufficiency.items())
        print(f"  {score.im:20s} efficiency {score.efficiency:.2f}, {p_values}")

# %%
# The PGA is the best measure for a small body. For a large body measures of the total motion are better. For one body
# the dimensionless velocity is proportional to the velocity.

assert (ranked[0.5].best, ranked[4.0].best) == ("pga", "arias")
scores = {score.im: score.efficiency for score in ranked[4.0].scores}
assert abs(scores["p pgv/(g tan alpha)"] / scores["pgv"] - 1.0) < 1e-9

# %%
# The large cabinet, the most efficient measure on top.

write(measures_picture(ranked[4.0]), "which_intensity_measure.png")
