"""Help of the commands in plain text, and the common options of all commands."""

import sys
import time
import traceback
from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import Annotated, Any, ClassVar

import typer
from typer.core import TyperCommand

from rocking.cli.spelling import UsageError, run_in

SIZE, SHAKING, HOW, OUTPUT = "Block dimensions", "Ground motion", "Computation", "Output"
_PANELS = ("Arguments", "Options", SHAKING, SIZE, HOW, OUTPUT)
_RARE = {
    "mass", "centre", "moment_of_inertia", "seed", "count", "threads", "quiet", "verbose", "name", "crossing_curves",
    "help_all", "start_height", "start_velocity", "normal_restitution", "check_identities", "address", "executor",
    "damping", "min_barrier", "bisections", "samples",
}  # fmt: skip
"""Rare options, which only --help-all shows."""
_METAVARS = {
    "output": "FILE", "sets": "KEY=VALUE", "restitution": "MODEL", "motions": "MOTION", "motion": "MOTION",
    "units": "UNITS",
    "synthetic": "FAMILY", "periods": "LIST", "data": "FOLDER", "host": "ADDRESS", "inputs": "FOLDER",
    **dict.fromkeys(("count", "seed", "threads", "workers", "port", "samples", "bisections"), "N"),
}  # fmt: skip
_WIDTH = 20  # width of the column of names [characters]


class Output:
    """Selected messages on standard error for the running command."""

    quiet: ContextVar[bool] = ContextVar("no progress and no notes", default=False)
    verbose: ContextVar[bool] = ContextVar("version, time, and the traceback of an error", default=False)
    began: ClassVar[float] = 0.0  # start time of the command [s]

    @classmethod
    def reset(cls) -> None:
        """Set the defaults at the beginning of a command."""
        cls.quiet.set(False)
        cls.verbose.set(False)
        cls.began = time.monotonic()

    @classmethod
    def finish(cls, error: BaseException | None = None) -> None:
        """Write version and elapsed time, or the traceback of an error, with --verbose."""
        if not cls.verbose.get():
            return
        if error is None:
            from rocking.version import SOFTWARE

            print(f"{SOFTWARE}, {time.monotonic() - cls.began:.1f} s", file=sys.stderr)
        else:
            traceback.print_exception(error)


def _set(variable: ContextVar[bool]) -> Callable[[bool], None]:
    def change(value: bool) -> None:
        variable.set(value)

    return change


def _show_all(context: typer.Context, value: bool) -> None:
    if value:
        context.meta["rocking.help_all"] = True
        typer.echo(context.get_help())
        raise typer.Exit


COMMON = {
    "quiet": typer.Option(
        "-q", "--quiet", expose_value=False, callback=_set(Output.quiet), rich_help_panel=OUTPUT,
        help="Suppress progress and notes.",
    ),
    "verbose": typer.Option(
        "-v", "--verbose", expose_value=False, callback=_set(Output.verbose), rich_help_panel=OUTPUT,
        help="Show version and elapsed time; show the traceback of an error.",
    ),
    "help_all": typer.Option(
        "--help-all", expose_value=False, is_eager=True, callback=_show_all, rich_help_panel=OUTPUT,
        help="Show all options.",
    ),
}  # fmt: skip
"""Options of every command, by their name."""


def with_common(command: Callable[..., None]) -> Callable[..., None]:
    """Return the command with the common options."""
    own = signature(command).parameters.values()
    if COMMON.keys() <= signature(command).parameters.keys():  # the command already has the common options
        return command

    @wraps(command)
    def called(**values: Any) -> None:
        command(**{name: value for name, value in values.items() if name not in COMMON})

    annotations = {name: Annotated[bool, option] for name, option in COMMON.items()}
    called.__signature__ = Signature([  # type: ignore[attr-defined]
        *(parameter.replace(kind=Parameter.KEYWORD_ONLY) for parameter in own),
        *(Parameter(n, Parameter.KEYWORD_ONLY, default=False, annotation=a) for n, a in annotations.items()),
    ])  # fmt: skip
    called.__annotations__ = {**command.__annotations__, **annotations}
    return called


class Command(TyperCommand):
    """A command with help in plain text; messages name its options."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments; refuse a second model of a command with one model."""
        _, _, order = self.make_parser(ctx).parse_args(list(args))
        remaining: list[str] = super().parse_args(ctx, args)
        if (
            sum(parameter.name == "restitution" and not parameter.multiple for parameter in order) > 1
            and not ctx.resilient_parsing
        ):
            run_in(ctx)
            raise UsageError(
                "{parameter} accepts one model here", parameter="restitution",
                hint="use simulate to compare all models; map, fragility, histories and assess accept several",
            )  # fmt: skip
        return remaining

    def invoke(self, context: typer.Context) -> Any:  # type: ignore[override]  # click comes with typer
        run_in(context)
        return super().invoke(context)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write usage, summary and options by panel; rare options with --help-all only."""
        self.format_usage(ctx, formatter)
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(self.help or "")
        is_complete = "rocking.help_all" in ctx.meta
        shown = [entry for entry in self.get_params(ctx) if not getattr(entry, "hidden", False)]
        rare = [entry for entry in shown if entry.param_type_name == "option" and entry.name in _RARE]
        panels: dict[str, list[tuple[str, str]]] = {}
        for parameter in shown:
            if is_complete or parameter not in rare:
                panels.setdefault(_panel(parameter), []).append((_names(parameter), _text(parameter)))
        if not is_complete and (sizes := panels.get(SIZE)):
            panels[SIZE] = [("In place of a file", " ".join(names.partition(" ")[0] for names, _ in sizes))]
        for panel in sorted(panels, key=lambda name: _PANELS.index(name) if name in _PANELS else 1):
            with formatter.section(panel):
                formatter.write_dl([(f"{names:<{_WIDTH}}", text) for names, text in panels[panel]], col_max=_WIDTH)
        if rare and not is_complete:
            formatter.write_paragraph()
            formatter.write_text(f"All options and their units: {ctx.command_path} --help-all")
        if self.epilog:
            formatter.write_paragraph()
            formatter.write_text(self.epilog)


def _panel(parameter: Any) -> str:
    if parameter.param_type_name == "argument":
        return "Arguments"
    if parameter.name == "help":
        return OUTPUT
    return getattr(parameter, "rich_help_panel", None) or "Options"


def _names(parameter: Any) -> str:
    if parameter.param_type_name == "argument":
        return f"{parameter.name.upper()}{'' if parameter.nargs == 1 else '...'}"
    names = ", ".join(sorted(parameter.opts, key=len))
    if parameter.is_flag:
        return names
    return f"{names} {_METAVARS.get(parameter.name, 'VALUE')}"


def _text(parameter: Any) -> str:
    text = (parameter.help or "").replace("\\[", "[")
    default = parameter.default
    if parameter.param_type_name == "argument" or isinstance(default, bool) or default in (None, "", [], ()):
        return text
    return f"{text} [default: {default}]"
