"""Rocking spectra: peak rotation of blocks against the size of the blocks, for slenderness angles and motions."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Block
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.mechanics import study_settings
from rocking.dynamics.parameters import sides_of
from rocking.errors import InvalidValueError, extra
from rocking.motions.pulse import Motion
from rocking.outcome import contact_words
from rocking.studies.histories import Product
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.question import Question
from rocking.studies.sensitivity.restitutions import sampled
from rocking.studies.study_plan import Study, along, labels_along, motions_along
from rocking.tables import Column

if TYPE_CHECKING:
    import xarray as xr


def rocking_spectrum(
    motions: Motion | Sequence[Motion],
    slenderness_angles: Any,
    periods: Any,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> "xr.Dataset":
    """Return the peak rotation of blocks under motions.

    For other plane or 3D bodies, use a map over ``semi_diagonal``.

    Parameters
    ----------
    motions : GroundMotion, Pulse or mapping, or a sequence of them
        Either records only or pulses only, with components along x and z as for `simulate`.
    slenderness_angles : array_like
        Slenderness angles alpha, between 0 and pi/2 [rad].
    periods : array_like
        Periods 2 pi / p [s]. The size R of a block follows from p^2 = 3 g / (4 R).
    restitution : as for `simulate`
        Restitution, which is evaluated for every block.
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
        Dataset over ``motion, slenderness_angle, period``: outcome, mode, peak_rotation, peak_ratio and more, with
        units. Coordinates are ``semi_diagonal`` [m] and ``coefficient`` of restitution [-], which is missing for a law
        with a coefficient per impact. The peak of an overturned block is pi/2.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import rocking as rk
    >>> spectrum = rocking_spectrum(rk.pulses.sine(amplitude=2.0, period=0.8), [0.15, 0.3], [1.0, 2.0, 4.0, 8.0], 0.9)
    >>> dict(spectrum.sizes), spectrum["mode"].sel(slenderness_angle=0.3).values.tolist()
    ({'motion': 1, 'slenderness_angle': 2, 'period': 4}, [[-2, -2, -2, -2]])
    """
    extra("xarray", "rocking_spectrum")
    scale = checks.within("scale", options.pop("scale", 1.0), -1e6, 1e6)
    engine = options.pop("engine", "auto")
    settings = study_settings(None, options, gravity)
    angles = _row("slenderness_angles", slenderness_angles, "rad")
    times = _row("periods", periods, "s")
    all_motions = MotionList(motions, plane=True)

    def product_of(blocks: list[Block]) -> tuple[Product, dict[str, Any]]:
        question = Question(blocks[0], all_motions[0], restitution, settings, threads, engine)
        sides = sides_of([question.parameters_of(block) for block in blocks])
        columns = {name: values[:, None] for name, values in sides.items()}
        product = Product(
            all_motions, columns, np.array([scale]), law=question.law, settings=settings, engine=engine
        )  # fmt: skip
        return product, _attributes(question)

    study = spectrum_study(product_of, all_motions, angles, times, gravity=settings.gravity, scale=scale)
    names = [all_motions[k].name for k in range(len(all_motions))]
    dataset: xr.Dataset = study.computed(progress, threads).assign_coords(motion=names)
    dataset.attrs["contact"] = str(contact_words(dataset["lost_contact"].values))
    return dataset


def spectrum_study(
    product_of: Callable[[list[Block]], tuple[Product, dict[str, Any]]], motions: MotionSet, angles: FloatArray,
    times: FloatArray, *, gravity: float, scale: float, restitutions: Sequence[str] = (),
) -> Study:  # fmt: skip
    """Return the study over motion, slenderness angle, period and, if several, restitution.

    `product_of` is a function that returns the histories of blocks, and attributes.
    """
    sizes = 0.75 * gravity * (0.5 * times / np.pi) ** 2  # Eq. 180
    product, attributes = product_of(
        [Block.from_angle(float(alpha), float(size)) for alpha in angles for size in sizes]
    )
    dims = {"motion": len(motions), "slenderness_angle": angles.size, "period": times.size}
    coordinates = {
        "motion": motions_along(motions),
        "slenderness_angle": along("slenderness_angle", angles, "rad", "slenderness angle"),
        "period": along("period", times, "s", "2 pi / p"),
        "semi_diagonal": along("period", sizes, "m", "semi-diagonal R of the block"),
    }
    if len(restitutions) > 1:
        dims["restitution"] = len(restitutions)
        coordinates["restitution"] = labels_along("restitution", restitutions, "restitution")
    # a law with a coefficient per impact has no single coefficient
    coefficient = np.where(isinstance(product.law, ConstantRestitution), product.sides["r_right"], np.nan)
    coefficient = coefficient.reshape([*dims.values()][1:])
    coordinates["coefficient"] = Column(coefficient, "1", "coefficient of restitution", dims=tuple(dims)[1:])
    attributes["scale"] = scale
    if isinstance(motions, MotionList):
        attributes["motion_sha256"] = "; ".join(item["sha256"] for item in motions.description()["motions"])
    return Study(sampled(product), dims, coordinates, attributes)


def _row(name: str, row: Any, unit: str) -> FloatArray:
    values = np.atleast_1d(checks.positive_array(name, row, unit))
    if values.ndim != 1 or not values.size:
        raise InvalidValueError(
            "{parameter} must be a row of numbers [{unit}], got shape {shape}", parameter=name, unit=unit,
            shape=values.shape,
        )  # fmt: skip
    return values


def _attributes(question: Question) -> dict[str, Any]:
    kept = question.attributes({})
    about = {k: v for k, v in kept.items() if k in {"software", "seed", "restitution_file"} or k.startswith("setting_")}
    return {**about, "restitution": question.parameters.label}
