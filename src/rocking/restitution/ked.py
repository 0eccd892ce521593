"""KED, the kinetic energy distribution model of Mao, Deng, Shen & Wang (2024): the paper."""

from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from rocking.bodies import Block, Body, MassPoints, Section
from rocking.conventions import FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.restitution import ked_integrals
from rocking.restitution.model import RestitutionModel


@dataclass(frozen=True)
class Ked(RestitutionModel):
    """Kinetic energy distribution over the mass points, for any plane body.

    ``r^2 = Int y^4 / (y^2 + (x_new - x)^2) dm / Int (y^2 + (x_new - x)^2) dm`` (Eq. 17, Mao et al. 2024):
    stage 1 removes the vertical velocity of every mass point, stage 2 the part along the line to the new foot,
    stage 3 hands the kinetic energy that is left to the rotation about the new foot.

    Examples
    --------
    >>> from rocking import Block
    >>> round(Ked().coefficient(Block(width=1.0, height=2.0)), 12)
    0.830309150037
    """

    name = "ked"
    can_stop = False
    short_name = "KED"
    colour, linestyle = "#D55E00", "-"
    title = "kinetic energy distribution over the mass points (the paper)"
    reference = "Mao, Deng, Shen & Wang 2024, Buildings 14(7) 2119, doi:10.3390/buildings14072119"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "the vertical velocity of every mass point is lost, then its part along the line to the new foot",
        "the kinetic energy that is left becomes rotation about the new foot without further loss",
    )
    domain = "published for homogeneous rectangles, extended here to any plane body: 0 < r < 1 always"
    known_defects = (
        "angular momentum about the new foot is exact if the impulse acts there; the paper's objection to it is not "
        "sound (gravity is not impulsive), and what is really open is where the impulse acts",
        "implies an impulse inside the base with no force model that produces it",
        "stage 3 turns a velocity field that is not rigid into a rigid one without loss, which rigid bodies cannot",
        "not a function of mass, centre, inertia and feet: bodies with the same dynamics get different values",
        "ignores the old foot: with coincident feet (no impact at all) it still loses energy",
        "not Galilean invariant: velocities must be taken relative to the ground",
        "the mass effect it is said to capture is explained as simply by an additive loss at the interface",
        "a high correlation is no evidence for it: Housner's is as high on the same data",
    )

    def raw_coefficient(self, body: Body, onto: Foot) -> float:
        """Eq. 17, Mao et al. 2024, over the body's mass distribution."""
        if isinstance(body, Block):
            return float(self.raw_of_slenderness(np.array([body.slenderness_ratio]))[0])
        # Eq. 6; Eq. 17, Mao et al. 2024
        return float(np.sqrt(projected_moment(body, onto) / body.side(onto).moment_of_inertia))

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Eq. 17 for homogeneous rectangles, in closed form."""
        out = np.empty(np.shape(slenderness))
        ked_integrals.fill_rectangles(slenderness, float(np.min(slenderness, initial=1.0)), out)
        return out

    def _fill(self, slenderness: FloatArray, least: float, out: FloatArray) -> None:
        ked_integrals.fill_rectangles(slenderness, least, out)


@singledispatch
def projected_moment(body: Body, onto: Foot) -> float:
    """Return the numerator of Eq. 17, the integral of y^4 / |S - O'|^2 dm.

    A new kind of body registers its own way: ``@projected_moment.register``.

    Parameters
    ----------
    body : Body
        The body.
    onto : {"left", "right"}
        The new foot O'.

    Returns
    -------
    float
        Twice the kinetic energy after stage 2 over the square of the angular velocity before [kg m2].

    Raises
    ------
    InvalidValueError
        If this kind of body is not known.
    """
    raise InvalidValueError(f"model ked does not know how mass is distributed in a {type(body).__name__}")


@projected_moment.register
def _(body: Block, onto: Foot) -> float:
    return Ked().raw_coefficient(body, onto) ** 2 * body.side(onto).moment_of_inertia


@projected_moment.register
def _(body: Section, onto: Foot) -> float:
    foot = np.array([body.local_feet[onto == "right"], 0.0])
    return body.depth * sum(
        region.density * ked_integrals.ring_integral(ring - foot) for region in body.regions for ring in region.rings
    )


@projected_moment.register
def _(body: MassPoints, onto: Foot) -> float:
    x, y = (body.points - np.array([body.local_feet[onto == "right"], 0.0])).T
    squared = x * x + y * y
    # a mass on the new foot itself has no velocity after the impact and contributes nothing
    ratio = np.divide(y**4, squared, out=np.zeros_like(y), where=squared > 0.0)  # Eq. 9
    return float((body.masses * ratio).sum())
