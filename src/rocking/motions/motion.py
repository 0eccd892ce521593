"""A ground motion: accelerations at equal time steps, with straight lines between them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.messages import Range
from rocking.motions.segments import Segments

LARGEST_ACCELERATION = 1e6  # [m/s2]; larger samples result from a wrong unit or a damaged file
SHORTEST_STEP, LONGEST_STEP = 1e-9, 1e3  # allowed range of the time step [s]


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """Horizontal and optional vertical acceleration of the ground.

    The first sample is at time zero. The acceleration is linear between samples, and zero before the first sample and
    after the last sample.

    Parameters
    ----------
    acceleration : array_like
        Horizontal acceleration, positive to the right [m/s2].
    time_step : float
        Time step between samples [s].
    vertical : array_like, optional
        Vertical acceleration, positive upwards, of the same length [m/s2].
    name : str
        Name for titles and tables.
    metadata : mapping of str to str
        Facts from the file or the generator.
    provenance : tuple of str
        Source and processing steps, one sentence each.

    Raises
    ------
    InvalidValueError
        If a sample is not finite or exceeds 1e6 m/s2; if there are fewer than two samples; if the time step is not
        above zero; if the vertical part has another length; or if name, metadata or provenance have a wrong type.

    Examples
    --------
    >>> motion = GroundMotion([0.0, 1.0, -2.0, 0.0], time_step=0.1)
    >>> motion.peak, round(motion.duration, 12)
    (2.0, 0.3)
    """

    acceleration: FloatArray
    time_step: float
    vertical: FloatArray | None = None
    name: str = "ground motion"
    metadata: Mapping[str, str] = field(default_factory=dict)
    provenance: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        step = checks.within("time_step", self.time_step, SHORTEST_STEP, LONGEST_STEP, unit="s", hint="in seconds")
        object.__setattr__(self, "time_step", step)
        object.__setattr__(self, "acceleration", _samples("acceleration", self.acceleration))
        if self.vertical is not None:
            vertical = _samples("vertical", self.vertical)
            if vertical.size != self.acceleration.size:
                raise InvalidValueError(
                    "{parameter} must have as many samples as acceleration, {expected}, got {count}",
                    parameter="vertical", expected=self.acceleration.size, count=vertical.size,
                )  # fmt: skip
            object.__setattr__(self, "vertical", vertical)
        checks.of_kind("name", self.name, str, "a string")
        object.__setattr__(self, "metadata", _metadata(self.metadata))
        object.__setattr__(self, "provenance", _provenance(self.provenance))
        plausibility.warn_of_values(self.doubts)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about implausible accelerations or time steps."""
        return plausibility.of_acceleration(max(self.peak, self.peak_vertical)) + plausibility.of_time_step(
            self.time_step
        )

    def __len__(self) -> int:
        return int(self.acceleration.size)

    def __repr__(self) -> str:
        both = "" if self.vertical is None else ", with vertical"
        size = f"{len(self)} samples at {self.time_step:g} s, peak {self.peak:.4g} m/s2"
        return f"<GroundMotion {self.name!r}: {size}{both}>"

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for pickle, without the mapping proxy of the metadata."""
        return {**self.__dict__, "metadata": dict(self.metadata)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore the state, with read-only metadata."""
        self.__dict__.update(state)
        object.__setattr__(self, "metadata", MappingProxyType(state["metadata"]))
        self.acceleration.setflags(write=False)
        if self.vertical is not None:
            self.vertical.setflags(write=False)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (len(self) - 1) * self.time_step

    @property
    def time(self) -> FloatArray:
        """Times of the samples [s]."""
        return np.asarray(np.arange(len(self)) * self.time_step, dtype=np.float64)

    @property
    def peak(self) -> float:
        """Peak ground acceleration, horizontal [m/s2]."""
        return float(np.abs(self.acceleration).max())

    @property
    def peak_vertical(self) -> float:
        """Peak vertical acceleration [m/s2]; zero without a vertical part."""
        return 0.0 if self.vertical is None else float(np.abs(self.vertical).max())

    def segments(self) -> Segments:
        """Return the motion as polynomials: one straight line per step.

        Returns
        -------
        Segments
            Segments of degree 1.

        Raises
        ------
        InvalidValueError
            If the motion is or may be the vertical component of a record.
        """
        checked_level(self)
        return self.upright_segments()

    def upright_segments(self) -> Segments:
        """Return the segments. This method also accepts a vertical component, a motion along z.

        Returns
        -------
        Segments
            Straight lines between the samples [m/s2, s].
        """
        return Segments.between_samples(self.time_step, self.acceleration, self.vertical)

    def changed(self, action: str, **fields: Any) -> "GroundMotion":
        """Return a copy with some fields replaced and a line added to its provenance.

        Parameters
        ----------
        action : str
            Processing step, as a sentence.
        **fields
            New values of constructor parameters.

        Returns
        -------
        GroundMotion
            Changed motion.
        """
        return replace(self, provenance=(*self.provenance, action), **fields)

    def scaled(self, factor: float) -> "GroundMotion":
        """Return the motion with both components multiplied by a factor.

        Parameters
        ----------
        factor : float
            Scale factor [-]. A negative factor reverses the polarity.

        Returns
        -------
        GroundMotion
            Scaled motion.

        Examples
        --------
        >>> GroundMotion([0.0, 1.0], 0.1).scaled(-3.0).acceleration.tolist()
        [-0.0, -3.0]
        """
        factor = checks.number("factor", factor)
        vertical = None if self.vertical is None else self.vertical * factor
        action = f"multiplied by {factor!r}"
        return self.changed(action, acceleration=self.acceleration * factor, vertical=vertical)


