"""Parameter studies of a contact bed, with the resulting coefficients of restitution."""

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Block, Body
from rocking.conventions import FloatArray, Foot
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.errors import InvalidValueError, extra
from rocking.quantities import Quantity
from rocking.restitution import Ked
from rocking.restitution.bed import (
    BaseFriction,
    ContactBed,
    Coulomb,
    KelvinVoigt,
    Sticking,
    bed_impacts,
    fast,
    setup_of,
)
from rocking.restitution.bed.scaled import ScaledImpact, resolved_coefficients
from rocking.restitution.bed.setup import Setup
from rocking.restitution.bed_table import HARDNESS, POINTS, STEP, BedTable, nodes
from rocking.restitution.contact_bed import ContactBedModel
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Laboratory:
    """A homogeneous block on a bed of Kelvin-Voigt points, from which studies start."""

    slenderness: float = 2.0  # h/b [-]
    width: float = 0.2  # width of the base [m]
    density: float = 2400.0  # density of the block [kg/m3]
    points: int = 41  # number of contact points
    # sqrt(k / m) / (2 pi) of the bed [Hz]; not used with `modulus_over_thickness`
    frequency: float = 400.0
    damping: float = 1.0  # damping ratio zeta of the whole bed [-]
    # elastic modulus of the layer divided by its thickness, per metre of depth of the block [Pa/m]
    modulus_over_thickness: float | None = None
    release: float = 0.5  # initial rotation / slenderness angle [-]
    friction: BaseFriction = field(default_factory=Sticking)  # by default, the base cannot slide
    profile: tuple[float, ...] = ()  # heights of the points above the base line [m]; empty for a flat base
    tolerance: float = 1e-9  # relative error of a step [-]

    def __post_init__(self) -> None:
        checks.within("release", self.release, 0.0, 1.0, open_low=True, open_high=True)
        checks.positive("frequency", self.frequency, "Hz")
        if self.modulus_over_thickness is not None:
            checks.positive("modulus over thickness", self.modulus_over_thickness, "Pa/m")
        if self.profile and len(self.profile) != self.points:
            raise InvalidValueError(
                "{parameter} must have {points} heights, one per point, got {count}", parameter="profile",
                points=self.points, count=len(self.profile),
            )  # fmt: skip

    def but(self, **changes: Any) -> "Laboratory":
        """Return a copy of the laboratory with changed fields."""
        return replace(self, **changes)

    @property
    def layered(self) -> "Laboratory":
        """The laboratory on a layer, by default with 1 GPa/m."""
        return self if self.modulus_over_thickness is not None else self.but(modulus_over_thickness=1e9)

    @property
    def block(self) -> Block:
        return Block(width=self.width, height=self.slenderness * self.width, density=self.density)

    @property
    def stiffness(self) -> float:
        """Stiffness of the bed: E A / t for a layer, m (2 pi f)^2 otherwise [N/m]."""
        if self.modulus_over_thickness is not None:
            return self.modulus_over_thickness * self.width  # Eq. 115
        return self.block.mass * (2.0 * math.pi * self.frequency) ** 2

    @property
    def setup(self) -> Setup:
        """The impact, ready to be computed."""
        block = self.block
        law = KelvinVoigt(self.stiffness, damping_ratio=self.damping)
        bed = ContactBed.uniform(block, self.points, law, friction=self.friction)
        if self.profile:
            bed = bed.with_profile(np.array(self.profile))
        angle = self.release * math.atan(1.0 / self.slenderness)
        return setup_of(block, bed, rotation=angle, tolerance=self.tolerance)


def hardness_of(setup: Setup) -> float:
    """Return the dimensionless landing speed of the new foot, v sqrt(k / m) / g."""
    return setup.speed * math.sqrt(setup.law.stiffness / setup.rigid.mass) / setup.rigid.gravity  # Eq. 130


def coefficients(laboratories: Iterable[Laboratory], *, threads: int = 1) -> FloatArray:
    """Return the coefficients of restitution of laboratories; NaN for failed impacts."""
    return bed_impacts([laboratory.setup for laboratory in laboratories], threads=threads).coefficient


Shape = Literal["convex", "concave", "tilted", "random"]
SHAPES: tuple[Shape, ...] = ("convex", "concave", "tilted", "random")


