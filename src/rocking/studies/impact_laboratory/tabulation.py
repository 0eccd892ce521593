"""The table of the model `contact-bed`, from impacts resolved in time."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np

from rocking import conventions
from rocking.bodies import MassPoints
from rocking.conventions import FloatArray
from rocking.dynamics.bed import BedStatus, ContactBed, KelvinVoigt, bed_impacts, setup_of
from rocking.dynamics.bed.tables import Setup
from rocking.errors import InvalidValueError
from rocking.restitution.bed_table import POINTS, BedTable, nodes

RELEASE = 0.05
"""Rotation from which the body falls, over the least slenderness angle: rocking of small amplitude [-]."""


def table_setup(flatness: float, offset: float, points: int, damping: float, hardness: float) -> Setup:
    """Return the impact of one node of the table: half base 1 m, mass 1 kg.

    Parameters
    ----------
    flatness, offset : float
        Body, as in `BedTable` [-].
    points : int
        Contact points.
    damping, hardness : float
        Damping ratio and dimensionless landing speed of the new foot [-].

    Returns
    -------
    Setup
        The impact.
    """
    body, feet, release, speed = _body(flatness, offset)
    stiffness = (hardness * conventions.g / speed) ** 2
    return setup_of(body, _bed(feet, points, stiffness, damping), rotation=release, tolerance=1e-8)


def impulse_position(coefficient: FloatArray, flatness: FloatArray, offset: FloatArray) -> FloatArray:
    """Return where an impulse acts that gives a coefficient, from angular momentum about its position.

    Parameters
    ----------
    coefficient : ndarray
        theta_dot_after / theta_dot_before [-].
    flatness, offset : ndarray
        Of the bodies [-].

    Returns
    -------
    ndarray
        kappa [-].
    """
    gyration = 1.0 / flatness - 1.0
    arm = gyration * (1.0 - coefficient) / (1.0 + offset + coefficient * (1.0 - offset))
    return np.asarray(arm + offset)


def resolved(cases: FloatArray, points: int, *, threads: int = 1) -> FloatArray:
    """Return coefficients of restitution resolved in time.

    Parameters
    ----------
    cases : ndarray, shape (n, 4)
        Flatness, offset, damping, hardness [-].
    points : int
        Contact points.
    threads : int
        Threads of the fast engine.

    Returns
    -------
    ndarray, shape (n,)
        theta_dot_after / theta_dot_before, by the next peak [-].

    Raises
    ------
    InvalidValueError
        If an impact did not end.
    """
    r = _coefficients(cases, points, 1e-8, threads)
    # a chattering point can use up its steps: another step tolerance takes another way through
    for tolerance in (3e-8, 1e-7, 1e-6):
        failed = np.isnan(r)
        if not failed.any():
            break
        r[failed] = _coefficients(cases[failed], points, tolerance, threads)
    if np.isnan(r).any():
        row = cases[np.isnan(r)][0].tolist()
        raise InvalidValueError(f"{int(np.isnan(r).sum())} impacts of the table did not end, the first at {row}")
    return r


def tabulated(*, threads: int = 1, progress: Callable[[int], None] | None = None) -> BedTable:
    """Compute the table of the model `contact-bed`; takes minutes.

    Parameters
    ----------
    threads : int
        Threads of the fast engine; the bits do not depend on them.
    progress : callable, optional
        Called with the number of impacts done since the last call.

    Returns
    -------
    BedTable
        The table.
    """
    axes = nodes()
    shape = tuple(axis.size for axis in axes)
    planes = []
    for points, cases in _cases(axes):
        r = np.concatenate(
            [_told(resolved(piece, points, threads=threads), progress) for piece in np.array_split(cases, 40)]
        )
        planes.append(impulse_position(r, cases[:, 0], cases[:, 1]).reshape(shape))
    return BedTable(*axes, np.array(planes))


def stored(table: BedTable) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    """Return the positions as they are shipped.

    Parameters
    ----------
    table : BedTable
        The table.

    Returns
    -------
    ndarray of uint16
        Whole multiples of 2^-15, to be written with `numpy.save`.
    """
    return np.asarray(np.rint(np.clip(table.positions, 0.0, 1.9) * 2.0**15).astype(np.uint16))


def _coefficients(cases: FloatArray, points: int, tolerance: float, threads: int) -> FloatArray:
    setups = [
        replace(table_setup(flatness, offset, points, damping, hardness), tolerance=tolerance)
        for flatness, offset, damping, hardness in cases.tolist()
    ]
    impacts = bed_impacts(setups, threads=threads)
    ended = [status in {BedStatus.PEAK, BedStatus.TOPPLED} for status in impacts.status]
    return np.where(ended, impacts.coefficient, np.nan)


@lru_cache(maxsize=256)
def _body(flatness: float, offset: float) -> tuple[MassPoints, tuple[float, float], float, float]:
    """Body, feet, rotation of release and landing speed of the new foot."""
    gyration = 1.0 / flatness - 1.0
    height = math.sqrt(0.7 * gyration)
    arm = math.sqrt(0.3 * gyration)
    feet = (-1.0 - offset, 1.0 - offset)
    body = MassPoints([(-arm, height), (arm, height)], [0.5, 0.5], feet=feet)
    release = RELEASE * math.atan(min(-feet[0], feet[1]) / height)
    speed = 2.0 * setup_of(body, _bed(feet, 2, 1.0, 1.0), rotation=release).start.landing_velocity
    return body, feet, release, speed


def _cases(axes: tuple[FloatArray, ...]) -> Iterator[tuple[int, FloatArray]]:
    grid = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    for points in POINTS:
        yield points, grid


def _bed(feet: tuple[float, float], points: int, stiffness: float, damping: float) -> ContactBed:
    shares = np.ones(points)
    shares[[0, -1]] = 0.5
    law = KelvinVoigt(stiffness, damping_ratio=damping)
    return ContactBed(np.linspace(*feet, points), law, shares / shares.sum(), kinematics="small")


def _told(values: FloatArray, progress: Callable[[int], None] | None) -> FloatArray:
    if progress is not None:
        progress(values.size)
    return values
