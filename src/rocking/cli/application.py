"""The commands and their help; a command is imported when it is called, all of them for the list."""

from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import getdoc
from pkgutil import iter_modules
from typing import Any

import typer
from typer.core import TyperGroup

from rocking import spec
from rocking.cli.completion import words_on_the_line
from rocking.cli.help import Command, with_common
from rocking.version import SOFTWARE

ABOUT = "Predict rocking and overturning of bodies in earthquakes."
GROUPS = {
    "Assess": {
        "assess": "Assess overturning: margin, uncertainty, measures.",
        "predict": "Compute probabilities of rocking and overturning.",
        "fragility": "Compute fragility curves of rocking and overturning.",
        "inventory": "Assess a list of objects at one intensity level.",
        "code-checks": "Compare code methods with time histories.",
        "validate-predictions": "Compare predictions with measured outcomes.",
    },
    "Respond": {
        "simulate": "Simulate rocking; compare restitution models.",
        "map": "Compute an overturning map over two parameters.",
        "overturning-pga": "Find every PGA interval with overturning.",
        "spectrum": "Compute the rocking spectrum of ground motions.",
        "histories": "Simulate many motions, scale factors and models.",
        "equilibria": "Find the stable poses and energy barriers of a solid.",
    },
    "Long-run dynamics": {
        "bifurcation": "Compute a bifurcation diagram under harmonic motion.",
        "orbits": "Follow periodic orbits and find their bifurcations.",
        "lyapunov": "Compute Lyapunov exponents under harmonic motion.",
        "basins": "Compute basins of overturning and their erosion.",
    },
    "Restitution": {
        "restitution": "Compute coefficients of restitution of a body.",
        "identify": "Identify the coefficient from a measurement.",
        "models": "List the restitution models.",
        "measurements": "Add and list measurements; calibrate models.",
        "reproduce": "Recompute the results of a paper.",
    },
    "Records": {
        "record": "Show, convert, process and select records.",
    },
    "Run": {
        "serve": "Start the web application on this machine.",
        "campaign": "Compute a large study; stop and resume it.",
        "examples": "List examples; run an example in this folder.",
    },
}
"""Commands by group, and what each does; the command itself is imported when it is called."""
RECORD = {
    "show": "Show a record or a pulse: intensity measures and response spectrum.",
    "batch": "Compute the intensity measures and spectra of many records; select and scale records.",
    "convert": "Write a record in another format; apply processing steps.",
    "formats": "List the record formats.",
}
SUBCOMMANDS = ("record", "measurements", "campaign")
_GENERIC = {"histories", "bifurcation", "orbits", "lyapunov", "basins"}  # from the table of the study
_MODULES = {"assess": "predict", "models": "catalogues", "record formats": "catalogues"}


def commands() -> dict[str, str]:
    """Return every command with its summary."""
    return {name: summary for group in GROUPS.values() for name, summary in group.items()}


def added_studies() -> dict[str, str]:
    """Return the studies that are files of `rocking.spec.questions` alone, by kind, and what each is."""
    files = {module.name for module in iter_modules([f"{folder}/questions" for folder in spec.__path__])}
    known = {*commands(), "minimum", "long_run"}  # the table of overturning-pga, and four commands
    if files <= known:  # the questions themselves take long to be imported
        return {}
    from rocking.spec.questions import questions

    classes = {kind: question for kind, question in questions().items() if question.own_table() not in known}
    return {kind: (getdoc(question) or "").partition("\n")[0] for kind, question in classes.items()}


class CommandList(TyperGroup):
    """A command with subcommands, which the help lists by group."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the groups in plain text, each with its commands."""
        panels: dict[str, list[tuple[str, str]]] = {}
        width = formatter.width - 6 - max(map(len, self.commands))
        for name, command in self.commands.items():
            panel = str(getattr(command, "rich_help_panel", None) or "Commands")
            panels.setdefault(panel, []).append((name, command.get_short_help_str(width)))
        for panel, rows in panels.items():
            with formatter.section(panel):
                formatter.write_dl([(f"{name:<20}", summary) for name, summary in rows])


def application(arguments: Sequence[str] | None = None) -> typer.Typer:
    """Return the command line application; for the words of one call, the command they name, or a list."""
    named, second, *_ = *(arguments or words_on_the_line()), "", ""
    app = typer.Typer(
        name="rocking",
        cls=CommandList,
        help=ABOUT,
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    groups = GROUPS
    if named not in commands() and (added := added_studies()):
        groups = GROUPS | {"More studies": added}
    known = {name for group in groups.values() for name in group}
    for panel, summaries in groups.items():
        for name, summary in summaries.items():
            if arguments is None or name == named:
                _add(app, name, summary, panel, second if arguments is not None else None)
            elif named not in known:
                app.command(name, short_help=summary, rich_help_panel=panel)(_nothing)
    return app


def _add(app: typer.Typer, name: str, summary: str, panel: str, second: str | None) -> None:
    """Add a command; second: its subcommand that is called, all of them if None."""
    if name == "record":
        group = typer.Typer(name=name, no_args_is_help=True, pretty_exceptions_enable=False, add_completion=False)
        for one, about in RECORD.items():
            called = second is None or one == second
            command = with_common(_command(f"{name} {one}")) if called else _nothing
            group.command(one, cls=Command if called else None, help=about)(command)
    elif name in SUBCOMMANDS:
        group = getattr(import_module(f"rocking.cli.{name}"), name)
        for registered in group.registered_commands:
            registered.cls = Command
            registered.callback = with_common(registered.callback)
    else:
        app.command(name, cls=Command, help=summary, rich_help_panel=panel)(with_common(_command(name)))
        return
    app.add_typer(group, help=summary, rich_help_panel=panel)


def _command(name: str) -> Callable[..., None]:
    if name in _GENERIC or (name not in commands() and not name.startswith("record ")):
        from rocking.cli.histories import command_of

        return command_of(name)
    function = name.replace("-", "_").replace(" ", "_")
    module = import_module(f"rocking.cli.{_MODULES.get(name, function)}")
    command: Callable[..., None] = getattr(module, function)
    return command


def _nothing() -> None:
    """Stand for a command in the list."""


def _version(is_asked: bool) -> None:
    if is_asked:
        print(SOFTWARE)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Show the version."),
) -> None:
    """Show the help of a command: rocking COMMAND --help."""
