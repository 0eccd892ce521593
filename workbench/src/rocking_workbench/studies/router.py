"""Endpoints of studies: launch, progress, cancel, resume, results and export."""

import asyncio
import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, get_args

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel, ConfigDict, Field
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response
from starlette.websockets import WebSocket, WebSocketDisconnect

from rocking.errors import RockingError
from rocking_workbench.answers import MEDIA_TYPES, Deleted, JsonAnswer, answered, answered_with_file, attachment_headers
from rocking_workbench.plain_text import safe_name
from rocking_workbench.settings import state_of
from rocking_workbench.studies.answers import HistoryAnswer, Launched, Studies, StudyFacts, StudyResult
from rocking_workbench.studies.finished import Crossing, Kind
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.studies.study import HostedStudy
from rocking_workbench.studies.study_folder import StudyFolder
from rocking_workbench.work import heavy

router = APIRouter(prefix="/api/studies", tags=["studies"])
_JOB = """\
The tables of a job file (`rocking.examples`) as JSON. Records are named by the SHA-256 under which they were
uploaded, `{"records": ["64 hexadecimal digits"]}`; bodies are given as they are, not by the names of files."""
Whole = Annotated[int, Field(ge=0, le=10_000_000)]
_ONE = answered(StudyFacts, "State and progress.")
SHORTEST = 0.2  # smallest interval between two messages [s]
MOST = 64  # largest number of connected browsers
_TRY_LATER = 1013


