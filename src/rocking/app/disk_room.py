"""What is said when the disk does not take what was sent."""

from collections.abc import Iterator
from contextlib import contextmanager

from rocking.app.problems import NoRoom


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
