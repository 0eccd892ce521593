"""Assessment of every object in both directions under every motion. The worse direction decides."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION, FloatArray, IntArray, g
from rocking.decision.inventory.draws import STRATA, Draws, restitutions, slenderest
from rocking.decision.inventory.hazard import SEED, Hazard
from rocking.decision.inventory.lights import Light, Thresholds
from rocking.decision.inventory.lists.reader import Inventory
from rocking.decision.inventory.objects import DIRECTIONS, Direction, InventoryObject, NotAssessed
from rocking.decision.inventory.retrofits import PlanEntry, Planner
from rocking.decision.inventory.space import SpatialObject
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
from rocking.studies.motion_sets import MotionList


@dataclass(frozen=True)
class DirectionResult:
    """Result of an object in one direction with one restitution model."""

    direction: Direction  # the direction
    uplift_acceleration: float  # horizontal acceleration of uplift, ``g b / h`` [m/s2]
    # count: number of computed motions; lifted: with uplift; overturned: with overturning; failed: number of motions
    # that could not be computed [-]
    count: int
    lifted: int
    overturned: int
    failed: int
    # median_rotation, high_rotation: median and 84 % quantile of the ratio of peak rotation to slenderness angle [-];
    # None with overturning
    median_rotation: float | None
    high_rotation: float | None
    light: Light  # light for this direction alone
    # number of computed motions with a tensile contact force; these results assume contact [-]
    lost_contact: int = 0
    slid: int = 0  # number of motions with sliding, of an object in three dimensions [-]

    @property
    def overturned_fraction(self) -> float:
        """Fraction of the motions that overturn the object [-]."""
        return self.overturned / self.count

    @property
    def lifted_fraction(self) -> float:
        """Fraction of the motions that lift the object [-]."""
        return self.lifted / self.count

    @property
    def severity(self) -> tuple[float, ...]:
        """Sort key of the worse direction: light, fraction, rotations, and the acceleration of uplift [-]."""
        high, middle = (1e9 if ratio is None else ratio for ratio in (self.high_rotation, self.median_rotation))
        return self.light.severity, self.overturned_fraction, high, middle, -self.uplift_acceleration


@dataclass(frozen=True)
class Verdict:
    """Result of an object."""

    item: InventoryObject  # the object
    results: tuple[DirectionResult, ...]  # results by direction, with the selected restitution model
    compared: tuple[tuple[DirectionResult, ...], ...]  # results with the other models
    interval: tuple[float, float]  # interval of the overturning fraction in the worse direction [-]
    friction: float = math.inf  # coefficient of friction of an object in 3D; infinite for a plane object [-]

    @property
    def worse(self) -> DirectionResult:
        """The governing direction."""
        return max(self.results, key=lambda result: result.severity)

    @property
    def worse_compared(self) -> tuple[DirectionResult, ...]:
        """The governing direction for each of the other models."""
        return tuple(max(results, key=lambda result: result.severity) for results in self.compared)

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal acceleration of uplift: the smaller value of both directions [m/s2]."""
        return min(result.uplift_acceleration for result in self.results)

    @property
    def light(self) -> Light:
        """The light of the object."""
        return self.worse.light

    @property
    def depends_on_model(self) -> bool:
        """True if another restitution model gives another light."""
        return any(result.light is not self.light for result in self.worse_compared)


