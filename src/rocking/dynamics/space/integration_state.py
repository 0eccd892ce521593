"""What is kept of a history while it runs: pieces, events, the largest tilt, and whether the body has fallen."""

import math
from dataclasses import replace

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.settings import Settings
from rocking.dynamics.space import attitude, contact_mode
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.contact_mode import ContactSet
from rocking.dynamics.space.trajectory import SpatialEvent, SpatialTrajectory, StepPiece
from rocking.dynamics.taylor import slope, turning_points
from rocking.outcome import Outcome, Status
from rocking.portable import dot

_HALVINGS = 60


class IntegrationState:
    """The record of a history."""

    def __init__(self, body: SpatialBody, settings: Settings) -> None:
        self.body, self.settings = body, settings
        self.pieces: list[StepPiece] = []
        self.events: list[SpatialEvent] = []
        self.peak, self.peak_time = 0.0, 0.0
        self.held = 0.0
        self.over_time = math.nan
        self.over: ContactSet | None = None

    def add(
        self, piece: StepPiece, until: float, up: FloatArray, pivot: FloatArray, vertical: FloatArray | None = None
    ) -> None:
        """Keep a step, ended at `until` of its length."""
        # vertical: series of the cosine of the tilt, None of a body at rest
        if until > 0.0 or not self.pieces:
            self.pieces.append(replace(piece, until=until))
        if vertical is None:
            return
        self._raise_peak(piece, until, vertical)
        if not _leaning_over(self.body, up, pivot) > 0.0:
            self.over_time, self.over = math.nan, None
        elif math.isnan(self.over_time):
            self.over_time, self.over = self._passing(piece, until), piece.contact

    def ended(
        self, time: float, quaternion: FloatArray, velocity: FloatArray, pivot: FloatArray, final: bool | None
    ) -> tuple[Outcome, Status] | None:
        """Return outcome and status of a history that lies or lacks the energy to overturn; None if it goes on."""
        up = attitude.matrix(quaternion)[2]
        if up[2] <= 0.0:
            self.over_time = time if math.isnan(self.over_time) else self.over_time
            return Outcome.OVERTURNED, Status.GOOD
        if final is False:
            return None
        body, settings = self.body, self.settings
        energy = body.kinetic(pivot, velocity) + body.mass * settings.gravity * contact_mode.rise(body, pivot, up)
        inside = not _leaning_over(body, up, pivot) > 0.0
        if final is None or (inside and energy < body.mass * settings.gravity * body.lift):
            return Outcome.ROCKED, Status.GOOD
        return None

    def falls(self, pivot: FloatArray, up: FloatArray) -> Outcome:
        """Return what a loss of contact means: a body whose centre is beyond its support falls."""
        return Outcome.OVERTURNED if _leaning_over(self.body, up, pivot) > 0.0 else Outcome.FAILED

    def trajectory(self, outcome: Outcome, status: Status) -> SpatialTrajectory:
        """Return what was kept."""
        failed, over = outcome is Outcome.FAILED, outcome is Outcome.OVERTURNED
        return SpatialTrajectory(
            pieces=self.pieces,
            events=self.events,
            outcome=outcome,
            status=status,
            peak_tilt=math.nan if failed else 0.5 * math.pi if over else self.peak,
            peak_time=math.nan if failed else self.over_time if over else self.peak_time,
            overturning_time=self.over_time if over else math.nan,
            fell_over=self.over if over else None,
            held=self.held,
            engine=f"reference (Taylor, order up to {self.settings.order}, tolerance {self.settings.tolerance:g})",
        )

    def _raise_peak(self, piece: StepPiece, until: float, vertical: FloatArray) -> None:
        """Tilt at both ends, and where it turns inside."""
        share = [0.0, until]
        terms = vertical.tolist()
        if slope(terms, 0.0) < 0.0 < slope(terms, until):
            share += turning_points(terms, until)
        found = attitude.tilt(piece.at(np.array(share))[0])
        best = int(np.argmax(found))
        if found[best] > self.peak:
            self.peak, self.peak_time = float(found[best]), piece.start + share[best] * piece.length

    def _passing(self, piece: StepPiece, until: float) -> float:
        """When the centre of mass passed over the contact, within a step."""
        low, high = 0.0, until
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            up = attitude.matrix(piece.at(np.array([middle]))[0][0])[2]
            beyond = _leaning_over(self.body, up, contact_mode.touching_point(self.body, piece.contact, up)) > 0.0
            low, high = (low, middle) if beyond else (middle, high)
        return piece.start + high * piece.length


def _leaning_over(body: SpatialBody, up: FloatArray, pivot: FloatArray) -> float:
    """Above zero where the centre of mass is beyond the contact, in the direction in which the body leans."""
    arm = body.centre - pivot
    # horizontal parts of arm and axis: a . b - (a . Z)(b . Z)
    return float(arm[2] - dot(up, arm) * up[2])  # Eq. 87
