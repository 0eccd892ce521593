"""Histories that a study asks for while it runs: what it asks next depends on what it was answered."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import IntArray
from rocking.dynamics.plane.batch import Batch, Rows
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.errors import InvalidValueError
from rocking.studies.histories import Histories, HistoryTable, hash_of
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.question import Question
from rocking.studies.sensitivity.restitutions import sampled

Compute = Callable[[Histories], Arrays]
"""Computes a round of histories; in a campaign each round is kept, and is not computed again by whoever goes on."""


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
class AskedBatch(Batch):
    """A batch whose histories somebody else computes, round by round."""

    motion_set: MotionSet = field(kw_only=True)
    compute: Compute = field(kw_only=True)  # computes a round

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results of many histories.

        Returns results: one array for each key of `fast_engine.RESULTS`; NaN of what a round does not keep;
        work: Empty: nobody counts the steps of all rounds.
        """
        if not count:
            return super().run(0, rows)
        given = rows(0, count)
        options: dict[str, Any] = {"law": self.law, "settings": self.settings, "engine": self.engine}
        asked = NumberedTable(self.motion_set, given.motion, given.values, given.stream, **options)
        found = self.compute(sampled(asked))
        # nobody asks for what a round does not keep, and views of one NaN need no room
        return {name: found.get(name, np.broadcast_to(np.nan, count)) for name in RESULTS}, {}


@dataclass(frozen=True)
class AskedQuestion(Question):
    """A question whose histories somebody else computes: the studies that take questions do not notice."""

    compute: Compute = field(kw_only=True)  # computes a round

    @classmethod
    def of(cls, question: Question, compute: Compute) -> "AskedQuestion":
        """Return a question, asked of somebody else.

        Returns the same body, motion, restitution and settings.
        """
        told = {name: getattr(question, name) for name in question.__dataclass_fields__}
        return cls(**told, compute=compute)

    @cached_property
    def batch(self) -> Batch:
        """The motion, and who computes."""
        return AskedBatch(
            [self.motion.segments()], self.law, self.settings, None, self.engine,
            motion_set=MotionList([self.motion]), compute=self.compute,
        )  # fmt: skip


class _FirstRoundError(Exception):
    """Stops a study at the first round that it asks for."""

    def __init__(self, histories: Histories) -> None:
        super().__init__("the first round is known")
        self.histories = histories


def first_round(search: Callable[[Compute], Any]) -> Histories:
    """Return the histories that a study asks for first; nothing is computed."""

    def stop(histories: Histories) -> Arrays:
        raise _FirstRoundError(histories)

    try:
        search(stop)
    except _FirstRoundError as found:
        return found.histories
    raise InvalidValueError("a study must ask for at least one round")
