"""What of a response goes into files: samples, tables beside them, and what was computed from what."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """Values of one kind with their unit and meaning.

    >>> Quantity(np.zeros(2), "rad", "rotation").attributes
    {'units': 'rad', 'long_name': 'rotation'}
    """

    values: np.ndarray  # numbers, or words; shape (n,)
    unit: str = ""  # unit, "1" for numbers without one; empty for words
    words: str = ""  # what it is; empty where the name says it

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and meaning, as xarray and netCDF name them."""
        return {key: value for key, value in (("units", self.unit), ("long_name", self.words)) if value}


@dataclass(frozen=True, slots=True, eq=False)
class Exported:
    """Everything that the files of one response hold."""

    samples: dict[str, Quantity]  # by name, all of one length, ``time`` among them
    # by what one row is (``impact``, ``interval``): name to `Quantity`
    tables: dict[str, dict[str, Quantity]] = field(default_factory=dict)
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
