"""Continuation of periodic orbits in one or two parameters, and their bifurcations."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.interpolate import barycentric_interpolate
from scipy.optimize import brentq

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.longrun.orbits import OrbitNotFoundError, PeriodicOrbit, orbit_at
from rocking.studies.longrun.system import IMPACT, REST_SPEED, HarmonicRocking, ImpactFlights, Parameter, over_impacts

_SHORTEST = 1e-9  # step in phase [rad], speed and parameter
_CLOSE, _FAR = 1e-6, 1e-2  # rotations / alpha, or speeds / (alpha p), at a grazing and near it


def _test(jacobian: FloatArray, name: str) -> float:
    """Return the function of a jacobian that is zero at a fold, or at a pitchfork or period doubling ("flip")."""
    (a, b), (c, d) = jacobian.tolist()
    return float(1.0 + (-a - d if name == "fold" else a + d) + (a * d - b * c))  # Eqs. 335, 336


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """A bifurcation on a branch of periodic orbits.

    Parameters
    ----------
    kind : {"fold", "pitchfork", "period doubling", "grazing"}
        A pitchfork breaks the symmetry of an orbit; a period doubling doubles its period. At a grazing an impact
        appears or disappears without velocity: the orbits with this number of impacts end.
    value : float
        Value of the parameter.
    orbit : PeriodicOrbit
        The orbit there.
    """

    kind: str
    value: float
    orbit: PeriodicOrbit


@dataclass(frozen=True, eq=False)
class Branch:
    """A branch of periodic orbits over one parameter.

    Parameters
    ----------
    parameter : str
        Parameter, as for `HarmonicRocking.changed`.
    orbits : list of PeriodicOrbit
        Orbits along the branch.
    bifurcations : list of Bifurcation
        Bifurcations along the branch.
    """

    parameter: Parameter
    orbits: list[PeriodicOrbit]
    bifurcations: list[Bifurcation]

    @cached_property
    def values(self) -> FloatArray:
        """Values of the parameter, shape (orbits,)."""
        return np.array([orbit.system.value(self.parameter) for orbit in self.orbits])

    def at(self, value: float) -> list[PeriodicOrbit]:
        """Return the orbits of the branch at a value of the parameter.

        Parameters
        ----------
        value : float
            Value of the parameter.

        Returns
        -------
        list of PeriodicOrbit
            One orbit per passage of the branch through the value; empty outside the branch.

        Raises
        ------
        OrbitNotFoundError
            If the orbits of the branch are too far from each other.
        """
        curve, normal = _Curve(self.orbits[0], (self.parameter,)), np.array([0.0, 0.0, 1.0])
        passages = []
        for before, after in pairwise(self.orbits):
            low, high = curve.start(before), curve.start(after)
            share = (value / curve.scales[0] - low[2]) / ((high - low)[2] or math.nan)
            if 0.0 <= share < 1.0 or (after is self.orbits[-1] and share == 1.0):
                low[0] += round((high - low)[0] / (2.0 * math.pi)) * 2.0 * math.pi
                passages.append(curve.orbit(curve.corrected(low + share * (high - low), normal)))
        return passages

    def first(self, kind: str) -> Bifurcation:
        """Return the first bifurcation of a kind.

        Parameters
        ----------
        kind : {"fold", "pitchfork", "period doubling", "grazing"}
            The kind.

        Returns
        -------
        Bifurcation
            The bifurcation.

        Raises
        ------
        OrbitNotFoundError
            If the branch has none.
        """
        for bifurcation in self.bifurcations:
            if bifurcation.kind == kind:
                return bifurcation
        raise OrbitNotFoundError("the branch has no {kind}", kind=kind)


class _Curve:
    """Orbits as a curve of phase, speed and parameters over their first values; with a test function, its zeros."""

    def __init__(self, orbit: PeriodicOrbit, parameters: tuple[Parameter, ...], test: str = "") -> None:
        self.first, self.impacts, self.halves, self.parameters = orbit.system, orbit.impacts, orbit.halves, parameters
        self.scales, self.test = np.abs([orbit.system.value(name) for name in parameters]), test

    def start(self, orbit: PeriodicOrbit) -> FloatArray:
        """Return phase, speed and scaled parameters of an orbit, shape (2 + parameters,)."""
        values = [orbit.system.value(name) for name in self.parameters]
        return np.array([orbit.phase, orbit.speed, *(values / self.scales)])

    def system(self, point: FloatArray) -> HarmonicRocking:
        """Return the system; the amplitude ratio last, since its unit changes with the slenderness."""
        system, values = self.first, dict(zip(self.parameters, (point[2:] * self.scales).tolist(), strict=True))
        try:
            for name in sorted(self.parameters, key="amplitude".__eq__):
                system = system.changed(name, values[name])
        except InvalidValueError as error:
            raise self._error("the orbit ends at {name} {limit:.9g}", point) from error
        return system

    def equations(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the residual, and its derivative by the point: exact, or by differences with a test function."""
        if not self.test:
            residual, flight = self._closure(point, self.parameters[0])
            return residual, np.column_stack([flight.jacobian[0] - np.eye(2), flight.by_parameter[0] * self.scales])
        shifts = 1e-6 * np.eye(len(point))
        columns = [(self._tested(point + shift) - self._tested(point - shift)) / 2e-6 for shift in shifts]
        return self._tested(point), np.column_stack(columns)

    def _closure(self, point: FloatArray, parameter: Parameter | Literal[""]) -> tuple[FloatArray, ImpactFlights]:
        flight = over_impacts(self.system(point), point[0], point[1], self.impacts, parameter=parameter)
        if flight.event[0] != IMPACT:
            raise self._error("the orbit ends at {name} {limit:.9g}", point)
        return np.array([flight.phase[0] - point[0] - self.halves * math.pi, flight.speed[0] - point[1]]), flight

    def _tested(self, point: FloatArray) -> FloatArray:
        residual, flight = self._closure(point, "")
        return np.append(residual, _test(flight.jacobian[0], self.test))

    def _error(self, text: str, point: FloatArray) -> OrbitNotFoundError:
        return OrbitNotFoundError(text, name=self.parameters[-1], limit=float(point[-1] * self.scales[-1]))

    def tangent(self, point: FloatArray, along: FloatArray) -> FloatArray:
        """Return the unit tangent in the direction of another vector."""
        vector: FloatArray = np.linalg.svd(self.equations(point)[1])[2][-1]
        return vector if vector @ along >= 0.0 else -vector

    def corrected(self, guess: FloatArray, normal: FloatArray) -> FloatArray:
        """Return the orbit in the plane through a guess with a normal."""
        point = guess.copy()
        for _ in range(25):
            residual, derivative = self.equations(point)
            rows = np.vstack([derivative, normal])
            step = np.linalg.solve(rows, -np.append(residual, normal @ (point - guess)))
            point = point + step
            if np.max(np.abs(step)) < 1e-11 and np.max(np.abs(residual)) < 1e-9:
                return point
            if not np.all(np.abs(step) < 1.0) or point[1] <= 0.0:
                break
        raise self._error("the continuation finds no orbit near {name} {limit:.9g}", guess)

    def orbit(self, point: FloatArray) -> PeriodicOrbit:
        flight = self._closure(point, "")[1]
        return orbit_at(self.system(point), point[:2], self.impacts, self.halves, flight)


