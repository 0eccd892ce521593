"""The command line: what `rocking --help` lists."""

import gc
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import Any

_FEW_COLLECTIONS = 100_000  # objects until garbage is looked for: a command imports many that all stay


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code: 0 done, 2 refused, 130 interrupted."""
    gc.set_threshold(_FEW_COLLECTIONS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # to look for them reads every installed distribution
    from typer import BadParameter

    from rocking.cli.application import application
    from rocking.errors import RockingError, SlowEngineWarning

    click_exception: Any = BadParameter.__mro__[2]  # versions of typer differ in where they keep click
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", SlowEngineWarning)
            warnings.showwarning = _Notes()
            if os.environ.get("ROCKING_MODELS"):
                from rocking.restitution.from_file import register_own

                register_own()
            # without arguments the help is the answer
            code = application(arguments)(args=arguments or ["--help"], prog_name="rocking", standalone_mode=False)
    except RockingError as error:
        print(f"rocking: {error}", file=sys.stderr)
        sys.exit(2)
    except click_exception as error:
        print(f"rocking: {_refusal(error, arguments)}; see rocking --help", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"rocking: {error.strerror or error}: {error.filename or ''}".rstrip(": "), file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("rocking: interrupted", file=sys.stderr)
        sys.exit(130)
    except Exception as error:
        from rocking.restitution.from_file import in_own_model

        if not (sentence := in_own_model(error)):
            raise
        print(f"rocking: {sentence}", file=sys.stderr)
        sys.exit(2)
    sys.exit(code or 0)


def _refusal(error: Exception, arguments: list[str]) -> str:
    """Return why the words make no sense, with a key for an option that does not exist, or a comma for a point."""
    from rocking.checks import number_hint  # numpy with it, which help does not need
    from rocking.cli.options import key_of

    message = error.format_message() if hasattr(error, "format_message") else str(error)
    if hasattr(error, "possibilities") and (key := key_of(str(getattr(error, "option_name", "")))):
        return f"{message.rstrip('.')}; it is a key: {key}"
    hints = [number_hint(word) for word in arguments if not word.partition("=")[2].strip("+-,0123456789")]
    return f"{message}{next(filter(None, hints), '') if re.search('valid (number|float)', message) else ''}"


class _Notes:
    """Print a warning as a note, each sentence once: Python's own "once" forgets whenever a filter changes."""

    def __init__(self) -> None:
        self.sentences: set[str] = set()

    def __call__(self, message: Warning | str, *where: object, **more: object) -> None:
        if str(message) not in self.sentences:
            self.sentences.add(str(message))
            print(f"rocking: note: {message}", file=sys.stderr)
