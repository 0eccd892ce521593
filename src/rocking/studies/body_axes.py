"""Axes of the body: its size, slenderness and restitution."""

from dataclasses import replace

import numpy as np

from rocking.bodies import Block
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.errors import InvalidValueError
from rocking.studies.axis import BODY, RESTITUTION, Axis
from rocking.studies.case import Case
from rocking.studies.question import Question


class _BodyAxis(Axis):
    """A dimension of the body."""

    stage = BODY

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the dimension that the axis is named after."""
        return replace(case, geometry={**case.geometry, self.name: values})


class _BlockAxis(_BodyAxis):
    """A dimension that only a block has."""

    def _fits(self, question: Question) -> None:
        """Refuse a body that is no block."""
        if not isinstance(question.body, Block):
            raise InvalidValueError(f"{self.name} varies only for a Block, got {question.body!r:.60}")


class SemiDiagonal(_BodyAxis):
    """Size: the body with all its lengths scaled."""

    name, unit, words, sets = "semi_diagonal", "m", "semi-diagonal R; the body with all lengths scaled", "size"


class SlendernessAngle(_BlockAxis):
    """Slenderness angle of a block; the semi-diagonal stays unless the other axis is a dimension."""

    name, unit, words, sets = "slenderness_angle", "rad", "slenderness angle alpha of the block", "slenderness"
    high = 0.5 * np.pi


class SlendernessRatio(_BlockAxis):
    """Slenderness ratio h/b of a block; the semi-diagonal stays unless the other axis is a dimension."""

    name, unit, words, sets = "slenderness_ratio", "1", "slenderness ratio h/b of the block", "slenderness"

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the angle of the ratio."""
        return replace(case, geometry={**case.geometry, "slenderness_angle": np.arctan(1.0 / values)})


class Width(_BlockAxis):
    """Width of a block; the height stays unless the other axis changes it."""

    name, unit, words, sets = "width", "m", "width of the block", "width"


class Height(_BlockAxis):
    """Height of a block; the width stays unless the other axis changes it."""

    name, unit, words, sets = "height", "m", "height of the block", "height"


class RestitutionAxis(Axis):
    """A coefficient of restitution, the same for both sides."""

    name, unit, words = "restitution", "1", "coefficient of restitution, ratio of velocities"
    sets, stage, high, low_is_allowed = "restitution", RESTITUTION, 1.0, True

    def _fits(self, question: Question) -> None:
        """Refuse a law of impact, whose factors would multiply the axis."""
        if not isinstance(question.law, ConstantRestitution):
            raise InvalidValueError(
                f"restitution is an axis: leave the law of impact out, got {type(question.law).__name__}"
            )

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the coefficient; NaN, which the engine refuses, where it would create energy."""
        body = case.question.body
        inertia = [body.side(foot).moment_of_inertia for foot in FEET]
        most = np.sqrt(min(inertia) / max(inertia)) * (1.0 + 1e-9)  # Eq. 29
        allowed = np.where(values <= most, values, np.nan)
        return replace(case, sides={**case.sides, "r_right": allowed, "r_left": allowed})
