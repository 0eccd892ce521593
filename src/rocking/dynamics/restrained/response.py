"""The response of a plane body with restraints."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, errors, plausibility
from rocking.answers import Answer, AnswerRows
from rocking.bodies.restrained import Restrained
from rocking.bodies.restraints import Wall
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.response import IMPACT, is_lossless, start_within
from rocking.dynamics.response_base import ResponseBase, followed, ground_at_rest, max_duration, motion_provenance
from rocking.dynamics.restrained.devices import parameters_of
from rocking.dynamics.restrained.engines import RESTRAINT_RESULTS, run
from rocking.dynamics.restrained.forces import RestrainedForces
from rocking.dynamics.restrained.reference import RestrainedTrajectory
from rocking.dynamics.restrained.settings import RestrainedSettings
from rocking.errors import PureRockingWarning
from rocking.messages import Message
from rocking.motions.pulse import Motion
from rocking.motions.segments import Segments
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome
from rocking.restitution.from_file import origin_of
from rocking.tables import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FINE, _AFTER, _FREE = 0.05, 15.0, 300.0  # products of p with time step and durations, as without restraints
_TENSILE = (
    "the contact force becomes tensile at {time:.4g} s, up to {force:.2g} of the weight: from this time the body would "
    "leave the ground, and the model does not apply"
)
_REBOUND = (
    "{name}: the rebound of Sorrentino et al. (2008) is empirical; it needs friction at the wall and a floor that "
    "pulls the body"
)
_SIDES = {1: "right", -1: "left"}


@dataclass(frozen=True, eq=False, repr=False)
class RestrainedResponse(ResponseBase):
    """Response of a plane body with restraints.

    Parameters
    ----------
    body : Restrained
        The body with its restraints.
    motion : GroundMotion or Pulse, optional
        The ground motion; None for free rocking.
    parameters : RockingParameters
        Parameters of the equations, with the coefficients of restitution.
    settings : RestrainedSettings
        Settings of the integration.
    segments : Segments
        The integrated motion, followed by ground at rest [m/s2].
    scale : float
        Factor on the motion [-].
    trajectory : RestrainedTrajectory
        Result of the engine.
    """

    body: Restrained
    motion: Motion | None
    parameters: RockingParameters
    settings: RestrainedSettings
    segments: Segments
    scale: float
    trajectory: RestrainedTrajectory

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, up to the end or until the body has fallen [s]."""
        count = int(np.isfinite(self.trajectory.rotation).sum())
        return np.asarray(np.arange(count) * self.segments.step, dtype=np.float64)

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta at the samples, positive (clockwise) about the right foot [rad]."""
        return self.trajectory.rotation[: self.time.size]

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' at the samples [rad/s]."""
        return self.trajectory.angular_velocity[: self.time.size]

    @property
    def elongation(self) -> FloatArray:
        """Elongation of each restraint at the samples, shape (samples, restraints) [m]."""
        return self.trajectory.elongation[: self.time.size]

    @property
    def restraint_force(self) -> FloatArray:
        """Force of each restraint at the samples, positive in tension, shape (samples, restraints) [N]."""
        return self.trajectory.force[: self.time.size]

    @property
    def restraint_work(self) -> FloatArray:
        """Work done on each restraint since the start, shape (samples, restraints) [J]."""
        return self.trajectory.restraint_work[: self.time.size]

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order of time, with the fields of `IMPACT`."""
        rows = [
            (e.time, e.before, e.after, e.coefficient, _SIDES[e.side])
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
    def peak_ratio(self) -> float:
        """Peak rotation / slenderness angle of its side [-]."""
        return self.peak_rotation / self.parameters.side(self.trajectory.peak_rotation).slenderness_angle

    @property
    def residual_rotation(self) -> float:
        """Rotation at the end [rad]. It is not zero if friction holds the body or the body still rocks."""
        return float(self.rotation[-1])

    @property
    def uplift_height(self) -> float:
        """Largest height of the lifted foot above the ground [m]."""
        left, right = self.body.body.feet
        return (right - left) * math.sin(self.peak_rotation)

    @cached_property
    def forces(self) -> RestrainedForces:
        """Forces of the ground and energy at the samples."""
        states = self.rotation, self.angular_velocity, self.restraint_force
        ground = self._at_samples(self.segments.horizontal), self._at_samples(self.segments.vertical)
        return self._forces(self.time, states, *ground)

    def _forces(
        self,
        time: FloatArray,
        states: tuple[FloatArray, FloatArray, FloatArray],
        horizontal: FloatArray,
        vertical: FloatArray,
    ) -> RestrainedForces:
        return RestrainedForces.of(
            self.body, self.parameters, self.trajectory, time, states, horizontal, vertical, self.settings.gravity,
            linear=self.settings.linear,
        )  # fmt: skip

    @property
    def ground_acceleration(self) -> FloatArray:
        """Horizontal acceleration of the ground at the samples [m/s2]."""
        return self._at_samples(self.segments.horizontal)

    def _at_samples(self, polynomials: FloatArray | None) -> FloatArray:
        if polynomials is None:
            return np.zeros(self.time.size)
        values = np.append(self.scale * polynomials[:, 0], 0.0)
        moving = np.flatnonzero(polynomials.any(axis=1))
        if moving.size:
            values[moving[-1] + 1] = self.scale * polynomials[moving[-1]].sum()
        return np.asarray(values[: self.time.size])

    def _at_times(self, polynomials: FloatArray | None, time: FloatArray) -> FloatArray:
        """Return the ground acceleration at any times [m/s2]."""
        if polynomials is None:
            return np.zeros(time.size)
        stretch = np.minimum((time / self.segments.step).astype(int), len(polynomials))
        rows = np.vstack([polynomials, np.zeros(polynomials.shape[1])])[stretch]
        powers = np.vander(time / self.segments.step - stretch, rows.shape[1], increasing=True)
        return np.asarray(self.scale * (rows * powers).sum(axis=1))

    @cached_property
    def _normal_forces(self) -> tuple[FloatArray, FloatArray]:
        """Times, and contact forces divided by the weight, at the samples and during contact with walls."""
        time, force, weight = self.time, self.forces.vertical_force, self.body.mass * self.settings.gravity
        contacts = np.array(self.trajectory.contacts).reshape(-1, 3 + len(self.body.restraints))
        if contacts.size:
            at, ground = contacts[:, 0], (self.segments.horizontal, self.segments.vertical)
            states = contacts[:, 1], contacts[:, 2], contacts[:, 3:]
            between = self._forces(at, states, *(self._at_times(rows, at) for rows in ground))
            order = np.argsort(np.append(time, at), kind="stable")
            time, force = np.append(time, at)[order], np.append(force, between.vertical_force)[order]
        shown = slice(None) if math.isnan(self.overturning_time) else time <= self.overturning_time
        return time[shown], force[shown] / weight

    @cached_property
    def least_force(self) -> float:
        """Smallest normal contact force divided by the weight [-]. A negative force is tensile.

        The instants are the samples, and 32 instants of each step in contact with a wall.
        """
        return float(np.min(self._normal_forces[1], initial=math.inf))

    @property
    def lost_contact_time(self) -> float:
        """Time from which the contact force is tensile, so that the model does not apply; NaN without tension [s]."""
        time, force = self._normal_forces
        return float(np.append(time[force < 0.0], math.nan)[0])

    @property
    def lost_contact(self) -> bool:
        """True if the contact force becomes tensile at a sample."""
        return self.least_force < 0.0

    @cached_property
    def energy_closure(self) -> float:
        """Largest energy balance error, divided by the largest energy of body, ground, restraints and impacts [-]."""
        forces = self.forces
        stored = forces.kinetic_energy + forces.potential_energy
        gap = stored - stored[0] - self.trajectory.work[: self.time.size] + self.restraint_work.sum(axis=1)
        scale = max(float(np.max(np.abs(stored))), float(np.max(np.abs(self.restraint_work), initial=0.0)), 1e-300)
        return float(np.max(np.abs(gap + forces.energy_lost))) / scale

    @property
    def restraints(self) -> AnswerRows:
        """Extremes, yielding, residual state and energy of each restraint."""
        pairs = list(zip(self.body.restraints, self.trajectory.devices, strict=True))
        columns: dict[str, list[Any]] = {
            "restraint": [item.name for item, _ in pairs], "restraint_kind": [item.kind for item, _ in pairs],
            **{name: [device.summary[name] for _, device in pairs] for name in RESTRAINT_RESULTS},
            "residual_force": [device.law.residual_force for _, device in pairs],
            "residual_slack": [device.law.residual_slack for _, device in pairs],
            "rupture_loss": [device.law.lost for _, device in pairs],
        }  # fmt: skip
        return AnswerRows(columns)

    @cached_property
    def restraint_events(self) -> AnswerRows:
        """Yielding, reversal, slack, slip and rupture of restraints in order of time."""
        events = self.trajectory.restraint_events
        return AnswerRows({
            "time": [event.time for event in events],
            "restraint": [self.body.restraints[event.index].name for event in events],
            "restraint_phase": [event.phase for event in events],
            "rotation": [event.rotation for event in events],
            "elongation": [event.elongation for event in events],
            "restraint_force": [event.force for event in events],
        })  # fmt: skip

    def answer(self) -> Answer:
        """Return outcome, peaks, and forces and energy of the restraints, with units and warnings.

        Returns
        -------
        Answer
            Body, motion, restitution, outcome, peaks, forces and energy of restraints, events, and warnings.
        """
        return super().answer() | {
            "coefficient": {foot: getattr(self.parameters, foot).coefficient for foot in FEET},
            "body": self.body.answer(self.settings.gravity), "motion": motion_answer(self.motion, self.scale),
            "initial_rotation": float(self.rotation[0]), "restitution": self.parameters.label,
            "linear": self.settings.linear, "uplift_times": self.uplifts, "energy_closure": self.energy_closure,
            "least_force": self.least_force, "lost_contact_time": self.lost_contact_time, "warnings": self.doubts(),
        }  # fmt: skip

    def doubts(self) -> list[str]:
        """Return the reasons against rocking in contact.

        Returns
        -------
        list of str
            Sentences; empty if the model is credible.
        """
        reasons: list[str] = [
            Message(_REBOUND, {"name": restraint.name})
            for restraint in self.body.restraints
            if isinstance(restraint, Wall) and restraint.law == "sorrentino"
        ]
        if self.lost_contact:
            reasons.append(Message(_TENSILE, {"time": self.lost_contact_time, "force": -self.least_force}))
        return reasons

    @property
    def _values(self) -> dict[str, Any]:
        forces = self.forces
        return {
            "side": _SIDES.get(self.trajectory.side), "peak_rotation": self.peak_rotation,
            "peak_ratio": self.peak_ratio, "residual_rotation": self.residual_rotation,
            "uplift_height": self.uplift_height, "largest_base_shear": float(np.max(np.abs(forces.base_shear))),
            "largest_overturning_moment": float(np.max(np.abs(forces.overturning_moment))),
            "lost_contact": self.lost_contact,
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
        facts = {"rotation": np.degrees(self.peak_rotation), "ratio": self.peak_ratio}
        if run.outcome is Outcome.HELD:
            return Message(
                "rocked and stays tilted by {residual:.4g} degrees, held by friction: largest rotation {rotation:.4g} "
                "degrees, {ratio:.3g} of the slenderness angle",
                {**facts, "residual": np.degrees(self.residual_rotation)},
            )
        return Message(
            "rocked but did not overturn: largest rotation {rotation:.4g} degrees, {ratio:.3g} of the slenderness "
            "angle, {count} impact",
            {**facts, "count": int(run.impacts)},
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
    def _never_rests(self) -> bool:
        return is_lossless(self.parameters)

    @property
    def _samples(self) -> dict[str, FloatArray]:
        forces = self.forces
        names = (
            "kinetic_energy", "potential_energy", "energy_lost", "horizontal_force", "vertical_force", "base_shear",
            "overturning_moment",
        )  # fmt: skip
        return {
            "time": self.time, "rotation": self.rotation, "angular_velocity": self.angular_velocity,
            "ground_acceleration": self.ground_acceleration,
            "work_of_ground": self.trajectory.work[: self.time.size],
            **{name: getattr(forces, name) for name in names},
        }  # fmt: skip

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        return {
            "impacts": AnswerRows.of(self.impacts), "restraints": self.restraints,
            "restraint_events": self.restraint_events,
        }  # fmt: skip

    def exported(self) -> "Table":
        """Return the table of samples, with tables of impacts, restraints, and their samples."""
        table, names = super().exported(), [item.name for item in self.body.restraints]
        samples = {
            "time": np.repeat(self.time, len(names)), "restraint": np.tile(np.array(names, "U"), self.time.size),
            "elongation": self.elongation.ravel(), "restraint_force": self.restraint_force.ravel(),
            "restraint_work": self.restraint_work.ravel(),
        }  # fmt: skip
        more = {"restraint_sample": Table.of("restraint_sample", samples)} if names else {}
        return replace(table, related={**table.related, **more})

    def _plot(self, **_: Any) -> "Figure":
        from rocking.plots import restrained_picture

        return restrained_picture(self)

    @property
    def _facts(self) -> dict[str, Any]:
        motion, parameters = self.motion, self.parameters
        sides = {
            f"{name}_{foot}": getattr(getattr(parameters, foot), name)
            for foot in FEET
            for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal", "coefficient")
        }
        return {
            "side": self.trajectory.side, "body": type(self.body.body).__name__, "mass": self.body.mass,
            "restitution": parameters.label, **origin_of(parameters.label), **sides,
            "motion": "none: free rocking" if motion is None else motion.name,
            "motion_provenance": motion_provenance(motion), "scale": self.scale,
        }  # fmt: skip


def response_with_restraints(  # noqa: PLR0913 - the arguments of `simulate`
    body: Restrained,
    motion: Motion | None,
    restitution: Any,
    settings: RestrainedSettings,
    *,
    start: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    duration: float | None = None,
    engine: str = "auto",
    stream: int = 0,
) -> RestrainedResponse:
    """Return the response of a plane body with restraints. The durations are those without restraints."""
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    parameters = parameters_of(body, restitution, settings.gravity)
    frequencies = parameters.right.frequency_parameter, parameters.left.frequency_parameter
    slow, quick = min(frequencies), max(frequencies)
    state = start_within(parameters, *start)
    if duration is not None:
        checks.positive("duration", duration, "s")
    stream = checks.whole("stream", stream)

    def computed(length: float) -> tuple[RestrainedTrajectory, Segments]:
        if motion is None:
            segments = ground_at_rest(_FINE / quick, length)
        else:
            segments = motion.segments()
            segments = followed(segments, length, math.ceil(quick * segments.step / _FINE), motion)
        return run(body, parameters, segments, settings, state, scale=scale, stream=stream, engine=engine), segments

    moved = 0.0 if motion is None else motion.duration
    length = duration or moved + (_FREE if motion is None else _AFTER) / slow
    trajectory, segments = computed(length)
    longest = min(moved + _FREE / slow, max_duration(segments.step))
    if duration is None and trajectory.still_rocking and not is_lossless(parameters) and longest > length:
        kept = segments.count
        trajectory, segments = computed(longest)
        segments = _until_rest(trajectory, segments, kept)
    elif duration is None and motion is None:
        segments = _until_rest(trajectory, segments, 0)
    response = RestrainedResponse(body, motion, parameters, settings, segments, scale, trajectory)
    for sentence in () if errors.silenced(PureRockingWarning) else _doubts(response):
        errors.warn(sentence, PureRockingWarning)
    return response


def _doubts(response: RestrainedResponse) -> list[str]:
    return [] if response.outcome is Outcome.FAILED else response.doubts()


def _until_rest(trajectory: RestrainedTrajectory, segments: Segments, min_stretches: int) -> Segments:
    """Remove the samples at rest at the end of a response. At least `min_stretches` segments are kept."""
    moving = (trajectory.angular_velocity != 0.0) | (np.diff(trajectory.rotation, prepend=0.0) != 0.0)
    last = max(int(moving.nonzero()[0][-1]) + 2 if moving.any() else 2, min_stretches)
    if last >= trajectory.rotation.size:
        return segments
    trajectory.cut(last)
    return segments.first(last)
