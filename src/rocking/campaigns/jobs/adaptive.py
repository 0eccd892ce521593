"""Studies whose next histories depend on the results of the last: they ask for rounds, which somebody else computes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from rocking.conventions import IntArray
from rocking.dynamics.content import hash_of
from rocking.dynamics.plane.batch import Batch, Rows
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.errors import InvalidValueError
from rocking.studies.histories import Histories, HistoryTable
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.question import Question
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Table

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
