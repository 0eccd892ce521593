"""Many histories: overturning maps, rocking spectra, sensitivity to the restitution, fragility, campaigns."""

from rocking.studies.histories import Histories, Product, Table
from rocking.studies.motion_set import MotionList, MotionSet

__all__ = ["Histories", "MotionList", "MotionSet", "Product", "Table"]
