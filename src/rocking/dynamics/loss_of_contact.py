"""Whether the ground would have to pull, which it cannot: the verdict of rocking then assumes a contact it lacks."""

from typing import Any

import numpy as np

from rocking.conventions import FloatArray, percent
from rocking.outcome import Outcome, of_results, overturned


def lost_contact(results: Any) -> FloatArray:
    """Return in which histories the ground would have to pull.

    Returns 1 where it would, 0 where not, NaN where there is no result [-].

    >>> lost_contact({"outcome": [1, 1, 0, 3], "least_force": [-0.1, 0.2, np.nan, np.nan]}).tolist()
    [1.0, 0.0, 0.0, nan]
    """
    force = np.asarray(results["least_force"], dtype=np.float64)
    unknown = np.isnan(force) & (np.asarray(results["outcome"]) != Outcome.NO_UPLIFT.code)
    return np.where(unknown, np.nan, force < 0.0)


def flags(results: Any) -> dict[str, FloatArray]:
    """Return what is true or false of histories, as numbers.

    Returns Overturned, still_rocking, lost_contact: 1, 0, NaN where there is no result [-].
    """
    outcome = results["outcome"]
    still = of_results(outcome, np.asarray(results["still_rocking"]) == 1)
    return {"overturned": overturned(outcome), "still_rocking": still, "lost_contact": lost_contact(results)}


def contact_words(flags: Any) -> str:
    """Return in how many histories the ground would have to pull, as a sentence that stands beside their verdicts.

    >>> contact_words([1.0, 0.0, 0.0, np.nan])
    'in 1 of 3 histories (33.3 %) the ground would have to pull; their verdicts assume contact'
    """
    known = np.asarray(flags, dtype=np.float64)
    known = known[np.isfinite(known)]
    lost = int((known == 1.0).sum())
    if not lost:
        return ""
    share = percent(lost / known.size)
    return f"in {lost} of {known.size} histories ({share}) the ground would have to pull; their verdicts assume contact"
