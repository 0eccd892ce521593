"""The response of a body to a ground motion: rotation, impacts, energy, forces, outcome."""

import math
import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, plausibility
from rocking.answers import Answer, AnswerRows
from rocking.bodies import Body
from rocking.conventions import DEFAULT_FRICTION, FEET, Assumed, FloatArray, given_or_assumed
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import EventKind, Trajectory
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.response_base import ResponseBase, followed, ground_at_rest, max_duration, motion_provenance
from rocking.dynamics.settings import SHORTEST_STEP
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.messages import Message
from rocking.motions.pulse import Motion
from rocking.motions.segments import Segments
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome
from rocking.restitution.from_file import origin_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.dynamics.plane.dense_output import DenseOutput
    from rocking.dynamics.plane.energy_balance import GroundForces, ResponseEnergy
    from rocking.dynamics.plane.tangent import Tangent
    from rocking.dynamics.plane_frictional import ContactResponse

_ROUNDING = 1e-9

IMPACT = np.dtype(
    [("time", "f8"), ("velocity_before", "f8"), ("velocity_after", "f8"), ("coefficient", "f8"), ("foot", "U5")]
)
"""Fields of `Response.impacts`: time [s], velocities before and after [rad/s], coefficient [-], foot."""

_OVERTURNED = {
    "left": (
        "overturned to the left without an impact, past the point of no return at {time:.4g} s",
        "overturned to the left after {count} impact, past the point of no return at {time:.4g} s",
        "overturned to the left after {count} impacts, past the point of no return at {time:.4g} s",
    ),
    "right": (
        "overturned to the right without an impact, past the point of no return at {time:.4g} s",
        "overturned to the right after {count} impact, past the point of no return at {time:.4g} s",
        "overturned to the right after {count} impacts, past the point of no return at {time:.4g} s",
    ),
}
_FLIGHT_UNKNOWN = (
    "the contact force becomes tensile, up to {force:.2g} of the weight: {leaves}. Rocking alone: {outcome}. With "
    "flight: no result, {reason}"
)
_FLIGHT = (
    "the contact force becomes tensile, up to {force:.2g} of the weight: {leaves}. Rocking alone: {outcome}. With "
    "flight and a coefficient of friction of {friction:g}, {origin}: {flight}"
)


