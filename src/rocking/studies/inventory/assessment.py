"""The assessment: every object in both directions under every motion, the worse direction counts."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION, FloatArray, IntArray, g
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.errors import InvalidValueError, RockingError
from rocking.messages import Message
from rocking.outcome import Outcome, lost_contact
from rocking.statistics.counts import share_interval
from rocking.statistics.quantiles import quantiles
from rocking.studies.histories import Histories, JoinedHistories, Product, results_of
from rocking.studies.inventory.draws import STRATA, Draws, restitutions, slenderest
from rocking.studies.inventory.hazard import SEED, Hazard
from rocking.studies.inventory.lights import Light, Thresholds
from rocking.studies.inventory.objects import DIRECTIONS, Direction, InventoryObject, NotAssessed
from rocking.studies.inventory.plan import PlanEntry, Planner
from rocking.studies.inventory.reading import Inventory
from rocking.studies.inventory.space import SpatialObject
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
    slid: int = 0  # motions that make it slide, of an object in three dimensions [-]

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
    compared: tuple[tuple[DirectionResult, ...], ...]  # the same by each of the other models
    interval: tuple[float, float]  # interval of the share that overturns in the worse direction [-]
    friction: float = math.inf  # of an object that moves in space; infinite for one that rocks in a plane [-]

    @property
    def worse(self) -> DirectionResult:
        """The direction that governs."""
        return max(self.results, key=lambda each: each.severity)

    @property
    def worse_compared(self) -> tuple[DirectionResult, ...]:
        """The direction that governs, by each of the other models."""
        return tuple(max(results, key=lambda each: each.severity) for results in self.compared)

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
        """Whether another model of impact would show another light."""
        return any(each.light is not self.light for each in self.worse_compared)


@dataclass(frozen=True, eq=False)
class Assessment:
    """An inventory assessed."""

    verdicts: tuple[Verdict, ...]  # the worst first
    not_assessed: tuple[NotAssessed, ...]  # rows without a verdict
    hazard: Hazard  # the motions
    thresholds: Thresholds  # what the lights mean
    restitution: str  # restitution, comparisons: the models of impact, in words
    comparisons: tuple[str, ...]
    source: str = "objects"  # name of the inventory
    ignored: tuple[str, ...] = ()  # columns of the file that were not read
    gravity: float = g  # acceleration of gravity [m/s2]
    plan: tuple[PlanEntry, ...] = ()  # what helps the objects that are not green, sorted by gain
    drawn: bool = False  # whether the coefficient of restitution is drawn for every motion
    language: str = "en"  # of the report
    not_objects: tuple[NotAssessed, ...] = ()  # rows of the list that are no objects
    stated: tuple[str | Message, ...] = ()  # what the list states beside its table and was used
    header_lines: tuple[int, ...] = ()  # lines of the header of the list

    def pieces(self) -> dict[Light, int]:
        """Return how many pieces show each light, the worst first."""
        return {
            light: sum(each.item.count for each in self.verdicts if each.light is light) for light in reversed(Light)
        }

    def counts(self) -> dict[Light, int]:
        """Return how many rows, not pieces, show each light, the worst first."""
        return {light: sum(each.light is light for each in self.verdicts) for light in reversed(Light)}


_ROLLS = Message("its friction was not used: a round object rocks in a plane")

DEFAULT_MODELS = (DEFAULT_RESTITUTION, *reversed(COMPARED_RESTITUTIONS))
"""Restitution models of an inventory without a stated one: the first gives the rating."""

PIECE = 1 << 18
"""Histories held in memory at once unless one object has more."""


def assess(
    inventory: Inventory | Sequence[InventoryObject],
    hazard: Hazard,
    *,
    restitution: Any = None,
    thresholds: Thresholds | None = None,
    gravity: float = g,
    friction: float | None = None,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Assessment:
    """Assess an inventory; `rocking.inventory` returns the same as a dataset.

    Parameters
    ----------
    inventory : Inventory or sequence of InventoryObject
        The objects.
    hazard : Hazard
        The motions; each acts in either direction by itself.
    restitution, thresholds, gravity, friction
        As for `rocking.inventory`.
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
    assessor = _Assessor(
        inventory, hazard, restitution=restitution, thresholds=thresholds, gravity=gravity, friction=friction
    )
    in_space = filter(assessor.moves_in_space, assessor.inventory.objects)
    rulings = [assessor.verdict_in_space(item, threads, progress) for item in in_space]
    for objects in assessor.pieces():
        product, items, refused = assessor.product(objects)
        rulings += refused
        if product is not None:
            rulings += assessor.verdicts(items, product, results_of(product, threads=threads, progress=progress))
    return assessor.assessment(rulings, threads)


