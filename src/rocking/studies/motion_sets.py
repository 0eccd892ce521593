"""The motions of a study, by number: held in memory, or made from a seed when they are needed."""

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
    """Motions by number. The same number is the same motion, to the last bit, whoever asks and when."""

    @abstractmethod
    def __len__(self) -> int: ...

    @abstractmethod
    def __getitem__(self, index: int) -> Motion: ...

    @abstractmethod
    def description(self) -> dict[str, Any]:
        """Return what makes these motions these, as plain values: kinds, parameters, seeds, hashes of samples.

        Returns
        -------
        dict
            For provenance; two sets that describe themselves alike hold the same motions.
        """

    @property
    def in_memory(self) -> bool:
        """Whether the motions are all at hand, so that laying them out once pays."""
        return False


class MotionList(MotionSet):
    """Motions that are all at hand.

    Parameters
    ----------
    motions : GroundMotion, Pulse or mapping, or a sequence of them
        All records or all pulses; also components by axis, as for `simulate`.
    plane : bool
        Whether they shake plane bodies, which take a component along x and one along z, a record each.

    Raises
    ------
    InvalidValueError
        If there is none, or they are of different kinds.

    Examples
    --------
    >>> import rocking as rk
    >>> len(MotionList([rk.pulses.sine(2.0, 0.5), rk.pulses.sine(3.0, 0.5)]))
    2
    """

    def __init__(self, motions: Any, *, plane: bool = False) -> None:
        single = isinstance(motions, (GroundMotion, Pulse, Components, Mapping))
        wanted = "{parameter} must be ground motions or pulses, got {given}"
        if not single and (isinstance(motions, (str, os.PathLike)) or not isinstance(motions, Iterable)):
            raise InvalidValueError(wanted, parameter="motions", value=motions, given=checks.given("motions", motions))
        found = [together(each, plane=plane) for each in ([motions] if single else motions)]
        if not found:
            raise InvalidValueError(wanted, parameter="motions", given="none")
        for k, item in enumerate(found):
            if not isinstance(item, (GroundMotion, Pulse, Components)):
                raise InvalidValueError(
                    wanted, parameter="motions", value=item, given=checks.given("motions", item, f" at index {k}")
                )
        if len({isinstance(leading(item), Pulse) for item in found}) > 1:
            raise InvalidValueError("motions of a study must be all records or all pulses; sample the pulses")
        self._motions: list[Motion] = found

    @classmethod
    def empty(cls) -> "MotionList":
        """Return a set without motions, for bodies under a harmonic ground motion."""
        made = cls.__new__(cls)
        made._motions = []
        return made

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
    """Return the SHA-256 of what an engine sees of a motion: the step, and the coefficients of both accelerations."""
    import hashlib

    import numpy as np

    if isinstance(motion, Components):
        parts = (b"none" if part is None else digest(part).encode() for part in motion.parts)
        return hashlib.sha256(b" ".join(parts)).hexdigest()
    segments = motion.upright_segments() if isinstance(motion, GroundMotion) else motion.segments()
    hashed = hashlib.sha256(np.array([segments.step, segments.degree], "<f8").tobytes())
    for part in (segments.horizontal, segments.vertical):
        hashed.update(b"none" if part is None else np.ascontiguousarray(part, "<f8").tobytes())
    return hashed.hexdigest()


MOST_MOTIONS = 10_000_000  # no set has more motions: asking for more is a slip


class SyntheticSet(MotionSet):
    """Motions of a family, each made when it is asked for.

    A motion depends on the family, the seed and its number alone: a larger set begins with the motions of a smaller
    one.

    Parameters
    ----------
    which : str or Family
        The family: a name of `rocking.motions.synthetic.families.families`, or one of your own.
    count : int
        How many motions [-].
    seed : int
        Seed of the set, at least 0 [-].
    time_step : float, optional
        Step between samples; that of the family if not given [s].
    **level : float
        To what each motion is scaled: one measure that grows with it, by name, such as ``pga=3.0``; none if not given
        [unit of the measure].

    Raises
    ------
    InvalidValueError
        If a value is outside its range, several levels are given, or no factor changes the measure.

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
        given = {name: value for name, value in level.items() if value is not None}
        if len(given) > 1:
            raise InvalidValueError("motions can be scaled to {measures}, not to both", measures=" or to ".join(given))
        self.level: dict[str, float] = {}
        for name, value in given.items():
            one = measure(name)
            one.check_grows()
            self.level[one.name] = checks.positive(one.name, value, one.unit)
        step = self.family.time_step if time_step is None else time_step
        self.time_step = checks.positive("time_step", step, "s")

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int) -> GroundMotion:
        place = index + self.count if index < 0 else index
        if not 0 <= place < self.count:
            raise IndexError(f"motions are numbered 0 to {self.count - 1}, got {index}")
        motion = self.family.motion(self.seed, int(place), self.time_step)
        for name, value in self.level.items():
            motion = scaled_to(motion, name, value)
        return motion

    def description(self) -> dict[str, Any]:
        """Return family, distributions as drawn, seed, level, and hashes of the first and last motion."""
        first, last = self._ends
        return {
            "kind": "synthetic",
            "family": self.family.name,
            "generator": self.family.generator,
            "distributions": [[name, _told(name, each)] for name, each in self.family.distributions.items()],
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
        """Hashes of the first and the last motion, which show what the code of the family makes."""
        return digest(self[0]), digest(self[-1])


def _named(make: Callable[..., GroundMotion]) -> str:
    """Return the name of a function; one without a name, or which holds other values, does not say what it makes."""
    name = getattr(make, "__qualname__", "")
    held = getattr(make, "__closure__", None) or (getattr(make, "__self__", None) is not None)
    if not name or "<lambda>" in name or held:
        raise InvalidValueError(
            "make of a family must be a function with a name that holds no other values, got {value}: a lambda, a "
            "partial, a method or a closure does not say which motions it makes", parameter="make", value=make,
        )  # fmt: skip
    return f"{make.__module__}.{name}"


def _told(name: str, distribution: Distribution) -> str:
    if type(distribution).__repr__ is object.__repr__:
        raise InvalidValueError(
            "distribution {parameter} must say what makes it by repr(), as a dataclass does, got {value}",
            parameter=name, value=distribution,
        )  # fmt: skip
    return f"{full_name(type(distribution))}: {distribution!r}"
