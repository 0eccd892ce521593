"""Dynamics: equations of motion, engines, responses."""

from lazy_loader import attach_stub

from rocking.outcome import Outcome as Outcome
from rocking.outcome import Status as Status

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
__all__ += ["Outcome", "Status"]
