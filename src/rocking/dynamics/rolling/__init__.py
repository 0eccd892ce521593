"""3D bodies: rocking about edges and vertices and rolling on rims, under three components of motion."""

from lazy_loader import attach_stub

from rocking.outcome import ContactMode as ContactMode

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
__all__ += ["ContactMode"]
