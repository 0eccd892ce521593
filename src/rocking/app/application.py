"""The application: gate, endpoints, pages, put together."""

import mimetypes
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from fastapi import FastAPI
from fastapi.routing import APIRoute
from starlette.middleware import Middleware
from starlette.responses import FileResponse
from starlette.staticfiles import StaticFiles

from rocking import __version__
from rocking.app.answers import JsonAnswer
from rocking.app.api import body, impact, info, motion, records, response
from rocking.app.handlers import install_handlers
from rocking.app.records import RecordStore
from rocking.app.schemas.error import ERRORS, describe_api
from rocking.app.security import session
from rocking.app.security.failures import Failures
from rocking.app.security.gate import Gate
from rocking.app.security.headers import SafeHeaders
from rocking.app.security.limits import BodyLimits
from rocking.app.security.tokens import Sessions
from rocking.app.settings import Settings
from rocking.app.state import AppState
from rocking.app.studies import router as studies
from rocking.app.studies.manager import StudyManager
from rocking.app.takeaway import documents, pictures, tables
from rocking.app.work import WaitingLine

STATIC = Path(__file__).parent / "static"
_ABOUT = """\
The same API serves the pages of `rocking serve`, scripts and MATLAB. Numbers are SI, float64, with every digit.

A script sends with every request `Authorization: Bearer KEY`, where KEY stands in the file `api-key` of the data
folder and is new at every start, and with every POST or DELETE also `Origin: {origin}`, the server's
own address. Errors are `{{"error": {{"kind", "message"}}}}`."""


def create_app(settings: Settings) -> FastAPI:
    """Return the application.

    Returns every page and every endpoint, behind the gate.
    """
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
        generate_unique_id_function=_operation,
        lifespan=_lifespan,
        middleware=[
            Middleware(SafeHeaders),
            Middleware(Failures),
            Middleware(Gate, settings=settings),
            Middleware(BodyLimits, limits=settings.limits),
        ],
    )
    app.state.rocking = _state(settings)
    install_handlers(app)
    _add_endpoints(app)
    _add_pages(app)
    return app


def _add_endpoints(app: FastAPI) -> None:
    for router in (
        session.router,
        info.router,
        body.router,
        impact.router,
        records.router,
        motion.router,
        response.router,
        pictures.router,
        tables.router,
        documents.router,
        studies.router,
    ):
        app.include_router(router, responses=ERRORS)
    describe_api(app)


def _state(settings: Settings) -> AppState:
    limits = settings.limits
    store = RecordStore(settings.folder, limits)
    return AppState(
        settings=settings,
        records=store,
        studies=StudyManager(settings.folder, limits, store, workers=settings.workers),
        sessions=Sessions(limits),
        heavy=WaitingLine(limits.heavy_at_once, limits.heavy_waiting),
    )


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    yield
    app.state.rocking.heavy.close()
    app.state.rocking.studies.close()


def _operation(route: APIRoute) -> str:
    return route.name


def _add_pages(app: FastAPI) -> None:
    for kind, suffix in (("text/javascript", ".js"), ("text/css", ".css"), ("image/svg+xml", ".svg")):
        mimetypes.add_type(kind, suffix)  # the registry of some systems says text/plain, which browsers then refuse

    @app.get("/api-docs", include_in_schema=False)
    def api_docs() -> FileResponse:
        return FileResponse(STATIC / "api-docs.html")

    app.mount("/", StaticFiles(directory=STATIC, html=True), name="pages")
