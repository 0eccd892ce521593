"""How a planar history ends, and whether it could be computed; the values are the sentences that a user reads."""

from enum import Enum


class PlanarOutcome(Enum):
    """How a history ends; of several that apply, the last one listed before FAILED."""

    NO_MOTION = "stayed at rest: the ground neither lifted nor moved it"
    SLID = "slid without rocking and stayed standing"
    ROCKED = "rocked without sliding and stayed standing"
    ROCKED_AND_SLID = "rocked and slid and stayed standing"
    FLEW = "left the ground with both feet and stayed standing"
    OVERTURNED = "overturned"
    FAILED = "no result"

    @property
    def code(self) -> int:
        """Number of the outcome in arrays."""
        return list(PlanarOutcome).index(self)


class PlanarStatus(Enum):
    """Whether a history could be computed."""

    GOOD = "computed"
    NOT_FINITE = "stopped: the motion of the body is no longer a finite number"
    TOO_MANY_EVENTS = "stopped: more impacts and changes of regime than allowed"
    NOT_RESOLVED = "stopped: changes of regime follow each other without time passing"
    NO_CONTACT_FORCE = "stopped: no contact force obeys Coulomb's law with a rigid body here (Painleve's paradox)"
    AMBIGUOUS = "stopped: several contact forces obey Coulomb's law with a rigid body here (Painleve's paradox)"
    ENERGY_GAIN = "stopped: Newton's normal restitution with friction would create energy in this impact"
