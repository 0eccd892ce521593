"""The published measurements in plain values, and the curves of the models between them."""

from functools import cache
from typing import Any

import numpy as np

from rocking.evidence._coefficient_table import default_models
from rocking.evidence.measurements import all_measurements

_RATIOS = np.geomspace(0.8, 12.0, 40)


@cache
def measured_facts() -> dict[str, Any]:
    """Return every independent published measurement.

    Returns ``source`` and ``points``: ``group``, ``label``, ``slenderness_ratio``, ``slenderness_angle_rad``,
    ``coefficient``, and ``low`` and ``high`` that the printed digits leave open.
    """
    data = all_measurements()
    columns = {
        "group": data.group,
        "label": data.labels,
        "slenderness_ratio": data.slenderness.tolist(),
        "slenderness_angle_rad": np.arctan(1.0 / data.slenderness).tolist(),
        "coefficient": data.coefficient.tolist(),
        "low": data.low.tolist(),
        "high": data.high.tolist(),
    }
    rows = zip(*columns.values(), strict=True)
    return {"source": data.source, "points": [dict(zip(columns, row, strict=True)) for row in rows]}


@cache
def curves_facts() -> list[dict[str, Any]]:
    """Return the coefficient of homogeneous rectangles under every model.

    Returns ``model``, ``slenderness_ratio`` and ``coefficient`` [-].
    """
    ratios = _RATIOS.tolist()
    return [
        {"model": model.label, "slenderness_ratio": ratios, "coefficient": model.of_slenderness(_RATIOS).tolist()}
        for model in default_models()
    ]
