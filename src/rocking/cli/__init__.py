"""The command line: what `rocking --help` lists."""

import sys
import warnings
from collections.abc import Sequence
from typing import TextIO


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code: 0 done, 2 refused, 130 interrupted.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after ``rocking``; by default those of the process.

    Raises
    ------
    SystemExit
        Always.
    """
    from typer.exceptions import TyperException

    from rocking.cli.application import application
    from rocking.errors import RockingError, SlowEngineWarning

    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("once", SlowEngineWarning)
            warnings.showwarning = _say
            # without arguments the help is the answer
            code = application()(args=words or ["--help"], prog_name="rocking", standalone_mode=False)
    except RockingError as error:
        print(f"rocking: {error}", file=sys.stderr)
        sys.exit(2)
    except TyperException as error:
        message = error.format_message() if hasattr(error, "format_message") else str(error)
        print(f"rocking: {message}; see rocking --help", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"rocking: {error.strerror or error}: {error.filename or ''}".rstrip(": "), file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("rocking: interrupted", file=sys.stderr)
        sys.exit(130)
    sys.exit(code or 0)


def _say(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    print(f"rocking: note: {message}", file=sys.stderr)
