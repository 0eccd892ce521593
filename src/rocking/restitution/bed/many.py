"""Many impacts at once."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed import fast, reference
from rocking.restitution.bed.emergent import BedStatus, Emergent, emergent_of, status_of
from rocking.restitution.bed.impact import MOST_STEPS
from rocking.restitution.bed.tables import COUNTS, RESULTS, Setup

_NONE = Emergent(float("nan"), float("nan"), float("nan"), stopped=False)


@dataclass(frozen=True, eq=False)
class BedImpacts:
    """Results of many impacts, a row each.

    Parameters
    ----------
    setups : sequence of Setup
        The impacts.
    results, counts : ndarray
        Columns `tables.RESULTS` and `tables.COUNTS`.
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
            One of `tables.RESULTS`.

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
        results, counts = fast.many(rows, MOST_STEPS, int(number))
    else:
        computed = [reference.one(row)[:2] for row in rows]
        results, counts = np.array([c[0] for c in computed]), np.array([c[1] for c in computed])
    return BedImpacts(rows, results, counts, tuple(_emergent(*row) for row in zip(rows, results, counts, strict=True)))


def _emergent(setup: Setup, results: FloatArray, counts: IntArray) -> Emergent:
    try:
        return emergent_of(setup, results, counts)
    except InvalidValueError:
        return _NONE
