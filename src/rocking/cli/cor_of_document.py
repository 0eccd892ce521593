"""The body of `rocking cor` in a file that says a whole response, as the application gives one to take away."""

from pathlib import Path
from typing import Any

from rocking.bodies import Body
from rocking.cli.solid_options import spelt
from rocking.errors import InvalidValueError
from rocking.spec.document import SettingsTable
from rocking.spec.fields import JobTable
from rocking.spec.parts import body_of
from rocking.spec.reading import InputFiles, located, read_text, validated


class BodyOfDocument(JobTable):
    """The tables of such a file of which only the body and the settings are looked at."""

    body: dict[str, Any]
    settings: SettingsTable = SettingsTable()
    response: Any = None
    motion: Any = None
    restitution: Any = None


def body_and_gravity(path: Path, size: dict[str, object]) -> tuple[Body, float | None]:
    """Return the body of a file with a table [response], and the gravity that it states.

    Returns gravity: acceleration of gravity, None if the file states none [m/s2].
    """
    given = [name for name, value in spelt(size).items() if value is not None]
    if given:
        raise InvalidValueError(f"{path} has a table [body] and says everything itself, so it takes no {given[0]}")
    with located(str(path)):
        document = validated(BodyOfDocument, read_text(path))
        with located("body"):
            body = body_of(document.body, InputFiles(path.parent))
    return body, document.settings.gravity


def sentence(path: Path) -> str:
    """Return what is not used of such a file."""
    return f"{path.name}: body and gravity are taken from it; everything else it says is for `rocking simulate`."