@dataclass(frozen=True, eq=False, repr=False)
class Response(ResponseBase):
    """Response of a plane body without friction.

    Quantities that take long to compute are computed at first access.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse, optional
        The ground motion; None for free rocking.
    parameters : RockingParameters
        Parameters of the equations, with the coefficients of restitution.
    settings : PlaneSettings
        Settings of the integration.
    segments : Segments
        The integrated motion, followed by ground at rest [m/s2].
    scale : float
        Factor on the motion [-].
    stream : int
        Number of the history, for random coefficients.
    trajectory : Trajectory
        Result of the engine.
    """

    body: Body
    motion: Motion | None
    parameters: RockingParameters
    settings: PlaneSettings
    segments: Segments
    scale: float
    stream: int
    trajectory: Trajectory

    @cached_property
    def _finite(self) -> int:
        bad = np.flatnonzero(~np.isfinite(self.trajectory.rotation))
        return int(bad[0]) if bad.size else int(self.trajectory.rotation.size)

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, up to the end or until the body has fallen [s]."""
        return np.asarray(np.arange(self._finite) * self.segments.step, dtype=np.float64)

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta at the samples, positive (clockwise) about the right foot [rad]."""
        return self.trajectory.rotation[: self._finite]

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' at the samples [rad/s]."""
        return self.trajectory.angular_velocity[: self._finite]

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order of time, with the fields of `IMPACT`."""
        rows = [
            (e.time, e.before, e.after, e.coefficient, "right" if e.side > 0 else "left")
            for e in self.trajectory.events
            if e.kind is EventKind.IMPACT
        ]
        return np.array(rows, dtype=IMPACT)

    @cached_property
    def uplifts(self) -> FloatArray:
        """Times of uplift from rest [s]."""
        return np.array([e.time for e in self.trajectory.events if e.kind is EventKind.UPLIFT])

    @property
    def peak_rotation(self) -> float:
        """Largest rotation, including times between the samples; a quarter turn after overturning [rad]."""
        return abs(self.trajectory.peak_rotation)

    @property
    def side(self) -> int:
        """Side of overturning, as in `simulate_many`: 1 right, -1 left, 0 without overturning [-]."""
        return int(self.trajectory.side) if self.outcome is Outcome.OVERTURNED else 0

    @property
    def peak_ratio(self) -> float:
        """Peak rotation / slenderness angle of its side [-]. A body with a value above 1 need not overturn."""
        return self.peak_rotation / self.parameters.side(self.trajectory.peak_rotation).slenderness_angle

    @property
    def coefficients(self) -> dict[str, float]:
        """Coefficient of restitution by foot of landing [-]."""
        return {foot: getattr(self.parameters, foot).coefficient for foot in FEET}

    @property
    def least_force(self) -> float:
        """Smallest normal contact force during rocking / weight; NaN without rocking [-].

        A negative force is tensile. The force is evaluated at the samples, uplifts and impacts, up to the overturning
        time. Inside a step, the force may be smaller: for 2 of 24 random records with a step of 0.005 s, it was smaller
        by 1e-4 of the weight. `simulate_many` gives the same number.
        """
        return self.trajectory.least_force

    @property
    def lost_contact(self) -> bool | None:
        """True if the contact force becomes tensile; the outcome then assumes contact. None without a result."""
        return None if self.outcome is Outcome.FAILED else self.least_force < 0.0

    def with_contact(self, friction: float = math.inf) -> "ContactResponse":
        """Return the response of the body with sliding, hopping and flight: `simulate` with friction.

        Parameters
        ----------
        friction : float
            Coefficient of friction [-]. If infinite, the first of 10, 3 and 1 for which there is a response, so that
            feet in contact do not slide.

        Returns
        -------
        ContactResponse
            Response with the full equations.

        Raises
        ------
        InvalidValueError
            If the coefficient of restitution changes from impact to impact.
        """
        from rocking.dynamics.plane_frictional.base import Start
        from rocking.dynamics.plane_frictional.response import response_with_contact
        from rocking.dynamics.plane_frictional.settings import ContactSettings

        parameters, run = self.parameters, self.trajectory
        if parameters.law.kind:
            raise InvalidValueError(
                "{parameter} must be constant for a body that may fly, got {law}", parameter="restitution",
                law=parameters.label,
            )  # fmt: skip
        start = Start(rotation=float(run.rotation[0]), angular_velocity=float(run.angular_velocity[0]))
        for mu in (10.0, 3.0, 1.0) if friction == math.inf else (friction,):
            with warnings.catch_warnings():  # this response has already issued the warnings
                warnings.simplefilter("ignore", PlausibilityWarning)
                response = response_with_contact(
                    self.body, self.motion, {f: getattr(parameters, f).coefficient for f in FEET},
                    ContactSettings(self.settings.gravity, friction=mu), start=start, scale=self.scale,
                    duration=self.segments.count * self.segments.step,
                )  # fmt: skip
            if response.outcome is not Outcome.FAILED:
                break
        return response

    def doubts(self, friction: float = math.inf) -> list[str]:
        """Return the reasons against pure rocking. If contact is lost, they describe the response with flight.

        Parameters
        ----------
        friction : float
            Coefficient of friction between body and ground [-]. If infinite, only loss of contact is checked.

        Returns
        -------
        list of str
            Sentences; empty if pure rocking is credible.
        """
        # an assumed friction is not used for the response with flight; its feet do not slide
        stated = math.inf if isinstance(friction, Assumed) else friction
        if self.lost_contact and stated not in self._flights:
            self._flights[stated] = self._flight_text(stated)
        reasons = [self._flights[stated]] if self.lost_contact else []
        return reasons if friction == math.inf else [*reasons, *self.contact.slips(friction)]

    @cached_property
    def _flights(self) -> dict[float, str]:
        """Descriptions of the response with flight, by coefficient of friction. They are computed once."""
        return {}

    def _flight_text(self, friction: float) -> str:
        from rocking.dynamics.plane.energy_balance import LEAVES

        facts: dict[str, Any] = {"force": -self.least_force, "leaves": Message(LEAVES), "outcome": self._verdict}
        try:
            response = self.with_contact(friction)
        except InvalidValueError as error:
            return Message(_FLIGHT_UNKNOWN, {**facts, "reason": str(error)})
        origin = "because no friction is stated" if friction == math.inf else f"as {given_or_assumed(friction)}"
        facts |= {"friction": response.law.friction, "origin": Message(origin), "flight": response.summary}
        return Message(_FLIGHT, facts)

    @property
    def _ending(self) -> str:
        """The outcome in one sentence. If the motion was cut, the sentence contains the end of the motion."""
        if not self._is_cut:
            return self._verdict
        return Message(
            "{outcome}; the motion was cut at {time:.4g} s, with ground at rest afterwards",
            {"outcome": self._verdict, "time": self.segments.count * self.segments.step},
        )

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        angle, rate = np.degrees(self.rotation[-1]), self.angular_velocity[-1]
        state = Message("at {rotation:.3g} degrees and {velocity:.3g} rad/s", {"rotation": angle, "velocity": rate})
        return "rocking", self.time[-1], state

    @property
    def _verdict(self) -> str:
        run = self.trajectory
        if run.outcome is Outcome.OVERTURNED:
            no_impact, singular, plural = _OVERTURNED["right" if run.side > 0 else "left"]
            facts = {"count": int(run.impacts), "time": run.overturning_time}
            return Message(singular, facts, plural) if run.impacts else Message(no_impact, facts)
        if run.outcome is Outcome.NO_UPLIFT:
            return str(run.outcome.value)
        ratio = self.peak_rotation / self.parameters.side(run.peak_rotation).slenderness_angle
        return Message(
            "rocked but did not overturn: largest rotation {rotation:.4g} degrees, {ratio:.3g} of the slenderness "
            "angle, {count} impact",
            {"rotation": np.degrees(self.peak_rotation), "ratio": ratio, "count": int(run.impacts)},
            "rocked but did not overturn: largest rotation {rotation:.4g} degrees, {ratio:.3g} of the slenderness "
            "angle, {count} impacts",
        )

    @property
    def _never_rests(self) -> bool:
        return is_lossless(self.parameters)

    @property
    def _is_cut(self) -> bool:
        end = self.segments.count * self.segments.step
        over = self._finite < self.trajectory.rotation.size  # the body fell early, or there is no result
        return not over and self.motion is not None and end < self.motion.duration * (1.0 - _ROUNDING)

    @cached_property
    def _covered(self) -> FloatArray:
        """Times of the samples, and the overturning time if it is after the last sample [s]."""
        fall, last = self.overturning_time, float(self.time[-1])
        return np.append(self.time, fall) if fall > last + _ROUNDING * self.segments.step else self.time

    @cached_property
    def dense_output(self) -> "DenseOutput":
        """The response between its samples and events."""
        from rocking.dynamics.plane.dense_output import DenseOutput

        return DenseOutput.of(self.trajectory, self.segments, self.parameters, self.settings, self.scale)

    @cached_property
    def energy(self) -> "ResponseEnergy":
        """Kinetic and potential energy, work of the ground and losses at the samples and a later fall [J]."""
        from rocking.dynamics.plane.energy_balance import energy_of

        return energy_of(self.dense_output, self._covered, self.body.mass, self.settings)

    @cached_property
    def contact(self) -> "GroundForces":
        """Forces of the ground, friction demand and loss of contact."""
        from rocking.dynamics.plane.energy_balance import contact_of

        return contact_of(self.trajectory, self.dense_output, self._covered, self.body, self.settings)

    @cached_property
    def ground_acceleration(self) -> FloatArray:
        """Horizontal acceleration of the ground at the samples [m/s2]. At the end, the last value of the motion."""
        return self._at_samples(self.segments.horizontal)

    @cached_property
    def vertical_ground_acceleration(self) -> FloatArray | None:
        """Vertical acceleration of the ground at the samples; None without a vertical component [m/s2]."""
        return None if self.segments.vertical is None else self._at_samples(self.segments.vertical)

    def _at_samples(self, polynomials: FloatArray) -> FloatArray:
        h = self.scale * polynomials
        values = np.append(h[:, 0], 0.0)
        moving = np.flatnonzero(h.any(axis=1))
        if moving.size:
            values[moving[-1] + 1] = h[moving[-1]].sum()
        return values[: self._finite]

    @cached_property
    def error_estimate(self) -> float:
        """Largest change of theta in a second run with half steps: the integration error [rad].

        The error increases with the duration, because rocking amplifies small differences. If the half steps change the
        outcome, the estimate is infinite.
        """
        name, settings, first = "reference", self.settings, self.trajectory
        half_step = 0.5 * settings.longest_step
        if self.engine.startswith("fast") and half_step >= SHORTEST_STEP:  # the reference engine accepts shorter steps
            name, settings = "fast", replace(settings, longest_step=half_step)
        twin = run(
            self.parameters, self.segments.refined(2), settings, engine=name, scale=self.scale, stream=self.stream,
            rotation=float(first.rotation[0]), velocity=float(first.angular_velocity[0]),
        )  # fmt: skip
        if twin.outcome is not first.outcome:
            return math.inf
        return float(np.nanmax(np.abs(twin.rotation[::2] - first.rotation)))  # Eq. 47

    def tangent(self) -> "Tangent":
        """Return the derivatives with respect to initial state and parameters, and the growth of small differences.

        Returns
        -------
        Tangent
            Derivatives at the samples, through all impacts of the engine.

        Raises
        ------
        InvalidValueError
            If there is no response.

        Examples
        --------
        >>> import rocking as rk
        >>> block = rk.Block(width=1.0, height=4.0)
        >>> pulse = rk.pulses.sine(amplitude=3.0, period=0.8)
        >>> tangent = rk.simulate(block, pulse, 0.9, rotation=0.05, duration=2.0).tangent()
        >>> impacts = tangent.determinants.size
        >>> bool(abs(np.linalg.det(tangent.by_start[-1]) / 0.9 ** (2 * impacts) - 1.0) < 1e-10)
        True
        """
        from rocking.dynamics.plane.tangent import tangent_of

        return tangent_of(self)

    def at(self, time: Any) -> FloatArray:
        """Return the rotation at any times within the response.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            theta [rad].

        Raises
        ------
        InvalidValueError
            If a time is not finite, or is outside the response by more than rounding. The response ends with the last
            sample, or when the body has fallen.
        """
        output = self.dense_output
        t = self._times_within(time, float(output.end[-1]))
        k = np.clip(np.searchsorted(output.start, t, side="right") - 1, 0, output.start.size - 1)
        x = (t - output.start[k]) / output.length[k]
        c = output.quintics()[k]
        return np.asarray((c * x[..., None] ** np.arange(6)).sum(axis=-1))

    def answer(self, friction: float = DEFAULT_FRICTION) -> Answer:
        """Return outcome, peaks, impacts and friction demand, with units and warnings.

        Parameters
        ----------
        friction : float
            Coefficient of friction between body and ground, for comparison with the friction demand [-].

        Returns
        -------
        Answer
            Body, motion, restitution, outcome, peaks, impacts, friction demand, accuracy, and warnings.
        """
        contact = self.contact
        return super().answer() | {
            "coefficient": self.coefficients,
            "body": self.body.answer(self.settings.gravity), "motion": motion_answer(self.motion, self.scale),
            "initial_rotation": float(self.rotation[0]), "restitution": self.parameters.label,
            "linear": self.settings.linear, "uplift_times": self.uplifts,
            "energy_closure": self.energy.closure, "error_estimate": self.error_estimate, "friction": friction,
            "friction_assumed": isinstance(friction, Assumed), "friction_demand": contact.friction_demand,
            "friction_of_motion": contact.friction_of_motion, "friction_of_impacts": contact.friction_of_impacts,
            "least_force": self.least_force, "warnings": self.doubts(friction),
        }  # fmt: skip

    def outcome_answer(self) -> Answer:
        """Return coefficients, outcome and peaks, for a comparison of models.

        Returns
        -------
        Answer
            Coefficients, outcome and its side, peaks, number of impacts.
        """
        parts = super().answer()
        names = ("outcome", "summary", "still_rocking", "last_state", "overturning_time")
        return Answer({name: parts[name] for name in names}) | {
            **self._values, "coefficient": self.coefficients, "impacts": int(self.impacts.size),
        }  # fmt: skip

    @property
    def _values(self) -> dict[str, Any]:
        return {
            "side": {1: "right", -1: "left"}.get(self.side), "peak_rotation": self.peak_rotation,
            "peak_ratio": self.peak_ratio, "lost_contact": self.lost_contact,
        }  # fmt: skip

    @property
    def _last_state(self) -> dict[str, Any]:
        return {
            "time": self.time[-1], "rotation": self.rotation[-1], "angular_velocity": self.angular_velocity[-1],
        }  # fmt: skip

    @property
    def _samples(self) -> dict[str, FloatArray]:
        energy, contact, up = self.energy, self.contact, self.vertical_ground_acceleration
        values = {
            "time": self.time, "rotation": self.rotation, "angular_velocity": self.angular_velocity,
            "ground_acceleration": self.ground_acceleration,
            **({} if up is None else {"vertical_ground_acceleration": up}),
            "kinetic_energy": energy.kinetic, "potential_energy": energy.potential, "work_of_ground": energy.work,
            "energy_lost": energy.lost, "horizontal_force": contact.horizontal, "vertical_force": contact.vertical,
        }  # fmt: skip
        # overturning may occur after the last sample
        return {name: series[: self._finite] for name, series in values.items()}

    def _plot(self, **options: Any) -> "Figure":
        from rocking.plots import response_picture

        return response_picture(self, **options)

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        return {"impacts": AnswerRows.of(self.impacts)}

    @property
    def _facts(self) -> dict[str, Any]:
        motion, parameters = self.motion, self.parameters
        sides = {
            f"{name}_{foot}": getattr(getattr(parameters, foot), name)
            for foot in FEET
            for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal", "coefficient")
        }
        return {
            "side": self.side,
            "impacts": int(self.trajectory.impacts),
            **({"overturning_time": self.overturning_time} if self.side else {}),
            "body": type(self.body).__name__,
            "mass": self.body.mass,
            "restitution": parameters.label,
            **origin_of(parameters.label),
            **sides,
            "motion": "none: free rocking" if motion is None else motion.name,
            "motion_provenance": motion_provenance(motion),
            "scale": self.scale,
            "random_stream": self.stream,
        }


# products of p and a time: step between samples under a pulse, time after the motion, time on ground at rest
_FINE, _AFTER, _FREE = 0.05, 15.0, 300.0


def response_of_rocking(  # noqa: PLR0913 - the arguments of `simulate`
    body: Body,
    motion: Motion | None,
    restitution: Any,
    settings: PlaneSettings,
    *,
    start: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    duration: float | None = None,
    engine: str = "auto",
    stream: int = 0,
) -> Response:
    """Return the response of a plane body without friction. If `motion` is None, the ground is at rest."""
    # start: theta [rad] and theta' [rad/s]
    # duration [s]: by default to 15 / p after the motion; if the body still rocks, until it rests, at most to 300 / p
    # after the motion; on ground at rest until the body rests or has fallen, at most to 300 / p
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    parameters = RockingParameters.of_body(body, restitution, settings.gravity)
    frequencies = parameters.right.frequency_parameter, parameters.left.frequency_parameter
    slow, quick = min(frequencies), max(frequencies)
    rotation, velocity = start_within(parameters, *start)
    default_length = _FREE / slow if motion is None else motion.duration + _AFTER / slow
    length = default_length if duration is None else checks.positive("duration", duration, "s")
    stream = checks.whole("stream", stream)

    def computed(length: float) -> tuple[Any, Segments]:
        if motion is None:
            segments = ground_at_rest(_FINE / quick, length)
        else:
            segments = motion.segments()
            segments = followed(segments, length, math.ceil(quick * segments.step / _FINE), motion)
        trajectory = run(
            parameters, segments, settings, engine=engine, scale=scale, stream=stream, rotation=rotation,
            velocity=velocity,
        )  # fmt: skip
        return trajectory, segments

    trajectory, segments = computed(length)
    if duration is None and motion is None:
        trajectory, segments = _until_rest(trajectory, segments, 0)
    elif duration is None and motion is not None and trajectory.still_rocking and not is_lossless(parameters):
        trajectory, segments = _extended(computed, motion.duration + _FREE / slow, trajectory, segments)
    return Response(body, motion, parameters, settings, segments, scale, stream, trajectory)


def start_within(parameters: RockingParameters, rotation: Any, angular_velocity: Any) -> tuple[float, float]:
    """Return theta [rad] and theta' [rad/s] at the start. Raise an error above a quarter turn or 100 p."""
    half_pi = 0.5 * math.pi
    max_velocity = 100.0 * max(parameters.right.frequency_parameter, parameters.left.frequency_parameter)
    return (
        checks.within(
            "rotation",
            rotation,
            -half_pi,
            half_pi,
            unit="rad",
            open_low=True,
            open_high=True,
            hint="in radians",
        ),
        checks.within(
            "angular_velocity",
            angular_velocity,
            -max_velocity,
            max_velocity,
            unit="rad/s",
            hint="in radians",
        ),
    )


