"""What the coefficient of restitution of a contact bed depends on: one study a question."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, extra
from rocking.restitution.bed import Coulomb
from rocking.studies.impact_laboratory.beds import Laboratory, hardness_of, measured
from rocking.studies.impact_laboratory.result import LaboratoryStudy, about, provenance

if TYPE_CHECKING:
    import xarray as xr

Change = Callable[[Laboratory, float], Laboratory]


def slenderness_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against slenderness.

    values: h/b [-].

    >>> slenderness_study([2.0, 4.0]).coefficient.round(2).values.tolist()
    [0.84, 0.96]
    """
    return study("slenderness", "1", values, lambda lab, x: lab.but(slenderness=x), laboratory)


def points_study(values: Sequence[int], laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the number of contact points.

    values: contact points, two or more [-].
    """
    return study("points", "1", values, lambda lab, x: lab.but(points=whole("points", x, 2)), laboratory)


def damping_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the damping ratio of the bed.

    values: zeta [-].
    """
    return study("damping", "1", values, lambda lab, x: lab.but(damping=x), laboratory)


def modulus_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the modulus of the layer over its thickness.

    values: E / t [Pa/m].
    """
    return study("modulus_over_thickness", "Pa/m", values, lambda lab, x: lab.but(modulus_over_thickness=x), laboratory)


def friction_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the coefficient of friction of the base.

    values: mu [-].
    """
    return study("friction", "1", values, lambda lab, x: lab.but(friction=Coulomb(x)), laboratory)


def mass_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the density of the block on a layer of given stiffness: mass alone, the size stays.

    values: densities [kg/m3].
    """
    return study("density", "kg/m3", values, lambda lab, x: lab.but(density=x), layered(laboratory))


def size_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the width of blocks of one shape and density on one layer.

    values: widths [m].
    """
    return study("width", "m", values, lambda lab, x: lab.but(width=x), layered(laboratory))


def velocity_study(values: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r against the rotation of release, and so against the landing velocity.

    values: rotations over the slenderness angle, in (0, 1) [-].
    """
    return study("release", "1", values, lambda lab, x: lab.but(release=x), laboratory)


def study(
    name: str, unit: str, values: Any, change: Change, laboratory: Laboratory | None = None, *, threads: int = 1
) -> LaboratoryStudy:
    """Return what emerges as one thing about the bed or the block changes.

    Returns over `name`: coefficient, coefficient_by_energy, hardness [-], landing_velocity [rad/s], peak_force [N],
    bed_loss and friction_loss [J], contacts, audit [-]; NaN where an impact failed.
    """
    xarray = extra("xarray", "the impact laboratory")
    row = np.atleast_1d(checks.real_array(name, values))
    if row.ndim != 1 or row.size == 0 or not bool(np.isfinite(row).all()):
        raise InvalidValueError(f"{name} must be a row of finite numbers [{unit}], got shape {row.shape}")
    start = laboratory or Laboratory()
    setups, impacts = measured((change(start, value) for value in row.tolist()), threads=threads)
    results: dict[str, tuple[str, FloatArray]] = {
        "coefficient": ("1", impacts.coefficient),
        "coefficient_by_energy": ("1", np.array([each.by_energy for each in impacts.emergent])),
        "hardness": ("1", np.array([hardness_of(setup) for setup in setups])),
        "landing_velocity": ("rad/s", np.array([setup.start.landing_velocity for setup in setups])),
        "peak_force": ("N", impacts.result("peak_force")),
        "bed_loss": ("J", impacts.result("bed_loss")),
        "friction_loss": ("J", impacts.result("friction_loss")),
        "contacts": ("1", impacts.contacts.astype(np.float64)),
        "audit": ("1", impacts.audit),
    }
    made: xr.Dataset = xarray.Dataset(
        {key: (name, value, about(key, of)) for key, (of, value) in results.items()},
        coords={name: (name, row, about(name, unit))},
        attrs=provenance(name, start),
    )
    return LaboratoryStudy(made)


def whole(name: str, value: Any, least: int) -> int:
    """Return a number that counts something.

    least: the smallest that is allowed [-].

    >>> whole("points", 41.0, 2)
    41
    """
    result = checks.number(name, value)
    if result != int(result) or result < least:
        raise InvalidValueError(
            f"{name} must be a whole number of at least {least}, got {result:g}; it counts, and is not rounded"
        )
    return int(result)


def layered(laboratory: Laboratory | None) -> Laboratory:
    """Return a laboratory whose bed is a layer."""
    start = laboratory or Laboratory()
    return start if start.modulus_over_thickness is not None else start.but(modulus_over_thickness=1e9)
