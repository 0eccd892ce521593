"""A study as a campaign computes it: histories, their dimensions, the use of their results, and rounds."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from rocking.conventions import IntArray
from rocking.dynamics.batch import Batch
from rocking.dynamics.content import hash_of
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError, extra
from rocking.messages import plain_texts
from rocking.outcome import flags
from rocking.quantities import HISTORY, attributes
from rocking.studies.histories import Histories, HistoryTable, results_of
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.question import Question, modes_of, peak_ratio
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column, Table, text_array

if TYPE_CHECKING:
    import xarray as xr

TYPES: dict[str, Any] = {
    name: np.float64 if name in {"overturned", "still_rocking", "lost_contact"} else RESULTS.get(name, np.float64)
    for name in HISTORY
} | {"mode": np.int64}
"""Type of what is known of every history."""


Compute = Callable[[Histories], Arrays]
"""Computes a round of histories; in a campaign each round is kept, and is not computed again by whoever goes on."""


@dataclass(frozen=True)
class AdaptiveResult:
    """The result of an adaptive study: tables of any length, beside or in place of its histories."""

    value: Any  # what the Python call returns
    tables: Mapping[str, Table]  # the same as tables, by what `export` calls them
    attributes: dict[str, Any] = field(default_factory=dict)  # what more is to be said of it, as plain values


class Search(Protocol):
    """An adaptive study."""

    @property
    def kept(self) -> float:
        """Share of its later histories that stays in memory [-]."""

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Ask for one round of histories after another."""

    def later(self, first: int) -> tuple[int, int]:
        """Return from and to how many histories later rounds usually have, as jobs of many sizes had them."""


