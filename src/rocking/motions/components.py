"""Components of one motion: joining, rotation, and largest values over all directions."""

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
"""A motion along x, components by direction, or components in the order x, y, z."""


@dataclass(frozen=True, eq=False)
class Components:
    """Motions along x, y and z, which are scaled and stretched together. The leading component gives the measures.

    >>> both = Components(GroundMotion([0.0, 1.0], 0.1, name="a"), GroundMotion([0.0, -2.0], 0.1, name="b"), None)
    >>> both.name, both.peak
    ('a, b, none', 2.0)
    """

    x: Any  # GroundMotion, Pulse or None
    y: Any
    z: Any

    def __post_init__(self) -> None:
        """Raise an error for a vertical component along x or y."""
        checked_level(self.x)
        checked_level(self.y)

    @property
    def parts(self) -> tuple[Any, Any, Any]:
        """Components along x, y and z; None if absent."""
        return self.x, self.y, self.z

    @property
    def leading(self) -> Any:
        """The horizontal component with the largest peak. Without horizontal components, the vertical component."""
        return max(
            (component for component in (self.x, self.y) if component is not None),
            key=lambda component: component.peak,
            default=self.z,
        )

    @property
    def name(self) -> str:
        return ", ".join("none" if component is None else component.name for component in self.parts)

    @property
    def peak(self) -> float:
        """Peak acceleration of the leading component [m/s2]."""
        return float(self.leading.peak)

    @property
    def duration(self) -> float:
        """Duration of the longest component [s]."""
        return float(max(component.duration for component in self.parts if component is not None))

    @property
    def metadata(self) -> Any:
        """Metadata of the leading component."""
        return getattr(self.leading, "metadata", {})

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about the components."""
        return tuple(doubt for component in self.parts if component is not None for doubt in component.doubts)

    def each(self, change: Callable[[Any], Any]) -> "Components":
        """Apply a function to all components."""
        return Components(*(None if component is None else change(component) for component in self.parts))

    def segments(self) -> "Components":
        """Return the components unchanged, because the 3D engine computes their segments together."""
        return self


def leading(motion: Any) -> Any:
    """Return the motion for axes and measures: the motion itself, or the leading component."""
    return motion.leading if isinstance(motion, Components) else motion


_ALLOWED = 'a GroundMotion, a pulse, or {"x": ..., "y": ..., "z": ...} of these'


def components_of(motion: Any) -> tuple[Component, Component, Component]:
    """Return the components of a motion, of a mapping with x, y and z, or of a tuple in this order.

    The vertical part of a record along x becomes the component z.

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
    components = motion if isinstance(motion, (tuple, list)) else (motion,)
    if len(components) > 3:
        raise InvalidValueError("a motion has at most three components, x, y and z, got {count}", count=len(components))
    for component in components:
        checks.of_kind("motion", component, (GroundMotion, Pulse, type(None)), _ALLOWED)
    if all(component is None for component in components):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got none", parameter="motion", allowed=_ALLOWED,
            hint="use free_rocking for ground at rest",
        )  # fmt: skip
    x, y, z = (*components, None, None)[:3]
    if isinstance(x, GroundMotion) and x.vertical is not None:
        if z is not None:
            raise InvalidValueError("the vertical motion appears twice: in x and as z; remove one")
        z = x.changed("its vertical part", acceleration=x.vertical, vertical=None)
        x = x.changed("its horizontal part", vertical=None)
    return checked_level(x), checked_level(y), z


def together(motion: Any, *, plane: bool = False) -> Any:
    """Return a motion unchanged and several components as `Components`. With `plane`, see `in_plane`."""
    if not isinstance(motion, (Mapping, tuple, Components)):
        return checked_level(motion)
    if plane:
        return in_plane(motion)
    return motion if isinstance(motion, Components) else Components(*components_of(motion))


def in_plane(motion: Any) -> GroundMotion | Pulse:
    """Return the motion for a plane body: component x, with component z as its vertical part."""
    if isinstance(motion, (GroundMotion, Pulse)):
        return checked_level(motion)  # type: ignore[no-any-return]
    x, y, z = components_of(motion)
    if y is not None:
        raise InvalidValueError("a plane body moves along x and z only, got y; use Solid.from_section for a 3D body")
    if z is None and x is not None:
        return x
    if not isinstance(z, GroundMotion) or isinstance(x, Pulse):
        raise InvalidValueError("vertical motion of a plane body requires records (GroundMotion) along x and z")
    if x is None:
        x = z.changed("no horizontal motion", acceleration=0.0 * z.acceleration, metadata={})
    return with_vertical(x, z)


