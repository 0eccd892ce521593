"""The fast engine as Python sees it: whether it is there, and arrays in and out."""

import os
import warnings
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.impact_law import ImpactLaw
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning
from rocking.motions.segments import Segments

Arrays = dict[str, Any]

RESULTS: dict[str, Any] = {
    "outcome": np.int8, "status": np.int8, "side": np.int8,
    "peak_rotation": np.float64, "peak_time": np.float64, "peak_velocity": np.float64,
    "overturning_time": np.float64, "first_uplift": np.float64, "error": np.float64,
    "impacts": np.int64, "uplifts": np.int64,
}  # fmt: skip
"""What the fast engine reports for every history."""


ENGINES = ("auto", "fast", "reference")
"""What can be asked for."""

_NOT_BUILT = (
    "the fast engine was not built: it takes a C++17 compiler when rocking is installed (in a checkout, `make engine`)"
)


@cache
def _module() -> ModuleType | None:
    try:
        from rocking.dynamics import _engine
    except ImportError:
        return None
    return _engine


def available() -> bool:
    """Return whether the fast engine was built with this installation.

    Returns
    -------
    bool
        True if it is there; otherwise the reference engine serves.
    """
    return _module() is not None


def chosen(asked: str) -> str:
    """Return which engine will run, and say so once if it is not the one that users expect.

    Parameters
    ----------
    asked : {"auto", "fast", "reference"}
        What was asked for.

    Returns
    -------
    str
        "fast" or "reference".

    Raises
    ------
    InvalidValueError
        If there is no such engine.
    MissingExtraError
        If the fast one was asked for and not built.
    """
    if asked not in ENGINES:
        raise InvalidValueError(f"engine must be one of {', '.join(ENGINES)}, got {asked!r}")
    if asked == "fast":
        module()
    if asked == "auto" and not available():
        warnings.warn(f"{_NOT_BUILT}; the reference engine runs instead", SlowEngineWarning, stacklevel=4)
        return "reference"
    return "fast" if asked == "auto" else asked


def instruction_sets() -> list[str]:
    """Return what the fast engine can use on this processor, the fastest first.

    Returns
    -------
    list of str
        Of ``avx512``, ``avx2`` and ``plain``.
    """
    return list(module().instruction_sets())


def instruction_set() -> str:
    """Return what the fast engine will use: the environment variable ROCKING_ISA, or the fastest there is.

    Returns
    -------
    str
        One of `instruction_sets`.

    Raises
    ------
    InvalidValueError
        If the environment asks for one that this processor lacks.
    """
    wanted, known = os.environ.get("ROCKING_ISA", ""), instruction_sets()
    if wanted and wanted not in known:
        raise InvalidValueError(f"ROCKING_ISA must be one of {', '.join(known)}, got {wanted!r}")
    return wanted or known[0]


def module() -> ModuleType:
    """Return the compiled module.

    Returns
    -------
    module
        The fast engine.

    Raises
    ------
    MissingExtraError
        If it was not built.
    """
    found = _module()
    if found is None:
        raise MissingExtraError(f'{_NOT_BUILT}; engine="reference" gives the same results, slowly')
    return found


class Library:
    """Motions laid out for the fast engine, all of the same degree, all with or all without a vertical part.

    Parameters
    ----------
    segments : list of Segments
        The motions, of degree 1 (records) or 7 (pulses).

    Raises
    ------
    InvalidValueError
        If there is none, or they are of different kinds.
    """

    def __init__(self, segments: list[Segments]) -> None:
        if not segments:
            raise InvalidValueError("motions must be at least one, got none")
        self.degree = segments[0].degree
        self.vertical = any(s.vertical is not None for s in segments)
        if self.degree not in {1, 7} or any(s.degree != self.degree for s in segments):
            raise InvalidValueError("motions in one batch must be all records or all pulses; sample the pulses")
        if self.degree > 1 and self.vertical:
            raise InvalidValueError("a pulse has no vertical part; sample it")
        laid = [self._flat(s) for s in segments]
        data, counts, still = [d for d, _, _ in laid], [n for _, n, _ in laid], [m for _, _, m in laid]
        first = np.concatenate([[0], np.cumsum([d.size for d in data])[:-1]]).astype(np.int64)
        steps = np.array([s.step for s in segments])
        self.handle = module().Library(
            np.concatenate(data), self.degree, self.vertical, first, np.array(counts, np.int64),
            np.array(still, np.int64), steps,
        )  # fmt: skip

    def _flat(self, segments: Segments) -> tuple[FloatArray, int, int]:
        """Numbers one after another, stretches up to the jump to rest if there is one, and stretches after it."""
        if self.degree > 1:
            return np.ascontiguousarray(segments.horizontal).ravel(), segments.count, 0
        parts = [segments.horizontal]
        if self.vertical:
            vertical = segments.vertical
            parts.append(np.zeros_like(segments.horizontal) if vertical is None else vertical)
        jumps = np.flatnonzero(np.any([_jumps(lines) for lines in parts], axis=0))
        if not jumps.size:
            return np.ascontiguousarray(np.column_stack([_samples(x) for x in parts])).ravel(), segments.count, 0
        before = int(jumps[0]) + 1
        if jumps.size > 1 or any(np.any(lines[before:]) for lines in parts):
            raise InvalidValueError(
                f"the fast engine takes records without jumps between their samples, got {jumps.size}, the first "
                f'after {before * segments.step:g} s; engine="reference" takes them'
            )
        rows = [np.append(_samples(lines[:before]), np.zeros(segments.count - before + 1)) for lines in parts]
        return np.ascontiguousarray(np.column_stack(rows)).ravel(), before, segments.count - before


def _samples(lines: FloatArray) -> FloatArray:
    return np.append(lines[:, 0], lines[-1].sum())


def _jumps(lines: FloatArray) -> np.ndarray:
    gap = np.abs(lines[:-1].sum(axis=1) - lines[1:, 0])
    return np.asarray(gap > 1e-14 * np.abs(lines[:, 0]).max(initial=0.0))


def empty_results(count: int) -> Arrays:
    """Return arrays for the results of some histories.

    Parameters
    ----------
    count : int
        How many.

    Returns
    -------
    dict of str to ndarray
        One array for each key of `RESULTS`.
    """
    return {name: np.empty(count, dtype) for name, dtype in RESULTS.items()}


def common(settings: Settings, law: ImpactLaw) -> Arrays:
    """Return the arguments that all calls of the fast engine share.

    Parameters
    ----------
    settings : Settings
        How to integrate.
    law : ImpactLaw
        How the coefficient changes from impact to impact.

    Returns
    -------
    dict
        Keyword arguments.
    """
    return {
        "kind": law.kind, "at": law.at, "value": law.factors, "seed": law.seed,
        "gravity": settings.gravity, "longest_step": settings.longest_step, "rest": settings.rest_speed,
        "most_impacts": settings.most_impacts, "linear": settings.linear, "isa": instruction_set(),
    }  # fmt: skip