@dataclass(frozen=True)
class Study:
    """Histories over dimensions."""

    histories: Histories  # what is computed, of an adaptive study first; the last dimension changes fastest
    dims: dict[str, int]  # length of every dimension, in order
    coordinates: dict[str, Column]  # what is known along the dimensions: columns with `dims`
    attributes: dict[str, Any] = field(default_factory=dict)  # what the study is, as plain values
    exports: tuple[str, ...] = ("histories",)  # what can be written of it; the first unless something else is asked for
    # takes the results of all histories and returns the fragility analysis of each restitution by label
    finish: Callable[[Arrays], dict[str, Any]] | None = None
    # takes first and last number of histories and their results, and changes those whose unit is not yet the user's
    rescale: Callable[[int, int, Arrays], Arrays] | None = None
    # of an adaptive study: takes what computes a round of histories, and returns the result of all rounds
    search: Search | None = None
    # takes outcome and peak_rotation of all histories and returns the assessment of an inventory
    assess: Callable[[Arrays], Any] | None = None

    def __post_init__(self) -> None:
        """Check the dimensions."""
        if int(np.prod(self.shape, dtype=np.int64)) != self.histories.count:
            raise InvalidValueError(
                "dimensions {names} do not fit {count} histories",
                names=", ".join(self.dims),
                count=self.histories.count,
            )

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of every dimension."""
        return tuple(self.dims.values())

    @property
    def types(self) -> dict[str, Any]:
        """Types of the results as users know them."""
        own = self.histories.columns
        return TYPES if own is RESULTS else own

    def derived(self, first: int, last: int, results: Arrays) -> Arrays:
        """Return the results of some histories as users know them, with what follows from them."""
        if self.types is not TYPES:
            return results
        own = results if self.rescale is None else self.rescale(first, last, dict(results))
        sides = self.histories.rows(first, last).values
        ratio = peak_ratio(own["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        whole = {**own, **flags(own), "mode": modes_of(own), "peak_ratio": ratio}
        return {name: whole[name] for name in HISTORY}

    def dataset(self, results: Mapping[str, Any]) -> "xr.Dataset":
        """Return results of all histories over the dimensions, with units."""
        xarray: Any = extra("xarray", "a dataset of histories")
        dims = tuple(self.dims)
        data = {name: (dims, values.reshape(self.shape), attributes(name)) for name, values in results.items()}
        coords = {name: (each.dims, each.values, each.attributes) for name, each in self.coordinates.items()}
        dataset: xr.Dataset = xarray.Dataset(data, coords, plain_texts(self.attributes))
        return dataset

    def computed(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Any:
        """Compute the study in memory; return the value of its search, its evaluation, or the dataset of histories."""
        compute = partial(results_of, progress=progress, threads=threads)
        if self.search is not None:
            return self.search(compute).value
        results = compute(self.histories)
        evaluate = self.finish or self.assess
        if evaluate is not None:
            return evaluate(results)
        return self.dataset(self.derived(0, self.histories.count, results))


def along(dim: str, values: Any, unit: str = "1", meaning: str = "") -> Column:
    """Return numbers along a dimension."""
    return Column(np.asarray(values), unit, meaning, dims=(dim,))


def labels_along(dim: str, values: Iterable[str], meaning: str) -> Column:
    """Return labels along a dimension."""
    return Column(text_array(list(values)), "1", meaning, dims=(dim,))


def motions_along(motions: MotionSet) -> Column:
    """Return what the motions are called: by name, or by number where each is made from a seed when it is needed."""
    if isinstance(motions, MotionList):
        return labels_along("motion", (motions[k].name for k in range(len(motions))), "name of the motion")
    return along("motion", np.arange(len(motions)), "1", "number of the motion in its set")


@dataclass(frozen=True, eq=False)
class NumberedTable(HistoryTable):
    """Histories given one by one, the draws of each under a number of its own."""

    number: IntArray  # number of each history for random coefficients

    def rows(self, first: int, last: int) -> Rows:
        """Return some of the rows."""
        rows = super().rows(first, last)
        return Rows(rows.values, rows.motion, self.number[first:last])

    def content(self) -> dict[str, Any]:
        """Return the hashes of the arrays."""
        return super().content() | {"number": hash_of(np.asarray(self.number, dtype=np.int64))}


@dataclass(frozen=True)
class DelegatedBatch(Batch):
    """A batch whose histories somebody else computes, round by round."""

    motion_set: MotionSet = field(kw_only=True)
    compute: Compute = field(kw_only=True)

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results of many histories, NaN of what a round does not keep; nobody counts the steps."""
        if not count:
            return super().run(0, rows)
        every = rows(0, count)
        options: dict[str, Any] = {"law": self.law, "settings": self.settings, "engine": self.engine}
        table = NumberedTable(self.motion_set, every.motion, every.values, every.stream, **options)
        results = self.compute(sampled(table))
        # nobody asks for what a round does not keep, and views of one NaN need no room
        return {name: results.get(name, np.broadcast_to(np.nan, count)) for name in RESULTS}, {}


@dataclass(frozen=True)
class DelegatedQuestion(Question):
    """A question whose histories somebody else computes: the studies that take questions do not notice."""

    compute: Compute = field(kw_only=True)

    @classmethod
    def of(cls, question: Question, compute: Compute) -> "DelegatedQuestion":
        """Return the same body, motion, restitution and settings."""
        return cls(**{name: getattr(question, name) for name in question.__dataclass_fields__}, compute=compute)

    @cached_property
    def batch(self) -> Batch:
        """The motion, and who computes."""
        return DelegatedBatch(
            [self.motion.segments()], self.law, self.settings, None, self.engine,
            motion_set=MotionList([self.motion]), compute=self.compute,
        )  # fmt: skip


class _FirstRoundError(Exception):
    """Stops a study at the first round that it asks for."""


def first_round(search: Callable[[Compute], Any]) -> Histories:
    """Return the histories that a study asks for first; nothing is computed."""

    def stop(histories: Histories) -> Arrays:
        raise _FirstRoundError(histories)

    try:
        search(stop)
    except _FirstRoundError as error:
        histories: Histories = error.args[0]
        return histories
    raise InvalidValueError("a study must ask for at least one round")
