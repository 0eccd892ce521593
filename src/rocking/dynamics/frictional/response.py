"""Response of a body on the vertices of its hull: attitude, position, contacts, impacts, sliding, outcome."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, plausibility
from rocking.answers import AnswerRows
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.engine import HullEngine
from rocking.dynamics.frictional.ground import HullGround, unit
from rocking.dynamics.frictional.histories import ENGINES, chosen, start_of, traced
from rocking.dynamics.frictional.history import HullEventKind, HullHistory
from rocking.dynamics.frictional.restitution import law_on_hull
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.response_base import ResponseBase, interval_rows, motion_provenance
from rocking.dynamics.rolling import attitude
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.ground import Component, ground_of
from rocking.dynamics.rolling.response import samples, started
from rocking.messages import Message
from rocking.motions.motion import GroundMotion
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome
from rocking.portable import applied

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FINE = 0.05  # time between samples without a record, divided by sqrt(size / g)
_NO_SLIP = 1e-6  # sliding distance / size; results do not mention a smaller distance

HULL_IMPACT = np.dtype([("time", "f8"), ("energy_before", "f8"), ("energy_after", "f8"), ("vertices", "U64")])
"""Fields of `HullResponse.impacts`: time [s], kinetic energy before and after [J], vertices in contact after."""

_AXES = ("x", "y", "z")


def response_on_hull(
    body: Any,
    components: tuple[Component, Component, Component],
    restitution: Any,
    settings: HullSettings,
    *,
    start: SpatialStart,
    engine: str = "auto",
    scale: float = 1.0,
    duration: float | None = None,
) -> "HullResponse":
    """Return the response of a 3D body with friction. Without components, the ground is at rest."""
    # duration: shortest duration [s]; by default, the response ends when the body rests after the motion
    hull_body = HullBody.of(body)
    law = law_on_hull(restitution)
    scale = checks.within("scale", scale, -1e6, 1e6)
    start = started(start, math.sqrt(settings.gravity / hull_body.size))
    until = np.inf if duration is None else checks.positive("duration", duration, "s")
    motions = [motion for motion in components if motion is not None]
    motion = ground_of(*components, until=until, scale=scale)
    plausibility.warn(plausibility.of_scaled(motions, scale))
    ground = HullGround.placed(motion, np.eye(3), (math.inf, math.inf), settings.gravity)
    steps = [record.time_step for record in motions if isinstance(record, GroundMotion)]
    step = min(steps, default=FINE / math.sqrt(settings.gravity / hull_body.size))
    if duration is not None:
        samples(step, duration)  # raises an error before the computation if there are too many samples
    horizon, used = 0.0 if duration is None else duration, chosen(engine)
    if used == "fast":
        history = traced(hull_body, ground, law, settings.friction, start, horizon=horizon, settings=settings)
    else:
        history = HullEngine(hull_body, ground, law, settings.friction, settings).run(
            start_of(hull_body, start), horizon, hull_body.base
        )
    end = min(until, history.time[-1])
    time = samples(step, end)
    return HullResponse(hull_body, ground, str(law), settings, time, history, end, components, scale, ENGINES[used])


@dataclass(frozen=True, eq=False)
class HullStates:
    """States of a body at n instants, in axes of the ground."""

    quaternion: FloatArray  # attitude (s, x, y, z) [-]; shape (n, 4)
    angular_velocity: FloatArray  # angular velocity [rad/s]; shape (n, 3)
    centre: FloatArray  # centre of mass relative to the ground point under its start [m]; shape (n, 3)
    centre_velocity: FloatArray  # velocity of the centre of mass [m/s]; shape (n, 3)
    touching: IntArray  # number of vertices in contact
    sliding: IntArray  # number of sliding vertices


@dataclass(frozen=True, eq=False, repr=False)
class HullResponse(ResponseBase):
    """Response of a 3D body with friction, as returned by `simulate`.

    Parameters
    ----------
    body : HullBody
        The body on the vertices of its convex hull.
    ground : HullGround
        The integrated motion [m/s2].
    restitution : str
        Law of restitution, or its coefficient.
    settings : HullSettings
        Settings of the integration, with the friction.
    time : ndarray
        Times of the samples, until the body rests after the motion, or up to the duration [s].
    trajectory : HullHistory
        Result of the engine.
    end : float
        End of the response [s]. The engine may continue until the body rests.
    components : tuple
        Motions along x, y and z, or None.
    scale : float
        Factor on the motion [-].
    used : str
        Name of the engine, with its method.
    """

    body: HullBody
    ground: HullGround
    restitution: str
    settings: HullSettings
    time: FloatArray
    trajectory: HullHistory
    end: float
    components: tuple[Component, Component, Component]
    scale: float
    used: str

    @property
    def engine(self) -> str:
        """Name of the engine, with its method."""
        return self.used

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the three motions."""
        return tuple("none" if motion is None else motion.name for motion in self.components)

    @cached_property
    def states(self) -> HullStates:
        """Attitude, position, velocities and contact at the samples."""
        return self.at(self.time)

    @property
    def quaternion(self) -> FloatArray:
        """Attitude (s, x, y, z) at the samples, body axes to axes of the ground, shape (n, 4) [-]."""
        return self.states.quaternion

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity at the samples in axes of the ground, shape (n, 3) [rad/s]."""
        return self.states.angular_velocity

    @property
    def centre(self) -> FloatArray:
        """Path of the centre of mass relative to the ground point under its start, shape (n, 3) [m]."""
        return self.states.centre

    @cached_property
    def _up(self) -> FloatArray:
        """Axis of the body in its initial pose, at the samples in axes of the ground [-]."""
        axis = -np.array(unit(self.body.facets[self.trajectory.initial_facet]))
        return applied(attitude.matrix(self.quaternion), axis)

    @cached_property
    def tilt(self) -> FloatArray:
        """Angle from the pose before the initial tilt, at the samples [rad]."""
        x, y, z = self._up.T
        return np.asarray(np.arctan2(np.hypot(x, y), z))

    @cached_property
    def azimuth(self) -> FloatArray:
        """Direction of tilt at the samples, from x towards y [rad]."""
        return np.asarray(np.arctan2(self._up[:, 1], self._up[:, 0]))

    @cached_property
    def intervals(self) -> list[tuple[float, float, tuple[int, ...], tuple[int, ...]]]:
        """Intervals with constant contact: start and end [s], vertices in contact, sliding vertices."""
        rows: list[tuple[float, float, tuple[int, ...], tuple[int, ...]]] = []
        history, end = self.trajectory, self.end
        stops = [*history.time[1:], history.time[-1]]
        for start, stop, contact in zip(history.time, stops, history.contacts, strict=True):
            slides = tuple(i for i in contact.members if i not in contact.stuck)
            if start > end or stop <= start:
                continue
            same = rows and rows[-1][2:] == (contact.members, slides)
            first = rows.pop()[0] if same else start
            rows.append((first, min(stop, end), contact.members, slides))
        return rows

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order, with the fields of `HULL_IMPACT`."""
        rows = [
            (event.time, event.before, event.after, "-".join(map(str, event.contact.members)))
            for event in self.trajectory.events
            if event.kind is HullEventKind.IMPACT and event.time <= self.end
        ]
        return np.array(rows, dtype=HULL_IMPACT)

    @property
    def peak_tilt(self) -> float:
        """Largest angle from the initial pose, also between the samples [rad]."""
        return self.trajectory.peak_tilt

    @property
    def sliding_distance(self) -> float:
        """Path along the ground of the vertex with the largest slip [m]."""
        return self.trajectory.sliding_distance

    @property
    def pose(self) -> int:
        """Index of the stable pose at the end, or to which the body moves; 0 has the lowest centre of mass."""
        return self.trajectory.pose

    @property
    def overturning_direction(self) -> float:
        """Direction of tilt when the body left its initial pose, from x towards y [rad]; NaN if the body did not."""
        return self.trajectory.direction

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        last = self.trajectory.states[-1]
        rate = math.hypot(*last.spin)
        return "moving", self.trajectory.time[-1], Message("rotating at {velocity:.3g} rad/s", {"velocity": rate})

    @property
    def _ending(self) -> str:
        slides = self.sliding_distance > _NO_SLIP * self.body.size
        slid = f", total sliding distance of a vertex {self.sliding_distance:.4g} m" if slides else ""
        if self.outcome is Outcome.NO_UPLIFT:
            return str(self.outcome.value)
        count = self.impacts.size
        impacts = f"{count} impact{'s' * (count != 1)}"
        if self.outcome is Outcome.OVERTURNED:
            degrees = round(math.degrees(self.overturning_direction), 6) + 0.0  # smaller angles are rounding errors
            direction = "" if self.trajectory.fell_off else f" towards {degrees:.4g} degrees"
            time = "" if math.isnan(self.overturning_time) else f", for good at {self.overturning_time:.4g} s"
            return f"overturned{direction} into pose {self.pose}{time}; {impacts}{slid}"
        sentence = f"{self.outcome.value}: largest tilt {math.degrees(self.peak_tilt):.4g} degrees, {impacts}{slid}"
        if held_count := self.trajectory.held:
            sentence += (
                f"; {held_count} time{'s' * (held_count != 1)} no contact satisfied all laws: the vertices were held"
            )
        return sentence

    def at(self, time: Any) -> HullStates:
        """Return the state of the body at any times within the response.

        Between the steps of the engine, position and attitude are cubics that match the velocities at the steps.

        Parameters
        ----------
        time : array_like, shape (n,)
            Times [s].

        Returns
        -------
        HullStates
            Attitude, position, velocities, contact.

        Raises
        ------
        InvalidValueError
            If a time is not finite, or is outside the response by more than rounding.
        """
        stops, positions, attitudes, velocities, attitude_rates = self._nodes
        times = np.atleast_1d(self._times_within(time, float(stops[-1])))
        k = np.clip(np.searchsorted(stops, times, side="right") - 1, 0, max(len(stops) - 2, 0))
        last = np.minimum(k + 1, len(stops) - 1)
        k = np.where((times >= stops[-1]), len(stops) - 1, k)
        last = np.maximum(last, k)
        span = stops[last] - stops[k]
        fraction = np.divide(times - stops[k], span, out=np.zeros(times.size), where=span > 0.0)

        def between(values: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
            return _hermite(values[k], rates[k], values[last], rates[last], span[:, None], fraction[:, None])

        centre, velocity = between(positions, velocities)
        q, rate = between(attitudes, attitude_rates)
        size = np.linalg.norm(q, axis=1)[:, None]
        q = q / size
        contacts = [self.trajectory.contacts[i] for i in k]
        return HullStates(
            q,
            _spin(q, rate / size),
            centre,
            velocity,
            np.array([len(c.members) for c in contacts], np.int64),
            np.array([len(c.members) - len(c.stuck) for c in contacts], np.int64),
        )

    @cached_property
    def _nodes(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Times, positions, attitudes, velocities and attitude rates at the ends of the steps."""
        states = self.trajectory.states
        q = np.array([s.attitude for s in states])
        w = np.array([s.spin for s in states])
        s, v = q[:, :1], q[:, 1:]
        scalar = -0.5 * (v * w).sum(axis=1)  # Eq. 22
        rate = np.column_stack([scalar, 0.5 * (s * w + attitude.cross(v, w))])
        positions, velocities = (
            np.array([getattr(state, name) for state in states]) for name in ("position", "velocity")
        )
        return np.array(self.trajectory.time), positions, q, velocities, rate

    @property
    def _values(self) -> dict[str, Any]:
        direction = self.overturning_direction
        return {
            "motions": {
                axis: motion_answer(motion, self.scale) for axis, motion in zip(_AXES, self.components, strict=True)
            },
            "restitution": self.restitution, "friction": self.settings.friction, "peak_tilt": self.peak_tilt,
            "direction": None if math.isnan(direction) else direction, "sliding_distance": self.sliding_distance,
            "pose": self.pose, "energy_lost": self.trajectory.lost,
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

        states = self.states
        return {
            "time": self.time,
            **{f"quaternion_{axis}": self.quaternion[:, k] for k, axis in enumerate(("s", *_AXES))},
            **axes("angular_velocity", states.angular_velocity), "tilt": self.tilt, "azimuth": self.azimuth,
            "touching": states.touching.astype(np.float64), "sliding": states.sliding.astype(np.float64),
            **axes("centre", states.centre), **axes("ground_acceleration", self.ground.motion.at(self.time)),
        }  # fmt: skip

    def _plot(self, **options: Any) -> "Figure":
        from rocking.plots import spatial_picture

        return spatial_picture(self, **options)

    @property
    def _tables(self) -> dict[str, AnswerRows]:
        intervals = interval_rows(self.intervals, "vertices", "sliding_vertices")
        return {"intervals": intervals, "impacts": AnswerRows.of(self.impacts)}

    @property
    def _facts(self) -> dict[str, Any]:
        body, direction = self.body, self.overturning_direction
        return {
            **({} if math.isnan(direction) else {"direction": direction}),
            "pose": self.pose,
            "mass": body.mass,
            "centre": body.centre.tolist(),
            "inertia": np.ravel(body.inertia).tolist(),
            "vertices": len(body.points),
            "restitution": self.restitution,
            "scale": self.scale,
            **{f"motion_{axis}": name for axis, name in zip(("x", "y", "vertical"), self.names, strict=True)},
            "motion_provenance": [motion_provenance(motion) for motion in self.components],
        }


def _hermite(
    a: FloatArray, va: FloatArray, b: FloatArray, vb: FloatArray, span: FloatArray, x: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return value and rate of the cubic that has the given values and rates at both ends."""
    da, db, rise = span * va, span * vb, b - a
    cubic, square = da + db - 2.0 * rise, 3.0 * rise - 2.0 * da - db
    value = a + x * (da + x * (square + x * cubic))
    slope = da + x * (2.0 * square + 3.0 * x * cubic)
    return value, np.divide(slope, span, out=va.copy(), where=span > 0.0)


def _spin(q: FloatArray, rate: FloatArray) -> FloatArray:
    """Return the angular velocity in axes of the ground [rad/s]."""
    s, v, ds, dv = q[:, :1], q[:, 1:], rate[:, :1], rate[:, 1:]
    return np.asarray(2.0 * (s * dv - ds * v - attitude.cross(dv, v)))  # Eq. 22
