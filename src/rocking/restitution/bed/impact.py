"""Impacts on a bed, resolved in time."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution.bed import fast, reference
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.emergent import BedStatus, Emergent, emergent_of, status_of
from rocking.restitution.bed.setup import COUNTS, RESULTS, SAMPLES, Setup, setup_of

BedEngine = Literal["auto", "fast", "reference"]
ENGINES: tuple[BedEngine, ...] = ("auto", "fast", "reference")


@dataclass(frozen=True, eq=False)
class BedImpact:
    """An impact with its history.

    Parameters
    ----------
    setup : Setup
        Body, bed, start.
    results, counts : ndarray
        Rows of results, columns `setup.RESULTS` and `setup.COUNTS`.
    samples : ndarray
        History, columns `setup.SAMPLES`.
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
            One of `setup.RESULTS`, "bed_loss" or "friction_loss" [J] for instance.

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
            One of `setup.SAMPLES`.

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
    return BedImpact(setup, *fast.one(setup))


_NONE = Emergent(float("nan"), float("nan"), float("nan"), stopped=False)


@dataclass(frozen=True, eq=False)
class BedImpacts:
    """Results of many impacts, a row each.

    Parameters
    ----------
    setups : sequence of Setup
        The impacts.
    results, counts : ndarray
        Columns `setup.RESULTS` and `setup.COUNTS`.
    emergent : tuple of Emergent
        Coefficients of restitution by three measures; NaN for an impact that failed.
    """

    setups: Sequence[Setup]
    results: FloatArray
    counts: IntArray
    emergent: tuple[Emergent, ...]

    @property
    def coefficient(self) -> FloatArray:
        """Coefficients of restitution; NaN for an impact that failed, see `status` [-]."""
        return np.array([row.coefficient for row in self.emergent])

    @property
    def stopped(self) -> BoolArray:
        """Whether the body did not step onto the new foot."""
        return np.array([row.stopped for row in self.emergent])

    @property
    def status(self) -> list[BedStatus]:
        """How each computation ended."""
        return [status_of(row) for row in self.counts]

    @property
    def contacts(self) -> IntArray:
        """How often each body came into contact with its bed as a whole."""
        return np.array(self.counts[:, COUNTS.index("contacts")])

    @property
    def audit(self) -> FloatArray:
        """Energy at the end plus losses minus energy at the start, over the energy before each impact [-]."""
        energy = np.array([setup.start.energy for setup in self.setups], dtype=np.float64)
        return np.asarray(self.result("residual") / energy)

    def result(self, name: str) -> FloatArray:
        """Return one column of the results.

        Parameters
        ----------
        name : str
            One of `setup.RESULTS`.

        Returns
        -------
        ndarray
            Its values in SI.
        """
        return np.array(self.results[:, RESULTS.index(name)])


def bed_impacts(setups: Iterable[Setup], *, threads: int = 1) -> BedImpacts:
    """Compute many impacts; the bits of a row depend neither on the threads nor on the other rows.

    Parameters
    ----------
    setups : iterable of Setup
        Impacts from `setup_of`.
    threads : int
        Threads of the fast engine.

    Returns
    -------
    BedImpacts
        A row an impact, in the order given; one that fails says so in its status and has a coefficient of NaN.

    Raises
    ------
    InvalidValueError
        If there is no impact, or the number of threads is not a whole number above zero.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impacts, setup_of
    >>> block = Block(width=0.2, height=0.4)
    >>> bed = ContactBed.uniform(block, 2, KelvinVoigt(1e9, damping_ratio=1.0))
    >>> impacts = bed_impacts([setup_of(block, bed, angular_velocity=v) for v in (0.5, 1.0)])
    >>> impacts.coefficient.round(2).tolist()
    [0.7, 0.7]
    """
    rows = list(setups)
    if not rows:
        raise InvalidValueError("at least one impact is needed, got none")
    number = checks.positive("threads", threads)
    if number != int(number):
        raise InvalidValueError(f"threads must be a whole number, got {threads}")
    if fast.available():
        results, counts = fast.many(rows, int(number))
    else:
        computed = [reference.one(row)[:2] for row in rows]
        results, counts = np.array([c[0] for c in computed]), np.array([c[1] for c in computed])
    return BedImpacts(rows, results, counts, tuple(_emergent(*row) for row in zip(rows, results, counts, strict=True)))


def _emergent(setup: Setup, results: FloatArray, counts: IntArray) -> Emergent:
    try:
        return emergent_of(setup, results, counts)
    except InvalidValueError:
        return _NONE
