"""Coefficients of restitution from measured rocking: times of impacts, rotations, angular velocities."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
