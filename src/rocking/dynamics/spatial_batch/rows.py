"""The rows of a batch: every combination of bodies, motions, scales, restitutions and starts, made piece by piece."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.spatial_batch.laws import BatchLaw
from rocking.dynamics.spatial_batch.start import SpatialStart
from rocking.dynamics.spatial_batch.tables import ROW


@dataclass(frozen=True, eq=False)
class RowTable:
    """All that the rows are made of.

    Parameters
    ----------
    shape : tuple of int
        Numbers of bodies, motions, scales, restitutions and starts.
    scales : ndarray
        Factors on the motions [-].
    laws : sequence of BatchLaw
        Impact laws.
    starts : sequence of SpatialStart
        Initial conditions.
    horizons : ndarray, shape (bodies, motions)
        How long to follow each body [s].
    """

    shape: tuple[int, int, int, int, int]
    scales: FloatArray
    laws: Sequence[BatchLaw]
    starts: Sequence[SpatialStart]
    horizons: FloatArray

    def __len__(self) -> int:
        """Return the number of rows."""
        return int(np.prod(self.shape))

    def piece(self, first: int, last: int) -> tuple[FloatArray, IntArray]:
        """Return some rows.

        Parameters
        ----------
        first, last : int
            From which to before which.

        Returns
        -------
        numbers : ndarray, shape (n, 10)
            Coefficient, scale, horizon, attitude, angular velocity in body axes; NaN for a start that is none.
        choices : ndarray of int, shape (n, 3)
            Body, motion, law.
        """
        body, motion, scale, law, start = np.unravel_index(np.arange(first, last), self.shape)
        numbers = np.empty((last - first, ROW))
        numbers[:, 0] = np.array([made.coefficient for made in self.laws])[law]
        numbers[:, 1] = self.scales[scale]
        numbers[:, 2] = self.horizons[body, motion]
        numbers[:, 3:] = self._states[start]
        codes = np.array([made.code for made in self.laws], np.int64)
        return numbers, np.column_stack([body, motion, codes[law]]).astype(np.int64)

    @property
    def _states(self) -> FloatArray:
        none = np.full(7, np.nan)
        rows = [np.concatenate([s.quaternion, s.body_velocity]) if s.valid else none for s in self.starts]
        return np.array(rows)
