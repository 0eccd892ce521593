"""The commands and their help; each command is imported when it runs."""

import sys
from collections.abc import Callable, Sequence
from glob import glob
from importlib import import_module
from inspect import getdoc
from pkgutil import iter_modules
from typing import Any

import typer
from typer.core import TyperGroup

from rocking import spec
from rocking.cli.completion import words_on_the_line
from rocking.cli.help import Command, with_common
from rocking.errors import MissingExtraError, how_to_install
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
        "campaign": "Compute a large study; stop and resume it.",
        "examples": "List examples; run an example in this folder.",
    },
}
"""Summaries of the commands by group."""
RECORD = {
    "show": "Show intensity measures and spectrum of a record or a pulse.",
    "batch": "Compute measures of many records; match a target spectrum.",
    "convert": "Convert a record to another format; apply processing steps.",
    "formats": "List the record formats.",
}
SUBCOMMANDS = ("record", "measurements", "campaign")
PLUGINS = "rocking.commands"
"""Entry-point group of commands from other distributions: a name and its function."""
ABSENT = {"serve": "rocking-workbench"}  # distribution of each command, named in the error for an absent distribution
_GENERIC = {"histories", "bifurcation", "orbits", "lyapunov", "basins"}  # options follow from the table of the study
_MODULES = {"assess": "predict", "models": "catalogues", "record formats": "catalogues"}


def commands() -> dict[str, str]:
    """Return every command with its summary."""
    return {name: summary for group in GROUPS.values() for name, summary in group.items()}


def plugins() -> dict[str, str]:
    """Return the commands of other installed distributions, each as "module:function".

    `importlib.metadata` gives the same result, but needs 0.1 s of CPU time: a third of the time of `rocking --help`.
    """
    added: dict[str, str] = {}
    for folder in sys.path:
        for file in glob(f"{folder or '.'}/*.dist-info/entry_points.txt"):  # noqa: PTH207 - pathlib takes longer
            with open(file, encoding="utf-8") as lines:  # noqa: PTH123
                section = lines.read().partition(f"[{PLUGINS}]\n")[2].partition("[")[0]
            pairs = (line.split("=") for line in section.split("\n") if "=" in line)
            added |= {name.strip(): value.strip() for name, value in pairs}
    return {name: value for name, value in added.items() if name not in commands()}


def _load(value: str) -> Callable[..., None]:
    module, _, function = value.partition(":")
    command: Callable[..., None] = getattr(import_module(module), function)
    return command


def added_studies() -> dict[str, str]:
    """Return the summaries of studies without a command module, by kind, from the files of `rocking.spec.questions`."""
    files = {module.name for module in iter_modules([f"{folder}/questions" for folder in spec.__path__])}
    tables_of_commands = {*commands(), "minimum", "long_run"}  # tables of overturning-pga and of four commands
    if files <= tables_of_commands:  # avoids the slow import of the questions
        return {}
    from rocking.spec.questions import questions

    classes = {
        kind: question for kind, question in questions().items() if question.own_table() not in tables_of_commands
    }
    return {kind: (getdoc(question) or "").partition("\n")[0] for kind, question in classes.items()}


class CommandList(TyperGroup):
    """A command with subcommands, listed by group in its help."""

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
    """Return the application with all commands, or only with the command in the given arguments."""
    command_name, subcommand_name, *_ = *(arguments or words_on_the_line()), "", ""
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
    if command_name not in commands():
        groups = GROUPS | _added(command_name)
    listed = {name for group in groups.values() for name in group}
    for panel, summaries in groups.items():
        for name, summary in summaries.items():
            if arguments is None or name == command_name:
                _add(app, name, summary, panel, subcommand_name if arguments is not None else None)
            elif command_name not in listed:
                app.command(name, short_help=summary, rich_help_panel=panel)(_nothing)
    return app


def _added(command_name: str) -> dict[str, dict[str, str]]:
    """Return the groups with plug-ins and added studies; raise an error for a command of an absent distribution."""
    functions = {name: _load(value) for name, value in plugins().items()}
    if command_name in ABSENT and command_name not in functions:
        distribution = ABSENT[command_name]
        raise MissingExtraError(how_to_install(f"rocking {command_name}", distribution, ImportError(name=distribution)))
    summaries = {name: (getdoc(function) or "").partition("\n")[0] for name, function in functions.items()}
    added = {"Run": GROUPS["Run"] | summaries, "More studies": added_studies()}
    return {group: names for group, names in added.items() if names}


def _add(app: typer.Typer, name: str, summary: str, panel: str, second: str | None) -> None:
    """Add a command; `second` is the subcommand of the call, or None for all subcommands."""
    if name == "record":
        group = typer.Typer(name=name, no_args_is_help=True, pretty_exceptions_enable=False, add_completion=False)
        for subcommand, summary_of_subcommand in RECORD.items():
            called = second is None or subcommand == second
            command = with_common(_command(f"{name} {subcommand}")) if called else _nothing
            group.command(subcommand, cls=Command if called else None, help=summary_of_subcommand)(command)
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
    if name not in commands() and (plugin := plugins().get(name)):
        return _load(plugin)
    if name in _GENERIC or (name not in commands() and not name.startswith("record ")):
        from rocking.cli.histories import command_of

        return command_of(name)
    function = name.replace("-", "_").replace(" ", "_")
    module = import_module(f"rocking.cli.{_MODULES.get(name, function)}")
    command: Callable[..., None] = getattr(module, function)
    return command


def _nothing() -> None:
    """Represent a command in the list of commands."""


def _version(is_asked: bool) -> None:
    if is_asked:
        print(SOFTWARE)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Show the version."),
) -> None:
    """Show the help of a command: rocking COMMAND --help."""
