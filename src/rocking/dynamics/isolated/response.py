"""The response of a plane body on an isolated base."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, errors, plausibility
from rocking.answers import Answer, AnswerRows
from rocking.bodies.isolated import Isolated
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.isolated.reference import IsolatedReference, IsolatedTrajectory
from rocking.dynamics.isolated.settings import IsolatedSettings
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.response import start_within
from rocking.dynamics.response_base import ResponseBase, followed, ground_at_rest, motion_provenance
from rocking.errors import PureRockingWarning
from rocking.messages import Message
from rocking.motions.pulse import Motion
from rocking.motions.segments import Segments
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome
from rocking.restitution.from_file import origin_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FINE, _AFTER, _FREE = 0.05, 15.0, 100.0  # products of p with time step and durations
_SIDES = {1: "right", -1: "left"}
_TENSILE = "the contact force becomes tensile, up to {force:.2g} of the weight: the body would leave the base"
_TENSILE_BELOW = (
    "the force of the ground on the base becomes tensile, up to {force:.2g} of the weight of body and base: the base "
    "would leave the ground, and friction and later results do not hold"
)
IMPACT = np.dtype([
    ("time", "f8"), ("velocity_before", "f8"), ("velocity_after", "f8"), ("coefficient", "f8"), ("foot", "U5"),
    ("base_velocity_before", "f8"), ("base_velocity_after", "f8"),
])  # fmt: skip
"""Fields of `IsolatedResponse.impacts`: those of `Response.impacts`, and velocities of the base [m/s]."""


@dataclass(frozen=True, eq=False, repr=False)
class IsolatedResponse(ResponseBase):
    """Response of a plane body on an isolated base.

    Parameters
    ----------
    body : Isolated
        The body with its base.
    motion : GroundMotion or Pulse, optional
        The ground motion; None for free rocking.
    parameters : RockingParameters
        Parameters of the body on fixed ground, with the coefficients of restitution.
    settings : IsolatedSettings
        Settings of the integration.
    segments : Segments
        The integrated motion, followed by ground at rest [m/s2].
    scale : float
        Factor on the motion [-].
    trajectory : IsolatedTrajectory
        Result of the engine.
    """

    body: Isolated
    motion: Motion | None
    parameters: RockingParameters
    settings: IsolatedSettings
    segments: Segments
    scale: float
    trajectory: IsolatedTrajectory

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, up to the end or until the body has fallen [s]."""
        count = int(np.isfinite(self.trajectory.samples["rotation"]).sum())
        return np.asarray(np.arange(count) * self.segments.step, dtype=np.float64)

    def _sampled(self, name: str) -> FloatArray:
        return np.asarray(self.trajectory.samples[name][: self.time.size])

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta at the samples, positive (clockwise) about the right foot [rad]."""
        return self._sampled("rotation")

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' at the samples [rad/s]."""
        return self._sampled("angular_velocity")

    @property
    def base_displacement(self) -> FloatArray:
        """Displacement of the base relative to the ground at the samples, positive to the right [m]."""
        return self._sampled("displacement")

    @property
    def base_velocity(self) -> FloatArray:
        """Velocity of the base relative to the ground at the samples [m/s]."""
        return self._sampled("velocity")

    @property
    def base_acceleration(self) -> FloatArray:
        """Absolute acceleration of the base at the samples, without the impacts [m/s2]."""
        return self._sampled("acceleration")

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order of time, with the fields of `IMPACT`."""
        events = [event for event in self.trajectory.events if event.kind is EventKind.IMPACT]
        rows = [
            (e.time, e.before, e.after, e.coefficient, _SIDES[e.side], *velocities)
            for e, velocities in zip(events, self.trajectory.base_velocities, strict=True)
        ]
        return np.array(rows, dtype=IMPACT)

    @cached_property
    def uplifts(self) -> FloatArray:
        """Times of uplift from rest [s]."""
        return np.array([e.time for e in self.trajectory.events if e.kind is EventKind.UPLIFT])

    @cached_property
    def peak_rotation(self) -> float:
        """Largest rotation, including times between the samples; a quarter turn after overturning [rad]."""
        if self.outcome is Outcome.OVERTURNED:
            return 0.5 * math.pi
        peaks = [abs(theta) for _, theta in self.trajectory.peaks]
        return float(np.max([*peaks, *np.abs(self.rotation[[0, -1]]).tolist()]))

    @property
    def peak_ratio(self) -> float:
        """Peak rotation over the smaller slenderness angle [-]."""
        return self.peak_rotation / min(self.parameters.side(s).slenderness_angle for s in (1, -1))

    @cached_property
    def largest_base_displacement(self) -> float:
        """Largest displacement of the base relative to the ground, the clearance that the base needs [m]."""
        peaks = [abs(u) for _, u in self.trajectory.base_peaks]
        return float(np.max([*peaks, *np.abs(self.base_displacement).tolist()]))

    @property
    def kinetic_energy(self) -> FloatArray:
        """Kinetic energy of body and base relative to the ground at the samples [J]."""
        static, inertia, angle, _ = self._constants
        rate, v, total = self.angular_velocity, self.base_velocity, self.body.mass + self.body.base_mass
        return np.asarray(0.5 * total * v**2 + static * np.cos(angle) * rate * v + 0.5 * inertia * rate**2)

    @property
    def potential_energy(self) -> FloatArray:
        """Potential energy of the body and energy of the spring at the samples [J]."""
        static, _, angle, alpha = self._constants
        raised = static * self.settings.gravity * (np.cos(angle) - np.cos(alpha))
        return np.asarray(raised + 0.5 * self.body.stiffness * self.base_displacement**2)

    @property
    def _constants(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return m R, inertia, angle to the vertical, and alpha of the side at the samples."""
        right = self.rotation > 0.0
        right |= (self.rotation == 0.0) & (self.angular_velocity > 0.0)
        p, alpha, radius = (
            np.where(right, getattr(self.parameters.right, name), getattr(self.parameters.left, name))
            for name in ("frequency_parameter", "slenderness_angle", "semi_diagonal")
        )
        static = self.body.mass * radius
        return static, static * self.settings.gravity / p**2, alpha - np.abs(self.rotation), alpha

    @property
    def energy_closure(self) -> float:
        """Largest energy balance error, divided by the largest energy of body, base, ground and losses [-]."""
        stored = self.kinetic_energy + self.potential_energy
        work, spent = self._sampled("work"), self._sampled("dissipated") + self._sampled("lost")
        gap = stored - stored[0] - work + spent
        scale = max(float(np.max(np.abs(values))) for values in (stored, work, spent))
        return float(np.max(np.abs(gap))) / scale if scale else 0.0

    @property
    def least_force(self) -> float:
        """Smallest normal force on the body at the ends of the steps, divided by its weight [-]."""
        return min(self.trajectory.least_force, 1.0)

    @property
    def lost_contact(self) -> bool:
        """True if the normal force on the body becomes tensile."""
        return self.least_force < 0.0

    def doubts(self) -> list[str]:
        """Return the reasons against rocking in contact.

        Returns
        -------
        list of str
            Sentences; empty if the model is credible.
        """
        forces = {_TENSILE: self.least_force, _TENSILE_BELOW: self.trajectory.least_base_force}
        return [Message(text, {"force": -force}) for text, force in forces.items() if force < 0.0]

    def answer(self) -> Answer:
        """Return outcome, peaks of body and base, energy, impacts, and warnings.

        Returns
        -------
        Answer
            Body, base, motion, restitution, outcome, peaks, energy, impacts, and warnings.
        """
        return super().answer() | {
            "coefficient": {foot: getattr(self.parameters, foot).coefficient for foot in FEET},
            "body": self.body.answer(self.settings.gravity), "motion": motion_answer(self.motion, self.scale),
            "initial_rotation": float(self.rotation[0]), "restitution": self.parameters.label,
            "uplift_times": self.uplifts, "energy_closure": self.energy_closure, "least_force": self.least_force,
            "warnings": self.doubts(),
        }  # fmt: skip

    @property
    def _values(self) -> dict[str, Any]:
        return {
            "side": _SIDES.get(self.trajectory.side), "peak_rotation": self.peak_rotation,
            "peak_ratio": self.peak_ratio, "largest_base_displacement": self.largest_base_displacement,
            "residual_base_displacement": float(self.base_displacement[-1]),
            "largest_base_acceleration": float(np.max(np.abs(self.base_acceleration))),
            "lost_in_isolators": float(self._sampled("dissipated")[-1]), "lost_contact": self.lost_contact,
        }  # fmt: skip

    @property
    def _ending(self) -> str:
        run = self.trajectory
        if run.outcome in {Outcome.NO_UPLIFT, Outcome.FAILED}:
            return str(run.outcome.value)
        if run.outcome is Outcome.OVERTURNED:
            side = Message(_SIDES[run.side])
            return Message("overturned to the {side}, last passage of equilibrium at {time:.4g} s", {
                "side": side, "time": run.overturning_time,
            })  # fmt: skip
        return Message(
            "rocked but did not overturn: largest rotation {rotation:.4g} degrees, {ratio:.3g} of the slenderness "
            "angle, {count} impact",
            {"rotation": np.degrees(self.peak_rotation), "ratio": self.peak_ratio, "count": int(self.impacts.size)},
            "rocked but did not overturn: largest rotation {rotation:.4g} degrees, {ratio:.3g} of the slenderness "
            "angle, {count} impacts",
        )

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        angle, rate = np.degrees(self.rotation[-1]), self.angular_velocity[-1]
        state = Message("at {rotation:.3g} degrees and {velocity:.3g} rad/s", {"rotation": angle, "velocity": rate})
        return "rocking", self.time[-1], state

    @property
    def _last_state(self) -> dict[str, Any]:
        return {
            "time": self.time[-1], "rotation": self.rotation[-1], "angular_velocity": self.angular_velocity[-1],
        }  # fmt: skip

    @property
    def _samples(self) -> dict[str, FloatArray]:
        return {
            "time": self.time, "rotation": self.rotation, "angular_velocity": self.angular_velocity,
            "base_displacement": self.base_displacement, "base_velocity": self.base_velocity,
            "base_acceleration": self.base_acceleration, "work_of_ground": self._sampled("work"),
            "kinetic_energy": self.kinetic_energy, "potential_energy": self.potential_energy,
            "energy_lost": self._sampled("lost"), "energy_dissipated": self._sampled("dissipated"),
        }  # fmt: skip

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        return {"impacts": AnswerRows.of(self.impacts)}

    def _plot(self, **_: Any) -> "Figure":
        from rocking.plots import isolated_picture

        return isolated_picture(self)

    @property
    def _facts(self) -> dict[str, Any]:
        sides = {
            f"{name}_{foot}": getattr(getattr(self.parameters, foot), name)
            for foot in FEET
            for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal", "coefficient")
        }
        names = "base_mass", "stiffness", "damping"
        return {
            "side": self.trajectory.side, "body": type(self.body.body).__name__, "mass": self.body.mass,
            **{name: getattr(self.body, name) for name in names}, "base_friction": self.body.friction,
            "restitution": self.parameters.label, **origin_of(self.parameters.label), **sides,
            "motion": "none: free rocking" if self.motion is None else self.motion.name,
            "motion_provenance": motion_provenance(self.motion), "scale": self.scale,
        }  # fmt: skip


