"""Margins of bodies to overturning, and retrofit measures: anchors, wider base, lower centre of mass, isolators."""

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

POINTS, REACH, MARGIN_BISECTIONS = 64, 50.0, 6
"""Search of the smallest overturning factor: number of levels, highest level / uplift, number of bisections."""


@dataclass(frozen=True, eq=False)
class Margins:
    """Histories of one body under all motions, for both polarities if the polarities differ."""

    min_factors_by_polarity: FloatArray  # smallest overturning factor, by polarity and motion [-]
    overturned_by_polarity: FloatArray  # 1 if overturned, NaN without a result, by polarity, motion and level
    factors: FloatArray  # scale factors, by motion and level [-]
    label: str  # label of the restitution

    @classmethod
    def of(
        cls, body: Body, motions: MotionList, restitution: Any, measure: Any, levels: FloatArray | None,
        options: dict[str, Any],
    ) -> "Margins":  # fmt: skip
        """Return the margins of a body at levels of the measure, or under the motions as recorded."""
        ground = {name: value for name, value in options.items() if name not in {"threads", "progress"}}
        subjects = [Subject.of(*case, measure, ground) for case in polarities(body, motions, restitution)]
        intensities = subjects[0].intensities
        factors = np.ones((len(motions), 1)) if levels is None else measure.factors(intensities, levels)

        def overturned(subject: Subject, histories: Histories, shape: tuple[int, ...]) -> FloatArray:
            arrays = results_of(histories, threads=options.get("threads"), progress=options.get("progress"))
            return Responses.of(arrays, subject.parameters, shape).overturned

        fallen = [overturned(subject, subject.product(factors), factors.shape) for subject in subjects]
        min_factors = [_min_factor(subject, overturned) for subject in subjects]
        return cls(np.array(min_factors), np.array(fallen), factors, subjects[0].parameters.label)

    @property
    def min_factors(self) -> FloatArray:
        """Smallest overturning factor of each motion; infinite if none overturns, NaN without a result [-]."""
        return np.asarray(np.minimum.reduce(self.min_factors_by_polarity))

    @property
    def overturned(self) -> FloatArray:
        """1 with overturning in at least one polarity, by motion and level; NaN without a result."""
        return np.asarray(np.maximum.reduce(self.overturned_by_polarity))


def polarities(body: Body, motions: Any, restitution: Any) -> list[tuple[Body, Any, Any]]:
    """Return a body with its motions and restitution, and also the mirrored body if it differs."""
    swapped, differ = restitution, not body.is_symmetric
    if isinstance(restitution, Mapping) and {"left", "right"} <= set(restitution):
        swapped = {"left": restitution["right"], "right": restitution["left"]}
        differ |= restitution["left"] != restitution["right"]
    if not differ:
        return [(body, motions, restitution)]
    return [(body, motions, restitution), (body.mirrored(), motions, swapped)]


def _min_factor(
    subject: Subject, overturned: Callable[[Subject, Histories, tuple[int, ...]], FloatArray]
) -> FloatArray:
    """Return the smallest overturning factor of each motion; infinite if none, NaN without a result."""
    peaks, uplift = measure_of("pga").values(subject.motions, subject.scale), subject.scale.threshold
    lowest = uplift if subject.are_horizontal else 0.1 * uplift
    grid = np.geomspace(lowest, highest_acceleration(uplift), POINTS) / peaks[:, None]
    return find_min_factors(
        grid, lambda rows, factors: overturned(subject, subject.table(rows, factors), factors.shape), POINTS
    )


def highest_acceleration(uplift: float, reach: float = REACH) -> float:
    """Return the highest acceleration of the search from the acceleration of uplift [m/s2]."""
    return min(reach * uplift, max(plausibility.LARGEST_PGA, 4.0 * uplift))


