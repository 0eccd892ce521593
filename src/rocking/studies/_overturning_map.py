"""Overturning maps: outcome of a body over two parameters of body and motion."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import conventions
from rocking.bodies import Body, Restrained
from rocking.conventions import DEFAULT_RESTITUTION
from rocking.errors import extra
from rocking.messages import plain_texts
from rocking.motions.pulse import Motion
from rocking.outcome import contact_words
from rocking.quantities import HISTORY, WITH_RESTRAINTS, attributes
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane, refined
from rocking.studies.axis import Axis

if TYPE_CHECKING:
    import xarray as xr


def overturning_map(  # noqa: PLR0913 - users set every one of them
    body: Body | Restrained,
    motion: Motion,
    x: Axis | tuple[str, Any],
    y: Axis | tuple[str, Any],
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    refine: int | None = None,
    **settings: Any,
) -> "xr.Dataset":
    """Return the outcome of a body over two parameters.

    Restitution models are evaluated for every body on the axes. A pulse or record is stretched exactly in time, without
    resampling.

    Parameters
    ----------
    body : Body or Restrained
        The body. Axes replace its values, but not the dimensions of a body with restraints.
    motion : GroundMotion, Pulse or mapping
        The motion, or its components as for `simulate`. Axes replace its values.
    x, y : Axis or (str, array_like)
        Axes, or their names and values: frequency_ratio, amplitude_ratio, scale, pga [m/s2], pgv [m/s], period [s],
        duration [s], semi_diagonal [m], slenderness_ratio, slenderness_angle [rad], width [m], height [m], restitution,
        friction, initial_rotation [rad], initial_angular_velocity [rad/s]; for 3D bodies azimuth [rad].
    restitution : as for `simulate`
        Ignored if restitution is an axis.
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Number of threads of the fast engine. The results do not depend on this number.
    progress : callable, optional
        Function called with the number of histories finished since the last call.
    refine : int, optional
        Number of refinements along the boundaries between modes. A refinement halves the spacing, see `refined_map`.
    **settings
        Fields of `Settings`, and ``engine``. With ``friction`` as a setting or an axis, the body may slide, hop and
        fly, and the restitution may be None, as for `simulate`.

    Returns
    -------
    xarray.Dataset
        Dataset over the two axes (y first): outcome, mode, peak_rotation, peak_ratio, impacts, side, overturning_time,
        status, error, with units; with restraints also residual_rotation, yielded_restraints and broken_restraints.
        With `refine`, the dataset also contains ``refined_mode``, ``refined_peak_ratio``, ``refined_x`` and
        ``refined_y`` over ``point``, for all computed points. A cell that could not be computed has mode -3 and a
        status with the reason. It does not affect other cells.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or if the axes do not fit the body, the motion or each other.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> ratios = np.linspace(1.0, 6.0, 11)
    >>> outcomes = overturning_map(block, pulse, ("frequency_ratio", ratios), ("amplitude_ratio", ratios), 0.9)
    >>> outcomes["mode"].sel(frequency_ratio=1.0, amplitude_ratio=[1.0, 3.0]).values.tolist()
    [-2, 0]
    """
    extra("xarray", "overturning_map")
    return map_arrays(
        body, motion, x, y, restitution, gravity=gravity, threads=threads, progress=progress, refine=refine, **settings
    ).to_xarray()


@dataclass(frozen=True, eq=False)
class MapArrays:
    """An overturning map as arrays. A dataset is created only for return or export."""

    axes: tuple[Axis, Axis]  # x, y
    variables: dict[str, np.ndarray]  # results over y and x; results with the prefix refined_ over the points
    attributes: dict[str, Any]  # provenance of the dataset

    def __getitem__(self, name: str) -> np.ndarray:
        return self.variables[name]

    @property
    def points(self) -> int | None:
        """Number of points of a refined map; None without refinement."""
        return len(self["refined_mode"]) if "refined_mode" in self.variables else None

    def to_xarray(self) -> "xr.Dataset":
        xarray = extra("xarray", "overturning_map")
        x, y = self.axes
        own = {"refined_x": x.attributes, "refined_y": y.attributes}
        dataset: xr.Dataset = xarray.Dataset(
            {
                name: (
                    "point" if name.startswith("refined_") else (y.name, x.name),
                    values,
                    own.get(name) or attributes(name.removeprefix("refined_")),
                )
                for name, values in self.variables.items()
            },
            coords={axis.name: (axis.name, axis.values, axis.attributes) for axis in (y, x)},
            attrs=plain_texts(self.attributes),
        )
        return dataset


def map_arrays(
    *subject: Any, progress: Callable[[int], None] | None = None, refine: int | None = None, **options: Any
) -> MapArrays:
    """Return an overturning map as arrays. Parameters are those of `overturning_map`, in the order of `Plane.of`."""
    plane = Plane.of(*subject, **options)
    results, work = plane.answers(*plane.mesh(), progress=progress)
    shape = (plane.y.values.size, plane.x.values.size)
    names = (*HISTORY, *(name for name in WITH_RESTRAINTS if name in results))
    variables = {name: results[name].reshape(shape) for name in names}
    if refine is not None:
        grid = AdaptiveGrid(plane, refine, progress)
        points, _ = refined(grid, variables["mode"], results["peak_ratio"])
        variables |= {
            "refined_x": points.x, "refined_y": points.y, "refined_mode": points.modes,
            "refined_peak_ratio": points.peak_ratio,
        }  # fmt: skip
    attributes = {**plane.attributes(work), "contact": contact_words(results["lost_contact"])}
    return MapArrays((plane.x, plane.y), variables, attributes)
