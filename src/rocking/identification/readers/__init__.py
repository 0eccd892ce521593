"""Reading measurements of free rocking: sounds, and tables of what a sensor or a list of times holds."""

from rocking.identification.readers.reader import KINDS, read_measurement

__all__ = ["KINDS", "read_measurement"]
