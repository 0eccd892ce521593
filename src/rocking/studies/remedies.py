"""How far bodies are from overturning, and what to do: anchors, a wider base, a lower centre, isolators."""

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import plausibility
from rocking.answers import Answer
from rocking.bodies import Block, Body
from rocking.conventions import FEET, BoolArray, FloatArray, Foot, IntArray
from rocking.dynamics.parameters import RockingParameters, coefficients_of, sides_of
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.errors import GeometryError, InvalidValueError, PlausibilityWarning
from rocking.motions.intensity import measure as measure_of
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import response_spectrum
from rocking.outcome import overturned
from rocking.restitution._implied import energy_bound
from rocking.studies.fragility.subject import Responses, Subject
from rocking.studies.histories import Histories, Product, results_of
from rocking.studies.motion_sets import MotionList

POINTS, REACH, MARGIN_HALVINGS = 64, 50.0, 6
"""Levels at which the least that overturns is looked for, up to so many times what lifts, and halvings of its place."""


@dataclass(frozen=True, eq=False)
class Margins:
    """Histories of one body under all motions, of both ways round where these differ."""

    least_each: FloatArray  # least factor that overturns, by way round (as it stands, mirrored) and motion [-]
    fell_each: FloatArray  # 1 where it overturns, NaN without a result, by way round, motion and level
    factors: FloatArray  # by motion and level [-]
    label: str  # of the restitution

    @classmethod
    def of(
        cls, body: Body, motions: MotionList, restitution: Any, measure: Any, levels: FloatArray | None,
        options: dict[str, Any],
    ) -> "Margins":  # fmt: skip
        """Return the margins of a body; levels: of the measure, the motions as they are if none."""
        ground = {name: value for name, value in options.items() if name not in {"threads", "progress"}}
        subjects = [Subject.of(*each, measure, ground) for each in ways_round(body, motions, restitution)]
        one = subjects[0]
        factors = np.ones((len(motions), 1)) if levels is None else measure.factors(one.intensities, levels)

        def overturned(subject: Subject, histories: Histories, shape: tuple[int, ...]) -> FloatArray:
            arrays = results_of(histories, threads=options.get("threads"), progress=options.get("progress"))
            return Responses.of(arrays, subject.parameters, shape).overturned

        fell = [overturned(each, each.product(factors), factors.shape) for each in subjects]
        least = [_least_factor(each, overturned) for each in subjects]
        return cls(np.array(least), np.array(fell), factors, one.parameters.label)

    @property
    def least(self) -> FloatArray:
        """Least factor on each motion that overturns; infinite if none did, NaN without a result [-]."""
        return np.asarray(np.minimum.reduce(self.least_each))

    @property
    def overturned(self) -> FloatArray:
        """1 where it overturns, of either way round, by motion and level; NaN without a result."""
        return np.asarray(np.maximum.reduce(self.fell_each))


def ways_round(body: Body, motions: Any, restitution: Any) -> list[tuple[Body, Any, Any]]:
    """Return a body with its motions and restitution, and mirrored with the same where that differs."""
    swapped, differ = restitution, not body.is_symmetric
    if isinstance(restitution, Mapping) and {"left", "right"} <= set(restitution):
        swapped = {"left": restitution["right"], "right": restitution["left"]}
        differ |= restitution["left"] != restitution["right"]
    if not differ:
        return [(body, motions, restitution)]
    return [(body, motions, restitution), (body.mirrored(), motions, swapped)]


def _least_factor(
    subject: Subject, overturned: Callable[[Subject, Histories, tuple[int, ...]], FloatArray]
) -> FloatArray:
    """Return the least factor on each motion that was found to overturn; infinite if none, NaN without a result."""
    peaks, lifts = measure_of("pga").values(subject.motions, subject.scale), subject.scale.threshold
    light = not subject.are_horizontal
    grid = np.geomspace((0.1 if light else 1.0) * lifts, highest(lifts), POINTS) / peaks[:, None]
    return first_to_fall(
        grid, lambda rows, factors: overturned(subject, subject.table(rows, factors), factors.shape), POINTS
    )


def highest(lifts: float, reach: float = REACH) -> float:
    """Return up to which acceleration it is looked for what overturns, of that which lifts [m/s2]."""
    return min(reach * lifts, max(plausibility.LARGEST_PGA, 4.0 * lifts))


