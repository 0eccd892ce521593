"""Response of a 3D body: attitude, contact, impacts, energy, outcome, direction."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.answers import AnswerRows
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.energy_balance import ResponseEnergy
from rocking.dynamics.response_base import ResponseBase, check_samples, interval_rows, motion_provenance
from rocking.dynamics.rolling import attitude
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.event_functions import NEARLY_FLAT
from rocking.dynamics.rolling.ground import Component, SpatialGround, ground_of
from rocking.dynamics.rolling.impact_laws import SpatialImpactLaw, law_of
from rocking.dynamics.rolling.reference import SpatialReference
from rocking.dynamics.rolling.settings import SpaceSettings
from rocking.dynamics.rolling.trajectory import SpatialEventKind, SpatialTrajectory, States, pivots, states_of
from rocking.errors import InvalidValueError
from rocking.messages import Message, Range
from rocking.motions.motion import GroundMotion
from rocking.motions.summary import motion_answer
from rocking.outcome import ContactMode, Outcome
from rocking.portable import applied, dot, gauss_legendre, norm

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_NODES, _WEIGHTS = gauss_legendre(20)
_AXES = ("x", "y", "z")

SPATIAL_IMPACT = np.dtype([
    ("time", "f8"), ("energy_before", "f8"), ("energy_after", "f8"), ("impulse", "f8"), ("pull", "f8"),
    ("contact", "U8"), ("vertices", "U64"),
])  # fmt: skip
"""Fields of `SpatialResponse.impacts`.

