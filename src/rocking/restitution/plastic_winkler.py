"""Plastic Winkler bed: pressure is proportional to indentation as long as a point descends, and zero afterwards."""

import math
from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache
from operator import mul

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.errors import RockingError
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry, contact_of

_LARGEST_BATCH = 128
_DEGREE = 80
_REACH = float(np.log(100.0))


@dataclass(frozen=True)
class PlasticWinkler(InertiaModel):
    """Flat base on springs without rebound. The result does not depend on the stiffness of the springs.

    The pressure is k_w times the indentation as long as a point descends, and zero afterwards. The integration uses
    moments and no mesh along the base. The state is (v, omega, Y = Int v dt, Theta = Int omega dt).

    Examples
    --------
    >>> from rocking import Block
    >>> round(PlasticWinkler().coefficient(Block(width=1.0, height=2.0)), 8)
    0.81425939
    """

    name = "plastic-winkler"
    short_name = "plastic Winkler"
    colour, linestyle = "#AC5B2B", (0, (6, 2))
    title = "flat base on a bed of plastic springs without rebound"
    reference = "derived in this project (theory, Plastic Winkler bed); no publication yet"
    assumptions = (
        "flat base, sticking, impact much shorter than the motion",
        "the bed is uniform and has no rebound",
    )
    domain = "bodies for which the base behind the contact rises; otherwise the body stops: r = 0"
    known_defects = ("one pressure law for all interfaces: soft layers and rough contacts differ",)
    inertia_only = True

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the coefficients of bases in contact from foot to foot [-]."""
        lever = geometry.new_lever
        kappa, back = np.broadcast_arrays(lever**2 / geometry.base_gyration, geometry.old_lever / lever)
        flat = np.column_stack([kappa.ravel(), back.ravel()])
        different, inverse = np.unique(flat, axis=0, return_inverse=True)
        values = [_impact(k, b, (-b, 1.0)) for k, b in different.tolist()]
        return np.array(values)[inverse].reshape(kappa.shape)

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the coefficients of homogeneous rectangles [-]. For large arrays, they are interpolated."""
        logarithm = np.log(slenderness)
        inside = np.abs(logarithm) <= _REACH
        if len(set(slenderness.ravel().tolist())) <= _LARGEST_BATCH or not inside.all():
            return super().raw_of_slenderness(slenderness)
        return np.asarray(1.0 / (1.0 + np.exp(-_log_odds()(logarithm))))

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        """Return the coefficient of a body with the contact segments of its base [-]."""
        geometry = ImpactGeometry.of_body(body, foot)
        lever, back = float(geometry.new_lever), float(geometry.old_lever)
        edges = (contact_of(body, foot) / lever).ravel().tolist()
        return _impact(lever**2 / float(geometry.base_gyration), back / lever, tuple(edges))


@lru_cache(maxsize=4096)
def _impact(kappa: float, back: float, edges: tuple[float, ...]) -> float:
    """Return the velocity ratio, with kappa = m b_new^2 / (I_C + m h^2) [-]. Levers are divided by the new lever."""
    stretches = np.reshape(edges, (-1, 2))
    if float((stretches[:, 1] - stretches[:, 0]).sum()) <= 1e-9 * (1.0 + back):
        # for feet without area, the impulse acts at the new foot (Housner)
        return (1.0 - kappa * back) / (1.0 + kappa)  # Eq. 2
    end, velocity = land(kappa, back, stretches)
    # after the bed, the body turns about the end of the base and then steps onto the foot (Housner)
    return velocity * (1.0 + kappa * end) / (1.0 + kappa)  # Eq. 110


@lru_cache(maxsize=1)
def _log_odds() -> "np.polynomial.Chebyshev":
    # ln(r / (1 - r)) over ln(h/b) is smooth and linear at both ends, with r ~ (h/b)^2 and 1 - r ~ (h/b)^-2
    def odds(logarithm: FloatArray) -> FloatArray:
        r = PlasticWinkler().of_geometry(ImpactGeometry.of_slenderness(np.exp(logarithm)))
        return np.asarray(np.log(r / (1.0 - r)))

    return np.polynomial.Chebyshev.interpolate(odds, _DEGREE, domain=[-_REACH, _REACH])


# the contact ends exponentially; the computation ends at this ratio of the tip speed to its initial value
_AT_REST = 1e-14
_STOPPED = 1e-9
_ORDER = 20
_RELATIVE = 1e-16
_STEPS = 100_000

_State = tuple[float, ...]


def land(kappa: float, back: float, stretches: FloatArray) -> tuple[float, float]:
    """Return the end of the contact and the velocity after the bed. Levers are divided by the new lever."""
    # The state is (v, omega, Int v dt, Int omega dt). A point x of the base descends if omega x > v, with a pressure of
    # k_w times its indentation. The equations have a kink when the edge v / omega of the pressure passes an end of a
    # segment, at which the integration restarts.
    # The first result is the end of the base that leaves the bed last, or the foot if it is nearer, divided by the
    # lever of the new foot [-]. The second result is the ratio of angular velocities after and before, zero for a body
    # that stops [-].
    bed = _Bed(kappa, stretches)
    state: _State = (-back, 1.0, 0.0, 0.0)
    section, direction = bed.first_section(-back), 1
    while direction:
        state, direction = bed.follow(state, section)
        section += direction
    return bed.end, 0.0 if state[1] < _STOPPED else state[1]


