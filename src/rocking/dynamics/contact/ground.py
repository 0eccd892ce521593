"""The motion of the ground over a short time."""

from typing import NamedTuple


class GroundSeries(NamedTuple):
    """The ground over a unit of time."""

    push: list[float]  # push, lift: coefficients of a_x and of g + a_z [m/s2]
    lift: list[float]
    unit: float  # the unit of time [s]

    def shortened(self, part: float) -> "GroundSeries":
        """Return the beginning of the same motion."""
        if part == 1.0:
            return self
        push, lift = ([c * part**k for k, c in enumerate(series)] for series in (self.push, self.lift))
        return GroundSeries(push, lift, self.unit * part)
