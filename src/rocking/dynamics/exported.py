"""What of a response goes into files: samples, tables beside them, and what was computed from what."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.quantities import QUANTITIES, Quantity, attributes


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """Values of one kind, and what they are.

    >>> Column.of("rotation", np.zeros(2)).attributes
    {'units': 'rad', 'long_name': 'rotation theta, positive clockwise'}
    """

    values: np.ndarray  # numbers, or words
    unit: str = ""  # "1" for numbers without one; empty for words
    attributes: dict[str, Any] = field(default_factory=dict)  # as xarray and netCDF name them

    @classmethod
    def of(cls, name: str, values: np.ndarray) -> "Column":
        """Return values of what has an entry in `rocking.quantities`."""
        return cls(values, QUANTITIES[name].unit, attributes(name))

    @classmethod
    def said(cls, values: np.ndarray, unit: str, meaning: str) -> "Column":
        """Return values that are known here alone."""
        return cls(values, unit, Quantity("", unit, meaning).attributes)


@dataclass(frozen=True, slots=True, eq=False)
class Exported:
    """Everything that the files of one response hold."""

    samples: dict[str, Column]  # by name, all of one length, ``time`` among them
    # by what one row is (``impact``, ``interval``): name to `Column`
    tables: dict[str, dict[str, Column]] = field(default_factory=dict)
    # what was computed from what: numbers, words, and lists of numbers
    provenance: dict[str, Any] = field(default_factory=dict)

    @property
    def headed(self) -> dict[str, np.ndarray]:
        """Samples by headings such as ``rotation [rad]``; ``[-]`` for numbers without a unit, nothing for words."""
        units = {name: "-" if one.unit == "1" else one.unit for name, one in self.samples.items()}
        return {f"{name} [{units[name]}]" if units[name] else name: q.values for name, q in self.samples.items()}


def told(motion: Any) -> str:
    """Return where a motion comes from.

    >>> told(None)
    'ground at rest'
    """
    return "ground at rest" if motion is None else "; ".join(getattr(motion, "provenance", ())) or repr(motion)
