"""Whether a history in space could be computed, and on what the body stands; the values are what a user reads."""

from enum import Enum


class SpatialStatus(Enum):
    """Whether a history in space could be computed."""

    GOOD = "computed"
    LOST_CONTACT = "stopped: the ground would have to pull; the body leaves it, and flight is not modelled here"
    TOO_MANY_EVENTS = "stopped: more impacts and changes of contact than allowed"
    NOT_FINITE = "stopped: the motion of the body is no longer a finite number"


class Contact(Enum):
    """On what the body stands."""

    REST = "at rest on its whole base"
    EDGE = "turning about an edge"
    VERTEX = "turning about a vertex"
    ROLLING = "rolling on its rim"

    @property
    def code(self) -> int:
        """Number of the regime in arrays."""
        return list(Contact).index(self)
