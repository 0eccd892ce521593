"""Errors and hints in the words of the command line: its own options, and --set for keys without one."""

from contextvars import ContextVar

import typer

from rocking.errors import RockingError
from rocking.messages import Fact, Message, Option, Parameter, Spelling


class RefusedCommandError(Exception):
    """A command is refused; its text names what was typed."""


_RUNNING: ContextVar[typer.Context | None] = ContextVar("the command that runs", default=None)
_KEYS = {"restitution.model": "restitution"}  # options by keys whose last part they do not have for a name


def run_in(context: typer.Context) -> None:
    """Let messages name options as the command of a context has them."""
    _RUNNING.set(context)


def spelled(message: Message | RockingError | str) -> str:
    """Return a message or an error as the command that runs spells it."""
    context = _RUNNING.get()
    if context is None:
        return str(message)
    if isinstance(message, RockingError):
        return message.spelt(spelling(context), within=False)
    return message.spelt(spelling(context)) if isinstance(message, Message) else message


def no_command() -> None:
    """Forget the command that ran before in this process."""
    _RUNNING.set(None)


def spelling(context: typer.Context) -> Spelling:
    """Return how a command spells what a message names."""

    def spelt(fact: Fact) -> str:
        if isinstance(fact, Option):
            return _stated(context, fact)
        if isinstance(fact, Parameter):
            return _named(context, fact)
        return str(fact)

    return spelt


def _stated(context: typer.Context, option: Option) -> str:
    """Return an option as it is typed: --units g, or --set motion.skip=3."""
    value = {True: "true", False: "false"}.get(option.value, option.value)
    if option.name in context.params and not _is_of_another_table(option):
        return f"--{option.name.replace('_', '-')}{'' if value is None else f' {value}'}"
    key = f"{option.path}={'' if value is None else value}"
    return f"--set {key}" if "sets" in context.params else key


def _named(context: typer.Context, parameter: Parameter) -> str:
    """Return the option that was typed for a parameter, or its key if --set states it; its name otherwise."""
    if any(text.partition("=")[0].strip() == parameter.path for text in context.params.get("sets") or ()):
        return parameter.path
    name = _KEYS.get(parameter.path, parameter.name)
    if name not in context.params or _is_of_another_table(parameter):
        return str(parameter)
    return next(iter(typed(context, name)), str(parameter))


def _is_of_another_table(fact: Option | Parameter) -> bool:
    """Return whether a fact has the name of an option of bodies, but is of no body."""
    from rocking.bodies.formats.schema import BLOCK_KEYS

    return fact.name in BLOCK_KEYS and fact.path.partition(".")[0] not in {"body", "block", fact.path}


def typed(context: typer.Context, *names: str) -> list[str]:
    """Return which of some parameters were typed, as they are spelt."""
    spelt = {"record": "second word", "motions": "second word", "sets": "--set"}
    sources = {name: context.get_parameter_source(name) for name in names}
    return [
        spelt.get(name, f"--{name.replace('_', '-')}")
        for name, source in sources.items()
        if source is not None and source.name == "COMMANDLINE"
    ]
