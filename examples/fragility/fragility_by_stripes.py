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
# Sixty synthetic motions, each scaled to all levels; three states of damage. Rocking itself is no matter of
# probability: it starts at `g b / h`.

cabinet = rk.Block(width=0.3, height=1.5)
motions = SyntheticSet("point-source", count=60, seed=1)
levels = np.linspace(0.15, 0.9, 11) * conventions.g
found = fragility_analysis(cabinet, list(motions), levels, "ked", limit_states=(0.2, 0.5))

print(f"{found.trials.sum()} histories; {found.uplift.verdict}")
assert found.uplift.contradictions == 0
assert abs(found.subject.uplift_threshold / (0.2 * conventions.g) - 1.0) < 1e-12

# %%
# Medians with their intervals. One motion serves at every level: whole motions are drawn anew, not single outcomes.

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
# Shares that were counted, curves with their bands, and below them what becomes of the cabinet at each level.

write(fragility_picture(found), "fragility_by_stripes.png")

# %%
# For OpenQuake and FEMA P-58. Curves of unlike dispersion cross somewhere; where states follow one another one
# dispersion for all is fitted.

model = model_of(found, "cabinet")
to_nrml(model, "cabinet_for_openquake.xml", crossing_curves="common-dispersion")
to_csv(model, "cabinet_fema_p58.csv", "fema-p58", crossing_curves="common-dispersion")
