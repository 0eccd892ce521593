"""The command line; `rocking --help` lists the commands."""

import gc
import json
import os
import sys
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking.errors import RockingError

_FEW_COLLECTIONS = 100_000  # objects between two garbage collections; imported objects remain anyway


def main(arguments: Sequence[str] | None = None, unnamed_file: str = "") -> None:
    """Run the command line and exit: 0 done, 2 invalid input, 130 interrupted.

    `unnamed_file` is a file that the caller has written; errors do not name this file.
    """
    gc.set_threshold(_FEW_COLLECTIONS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # a search for plug-ins is slow
    from typer import BadParameter

    from rocking.cli.application import SUBCOMMANDS, application
    from rocking.cli.help import Output
    from rocking.cli.spelling import help_hint, no_command, spelled, with_help
    from rocking.errors import RockingError, SlowEngineWarning, reason_of

    click_exception: Any = BadParameter.__mro__[2]  # the module of click depends on the version of typer
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    no_command()
    Output.reset()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", SlowEngineWarning)
            warnings.showwarning = _Notes()
            _register_own_models()
            code = application(arguments)(
                args=_with_help(arguments, SUBCOMMANDS), prog_name="rocking", standalone_mode=False, obj=main
            )
    except RockingError as error:
        refusal = error.without_file(unnamed_file) if unnamed_file else with_help(error)  # forms have no commands
    except click_exception as error:
        refusal = _refusal(error)
        refusal.add_hint(help_hint(getattr(error, "ctx", None)))
    except OSError as error:
        refusal = RockingError(reason_of(error))
        refusal = refusal.at(str(error.filename)) if error.filename else refusal
    except KeyboardInterrupt:
        print("rocking: interrupted", file=sys.stderr)
        sys.exit(130)
    except Exception as error:  # noqa: BLE001 - raised again unless a user's own model has caused it
        refusal = _of_own_model(error)
    else:
        Output.finish()
        sys.exit(code or 0)
    Output.finish(refusal)
    sentence = spelled(refusal)
    as_json = json.dumps({"error": {**refusal.data(), "message": sentence}}) if "--json" in arguments else ""
    print(as_json or f"rocking: {sentence}", file=sys.stderr)
    sys.exit(2)


def _with_help(arguments: list[str], groups: Sequence[str]) -> list[str]:
    """Return the arguments, with --help for a group without a command."""
    named = arguments[: -1 if arguments[-1:] == ["--help-all"] else None]
    return [*named, "--help"] if named in ([], *([name] for name in groups)) else arguments


def _of_own_model(error: Exception) -> "RockingError":
    """Return the message for an error in a user's own model; raise any other error again."""
    from rocking.errors import RockingError
    from rocking.restitution.from_file import in_own_model

    if not (sentence := in_own_model(error)):
        raise error
    return RockingError(sentence)


def _register_own_models() -> None:
    if os.environ.get("ROCKING_MODELS"):
        from rocking.restitution.from_file import register_own

        register_own()


def _refusal(error: Any) -> "RockingError":
    """Return the error of an invalid option; its hint names the input-file key of an unknown option."""
    from pydantic import ValidationError  # imported here, because help does not need pydantic and numpy

    from rocking.bodies.formats.words import from_pydantic
    from rocking.cli.options import FRICTION_RANGE, key_of
    from rocking.errors import InvalidValueError
    from rocking.messages import Message

    message = error.format_message() if hasattr(error, "format_message") else str(error)
    if hasattr(error, "possibilities") and (key := key_of(str(getattr(error, "option_name", "")))):
        return InvalidValueError(
            "{fault}", parameter=error.option_name, fault=message.rstrip("."),
            hint=Message("use {key}", {"key": key}),
        )  # fmt: skip
    if isinstance(error.__cause__, ValidationError) and getattr(error, "param", None) is not None:
        problems = error.__cause__.errors(include_url=False)
        refusal: RockingError = from_pydantic([{**problem, "loc": (error.param.opts[0],)} for problem in problems])
        if "predict.friction" in (error.param.help or ""):
            refusal.add_hint(FRICTION_RANGE)
        return refusal
    options = error.param.opts if getattr(error, "param", None) is not None else [getattr(error, "option_name", "")]
    return InvalidValueError("{fault}", parameter=options[0] or "", fault=message.rstrip("."))


class _Notes:
    """Print warnings as notes, each sentence once. The filter "once" of Python resets after a change of filters."""

    def __init__(self) -> None:
        self.sentences: set[str] = set()

    def __call__(self, message: Warning | str, *where: object, **more: object) -> None:
        from rocking.cli.help import Output

        if str(message) not in self.sentences and not Output.quiet.get():
            self.sentences.add(str(message))
            print(f"rocking: note: {message}", file=sys.stderr)
