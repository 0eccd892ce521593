"""Methods and paths that a browser or a script of ours sends; everything else is refused before it is looked at."""

import re

from rocking.app.problems import BadRequest, NotFound, Problem, WrongMethod
from rocking.app.security.asked import SAFE, Asked

_METHODS = SAFE | {"POST", "DELETE", "WEBSOCKET"}
_PATH = re.compile(r"(/[A-Za-z0-9_-][A-Za-z0-9._-]*)+/?|/")


class TooLong(Problem):
    """The path or the query is longer than any that is needed."""

    status = 414
    kind = "too-large"


def check_method(asked: Asked) -> None:
    """Refuse methods that nothing here takes; OPTIONS too, as no other site may ask."""
    if asked.method not in _METHODS:
        raise WrongMethod("the method must be GET, HEAD, POST or DELETE")
    if asked.method in SAFE and asked.has_body:
        raise BadRequest(f"a {asked.method} request has no body")


def check_target(asked: Asked, most: int) -> None:
    """Refuse paths with anything but plain letters, digits, dots, dashes and slashes.

    most: longest path and query [bytes].
    """
    if len(asked.target) + len(asked.query) > most:
        raise TooLong(f"path and query are longer than {most} bytes")
    if not _PATH.fullmatch(asked.target):
        raise NotFound("there is no such page: its path has characters that none here has")
