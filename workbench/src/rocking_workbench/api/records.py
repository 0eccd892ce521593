"""Uploaded records: POST, GET and DELETE /api/records; content and missing data of a file."""

from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath

from rocking import GroundMotion
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, RecordError
from rocking.messages import Message, Option
from rocking.motions.formats import Component, Record, formats, read_record
from rocking.motions.formats.miniseed import STATIONS
from rocking_workbench.answers import FILE_SENT, Deleted, JsonAnswer, Messages, answered, shape, shape_of
from rocking_workbench.errors import room_on_disk
from rocking_workbench.inputs import check_record, check_samples
from rocking_workbench.plain_text import safe_name
from rocking_workbench.records import RecordStore, StoredRecord
from rocking_workbench.settings import state_of
from rocking_workbench.work import heavy

_STAND_IN = {"units": "m/s2", "time_step": 0.01}  # with substitutes, all missing values are found at once
_QUIETEST = 1e-100  # smaller accelerations are refused: in any unit, their squares vanish in floating point
_ORDER = ("format", "units", "time_step", "component")
router = APIRouter(prefix="/api/records", tags=["records"])
_STATIONS = b"<FDSNStationXML"
_WAY = (
    "drop both files together, or add both files in the step “Records”, add the step “response” and choose the "
    "StationXML"
)
Need = Literal["format", "units", "time_step", "component"]
Word = Annotated[str | None, Query(min_length=1, max_length=200)]
Step = Annotated[float | None, Query(gt=0.0, allow_inf_nan=False, description="s")]
Sha = Annotated[str, InPath(min_length=1, max_length=200, description="SHA-256")]

RecordKept: Any = shape_of(StoredRecord, "RecordKept")
ComponentFacts: Any = shape(
    "ComponentFacts",
    "One component of a record; null for data missing in the file.",
    name=str,
    samples=int,
    unit=(str | None, "of acceleration in the file"),
    time_step=float | None,
    duration=float | None,
    peak_ground_acceleration=(float | None, "largest acceleration"),
)
RecordFacts: Any = shape(
    "RecordFacts",
    "Content of a record file and its missing data.",
    RecordKept,
    messages=Messages,
    format=(str | None, "null if no format is detected"),
    components=list[ComponentFacts],
    needs=(list[Need], "data required before use"),
    choices=(dict[Need, list[str]], "allowed values"),
    message=(str, "reason as a sentence; empty if no data are missing"),
    doubts=(str, "contradictions of header and data, or resampling; empty if none"),
)


@router.post(
    "",
    summary="Send a record file",
    responses=answered(RecordFacts, "The content of the file."),
    openapi_extra=FILE_SENT,
)
async def add_record(
    request: Request,
    name: Annotated[str, Query(max_length=500)] = "record",
    format: Word = None,
    units: Word = None,
    time_step: Step = None,
) -> JsonAnswer:
    """Store a record file of any format, and return its properties.

    `record` of the answer is its SHA-256, the reference in the inputs. `needs` lists the missing options (`units`,
    `time_step`, `component`, `format`), and `choices` their allowed values. Send the file again with these options. An
    unreadable file is refused and not stored.
    """
    content, stated = await request.body(), _stated(format, units, time_step)
    return JsonAnswer(await heavy(request, _added, state_of(request).records, content, name, stated))


@router.get("", summary="All record files", responses=answered(list[RecordKept], "The files."))
def list_records(request: Request) -> JsonAnswer:
    """Return the stored records, newest first."""
    return JsonAnswer([asdict(record) for record in state_of(request).records.stored()])


@router.get(
    "/{record}", summary="Content of a record file", responses=answered(RecordFacts, "The content of the file.")
)
async def look_at_record(
    request: Request, record: Sha, format: Word = None, units: Word = None, time_step: Step = None
) -> JsonAnswer:
    """Return the content and missing data of a stored file; `time_step` is for a file without time step [s]."""
    stated = _stated(format, units, time_step)
    return JsonAnswer(await heavy(request, _looked, state_of(request).records, record, stated))


@router.delete("/{record}", summary="Remove a record file", responses=answered(Deleted, "The deleted record."))
def delete_record(request: Request, record: Sha) -> JsonAnswer:
    """Return the hash of the deleted record."""
    state_of(request).records.delete(record)
    return JsonAnswer({"deleted": record})


