"""Equations of motion of a rocking body, and formulas derived from these equations (docs/theory/rocking.md).

All functions accept numbers or arrays.
"""

import math
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.outcome import Outcome, Status
from rocking.portable import each


def angular_acceleration(
    rotation: Any, side: Any, alpha: Any, p: Any, push: Any, weight: Any = 1.0, *, linear: bool = False
) -> FloatArray:
    """Return theta'' [rad/s2]. `push` is a_x / g, `weight` is 1 + a_z / g [-]."""
    to_top = np.asarray(alpha) * side - rotation
    sine, cosine = (to_top, np.ones_like(to_top)) if linear else (np.sin(to_top), np.cos(to_top))  # Eq. 15
    return np.asarray(-np.square(p) * (np.asarray(weight) * sine + np.asarray(push) * cosine))  # Eq. 14


def energy(rotation: Any, angular_velocity: Any, alpha: Any, p: Any, *, linear: bool = False) -> FloatArray:
    """Return energy above rest / (m g R), ``theta'^2 / (2 p^2) + cos(alpha - |theta|) - cos(alpha)`` [-]."""
    size, angle = np.abs(rotation), np.asarray(alpha)
    kinetic = 0.5 * np.square(np.asarray(angular_velocity) / p)
    if linear:
        return np.asarray(kinetic + size * (angle - 0.5 * size))  # Eq. 30
    # cos a - cos b is written as a product to avoid cancellation at small rotations
    return np.asarray(kinetic + 2.0 * np.sin(angle - 0.5 * size) * np.sin(0.5 * size))  # Eq. 17


def energy_at_top(alpha: Any, *, linear: bool = False) -> FloatArray:
    """Return the energy barrier of overturning / (m g R), ``1 - cos(alpha)`` [-]."""
    angle = np.asarray(alpha)
    return np.asarray(0.5 * np.square(angle) if linear else 2.0 * np.square(np.sin(0.5 * angle)))  # Eq. 31


def turning_rotation(energy_over_mgr: Any, alpha: Any, *, linear: bool = False) -> FloatArray:
    """Return the amplitude of a freely rocking body.

    `energy_over_mgr` is the energy above rest / (m g R) [-], up to the energy at the top. Returns |theta| [rad].

    >>> round(turning_rotation(energy(0.05, 0.0, 0.2, 3.0), 0.2).item(), 12)
    0.05
    """
    angle = np.asarray(alpha)
    left = np.maximum(energy_at_top(angle, linear=linear) - energy_over_mgr, 0.0)
    return np.asarray(angle - (np.sqrt(2.0 * left) if linear else 2.0 * each(math.asin, np.sqrt(0.5 * left))))  # Eq. 32


def reactions(  # noqa: PLR0917 - the state of body and ground in the order of the equations
    rotation: Any,
    angular_velocity: Any,
    acceleration: Any,
    side: Any,
    alpha: Any,
    semi_diagonal: Any,
    horizontal: Any,
    vertical: Any,
) -> tuple[FloatArray, FloatArray]:
    """Return horizontal and vertical force of the ground per unit mass [N/kg]."""
    # horizontal: a_x, vertical: g + a_z [m/s2]
    psi = np.asarray(alpha) - np.asarray(side) * rotation
    outward = np.asarray(side) * acceleration  # |theta|''
    rate2 = np.square(angular_velocity)
    f_x = horizontal + np.asarray(side) * semi_diagonal * (np.cos(psi) * outward + np.sin(psi) * rate2)  # Eq. 18
    f_z = vertical + semi_diagonal * (np.sin(psi) * outward - np.cos(psi) * rate2)  # Eq. 18
    return np.asarray(f_x), np.asarray(f_z)


def friction_of_impact(height: float, old_lever: float, new_lever: float, coefficient: Any) -> FloatArray:
    """Return the friction demand of an impact without slip, h (1 - r) / (b_old + b_new r) [-]."""
    r = np.asarray(coefficient)
    return np.asarray(height * (1.0 - r) / (old_lever + new_lever * r))  # Eq. 5


class EventKind(IntEnum):
    """Kind of an event."""

    UPLIFT = 0
    IMPACT = 1
    REST = 2


@dataclass(frozen=True, slots=True)
class Event:
    """An uplift, an impact or the start of rest."""

    time: float  # time [s]
    kind: EventKind
    side: int  # foot in contact after the event: +1 right, -1 left
    before: float = 0.0  # before, after: angular velocities of an impact [rad/s]
    after: float = 0.0
    coefficient: float = 0.0  # coefficient of restitution of an impact [-]


@dataclass(frozen=True)
class Trajectory:
    """A history: states at the ends of all segments of the motion, and events."""

    # rotation, angular_velocity: theta [rad] and theta' [rad/s]; NaN after overturning; shape (segments + 1,)
    rotation: FloatArray
    angular_velocity: FloatArray
    events: list[Event] = field(repr=False)  # in order of time
    outcome: Outcome
    status: Status
    side: int  # side of overturning, +1 or -1; 0 without overturning
    peak_rotation: float  # theta of largest absolute value; a quarter turn after overturning [rad]
    peak_time: float  # time [s]
    peak_velocity: float  # largest |theta'| [rad/s]
    # last passage of the centre of mass over the foot, or the end of the motion if the passage is later; NaN without
    # overturning [s]
    overturning_time: float
    impacts: int  # impacts, uplifts: their numbers
    uplifts: int
    truncation: float  # sum of the truncation errors of the steps [rad]; not a measure of the global error
    # smallest normal contact force during rocking / (m g), up to the overturning time, at samples, uplifts
    # and impacts; a negative force is tensile; NaN without rocking [-]
    least_force: float
    # largest ratio of horizontal to normal force at the same instants [-]; infinite if contact is lost
    friction_demand: float
    engine: str  # engine and method

    @property
    def first_uplift(self) -> float:
        """Time of the first uplift from rest; NaN without uplift [s]."""
        return next((event.time for event in self.events if event.kind is EventKind.UPLIFT), math.nan)

    @property
    def still_rocking(self) -> bool:
        """True if the body has not overturned and still moves at the last sample."""
        return self.outcome is Outcome.ROCKED and bool(self.rotation[-1] != 0.0 or self.angular_velocity[-1] != 0.0)