@dataclass(frozen=True)
class _Course:
    """Limits of the parameter, first step, largest number of orbits, and test of bifurcations that end a branch."""

    limits: tuple[float, float]
    step: float
    most: int
    stop: Callable[[Bifurcation], bool] | None


def continue_orbit(
    orbit: PeriodicOrbit,
    limits: tuple[float, float],
    *,
    parameter: Parameter = "amplitude",
    increasing: bool = True,
    step: float = 0.02,
    most: int = 2000,
    stop: Callable[[Bifurcation], bool] | None = None,
) -> Branch:
    """Continue a periodic orbit in a parameter, through folds, and locate its bifurcations.

    Parameters
    ----------
    orbit : PeriodicOrbit
        First orbit.
    limits : tuple of float
        Smallest and largest value of the parameter.
    parameter : {"amplitude", "frequency", "restitution", "slenderness"}, optional
        Parameter, as for `HarmonicRocking.changed`.
    increasing : bool, optional
        True if the parameter increases at first.
    step : float, optional
        First step in phase [rad], speed and parameter [-]; it adapts.
    most : int, optional
        Largest number of orbits.
    stop : callable, optional
        Ends the branch at a bifurcation for which it returns True.

    Returns
    -------
    Branch
        Orbits and bifurcations; values of bifurcations are accurate to about 1e-10. A grazing is the last one, because
        orbits with this number of impacts end there.

    Raises
    ------
    OrbitNotFoundError
        If the continuation fails at the first step.

    References
    ----------
    Keller (1977), pseudo-arclength continuation; Hogan (1989), Proc. R. Soc. Lond. A 425:441-476.
    """
    curve = _Curve(orbit, (parameter,))
    point = curve.start(orbit)
    tangent = curve.tangent(point, np.array([0.0, 0.0, 1.0 if increasing else -1.0]))
    return _followed(curve, point, tangent, _Course(limits, step, most, stop))


