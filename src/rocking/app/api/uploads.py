"""Files that were sent: a body file becomes the body of the inputs."""

import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rocking.app.disk_room import room_on_disk
from rocking.app.files import safe_name
from rocking.app.problems import Refused
from rocking.app.schemas.body import BodyInput
from rocking.app.schemas.caps import check_file
from rocking.app.schemas.toml_text import parsed_toml
from rocking.bodies.formats import read_body
from rocking.bodies.formats.body_writer import body_to_toml
from rocking.bodies.formats.source import blamed
from rocking.errors import BodyFileError

OCTETS: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
"""What the schema of an endpoint says that takes a file."""


def body_in_file(content: bytes, name: str, units: str | None, density: float | None) -> BodyInput:
    """Return the body that a file describes.

    density: density of what has none of its own, in a drawing [kg/m3].
    """
    shown = safe_name(name, "body")
    check_file(content, shown)
    if shown.lower().endswith(".toml"):
        return _toml(content, shown, units)
    with TemporaryDirectory(prefix="rocking-") as folder:
        path = Path(folder) / shown
        with room_on_disk():
            path.write_bytes(content)
        body = read_body(path, units=units, density=density)
    return BodyInput.model_validate({**tomllib.loads(body_to_toml(body)), "name": Path(shown).stem})


def _toml(content: bytes, name: str, units: str | None) -> BodyInput:
    with blamed(name):
        try:
            given = parsed_toml(content.decode("utf-8-sig"))
        except (UnicodeDecodeError, Refused) as error:
            raise BodyFileError(f"is not TOML that can be read: {str(error).partition(';')[0]}") from error
        if "body" in given and isinstance(given["body"], dict):
            given = given["body"]
        if units is not None and given.get("units", units) != units:
            raise BodyFileError(f"states units = {given['units']!r:.20}, but units = {units!r} was asked for")
    return BodyInput.model_validate(given)