def find_min_factors(
    grid: FloatArray, overturned: Callable[[IntArray, FloatArray], FloatArray], batch: int
) -> FloatArray:
    """Return the smallest overturning factor of each row; infinite if none, NaN without a result.

    `grid` contains increasing factors of each row. `overturned` is a function of row indices and factors. `batch` is
    the number of factors that are computed together for the rows without overturning.
    """
    count, points = grid.shape
    fallen = np.zeros(grid.shape)
    for begin in range(0, points, batch):
        columns = slice(begin, begin + batch)
        upright = np.flatnonzero(~(fallen == 1.0).any(axis=1))
        if upright.size:
            factors = grid[upright, columns]
            indices = np.repeat(upright, factors.shape[1])
            fallen[upright, columns] = overturned(indices, factors.ravel()).reshape(factors.shape)
    first = np.argmax(fallen == 1.0, axis=1)
    rows = np.arange(count)
    min_factors = np.where(fallen[rows, first] == 1.0, grid[rows, first], np.inf)
    low, high = grid[rows, np.maximum(first - 1, 0)], min_factors
    bracketed = np.flatnonzero(np.isfinite(min_factors) & (first > 0))
    for _ in range(MARGIN_BISECTIONS if bracketed.size else 0):
        middle = np.sqrt(low[bracketed] * high[bracketed])
        falls = overturned(bracketed, middle) == 1.0
        high[bracketed] = np.where(falls, middle, high[bracketed])
        low[bracketed] = np.where(falls, low[bracketed], middle)
    high[bracketed] = np.sqrt(low[bracketed] * high[bracketed])
    before = np.where(np.isfinite(min_factors), first, points)[:, None] > np.arange(points)
    return np.where((np.isnan(fallen) & before).any(axis=1), np.nan, high)


CALIBRATED = "calibrated"

STEPS, BISECTIONS = 32, 5
"""Number of tested changes up to the change without uplift, and number of bisections."""

FACTOR_RATIOS = np.array([0.6, 0.7, 0.8, 0.9, 1.0])
"""Fractions of the factor for a first check of each change, before the margin of the result is computed."""

PERIODS, DAMPING = np.round(np.geomspace(0.5, 6.0, 40), 2), 0.1
"""Candidate isolators: periods with three digits [s], and damping ratio [-]."""

ASSUMED = (
    "Anchors: body, anchors and floor are rigid, without uplift and amplification. The anchors of one edge pull "
    "vertically, with the other edge as the pivot. Shear without friction. No safety factor.",
    "Wider base, lower centre of mass: mass and moment of inertia about the centre of mass do not change. A wider base "
    "extends equally on both sides.",
    f"Isolators: linear, {100 * DAMPING:g} % of critical damping, horizontal only, with a rigid body. Vertical motion "
    "is transmitted; its largest downward acceleration is used throughout.",
)
"""Assumptions of the measures."""


def millimetres(length: float) -> int:
    """Return a required length in whole millimetres, rounded up."""
    return math.ceil(1e3 * length - 1e-9)


def rounded_up(value: float) -> float:
    """Return a required value with three digits, rounded up.

    >>> rounded_up(2588.96), rounded_up(0.062), rounded_up(0.0)
    (2590.0, 0.062, 0.0)
    """
    digits = 2 - math.floor(math.log10(value)) if value > 0.0 else 0
    return round(math.ceil(value * 10.0**digits - 1e-9) / 10.0**digits, max(digits, 0))


@dataclass(frozen=True)
class LengthChange:
    """Required change of a length."""

    # smallest change above which no computed history overturns, in whole millimetres; 0 if no change is needed [m]
    length_no_overturning: float
    length_no_uplift: float  # change without uplift, in closed form [m]
    reason: str = ""  # reason of a missing search; empty after a search


@dataclass(frozen=True)
class Remedies:
    """Measures that prevent overturning under scaled motions."""

    margin: float  # scale factor of the motions [-]
    # total force of the anchors along the left and the right edge; 0 without uplift [N]
    tension: dict[str, float]
    shear: float  # horizontal force on all anchors [N]
    # wider: extension of the base on each side; lower: lowering of the centre of mass
    wider: LengthChange
    lower: LengthChange
    # smallest isolator period above which no uplift occurs [s], and the isolator displacement [m]; None if uplift
    # occurs at all periods up to 6 s
    isolation: tuple[float, float] | None

    def answer(self) -> Answer:
        """Return forces of anchors, changes of lengths, and isolation."""
        period, displacement = (None, None) if self.isolation is None else self.isolation
        lengths = {
            name: {
                "no_overturning": change.length_no_overturning,
                "no_uplift": change.length_no_uplift,
                "reason": change.reason,
            }
            for name, change in (("wider", self.wider), ("lower", self.lower))
        }
        return Answer({
            "margin": self.margin, "tension": self.tension, "shear": self.shear, **lengths,
            "isolation_period": period, "isolation_displacement": displacement,
        })  # fmt: skip

    @property
    def needed(self) -> bool:
        """True if uplift occurs."""
        return any(force > 0.0 for force in self.tension.values())


def accelerations_of(motion: GroundMotion) -> tuple[FloatArray, FloatArray]:
    """Return the absolute horizontal acceleration, which covers both polarities, and the upward acceleration."""
    across = np.abs(motion.acceleration)
    return across, np.zeros_like(across) if motion.vertical is None else np.asarray(motion.vertical)


