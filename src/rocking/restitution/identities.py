"""Checks of a model and a body by identities of rigid-body mechanics."""

import math
import warnings
from dataclasses import dataclass

from rocking.bodies import Body, MassPoints
from rocking.bodies.frame import refuse_frame
from rocking.conventions import Foot, opposite
from rocking.errors import PlausibilityWarning
from rocking.restitution._implied import implied
from rocking.restitution._model import RestitutionModel

_EXACT = 1e-9
# relative distance of nearly coincident feet; errors of correct models are below its square root
_NEARLY_COINCIDENT = 1e-6
_STATEMENTS = {
    "scale": "the coefficient does not depend on size",
    "density": "the coefficient does not depend on density",
    "mirror": "the mirror image has the same coefficient",
    "coincident pivots": "with coincident feet there is no impact and no energy loss",
    "inertia alone": "bodies with the same mass, centre, inertia and base have the same coefficient",
    "energy bound": "the impact creates no energy, r^2 I_O' <= I_O",
    "round trip": "an impact onto each foot creates no energy, r r' <= 1",
    "impulse on the base": "the implied impulse acts on the base, k <= 1",
}


@dataclass(frozen=True, slots=True)
class IdentityCheck:
    """Check of one identity for one model and one body.

    Parameters
    ----------
    name : str
        Short name, such as ``"coincident pivots"``.
    statement : str
        The identity as a sentence.
    expected : float
        Value required by the identity [-].
    computed : float
        Value of the model with the largest difference [-].
    holds : bool
        True if the identity holds.
    """

    name: str
    statement: str
    expected: float
    computed: float
    holds: bool

    @property
    def sentence(self) -> str:
        """Result of the check as a sentence."""
        if self.holds:
            return f"{self.name}: holds"
        numbers = f"expected {self.expected:.6g}, got {self.computed:.6g}"
        return f"{self.name}: violated for this body ({self.statement}; {numbers})"


def identity_report(body: Body, model: RestitutionModel, *, foot: Foot = "right") -> tuple[IdentityCheck, ...]:
    """Return the checks of all identities for a model and a body.

    Parameters
    ----------
    body : Body
        The body.
    model : RestitutionModel
        The model.
    foot : {"left", "right"}
        The foot on which the body lands.

    Returns
    -------
    tuple of IdentityCheck
        Checks: scale, density, mirror, coincident pivots, inertia alone, energy bound, round trip, impulse on the base.

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
        # no warnings for modified bodies (larger, lighter, or with nearly coincident feet)
        warnings.simplefilter("ignore", PlausibilityWarning)
        r, r_back = model.coefficient(body, foot), model.coefficient(body, opposite(foot))
        others = {
            "scale": model.coefficient(body.scaled(size=3.7), foot),
            "density": model.coefficient(body.scaled(density=3.7), foot),
            "mirror": model.coefficient(body.mirrored(), opposite(foot)),
            "coincident pivots": model.coefficient(body.with_feet(x - gap, x + gap), foot),
            "inertia alone": max(
                (model.coefficient(twin, foot) for twin in _dumbbells(body)), key=lambda value: abs(value - r)
            ),
        }
    implication = implied(body, r, foot=foot)
    bounds = {
        "energy bound": (implication.largest_coefficient, r, implication.within_energy),
        "round trip": (1.0, r * r_back, r * r_back <= 1.0 + _EXACT),  # Eq. 113
        "impulse on the base": (1.0, implication.impulse_ratio, implication.within_base),
    }
    checks = []
    for name, statement in _STATEMENTS.items():
        if name in bounds:
            expected, actual, holds = bounds[name]
        else:
            pivots = name == "coincident pivots"
            expected, actual = 1.0 if pivots else r, others[name]
            holds = abs(actual - expected) <= (math.sqrt(_NEARLY_COINCIDENT) if pivots else _EXACT)
        checks.append(IdentityCheck(name, statement, expected, actual, holds))
    return tuple(checks)


def _dumbbells(body: Body) -> list[MassPoints]:
    """Return mass pairs with mass, centre of mass and polar inertia of the body: horizontal, if possible vertical."""
    refuse_frame(body)
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
