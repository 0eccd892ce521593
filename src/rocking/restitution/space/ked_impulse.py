"""KED in space: the impulse acts where the paper's energy balance has it for a landing of the whole base."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid import Solid
from rocking.conventions import FloatArray
from rocking.portable import applied, dot
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.impulse_position import impulse_position
from rocking.restitution.space.model import SpatialFlag, SpatialModel

_ROUNDING = 1e-12


@dataclass(frozen=True)
class SpatialKed(SpatialModel):
    """Kinetic energy distribution with a place for its impulse: steps of any size, from any pivot to any other.

    Of the paper is what a landing of the whole base costs, and with that where its impulse acts: k of the half distance
    between the feet (`ImpulsePosition`), cut at 1, the new foot, beyond which the ground would have to pull. That k,
    not the coefficient, is taken over to a step from any pivot P to any pivot Q: the impulse acts at
    ``X = (P + Q)/2 + k (Q - P)/2``, and angular momentum about X is kept,
    ``I_C w+ + m rho_X x (w+ x rho_Q) = I_C w- + m rho_X x (w- x rho_P)``; about an edge its component along the edge.
    A rectangle that lands on its edge has the paper's coefficient, no step costs nothing, n small steps cost 1/n of a
    large one, and a rim rolls without loss.

    This closure is this project's own, not the paper's.
    """

    name = "ked-3d"
    title = "momentum about the point where the paper's energy balance puts the impulse (this project's closure)"
    reference = "Mao, Deng, Shen & Wang 2024, doi:10.3390/buildings14072119, closed by momentum in this project"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "a landing of the whole base costs what the paper says, by one impulse between the old foot and the new one",
        "a smaller step has its impulse at the same share of the way, that of the direction of the step in the body "
        "that stands upright",
        "beyond the new foot, or where it would have to pull, the impulse acts at the new foot (Housner's)",
    )
    needs_solid = True
    domain = (
        "every impact on one corner or edge, in any attitude; the paper publishes homogeneous rectangles in the plane"
    )
    known_defects = (
        "of a landing of the whole base all defects of KED in the plane; on feet so narrow that k exceeds 1 the "
        "paper's coefficient is not reached, and said so",
        "that the share of the way is the same for small steps and large ones is assumed, and so is that the lean at "
        "the landing does not matter",
        "very squat bodies (k below 0.3) would gain energy in rare steps; the velocity is then cut at the energy",
        "onto an edge through the old pivot, and onto the whole base, it is Housner's impact",
    )

    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        """Keep the angular momentum about the impulse's point; about an edge, its component along a parallel line."""
        step, axis = _step(impact), impact.edge
        k = min(_position(impact.solid, step), 1.0)
        made = _kept(impact, step, k)
        if k < 1.0 and _push(impact, made) < 0.0:
            made = _kept(impact, step, 1.0)
        after = 0.5 * dot(made, applied(impact.inertia, made))
        if after > impact.energy:
            made = made * math.sqrt(impact.energy / after)
        return made if axis is None else dot(made, axis) * axis

    def flags(self, impact: SpatialImpact, velocity: FloatArray) -> tuple[SpatialFlag, ...]:
        """Return whether k was cut, and whether the ground would have to pull."""
        scale = impact.moments.mass * impact.speed * float(np.abs(impact.moments.centre).max())
        pulls = _push(impact, velocity) < -_ROUNDING * scale
        return (SpatialFlag.CUT,) * self.cut(impact.solid, _step(impact)) + (SpatialFlag.PULLS,) * pulls

    def cut(self, solid: Solid, step: FloatArray) -> bool:
        """Return whether k of a step was cut: the base is too narrow in this direction for the paper's loss.

        Parameters
        ----------
        solid : Solid
            The body.
        step : ndarray, shape (3,)
            From the old pivot to the new one, in the solid's axes [m].

        Returns
        -------
        bool
            True if the impulse is taken at the new foot although the model would have it beyond.
        """
        return _position(solid, step) > 1.0 + _ROUNDING


def _step(impact: SpatialImpact) -> FloatArray:
    """From the old pivot to the landing point, or across the edge."""
    step = impact.onto.point - impact.pivot
    return step if impact.edge is None else step - dot(step, impact.edge) * impact.edge


def _position(solid: Solid, step: FloatArray) -> float:
    """Position k of a step, not cut; 1 where there is no step."""
    if not float(np.abs(step).max()) > _ROUNDING * solid.size:
        return 1.0
    return impulse_position(solid).at(step)


def _kept(impact: SpatialImpact, step: FloatArray, k: float) -> FloatArray:
    """Velocity with the angular momentum about X, which lies behind the landing point by (1 - k)/2 of the step."""
    arm, back = impact.moments.centre, 0.5 * (1.0 - k) * impact.moments.mass * step
    momentum = impact.angular_momentum + _cross(back, _centre_velocity(impact))
    inertia = impact.inertia + dot(back, arm) * np.eye(3) - arm[:, None] * back  # Eq. 103
    if impact.edge is not None:
        return impact.edge * (dot(impact.edge, momentum) / dot(impact.edge, applied(inertia, impact.edge)))
    # Cramer's rule, since this matrix is not symmetric: the same on every processor
    a, b, c = inertia.T
    volume = dot(a, _cross(b, c))
    return np.array([dot(momentum, _cross(*pair)) for pair in ((b, c), (c, a), (a, b))]) / volume  # Eq. 103


def _centre_velocity(impact: SpatialImpact) -> FloatArray:
    return _cross(impact.velocity, impact.moments.centre + impact.onto.point - impact.pivot)


def _push(impact: SpatialImpact, velocity: FloatArray) -> float:
    """Vertical impulse of the ground [N s]."""
    change = _cross(velocity, impact.moments.centre) - _centre_velocity(impact)
    return impact.moments.mass * dot(impact.up, change)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    x, y, z = a.tolist()
    u, v, w = b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
