"""Errors and hints with the options of the command line, and --set for keys without an option."""

from contextvars import ContextVar

import typer

from rocking.errors import (
    BodyFileError,
    InvalidValueError,
    MeasurementError,
    RecordError,
    RockingError,
    UnknownModelError,
)
from rocking.messages import Fact, Message, Option, Parameter, Spelling


class UsageError(InvalidValueError):
    """The arguments of a command are invalid; the message ends with a reference to the help of the command."""


_OF_ARGUMENTS = (InvalidValueError, UnknownModelError, BodyFileError, RecordError, MeasurementError)
_RUNNING: ContextVar[typer.Context | None] = ContextVar("the command that runs", default=None)
_KEYS = {"restitution.model": "restitution"}  # keys of options with another name


def run_in(context: typer.Context) -> None:
    """Set the running command. Messages then contain the names of its options."""
    _RUNNING.set(context)


def spelled(message: Message | RockingError | str) -> str:
    """Return a message or an error with the options of the running command."""
    context = _RUNNING.get()
    if context is None:
        return str(message)
    if isinstance(message, RockingError):
        return message.spelt(spelling(context), within=False)
    return message.spelt(spelling(context)) if isinstance(message, Message) else message


def help_hint(context: typer.Context | None = None) -> Message:
    """Return a reference to the help of a command, by default of the running command."""
    context = context or _RUNNING.get()
    return Message("see {command} --help", {"command": "rocking" if context is None else context.command_path})


def with_help(error: RockingError) -> RockingError:
    """Return an error, with a reference to the help of the running command unless a file has the invalid value."""
    if isinstance(error, _OF_ARGUMENTS) and not any(location.kind == "file" for location in error.places):
        error.add_hint(help_hint())
    return error


def no_command() -> None:
    """Remove the command that ran before in this process."""
    _RUNNING.set(None)


def spelling(context: typer.Context) -> Spelling:
    """Return the spelling of parameters and options in messages of a command."""

    def text_of(fact: Fact) -> str:
        if isinstance(fact, Option):
            return _stated(context, fact)
        if isinstance(fact, Parameter):
            return _named(context, fact)
        return str(fact)

    return text_of


def _stated(context: typer.Context, option: Option) -> str:
    """Return an option with its value: --units g, or --set motion.skip=3."""
    value = {True: "true", False: "false"}.get(option.value, option.value)
    if option.name in context.params and not _is_of_another_table(option):
        return f"--{option.name.replace('_', '-')}{'' if value is None else f' {value}'}"
    key = f"{option.path}={'' if value is None else value}"
    return f"--set {key}" if "sets" in context.params else key


def _named(context: typer.Context, parameter: Parameter) -> str:
    """Return the typed option of a parameter, or its key if typed with --set, or otherwise its name."""
    if any(text.partition("=")[0].strip() == parameter.path for text in context.params.get("sets") or ()):
        return parameter.path
    name = _KEYS.get(parameter.path, parameter.name)
    if name not in context.params or _is_of_another_table(parameter):
        return str(parameter)
    return next(iter(typed(context, name)), str(parameter))


def _is_of_another_table(fact: Option | Parameter) -> bool:
    """Return True for a name of a body option in a table that is not of a body."""
    from rocking.bodies.formats.schema import BLOCK_KEYS

    return fact.name in BLOCK_KEYS and fact.path.partition(".")[0] not in {"body", "block", fact.path}


def typed(context: typer.Context, *names: str) -> list[str]:
    """Return the options of those parameters that were typed."""
    labels = {"record": "second argument", "motions": "second argument", "sets": "--set"}
    sources = {name: context.get_parameter_source(name) for name in names}
    return [
        labels.get(name, f"--{name.replace('_', '-')}")
        for name, source in sources.items()
        if source is not None and source.name == "COMMANDLINE"
    ]