ANGLES = np.radians(np.arange(180.0))  # directions for RotD [rad], every degree from 0 to 179


def with_vertical(horizontal: GroundMotion, vertical: GroundMotion) -> GroundMotion:
    """Return a motion with the samples of another motion as its vertical part.

    Both start at the same instant.

    Parameters
    ----------
    horizontal : GroundMotion
        Horizontal motion; the result has its name, metadata and time step.
    vertical : GroundMotion
        Vertical motion, positive upwards, with the same time step.

    Returns
    -------
    GroundMotion
        Motion with both parts, cut to the shorter motion. The provenance contains the cut.

    Raises
    ------
    InvalidValueError
        If a motion is not a `GroundMotion` or already has a vertical part, or if the time steps differ.

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
            "{parameter} must have the time step of horizontal, {expected:g} s, got {step:g} s", parameter="vertical",
            expected=horizontal.time_step, step=vertical.time_step, hint="resample one motion first",
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
        {**horizontal.metadata, **_vertical_metadata(horizontal, vertical)},
        tuple(provenance),
    )


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> tuple[GroundMotion, GroundMotion]:
    """Return two perpendicular components along rotated axes.

    Parameters
    ----------
    first, second : GroundMotion
        Horizontal components along x and y, with equal time step and length.
    angle : float
        Rotation angle, from x towards y [rad].

    Returns
    -------
    tuple of GroundMotion
        Components along the rotated x and y. A vertical part of a component is kept.

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
    action = f"turned by {angle:g} rad together with "
    return (
        first.changed(action + repr(second.name), acceleration=c * a + s * b),  # Eq. 156
        second.changed(action + repr(first.name), acceleration=c * b - s * a),
    )


def rotd_pga(first: GroundMotion, second: GroundMotion, percentile: float) -> float:
    """Return a percentile of the peak ground acceleration over all directions.

    Boore (2010), DOI 10.1785/0120090400. The directions are at every degree from 0 to 179 degrees. RotD100 is
    exact, over all directions.

    Parameters
    ----------
    first, second : GroundMotion
        Perpendicular horizontal components, with equal time step and length.
    percentile : float
        50 for RotD50, 100 for RotD100, 0 for RotD00 [%].

    Returns
    -------
    float
        Percentile of the peaks [m/s2].

    Examples
    --------
    >>> rotd_pga(GroundMotion([0.0, 3.0], 0.1), GroundMotion([0.0, 4.0], 0.1), 100)
    5.0
    """
    matching(first, second)
    percentile = checks.within("percentile", percentile, 0.0, 100.0, unit="%")
    a, b = first.acceleration, second.acceleration
    if percentile == 100.0:
        # between samples, the vector moves on a straight line, so that the maximum is at a sample
        return float(np.hypot(a, b).max())
    peaks = np.array([np.abs(math.cos(t) * a + math.sin(t) * b).max() for t in ANGLES])  # Eq. 156
    return float(np.percentile(peaks, percentile))


def _check(name: str, motion: object) -> None:
    if checked_motion(motion, name).vertical is not None:
        raise InvalidValueError(
            "{parameter} must have no vertical part, got {value}", parameter=name, value=motion,
            hint="remove one of the vertical parts",
        )  # fmt: skip


def _vertical_metadata(horizontal: GroundMotion, vertical: GroundMotion) -> dict[str, str]:
    name = vertical.metadata.get("component", "vertical")
    if name.casefold() == horizontal.metadata.get("component", "horizontal").casefold():
        # two components of one file need different names
        name += " (vertical)"
    values = {key: vertical.metadata[key] for key in ("header", "channel") if key in vertical.metadata}
    return {"vertical component": name} | {f"vertical {key}": text for key, text in values.items()}


def matching(first: GroundMotion, second: GroundMotion) -> None:
    """Raise an error unless both components are records with equal time step and length."""
    checked_motion(first, "first")
    checked_motion(second, "second")
    if len(first) != len(second) or not math.isclose(first.time_step, second.time_step, rel_tol=1e-9):
        raise InvalidValueError(
            "{parameter} must have the time step and the length of first, {first_step:g} s and {first_count} samples, "
            "got {step:g} s and {count}", parameter="second", first_step=first.time_step, first_count=len(first),
            step=second.time_step, count=len(second),
        )  # fmt: skip