def _followed(curve: _Curve, point: FloatArray, tangent: FloatArray, course: _Course) -> Branch:
    orbits = [curve.orbit(point)]
    bifurcations: list[Bifurcation] = []
    length = course.step
    while len(orbits) < course.most:
        try:
            following = curve.corrected(point + length * tangent, tangent)
            ahead = curve.tangent(following, tangent)
            if ahead @ tangent < 0.97:
                raise OrbitNotFoundError("the step of the continuation is too long")
            orbits.append(curve.orbit(following))
        except (OrbitNotFoundError, np.linalg.LinAlgError):
            length *= 0.5
            if length < _SHORTEST:
                if len(orbits) == 1:
                    raise
                bifurcations += [] if curve.test else _grazings(curve.parameters[0], orbits)
                break
            continue
        located = [
            bifurcation
            for name in (() if curve.test else ("fold", "flip"))
            if (bifurcation := _located(curve, (point, following), tangent, name, (orbits[-2], orbits[-1])))
        ]
        bifurcations += located
        point, tangent = following, ahead
        is_end = course.stop is not None and any(map(course.stop, located))
        if is_end or not course.limits[0] <= point[-1] * curve.scales[-1] <= course.limits[1]:
            break
        length = min(1.5 * length, 5.0 * course.step) if ahead @ tangent > 0.995 else length
    return Branch(curve.parameters[0], orbits, bifurcations)


def _located(
    curve: _Curve,
    points: tuple[FloatArray, FloatArray],
    tangent: FloatArray,
    name: str,
    orbits: tuple[PeriodicOrbit, PeriodicOrbit],
) -> Bifurcation | None:
    """Locate the zero of a test function between two points of a curve."""
    before, after = (_test(orbit.jacobian, name) for orbit in orbits)
    if before * after >= 0.0:
        return None
    point, following = points

    def test(length: float) -> float:
        return _test(curve.orbit(curve.corrected(point + length * tangent, tangent)).jacobian, name)

    zero = brentq(test, 0.0, float(tangent @ (following - point)), xtol=1e-14, rtol=1e-14)
    orbit = curve.orbit(curve.corrected(point + zero * tangent, tangent))
    symmetric = curve.impacts % 2 == 1 and curve.first.is_symmetric
    kind = "fold" if name == "fold" else "pitchfork" if symmetric else "period doubling"
    return Bifurcation(kind, orbit.system.value(curve.parameters[0]), orbit)


def _grazings(parameter: Parameter, orbits: list[PeriodicOrbit]) -> list[Bifurcation]:
    """Return the grazing at the end of a branch, where a minimum of the rotation or an impact speed is zero."""
    for name, lowest in (("trough", 0.0), ("slowest", 10.0 * REST_SPEED)):  # slower impacts are less accurate
        points: list[tuple[float, float]] = []
        for orbit in reversed(orbits if getattr(orbits[-1], name) < _CLOSE else []):
            height = getattr(orbit, name)
            if height > _FAR or len(points) == 4:
                break
            if height > (3.0 * points[-1][0] if points else lowest):
                points.append((height, orbit.system.value(parameter)))
        if points:
            heights, values = np.transpose(points)
            value = float(np.real(barycentric_interpolate(heights, values, 0.0)))
            return [Bifurcation("grazing", value, orbits[-1])]
    return []