def profile(shape: Shape, amplitude: float, points: int, *, seed: int = 0) -> tuple[float, ...]:
    """Return heights of contact points above the base line [m], within an amplitude.

    The shape is a convex or concave parabola, a slope with the new foot up, or independent uniform heights from the
    seed.

    >>> profile("concave", 0.001, 3)
    (0.0, 0.001, 0.0)
    """
    amplitude = checks.within("amplitude", amplitude, 0.0, 10.0, unit="m")
    count, start = checked_integer("points", points, 2), checked_integer("seed", seed, 0)
    s = np.linspace(-1.0, 1.0, count)
    match checks.one_of("shape", shape, SHAPES):
        case "concave":
            heights = amplitude * (1.0 - s**2)
        case "convex":
            heights = amplitude * s**2
        case "tilted":
            heights = 0.5 * amplitude * (1.0 + s)
        case _:  # random
            heights = np.random.default_rng(start).uniform(0.0, amplitude, count)
    return tuple(heights.tolist())


def checked_integer(name: str, value: Any, minimum: int) -> int:
    """Return an integer. Raise an error if it is below the minimum.

    >>> checked_integer("points", 41.0, 2)
    41
    """
    result = checks.number(name, value)
    if result != int(result) or result < minimum:
        raise InvalidValueError(
            parameter=name, allowed=f"a whole number of at least {minimum}", value=result,
            hint="Other numbers are not rounded.",
        )  # fmt: skip
    return int(result)


# parameters of studies, with unit and function that sets a value
STUDIES: dict[str, tuple[str, Callable[..., Laboratory]]] = {
    "slenderness": ("1", lambda lab, x: lab.but(slenderness=x)),
    "points": ("1", lambda lab, x: lab.but(points=checked_integer("points", x, 2))),
    "damping": ("1", lambda lab, x: lab.but(damping=x)),
    "modulus_over_thickness": ("Pa/m", lambda lab, x: lab.but(modulus_over_thickness=x)),
    "friction": ("1", lambda lab, x: lab.but(friction=Coulomb(x))),
    "release": ("1", lambda lab, x: lab.but(release=x)),  # determines the landing velocity
    "density": ("kg/m3", lambda lab, x: lab.but(density=x)),  # on one layer, changes only the mass at constant size
    "width": ("m", lambda lab, x: lab.but(width=x)),  # blocks of equal shape and density on one layer
    "amplitude": ("m", lambda lab, x, shape, seed=0: lab.but(profile=profile(shape, x, lab.points, seed=seed))),
    "seed": ("1", lambda lab, x, amplitude: lab.but(profile=profile("random", amplitude, lab.points, seed=x))),
}
_ON_A_LAYER = {"density", "width"}

# long names of results; other results need no long name
_WORDS = {
    "coefficient": "theta_dot after over theta_dot before, by the next peak",
    "coefficient_by_energy": "ratio of velocities by the energy at the end, including hops",
    "hardness": "landing speed of the new foot times sqrt(k / m) over gravity",
    "landing_velocity": "theta_dot of rigid rocking at the landing",
    "peak_force": "largest force of the bed",
    "bed_loss": "energy lost in compression",
    "friction_loss": "energy lost in friction",
    "contacts": "number of contacts: hops plus one",
    "audit": "energy at the end plus losses minus energy at the start, over the energy before the impact",
}


def study(
    varied: str, values: Any, laboratory: Laboratory | None = None, *, threads: int = 1, **options: Any
) -> "xr.Dataset":
    """Return the results for one varied parameter of `STUDIES`. Failed impacts are NaN.

    Options of ``"amplitude"`` are ``shape`` of uneven bases and, for random shapes, ``seed``. The option of ``"seed"``
    is ``amplitude`` of random bases. Other studies have no options.

    >>> study("slenderness", [2.0, 4.0]).coefficient.round(2).values.tolist()
    [0.84, 0.96]
    """
    extra("xarray", "the impact laboratory")
    unit, change = STUDIES[checks.one_of("varied", varied, tuple(STUDIES))]
    _check_options(varied, options)
    row = np.atleast_1d(checks.real_array(varied, values))
    if row.ndim != 1 or row.size == 0 or not bool(np.isfinite(row).all()):
        raise InvalidValueError(
            "{parameter} must be a row of finite numbers [{unit}], got shape {shape}", parameter=varied, unit=unit,
            shape=row.shape,
        )  # fmt: skip
    start = laboratory or Laboratory()
    if varied in _ON_A_LAYER:
        start = start.layered
    setups = [change(start, value, **options).setup for value in row.tolist()]
    impacts = bed_impacts(setups, threads=threads)
    results = {
        "coefficient": ("1", impacts.coefficient),
        "coefficient_by_energy": ("1", np.array([impact.by_energy for impact in impacts.emergent])),
        "hardness": ("1", np.array([hardness_of(setup) for setup in setups])),
        "landing_velocity": ("rad/s", np.array([setup.landing_velocity for setup in setups])),
        "peak_force": ("N", impacts.results["peak_force"]),
        "bed_loss": ("J", impacts.results["bed_loss"]),
        "friction_loss": ("J", impacts.results["friction_loss"]),
        "contacts": ("1", impacts.results["contacts"].astype(np.float64)),
        "audit": ("1", impacts.audit),
    }
    return _labelled(varied, row, results, start)


