"""The uploaded records: POST, GET and DELETE /api/records; what a file holds, and what it leaves open."""

from dataclasses import asdict, dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath

from rocking.app.answers import JsonAnswer, safe_name
from rocking.app.api.body import OCTETS
from rocking.app.errors import room_on_disk
from rocking.app.records import RecordStore
from rocking.app.schemas.answers import Deleted, RecordFacts, RecordKept, answered
from rocking.app.schemas.inputs import check_record, check_samples
from rocking.app.settings import state_of
from rocking.app.work import heavy
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
router = APIRouter(prefix="/api/records", tags=["records"])
_ABOUT = """\
The content of a record file of any format. `record` of the answer is its SHA-256, by which the inputs name it; `needs`
says what must still be told (`units`, `time_step`, `component`, `format`), `choices` what may be said. The same file
can be sent again with what was missing; a file that no format can read is refused and not kept."""
_STATIONS = b"<FDSNStationXML"
_WAY = (
    "this page takes no StationXML. Turn counts into m/s2 in Python and send the file that is written: "
    'record = MiniSeed.with_response("station.xml").read(Source.of_path(Path("counts.mseed"))), then '
    'write_record(record, "motion.mseed", "miniseed"); write_record is in rocking.motions.formats, MiniSeed and Source '
    "in its modules miniseed and source"
)
Word = Annotated[str | None, Query(min_length=1, max_length=200)]


@dataclass(frozen=True, slots=True)
class RecordOptions:
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
    def at(cls, content: bytes, name: str, told: RecordOptions) -> "Looked":
        """Look at a file."""
        check_record(content)
        with TemporaryDirectory(prefix="rocking-") as folder:
            path = Path(folder) / safe_name(name, "record")
            with room_on_disk():
                path.write_bytes(content)
            return cls._of(path, told)

    @classmethod
    def _of(cls, path: Path, told: RecordOptions) -> "Looked":
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


@router.post(
    "",
    summary="Send a record file",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(RecordFacts, "What the file holds."),
    openapi_extra=OCTETS,
)
async def add_record(
    request: Request,
    name: Annotated[str, Query(max_length=500)] = "record",
    format: Word = None,
    units: Word = None,
    time_step: Annotated[float | None, Query(gt=0.0, allow_inf_nan=False, description="s")] = None,
) -> JsonAnswer:
    """Answer with what the file holds and what must still be told.

    time_step: step between samples, where the file does not state it [s].
    """
    content, told = await request.body(), RecordOptions(format, units, time_step)
    return JsonAnswer(await heavy(request, _added, state_of(request).records, content, name, told))


@router.get(
    "",
    summary="All record files",
    description="What is kept, the latest first.",
    response_class=JsonAnswer,
    responses=answered(list[RecordKept], "The files."),
)
def list_records(request: Request) -> JsonAnswer:
    """Answer with what is kept, the latest first."""
    return JsonAnswer([asdict(made) for made in state_of(request).records.stored()])


@router.get(
    "/{record}",
    summary="What a record file holds",
    description="As when it was sent.",
    response_class=JsonAnswer,
    responses=answered(RecordFacts, "What the file holds."),
)
async def look_at_record(
    request: Request,
    record: Annotated[str, InPath(min_length=1, max_length=200, description="SHA-256")],
    format: Word = None,
    units: Word = None,
    time_step: Annotated[float | None, Query(gt=0.0, allow_inf_nan=False, description="s")] = None,
) -> JsonAnswer:
    """Answer with what a kept file holds and what must still be told.

    time_step: step between samples, where the file does not state it [s].
    """
    told = RecordOptions(format, units, time_step)
    return JsonAnswer(await heavy(request, _looked, state_of(request).records, record, told))


@router.delete(
    "/{record}",
    summary="Remove a record file",
    description="Gone, from memory too.",
    response_class=JsonAnswer,
    responses=answered(Deleted, "What is no longer kept."),
)
def delete_record(
    request: Request, record: Annotated[str, InPath(min_length=1, max_length=200, description="SHA-256")]
) -> JsonAnswer:
    """Answer with the hash of what is no longer kept."""
    state_of(request).records.delete(record)
    return JsonAnswer({"deleted": record})


def _added(records: RecordStore, content: bytes, name: str, told: RecordOptions) -> dict[str, Any]:
    records.check_upload(content)
    looked = _read(content, name, told)
    return {**asdict(records.add(content, name)), **looked.facts()}


def _looked(records: RecordStore, record: str, told: RecordOptions) -> dict[str, Any]:
    stored = records.get(record)
    return {**asdict(stored), **_read(records.content(record), stored.file_name, told).facts()}


def _read(content: bytes, name: str, told: RecordOptions) -> Looked:
    if _STATIONS in content[:4096]:
        raise RecordError(
            f"{name}: this is a StationXML file, which describes an instrument and holds no motion; {_WAY}"
        )
    try:
        return Looked.at(content, name, told)
    except RecordError as error:
        if "with_response" not in str(error):
            raise
        words = f"{name}: the samples are counts of the instrument, whose response lies in a StationXML file of its own"
        raise RecordError(f"{words}; {_WAY}") from error
