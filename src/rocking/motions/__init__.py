"""What shakes: records, pulses, synthetic motions, and what is measured on them."""

from lazy_loader import attach_stub

from rocking.motions.segments import Segments as Segments  # what engines integrate

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
