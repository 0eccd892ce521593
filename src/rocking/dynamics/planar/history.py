"""What the planar engine returns."""

from typing import NamedTuple

from rocking.dynamics.planar.log import Log
from rocking.dynamics.planar.outcome import PlanarStatus


class History(NamedTuple):
    """What the engine returns.

    Parameters
    ----------
    log : Log
        Samples, pieces, events, energy.
    status : PlanarStatus
        Whether it could be computed.
    lies : bool
        Whether the body fell over.
    passed : float
        When the centre last passed over a foot; NaN if it never did or came back [s].
    end : float
        When the history ends [s].
    """

    log: Log
    status: PlanarStatus
    lies: bool
    passed: float
    end: float
