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
    """What the endpoints share.

    Parameters
    ----------
    settings : Settings
        What the server was told.
    records : RecordStore
        Uploaded records.
    studies : StudyManager
        Campaigns that run, wait or are done.
    sessions : Sessions
        Who is signed in.
    heavy : WaitingLine
        Threads for long computations.
    """

    settings: Settings
    records: "RecordStore"
    studies: "StudyManager"
    sessions: "Sessions"
    heavy: WaitingLine


def state_of(request: HTTPConnection) -> AppState:
    """Return what the endpoints share.

    Parameters
    ----------
    request : HTTPConnection
        A request or a websocket.

    Returns
    -------
    AppState
        The same object for every request of an application.
    """
    return cast("AppState", request.app.state.rocking)
