"""The response with contact: positions, regimes, impacts, sliding, forces, energy, outcome."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.contact.base import PlaneBase
from rocking.dynamics.contact.history import SAMPLED, History, impacts_of, places_of, regimes_of
from rocking.dynamics.contact.impact_resolution import GroundContact
from rocking.dynamics.exportable import Drawable, motion_provenance
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Regime, Status
from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.tables import Table


@dataclass(frozen=True)
class ContactEnergy:
    """Energy in the frame of the ground."""

    time: FloatArray  # times of the samples [s]
    kinetic: FloatArray  # kinetic, potential: of the body; the potential one above where it stands [J]
    potential: FloatArray
    work: FloatArray  # done by the ground since the start [J]
    lost_in_impacts: FloatArray  # lost_in_impacts, lost_in_friction: since the start [J]
    lost_in_friction: FloatArray

    @property
    def gap(self) -> FloatArray:
        """What does not add up: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        lost = self.lost_in_impacts + self.lost_in_friction
        return np.asarray(stored + lost - self.work - (stored[0] + lost[0]), dtype=np.float64)  # Eq. 45

    @property
    def closure(self) -> float:
        """Largest gap over the largest energy that was stored, lost, or worked [-]."""
        parts = (self.kinetic + self.potential, self.lost_in_impacts, self.lost_in_friction, self.work)
        scale = max(1e-300, *(float(np.abs(part).max()) for part in parts))
        return float(np.abs(self.gap).max()) / scale


@dataclass(frozen=True)
class ContactForces:
    """Forces of the ground on the body."""

    time: FloatArray  # times of the samples [s]
    horizontal: FloatArray  # on both feet together, to the right [N]
    left: FloatArray  # left, right: vertical force on each foot [N]
    right: FloatArray
    usage: FloatArray  # |horizontal| over mu times the vertical force; zero in flight [-]

    @property
    def vertical(self) -> FloatArray:
        """Vertical force on both feet together [N]."""
        return np.asarray(self.left + self.right)


def energy_of(response: "ContactResponse") -> ContactEnergy:
    """Return the energy of a response."""
    mass, j = response.base.mass, response.base.inertia
    u, w, spin = response.horizontal_velocity, response.vertical_velocity, response.angular_velocity
    return ContactEnergy(
        response.time,
        0.5 * mass * (u**2 + w**2 + j * spin**2),  # Eq. 62
        mass * response.settings.gravity * response.rise,
        mass * response._sampled("work"),
        mass * response._sampled("impact_loss"),
        mass * response._sampled("friction_loss"),
    )


def forces_of(response: "ContactResponse") -> ContactForces:
    """Return the forces of a response; at its samples, as limits from before."""
    mass, friction = response.base.mass, response.law.friction
    tangential = response._sampled("tangential")
    left, right = response._sampled("normal_left"), response._sampled("normal_right")
    most = friction * (left + right)
    usage = np.zeros(most.size)
    np.divide(np.abs(tangential), most, out=usage, where=most > 0.0)  # Eq. 78
    return ContactForces(response.time, mass * tangential, mass * left, mass * right, usage)