class _Bed:
    """Force and moment of the springs, for the section of the base in which the pressure ends."""

    def __init__(self, kappa: float, stretches: FloatArray) -> None:
        self.stretches: list[list[float]] = stretches.tolist()
        self.edges = [edge for stretch in self.stretches for edge in stretch]
        self.end = min(self.edges[-1], 1.0)
        # the stiffness of the bed only scales time; this choice gives similar durations for all sizes
        self.push = 1.0 / sum(far - near for near, far in self.stretches)
        self.turn = -kappa * self.push

    def moments_beyond(self, section: int) -> _State:
        """Return length, first and second moment of the segments beyond a section."""
        full = self.stretches[(section + 1) // 2 :]
        return tuple(sum((far**n - near**n) / n for near, far in full) for n in (1, 2, 3))

    def first_section(self, edge: float) -> int:
        """Return the index of the base section that contains the initial end of the pressure zone."""
        section = bisect_right(self.edges, edge)
        if section == 0 or self.edges[section - 1] != edge:
            return section
        # the edge is the end of a segment: the first force determines which of the two adjacent sections follows
        length, first, second = self.moments_beyond(section - 1)
        falls = self.push * (first - edge * length) >= edge * self.turn * (second - edge * first)
        return section if falls else section - 1

    def follow(self, state: _State, section: int) -> tuple[_State, int]:
        """Return the state at the end of a section or of the contact, and the direction of the next section."""
        ends = [(self.edges[section], 1)] if section < len(self.edges) - 1 else []
        if section > 0:
            ends.append((self.edges[section - 1], -1))
        for _ in range(_STEPS):
            series = self._series(state, section)
            step = _step(series)
            state = v, omega, *_ = _at(series, step)
            for edge, sign in ends:
                if sign * (v - edge * omega) > 0.0:
                    passing = _at_edge(series, step, edge, sign)
                    return passing, sign if passing[1] >= _STOPPED else 0  # 0 for a body that stops
            if omega < _STOPPED or self.end * omega - v <= _AT_REST:
                return state, 0
        raise RockingError("the landing on a bed of plastic springs did not end within {steps} steps", steps=_STEPS)

    def _series(self, state: _State, section: int) -> list[list[float]]:
        """Return the Taylor coefficients of v, omega and their integrals, for a pressure that ends in a section."""
        length, first, second = self.moments_beyond(section)
        v, omega, y, theta = series = [[value] for value in state]
        edge: list[float] = []
        square: list[float] = []
        cube: list[float] = []
        inside = section % 2 == 1
        end = self.edges[section] if inside else 0.0  # zero if the pressure ends between two segments
        reach, lever, inertia = [length + end], [first + 0.5 * end * end], [second + end**3 / 3.0]
        for k in range(_ORDER):
            if k:
                for moment in (reach, lever, inertia):
                    moment.append(0.0)
            if inside:
                edge.append((v[k] - _product(omega[1:], edge)) / omega[0])
                square.append(_product(edge, edge))
                cube.append(_product(edge, square))
                reach[k] -= edge[k]
                lever[k] -= 0.5 * square[k]
                inertia[k] -= cube[k] / 3.0
            v.append(self.push * (_product(theta, lever) - _product(y, reach)) / (k + 1))  # Eq. 13
            omega.append(self.turn * (_product(theta, inertia) - _product(y, lever)) / (k + 1))  # Eq. 13
            y.append(v[k] / (k + 1))
            theta.append(omega[k] / (k + 1))
        return series


def _at_edge(series: list[list[float]], step: float, edge: float, sign: int) -> _State:
    """Return the state at an edge that the pressure passed in a step, by bisection to the last bit."""
    start, stop = 0.0, step
    while start < (middle := 0.5 * (start + stop)) < stop:
        v, omega, *_ = _at(series, middle)
        passed = sign * (v - edge * omega) > 0.0
        start, stop = (start, middle) if passed else (middle, stop)
    return _at(series, start)


def _product(left: list[float], right: list[float]) -> float:
    """Return the last coefficient of the product of two series."""
    return float(sum(map(mul, left, reversed(right))))


def _step(series: list[list[float]]) -> float:
    """Return the range of the series in which the last two terms are below the rounding of the state."""
    v, omega = series[0][0], series[1][0]
    bound = _RELATIVE * max(abs(v), abs(omega))
    last, before = (max(abs(terms[-k]) for terms in series) + 1e-300 for k in (1, 2))
    return min(math.pow(bound / last, 1.0 / _ORDER), math.pow(bound / before, 1.0 / (_ORDER - 1)))


def _at(series: list[list[float]], time: float) -> _State:
    values = []
    for coefficients in series:
        value = 0.0
        for coefficient in reversed(coefficients):
            value = value * time + coefficient
        values.append(value)
    return tuple(values)
