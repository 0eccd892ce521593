"""What shakes: records, pulses, synthetic motions, and what is measured on them."""

from rocking.motions.motion import GroundMotion
from rocking.motions.segments import Segments

__all__ = ["GroundMotion", "Segments"]
