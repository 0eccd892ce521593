"""What the planar engine returns."""

from typing import NamedTuple

from rocking.dynamics.contact.log import Log
from rocking.outcome import Status


class History(NamedTuple):
    """What the engine returns."""

    log: Log  # samples, pieces, events, energy
    status: Status  # whether it could be computed
    lies: bool  # whether the body fell over
    passed: float  # when the centre last passed over a foot; NaN if it never did or came back [s]
    end: float  # when the history ends [s]
