"""What goes with curves into netCDF and MATLAB files: intervals, goodness of fit and bootstrap as variables."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.studies.fragility.agreement import STATISTICS, Agreement, Repeated, ends_of

if TYPE_CHECKING:
    from rocking.studies.fragility.curves import FragilityCurve

_BOTH = ("state", "end")


def variables_of(curves: "Sequence[FragilityCurve]", levels: int, unit: str) -> dict[str, Any]:
    """Return what is known of curves beside their parameters, over state.

    Returns Dimensions, values and attributes by name; numbers are missing (NaN) where there is none or an end is open.
    """
    told = "95 % interval, missing where it is open, or there is none"
    found: dict[str, Any] = {}
    for name, of in (("median_95", unit), ("dispersion_95", "1")):
        found[name] = (_BOTH, np.array([ends_of(getattr(curve, name)) for curve in curves]), _said(of, told))
    agreements = [curve.agreement or Agreement() for curve in curves]
    for name, words in STATISTICS.items():
        value, p_value = np.array([each.numbers[name] for each in agreements]).T
        found[name] = ("state", value, _said("1", words))
        found[f"{name}_p_value"] = ("state", p_value, _said("1", f"p-value: {words}"))
    found["agreement"] = ("state", np.array([each.words for each in agreements]))
    return found | (_repeated(curves, levels, unit) if any(curve.repeated for curve in curves) else {})


def _repeated(curves: "Sequence[FragilityCurve]", levels: int, unit: str) -> dict[str, Any]:
    told = "95 % interval from the bootstrap, missing where it is open, or there is none"
    each = [curve.repeated or Repeated() for curve in curves]
    bands = np.array([one.band_at(levels) for one in each])
    return {
        "median_bootstrap_95": (_BOTH, np.array([ends_of(one.median_95) for one in each]), _said(unit, told)),
        "dispersion_bootstrap_95": (_BOTH, np.array([ends_of(one.dispersion_95) for one in each]), _said("1", told)),
        "probability_bootstrap_95": (("state", "end", "level"), bands, _said("1", told)),
        "bootstrap": ("state", np.array([one.words for one in each])),
    }


def _said(unit: str, words: str) -> dict[str, str]:
    return {"units": unit, "long_name": words}
