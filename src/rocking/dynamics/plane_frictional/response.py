"""Response of a plane body with friction: positions, regimes, impacts, sliding, forces, energy, outcome."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.answers import AnswerRows
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.combined import label_of
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters, is_none
from rocking.dynamics.plane_frictional.base import PlaneBase, Start, state_at_start
from rocking.dynamics.plane_frictional.engine import ContactEngine
from rocking.dynamics.plane_frictional.history import SAMPLED, History, impacts_of, positions_of, regimes_of
from rocking.dynamics.plane_frictional.impact_resolution import GroundContact
from rocking.dynamics.plane_frictional.settings import ContactSettings
from rocking.dynamics.response_base import ResponseBase, followed, ground_at_rest, max_duration, motion_provenance
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class ContactEnergy:
    """Energy in the frame of the ground."""

    time: FloatArray  # times of the samples [s]
    kinetic: FloatArray  # kinetic energy, and potential energy relative to the body at rest [J]
    potential: FloatArray
    work: FloatArray  # work of the ground since the start [J]
    lost_in_impacts: FloatArray  # lost_in_impacts, lost_in_friction: energy lost since the start [J]
    lost_in_friction: FloatArray

    @property
    def gap(self) -> FloatArray:
        """Energy balance error: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        lost = self.lost_in_impacts + self.lost_in_friction
        return np.asarray(stored + lost - self.work - (stored[0] + lost[0]), dtype=np.float64)  # Eq. 45

    @property
    def closure(self) -> float:
        """Largest energy balance error, divided by the largest stored energy, loss or work [-]."""
        energies = (self.kinetic + self.potential, self.lost_in_impacts, self.lost_in_friction, self.work)
        scale = max(1e-300, *(float(np.abs(energy).max()) for energy in energies))
        return float(np.abs(self.gap).max()) / scale


@dataclass(frozen=True)
class ContactForces:
    """Forces of the ground on the body."""

    time: FloatArray  # times of the samples [s]
    horizontal: FloatArray  # total of both feet, to the right [N]
    left: FloatArray  # left, right: vertical force on each foot [N]
    right: FloatArray
    usage: FloatArray  # |horizontal| divided by mu times the vertical force [-]; zero in flight

    @property
    def vertical(self) -> FloatArray:
        """Vertical force on both feet together [N]."""
        return np.asarray(self.left + self.right)


