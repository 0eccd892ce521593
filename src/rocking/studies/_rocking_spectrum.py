"""Rocking spectra: peak rotation of blocks over their size, for several slendernesses and motions."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Block
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.mechanics import study_settings
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, extra
from rocking.messages import plain_texts
from rocking.motions.pulse import Motion
from rocking.outcome import contact_words, flags
from rocking.quantities import HISTORY, attributes
from rocking.studies.histories import Product, results_of
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import Question, modes_of, peak_ratio

if TYPE_CHECKING:
    import xarray as xr

_DIMENSIONS = ("motion", "slenderness_angle", "period")


def rocking_spectrum(
    motions: Motion | Sequence[Motion],
    slenderness_angles: Any,
    periods: Any,
    restitution: Any = "ked",
    *,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> "xr.Dataset":
    """Return the peak rotation of blocks under motions.

    Of another body, plane or in space, a map over ``semi_diagonal`` shows all sizes.

    Parameters
    ----------
    motions : GroundMotion, Pulse or mapping, or a sequence of them
        All records or all pulses; components along x and z as for `simulate`.
    slenderness_angles : array_like
        alpha, between 0 and pi/2 [rad].
    periods : array_like
        2 pi / p [s], which with p^2 = 3 g / (4 R) sets the size of a block.
    restitution : as for `simulate`
        Evaluated for every block.
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the fast engine; the results do not depend on them.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``scale``, a factor on the motions [-], ``engine``, and fields of `Settings`.

    Returns
    -------
    xarray.Dataset
        Over ``motion, slenderness_angle, period``: outcome, mode, peak_rotation, peak_ratio and more, with units;
        coordinates ``semi_diagonal`` [m] and ``coefficient`` of restitution [-], which is missing where a law changes
        it from impact to impact. Where a block overturned the peak is a quarter turn.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rocking_spectrum(rk.pulses.sine(amplitude=2.0, period=0.8), [0.15, 0.3], [1.0, 2.0, 4.0, 8.0], 0.9)
    >>> dict(found.sizes), found["mode"].sel(slenderness_angle=0.3).values.tolist()
    ({'motion': 1, 'slenderness_angle': 2, 'period': 4}, [[-2, -2, -2, -2]])
    """
    xarray = extra("xarray", "rocking_spectrum")
    scale = checks.within("scale", options.pop("scale", 1.0), -1e6, 1e6)
    engine = options.pop("engine", "auto")
    settings = study_settings(None, options, gravity)
    angles = _row("slenderness_angles", slenderness_angles, "rad")
    times = _row("periods", periods, "s")
    sizes = 0.75 * settings.gravity * (0.5 * times / np.pi) ** 2  # Eq. 180
    all_motions = MotionList(motions, plane=True)
    blocks = [Block.from_angle(float(alpha), float(size)) for alpha in angles for size in sizes]
    question = Question(blocks[0], all_motions[0], restitution, settings, threads, engine)
    sides = sides_of([question.parameters_of(block) for block in blocks])
    histories = Product(
        all_motions, {name: v[:, None] for name, v in sides.items()}, np.array([scale]),
        law=question.law, settings=settings, engine=engine,
    )  # fmt: skip
    results = results_of(histories, threads=threads, progress=progress)
    shape = (len(all_motions), angles.size, times.size)
    alpha = np.tile(sides["alpha_right"], len(all_motions))
    results |= {"mode": modes_of(results), **flags(results)}
    results["peak_ratio"] = peak_ratio(results["peak_rotation"], alpha, alpha)
    data = {name: (_DIMENSIONS, results[name].reshape(shape), attributes(name)) for name in HISTORY}
    constant = isinstance(question.law, ConstantRestitution)
    coefficient = np.where(constant, sides["r_right"], np.nan).reshape(shape[1:])
    labelled: xr.Dataset = xarray.Dataset(
        data,
        coords={
            "motion": [all_motions[k].name for k in range(len(all_motions))],
            "slenderness_angle": ("slenderness_angle", angles, {"units": "rad", "long_name": "slenderness angle"}),
            "period": ("period", times, {"units": "s", "long_name": "2 pi / p"}),
            "semi_diagonal": ("period", sizes, {"units": "m", "long_name": "semi-diagonal R of the block"}),
            "coefficient": (_DIMENSIONS[1:], coefficient, {"units": "1", "long_name": "coefficient of restitution"}),
        },
        attrs=plain_texts(_attributes(question, settings, scale, all_motions))
        | {"contact": contact_words(results["lost_contact"])},
    )
    return labelled


def _row(name: str, row: Any, unit: str) -> FloatArray:
    values = np.atleast_1d(checks.positive_array(name, row, unit))
    if values.ndim != 1 or not values.size:
        raise InvalidValueError(
            "{parameter} must be a row of numbers [{unit}], got shape {shape}", parameter=name, unit=unit,
            shape=values.shape,
        )  # fmt: skip
    return values


def _attributes(question: Question, settings: Settings, scale: float, motions: MotionList) -> dict[str, Any]:
    kept = question.attributes({})
    about = {k: v for k, v in kept.items() if k in {"software", "seed", "restitution_file"} or k.startswith("setting_")}
    hashes = "; ".join(item["sha256"] for item in motions.description()["motions"])
    return {**about, "restitution": question.parameters.label, "scale": scale, "motion_sha256": hashes}
