"""How a history ends, and whether it could be computed: one list for rocking, sliding and flying, in plane and space.

The values are the sentences that a user reads; the codes stand in arrays, in files and in the C++ engines, so that
what comes new comes last.
"""

from enum import Enum
from typing import Any

import numpy as np

from rocking.conventions import FloatArray


class Outcome(Enum):
    """How a history ends; of several that apply, overturned, then flew, then rocked and slid."""

    NO_UPLIFT = "stayed at rest: the ground never lifted it"
    ROCKED = "rocked and stayed standing"
    OVERTURNED = "overturned"
    FAILED = "no result"
    SLID = "slid without rocking and stayed standing"
    ROCKED_AND_SLID = "rocked and slid and stayed standing"
    FLEW = "left the ground with both feet and stayed standing"

    @property
    def code(self) -> int:
        """Number of the outcome in arrays."""
        return list(Outcome).index(self)


class Status(Enum):
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

    @property
    def code(self) -> int:
        """Number of the status in arrays."""
        return list(Status).index(self)


OVERTURNED = ("1", "1 it overturned, 0 it did not, NaN where there is no result: neither")
"""Unit and meaning of what `overturned` returns."""

STILL_ROCKING = (
    "1", "1 where it stands, but did not yet rest when the motion ended, and later impacts do not count; NaN no result"
)  # fmt: skip
"""Unit and meaning of `still_rocking`."""


def overturned(outcome: Any) -> FloatArray:
    """Return which histories overturned; no result is neither a fall nor a stand.

    Returns 1 for those that did, 0 for those that did not, NaN for those without a result [-].

    >>> overturned([0, 1, 2, 3]).tolist()
    [0.0, 0.0, 1.0, nan]
    """
    return of_results(outcome, np.asarray(outcome) == Outcome.OVERTURNED.code)


def of_results(outcome: Any, flags: Any) -> FloatArray:
    """Return flags of histories as numbers; no result is neither true nor false.

    Returns 1 and 0, NaN for those without a result [-].
    """
    return np.where(np.asarray(outcome) == Outcome.FAILED.code, np.nan, flags)
