"""The planar response: positions, regimes, impacts, sliding, forces, energy, outcome."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.contact.base import PlaneBase
from rocking.dynamics.contact.energy_balance import ContactEnergy, ContactForces, energy_of, forces_of
from rocking.dynamics.contact.events import impacts_of, places_of, regimes_of
from rocking.dynamics.contact.ground_contact import GroundContact
from rocking.dynamics.contact.history import History
from rocking.dynamics.contact.log import SAMPLED
from rocking.dynamics.exportable import Exportable
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Regime, Status

if TYPE_CHECKING:
    from rocking.tables import Table

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class ContactResponse(Exportable):
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
        rows = self.history.log.samples
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        return rows[: int(bad[0])] if bad.size else rows

    def sampled(self, name: str) -> FloatArray:
        """Return one column of the record, per unit of mass where it is a force or an energy.

        Parameters
        ----------
        name : str
            Name of the column, of `rocking.dynamics.contact.log.SAMPLED`.

        Returns
        -------
        ndarray
            At the samples.
        """
        return np.asarray(self._samples[:, SAMPLED.index(name)], dtype=np.float64)

    @cached_property
    def time(self) -> FloatArray:
        """Times of the samples, to the end or until the body lies [s]."""
        return np.asarray(np.arange(len(self._samples)) * self.segments.step, dtype=np.float64)

    @property
    def displacement(self) -> FloatArray:
        """Displacement x of the centre of mass along the ground, to the right [m]."""
        return self.sampled("x")

    @property
    def rise(self) -> FloatArray:
        """Height z of the centre of mass above where it is when the body stands [m]."""
        return self.sampled("rise")

    @property
    def rotation(self) -> FloatArray:
        """Rotation theta, positive clockwise [rad]."""
        return self.sampled("rotation")

    @property
    def horizontal_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, to the right [m/s]."""
        return self.sampled("u")

    @property
    def vertical_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, upwards [m/s]."""
        return self.sampled("w")

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity theta' [rad/s]."""
        return self.sampled("spin")

    @property
    def regime(self) -> IntArray:
        """Regime up to each sample, as `Regime.code`."""
        return np.asarray(self.sampled("regime"), dtype=np.int64)

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
        return self.history.log.slid

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
        return self.history.log.usage

    @property
    def peak_rotation(self) -> float:
        """Largest |theta|, between the samples too; a quarter turn if it overturned [rad]."""
        return self.history.log.peak

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
        from rocking.dynamics.contact.export import exported

        return exported(self)