def first_to_fall(
    grid: FloatArray, overturned: Callable[[IntArray, FloatArray], FloatArray], together: int
) -> FloatArray:
    """Return the least factor that was found to overturn; infinite if none did, NaN without a result.

    grid: factors of each row, upwards; overturned: says it of numbers of rows, each with its factor; together: so many
    factors are tried at once of the rows of which none overturned yet.
    """
    count, points = grid.shape
    fell = np.zeros(grid.shape)
    for begin in range(0, points, together):
        part = slice(begin, begin + together)
        some = np.flatnonzero(~(fell == 1.0).any(axis=1))
        if some.size:
            tried = grid[some, part]
            numbers = np.repeat(some, tried.shape[1])
            fell[some, part] = overturned(numbers, tried.ravel()).reshape(tried.shape)
    first = np.argmax(fell == 1.0, axis=1)
    rows = np.arange(count)
    found = np.where(fell[rows, first] == 1.0, grid[rows, first], np.inf)
    low, high = grid[rows, np.maximum(first - 1, 0)], found
    some = np.flatnonzero(np.isfinite(found) & (first > 0))
    for _ in range(MARGIN_HALVINGS if some.size else 0):
        middle = np.sqrt(low[some] * high[some])
        falls = overturned(some, middle) == 1.0
        high[some], low[some] = np.where(falls, middle, high[some]), np.where(falls, low[some], middle)
    high[some] = np.sqrt(low[some] * high[some])
    before = np.where(np.isfinite(found), first, points)[:, None] > np.arange(points)
    return np.where((np.isnan(fell) & before).any(axis=1), np.nan, high)


CALIBRATED = "calibrated"

STEPS, HALVINGS = 32, 5
"""Changes that are tried up to the one that keeps a body from lifting, and halvings of the place found."""

SHARES = np.array([0.6, 0.7, 0.8, 0.9, 1.0])
"""Of the factor, at which each change is tried before the margin of the one that is found is looked for."""

PERIODS, DAMPING = np.round(np.geomspace(0.5, 6.0, 40), 2), 0.1
"""Of the isolators that are looked at: periods, such as can be said in three digits [s], and damping ratio [-]."""

ASSUMED = (
    "Anchors: body, anchors and floor are rigid, so that nothing lifts and nothing is amplified; the anchors of one "
    "edge pull straight down, with the other edge as the pivot; shear without help of friction; no safety factor.",
    "Wider base, lower centre: mass and moment of inertia about the centre stay as they are; a wider base reaches out "
    "equally on both sides.",
    f"Isolators: linear, {100 * DAMPING:g} % of critical damping, in horizontal directions alone, the body rigid on "
    "them; vertical motion passes through and is taken with its peaks throughout.",
)
"""What the remedies take for granted."""


def millimetres(length: float) -> int:
    """Return a length that is demanded in whole millimetres, never less than it is."""
    return math.ceil(1e3 * length - 1e-9)


def rounded_up(value: float) -> float:
    """Return what is demanded in three digits, never less than it is.

    >>> rounded_up(2588.96), rounded_up(0.062), rounded_up(0.0)
    (2590.0, 0.062, 0.0)
    """
    digits = 2 - math.floor(math.log10(value)) if value > 0.0 else 0
    return round(math.ceil(value * 10.0**digits - 1e-9) / 10.0**digits, max(digits, 0))


@dataclass(frozen=True)
class LengthChange:
    """How far a length must be changed."""

    # with which no history overturns any more: the least from which on all that were tried stand, in whole
    # millimetres; 0 where it stands as it is [m]
    stands: float
    lifts_not: float  # with which it does not even lift, in closed form [m]
    why_not: str = ""  # why none was looked for; empty if one was


@dataclass(frozen=True)
class Remedies:
    """What would keep a body standing under motions times a factor."""

    margin: float  # the factor on the motions [-]
    # force that anchors along the left and the right edge must hold, that of the whole edge; 0 where it does not lift
    # [N]
    tension: dict[str, float]
    shear: float  # horizontal force on all anchors [N]
    # wider, lower: how far each side of the base must reach out, and how far the centre of mass must come down
    wider: LengthChange
    lower: LengthChange
    # least period from which on no longer one lets it lift [s], and the displacement that it takes [m]; None if there
    # is none up to 6 s
    isolation: tuple[float, float] | None

    def answer(self) -> Answer:
        """Return forces of anchors, changes of lengths, and isolation."""
        period, displacement = (None, None) if self.isolation is None else self.isolation
        lengths = {
            name: {"no_overturning": each.stands, "no_uplift": each.lifts_not, "reason": each.why_not}
            for name, each in (("wider", self.wider), ("lower", self.lower))
        }
        return Answer({
            "margin": self.margin, "tension": self.tension, "shear": self.shear, **lengths,
            "isolation_period": period, "isolation_displacement": displacement,
        })  # fmt: skip

    @property
    def needed(self) -> bool:
        """Whether it lifts at all."""
        return any(force > 0.0 for force in self.tension.values())


