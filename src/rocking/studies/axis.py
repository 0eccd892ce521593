"""An axis of a map: a parameter of the body or the motion, its values, and how it changes a case."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.case import Case
from rocking.studies.question import Question

BODY, RESTITUTION, TIME, AMPLITUDE, VELOCITY = range(5)
"""Stages in which axes are applied, in this order."""


@dataclass(frozen=True, eq=False)
class Axis(ABC):
    """A parameter of a map and its values.

    Parameters
    ----------
    values : array_like
        Increasing, in the unit of the axis.

    Attributes
    ----------
    name, unit, words : str
        What it is called, its unit, and what it means.
    sets : str
        What it decides; two axes of a map cannot decide the same thing.
    stage : int
        When it is applied: bodies first, then restitution, time, amplitude, velocity.
    low, high : float
        Allowed range.
    low_is_allowed : bool
        Whether the low end itself is.

    Raises
    ------
    InvalidValueError
        If the values are not finite, not within the range of the axis, or do not increase.
    """

    values: FloatArray

    name: ClassVar[str]
    unit: ClassVar[str]
    words: ClassVar[str]
    sets: ClassVar[str]
    stage: ClassVar[int]
    low: ClassVar[float] = 0.0
    high: ClassVar[float] = 1e9
    low_is_allowed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Check the values."""
        values = np.atleast_1d(checks.real_array(self.name, self.values, self.unit)).copy()
        if values.ndim != 1 or not values.size:
            raise InvalidValueError(f"{self.name} must be a row of numbers, got shape {values.shape}")
        above = values >= self.low if self.low_is_allowed else values > self.low
        bad = np.flatnonzero(~(above & (values <= self.high)))
        if bad.size:
            bracket = "[" if self.low_is_allowed else "("
            raise InvalidValueError(
                f"{self.name} must be in {bracket}{self.low:g}, {self.high:g}] {self.unit}, "
                f"got {values[bad[0]]:g} at index {bad[0]}; wrong unit?"
            )
        if np.any(np.diff(values) <= 0.0):
            raise InvalidValueError(f"{self.name} must increase from value to value")
        values.setflags(write=False)
        object.__setattr__(self, "values", values)

    @abstractmethod
    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return a case with this parameter changed."""

    def _fits(self, question: Question) -> None:
        """Refuse a question that has no such parameter."""
        if self.stage == TIME:
            question.check_stretching(self.name)

    def applied(self, case: Case, values: FloatArray) -> Case:
        """Return a case with this parameter changed.

        Parameters
        ----------
        case : Case
            The variations.
        values : ndarray
            The parameter of each.

        Returns
        -------
        Case
            The changed variations.
        """
        return self._changed(case, values)

    def check(self, question: Question) -> None:
        """Refuse a question that has no such parameter.

        Parameters
        ----------
        question : Question
            What is to be varied.

        Raises
        ------
        InvalidValueError
            If the body, the motion or the restitution does not have it.
        """
        self._fits(question)

    def check_beside(self, other: "Axis") -> None:  # noqa: B027 - most axes fit any other
        """Refuse another axis whose values this one cannot go with.

        Parameters
        ----------
        other : Axis
            The other axis of the plane.

        Raises
        ------
        InvalidValueError
            If there is such a value.
        """

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and meaning, for a coordinate of a dataset."""
        return {"units": self.unit, "long_name": self.words}
