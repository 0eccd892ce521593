"""Bodies of a study whose size or slenderness varies."""

import math
from collections.abc import Mapping

from rocking.bodies import Block, Body
from rocking.errors import InvalidValueError


def reference_side(body: Body) -> str:
    """Return the side that the ground lifts the body about first: the less stocky one, the right one if equal.

    Returns the side that axes refer to when they speak of size and slenderness.
    """
    return "left" if body.side("left").slenderness_angle < body.side("right").slenderness_angle else "right"


def changed_body(body: Body, parameters: Mapping[str, float]) -> Body:
    """Return a body with other dimensions.

    parameters: semi_diagonal [m] scales any body with all its lengths; slenderness_angle [rad], width and height [m]
    are for a block. A slenderness alone keeps the semi-diagonal, a width alone the height, a height alone the width.
    Returns the changed body; the same if there is nothing to change.

    >>> made = changed_body(Block(width=1.0, height=4.0), {"height": 3.0})
    >>> made.width, made.height
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


def _dimensions(block: Block, given: Mapping[str, float]) -> tuple[float, float]:
    alpha, diagonal = given.get("slenderness_angle"), given.get("semi_diagonal")
    width, height = given.get("width"), given.get("height")
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
        return (width, other) if width is not None else (other, given["height"])
    return (block.width if width is None else width), (block.height if height is None else height)


def _leg(diagonal: float, known: float) -> float:
    square = 4.0 * diagonal**2 - known**2
    if square <= 0.0:
        raise InvalidValueError(f"no block of semi-diagonal {diagonal:g} m has a side of {known:g} m")
    return math.sqrt(square)
