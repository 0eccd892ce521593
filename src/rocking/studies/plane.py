"""The plane of two axes: what happens at any of its points."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.engine import Arrays
from rocking.dynamics.histories import settings_of
from rocking.errors import InvalidValueError
from rocking.studies.axes import axis_of
from rocking.studies.axis import Axis
from rocking.studies.case import Case
from rocking.studies.question import Question


@dataclass(frozen=True)
class Plane:
    """A question and two axes along which it varies.

    Parameters
    ----------
    question : Question
        Body, motion, restitution and settings.
    x, y : Axis
        The axes.

    Raises
    ------
    InvalidValueError
        If both axes decide the same thing, or one does not fit the body or the motion.
    """

    question: Question
    x: Axis
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

        Parameters
        ----------
        body : Body
            The body.
        motion : GroundMotion or Pulse
            The motion.
        x, y : Axis or (str, array_like)
            The axes.
        restitution : Any
            As for `simulate`.
        **options
            gravity [m/s2], threads, engine and fields of `Settings`.

        Returns
        -------
        Plane
            The plane.
        """
        threads, engine = options.pop("threads", None), options.pop("engine", "auto")
        settings = settings_of(options.pop("gravity"), options)
        return cls(Question(body, motion, restitution, settings, threads, engine), axis_of(x), axis_of(y))

    def case(self, x: FloatArray, y: FloatArray) -> Case:
        """Return the variations at some points.

        Parameters
        ----------
        x, y : ndarray
            Coordinates, in the units of the axes.

        Returns
        -------
        Case
            Bodies first, then restitution, time, amplitude and velocity.
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
        """Return what happens at some points.

        Parameters
        ----------
        x, y : ndarray
            Coordinates, in the units of the axes.
        key : array_like of int, optional
            Numbers of the histories for random coefficients; 0, 1, ... if not given.
        progress : callable, optional
            Called with the number of histories done since the last call.

        Returns
        -------
        results : dict of str to ndarray
            As of `Question.run`.
        work : dict of str to int
            Counts of the engine.
        """
        case = self.case(x, y)
        return self.question.run(case.values, case.stretch, key, progress)

    def mesh(self) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of all pairs of values, those of x varying fastest.

        Returns
        -------
        x, y : ndarray
            One entry a pair, in the units of the axes.
        """
        x, y = np.meshgrid(self.x.values, self.y.values)
        return x.ravel(), y.ravel()
