"""What goes wrong, as the client is told it: one kind, one sentence, never a traceback."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import ClassVar

from rocking.errors import BodyFileError, GeometryError, MissingExtraError, RecordError, RockingError, UnknownModelError

INTERNAL = "something went wrong; its trace is in the server's log"
_KINDS: tuple[tuple[type[RockingError], str], ...] = (
    (UnknownModelError, "unknown-model"),
    (GeometryError, "geometry"),
    (BodyFileError, "body-file"),
    (RecordError, "record"),
    (MissingExtraError, "missing-extra"),
    (RockingError, "invalid-value"),
)
_BY_STATUS = {
    401: "forbidden",
    403: "forbidden",
    404: "not-found",
    413: "too-large",
    429: "busy",
    503: "busy",
    507: "no-room",
}


class Problem(RockingError):  # noqa: N818 - the names of the subclasses are what is said of them
    """Base of what the server itself refuses.

    seconds: time after which another try makes sense [s].
    """

    status: ClassVar[int] = 422
    kind: ClassVar[str] = "invalid-value"

    def __init__(self, message: str, *, needs: Sequence[str] = (), seconds: float | None = None) -> None:
        super().__init__(message)
        self.needs = tuple(needs)
        self.seconds = seconds


class Refused(Problem):
    """The input is not allowed."""


class Busy(Problem):
    """Too much is asked at once."""

    status = 429
    kind = "busy"


class TooLarge(Problem):
    """More is asked than one server takes."""

    status = 413
    kind = "too-large"


class NoRoom(Problem):
    """The disk of the server takes nothing more."""

    status = 507
    kind = "no-room"


class Ending(Problem):
    """The server ends, and the computation with it."""

    status = 503
    kind = "busy"


class NotFound(Problem):
    """There is no such thing."""

    status = 404
    kind = "not-found"


class NotAllowed(Problem):
    """Somebody asks who may not."""

    status = 403
    kind = "forbidden"


class NotSignedIn(NotAllowed):
    """Nobody is signed in."""

    status = 401


class WrongContent(Problem):
    """The body of the request is of a type that nothing here takes."""

    status = 415


class WrongMethod(Problem):
    """The method is one that nothing here takes."""

    status = 405


class BadRequest(Problem):
    """The request is not what a browser or a script sends."""

    status = 400


def status_and_kind(error: RockingError) -> tuple[int, str]:
    """Return how an error is told."""
    if isinstance(error, Problem):
        return error.status, error.kind
    return 422, next(kind for family, kind in _KINDS if isinstance(error, family))


def kind_of_status(status: int) -> str:
    """Return the kind of a problem of which only the status is known."""
    return _BY_STATUS.get(status, "internal" if status >= 500 else "invalid-value")


@contextmanager
def room_on_disk() -> Iterator[None]:
    """Turn what a disk says that takes nothing more into a sentence for whoever sent the file."""
    try:
        yield
    except OSError as error:  # its own words name files of the server
        why = error.strerror or "it cannot be written"
        raise NoRoom(
            f"the disk of the server does not take the file: {why}; make room there, then send it again"
        ) from error
