"""How many histories are computed at a time."""

from rocking.studies.campaign.chunks import DEFAULT_CHUNK
from rocking.studies.campaign.fingerprint import kind_of

_ASK = 0.3
_FIRST = {"fast": 64, "reference": 4}
_FASTER = 4


class Pace:
    """How many histories at a time take as long as nobody minds to wait, learned from one piece to the next.

    Parameters
    ----------
    engine : str
        The engine that computes them.
    """

    def __init__(self, engine: str) -> None:
        self.step = _FIRST[kind_of(engine)]

    def piece(self, left: int) -> int:
        """Return how many of the histories that are left to take: equal pieces, since short ones leave lanes idle.

        Parameters
        ----------
        left : int
            At least 1.

        Returns
        -------
        int
            At most `step`.
        """
        return -(-left // -(-left // self.step))

    def took(self, count: int, seconds: float) -> None:
        """Learn from a piece.

        Parameters
        ----------
        count : int
            Its histories.
        seconds : float
            What they took [s].
        """
        wanted = int(count * _ASK / max(seconds, 1e-6))
        if wanted < self.step or 2 * count >= self.step:  # the end of a chunk says nothing about longer pieces
            self.step = max(1, min(wanted, _FASTER * self.step, DEFAULT_CHUNK))