def parts_of(motion: GroundMotion) -> tuple[FloatArray, FloatArray]:
    """Return the horizontal acceleration without its sign, both ways round being possible, and the one upwards."""
    across = np.abs(motion.acceleration)
    return across, np.zeros_like(across) if motion.vertical is None else np.asarray(motion.vertical)


def lifting_factor(body: Body, motion: GroundMotion, gravity: float) -> float:
    """Return the factor on a motion from which on it lifts a body, either way round [-]."""
    across, up = parts_of(motion)
    sides = [body.side(foot, gravity) for foot in FEET]
    least = [s.half_width * gravity / max((across * s.centre_height - up * s.half_width).max(), 1e-300) for s in sides]
    return float(min(least))  # Eq. 312


def tension(body: Body, motion: GroundMotion, factor: float, gravity: float) -> dict[str, float]:
    """Return the force with which anchors along each edge must hold it down [N]; the pivot is the other edge."""
    across, up = parts_of(motion)
    base = body.feet[1] - body.feet[0]
    found = {}
    for edge, pivot in zip(FEET, FEET[::-1], strict=True):
        side = body.side(pivot, gravity)
        moment = factor * across * side.centre_height - (gravity + factor * up) * side.half_width
        found[edge] = max(0.0, body.mass * float(moment.max()) / base)  # Eq. 313
    return {str(edge): force for edge, force in found.items()}


def still(body: Body, motions: Sequence[GroundMotion], factor: float, gravity: float) -> tuple[float, float]:
    """Return how far the sides must reach out, and the centre come down, that nothing lifts [m]; infinite if none."""
    sides = [body.side(foot, gravity) for foot in FEET]
    narrow, height = min(side.half_width for side in sides), sides[0].centre_height
    ratio = 0.0
    for motion in motions:
        across, up = parts_of(motion)
        weight = gravity + factor * up
        if (weight <= 0.0).any():
            return np.inf, np.inf
        ratio = max(ratio, float((factor * across / weight).max()))
    return max(0.0, ratio * height - narrow), max(0.0, height - narrow / ratio if ratio else 0.0)  # Eq. 314


def remedies(
    body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float,
    restitutions: Mapping[str, Any], *, falls: bool,
) -> Remedies:  # fmt: skip
    """Return what would help; restitutions: by name; falls: whether it overturns under some motion times the margin."""
    both = [tension(body, each, margin, gravity) for each in motions]
    out, down = still(body, motions, margin, gravity)
    shear = margin * body.mass * max(float(parts_of(each)[0].max()) for each in motions)
    changes = {}
    for name, most in (("out", out), ("down", down)):
        try:
            with warnings.catch_warnings():  # nobody typed how low a centre is that is tried
                warnings.simplefilter("ignore", PlausibilityWarning)
                landings = Landings(body, restitutions) if falls else None
                stands = _least(body, motions, margin, gravity, landings, name=name, most=most) if landings else 0.0
            changes[name] = LengthChange(stands, most)
        except GeometryError as error:
            changes[name] = LengthChange(np.nan, most, str(error))
    held = {str(edge): max(one[edge] for one in both) for edge in FEET}
    lifts = any(force > 0.0 for force in held.values())
    isolated = isolation(body, motions, margin, gravity) if lifts else None
    return Remedies(margin, held, shear, changes["out"], changes["down"], isolated)


def isolation(body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float) -> tuple[float, float] | None:
    """Return the least period from which on isolators keep a body from lifting [s], and their displacement [m]."""
    slope = min(body.side(foot, gravity).half_width / body.side(foot, gravity).centre_height for foot in FEET)
    good, far = np.ones(PERIODS.size, bool), np.zeros(PERIODS.size)
    for motion in motions:
        lightest = gravity + margin * min(float(parts_of(motion)[1].min()), 0.0)
        found = response_spectrum(motion, PERIODS, DAMPING)
        good &= margin * found.absolute_acceleration <= slope * lightest
        far = np.maximum(far, margin * found.displacement)
    first = int(np.flatnonzero(~good)[-1]) + 1 if not good.all() else 0
    return (float(PERIODS[first]), float(far[first])) if first < PERIODS.size else None