def assessment_plan(
    inventory: Inventory | Sequence[InventoryObject], hazard: Hazard, **options: Any
) -> tuple[Histories, Callable[[Arrays], Assessment], dict[str, int], tuple[InventoryObject, ...]]:
    """Return the histories of an assessment, what makes it of their results, what they are over, and the objects.

    For campaigns. Objects that move in three dimensions have models of impact that change more slowly than motions.
    """
    assessor = _Assessor(inventory, hazard, **options)
    objects = assessor.inventory.objects
    shaken, models = {"motion": len(hazard.motions)}, {"restitution": len(assessor.labels)}
    ways = {"direction": len(DIRECTIONS)}
    if any(map(assessor.moves_in_space, objects)):
        every = [assessor.object_histories(item) for item in objects]
        rows = [each for each in every if isinstance(each, ObjectHistories)]
        refused = [each for each in every if isinstance(each, NotAssessed)]
        assessor.check_any(rows, refused)
        parts = tuple(part for row in rows for part in row.parts)
        histories = JoinedHistories(assessor.ordered, parts, settings=parts[0].settings)

        def ruled(results: Arrays) -> Assessment:
            apart = [dict(zip(results, each, strict=True)) for each in zip(
                *(np.split(values, len(rows)) for values in results.values()), strict=True
            )]  # fmt: skip
            return assessor.assessment([*refused, *(row.rule(own) for row, own in zip(rows, apart, strict=True))])

        over = {"object": len(rows)} | models | shaken | ways
        return histories, ruled, over, tuple(row.item for row in rows)
    product, items, refused = assessor.product(objects)
    assessor.check_any(items, refused)
    assert product is not None

    def finish(results: Arrays) -> Assessment:
        return assessor.assessment([*refused, *assessor.verdicts(items, product, results)])

    return product, finish, shaken | {"object": len(items)} | ways | models, tuple(items)


@dataclass(frozen=True)
class ObjectHistories:
    """The histories of one object's verdict, and what makes it of their results."""

    item: InventoryObject
    parts: tuple[Product, ...]  # of the models one after another, each over motion and direction
    models: int  # number of models of impact
    make: Callable[[Arrays], Verdict | NotAssessed]  # of results over motion, direction and model

    def rule(self, results: Arrays) -> Verdict | NotAssessed:
        """Return the verdict of results over model, motion and direction."""
        shape = (self.models, -1, len(DIRECTIONS))
        return self.make({name: np.moveaxis(values.reshape(shape), 0, -1).ravel() for name, values in results.items()})


