"""Endpoints of long runs and their files: upload, queue, progress, stop and export."""

import json
from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response

from rocking_workbench.answers import (
    FILE_SENT,
    MEDIA_TYPES,
    Deleted,
    JsonAnswer,
    Refusal,
    answered,
    answered_with_file,
    attachment_headers,
    shape,
    shape_of,
)
from rocking_workbench.api.records import RecordKept
from rocking_workbench.questions.desk import OUTPUTS, Command, HostedQuestion, QuestionDesk
from rocking_workbench.settings import state_of

router = APIRouter(prefix="/api", tags=["questions"])
_TABLES = """\
The tables of a file that the command of the same name takes, as JSON; those of `equilibria` and `cor` have a table
`response` beside `body`, and `simulate` is of a body in space with friction; `paper` has none. Files in them are named
as in `files`, and were sent to `/api/files` or `/api/records`."""
QuestionFacts: Any = shape_of(
    HostedQuestion, "QuestionFacts", without=("starts",), refusal=(Refusal | None, "reason of a refusal, as data")
)
Questions: Any = shape("Questions", "All runs, newest first.", questions=list[QuestionFacts])
WholeQuestion: Any = shape(
    "WholeQuestion",
    "A run and its answer.",
    QuestionFacts,
    toml=(str, "inputs of the run, as an input file"),
    answer=(Any, "output of the command with --json, or null"),
)


class NewQuestion(BaseModel):
    """A new run."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    command: Command
    tables: Annotated[dict[str, Any], Field(description=_TABLES)]
    files: Annotated[
        dict[str, str],
        Field(description="SHA-256 of each file, by its name in the tables; records/NAME in a folder"),
    ] = Field(default_factory=dict)
    name: Annotated[str, Field(max_length=200, description="display name")] = ""
    project: Annotated[str, Field(max_length=40, description="project of the run")] = ""
    format: Annotated[str, Field(max_length=20, description="additional output format of convert")] = ""


def _desk(request: Request) -> QuestionDesk:
    return state_of(request).questions


def _facts(question: HostedQuestion) -> dict[str, Any]:
    return {key: value for key, value in asdict(question).items() if key != "starts"}


@router.post("/files", openapi_extra=FILE_SENT, summary="Send a file", responses=answered(RecordKept, "The file."))
async def add_file(request: Request, name: Annotated[str, Query(max_length=500)] = "file") -> JsonAnswer:
    """Store a scan, sound, list or table by hash; the run reads the file."""
    content = await request.body()
    return JsonAnswer(asdict(await run_in_threadpool(state_of(request).files.add, content, name)))


@router.post(
    "/questions", status_code=202, summary="Queue a run", responses=answered(QuestionFacts, "The item is queued.", 202)
)
async def ask_question(request: Request, item: NewQuestion) -> JsonAnswer:
    """Queue a run. Its answer is the output of the command with --json."""
    if item.project:
        await run_in_threadpool(state_of(request).projects.get, item.project)
    question = await run_in_threadpool(
        _desk(request).ask, item.command, item.tables, item.files, item.name, item.project, item.format
    )
    return JsonAnswer(_facts(question), status_code=202)


@router.get("/questions", summary="All runs", responses=answered(Questions, "The runs."))
async def list_questions(request: Request) -> JsonAnswer:
    """Return all runs, newest first."""
    await run_in_threadpool(_desk(request).prepare)
    return JsonAnswer({"questions": [*map(_facts, _desk(request).all())]})


@router.get("/questions/{question}", summary="One run", responses=answered(WholeQuestion, "The run."))
async def get_question(request: Request, question: str) -> JsonAnswer:
    """Return a run, and its answer if finished."""

    def whole() -> dict[str, Any]:
        desk = _desk(request)
        run = desk.get(question)  # read the state once, because the run may finish a moment later
        answer = desk.answer(question) if run.state == "done" else None
        return {
            **_facts(run), "toml": desk.tables(question), "answer": None if answer is None else json.loads(answer)
        }  # fmt: skip

    return JsonAnswer(await run_in_threadpool(whole))


@router.post("/questions/{question}/stop", summary="Stop a run", responses=answered(QuestionFacts, "Stopped."))
async def stop_question(request: Request, question: str) -> JsonAnswer:
    """Stop a running or queued run."""
    return JsonAnswer(_facts(await run_in_threadpool(_desk(request).stop, question)))


@router.delete("/questions/{question}", summary="Delete a run", responses=answered(Deleted, "The deleted run."))
async def delete_question(request: Request, question: str) -> JsonAnswer:
    """Delete a run and its answer."""
    await run_in_threadpool(_desk(request).delete, question)
    return JsonAnswer({"deleted": question})


_ENDINGS = sorted({"dat", *(name.rpartition(".")[2] for names in OUTPUTS.values() for name in names)})


@router.get(
    "/questions/{question}/{file}",
    summary="An output file",
    response_class=Response,
    responses=answered_with_file("The file.", *_ENDINGS),
)
async def question_file(request: Request, question: str, file: str) -> Response:
    """Return a picture, report or table of a run."""
    path = await run_in_threadpool(_desk(request).file, question, file)
    name = f"{_desk(request).get(question).name} {file}"
    media = MEDIA_TYPES.get(file.rpartition(".")[2], MEDIA_TYPES["dat"])
    return FileResponse(path, media_type=media, headers=attachment_headers(name))
