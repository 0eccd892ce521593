"""`assess`: histories with every model, in a plane or in space, margins, code methods, a probability, and remedies."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from rocking import checks, conventions
from rocking.assessment.answer import BodyAssessment, ModelMargin, StandingSolid, just_above
from rocking.bodies import Body, Solid
from rocking.bodies.equilibria import StablePose
from rocking.conventions import FEET, FloatArray, IntArray
from rocking.dynamics.mechanics import mechanics_for
from rocking.dynamics.parameters import RockingParameters
from rocking.errors import InvalidValueError, RockingError
from rocking.evidence import restitution_distribution
from rocking.motions.components import Components, components_of, rotated, with_vertical
from rocking.motions.intensity import sampled
from rocking.motions.motion import GroundMotion
from rocking.prediction import predict
from rocking.prediction.mechanics import FRICTION, Uncertain, parts, several
from rocking.prediction.space import SampledInSpace
from rocking.restitution import RestitutionModel, model, models
from rocking.studies.code_methods import CODE_METHODS
from rocking.studies.code_methods.methods import BodySides, Shaking
from rocking.studies.motion_sets import MotionList
from rocking.studies.remedies import CALIBRATED, Margins, first_to_fall, highest, lifting_factor, remedies

SPACE_DIRECTIONS = 6
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

    @property
    def vertical(self) -> FloatArray | None:
        """Vertical acceleration, as of a plane motion [m/s2]."""
        return self.in_plane.vertical


class SolidHistories:
    """Histories of a solid under motions, turned into every direction, both ways round."""

    def __init__(self, solid: Solid, motions: Any, azimuth: Any, friction: float, options: dict[str, Any]) -> None:
        self.given = [Components(*components_of(motions[k])) for k in range(len(motions))]
        for each in self.given:
            parts(each)  # refuses what is none
        told = {"friction": friction, "base": 0.0, "centre": 1.0, "restitution": 0.0}
        self._mechanics, self._options = SampledInSpace(solid, self.given, told, options["gravity"]), options
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
            for step in range(SPACE_DIRECTIONS if fixed is None else 1):
                towards = 0.5 * TURN * step / SPACE_DIRECTIONS if fixed is None else fixed + plane
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
        self, mechanics: SampledInSpace, level: float, rows: IntArray, factors: FloatArray
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


ENDS = {"low": 0.025, "high": 0.975}
"""Of the 95 % interval of what is measured of single bodies, which are asked beside the calibrated model: quantiles."""

MOST_ASKED = 50.0
"""Largest factor on the motions that remedies may be asked to hold, that up to which margins are looked for [-]."""

DIRECTIONS = 12
"""Over half a turn, into which two components are turned; both ways round make it a whole one."""

IN_SPACE = CALIBRATED, "ked", "housner"
"""Models that say something of solids, where nobody names others."""


def assess(  # noqa: PLR0913 - what is asked, what is known and how it is computed
    body: Body | Solid,
    motions: Any,
    restitution: Any = None,
    *,
    friction: Any = None,
    margin: float = 1.0,
    pga: float | None = None,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **known: Any,
) -> BodyAssessment:
    """Say whether a body stands under motions, how far it is from overturning, what decides it and what to do.

    Histories are computed under every motion, both ways round, with every model of restitution, rocking alone, and with
    the one of the least margin also where it may slide. Each is repeated at factors on the motion, to find the least
    one that overturns. Beside them stand a probability, in which what is not known is drawn, and the code methods.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        A body in its plane; or a solid, which stands in space on the vertices of its hull, in the pose into which it
        settles. Code methods and remedies of a solid are those of ``solid.in_plane`` over its nearest edge.
    motions : GroundMotion, Pulse, or mapping with x, y and z, or a sequence of them
        With y, the body is turned to both components in 12 directions; a solid in 6, with one component too.
    restitution : str, float, RestitutionModel or a sequence of them, optional
        Names, models and coefficients; if not given all registered models, and of the calibrated one its mean and
        both ends of its 95 % interval; of a solid "calibrated", "ked", "housner" and coefficients [-].
    friction : as for `predict`
        Coefficient of friction; histories that slide, and all of a solid, take its median [-].
    margin : float
        Factor on the motions that remedies must hold, up to 50 [-].
    pga : float, optional
        Peak ground acceleration to which each motion is scaled, as for `predict` [m/s2].
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the engine.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **known
        What else is known of the body, as for `predict`: ``base``, ``centre``, ``polarity``, ``azimuth``, ``count``,
        ``seed`` and more; also its ``restitution`` as ``predicted``. With a number as azimuth it is not turned.

    Returns
    -------
    BodyAssessment
        Verdict, margins, probability, code methods, remedies.

    Raises
    ------
    InvalidValueError
        If it is no body, a motion is zero throughout, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> found = assess(rk.Block(width=0.5, height=2.0, mass=300.0), rk.pulses.sine(2.0, 0.8), ["ked", 0.95], count=16)
    >>> found.verdict
    'It does not lift: it overturns under none of 1 motion, with none of 2 restitutions, either way round.'
    """
    checks.of_kind("body", body, (Body, Solid), "a Block, Section, MassPoints or Solid")
    checks.within("margin", margin, 0.0, MOST_ASKED, open_low=True)
    margin, gravity = float(margin), checks.positive("gravity", gravity, "m/s2")
    if isinstance(restitution, (str, int, float, RestitutionModel)):
        restitution = [restitution]
    whole = several(motions, pga)
    stated = (mu for mu in (friction, FRICTION[0]) if mu is not None)
    coefficient = Uncertain.of("friction", next(stated), *FRICTION[1:]).median
    options, subject = {"gravity": gravity, "threads": threads, "progress": progress}, cast(Any, body)
    space: SolidHistories | None = None
    moving: Sequence[Any]
    if not mechanics_for(subject, friction, study=True).in_plane:
        space = SolidHistories(subject, whole, known.get("azimuth"), coefficient, options)
        flat, moving, records, body, whole = space.body, space.motions, space.records, space.standing.solid, space.given
        plane = [each.in_plane for each in space.motions]
        asked = IN_SPACE if restitution is None else restitution
        restitution = [each.removesuffix("-3d") if isinstance(each, str) else each for each in asked]
    else:
        plane, records = in_the_plane(whole, known.get("azimuth"))
        flat, moving = subject, plane
    if still := next((each for each in plane if not each.peak > 0.0), None):
        raise InvalidValueError("motion {motion!r} is zero throughout: nothing would move", motion=still.name)
    different = list({id(each): each for each in plane}.values())
    place = [next(k for k, other in enumerate(different) if other is each) for each in plane]
    kept = MotionList(different)
    lifts = np.array([lifting_factor(flat, each, gravity) for each in plane]) if space is None else space.lifts()

    chosen = choices(flat, restitution)
    found, beside, refused = _margins(flat, kept, chosen, options, space, lifts)
    worst = sorted(found, key=lambda name: np.nan_to_num(found[name].lowest, nan=np.inf))
    lowest = float(np.nanmin([*(each.lowest for each in beside.values()), np.inf]))
    standing = None
    if space is None:
        sliding = _margin(flat, kept, chosen[worst[0]], {**options, "friction": coefficient})
    else:
        sliding = found[worst[0]]
        standing = space.fallen(sliding, *_told(worst[0], chosen[worst[0]]), lowest)
    falls = max(lowest, sliding.lowest) if space else lowest
    sides, shaking = BodySides.of([flat], gravity), Shaking.of(kept)
    prediction = predict(
        body, whole, restitution=known.pop("predicted", None), friction=friction, gravity=gravity, threads=threads,
        progress=progress, **known,
    )  # fmt: skip
    return BodyAssessment(
        body=flat, motions=tuple(moving), records=records, models=found, refused=refused,
        friction=coefficient, sliding=sliding, lifts=lifts,
        capacities={name: each.capacity(sides, shaking)[place, 0] for name, each in CODE_METHODS.items()},
        prediction=prediction,
        remedies=remedies(
            flat, different, margin, gravity, {name: chosen[name] for name in worst}, falls=falls <= margin
        ),
        gravity=gravity, standing=standing,
        outside={name: each.outside(sides, shaking) for name, each in CODE_METHODS.items()},
        vertical=int(shaking.vertical.sum()),
    )  # fmt: skip


def in_the_plane(motions: Any, azimuth: Any = None) -> tuple[list[GroundMotion], IntArray]:
    """Return what moves a body in its plane, one component as it is, two turned into every direction, and of which."""
    found: list[GroundMotion] = []
    records: list[int] = []
    for k in range(len(motions)):
        along, across, upright = parts(motions[k])
        turned = {"": sampled(along)}
        if across is not None:
            fixed = isinstance(azimuth, (int, float))
            angles = [float(azimuth)] if fixed else np.pi * np.arange(DIRECTIONS) / DIRECTIONS
            turned = {f", {np.degrees(a):.0f} deg": rotated(along, across, float(a))[0] for a in angles}
        for words, each in turned.items():
            name = f"{along.name}{words}"
            vertical = each.vertical if upright is None else with_vertical(each, sampled(upright)).vertical
            samples = each.acceleration if vertical is None else each.acceleration[: len(vertical)]
            called = numbered(name, found)
            found.append(GroundMotion(samples, each.time_step, vertical, called, each.metadata, each.provenance))
            records.append(k)
    return found, np.array(records)


def choices(body: Body, given: Sequence[Any] | None) -> Mapping[str, Any]:
    """Return the restitutions of histories by their names."""
    named: dict[str, Any] = {}
    usual = [CALIBRATED, *(name for name in models() if name not in {CALIBRATED, "fixed"})]
    for each in usual if given is None else given:
        if each == CALIBRATED:
            named[CALIBRATED], drawn = model(each), restitution_distribution(body)
            for end, level in ENDS.items():
                named[f"{CALIBRATED}, {end}"] = {foot: float(drawn.quantile(level, foot)) for foot in FEET}
        elif isinstance(each, (int, float)):
            named[f"r = {each:g}"] = float(each)
        else:
            one = model(each)
            named[one.label] = one
    return named


def _told(name: str, choice: Any) -> tuple[Any, float]:
    """Return a restitution by its name as `predict` takes it of a solid, and the probability of its distribution."""
    what, _, end = name.partition(", ")
    if what == CALIBRATED:
        return None, ENDS.get(end, 0.5)
    return (choice if isinstance(choice, float) else what), 0.5


def _margins(
    body: Body, motions: MotionList, chosen: Mapping[str, Any], options: dict[str, Any],
    space: SolidHistories | None, lifts: FloatArray,
) -> tuple[dict[str, ModelMargin], dict[str, ModelMargin], dict[str, str]]:  # fmt: skip
    """Return the margins, those of the plane body beside a solid, and what says nothing of it, by restitution."""
    found, beside, refused = dict[str, ModelMargin](), dict[str, ModelMargin](), dict[str, str]()
    for name, choice in chosen.items():
        try:
            flat = _margin(body, motions, choice, options)
            found[name] = flat if space is None else space.margin(flat, *_told(name, choice), lifts)
            beside[name] = flat
        except RockingError as error:
            refused[name] = str(error)
    if not found:
        raise InvalidValueError(
            "no restitution says anything of this body: {reasons}", reasons="; ".join(refused.values())
        )
    return found, beside, refused


def _margin(body: Body, motions: MotionList, restitution: Any, options: dict[str, Any]) -> ModelMargin:
    found = Margins.of(body, motions, restitution, "pga", None, options)
    # a factor of 1 may lie in a stretch that the levels have missed
    least = np.where(found.fell_each[:, :, 0] == 1.0, np.minimum(found.least_each, 1.0), found.least_each)
    parameters = RockingParameters.of_body(body, restitution, options["gravity"])
    return ModelMargin({foot: getattr(parameters, foot).coefficient for foot in FEET}, found.overturned[:, 0], least)