Time [s], kinetic energy before and after [J], vertical impulse [N s], largest tensile impulse without slip [N s],
contact after the impact, and vertices of the contact.
"""


@dataclass(frozen=True, eq=False, repr=False)
class SpatialResponse(ResponseBase):
    """Response of a 3D body without friction.

    Quantities that take long to compute are computed at first access.

    Parameters
    ----------
    body : SpatialBody
        The body.
    ground : SpatialGround
        The integrated motion [m/s2].
    law : SpatialImpactLaw
        Restitution.
    settings : SpaceSettings
        Settings of the integration.
    time : ndarray
        Times of the samples, up to the end or until the body has fallen [s].
    trajectory : SpatialTrajectory
        Result of the engine.
    end : float
        End of the response [s]. The engine may continue after this time to determine the outcome.
    components : tuple
        Motions along x, y and upwards; None for a component at rest.
    ends_early : bool
        True if the response ends 15 / p after the motion because impacts lost no energy in this time.
    scale : float
        Factor on the motion [-].
    """

    body: SpatialBody
    ground: SpatialGround
    law: SpatialImpactLaw
    settings: SpaceSettings
    time: FloatArray
    trajectory: SpatialTrajectory
    end: float
    components: tuple[Component, Component, Component] = (None, None, None)
    ends_early: bool = False
    scale: float = 1.0

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of the motions along x, y and upwards."""
        x, y, z = ("none" if motion is None else motion.name for motion in self.components)
        return x, y, z

    @cached_property
    def states(self) -> States:
        """Attitude, velocity and contact at the samples."""
        return self.at(self.time)

    @property
    def quaternion(self) -> FloatArray:
        """Attitude (s, x, y, z) at the samples, body axes to axes of the ground, shape (n, 4) [-]."""
        return self.states.quaternion

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity at the samples in axes of the ground, shape (n, 3) [rad/s]."""
        return self.states.angular_velocity

    @cached_property
    def tilt(self) -> FloatArray:
        """Angle between the axis of the body and the vertical at the samples [rad]."""
        return attitude.tilt(self.quaternion)

    @cached_property
    def azimuth(self) -> FloatArray:
        """Direction of tilt at the samples, from x towards y [rad]."""
        return attitude.azimuth(self.quaternion)

    @property
    def contact(self) -> IntArray:
        """Code of the regime at the samples: 0 rest, 1 edge, 2 vertex, 3 rolling."""
        return self.states.contact

    @cached_property
    def centre(self) -> FloatArray:
        """Path of the centre of mass relative to the ground, z upwards, shape (n, 3) [m]."""
        return self.states.point(self.body.centre)

    @cached_property
    def top(self) -> FloatArray:
        """Path of the point above the centre of mass at twice its height, shape (n, 3) [m]."""
        return self.states.point(self.body.centre * np.array([1.0, 1.0, 2.0]))

    @cached_property
    def intervals(self) -> list[tuple[float, float, ContactMode, tuple[int, ...]]]:
        """Intervals with constant contact: start and end [s], regime, and vertices in contact."""
        rows: list[tuple[float, float, ContactMode, tuple[int, ...]]] = []
        for piece in self.trajectory.pieces:
            if rows and piece.start >= self.end:
                break
            now = piece.contact.mode, piece.contact.points
            if rows and rows[-1][2:] == now:
                rows[-1] = (rows[-1][0], min(piece.end, self.end), *now)
            else:
                rows.append((piece.start, min(piece.end, self.end), *now))
        return rows

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order, with the fields of `SPATIAL_IMPACT`."""
        rows = []
        for event in self.trajectory.impacts:
            if event.time > self.end:
                break
            contact, push = event.contact, event.impulses
            total = push.sum() if contact.mode is ContactMode.EDGE else push[-1]
            vertices = "-".join(map(str, contact.points))
            pull = max(0.0, -float(push.min()))
            rows.append((event.time, event.before, event.after, total, pull, contact.mode.name.lower(), vertices))
        return np.array(rows, dtype=SPATIAL_IMPACT)

    @property
    def peak_tilt(self) -> float:
        """Largest tilt, including times between the samples; a quarter turn after overturning [rad]."""
        return self.trajectory.peak_tilt

    @cached_property
    def overturning_direction(self) -> float:
        """Direction of overturning, from x towards y [rad]; NaN without overturning."""
        return self.trajectory.direction

    @property
    def overturned_over(self) -> str:
        """Edge, vertex or rim over which the body overturned, as text; empty without overturning."""
        over = self.trajectory.overturned_over
        if over is None or not over.points:
            return "" if over is None else "its rim"
        return f"{over.mode.name.lower()} {'-'.join(map(str, over.points))}"

    @cached_property
    def still_rocking(self) -> bool:
        """True if the body has not overturned and still moves at the end. `impacts` excludes later impacts."""
        return self.outcome is Outcome.ROCKED and int(self.at(self.end).contact[0]) != ContactMode.REST.code

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        last = self.at(self.end)
        angle, rate = np.degrees(attitude.tilt(last.quaternion)[0]), math.hypot(*last.angular_velocity[0])
        template = "tilted by {rotation:.3g} degrees, rotating at {velocity:.3g} rad/s"
        return "rocking", self.end, Message(template, {"rotation": angle, "velocity": rate})

    @property
    def _end_reason(self) -> str:
        if not self.ends_early:
            return super()._end_reason
        return (
            f"no impact lost energy in the {_AFTER:g} / p after the motion, so that the body does not come to rest; "
            "use duration= in Python for a longer response"
        )

    @property
    def _ending(self) -> str:
        if self.outcome is Outcome.NO_UPLIFT:
            return str(self.outcome.value)
        count = self.impacts.size
        impacts = f"{count} impact{'s' * (count != 1)}"
        if self.outcome is Outcome.OVERTURNED:
            contact = f" over {self.overturned_over}" if self.overturned_over else ""
            return (
                f"overturned towards {math.degrees(self.overturning_direction):.4g} degrees{contact} after {impacts}, "
                f"past the point of no return at {self.overturning_time:.4g} s"
            )
        sentence = f"rocked but did not overturn: largest tilt {math.degrees(self.peak_tilt):.4g} degrees, {impacts}"
        if tensile := int((self.impacts["pull"] > 1e-9 * np.abs(self.impacts["impulse"])).sum()):
            sentence += f"; at {tensile} of them a corner would have slipped or bounced rather than stuck"
        if self.cut_impacts:
            sentence += f"; at {self.cut_impacts} of them the base is so narrow that the loss is Housner's"
        if passages := self.near_flat_passages:
            sentence += (
                f"; it passed {passages} time{'s' * (passages != 1)} through a nearly flat position, after which small "
                "changes have large effects: use many motions, not one"
            )
            if held_time := self.trajectory.held:
                sentence += f"; in these positions its rim would have hopped or slipped for {held_time:.2g} s"
        return sentence

    @cached_property
    def cut_impacts(self) -> int:
        """Number of impacts with an impulse position beyond the new foot, which the model moves to the foot."""
        cut = getattr(getattr(self.law, "model", None), "cut", None)
        if cut is None or self.body.matter is None:
            return 0
        solid, count = self.body.matter()[0], 0
        for old, event in pairwise(self.trajectory.events):
            if event.time > self.end:
                break
            if event.kind is not SpatialEventKind.IMPACT:
                continue
            if self.body.round:  # direction perpendicular to the axis of rotation
                before = self.at(np.nextafter(event.time, 0.0))
                spin = applied(before.rotation[0].T, before.angular_velocity[0])
                step = self.body.radius / norm(spin[:2]) * np.array([spin[1], -spin[0], 0.0])
            else:
                step, axis = event.contact.pivot - old.contact.pivot, event.contact.axis
                step = step if axis is None else step - dot(step, axis) * axis
            count += cut(solid, step)
        return count

    @cached_property
    def near_flat_passages(self) -> int:
        """Number of passages of a round base through a tilt below 1 % of its slenderness angle."""
        if not self.body.round:
            return 0
        rolling = [p for p in self.trajectory.pieces if p.contact.mode is ContactMode.ROLLING and p.start < self.end]
        tilts = attitude.tilt(np.array([p.quaternions[0] for p in rolling]).reshape(-1, 4))
        low = (tilts[1:-1] <= tilts[:-2]) & (tilts[1:-1] < tilts[2:])
        return int((low & (tilts[1:-1] < NEARLY_FLAT * self.body.radius / self.body.centre[2])).sum())

    @cached_property
    def energy(self) -> ResponseEnergy:
        """Kinetic and potential energy, work of the ground and losses at the samples [J].

        The work of the ground is the integral of -m a_g . v_C, by Gauss quadrature over every step of the engine. The
        losses are the losses of the impacts. No term is computed from the energy balance, so that the balance is a
        check.
        """
        impacts = self.trajectory.impacts
        lost = np.concatenate([[0.0], np.cumsum([event.before - event.after for event in impacts])])
        lost = lost[np.searchsorted([event.time for event in impacts], self.time, side="right")]
        potential = self.body.mass * self.settings.gravity * self.states.rise
        # an impact at the start is before the first sample
        return ResponseEnergy(self.time, self.states.kinetic, potential, self._work, lost - lost[0])

    @property
    def _work(self) -> FloatArray:
        """Work of the ground up to every sample [J]."""
        work, total, body = np.zeros(self.time.size), 0.0, self.body
        for piece in self.trajectory.pieces:
            first, last = np.searchsorted(self.time, [piece.start, piece.end], side="left")
            if not (piece.end > piece.start and len(piece.quaternions) > 1 and piece.start < self.ground.end):
                work[first:last] = total
                continue
            stops = np.concatenate([[piece.start], self.time[first:last], [piece.end]])
            half = 0.5 * np.diff(stops)
            times = (0.5 * (stops[1:] + stops[:-1]))[:, None] + half[:, None] * _NODES
            q, w, position = piece.at(np.clip((times.ravel() - piece.start) / piece.length, 0.0, piece.until))
            states = States(body, q, w, pivots(body, piece, q), position, np.zeros(len(q), dtype=np.int64))
            power = -body.mass * (self.ground.at(times.ravel()) * states.centre_velocity).sum(axis=1)  # Eq. 46
            increments = applied(power.reshape(times.shape), _WEIGHTS) * half
            work[first:last] = total + np.cumsum(increments)[:-1]
            total += float(increments.sum())
        work[self.time >= self.trajectory.pieces[-1].end] = total
        return work

    def at(self, time: Any) -> States:
        """Return the state of the body at any times within the response.

        Parameters
        ----------
        time : array_like, shape (n,)
            Times [s].

        Returns
        -------
        States
            Attitude, velocity, contact, positions.

        Raises
        ------
        InvalidValueError
            If a time is not finite, or is outside the response by more than rounding.
        """
        times = np.atleast_1d(self._times_within(time, self.trajectory.pieces[-1].end))
        return states_of(self.body, self.trajectory, times)

    @property
    def _values(self) -> dict[str, Any]:
        direction = self.overturning_direction
        return {
            "motions": {
                axis: motion_answer(motion, self.scale) for axis, motion in zip(_AXES, self.components, strict=True)
            },
            "restitution": self.law.label, "peak_tilt": self.peak_tilt,
            "direction": None if math.isnan(direction) else direction,
            "overturned_over": self.overturned_over or None, "ends_early": self.ends_early,
            "energy_closure": self.energy.closure,
        }  # fmt: skip

    @property
    def _last_state(self) -> dict[str, Any]:
        last = self.at(self.end)
        return {
            "time": self.end, "quaternion": last.quaternion[0],
            "angular_velocity": dict(zip(_AXES, last.angular_velocity[0].tolist(), strict=True)),
        }  # fmt: skip

    @property
    def _samples(self) -> dict[str, FloatArray]:
        def axes(name: str, rows: FloatArray) -> dict[str, FloatArray]:
            return {f"{name}_{axis}": rows[:, k] for k, axis in enumerate(_AXES)}

        energy, quaternion = self.energy, self.quaternion
        return {
            "time": self.time,
            **{f"quaternion_{axis}": quaternion[:, k] for k, axis in enumerate(("s", *_AXES))},
            **axes("angular_velocity", self.angular_velocity),
            "tilt": self.tilt, "azimuth": self.azimuth, "contact": self.contact.astype(np.float64),
            **axes("centre", self.centre), **axes("ground_acceleration", self.ground.at(self.time)),
            "kinetic_energy": energy.kinetic, "potential_energy": energy.potential,
            "work_of_ground": energy.work, "energy_lost": energy.lost,
        }  # fmt: skip

    def _plot(self, **options: Any) -> "Figure":
        from rocking.plots import spatial_picture

        return spatial_picture(self, **options)

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        rows = [(start, end, mode.name.lower(), points) for start, end, mode, points in self.intervals]
        return {
            "intervals": interval_rows(rows, "contact", "vertices"), "impacts": AnswerRows.of(self.impacts),
        }  # fmt: skip

    @property
    def _facts(self) -> dict[str, Any]:
        direction = self.overturning_direction
        return {
            **({} if math.isnan(direction) else {"direction": direction}),
            **self.body.facts,
            "ends_early": self.ends_early,
            "restitution": self.law.label,
            **{f"motion_{axis}": name for axis, name in zip(("x", "y", "vertical"), self.names, strict=True)},
            "motion_provenance": [motion_provenance(motion) for motion in self.components],
        }


