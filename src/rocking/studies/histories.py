"""Histories of a study: what is computed, in an order that never changes, in pieces that any worker can do alone."""

import hashlib
import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.dynamics.batch import Batch
from rocking.dynamics.content import full_name, hash_of
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays, empty_results
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import PIECE, ROWS, SIDE_DEFAULTS, Rows
from rocking.dynamics.settings import Settings, check_progress
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.studies.motion_sets import MotionSet

_ROWS_AT_ONCE = 32768
MOTIONS_AT_ONCE = 128  # motions made from a seed that are laid out at a time

MOTIONS_KEPT = 128 << 20
"""Room for motions that are kept for the next piece, where histories of one motion do not stand together [bytes]."""

LARGEST_CHUNK = 1 << 22  # a chunk is held in memory as a whole: 0.3 GB


@dataclass(frozen=True, eq=False)
class Histories(ABC):
    """Independent histories, numbered 0 to count - 1.

    A piece of them can be computed anywhere, in any order: a history's result depends on its number alone. All fields
    can be pickled.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    law : ImpactLaw
        How the coefficient changes from impact to impact.
    settings : Settings
        How to integrate.
    engine : {"auto", "fast", "reference"}
        Which engine.
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
        """Histories of one motion that stand in a row, from a multiple of this number on: the best places to cut."""
        return 1

    @property
    def columns(self) -> dict[str, Any]:
        """Types of the results, by their names."""
        return RESULTS

    @property
    def parts(self) -> "tuple[Histories, ...]":
        """What they are joined from, each of one law and engine: themselves alone."""
        return (self,)

    @abstractmethod
    def rows(self, first: int, last: int) -> Rows:
        """Return what makes the histories from a first up to but not including a last one.

        Parameters
        ----------
        first, last : int
            Numbers of histories.

        Returns
        -------
        Rows
            The rows; the stream of a history is its number.
        """

    @abstractmethod
    def content(self) -> dict[str, Any]:
        """Return what beside motions, law and settings makes these histories these, as plain values.

        Returns
        -------
        dict
            Numbers, words, lists and dictionaries only; arrays as their SHA-256.
        """

    def description(self) -> dict[str, Any]:
        """Return what makes these histories these, as plain values.

        Returns
        -------
        dict
            Two studies that describe themselves alike have the same results.
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
        """Return the name of these histories.

        Parameters
        ----------
        described : dict, optional
            Their `description`, if it is at hand: it takes a hash of every array.

        Returns
        -------
        str
            SHA-256 of `description`, 64 hexadecimal digits.

        Raises
        ------
        InvalidValueError
            If the description holds anything but plain values.
        """
        content = self.description() if described is None else described
        try:
            text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        except (TypeError, ValueError) as error:
            why = f"what makes histories must be finite numbers, words, lists and dictionaries of words: {error}"
            raise InvalidValueError(why) from error
        return hashlib.sha256(text.encode()).hexdigest()

    def run(self, first: int, last: int, *, threads: int | None = None) -> Arrays:
        """Return the results of some histories.

        Parameters
        ----------
        first, last : int
            Numbers: from the first up to but not including the last.
        threads : int, optional
            Threads of the fast engine; the results do not depend on them.

        Returns
        -------
        dict of str to ndarray
            The keys of `columns`, one entry a history.

        Raises
        ------
        InvalidValueError
            If the numbers are not of histories.
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
        """Leave the motions as the engine lays them out behind: they are made again where they are needed."""
        return {name: value for name, value in self.__dict__.items() if name not in {"_batch", "_kept"}}

    @cached_property
    def _kept(self) -> dict[int, Segments]:
        """Motions that were made for an earlier piece, the oldest first."""
        return {}

    def _forget(self) -> None:
        """Forget the oldest motions: all but the last where those of the next piece are others, or there is no room."""
        scattered = self.together == 1 and self.count > len(self.motions)
        room = MOTIONS_KEPT if scattered else 0
        for number in list(self._kept)[-2::-1]:
            kept = self._kept.get(number)  # threads of a worker share them
            if kept is not None:
                room -= sum(part.nbytes for part in (kept.horizontal, kept.vertical) if part is not None)
            if room < 0:
                self._kept.pop(number, None)

    def _run_made(self, first: int, last: int, threads: int | None) -> Arrays:
        """Run with motions that are made for some histories and forgotten after them: never many at once."""
        results = empty_results(last - first)
        for start in range(first, last, _ROWS_AT_ONCE):
            rows = self.rows(start, min(start + _ROWS_AT_ONCE, last))
            wanted, places = np.unique(rows.motion, return_inverse=True)
            for low in range(0, len(wanted), MOTIONS_AT_ONCE):
                some = wanted[low : low + MOTIONS_AT_ONCE]
                chosen = np.flatnonzero((places >= low) & (places < low + len(some)))
                local = Rows(
                    {name: rows.values[name][chosen] for name in ROWS}, places[chosen].astype(np.int64) - low,
                    rows.stream[chosen],
                )  # fmt: skip
                batch = Batch(self._laid_out(some.tolist()), self.law, self.settings, threads, self.engine)
                for name, values in batch.run(len(local), local.part)[0].items():
                    results[name][start - first + chosen] = values
        return results

    def _laid_out(self, wanted: list[int]) -> list[Segments]:
        """Return some motions, made unless they are kept; the newest stand last."""
        every = []
        for number in wanted:
            segments = self._kept.pop(number, None) or self.motions[number].segments()
            self._kept[number] = segments
            every.append(segments)
        self._forget()
        return every


def checked_range(first: int, last: int, count: int) -> None:
    """Refuse numbers that are not of histories."""
    if not 0 <= first <= last <= count:
        raise InvalidValueError(
            "{parameter} must be within [0, {count}], got {first} to {last}", parameter="histories", count=count,
            first=first, last=last,
        )  # fmt: skip


def results_of(
    histories: Histories, *, threads: int | None = None, progress: Callable[[int], None] | None = None
) -> Arrays:
    """Return the results of all histories, computed piece by piece so that progress can be told."""
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
    """Histories given one by one.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    motion : ndarray of int
        Number of each history's motion.
    values : dict of str to ndarray
        The keys of `batch.ROWS` [rad, rad/s, -, rad, rad/s], one entry a history.
    law, settings, engine
        As for `Histories`.

    Raises
    ------
    InvalidValueError
        If the arrays do not fit one another.
    """

    motion: np.ndarray
    values: dict[str, FloatArray]

    def __post_init__(self) -> None:
        count = max((np.size(v) for v in [self.motion, *self.values.values()]), default=0)
        whole = Rows.of(count, self.motion, **self.values)
        values = {name: _own(array, self.values.get(name)) for name, array in whole.values.items()}
        object.__setattr__(self, "motion", _own(whole.motion, self.motion))
        object.__setattr__(self, "values", values)

    @property
    def count(self) -> int:
        """Number of histories."""
        return int(self.motion.size)

    def rows(self, first: int, last: int) -> Rows:
        """Return some of the rows."""
        values = {name: array[first:last] for name, array in self.values.items()}
        return Rows(values, self.motion[first:last], np.arange(first, last, dtype=np.int64))

    def content(self) -> dict[str, Any]:
        """Return the hashes of the arrays, of friction and azimuth where they are told."""
        usual = {name for name in ("friction", "azimuth") if np.isnan(self.values[name]).all()}
        told = {name: array for name, array in self.values.items() if name not in usual}
        return {"motion": hash_of(self.motion)} | {name: hash_of(values) for name, values in told.items()}


@dataclass(frozen=True, eq=False)
class Product(Histories):
    """Every motion with every body, scale and restitution; the motion changes slowest, the restitution fastest.

    Parameters
    ----------
    motions : MotionSet
        The motions.
    sides : dict of str to ndarray, shape (bodies, restitutions) or (motions, bodies, restitutions)
        The same under every motion, or for each its own: alpha_right, alpha_left [rad], p_right, p_left [rad/s],
        r_right, r_left [-]; and q_right, q_left (m R^2 / I_O), without which the forces of the ground are not known
        [-]; and share_right, share_left, of the probability of a law that draws, 1 if not given [-].
    scales : ndarray, shape (scales,) or (motions, scales)
        Factors on the motions, the same for all or for each its own [-].
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
        """Histories of each motion."""
        return self.count // len(self.motions)

    def rows(self, first: int, last: int) -> Rows:
        """Return some of the rows."""
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
    """Histories of several kinds, one after another: each part has a law, an engine and motions of its own."""

    joined: tuple[Histories, ...]  # whose motions are made of the common ones

    @property
    def parts(self) -> tuple[Histories, ...]:
        """The parts, in order."""
        return self.joined

    @property
    def count(self) -> int:
        """Number of histories of all parts."""
        return sum(part.count for part in self.parts)

    def _within(self, first: int, last: int) -> Iterator[tuple[Histories, int, int]]:
        """Yield the parts of which some histories are, and which of their own these are."""
        for part in self.parts:
            if first < part.count and last > 0:
                yield part, max(first, 0), min(last, part.count)
            first, last = first - part.count, last - part.count

    def rows(self, first: int, last: int) -> Rows:
        """Return some of the rows; their motions are those of the parts."""
        pieces = [part.rows(low, high) for part, low, high in self._within(first, last)]
        values = {name: np.concatenate([np.empty(0), *(each.values[name] for each in pieces)]) for name in ROWS}
        motion = np.concatenate([np.empty(0, np.int64), *(each.motion for each in pieces)])
        return Rows(values, motion, np.arange(first, last, dtype=np.int64))

    def run(self, first: int, last: int, *, threads: int | None = None) -> Arrays:
        """Return the results of some histories, part by part."""
        checked_range(first, last, self.count)
        results, done = empty_results(last - first), 0
        for part, low, high in self._within(first, last):
            for name, values in part.run(low, high, threads=threads).items():
                results[name][done : done + high - low] = values
            done += high - low
            if high == part.count:  # its motions as the engine lays them out: of one part at a time there is room
                part.__dict__.pop("_batch", None)
        return results

    def content(self) -> dict[str, Any]:
        """Return how many parts there are, and the hash of what makes them."""
        parts = [
            {"count": part.count, "content": part.content(), "law": described_law(part.law)} | part.settings.identity
            for part in self.parts
        ]
        motions = [each.description() for each in dict.fromkeys(part.motions for part in self.parts)]
        text = json.dumps([parts, motions], sort_keys=True, allow_nan=False)
        return {"parts": len(parts), "sha256": hashlib.sha256(text.encode()).hexdigest()}


def _own(array: np.ndarray, original: object) -> np.ndarray:
    """Return the array, read-only, and as a copy where it is the caller's: what has been named must not change."""
    mine = array.copy() if np.may_share_memory(array, np.asarray(original)) else array
    mine.setflags(write=False)
    return mine


def described_law(law: ImpactLaw) -> dict[str, Any]:
    """Return what makes a law of impact this law: its class, and what it says of itself."""
    return {"law": type(law).__name__, "class": full_name(type(law)), "content": law.content()}
