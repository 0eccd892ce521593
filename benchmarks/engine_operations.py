"""Number of arithmetic operations of the fast engine on a batch, with numbers that count."""

import ctypes
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from benchmarks.engine_batch import STEP, Histories
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.plane.fast_engine import common
from rocking.dynamics.plane.settings import PlaneSettings

SOURCE = Path(__file__).with_name("operations.cpp")
FLAGS = ("-std=c++17", "-O2", "-ffp-contract=off", "-fno-math-errno", "-shared", "-fPIC")


@dataclass(frozen=True)
class Operations:
    """Operations of time steps, landings and the search for uplift, in lanes with a history.

    Operations of single lanes (impacts, maxima, rest) are excluded, a few per time step.

    Loads, stores, comparisons, selections, absolute values and integers are no operations.
    """

    sums: int
    products: int
    quotients: int
    roots: int
    fused: int
    extremes: int
    steps: int
    outcome: np.ndarray

    @property
    def total(self) -> int:
        """Additions, multiplications, divisions and square roots; a multiply-add is two."""
        return self.sums + self.products + self.quotients + self.roots + 2 * self.fused

    @property
    def with_extremes(self) -> int:
        """The same with the lesser and the greater of two numbers, which processors that count operations count."""
        return self.total + self.extremes


class _Settings(ctypes.Structure):
    """`Settings` of engine/batch.hpp."""

    _fields_ = (
        ("gravity", ctypes.c_double),
        ("longest_step", ctypes.c_double),
        ("rest", ctypes.c_double),
        ("most_impacts", ctypes.c_int64),
        ("linear", ctypes.c_bool),
        ("order", ctypes.c_int),
        ("to_the_ground", ctypes.c_bool),
    )


def counted(batch: Histories, p: np.ndarray | None = None, rotation: np.ndarray | None = None) -> Operations | None:
    """Return the operations of a batch, with another p or initial rotations if given; None without a compiler."""
    library = _built()
    if library is None:
        return None
    lengths = np.array([record.size for record in batch.records], np.int64)
    first = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)
    data = np.concatenate([*batch.records, np.zeros(64)])
    given = common(PlaneSettings(), ConstantRestitution())
    names = [name for name, _ in _Settings._fields_]
    settings = _Settings(*({**given, "order": PlaneSettings().order, "to_the_ground": False}[name] for name in names))
    outcome, counts = np.empty(len(batch), np.int8), np.empty(7, np.int64)
    columns = (batch.alpha, batch.p if p is None else p, batch.r, batch.scale)
    columns = (*columns, np.zeros(len(batch)) if rotation is None else rotation)
    library.count_operations(
        _pointer(data), len(batch), _pointer(first), _pointer(lengths - 1), STEP, len(batch),
        *(_pointer(np.ascontiguousarray(column)) for column in columns),
        ctypes.byref(settings), _pointer(outcome), _pointer(counts),
    )  # fmt: skip
    return Operations(*(int(n) for n in counts), outcome)


@cache
def _built() -> ctypes.CDLL | None:
    compiler = next(filter(None, map(shutil.which, ("c++", "g++", "clang++"))), None)
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        built = Path(folder) / "operations.so"
        subprocess.run([compiler, *FLAGS, "-o", built, SOURCE], check=True)
        library = ctypes.CDLL(str(built))
    pointer = ctypes.c_void_p
    library.count_operations.argtypes = (
        pointer, ctypes.c_int64, pointer, pointer, ctypes.c_double, ctypes.c_int64, *(pointer,) * 8,
    )  # fmt: skip
    library.count_operations.restype = None
    return library


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)  # which keeps the array
