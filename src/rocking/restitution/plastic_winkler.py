"""Plastic Winkler bed: pressure grows with indentation while a point descends, and is gone once it rises."""

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
    """A flat base on springs that do not push back; the result does not depend on their stiffness.

    Pressure is k_w times indentation while a point still descends, zero after. Integrated in moment form: the
    state is (v, omega, Y = Int v dt, Theta = Int omega dt), without a mesh along the base.

    Examples
    --------
    >>> from rocking import Block
    >>> round(PlasticWinkler().coefficient(Block(width=1.0, height=2.0)), 8)
    0.81425939
    """

    name = "plastic-winkler"
    short_name = "plastic Winkler"
    colour, linestyle = "#AC5B2B", (0, (6, 2))
    title = "flat base on a bed of plastic springs that do not push back"
    reference = "derived in this project (theory, Plastic Winkler bed); no publication yet"
    assumptions = (
        "flat base, sticking, impact much shorter than the motion",
        "the bed is uniform and gives nothing back while it unloads",
    )
    domain = "every body whose base leaves the ground behind it; otherwise the body stops: r = 0"
    known_defects = ("one pressure law for every interface: soft layers and rough contacts differ",)
    inertia_only = True

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Coefficients for bases that touch from foot to foot."""
        lever = geometry.new_lever
        kappa, back = np.broadcast_arrays(lever**2 / geometry.base_gyration, geometry.old_lever / lever)
        flat = np.column_stack([kappa.ravel(), back.ravel()])
        different, place = np.unique(flat, axis=0, return_inverse=True)
        values = [_impact(k, b, (-b, 1.0)) for k, b in different.tolist()]
        return np.array(values)[place].reshape(kappa.shape)

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the coefficients of homogeneous rectangles; many of them from an interpolant."""
        place = np.log(slenderness)
        inside = np.abs(place) <= _REACH
        if len(set(slenderness.ravel().tolist())) <= _LARGEST_BATCH or not inside.all():
            return super().raw_of_slenderness(slenderness)
        return np.asarray(1.0 / (1.0 + np.exp(-_log_odds()(place))))

    def raw_coefficient(self, body: Body, onto: Foot) -> float:
        """Coefficient of a body, over the stretches of its base that touch."""
        geometry = ImpactGeometry.of_body(body, onto)
        lever, back = float(geometry.new_lever), float(geometry.old_lever)
        edges = (contact_of(body, onto) / lever).ravel().tolist()
        return _impact(lever**2 / float(geometry.base_gyration), back / lever, tuple(edges))


@lru_cache(maxsize=4096)
def _impact(kappa: float, back: float, edges: tuple[float, ...]) -> float:
    """Velocity ratio for levers in units of the new one; kappa = m b_new^2 / (I_C + m h^2)."""
    stretches = np.reshape(edges, (-1, 2))
    if float((stretches[:, 1] - stretches[:, 0]).sum()) <= 1e-9 * (1.0 + back):
        # feet without area: the whole impulse acts at the new one (Housner)
        return (1.0 - kappa * back) / (1.0 + kappa)  # Eq. 2
    end, velocity = land(kappa, back, stretches)
    # the bed leaves the body turning about its end; from there it steps onto the foot (Housner)
    return velocity * (1.0 + kappa * end) / (1.0 + kappa)  # Eq. 110


@lru_cache(maxsize=1)
def _log_odds() -> "np.polynomial.Chebyshev":
    # ln(r / (1 - r)) against ln(h/b) is smooth, and straight at both ends: r ~ (h/b)^2 and 1 - r ~ (h/b)^-2
    def odds(place: FloatArray) -> FloatArray:
        r = PlasticWinkler().of_geometry(ImpactGeometry.of_slenderness(np.exp(place)))
        return np.asarray(np.log(r / (1.0 - r)))

    return np.polynomial.Chebyshev.interpolate(odds, _DEGREE, domain=[-_REACH, _REACH])


# The contact ends exponentially: once the tip is this slow, relative to the start, nothing more happens.
_AT_REST = 1e-14
_STOPPED = 1e-9
_ORDER = 20
_RELATIVE = 1e-16
_STEPS = 100_000

_State = tuple[float, ...]


