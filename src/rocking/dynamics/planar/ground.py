"""The motion of the ground over a short time."""

from typing import NamedTuple


class Ground(NamedTuple):
    """The ground over a unit of time.

    Parameters
    ----------
    push, lift : list of float
        Coefficients of a_x and of g + a_z [m/s2].
    unit : float
        The unit of time [s].
    """

    push: list[float]
    lift: list[float]
    unit: float

    def shortened(self, part: float) -> "Ground":
        """Return the beginning of the same motion.

        Parameters
        ----------
        part : float
            How much of it, in (0, 1].

        Returns
        -------
        Ground
            Over a shorter unit.
        """
        if part == 1.0:
            return self
        push, lift = ([c * part**k for k, c in enumerate(series)] for series in (self.push, self.lift))
        return Ground(push, lift, self.unit * part)