class _Assessor:
    """What an assessment is made with, checked, and its steps: bodies, histories, verdicts."""

    def __init__(
        self, inventory: Inventory | Sequence[InventoryObject], hazard: Hazard, *, restitution: Any = None,
        thresholds: Thresholds | None = None, gravity: float = g, friction: float | None = None,
    ) -> None:  # fmt: skip
        self.friction = friction
        self.inventory = inventory if isinstance(inventory, Inventory) else Inventory(tuple(inventory))
        if not self.inventory.objects and not self.inventory.not_assessed:
            raise InvalidValueError("an inventory must have at least one object, got none")
        if isinstance(restitution, ImpactLaw):
            raise InvalidValueError(
                "restitution of an inventory must be a model or a coefficient, not a law of impacts"
            )
        self.hazard, self.thresholds = hazard, thresholds or Thresholds()
        self.gravity = checks.positive("gravity", gravity, "m/s2")
        is_housner = restitution == "housner" or getattr(restitution, "name", None) == "housner"
        beside = ("ked",) if is_housner else ("housner",)
        # in 3D the first is the mean of the calibrated model, without scatter
        self.restitutions = DEFAULT_MODELS if restitution is None else (restitution, *beside)
        # what nobody asked for by name is drawn with its scatter, for every motion another
        self.drawn, self.draws = restitution is None, Draws(len(hazard.motions), hazard.description.get("seed", SEED))
        # a wrong word is the user's slip, not that of every row: it is refused here
        example = Block(width=1.0, height=4.0)
        self.labels = tuple(RockingParameters.of_body(example, each, self.gravity).label for each in self.restitutions)

    def pieces(self) -> Iterator[Sequence[InventoryObject]]:
        """Yield objects whose histories fit into a piece: an inventory of any length takes no more memory."""
        objects = [item for item in self.inventory.objects if not self.moves_in_space(item)]
        many = max(1, PIECE // (len(self.hazard.motions) * len(DIRECTIONS) * len(self.labels)))
        for first in range(0, len(objects), many):
            yield objects[first : first + many]

    def product(
        self, objects: Sequence[InventoryObject]
    ) -> tuple[Product | None, list[InventoryObject], list[NotAssessed]]:
        """Return the histories of some objects, those that have any, and those that are refused."""
        items: list[InventoryObject] = []
        refused: list[NotAssessed] = []
        columns: list[dict[str, FloatArray]] = []
        for item in objects:
            try:
                columns += [self._column(item, way) for way in DIRECTIONS]
            except RockingError as error:
                refused.append(NotAssessed.of(item, error.sentence))
            else:
                items.append(item)
        if not items:
            return None, items, refused
        sides = {name: np.stack([column[name] for column in columns], axis=-2) for name in columns[0]}
        if not self.drawn and not any(item.approximate for item in items):
            sides = {name: values[0] for name, values in sides.items()}  # the same under every motion
        settings = PlaneSettings(gravity=self.gravity)
        return Product(MotionList(self.hazard.motions), sides, np.ones(1), settings=settings), items, refused

    def _column(self, item: InventoryObject, way: Direction) -> dict[str, FloatArray]:
        """Return the sides of an object in a direction, under each motion by each of the models of impact."""
        bodies = [each.body(way) for each in self.draws.bodies(item)]
        every = sides_of([
            RockingParameters.of_body(body, restitution, self.gravity)
            for body in bodies for restitution in self.restitutions
        ])  # fmt: skip
        number = self.draws.number(len(bodies))
        sides = {name: values.reshape(len(bodies), -1)[number] for name, values in every.items()}
        if self.drawn:
            for foot, r in restitutions(self.draws, bodies).items():
                sides[f"r_{foot}"][:, 0] = r
        return sides

    def verdicts(
        self, items: Sequence[InventoryObject], product: Product, results: Arrays
    ) -> Iterator[Verdict | NotAssessed]:
        """Yield a verdict of each object: from outcome, rotation over the slenderness angle, and loss of contact."""
        shape = (len(product.motions), len(items), len(DIRECTIONS), len(self.labels))
        outcome = results["outcome"].reshape(shape)
        peak = np.abs(results["peak_rotation"].reshape(shape))
        ratio = peak / product.sides["alpha_right"].reshape((-1, *shape[1:]))
        lost = lost_contact(results).reshape(shape)
        for k, item in enumerate(items):
            lifts = [slenderest(item).uplift_acceleration(way, self.gravity) for way in DIRECTIONS]
            yield self._verdict(item, lifts, outcome[:, k], ratio[:, k], lost[:, k])

    def moves_in_space(self, item: InventoryObject) -> bool:
        """Return whether an object moves in three dimensions; a round one, which would roll for minutes, does not."""
        return item.solid is not None or (item.shape != "round" and self._friction(item) is not None)

    def _friction(self, item: InventoryObject) -> float | None:
        return next((mu for mu in (item.friction, self.friction) if mu is not None), None)

    def verdict_in_space(
        self, item: InventoryObject, threads: int | None, progress: Callable[[int], None] | None
    ) -> Verdict | NotAssessed:
        """Return the verdict of an object on the vertices of its hull, shaken along its width and along its depth."""
        try:
            row = self._histories_in_space(item)
            results = [results_of(part, threads=threads, progress=progress) for part in row.parts]
        except RockingError as error:
            return NotAssessed.of(item, error.sentence)
        names = ("outcome", "peak_rotation")
        return row.rule({name: np.concatenate([part[name] for part in results]) for name in names})

    def _moving(self, item: InventoryObject, threads: int | None = None) -> SpatialObject:
        return SpatialObject(item, self.hazard, self.draws, self.gravity, self._friction(item), threads)

    def object_histories(self, item: InventoryObject) -> ObjectHistories | NotAssessed:
        """Return the histories of one object, whether it rocks in a plane or moves in three dimensions."""
        if self.moves_in_space(item):
            try:
                return self._histories_in_space(item)
            except RockingError as error:
                return NotAssessed.of(item, error.sentence)
        product, _, refused = self.product([item])
        if product is None:
            return refused[0]
        sides = {name: values[self.order] if values.ndim > 2 else values for name, values in product.sides.items()}
        product = replace(product, motions=self.ordered, sides=sides)
        parts = tuple(
            replace(product, sides={name: values[..., k : k + 1] for name, values in sides.items()})
            for k in range(len(self.labels))
        )
        return ObjectHistories(item, parts, len(parts), lambda results: next(self.verdicts([item], product, results)))

    def _histories_in_space(self, item: InventoryObject) -> ObjectHistories:
        moving = self._moving(item)
        lifts = moving.moves()
        models = [[rows for _, rows in moving.histories(each, self.order)] for each in self.restitutions]
        angle = np.concatenate([np.full(len(one.motions), one.sides["alpha_right"].item()) for one in models[0]])
        shape = (-1, len(DIRECTIONS), len(self.labels))

        def make(results: Arrays) -> Verdict | NotAssessed:
            ratio = np.abs(results["peak_rotation"].reshape(shape)) / angle.reshape(-1, len(DIRECTIONS), 1)
            outcome = results["outcome"].reshape(shape)
            return self._verdict(item, lifts, outcome, ratio, np.zeros(ratio.shape), moving.friction)

        return ObjectHistories(item, tuple(one for own in models for one in own), len(models), make)

    @cached_property
    def order(self) -> IntArray:
        """The motions of one body of an object of approximate sizes after those of another."""
        return np.argsort(np.arange(len(self.hazard.motions)) % STRATA, kind="stable")

    @cached_property
    def ordered(self) -> MotionList:
        """The motions in this order."""
        return MotionList([self.hazard.motions[k] for k in self.order])

    def check_any(self, items: Sequence[Any], refused: Sequence[NotAssessed]) -> None:
        """Refuse an inventory of which no object can be assessed."""
        if not items:
            first = min([*self.inventory.not_assessed, *refused], key=lambda each: each.row)
            raise InvalidValueError(
                "no object can be assessed; line {line}: {reason}", line=first.row, reason=first.reason
            )

    def _verdict(
        self, item: InventoryObject, lifts: Sequence[float], outcome: np.ndarray, ratio: FloatArray, lost: FloatArray,
        friction: float = math.inf,
    ) -> Verdict | NotAssessed:  # fmt: skip
        if (outcome == Outcome.FAILED.code).all(axis=0).any():
            return NotAssessed.of(item, Message("no motion could be computed in one of its directions"))
        limits = self.thresholds.of(item.consequence)
        of_model, *of_others = (
            tuple(
                self._direction(way, lifts[j], outcome[:, j, model], ratio[:, j, model], lost[:, j, model], limits)
                for j, way in enumerate(DIRECTIONS)
            )
            for model in range(len(self.labels))
        )
        worse = max(of_model, key=lambda each: each.severity)
        interval = share_interval(worse.overturned, worse.count, self.thresholds.level)
        if not self.moves_in_space(item) and self._friction(item) is not None:
            item = replace(item, remarks=(*item.remarks, _ROLLS))
        return Verdict(item, of_model, tuple(of_others), interval, friction)

    def _direction(
        self, way: Direction, lifts: float, outcome: np.ndarray, ratio: FloatArray, lost: FloatArray,
        limits: Thresholds,
    ) -> DirectionResult:  # fmt: skip
        good = outcome != Outcome.FAILED.code
        fell = outcome[good] == Outcome.OVERTURNED.code
        lifted = ~np.isin(outcome[good], [Outcome.NO_UPLIFT.code, Outcome.SLID.code])
        slid = np.isin(outcome[good], [Outcome.SLID.code, Outcome.ROCKED_AND_SLID.code])
        rotations = quantiles(np.where(fell, np.inf, ratio[good]), (0.5, 0.84)).tolist()
        middle, high = (value if math.isfinite(value) else None for value in rotations)
        counts = {"lifted": int(lifted.sum()), "overturned": int(fell.sum()), "count": int(good.sum())}
        failed = int((~good).sum())
        light = limits.light(high_rotation=high, failed=failed, slid=int(slid.sum()), **counts)
        return DirectionResult(
            way, lifts, median_rotation=middle, high_rotation=high, light=light, failed=failed,
            lost_contact=int(np.nansum(lost)), slid=int(slid.sum()), **counts,
        )  # fmt: skip

    def assessment(self, rulings: Sequence[Verdict | NotAssessed], threads: int | None = None) -> Assessment:
        """Return verdicts and refusals of all objects, in order, with the plan of measures."""
        verdicts = [each for each in rulings if isinstance(each, Verdict)]
        refused = [*self.inventory.not_assessed, *(each for each in rulings if isinstance(each, NotAssessed))]
        verdicts.sort(key=lambda each: (each.worse.severity, -each.item.row), reverse=True)
        refused.sort(key=lambda each: each.row)
        return Assessment(
            tuple(verdicts), tuple(refused), self.hazard, self.thresholds, self.labels[0], self.labels[1:],
            source=self.inventory.source, ignored=self.inventory.ignored, gravity=self.gravity,
            plan=self._plan(verdicts, threads), drawn=self.drawn, language=self.inventory.language,
            not_objects=self.inventory.not_objects, stated=self.inventory.stated,
            header_lines=self.inventory.header_lines,
        )  # fmt: skip

    def _plan(self, verdicts: Sequence[Verdict], threads: int | None) -> tuple[PlanEntry, ...]:
        """Return what helps each object that is not green, the largest gain first, the worse of equals first."""
        asked = None if self.drawn else self.restitutions[0]
        planner = Planner(self.hazard, self.draws, asked, self.gravity, threads, self._is_green)
        wanted: list[tuple[InventoryObject, tuple[Direction, ...], float, float]] = []
        found: list[PlanEntry] = []
        for each in verdicts:
            if each.light is Light.GREEN:
                continue
            share, weight = each.worse.overturned_share, 1.0 / self.thresholds.factor(each.item.consequence)
            if self.moves_in_space(each.item):
                found.append(
                    planner.entry_in_space(self._moving(each.item, threads), self.restitutions[0], share, weight)
                )
            else:
                lifted = tuple(one.direction for one in each.results if one.lifted or one.failed)
                wanted.append((each.item, lifted, share, weight))
        many = max(1, PIECE // (3 * len(DIRECTIONS) * len(self.hazard.motions)))
        for first in range(0, len(wanted), many):
            found += planner.entries(wanted[first : first + many])
        rank = {id(each.item): place for place, each in enumerate(verdicts)}
        return tuple(sorted(found, key=lambda each: (-each.gain, rank[id(each.item)])))

    def _is_green(self, item: InventoryObject, way: Direction, outcome: np.ndarray, ratio: FloatArray) -> bool:
        limits = self.thresholds.of(item.consequence)
        if (outcome == Outcome.FAILED.code).all():
            return False
        return self._direction(way, 0.0, outcome, ratio, np.zeros(1), limits).light is Light.GREEN
