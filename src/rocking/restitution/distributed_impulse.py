"""Distributed impulse: contact pressure is proportional to the downward speed to the power q, over the base."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.portable import dot, each, gauss_legendre
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry, contact_of, is_whole_base

_NODES, _WEIGHTS = gauss_legendre(60)


@dataclass(frozen=True)
class DistributedImpulse(InertiaModel):
    """Flat base that lands one point after another. The pressure is ~ (downward speed)^q as long as a point descends.

    The model is ``r = exp(-Int kappa s_c / (1 + kappa s_c sigma) d(sigma))`` over the base. Here sigma is the point
    that has just stopped descending, s_c(sigma) is the centre of the pressure ahead of this point, and kappa = m / (I_C
    + m h^2). The result is a closed form for contact of the full base, and a quadrature for separate contact areas.

    Parameters
    ----------
    q : float
        Exponent [-]: 0 rigid-plastic pressure, 1 viscous interface, infinity Housner.

    Raises
    ------
    InvalidValueError
        If q is negative or not finite.

    Examples
    --------
    >>> from rocking import Block
    >>> round(DistributedImpulse(q=1.0).coefficient(Block(width=1.0, height=2.0)), 12)
    0.796535422516
    """

    q: float = 1.0

    name = "distributed-impulse"
    short_name = "distributed impulse"
    colour, linestyle = "#008FE6", (0, (5, 1, 1, 1, 1, 1))
    legend = "distributed, q = 1"
    title = "contact pressure over the flat base follows the downward speed to the power q"
    reference = "derived in this project (theory, Distributed impulse); no publication yet"
    assumptions = (
        "flat base, sticking, instantaneous impact",
        "contact without tension or rebound: pressure only while a point descends",
    )
    domain = "bodies and q >= 0 for which the base behind the contact rises; otherwise the body stops: r = 0"
    known_defects = ("q is an interface property that must be chosen or fitted",)
    inertia_only = True
    trials = ("", "q=0", "q=0.5", "q=4")

    def __post_init__(self) -> None:
        checks.within("q", self.q, 0.0, 1e6, hint="for larger q use Housner's model")

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the closed form for a base in contact from foot to foot [-]."""
        return distributed(geometry, np.asarray(self.q))

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        """Return the closed form for contact of the full base, otherwise the quadrature over the contact areas [-]."""
        geometry = ImpactGeometry.of_body(body, foot)
        patches = contact_of(body, foot)
        if is_whole_base(patches, geometry):
            return float(self.of_geometry(geometry))
        return self._by_quadrature(patches, geometry)

    def _by_quadrature(self, patches: FloatArray, geometry: ImpactGeometry) -> float:
        start, end = -float(geometry.old_lever), float(geometry.new_lever)
        kappa = 1.0 / float(geometry.base_gyration)
        cuts = np.unique(np.concatenate([[start, end], patches.ravel()]))
        exponent = 0.0
        for a, b in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
            # a quintic change of variable removes the fractional powers at the ends of a patch
            t = 0.5 * (1.0 + _NODES)
            sigma = a + (b - a) * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
            slope = 0.5 * (b - a) * 30.0 * t * t * (1.0 - t) ** 2
            arm = kappa * _centre_ahead(sigma, patches, end, self.q)
            behind = 1.0 + arm * sigma
            if behind.min() <= 0.0:
                return 0.0
            exponent += dot(_WEIGHTS, slope * arm / behind)  # Eq. 11
        return math.exp(-exponent)


def distributed(geometry: ImpactGeometry, q: FloatArray) -> FloatArray:
    """Return the coefficients of bases in contact from foot to foot, for broadcast arrays of exponents [-]."""
    start, end = -geometry.old_lever, geometry.new_lever
    c = 1.0 / (geometry.base_gyration * (q + 2.0))
    e = c * (q + 1.0) * end
    lowest = np.clip(-0.5 * (q + 1.0) * end, start, end)
    # D = 1 + kappa s_c sigma > 0, because the stopped points rise
    leaves = 1.0 + e * lowest + c * lowest**2 > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (1.0 + e * end + c * end**2) / (1.0 + e * start + c * start**2)
        exponent = 0.5 * np.log(ratio) + 0.5 * e * _inverse_quadratic(c, e, start, end)  # Eq. 12
    return np.where(leaves, np.exp(-np.where(leaves, exponent, np.inf)), 0.0)


def _centre_ahead(sigma: FloatArray, patches: FloatArray, end: float, q: float) -> FloatArray:
    force, moment = np.zeros_like(sigma), np.zeros_like(sigma)
    # distances are divided by the largest distance, so that powers do not overflow or depend on the unit
    reach = np.maximum(patches[-1, 1] - sigma, 0.0) if patches.size else np.zeros_like(sigma)
    ahead = reach > 0.0
    scale = np.where(ahead, reach, 1.0)
    for a, b in patches.tolist():
        near, far = np.maximum(a - sigma, 0.0) / scale, np.maximum(b - sigma, 0.0) / scale
        force += _power_difference(near, far, q + 1.0)
        moment += _power_difference(near, far, q + 2.0)
    # without a flat segment ahead, the impulse acts at the foot
    centre = np.divide(moment, force, out=np.zeros_like(sigma), where=force > 0.0)
    return np.where(force > 0.0, sigma + reach * centre, end)  # Eq. 111


def _power_difference(near: FloatArray, far: FloatArray, power: float) -> FloatArray:
    """Return (far^power - near^power) / power, without cancellation for narrow segments."""
    ratio = np.divide(near, far, out=np.ones_like(far), where=far > 0.0)
    with np.errstate(divide="ignore"):
        return np.asarray(-(far**power) * np.expm1(power * np.log(ratio)) / power)


def _inverse_quadratic(c: FloatArray, e: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    # Int d(sigma) / (1 + e sigma + c sigma^2), one expression for both signs of the discriminant
    delta = 4.0 * c - e * e
    x0, x1 = 2.0 * c * start + e, 2.0 * c * end + e
    below = delta + x0 * x1
    root = np.sqrt(np.abs(delta))
    tangent = root * (x1 - x0) / below
    near = np.abs(tangent) < 1e-3
    z = np.where(near, np.sign(delta) * tangent * tangent, 0.0)
    series = 2.0 * (x1 - x0) / below * (1.0 - z / 3.0 + z * z / 5.0)
    trigonometric = each(math.atan2, root * (x1 - x0), below)
    hyperbolic = np.arctanh(np.clip(tangent, -1.0, 1.0))
    far = 2.0 / np.where(root > 0.0, root, 1.0) * np.where(delta > 0.0, trigonometric, hyperbolic)
    return np.where(near & (below > 0.0), series, far)
