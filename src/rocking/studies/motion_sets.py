"""Motions of a study by index. Motions are kept in memory, or generated from a seed when needed."""

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any

from rocking import checks
from rocking.dynamics.content import full_name
from rocking.errors import InvalidValueError
from rocking.motions.components import Components, leading, together
from rocking.motions.intensity import measure
from rocking.motions.motion import GroundMotion
from rocking.motions.processing import scaled_to
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.synthetic.distributions import Distribution
from rocking.motions.synthetic.families import Family, family


class MotionSet(ABC):
    """Motions by index. An index always gives a bit-identical motion."""

    @abstractmethod
    def __len__(self) -> int: ...

    @abstractmethod
    def __getitem__(self, index: int) -> Motion: ...

    @abstractmethod
    def description(self) -> dict[str, Any]:
        """Return the identity of the motions as plain values: kinds, parameters, seeds, hashes of samples.

        Returns
        -------
        dict
            Provenance. Sets with equal descriptions contain equal motions.
        """

    @property
    def in_memory(self) -> bool:
        """True if all motions are in memory, so that the engine prepares the motions once."""
        return False


class MotionList(MotionSet):
    """Motions in memory.

    Parameters
    ----------
    motions : GroundMotion, Pulse or mapping, or a sequence of them
        Either records only or pulses only. Components by axis are allowed, as for `simulate`.
    plane : bool
        True for plane bodies, which use a component along x and a component along z; both must be records.

    Raises
    ------
    InvalidValueError
        If there is no motion, or if the motions have different kinds.

    Examples
    --------
    >>> import rocking as rk
    >>> len(MotionList([rk.pulses.sine(2.0, 0.5), rk.pulses.sine(3.0, 0.5)]))
    2
    """

    def __init__(self, motions: Any, *, plane: bool = False) -> None:
        single = isinstance(motions, (GroundMotion, Pulse, Components, Mapping))
        text = "{parameter} must be ground motions or pulses, got {given}"
        if not single and (isinstance(motions, (str, os.PathLike)) or not isinstance(motions, Iterable)):
            raise InvalidValueError(text, parameter="motions", value=motions, given=checks.given("motions", motions))
        items = [together(motion, plane=plane) for motion in ([motions] if single else motions)]
        if not items:
            raise InvalidValueError(text, parameter="motions", given="none")
        for k, item in enumerate(items):
            if not isinstance(item, (GroundMotion, Pulse, Components)):
                raise InvalidValueError(
                    text, parameter="motions", value=item, given=checks.given("motions", item, f" at index {k}")
                )
        if len({isinstance(leading(item), Pulse) for item in items}) > 1:
            raise InvalidValueError("motions of a study must be all records or all pulses; sample the pulses")
        self._motions: list[Motion] = items

    @classmethod
    def empty(cls) -> "MotionList":
        """Return a set without motions, for bodies under a harmonic ground motion."""
        motion_set = cls.__new__(cls)
        motion_set._motions = []
        return motion_set

    def __len__(self) -> int:
        return len(self._motions)

    def __getitem__(self, index: int) -> Motion:
        return self._motions[index]

    @property
    def in_memory(self) -> bool:
        """True."""
        return True

    def description(self) -> dict[str, Any]:
        """Return names and hashes."""
        return {
            "kind": "list",
            "motions": [{"name": motion.name, "sha256": digest(motion)} for motion in self._motions],
        }


def digest(motion: Any) -> str:
    """Return the SHA-256 of a motion for an engine, from the step and the coefficients of both accelerations."""
    import hashlib

    import numpy as np

    if isinstance(motion, Components):
        digests = (b"none" if component is None else digest(component).encode() for component in motion.parts)
        return hashlib.sha256(b" ".join(digests)).hexdigest()
    segments = motion.upright_segments() if isinstance(motion, GroundMotion) else motion.segments()
    hashed = hashlib.sha256(np.array([segments.step, segments.degree], "<f8").tobytes())
    for component in (segments.horizontal, segments.vertical):
        hashed.update(b"none" if component is None else np.ascontiguousarray(component, "<f8").tobytes())
    return hashed.hexdigest()


