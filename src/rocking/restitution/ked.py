"""KED, the kinetic energy distribution model of Mao, Deng, Shen & Wang (2024), and the energy balance of Figure 2."""

import math
from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body, MassPoints, Section
from rocking.bodies.moments import quarters
from rocking.conventions import BoolArray, FloatArray, Foot, opposite
from rocking.errors import InvalidValueError
from rocking.portable import each, gauss_legendre
from rocking.restitution._model import RestitutionModel

# for smaller slenderness, the closed form loses more than two digits, so that the series is used
_SERIES_BELOW = 0.3
_SERIES = np.array([(-1.0) ** j / ((2 * j - 1) * (2 * j + 3)) for j in range(14, 0, -1)])
# Gauss-Legendre nodes for edges with a small difference of end angles, for which the closed form has cancellation
_NODES, _WEIGHTS = gauss_legendre(12)
_GAUSS_BEYOND = 5.0
_FEW = 256


def fill_rectangles(ratio: FloatArray, smallest: float, out: FloatArray) -> None:
    """Write the KED coefficients of homogeneous rectangles (Eq. 17, Mao et al. 2024, in closed form)."""
    # ``r^2 = N/D`` with ``N/B^4 = l^3/12 - l/4 + atan(l)/4 + (l^4/4) atan(1/l)`` and ``D/B^4 = l (1 + l^2)/3``.
    # ratio: slenderness ratios l = h/b > 0 [-]
    # smallest: a lower bound of the ratios [-]
    # out: r, with equal shape and a relative error below 3e-14 [-]
    # N/D in partial fractions with t = 1/l: r^2 = 1/4 + (3 pi t/8 - 1) / (1 + l^2) + 3/4 atan(t) (l - t)
    t = np.divide(1.0, ratio, out=np.empty(ratio.shape))
    np.subtract(ratio, t, out=out)
    # numpy's arctan is fast, but its last digit depends on the processor
    buffer = each(math.atan, t) if t.size <= _FEW else np.arctan(t, out=np.empty(ratio.shape))
    with np.errstate(over="ignore", invalid="ignore"):
        out *= buffer
        out *= 0.75
        np.multiply(ratio, ratio, out=buffer)
        buffer += 1.0
        t *= 0.375 * np.pi
        t -= 1.0
        t /= buffer
        out += t
        out += 0.25  # Eq. 7; Eq. 17, Mao et al. 2024
        np.sqrt(out, out=out)
    if smallest < _SERIES_BELOW:
        squat = ratio < _SERIES_BELOW
        out[squat] = _series(ratio[squat])


def _series(t: FloatArray) -> FloatArray:
    # N/B^4 = pi l^4/8 - l^5/5 + l^7/21 - l^9/45 + ...
    t2 = t * t
    return np.sqrt(3.0 * t * t2 * (np.pi / 8.0 + np.polyval(_SERIES, t2) * t) / (1.0 + t2))  # Eq. 7


def ring_integral(ring: FloatArray) -> float:
    """Return the exact integral of y^4 / (x^2 + y^2) over the area inside a ring [m4]."""
    # by Green's theorem, this is a quarter of the integral of y^4 d(phi) along the boundary, phi the polar angle, with
    # an elementary integral for every straight edge
    return 0.25 * float(edge_integrals(ring, np.roll(ring, -1, axis=0)).sum())  # Eq. 8


