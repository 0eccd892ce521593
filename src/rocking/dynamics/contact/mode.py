"""Which feet carry the body and whether they slide: ten modes, six regimes."""

from typing import NamedTuple

from rocking.dynamics.contact.base import BOTH, LEFT, RIGHT
from rocking.outcome import Regime


class Mode(NamedTuple):
    """One smooth piece of the motion."""

    feet: tuple[int, ...]  # feet that carry: none, -1 (left), +1 (right) or both
    slip: int = 0  # direction in which they slide: -1, 0 (they stick) or +1

    @property
    def regime(self) -> Regime:
        """What the body does."""
        if not self.feet:
            return Regime.FLIGHT
        if len(self.feet) == 2:
            return Regime.SLIDE if self.slip else Regime.REST
        return Regime.SLIDE_ROCK if self.slip else Regime.ROCK

    @property
    def carrier(self) -> str:
        """Feet in words: ``"none"``, ``"left"``, ``"right"`` or ``"both"``."""
        return {(): "none", (LEFT,): "left", (RIGHT,): "right", BOTH: "both"}[self.feet]


REST = Mode(BOTH)
FLIGHT = Mode(())
