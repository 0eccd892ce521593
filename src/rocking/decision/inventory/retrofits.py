"""Plan of measures: the smallest changes that make an object green, and the number of prevented falls."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray, IntArray
from rocking.decision.inventory.draws import Draws, impacts, slenderest
from rocking.decision.inventory.hazard import Hazard
from rocking.decision.inventory.objects import DIRECTIONS, Direction, InventoryObject
from rocking.decision.inventory.space import SpatialObject
from rocking.decision.remedies import Landings, changed, lengths_without_uplift, lifting_factor, tension
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.motions import peak_ground_acceleration, peak_ground_velocity
from rocking.outcome import overturned
from rocking.restitution import ImpactGeometry
from rocking.studies.histories import HistoryTable, results_of
from rocking.studies.motion_sets import MotionList

ROUNDS = 4
"""Number of bisections between no change and the change without uplift."""

_COARSE, _FINE, _SMALL = 0.01, 0.001, 0.1  # lengths change in steps of 1 cm, or in steps of 1 mm up to 10 cm [m]
_angle = np.frompyfunc(math.atan2, 2, 1)  # math.atan2, because numpy.arctan2 differs between processors

_Judgement = Callable[[InventoryObject, Direction, np.ndarray, FloatArray], bool]
# object, directions of uplift, fraction of motions with overturning, and weight of a fall
_Candidate = tuple[InventoryObject, tuple[Direction, ...], float, float]


@dataclass(frozen=True, eq=False)
class PlanEntry:
    """Measures that make an object green. A measure is None if it is not effective, unknown or not computed."""

    item: InventoryObject
    spared: float  # expected number of prevented falls [-]
    gain: float  # prevented falls, weighted by the consequence of a fall [-]
    directions: tuple[Direction, ...] = ()  # directions of uplift
    wider: float | None = None  # extension of the base on each side [m]
    lower: float | None = None  # lowering of the centre of mass [m]
    ballast: float | None = None  # mass of the ballast at the floor for this lowering, for a known mass [kg]
    ballast_share: float | None = None  # mass of the ballast / mass of the object [-]
    weaker: float | None = None  # largest scale factor of the motions that gives green [-]
    pull: float | None = None  # force of the anchors along one edge / weight [-]
    force: float | None = None  # force of the anchors, if the mass is known [N]
    shear: float | None = None  # horizontal force on all anchors / weight [-]
    in_space: bool = False  # True for an object in three dimensions, without changes of base and centre


@dataclass(eq=False)
class _Search:
    """Search of one measure in integer steps, between no change (not sufficient) and the change without uplift."""

    subject: "_Subject"
    name: str  # measure: out, down or weaker
    step: float
    high: int
    low: int = 0
    is_effective: bool = False


class Planner:
    """Histories of changed objects, with the motions and samples of the assessment."""

    def __init__(
        self, hazard: Hazard, draws: Draws, restitution: Any, gravity: float, threads: int | None,
        is_green: _Judgement,
    ) -> None:  # fmt: skip
        self.draws, self.restitution, self.gravity, self.threads = draws, restitution, gravity, threads
        self.motions, self.settings, self.is_green = (
            MotionList(hazard.motions),
            PlaneSettings(gravity=gravity),
            is_green,
        )
        # without vertical motion, the strongest motion alone decides on uplift
        peaks = [peak_ground_acceleration(motion) for motion in hazard.motions]
        self.strongest = hazard.motions if hazard.vertical else hazard.motions[int(np.argmax(peaks)) :][:1]
        self.peak = max(peaks)
        # these motions come first: if one of them overturns an object, the other motions are not computed
        order = np.argsort([-peak_ground_velocity(motion) for motion in hazard.motions], kind="stable")
        self.hardest = np.sort(order[: math.ceil(len(order) / 4)])

    def entries(self, candidates: Iterable[_Candidate]) -> list[PlanEntry]:
        """Return the measures for objects that are not green."""
        subjects = [(_Subject(self, item, ways), fraction, weight) for item, ways, fraction, weight in candidates]
        searches = [search for subject, _, _ in subjects for search in subject.searches()]
        self._bisect(searches)
        changes = {
            (id(search.subject), search.name): search.high * search.step for search in searches if search.is_effective
        }
        names = ("out", "down", "weaker")
        return [
            subject.entry(fraction, weight, *(changes.get((id(subject), name)) for name in names))
            for subject, fraction, weight in subjects
        ]

    def entry_in_space(self, moving: SpatialObject, restitution: Any, fraction: float, weight: float) -> PlanEntry:
        """Return the largest scale factor of green for an object in three dimensions, and the anchor forces."""
        item, others = moving.item, np.setdiff1d(np.arange(len(self.motions)), self.hardest)

        def green(k: int) -> bool:
            hard = moving.results(restitution, self.hardest, 1.0 - _COARSE * k)
            if overturned(hard[0]).any():
                return False
            easy = moving.results(restitution, others, 1.0 - _COARSE * k)
            outcomes, ratios = (np.concatenate(values).T for values in zip(hard, easy, strict=True))
            return all(self.is_green(item, *values) for values in zip(DIRECTIONS, outcomes, ratios, strict=True))

        # scale factor of horizontal motions without uplift and sliding
        threshold = 0.0 if len(self.strongest) > 1 else min(moving.moves()) / self.peak
        low, high = 0, min(99, max(1, math.floor((1.0 - threshold) / _COARSE + 1e-9) + 1))
        is_effective = green(high)
        for _ in range(ROUNDS if is_effective else 0):
            middle = (low + high) // 2
            low, high = (low, high) if middle == low else (low, middle) if green(middle) else (middle, high)
        pull = moving.pull()
        return PlanEntry(
            item, item.count * fraction, item.count * fraction * weight, DIRECTIONS, in_space=True, pull=pull,
            weaker=round(1.0 - _COARSE * high, 9) if is_effective else None, shear=self.peak / self.gravity,
            force=None if item.mass is None else pull * item.mass * self.gravity,
        )  # fmt: skip

    def _bisect(self, searches: Sequence[_Search]) -> None:
        are_green = self.green([(search, search.high) for search in searches])
        for search, is_green in zip(searches, are_green, strict=True):
            search.is_effective = is_green
        for _ in range(ROUNDS):
            trials = [
                (search, (search.low + search.high) // 2)
                for search in searches if search.is_effective and search.high - search.low > 1
            ]  # fmt: skip
            for (search, k), is_green in zip(trials, self.green(trials), strict=True):
                search.low, search.high = (search.low, k) if is_green else (k, search.high)

    def green(self, trials: Sequence[tuple[_Search, int]]) -> list[bool]:
        """Return True for changed objects that are green in every direction of uplift."""
        upright = self._all(trials, self.hardest, lambda _, __, outcome, ___: not overturned(outcome).any())
        remaining = [trial for trial, is_upright in zip(trials, upright, strict=True) if is_upright]
        are_green = iter(self._all(remaining, np.arange(len(self.motions)), self.is_green))
        return [is_upright and next(are_green) for is_upright in upright]

    def _all(self, trials: Sequence[tuple[_Search, int]], motions: IntArray, good: _Judgement) -> list[bool]:
        """Return True for changed objects whose histories are acceptable in every direction."""
        rows = [
            (search.subject.item, way, search.subject.sides(way, **{search.name: k * search.step}))
            for search, k in trials for way in search.subject.directions
        ]  # fmt: skip
        if not rows:
            return []
        values = {name: np.concatenate([sides[name][motions] for *_, sides in rows]) for name in rows[0][2]}
        table = HistoryTable(self.motions, np.tile(motions, len(rows)), values, settings=self.settings)
        results = results_of(table, threads=self.threads)
        shape = (len(rows), len(motions))
        outcome = results["outcome"].reshape(shape)
        ratio = (np.abs(results["peak_rotation"]) / values["alpha_right"]).reshape(shape)
        are_good = [good(item, way, *both) for (item, way, _), *both in zip(rows, outcome, ratio, strict=True)]
        ends = np.cumsum([len(search.subject.directions) for search, _ in trials]).tolist()
        return [all(are_good[first:last]) for first, last in zip([0, *ends[:-1]], ends, strict=True)]


class _Subject:
    """An object and its changed variants."""

    def __init__(self, planner: Planner, item: InventoryObject, directions: tuple[Direction, ...]) -> None:
        self.planner, self.item, self.directions = planner, item, directions
        self._bodies = {way: [variant.body(way) for variant in planner.draws.bodies(item)] for way in directions}
        self._number = planner.draws.number(len(next(iter(self._bodies.values()))))
        self._right = {way: impacts(bodies, "right", self._number) for way, bodies in self._bodies.items()}
        # variants with the smallest uplift acceleration
        self._worst = [slenderest(item).body(way) for way in directions]

    @cached_property
    def _landings(self) -> dict[Direction, list[Landings]]:
        models = {"selected": self.planner.restitution}
        return {way: [Landings(body, models) for body in bodies] for way, bodies in self._bodies.items()}

    def searches(self) -> Iterator[_Search]:
        """Yield the searches of measures; the upper end is the change without uplift, in closed form."""
        planner = self.planner
        limits = np.array(
            [lengths_without_uplift(body, planner.strongest, 1.0, planner.gravity) for body in self._worst]
        ).max(axis=0)
        lowest = min(float(geometry.height.min()) for geometry in self._right.values())
        for name, length in zip(("out", "down"), limits.tolist(), strict=True):
            if math.isfinite(length):
                step = _COARSE if length > _SMALL else _FINE
                high = math.floor(length / step + 1e-9) + 1  # the smallest step above the limit of uplift
                yield _Search(self, name, step, max(1, high if name == "out" else min(high, int(0.99 * lowest / step))))
        uplift = min(
            lifting_factor(body, motion, planner.gravity) for body in self._worst for motion in planner.strongest
        )
        yield _Search(self, "weaker", _COARSE, min(99, max(1, math.floor((1.0 - uplift) / _COARSE + 1e-9) + 1)))

    def sides(self, way: Direction, out: float = 0.0, down: float = 0.0, weaker: float = 0.0) -> dict[str, FloatArray]:
        """Return the side parameters of a changed object, for each motion."""
        right, gravity = self._right[way], self.planner.gravity
        height, old, new = right.height - down, right.old_lever + out, right.new_lever + out
        # ballast at the floor: its fraction of the total mass is down / right.height
        spread_x, spread_y = height / right.height * np.array([right.spread_x, right.spread_y])
        spread_y = spread_y + down * height
        rows = {"scale": np.full(len(height), 1.0 - weaker)}
        for foot, behind, ahead in (("right", old, new), ("left", new, old)):
            geometry = ImpactGeometry(height, behind, ahead, spread_x, spread_y)
            square = height**2 + ahead**2
            rows[f"alpha_{foot}"] = np.asarray(_angle(ahead, height), dtype=np.float64)
            rows[f"p_{foot}"] = np.sqrt(gravity * np.sqrt(square) / geometry.new_gyration)  # Eq. 26
            rows[f"q_{foot}"] = square / geometry.new_gyration  # Eq. 27
            if self.planner.restitution is None:
                rows[f"r_{foot}"] = self.planner.draws.restitution(geometry)
        if self.planner.restitution is not None:
            pairs = [
                landings.of(changed(body, True, out=out, down=down))[0]
                for landings, body in zip(self._landings[way], self._bodies[way], strict=True)
            ]
            rows |= {f"r_{foot}": np.array([pair[foot] for pair in pairs])[self._number] for foot in FEET}
        return rows

    def entry(
        self, fraction: float, weight: float, out: float | None, down: float | None, weaker: float | None
    ) -> PlanEntry:
        """Return the measures of the searches, with the anchor forces."""
        planner, item = self.planner, self.item
        pull = max(
            max(tension(body, motion, 1.0, planner.gravity).values()) / (body.mass * planner.gravity)
            for body in self._worst for motion in planner.strongest
        )  # fmt: skip
        added = None if down is None else down / (self._worst[0].side("right").centre_height - down)
        return PlanEntry(
            item, item.count * fraction, item.count * fraction * weight, self.directions, wider=out, lower=down,
            ballast=None if added is None or item.mass is None else item.mass * added, ballast_share=added,
            weaker=None if weaker is None else round(1.0 - weaker, 9), pull=pull,
            force=None if item.mass is None else pull * item.mass * planner.gravity,
            shear=planner.peak / planner.gravity,
        )  # fmt: skip
