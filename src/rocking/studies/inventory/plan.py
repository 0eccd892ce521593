"""A plan of measures: the least change that makes an object green, and how many pieces fall less for it."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray, IntArray
from rocking.dynamics.settings import Settings
from rocking.motions import peak_ground_velocity
from rocking.outcome import overturned
from rocking.restitution import ImpactGeometry
from rocking.studies.histories import HistoryTable, results_of
from rocking.studies.inventory.draws import Draws, chosen, geometries, slenderest
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.objects import Direction, InventoryObject
from rocking.studies.motion_sets import MotionList
from rocking.studies.remedies import Landings, changed, lifting_factor, still, tension

_Judgement = Callable[[InventoryObject, Direction, np.ndarray, FloatArray], bool]

ROUNDS = 4
"""Halvings between the change that keeps an object from lifting and none."""

_COARSE, _FINE, _SMALL = 0.01, 0.001, 0.1  # lengths are changed by whole centimetres, up to 10 cm by millimetres [m]
_angle = np.frompyfunc(math.atan2, 2, 1)  # numpy's own differs between processors


@dataclass(frozen=True, eq=False)
class Measures:
    """What would make an object green; None where it does not serve, or was not computed."""

    item: InventoryObject
    spared: float  # pieces that fall less, as expected [-]
    gain: float  # the same, weighted by the consequence of a fall [-]
    directions: tuple[Direction, ...]  # in which it is lifted, and changed
    wider: float | None  # how far either side of its base must reach out [m]
    lower: float | None  # how far the centre of mass must come down [m]
    ballast: float | None  # mass at the floor that lowers it so far, where its own is known [kg]
    pull: float | None  # force to be held along one edge over the weight, and on all anchors across [-]
    shear: float | None
    force: float | None  # pull in newtons, where the mass is known [N]
    weaker: float | None  # largest share of this shaking under which it is green where it stands [-]

    @property
    def computed(self) -> bool:
        """Whether anything was computed: not in three dimensions."""
        return self.pull is not None


@dataclass
class _Search:
    """One way to help an object, in whole steps: from none, which is not enough, to what keeps it from lifting."""

    subject: "_Subject"
    name: str  # out, down or weaker
    step: float
    high: int
    low: int = 0
    serves: bool = field(default=False)

    @property
    def middle(self) -> int:
        return (self.low + self.high) // 2


class Planner:
    """Histories of changed objects: with the same motions and draws as those of the assessment."""

    def __init__(
        self, hazard: Hazard, draws: Draws, restitution: Any, gravity: float, threads: int | None,
        is_green: _Judgement,
    ) -> None:  # fmt: skip
        self.draws, self.restitution, self.gravity, self.threads = draws, restitution, gravity, threads
        self.motions, self.is_green = MotionList(hazard.motions), is_green
        # of level motions the strongest one alone decides what lifts
        peaks = [float(np.abs(each.acceleration).max()) for each in hazard.motions]
        self.strongest = hazard.motions if hazard.vertical else hazard.motions[int(np.argmax(peaks)) :][:1]
        self.peak = max(peaks)
        self.settings = Settings(gravity=gravity)
        # where one of these overturns a changed object, the others need not be asked
        order = np.argsort([-peak_ground_velocity(each) for each in hazard.motions], kind="stable")
        self.hardest = np.sort(order[: math.ceil(len(order) / 4)])

    def measures(self, wanted: Iterable[tuple[InventoryObject, tuple[Direction, ...], float, float]]) -> list[Measures]:
        """Return what helps objects that are lifted in some directions: with the share that falls, and its weight."""
        subjects = [(_Subject(self, item, ways), share, weight) for item, ways, share, weight in wanted]
        searches = [each for subject, _, _ in subjects for each in subject.searches()]
        self._bisect(searches)
        found = {(id(each.subject), each.name): each.high * each.step for each in searches if each.serves}
        return [
            subject.measures(share, weight, {name: found.get((id(subject), name)) for name in ("out", "down", "weaker")})
            for subject, share, weight in subjects
        ]

    def _bisect(self, searches: Sequence[_Search]) -> None:
        for each, green in zip(searches, self.green([(one, one.high) for one in searches]), strict=True):
            each.serves = green
        for _ in range(ROUNDS):
            open_ones = [each for each in searches if each.serves and each.high - each.low > 1]
            middles = [each.middle for each in open_ones]
            for each, k, green in zip(open_ones, middles, self.green(list(zip(open_ones, middles, strict=True))), strict=True):
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
        each = (good(item, way, *both) for (item, way, _), *both in zip(rows, outcome, ratio, strict=True))
        return [all([next(each) for _ in search.subject.directions]) for search, _ in tried]


class _Subject:
    """An object as it is, and as it would be changed."""

    def __init__(self, planner: Planner, item: InventoryObject, directions: tuple[Direction, ...]) -> None:
        self.planner, self.item, self.directions = planner, item, directions
        self._bodies = {way: [each.body(way) for each in planner.draws.bodies(item)] for way in directions}
        self._number = planner.draws.number(len(next(iter(self._bodies.values()))))
        self._right = {way: chosen(geometries(bodies, "right"), self._number) for way, bodies in self._bodies.items()}
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
                high = math.ceil(length / step - 1e-9)
                yield _Search(self, name, step, max(1, high if name == "out" else min(high, int(0.99 * lowest / step))))
        lifts = min(lifting_factor(body, each, planner.gravity) for body in self._worst for each in planner.strongest)
        yield _Search(self, "weaker", _COARSE, min(99, max(1, math.ceil((1.0 - lifts) / _COARSE - 1e-9))))

    def sides(self, way: Direction, out: float = 0.0, down: float = 0.0, weaker: float = 0.0) -> dict[str, FloatArray]:
        """Return the rows of a changed object, under each motion."""
        right, gravity = self._right[way], self.planner.gravity
        height, old, new = right.height - down, right.old_lever + out, right.new_lever + out
        rows = {"scale": np.full(len(height), 1.0 - weaker)}
        for foot, behind, ahead in (("right", old, new), ("left", new, old)):
            geometry = ImpactGeometry(height, behind, ahead, right.spread_x, right.spread_y)
            square = height**2 + ahead**2
            rows[f"alpha_{foot}"] = _angle(ahead, height).astype(np.float64)
            rows[f"p_{foot}"] = np.sqrt(gravity * np.sqrt(square) / geometry.new_gyration)  # Eq. 26
            rows[f"q_{foot}"] = square / geometry.new_gyration  # Eq. 27
            if self.planner.restitution is None:
                rows[f"r_{foot}"] = self.planner.draws.restitution(geometry)
        if self.planner.restitution is not None:
            pairs = [
                landings.of(changed(body, out=out, down=down))[0]
                for landings, body in zip(self._landings[way], self._bodies[way], strict=True)
            ]
            rows |= {f"r_{foot}": np.array([pair[foot] for pair in pairs])[self._number] for foot in FEET}
        return rows

    def measures(self, share: float, weight: float, steps: dict[str, float | None]) -> Measures:
        """Return what was found, with what anchors must hold."""
        planner, item = self.planner, self.item
        pull = max(
            max(tension(body, each, 1.0, planner.gravity).values()) / (body.mass * planner.gravity)
            for body in self._worst for each in planner.strongest
        )  # fmt: skip
        down, mass = steps["down"], item.mass
        height = self._worst[0].side("right").centre_height
        return Measures(
            item, item.count * share, item.count * share * weight, self.directions, steps["out"], down,
            None if down is None or mass is None else mass * down / (height - down),
            pull, planner.peak / planner.gravity, None if mass is None else pull * mass * planner.gravity,
            None if steps["weaker"] is None else 1.0 - steps["weaker"],
        )  # fmt: skip


def not_computed(item: InventoryObject, share: float, weight: float) -> Measures:
    """Return the entry of an object in three dimensions, of which nothing was computed."""
    return Measures(item, item.count * share, item.count * share * weight, (), *[None] * 7)
