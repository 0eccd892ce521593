"""Fragility curve by stripes
==========================

Overturning probability of a slender cabinet as a function of the PGA, from sixty motions at eleven levels, with
confidence intervals. For engineers who need curves for a risk analysis.
"""

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import fragility_picture, write
from rocking.studies import SyntheticSet, fragility_analysis
from rocking.studies.fragility import model_of, to_csv, to_nrml

# %%
# Sixty synthetic motions are scaled to all levels. There are three limit states. Rocking is not statistical: it
# begins at `g b / h`.

cabinet = rk.Block(width=0.3, height=1.5)
motions = SyntheticSet("point-source", count=60, seed=1)
levels = np.linspace(0.15, 0.9, 11) * conventions.g
found = fragility_analysis(cabinet, list(motions), levels, "ked", limit_states=(0.2, 0.5))

print(f"{found.trials.sum()} histories; {found.uplift.verdict}")
assert found.uplift.contradictions == 0
assert abs(found.subject.uplift_threshold / (0.2 * conventions.g) - 1.0) < 1e-12

# %%
# Medians with their intervals. Each motion is used at each level, so the bootstrap samples motions, not single
# outcomes.

medians = []
for state, fit in found.fits.items():
    low, high = fit.interval("median", method="bootstrap")
    print(
        f"{state:20s} median {fit.median / conventions.g:.3f} g "
        f"({low / conventions.g:.3f} to {high / conventions.g:.3f}), dispersion {fit.dispersion:.2f}"
    )
    assert low < fit.median < high
    medians.append(fit.median)
assert medians == sorted(medians)  # the worse the state, the stronger the motion that it takes

# %%
# Counted fractions, curves with their bands, and below them the probabilities of the limit states at each level.

write(fragility_picture(found), "fragility_by_stripes.png")

# %%
# Files for OpenQuake and FEMA P-58. Curves with different dispersions cross. Therefore one dispersion is fitted to
# all nested limit states.

model = model_of(found, "cabinet")
to_nrml(model, "cabinet_for_openquake.xml", crossing_curves="common-dispersion")
to_csv(model, "cabinet_fema_p58.csv", "fema-p58", crossing_curves="common-dispersion")
