"""The response of a body on the vertices of its hull: attitude, place, contacts, impacts, sliding, outcome."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, plausibility
from rocking.answers import AnswerRows
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.engine import HullEngine
from rocking.dynamics.hull.ground import HullGround, unit
from rocking.dynamics.hull.histories import ENGINES, chosen, start_of, traced
from rocking.dynamics.hull.history import HullEventKind, HullHistory
from rocking.dynamics.hull.restitution import law_on_hull
from rocking.dynamics.hull.settings import HullSettings
from rocking.dynamics.response_base import ResponseBase, interval_rows, motion_provenance
from rocking.dynamics.space import attitude
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.ground import Component, ground_of
from rocking.dynamics.space.response import samples, started
from rocking.messages import Message
from rocking.motions.motion import GroundMotion
from rocking.motions.summary import motion_answer
from rocking.outcome import Outcome
from rocking.portable import applied

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FINE = 0.05  # time between samples where no record gives it, over sqrt(size / g)
_NO_SLIP = 1e-6  # over the size: what an answer does not speak of

HULL_IMPACT = np.dtype([("time", "f8"), ("energy_before", "f8"), ("energy_after", "f8"), ("vertices", "U64")])
"""Fields of `HullResponse.impacts`: [s], kinetic energy [J], [J], vertices that stay on the ground."""

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
    """Return how a body in space moves that may rock, slide, hop and fall; without components, when it is let go."""
    # duration: how long to follow the body at least [s]; if not given, until it rests after the motion
    made = HullBody.of(body)
    law = law_on_hull(restitution)
    scale = checks.within("scale", scale, -1e6, 1e6)
    start = started(start, math.sqrt(settings.gravity / made.size))
    until = np.inf if duration is None else checks.positive("duration", duration, "s")
    shaken = [motion for motion in components if motion is not None]
    motion = ground_of(*components, until=until, scale=scale)
    plausibility.warn(plausibility.of_scaled(shaken, scale))
    ground = HullGround.placed(motion, np.eye(3), (math.inf, math.inf), settings.gravity)
    steps = [each.time_step for each in shaken if isinstance(each, GroundMotion)]
    step = min(steps, default=FINE / math.sqrt(settings.gravity / made.size))
    if duration is not None:
        samples(step, duration)  # too many are refused before they are computed
    horizon, used = 0.0 if duration is None else duration, chosen(engine)
    if used == "fast":
        found = traced(made, ground, law, settings.friction, start, horizon=horizon, settings=settings)
    else:
        found = HullEngine(made, ground, law, settings.friction, settings).run(
            start_of(made, start), horizon, made.base
        )
    end = min(until, found.time[-1])
    time = samples(step, end)
    return HullResponse(made, ground, str(law), settings, time, found, end, components, scale, ENGINES[used])


@dataclass(frozen=True, eq=False)
class HullStates:
    """A body at n instants, in axes of the ground; its vertices stand in `HullBody`."""

    quaternion: FloatArray  # attitude (s, x, y, z) [-]; shape (n, 4)
    angular_velocity: FloatArray  # [rad/s]; shape (n, 3)
    centre: FloatArray  # place of the centre of mass, from under where it was at the start [m]; shape (n, 3)
    centre_velocity: FloatArray  # [m/s]; shape (n, 3)
    touching: IntArray  # how many vertices are on the ground
    sliding: IntArray  # how many of these slide


@dataclass(frozen=True, eq=False, repr=False)
class HullResponse(ResponseBase):
    """What `simulate` returns of a body in space with friction.

    Parameters
    ----------
    body : HullBody
        The body on the vertices of its convex hull.
    ground : HullGround
        The motion as it was integrated [m/s2].
    restitution : str
        Law of restitution, or its coefficient.
    settings : HullSettings
        How it was integrated, and with which friction.
    time : ndarray
        Times of the samples, until it rests after the motion, or to the duration [s].
    trajectory : HullHistory
        What the engine returned.
    end : float
        End of the response; the engine may have gone on until it rests [s].
    components : tuple
        Motions along x, y and z, or None.
    scale : float
        Factor on the motion [-].
    used : str
        Which engine ran, and how.
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
        """Which engine ran, and how."""
        return self.used

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the three motions."""
        return tuple("none" if motion is None else motion.name for motion in self.components)

    @cached_property
    def states(self) -> HullStates:
        """Attitude, place, velocities and contact at the samples."""
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
        """Path of the centre of mass over the ground, from under where it was, shape (n, 3) [m]."""
        return self.states.centre

    @cached_property
    def _up(self) -> FloatArray:
        """The axis of the body, of the pose in which it stood, at the samples in axes of the ground."""
        axis = -np.array(unit(self.body.facets[self.trajectory.stood]))
        return applied(attitude.matrix(self.quaternion), axis)

    @cached_property
    def tilt(self) -> FloatArray:
        """Angle from the pose in which the body stood before it was tilted, at the samples [rad]."""
        x, y, z = self._up.T
        return np.asarray(np.arctan2(np.hypot(x, y), z))

    @cached_property
    def azimuth(self) -> FloatArray:
        """Direction in which the body leans at the samples, from x towards y [rad]."""
        return np.asarray(np.arctan2(self._up[:, 1], self._up[:, 0]))

    @cached_property
    def intervals(self) -> list[tuple[float, float, tuple[int, ...], tuple[int, ...]]]:
        """Start and end [s], vertices on the ground and those of them that slide, as long as they stay the same."""
        found: list[tuple[float, float, tuple[int, ...], tuple[int, ...]]] = []
        made, end = self.trajectory, self.end
        stops = [*made.time[1:], made.time[-1]]
        for start, stop, contact in zip(made.time, stops, made.contacts, strict=True):
            slides = tuple(i for i in contact.members if i not in contact.stuck)
            if start > end or stop <= start:
                continue
            same = found and found[-1][2:] == (contact.members, slides)
            first = found.pop()[0] if same else start
            found.append((first, min(stop, end), contact.members, slides))
        return found

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order: time, energy_before, energy_after, vertices that stay on the ground."""
        rows = [
            (event.time, event.before, event.after, "-".join(map(str, event.contact.members)))
            for event in self.trajectory.events
            if event.kind is HullEventKind.IMPACT and event.time <= self.end
        ]
        return np.array(rows, dtype=HULL_IMPACT)

    @property
    def peak_tilt(self) -> float:
        """Largest angle from the pose in which the body stood, between the samples too [rad]."""
        return self.trajectory.peak_tilt

    @property
    def sliding_distance(self) -> float:
        """Path of the vertex that slides most, along the ground [m]."""
        return self.trajectory.sliding_distance

    @property
    def pose(self) -> int:
        """Number of the stable pose in which it ends, or to which it is on its way; that of the lowest centre is 0."""
        return self.trajectory.pose

    @property
    def overturning_direction(self) -> float:
        """Direction in which it leant when it left its first pose, from x towards y; NaN if it did not [rad]."""
        return self.trajectory.direction

    @property
    def _last_motion(self) -> tuple[str, float, str]:
        last = self.trajectory.states[-1]
        rate = math.hypot(*last.spin)
        return "moving", self.trajectory.time[-1], Message("turning at {velocity:.3g} rad/s", {"velocity": rate})

    @property
    def _ending(self) -> str:
        slides = self.sliding_distance > _NO_SLIP * self.body.size
        slid = f", a vertex slid {self.sliding_distance:.4g} m in all" if slides else ""
        if self.outcome is Outcome.NO_UPLIFT:
            return str(self.outcome.value)
        count = self.impacts.size
        impacts = f"{count} impact{'s' * (count != 1)}"
        if self.outcome is Outcome.OVERTURNED:
            degrees = round(math.degrees(self.overturning_direction), 6) + 0.0  # less is rounding
            where = "" if self.trajectory.fell else f" towards {degrees:.4g} degrees"
            when = "" if math.isnan(self.overturning_time) else f", for good at {self.overturning_time:.4g} s"
            return f"overturned{where} into pose {self.pose}{when}; {impacts}{slid}"
        sentence = f"{self.outcome.value}: largest tilt {math.degrees(self.peak_tilt):.4g} degrees, {impacts}{slid}"
        if held := self.trajectory.held:
            sentence += f"; {held} time{'s' * (held != 1)} no contact obeyed every law, and what touched was held"
        return sentence

    def at(self, time: Any) -> HullStates:
        """Return the state of the body at any times within the response.

        Between steps of the engine place and attitude follow cubics with its velocities.

        Parameters
        ----------
        time : array_like, shape (n,)
            Times [s].

        Returns
        -------
        HullStates
            Attitude, place, velocities, contact.

        Raises
        ------
        InvalidValueError
            If a time is not finite, or before the start or after the end by more than rounding.
        """
        stops, places, attitudes, velocities, turning = self._nodes
        times = np.atleast_1d(self._times_within(time, float(stops[-1])))
        k = np.clip(np.searchsorted(stops, times, side="right") - 1, 0, max(len(stops) - 2, 0))
        last = np.minimum(k + 1, len(stops) - 1)
        k = np.where((times >= stops[-1]), len(stops) - 1, k)
        last = np.maximum(last, k)
        span = stops[last] - stops[k]
        share = np.divide(times - stops[k], span, out=np.zeros(times.size), where=span > 0.0)

        def between(values: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
            return _hermite(values[k], rates[k], values[last], rates[last], span[:, None], share[:, None])

        centre, velocity = between(places, velocities)
        q, rate = between(attitudes, turning)
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
        """Times, places, attitudes and their rates at the ends of the steps."""
        states = self.trajectory.states
        q = np.array([s.attitude for s in states])
        w = np.array([s.spin for s in states])
        s, v = q[:, :1], q[:, 1:]
        scalar = -0.5 * (v * w).sum(axis=1)  # Eq. 22
        rate = np.column_stack([scalar, 0.5 * (s * w + attitude.cross(v, w))])
        places, velocities = (np.array([getattr(one, name) for one in states]) for name in ("place", "velocity"))
        return np.array(self.trajectory.time), places, q, velocities, rate

    @property
    def _values(self) -> dict[str, Any]:
        direction = self.overturning_direction
        return {
            "motions": {
                axis: motion_answer(each, self.scale) for axis, each in zip(_AXES, self.components, strict=True)
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
    """Return the cubic with given values and rates at both ends, and its rate."""
    da, db, rise = span * va, span * vb, b - a
    cubic, square = da + db - 2.0 * rise, 3.0 * rise - 2.0 * da - db
    value = a + x * (da + x * (square + x * cubic))
    slope = da + x * (2.0 * square + 3.0 * x * cubic)
    return value, np.divide(slope, span, out=va.copy(), where=span > 0.0)


def _spin(q: FloatArray, rate: FloatArray) -> FloatArray:
    """Return the angular velocity in axes of the ground."""
    s, v, ds, dv = q[:, :1], q[:, 1:], rate[:, :1], rate[:, 1:]
    return np.asarray(2.0 * (s * dv - ds * v - attitude.cross(dv, v)))  # Eq. 22
