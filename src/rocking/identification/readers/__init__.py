"""Readers of measurements of free rocking: sounds, videos, and tables of sensors or times."""

from rocking.identification.readers.reader import KINDS, read_measurement

__all__ = ["KINDS", "read_measurement"]
