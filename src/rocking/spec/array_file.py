"""Motions in one NumPy array file (.npz): one array of accelerations per motion."""

import zipfile
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion

SUFFIX = ".npz"
MOST_BYTES = 1 << 30
"""Largest size of an array file after decompression [byte]."""

_HOW = (
    "an array file contains one 1-D array per motion, and optionally NAME_unit, the factor to m/s2 of the array NAME, "
    "and time_step or NAME_time_step [s]"
)


class ArrayFile:
    """Accelerations by name in a .npz file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @cached_property
    def names(self) -> frozenset[str]:
        """Names of all arrays."""
        try:
            with zipfile.ZipFile(self.path) as archive:
                size = sum(item.file_size for item in archive.infolist())
                names = frozenset(name.removesuffix(".npy") for name in archive.namelist())
        except (OSError, zipfile.BadZipFile) as error:
            raise InvalidValueError("The file is not a readable array file", hint=_HOW).at(self.path.name) from error
        if size > MOST_BYTES:
            raise InvalidValueError("an array file must be smaller than {limit} MiB", limit=MOST_BYTES >> 20).at(
                self.path.name
            )
        return names

    def motion(self, name: str, keys: Mapping[str, Any]) -> GroundMotion:
        """Return the motion of an array. `keys` contains units and time_step if the file does not contain them."""
        samples = np.asarray(self._array(name), dtype=np.float64)
        if samples.ndim != 1:
            raise InvalidValueError("array {name!r:.60} must be 1-D, got shape {shape}", name=name, shape=samples.shape,
                                    hint=_HOW)  # fmt: skip
        metadata = {"file": self.path.name, "array": name}
        return GroundMotion(samples * self._factor(name, keys), self._step(name, keys), name=name, metadata=metadata)

    def _factor(self, name: str, keys: Mapping[str, Any]) -> float:
        """Return the factor of an array to m/s2."""
        if f"{name}_unit" in self.names:
            return self._number(f"{name}_unit")
        if (units := keys.get("units")) is None:
            raise InvalidValueError("array {name!r:.60} has no unit", name=name, hint="add motion.units")
        return ACCELERATION_UNITS[checks.one_of("units", units, ACCELERATION_UNITS)]

    def _step(self, name: str, keys: Mapping[str, Any]) -> float:
        """Return the time step of an array [s]."""
        own = next((key for key in (f"{name}_time_step", "time_step") if key in self.names), None)
        stated = keys.get("time_step")
        step = stated if own is None else self._number(own)
        if step is None:
            raise InvalidValueError("array {name!r:.60} has no time step", name=name, hint="add motion.time_step")
        if own is not None and stated is not None and abs(stated - step) > 1e-9 * step:
            raise InvalidValueError(
                "{parameter} is {value}, but the array file contains {step}", parameter="motion.time_step",
                value=stated, step=step,
            )  # fmt: skip
        return float(step)

    def _number(self, name: str) -> float:
        values = np.asarray(self._array(name), dtype=np.float64)
        if values.size != 1:
            raise InvalidValueError("array {name!r:.60} must be one number", name=name, hint=_HOW)
        return checks.positive(name, float(values.ravel()[0]))

    def _array(self, name: str) -> Any:
        if name not in self.names:
            raise InvalidValueError(
                "The array {name!r:.60} is not in {file}", name=name, file=self.path.name, hint=_HOW
            )
        try:
            with np.load(self.path, allow_pickle=False) as arrays:
                values = arrays[name]
        except (OSError, ValueError, zipfile.BadZipFile) as error:
            raise InvalidValueError("array {name!r:.60} is damaged or no array of numbers", name=name).at(
                self.path.name
            ) from error
        if values.dtype.kind not in "iuf":
            raise InvalidValueError("array {name!r:.60} must contain numbers", name=name, hint=_HOW)
        return values