def branch_off(
    bifurcation: Bifurcation,
    limits: tuple[float, float],
    *,
    parameter: Parameter = "amplitude",
    step: float = 0.02,
    most: int = 2000,
    stop: Callable[[Bifurcation], bool] | None = None,
) -> Branch:
    """Follow the orbits that branch off at a pitchfork or a period doubling.

    Parameters
    ----------
    bifurcation : Bifurcation
        A pitchfork or a period doubling.
    limits, parameter, step, most, stop
        As for `continue_orbit`.

    Returns
    -------
    Branch
        Orbits with twice the number of impacts, and their bifurcations.

    Raises
    ------
    InvalidValueError
        If the bifurcation is a fold or a grazing.
    """
    if bifurcation.kind == "fold":
        raise InvalidValueError(
            "no branch begins at a fold; use continue_orbit, which follows the branch through the fold"
        )
    checks.one_of("bifurcation", bifurcation.kind, ("pitchfork", "period doubling"))
    orbit = bifurcation.orbit
    values, vectors = np.linalg.eig(orbit.jacobian)
    direction = np.real(vectors[:, np.argmin(np.abs(values + 1.0))])
    tangent = np.append(direction / np.linalg.norm(direction), 0.0)
    twice = orbit.jacobian @ orbit.jacobian
    double = replace(orbit, impacts=2 * orbit.impacts, halves=2 * orbit.halves, jacobian=twice)
    curve = _Curve(double, (parameter,))
    point, offset = curve.start(double), 1e-3
    while True:
        try:
            first = curve.corrected(point + offset * tangent, tangent)
            return _followed(curve, first, curve.tangent(first, tangent), _Course(limits, step, most, stop))
        except OrbitNotFoundError:
            offset *= 0.1
            if offset < 1e-6:
                raise


def bifurcation_curve(
    bifurcation: Bifurcation,
    limit: float,
    *,
    parameters: tuple[Parameter, Parameter] = ("amplitude", "frequency"),
    step: float = 0.05,
    most: int = 500,
) -> list[Bifurcation]:
    """Follow a fold, a pitchfork or a period doubling in two parameters.

    Parameters
    ----------
    bifurcation : Bifurcation
        First point of the curve.
    limit : float
        Value of the second parameter at the end of the curve.
    parameters : tuple of {"amplitude", "frequency", "restitution", "slenderness"}, optional
        Parameters, as for `HarmonicRocking.changed`; `Bifurcation.value` is the first one.
    step : float, optional
        First step in phase [rad], speed and relative parameters [-]; it adapts.
    most : int, optional
        Largest number of points.

    Returns
    -------
    list of Bifurcation
        Points of the curve, which may turn; the last one is at the limit if the curve reaches the limit.

    Raises
    ------
    OrbitNotFoundError
        If the continuation fails at the first step.
    InvalidValueError
        If the bifurcation is a grazing.
    """
    checks.one_of("bifurcation", bifurcation.kind, ("fold", "pitchfork", "period doubling"))
    first = bifurcation.orbit
    curve = _Curve(first, parameters, "fold" if bifurcation.kind == "fold" else "flip")
    start, end = first.system.value(parameters[1]), np.array([0.0, 0.0, 0.0, 1.0])
    limits = (-math.inf, limit) if limit > start else (limit, math.inf)
    point = curve.start(first)
    tangent = curve.tangent(point, end if limit > start else -end)
    orbits = _followed(curve, point, tangent, _Course(limits, step, most, None)).orbits
    if not limits[0] <= orbits[-1].system.value(parameters[1]) <= limits[1]:
        last = curve.start(orbits[-1])
        last += (limit / curve.scales[1] - last[3]) * (tangent := curve.tangent(last, end)) / tangent[3]
        orbits[-1] = curve.orbit(curve.corrected(last, end))
    return [Bifurcation(bifurcation.kind, orbit.system.value(parameters[0]), orbit) for orbit in orbits]
