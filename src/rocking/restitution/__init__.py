"""What an impact costs: published and derived restitution models, and what a coefficient implies."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