def changed(body: Body, ballast: bool = False, /, *, out: float = 0.0, down: float = 0.0) -> Block:
    """Return a block of the same mass and inertia with feet so far outside, and a centre so far below, as given [m].

    With ballast, what lowers the centre is a mass on the ground below it, which is added with its inertia.
    """
    left, right = body.feet
    width, x, y = right - left + 2.0 * out, body.centre[0] - left + out, body.centre[1] - body.ground - down
    if not y > 0.0:
        raise GeometryError("the centre of mass would lie {depth:.0f} mm below the ground", depth=-1000.0 * y)
    mass, inertia = body.mass, body.moment_of_inertia
    if ballast:
        mass, inertia = mass * (y + down) / y, inertia + mass * down * (y + down)
    gyration = inertia / mass - x * (width - x)  # what of it only height can give
    height = max(body.local_box[3], y + 1.01 * max(gyration, y**2) / y)
    return Block(width=width, height=height, depth=1.0, mass=mass, centre=(x, y), moment_of_inertia=inertia)


class Landings:
    """Coefficients of a body that is changed: those it has, moved as far as what gives them says for the change.

    What is changed is a block, whose mass lies otherwise than that of the body: unchanged it has the body's own ones.
    """

    def __init__(self, body: Body, restitutions: Mapping[str, Any]) -> None:
        self._rules = {name: CALIBRATED if isinstance(each, Mapping) else each for name, each in restitutions.items()}
        real, same = ({name: self._pair(each, one) for name, each in given.items()}
                      for given, one in ((restitutions, body), (self._rules, changed(body))))  # fmt: skip
        self._moved = {name: {foot: real[name][foot] - same[name][foot] for foot in FEET} for name in real}

    def of(self, body: Body) -> list[dict[str, float]]:
        """Return the coefficients of a changed body, each at most as large as energy allows."""
        most = {foot: energy_bound(body, foot) for foot in FEET}
        return [
            {foot: min(max(pair[foot] + self._moved[name][foot], 0.0), most[foot]) for foot in FEET}
            for name, pair in ((name, self._pair(rule, body)) for name, rule in self._rules.items())
        ]

    @staticmethod
    def _pair(restitution: Any, body: Body) -> Mapping[Foot, float]:
        """Return the coefficients; where the model says none, the largest that energy allows."""
        try:
            return coefficients_of(restitution, body)[0]
        except InvalidValueError:
            return {foot: energy_bound(body, foot) for foot in FEET}


def _least(
    body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings,
    *, name: str, most: float,
) -> float:  # fmt: skip
    """Return the least change from which on all that are tried stand, up to the one that keeps it from lifting [m].

    It is a whole number of millimetres, as it is said, and that changed body has a margin above what is asked for.
    """
    if not np.isfinite(most):
        raise GeometryError("the vertical motion takes all of its weight: nothing but anchors holds it down")

    def falls(lengths: Sequence[float]) -> BoolArray:
        return overturns([changed(body, **{name: each}) for each in lengths], motions, margin, gravity, landings)

    grid = np.linspace(0.0, most, STEPS + 1)
    down = np.flatnonzero(falls(grid[:-1].tolist()))
    last = int(down[-1]) if down.size else 0
    low, high = float(grid[last]), float(grid[last + 1])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if falls([middle])[0] else (low, middle)
    for length in (high, *grid[last + 1 : -1].tolist()):
        whole = millimetres(length) / 1e3
        if holds(changed(body, **{name: whole}), motions, margin, gravity, landings):
            return whole
    return millimetres(most) / 1e3


def holds(body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings) -> bool:
    """Return whether the least factor that overturns a changed body is above the margin, with every restitution."""
    kept = MotionList(motions)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PlausibilityWarning)
        for pair in landings.of(body):
            found = Margins.of(body, kept, pair, "pga", None, {"gravity": gravity})
            if not (found.least_each > margin).all() or (margin >= 1.0 and (found.fell_each != 0.0).any()):
                return False
    return True


def overturns(
    bodies: Sequence[Body], motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings
) -> BoolArray:
    """Return which bodies overturn under any motion up to a factor, with any restitution, either way round."""
    rows, owner = [], []
    with warnings.catch_warnings():  # a body that is tried may be as wide as high: nobody typed its coefficients
        warnings.simplefilter("ignore", PlausibilityWarning)
        for k, body in enumerate(bodies):
            for pair in landings.of(body):
                for one, _, own in ways_round(body, motions, pair):
                    rows.append(RockingParameters.of_body(one, own, gravity))
                    owner.append(k)
    sides = {name: values[:, None] for name, values in sides_of(rows).items()}
    histories = Product(MotionList(motions), sides, margin * SHARES, settings=PlaneSettings(gravity=gravity))
    fell = overturned(results_of(histories)["outcome"]).reshape(len(motions), len(rows), SHARES.size) == 1.0
    found = np.zeros(len(bodies), bool)
    np.logical_or.at(found, np.array(owner), fell.any(axis=(0, 2)))
    return found
