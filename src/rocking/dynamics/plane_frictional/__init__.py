"""Motion of a plane body with friction: rest, sliding, rocking, sliding during rocking, flight, impacts."""

from lazy_loader import attach_stub

from rocking.outcome import Regime as Regime

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
__all__ += ["Regime"]
