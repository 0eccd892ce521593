"""Many bodies in space under many motions at once: the compiled engine, or the reference engine row by row."""

from rocking.dynamics.spatial_batch.many import simulate_spatial_batch
from rocking.dynamics.spatial_batch.result import SpatialBatch
from rocking.dynamics.spatial_batch.settings import SpatialBatchSettings
from rocking.dynamics.spatial_batch.start import SpatialStart

__all__ = [
    "SpatialBatch",
    "SpatialBatchSettings",
    "SpatialStart",
    "simulate_spatial_batch",
]
