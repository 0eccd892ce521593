"""`rocking simulate FILE.toml`: one file that says body, motion, restitutions and settings."""

from pathlib import Path

import typer

from rocking.cli.simulate_output import ResponseComparison
from rocking.errors import InvalidValueError

_OUTPUTS = {"body", "picture", "animation", "csv", "mat", "netcdf", "as_json"}


def path_of(context: typer.Context) -> Path | None:
    """Return the file that says everything, if the command was given one: a TOML file with a table [response].

    Returns none if the first word is something else.
    """
    from rocking.spec.reading import is_response

    word = context.params.get("body")
    if word is None or not is_response(Path(word)):
        return None
    given = [name for name in context.params if name not in _OUTPUTS and typed(context, name)]
    if given:
        names = ", ".join("a second word" if name == "record" else f"--{name.replace('_', '-')}" for name in given)
        raise InvalidValueError(f"{word} has a table [response] and says everything itself, so it takes no {names}")
    return Path(word)


def answer_of(path: Path) -> ResponseComparison:
    """Return the answer to what a file asks.

    Returns the response with the first restitution, and with the others that the file lists.
    """
    from rocking.spec.response import ResponseJob

    return ResponseComparison.of_choices(ResponseJob.read(path).question)


def typed(context: typer.Context, name: str) -> bool:
    """Return whether an option was typed.

    Returns false where its value is the default.
    """
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"
