"""Long-run dynamics of a body under harmonic ground motion, with one or several restitution models."""

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.longrun import study
from rocking.studies.longrun.basins import cells
from rocking.studies.longrun.exponents import ALIGNED
from rocking.studies.longrun.system import Harmonic

if TYPE_CHECKING:
    import xarray as xr


def poincare(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body, excitation: Harmonic, restitution: Any = DEFAULT_RESTITUTION, *, starts: Any = 1,
    cycles: tuple[int, int] = (100, 500), at: Literal["period", "impact"] = "period", seed: int = 0,
    linear: bool = False, gravity: float = conventions.g, threads: int | None = None,
) -> "xr.Dataset":  # fmt: skip
    """Compute the Poincare section of long histories.

    Parameters
    ----------
    body : Body
        A plane body.
    excitation : Harmonic
        Harmonic ground motion.
    restitution : as for `simulate`, or a list of them
        Restitution; a list adds the dimension ``restitution``.
    starts : int or array_like, optional
        Number of initial states: at rest, then random after an impact. Or the phase of the ground motion [rad] and
        the speed / (alpha p) of each state after an impact, shape (starts, 2); NaN at rest.
    cycles : tuple of int, optional
        Number of periods before the section, and of the section.
    at : {"period", "impact"}, optional
        States at the ends of periods: rotation / alpha, angular velocity / (alpha p). Or after the first impacts,
        8 per period at most: phase of the ground motion [rad], angular velocity / (alpha p).
    seed : int, optional
        Random seed of the initial states.
    linear : bool, optional
        Equations of a slender body.
    gravity : float, optional
        Acceleration of gravity [m/s2].
    threads : int, optional
        Number of threads; the results do not depend on it.

    Returns
    -------
    xarray.Dataset
        States over initial state and number; NaN after overturning.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block, motion = rk.Block(width=0.5, height=2.0), rk.Harmonic(amplitude=3.0, period=0.8)
    >>> poincare(block, motion, "housner", cycles=(50, 10)).sizes["period_number"]
    10
    """
    task = study.SectionTask(_states(starts, seed), _cycles(cycles), checks.one_of("at", at, ("period", "impact")))
    return _computed(study.systems_of(body, excitation, restitution, linear=linear, gravity=gravity), task, threads)


def bifurcation(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body, excitation: Harmonic, axis: str, values: Any, restitution: Any = DEFAULT_RESTITUTION, *,
    starts: Any = 4, sweeps: tuple[str, ...] = ("none",), cycles: tuple[int, int] = (300, 128),
    exponents: bool = True, seed: int = 0, linear: bool = False, gravity: float = conventions.g,
    threads: int | None = None,
) -> "xr.Dataset":  # fmt: skip
    """Compute a bifurcation diagram: the attractors over one parameter.

    Parameters
    ----------
    body, excitation
        As for `poincare`.
    axis : {"amplitude", "frequency", "slenderness", "size", "restitution"}
        Parameter: amplitude / uplift amplitude, frequency / p, slenderness h/b of a block with constant amplitude
        and frequency ratios, semi-diagonal [m] with constant ground motion, or coefficient of restitution.
    values : array_like
        Increasing values of the parameter.
    restitution, starts
        As for `poincare`.
    sweeps : tuple of {"none", "up", "down"}, optional
        Directions of the sweeps. Up and down, each history starts in the last state at the previous value.
    cycles : tuple of int, optional
        Number of periods before the kept states, and with kept states; periods up to half of the latter are
        recognised, at most 64.
    exponents : bool, optional
        True also computes the largest Lyapunov exponent.
    seed, linear, gravity, threads
        As for `poincare`.

    Returns
    -------
    xarray.Dataset
        Over sweep, parameter, initial state and period: rotation and velocity at the end of the period; kind of the
        attractor, its periods, symmetry, impacts per period, peak and exponent [1/s], equal for all periods.

    Raises
    ------
    InvalidValueError
        If the values do not increase, or a value is outside its range.

    References
    ----------
    Hogan (1989), Proc. R. Soc. Lond. A 425:441-476; Gaibor and Lopez (2026), arXiv:2606.14288.

    Examples
    --------
    >>> import rocking as rk
    >>> block, motion = rk.Block(width=0.5, height=2.0), rk.Harmonic(amplitude=3.0, period=0.8)
    >>> diagram = bifurcation(block, motion, "amplitude", [0.9, 1.2], ["ked", "housner"], starts=1)
    >>> bool((diagram["attractor"].sel(amplitude_ratio=0.9) == 0).all())  # at rest below uplift
    True
    """
    checks.one_of("axis", axis, tuple(study.AXES))
    numbers = checks.finite("values", values, "-", minimum=1)
    checks.increasing("values", numbers)
    for sweep in sweeps:
        checks.one_of("sweeps", sweep, ("none", "up", "down"))
    task = study.Diagram(axis, numbers, _states(starts, seed), tuple(sweeps), _cycles(cycles), exponents)
    return _computed(study.systems_of(body, excitation, restitution, linear=linear, gravity=gravity), task, threads)


