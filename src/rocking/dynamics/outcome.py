"""How a history ends, and whether it could be computed; the values are the sentences that a user reads."""

from enum import Enum


class Outcome(Enum):
    """How a history ends."""

    NO_UPLIFT = "stayed at rest: the ground never lifted it"
    ROCKED = "rocked and stayed standing"
    OVERTURNED = "overturned"
    FAILED = "no result"

    @property
    def code(self) -> int:
        """Number of the outcome in arrays."""
        return list(Outcome).index(self)


class Status(Enum):
    """Whether a history could be computed."""

    GOOD = "computed"
    INVALID = "refused: a value is not finite or outside its range"
    NOT_FINITE = "stopped: the motion of the body is no longer a finite number"
    TOO_MANY_IMPACTS = "stopped: more impacts than allowed"
    NOT_RESOLVED = "stopped: the motion changes too fast for the steps; a shorter longest_step may help"

    @property
    def code(self) -> int:
        """Number of the status in arrays."""
        return list(Status).index(self)
