"""What the endpoints share: one object on the application."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from starlette.requests import HTTPConnection

from rocking.app.settings import Settings
from rocking.app.work import WaitingLine

if TYPE_CHECKING:
    from rocking.app.records import RecordStore
    from rocking.app.security.tokens import Sessions
    from rocking.app.studies.manager import StudyManager


@dataclass(frozen=True)
class AppState:
    """What the endpoints share."""

    settings: Settings  # what the server was told
    records: "RecordStore"  # uploaded records
    studies: "StudyManager"  # campaigns that run, wait or are done
    sessions: "Sessions"  # who is signed in
    heavy: WaitingLine  # threads for long computations


def state_of(request: HTTPConnection) -> AppState:
    """Return what the endpoints share.

    Returns the same object for every request of an application.
    """
    return cast("AppState", request.app.state.rocking)
