"""The commands and their help; a command is imported when it is called, all of them for the list."""

import ast
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

import typer

from rocking.cli.completion import words_on_the_line
from rocking.version import SOFTWARE

_MODULES = {"models": "catalogues", "formats": "catalogues", "assess": "predict"}
COMMANDS = (
    "cor", "equilibria", "simulate", "predict", "assess", "validate", "identify", "map", "minimum", "spectrum",
    "fragility", "inventory", "codes", "paper", "models", "motion", "motions", "convert", "formats", "serve",
    "example",
)  # fmt: skip


def application(arguments: Sequence[str] | None = None) -> typer.Typer:
    """Return the command line application; for the words of one call, the command they name, or a list."""
    app = typer.Typer(
        name="rocking",
        help="Predict what an impact costs a rocking body, with the evidence beside every number.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    named = next(iter(arguments or words_on_the_line()), "")
    for name in COMMANDS:
        module = _MODULES.get(name, name)
        if arguments is None or name == named:
            app.command(name)(getattr(import_module(f"rocking.cli.{module}"), name))
        elif named not in COMMANDS:
            app.command(name)(_listed(module, name))
    if named not in COMMANDS:
        from rocking.cli.campaign import campaign
        from rocking.cli.evidence import evidence

        app.add_typer(campaign, name="campaign")
        app.add_typer(evidence, name="evidence")
    return app


def _listed(module: str, name: str) -> Callable[[], None]:
    """Return what stands for a command in the list: its own first sentence, read without importing it."""
    tree = ast.parse(Path(__file__).with_name(f"{module}.py").read_text("utf-8"))

    def listed() -> None:
        """Be replaced by the command itself."""

    command = next(node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == name)
    listed.__doc__ = ast.get_docstring(command)
    return listed


def _version(wanted: bool) -> None:
    if wanted:
        print(SOFTWARE)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Predict what an impact costs a rocking body, with the evidence beside every number."""
