"""Coordinates of studies: words and numbers along a dimension, and the names of motions."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.tables import Column, text_array


def along(dim: str, values: Any, unit: str = "1", words: str = "") -> Column:
    """Return numbers along a dimension."""
    return Column(np.asarray(values), unit, words, dims=(dim,))


def of_words(dim: str, values: Iterable[str], words: str) -> Column:
    """Return words along a dimension."""
    return Column(text_array(list(values)), "1", words, dims=(dim,))


def of_motions(motions: MotionSet) -> Column:
    """Return what the motions are called: by name, or by number where each is made from a seed when it is needed."""
    if isinstance(motions, MotionList):
        return of_words("motion", (motions[k].name for k in range(len(motions))), "name of the motion")
    return along("motion", np.arange(len(motions)), "1", "number of the motion in its set")
