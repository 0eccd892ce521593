"""Pictures: bodies, models and measurements, motions, responses, animations, studies, the paper's figures."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
