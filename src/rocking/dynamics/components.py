"""Ground motion along x, y and z, as users say it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking.bodies import Body
from rocking.errors import InvalidValueError
from rocking.motions.components import with_vertical
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse

Component = GroundMotion | Pulse | None
Components = tuple[Component, Component, Component]

_HOW = 'a GroundMotion, a pulse, or {"x": ..., "y": ..., "z": ...} of these'


def components_of(motion: Any) -> Components:
    """Return the components of a motion, of a mapping from x, y and z, or of a tuple in that order.

    The vertical part of a record along x is its z.

    >>> [part is None for part in components_of({"z": GroundMotion([0.0, 1.0], 0.1)})]
    [True, True, False]
    """
    if isinstance(motion, Mapping):
        unknown = [name for name in motion if name not in ("x", "y", "z")]
        if unknown:
            raise InvalidValueError(f"a component of the motion is x, y or z, got {unknown[0]!r:.60}")
        motion = tuple(motion.get(name) for name in "xyz")
    parts = motion if isinstance(motion, (tuple, list)) else (motion,)
    if len(parts) > 3:
        raise InvalidValueError(f"a motion has at most three components, x, y and z, got {len(parts)}")
    for part in parts:
        if not isinstance(part, (GroundMotion, Pulse)) and part is not None:
            raise InvalidValueError(f"motion must be {_HOW}, got {part!r:.60}")
    if all(part is None for part in parts):
        raise InvalidValueError(f"motion must be {_HOW}, got none; free_rocking lets a body go on ground at rest")
    x, y, z = (*parts, None, None)[:3]
    if isinstance(x, GroundMotion) and x.vertical is not None:
        if z is not None:
            raise InvalidValueError("the vertical motion is given twice: by the vertical part of x, and by z")
        z = x.changed("its vertical part", acceleration=x.vertical, vertical=None)
        x = x.changed("its horizontal part", vertical=None)
    return x, y, z


def in_space(body: Any) -> bool:
    """Return whether a body is one in space: it has a base to stand on, not two feet."""
    return not isinstance(body, (Body, np.ndarray)) and hasattr(body, "base")


def in_plane(motion: Any) -> GroundMotion | Pulse:
    """Return the motion of a plane body: along x, and z as its vertical part."""
    if isinstance(motion, (GroundMotion, Pulse)):
        return motion
    x, y, z = components_of(motion)
    if y is not None:
        raise InvalidValueError("a plane body moves along x and z, got y too; Solid.from_section makes it a solid")
    if z is None and x is not None:
        return x
    if not isinstance(z, GroundMotion) or isinstance(x, Pulse):
        raise InvalidValueError("vertical motion of a plane body is a record beside another: two GroundMotion, please")
    return with_vertical(z.scaled(0.0) if x is None else x, z)
