"""The application: gate, endpoints and pages."""

import os
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from fastapi import Depends, FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.staticfiles import StaticFiles

from rocking.bodies.formats.words import from_pydantic
from rocking.errors import RockingError
from rocking.language import page_words
from rocking.restitution.from_file import register_own
from rocking.version import __version__
from rocking_workbench.answers import ERRORS, JsonAnswer, describe_api, error_answer, refusal
from rocking_workbench.api import body, contact_bed, impact, info, motion, records, response
from rocking_workbench.downloads import documents, tables
from rocking_workbench.errors import kind_of_status
from rocking_workbench.pages import FILES, PAGES, STATIC, page_answer
from rocking_workbench.projects import router as projects
from rocking_workbench.projects.store import ProjectStore
from rocking_workbench.questions import router as questions
from rocking_workbench.questions.desk import QuestionDesk
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.runner import Runner
from rocking_workbench.security import sessions as session
from rocking_workbench.security.gate import Failures, Gate, SafeHeaders
from rocking_workbench.security.request_body import BodyLimits
from rocking_workbench.security.sessions import Sessions
from rocking_workbench.settings import AppState, ServerSettings
from rocking_workbench.studies import router as studies
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.work import ComputationQueue

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

_SAME_AS = {"model_attributes_type": "model_type", "int_parsing": "int_type", "float_parsing": "float_type"}
_READING = threading.Lock()
_WORDS = {404: "not found", 405: "the method is not allowed here"}
_MANUALS = (Path(__file__).parent / "manual", Path(__file__).parents[3] / "build" / "manual")  # packaged or built
_ABOUT = """\
The same API serves the pages of `rocking serve`, scripts and MATLAB. Numbers are float64 in SI units, with all digits.

Every request of a script needs the header `Authorization: Bearer KEY`. The file `api-key` in the data folder contains
KEY. Each start of the server creates a new KEY. Every POST or DELETE also needs `Origin: {origin}`, the address of the
server. Errors are `{{"error": {{"kind", "message", ...}}}}`. `message` is a sentence. Its components are `parameter`,
`text` with its `facts`, `hint`, `places` and `more`."""


def refused_input(error: ValidationError | RequestValidationError) -> RockingError:
    """Return the first validation error as an error of this package."""
    errors: list[dict[str, Any]] = [dict(item) for item in error.errors()]
    for item in errors:
        if item["loc"] and item["loc"][0] in {"body", "query", "path", "header"}:
            item["loc"] = tuple(item["loc"][1:])
        item["type"] = _SAME_AS.get(item["type"], item["type"])
    if errors and errors[0]["loc"] == ():
        errors[0]["loc"] = ("the body of the request",)
    match getattr(error, "body", None):
        case {"body": {"units": stated}} if errors and errors[0]["loc"][0] == "body":
            units = stated
        case _:
            units = None
    return from_pydantic(cast("list[ErrorDetails]", errors), units)


def _invalid(error: ValidationError | RequestValidationError) -> JsonAnswer:
    return refusal(refused_input(error))


def _refused(error: HTTPException) -> JsonAnswer:
    answer = error_answer(
        error.status_code, kind_of_status(error.status_code), _WORDS.get(error.status_code, str(error.detail))
    )
    answer.headers.update(error.headers or {})
    return answer


def _handler(answer: Callable[[Any], JsonAnswer]) -> Callable[[Request, Exception], Awaitable[JsonAnswer]]:
    # async without a worker thread, because the server does not wait for threads at shutdown
    async def handle(request: Request, error: Exception) -> JsonAnswer:
        return answer(error)

    return handle


def _read_own_models() -> None:
    with _READING:
        register_own()


async def _own_models() -> None:
    """Load the current restitution models of the user; raise an error for invalid models."""
    if os.environ.get("ROCKING_MODELS"):
        await run_in_threadpool(_read_own_models)


async def _own_models_if_sound() -> None:
    with suppress(RockingError):
        await _own_models()


def create_app(settings: ServerSettings) -> FastAPI:
    """Return the application with all pages and endpoints behind the gate."""
    app = FastAPI(
        title="rocking",
        version=__version__,
        description=_ABOUT.format(origin=settings.origin),
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/openapi.json",
        redirect_slashes=False,
        separate_input_output_schemas=False,
        default_response_class=JsonAnswer,
        generate_unique_id_function=lambda route: str(route.name),
        lifespan=_lifespan,
        middleware=[
            Middleware(SafeHeaders),
            Middleware(Failures),
            Middleware(Gate, settings=settings),
            Middleware(BodyLimits, limits=settings.limits),
        ],
    )
    app.add_route(f"/{FILES.fingerprint}/{{name:path}}", FILES.respond, include_in_schema=False)
    limits = settings.limits
    store = RecordStore(settings.folder, limits)
    files = RecordStore(settings.folder, limits, "files", forgets=True)  # each run keeps its files
    runner = Runner()
    app.state.rocking = AppState(
        settings=settings,
        records=store,
        files=files,
        projects=ProjectStore(settings.folder, limits),
        questions=QuestionDesk(settings.folder, (files, store), limits, runner),
        studies=StudyManager(settings.folder, limits, store, runner, workers=settings.workers),
        sessions=Sessions(limits, kept=settings.folder / "sessions.json"),
        heavy=ComputationQueue(limits.heavy_at_once, limits.heavy_waiting),
    )
    app.add_exception_handler(RockingError, _handler(refusal))
    app.add_exception_handler(RequestValidationError, _handler(_invalid))
    app.add_exception_handler(ValidationError, _handler(_invalid))
    app.add_exception_handler(HTTPException, _handler(_refused))
    of_results = (tables, documents, projects, questions, studies)
    computed = {impact, response, tables, documents}
    for module in (session, info, body, impact, contact_bed, records, motion, response, *of_results):
        dependencies = [Depends(_own_models if module in computed else _own_models_if_sound)]
        app.include_router(
            module.router, responses=ERRORS, dependencies=dependencies if module in {*computed, info, studies} else []
        )
    describe_api(app)
    _add_pages(app)
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    yield
    app.state.rocking.heavy.close()
    app.state.rocking.studies.close()
    app.state.rocking.questions.close()
    app.state.rocking.projects.close()


def _add_pages(app: FastAPI) -> None:
    @app.api_route("/words/{code}.json", methods=["GET", "HEAD"], include_in_schema=False)
    def words(code: str) -> JsonAnswer:
        return JsonAnswer(page_words(code))

    for address in PAGES:
        app.add_route(address, page_answer, include_in_schema=False)
    built = next((folder for folder in _MANUALS if (folder / "index.html").exists()), STATIC / "manual")
    app.mount("/manual", StaticFiles(directory=built, html=True), name="manual")
    app.mount("/", StaticFiles(directory=STATIC, html=True), name="pages")
