"""Probability of rocking, sliding and overturning of a body with uncertain inputs, and its validation."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
