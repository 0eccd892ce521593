"""How to integrate: settings, and which engine runs on how many threads with which instructions."""

import os
from dataclasses import dataclass, fields
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from rocking import checks, conventions, errors, plausibility
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning

ORDERS = (4, 6, 8)  # orders that the fast engine has been compiled for

BOUNCE_LAWS = ("newton", "poisson", "stronge")
"""What the coefficient of normal restitution may be the ratio of: velocities, impulses or, squared, energies."""

# friction of a body in space for which a study is told none: it may hop, fly and fall into another pose [-]
NEVER_SLIDES = 1e6

SHORTEST_STEP = 1e-6  # least `Settings.longest_step` [-]

# usual, least and most value of what the mechanics have of their own; the others are the same for all
_OWN: dict[str, dict[str, tuple[float, float, float]]] = {
    "rocking": {
        "rest_speed": (0.001, 0.0, 0.1),
        "longest_step": (0.15, SHORTEST_STEP, 1.0),
        "order": (8, 4, 8),
        "tolerance": (1e-15, 1e-17, 1e-3),
    },
    "contact": {"rest_speed": (1e-7, 1e-12, 0.1), "tolerance": (1e-15, 1e-17, 1e-3)},
    "space": {
        "rest_speed": (1e-5, 1e-7, 0.01),
        "longest_step": (1.0, SHORTEST_STEP, 1.0),
        "order": (28, 2, 40),
        "tolerance": (1e-17, 1e-20, 1e-2),
    },
    "space, many": {
        "rest_speed": (1e-5, 1e-7, 0.01),
        "longest_step": (0.6, SHORTEST_STEP, 1.0),
        "tolerance": (1e-13, 1e-20, 1e-2),
    },
    "space with friction": {"rest_speed": (1e-5, 1e-7, 0.01), "tolerance": (1e-12, 1e-15, 1e-2)},
}
_HINTS = {
    ("rocking", "rest_speed"): "the flights must be short for the sum to hold",
    ("contact", "rest_speed"): "bounces accumulate: zero would never end",
}


