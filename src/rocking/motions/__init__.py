"""Ground motions: records, pulses, synthetic motions, and their intensity measures."""

from lazy_loader import attach_stub

from rocking.motions.segments import Segments as Segments

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
