"""Record of a history. Regimes, impacts and positions are available as arrays."""

import math
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane_frictional.base import LEFT, RIGHT, ContactState, Mode, PlaneBase
from rocking.dynamics.plane_frictional.impact_resolution import Struck
from rocking.dynamics.plane_frictional.mode_series import GroundSeries, ModeSeries, derivative, integral, value
from rocking.dynamics.taylor import turning_points
from rocking.outcome import Outcome, Regime, Status

SAMPLED = (
    "x", "rise", "rotation", "u", "w", "spin", "tangential", "normal_left", "normal_right", "work", "friction_loss",
    "impact_loss", "slid", "regime",
)  # fmt: skip

_LIGHT = 1e-9  # force / weight; smaller values are rounding errors, for which friction usage is not evaluated


class SmoothPiece(NamedTuple):
    """A smooth piece of the history."""

    start: float  # start and duration [s]
    duration: float
    series: ModeSeries
    at: float  # end of the piece within the series, in (0, 1]


class Blow(NamedTuple):
    """An impact."""

    time: float  # [s]
    before: ContactState  # state before the impact
    struck: Struck  # impulses and state after the impact
    after: ContactState  # state at the start of the next mode
    loss: float  # energy lost, per unit of mass [J/kg]


@dataclass
class History:
    """The record of a history, per unit of mass."""

    engine: ClassVar[str] = "planar: Taylor series with events and complementarity"
    count: int  # number of segments of the motion; the number of samples is count + 1
    gravity: float  # acceleration of gravity [m/s2]
    work: float = 0.0
    friction_loss: float = 0.0
    impact_loss: float = 0.0
    slid: float = 0.0
    usage: float = 0.0
    peak: float = 0.0
    replaced: int = 0  # number of impacts with Stronge's law instead of the requested law
    shocks: int = 0  # number of impacts without collision (Painleve)
    last_x: float = math.nan  # displacement of the centre of mass at the end [m]
    pieces: list[SmoothPiece] = field(default_factory=list)
    blows: list[Blow] = field(default_factory=list)
    changes: list[tuple[float, Mode]] = field(default_factory=list)
    samples: FloatArray = field(init=False)
    status: Status = Status.GOOD
    lies: bool = False  # True if the body overturned
    # last passage of the centre of mass over a foot [s]; NaN if there is none, or after a return
    passed: float = math.nan
    end: float = 0.0  # end of the history [s]

    def __post_init__(self) -> None:
        self.samples = np.full((self.count + 1, len(SAMPLED)), math.nan)

    @property
    def intervals(self) -> list[tuple[float, float, Mode]]:
        """Start [s], end [s] and mode of every interval, in order. Intervals of zero duration are omitted."""
        ends = [*(time for time, _ in self.changes[1:]), self.end]
        return [(start, end, mode) for (start, mode), end in zip(self.changes, ends, strict=False) if end > start]

    @property
    def outcome(self) -> Outcome:
        if self.status is not Status.GOOD or self.lies:
            return Outcome.OVERTURNED if self.status is Status.GOOD else Outcome.FAILED
        regimes = {mode.regime for _, _, mode in self.intervals}
        if Regime.FLIGHT in regimes:
            return Outcome.FLEW
        slid = bool(regimes & {Regime.SLIDE, Regime.SLIDE_ROCK})
        if regimes & {Regime.ROCK, Regime.SLIDE_ROCK}:
            return Outcome.ROCKED_AND_SLID if slid else Outcome.ROCKED
        return Outcome.SLID if slid else Outcome.NO_UPLIFT

    @property
    def overturning_time(self) -> float:
        """Time of the last passage of the centre of mass over the foot; NaN without overturning [s]."""
        return self.passed if self.outcome is Outcome.OVERTURNED else math.nan

    @property
    def still_rocking(self) -> bool:
        """True if the body has not overturned, but rocks or flies at the end."""
        if self.status is not Status.GOOD or self.lies:
            return False
        return self.intervals[-1][2].regime in {Regime.ROCK, Regime.SLIDE_ROCK, Regime.FLIGHT}

    def pass_through(self, start: float, series: ModeSeries, ground: GroundSeries, at: float, friction: float) -> None:
        """Add a piece to the energy balance."""
        self.pieces.append(SmoothPiece(start, at * series.unit, series, at))
        lift = np.array(ground.lift)
        lift[0] -= self.gravity
        along_x = integral(np.array(ground.push), derivative(series.x), at)
        along_z = integral(lift, derivative(series.rise), at)
        self.work -= along_x + along_z  # Eq. 46
        if series.sliding is not None and series.sliding.any():
            self.friction_loss -= series.unit * integral(series.tangential, series.sliding, at)
            self.slid += abs(series.unit * integral(np.ones(1), series.sliding, at))
        rate = derivative(series.rotation)
        inside = turning_points(series.rotation.tolist(), at) if value(rate, 0.0) * value(rate, at) < 0.0 else []
        self.peak = max(self.peak, *(abs(value(series.rotation, instant)) for instant in (0.0, at, *inside)))
        for instant in (0.0, at):
            normal = sum(value(c, instant) for c in series.normals.values())
            tangential = abs(value(series.tangential, instant))
            if tangential > 0.0 and normal > _LIGHT * self.gravity:
                self.usage = max(self.usage, tangential / normal / friction if friction else 1.0)  # Eq. 78

    def sample(self, row: int, state: ContactState, mode: Mode, series: ModeSeries | None, at: float) -> None:
        if row > self.count:
            return
        forces = [0.0, 0.0, 0.0]
        if series is not None:
            normals = [value(series.normals[f], at) if f in series.normals else 0.0 for f in (LEFT, RIGHT)]
            forces = [value(series.tangential, at), *normals]
        energies = (self.work, self.friction_loss, self.impact_loss, self.slid)
        self.samples[row] = (*state[:6], *forces, *energies, mode.regime.code)

    def strike(self, blow: Blow) -> None:
        """Add an impact to the energy balance."""
        self.blows.append(blow)
        self.impact_loss += blow.loss

    def change(self, time: float, mode: Mode) -> None:
        """Record the start of another mode."""
        if self.changes and self.changes[-1][0] == time:
            self.changes.pop()
        if not self.changes or self.changes[-1][1] != mode:
            self.changes.append((time, mode))


