"""The probability that a body rocks, slides or overturns, of which not everything is known; and how good it was."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
