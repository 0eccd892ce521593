"""The rows of a batch: every combination of bodies, motions, scales, restitutions and starts, made piece by piece."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.batch.laws import BatchLaw
from rocking.dynamics.space.batch.tables import ROW


@dataclass(frozen=True, eq=False)
class RowTable:
    """All that the rows are made of."""

    shape: tuple[int, int, int, int, int]  # numbers of bodies, motions, scales, restitutions and starts
    scales: FloatArray  # factors on the motions [-]
    laws: Sequence[BatchLaw]  # impact laws
    starts: Sequence[SpatialStart]  # initial conditions
    horizons: FloatArray  # how long to follow each body [s]; shape (bodies, motions)

    def __len__(self) -> int:
        """Return the number of rows."""
        return int(np.prod(self.shape))

    def piece(self, first: int, last: int) -> tuple[FloatArray, IntArray]:
        """Return some rows.

        Returns numbers: Coefficient, scale, horizon, attitude, angular velocity in body axes; NaN for a start that is
        none (shape (n, 10)); choices: Body, motion, law (shape (n, 3)).
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
