"""The claim that kinetic energy distribution suits large bodies, against the contact bed."""

from typing import Any

from rocking.restitution import Ked
from rocking.studies.impact_laboratory.beds import Laboratory
from rocking.studies.impact_laboratory.dependence import size_study
from rocking.studies.impact_laboratory.profiles import profile
from rocking.studies.impact_laboratory.result import LaboratoryStudy


def large_bodies_study(widths: Any, *, hollow: float = 1e-4, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return what the bed says about blocks of one shape that grow, on a flat and on a hollow base, beside KED.

    On a flat base of one layer r does not depend on the size at all (`size_study`): neither does KED. What can change
    with size is a length that does not grow: here a hollow of fixed height under the base.

    Parameters
    ----------
    widths : array_like
        Widths of the base [m].
    hollow : float
        Height of the hollow [m].
    laboratory : Laboratory, optional
        What stays as it is; without a layer of its own one of 1e9 Pa/m is taken.

    Returns
    -------
    LaboratoryStudy
        Over `width`: flat, hollow, ked and hollow_minus_ked [-].

    Examples
    --------
    >>> found = large_bodies_study([0.1, 1.0, 10.0])
    >>> bool((found.hollow.diff("width") > 0.0).all())
    True
    """
    start = laboratory or Laboratory()
    flat = size_study(widths, start.but(profile=()))
    uneven = size_study(widths, start.but(profile=profile("concave", hollow, start.points)))
    ked = flat.coefficient * 0.0 + Ked().coefficient(start.block)
    data = {"flat": flat.coefficient, "hollow": uneven.coefficient, "ked": ked}
    made = flat.dataset.drop_vars(list(flat.data_vars)).assign(data)
    made = made.assign(hollow_minus_ked=made.hollow - made.ked)
    for name in made.data_vars:
        made[name].attrs["units"] = "1"
    return LaboratoryStudy(made)
