"""What an adaptive study has found: tables of any length, beside or in place of its histories."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    values: np.ndarray  # numbers or words; NaN where there is nothing
    unit: str = "1"  # unit, words: unit and meaning
    words: str = ""
    variable: str | None = None  # its name in netCDF files, where it differs

    @property
    def is_words(self) -> bool:
        """Whether the values are words."""
        return self.values.dtype.kind not in "iufb"


@dataclass(frozen=True)
class Sheet:
    """A table."""

    dim: str  # dimension of its rows in netCDF files
    columns: Mapping[str, Column]  # the columns by name, all of one length

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(next(iter(self.columns.values())).values.size)

    def header(self) -> list[str]:
        """Return the names of the columns with their units.

        Returns as ``name [unit]``; without unit where there is none.
        """
        return [name if each.unit == "1" else f"{name} [{each.unit}]" for name, each in self.columns.items()]


@dataclass(frozen=True)
class Answer:
    """What an adaptive study has found."""

    value: Any  # what the Python call returns
    sheets: Mapping[str, Sheet]  # the same as tables, by what `export` calls them
    attributes: dict[str, Any] = field(default_factory=dict)  # what more is to be said of it, as plain values


def words_of(values: list[str]) -> np.ndarray:
    """Return words as an array."""
    made = np.empty(len(values), dtype=object)
    made[:] = values
    return made


def variable_of(name: str, taken: Mapping[str, Column]) -> str:
    """Return a name that MATLAB and netCDF take, and no other column has.

    >>> variable_of("overturned: median ratio", {})
    'overturned_median_ratio'
    """
    made = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    others = {each.variable for each in taken.values()}
    count = 2
    while (unique := made if count == 2 and made not in others else f"{made}_{count}") in others:
        count += 1
    return unique
