"""Arrays as plain lists, with None where there is no finite number, and what several kinds of results share."""

from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy

MODES = {-3: "not computed", -2: "not lifted", -1: "rocks, stays standing", 0: "overturns without impact"}
"""Ways to end in words; n > 0 overturns after n impacts."""


def plain(values: Any) -> Any:
    """Return an array as lists.

    Returns none where there is no finite number.
    """
    array = np.asarray(values)
    if array.dtype.kind != "f" or np.isfinite(array).all():
        return array.tolist()
    return np.where(np.isfinite(array), array, np.array(None, dtype=object)).tolist()


def meaning(mode: int) -> str:
    """Return a way to end in words.

    >>> meaning(-1), meaning(1)
    ('rocks, stays standing', 'overturns after 1 impact')
    """
    return MODES.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def shares(modes: np.ndarray) -> list[dict[str, Any]]:
    """Return how many histories end in which way.

    Returns mode, meaning, count and share [-], by mode.
    """
    found, counts = np.unique(modes, return_counts=True)
    return [
        {"mode": mode, "meaning": meaning(mode), "count": count, "share": count / modes.size}
        for mode, count in zip(found.tolist(), counts.tolist(), strict=True)
    ]


def coordinate(study: OpenStudy, name: str) -> dict[str, Any]:
    """Return what is known of a dimension of a study."""
    found = study.job.job.study.coordinates[name]
    return {"name": name, "values": plain(found.values), "unit": found.unit, "words": found.words}


def by_restitution(study: OpenStudy, name: str) -> np.ndarray:
    """Return a result with the restitution as its first dimension.

    Returns also where the study has only one restitution.
    """
    values, dims = study.results[name], list(study.job.job.study.dims)
    several = len(study.axes) < len(dims)
    return np.moveaxis(values, dims.index("restitution"), 0) if several else values[None]
