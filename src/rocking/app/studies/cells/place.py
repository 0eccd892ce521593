"""Which history of a study a point of its picture is."""

from dataclasses import dataclass

import numpy as np

from rocking.app.problems import NotFound
from rocking.app.studies.opened import OpenStudy

_ACROSS = {
    "rocking-spectrum": ("period", "slenderness_angle"),
    "stripes": ("level", "motion"),
    "incremental": ("level", "motion"),
    "cloud": ("motion", ""),
    "histories": ("scale", "body"),
    "minimum-acceleration": ("point", "body"),
}
"""Dimensions of a kind that the picture has along x and y; those of a map are its axes."""


@dataclass(frozen=True)
class Place:
    """A history of a study."""

    number: int
    index: dict[str, int]  # its place along every axis of the study, and along ``motion`` also where there is only one
    restitution: int  # number of the restitution among those that are compared

    @classmethod
    def of(cls, study: OpenStudy, x: int, y: int, restitution: int = 0, motion: int = 0) -> "Place":
        """Return the history at a point of a picture."""
        dims, choices = study.job.job.study.dims, len(study.job.job.parts.choices)
        across = across_of(study)
        index = {"motion": motion} | {across[0]: x, across[1]: y}
        sizes = {name: dims[name] for name in study.axes} | {"the restitution": choices}
        at = {name: index.get(name, 0) for name in study.axes} | {"the restitution": restitution}
        for name, size in sizes.items():
            if not 0 <= at[name] < size:
                raise NotFound(f"{name} must be a number from 0 to {size - 1}, got {at[name]}")
        places = [at[name] if name in study.axes else restitution for name in dims]
        number = int(np.ravel_multi_index(tuple(places), study.job.job.study.shape))
        return cls(number, {"motion": 0} | {name: at[name] for name in study.axes}, restitution)


def across_of(study: OpenStudy) -> tuple[str, str]:
    """Return the dimensions that a picture of a study has along x and y.

    Returns names of dimensions; empty where the picture has only one.
    """
    kind = str(study.job.job.document.campaign.kind)
    if kind in _ACROSS:
        return _ACROSS[kind]
    y, x = study.axes
    return x, y