def lyapunov(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body, excitation: Harmonic, restitution: Any = DEFAULT_RESTITUTION, *, orbits: int = 64,
    cycles: tuple[int, int] = (500, 1000), seed: int = 0, linear: bool = False, gravity: float = conventions.g,
    threads: int | None = None,
) -> "xr.Dataset":  # fmt: skip
    """Compute Lyapunov exponents of several orbits.

    Parameters
    ----------
    body, excitation, restitution
        As for `poincare`.
    orbits : int, optional
        Number of orbits with random initial states. Orbits that overturn within 60 periods are replaced, with at most
        65,536 random states, or 16 per orbit if these are more.
    cycles : tuple of int, optional
        Number of periods before growth is counted, at least 60, and with counted growth.
    seed, linear, gravity, threads
        As for `poincare`.

    Returns
    -------
    xarray.Dataset
        Over orbit: both exponents [1/s], minus infinity for an orbit with rests, NaN for one that overturns; impacts
        per second. `rocking.plots.lyapunov_picture` draws mean and standard errors; the mean is that of one attractor
        only if all orbits are on it.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block, motion = rk.Block(width=1.0, height=2.0), rk.Harmonic(amplitude=6.0, period=1.2)
    >>> exponents = lyapunov(block, motion, "housner", orbits=4, cycles=(100, 100))
    >>> bool((exponents["exponent"] < 0.0).all())
    True
    """
    settled, kept = _cycles(cycles, ALIGNED)
    task = study.Exponents(checks.whole("orbits", orbits, 1), settled, kept, checks.whole("seed", seed))
    return _computed(study.systems_of(body, excitation, restitution, linear=linear, gravity=gravity), task, threads)


def basin(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body, excitation: Harmonic, restitution: Any = DEFAULT_RESTITUTION, *, amplitudes: Any = None,
    phases: Any = 100, speeds: Any = 100, highest: float = 2.0, impacts: int = 120, small: float = 0.02,
    check: bool = True, linear: bool = False, gravity: float = conventions.g, threads: int | None = None,
) -> "xr.Dataset":  # fmt: skip
    """Compute the basin of overturning over phase and speed after an impact, or over phase and amplitude from rest.

    Parameters
    ----------
    body, excitation, restitution
        As for `poincare`.
    amplitudes : array_like, optional
        Amplitudes / uplift amplitude [-]. Default: the amplitude of the ground motion. Several amplitudes show the
        erosion.
    phases, speeds : int or array_like, optional
        Number of cells, with states at their centres, or phases of the ground motion [rad] and speeds / (alpha p).
        One phase or one speed is a path through the basin. A speed of 0, also ``speeds=0``, is a start at rest.
    highest : float, optional
        Upper end of the speeds / (alpha p) [-].
    impacts : int, optional
        Number of impacts; histories from rest last half as many periods.
    small : float, optional
        Speed / (alpha p) after an impact below which a history ends as small; a history from rest is small if the body
        rests in the last period.
    check : bool, optional
        True repeats the computation with 30 times the step error and marks the cells that differ.
    linear, gravity, threads
        As for `poincare`.

    Returns
    -------
    xarray.Dataset
        Over amplitude, phase and speed: outcome, final state and uncertainty.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    References
    ----------
    Soliman and Thompson (1989), J. Sound Vib. 135:453-475 (erosion of basins).

    Examples
    --------
    >>> import rocking as rk
    >>> block, motion = rk.Block(width=0.5, height=2.0), rk.Harmonic(amplitude=3.0, period=0.8)
    >>> dict(basin(block, motion, "ked", phases=8, speeds=4).sizes)
    {'amplitude_ratio': 1, 'ground_phase': 8, 'speed_ratio': 4}
    >>> safe = basin(block, motion, "ked", amplitudes=[0.5, 2.0], phases=16, speeds=0)["final_state"] != 0
    >>> safe.mean(("ground_phase", "speed_ratio")).values.round(2).tolist()  # fraction of the phases
    [1.0, 0.0]
    """
    systems = study.systems_of(body, excitation, restitution, linear=linear, gravity=gravity)
    if amplitudes is None:
        amplitudes = [next(iter(systems.values())).amplitude_ratio]
    counts = [axis if isinstance(axis, int) else 1 for axis in (phases, speeds)]
    phase, speed = cells(counts[0], counts[1], highest)
    if not isinstance(phases, int):
        phase = checks.finite("phases", np.atleast_1d(phases), "rad")
    if not isinstance(speeds, int):
        speed = checks.finite("speeds", np.atleast_1d(speeds))
        checks.within("speeds", float(speed.min()), 0.0, math.inf)
    ratios = np.atleast_1d(checks.positive_array("amplitudes", amplitudes, "-"))
    task = study.Cells(ratios, phase, speed, checks.whole("impacts", impacts, 1), small, check)
    return _computed(systems, task, threads)


