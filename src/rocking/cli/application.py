"""The commands and their help; what they do is imported when they run."""

import typer

from rocking.cli.campaign import campaign
from rocking.cli.cor import cor
from rocking.cli.formats import formats
from rocking.cli.fragility import fragility
from rocking.cli.inventory import inventory
from rocking.cli.map import map
from rocking.cli.minimum import minimum
from rocking.cli.models import models
from rocking.cli.motion import motion
from rocking.cli.paper import paper
from rocking.cli.serve import serve
from rocking.cli.simulate import simulate
from rocking.cli.spectrum import spectrum
from rocking.version import SOFTWARE


def application() -> typer.Typer:
    """Return the command line application."""
    app = typer.Typer(
        name="rocking",
        help="Predict what an impact costs a rocking body, with the evidence beside every number.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        add_completion=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    for command in (cor, simulate, map, minimum, spectrum, fragility, inventory, paper, models, motion, formats, serve):
        app.command()(command)
    app.add_typer(campaign, name="campaign")
    return app


def _version(wanted: bool) -> None:
    if wanted:
        print(SOFTWARE)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Predict what an impact costs a rocking body, with the evidence beside every number."""