def _may_overturn(trajectory: IsolatedTrajectory, parameters: RockingParameters) -> bool:
    """Return True if the rotation at the end exceeds the slenderness angle or increases."""
    rotation, rate = (float(trajectory.samples[name][-1]) for name in ("rotation", "angular_velocity"))
    return rotation * rate > 0.0 or abs(rotation) > parameters.side(rotation).slenderness_angle


def response_on_a_base(
    body: Isolated,
    motion: Motion | None,
    restitution: Any,
    settings: IsolatedSettings,
    *,
    start: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    duration: float | None = None,
    stream: int = 0,
) -> IsolatedResponse:
    """Return the response of a body on an isolated base, to 15 / p after the motion or 100 / p in free rocking."""
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    parameters = RockingParameters.of_body(body.body, restitution, settings.gravity)
    frequencies = parameters.right.frequency_parameter, parameters.left.frequency_parameter
    slow, quick = min(frequencies), max(frequencies)
    length = (0.0 if motion is None else motion.duration) + (_FREE if motion is None else _AFTER) / slow
    if duration is not None:
        length = checks.positive("duration", duration, "s")
    if motion is None:
        segments = ground_at_rest(_FINE / quick, length)
    else:
        segments = motion.segments()
        segments = followed(segments, length, math.ceil(quick * segments.step / _FINE), motion)
    inputs, state = (settings, scale, checks.whole("stream", stream)), start_within(parameters, *start)
    trajectory = IsolatedReference(body, parameters, segments, *inputs).run(*state)
    if trajectory.still_rocking and _may_overturn(trajectory, parameters):  # ground at rest, to determine the outcome
        longer = IsolatedReference(body, parameters, segments.extended(length + _AFTER / slow), *inputs).run(*state)
        if longer.outcome is Outcome.OVERTURNED:
            trajectory.outcome, trajectory.side = longer.outcome, longer.side
            trajectory.overturning_time = longer.overturning_time
    response = IsolatedResponse(body, motion, parameters, settings, segments, scale, trajectory)
    silent = errors.silenced(PureRockingWarning) or response.outcome is Outcome.FAILED
    for sentence in () if silent else response.doubts():
        errors.warn(sentence, PureRockingWarning)
    return response
