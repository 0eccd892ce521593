"""Study of a campaign: histories, dimensions, evaluation of results, and rounds."""

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
"""Data types of the results of a history."""


Compute = Callable[[Histories], Arrays]
"""Function that computes a round of histories. A campaign stores every round and can resume after it."""


@dataclass(frozen=True)
class AdaptiveResult:
    """Result of an adaptive study: tables of any length, in addition to the histories or instead of the histories."""

    value: Any  # return value of the Python function
    tables: Mapping[str, Table]  # tables of the result, by their names in `export`
    attributes: dict[str, Any] = field(default_factory=dict)  # additional attributes, as plain values


class Search(Protocol):
    """An adaptive study."""

    @property
    def kept(self) -> float:
        """Fraction of the later histories that stays in memory [-]."""

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Compute the rounds of histories and return the result."""

    def later(self, first: int) -> tuple[int, int]:
        """Return the usual range of the number of histories of later rounds, known from jobs of many sizes."""


@dataclass(frozen=True)
class Study:
    """Histories over dimensions."""

    histories: Histories  # histories (for an adaptive study, the first round); the last dimension changes fastest
    dims: dict[str, int]  # length of every dimension, in order
    coordinates: dict[str, Column]  # coordinates along the dimensions: columns with `dims`
    attributes: dict[str, Any] = field(default_factory=dict)  # description of the study, as plain values
    exports: tuple[str, ...] = ("histories",)  # possible exports; the first is the default
    # function from the results of all histories to the fragility analyses of the restitutions, by label
    finish: Callable[[Arrays], dict[str, Any]] | None = None
    # function of first index, last index and results that converts results to the units of the user
    rescale: Callable[[int, int, Arrays], Arrays] | None = None
    # search of an adaptive study, a function from a `Compute` to the result of all rounds
    search: Search | None = None
    # function from outcome and peak_rotation of all histories to the assessment of an inventory
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
        """Data types of the results in the units of the user."""
        own = self.histories.columns
        return {**TYPES, **{name: own[name] for name in self.further_columns}} if self.is_of_rocking else dict(own)

    @property
    def is_of_rocking(self) -> bool:
        """True if the histories have all results of the fast engine."""
        return RESULTS.keys() <= self.histories.columns.keys()

    @property
    def further_columns(self) -> tuple[str, ...]:
        """Names of results that the fast engine does not have, such as those of restraints."""
        return tuple(name for name in self.histories.columns if name not in RESULTS)

    def derived(self, first: int, last: int, results: Arrays) -> Arrays:
        """Return the results of histories in the units of the user, with derived quantities."""
        if not self.is_of_rocking:
            return results
        own = results if self.rescale is None else self.rescale(first, last, dict(results))
        sides = self.histories.rows(first, last).values
        ratio = peak_ratio(own["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        all_results = {**own, **flags(own), "mode": modes_of(own), "peak_ratio": ratio}
        return {name: all_results[name] for name in self.types}

    def dataset(self, results: Mapping[str, Any]) -> "xr.Dataset":
        """Return results of all histories over the dimensions, with units."""
        xarray: Any = extra("xarray", "a dataset of histories")
        dims = tuple(self.dims)
        data = {name: (dims, values.reshape(self.shape), attributes(name)) for name, values in results.items()}
        coords = {name: (column.dims, column.values, column.attributes) for name, column in self.coordinates.items()}
        dataset: xr.Dataset = xarray.Dataset(data, coords, plain_texts(self.attributes))
        return dataset

    def computed(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Any:
        """Compute the study in memory. Return the value of its search, its evaluation, or the dataset of histories."""
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
    """Return the names of the motions. For a set that is generated from a seed, return indices."""
    if isinstance(motions, MotionList):
        return labels_along("motion", (motions[k].name for k in range(len(motions))), "name of the motion")
    return along("motion", np.arange(len(motions)), "1", "number of the motion in its set")


@dataclass(frozen=True, eq=False)
class NumberedTable(HistoryTable):
    """Table of histories, with one index of random numbers per history."""

    number: IntArray  # indices of the random coefficients of the histories

    def rows(self, first: int, last: int) -> Rows:
        """Return a range of the rows."""
        rows = super().rows(first, last)
        return Rows(rows.values, rows.motion, self.number[first:last])

    def content(self) -> dict[str, Any]:
        """Return the hashes of the arrays."""
        return super().content() | {"number": hash_of(np.asarray(self.number, dtype=np.int64))}


@dataclass(frozen=True)
class DelegatedBatch(Batch):
    """A batch whose histories are computed in rounds by `compute`."""

    motion_set: MotionSet = field(kw_only=True)
    compute: Compute = field(kw_only=True)

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results of histories. Results that a round does not store are NaN. Steps are not counted."""
        if not count:
            return super().run(0, rows)
        all_rows = rows(0, count)
        options: dict[str, Any] = {"law": self.law, "settings": self.settings, "engine": self.engine}
        table = NumberedTable(self.motion_set, all_rows.motion, all_rows.values, all_rows.stream, **options)
        results = self.compute(sampled(table))
        # results that a round does not store are not used; views of one NaN need no memory
        return {name: results.get(name, np.broadcast_to(np.nan, count)) for name in RESULTS}, {}


@dataclass(frozen=True)
class DelegatedQuestion(Question):
    """A question whose histories are computed by `compute`. It can be used in any study."""

    compute: Compute = field(kw_only=True)

    @classmethod
    def of(cls, question: Question, compute: Compute) -> "DelegatedQuestion":
        """Return a copy of a question with the function `compute`."""
        return cls(**{name: getattr(question, name) for name in question.__dataclass_fields__}, compute=compute)

    @cached_property
    def batch(self) -> Batch:
        """Batch of the motion that delegates the computation."""
        return DelegatedBatch(
            [self.motion.segments()], self.law, self.settings, None, self.engine,
            motion_set=MotionList([self.motion]), compute=self.compute,
        )  # fmt: skip


class _FirstRoundError(Exception):
    """Stops a study at its first round."""


def first_round(search: Callable[[Compute], Any]) -> Histories:
    """Return the first round of histories of a study without computing it."""

    def stop(histories: Histories) -> Arrays:
        raise _FirstRoundError(histories)

    try:
        search(stop)
    except _FirstRoundError as error:
        histories: Histories = error.args[0]
        return histories
    raise InvalidValueError("a study must request at least one round")
