"""One impact on a bed, resolved in time."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution.bed import fast, reference
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.emergent import BedStatus, Emergent, emergent_of, status_of
from rocking.restitution.bed.law import LawKind
from rocking.restitution.bed.rigid import RigidRocking
from rocking.restitution.bed.start import start_of
from rocking.restitution.bed.tables import COUNTS, RESULTS, SAMPLES, Setup

BedEngine = Literal["auto", "fast", "reference"]
ENGINES: tuple[BedEngine, ...] = ("auto", "fast", "reference")
MOST_STEPS = 500_000


@dataclass(frozen=True, eq=False)
class BedImpact:
    """An impact with its history.

    Parameters
    ----------
    setup : Setup
        Body, bed, start.
    results, counts : ndarray
        Rows of results, columns `tables.RESULTS` and `tables.COUNTS`.
    samples : ndarray
        History, columns `tables.SAMPLES`.
    forces : ndarray, shape (samples, points)
        Normal force of each point [N].
    intervals : ndarray, shape (contacts, 3)
        Point, begin and end of each contact; the end is infinite for those that last [-, s, s].
    """

    setup: Setup
    results: FloatArray
    counts: IntArray
    samples: FloatArray
    forces: FloatArray
    intervals: FloatArray

    @property
    def time(self) -> FloatArray:
        """Times of the samples [s]."""
        return self.sample("time")

    @cached_property
    def emergent(self) -> Emergent:
        """The coefficient of restitution, by three measures."""
        return emergent_of(self.setup, self.results, self.counts)

    @property
    def coefficient(self) -> float:
        """Ratio theta_dot_after / theta_dot_before, as `emergent` defines it [-]."""
        return self.emergent.coefficient

    @property
    def status(self) -> BedStatus:
        """How the computation ended."""
        return status_of(self.counts)

    @property
    def impulse_position(self) -> FloatArray:
        """Position k(t) of the resultant over the half base, from its middle to the new foot; NaN in flight [-]."""
        ends = self.setup.rigid.bed.ends
        with np.errstate(invalid="ignore", divide="ignore"):
            at = self.sample("moment") / self.sample("normal")
        at[self.sample("normal") <= 0.0] = np.nan
        return np.asarray((at - 0.5 * (ends[0] + ends[1])) / (0.5 * (ends[1] - ends[0])))

    @property
    def mean_impulse_position(self) -> float:
        """Position k of the whole impulse between first touch and parting, the weight's share of it included [-]."""
        ends = self.setup.rigid.bed.ends
        if self.result("impulse") <= 0.0:
            return float("nan")
        at = self.result("impulse_moment") / self.result("impulse")
        return (at - 0.5 * (ends[0] + ends[1])) / (0.5 * (ends[1] - ends[0]))

    @property
    def duration(self) -> float:
        """From the first touch beyond the old foot until only the new foot presses and is arrested [s]."""
        touch, parting = self.result("touch"), self.result("parting")
        return parting - touch if 0.0 <= touch <= parting else float("nan")

    @property
    def contacts(self) -> int:
        """How often the body as a whole came into contact with the bed: hops are one less."""
        return int(self.counts[COUNTS.index("contacts")])

    @property
    def audit(self) -> float:
        """Energy at the end plus losses minus energy at the start, over the energy before the impact [-]."""
        return self.result("residual") / self.setup.start.energy

    def result(self, name: str) -> float:
        """Return one of the results.

        Parameters
        ----------
        name : str
            One of `tables.RESULTS`, "bed_loss" or "friction_loss" [J] for instance.

        Returns
        -------
        float
            Its value in SI.
        """
        return float(self.results[RESULTS.index(name)])

    def sample(self, name: str) -> FloatArray:
        """Return one column of the history.

        Parameters
        ----------
        name : str
            One of `tables.SAMPLES`.

        Returns
        -------
        ndarray
            Its values in SI.
        """
        return np.array(self.samples[:, SAMPLES.index(name)])


