"""Histories of a study in a fixed order. Workers compute pieces of the histories independently."""

import hashlib
import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.dynamics.batch import Batch
from rocking.dynamics.content import full_name, hash_of
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.plane.fast_engine import Arrays, empty_results
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import PIECE, ROWS, SIDE_DEFAULTS, Rows
from rocking.dynamics.settings import Settings, check_progress
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.studies.motion_sets import MotionSet

_ROWS_AT_ONCE = 32768
MOTIONS_AT_ONCE = 128  # number of generated motions prepared together

MOTIONS_KEPT = 128 << 20
"""Memory for motions that are kept for the next piece if the histories of a motion are not consecutive [bytes]."""

LARGEST_CHUNK = 1 << 22  # histories per chunk; a chunk in memory needs 0.3 GB


@dataclass(frozen=True, eq=False)
class Histories(ABC):
    """Independent histories, numbered 0 to count - 1.

    Pieces can be computed on any machine and in any order, because the result of a history depends only on its index.
    All fields can be pickled.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    law : ImpactLaw
        Law of the coefficient per impact.
    settings : Settings
        Settings of the integration.
    engine : {"auto", "fast", "reference"}
        Name of the engine.
    """

    motions: MotionSet
    law: ImpactLaw = field(default_factory=ConstantRestitution, kw_only=True)
    settings: Settings = field(default_factory=PlaneSettings, kw_only=True)
    engine: str = field(default="auto", kw_only=True)

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of histories."""

    @property
    def together(self) -> int:
        """Number of consecutive histories of one motion. Pieces should be multiples of this number."""
        return 1

    @property
    def columns(self) -> Mapping[str, Any]:
        """Data types of the results by name."""
        return mechanics_of(self.settings).study_columns

    @property
    def parts(self) -> "tuple[Histories, ...]":
        """Parts of joined histories. A part has one law and engine; other histories have one part."""
        return (self,)

    @abstractmethod
    def rows(self, first: int, last: int) -> Rows:
        """Return the inputs of the histories from `first` to `last` (excluded).

        Parameters
        ----------
        first, last : int
            Indices of histories.

        Returns
        -------
        Rows
            The rows. The stream of a history is its index.
        """

    @abstractmethod
    def content(self) -> dict[str, Any]:
        """Return the identity of the histories as plain values, except motions, law and settings.

        Returns
        -------
        dict
            Only numbers, texts, lists and dictionaries. Arrays are given by their SHA-256.
        """

    def description(self) -> dict[str, Any]:
        """Return the identity of the histories, as plain values.

        Returns
        -------
        dict
            Plain values. Studies with equal descriptions have equal results.
        """
        return {
            "histories": type(self).__name__,
            "class": full_name(type(self)),
            "count": self.count,
            "content": self.content(),
            "motions": {"class": full_name(type(self.motions)), **self.motions.description()},
            "law": described_law(self.law),
            "settings": self.settings.identity,
            "engine": self.engine,
        }

    def key(self, described: dict[str, Any] | None = None) -> str:
        """Return the key of these histories.

        Parameters
        ----------
        described : dict, optional
            The `description` of the histories, which avoids hashing every array again.

        Returns
        -------
        str
            SHA-256 of `description`, 64 hexadecimal digits.

        Raises
        ------
        InvalidValueError
            If the description contains values that are not plain.
        """
        content = self.description() if described is None else described
        try:
            text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        except (TypeError, ValueError) as error:
            message = (
                f"the description of histories must contain finite numbers, texts, lists and dictionaries: {error}"
            )
            raise InvalidValueError(message) from error
        return hashlib.sha256(text.encode()).hexdigest()

    def run(self, first: int, last: int, *, threads: int | None = None) -> Arrays:
        """Return the results of a range of histories.

        Parameters
        ----------
        first, last : int
            Indices of the first and the last history (excluded).
        threads : int, optional
            Threads of the fast engine; the results do not depend on them.

        Returns
        -------
        dict of str to ndarray
            Results by the keys of `columns`, one entry per history.

        Raises
        ------
        InvalidValueError
            If the indices are out of range.
        """
        checked_range(first, last, self.count)
        if self.motions.in_memory:
            return self._batch.run(last - first, lambda a, b: self.rows(first + a, first + b), threads=threads)[0]
        return self._run_made(first, last, threads)

    @cached_property
    def _batch(self) -> Batch:
        motions = [self.motions[k].segments() for k in range(len(self.motions))]
        return Batch(motions, self.law, self.settings, None, self.engine)

    def __getstate__(self) -> dict[str, Any]:
        """Exclude the prepared motions, which are generated again when needed."""
        return {name: value for name, value in self.__dict__.items() if name not in {"_batch", "_kept"}}

    @cached_property
    def _kept(self) -> dict[int, Segments]:
        """Motions of earlier pieces, with the oldest first."""
        return {}

    def _forget(self) -> None:
        """Remove the oldest motions.

        Keep only the last motion if the next piece needs others, or if memory is short.
        """
        scattered = self.together == 1 and self.count > len(self.motions)
        room = MOTIONS_KEPT if scattered else 0
        for number in list(self._kept)[-2::-1]:
            segments = self._kept.get(number)  # all threads of a worker use these motions
            if segments is not None:
                arrays = (segments.horizontal, segments.vertical)
                room -= sum(array.nbytes for array in arrays if array is not None)
            if room < 0:
                self._kept.pop(number, None)

    def _run_made(self, first: int, last: int, threads: int | None) -> Arrays:
        """Run with motions that are generated for a few histories and then removed."""
        results = empty_results(last - first, self.columns)
        for start in range(first, last, _ROWS_AT_ONCE):
            rows = self.rows(start, min(start + _ROWS_AT_ONCE, last))
            motions, inverse = np.unique(rows.motion, return_inverse=True)
            for low in range(0, len(motions), MOTIONS_AT_ONCE):
                group = motions[low : low + MOTIONS_AT_ONCE]
                selected = np.flatnonzero((inverse >= low) & (inverse < low + len(group)))
                local = Rows(
                    {name: rows.values[name][selected] for name in ROWS}, inverse[selected].astype(np.int64) - low,
                    rows.stream[selected],
                )  # fmt: skip
                batch = Batch(self._prepared(group.tolist()), self.law, self.settings, threads, self.engine)
                for name, values in batch.run(len(local), local.part)[0].items():
                    results[name][start - first + selected] = values
        return results

    def _prepared(self, numbers: list[int]) -> list[Segments]:
        """Return motions from memory, or generate them. The newest motions are kept last."""
        motions = []
        for number in numbers:
            segments = self._kept.pop(number, None) or self.motions[number].segments()
            self._kept[number] = segments
            motions.append(segments)
        self._forget()
        return motions


def checked_range(first: int, last: int, count: int) -> None:
    """Raise an error for indices out of range."""
    if not 0 <= first <= last <= count:
        raise InvalidValueError(
            "{parameter} must be within [0, {count}], got {first} to {last}", parameter="histories", count=count,
            first=first, last=last,
        )  # fmt: skip


def results_of(
    histories: Histories, *, threads: int | None = None, progress: Callable[[int], None] | None = None
) -> Arrays:
    """Return the results of all histories. They are computed in pieces, with calls of `progress`."""
    check_progress(progress)
    results = empty_results(histories.count, histories.columns)
    for first in range(0, histories.count, PIECE):
        last = min(first + PIECE, histories.count)
        for name, values in histories.run(first, last, threads=threads).items():
            results[name][first:last] = values
        if progress is not None:
            progress(last - first)
    return results


@dataclass(frozen=True, eq=False)
class HistoryTable(Histories):
    """Table of histories.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    motion : ndarray of int
        Index of the motion of each history.
    values : dict of str to ndarray
        Values by the keys of `batch.ROWS` [rad, rad/s, -, rad, rad/s], one entry per history.
    law, settings, engine
        As for `Histories`.

    Raises
    ------
    InvalidValueError
        If the arrays have different lengths.
    """

    motion: np.ndarray
    values: dict[str, FloatArray]

    def __post_init__(self) -> None:
        count = max((np.size(v) for v in [self.motion, *self.values.values()]), default=0)
        rows = Rows.of(count, self.motion, **self.values)
        values = {name: _own(array, self.values.get(name)) for name, array in rows.values.items()}
        object.__setattr__(self, "motion", _own(rows.motion, self.motion))
        object.__setattr__(self, "values", values)

    @property
    def count(self) -> int:
        """Number of histories."""
        return int(self.motion.size)

    def rows(self, first: int, last: int) -> Rows:
        """Return a range of the rows."""
        values = {name: array[first:last] for name, array in self.values.items()}
        return Rows(values, self.motion[first:last], np.arange(first, last, dtype=np.int64))

    def content(self) -> dict[str, Any]:
        """Return the hashes of the arrays. Friction and azimuth are included only if they are set."""
        unset = {name for name in ("friction", "azimuth") if np.isnan(self.values[name]).all()}
        arrays = {name: array for name, array in self.values.items() if name not in unset}
        return {"motion": hash_of(self.motion)} | {name: hash_of(values) for name, values in arrays.items()}


@dataclass(frozen=True, eq=False)
class Product(Histories):
    """Every motion with every body, scale and restitution. The motion changes slowest, the restitution fastest.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    sides : dict of str to ndarray, shape (bodies, restitutions) or (motions, bodies, restitutions)
        Values for all motions, or per motion: alpha_right, alpha_left [rad], p_right, p_left [rad/s], r_right, r_left
        [-]. Optional values are q_right, q_left (m R^2 / I_O) for the ground forces [-], and the probability fractions
        share_right, share_left of a random law, default 1 [-].
    scales : ndarray, shape (scales,) or (motions, scales)
        Scale factors for all motions, or per motion [-].
    law, settings, engine
        As for `Histories`.
    """

    sides: dict[str, FloatArray]
    scales: FloatArray

    def __post_init__(self) -> None:
        names = {name for name in ROWS if name[-5:] in {"right", "_left"}}
        shape = np.shape(next(iter(self.sides.values()), ()))
        unknown = {name: np.full(shape, value) for name, value in SIDE_DEFAULTS.items()}
        object.__setattr__(self, "sides", unknown | self.sides)
        shapes = {np.shape(values) for values in self.sides.values()}
        (size, *others) = shapes
        if set(self.sides) != names or others or len(size) not in {2, 3} or size[:-2] not in {(), (len(self.motions),)}:
            raise InvalidValueError(
                "{parameter} must be {names}, each of shape (bodies, restitutions)", parameter="sides",
                names=", ".join(sorted(names)),
            )  # fmt: skip
        scales = np.asarray(self.scales, dtype=np.float64)
        if scales.ndim not in {1, 2} or (scales.ndim == 2 and len(scales) != len(self.motions)) or not scales.size:
            raise InvalidValueError(
                "{parameter} must be of shape (scales,) or (motions, scales), got {shape}", parameter="scales",
                shape=scales.shape,
            )  # fmt: skip
        sides = {name: checks.real_array(name, values) for name, values in self.sides.items()}
        object.__setattr__(self, "sides", {name: _own(array, self.sides[name]) for name, array in sides.items()})
        object.__setattr__(self, "scales", _own(scales, self.scales))
        if self.motions.in_memory:
            plausibility.warn(plausibility.of_scaled([self.motions[k] for k in range(len(self.motions))], scales))

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Numbers of motions, bodies, scales and restitutions."""
        bodies, restitutions = self.sides["p_right"].shape[-2:]
        return len(self.motions), bodies, self.scales.shape[-1], restitutions

    @property
    def count(self) -> int:
        """Number of histories."""
        return int(np.prod(self.shape, dtype=np.int64))

    @property
    def together(self) -> int:
        """Number of histories per motion."""
        return self.count // len(self.motions)

    def rows(self, first: int, last: int) -> Rows:
        """Return a range of the rows."""
        numbers = np.arange(first, last, dtype=np.int64)
        motion, body, scale, restitution = np.unravel_index(numbers, self.shape)
        factor = self.scales[scale] if self.scales.ndim == 1 else self.scales[motion, scale]
        own = {2: (body, restitution), 3: (motion, body, restitution)}
        values = {name: array[own[array.ndim]] for name, array in self.sides.items()}
        return Rows.of(last - first, motion, numbers, scale=factor, **values)

    def content(self) -> dict[str, Any]:
        """Return the shape and the hashes of the arrays."""
        hashes = {name: hash_of(np.ascontiguousarray(values)) for name, values in self.sides.items()}
        return {"shape": list(self.shape), "scales": hash_of(self.scales), **hashes}


