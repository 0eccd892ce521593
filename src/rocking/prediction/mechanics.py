"""What a prediction asks of a body: which numbers are drawn for it, and what becomes of it under each motion."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.dynamics._simulate import components_of
from rocking.errors import InvalidValueError
from rocking.motions.components import Components
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.prediction.uncertain import Uncertain

MEASURED, COMPLEMENTARITY = ("measured", "calibrated"), "complementarity"
"""Restitution by what the published measurements say of a body, drawn; by the laws of contact at the corners alone."""

FRICTION = ((0.3, 0.8), 0.01, 10.0, "-")
CENTRE = ((0.97, 1.03), 0.5, 1.5, "-")
FRICTION_WHY = "dry stone, concrete, wood and metal: EN 12812 and BS 5975 differ by as much for one pair of them"
CENTRE_WHY = "factor on the height of the centre: what is inside is rarely homogeneous"
AZIMUTH_WHY = "which way round the body stands to the two components is not known"

Usual = tuple[Any, float, float, str]
"""What an input is where nobody says otherwise, its least and largest value that make sense, and its unit."""


@dataclass(frozen=True, eq=False)
class Endings:
    """What became of bodies under one motion, one entry a body."""

    uplift: FloatArray  # 1 where it rocked, 0 where not, NaN without a result
    sliding: FloatArray  # how far it slid [m]
    overturning: FloatArray  # 1 where it overturned
    peak: FloatArray  # largest rotation, without its sign [rad]
    direction: FloatArray | None = None  # of a body in space, in which it leant when it fell, from x to y [rad]


class Mechanics(ABC):
    """A body on an engine: what is drawn for it from the unit cube, and what becomes of it."""

    widths_of: Mapping[str, int] = {}  # how many numbers an input takes, if not one
    why: Mapping[str, str] = {}  # why inputs are what they are where nobody says otherwise

    def __init__(self, motions: Any, given: Mapping[str, Any]) -> None:
        self._motions, self.names, self._turns = several(motions), [], False
        for k in range(len(self._motions)):
            along, across, _ = parts(self._motions[k])
            self.names.append(along.name)
            self._turns |= across is not None
        self.given, self.inputs, self.assumed = given, dict[str, Uncertain](), list[str]()

    def _take(self, usual: Mapping[str, Usual]) -> None:
        """Take what is given of inputs, and say what was assumed of the others."""
        for name, (otherwise, low, high, unit) in usual.items():
            told = self.given.get(name)
            self.inputs[name] = Uncertain.of(name, otherwise if told is None else told, low, high, unit)
            if told is None:
                self.assumed.append(f"{name}: {self.inputs[name].words} ({self.why[name]})")
        plausibility.warn(plausibility.of_friction(float(self.inputs["friction"].quantile(np.array([0.5]))[0])))

    @property
    def widths(self) -> dict[str, int]:
        """How many numbers from 0 to 1 each input takes that is not known."""
        return {name: self.widths_of.get(name, 1) for name, each in self.inputs.items() if not each.fixed}

    def probabilities(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return the columns of each input; one half of what is fixed, whatever it then means."""
        found, at, widths = {}, 0, self.widths
        for name in self.inputs:
            width = widths.get(name, 0)
            fixed = np.full((len(draws), self.widths_of.get(name, 1)), 0.5)
            found[name] = draws[:, at : at + width] if width else fixed
            at += width
        return found

    def values(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return what draws from the unit cube mean, by input; one row a body."""
        levels = self.probabilities(draws)
        return {name: each.quantile(levels[name]) for name, each in self.inputs.items()}

    @abstractmethod
    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> Endings:
        """Return what becomes of bodies under a motion times a factor."""


def several(motions: Any) -> Any:
    """Return motions by number: one, several, or a set that makes them when they are asked for."""
    if isinstance(motions, (Mapping, GroundMotion, Pulse)) or not hasattr(motions, "__getitem__"):
        motions = [motions]
    if isinstance(motions, str) or not motions:
        raise InvalidValueError(f"motions must be one or more records, pulses or pairs x and y, got {motions!r:.60}")
    return motions


def parts(motion: Any) -> tuple[Any, Any, Any]:
    """Return what moves the ground along x, across it and upwards."""
    checks.of_kind("motions", motion, (Mapping, Components, GroundMotion, Pulse), "records, pulses or pairs x and y")
    x, y, z = components_of(motion) if isinstance(motion, (Mapping, Components)) else (motion, None, None)
    if x is None:
        raise InvalidValueError("a motion of components has one along x, got none")
    if y is not None and not (isinstance(x, GroundMotion) and isinstance(y, GroundMotion)):
        raise InvalidValueError("two components are two records; sample the pulses first")
    return x, y, z
