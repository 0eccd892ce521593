"""How to integrate: what the settings of all mechanics share, and which engine runs on how many threads."""

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
"""What the coefficient of normal restitution may be the ratio of: velocities, impulses or, squared, energies."""

# friction of a body in space for which a study is told none: it may hop, fly and fall into another pose [-]
NEVER_SLIDES = 1e6

SHORTEST_STEP = 1e-6  # least `longest_step` of settings [-]


_FIRST_IN_FILES = ("gravity", "linear", "rest_speed", "most_events")


def checked(default: Any, check: Callable[[str, Any], Any]) -> Any:
    """Return a field of settings: its default, and the function of name and value that checks it."""
    return field(default=default, metadata={"check": check})


def ranged(default: float, low: float, high: float, **options: Any) -> Any:
    """Return a field of settings that is a number within limits; options of `checks.within`."""
    return checked(default, partial(checks.within, low=low, high=high, **options))


def counted(default: int, low: int, high: int) -> Any:
    """Return a field of settings that is a whole number within limits."""
    return checked(default, partial(checks.whole, low=low, high=high))


def checked_friction(name: str, value: Any) -> float:
    """Return a coefficient of friction; one that nobody gave remains told apart."""
    number = checks.within(name, value, 0.0, 1e6, hint="1e6 for feet that never slide")
    plausibility.warn(plausibility.of_friction(number))
    return value if isinstance(value, conventions.Assumed) else number


def _checked_gravity(name: str, value: Any) -> float:
    number = checks.within(name, value, 0.0, 1e6, unit="m/s2", open_low=True)
    plausibility.warn(plausibility.of_gravity(number))
    return number


@dataclass(frozen=True)
class Settings:
    """How to integrate: what the settings of all mechanics have. Each mechanics has a class of its own.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    most_events : int
        A history with more impacts and changes of contact is stopped, with a status that says so.

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
        for each in fields(self):  # numbers of one kind: 9 and 9.0 are the same settings
            object.__setattr__(self, each.name, each.metadata["check"](each.name, getattr(self, each.name)))

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the names of the settings."""
        return tuple(each.name for each in fields(cls))

    @property
    def stated(self) -> dict[str, Any]:
        """Values by name, in the order in which files have them."""
        order = {name: place for place, name in enumerate(_FIRST_IN_FILES)}
        names = sorted(self.names(), key=lambda name: order.get(name, len(order)))
        return {name: getattr(self, name) for name in names}

    @property
    def integration(self) -> dict[str, Any]:
        """Values by name, without those of the ground, which are among the facts of a response."""
        return self.stated

    @property
    def linear(self) -> bool:
        """Whether the equations are the slender-linear ones."""
        return False

    @property
    def friction(self) -> float:
        """Coefficient of friction between body and ground; infinite where the body does not slide [-]."""
        return math.inf


ENGINES = ("auto", "fast", "reference")


@dataclass(frozen=True)
class CompiledEngine:
    """An engine in C++, which an installation may lack."""

    name: str  # of its module
    not_built: str  # what is said where it was not built
    instead: str = "the reference engine runs instead"
    floats: tuple[str, ...] = ()  # columns of its results, NaN without a result
    wholes: tuple[str, ...] = ()  # columns of whole numbers

    def built(self) -> ModuleType | None:
        try:
            return import_module(self.name)
        except ImportError:
            return None

    def available(self) -> bool:
        """Return whether the engine was built with this installation; otherwise the reference engine serves."""
        return self.built() is not None

    def module(self) -> ModuleType:
        """Return the compiled module, or say what it takes."""
        found = self.built()
        if found is None:
            raise MissingExtraError(self.not_built, hint='engine="reference" gives the same results, slowly')
        return found

    def chosen(self, asked: str) -> str:
        """Return which engine will run, and say so if it is not the one that users expect."""
        asked = checks.one_of("engine", asked, ENGINES)
        if asked == "auto" and not self.available():
            errors.warn(f"{self.not_built}; {self.instead}", SlowEngineWarning)
            return "reference"
        if asked != "reference":
            self.module()
        return "reference" if asked == "reference" else "fast"

    def instruction_sets(self) -> list[str]:
        """Return what the engine can use on this processor, the fastest first."""
        return list(self.module().instruction_sets())

    def instruction_set(self) -> str:
        """Return what it will use: what the environment variable ROCKING_ISA names, or the fastest there is."""
        known, wanted = self.instruction_sets(), os.environ.get("ROCKING_ISA", "")
        if wanted and wanted not in known:
            raise InvalidValueError(parameter="ROCKING_ISA", allowed=f"one of {', '.join(known)}", value=wanted)
        return wanted or known[0]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its results."""
        return (*self.wholes, *self.floats)

    def room(self, count: int) -> tuple[FloatArray, IntArray]:
        """Return tables for the results of some rows: `floats`, and `wholes`."""
        return np.full((count, len(self.floats)), np.nan), np.zeros((count, len(self.wholes)), np.int64)

    def named(self, results: FloatArray, counts: IntArray) -> dict[str, np.ndarray]:
        """Return the columns of such tables by name."""
        whole = {name: np.ascontiguousarray(counts[:, k]) for k, name in enumerate(self.wholes)}
        return whole | {name: np.ascontiguousarray(results[:, k]) for k, name in enumerate(self.floats)}


MOST_THREADS = 4096


def thread_count(threads: object) -> int:
    """Return how many threads to run on: every processor if None."""
    return processors() if threads is None else checks.whole("threads", threads, 1, MOST_THREADS)


def check_progress(progress: object) -> None:
    """Refuse what cannot be told how far the work is."""
    if progress is not None and not callable(progress):
        raise InvalidValueError(
            parameter="progress", allowed="a function of the histories done, or None", value=progress
        )


def processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
