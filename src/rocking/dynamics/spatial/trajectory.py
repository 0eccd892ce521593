"""What the engine in space hands back for one history: polynomials between events, and the events."""

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.outcome import Outcome, Status
from rocking.dynamics.spatial.outcome import Contact
from rocking.dynamics.spatial.stance import Stance
from rocking.portable import powers, times


class SpatialEventKind(Enum):
    """What happened."""

    UPLIFT = "lifted from rest"
    IMPACT = "impact"
    CHANGE = "change of contact without impact"
    REST = "came to rest"


@dataclass(frozen=True, eq=False, slots=True)
class SpatialEvent:
    """An uplift, an impact, a change of contact or a coming to rest.

    Parameters
    ----------
    time : float
        When [s].
    kind : SpatialEventKind
        What.
    stance : Stance
        On what the body stands from then on.
    before, after : float
        Kinetic energy before and after [J].
    impulses : ndarray
        Of an impact, vertical: at the vertex, at both ends of the edge, or as `supports` of a face [N s].
    """

    time: float
    kind: SpatialEventKind
    stance: Stance
    before: float
    after: float
    impulses: FloatArray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """A step of the engine.

    Parameters
    ----------
    start, length : float
        When it starts, and the unit of time of its series [s].
    until : float
        Where it ends, in that unit [-].
    quaternions, velocities : ndarray, shape (order + 1, 4) and (order + 1, 3)
        Attitude [-] and angular velocity in body axes [rad/s], coefficients by power.
    places : ndarray, shape (n, 2)
        Place of the pivot or contact on the ground, coefficients by power [m].
    stance : Stance
        On what the body stands.
    """

    start: float
    length: float
    until: float
    quaternions: FloatArray
    velocities: FloatArray
    places: FloatArray
    stance: Stance

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return self.start + self.until * self.length

    def at(self, share: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return attitude, angular velocity and place of the pivot.

        Parameters
        ----------
        share : ndarray, shape (n,)
            Times in units of the length, from 0 to `until`.

        Returns
        -------
        quaternions, velocities, places : ndarray, shape (n, 4), (n, 3), (n, 2)
            At these times.
        """
        by_power = powers(share, max(len(self.quaternions), len(self.places)))
        made = [times(by_power[:, : len(c)], c) for c in (self.quaternions, self.velocities, self.places)]
        made[0] /= np.linalg.norm(made[0], axis=1)[:, None]
        return made[0], made[1], made[2]


@dataclass(frozen=True, eq=False)
class SpatialTrajectory:
    """A history.

    Parameters
    ----------
    pieces : list of Piece
        In order of time, without gaps.
    events : list of SpatialEvent
        In order of time.
    outcome : Outcome
        How it ended.
    status : Status
        Whether it could be computed.
    peak_tilt, peak_time : float
        Largest angle between the axis of the body and the vertical [rad], and when [s].
    overturning_time : float
        When the centre of mass passed over the contact for the last time; NaN if the body did not overturn [s].
    fell_over : Stance, optional
        The edge or vertex over which it overturned.
    held : float
        For how long an end of an edge was held down although the ground would have had to pull there, because its
        friction kept it from opening: there it slips in truth; or a rim nearly flat, which hops [s].
    engine : str
        Which engine, and how.
    """

    pieces: list[Piece] = field(repr=False)
    events: list[SpatialEvent] = field(repr=False)
    outcome: Outcome
    status: Status
    peak_tilt: float
    peak_time: float
    overturning_time: float
    fell_over: Stance | None
    held: float
    engine: str

    @property
    def impacts(self) -> list[SpatialEvent]:
        """The impacts."""
        return [event for event in self.events if event.kind is SpatialEventKind.IMPACT]

    @property
    def contact(self) -> Contact:
        """On what the body stands at the end."""
        return self.pieces[-1].stance.contact
