"""What arrays are named by."""

import hashlib

import numpy as np
import pytest

from rocking.dynamics.content import hash_of


@pytest.mark.parametrize(
    "values",
    [
        np.arange(7.0), np.arange(12.0).reshape(3, 4).T, np.arange(9)[::2], np.empty(0), np.empty((0, 3)),
        np.array(2.5), np.array([True, False]), np.arange(5, dtype=">i4"), np.broadcast_to(2.0, (4,)),
    ],
)  # fmt: skip
def test_hash_is_of_kind_shape_and_bytes(values: np.ndarray) -> None:
    """SHA-256 of the words of type and shape, then of the numbers, little-endian in the order of C."""
    little = np.atleast_1d(values).astype(values.dtype.newbyteorder("<"))
    said = f"('{little.dtype.str}', {little.shape})".encode()
    assert hash_of(values) == hashlib.sha256(said + little.tobytes(order="C")).hexdigest()