_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class ContactResponse(Drawable):
    """What `simulate` returns of a plane body with friction.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse, optional
        The motion; None on ground at rest.
    base : PlaneBase
        The body as the equations see it.
    law : ContactLaw
        Friction and restitution.
    settings : Settings
        How it was integrated.
    segments : Segments
        The motion as it was integrated [m/s2].
    scale : float
        Factor on the motion [-].
    history : History
        What the engine returned.
    """

    body: Body
    motion: GroundMotion | Pulse | None
    base: PlaneBase
    law: GroundContact
    settings: Settings
    segments: Segments = field(repr=False)
    scale: float
    history: History = field(repr=False)

    def __repr__(self) -> str:
        """Outcome in words."""
        return f"<ContactResponse: {self.summary}>"

    @cached_property
    def _samples(self) -> FloatArray:
        rows = self.history.samples
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        return rows[: int(bad[0])] if bad.size else rows

    def _sampled(self, name: str) -> FloatArray:
        """Return one column of the record, per unit of mass where it is a force or an energy."""
        return np.asarray(self._samples[:, SAMPLED.index(name)], dtype=np.float64)

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, to the end or until the body lies [s]."""
        return np.asarray(np.arange(len(self._samples)) * self.segments.step, dtype=np.float64)

    @property
    def displacement(self) -> FloatArray:
        """Displacement x of the centre of mass along the ground, to the right [m]."""
        return self._sampled("x")

    @property
    def rise(self) -> FloatArray:
        """Height z of the centre of mass above where it is when the body stands [m]."""
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
        """Regime up to each sample, as `Regime.code`."""
        return np.asarray(self._sampled("regime"), dtype=np.int64)

    @cached_property
    def regimes(self) -> np.ndarray:
        """Regimes in order: start, end, regime, feet, slip, and the distance that the feet slid."""
        return regimes_of(self.history, self.base)

    @cached_property
    def impacts(self) -> np.ndarray:
        """Impacts in order: time, feet, velocities, impulses at each foot, energy lost, whether the feet slid."""
        return impacts_of(self.history, self.base)

    @property
    def sliding_distance(self) -> float:
        """Total path of the feet that carried, along the ground [m]."""
        return self.history.slid

    @cached_property
    def energy(self) -> ContactEnergy:
        """Kinetic and potential energy, work of the ground, losses in impacts and in friction [J]."""
        return energy_of(self)

    @cached_property
    def forces(self) -> ContactForces:
        """Forces of the ground on the feet [N], and how much of the friction is used."""
        return forces_of(self)

    @property
    def friction_usage(self) -> float:
        """Largest |horizontal| over mu times the vertical force; 1 where the body slides [-]."""
        return self.history.usage

    @property
    def peak_rotation(self) -> float:
        """Largest |theta|, between the samples too; a quarter turn if it overturned [rad]."""
        return self.history.peak

    @property
    def status(self) -> Status:
        """Whether it could be computed."""
        return self.history.status

    @property
    def overturning_time(self) -> float:
        """When the centre passed over the foot for good; NaN if it did not overturn [s]."""
        return self.history.passed if self.outcome is Outcome.OVERTURNED else float("nan")

    @cached_property
    def outcome(self) -> Outcome:
        """How it ended."""
        if self.status is not Status.GOOD:
            return Outcome.FAILED
        if self.history.lies:
            return Outcome.OVERTURNED
        seen = {Regime[name] for name in self.regimes["regime"]}
        if Regime.FLIGHT in seen:
            return Outcome.FLEW
        slid = bool(seen & {Regime.SLIDE, Regime.SLIDE_ROCK})
        if seen & {Regime.ROCK, Regime.SLIDE_ROCK}:
            return Outcome.ROCKED_AND_SLID if slid else Outcome.ROCKED
        return Outcome.SLID if slid else Outcome.NO_UPLIFT

    @property
    def still_rocking(self) -> bool:
        """Whether it stands, but rocks or flies where the response ends; later impacts are not among `impacts`."""
        moving = {Regime.ROCK.name, Regime.SLIDE_ROCK.name, Regime.FLIGHT.name}
        stands = self.outcome not in {Outcome.FAILED, Outcome.OVERTURNED}
        return stands and self.regimes["regime"][-1] in moving

    @property
    def unfinished(self) -> str:
        """A sentence that says when and how it still rocks where the response ends; empty if it does not."""
        if not self.still_rocking:
            return ""
        angle, rate = np.degrees(self.rotation[-1]), self.angular_velocity[-1]
        return (
            f"it is still {Regime[self.regimes['regime'][-1]].value} when the computation ends at "
            f"{self.time[-1]:.4g} s, at {angle:.3g} degrees and {rate:.3g} rad/s; later impacts are not counted"
        )

    @property
    def summary(self) -> str:
        """The outcome in one sentence; also whether it still rocks where the response ends."""
        if self.outcome is Outcome.FAILED:
            return f"{self.outcome.value}: {self.status.value}"
        told = [self.outcome.value]
        if self.peak_rotation > 0.0 and self.outcome is not Outcome.OVERTURNED:
            told.append(f"largest rotation {np.degrees(self.peak_rotation):.4g} degrees")
        if self.sliding_distance > 0.0:
            told.append(f"slid {self.sliding_distance:.4g} m in all")
        return ", ".join(told) + (f"; {self.unfinished}" if self.still_rocking else "")

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
            If a time is not finite, or before the start or after the end by more than rounding.
        """
        end = self.history.end
        given = checks.real_array("time", time, "s")
        bad = given[~((given >= -_ROUNDING * end) & (given <= (1.0 + _ROUNDING) * end))]
        if bad.size:
            raise InvalidValueError(f"time must be in [0, {end:g}] s, where the response is known, got {bad[0]:g}")
        return places_of(self.history, np.clip(given, 0.0, end))

    def exported(self) -> "Table":
        """Return what the files of this response hold.

        Returns
        -------
        Table
            Samples, impacts, intervals of one regime and provenance, with units.
        """
        return exported(self)