def edge_integrals(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the integrals of y^4 d(phi) along straight edges, where phi is the polar angle; shape (n,)."""
    length = np.sqrt(np.square(end - start).sum(axis=1))
    tau = (end - start) / np.maximum(length, 1e-300)[:, None]
    offset = tau[:, 1] * start[:, 0] - tau[:, 0] * start[:, 1]
    u0, u1 = (tau * start).sum(axis=1), (tau * end).sum(axis=1)
    radial = np.abs(offset) <= 1e-300
    smooth = ~radial & _is_smooth(offset, u0, u1)
    sharp = ~(radial | smooth)
    integrals = np.zeros(len(start))
    integrals[smooth] = _by_gauss(*(values[smooth] for values in (start[:, 1], end[:, 1], offset, u0, u1)))
    integrals[sharp] = _by_formula(*(values[sharp] for values in (tau[:, 0], tau[:, 1], offset, u0, u1)))
    return integrals


def _is_smooth(offset: FloatArray, u0: FloatArray, u1: FloatArray) -> BoolArray:
    # size of the Bernstein ellipse through the pole u = i * offset; the error of 12 nodes is its power -24
    z = (1j * np.abs(offset) - 0.5 * (u0 + u1)) / (0.5 * (u1 - u0))
    root = np.sqrt(z * z - 1.0)
    return np.maximum(np.abs(z + root), np.abs(z - root)) > _GAUSS_BEYOND


def _by_gauss(y0: FloatArray, y1: FloatArray, offset: FloatArray, u0: FloatArray, u1: FloatArray) -> FloatArray:
    fraction = 0.5 * (1.0 + _NODES)[:, None]
    y = y0 + (y1 - y0) * fraction
    u = u0 + (u1 - u0) * fraction
    integrand = (y * y) ** 2 * offset / (offset**2 + u**2)
    return np.asarray(0.5 * (u1 - u0) * (_WEIGHTS[:, None] * integrand).sum(axis=0))


def _by_formula(c_x: FloatArray, c: FloatArray, p: FloatArray, u0: FloatArray, u1: FloatArray) -> FloatArray:
    # y = s p + c u along the edge, with s = -tau_x and c = tau_y
    s, c2, s2, p2 = -c_x, c * c, c_x * c_x, p * p
    powers = (
        c2 * c2 * p * (u1 - u0) * (u0 * u0 + u0 * u1 + u1 * u1) / 3.0
        + 2.0 * c2 * c * s * p2 * (u1 - u0) * (u1 + u0)
        + (6.0 * c2 * s2 - c2 * c2) * p2 * p * (u1 - u0)
    )
    logs = 2.0 * c * s * (s2 - c2) * p2 * p2 * each(math.log, (p2 + u1 * u1) / (p2 + u0 * u0))
    turn = each(math.atan2, p * (u1 - u0), p2 + u0 * u1)
    angles = (s2 * s2 - 6.0 * c2 * s2 + c2 * c2) * p2 * p2 * turn
    return np.asarray(powers + logs + angles)  # Eq. 114


@dataclass(frozen=True)
class Ked(RestitutionModel):
    """Kinetic energy distribution over the mass points, for plane bodies.

    ``r^2 = Int y^4 / (y^2 + (x_new - x)^2) dm / Int (y^2 + (x_new - x)^2) dm`` (Eq. 17, Mao et al. 2024):
    stage 1 removes the vertical velocity of every mass point, stage 2 removes the component along the line to the new
    foot, and stage 3 converts the remaining kinetic energy to rotation about the new foot.

    Examples
    --------
    >>> from rocking import Block
    >>> round(Ked().coefficient(Block(width=1.0, height=2.0)), 12)
    0.830309150037
    """

    name = "ked"
    can_stop = sees_old_foot = False
    short_name = "KED"
    colour, linestyle = "#D96C00", "-"
    title = "kinetic energy distribution over the mass points (the paper)"
    reference = "Mao, Deng, Shen & Wang 2024, Buildings 14(7) 2119, doi:10.3390/buildings14072119"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "every mass point loses its vertical velocity, then its component along the line to the new foot",
        "the remaining kinetic energy becomes rotation about the new foot without further loss",
    )
    domain = "published for homogeneous rectangles, extended here to all plane bodies: 0 < r < 1 always"
    known_defects = (
        "angular momentum about the new foot is conserved if the impulse acts there; the paper's objection is "
        "not valid (gravity is not impulsive); the open question is the impulse position",
        "implies an impulse inside the base without a force model",
        "stage 3 converts a velocity field that is not rigid to a rigid one without loss, which is not physical",
        "not a function of mass, centre, inertia and feet: dynamically equal bodies have different values",
        "independent of the old foot: coincident feet (no impact) still have an energy loss",
        "not Galilean invariant: velocities must be relative to the ground",
        "an additive loss at the interface explains the mass effect equally well",
        "its high correlation is not evidence: that of Housner's model is equal on the same data",
    )

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        """Return r by Eq. 17 of Mao et al. (2024), over the mass distribution of the body [-]."""
        if isinstance(body, Block) and body.known is None and body.stands_on_corners:
            return float(self.raw_of_slenderness(np.array([body.slenderness_ratio]))[0])
        # Eq. 6; Eq. 17, Mao et al. 2024
        return float(np.sqrt(projected_moment(body, foot) / body.side(foot).moment_of_inertia))

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return r by Eq. 17 for homogeneous rectangles, in closed form [-]."""
        out = np.empty(np.shape(slenderness))
        fill_rectangles(slenderness, float(np.min(slenderness, initial=1.0)), out)
        return out

    def _fill(self, slenderness: FloatArray, smallest: float, out: FloatArray) -> None:
        fill_rectangles(slenderness, smallest, out)


@singledispatch
def projected_moment(body: Body, foot: Foot) -> float:
    """Return the numerator of Eq. 17, the integral of ``y^4 / |S - O'|^2 dm``.

    To support a new kind of body, register a function with ``@projected_moment.register``.

    Parameters
    ----------
    body : Body
        The body.
    foot : {"left", "right"}
        The new foot O'.

    Returns
    -------
    float
        Twice the kinetic energy after stage 2 / square of the angular velocity before [kg m2].

    Raises
    ------
    InvalidValueError
        If the kind of body is not registered.
    """
    raise InvalidValueError("model ked has no mass distribution for a {type}", type=type(body).__name__)


@projected_moment.register
def _(body: Block, foot: Foot) -> float:
    if body.known is not None:
        return _of_quarters(body, foot)
    if not body.stands_on_corners:
        return projected_moment(body.to_section(), foot)
    return Ked().raw_coefficient(body, foot) ** 2 * body.side(foot).moment_of_inertia


@projected_moment.register
def _(body: Section, foot: Foot) -> float:
    if body.known is not None:
        return _of_quarters(body, foot)
    pivot = np.array([body.local_feet[foot == "right"], 0.0])
    return body.depth * sum(
        region.density * ring_integral(ring - pivot) for region in body.regions for ring in region.rings
    )


@projected_moment.register
def _(body: MassPoints, foot: Foot) -> float:
    return _of_points(body.points - np.array([body.local_feet[foot == "right"], 0.0]), body.masses)


def _of_points(points: FloatArray, masses: FloatArray) -> float:
    """Return the sum over mass points relative to the new foot [kg m2]."""
    x, y = points.T
    squared = x * x + y * y
    # a mass at the new foot has no velocity after the impact, so that its contribution is zero
    ratio = np.divide(y**4, squared, out=np.zeros_like(y), where=squared > 0.0)  # Eq. 9
    return float((masses * ratio).sum())


def _of_quarters(body: Body, foot: Foot) -> float:
    """Return the projected moment of a body with stated moments, with masses in the quarters of its box [kg m2]."""
    pivot = np.array([body.local_feet[foot == "right"], 0.0])
    rings, corners, (inside, outside) = quarters(body.local_moments, body.local_box)
    areas = [abs(float(np.prod(ring[2] - ring[0]))) for ring in rings]
    integrals = [abs(ring_integral(ring - pivot)) for ring in rings]
    spread = sum(m / area * integral for m, area, integral in zip(inside, areas, integrals, strict=True))
    return float(spread) + _of_points(corners - pivot, outside)


STAGES = ("before", "stage 1", "stage 2", "after")
"""Stages: before impact, without vertical component, without component towards the new foot, redistributed."""


@dataclass(frozen=True, slots=True)
class EnergyBalance:
    """Kinetic energy of a body through the stages of KED (Fig. 2, Mao et al. 2024).

    Parameters
    ----------
    body : Body
        The body.
    foot : {"left", "right"}
        The foot on which the body lands.
    velocity_before, velocity_after : float
        Angular velocities about the old and about the new foot [rad/s].
    totals : dict of str to float
        Kinetic energy before, after stage 1, after stage 2 and after redistribution [J].

    Examples
    --------
    >>> from rocking import Block
    >>> balance = energy_balance(Block(width=1.0, height=2.0, density=1000.0))
    >>> [round(fraction, 6) for fraction in balance.fractions.values()]
    [1.0, 0.8, 0.689413, 0.689413]
    """

    body: Body
    foot: Foot
    velocity_before: float
    velocity_after: float
    totals: dict[str, float]

    @property
    def fractions(self) -> dict[str, float]:
        """Totals / energy before the impact, by stage [-]."""
        before = self.totals["before"]
        return {stage: energy / before for stage, energy in self.totals.items()}

    def velocities(self, x: FloatArray, y: FloatArray) -> dict[str, FloatArray]:
        """Return the velocities at points of the body after the stages.

        Parameters
        ----------
        x, y : ndarray
            Points in the user's coordinates, of equal shape [m].

        Returns
        -------
        dict of str to ndarray
            Velocities (v_x, v_y) by stage, with an additional last dimension of length 2 [m/s].
        """
        # a clockwise rotation leads to the right foot, a counter-clockwise rotation to the left foot
        sense = 1.0 if self.foot == "right" else -1.0
        feet = dict(zip(("left", "right"), self.body.feet, strict=True))
        up = np.asarray(y, dtype=np.float64) - self.body.ground
        from_old = np.asarray(x, dtype=np.float64) - feet[opposite(self.foot)]
        from_new = np.asarray(x, dtype=np.float64) - feet[self.foot]
        before, after = sense * self.velocity_before, sense * self.velocity_after
        squared = up**2 + from_new**2
        remaining = np.divide(up**2, squared, out=np.zeros_like(squared), where=squared > 0.0)
        return {
            "before": before * np.stack([up, -from_old], axis=-1),  # Eq. 6, Mao et al. 2024
            "stage 1": before * np.stack([up, np.zeros_like(up)], axis=-1),  # Eq. 7, Mao et al. 2024
            "stage 2": before * remaining[..., None] * np.stack([up, -from_new], axis=-1),  # Eqs. 8, 9, Mao et al. 2024
            "after": after * np.stack([up, -from_new], axis=-1),  # Eq. 12, Mao et al. 2024
        }

    def energy_density(self, x: FloatArray, y: FloatArray) -> dict[str, FloatArray]:
        """Return the kinetic energy per volume at points after the stages.

        Parameters
        ----------
        x, y : ndarray
            Points in the user's coordinates, of equal shape [m].

        Returns
        -------
        dict of str to ndarray
            Energy density by stage, zero outside the body [J/m3].
        """
        density = known_density(self.body, x, y)
        fields = self.velocities(x, y)
        return {stage: 0.5 * density * (field**2).sum(axis=-1) for stage, field in fields.items()}


def known_density(body: Body, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return `density_at` [kg/m3]. Raise an error for a body with stated moments."""
    if body.known is not None:
        raise InvalidValueError(
            "the energy field needs the distribution of mass, but this body has moments only; describe the body by "
            "regions with densities, without centre and moment_of_inertia"
        )
    return body.density_at(x, y)


def energy_balance(body: Body, *, foot: Foot = "right", angular_velocity: float = 1.0) -> EnergyBalance:
    """Return the energy balance of an impact under KED.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    foot : {"left", "right"}
        The foot on which the body lands.
    angular_velocity : float
        Angular velocity before the impact [rad/s].

    Returns
    -------
    EnergyBalance
        Totals, fractions, and fields over the body (Eqs. 6-17, Mao et al. 2024, doi:10.3390/buildings14072119).

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking import Block
    >>> round(energy_balance(Block(width=1.0, height=4.0)).velocity_after, 8)
    0.94736684
    """
    foot = checks.foot("foot", foot)
    speed = checks.positive("angular_velocity", angular_velocity, "rad/s")
    moments, half = body.local_moments, 0.5 * speed**2
    projected = projected_moment(body, foot)
    inertia = body.side(foot).moment_of_inertia
    totals = {
        "before": half * body.side(opposite(foot)).moment_of_inertia,
        "stage 1": half * (moments.yy + moments.mass * moments.y**2),
        "stage 2": half * projected,  # Eq. 11, Mao et al. 2024
    }
    after = speed * float(np.sqrt(projected / inertia))  # Eq. 16, Mao et al. 2024
    # Eq. 15, Mao et al. 2024
    return EnergyBalance(body, foot, speed, after, {**totals, "after": 0.5 * inertia * after**2})