_FINE, _AFTER, _LONG = 0.05, 15.0, 300.0


def response_in_space(
    body: Any,
    components: tuple[Component, Component, Component],
    restitution: Any,
    settings: SpaceSettings,
    *,
    start: SpatialStart,
    scale: float = 1.0,
    duration: float | None = None,
) -> SpatialResponse:
    """Return the response of a 3D body without friction. Without components, the ground is at rest."""
    # duration [s]: by default to 15 / p after the motion; if the body still rocks with losses, until it rests or
    # has fallen, at most to 300 / p after the motion
    spatial_body = SpatialBody.of(body)
    scale = checks.within("scale", scale, -1e6, 1e6)
    start.check_grounded()
    start = started(start, spatial_body.frequency(conventions.g))
    p, motions = spatial_body.frequency(settings.gravity), [motion for motion in components if motion is not None]
    if motions and not all(hasattr(motion, "duration") for motion in motions):
        ground_of(*components)  # raises an error with the name of the invalid component
    default_length = max(motion.duration for motion in motions) + _AFTER / p if motions else _LONG / p
    length = default_length if duration is None else checks.positive("duration", duration, "s")
    ground = ground_of(*components, until=length if motions else np.inf, scale=scale)
    plausibility.warn(plausibility.of_scaled(motions, scale))
    law = law_of(restitution, spatial_body)

    def followed(until: float) -> SpatialTrajectory:
        engine = SpatialReference(spatial_body, ground, law, settings)
        return engine.run(start.quaternion, start.body_velocity, until)

    trajectory, ends_early, min_length = followed(length), False, length if motions else 0.0
    if motions and duration is None and _rocks(trajectory):
        ends_early = not _loses_energy(trajectory, length - _AFTER / p)
        longest = length + (_LONG - _AFTER) / p
        longer = trajectory if ends_early else followed(longest)
        if longer is not trajectory and longer.outcome is not Outcome.FAILED:
            trajectory, length = longer, longest
    last = trajectory.pieces[-1]
    is_at_rest = duration is None and last.contact.mode is ContactMode.REST
    end = min(length, max(min_length, last.start + _FINE / p) if is_at_rest else last.end)
    steps = [motion.time_step for motion in motions if isinstance(motion, GroundMotion)]
    time = samples(min(steps, default=_FINE / p), end)
    return SpatialResponse(spatial_body, ground, law, settings, time, trajectory, end, components, ends_early, scale)


