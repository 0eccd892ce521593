"""How a history ends, whether it could be computed, and on what the body stands: in the plane and in space.

The values are the sentences that a user reads.
"""

from enum import Enum
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, percent
from rocking.messages import Message


class Coded(Enum):
    """Words for arrays, files and the C++ engines, in which their numbers stand, so that what comes new comes last."""

    @property
    def code(self) -> int:
        """Number in arrays."""
        return list(type(self)).index(self)


class Outcome(Coded):
    """How a history ends; of several that apply, overturned, then flew, then rocked and slid."""

    NO_UPLIFT = "stayed at rest: the ground never lifted it"
    ROCKED = "rocked and stayed standing"
    OVERTURNED = "overturned"
    FAILED = "no result"
    SLID = "slid without rocking and stayed standing"
    ROCKED_AND_SLID = "rocked and slid and stayed standing"
    FLEW = "left the ground with both feet and stayed standing"


class Status(Coded):
    """Whether a history could be computed."""

    GOOD = "computed"
    INVALID = "refused: a value is not finite or outside its range, or there is no such body"
    NOT_FINITE = "stopped: the motion of the body is no longer a finite number"
    TOO_MANY_EVENTS = "stopped: more impacts and changes of contact than allowed"
    NOT_RESOLVED = "stopped: the motion changes too fast for the steps; a shorter longest_step may help"
    LOST_CONTACT = "stopped: the ground would have to pull; the body leaves it, and flight is not modelled here"
    STUCK = "stopped: changes of contact follow each other without time passing"
    NO_CONTACT_FORCE = "stopped: no contact force obeys Coulomb's law with a rigid body here (Painleve's paradox)"
    AMBIGUOUS = "stopped: several contact forces obey Coulomb's law with a rigid body here (Painleve's paradox)"
    ENERGY_GAIN = "stopped: Newton's normal restitution with friction would create energy in this impact"


class Regime(Coded):
    """What a body in the plane does that may slide and hop, in words."""

    REST = "at rest"
    SLIDE = "sliding on its base"
    ROCK = "rocking about one foot"
    SLIDE_ROCK = "rocking about one foot that slides"
    FLIGHT = "in flight"


class ContactMode(Coded):
    """On what a body in space stands."""

    REST = "at rest on its whole base"
    EDGE = "turning about an edge"
    VERTEX = "turning about a vertex"
    ROLLING = "rolling on its rim"


UNCOUNTED = 1_000_000
"""Impacts, and mode, of a body in space that has overturned: they go on as it falls, and are not counted."""


_MODES = {-3: "not computed", -2: "not lifted", -1: "rocks, stays standing", 0: "overturns without impact",
          UNCOUNTED: "overturns"}  # fmt: skip


def mode_words(mode: int) -> str:
    """Return in words how a history ends.

    >>> mode_words(-1), mode_words(2)
    ('rocks, stays standing', 'overturns after 2 impacts')
    """
    return _MODES.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def mode_shares(modes: Any) -> list[dict[str, Any]]:
    """Return mode, meaning, count and share [-] of the histories that end in each way."""
    counted = zip(*(part.tolist() for part in np.unique(modes, return_counts=True)), strict=True)
    return [
        {"mode": mode, "meaning": mode_words(mode), "count": count, "share": count / modes.size}
        for mode, count in counted
    ]


def overturned(outcome: Any) -> FloatArray:
    """Return 1 for histories that overturned, 0 for others."""
    # NaN without a result, which is neither a fall nor a stand
    return of_results(outcome, np.asarray(outcome) == Outcome.OVERTURNED.code)


def of_results(outcome: Any, flags: Any) -> FloatArray:
    """Return flags of histories as 1 and 0, NaN for those without a result."""
    return np.where(np.asarray(outcome) == Outcome.FAILED.code, np.nan, flags)


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
    """Return `overturned`, `still_rocking` and `lost_contact` as 1 or 0, and NaN without a result [-]."""
    outcome = results["outcome"]
    still = of_results(outcome, np.asarray(results["still_rocking"]) == 1)
    return {"overturned": overturned(outcome), "still_rocking": still, "lost_contact": lost_contact(results)}


def contact_words(lost: Any) -> str:
    """Return in how many histories the ground would have to pull, as a sentence that stands beside their verdicts."""
    known = np.asarray(lost, dtype=np.float64)
    known = known[np.isfinite(known)]
    return contact_sentence(int((known == 1.0).sum()), known.size)


def contact_sentence(lost: int, known: int) -> str:
    """Return the same of two counts: where the ground would have to pull, and all that have a result."""
    if not lost:
        return ""
    share = percent(lost / known)
    return Message(
        ("in {lost} of {known} histories ({share}) the ground would have to pull; their verdicts assume contact"),
        {"lost": lost, "known": known, "share": share},
    )