class StudyRequest(BaseModel):
    """A study to launch."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    name: Annotated[str | None, Field(max_length=200, description="name; default: name in the job")] = None
    job: Annotated[dict[str, Any], Field(description=_JOB)]
    project: Annotated[str, Field(max_length=40, description="project of the study")] = ""


class PointRequest(BaseModel):
    """A point of a study: indices along its axes."""

    model_config = ConfigDict(extra="forbid")

    x: Whole = 0
    y: Whole = 0
    restitution: Whole = 0
    motion: Annotated[Whole, Field(description="index of the motion; ignored if the motion is an axis of the map")] = 0
    points: Annotated[int, Field(ge=10, le=2000, description="pixels of the curves")] = 1000


@router.post(
    "",
    status_code=202,
    summary="Launch a study",
    description=_JOB,
    responses=answered(Launched, "The item is queued.", 202),
)
async def create_study(request: Request, study: StudyRequest) -> JsonAnswer:
    """Put a study in the queue."""
    if study.project:
        await run_in_threadpool(state_of(request).projects.get, study.project)
    name = await heavy(request, _studies(request).create, study.name, study.job, study.project)
    return JsonAnswer({"id": name}, status_code=202)


@router.get("", summary="All studies", responses=answered(Studies, "The studies."))
async def list_studies(request: Request) -> JsonAnswer:
    """Return all studies, newest first."""
    return JsonAnswer({"studies": _studies(request).overview()})


@router.websocket("/live")
async def live_studies(socket: WebSocket) -> None:
    """Send the list of studies at every change."""
    await serve(state_of(socket).studies, socket)


@router.get("/{study}", summary="One study", responses=_ONE)
async def get_study(request: Request, study: str) -> JsonAnswer:
    """Return state and progress of a study."""
    return JsonAnswer(_studies(request).get(study))


@router.post("/{study}/cancel", summary="Stop a study; it can be resumed", responses=_ONE)
async def cancel_study(request: Request, study: str) -> JsonAnswer:
    """Stop a study within a second."""
    await run_in_threadpool(_studies(request).cancel, study)
    return JsonAnswer(_studies(request).get(study))


@router.post("/{study}/resume", summary="Resume a study", responses=_ONE)
async def resume_study(request: Request, study: str) -> JsonAnswer:
    """Put a study in the queue again."""
    await run_in_threadpool(_studies(request).resume, study)
    return JsonAnswer(_studies(request).get(study))


@router.delete(
    "/{study}", summary="Delete a study and its results", responses=answered(Deleted, "Identifier of the deleted item.")
)
async def delete_study(request: Request, study: str) -> JsonAnswer:
    """Delete a study."""
    await run_in_threadpool(_studies(request).delete, study)
    return JsonAnswer({"deleted": study})


@router.get(
    "/{study}/result",
    summary="Result of a study; its form depends on the kind of the study",
    responses=answered(StudyResult, "The result."),
)
async def study_result(request: Request, study: str) -> Response:
    """Return the result of a finished study."""
    manager = _studies(request)
    manager.finished(study)
    cached = manager.answers.known((study, "result"))
    data = cached if cached is not None else await heavy(request, _result, manager, study)
    return Response(data, media_type="application/json")


@router.get(
    "/{study}/cell",
    summary="Simulation of a point of a study",
    responses=answered(HistoryAnswer, "The simulation."),
)
async def study_cell(request: Request, study: str, point: Annotated[PointRequest, Query()]) -> Response:
    """Return inputs and response of one simulation of a finished study."""
    manager = _studies(request)
    manager.finished(study)
    return Response(await heavy(request, _cell, manager, study, point), media_type="application/json")


@router.get(
    "/{study}/export.{kind}",
    summary="A finished study as a file",
    response_class=Response,
    responses=answered_with_file("The study.", *get_args(Kind)),
)
async def export_study(
    request: Request,
    study: str,
    kind: Kind,
    what: Annotated[
        str | None,
        Query(
            max_length=40,
            description="content of the file, as CONTENT in `rocking campaign export --output CONTENT=FILE`",
        ),
    ] = None,
    restitution: Annotated[Whole, Query(description="index of the restitution whose curves are exported")] = 0,
    crossing_curves: Annotated[Crossing | None, Query(description="treatment of crossing fragility curves")] = None,
) -> Response:
    """Return a finished study as a file."""
    manager = _studies(request)
    name = safe_name(f"{manager.get(study)['name']}.{kind}", "study")
    path = await heavy(request, _file, manager, study, kind, what, restitution, crossing_curves)
    return FileResponse(
        path,
        media_type=MEDIA_TYPES[kind],
        headers=attachment_headers(name),
        background=BackgroundTask(shutil.rmtree, path.parent, ignore_errors=True),
    )


def _studies(request: Request) -> StudyManager:
    return state_of(request).studies


@contextmanager
def _there(manager: StudyManager, study: str) -> Iterator[StudyFolder]:
    """Raise `NotFound` if the study is deleted during the access."""
    folder = manager.finished(study)
    try:
        yield folder
    except (OSError, RockingError):
        manager.finished(study)
        raise


def _result(manager: StudyManager, study: str) -> bytes:
    from rocking_workbench.studies.results import keep_result, kept_result

    with _there(manager, study) as folder:
        return manager.answers.get((study, "result"), lambda: kept_result(folder) or keep_result(manager.open(folder)))


def _cell(manager: StudyManager, study: str, point: PointRequest) -> bytes:
    from rocking_workbench.studies.history_at_point import HistoryPlace, cell_of

    with _there(manager, study) as folder:
        opened = manager.open(folder)
        history_point = HistoryPlace.of(opened, point.x, point.y, point.restitution, point.motion)
        key = (study, "cell", history_point.number, point.points)
        return manager.answers.get(key, lambda: bytes(JsonAnswer(cell_of(opened, history_point, point.points)).body))


def _file(
    manager: StudyManager,
    study: str,
    kind: Kind,
    content: str | None,
    restitution: int,
    crossing_curves: Crossing | None,
) -> Path:
    from rocking_workbench.studies.finished import written

    path = Path(tempfile.mkdtemp(prefix="rocking-export-")) / f"study.{kind}"
    try:
        with _there(manager, study) as folder:
            written(manager.open(folder), kind, path, content, restitution, crossing_curves)
    except BaseException:
        shutil.rmtree(path.parent, ignore_errors=True)
        raise
    return path


async def serve(manager: StudyManager, socket: WebSocket) -> None:
    """Send the list of studies now and after every change, until the browser disconnects."""
    loop, changed = asyncio.get_running_loop(), asyncio.Event()

    def tell() -> None:
        with contextlib.suppress(RuntimeError):  # the server has ended
            loop.call_soon_threadsafe(changed.set)

    async def send() -> None:
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):  # the browser disconnected during a message
            while True:
                changed.clear()
                await socket.send_text(bytes(JsonAnswer({"studies": manager.overview()}).body).decode())
                await changed.wait()
                await asyncio.sleep(SHORTEST)

    if len(manager.queue.listeners) >= MOST:
        await socket.close(_TRY_LATER)
        return
    manager.queue.listeners.add((HostedStudy, tell))
    try:
        await socket.accept()
        sending = asyncio.create_task(send())
        try:
            while (await socket.receive())["type"] != "websocket.disconnect":
                pass  # messages of the browser are ignored
        finally:
            sending.cancel()
    except (WebSocketDisconnect, RuntimeError):  # the browser disconnected early
        pass
    finally:
        manager.queue.listeners.discard((HostedStudy, tell))
