"""The claim that kinetic energy distribution suits large bodies, against the contact bed."""

from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import extra
from rocking.restitution import Ked
from rocking.studies.impact_laboratory.beds import Laboratory, coefficients
from rocking.studies.impact_laboratory.dependence import layered
from rocking.studies.impact_laboratory.profiles import profile
from rocking.studies.impact_laboratory.result import LaboratoryStudy, about, provenance


def large_bodies_study(widths: Any, *, hollow: float = 1e-4, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return what the bed says about blocks of one shape that grow, on a flat and on a hollow base, beside KED.

    On a flat base of one layer r does not depend on the size at all (`size_study`): neither does KED. What can change
    with size is a length that does not grow: here a hollow of fixed height under the base.

    widths: widths of the base [m]; hollow: height of the hollow [m]. Returns over `width`: flat, hollow, ked and
    hollow_minus_ked [-].

    >>> found = large_bodies_study([0.1, 1.0, 10.0])
    >>> bool((found.hollow.diff("width") > 0.0).all())
    True
    """
    xarray = extra("xarray", "the impact laboratory")
    found = large_bodies(widths, hollow=hollow, laboratory=laboratory)
    found["hollow_minus_ked"] = found["hollow"] - found["ked"]
    data = {name: ("width", values, {"units": "1"}) for name, values in found.items()}
    coords = {"width": ("width", np.atleast_1d(np.asarray(widths, dtype=np.float64)), about("width", "m"))}
    return LaboratoryStudy(xarray.Dataset(data, coords, provenance("width", layered(laboratory))))


def large_bodies(widths: Any, *, hollow: float = 1e-4, laboratory: Laboratory | None = None) -> dict[str, FloatArray]:
    """Return the numbers of `large_bodies_study`, which need no labelled arrays.

    widths: widths of the base [m]; hollow: height of the hollow [m]. Returns flat, hollow and ked, over the widths [-].
    """
    start, row = layered(laboratory), np.atleast_1d(checks.positive_array("width", widths, "m"))
    beds = {"flat": start.but(profile=()), "hollow": start.but(profile=profile("concave", hollow, start.points))}
    found = {name: coefficients(bed.but(width=w) for w in row.tolist()) for name, bed in beds.items()}
    return {**found, "ked": np.full(row.shape, Ked().coefficient(start.block))}
