"""The uploaded records: POST, GET and DELETE /api/records."""

from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath

from rocking.app.answers import JsonAnswer
from rocking.app.api.record_file import Looked, Told
from rocking.app.api.uploads import OCTETS
from rocking.app.records import RecordStore
from rocking.app.schemas.answers.answer import answered
from rocking.app.schemas.answers.records import Deleted, RecordFacts, RecordKept
from rocking.app.state import state_of
from rocking.app.work import heavy
from rocking.errors import RecordError

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
    content, told = await request.body(), Told(format, units, time_step)
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
    told = Told(format, units, time_step)
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


def _added(records: RecordStore, content: bytes, name: str, told: Told) -> dict[str, Any]:
    records.check_upload(content)
    looked = _read(content, name, told)
    return {**asdict(records.add(content, name)), **looked.facts()}


def _looked(records: RecordStore, record: str, told: Told) -> dict[str, Any]:
    stored = records.get(record)
    return {**asdict(stored), **_read(records.content(record), stored.file_name, told).facts()}


def _read(content: bytes, name: str, told: Told) -> Looked:
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