SAMPLES = (
    "time", "displacement", "rise", "rotation", "horizontal_velocity", "vertical_velocity", "angular_velocity",
    "regime", "sliding_distance", "horizontal_force", "vertical_force_left", "vertical_force_right", "kinetic_energy",
    "potential_energy", "work_of_ground", "energy_lost", "lost_in_friction",
)  # fmt: skip
"""What is known at every sample."""
_IMPACTS = (
    "time", "velocity_before", "velocity_after", "normal_left", "normal_right", "tangential_left", "tangential_right",
    "lost",
)  # fmt: skip


def columns(response: "ContactResponse") -> dict[str, FloatArray]:
    """Return the samples of a response by name; all of one length, in the order of `SAMPLES`."""
    energy, forces = response.energy, response.forces
    values = (
        response.time, response.displacement, response.rise, response.rotation, response.horizontal_velocity,
        response.vertical_velocity, response.angular_velocity, response._sampled("regime"), response._sampled("slid"),
        forces.horizontal, forces.left, forces.right, energy.kinetic, energy.potential, energy.work,
        energy.lost_in_impacts, energy.lost_in_friction,
    )  # fmt: skip
    return dict(zip(SAMPLES, values, strict=True))


def provenance(response: "ContactResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values."""
    motion, law, base = response.motion, response.law, response.base
    imposed = (
        "none: complementarity" if law.restitution is None else "left {:.9g}, right {:.9g}".format(*law.restitution)
    )
    return {
        "software": SOFTWARE,
        "engine": "planar: Taylor series with events and complementarity",
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        "body": type(response.body).__name__,
        "mass_kg": base.mass,
        "inertia_kg_m2": base.mass * base.inertia,
        "centre_height_m": base.height,
        "half_width_left_m": base.left,
        "half_width_right_m": base.right,
        "friction": law.friction,
        "bounce": law.bounce,
        "imposed_restitution": imposed,
        "motion": "none: ground at rest" if motion is None else motion.name,
        "motion_provenance": motion_provenance(motion),
        "scale": response.scale,
        **{f"setting_{k}": v for k, v in response.settings.stated.items()},
    }


def exported(response: "ContactResponse") -> Table:
    """Return what the files of a response hold; samples, impacts, intervals of one regime, and provenance."""
    samples = {name: Column.of(name, values) for name, values in columns(response).items()}
    impacts, regimes = response.impacts, response.regimes
    blows = {name: Column.of(name, impacts[name]) for name in _IMPACTS}
    blows["feet"] = Column.of("feet", impacts["feet"])
    blows["slips"] = Column.of("slips", impacts["slips"].astype(np.int8))
    intervals = {name: Column.of(name, regimes[name]) for name in ("start", "end", "distance")}
    intervals["regime"] = Column(regimes["regime"], "", "regime")
    intervals["feet"] = Column(regimes["feet"], "", "feet that carry")
    beside = {"impact": Table("impact", blows), "interval": Table("interval", intervals)}
    return Table("time", samples, provenance(response), beside, no_unit="-")
