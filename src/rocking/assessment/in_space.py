"""A solid as it stands: histories in space, turned into every direction, and the plane body of its weakest one."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rocking.assessment.answer import ModelMargin, StandingSolid, just_above
from rocking.bodies import Body, Solid
from rocking.bodies.equilibria import StablePose
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics._simulate import components_of
from rocking.motions.components import Components, rotated, with_vertical
from rocking.motions.intensity import sampled
from rocking.motions.motion import GroundMotion
from rocking.prediction.mechanics import parts
from rocking.prediction.space import SpaceMechanics
from rocking.studies.remedies import first_to_fall, highest

DIRECTIONS = 6
"""Over half a turn, into which a solid is turned; both ways round make it a whole one."""

POINTS, REACH, TOGETHER = 24, 20.0, 8
"""Factors at which the least that overturns it is looked for, up to so many times that which lifts it, so many at once:
a history in space takes a thousand times as long as one in the plane."""

TURN, SAME = 2.0 * math.pi, 1e-9


@dataclass(frozen=True, eq=False)
class TurnedMotion(Components):
    """A motion of several components under a solid that is turned."""

    called: str
    azimuth: float  # of the solid's x axis, from the ground's [rad]
    in_plane: GroundMotion  # what of it moves the plane body beside the solid

    @property
    def name(self) -> str:
        return self.called


class SolidHistories:
    """Histories of a solid under motions, turned into every direction, both ways round."""

    def __init__(self, solid: Solid, motions: Any, azimuth: Any, friction: float, options: dict[str, Any]) -> None:
        self.given = [Components(*components_of(motions[k])) for k in range(len(motions))]
        for each in self.given:
            parts(each)  # refuses what is none
        told = {"friction": friction, "base": 0.0, "centre": 1.0, "restitution": 0.0}
        self._mechanics, self._options = SpaceMechanics(solid, self.given, told, options["gravity"]), options
        pose, equilibria = self._mechanics.pose, self._mechanics.solid.equilibria()
        self._edges, self._outward = pose.edge_distances, _outward(pose)
        fixed = float(azimuth) if isinstance(azimuth, (int, float)) else None
        # over which edge it lifts first: the nearest one, or that of the direction in which it stands
        first = self._edges if fixed is None else np.min([self._lifting(each, fixed) for each in self.given], axis=0)
        towards = np.arctan2(self._outward[:, 1], self._outward[:, 0]) + 0.0
        alike = np.flatnonzero(first <= (1.0 + SAME) * first.min())
        edge = alike[np.lexsort((-towards[alike], np.abs(towards[alike])))[0]]
        reach = float(self._edges[edge])
        self.standing = StandingSolid(
            self._mechanics.solid, pose, float(towards[edge]), reach,
            bool(reach <= (1.0 + SAME) * self._edges.min()),
            next(iter(equilibria.neighbours(pose)), None),
        )  # fmt: skip
        self.motions: list[TurnedMotion] = []
        self.records: IntArray = np.empty(0, np.int64)
        self._turn(fixed)

    def _turn(self, fixed: float | None) -> None:
        """Turn every motion into every direction that the solid may have."""
        plane, numbers = self.standing.plane, list[int]()
        for k, each in enumerate(self.given):
            x = sampled(each.x)
            z = None if each.z is None else sampled(each.z)
            for step in range(DIRECTIONS if fixed is None else 1):
                towards = 0.5 * TURN * step / DIRECTIONS if fixed is None else fixed + plane
                along = x
                if each.y is not None or fixed is not None:
                    y = x.changed("none", acceleration=0.0 * x.acceleration) if each.y is None else each.y
                    least = min(len(x), len(y))
                    first, second = (part.changed("cut", acceleration=part.acceleration[:least]) for part in (x, y))
                    along, _ = rotated(first, second, towards)
                name = f"{each.x.name}, {math.degrees(towards):.0f} deg" if fixed is None else each.x.name
                called = numbered(name, self.motions)
                whole = along if z is None else with_vertical(along, z)
                self.motions.append(TurnedMotion(*each.parts, called, towards - plane, whole))
                numbers.append(k)
        self.records = np.array(numbers)

    @property
    def body(self) -> Body:
        """The plane body beside it."""
        return self.standing.solid.in_plane(self.standing.plane)

    @property
    def ways(self) -> int:
        """Whether turning it half round makes a difference: 2, or 1."""
        size, inertia = self._edges.min() * SAME, self._mechanics.inertia
        corners = np.round(self._mechanics.corners / size) + 0.0
        same = set(map(tuple, corners.tolist())) == set(map(tuple, (corners * [-1.0, -1.0, 1.0] + 0.0).tolist()))
        return 1 if same and np.abs(inertia[2, :2]).max() <= SAME * np.trace(inertia) else 2

    def lifts(self) -> FloatArray:
        """Return the factor on each motion from which on it lifts the solid over an edge, either way round [-]."""
        return np.array([self._lifting(each, each.azimuth).min() for each in self.motions])

    def _lifting(self, motion: Components, azimuth: float) -> FloatArray:
        """Return the factor on a motion from which on it lifts the solid over each edge, either way round [-]."""
        ground = [np.zeros(0) if part is None else sampled(part).acceleration for part in motion.parts]
        x, y, up = (np.pad(part, (0, max(map(len, ground)) - len(part))) for part in ground)
        c, s = math.cos(azimuth), math.sin(azimuth)
        towards = self._outward @ np.array([[c, s], [-s, c]])  # in the axes of the ground
        height, gravity = self._mechanics.pose.height, self._options["gravity"]
        push = np.abs(towards[:, :1] * x + towards[:, 1:] * y) * height - self._edges[:, None] * up
        return np.asarray(gravity * self._edges / np.maximum(push.max(axis=1), 1e-300))  # Eq. 312

    def margin(self, beside: ModelMargin, told: Any, level: float, lifts: FloatArray) -> ModelMargin:
        """Return what becomes of it with one restitution.

        beside: of the plane body, whose coefficients it has; told: what an impact costs, as `predict` takes it; level:
        probability of its distribution, if it has one.
        """
        mechanics, ways, count = self._mechanics.with_restitution(told), self.ways, len(self.motions)
        peaks = np.array([each.peak for each in self.motions])
        grid = np.array([np.geomspace(f, highest(f * a, REACH) / a, POINTS) for f, a in zip(lifts, peaks, strict=True)])

        def overturned(rows: IntArray, factors: FloatArray) -> FloatArray:
            return self._run(mechanics, level, rows, factors)[0]

        fell = overturned(np.arange(ways * count), np.ones(ways * count)).reshape(ways, count)
        least = first_to_fall(np.tile(grid, (ways, 1)), overturned, TOGETHER).reshape(ways, count)
        # a factor of 1 may lie in a stretch that the levels have missed
        least = np.where(fell == 1.0, np.minimum(least, 1.0), least)
        return replace(beside, overturned=np.maximum.reduce(fell), least=least)

    def fallen(self, margin: ModelMargin, told: Any, level: float, in_plane: float) -> StandingSolid:
        """Return it with how it falls at its least factor; in_plane: that of the plane body."""
        mechanics, (way, motion) = self._mechanics.with_restitution(told), margin.place
        turned = self.motions[motion].azimuth + 0.5 * TURN * way
        known = replace(self.standing, in_plane=in_plane, restitution=mechanics.law(level), turned=turned)
        if not math.isfinite(margin.lowest):
            return known
        factor, row = np.array([just_above(margin.lowest)]), np.array([way * len(self.motions) + motion])
        fell, slid, towards = (float(each[0]) for each in self._run(mechanics, level, row, factor))
        own = math.remainder(towards - turned, TURN) if fell == 1.0 else math.nan
        return replace(known, falls_towards=own, slides=slid)

    def _run(
        self, mechanics: SpaceMechanics, level: float, rows: IntArray, factors: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return whether each row overturns, how far it slides and in which direction it falls."""
        way, motion = np.divmod(rows, len(self.motions))
        turns = np.array([each.azimuth for each in self.motions])[motion] / TURN + 0.5 * way
        levels = {"restitution": np.full(rows.size, level), "azimuth": turns % 1.0}
        draws = np.column_stack([levels[name] for name in mechanics.widths])
        found = np.full((3, rows.size), np.nan)
        for k in np.unique(self.records[motion]):
            some = np.flatnonzero(self.records[motion] == k)
            one = mechanics.run(draws[some], int(k), factors[some], self._options["threads"])
            assert one.direction is not None
            found[:, some] = one.overturning, one.sliding, one.direction
            if self._options["progress"] is not None:
                self._options["progress"](some.size)
        return found[0], found[1], found[2]


def numbered(name: str, among: Sequence[Any]) -> str:
    """Return a name that none of some motions has: with a number behind it where one has it."""
    many = sum(other.name.partition(" (no. ")[0] == name for other in among)
    return f"{name} (no. {many + 1})" if many else name


def _outward(pose: StablePose) -> FloatArray:
    """Return the horizontal normals of the edges on which it stands, as set down."""
    along = np.roll(pose.support, -1, axis=0) - pose.support
    return np.asarray(np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True))
