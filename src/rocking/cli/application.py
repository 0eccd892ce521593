"""The commands and their help; a command is imported when it is called, all of them for the list."""

from collections.abc import Callable, Sequence
from inspect import getdoc
from pkgutil import iter_modules

import typer

from rocking import spec
from rocking.cli.completion import words_on_the_line
from rocking.cli.spelling import Command
from rocking.version import SOFTWARE

COMMANDS = {
    "cor": "Print the coefficient of restitution of a body under every model, with its interval and what it implies.",
    "equilibria": (
        "Print in which ways a solid can stand, how far its centre must rise to leave each, and how sure its base is."
    ),
    "simulate": (
        "Print how a body rocks under a ground motion, whether it overturns, and whether the model of impact decides."
    ),
    "predict": (
        "Print how likely a body is to rock, slide or overturn, what decides it, and whether that can be predicted."
    ),
    "assess": "Print whether a body stands, its margin to overturning, what governs, and what to do about it.",
    "validate": "Print how good predictions of a folder's trials are, beside the plain curve that they must beat.",
    "identify": "Print the coefficient of restitution that a measurement of rocking says, with its interval.",
    "map": (
        "Print how a body ends over two parameters: shares of each way to overturn, safe islands, and where it begins."
    ),
    "minimum": "Print all peak ground accelerations at which a body begins or ceases to overturn, not the first alone.",
    "spectrum": (
        "Print the peak rotation of blocks of many sizes and slendernesses under motions, and which sizes overturn."
    ),
    "fragility": "Print how likely a body is to rock or to overturn at a level of shaking, and how well that is known.",
    "histories": "Compute every history of a body under motions, with scale factors and restitution models.",
    "inventory": "Print which objects of a list stay standing at a level of shaking, the worst first, in plain words.",
    "codes": "Print what code methods say of bodies, how many that they call safe overturn, and how far off they are.",
    "paper": "Recompute the paper: every table, figure, erratum and claim, and the league of all models.",
    "models": "List the restitution models, in the plane and in space: reference, assumptions, domain, known defects.",
    "motion": "Print what a record or a pulse is, its intensity measures and its response spectrum.",
    "motions": (
        "Print the intensity measures of many records and write them with RotD spectra; choose and scale to a target."
    ),
    "convert": (
        'Write a record in another format, corrected by --set "motion.process=mean; bandpass:low=0.1,high=25; taper".'
    ),
    "formats": (
        "List the formats of ground-motion files: name, endings, whether they state unit and step, what to know."
    ),
    "serve": "Open the application: draw a body, drop a record, see it rock. Everything stays on this machine.",
    "example": (
        "Run an example in this folder: write its files, show the commands and what they answer; or list what there is."
    ),
}
"""What each command does; the command itself is imported when it is called."""


def added_studies() -> dict[str, str]:
    """Return the studies that are files of `rocking.spec.questions` alone, by kind, and what each is."""
    files = {module.name for module in iter_modules([f"{folder}/questions" for folder in spec.__path__])}
    if files <= COMMANDS.keys():  # the questions themselves take long to be imported
        return {}
    from rocking.spec.questions import questions

    classes = {kind: question for kind, question in questions().items() if question.own_table() not in COMMANDS}
    return {kind: (getdoc(question) or "").partition("\n")[0] for kind, question in classes.items()}


def application(arguments: Sequence[str] | None = None) -> typer.Typer:
    """Return the command line application; for the words of one call, the command they name, or a list."""
    named = next(iter(arguments or words_on_the_line()), "")
    app = typer.Typer(
        name="rocking",
        help="Predict what an impact costs a rocking body, with the evidence beside every number.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        # plain text where the list alone is shown: frames around it would take twice the time to be imported
        rich_markup_mode=None if arguments is not None and named[:1] in {"", "-"} else "rich",
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    commands = COMMANDS if named in COMMANDS else COMMANDS | added_studies()
    for name, summary in commands.items():
        if arguments is None or name == named:
            app.command(name, cls=Command, help=summary)(_command(name))
        elif named not in commands:
            app.command(name, short_help=summary)(_nothing)
    if named not in commands:
        from rocking.cli.campaign import campaign
        from rocking.cli.evidence import evidence

        for group in (campaign, evidence):
            for one in group.registered_commands:
                one.cls = Command
            app.add_typer(group, short_help=group.info.help)
    return app


def _command(name: str) -> Callable[..., None]:  # noqa: PLR0911, PLR0912, PLR0915 - one import for each command
    match name:
        case "cor":
            from rocking.cli.cor import cor

            return cor
        case "equilibria":
            from rocking.cli.equilibria import equilibria

            return equilibria
        case "simulate":
            from rocking.cli.simulate import simulate

            return simulate
        case "predict":
            from rocking.cli.predict import predict

            return predict
        case "assess":
            from rocking.cli.predict import assess

            return assess
        case "validate":
            from rocking.cli.validate import validate

            return validate
        case "identify":
            from rocking.cli.identify import identify

            return identify
        case "map":
            from rocking.cli.map import map

            return map
        case "minimum":
            from rocking.cli.minimum import minimum

            return minimum
        case "spectrum":
            from rocking.cli.spectrum import spectrum

            return spectrum
        case "fragility":
            from rocking.cli.fragility import fragility

            return fragility
        case "inventory":
            from rocking.cli.inventory import inventory

            return inventory
        case "codes":
            from rocking.cli.codes import codes

            return codes
        case "paper":
            from rocking.cli.paper import paper

            return paper
        case "models":
            from rocking.cli.catalogues import models

            return models
        case "motion":
            from rocking.cli.motion import motion

            return motion
        case "motions":
            from rocking.cli.motions import motions

            return motions
        case "convert":
            from rocking.cli.convert import convert

            return convert
        case "formats":
            from rocking.cli.catalogues import formats

            return formats
        case "serve":
            from rocking.cli.serve import serve

            return serve
        case "example":
            from rocking.cli.example import example

            return example
    from rocking.cli.histories import command_of

    return command_of(name)


def _nothing() -> None:
    """Stand for a command in the list."""


def _version(wanted: bool) -> None:
    if wanted:
        print(SOFTWARE)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Predict what an impact costs a rocking body, with the evidence beside every number."""