def _rocks(history: SpatialTrajectory) -> bool:
    return history.outcome is Outcome.ROCKED and history.pieces[-1].contact.mode is not ContactMode.REST


def _loses_energy(history: SpatialTrajectory, since: float) -> bool:
    """Return True if an impact after a time loses energy. Without such a loss, a rolling rim never comes to rest."""
    return any(event.after < event.before for event in history.impacts if event.time > since)


def started(start: SpatialStart, pace: float) -> SpatialStart:
    """Return a start after checking its ranges. `pace` is the frequency parameter, or sqrt(g / size) [1/s]."""
    max_velocity = 100.0 * pace
    tilt = checks.within("tilt", start.tilt, 0.0, 0.5 * math.pi, unit="rad", open_high=True, hint="in radians")
    azimuth, yaw = (checks.number(name, getattr(start, name), "rad") for name in ("azimuth", "yaw"))
    spin = checks.real_array("angular_velocity", start.angular_velocity, "rad/s")
    if spin.shape != (3,) or not (np.abs(spin) <= max_velocity).all():
        raise InvalidValueError(
            "{parameter} must be three numbers {allowed}, got {value}", parameter="angular_velocity",
            allowed=Range(-max_velocity, max_velocity, "rad/s"), value=start.angular_velocity,
        )  # fmt: skip
    height = checks.within("height", start.height, 0.0, 1e4, unit="m", hint="the ground is at zero")
    velocity = checks.real_array("velocity", start.velocity, "m/s")
    if velocity.shape != (3,) or not (np.abs(velocity) <= 1e4).all():
        raise InvalidValueError(
            "{parameter} must be three numbers {allowed}, got {value}", parameter="velocity",
            allowed=Range(-1e4, 1e4, "m/s"), value=start.velocity,
        )  # fmt: skip
    return replace(start, tilt=tilt, azimuth=azimuth, yaw=yaw, angular_velocity=spin, height=height, velocity=velocity)


def samples(step: float, end: float) -> FloatArray:
    """Return the times of samples up to an end [s]."""
    count = end / step
    check_samples(count)
    return np.asarray(np.arange(math.floor(count + 1e-9) + 1) * step, dtype=np.float64).clip(max=end)
