"""Components of one motion: joined, turned into other directions, and the largest over all of them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion, checked_level, checked_motion
from rocking.motions.pulse import Motion, Pulse

Component = GroundMotion | Pulse | None
AnyMotion = Motion | Mapping[str, Motion] | tuple[Component, ...]
"""A motion along x, or components by direction, or in the order x, y, z."""


@dataclass(frozen=True, eq=False)
class Components:
    """Motions along x, y and z that a study takes as one: scaled and stretched together, and measured by the leading.

    >>> both = Components(GroundMotion([0.0, 1.0], 0.1, name="a"), GroundMotion([0.0, -2.0], 0.1, name="b"), None)
    >>> both.name, both.peak
    ('a, b, none', 2.0)
    """

    x: Any  # GroundMotion, Pulse or None
    y: Any
    z: Any

    def __post_init__(self) -> None:
        """Refuse a vertical component along x or y."""
        checked_level(self.x)
        checked_level(self.y)

    @property
    def parts(self) -> tuple[Any, Any, Any]:
        """All three."""
        return self.x, self.y, self.z

    @property
    def leading(self) -> Any:
        """The horizontal component with the largest peak; the vertical one where it is alone."""
        return max((part for part in (self.x, self.y) if part is not None), key=lambda part: part.peak, default=self.z)

    @property
    def name(self) -> str:
        return ", ".join("none" if part is None else part.name for part in self.parts)

    @property
    def peak(self) -> float:
        """Peak acceleration of the leading component [m/s2]."""
        return float(self.leading.peak)

    @property
    def duration(self) -> float:
        """Duration of the longest component [s]."""
        return float(max(part.duration for part in self.parts if part is not None))

    @property
    def metadata(self) -> Any:
        """What is known of the leading component."""
        return getattr(self.leading, "metadata", {})

    @property
    def doubts(self) -> tuple[str, ...]:
        """Doubts about any of them."""
        return tuple(doubt for part in self.parts if part is not None for doubt in part.doubts)

    def each(self, change: Callable[[Any], Any]) -> "Components":
        """Return components, each of which was changed."""
        return Components(*(None if part is None else change(part) for part in self.parts))

    def segments(self) -> "Components":
        """Return itself: the engine of bodies in space lays out its components together."""
        return self


def leading(motion: Any) -> Any:
    """Return the motion that axes and measures speak of: itself, or the leading one of several components."""
    return motion.leading if isinstance(motion, Components) else motion


_HOW = 'a GroundMotion, a pulse, or {"x": ..., "y": ..., "z": ...} of these'


def components_of(motion: Any) -> tuple[Component, Component, Component]:
    """Return the components of a motion, of a mapping from x, y and z, or of a tuple in that order.

    The vertical part of a record along x is its z.

    >>> [part is None for part in components_of({"z": GroundMotion([0.0, 1.0], 0.1)})]
    [True, True, False]
    """
    if isinstance(motion, Components):
        motion = motion.parts
    if isinstance(motion, Mapping):
        unknown = [name for name in motion if name not in ("x", "y", "z")]
        if unknown:
            raise InvalidValueError(
                "a component of the {parameter} is x, y or z, got {value}", parameter="motion", value=unknown[0]
            )
        motion = tuple(motion.get(name) for name in "xyz")
    parts = motion if isinstance(motion, (tuple, list)) else (motion,)
    if len(parts) > 3:
        raise InvalidValueError("a motion has at most three components, x, y and z, got {count}", count=len(parts))
    for part in parts:
        checks.of_kind("motion", part, (GroundMotion, Pulse, type(None)), _HOW)
    if all(part is None for part in parts):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got none", parameter="motion", allowed=_HOW,
            hint="free_rocking lets a body go on ground at rest",
        )  # fmt: skip
    x, y, z = (*parts, None, None)[:3]
    if isinstance(x, GroundMotion) and x.vertical is not None:
        if z is not None:
            raise InvalidValueError("the vertical motion is given twice: by the vertical part of x, and by z")
        z = x.changed("its vertical part", acceleration=x.vertical, vertical=None)
        x = x.changed("its horizontal part", vertical=None)
    return checked_level(x), checked_level(y), z


def together(motion: Any, *, plane: bool = False) -> Any:
    """Return a motion of one component as it is, of several as one of a study: in a plane along x, with its z."""
    if not isinstance(motion, (Mapping, tuple, Components)):
        return checked_level(motion)
    if plane:
        return in_plane(motion)
    return motion if isinstance(motion, Components) else Components(*components_of(motion))


def in_plane(motion: Any) -> GroundMotion | Pulse:
    """Return the motion of a plane body: along x, and z as its vertical part."""
    if isinstance(motion, (GroundMotion, Pulse)):
        return checked_level(motion)  # type: ignore[no-any-return]
    x, y, z = components_of(motion)
    if y is not None:
        raise InvalidValueError("a plane body moves along x and z, got y too; Solid.from_section makes it a solid")
    if z is None and x is not None:
        return x
    if not isinstance(z, GroundMotion) or isinstance(x, Pulse):
        raise InvalidValueError("vertical motion of a plane body is a record beside another: two GroundMotion, please")
    if x is None:
        x = z.changed("no horizontal motion", acceleration=0.0 * z.acceleration, metadata={})
    return with_vertical(x, z)


ANGLES = np.radians(np.arange(180.0))  # directions for RotD: every degree over half a turn


def with_vertical(horizontal: GroundMotion, vertical: GroundMotion) -> GroundMotion:
    """Return a motion with the samples of another one as its vertical part.

    Both are taken to start at the same instant.

    Parameters
    ----------
    horizontal : GroundMotion
        Horizontal motion; its name, metadata and step are kept.
    vertical : GroundMotion
        Motion whose acceleration is the vertical one, positive upwards, of the same step.

    Returns
    -------
    GroundMotion
        Both; if one is longer, both are cut to the shorter, which its provenance says.

    Raises
    ------
    InvalidValueError
        If one of them is no `GroundMotion` or has a vertical part already, or their steps differ.

    Examples
    --------
    >>> along, up = GroundMotion([0.0, 1.0, 2.0], 0.1), GroundMotion([0.0, 0.5], 0.1)
    >>> both = with_vertical(along, up)
    >>> both.acceleration.tolist(), both.vertical.tolist()
    ([0.0, 1.0], [0.0, 0.5])
    """
    _check("horizontal", checked_level(horizontal))
    _check("vertical", vertical)
    if not math.isclose(horizontal.time_step, vertical.time_step, rel_tol=1e-9):
        raise InvalidValueError(
            "{parameter} must have the step of horizontal, {expected:g} s, got {step:g} s", parameter="vertical",
            expected=horizontal.time_step, step=vertical.time_step, hint="resample one first",
        )  # fmt: skip
    sources = vertical.provenance or (f"samples of {vertical.name!r}",)
    provenance = [*horizontal.provenance, *(f"vertical part: {line}" for line in sources)]
    samples = min(len(horizontal), len(vertical))
    if len(horizontal) != len(vertical):
        provenance.append(f"components of {len(horizontal)} and {len(vertical)} samples, both cut to {samples}")
    return GroundMotion(
        horizontal.acceleration[:samples],
        horizontal.time_step,
        vertical.acceleration[:samples],
        horizontal.name,
        {**horizontal.metadata, **_told(horizontal, vertical)},
        tuple(provenance),
    )


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> tuple[GroundMotion, GroundMotion]:
    """Return two perpendicular components along turned axes.

    Parameters
    ----------
    first, second : GroundMotion
        Horizontal components along x and y, of one step and length.
    angle : float
        Angle of the turn, from x towards y [rad].

    Returns
    -------
    tuple of GroundMotion
        Components along the turned x and y; each keeps the vertical part of the motion that it replaces.

    Examples
    --------
    >>> x, y = rotated(GroundMotion([0.0, 1.0], 0.1), GroundMotion([0.0, 0.0], 0.1), math.pi / 2)
    >>> x.peak < 1e-15, y.acceleration.tolist()
    (True, [0.0, -1.0])
    """
    matching(first, second)
    angle = checks.number("angle", angle, "rad")
    c, s = math.cos(angle), math.sin(angle)
    a, b = first.acceleration, second.acceleration
    what = f"turned by {angle:g} rad together with "
    return (
        first.changed(what + repr(second.name), acceleration=c * a + s * b),  # Eq. 156
        second.changed(what + repr(first.name), acceleration=c * b - s * a),
    )


def rotd_pga(first: GroundMotion, second: GroundMotion, percentile: float) -> float:
    """Return a percentile over all directions of the peak ground acceleration.

    Boore (2010), DOI 10.1785/0120090400. The directions are every degree over half a turn; RotD100 is exact, over
    all directions.

    Parameters
    ----------
    first, second : GroundMotion
        Perpendicular horizontal components, of one step and length.
    percentile : float
        50 for RotD50, 100 for RotD100, 0 for RotD00 [%].

    Returns
    -------
    float
        The percentile of the peaks [m/s2].

    Examples
    --------
    >>> rotd_pga(GroundMotion([0.0, 3.0], 0.1), GroundMotion([0.0, 4.0], 0.1), 100)
    5.0
    """
    matching(first, second)
    percentile = checks.within("percentile", percentile, 0.0, 100.0, unit="%")
    a, b = first.acceleration, second.acceleration
    if percentile == 100.0:
        # between samples the point moves on a straight line, so that it is farthest at a sample
        return float(np.hypot(a, b).max())
    peaks = np.array([np.abs(math.cos(t) * a + math.sin(t) * b).max() for t in ANGLES])  # Eq. 156
    return float(np.percentile(peaks, percentile))


def _check(which: str, motion: object) -> None:
    if checked_motion(motion, which).vertical is not None:
        raise InvalidValueError(
            "{parameter} must have no vertical part yet, got {value}", parameter=which, value=motion,
            hint="which one is meant?",
        )  # fmt: skip


def _told(horizontal: GroundMotion, vertical: GroundMotion) -> dict[str, str]:
    name = vertical.metadata.get("component", "vertical")
    if name.casefold() == horizontal.metadata.get("component", "horizontal").casefold():
        # files that do not name their component: two of one name could not be written to one file
        name += " (vertical)"
    told = {key: vertical.metadata[key] for key in ("header", "channel") if key in vertical.metadata}
    return {"vertical component": name} | {f"vertical {key}": text for key, text in told.items()}


def matching(first: GroundMotion, second: GroundMotion) -> None:
    """Refuse components that are no records of one step and length."""
    checked_motion(first, "first")
    checked_motion(second, "second")
    if len(first) != len(second) or not math.isclose(first.time_step, second.time_step, rel_tol=1e-9):
        raise InvalidValueError(
            "{parameter} must have the step and the length of first, {first_step:g} s and {first_count} samples, got "
            "{step:g} s and {count}", parameter="second", first_step=first.time_step, first_count=len(first),
            step=second.time_step, count=len(second),
        )  # fmt: skip
