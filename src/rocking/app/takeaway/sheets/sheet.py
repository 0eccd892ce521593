"""A table with units, before it becomes a file."""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

Cell = float | int | bool | str | None


@dataclass(frozen=True)
class Column:
    """One column."""

    name: str  # name with underscores, which programs can use
    unit: str  # unit; empty for words, ``-`` for numbers without one
    values: Sequence[Cell]  # numbers, or words, or None where there is nothing

    @classmethod
    def of(cls, name: str, unit: str, values: "Iterable[Cell] | np.ndarray") -> "Column":
        """Return a column from anything that holds values.

        Returns with plain values; None in place of what is not finite.
        """
        plain = values.tolist() if isinstance(values, np.ndarray) else list(values)
        return cls(name, unit, [None if isinstance(one, float) and not math.isfinite(one) else one for one in plain])

    @property
    def head(self) -> str:
        """Name with unit, as it stands above the column."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def is_text(self) -> bool:
        """Whether the column holds words."""
        return any(isinstance(value, str) for value in self.values)

    @property
    def numbers(self) -> np.ndarray:
        """Values as numbers; NaN, which MATLAB and netCDF mean by missing, where there is nothing."""
        return np.array([np.nan if value is None else float(value) for value in self.values], dtype=np.float64)

    @property
    def words(self) -> list[str]:
        """Values as words; empty where there is nothing."""
        return ["" if value is None else str(value) for value in self.values]


@dataclass(frozen=True)
class Sheet:
    """A table."""

    name: str  # what it is called; letters, digits, spaces and dashes
    columns: Sequence[Column]  # all of one length
    about: dict[str, str] = field(default_factory=dict)  # what it belongs to

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.columns[0].values)

    @property
    def rows(self) -> "Iterable[tuple[Cell, ...]]":
        """The rows."""
        return zip(*(column.values for column in self.columns), strict=True)

    @property
    def variable(self) -> str:
        """Name that MATLAB and netCDF take."""
        return re.sub(r"\W+", "_", self.name).strip("_") or "table"
