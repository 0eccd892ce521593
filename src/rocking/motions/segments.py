"""Motions for the engines: polynomials on equal time segments."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.portable import each, times

SMOOTH_DEGREE = 7
"""Degree of the polynomials of a smooth pulse. With 32 polynomials per period, errors are rounding errors."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Acceleration of the ground as one polynomial of time per segment.

    >>> Segments.between_samples(0.1, np.array([0.0, 1.0, -2.0])).horizontal.tolist()
    [[0.0, 1.0], [1.0, -3.0]]
    """

    step: float  # duration of a segment [s]
    # coefficients of ``a(tau) = c[0] + c[1] tau + ...`` with ``tau`` from 0 to 1 over the segment [m/s2]
    horizontal: FloatArray
    vertical: FloatArray | None = None  # coefficients of the vertical acceleration [m/s2]

    @classmethod
    def between_samples(cls, step: float, horizontal: FloatArray, vertical: FloatArray | None = None) -> "Segments":
        """Return the straight lines between samples."""
        return cls(step, _lines(horizontal), None if vertical is None else _lines(vertical))

    @classmethod
    def still(cls, step: float, count: int) -> "Segments":
        """Return ground at rest."""
        return cls(step, np.zeros((count, 2)))

    @classmethod
    def of_function(cls, acceleration: Callable[[FloatArray], FloatArray], duration: float, count: int) -> "Segments":
        """Return `count` polynomials that approximate a smooth function.

        For large counts, errors are rounding errors.
        """
        n = SMOOTH_DEGREE + 1
        angles = np.pi * (np.arange(n) + 0.5) / n
        nodes = each(math.cos, angles)
        step = duration / count
        values = acceleration(((np.arange(count)[:, None] + 0.5 * (1.0 + nodes)) * step).ravel()).reshape(count, n)
        weights = 2.0 / n * each(math.cos, np.outer(angles, np.arange(n)))
        weights[:, 0] *= 0.5
        # two stages: small coefficients of high powers first, to keep rounding errors small
        return cls(step, times(times(values, weights), _SHIFTED))  # Eq. 162

    def refined(self, parts: int) -> "Segments":
        """Return the same polynomials on shorter segments."""
        if parts <= 1:
            return self
        cut = _cutting(self.degree, parts)
        pieces = [
            None if c is None else times(c, cut).swapaxes(0, 1).reshape(-1, c.shape[1])
            for c in (self.horizontal, self.vertical)
        ]
        assert pieces[0] is not None
        return Segments(self.step / parts, pieces[0], pieces[1])

    def extended(self, duration: float) -> "Segments":
        """Return the motion, extended by ground at rest up to a duration."""
        more = int(np.ceil((duration - self.duration) / self.step - 1e-9))
        if more <= 0:
            return self
        zeros = np.zeros((more, self.degree + 1))
        vertical = None if self.vertical is None else np.vstack([self.vertical, zeros])
        return Segments(self.step, np.vstack([self.horizontal, zeros]), vertical)

    def first(self, count: int) -> "Segments":
        """Return the first `count` segments."""
        vertical = None if self.vertical is None else self.vertical[:count]
        return Segments(self.step, self.horizontal[:count], vertical)

    @property
    def count(self) -> int:
        """Number of segments."""
        return int(self.horizontal.shape[0])

    @property
    def degree(self) -> int:
        """Degree of the polynomials."""
        return int(self.horizontal.shape[1]) - 1

    @property
    def moving(self) -> int:
        """Number of segments up to the last horizontal or vertical motion; 0 for ground at rest."""
        tables = [self.horizontal] if self.vertical is None else [self.horizontal, self.vertical]
        return int(max(np.flatnonzero(table.any(axis=1)).max(initial=-1) for table in tables)) + 1

    @property
    def duration(self) -> float:
        """Duration of all segments [s]."""
        return self.count * self.step


def _lines(samples: FloatArray) -> FloatArray:
    return np.column_stack([samples[:-1], np.diff(samples)])


def _cutting(degree: int, parts: int) -> FloatArray:
    """Return the matrices of powers of tau for `parts` equal pieces; shape (parts, k, j)."""
    cut = np.zeros((parts, degree + 1, degree + 1))
    for piece in range(parts):
        for k in range(degree + 1):
            cut[piece, k, : k + 1] = [math.comb(k, j) * piece ** (k - j) / parts**k for j in range(k + 1)]
    return cut


def _shifted_chebyshev(n: int) -> FloatArray:
    """Return T_k(2 tau - 1) in powers of tau, one polynomial per row. All entries are integers."""
    rows = np.zeros((n, n))
    rows[0, 0], rows[1, :2] = 1.0, (-1.0, 2.0)
    for k in range(2, n):
        rows[k] -= 2.0 * rows[k - 1] + rows[k - 2]
        rows[k, 1:] += 4.0 * rows[k - 1, :-1]
    return rows


_SHIFTED = _shifted_chebyshev(SMOOTH_DEGREE + 1)
