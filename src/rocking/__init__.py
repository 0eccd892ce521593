"""Predict what an impact costs a rocking body, how it rocks in an earthquake, and whether it overturns."""

from lazy_loader import attach_stub

from rocking.version import __version__ as __version__

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