@dataclass(frozen=True)
class Settings:
    """How to integrate.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    linear : bool
        Slender-linear equations: sine and cosine of the angles replaced by angle and one. Rocking alone has them.
    rest_speed : float, optional
        Speed below which a motion ends at once [-]. Rocking alone: after an impact, over p alpha (.001); the impacts
        to come are then summed up to rest instead of being resolved one by one, only where they provably end before
        the body could rise again. With contact: of a bounce or a rocking motion after an impact, over sqrt(g R)
        (1e-7); its energy is booked as lost in that impact. In space: of a vertex that leaves the ground and would
        fall back at once, over sqrt(g R) (1e-5); its square is the energy, over that of overturning, at which a body
        comes to rest. In space with friction that energy is at least 1e-11 m g R, since smaller gaps count as closed.
    most_events : int
        A history with more impacts and changes of contact is stopped, with a status that says so.
    longest_step : float, optional
        Longest Taylor step as p times time [-]; .15 in the fast engine, 1 in space (.6 for many bodies, there as p +
        ``|angular velocity|`` times time); with contact there is none.
    order : int, optional
        Order of the Taylor series. Rocking alone: 4, 6 or 8 (8), of the fast engine. With order 8, records whose
        samples are so close that order 6 leaves out less than a hundredth of what order 8 may leave out at the longest
        step are followed with order 6, under many g only if they are closer still. Orders 4 and 6 by themselves exist
        only for many histories at once (`simulate_many`), with the nonlinear equations and motions without a vertical
        part; elsewhere they are refused. In space: the highest, from 2 to 40 (28). Other engines choose their own.
    tolerance : float, optional
        Bound on the last two terms of a Taylor step: over the angle alpha (and the size R with contact) 1e-15; for
        quaternions of unit length 1e-17 in space (1e-13 for many bodies). In space with friction bound on the local
        error of a step of order 5, over size, radian and their rates (1e-12) [-].
    mechanics : {"rocking", "contact", "space", "space, many", "space with friction"}
        Whose usual values and ranges these are; with `friction` those of contact, in space of bodies on their hulls.
    friction, bounce, bounce_law : optional
        Of studies whose bodies may slide, hop and fly: as for `simulate` [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or these mechanics have no such setting.

    Examples
    --------
    >>> Settings().rest_speed, Settings(mechanics="space").rest_speed
    (0.001, 1e-05)
    """

    # what is None here is a number after __post_init__, where these mechanics have it
    gravity: float = conventions.g
    linear: bool = False
    rest_speed: float = None  # type: ignore[assignment]
    most_events: int = 100_000
    longest_step: float = None  # type: ignore[assignment]
    order: int = None  # type: ignore[assignment]
    tolerance: float = None  # type: ignore[assignment]
    mechanics: str = "rocking"
    friction: float | None = None
    bounce: float = 0.0
    bounce_law: str = "newton"

    def __post_init__(self) -> None:
        if self.friction is not None:
            self._check_ground()
        elif self.bounce or self.bounce_law != "newton":
            raise InvalidValueError("bounce and bounce_law go with friction: pure rocking does not leave the ground")
        own = _OWN[self.mechanics]
        made: dict[str, float] = {
            "gravity": checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True),
            "most_events": checks.whole(
                "most_events", self.most_events, 1, 10_000_000 if "space" in self.mechanics else 2**63 - 1
            ),
        }
        for name in ("rest_speed", "longest_step", "order", "tolerance"):
            value: Any = getattr(self, name)
            if name not in own:
                if value is not None:
                    raise InvalidValueError(f"{name} is no setting of {self.mechanics}; {self._has(own)}")
                continue
            usual, least, most = own[name]
            made[name] = self._checked(name, usual if value is None else value, least, most)
        linear: object = self.linear
        if not isinstance(linear, bool):
            raise InvalidValueError(f"linear must be True or False, got {self.linear!r}")
        if linear and self.mechanics != "rocking":
            raise InvalidValueError(f"linear equations are no setting of {self.mechanics}; {self._has(own)}")
        for name, number in made.items():  # numbers of one kind: 9 and 9.0 are the same settings
            object.__setattr__(self, name, number)
        plausibility.warn(plausibility.of_gravity(self.gravity))

    def _checked(self, name: str, value: Any, least: float, most: float) -> float:
        if name != "order":
            return checks.within(name, value, least, most, hint=_HINTS.get((self.mechanics, name), ""))
        if self.mechanics != "rocking":
            return checks.whole(name, value, int(least), int(most))
        if not isinstance(value, (int, np.integer)) or value not in ORDERS:
            raise InvalidValueError(f"order must be one of {ORDERS}, got {value!r:.60}")
        return int(value)

    def _check_ground(self) -> None:
        own = _OWN[self.mechanics]
        if self.mechanics not in {"rocking", "contact", "space with friction"}:
            raise InvalidValueError(f"friction is no setting of {self.mechanics}; {self._has(own)}")
        if self.mechanics != "space with friction":
            object.__setattr__(self, "mechanics", "contact")
        elif self.bounce or self.bounce_law != "newton":
            raise InvalidValueError(f"bounce is no setting of {self.mechanics}; {self._has(own)}")
        friction = checks.within("friction", self.friction, 0.0, 1e6, hint="1e6 for feet that never slide")
        made = {
            "friction": friction,
            "bounce": checks.within("bounce", self.bounce, 0.0, 1.0, open_high=True),
            "bounce_law": checks.one_of("bounce_law", self.bounce_law, BOUNCE_LAWS),
        }
        for name, value in made.items():
            object.__setattr__(self, name, value)
        plausibility.warn(plausibility.of_friction(friction))

    def _has(self, own: dict[str, Any]) -> str:
        return f"it has gravity, most_events, {', '.join(own)}"

    @property
    def stated(self) -> dict[str, Any]:
        """Values by name, of the settings that these mechanics have."""
        has = {"gravity", "most_events", *_OWN[self.mechanics]}
        if self.mechanics == "rocking":
            has.add("linear")
        if self.friction is not None:
            has |= {"friction"} if "space" in self.mechanics else {"friction", "bounce", "bounce_law"}
        return {field.name: getattr(self, field.name) for field in fields(self) if field.name in has}


def in_space(body: Any) -> bool:
    """Return whether a body is one in space: it has a base to stand on, not two feet."""
    return not isinstance(body, (Body, np.ndarray)) and hasattr(body, "base")


def settings_of(gravity: float, options: dict[str, Any], body: Any = None) -> Settings:
    """Return the settings of a call; body: what it is about, which may be one in space."""
    known = {field.name for field in fields(Settings)} - {"mechanics"}
    unknown = sorted(set(options) - known)
    if unknown:
        raise InvalidValueError(f"no option named {unknown[0]!r}; there are {', '.join(sorted(known))}")
    if not in_space(body):
        return Settings(gravity=gravity, **options)
    options = {**options, "friction": NEVER_SLIDES if options.get("friction") is None else options["friction"]}
    return Settings(gravity=gravity, **options, mechanics="space with friction")


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
            raise MissingExtraError(f'{self.not_built}; engine="reference" gives the same results, slowly')
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
            raise InvalidValueError(f"ROCKING_ISA must be one of {', '.join(known)}, got {wanted!r}")
        return wanted or known[0]

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
        raise InvalidValueError(f"progress must be a function of the histories done, or None, got {progress!r:.60}")


def processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
