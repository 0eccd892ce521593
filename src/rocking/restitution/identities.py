"""Which identities of rigid-body mechanics a model keeps for a given body, and which it breaks."""

import math
import warnings
from dataclasses import dataclass

from rocking.bodies import Body, MassPoints
from rocking.conventions import Foot, opposite
from rocking.errors import PlausibilityWarning
from rocking.restitution._implied import implied
from rocking.restitution._model import RestitutionModel

_EXACT = 1e-9
# Feet this far apart, relative to the base, stand for coincident ones; sound models are then within its square root.
_NEARLY_COINCIDENT = 1e-6
_STATEMENTS = {
    "scale": "the coefficient does not depend on size",
    "density": "the coefficient does not depend on density",
    "mirror": "the mirror image has the same coefficient",
    "coincident pivots": "with both feet in one place there is no impact and nothing is lost",
    "inertia alone": "bodies with the same mass, centre, inertia and base have the same coefficient",
    "energy bound": "the impact creates no energy, r^2 I_O' <= I_O",
    "round trip": "an impact onto each foot gains nothing, r r' <= 1",
    "impulse on the base": "the implied impulse acts on the base, k <= 1",
}


@dataclass(frozen=True, slots=True)
class IdentityCheck:
    """One identity, tried on one model and one body.

    Parameters
    ----------
    name : str
        Short name, such as ``"coincident pivots"``.
    statement : str
        What should hold.
    expected : float
        The value that the identity asks for [-].
    found : float
        The value furthest from it that the model gave [-].
    holds : bool
        Whether the identity holds.
    """

    name: str
    statement: str
    expected: float
    found: float
    holds: bool

    @property
    def sentence(self) -> str:
        """The verdict as a user reads it."""
        if self.holds:
            return f"{self.name}: holds"
        numbers = f"expected {self.expected:.6g}, got {self.found:.6g}"
        return f"{self.name}: violated for this body ({self.statement}; {numbers})"


def identity_report(body: Body, model: RestitutionModel, *, onto: Foot = "right") -> tuple[IdentityCheck, ...]:
    """Try every identity on a model and a body.

    Parameters
    ----------
    body : Body
        The body.
    model : RestitutionModel
        The model.
    onto : {"left", "right"}
        The foot on which it lands.

    Returns
    -------
    tuple of IdentityCheck
        Scale, density, mirror, coincident pivots, inertia alone, energy bound, round trip, impulse on the base.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution import Ked
    >>> report = identity_report(Block(width=1.0, height=2.0), Ked())
    >>> [check.name for check in report if not check.holds]
    ['coincident pivots', 'inertia alone']
    """
    (left, right), x = body.feet, body.centre[0]
    gap = 0.5 * _NEARLY_COINCIDENT * (right - left)
    with warnings.catch_warnings():
        # bodies that are only tried: grown, lighter, with both feet almost at one place
        warnings.simplefilter("ignore", PlausibilityWarning)
        here, back = model.coefficient(body, onto), model.coefficient(body, opposite(onto))
        others = {
            "scale": model.coefficient(body.scaled(size=3.7), onto),
            "density": model.coefficient(body.scaled(density=3.7), onto),
            "mirror": model.coefficient(body.mirrored(), opposite(onto)),
            "coincident pivots": model.coefficient(body.with_feet(x - gap, x + gap), onto),
            "inertia alone": max(
                (model.coefficient(twin, onto) for twin in _dumbbells(body)), key=lambda value: abs(value - here)
            ),
        }
    means = implied(body, here, onto=onto)
    bounds = {
        "energy bound": (means.largest_coefficient, here, means.within_energy),
        "round trip": (1.0, here * back, here * back <= 1.0 + _EXACT),  # Eq. 113
        "impulse on the base": (1.0, means.impulse_ratio, means.within_base),
    }
    checks = []
    for name, statement in _STATEMENTS.items():
        if name in bounds:
            expected, found, holds = bounds[name]
        else:
            pivots = name == "coincident pivots"
            expected, found = 1.0 if pivots else here, others[name]
            holds = abs(found - expected) <= (math.sqrt(_NEARLY_COINCIDENT) if pivots else _EXACT)
        checks.append(IdentityCheck(name, statement, expected, found, holds))
    return tuple(checks)


def _dumbbells(body: Body) -> list[MassPoints]:
    """Two equal masses with the body's mass, centre and polar inertia: lying, and standing if it fits."""
    moments = body.local_moments
    arm = math.sqrt(moments.polar / moments.mass)
    arms = [(arm, 0.0)] + ([(0.0, arm)] if arm <= moments.y else [])
    return [
        MassPoints(
            [(moments.x - dx, moments.y - dy), (moments.x + dx, moments.y + dy)],
            [0.5 * moments.mass] * 2,
            feet=body.local_feet,
            contact=body.local_contact,
        )
        for dx, dy in arms
    ]
