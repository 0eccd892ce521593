"""Outcome and status of time histories, and contact of the body: plane and 3D.

The values are sentences for users.
"""

from enum import Enum
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, percent
from rocking.messages import Message


class Coded(Enum):
    """Texts with integer codes for arrays, files and the C++ engines. New members must follow the existing members."""

    @property
    def code(self) -> int:
        """Code in arrays."""
        return list(type(self)).index(self)


class Outcome(Coded):
    """Outcome of a time history, in the order of priority: overturned, flew, rocked and slid, held."""

    NO_UPLIFT = "stayed at rest without uplift"
    ROCKED = "rocked but did not overturn"
    OVERTURNED = "overturned"
    FAILED = "no result"
    SLID = "slid without rocking or overturning"
    ROCKED_AND_SLID = "rocked and slid but did not overturn"
    FLEW = "left the ground with both feet but did not overturn"
    HELD = "rocked and stays tilted, held by friction"


class Status(Coded):
    """Status of the computation of a time history."""

    GOOD = "computed"
    INVALID = "refused: a value is not finite or outside its range, or there is no such body"
    NOT_FINITE = "stopped: the motion of the body is no longer a finite number"
    TOO_MANY_EVENTS = "stopped: more impacts and changes of contact than allowed"
    NOT_RESOLVED = "stopped: the motion changes too fast for the steps; a shorter longest_step may help"
    LOST_CONTACT = "stopped: the contact force becomes tensile; this model has no flight"
    STUCK = "stopped: changes of contact follow each other without time passing"
    NO_CONTACT_FORCE = "stopped: no contact force obeys Coulomb's law with a rigid body here (Painleve's paradox)"
    AMBIGUOUS = "stopped: several contact forces obey Coulomb's law with a rigid body here (Painleve's paradox)"
    ENERGY_GAIN = "stopped: Newton's normal restitution with friction would create energy in this impact"


class Regime(Coded):
    """Motion of a plane body with sliding and hopping."""

    REST = "at rest"
    SLIDE = "sliding on its base"
    ROCK = "rocking about one foot"
    SLIDE_ROCK = "rocking about one foot that slides"
    FLIGHT = "in flight"


class ContactMode(Coded):
    """Contact of a 3D body with the ground."""

    REST = "at rest on its whole base"
    EDGE = "turning about an edge"
    VERTEX = "turning about a vertex"
    ROLLING = "rolling on its rim"


UNCOUNTED = 1_000_000
"""Number of impacts, and mode, of an overturned 3D body: its impacts are not counted."""


_MODES = {-3: "not computed", -2: "no uplift", -1: "rocks, does not overturn", 0: "overturns without impact",
          UNCOUNTED: "overturns"}  # fmt: skip


def mode_words(mode: int) -> str:
    """Return the outcome of a mode as text.

    >>> mode_words(-1), mode_words(2)
    ('rocks, does not overturn', 'overturns after 2 impacts')
    """
    return _MODES.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def mode_shares(modes: Any) -> list[dict[str, Any]]:
    """Return mode, meaning, count and fraction [-] of the histories of each mode."""
    counted = zip(*(array.tolist() for array in np.unique(modes, return_counts=True)), strict=True)
    return [
        {"mode": mode, "meaning": mode_words(mode), "count": count, "share": count / modes.size}
        for mode, count in counted
    ]


def overturned(outcome: Any) -> FloatArray:
    """Return 1 for histories that overturned, 0 for other histories."""
    # NaN without a result
    return of_results(outcome, np.asarray(outcome) == Outcome.OVERTURNED.code)


def of_results(outcome: Any, flags: Any) -> FloatArray:
    """Return flags of histories as 1 and 0, or NaN for histories without a result."""
    return np.where(np.asarray(outcome) == Outcome.FAILED.code, np.nan, flags)


def lost_contact(results: Any) -> FloatArray:
    """Return 1 for histories with a tensile contact force, 0 for others, NaN without a result [-].

    >>> lost_contact({"outcome": [1, 1, 0, 3], "least_force": [-0.1, 0.2, np.nan, np.nan]}).tolist()
    [1.0, 0.0, 0.0, nan]
    """
    if "least_force" not in results:
        return np.zeros(0)
    force = np.asarray(results["least_force"], dtype=np.float64)
    unknown = np.isnan(force) & (np.asarray(results["outcome"]) != Outcome.NO_UPLIFT.code)
    return np.where(unknown, np.nan, force < 0.0)


def flags(results: Any) -> dict[str, FloatArray]:
    """Return `overturned`, `still_rocking` and `lost_contact` as 1 or 0, and NaN without a result [-]."""
    outcome = results["outcome"]
    still = of_results(outcome, np.asarray(results["still_rocking"]) == 1)
    return {"overturned": overturned(outcome), "still_rocking": still, "lost_contact": lost_contact(results)}


def contact_words(lost: Any) -> str:
    """Return a sentence with the number of histories with a tensile contact force; empty if the number is 0."""
    results = np.asarray(lost, dtype=np.float64)
    results = results[np.isfinite(results)]
    return contact_sentence(int((results == 1.0).sum()), results.size)


def contact_sentence(lost: int, count: int) -> str:
    """Return the sentence for `lost` histories with a tensile contact force, of `count` histories with a result."""
    if not lost:
        return ""
    fraction = percent(lost / count)
    return Message(
        "the contact force becomes tensile in {lost} of {known} histories ({share}); their results assume contact",
        {"lost": lost, "known": count, "share": fraction},
    )