def _check_options(varied: str, options: Mapping[str, Any]) -> None:
    """Raise an error for unknown options of a study, and for missing required options."""
    _, _, *parameters = inspect.signature(STUDIES[varied][1]).parameters.values()
    names = [option.name for option in parameters]
    for name in options:
        if name not in names:
            raise InvalidValueError(
                "the study of {study} has {options}, got {option}", study=varied, option=name,
                options=f"the options {', '.join(names)}" if names else "no options",
            )  # fmt: skip
    for option in parameters:
        if option.default is option.empty and option.name not in options:
            raise InvalidValueError("the study of {study} needs {option}", study=varied, option=option.name)


def _labelled(
    varied: str, row: FloatArray, results: Mapping[str, tuple[str, FloatArray]], start: Laboratory
) -> "xr.Dataset":
    """Return results over the varied parameter, with the inputs as attributes."""
    about = {name: Quantity(name, unit, _WORDS.get(name, "")).attributes for name, (unit, _) in results.items()}
    labelled: xr.Dataset = extra("xarray", "the impact laboratory").Dataset(
        {name: (varied, values, about[name]) for name, (_, values) in results.items()},
        coords={varied: (varied, row, Quantity(varied, STUDIES[varied][0], "").attributes)},
        attrs={
            "software": SOFTWARE,
            "engine": "contact bed, fast" if fast.available() else "contact bed, reference",
            "study": varied,
            "laboratory": repr(start),
        },
    )
    return labelled


def large_bodies(widths: Any, *, hollow: float = 1e-4, laboratory: Laboratory | None = None) -> dict[str, FloatArray]:
    """Return r of blocks of equal shape by width [m], on a flat base, on a hollow base, and by KED."""
    # on a flat base on one layer, neither r nor KED depends on the size (`study` of the width); a constant length
    # causes a size effect, here a hollow of fixed height [m] under the base
    start = (laboratory or Laboratory()).layered
    row = np.atleast_1d(checks.positive_array("width", widths, "m"))
    beds = {"flat": start.but(profile=()), "hollow": start.but(profile=profile("concave", hollow, start.points))}
    results = {name: coefficients(bed.but(width=w) for w in row.tolist()) for name, bed in beds.items()}
    return {**results, "ked": np.full(row.shape, Ked().coefficient(start.block))}


@dataclass(frozen=True, eq=False)
class Convergence:
    """A sequence of coefficients with orders of convergence."""

    at: FloatArray  # numbers of contact intervals, or tolerances [-]
    coefficient: FloatArray  # coefficients of restitution [-]
    error: FloatArray  # distance from the limit [-]
    order: FloatArray  # order of convergence between neighbouring values [-]
    limit: float  # limit of r [-], extrapolated or from the finest step


def points_convergence(
    counts: Sequence[int] = (11, 21, 41, 81, 161), *, slenderness: float = 2.0, limit: float | None = None
) -> Convergence:
    """Return the convergence of the viscous bed with its points. Every count doubles the number of intervals."""
    # Dashpots without springs absorb an impact in one contact, so that no hop disturbs the order, which is near 2 for
    # half weights at the ends. The limit is the exact r. By default, it is extrapolated from the last two values with
    # order 2.
    intervals = np.array(counts, dtype=np.float64) - 1.0
    if intervals.size < 3 or not bool((intervals[1:] == 2.0 * intervals[:-1]).all()):
        raise InvalidValueError(
            "{parameter} must be three or more numbers of points that double the number of intervals, such as 11, "
            "21, 41; got {counts}",
            parameter="counts",
            counts=counts,
        )  # fmt: skip
    block = Laboratory(slenderness=slenderness).block
    law = KelvinVoigt(0.0, damping=1e12 * block.mass)
    r = bed_impacts(
        [setup_of(block, ContactBed.uniform(block, n, law), angular_velocity=0.5, impulsive=True) for n in counts]
    ).coefficient
    end = float(r[-1] + (r[-1] - r[-2]) / 3.0) if limit is None else checks.number("limit", limit)
    return _converged(intervals, r, end, np.full(intervals.size - 1, 2.0))