def bed_impact(
    body: Body,
    bed: ContactBed,
    *,
    rotation: float | None = None,
    angular_velocity: float | None = None,
    impulsive: bool = False,
    ground_acceleration: tuple[float, float] = (0.0, 0.0),
    tolerance: float = 1e-9,
    engine: BedEngine = "auto",
) -> BedImpact:
    """Let a body rock down onto its bed and resolve the impact in time, until the next peak.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Its contact points, laws and friction.
    rotation : float, optional
        Rotation about the old foot at which it is let go [rad].
    angular_velocity : float, optional
        theta_dot at which it lands, instead [rad/s].
    impulsive : bool
        Leave gravity out, start flat and end when the bed has parted: the limit of a hard bed for laws that absorb
        the impact in one contact.
    ground_acceleration : (float, float)
        Horizontal and vertical acceleration of the ground during the impact [m/s2].
    tolerance : float
        Error of a step relative to the depth and speed of the impact [-].
    engine : {"auto", "fast", "reference"}
        Compiled engine or SciPy.

    Returns
    -------
    BedImpact
        History, losses and coefficient of restitution.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, the law cannot carry the body, or there is no such engine.
    MissingExtraError
        If the fast engine was asked for and not built.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impact
    >>> block = Block(width=0.2, height=0.4)
    >>> law = KelvinVoigt(block.mass * (2 * 3.141592653589793 * 400) ** 2, damping_ratio=1.0)
    >>> impact = bed_impact(block, ContactBed.uniform(block, 2, law), angular_velocity=1.0)
    >>> round(impact.coefficient, 2)
    0.7
    """
    if engine not in ENGINES:
        raise InvalidValueError(f"engine must be one of {', '.join(ENGINES)}, got {engine!r:.40}; a typing error?")
    setup = setup_of(
        body, bed, rotation=rotation, angular_velocity=angular_velocity, impulsive=impulsive,
        ground_acceleration=ground_acceleration, tolerance=tolerance,
    )  # fmt: skip
    if engine == "fast" and not fast.available():
        raise MissingExtraError(
            "the bed's fast engine was not built: it takes a C++17 compiler when rocking is installed"
        )
    if engine == "reference" or not fast.available():
        return BedImpact(setup, *reference.one(setup))
    return BedImpact(setup, *fast.one(setup, MOST_STEPS))


def setup_of(
    body: Body,
    bed: ContactBed,
    *,
    rotation: float | None = None,
    angular_velocity: float | None = None,
    impulsive: bool = False,
    ground_acceleration: tuple[float, float] = (0.0, 0.0),
    tolerance: float = 1e-9,
    gravity: float = conventions.g,
) -> Setup:
    """Return an impact, checked and ready to be computed; parameters as in `bed_impact`.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Its bed.
    rotation, angular_velocity : float, optional
        One of the two [rad], [rad/s].
    impulsive : bool
        Whether gravity is left out.
    ground_acceleration : (float, float)
        Horizontal and vertical [m/s2].
    tolerance : float
        Relative error of a step [-].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    Setup
        The impact.

    Raises
    ------
    InvalidValueError
        If a value is outside its range or the law cannot carry the body.
    """
    given: tuple[object, object] = (body, bed)
    if not (isinstance(given[0], Body) and isinstance(given[1], ContactBed)):
        raise InvalidValueError(f"body and bed must be a Body and a ContactBed, got {body!r:.40} and {bed!r:.40}")
    push, lift = _accelerations(ground_acceleration)
    total = checks.positive("gravity", gravity, "m/s2") + lift
    total = checks.positive("gravity + vertical ground acceleration", total, "m/s2", hint="the body floats")
    tolerance = checks.within("tolerance", tolerance, 1e-13, 1e-3)
    law = bed.law.numbers(body.mass)
    if not impulsive and (law.stiffness == 0.0 or (law.kind is LawKind.PLASTIC and law.rebound == 0.0)):
        raise InvalidValueError(
            "a law without stiffness or without rebound cannot carry the weight; "
            "use impulsive=True, or stiffness and rebound > 0"
        )
    rigid = RigidRocking.of_body(body, bed, total)
    start = start_of(rigid, law, rotation=rotation, angular_velocity=angular_velocity, impulsive=impulsive)
    longest = 30.0 * (rigid.inertia_about(start.old_foot) / (rigid.mass * total * rigid.height)) ** 0.5
    if impulsive:
        longest = min(longest, 1e6 * start.depth / start.speed)
    return Setup(rigid, law, start, push, tolerance, longest)


def _accelerations(given: object) -> tuple[float, float]:
    if not isinstance(given, (tuple, list, np.ndarray)) or np.shape(given) != (2,):
        raise InvalidValueError(
            f"ground_acceleration must be two finite numbers, horizontal and vertical [m/s2], got {given!r:.60}; "
            "for a horizontal one alone give (value, 0.0)"
        )
    return (
        checks.number("horizontal ground acceleration", given[0], "m/s2"),
        checks.number("vertical ground acceleration", given[1], "m/s2"),
    )
