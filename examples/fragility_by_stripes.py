"""Fragility by stripes
====================

How likely is a slender cabinet to overturn at a given PGA, and how well do 60 motions tell?
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import fragility_picture, write
from rocking.studies import SyntheticSet, multiple_stripe_analysis
from rocking.studies.fragility import model_of, to_csv, to_nrml

cabinet = rk.Block(width=0.3, height=1.5)
motions = SyntheticSet("point-source", count=60, seed=1)
levels = np.linspace(0.15, 0.9, 11) * conventions.g
found = multiple_stripe_analysis(cabinet, list(motions), levels, "ked", states=(0.2, 0.5))

print(f"{found.trials.sum()} histories; {found.uplift.verdict}")
assert found.uplift.contradictions == 0  # rocking is no matter of probability: it starts at g b / h
assert abs(found.subject.uplift_threshold / (0.2 * conventions.g) - 1.0) < 1e-12

medians = []
for state, fit in found.fits.items():
    # one motion serves at every level: whole motions are drawn anew, not single outcomes
    low, high = fit.interval("median", method="bootstrap")
    print(
        f"{state:20s} median {fit.median / conventions.g:.3f} g "
        f"({low / conventions.g:.3f} to {high / conventions.g:.3f}), dispersion {fit.dispersion:.2f}"
    )
    assert low < fit.median < high
    medians.append(fit.median)
assert medians == sorted(medians)  # the worse the state, the stronger the motion that it takes

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
# curves of unlike dispersion cross somewhere; where states follow one another one dispersion for all is fitted
model = model_of(found, "cabinet")
to_nrml(model, folder / "cabinet_for_openquake.xml", crossing="common-dispersion")
to_csv(model, folder / "cabinet_fema_p58.csv", "fema-p58", crossing="common-dispersion")
write(fragility_picture(found), folder / "fragility_by_stripes.png")