def step_convergence(tolerances: Any = (1e-4, 1e-5, 1e-6, 1e-7), laboratory: Laboratory | None = None) -> Convergence:
    """Return the convergence of r with decreasing step tolerances, relative to 1e-12.

    The order is a power of the tolerance.
    """
    row = np.atleast_1d(checks.positive_array("tolerances", tolerances))
    start = laboratory or Laboratory()
    r = coefficients(start.but(tolerance=float(tolerance)) for tolerance in (*row, 1e-12))
    return _converged(row, r[:-1], float(r[-1]), row[:-1] / row[1:])


def _converged(at: FloatArray, r: FloatArray, limit: float, ratio: FloatArray) -> Convergence:
    error = np.abs(r - limit)
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log(error[:-1] / error[1:]) / np.log(ratio)  # Eq. 132
    return Convergence(at, r, error, order, limit)


def bed_speed_law(
    body: Body,
    frequency: float,
    *,
    points: int = 41,
    damping: float = 1.0,
    foot: Foot = "right",
    gravity: float = conventions.g,
) -> SpeedRestitution:
    """Return a law r(speed) for `simulate`, for a body on a bed of given frequency sqrt(k / m) / (2 pi) [Hz].

    The hardness is v sqrt(k/m) / g with v = 2 w theta_dot. Beyond the table, r is constant.

    >>> from rocking import Block
    >>> law = bed_speed_law(Block(width=0.2, height=0.4), 400.0)
    >>> round(law.factor(2.0, 0, 0), 2), law.factor(0.5, 0, 0) > law.factor(4.0, 0, 0)
    (0.85, True)
    """
    rate = 2.0 * np.pi * checks.positive("frequency", frequency, "Hz") / checks.positive("gravity", gravity, "m/s2")
    left, right = body.local_feet
    hardness = np.geomspace(*HARDNESS, 41)
    hardness[[0, -1]] = HARDNESS
    r = [ContactBedModel(points, damping, value).coefficient(body, foot) for value in hardness.tolist()]
    return SpeedRestitution(hardness / (rate * (right - left)), np.minimum(r, 1.0))


def impulse_position(coefficient: FloatArray, flatness: FloatArray, offset: FloatArray) -> FloatArray:
    """Return the impulse position of a coefficient [-], from angular momentum about this position."""
    gyration = 1.0 / flatness - 1.0
    arm = gyration * (1.0 - coefficient) / (1.0 + offset + coefficient * (1.0 - offset))  # Eq. 4
    return np.asarray(arm + offset)


def resolved(cases: FloatArray, points: int, *, threads: int = 1) -> FloatArray:
    """Return coefficients of cases (flatness, offset, damping, hardness) by the next peak, from time integration."""
    impacts = [
        ScaledImpact(flatness, offset, points, damping, hardness)
        for flatness, offset, damping, hardness in cases.tolist()
    ]
    return resolved_coefficients(impacts, threads=threads)


def tabulated(*, threads: int = 1, progress: Callable[[int], None] | None = None) -> BedTable:
    """Compute the table of the model `contact-bed`. This takes minutes."""
    axes = nodes()
    shape = tuple(axis.size for axis in axes)
    cases = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    planes = []
    for points in POINTS:
        r = []
        for piece in np.array_split(cases, 40):
            r.append(resolved(piece, points, threads=threads))
            if progress is not None:
                progress(len(piece))
        planes.append(impulse_position(np.concatenate(r), cases[:, 0], cases[:, 1]).reshape(shape))
    return BedTable(*axes, np.array(planes))


def stored(table: BedTable) -> np.ndarray[tuple[int, ...], np.dtype[np.int16]]:
    """Return the stored positions as integer multiples of `bed_table.STEP`."""
    return np.asarray(np.rint(np.clip(table.positions, -3.9, 3.9) / STEP).astype(np.int16))
