"""The plane of two axes: what happens at any of its points."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.settings import settings_of
from rocking.errors import InvalidValueError
from rocking.studies._axes import axis_of
from rocking.studies.axis import Axis
from rocking.studies.case import Case
from rocking.studies.question import Question


@dataclass(frozen=True)
class Plane:
    """A question and two axes along which it varies."""

    question: Question  # body, motion, restitution and settings
    x: Axis  # x, y: the axes
    y: Axis

    def __post_init__(self) -> None:
        """Check that the axes fit the question and each other."""
        if self.x.sets == self.y.sets:
            raise InvalidValueError(
                f"x and y must set different things, got {self.x.name} and {self.y.name}: both set {self.x.sets}"
            )
        for axis, other in ((self.x, self.y), (self.y, self.x)):
            axis.check(self.question)
            axis.check_beside(other)

    @classmethod
    def of(cls, body: Any, motion: Any, x: Any, y: Any, restitution: Any, **options: Any) -> "Plane":
        """Return a plane from what a user gives.

        **options: gravity [m/s2], threads, engine and fields of `Settings`.
        """
        threads, engine = options.pop("threads", None), options.pop("engine", "auto")
        settings = settings_of(options.pop("gravity"), options)
        return cls(Question(body, motion, restitution, settings, threads, engine), axis_of(x), axis_of(y))

    def case(self, x: FloatArray, y: FloatArray) -> Case:
        """Return the variations at some points.

        Returns bodies first, then restitution, time, amplitude and velocity.
        """
        case = Case.of(self.question, x.size)
        steps = sorted([(self.x, x), (self.y, y)], key=lambda step: step[0].stage)
        for axis, values in steps:
            if axis.stage == 0:
                case = axis.applied(case, values)
        case = case.settled()
        for axis, values in steps:
            if axis.stage > 0:
                case = axis.applied(case, values)
        return case

    def answers(
        self, x: FloatArray, y: FloatArray, key: Any = None, progress: Callable[[int], None] | None = None
    ) -> tuple[Arrays, dict[str, int]]:
        """Return what happens at some points."""
        case = self.case(x, y)
        return self.question.run(case.values, case.stretch, key, progress)

    def mesh(self) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of all pairs of values, those of x varying fastest.

        Returns one entry a pair, in the units of the axes.
        """
        x, y = np.meshgrid(self.x.values, self.y.values)
        return x.ravel(), y.ravel()
