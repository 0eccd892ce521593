"""Statistics of outcomes that fail or survive at levels: counts, likelihoods, curves, intervals; no rocking in it."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
