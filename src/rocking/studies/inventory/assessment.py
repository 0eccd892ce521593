"""The assessment: every object in both directions under every motion, the worse direction counts."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FEET, FloatArray, g
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.loss_of_contact import lost_contact
from rocking.dynamics.parameters import SIDES, RockingParameters
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, RockingError
from rocking.outcome import Outcome
from rocking.statistics.counts import share_interval
from rocking.studies.histories import Product
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.lights import Light, Thresholds
from rocking.studies.inventory.objects import DIRECTIONS, Direction, InventoryObject, NotAssessed
from rocking.studies.inventory.reading import Inventory
from rocking.studies.motion_sets import MotionList


@dataclass(frozen=True)
class DirectionResult:
    """How an object fares in one direction with one model of impact."""

    direction: Direction  # the direction
    uplift_acceleration: float  # horizontal acceleration below which it stays still, ``g b / h`` [m/s2]
    # count, lifted, overturned, failed: motions that were computed, that lift it, that overturn it; and those that
    # could not be computed [-]
    count: int
    lifted: int
    overturned: int
    failed: int
    # median_rotation, high_rotation: median and 84 % quantile of the peak rotation over the slenderness angle [-];
    # None if it overturns there
    median_rotation: float | None
    high_rotation: float | None
    light: Light  # what this direction alone would show
    # motions of the computed ones in which the ground would have to pull: their verdicts assume contact [-]
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
    """What is said of an object."""

    item: InventoryObject  # the object
    results: tuple[DirectionResult, ...]  # one for each direction, by the model of impact that was asked for
    compared: tuple[DirectionResult, ...]  # the same by the other model
    interval: tuple[float, float]  # interval of the share that overturns in the worse direction [-]

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


PIECE = 1 << 18
"""Histories between two calls of the progress, and held in memory at once unless one object has more."""

# the one asked for and the one beside it
_MODELS = 2


@dataclass
class _Bodies:
    items: list[InventoryObject] = field(default_factory=list)
    pairs: list[list[RockingParameters]] = field(default_factory=list)
    refused: list[NotAssessed] = field(default_factory=list)


def assess(
    inventory: Inventory | Sequence[InventoryObject],
    hazard: Hazard,
    *,
    restitution: Any = "ked",
    thresholds: Thresholds | None = None,
    gravity: float = g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Assessment:
    """Assess an inventory.

    Parameters
    ----------
    inventory : Inventory or sequence of InventoryObject
        The objects.
    hazard : Hazard
        The motions; each acts in either direction by itself.
    restitution : str, RestitutionModel, float or mapping
        Model of impact; the verdict of Housner's stands beside it (of KED, if Housner's was asked for).
    thresholds : Thresholds, optional
        What the lights mean.
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the fast engine.
    progress : callable, optional
        Told how many histories have been computed since it was last called.

    Returns
    -------
    Assessment
        Verdicts, the worst first, and rows without one.

    Raises
    ------
    InvalidValueError
        If there is no object, or the restitution is a law that changes from impact to impact.

    Examples
    --------
    >>> from rocking.studies.inventory.hazard import Hazard, IntensityLevel
    >>> vase = InventoryObject(name="tall vase", width=0.2, depth=0.2, height=1.0)
    >>> hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.1g"), count=5, seed=1)
    >>> assess([vase], hazard).verdicts[0].light.word
    'green'
    """
    asked = _Asked.of(inventory, hazard, restitution, thresholds, gravity)
    found: list[Verdict | NotAssessed] = []
    for block in _blocks(asked.inventory.objects, len(hazard.motions)):
        bodies = asked.bodies(block)
        found += bodies.refused
        if bodies.items:
            found += _verdicts(bodies, _run(asked.product(bodies), threads, progress), asked)
    return asked.assessment(found)


def assessment_plan(
    inventory: Inventory | Sequence[InventoryObject],
    hazard: Hazard,
    *,
    restitution: Any = "ked",
    thresholds: Thresholds | None = None,
    gravity: float = g,
) -> tuple[Product, Callable[[Arrays], Assessment], tuple[InventoryObject, ...]]:
    """Return the histories of an assessment, what makes it of their results, and the objects, for campaigns.

    The histories are over motion, object and direction, one scale, and the two models of impact.
    """
    asked = _Asked.of(inventory, hazard, restitution, thresholds, gravity)
    bodies = asked.bodies(asked.inventory.objects)
    if not bodies.items:
        first = min([*asked.inventory.not_assessed, *bodies.refused], key=lambda each: each.row)
        raise InvalidValueError(f"no object can be assessed; line {first.row}: {first.reason}")
    product = asked.product(bodies)

    def finish(results: Arrays) -> Assessment:
        return asked.assessment([*bodies.refused, *_verdicts(bodies, _shaped(product, results), asked)])

    return product, finish, tuple(bodies.items)


@dataclass(frozen=True)
class _Asked:
    """What an assessment asks, checked."""

    inventory: Inventory
    hazard: Hazard
    restitution: Any
    comparison: str
    thresholds: Thresholds
    gravity: float

    @classmethod
    def of(
        cls, inventory: Inventory | Sequence[InventoryObject], hazard: Hazard, restitution: Any,
        thresholds: Thresholds | None, gravity: float,
    ) -> "_Asked":  # fmt: skip
        given = inventory if isinstance(inventory, Inventory) else Inventory(tuple(inventory))
        if not given.objects and not given.not_assessed:
            raise InvalidValueError("an inventory must have at least one object, got none")
        if isinstance(restitution, ImpactLaw):
            raise InvalidValueError(
                "restitution of an inventory must be a model or a coefficient, not a law of impacts"
            )
        other = "ked" if _is_housner(restitution) else "housner"
        gravity = checks.positive("gravity", gravity, "m/s2")
        made = cls(given, hazard, restitution, other, thresholds or Thresholds(), gravity)
        _ = made.labels  # a wrong word is the user's slip, not that of every row: it is refused here
        return made

    @property
    def labels(self) -> tuple[str, str]:
        """The two models, in words."""
        from rocking.bodies import Block

        block = Block(width=1.0, height=4.0)
        first, second = (
            RockingParameters.of_body(block, r, self.gravity).label for r in (self.restitution, self.comparison)
        )
        return first, second

    def bodies(self, objects: Sequence[InventoryObject]) -> _Bodies:
        return _bodies(objects, self.restitution, self.comparison, self.gravity)

    def product(self, bodies: _Bodies) -> Product:
        settings = Settings(gravity=self.gravity)
        return Product(MotionList(self.hazard.motions), _sides(bodies.pairs), np.ones(1), settings=settings)

    def assessment(self, found: Sequence[Verdict | NotAssessed]) -> Assessment:
        """Return what is said of all objects, in order."""
        verdicts = [each for each in found if isinstance(each, Verdict)]
        refused = [*self.inventory.not_assessed, *(each for each in found if isinstance(each, NotAssessed))]
        verdicts.sort(key=lambda each: (each.worse.severity, -each.item.row), reverse=True)
        refused.sort(key=lambda each: each.row)
        return Assessment(
            tuple(verdicts), tuple(refused), self.hazard, self.thresholds, *self.labels,
            source=self.inventory.source, ignored=self.inventory.ignored, gravity=self.gravity,
        )  # fmt: skip


def _blocks(objects: Sequence[InventoryObject], motions: int) -> Iterator[Sequence[InventoryObject]]:
    """Yield objects in blocks whose histories fit into a piece: an inventory of any length takes no more memory."""
    many = max(1, PIECE // (motions * len(DIRECTIONS) * _MODELS))
    for first in range(0, len(objects), many):
        yield objects[first : first + many]


def _is_housner(restitution: Any) -> bool:
    return restitution == "housner" or getattr(restitution, "name", None) == "housner"


def _bodies(objects: Sequence[InventoryObject], restitution: Any, other: str, gravity: float) -> _Bodies:
    bodies = _Bodies()
    for item in objects:
        try:
            pairs = [
                [RockingParameters.of_body(item.body(way), r, gravity) for r in (restitution, other)]
                for way in DIRECTIONS
            ]
        except RockingError as error:
            bodies.refused.append(NotAssessed(item.row, item.name, str(error)))
            continue
        bodies.items.append(item)
        bodies.pairs.extend(pairs)
    return bodies


def _verdicts(bodies: _Bodies, tables: Mapping[str, np.ndarray], asked: _Asked) -> Iterator[Verdict | NotAssessed]:
    """Yield what is said of each object of a block."""
    limits, gravity = asked.thresholds, asked.gravity
    for k, item in enumerate(bodies.items):
        yield _verdict(item, {name: values[:, 2 * k : 2 * k + 2] for name, values in tables.items()}, limits, gravity)


def _run(product: Product, threads: int | None, progress: Callable[[int], None] | None) -> Mapping[str, np.ndarray]:
    kept = {name: np.empty(product.count, RESULTS[name]) for name in ("outcome", "peak_rotation", "least_force")}
    for first in range(0, product.count, PIECE):
        last = min(first + PIECE, product.count)
        found = product.run(first, last, threads=threads)
        for name, values in kept.items():
            values[first:last] = found[name]
        if progress is not None:
            progress(last - first)
    return _shaped(product, kept)


def _shaped(product: Product, results: Arrays) -> Mapping[str, np.ndarray]:
    """Return outcome, peak rotation over the slenderness angle, loss of contact, each by motion, body and model."""
    motions, count, _, choices = product.shape
    outcome, peak = (results[name].reshape(motions, count, choices) for name in ("outcome", "peak_rotation"))
    lost = lost_contact(results).reshape(motions, count, choices)
    return {"outcome": outcome, "ratio": np.abs(peak) / product.sides["alpha_right"], "lost": lost}


def _sides(pairs: Sequence[Sequence[RockingParameters]]) -> dict[str, FloatArray]:
    return {
        f"{short}_{foot}": np.array(
            [[getattr(getattr(parameters, foot), name) for parameters in pair] for pair in pairs]
        )
        for short, name in SIDES
        for foot in FEET
    }


def _verdict(
    item: InventoryObject, table: Mapping[str, np.ndarray], limits: Thresholds, gravity: float
) -> Verdict | NotAssessed:
    failed = table["outcome"] == Outcome.FAILED.code
    if failed.all(axis=0).any():
        return NotAssessed(item.row, item.name, "no motion could be computed in one of its directions")
    found = [
        tuple(
            _direction(item, way, {name: values[:, k, choice] for name, values in table.items()}, limits, gravity)
            for k, way in enumerate(DIRECTIONS)
        )
        for choice in range(_MODELS)
    ]
    worse = max(found[0], key=lambda each: each.severity)
    return Verdict(item, found[0], found[1], share_interval(worse.overturned, worse.count, limits.level))


def _direction(
    item: InventoryObject, way: Direction, table: Mapping[str, np.ndarray], limits: Thresholds, gravity: float
) -> DirectionResult:
    outcome, ratio = table["outcome"], table["ratio"]
    good = outcome != Outcome.FAILED.code
    fell = outcome[good] == Outcome.OVERTURNED.code
    lifted = outcome[good] != Outcome.NO_UPLIFT.code
    middle, high = (_quantile(ratio[good], fell, share) for share in (0.5, 0.84))
    counts = {"lifted": int(lifted.sum()), "overturned": int(fell.sum()), "count": int(good.sum())}
    failed = int((~good).sum())
    light = limits.light(high_rotation=high, failed=failed, **counts)
    uplift = item.uplift_acceleration(way, gravity)
    return DirectionResult(
        way,
        uplift,
        median_rotation=middle,
        high_rotation=high,
        light=light,
        failed=failed,
        lost_contact=int(np.nansum(table["lost"])),
        **counts,
    )


def _quantile(ratio: FloatArray, fell: np.ndarray, share: float) -> float | None:
    """Return the smallest ratio that at least a share of the motions do not exceed; None if that one overturns."""
    ordered = np.sort(np.where(fell, np.inf, ratio))
    value = float(ordered[int(np.ceil(share * ordered.size - 1e-9)) - 1])
    return value if np.isfinite(value) else None
