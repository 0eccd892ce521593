"""Rest, sliding, rocking, sliding while rocking, and flight of a plane body, with friction and impacts."""

from lazy_loader import attach_stub

from rocking.outcome import Regime as Regime

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
__all__ += ["Regime"]
