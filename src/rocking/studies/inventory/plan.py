"""A plan of measures: the least change that makes an object green, and how many pieces fall less for it."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray, IntArray
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.motions import peak_ground_acceleration, peak_ground_velocity
from rocking.outcome import overturned
from rocking.restitution import ImpactGeometry
from rocking.studies.histories import HistoryTable, results_of
from rocking.studies.inventory.draws import Draws, impacts, slenderest
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.objects import DIRECTIONS, Direction, InventoryObject
from rocking.studies.inventory.space import SpatialObject
from rocking.studies.motion_sets import MotionList
from rocking.studies.remedies import Landings, changed, lifting_factor, still, tension

ROUNDS = 4
"""Halvings between no change and the one that keeps an object from lifting."""

_COARSE, _FINE, _SMALL = 0.01, 0.001, 0.1  # lengths are changed by whole centimetres, up to 10 cm by millimetres [m]
_angle = np.frompyfunc(math.atan2, 2, 1)  # numpy's own differs between processors

_Judgement = Callable[[InventoryObject, Direction, np.ndarray, FloatArray], bool]
# an object, the directions that lift it, the share of the motions that overturn it, and the weight of a fall
_Wanted = tuple[InventoryObject, tuple[Direction, ...], float, float]


@dataclass(frozen=True, eq=False)
class PlanEntry:
    """What would make an object green; None where it does not serve, is not known, or is not computed."""

    item: InventoryObject
    spared: float  # pieces that fall less, as expected [-]
    gain: float  # the same, weighted by the consequence of a fall [-]
    directions: tuple[Direction, ...] = ()  # in which it is lifted, and changed
    wider: float | None = None  # how far either side of its base must reach out [m]
    lower: float | None = None  # how far the centre of mass must come down [m]
    ballast: float | None = None  # mass at the floor that lowers it so far, where its own is known [kg]
    ballast_share: float | None = None  # the same over its own [-]
    weaker: float | None = None  # largest share of this shaking under which it is green where it stands [-]
    pull: float | None = None  # force that anchors along one edge must hold, over the weight [-]
    force: float | None = None  # the same, where the mass is known [N]
    shear: float | None = None  # horizontal force on all anchors over the weight [-]
    in_space: bool = False  # whether it moves in three dimensions, where neither base nor centre is changed


@dataclass(eq=False)
class _Search:
    """One way to help an object, in whole steps: from none, which is not enough, to what keeps it from lifting."""

    subject: "_Subject"
    name: str  # out, down or weaker
    step: float
    high: int
    low: int = 0
    serves: bool = False


class Planner:
    """Histories of changed objects: with the same motions and draws as those of the assessment."""

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
        # of level motions the strongest one alone decides what lifts
        peaks = [peak_ground_acceleration(each) for each in hazard.motions]
        self.strongest = hazard.motions if hazard.vertical else hazard.motions[int(np.argmax(peaks)) :][:1]
        self.peak = max(peaks)
        # where one of these overturns a changed object, the others need not be asked
        order = np.argsort([-peak_ground_velocity(each) for each in hazard.motions], kind="stable")
        self.hardest = np.sort(order[: math.ceil(len(order) / 4)])

    def entries(self, wanted: Iterable[_Wanted]) -> list[PlanEntry]:
        """Return what helps objects that are not green."""
        subjects = [(_Subject(self, item, ways), share, weight) for item, ways, share, weight in wanted]
        searches = [each for subject, _, _ in subjects for each in subject.searches()]
        self._bisect(searches)
        found = {(id(each.subject), each.name): each.high * each.step for each in searches if each.serves}
        names = ("out", "down", "weaker")
        return [
            subject.entry(share, weight, *(found.get((id(subject), name)) for name in names))
            for subject, share, weight in subjects
        ]

    def entry_in_space(self, moving: SpatialObject, restitution: Any, share: float, weight: float) -> PlanEntry:
        """Return how much weaker the shaking must be for an object in three dimensions, and what anchors must hold."""
        item, others = moving.item, np.setdiff1d(np.arange(len(self.motions)), self.hardest)

        def green(k: int) -> bool:
            hard = moving.results(restitution, self.hardest, 1.0 - _COARSE * k)
            if overturned(hard[0]).any():
                return False
            rest = moving.results(restitution, others, 1.0 - _COARSE * k)
            both = (np.concatenate(each).T for each in zip(hard, rest, strict=True))
            return all(self.is_green(item, *each) for each in zip(DIRECTIONS, *both, strict=True))

        # of level motions, what neither lifts it nor makes it slide
        still = 0.0 if len(self.strongest) > 1 else min(moving.moves()) / self.peak
        low, high = 0, min(99, max(1, math.floor((1.0 - still) / _COARSE + 1e-9) + 1))
        serves = green(high)
        for _ in range(ROUNDS if serves else 0):
            middle = (low + high) // 2
            low, high = (low, high) if middle == low else (low, middle) if green(middle) else (middle, high)
        pull = moving.pull()
        return PlanEntry(
            item, item.count * share, item.count * share * weight, DIRECTIONS, in_space=True, pull=pull,
            weaker=round(1.0 - _COARSE * high, 9) if serves else None, shear=self.peak / self.gravity,
            force=None if item.mass is None else pull * item.mass * self.gravity,
        )  # fmt: skip

    def _bisect(self, searches: Sequence[_Search]) -> None:
        for each, green in zip(searches, self.green([(one, one.high) for one in searches]), strict=True):
            each.serves = green
        for _ in range(ROUNDS):
            tried = [
                (each, (each.low + each.high) // 2) for each in searches if each.serves and each.high - each.low > 1
            ]
            for (each, k), green in zip(tried, self.green(tried), strict=True):
                each.low, each.high = (each.low, k) if green else (k, each.high)

    def green(self, tried: Sequence[tuple[_Search, int]]) -> list[bool]:
        """Return whether objects that are changed by so many steps are green in every direction that lifts them."""
        stands = self._all(tried, self.hardest, lambda _, __, outcome, ___: not overturned(outcome).any())
        left = [each for each, upright in zip(tried, stands, strict=True) if upright]
        rest = iter(self._all(left, np.arange(len(self.motions)), self.is_green))
        return [upright and next(rest) for upright in stands]

    def _all(self, tried: Sequence[tuple[_Search, int]], motions: IntArray, good: _Judgement) -> list[bool]:
        """Return whether histories under some motions are good in every direction."""
        rows = [
            (search.subject.item, way, search.subject.sides(way, **{search.name: k * search.step}))
            for search, k in tried for way in search.subject.directions
        ]  # fmt: skip
        if not rows:
            return []
        values = {name: np.concatenate([sides[name][motions] for *_, sides in rows]) for name in rows[0][2]}
        table = HistoryTable(self.motions, np.tile(motions, len(rows)), values, settings=self.settings)
        results = results_of(table, threads=self.threads)
        shape = (len(rows), len(motions))
        outcome = results["outcome"].reshape(shape)
        ratio = (np.abs(results["peak_rotation"]) / values["alpha_right"]).reshape(shape)
        found = [good(item, way, *both) for (item, way, _), *both in zip(rows, outcome, ratio, strict=True)]
        ends = np.cumsum([len(search.subject.directions) for search, _ in tried]).tolist()
        return [all(found[first:last]) for first, last in zip([0, *ends[:-1]], ends, strict=True)]


class _Subject:
    """An object as it is, and as it would be changed."""

    def __init__(self, planner: Planner, item: InventoryObject, directions: tuple[Direction, ...]) -> None:
        self.planner, self.item, self.directions = planner, item, directions
        self._bodies = {way: [each.body(way) for each in planner.draws.bodies(item)] for way in directions}
        self._number = planner.draws.number(len(next(iter(self._bodies.values()))))
        self._right = {way: impacts(bodies, "right", self._number) for way, bodies in self._bodies.items()}
        # of approximate sizes, those that lift first
        self._worst = [slenderest(item).body(way) for way in directions]

    @cached_property
    def _landings(self) -> dict[Direction, list[Landings]]:
        asked = {"asked": self.planner.restitution}
        return {way: [Landings(body, asked) for body in bodies] for way, bodies in self._bodies.items()}

    def searches(self) -> Iterator[_Search]:
        """Yield what may help, with the change that keeps the object from lifting, in closed form."""
        planner = self.planner
        most = np.array([still(body, planner.strongest, 1.0, planner.gravity) for body in self._worst]).max(axis=0)
        lowest = min(float(each.height.min()) for each in self._right.values())
        for name, length in zip(("out", "down"), most.tolist(), strict=True):
            if math.isfinite(length):
                step = _COARSE if length > _SMALL else _FINE
                high = math.floor(length / step + 1e-9) + 1  # beyond what just keeps it from lifting
                yield _Search(self, name, step, max(1, high if name == "out" else min(high, int(0.99 * lowest / step))))
        lifts = min(lifting_factor(body, each, planner.gravity) for body in self._worst for each in planner.strongest)
        yield _Search(self, "weaker", _COARSE, min(99, max(1, math.floor((1.0 - lifts) / _COARSE + 1e-9) + 1)))

    def sides(self, way: Direction, out: float = 0.0, down: float = 0.0, weaker: float = 0.0) -> dict[str, FloatArray]:
        """Return the rows of a changed object, under each motion."""
        right, gravity = self._right[way], self.planner.gravity
        height, old, new = right.height - down, right.old_lever + out, right.new_lever + out
        # ballast below the centre, at the floor, is down / right.height of the whole mass
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
        self, share: float, weight: float, out: float | None, down: float | None, weaker: float | None
    ) -> PlanEntry:
        """Return what was found, with what anchors must hold."""
        planner, item = self.planner, self.item
        pull = max(
            max(tension(body, each, 1.0, planner.gravity).values()) / (body.mass * planner.gravity)
            for body in self._worst for each in planner.strongest
        )  # fmt: skip
        added = None if down is None else down / (self._worst[0].side("right").centre_height - down)
        return PlanEntry(
            item, item.count * share, item.count * share * weight, self.directions, wider=out, lower=down,
            ballast=None if added is None or item.mass is None else item.mass * added, ballast_share=added,
            weaker=None if weaker is None else round(1.0 - weaker, 9), pull=pull,
            force=None if item.mass is None else pull * item.mass * planner.gravity,
            shear=planner.peak / planner.gravity,
        )  # fmt: skip