@dataclass(frozen=True, eq=False)
class Assessment:
    """Result of an inventory."""

    verdicts: tuple[Verdict, ...]  # the worst first
    not_assessed: tuple[NotAssessed, ...]  # rows without a verdict
    hazard: Hazard  # the motions
    thresholds: Thresholds  # thresholds of the lights
    restitution: str  # name of the restitution model
    comparisons: tuple[str, ...]
    source: str = "objects"  # name of the inventory
    ignored: tuple[str, ...] = ()  # columns of the file that were not read
    gravity: float = g  # acceleration of gravity [m/s2]
    plan: tuple[PlanEntry, ...] = ()  # measures for the objects that are not green, sorted by gain
    drawn: bool = False  # True if the coefficient of restitution is sampled for every motion
    language: str = "en"  # language of the report
    not_objects: tuple[NotAssessed, ...] = ()  # rows of the list that are not objects
    stated: tuple[str | Message, ...] = ()  # used statements of the list outside its table
    header_lines: tuple[int, ...] = ()  # lines of the header of the list

    def pieces(self) -> dict[Light, int]:
        """Return the number of pieces by light, the worst first."""
        return {
            light: sum(verdict.item.count for verdict in self.verdicts if verdict.light is light)
            for light in reversed(Light)
        }

    def counts(self) -> dict[Light, int]:
        """Return the number of rows (not pieces) by light, the worst first."""
        return {light: sum(verdict.light is light for verdict in self.verdicts) for light in reversed(Light)}


_ROLLS = Message("the friction coefficient is ignored: a round object rocks in a plane without sliding")

DEFAULT_MODELS = (DEFAULT_RESTITUTION, *reversed(COMPARED_RESTITUTIONS))
"""Default restitution models of an inventory; the first model gives the rating."""

