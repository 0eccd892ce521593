"""The response of a body in space: attitude, contact, impacts, energy, outcome and its direction."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.energy_balance import ResponseEnergy
from rocking.dynamics.response_base import Drawable
from rocking.dynamics.settings import Settings
from rocking.dynamics.space import attitude
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.event_functions import NEARLY_FLAT
from rocking.dynamics.space.ground import SpatialGround
from rocking.dynamics.space.impact_laws import SpatialImpactLaw
from rocking.dynamics.space.trajectory import SpatialEventKind, SpatialTrajectory, States, StepPiece, pivots
from rocking.errors import InvalidValueError
from rocking.outcome import ContactMode, Outcome, Status
from rocking.portable import applied, dot, gauss_legendre, norm
from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.dynamics.plane.energy_balance import ResponseEnergy
    from rocking.dynamics.space.trajectory import States
    from rocking.tables import Table


_NODES, _WEIGHTS = gauss_legendre(20)


def energy_of(response: "SpatialResponse") -> ResponseEnergy:
    """Return the energy of a response in space.

    The work of the ground is integrated along the history, -m a_g . v_C by Gauss's rule on every step of the engine;
    the losses are those of the impacts. Nothing is computed from the balance, so that the balance can be checked.
    """
    body, time = response.body, response.time
    states, impacts = response.states, response.trajectory.impacts
    lost = np.concatenate([[0.0], np.cumsum([event.before - event.after for event in impacts])])
    when = np.array([event.time for event in impacts])
    found = lost[np.searchsorted(when, time, side="right")]
    return ResponseEnergy(
        time=time,
        kinetic=states.kinetic,
        potential=body.mass * response.settings.gravity * states.rise,
        work=_work(response),
        lost=found - found[0],  # an impact at the start comes before the first sample
    )


def _work(response: "SpatialResponse") -> FloatArray:
    """Work of the ground up to each sample."""
    made, total = np.zeros(response.time.size), 0.0
    for piece in response.trajectory.pieces:
        first, last = np.searchsorted(response.time, [piece.start, piece.end], side="left")
        stops = np.concatenate([[piece.start], response.time[first:last], [piece.end]])
        if piece.end > piece.start and len(piece.quaternions) > 1 and piece.start < response.ground.end:
            parts = _of_piece(response, piece, stops)
            made[first:last] = total + np.cumsum(parts)[:-1]
            total += float(parts.sum())
        else:
            made[first:last] = total
    made[response.time >= response.trajectory.pieces[-1].end] = total
    return made


def _of_piece(response: "SpatialResponse", piece: StepPiece, stops: FloatArray) -> FloatArray:
    """Work between the stops of a step."""
    half = 0.5 * np.diff(stops)
    times = (0.5 * (stops[1:] + stops[:-1]))[:, None] + half[:, None] * _NODES
    q, w, place = piece.at(np.clip((times.ravel() - piece.start) / piece.length, 0.0, piece.until))
    body = response.body
    states = States(body, q, w, pivots(body, piece, q), place, np.zeros(len(q), dtype=np.int64))
    power = -body.mass * (response.ground.at(times.ravel()) * states.centre_velocity).sum(axis=1)  # Eq. 46
    return applied(power.reshape(times.shape), _WEIGHTS) * half


SPATIAL_IMPACT = np.dtype(
    [
        ("time", "f8"),
        ("energy_before", "f8"),
        ("energy_after", "f8"),
        ("impulse", "f8"),
        ("pull", "f8"),
        ("contact", "U8"),
        ("vertices", "U64"),
    ]
)
"""Fields of `SpatialResponse.impacts`: [s], [J], [J], vertical [N s], of that the part the ground would have to pull
for the points to stick [N s], what stays, and its vertices."""


@dataclass(frozen=True, eq=False)
class SpatialResponse(Drawable):
    """What `simulate` returns of a body in space; everything that takes time is computed when first asked for.

    Parameters
    ----------
    body : SpatialBody
        The body.
    ground : SpatialGround
        The motion as it was integrated [m/s2].
    law : SpatialImpactLaw
        What impacts cost.
    settings : Settings
        How it was integrated.
    time : ndarray
        Times of the samples, to the end or until the body lies [s].
    trajectory : SpatialTrajectory
        What the engine returned.
    end : float
        End of the response; the engine may have gone on to find out whether the body overturns [s].
    names : tuple of str
        Of the three motions.
    """

    body: SpatialBody
    ground: SpatialGround = field(repr=False)
    law: SpatialImpactLaw
    settings: Settings
    time: FloatArray = field(repr=False)
    trajectory: SpatialTrajectory = field(repr=False)
    end: float
    names: tuple[str, str, str] = ("none", "none", "none")

    def __repr__(self) -> str:
        """Outcome in words, and which engine found it."""
        return f"<SpatialResponse: {self.summary} [{self.trajectory.engine}]>"

    @cached_property
    def states(self) -> "States":
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
        """Direction in which the body leans at the samples, from x towards y [rad]."""
        return attitude.azimuth(self.quaternion)

    @property
    def contact(self) -> IntArray:
        """Number of the regime at the samples: 0 rest, 1 edge, 2 vertex, 3 rolling."""
        return self.states.contact

    @cached_property
    def centre(self) -> FloatArray:
        """Path of the centre of mass on the ground, z above it, shape (n, 3) [m]."""
        return self.states.point(self.body.centre)

    @cached_property
    def top(self) -> FloatArray:
        """Path of the point above the centre of mass at twice its height, shape (n, 3) [m]."""
        return self.states.point(self.body.centre * np.array([1.0, 1.0, 2.0]))

    @cached_property
    def intervals(self) -> list[tuple[float, float, ContactMode, tuple[int, ...]]]:
        """Start and end [s], regime, and vertices on the ground, as long as they stay the same."""
        found: list[tuple[float, float, ContactMode, tuple[int, ...]]] = []
        for piece in self.trajectory.pieces:
            if found and piece.start >= self.end:
                break
            now = piece.contact.mode, piece.contact.points
            if found and found[-1][2:] == now:
                found[-1] = (found[-1][0], min(piece.end, self.end), *now)
            else:
                found.append((piece.start, min(piece.end, self.end), *now))
        return found

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order: time, energy_before, energy_after, impulse, pull, contact, vertices."""
        rows = []
        for event in self.trajectory.impacts:
            if event.time > self.end:
                break
            stays, push = event.contact, event.impulses
            total = push.sum() if stays.mode is ContactMode.EDGE else push[-1]
            vertices = "-".join(map(str, stays.points))
            pull = max(0.0, -float(push.min()))
            rows.append((event.time, event.before, event.after, total, pull, stays.mode.name.lower(), vertices))
        return np.array(rows, dtype=SPATIAL_IMPACT)

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        return self.trajectory.outcome

    @property
    def status(self) -> Status:
        """Whether it could be computed."""
        return self.trajectory.status

    @property
    def peak_tilt(self) -> float:
        """Largest tilt, between the samples too; a quarter turn if it overturned [rad]."""
        return self.trajectory.peak_tilt

    @property
    def overturning_time(self) -> float:
        """When the centre of mass passed over the contact for good; NaN if it did not overturn [s]."""
        return self.trajectory.overturning_time

    @cached_property
    def overturning_direction(self) -> float:
        """Direction in which it lies, from x towards y; NaN if it did not overturn [rad]."""
        if self.outcome is not Outcome.OVERTURNED:
            return math.nan
        last = self.trajectory.pieces[-1]
        return float(attitude.azimuth(last.at(np.array([last.until]))[0][0]))

    @property
    def overturned_over(self) -> str:
        """Edge, vertex or rim over which it overturned, in words; empty if it did not."""
        over = self.trajectory.fell_over
        if over is None:
            return ""
        if not over.points:
            return "its rim"
        return f"{over.mode.name.lower()} {'-'.join(map(str, over.points))}"

    @cached_property
    def still_rocking(self) -> bool:
        """Whether it stands, but does not yet rest where the response ends; later impacts are not among `impacts`."""
        return self.outcome is Outcome.ROCKED and int(self._last.contact[0]) != ContactMode.REST.code

    @property
    def unfinished(self) -> str:
        """A sentence that says when and how it still rocks where the response ends; empty if it does not."""
        if not self.still_rocking:
            return ""
        angle = np.degrees(attitude.tilt(self._last.quaternion)[0])
        rate = math.hypot(*self._last.angular_velocity[0])
        return (
            f"it is still rocking when the computation ends at {self.end:.4g} s, leaning by {angle:.3g} degrees and "
            f"turning at {rate:.3g} rad/s; later impacts are not counted"
        )

    @cached_property
    def _last(self) -> "States":
        return self.at(self.end)

    @property
    def summary(self) -> str:
        """The outcome in one sentence; also whether it still rocks where the response ends."""
        run = self.trajectory
        count = self.impacts.size
        if run.outcome is Outcome.OVERTURNED:
            where = f" over {self.overturned_over}" if self.overturned_over else ""
            return (
                f"overturned towards {math.degrees(self.overturning_direction):.4g} degrees{where} after {count} "
                f"impact{'s' * (count != 1)}, past the point of no return at {run.overturning_time:.4g} s"
            )
        if run.outcome is Outcome.ROCKED:
            return (
                f"rocked and stayed standing: largest tilt {math.degrees(run.peak_tilt):.4g} degrees, {count} "
                f"impact{'s' * (count != 1)}{self._pulled}{self._cut}{self._nearly_flat}"
            ) + (f"; {self.unfinished}" if self.still_rocking else "")
        return run.outcome.value if run.outcome is Outcome.NO_UPLIFT else f"{run.outcome.value}: {run.status.value}"

    @property
    def _pulled(self) -> str:
        count = int((self.impacts["pull"] > 1e-9 * np.abs(self.impacts["impulse"])).sum())
        return f"; at {count} of them a corner would have slipped or bounced rather than stuck" if count else ""

    @cached_property
    def cut_impacts(self) -> int:
        """At how many impacts the model would have the impulse beyond the new foot, and has it at the foot."""
        cut = getattr(getattr(self.law, "model", None), "cut", None)
        if cut is None or self.body.matter is None:
            return 0
        solid, found = self.body.matter()[0], 0
        for old, event in pairwise(self.trajectory.events):
            if event.time > self.end:
                break
            if event.kind is not SpatialEventKind.IMPACT:
                continue
            if self.body.round:  # across the axis about which it lies down
                before = self.at(np.nextafter(event.time, 0.0))
                spin = applied(before.rotation[0].T, before.angular_velocity[0])
                step = self.body.radius / norm(spin[:2]) * np.array([spin[1], -spin[0], 0.0])
            else:
                step, axis = event.contact.pivot - old.contact.pivot, event.contact.axis
                step = step if axis is None else step - dot(step, axis) * axis
            found += cut(solid, step)
        return found

    @property
    def _cut(self) -> str:
        count = self.cut_impacts
        return f"; at {count} of them the base is so narrow that the loss is Housner's" if count else ""

    @cached_property
    def near_flat_passages(self) -> int:
        """How often a round base rolled through lying nearly flat, below 1 % of its slenderness angle."""
        if not self.body.round:
            return 0
        rolling = [p for p in self.trajectory.pieces if p.contact.mode is ContactMode.ROLLING and p.start < self.end]
        tilts = attitude.tilt(np.array([p.quaternions[0] for p in rolling]).reshape(-1, 4))
        low = (tilts[1:-1] <= tilts[:-2]) & (tilts[1:-1] < tilts[2:])
        return int((low & (tilts[1:-1] < NEARLY_FLAT * self.body.radius / self.body.centre[2])).sum())

    @property
    def _nearly_flat(self) -> str:
        count, held = self.near_flat_passages, self.trajectory.held
        if not count:
            return ""
        pulled = f"; there its rim would have hopped or slipped for {held:.2g} s" if held else ""
        return (
            f"; it rolled {count} time{'s' * (count != 1)} through lying nearly flat, after which small causes have "
            f"large effects: take many motions, not one{pulled}"
        )

    @cached_property
    def energy(self) -> "ResponseEnergy":
        """Kinetic and potential energy, work of the ground and losses at the samples [J]."""
        return energy_of(self)

    def at(self, time: Any) -> "States":
        """Return the state of the body at any times within the response.

        Parameters
        ----------
        time : array_like, shape (n,)
            Times [s].

        Returns
        -------
        States
            Attitude, velocity, contact, places.

        Raises
        ------
        InvalidValueError
            If a time is not finite, or before the start or after the end by more than rounding.
        """
        from rocking.dynamics.space.trajectory import states_of

        end = self.trajectory.pieces[-1].end
        given = np.atleast_1d(checks.real_array("time", time, "s"))
        bad = given[~((given >= -1e-9 * end) & (given <= (1.0 + 1e-9) * end))]
        if bad.size:
            raise InvalidValueError(f"time must be in [0, {end:g}] s, where the response is known, got {bad[0]:g}")
        return states_of(self.body, self.trajectory, np.clip(given, 0.0, end))

    def exported(self) -> "Table":
        """Return what the files of this response hold.

        Returns
        -------
        Table
            Samples, impacts, intervals of one contact and provenance, with units.
        """
        return exported(self)