@dataclass(frozen=True, eq=False, repr=False)
class ContactResponse(ResponseBase):
    """Response of a plane body with friction, as returned by `simulate`.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse, optional
        The ground motion; None for ground at rest.
    base : PlaneBase
        Inertia and feet of the body.
    law : GroundContact
        Friction and restitution.
    settings : ContactSettings
        Settings of the integration, and of the ground.
    segments : Segments
        The integrated motion [m/s2].
    scale : float
        Factor on the motion [-].
    trajectory : History
        Result of the engine.
    restitution : str
        Name of the restitution.
    """

    body: Body
    motion: GroundMotion | Pulse | None
    base: PlaneBase
    law: GroundContact
    settings: ContactSettings
    segments: Segments
    scale: float
    trajectory: History
    restitution: str

    @cached_property
    def _record(self) -> FloatArray:
        rows = self.trajectory.samples
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        return rows[: int(bad[0])] if bad.size else rows

    def _sampled(self, name: str) -> FloatArray:
        """Return one column of the record. Forces and energies are per unit of mass."""
        return np.asarray(self._record[:, SAMPLED.index(name)], dtype=np.float64)

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, up to the end or until the body has fallen [s]."""
        return np.asarray(np.arange(len(self._record)) * self.segments.step, dtype=np.float64)

    @property
    def displacement(self) -> FloatArray:
        """Displacement x of the centre of mass along the ground, to the right [m]."""
        return self._sampled("x")

    @property
    def rise(self) -> FloatArray:
        """Height z of the centre of mass above its position at rest [m]."""
        return self._sampled("rise")

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta, positive clockwise [rad]."""
        return self._sampled("rotation")

    @property
    def horizontal_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, to the right [m/s]."""
        return self._sampled("u")

    @property
    def vertical_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, upwards [m/s]."""
        return self._sampled("w")

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' [rad/s]."""
        return self._sampled("spin")

    @property
    def regime(self) -> IntArray:
        """Regime just before every sample, as `Regime.code`."""
        return np.asarray(self._sampled("regime"), dtype=np.int64)

    @cached_property
    def regimes(self) -> np.ndarray:
        """Regimes in order, with the fields of `REGIME`: start, end, regime, feet, slip, sliding distance."""
        return regimes_of(self.trajectory, self.base)

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order, with the fields of `IMPACT`: time, feet, velocities, impulses, energy loss, slip."""
        return impacts_of(self.trajectory, self.base)

    @property
    def sliding_distance(self) -> float:
        """Total path of the feet in contact along the ground [m]."""
        return self.trajectory.slid

    @cached_property
    def energy(self) -> ContactEnergy:
        """Kinetic and potential energy, work of the ground, losses in impacts and in friction [J]."""
        mass, u, w, spin = self.base.mass, self.horizontal_velocity, self.vertical_velocity, self.angular_velocity
        return ContactEnergy(
            self.time,
            0.5 * mass * (u**2 + w**2 + self.base.inertia * spin**2),  # Eq. 62
            mass * self.settings.gravity * self.rise,
            *(mass * self._sampled(name) for name in ("work", "impact_loss", "friction_loss")),
        )

    @cached_property
    def forces(self) -> ContactForces:
        """Forces of the ground on the feet [N] and friction usage [-]. At an event, the values before the event."""
        along, left, right = (self._sampled(name) for name in ("tangential", "normal_left", "normal_right"))
        capacity, mass = self.law.friction * (left + right), self.base.mass
        usage = np.zeros(capacity.size)
        np.divide(np.abs(along), capacity, out=usage, where=capacity > 0.0)  # Eq. 78
        return ContactForces(self.time, mass * along, mass * left, mass * right, usage)

    @property
    def friction_usage(self) -> float:
        """Largest horizontal force, divided by mu times the vertical force [-]; 1 if the body slides."""
        return self.trajectory.usage

    @property
    def peak_rotation(self) -> float:
        """Largest rotation, including times between the samples; a quarter turn after overturning [rad]."""
        return self.trajectory.peak

    @property
    def _never_rests(self) -> bool:
        return self.law.is_lossless

    @property
    def _ending(self) -> str:
        ending = Message(self.outcome.value)
        if self.peak_rotation > 0.0 and self.outcome is not Outcome.OVERTURNED:
            rotation = np.degrees(self.peak_rotation)
            ending = Message(
                "{outcome}, largest rotation {rotation:.4g} degrees", {"outcome": ending, "rotation": rotation}
            )
        if self.sliding_distance > 0.0:
            facts = {"outcome": ending, "distance": self.sliding_distance}
            ending = Message("{outcome}, total sliding distance {distance:.4g} m", facts)
        return ending

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        angle, rate = np.degrees(self.rotation[-1]), self.angular_velocity[-1]
        doing = self.trajectory.intervals[-1][2].regime.value
        state = Message("at {rotation:.3g} degrees and {velocity:.3g} rad/s", {"rotation": angle, "velocity": rate})
        return doing, self.time[-1], state

    def at(self, time: Any) -> FloatArray:
        """Return the position at any times within the response.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            x [m], rise [m] and theta [rad] along the last axis.

        Raises
        ------
        InvalidValueError
            If a time is not finite, or is outside the response by more than rounding.
        """
        return positions_of(self.trajectory, self._times_within(time, self.trajectory.end))

    @property
    def _values(self) -> dict[str, Any]:
        law, energy = self.law, self.energy
        imposed = None if law.restitution is None else dict(zip(("left", "right"), law.restitution, strict=True))
        return {
            "body": self.body.answer(self.settings.gravity), "motion": motion_answer(self.motion, self.scale),
            "initial_rotation": float(self.rotation[0]), "friction": law.friction,
            "friction_assumed": isinstance(law.friction, conventions.Assumed), "normal_restitution": law.bounce,
            "normal_restitution_law": law.bounce_law, "restitution": self.restitution, "coefficient": imposed,
            "peak_rotation": self.peak_rotation,
            "sliding_distance": self.sliding_distance, "residual_displacement": float(self.displacement[-1]),
            "friction_usage": self.friction_usage, "energy_lost": float(energy.lost_in_impacts[-1]),
            "lost_in_friction": float(energy.lost_in_friction[-1]), "energy_closure": energy.closure,
        }  # fmt: skip

    @property
    def _last_state(self) -> dict[str, Any]:
        return {
            "time": self.time[-1], "rotation": self.rotation[-1], "angular_velocity": self.angular_velocity[-1],
        }  # fmt: skip

    @property
    def _samples(self) -> dict[str, FloatArray]:
        energy, forces = self.energy, self.forces
        return {
            "time": self.time, "displacement": self.displacement, "rise": self.rise, "rotation": self.rotation,
            "horizontal_velocity": self.horizontal_velocity, "vertical_velocity": self.vertical_velocity,
            "angular_velocity": self.angular_velocity, "regime": self._sampled("regime"),
            "sliding_distance": self._sampled("slid"), "horizontal_force": forces.horizontal,
            "vertical_force_left": forces.left, "vertical_force_right": forces.right, "kinetic_energy": energy.kinetic,
            "potential_energy": energy.potential, "work_of_ground": energy.work,
            "energy_lost": energy.lost_in_impacts, "lost_in_friction": energy.lost_in_friction,
        }  # fmt: skip

    def _plot(self, **options: Any) -> "Figure":
        from rocking.plots import regimes_picture

        return regimes_picture(self, **options)

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        intervals = AnswerRows.of(self.regimes).columns
        regimes = [name.lower() for name in self.regimes["regime"].tolist()]
        return {"intervals": AnswerRows({**intervals, "regime": regimes}), "impacts": AnswerRows.of(self.impacts)}

    @property
    def _facts(self) -> dict[str, Any]:
        motion, law, base = self.motion, self.law, self.base
        r = law.restitution
        return {
            "body": type(self.body).__name__,
            "mass": base.mass,
            "moment_of_inertia": base.mass * base.inertia,
            "centre_height": base.height,
            "half_width_left": base.left,
            "half_width_right": base.right,
            "friction": law.friction,
            "normal_restitution": law.bounce,
            "normal_restitution_law": law.bounce_law,
            "restitution": "complementarity" if r is None else f"left {r[0]:.9g}, right {r[1]:.9g}",
            "motion": "none: ground at rest" if motion is None else motion.name,
            "motion_provenance": motion_provenance(motion),
            "scale": self.scale,
        }


FINE, AFTER = 0.1, 15.0
"""Products of sqrt(g / R) with the step between samples under a pulse, and with the duration after the motion."""

_FREE = 60.0  # product of sqrt(g / R) with the duration on ground at rest
LONGER = 30.0, 60.0, 120.0, 240.0, 300.0
"""Longer durations after the motion, which are used in this order if the body still rocks."""


def response_with_contact(
    body: Body,
    motion: GroundMotion | Pulse | None,
    restitution: Any,
    settings: ContactSettings,
    *,
    start: Start,
    scale: float = 1.0,
    duration: float | None = None,
) -> ContactResponse:
    """Return the response of a plane body with friction. If `motion` is None, the ground is at rest."""
    # restitution: None for impacts by complementarity
    # duration [s]: by default to 15 sqrt(R / g) after the motion (to 60 sqrt(R / g) on ground at rest), and up to
    # 300 sqrt(R / g) if the body still rocks
    base = PlaneBase.of_body(body)
    imposed = imposed_on(body, restitution, settings)
    law = GroundContact(settings.friction, settings.normal_restitution, imposed, settings.normal_restitution_law)
    scale = checks.within("scale", scale, -1e6, 1e6)
    segments = _segments(motion, base, settings.gravity, duration)
    plausibility.warn(plausibility.of_scaled([motion], scale))

    def computed(segments: Segments) -> History:
        return ContactEngine(base, segments, law, settings, scale).run(state_at_start(start, base))

    history, slow = computed(segments), math.sqrt(base.size / settings.gravity)
    for after in LONGER if duration is None and not law.is_lossless else ():
        length = (0.0 if motion is None else motion.duration) + after * slow
        if not history.still_rocking or length > max_duration(segments.step):
            break
        if length > segments.duration:
            longer = _segments(motion, base, settings.gravity, length)
            extended = computed(longer)
            if extended.outcome is Outcome.FAILED:
                break
            history, segments = extended, longer
    return ContactResponse(body, motion, base, law, settings, segments, scale, history, label_of(restitution))


def imposed_on(body: Body, restitution: Any, settings: ContactSettings) -> tuple[float, float] | None:
    """Return the imposed coefficients for landing left and right [-]; None if none is imposed."""
    if is_none(restitution):
        return None
    if isinstance(restitution, ImpactLaw):
        raise InvalidValueError(
            "{parameter} must be {allowed} with friction, got {law}; simulate() without friction accepts laws",
            parameter="restitution", allowed="a model, a name or a number", law=type(restitution).__name__,
        )  # fmt: skip
    parameters = RockingParameters.of_body(body, restitution, settings.gravity)
    return parameters.left.coefficient, parameters.right.coefficient


def length_of(motion: GroundMotion | Pulse, slow: float, duration: float | None, after: float = AFTER) -> float:
    """Return the duration of a history [s].

    `slow` is sqrt(R / g) [s]; `after` is the time after the motion over `slow`.
    """
    if duration is not None:
        return checks.positive("duration", duration, "s")
    return motion.duration + after * slow


def _segments(motion: Any, base: PlaneBase, gravity: float, duration: float | None) -> Segments:
    slow = math.sqrt(base.size / gravity)
    if motion is None:
        length = _FREE * slow if duration is None else checks.positive("duration", duration, "s")
        return ground_at_rest(length / max(1, math.ceil(length / (FINE * slow) - 1e-9)), length)
    checks.of_kind("motion", motion, (GroundMotion, Pulse), "a GroundMotion, a pulse or None")
    length = length_of(motion, slow, duration)
    segments = motion.segments()
    return followed(segments, length, math.ceil(segments.step / (FINE * slow)), motion)
