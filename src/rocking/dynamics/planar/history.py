"""What the planar engine returns."""

from typing import NamedTuple

from rocking.dynamics.outcome import Status
from rocking.dynamics.planar.log import Log


class History(NamedTuple):
    """What the engine returns.

    Parameters
    ----------
    log : Log
        Samples, pieces, events, energy.
    status : Status
        Whether it could be computed.
    lies : bool
        Whether the body fell over.
    passed : float
        When the centre last passed over a foot; NaN if it never did or came back [s].
    end : float
        When the history ends [s].
    """

    log: Log
    status: Status
    lies: bool
    passed: float
    end: float
