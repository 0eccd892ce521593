"""Predict the energy loss of rocking bodies at impact, simulate rocking, and assess overturning."""

from lazy_loader import attach_stub

from rocking.version import __version__ as __version__

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