@dataclass(frozen=True, eq=False)
class JoinedHistories(Histories):
    """Consecutive histories of several kinds. Every part has its own law, engine and motions."""

    joined: tuple[Histories, ...]  # parts, with motions from the common set

    @property
    def parts(self) -> tuple[Histories, ...]:
        """The parts, in order."""
        return self.joined

    @property
    def count(self) -> int:
        """Number of histories of all parts."""
        return sum(histories.count for histories in self.parts)

    def _within(self, first: int, last: int) -> Iterator[tuple[Histories, int, int]]:
        """Yield the parts with histories in the range, and their ranges."""
        for histories in self.parts:
            if first < histories.count and last > 0:
                yield histories, max(first, 0), min(last, histories.count)
            first, last = first - histories.count, last - histories.count

    def rows(self, first: int, last: int) -> Rows:
        """Return a range of the rows. The motions of the rows are the motions of the parts."""
        pieces = [histories.rows(low, high) for histories, low, high in self._within(first, last)]
        values = {name: np.concatenate([np.empty(0), *(piece.values[name] for piece in pieces)]) for name in ROWS}
        motion = np.concatenate([np.empty(0, np.int64), *(piece.motion for piece in pieces)])
        return Rows(values, motion, np.arange(first, last, dtype=np.int64))

    def run(self, first: int, last: int, *, threads: int | None = None) -> Arrays:
        """Return the results of a range of histories, part by part."""
        checked_range(first, last, self.count)
        results, done = empty_results(last - first), 0
        for histories, low, high in self._within(first, last):
            for name, values in histories.run(low, high, threads=threads).items():
                results[name][done : done + high - low] = values
            done += high - low
            if high == histories.count:  # keep the prepared motions of only one part
                histories.__dict__.pop("_batch", None)
        return results

    def content(self) -> dict[str, Any]:
        """Return the number of parts and the hash of their identity."""
        parts = [
            {"count": item.count, "content": item.content(), "law": described_law(item.law)} | item.settings.identity
            for item in self.parts
        ]
        motions = [motion_set.description() for motion_set in dict.fromkeys(item.motions for item in self.parts)]
        text = json.dumps([parts, motions], sort_keys=True, allow_nan=False)
        return {"parts": len(parts), "sha256": hashlib.sha256(text.encode()).hexdigest()}


def _own(array: np.ndarray, original: object) -> np.ndarray:
    """Return a read-only array. An array of the caller is copied, because hashed arrays must not change."""
    mine = array.copy() if np.may_share_memory(array, np.asarray(original)) else array
    mine.setflags(write=False)
    return mine


def described_law(law: ImpactLaw) -> dict[str, Any]:
    """Return the identity of an impact law, which is its class and its content."""
    return {"law": type(law).__name__, "class": full_name(type(law)), "content": law.content()}
