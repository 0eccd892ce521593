"""Settings of the server, and the shared state of its endpoints."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, cast

from starlette.requests import HTTPConnection

from rocking.evidence.store import data_folder
from rocking_workbench.work import ComputationQueue

if TYPE_CHECKING:
    from rocking_workbench.projects.store import ProjectStore
    from rocking_workbench.questions.desk import QuestionDesk
    from rocking_workbench.records import RecordStore
    from rocking_workbench.security.sessions import Sessions
    from rocking_workbench.studies.manager import StudyManager

MEBIBYTE = 1 << 20
LOOPBACK = ("127.0.0.1", "localhost", "::1")
DEFAULT_PORT = 8765


@dataclass(frozen=True)
class Limits:
    """Limits of one server."""

    upload_bytes: int = 32 * MEBIBYTE  # largest accepted file [bytes]
    project_bytes: int = 128 * MEBIBYTE  # largest file of a project [bytes]
    json_bytes: int = 2 * MEBIBYTE  # largest JSON document [bytes]
    json_depth: int = 32  # deepest nesting of a JSON document
    bytes_in_flight: int = 256 * MEBIBYTE  # largest total size of the request bodies in memory [bytes]
    body_seconds: float = 30.0  # time limit for the transfer of a request body [s]
    target_bytes: int = 4096  # longest path and query of a request [bytes]
    records_bytes: int = 1024 * MEBIBYTE  # disk for uploaded records [bytes]
    studies_bytes: int = 8192 * MEBIBYTE  # disk for studies [bytes]
    questions_bytes: int = 8192 * MEBIBYTE  # disk for questions [bytes]
    projects_bytes: int = 4096 * MEBIBYTE  # disk for all states of all projects [bytes]
    histories: int = 2_000_000  # largest study [histories]
    studies_waiting: int = 8  # studies that may wait in the queue
    heavy_at_once: int = 2  # threads for long computations
    heavy_waiting: int = 32  # long computations that may wait in the queue
    wrong_tokens: int = 10  # number of wrong tokens per minute before sign-in is blocked
    session_seconds: float = 12 * 3600.0  # idle time after which a browser must sign in again [s]


@dataclass(frozen=True)
class ServerSettings:
    """Settings of the server at its start."""

    host: str = "127.0.0.1"  # address to listen on
    port: int = DEFAULT_PORT  # port to listen on
    folder: Path = field(default_factory=data_folder)  # data folder: records, studies, the key for scripts
    allow_remote: bool = False  # True to allow addresses that are accessible from other machines
    workers: int | None = None  # processes per study; None for the default of campaigns
    limits: Limits = Limits()  # size limits

    @property
    def origin(self) -> str:
        """Return the address of the page, without a path."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}"


@dataclass(frozen=True)
class AppState:
    """Shared state of the endpoints."""

    settings: ServerSettings  # settings of the server
    records: "RecordStore"  # uploaded records
    files: "RecordStore"  # other uploaded files: scans, sounds, lists
    projects: "ProjectStore"  # saved projects
    questions: "QuestionDesk"  # long computations
    studies: "StudyManager"  # running, queued and finished campaigns
    sessions: "Sessions"  # sessions of browsers
    heavy: ComputationQueue  # threads for long computations


def state_of(request: HTTPConnection) -> AppState:
    """Return the shared state of the endpoints."""
    return cast("AppState", request.app.state.rocking)