def lifting_factor(body: Body, motion: GroundMotion, gravity: float) -> float:
    """Return the scale factor of uplift of a body under a motion, both polarities [-]."""
    across, up = accelerations_of(motion)
    sides = [body.side(foot, gravity) for foot in FEET]
    factors = [
        s.half_width * gravity / max((across * s.centre_height - up * s.half_width).max(), 1e-300) for s in sides
    ]
    return float(min(factors))  # Eq. 312


def tension(body: Body, motion: GroundMotion, factor: float, gravity: float) -> dict[str, float]:
    """Return the required force of the anchors along each edge, with the other edge as pivot [N]."""
    across, up = accelerations_of(motion)
    base = body.feet[1] - body.feet[0]
    forces = {}
    for edge, pivot in zip(FEET, FEET[::-1], strict=True):
        side = body.side(pivot, gravity)
        moment = factor * across * side.centre_height - (gravity + factor * up) * side.half_width
        forces[edge] = max(0.0, body.mass * float(moment.max()) / base)  # Eq. 313
    return {str(edge): force for edge, force in forces.items()}


def lengths_without_uplift(
    body: Body, motions: Sequence[GroundMotion], factor: float, gravity: float
) -> tuple[float, float]:
    """Return extension of each side and lowering of the centre of mass that prevent uplift [m]; infinite: none."""
    sides = [body.side(foot, gravity) for foot in FEET]
    narrow, height = min(side.half_width for side in sides), sides[0].centre_height
    ratio = 0.0
    for motion in motions:
        across, up = accelerations_of(motion)
        weight = gravity + factor * up
        if (weight <= 0.0).any():
            return np.inf, np.inf
        ratio = max(ratio, float((factor * across / weight).max()))
    return max(0.0, ratio * height - narrow), max(0.0, height - narrow / ratio if ratio else 0.0)  # Eq. 314


def remedies(
    body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float,
    restitutions: Mapping[str, Any], *, falls: bool,
) -> Remedies:  # fmt: skip
    """Return the measures for restitutions by name; `falls` is True if a motion times the margin overturns the body."""
    tensions = [tension(body, motion, margin, gravity) for motion in motions]
    out, down = lengths_without_uplift(body, motions, margin, gravity)
    shear = margin * body.mass * max(float(accelerations_of(motion)[0].max()) for motion in motions)
    changes = {}
    for name, no_uplift in (("out", out), ("down", down)):
        try:
            with warnings.catch_warnings():  # warnings about trial bodies are not for the user
                warnings.simplefilter("ignore", PlausibilityWarning)
                landings = Landings(body, restitutions) if falls else None
                length = (
                    _min_length(body, motions, margin, gravity, landings, name=name, no_uplift=no_uplift)
                    if landings
                    else 0.0
                )
            changes[name] = LengthChange(length, no_uplift)
        except GeometryError as error:
            changes[name] = LengthChange(np.nan, no_uplift, str(error))
    forces = {str(edge): max(pair[edge] for pair in tensions) for edge in FEET}
    has_uplift = any(force > 0.0 for force in forces.values())
    isolated = isolation(body, motions, margin, gravity) if has_uplift else None
    return Remedies(margin, forces, shear, changes["out"], changes["down"], isolated)


def isolation(body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float) -> tuple[float, float] | None:
    """Return the smallest period above which isolators prevent uplift [s], and their displacement [m]."""
    slope = min(body.side(foot, gravity).half_width / body.side(foot, gravity).centre_height for foot in FEET)
    good, displacement = np.ones(PERIODS.size, bool), np.zeros(PERIODS.size)
    for motion in motions:
        lightest = gravity + margin * min(float(accelerations_of(motion)[1].min()), 0.0)
        spectrum = response_spectrum(motion, PERIODS, DAMPING)
        good &= margin * spectrum.absolute_acceleration <= slope * lightest
        displacement = np.maximum(displacement, margin * spectrum.displacement)
    first = int(np.flatnonzero(~good)[-1]) + 1 if not good.all() else 0
    return (float(PERIODS[first]), float(displacement[first])) if first < PERIODS.size else None


def changed(body: Body, ballast: bool = False, /, *, out: float = 0.0, down: float = 0.0) -> Block:
    """Return a block of equal mass and inertia with feet further outside and a lower centre of mass [m].

    With ballast, a mass on the ground lowers the centre of mass; its mass and inertia are added.
    """
    left, right = body.feet
    width, x, y = right - left + 2.0 * out, body.centre[0] - left + out, body.centre[1] - body.ground - down
    if not y > 0.0:
        raise GeometryError("the centre of mass would lie {depth:.0f} mm below the ground", depth=-1000.0 * y)
    mass, inertia = body.mass, body.moment_of_inertia
    if ballast:
        mass, inertia = mass * (y + down) / y, inertia + mass * down * (y + down)
    gyration = inertia / mass - x * (width - x)  # from the vertical distribution of the mass
    height = max(body.local_box[3], y + 1.01 * max(gyration, y**2) / y)
    return Block(width=width, height=height, depth=1.0, mass=mass, centre=(x, y), moment_of_inertia=inertia)