def is_lossless(parameters: RockingParameters) -> bool:
    """Return True if no impact can lose energy, so that the body never comes to rest."""
    return parameters.smallest(-1.0) * parameters.smallest(1.0) >= 1.0


def _extended(computed: Any, length: float, trajectory: Any, segments: Segments) -> tuple[Any, Segments]:
    """Return the response until the body rests, up to a length [s].

    If the longer run fails, return the former response.
    """
    length = min(length, max_duration(segments.step))
    if length <= segments.duration:
        return trajectory, segments
    longer, longer_segments = computed(length)
    if longer.outcome is Outcome.FAILED:
        return trajectory, segments
    return _until_rest(longer, longer_segments, segments.count)


def _until_rest(trajectory: Any, segments: Segments, min_stretches: int) -> tuple[Any, Segments]:
    """Return a response without the samples at rest at its end. At least `min_stretches` segments are kept."""
    moving = (trajectory.rotation != 0.0) | (trajectory.angular_velocity != 0.0)
    last = max(int(moving.nonzero()[0][-1]) + 2 if moving.any() else 2, min_stretches)
    if last >= trajectory.rotation.size:
        return trajectory, segments
    kept = slice(last + 1)
    shorter = replace(
        trajectory, rotation=trajectory.rotation[kept], angular_velocity=trajectory.angular_velocity[kept]
    )
    return shorter, segments.first(last)