def periodic_orbits(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body, excitation: Harmonic, axis: str = "amplitude", limits: tuple[float, float] = (0.01, 10.0),
    restitution: Any = DEFAULT_RESTITUTION, *, doublings: int = 2, points: int = 400, linear: bool = False,
    gravity: float = conventions.g,
) -> "xr.Dataset":  # fmt: skip
    """Follow the symmetric periodic orbit in one parameter, and the orbits that branch off.

    Parameters
    ----------
    body, excitation
        As for `poincare`. The body is symmetric, and the amplitude is that of the first orbit.
    axis : {"amplitude", "frequency", "restitution"}, optional
        Parameter: amplitude / uplift amplitude, frequency / p, or coefficient of restitution.
    limits : tuple of float, optional
        Limits of the parameter.
    restitution
        As for `poincare`.
    doublings : int, optional
        Number of branches that branch off in turn: at the pitchfork, then at period doublings.
    points : int, optional
        Number of orbits of each branch.
    linear, gravity
        As for `poincare`.

    Returns
    -------
    xarray.Dataset
        Over branch and orbit: parameter, phase and speed after an impact, largest modulus of the multipliers, stability
        and kind of the bifurcation; the bifurcations come first. NaN for branches that do not exist.

    Raises
    ------
    OrbitNotFoundError
        If the amplitude is too small for the first orbit.
    InvalidValueError
        If a value is outside its range, or the body is not symmetric.

    Examples
    --------
    >>> import rocking as rk
    >>> block, motion = rk.Block(width=1.0, height=2.0), rk.Harmonic(amplitude=6.0, period=1.2)
    >>> orbits = periodic_orbits(block, motion, restitution="housner", doublings=0)
    >>> fold = orbits["amplitude_ratio"].where(orbits["branch_point"] == 1, drop=True).values.ravel()
    >>> print(f"{fold[0]:.4f}")
    0.3675
    """
    checks.one_of("axis", axis, ("amplitude", "frequency", "restitution"))
    points, doublings = checks.whole("points", points, 16), checks.whole("doublings", doublings, 0, 8)
    lowest, highest = checks.finite("limits", limits, shape=(2,)).tolist()
    task = study.Branches(axis, (lowest, highest), doublings, points)
    return _computed(study.systems_of(body, excitation, restitution, linear=linear, gravity=gravity), task, None)


def _states(starts: Any, seed: int) -> FloatArray:
    if isinstance(starts, int):
        return study.random_states(checks.whole("starts", starts, 1), checks.whole("seed", seed))
    states = np.atleast_2d(checks.real_array("starts", starts))
    if states.ndim != 2 or states.shape[1] != 2:
        raise InvalidValueError(parameter="starts", allowed="a number or an array of shape (starts, 2)", value=starts)
    return states


def _cycles(cycles: Any, minimum: int = 0) -> tuple[int, int]:
    if not isinstance(cycles, list | tuple) or len(cycles) != 2:
        raise InvalidValueError(parameter="cycles", allowed="two numbers of periods", value=cycles)
    return checks.whole("cycles[0]", cycles[0], minimum), checks.whole("cycles[1]", cycles[1], 1)


def _computed(systems: Any, task: Any, threads: int | None) -> "xr.Dataset":
    dataset: xr.Dataset = study.long_run_study(systems, task).computed(threads=threads)
    return dataset
