"""Rocking spectra, as the browser draws them."""

from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import by_restitution, coordinate, plain, shares


def spectrum_result(study: OpenStudy) -> dict[str, Any]:
    """Return rocking spectra.

    Returns ``x`` (the periods 2 pi / p), ``angles``, ``motions``, ``semi_diagonals``; ``curves``: for every restitution
    and slenderness angle the median of the peak rotation over alpha, its 16 % and 84 % over the motions (null where
    that many overturn), the share that overturns, the coefficient of restitution; ``shares``.
    """
    from rocking.plots.rocking_spectrum import fractiles

    job = study.job.job
    angles = coordinate(study, "slenderness_angle")
    modes = by_restitution(study, "mode")
    coefficient = job.study.coordinates["coefficient"].values
    curves = []
    for k, label in enumerate(job.parts.choices):
        found = study.dataset(k)
        for place, angle in enumerate(angles["values"]):
            low, middle, high = fractiles(found, place)
            mode = modes[k][:, place]
            with np.errstate(invalid="ignore"):  # where nothing could be computed there is no share
                share = (mode >= 0).sum(axis=0) / (mode != -3).sum(axis=0)
            curves.append({
                "restitution": label, "angle": angle, "low": plain(low), "median": plain(middle), "high": plain(high),
                "overturned": plain(share),
                "coefficient": plain(coefficient[place, :, k] if coefficient.ndim > 2 else coefficient[place]),
            })  # fmt: skip
    return {
        "x": coordinate(study, "period"),
        "angles": angles,
        "motions": coordinate(study, "motion"),
        "semi_diagonals": coordinate(study, "semi_diagonal"),
        "curves": curves,
        "shares": [shares(each) for each in modes],
    }
