"""Settings of the integration for all mechanics, and choice of engine and number of threads."""

import math
import os
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import partial
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from rocking import checks, conventions, errors, plausibility
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning

BOUNCE_LAWS = ("newton", "poisson", "stronge")
"""Definitions of normal restitution: ratio of velocities, ratio of impulses, or square root of the energy ratio."""

# coefficient of friction if no friction is stated [-]; the body does not slide, but can hop, fly and change its pose
NEVER_SLIDES = 1e6

SHORTEST_STEP = 1e-6  # smallest `longest_step` of settings [-]


_IDENTITY = {"normal_restitution": "bounce", "normal_restitution_law": "bounce_law"}
_FIRST_IN_FILES = ("gravity", "linear", "rest_speed", "most_events")


def checked(default: Any, check: Callable[[str, Any], Any]) -> Any:
    """Return a field of settings with a default and a function that checks a value.

    It is called with name and value.
    """
    return field(default=default, metadata={"check": check})


def ranged(default: float, low: float, high: float, **options: Any) -> Any:
    """Return a numeric field of settings with limits. The options are those of `checks.within`."""
    return checked(default, partial(checks.within, low=low, high=high, **options))


def counted(default: int, low: int, high: int) -> Any:
    """Return an integer field of settings with limits."""
    return checked(default, partial(checks.whole, low=low, high=high))


def checked_friction(name: str, value: Any) -> float:
    """Return a valid coefficient of friction. An assumed value stays marked as assumed."""
    number = checks.within(name, value, 0.0, 1e6, hint="1e6 for feet that never slide")
    plausibility.warn(plausibility.of_friction(number))
    return value if isinstance(value, conventions.Assumed) else number


def _checked_gravity(name: str, value: Any) -> float:
    number = checks.within(name, value, 0.0, 1e6, unit="m/s2", open_low=True)
    plausibility.warn(plausibility.of_gravity(number))
    return number


@dataclass(frozen=True)
class Settings:
    """Settings of the integration for all mechanics. Every mechanics has its own subclass.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    most_events : int
        Largest number of impacts and changes of contact. A history with more is stopped with an error status.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking.dynamics import PlaneSettings, SpaceSettings
    >>> PlaneSettings(gravity=9.81).rest_speed, SpaceSettings().rest_speed
    (0.001, 1e-05)
    """

    gravity: float = checked(conventions.g, _checked_gravity)
    most_events: int = counted(100_000, 1, 2**63 - 1)

    def __post_init__(self) -> None:
        for entry in fields(self):  # checks convert types, so that settings with 9 and 9.0 are equal
            object.__setattr__(self, entry.name, entry.metadata["check"](entry.name, getattr(self, entry.name)))

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the names of the settings."""
        return tuple(entry.name for entry in fields(cls))

    @property
    def identity(self) -> dict[str, Any]:
        """Values by the names that identify histories on disk. Renaming a setting thus does not change campaigns."""
        return {_IDENTITY.get(name, name): value for name, value in self.stated.items()}

    @property
    def stated(self) -> dict[str, Any]:
        """Values by name, in the order of input files."""
        order = {name: position for position, name in enumerate(_FIRST_IN_FILES)}
        names = sorted(self.names(), key=lambda name: order.get(name, len(order)))
        return {name: getattr(self, name) for name in names}

    @property
    def integration(self) -> dict[str, Any]:
        """Values by name, without the values of the ground."""
        return self.stated

    @property
    def linear(self) -> bool:
        """True for the slender-linear equations."""
        return False

    @property
    def friction(self) -> float:
        """Coefficient of friction between body and ground [-]; infinite if the body does not slide."""
        return math.inf


ENGINES = ("auto", "fast", "reference")


@dataclass(frozen=True)
class CompiledEngine:
    """An optional engine in C++."""

    name: str  # name of its module
    not_built: str  # message if it was not built
    fallback: str = "the reference engine runs instead"
    floats: tuple[str, ...] = ()  # names of columns of results; NaN without a result
    integers: tuple[str, ...] = ()  # names of columns of integer results

    def built(self) -> ModuleType | None:
        try:
            return import_module(self.name)
        except ImportError:
            return None

    def available(self) -> bool:
        """Return True if the engine was built with this installation. Otherwise the reference engine is used."""
        return self.built() is not None

    def module(self) -> ModuleType:
        """Return the compiled module. Raise an error if it was not built."""
        compiled = self.built()
        if compiled is None:
            raise MissingExtraError(self.not_built, hint='engine="reference" gives the same results, slowly')
        return compiled

    def chosen(self, requested: str) -> str:
        """Return the name of the engine to use. Issue a warning if "auto" selects the slow engine."""
        requested = checks.one_of("engine", requested, ENGINES)
        if requested == "auto" and not self.available():
            errors.warn(f"{self.not_built}; {self.fallback}", SlowEngineWarning)
            return "reference"
        if requested != "reference":
            self.module()
        return "reference" if requested == "reference" else "fast"

    def instruction_sets(self) -> list[str]:
        """Return the instruction sets that the engine supports on this processor, fastest first."""
        return list(self.module().instruction_sets())

    def instruction_set(self) -> str:
        """Return the instruction set in use: the environment variable ROCKING_ISA, or by default the fastest."""
        supported, requested = self.instruction_sets(), os.environ.get("ROCKING_ISA", "")
        if requested and requested not in supported:
            raise InvalidValueError(parameter="ROCKING_ISA", allowed=f"one of {', '.join(supported)}", value=requested)
        return requested or supported[0]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the results."""
        return (*self.integers, *self.floats)

    def empty_tables(self, count: int) -> tuple[FloatArray, IntArray]:
        """Return empty tables for the results of rows: `floats` and `integers`."""
        return np.full((count, len(self.floats)), np.nan), np.zeros((count, len(self.integers)), np.int64)

    def columns_by_name(self, results: FloatArray, counts: IntArray) -> dict[str, np.ndarray]:
        """Return the columns of the tables of results and counts by name."""
        integers = {name: np.ascontiguousarray(counts[:, k]) for k, name in enumerate(self.integers)}
        return integers | {name: np.ascontiguousarray(results[:, k]) for k, name in enumerate(self.floats)}


MOST_THREADS = 4096


def thread_count(threads: object) -> int:
    """Return the number of threads; None means the number of processors."""
    return processors() if threads is None else checks.whole("threads", threads, 1, MOST_THREADS)


def check_progress(progress: object) -> None:
    """Raise an error if `progress` is not a function."""
    if progress is not None and not callable(progress):
        raise InvalidValueError(
            parameter="progress", allowed="a function of the number of computed histories, or None", value=progress
        )


def processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