def checked_motion(motion: Any, name: str = "motion") -> GroundMotion:
    """Return a motion if it is a record. Otherwise raise an error.

    >>> checked_motion(GroundMotion([0.0, 1.0], 0.1)).peak
    1.0
    """
    if not isinstance(motion, GroundMotion):
        raise InvalidValueError(
            parameter=name, allowed="a GroundMotion", value=motion, hint="convert a pulse with .sampled(time_step)"
        )
    return motion


ORIENTATION = "orientation"
"""Metadata key of the direction of a record: up, down, unclear, or an azimuth [degree]."""

_UPRIGHT = {"up": "is vertical", "down": "is vertical", "unclear": "may be vertical or inclined"}


def checked_level(motion: Any) -> Any:
    """Return a motion. Raise an error if it is or may be the vertical component of a record.

    >>> checked_level(GroundMotion([0.0, 1.0], 0.1, metadata={"component": "UP", "orientation": "up"}))
    Traceback (most recent call last):
    rocking.errors.InvalidValueError: component UP of 'ground motion' is vertical and cannot be a horizontal motion; ...
    """
    metadata = motion.metadata if isinstance(motion, GroundMotion) else {}
    if (reason := _UPRIGHT.get(metadata.get(ORIENTATION, ""))) is not None:
        raise InvalidValueError(
            "component {component} of {file!r:.100} {orientation} and cannot be a horizontal motion",
            component=metadata.get("component", ""), file=metadata.get("file", motion.name), orientation=reason,
            hint="use this component along z, and a horizontal component along x",
        )  # fmt: skip
    return motion


def _samples(name: str, values: Any) -> FloatArray:
    samples = np.array(checks.real_array(name, values, "m/s2"), dtype=np.float64)
    if samples.ndim != 1 or samples.size < 2:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name,
            allowed="a row of at least 2 samples [m/s2]", shape=samples.shape,
        )  # fmt: skip
    bad = np.flatnonzero(~(np.abs(samples) <= LARGEST_ACCELERATION))
    if bad.size:
        raise InvalidValueError(
            "{parameter} must be finite and within {limit:g} m/s2, got {value} at index {index}", parameter=name,
            allowed=Range(-LARGEST_ACCELERATION, LARGEST_ACCELERATION, "m/s2"), value=float(samples[bad[0]]),
            limit=LARGEST_ACCELERATION, index=int(bad[0]), hint="check the unit and the file",
        )  # fmt: skip
    samples.setflags(write=False)
    return samples


def _metadata(metadata: Any) -> Mapping[str, str]:
    checks.of_kind("metadata", metadata, Mapping, "a mapping of strings to strings")
    return MappingProxyType({str(k): str(v) for k, v in metadata.items()})


def _provenance(lines: Any) -> tuple[str, ...]:
    if isinstance(lines, str) or not isinstance(lines, Sequence) or not all(isinstance(line, str) for line in lines):
        raise InvalidValueError(parameter="provenance", allowed="a sequence of strings, one sentence each", value=lines)
    return tuple(lines)