def _stated(format: str | None, units: str | None, time_step: float | None) -> dict[str, Any]:
    return {"format": format, "units": units, "time_step": time_step}


def _added(records: RecordStore, content: bytes, name: str, stated: dict[str, Any]) -> dict[str, Any]:
    records.check_upload(content)
    facts = record_facts(content, name, stated)
    return {**asdict(records.add(content, name)), **facts}


def _looked(records: RecordStore, record: str, stated: dict[str, Any]) -> dict[str, Any]:
    stored = records.get(record)
    return {**asdict(stored), **record_facts(records.content(record), stored.file_name, stated)}


def record_facts(content: bytes, name: str, stated: dict[str, Any]) -> dict[str, Any]:
    """Return the content of a file; `stated` contains format, units and time_step [s], or None."""
    if _STATIONS in content[:4096]:
        raise RecordError(
            ("{name}: a StationXML file describes an instrument and contains no motion; {way}"),
            name=name,
            way=_WAY,
        )
    check_record(content)
    try:
        with TemporaryDirectory(prefix="rocking-") as folder:
            path = Path(folder) / safe_name(name, "record")
            with room_on_disk():
                path.write_bytes(content)
            record, reasons = _read(path, stated)
    except RecordError as error:
        if error.hint is not STATIONS:
            raise
        message = "the samples are instrument counts; the instrument response is in a separate StationXML file"
        raise RecordError(message, hint=_WAY).at(name) from error
    components = [] if record is None else record.components
    choices = {
        "format": list(formats()),
        "units": list(ACCELERATION_UNITS),
        "component": [component.name for component in components],
    }
    return {
        "format": None if record is None else record.format,
        "components": [_component(component, reasons) for component in components],
        "needs": sorted(reasons, key=_ORDER.index),
        "choices": {name: choices[name] for name in reasons if name in choices},
        "message": f"{safe_name(name, 'record')}: {'; '.join(reasons.values())}" if reasons else "",
        "doubts": "" if record is None else record.metadata.get("doubts", ""),
    }


def _read(path: Path, stated: dict[str, Any]) -> tuple[Record | None, dict[str, str]]:
    """Return a record with substitutes for missing options, and the reasons for these options.

    The record is None if the format is missing.
    """
    stated, reasons = dict(stated), {}
    while True:
        try:
            record = read_record(path, **stated)
        except RecordError as error:
            missing = _to_state(error)
            if missing is None or stated.get(missing, missing) is not None:
                raise
            reasons[missing] = error.without_file(path.name).cause
            if missing not in _STAND_IN:
                return None, reasons
            stated[missing] = _STAND_IN[missing]
        else:
            break
    check_samples(sum(component.acceleration.size for component in record.components))
    _check_motions(record, path.name, unit_is_known="units" not in reasons)
    if len(record.components) > 1:
        names = ", ".join(component.name for component in record.components)
        reasons["component"] = Message(
            "the file has the components {names}; choose the horizontal component", {"names": names}
        )
    return record, reasons


def _to_state(error: RecordError) -> str | None:
    """Return the missing option of an error; None for any other error."""
    option = error.hint.facts.get("option") if isinstance(error.hint, Message) else None
    return option.name if isinstance(option, Option) else None


def _component(component: Component, missing: dict[str, str]) -> dict[str, Any]:
    unit, step = "units" not in missing, "time_step" not in missing
    return {
        "name": component.name,
        "samples": int(component.acceleration.size),
        "unit": component.unit if unit else None,
        "time_step": component.time_step if step else None,
        "duration": (component.acceleration.size - 1) * component.time_step if step else None,
        "peak_ground_acceleration": component.peak * ACCELERATION_UNITS[component.unit] if unit else None,
    }


def _check_motions(record: Record, name: str, *, unit_is_known: bool) -> None:
    """Refuse implausible motions, in the unit of the file or in the smallest unit."""
    if max(component.peak for component in record.components) < _QUIETEST:
        raise RecordError("{name}: the acceleration is zero throughout", name=name)
    for component in record.components:
        factor = ACCELERATION_UNITS[component.unit] if unit_is_known else min(ACCELERATION_UNITS.values())
        with np.errstate(over="ignore"):  # an overflow gives infinity, which is refused
            values = component.acceleration * factor
        try:
            GroundMotion(values, component.time_step)
        except InvalidValueError as error:
            raise error.copied(RecordError).at(f"{name}, {component.name}") from error
