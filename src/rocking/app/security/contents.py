"""Types of request bodies: JSON or a file's bytes, nothing that a form on another page could send."""

from rocking.app.problems import WrongContent
from rocking.app.security.asked import Asked

JSON = "application/json"
BYTES = "application/octet-stream"


def content_type(asked: Asked) -> str:
    """Return the type of a body without its parameters.

    Returns lower case; empty if none is given.
    """
    return asked.headers.get("content-type", "").partition(";")[0].strip().lower()


def check_content(asked: Asked) -> None:
    """Refuse bodies of other types, in another charset, or packed."""
    kind = content_type(asked)
    if asked.headers.get("content-encoding", "identity").lower() != "identity":
        raise WrongContent("the body must not be compressed")
    if (asked.has_body or kind) and asked.unsafe and kind not in {JSON, BYTES}:
        raise WrongContent(f"Content-Type must be {JSON}, or {BYTES} for a file")
    parameters = asked.headers.get("content-type", "").partition(";")[2].replace(" ", "").lower()
    if kind == JSON and parameters not in {"", "charset=utf-8", 'charset="utf-8"'}:
        raise WrongContent("JSON must be in UTF-8")
