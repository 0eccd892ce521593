"""Variations of one question, as arrays: which bodies, what scale, how stretched in time; the axes of a map fill it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from rocking.bodies import Block, Body
from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.errors import InvalidValueError
from rocking.studies.question import Question


@dataclass(frozen=True)
class Case:
    """Variations of a question, one entry each; every axis returns it with something changed."""

    question: Question  # what is varied
    count: int  # how many variations
    scale: FloatArray  # factor on the motion [-]
    stretch: FloatArray  # factor on its time [-]
    # dimensions that vary, by the names of `changed_body` [m, rad]
    geometry: Mapping[str, FloatArray] = field(default_factory=dict)
    # alpha, p and r, right and left, once the bodies are known [rad, rad/s, -]
    sides: Mapping[str, FloatArray] = field(default_factory=dict)
    amplitude_is_set: bool = False  # whether an axis has set the amplitude, so that the velocity must set the time

    @classmethod
    def of(cls, question: Question, count: int) -> "Case":
        """Return variations that do not vary yet."""
        return cls(question, count, np.ones(count), np.ones(count))

    def settled(self) -> "Case":
        """Return the case with its bodies made and the restitution evaluated for each; NaN where there is none."""
        names = sorted(self.geometry)
        if not names:
            rows, places = np.empty((1, 0)), np.zeros(self.count, dtype=np.int64)
        else:
            rows, places = np.unique(np.stack([self.geometry[n] for n in names], axis=-1), axis=0, return_inverse=True)
        table = sides_of(self._parameters([dict(zip(names, row.tolist(), strict=True)) for row in rows]))
        return replace(self, sides={name: values[places.ravel()] for name, values in table.items()})

    def _parameters(self, dimensions: list[dict[str, float]]) -> list[RockingParameters | None]:
        parameters: list[RockingParameters | None] = []
        refused: InvalidValueError | None = None
        for each in dimensions:
            try:
                parameters.append(self.question.parameters_of(changed_body(self.question.body, each)))
            except InvalidValueError as error:
                parameters.append(None)
                refused = error
        if refused is not None and not any(parameters):
            raise refused
        return parameters

    @property
    def slenderness_angle(self) -> FloatArray:
        """Slenderness angle of the side that lifts first [rad]."""
        return np.fmin(self.sides["alpha_right"], self.sides["alpha_left"])

    @property
    def frequency_parameter(self) -> FloatArray:
        """Frequency parameter p of the side that lifts first [rad/s]."""
        left = self.sides["alpha_left"] < self.sides["alpha_right"]
        return np.where(left, self.sides["p_left"], self.sides["p_right"])

    @property
    def uplift_acceleration(self) -> FloatArray:
        """Ground acceleration that lifts the body: g tan alpha, or g alpha in the linear equations [m/s2]."""
        settings = self.question.settings
        alpha = self.slenderness_angle
        return settings.gravity * (alpha if settings.linear else np.tan(alpha))  # Eq. 25

    @property
    def values(self) -> dict[str, FloatArray]:
        """What the engine is told of each variation."""
        return {**self.sides, "scale": self.scale}


def reference_side(body: Body) -> str:
    """Return the side that the ground lifts the body about first: the less stocky one, the right one if equal."""
    return "left" if body.side("left").slenderness_angle < body.side("right").slenderness_angle else "right"


def changed_body(body: Body, parameters: Mapping[str, float]) -> Body:
    """Return a body with other dimensions.

    semi_diagonal [m] scales any body with all its lengths; slenderness_angle [rad], width and height [m] are for a
    block. A slenderness alone keeps the semi-diagonal, a width alone the height, a height alone the width.

    >>> changed = changed_body(Block(width=1.0, height=4.0), {"height": 3.0})
    >>> changed.width, changed.height
    (1.0, 3.0)
    """
    if not parameters:
        return body
    if set(parameters) == {"semi_diagonal"}:
        side = body.side(reference_side(body))  # type: ignore[arg-type]
        return body.scaled(size=parameters["semi_diagonal"] / side.semi_diagonal)
    if not isinstance(body, Block):
        raise InvalidValueError(f"slenderness, width and height vary only for a Block, got {body!r:.60}")
    width, height = _dimensions(body, parameters)
    return Block(width=width, height=height, depth=body.depth, density=body.density)


def _dimensions(block: Block, dimensions: Mapping[str, float]) -> tuple[float, float]:
    alpha, diagonal = dimensions.get("slenderness_angle"), dimensions.get("semi_diagonal")
    width, height = dimensions.get("width"), dimensions.get("height")
    if alpha is not None:
        if height is not None:
            return height * math.tan(alpha), height
        if width is not None:
            return width, width / math.tan(alpha)
        size = 2.0 * (block.semi_diagonal if diagonal is None else diagonal)
        return size * math.sin(alpha), size * math.cos(alpha)
    if diagonal is not None:
        known = width if height is None else height
        other = _leg(diagonal, 0.0 if known is None else known)
        return (width, other) if width is not None else (other, dimensions["height"])
    return (block.width if width is None else width), (block.height if height is None else height)


def _leg(diagonal: float, known: float) -> float:
    square = 4.0 * diagonal**2 - known**2
    if square <= 0.0:
        raise InvalidValueError(f"no block of semi-diagonal {diagonal:g} m has a side of {known:g} m")
    return math.sqrt(square)
