"""Many bodies in space under many motions at once: the compiled engine, or the reference engine row by row."""

from rocking.dynamics.space.batch.result import SpatialBatch

__all__ = ["SpatialBatch"]
