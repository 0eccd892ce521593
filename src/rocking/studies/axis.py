"""An axis of a map: a parameter of body or motion, its values, and its effect on a case."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import PLANE_BODIES, Block
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.errors import InvalidValueError
from rocking.motions import peak_ground_velocity
from rocking.motions.components import leading
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse, Ricker, Sinusoids
from rocking.studies.question import Case, Question

BODY, RESTITUTION, TIME, AMPLITUDE, VELOCITY = range(5)  # stages of application of axes, in this order


@dataclass(frozen=True, eq=False)
class Axis:
    """A parameter of a map. A call with values returns the axis with these values.

    Values increase, are finite, and are within the range of the axis.
    """

    name: str
    unit: str
    meaning: str
    sets: str  # name of the parameter; two axes of a map must set different parameters
    stage: int  # order of application
    # function that changes a case for the values of its variations
    changes: Callable[[Case, FloatArray], dict[str, Any]] = field(repr=False)
    # check that raises an error for a question without this parameter
    check_kind: Callable[["Axis", Question], object] | None = field(default=None, repr=False)
    low: float = 0.0
    high: float = 1e9
    low_is_allowed: bool = False
    usual: tuple[float, float] = (1.0, 2.0)  # default first and last value in a form
    values: FloatArray = field(default_factory=lambda: np.empty(0))

    def __call__(self, values: Any) -> "Axis":
        row = np.atleast_1d(checks.real_array(self.name, values, self.unit)).copy()
        if row.ndim != 1 or not row.size:
            raise InvalidValueError(
                "{parameter} must be a row of numbers, got shape {shape}", parameter=self.name, shape=row.shape
            )
        above = row >= self.low if self.low_is_allowed else row > self.low
        bad = np.flatnonzero(~(above & (row <= self.high)))
        if bad.size:
            bracket = "[" if self.low_is_allowed else "("
            raise InvalidValueError(
                (
                    "{name} must be in {bracket}{low:g}, {high:g}] {unit}, got {size:g} at index {index}. Check the "
                    "unit."
                ),
                name=self.name,
                bracket=bracket,
                low=self.low,
                high=self.high,
                unit=self.unit,
                size=row[bad[0]],
                index=bad[0],
            )
        checks.increasing(self.name, row, self.unit)
        row.setflags(write=False)
        return replace(self, values=row)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle name and values, because functions cannot be pickled."""
        return (axis_of, ((self.name, self.values),)) if self.values.size else (_without_values, (self.name,))

    def applied(self, case: Case, values: FloatArray) -> Case:
        """Return a case in which this parameter has a value for every variation."""
        return replace(case, **self.changes(case, values))

    def check(self, question: Question) -> None:
        """Raise an error for a question without this parameter."""
        if self.stage == BODY:
            question.check_restraints(self.name)
        if self.stage == TIME:
            question.check_stretching(self.name)
        if self.stage in {AMPLITUDE, VELOCITY} and not question.motion.peak > 0.0:
            raise InvalidValueError(
                "the amplitude of {motion!r} cannot be set: the motion is zero", motion=question.motion.name
            )
        if self.check_kind is not None:
            self.check_kind(self, question)

    def check_beside(self, other: "Axis") -> None:
        """Raise an error for another axis with incompatible values."""
        if self.name == "pgv" and other.name == "scale":
            _refuse_zero(other.values)

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and meaning, for a coordinate of a dataset."""
        return {"units": self.unit, "long_name": self.meaning}


_SAMPLES = 4096


def main_period(motion: Motion) -> float:
    """Return the period T_p of a pulse, or of the first term in a sum of sinusoids [s]."""
    motion = leading(motion)
    if isinstance(motion, Ricker):
        return motion.period
    frequency = abs(motion.waves[0][1]) if isinstance(motion, Sinusoids) else 0.0
    if frequency == 0.0:
        raise InvalidValueError(
            "the period cannot vary for {motion!r}, since this motion has no period", motion=motion.name,
            hint="Use scale, pga, pgv or duration for this motion.",
        )  # fmt: skip
    return 2.0 * math.pi / frequency


def peak_velocity(motion: Motion) -> float:
    """Return the largest velocity of the ground in either direction [m/s]."""
    motion = leading(motion)
    if isinstance(motion, GroundMotion):
        return peak_ground_velocity(motion)
    times = np.linspace(0.0, motion.duration, _SAMPLES + 1)
    signs = np.sign(motion.acceleration_inside(times))
    crossings = np.flatnonzero(signs[:-1] * signs[1:] < 0.0)
    low, high = times[crossings], times[crossings + 1]
    for _ in range(60):  # bisection to the zeros of the acceleration
        middle = 0.5 * (low + high)
        left = np.sign(motion.acceleration_inside(middle)) == signs[crossings]
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    return float(np.abs(motion.velocity(np.concatenate([times, low]))).max())


def _geometry(name: str) -> Callable[[Case, FloatArray], dict[str, Any]]:
    return lambda case, values: {"geometry": {**case.geometry, name: values}}


def _slenderness_ratio(case: Case, values: FloatArray) -> dict[str, Any]:
    return {"geometry": {**case.geometry, "slenderness_angle": np.arctan(1.0 / values)}}


def _restitution(case: Case, values: FloatArray) -> dict[str, Any]:
    body: Any = case.question.body
    if not isinstance(body, PLANE_BODIES):
        return {"sides": {**case.sides, "r_right": values, "r_left": values}}
    inertia = [body.side(foot).moment_of_inertia for foot in FEET]
    largest = np.sqrt(min(inertia) / max(inertia)) * (1.0 + 1e-9)  # Eq. 29
    allowed = np.where(values <= largest, values, np.nan)
    return {"sides": {**case.sides, "r_right": allowed, "r_left": allowed}}


def _period(case: Case, values: FloatArray) -> dict[str, Any]:
    return {"stretch": values / main_period(case.question.motion)}


def _scaled(factors: Callable[[Case, FloatArray], FloatArray]) -> Callable[[Case, FloatArray], dict[str, Any]]:
    return lambda case, values: {"scale": factors(case, values), "amplitude_is_set": True}


def _velocity(case: Case, values: FloatArray) -> dict[str, Any]:
    now = peak_velocity(case.question.motion)
    if case.amplitude_is_set:
        _refuse_zero(case.scale)
        return {"stretch": values / (np.abs(case.scale) * now)}
    return {"scale": values / (now * case.stretch), "amplitude_is_set": True}


def _refuse_zero(scales: FloatArray) -> None:
    if not np.all(scales):
        raise InvalidValueError("pgv cannot be set for scale 0. Remove 0 from the scales.")


def _check_block(axis: Axis, question: Question) -> None:
    if not isinstance(question.body, Block):
        raise InvalidValueError(
            "{axis} varies only for a Block, got {value}", parameter="body", value=question.body, axis=axis.name
        )


def _check_law(axis: Axis, question: Question) -> None:
    if not isinstance(question.law, ConstantRestitution):
        raise InvalidValueError(
            "{axis} is an axis. Remove the impact law, got {law}.", axis=axis.name, law=type(question.law).__name__
        )


def _check_friction(_: Axis, question: Question) -> None:
    if "friction" not in question.settings.stated:
        raise InvalidValueError("the axis friction needs a friction in the settings")


def _check_in_plane(axis: Axis, question: Question) -> None:
    if not isinstance(question.body, PLANE_BODIES):
        raise InvalidValueError(
            "{axis} varies only for a plane body, got {value}", parameter="body", value=question.body, axis=axis.name
        )


def _check_in_space(axis: Axis, question: Question) -> None:
    if isinstance(question.body, PLANE_BODIES):
        raise InvalidValueError(
            "{axis} varies only for a 3D body, got {value}", parameter="body", value=question.body, axis=axis.name
        )


def varied_name(motion: Any, axes: Sequence[Axis]) -> str:
    """Return the name of a motion. Amplitude and period are omitted if axes vary them."""
    motion = leading(motion)
    if not isinstance(motion, Pulse):
        return str(motion.name)
    stages = {axis.stage for axis in axes}
    strength, period = bool(stages & {AMPLITUDE, VELOCITY}), TIME in stages
    return motion.named(strength=not strength, period=not period)


def friction_beside(axes: Sequence[Axis], stated: float | None) -> dict[str, float]:
    """Return the friction setting if friction is an axis. `stated` is the stated friction [-]."""
    values = next((axis.values for axis in axes if axis.name == "friction"), None)
    if values is None:
        return {}
    if stated is not None:
        raise InvalidValueError("friction is an axis. Remove friction from the settings.")
    return {"friction": float(values[-1])}


def _check_period(_: Axis, question: Question) -> None:
    main_period(question.motion)


_TIME, _AMPLITUDE = "the time of the motion", "the amplitude of the motion"

_ALL = (
    Axis(
        "frequency_ratio", "1", "omega_p / p, frequency of the pulse over that of the body", _TIME, TIME,
        lambda case, values: _period(case, 2.0 * np.pi / (values * case.frequency_parameter)), _check_period,
        usual=(0.5, 8.0),
    ),
    Axis(
        "amplitude_ratio", "1", "a_p / (g tan alpha), or a_p / (g alpha) in the linear equations", _AMPLITUDE,
        AMPLITUDE, _scaled(lambda case, values: values * case.uplift_acceleration / case.question.motion.peak),
        high=1e6, usual=(1.0, 10.0),
    ),
    Axis(
        "scale", "1", "factor on the motion", _AMPLITUDE, AMPLITUDE, _scaled(lambda _, values: values),
        lambda axis, question: plausibility.warn(plausibility.of_scaled([question.motion], axis.values)), -1e6, 1e6,
        usual=(0.25, 4.0),
    ),
    Axis(
        "pga", "m/s2", "peak ground acceleration", _AMPLITUDE, AMPLITUDE,
        _scaled(lambda case, values: values / case.question.motion.peak),
        lambda axis, _: plausibility.warn(plausibility.of_acceleration(float(axis.values.max()))), high=1e6,
        usual=(1.0, 12.0),
    ),
    Axis(
        "pgv", "m/s",
        "peak ground velocity, by scaling the motion, or by stretching its time if the other axis scales it",
        "the velocity of the motion", VELOCITY, _velocity, high=1e6, usual=(0.1, 2.0),
    ),
    Axis("period", "s", "period T_p of the pulse", _TIME, TIME, _period, _check_period, usual=(0.2, 3.0)),
    Axis(
        "duration", "s", "duration of the motion, stretched in time", _TIME, TIME,
        lambda case, values: {"stretch": values / case.question.motion.duration}, usual=(0.5, 5.0),
    ),
    Axis(
        "semi_diagonal", "m", "semi-diagonal R; the body with all lengths scaled", "size", BODY,
        _geometry("semi_diagonal"), usual=(0.25, 4.0),
    ),
    # for a block: slenderness alone keeps the semi-diagonal, width alone keeps the height, height alone keeps the width
    Axis(
        "slenderness_ratio", "1", "slenderness ratio h/b of the block", "slenderness", BODY, _slenderness_ratio,
        _check_block, usual=(2.0, 8.0),
    ),
    Axis(
        "slenderness_angle", "rad", "slenderness angle alpha of the block", "slenderness", BODY,
        _geometry("slenderness_angle"), _check_block, high=0.5 * np.pi, usual=(0.1, 0.4),
    ),
    Axis("width", "m", "width of the block", "width", BODY, _geometry("width"), _check_block, usual=(0.2, 2.0)),
    Axis("height", "m", "height of the block", "height", BODY, _geometry("height"), _check_block, usual=(0.5, 6.0)),
    Axis(
        "restitution", "1", "coefficient of restitution, ratio of velocities", "restitution", RESTITUTION,
        _restitution, _check_law, high=1.0, low_is_allowed=True, usual=(0.7, 1.0),
    ),
    Axis(
        "friction", "1", "coefficient of friction between body and ground", "friction", RESTITUTION,
        lambda case, values: {"sides": {**case.sides, "friction": values}}, _check_friction, high=1e6,
        low_is_allowed=True,
    ),
    Axis(
        "azimuth", "rad", "angle of the horizontal motion of a 3D body, from x towards y",
        "azimuth", RESTITUTION, lambda case, values: {"sides": {**case.sides, "azimuth": values}}, _check_in_space,
        high=2.0 * np.pi, low_is_allowed=True,
    ),
    Axis(
        "initial_rotation", "rad", "initial rotation of a plane body", "rotation", RESTITUTION,
        lambda case, values: {"sides": {**case.sides, "rotation": values}}, _check_in_plane, -1.57, 1.57,
        low_is_allowed=True, usual=(-0.2, 0.2),
    ),
    Axis(
        "initial_angular_velocity", "rad/s", "initial angular velocity of a plane body", "angular velocity",
        RESTITUTION, lambda case, values: {"sides": {**case.sides, "velocity": values}}, _check_in_plane, -1e3, 1e3,
        low_is_allowed=True, usual=(-1.0, 1.0),
    ),
)  # fmt: skip


def axes() -> dict[str, Axis]:
    """Return all axes by name, without values.

    Returns
    -------
    dict of str to Axis
        Axes by name. A call with values gives an axis of a map.

    Examples
    --------
    >>> sorted(axes())[:3]
    ['amplitude_ratio', 'azimuth', 'duration']
    """
    return {axis.name: axis for axis in _ALL}


def _without_values(name: str) -> Axis:
    return axes()[name]


def axis_of(axis: Any) -> Axis:
    """Return an axis with values, from an axis or from a name and values."""
    if isinstance(axis, Axis):
        if not axis.values.size:
            raise InvalidValueError(
                "the axis {axis} has no values. Call it with values in {unit}.", axis=axis.name, unit=axis.unit
            )
        return axis
    if not isinstance(axis, Sequence) or isinstance(axis, str) or len(axis) != 2 or not isinstance(axis[0], str):
        raise InvalidValueError('an axis is written as ("scale", values), got {value}', parameter="axis", value=axis)
    all_axes = axes()
    name = checks.spelling(axis[0], all_axes)
    if name not in all_axes:
        raise InvalidValueError(
            "Unknown axis {value}. Axes are {names}", parameter="axis", value=name, names=", ".join(sorted(all_axes)),
            hint=checks.nearest(name, all_axes),
        )  # fmt: skip
    return all_axes[name](axis[1])