REGIME = np.dtype(
    [("start", "f8"), ("end", "f8"), ("regime", "U10"), ("feet", "U5"), ("slip", "i1"), ("distance", "f8")]
)
"""Fields of `ContactResponse.regimes`: start, end [s], name of a `Regime`, feet, direction, slip to the right [m]."""

IMPACT = np.dtype(
    [
        ("time", "f8"), ("feet", "U5"), ("velocity_before", "f8"), ("velocity_after", "f8"), ("normal_left", "f8"),
        ("normal_right", "f8"), ("tangential_left", "f8"), ("tangential_right", "f8"),
        ("energy_lost", "f8"), ("slips", "?"),
    ]
)  # fmt: skip
"""Fields of `ContactResponse.impacts`: time [s], feet, theta' [rad/s], impulses [N s], energy loss [J], slip."""


def regimes_of(history: History, base: PlaneBase) -> np.ndarray:
    """Return the regimes of a history in order, of type `REGIME`, without intervals of zero duration."""
    rows = [
        (start, end, mode.regime.name, mode.carrier, mode.slip, _distance(history, base, mode, start, end))
        for start, end, mode in history.intervals
    ]
    return np.array(rows, dtype=REGIME)


def _distance(history: History, base: PlaneBase, mode: Mode, start: float, end: float) -> float:
    if not mode.slip:
        return 0.0
    (x_start, _, rotation_start), (x_end, _, rotation_end) = positions_of(history, np.array([start, end])).tolist()
    foot = mode.feet[0]
    return float(x_end + base.arm(foot, rotation_end)[0] - x_start - base.arm(foot, rotation_start)[0])


def impacts_of(history: History, base: PlaneBase) -> np.ndarray:
    """Return the impacts of a history in order, of type `IMPACT`."""
    # only the sum of the tangential impulses is determined; it is divided in proportion to the vertical impulses
    rows = []
    for blow in history.blows:
        normal = {foot: blow.struck.normal.get(foot, 0.0) for foot in (LEFT, RIGHT)}
        total = sum(normal.values())
        tangential = {foot: blow.struck.tangential * n / total if total else 0.0 for foot, n in normal.items()}
        feet = Mode(tuple(sorted(blow.before.touching))).carrier
        impulses = [base.mass * p for p in (normal[LEFT], normal[RIGHT], tangential[LEFT], tangential[RIGHT])]
        lost = base.mass * blow.loss
        rows.append((blow.time, feet, blow.before.spin, blow.after.spin, *impulses, lost, blow.struck.slip != 0))
    return np.array(rows, dtype=IMPACT)


def positions_of(history: History, time: FloatArray) -> FloatArray:
    """Return x [m], rise [m] and theta [rad] at times [s], shape (..., 3).

    Between two pieces, the later piece applies.
    """
    pieces = history.pieces
    if not pieces:
        return np.zeros((*time.shape, 3))
    starts = np.array([piece.start for piece in pieces])
    positions = np.empty((*time.shape, 3))
    indices = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(pieces) - 1)
    for index, k in np.ndenumerate(indices):
        piece = pieces[int(k)]
        at = min(max((float(time[index]) - piece.start) / piece.series.unit, 0.0), piece.at)
        series = (piece.series.x, piece.series.rise, piece.series.rotation)
        positions[index] = [np.polynomial.polynomial.polyval(at, c) for c in series]
    return positions
