"""What is said of an object: counts, rotations and a light for each direction, the worse of which governs."""

from dataclasses import dataclass

from rocking.conventions import g
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.lights import Light, Thresholds
from rocking.studies.inventory.objects import Direction, InventoryObject, NotAssessed


@dataclass(frozen=True)
class DirectionResult:
    """How an object fares in one direction with one model of impact.

    Parameters
    ----------
    direction : {"width", "depth"}
        The direction.
    uplift_acceleration : float
        Horizontal acceleration below which it stays still, ``g b / h`` [m/s2].
    count, lifted, overturned, failed : int
        Motions that were computed, that lift it, that overturn it; and those that could not be computed [-].
    median_rotation, high_rotation : float or None
        Median and 84 % quantile of the peak rotation over the slenderness angle [-]; None if it overturns there.
    light : Light
        What this direction alone would show.
    lost_contact : int
        Motions of the computed ones in which the ground would have to pull: their verdicts assume contact [-].
    """

    direction: Direction
    uplift_acceleration: float
    count: int
    lifted: int
    overturned: int
    failed: int
    median_rotation: float | None
    high_rotation: float | None
    light: Light
    lost_contact: int = 0

    @property
    def overturned_share(self) -> float:
        """Share of the motions that overturn it [-]."""
        return self.overturned / self.count

    @property
    def lifted_share(self) -> float:
        """Share of the motions that lift it [-]."""
        return self.lifted / self.count

    @property
    def severity(self) -> tuple[float, ...]:
        """What is compared to find the worse: light, share, rotations, and the acceleration of uplift [-]."""
        high, middle = (1e9 if each is None else each for each in (self.high_rotation, self.median_rotation))
        return self.light.severity, self.overturned_share, high, middle, -self.uplift_acceleration


@dataclass(frozen=True)
class Verdict:
    """What is said of an object.

    Parameters
    ----------
    item : InventoryObject
        The object.
    results : tuple of DirectionResult
        One for each direction, by the model of impact that was asked for.
    compared : tuple of DirectionResult
        The same by the other model.
    interval : tuple of float
        Interval of the share that overturns in the worse direction [-].
    """

    item: InventoryObject
    results: tuple[DirectionResult, ...]
    compared: tuple[DirectionResult, ...]
    interval: tuple[float, float]

    @property
    def worse(self) -> DirectionResult:
        """The direction that governs."""
        return max(self.results, key=lambda each: each.severity)

    @property
    def worse_compared(self) -> DirectionResult:
        """The direction that governs by the other model."""
        return max(self.compared, key=lambda each: each.severity)

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal acceleration below which the object stays still in both directions [m/s2]."""
        return min(each.uplift_acceleration for each in self.results)

    @property
    def light(self) -> Light:
        """The light of the object."""
        return self.worse.light

    @property
    def model_decides(self) -> bool:
        """Whether the other model of impact would show another light."""
        return self.worse_compared.light is not self.light


@dataclass(frozen=True, eq=False)
class Assessment:
    """An inventory assessed.

    Parameters
    ----------
    verdicts : tuple of Verdict
        The worst first.
    not_assessed : tuple of NotAssessed
        Rows without a verdict.
    hazard : Hazard
        The motions.
    thresholds : Thresholds
        What the lights mean.
    restitution, comparison : str
        The two models of impact, in words.
    source : str
        Name of the inventory.
    ignored : tuple of str
        Columns of the file that were not read.
    gravity : float
        Acceleration of gravity [m/s2].
    """

    verdicts: tuple[Verdict, ...]
    not_assessed: tuple[NotAssessed, ...]
    hazard: Hazard
    thresholds: Thresholds
    restitution: str
    comparison: str
    source: str = "objects"
    ignored: tuple[str, ...] = ()
    gravity: float = g

    def counts(self) -> dict[Light, int]:
        """Return how many rows show each light, the worst first.

        Returns
        -------
        dict of Light to int
            Rows, not pieces [-].
        """
        return {light: sum(each.light is light for each in self.verdicts) for light in reversed(Light)}