_AXES = ("x", "y", "z")


def columns(response: "SpatialResponse") -> dict[str, Column]:
    """Return the samples of a response in space by name."""
    energy, states = response.energy, response.states
    ground = response.ground.at(response.time)
    values = {"time": response.time}
    values |= {f"quaternion_{axis}": states.quaternion[:, k] for k, axis in enumerate(("s", *_AXES))}
    values |= _vector("angular_velocity", states.angular_velocity)
    values |= {"tilt": response.tilt, "azimuth": response.azimuth, "contact": response.contact.astype(np.float64)}
    values |= _vector("centre", response.centre) | _vector("ground_acceleration", ground)
    values |= {"kinetic_energy": energy.kinetic, "potential_energy": energy.potential}
    values |= {"work_of_ground": energy.work, "energy_lost": energy.lost}
    return {name: Column.of(name, each) for name, each in values.items()}


def provenance(response: "SpatialResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Returns Numbers, words and lists of numbers; ``overturning_direction_rad`` only where it overturned.
    """
    body, direction = response.body, response.overturning_direction
    return {
        "software": SOFTWARE,
        "engine": response.trajectory.engine,
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        **({} if math.isnan(direction) else {"overturning_direction_rad": direction}),
        "mass_kg": body.mass,
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": body.inertia.ravel().tolist(),
        "base_m": np.ravel(body.base).tolist(),
        "restitution": response.law.label,
        **{f"motion_{axis}": name for axis, name in zip(("x", "y", "vertical"), response.names, strict=True)},
        **{f"setting_{k}": v for k, v in response.settings.stated.items()},
    }


def exported(response: "SpatialResponse") -> Table:
    """Return what the files of a response in space hold; samples, impacts, intervals of one contact, and provenance."""
    known = ("time", "energy_before", "energy_after", "impulse", "pull")
    impacts = {name: Column.of(name, response.impacts[name]) for name in known}
    impacts["contact"] = Column(response.impacts["contact"], "", "contact that stays")
    impacts["vertices"] = Column(response.impacts["vertices"], "", "vertices that stay on the ground")
    rows = response.intervals
    intervals = {
        "start": Column.of("start", np.array([start for start, _, _, _ in rows], dtype=np.float64)),
        "end": Column.of("end", np.array([end for _, end, _, _ in rows], dtype=np.float64)),
        "contact": Column(np.array([contact.name.lower() for _, _, contact, _ in rows], dtype="U8"), "", "contact"),
        "vertices": Column.of(
            "vertices", np.array(["-".join(map(str, points)) for _, _, _, points in rows], dtype="U64")
        ),
    }
    beside = {"impact": Table("impact", impacts), "interval": Table("interval", intervals)}
    return Table("time", columns(response), provenance(response), beside, no_unit="-")


def _vector(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{name}_{axis}": values[:, k] for k, axis in enumerate(_AXES)}
