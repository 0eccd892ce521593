"""What a record file holds, and what must still be told before it can be read."""

from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from rocking.app.disk_room import room_on_disk
from rocking.app.files import safe_name
from rocking.app.schemas.caps import check_record, check_samples
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import formats, read_record
from rocking.motions.formats.record import Component, Record
from rocking.motions.motion import GroundMotion

_STAND_IN = {"units": "m/s2", "time_step": 0.01}
"""What stands for an answer that is missing, to find out what else is."""

_QUIETEST = 1e-100
"""Smaller accelerations have no energy: their squares vanish in floating point, whatever the unit."""

_FOR_PROGRAMS = "; say "
"""What follows in the words of the library names an argument; people see the choices instead."""

_ORDER = ("format", "units", "time_step", "component")


@dataclass(frozen=True, slots=True)
class Told:
    """What a user says about a file."""

    format: str | None = None  # format, units: name of the format and unit of acceleration
    units: str | None = None
    time_step: float | None = None  # step between samples [s]


@dataclass(frozen=True)
class Looked:
    """What was found in a file."""

    record: Record | None  # the file, read with stand-ins for what is missing; None if its format must be told first
    needs: list[str] = field(default_factory=list)  # what must still be told
    message: str = ""  # why, in the reader's words

    @classmethod
    def at(cls, content: bytes, name: str, told: Told) -> "Looked":
        """Look at a file."""
        check_record(content)
        with TemporaryDirectory(prefix="rocking-") as folder:
            path = Path(folder) / safe_name(name, "record")
            with room_on_disk():
                path.write_bytes(content)
            return cls._of(path, told)

    @classmethod
    def _of(cls, path: Path, told: Told) -> "Looked":
        given: dict[str, Any] = {"format": told.format, "units": told.units, "time_step": told.time_step}
        needs: list[str] = []
        reasons: list[str] = []
        while True:
            try:
                record = read_record(path, **given)
            except RecordError as error:
                missing = next((key for key in given if f"say {key}=" in str(error) and given[key] is None), None)
                if missing is None:
                    raise
                needs.append(missing)
                reasons.append(str(error).partition(_FOR_PROGRAMS)[0])
                if missing not in _STAND_IN:
                    return cls(None, needs, reasons[0])
                given[missing] = _STAND_IN[missing]
            else:
                check_samples(sum(part.acceleration.size for part in record.components))
                _check_motions(record, path.name, unit_is_known="units" not in needs)
                if len(record.components) > 1:
                    needs.append("component")
                    names = ", ".join(part.name for part in record.components)
                    reasons.append(f"the file has the components {names}: choose the horizontal one")
                return cls(record, needs, reasons[0] if reasons else "")

    def facts(self) -> dict[str, Any]:
        """Return what was found, as the API tells it.

        Returns ``format``, ``components``, ``needs``, ``choices`` for them and ``message``.
        """
        parts = () if self.record is None else self.record.components
        choices: dict[str, list[str]] = {
            "format": list(formats()),
            "units": list(ACCELERATION_UNITS),
            "component": [part.name for part in parts],
        }
        return {
            "format": None if self.record is None else self.record.format,
            "components": [self._component(part) for part in parts],
            "needs": sorted(self.needs, key=_ORDER.index),
            "choices": {name: choices[name] for name in self.needs if name in choices},
            "message": self.message,
        }

    def _component(self, part: Component) -> dict[str, Any]:
        unit, step = "units" not in self.needs, "time_step" not in self.needs
        return {
            "name": part.name,
            "samples": int(part.acceleration.size),
            "unit": part.unit if unit else None,
            "time_step_s": part.time_step if step else None,
            "duration_s": (part.acceleration.size - 1) * part.time_step if step else None,
            "peak_m_s2": part.peak * ACCELERATION_UNITS[part.unit] if unit else None,
        }


def _check_motions(record: Record, name: str, *, unit_is_known: bool) -> None:
    """Refuse what no ground does: in its unit, or while that is not told in the smallest one."""
    if max(part.peak for part in record.components) < _QUIETEST:
        raise RecordError(f"{name}: the acceleration is zero throughout; is this the right file?")
    for part in record.components:
        factor = ACCELERATION_UNITS[part.unit] if unit_is_known else min(ACCELERATION_UNITS.values())
        with np.errstate(over="ignore"):  # what overflows is infinite, and refused
            values = part.acceleration * factor
        try:
            GroundMotion(values, part.time_step)
        except InvalidValueError as error:
            raise RecordError(f"{name}, {part.name}: {error}") from error