PIECE = 1 << 18
"""Largest number of histories in memory, unless one object has more histories."""


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
    """Assess an inventory; `rocking.inventory` returns the same result as a dataset.

    Parameters
    ----------
    inventory : Inventory or sequence of InventoryObject
        The objects.
    hazard : Hazard
        The motions; each acts in each direction separately.
    restitution, thresholds, gravity, friction
        As for `rocking.inventory`.
    threads : int, optional
        Threads of the fast engine.
    progress : callable, optional
        Called with the number of histories computed since the last call.

    Returns
    -------
    Assessment
        Verdicts, the worst first, and rows without a verdict.

    Raises
    ------
    InvalidValueError
        If there is no object, or the restitution is an impact law.

    Examples
    --------
    >>> from rocking.decision.inventory.hazard import Hazard, IntensityLevel
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
    """Return the histories of an assessment, the function of their results, their dimensions, and the objects.

    The result is for campaigns. With objects in three dimensions, the motion index varies faster than the model index.
    """
    assessor = _Assessor(inventory, hazard, **options)
    objects = assessor.inventory.objects
    shaken, models = {"motion": len(hazard.motions)}, {"restitution": len(assessor.labels)}
    directions = {"direction": len(DIRECTIONS)}
    if any(map(assessor.moves_in_space, objects)):
        candidates = [assessor.object_histories(item) for item in objects]
        rows = [row for row in candidates if isinstance(row, ObjectHistories)]
        refused = [row for row in candidates if isinstance(row, NotAssessed)]
        assessor.check_any(rows, refused)
        products = tuple(product for row in rows for product in row.parts)
        histories = JoinedHistories(assessor.ordered, products, settings=products[0].settings)

        def ruled(results: Arrays) -> Assessment:
            by_row = [dict(zip(results, values, strict=True)) for values in zip(
                *(np.split(values, len(rows)) for values in results.values()), strict=True
            )]  # fmt: skip
            return assessor.assessment([*refused, *(row.rule(own) for row, own in zip(rows, by_row, strict=True))])

        dimensions = {"object": len(rows)} | models | shaken | directions
        return histories, ruled, dimensions, tuple(row.item for row in rows)
    product, items, refused = assessor.product(objects)
    assessor.check_any(items, refused)
    assert product is not None

    def finish(results: Arrays) -> Assessment:
        return assessor.assessment([*refused, *assessor.verdicts(items, product, results)])

    return product, finish, shaken | {"object": len(items)} | directions | models, tuple(items)


@dataclass(frozen=True)
class ObjectHistories:
    """The histories of one object, and the function from their results to its verdict."""

    item: InventoryObject
    parts: tuple[Product, ...]  # histories by model; each product is over motion and direction
    models: int  # number of restitution models
    make: Callable[[Arrays], Verdict | NotAssessed]  # function of results over motion, direction and model

    def rule(self, results: Arrays) -> Verdict | NotAssessed:
        """Return the verdict of results over model, motion and direction."""
        shape = (self.models, -1, len(DIRECTIONS))
        return self.make({name: np.moveaxis(values.reshape(shape), 0, -1).ravel() for name, values in results.items()})


class _Assessor:
    """Checked inputs of an assessment, and its steps: bodies, histories, verdicts."""

    def __init__(
        self, inventory: Inventory | Sequence[InventoryObject], hazard: Hazard, *, restitution: Any = None,
        thresholds: Thresholds | None = None, gravity: float = g, friction: float | None = None,
    ) -> None:  # fmt: skip
        self.friction = friction
        self.inventory = inventory if isinstance(inventory, Inventory) else Inventory(tuple(inventory))
        if not self.inventory.objects and not self.inventory.not_assessed:
            raise InvalidValueError("an inventory must have at least one object, got 0")
        if isinstance(restitution, ImpactLaw):
            raise InvalidValueError("restitution of an inventory must be a model or a coefficient, not an impact law")
        self.hazard, self.thresholds = hazard, thresholds or Thresholds()
        self.gravity = checks.positive("gravity", gravity, "m/s2")
        is_housner = restitution == "housner" or getattr(restitution, "name", None) == "housner"
        compared = ("ked",) if is_housner else ("housner",)
        # in 3D, the first default is the mean of the calibrated model, without scatter
        self.restitutions = DEFAULT_MODELS if restitution is None else (restitution, *compared)
        # the default model is sampled with its scatter, for each motion
        self.drawn, self.draws = restitution is None, Draws(len(hazard.motions), hazard.description.get("seed", SEED))
        # an unknown model is an error of the user, not of every row; therefore it is refused here
        example = Block(width=1.0, height=4.0)
        self.labels = tuple(
            RockingParameters.of_body(example, model, self.gravity).label for model in self.restitutions
        )

    def pieces(self) -> Iterator[Sequence[InventoryObject]]:
        """Yield groups of objects whose histories fit into a piece, so that memory does not grow with the inventory."""
        objects = [item for item in self.inventory.objects if not self.moves_in_space(item)]
        size = max(1, PIECE // (len(self.hazard.motions) * len(DIRECTIONS) * len(self.labels)))
        for first in range(0, len(objects), size):
            yield objects[first : first + size]

    def product(
        self, objects: Sequence[InventoryObject]
    ) -> tuple[Product | None, list[InventoryObject], list[NotAssessed]]:
        """Return the histories of objects, the objects with histories, and the refused objects."""
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
            sides = {name: values[0] for name, values in sides.items()}  # the sides do not depend on the motion
        settings = PlaneSettings(gravity=self.gravity)
        return Product(MotionList(self.hazard.motions), sides, np.ones(1), settings=settings), items, refused

    def _column(self, item: InventoryObject, way: Direction) -> dict[str, FloatArray]:
        """Return the sides of an object in a direction, for each motion and restitution model."""
        bodies = [variant.body(way) for variant in self.draws.bodies(item)]
        all_sides = sides_of([
            RockingParameters.of_body(body, restitution, self.gravity)
            for body in bodies for restitution in self.restitutions
        ])  # fmt: skip
        number = self.draws.number(len(bodies))
        sides = {name: values.reshape(len(bodies), -1)[number] for name, values in all_sides.items()}
        if self.drawn:
            for foot, r in restitutions(self.draws, bodies).items():
                sides[f"r_{foot}"][:, 0] = r
        return sides

    def verdicts(
        self, items: Sequence[InventoryObject], product: Product, results: Arrays
    ) -> Iterator[Verdict | NotAssessed]:
        """Yield the verdict of each object from outcomes, rotations / slenderness angle, and loss of contact."""
        shape = (len(product.motions), len(items), len(DIRECTIONS), len(self.labels))
        outcome = results["outcome"].reshape(shape)
        peak = np.abs(results["peak_rotation"].reshape(shape))
        ratio = peak / product.sides["alpha_right"].reshape((-1, *shape[1:]))
        lost = lost_contact(results).reshape(shape)
        for k, item in enumerate(items):
            uplifts = [slenderest(item).uplift_acceleration(way, self.gravity) for way in DIRECTIONS]
            yield self._verdict(item, uplifts, outcome[:, k], ratio[:, k], lost[:, k])

    def moves_in_space(self, item: InventoryObject) -> bool:
        """Return True if an object is computed in 3D; a round object is not, because it would roll for minutes."""
        return item.solid is not None or (item.shape != "round" and self._friction(item) is not None)

    def _friction(self, item: InventoryObject) -> float | None:
        return next((mu for mu in (item.friction, self.friction) if mu is not None), None)

    def verdict_in_space(
        self, item: InventoryObject, threads: int | None, progress: Callable[[int], None] | None
    ) -> Verdict | NotAssessed:
        """Return the verdict of an object in 3D, under motions along its width and along its depth."""
        try:
            row = self._histories_in_space(item)
            results = [results_of(product, threads=threads, progress=progress) for product in row.parts]
        except RockingError as error:
            return NotAssessed.of(item, error.sentence)
        names = ("outcome", "peak_rotation")
        return row.rule({name: np.concatenate([arrays[name] for arrays in results]) for name in names})

    def _moving(self, item: InventoryObject, threads: int | None = None) -> SpatialObject:
        return SpatialObject(item, self.hazard, self.draws, self.gravity, self._friction(item), threads)

    def object_histories(self, item: InventoryObject) -> ObjectHistories | NotAssessed:
        """Return the histories of one object, in a plane or in three dimensions."""
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
        uplifts = moving.moves()
        models = [[rows for _, rows in moving.histories(model, self.order)] for model in self.restitutions]
        angle = np.concatenate([np.full(len(rows.motions), rows.sides["alpha_right"].item()) for rows in models[0]])
        shape = (-1, len(DIRECTIONS), len(self.labels))

        def make(results: Arrays) -> Verdict | NotAssessed:
            ratio = np.abs(results["peak_rotation"].reshape(shape)) / angle.reshape(-1, len(DIRECTIONS), 1)
            outcome = results["outcome"].reshape(shape)
            return self._verdict(item, uplifts, outcome, ratio, np.zeros(ratio.shape), moving.friction)

        return ObjectHistories(item, tuple(rows for of_model in models for rows in of_model), len(models), make)

    @cached_property
    def order(self) -> IntArray:
        """Order of the motions, grouped by the sampled body of an object with approximate sizes."""
        return np.argsort(np.arange(len(self.hazard.motions)) % STRATA, kind="stable")

    @cached_property
    def ordered(self) -> MotionList:
        """The motions in the order of `order`."""
        return MotionList([self.hazard.motions[k] for k in self.order])

    def check_any(self, items: Sequence[Any], refused: Sequence[NotAssessed]) -> None:
        """Raise an error for an inventory without an object that can be assessed."""
        if not items:
            first = min([*self.inventory.not_assessed, *refused], key=lambda row: row.row)
            raise InvalidValueError(
                "no object can be assessed; line {line}: {reason}", line=first.row, reason=first.reason
            )

    def _verdict(
        self, item: InventoryObject, uplifts: Sequence[float], outcome: np.ndarray, ratio: FloatArray, lost: FloatArray,
        friction: float = math.inf,
    ) -> Verdict | NotAssessed:  # fmt: skip
        if (outcome == Outcome.FAILED.code).all(axis=0).any():
            return NotAssessed.of(item, Message("in one direction of the object no motion could be computed"))
        limits = self.thresholds.of(item.consequence)
        of_model, *of_others = (
            tuple(
                self._direction(way, uplifts[j], outcome[:, j, model], ratio[:, j, model], lost[:, j, model], limits)
                for j, way in enumerate(DIRECTIONS)
            )
            for model in range(len(self.labels))
        )
        worse = max(of_model, key=lambda result: result.severity)
        interval = share_interval(worse.overturned, worse.count, self.thresholds.level)
        if not self.moves_in_space(item) and self._friction(item) is not None:
            item = replace(item, remarks=(*item.remarks, _ROLLS))
        return Verdict(item, of_model, tuple(of_others), interval, friction)

    def _direction(
        self, way: Direction, uplift: float, outcome: np.ndarray, ratio: FloatArray, lost: FloatArray,
        limits: Thresholds,
    ) -> DirectionResult:  # fmt: skip
        good = outcome != Outcome.FAILED.code
        fallen = outcome[good] == Outcome.OVERTURNED.code
        lifted = ~np.isin(outcome[good], [Outcome.NO_UPLIFT.code, Outcome.SLID.code])
        slid = np.isin(outcome[good], [Outcome.SLID.code, Outcome.ROCKED_AND_SLID.code])
        rotations = quantiles(np.where(fallen, np.inf, ratio[good]), (0.5, 0.84)).tolist()
        middle, high = (value if math.isfinite(value) else None for value in rotations)
        counts = {"lifted": int(lifted.sum()), "overturned": int(fallen.sum()), "count": int(good.sum())}
        failed = int((~good).sum())
        light = limits.light(high_rotation=high, failed=failed, slid=int(slid.sum()), **counts)
        return DirectionResult(
            way, uplift, median_rotation=middle, high_rotation=high, light=light, failed=failed,
            lost_contact=int(np.nansum(lost)), slid=int(slid.sum()), **counts,
        )  # fmt: skip

    def assessment(self, rulings: Sequence[Verdict | NotAssessed], threads: int | None = None) -> Assessment:
        """Return verdicts and refusals of all objects, in order, with the plan of measures."""
        verdicts = [ruling for ruling in rulings if isinstance(ruling, Verdict)]
        refused = [*self.inventory.not_assessed, *(row for row in rulings if isinstance(row, NotAssessed))]
        verdicts.sort(key=lambda verdict: (verdict.worse.severity, -verdict.item.row), reverse=True)
        refused.sort(key=lambda row: row.row)
        return Assessment(
            tuple(verdicts), tuple(refused), self.hazard, self.thresholds, self.labels[0], self.labels[1:],
            source=self.inventory.source, ignored=self.inventory.ignored, gravity=self.gravity,
            plan=self._plan(verdicts, threads), drawn=self.drawn, language=self.inventory.language,
            not_objects=self.inventory.not_objects, stated=self.inventory.stated,
            header_lines=self.inventory.header_lines,
        )  # fmt: skip

    def _plan(self, verdicts: Sequence[Verdict], threads: int | None) -> tuple[PlanEntry, ...]:
        """Return the measures for objects that are not green, by decreasing gain, then from the worst verdict."""
        restitution = None if self.drawn else self.restitutions[0]
        planner = Planner(self.hazard, self.draws, restitution, self.gravity, threads, self._is_green)
        rockers: list[tuple[InventoryObject, tuple[Direction, ...], float, float]] = []
        entries: list[PlanEntry] = []
        for verdict in verdicts:
            if verdict.light is Light.GREEN:
                continue
            item, worse = verdict.item, verdict.worse
            fraction, weight = worse.overturned_fraction, 1.0 / self.thresholds.factor(item.consequence)
            if self.moves_in_space(item):
                entries.append(
                    planner.entry_in_space(self._moving(item, threads), self.restitutions[0], fraction, weight)
                )
            else:
                lifted = tuple(result.direction for result in verdict.results if result.lifted or result.failed)
                rockers.append((item, lifted, fraction, weight))
        size = max(1, PIECE // (3 * len(DIRECTIONS) * len(self.hazard.motions)))
        for first in range(0, len(rockers), size):
            entries += planner.entries(rockers[first : first + size])
        rank = {id(verdict.item): k for k, verdict in enumerate(verdicts)}
        return tuple(sorted(entries, key=lambda entry: (-entry.gain, rank[id(entry.item)])))

    def _is_green(self, item: InventoryObject, way: Direction, outcome: np.ndarray, ratio: FloatArray) -> bool:
        limits = self.thresholds.of(item.consequence)
        if (outcome == Outcome.FAILED.code).all():
            return False
        return self._direction(way, 0.0, outcome, ratio, np.zeros(1), limits).light is Light.GREEN
