"""The response of a stack."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, errors, plausibility
from rocking.answers import Answer, AnswerRows
from rocking.bodies.stack import Stack
from rocking.conventions import DEFAULT_RESTITUTION, FEET, FloatArray
from rocking.dynamics.response_base import ResponseBase, followed, ground_at_rest, motion_provenance
from rocking.dynamics.stack.engines import run
from rocking.dynamics.stack.settings import StackSettings
from rocking.dynamics.stack.start import start_within
from rocking.dynamics.stack.trajectory import IMPACT, StackTrajectory
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.messages import Message
from rocking.motions.pulse import Motion
from rocking.motions.segments import Segments
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome, Status
from rocking.tables import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FINE, _AFTER, _FREE = 0.05, 15.0, 300.0  # products of p with time step and durations, as for one body
_IMPACT = np.dtype([("time", "f8"), ("joint", "i8"), ("velocity_before", "f8"), ("velocity_after", "f8")])
_CORNERS = {1: "right", -1: "left", 0: "closed"}
_OPEN, _SLID = 1e-5, 1e-5  # smallest opening of a rocking joint [rad]; smallest displacement over the width


@dataclass(frozen=True, eq=False, repr=False)
class StackResponse(ResponseBase):
    """Response of a stack.

    Parameters
    ----------
    body : Stack
        The stack.
    motion : GroundMotion or Pulse, optional
        The ground motion; None for free rocking.
    settings : StackSettings
        Settings of the integration.
    segments : Segments
        The integrated motion, followed by ground at rest [m/s2].
    scale : float
        Factor on the motion [-].
    trajectory : StackTrajectory
        Result of the engine.
    """

    body: Stack
    motion: Motion | None
    settings: StackSettings
    segments: Segments
    scale: float
    trajectory: StackTrajectory

    @property
    def time(self) -> FloatArray:
        """Times of the samples [s]."""
        return self.trajectory.time

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta of every body, positive clockwise, shape (samples, bodies) [rad]."""
        return self.trajectory.rotation

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' of every body, shape (samples, bodies) [rad/s]."""
        return self.trajectory.angular_velocity

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order of time: time, joint, and velocity of the opening before and after."""
        rows = [
            (event.time, event.joint + 1, _relative(event.before, event.joint), _relative(event.after, event.joint))
            for event in self.trajectory.events
            if event.kind == IMPACT
        ]
        return np.array(rows, dtype=_IMPACT)

    @property
    def opening(self) -> FloatArray:
        """Relative rotation of every joint, shape (samples, joints) [rad]."""
        return self.trajectory.opening

    @property
    def joint_displacement(self) -> FloatArray:
        """Displacement of the upper body along every joint, shape (samples, joints) [m]."""
        return self.trajectory.slip

    @property
    def peak_rotation(self) -> float:
        """Largest rotation of a body at samples and turning points, at least a quarter turn if it overturns [rad]."""
        turning = [angle for event in self.trajectory.events for angle in event.rotation]
        turns = self.outcome is Outcome.OVERTURNED and not self.is_slid_off
        lowest = 0.5 * math.pi if turns else 0.0
        return float(max(np.max(np.abs(self.rotation)), np.max(np.abs(turning), initial=lowest)))

    @cached_property
    def ground_acceleration(self) -> FloatArray:
        """Horizontal acceleration of the ground at the samples [m/s2]."""
        values = np.append(self.scale * self.segments.horizontal[:, 0], 0.0)
        index = np.minimum(np.rint(self.time / self.segments.step).astype(int), values.size - 1)
        return np.asarray(values[index])

    @cached_property
    def energy_closure(self) -> float:
        """Largest energy balance error, divided by the largest energy of bodies, ground and losses [-]."""
        run = self.trajectory
        stored = run.kinetic + run.potential
        scale = max(float(np.max(np.abs(values))) for values in (stored, run.work, run.lost))
        return float(np.max(np.abs(stored - stored[0] - run.work + run.lost))) / scale if scale else 0.0

    @property
    def is_slid_off(self) -> bool:
        """True if a body has left the face of the body below by sliding."""
        return self.trajectory.slid_off

    @cached_property
    def joint_states(self) -> tuple[str, ...]:
        """State of every joint: monolithic, rocking, sliding, rocking and sliding, in flight, overturned, slid off."""
        run, states, end = self.trajectory, [], "slid off" if self.is_slid_off else "overturned"
        for index, joint in enumerate(self.body.joints):
            rocks, slides = run.peak_opening[index] > _OPEN, run.peak_slip[index] > _SLID * joint.width
            state = "rocking and sliding" if rocks and slides else "rocking" if rocks else "sliding"
            state = "in flight" if math.isfinite(run.flight_time[index]) else state if rocks or slides else "monolithic"
            states.append(end if index == run.fallen else state)
        return tuple(states)

    @cached_property
    def joints(self) -> AnswerRows:
        """State, extremes and residual displacement of every joint, lowest first."""
        run = self.trajectory
        return AnswerRows({
            "joint": list(range(1, len(self.body.joints) + 1)), "joint_state": list(self.joint_states),
            "peak_opening": run.peak_opening.tolist(), "residual_opening": self.opening[-1].tolist(),
            "peak_joint_displacement": run.peak_slip.tolist(),
            "residual_joint_displacement": self.joint_displacement[-1].tolist(),
            "least_force": run.least_normal.tolist(), "friction_demand": run.largest_ratio.tolist(),
            "impacts": [
                sum(event.kind == IMPACT and event.joint == k for event in run.events)
                for k in range(len(self.body.joints))
            ],
        })  # fmt: skip

    @cached_property
    def joint_events(self) -> AnswerRows:
        """Openings, impacts, closings and turning points, with opening of the joint and its velocity."""
        events = self.trajectory.events
        return AnswerRows({
            "time": [event.time for event in events], "joint": [event.joint + 1 for event in events],
            "joint_event": [event.kind for event in events],
            "corners_before": [_corners(event.sides_before) for event in events],
            "corners_after": [_corners(event.sides_after) for event in events],
            "opening": [_relative(event.rotation, event.joint) for event in events],
            "velocity_before": [_relative(event.before, event.joint) for event in events],
            "velocity_after": [_relative(event.after, event.joint) for event in events],
        })  # fmt: skip

    def doubts(self) -> list[str]:
        """Return the reasons against the assumptions of the engine: joints that stick and keep their contact.

        Returns
        -------
        list of str
            Sentences with joint and time; empty if the model is credible.
        """
        run = self.trajectory
        sentences: list[str] = []
        if run.unsolved_steps:
            sentences.append(Message(
                "{count} step has no contact force with the stated friction (Painleve's paradox); this step has a "
                "friction of at most 1", {"count": run.unsolved_steps},
                "{count} steps have no contact force with the stated friction (Painleve's paradox); these steps have a "
                "friction of at most 1",
            ))  # fmt: skip
        if not run.assumes_sticking:
            return sentences
        for index, time in enumerate(run.slip_time.tolist()):
            if math.isfinite(time):
                facts = {
                    "joint": index + 1, "time": time, "ratio": float(run.largest_ratio[index]),
                    "friction": self.body.friction[index],
                }  # fmt: skip
                sentences.append(Message(
                    "joint {joint} slides from {time:.4g} s: sticking needs friction {ratio:.3g}, and the friction is "
                    "{friction:g}; later results assume sticking", facts,
                ))  # fmt: skip
            if run.least_normal[index] < 0.0:
                force = -float(run.least_normal[index])
                sentences.append(Message(
                    "the contact force of joint {joint} becomes tensile, up to {force:.2g} of the weight above: the "
                    "bodies above would leave the joint", {"joint": index + 1, "force": force},
                ))  # fmt: skip
        return sentences

    def answer(self) -> Answer:
        """Return outcome, state and displacements of every joint, energy and events, with units and warnings.

        Returns
        -------
        Answer
            Stack, motion, outcome, peaks, joints, events, energy, and warnings.
        """
        return super().answer() | {
            "body": self.body.answer(self.settings.gravity), "motion": motion_answer(self.motion, self.scale),
            "restitution": ", ".join(f"{value:g}" for value in dict.fromkeys(self.body.restitution)),
            "energy_closure": self.energy_closure, "lost_in_joints": float(self.trajectory.lost[-1]),
            "interpenetration": self.trajectory.interpenetration, "energy_created": self.trajectory.energy_created,
            "warnings": self.doubts(),
        }  # fmt: skip

    @property
    def _values(self) -> dict[str, Any]:
        return {"peak_rotation": self.peak_rotation}

    @property
    def summary(self) -> str:
        """The outcome in one sentence, with a hint if a joint loses its contact in an engine without flight."""
        if self.status is not Status.LOST_CONTACT:
            return super().summary
        hint = Message(
            "state the friction of the joints, for the engine with sliding and flight: Stack(..., friction=0.6)"
        )
        return Message.followed(super().summary, hint)

    @property
    def _ending(self) -> str:
        run = self.trajectory
        if run.outcome in {Outcome.NO_UPLIFT, Outcome.FAILED, Outcome.SLID}:
            return str(run.outcome.value)
        if run.outcome is Outcome.OVERTURNED:
            facts: dict[str, Any] = {"joint": run.fallen + 1, "time": run.overturning_time}
            if self.is_slid_off:
                return Message("overturned: the bodies above joint {joint} slid off at {time:.4g} s", facts)
            return Message("overturned at joint {joint}, quarter turn at {time:.4g} s", facts)
        if run.outcome is Outcome.FLEW:
            joint = int(np.nanargmin(run.flight_time))
            return Message(
                "the bodies above joint {joint} flew but did not overturn: no contact from {time:.4g} s, largest gap "
                "{gap:.3g} m",
                {"joint": joint + 1, "time": float(run.flight_time[joint]), "gap": float(run.largest_gap[joint])},
            )
        joint = int(np.argmax(run.peak_opening))
        facts = {"opening": math.degrees(run.peak_opening[joint]), "joint": joint + 1}
        if run.outcome is Outcome.ROCKED_AND_SLID:
            return Message(
                "rocked and slid but did not overturn: largest opening {opening:.4g} degrees at joint {joint}, largest "
                "joint displacement {displacement:.3g} m",
                {**facts, "displacement": float(np.max(run.peak_slip))},
            )
        return Message("rocked but did not overturn: largest opening {opening:.4g} degrees at joint {joint}", facts)

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        rotation = ", ".join(f"{angle:.3g}" for angle in np.degrees(self.rotation[-1]))
        return "rocking", self.time[-1], Message("at ({rotations}) degrees", {"rotations": rotation})

    @property
    def _last_state(self) -> dict[str, Any]:
        return {
            "time": self.time[-1], "rotation": self.rotation[-1].tolist(),
            "angular_velocity": self.angular_velocity[-1].tolist(),
        }  # fmt: skip

    @property
    def _samples(self) -> dict[str, FloatArray]:
        run = self.trajectory
        return {
            "time": self.time, "ground_acceleration": self.ground_acceleration, "kinetic_energy": run.kinetic,
            "potential_energy": run.potential, "work_of_ground": run.work, "lost_in_joints": run.lost,
        }  # fmt: skip

    def exported(self) -> "Table":
        """Return the table of samples, with tables of joints, events, and samples of bodies and joints."""
        table, count = super().exported(), len(self.body.bodies)
        samples = {
            "time": np.repeat(self.time, count), "joint": np.tile(np.arange(1, count + 1), self.time.size),
            "rotation": self.rotation.ravel(), "angular_velocity": self.angular_velocity.ravel(),
            "opening": self.opening.ravel(), "joint_displacement": self.joint_displacement.ravel(),
        }  # fmt: skip
        return replace(table, related={**table.related, "joint_sample": Table.of("joint_sample", samples)})

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        return {"joints": self.joints, "joint_events": self.joint_events}

    def _plot(self, **_: Any) -> "Figure":
        from rocking.plots import stack_picture

        return stack_picture(self)

    @property
    def _facts(self) -> dict[str, Any]:
        return {
            "body": "Stack", "mass": self.body.mass, "bodies": len(self.body.bodies),
            "friction": ", ".join(f"{value:g}" for value in self.body.friction),
            "motion": "none: free rocking" if self.motion is None else self.motion.name,
            "motion_provenance": motion_provenance(self.motion), "scale": self.scale,
        }  # fmt: skip


def response_of_stack(
    body: Stack,
    motion: Motion | None,
    restitution: Any,
    settings: StackSettings,
    *,
    start: tuple[Any, Any] = (0.0, 0.0),
    scale: float = 1.0,
    duration: float | None = None,
    engine: str = "auto",
) -> StackResponse:
    """Return the response of a stack. The durations are those of the bodies as one body."""
    if restitution is not None and (np.ndim(restitution) or restitution != DEFAULT_RESTITUTION):
        raise InvalidValueError(
            "the joints of a stack have their own restitution: Stack(..., restitution=...)", parameter="restitution",
            value=restitution,
        )  # fmt: skip
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    count = len(body.bodies)
    frequencies = [
        body.side_above(k, foot, settings.gravity).frequency_parameter for k in range(count) for foot in FEET
    ]
    slow, quick = min(frequencies), max(frequencies)
    rotation, rates = start_within(start, count, 100.0 * quick)
    if duration is not None:
        checks.positive("duration", duration, "s")
    length = duration or (_FREE if motion is None else motion.duration * slow + _AFTER) / slow
    if motion is None:
        segments = ground_at_rest(_FINE / quick, length)
    else:
        segments = motion.segments()
        segments = followed(segments, length, math.ceil(quick * segments.step / _FINE), motion)
    trajectory = run(body, segments, settings, rotation, rates, scale=scale, engine=engine)
    response = StackResponse(body, motion, settings, segments, scale, trajectory)
    for sentence in () if errors.silenced(PureRockingWarning) else response.doubts():
        errors.warn(sentence, PureRockingWarning)
    return response


def _relative(values: tuple[float, ...], joint: int) -> float:
    return values[joint] - (values[joint - 1] if joint else 0.0)


def _corners(sides: tuple[int, ...]) -> str:
    return ", ".join(_CORNERS[side] for side in sides)
