"""What a contact point is made of: a force for a depth, its speed and its past."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from rocking.conventions import FloatArray


class LawKind(IntEnum):
    """The branches of the fast engine."""

    KELVIN_VOIGT = 0
    HUNT_CROSSLEY = 1
    PLASTIC = 2


@dataclass(frozen=True, slots=True)
class LawNumbers:
    """A law as both engines take it, after the mass of the body is known."""

    kind: LawKind  # branch of the equations
    stiffness: float  # of one copy of the law [N/m, or N/m^exponent]
    damping: float = 0.0  # kelvin-Voigt dashpot [N s/m]
    exponent: float = 1.0  # power of the depth [-]
    viscosity: float = 0.0  # hunt-Crossley chi [s/m]
    rebound: float = 1.0  # velocity ratio of plastic unloading [-]


class ContactLaw(ABC):
    """Normal force of a contact point; it never pulls.

    A contact point stands on `share` copies of the law: forces, stiffness and damping are proportional to it.
    """

    @abstractmethod
    def numbers(self, mass: float) -> LawNumbers:
        """Return the law's numbers under a body.

        Parameters
        ----------
        mass : float
            Mass of the body, which a damping ratio refers to [kg].

        Returns
        -------
        LawNumbers
            Stiffness, damping and the rest in SI.
        """

    @property
    @abstractmethod
    def label(self) -> str:
        """The law with its parameters, in one line."""


def force(law: LawNumbers, depth: FloatArray, speed: FloatArray, deepest: FloatArray) -> FloatArray:
    """Return the force of one copy of a law, written without its branches.

    Kelvin-Voigt ``F = max(0, k d + c d')``, Hunt-Crossley ``F = k d^n max(0, 1 + chi d')``, plastic unloading ``F =
    max(0, min(k d, k / e^2 (d - d_p)))`` with the set ``d_p = (1 - e^2) d_max``; zero for d <= 0. docs/theory.md,
    Section 13; Walton and Braun (1986) for the unloading branch.

    depth: depths d of the points [m]; speed: their rates d', positive while they sink [m/s]; deepest: greatest depths
    so far; only plastic unloading remembers them [m]. Returns forces on the body, upwards [N].
    """
    pressed = np.maximum(depth, 0.0)
    if law.kind is LawKind.KELVIN_VOIGT:
        value = law.stiffness * depth + law.damping * speed  # Eq. 117
    elif law.kind is LawKind.HUNT_CROSSLEY:
        value = law.stiffness * pressed**law.exponent * (1.0 + law.viscosity * speed)  # Eq. 118
    else:
        value = law.stiffness * depth
        if law.rebound > 0.0:
            square = law.rebound**2
            unloading = law.stiffness / square * (depth - (1.0 - square) * deepest)  # Eq. 120
            value = np.where(depth < deepest, np.minimum(value, unloading), value)
        else:
            value = np.where((depth >= deepest) & (speed > 0.0), value, 0.0)
    return np.where(depth > 0.0, np.maximum(value, 0.0), 0.0)


def stored(law: LawNumbers, depth: FloatArray, deepest: FloatArray) -> FloatArray:
    """Return the elastic energy of one copy of a law.

    depth: depths of the points [m]; deepest: greatest depths so far [m]. Returns energy that unloading would return
    [J].
    """
    pressed = np.maximum(depth, 0.0)
    if law.kind is LawKind.PLASTIC:
        if law.rebound == 0.0:
            return np.zeros_like(pressed)
        value = force(law, depth, np.zeros_like(depth), np.maximum(deepest, depth))
        return np.asarray(0.5 * value**2 * law.rebound**2 / law.stiffness)  # Eq. 121
    return np.asarray(law.stiffness * pressed ** (law.exponent + 1.0) / (law.exponent + 1.0))  # Eq. 121


def depth_under(law: LawNumbers, load: float) -> float:
    """Return how deep a static load presses one copy of a law.

    load: force on it [N]. Returns Depth; zero for a law without stiffness [m].
    """
    if law.stiffness == 0.0:
        return 0.0
    return float((max(load, 0.0) / law.stiffness) ** (1.0 / law.exponent))


def depth_absorbing(law: LawNumbers, copies: float, energy: float, speed: float) -> float:
    """Return how deep the law goes to take up an energy at a steady speed: the scale of depths of an impact.

    copies: copies of it that work side by side [-]; energy: energy of the impact [J]; speed: landing speed [m/s].
    Returns depth [m].
    """
    order = law.exponent + 1.0
    candidates = []
    if law.stiffness > 0.0:
        candidates.append(float((order * energy / (copies * law.stiffness)) ** (1.0 / order)))
    if law.damping > 0.0:
        candidates.append(energy / (copies * law.damping * speed))
    return min(candidates)
