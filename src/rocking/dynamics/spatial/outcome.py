"""On what a body in space stands."""

from enum import Enum


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
