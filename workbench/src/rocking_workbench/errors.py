"""Errors for clients: status, kind and sentence, without a traceback."""

import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rocking.errors import BodyFileError, GeometryError, MissingExtraError, RecordError, RockingError, UnknownModelError

INTERNAL = "internal error; the log of the server contains the traceback"
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
    409: "conflict",
    413: "too-large",
    414: "too-large",
    429: "busy",
    431: "too-large",
    503: "busy",
    507: "no-room",
}


class Refused(RockingError):  # noqa: N818 - the names of the subclasses are what is said of them
    """A refusal with an HTTP status; `seconds` is the waiting time before a retry [s]."""

    status = 422

    def __init__(
        self,
        text: str = "",
        *,
        status: int | None = None,
        needs: Sequence[str] = (),
        seconds: float | None = None,
        **parts: Any,
    ) -> None:
        super().__init__(text, **parts)
        self.status = self.status if status is None else status
        self.needs = tuple(needs)
        self.seconds = seconds


class NotFound(Refused):
    """Not found."""

    status = 404


class Conflict(Refused):
    """Another client changed the object first."""

    status = 409


class TooLarge(Refused):
    """The request exceeds a limit of the server."""

    status = 413


class Busy(Refused):
    """Too many requests at the same time."""

    status = 429


class NoRoom(Refused):
    """The disk of the server is full."""

    status = 507


def kind_of(error: RockingError) -> str:
    """Return the kind of an error of the library."""
    return next(kind for family, kind in _KINDS if isinstance(error, family))


def kind_of_status(status: int) -> str:
    """Return the kind of an error from its HTTP status."""
    return _BY_STATUS.get(status, "internal" if status >= 500 else "invalid-value")


@contextmanager
def room_on_disk() -> Iterator[None]:
    """Raise `NoRoom` for errors of the disk."""
    try:
        yield
    except OSError as error:  # the text of this error names files of the server
        raise NoRoom(
            "the server cannot store the file: {reason}", reason=error.strerror or "not writable",
            hint="free disk space, then send the file again",
        ) from error  # fmt: skip


def check_room(folder: Path, needed: int, limit: int, items: str) -> None:
    """Refuse results larger than the free space on the disk or in their quota [bytes]."""
    used = 0
    for folder_path, _, names in os.walk(folder):
        for name in names:
            with suppress(OSError):  # files may be deleted meanwhile
                used += Path(folder_path, name).lstat().st_size
    room = min(shutil.disk_usage(folder).free, limit - used)
    if needed > room:
        raise TooLarge(
            "the results need about {needed:.1f} MB, {free:.1f} MB are free; delete {items} that are no longer needed",
            needed=needed / 1e6, free=max(room, 0) / 1e6, items=items,
        )  # fmt: skip