def land(kappa: float, back: float, stretches: FloatArray) -> tuple[float, float]:
    """Return how a body leaves the bed, for levers in units of the new one."""
    # The state is (v, omega, Int v dt, Int omega dt): a point x of the base descends while omega x > v, and is pushed
    # with k_w times its indentation as long. Where the edge v / omega of the pressure passes an end of a stretch, the
    # equations have a kink: there the integration stops and begins anew. Returns the end of the base that leaves the
    # bed last, or the foot if that is nearer, over the lever of the new foot [-]; and the angular velocity then, over
    # the one before; zero where the body stops [-].
    bed = _Bed(kappa, stretches)
    state: _State = (-back, 1.0, 0.0, 0.0)
    part, towards = bed.first_part(-back), 1
    while towards:
        state, towards = bed.follow(state, part)
        part += towards
    return bed.end, 0.0 if state[1] < _STOPPED else state[1]


class _Bed:
    """Force and moment of the springs, by the part of the base in which the pressure ends."""

    def __init__(self, kappa: float, stretches: FloatArray) -> None:
        self.stretches: list[list[float]] = stretches.tolist()
        self.edges = [edge for stretch in self.stretches for edge in stretch]
        self.end = min(self.edges[-1], 1.0)
        # the stiffness of the bed only scales time: a contact of any size then takes about as long
        self.push = 1.0 / sum(far - near for near, far in self.stretches)
        self.turn = -kappa * self.push

    def whole(self, part: int) -> _State:
        """Return length, first and second moment of the stretches beyond a part."""
        full = self.stretches[(part + 1) // 2 :]
        return tuple(sum((far**n - near**n) / n for near, far in full) for n in (1, 2, 3))

    def first_part(self, edge: float) -> int:
        """Return in which part of the base the pressure ends at first."""
        part = bisect_right(self.edges, edge)
        if part == 0 or self.edges[part - 1] != edge:
            return part
        # it starts on the end of a stretch, and moves to where the first push drives it
        length, first, second = self.whole(part - 1)
        return part if self.push * (first - edge * length) >= edge * self.turn * (second - edge * first) else part - 1

    def follow(self, state: _State, part: int) -> tuple[_State, int]:
        """Return the state where the edge of the pressure leaves a part, or where the contact ends, and the way on."""
        ends = [(self.edges[part], 1)] if part < len(self.edges) - 1 else []
        if part > 0:
            ends.append((self.edges[part - 1], -1))
        for _ in range(_STEPS):
            series = self._series(state, part)
            step = _step(series)
            state = v, omega, *_ = _at(series, step)
            for edge, sign in ends:
                if sign * (v - edge * omega) > 0.0:
                    passing = _at_edge(series, step, edge, sign)
                    return passing, sign if passing[1] >= _STOPPED else 0  # a body that stops there goes nowhere
            if omega < _STOPPED or self.end * omega - v <= _AT_REST:
                return state, 0
        raise RockingError("a landing on a bed of plastic springs did not end within {steps} steps", steps=_STEPS)

    def _series(self, state: _State, part: int) -> list[list[float]]:
        """Return the Taylor coefficients of v, omega and their integrals, while the pressure ends in a part."""
        length, first, second = self.whole(part)
        v, omega, y, theta = series = [[value] for value in state]
        edge: list[float] = []
        square: list[float] = []
        cube: list[float] = []
        inside = part % 2 == 1
        end = self.edges[part] if inside else 0.0  # zero where the pressure ends between two stretches
        reach, lever, inertia = [length + end], [first + 0.5 * end * end], [second + end**3 / 3.0]
        for k in range(_ORDER):
            if k:
                for one in (reach, lever, inertia):
                    one.append(0.0)
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
    """Return the state at an edge that was passed in a step: by halving, to the last bit."""
    start, stop = 0.0, step
    while start < (middle := 0.5 * (start + stop)) < stop:
        v, omega, *_ = _at(series, middle)
        passed = sign * (v - edge * omega) > 0.0
        start, stop = (start, middle) if passed else (middle, stop)
    return _at(series, start)


def _product(one: list[float], other: list[float]) -> float:
    """Return the last coefficient of a product of series, as far as both are known."""
    return float(sum(map(mul, one, reversed(other))))


def _step(series: list[list[float]]) -> float:
    """Return how far the series hold: what the last two terms add is below the rounding of the state."""
    v, omega = series[0][0], series[1][0]
    room = _RELATIVE * max(abs(v), abs(omega))
    last, before = (max(abs(one[-k]) for one in series) + 1e-300 for k in (1, 2))
    return min(math.pow(room / last, 1.0 / _ORDER), math.pow(room / before, 1.0 / (_ORDER - 1)))


def _at(series: list[list[float]], time: float) -> _State:
    found = []
    for coefficients in series:
        value = 0.0
        for coefficient in reversed(coefficients):
            value = value * time + coefficient
        found.append(value)
    return tuple(found)
