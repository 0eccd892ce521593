"""Whether a history of a batch could be computed; the values are what a user reads."""

from enum import Enum

from rocking.dynamics.spatial.outcome import SpatialStatus


class SpatialBatchStatus(Enum):
    """Whether a history of a batch could be computed: those of one history, and a refusal that leaves the others be."""

    GOOD = SpatialStatus.GOOD.value
    LOST_CONTACT = SpatialStatus.LOST_CONTACT.value
    TOO_MANY_EVENTS = SpatialStatus.TOO_MANY_EVENTS.value
    NOT_FINITE = SpatialStatus.NOT_FINITE.value
    INVALID = "refused: a value is not finite or outside its range, or there is no such body"

    @property
    def code(self) -> int:
        """Number of the status in arrays."""
        return list(SpatialBatchStatus).index(self)