MOST_MOTIONS = 10_000_000  # largest number of motions of a set


class SyntheticSet(MotionSet):
    """Motions of a family. A motion is generated on access.

    A motion depends only on the family, the seed and its index, so that a larger set begins with the motions of a
    smaller set.

    Parameters
    ----------
    which : str or Family
        The family: a name of `rocking.motions.synthetic.families.families`, or a user-defined family.
    count : int
        Number of motions [-].
    seed : int
        Seed of the set, at least 0 [-].
    time_step : float, optional
        Time step of the samples [s]. Default: the time step of the family.
    **level : float
        Level of the scaled motions [unit of the measure], by the name of one measure that increases with the scale
        factor, such as ``pga=3.0``. Default: unscaled.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, if there are several levels, or if scaling does not change the measure.

    Examples
    --------
    >>> motions = SyntheticSet("point-source", count=100, seed=1, pga=3.0)
    >>> len(motions), round(motions[99].peak, 12)
    (100, 3.0)
    """

    def __init__(
        self,
        which: str | Family,
        count: int,
        seed: int,
        *,
        time_step: float | None = None,
        **level: float | None,
    ) -> None:
        self.family = family(which)
        self.count, self.seed = checks.whole("count", count, 1, MOST_MOTIONS), checks.whole("seed", seed)
        levels = {name: value for name, value in level.items() if value is not None}
        if len(levels) > 1:
            raise InvalidValueError("motions can be scaled to {measures}, not to both", measures=" or to ".join(levels))
        self.level: dict[str, float] = {}
        for name, value in levels.items():
            im = measure(name)
            im.check_grows()
            self.level[im.name] = checks.positive(im.name, value, im.unit)
        step = self.family.time_step if time_step is None else time_step
        self.time_step = checks.positive("time_step", step, "s")

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int) -> GroundMotion:
        position = index + self.count if index < 0 else index
        if not 0 <= position < self.count:
            raise IndexError(f"motions are numbered 0 to {self.count - 1}, got {index}")
        motion = self.family.motion(self.seed, int(position), self.time_step)
        for name, value in self.level.items():
            motion = scaled_to(motion, name, value)
        return motion

    def description(self) -> dict[str, Any]:
        """Return family, distributions, seed, level, and hashes of the first and the last motion."""
        first, last = self._ends
        return {
            "kind": "synthetic",
            "family": self.family.name,
            "generator": self.family.generator,
            "distributions": [
                [name, _described(name, distribution)] for name, distribution in self.family.distributions.items()
            ],
            "make": _named(self.family.make),
            "origin": self.family.origin,
            "count": self.count,
            "seed": self.seed,
            **dict.fromkeys(("pga_m_s2", "pgv_m_s")),
            **{measure(name).key: value for name, value in self.level.items()},
            "time_step_s": self.time_step,
            "first": first,
            "last": last,
        }

    @cached_property
    def _ends(self) -> tuple[str, str]:
        """Hashes of the first and the last motion, which identify the code of the family."""
        return digest(self[0]), digest(self[-1])


def _named(make: Callable[..., GroundMotion]) -> str:
    """Return the name of a function. Raise an error for functions without a name or with bound values."""
    name = getattr(make, "__qualname__", "")
    has_values = getattr(make, "__closure__", None) or (getattr(make, "__self__", None) is not None)
    if not name or "<lambda>" in name or has_values:
        raise InvalidValueError(
            "make of a family must be a named function without bound values, got {value}: a lambda, a partial, a "
            "method or a closure does not identify its motions", parameter="make", value=make,
        )  # fmt: skip
    return f"{make.__module__}.{name}"


def _described(name: str, distribution: Distribution) -> str:
    if type(distribution).__repr__ is object.__repr__:
        raise InvalidValueError(
            "distribution {parameter} must contain its parameters in repr(), as a dataclass does, got {value}",
            parameter=name, value=distribution,
        )  # fmt: skip
    return f"{full_name(type(distribution))}: {distribution!r}"
