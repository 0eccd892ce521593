"""What the shapes of answers share, and how an endpoint declares what it answers."""

from typing import Any

from pydantic import BaseModel, ConfigDict


class Answer(BaseModel):
    """A table of an answer: it has these keys and no others.

    The shapes describe; nothing is checked against them when a request is answered, which would cost more than the
    answer itself where the series are long. The tests check every one of them.
    """

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


def answered(shape: Any, words: str, status: int = 200) -> dict[int | str, dict[str, Any]]:
    """Return what an endpoint declares of an answer in JSON."""
    return {status: {"model": shape, "description": words}}


def answered_with_file(words: str, *media_types: str) -> dict[int | str, dict[str, Any]]:
    """Return what an endpoint declares of a file that it answers with."""
    name = {"schema": {"type": "string"}, "description": "attachment, with a harmless name of the file"}
    return {
        200: {
            "description": words,
            "headers": {"Content-Disposition": name},
            "content": {
                kind.partition(";")[0]: {"schema": {"type": "string", "format": "binary"}} for kind in media_types
            },
        }
    }
