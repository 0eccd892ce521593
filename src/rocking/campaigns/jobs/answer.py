"""What an adaptive study has found: tables of any length, beside or in place of its histories."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rocking.tables import Column, Table


@dataclass(frozen=True)
class AdaptiveResult:
    """What an adaptive study has found."""

    value: Any  # what the Python call returns
    tables: Mapping[str, Table]  # the same as tables, by what `export` calls them
    attributes: dict[str, Any] = field(default_factory=dict)  # what more is to be said of it, as plain values


def variable_of(name: str, taken: Mapping[str, Column]) -> str:
    """Return a name that MATLAB and netCDF take, and no other column has.

    >>> variable_of("overturned: median ratio", {})
    'overturned_median_ratio'
    """
    variable = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    others = {each.variable for each in taken.values()}
    count = 2
    while (unique := variable if count == 2 and variable not in others else f"{variable}_{count}") in others:
        count += 1
    return unique