class Landings:
    """Coefficients of a changed body: coefficients of the body plus the change of the coefficients of the model.

    The changed body is a block with a different mass distribution. Without a change, the coefficients are equal.
    """

    def __init__(self, body: Body, restitutions: Mapping[str, Any]) -> None:
        self._rules = {name: CALIBRATED if isinstance(rule, Mapping) else rule for name, rule in restitutions.items()}
        unchanged = changed(body)
        actual = {name: self._pair(restitution, body) for name, restitution in restitutions.items()}
        modelled = {name: self._pair(rule, unchanged) for name, rule in self._rules.items()}
        self._shifts = {name: {foot: actual[name][foot] - modelled[name][foot] for foot in FEET} for name in actual}

    def of(self, body: Body) -> list[dict[str, float]]:
        """Return the coefficients of a changed body, limited by the energy."""
        bounds = {foot: energy_bound(body, foot) for foot in FEET}
        return [
            {foot: min(max(pair[foot] + self._shifts[name][foot], 0.0), bounds[foot]) for foot in FEET}
            for name, pair in ((name, self._pair(rule, body)) for name, rule in self._rules.items())
        ]

    @staticmethod
    def _pair(restitution: Any, body: Body) -> Mapping[Foot, float]:
        """Return the coefficients of a model, or the energy bounds if the model gives no coefficients."""
        try:
            return coefficients_of(restitution, body)[0]
        except InvalidValueError:
            return {foot: energy_bound(body, foot) for foot in FEET}


def _min_length(
    body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings,
    *, name: str, no_uplift: float,
) -> float:  # fmt: skip
    """Return the smallest change above which no computed body overturns, up to the change without uplift [m].

    The change is a whole number of millimetres. The margin of the changed body is above the required margin.
    """
    if not np.isfinite(no_uplift):
        raise GeometryError("the vertical motion exceeds gravity: only anchors prevent uplift")

    def falls(lengths: Sequence[float]) -> BoolArray:
        return overturns([changed(body, **{name: length}) for length in lengths], motions, margin, gravity, landings)

    grid = np.linspace(0.0, no_uplift, STEPS + 1)
    down = np.flatnonzero(falls(grid[:-1].tolist()))
    last = int(down[-1]) if down.size else 0
    low, high = float(grid[last]), float(grid[last + 1])
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if falls([middle])[0] else (low, middle)
    for length in (high, *grid[last + 1 : -1].tolist()):
        rounded = millimetres(length) / 1e3
        if holds(changed(body, **{name: rounded}), motions, margin, gravity, landings):
            return rounded
    return millimetres(no_uplift) / 1e3


def holds(body: Body, motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings) -> bool:
    """Return True if the smallest overturning factor of a changed body exceeds the margin with every restitution."""
    motion_list = MotionList(motions)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PlausibilityWarning)
        for pair in landings.of(body):
            margins = Margins.of(body, motion_list, pair, "pga", None, {"gravity": gravity})
            if not (margins.min_factors_by_polarity > margin).all():
                return False
            if margin >= 1.0 and (margins.overturned_by_polarity != 0.0).any():
                return False
    return True


def overturns(
    bodies: Sequence[Body], motions: Sequence[GroundMotion], margin: float, gravity: float, landings: Landings
) -> BoolArray:
    """Return True for bodies that overturn under any motion up to a factor, any restitution and polarity."""
    rows, owner = [], []
    with warnings.catch_warnings():  # warnings about trial bodies, which may be wide, are not for the user
        warnings.simplefilter("ignore", PlausibilityWarning)
        for k, body in enumerate(bodies):
            for pair in landings.of(body):
                for variant, _, coefficients in polarities(body, motions, pair):
                    rows.append(RockingParameters.of_body(variant, coefficients, gravity))
                    owner.append(k)
    sides = {name: values[:, None] for name, values in sides_of(rows).items()}
    histories = Product(MotionList(motions), sides, margin * FACTOR_RATIOS, settings=PlaneSettings(gravity=gravity))
    fallen = overturned(results_of(histories)["outcome"]).reshape(len(motions), len(rows), FACTOR_RATIOS.size) == 1.0
    has_overturned = np.zeros(len(bodies), bool)
    np.logical_or.at(has_overturned, np.array(owner), fallen.any(axis=(0, 2)))
    return has_overturned
