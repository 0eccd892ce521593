"""What the compiled engines share: instruction sets, threads, and what is said where one was not built."""

import os
from typing import Any

from rocking import checks, errors
from rocking.errors import InvalidValueError, SlowEngineWarning

ENGINES = ("auto", "fast", "reference")


def chosen_engine(asked: str, module: Any, warning: str) -> str:
    """Return which engine will run; where "auto" finds none compiled, the warning is given.

    module: the compiled module, or None where it was not built.
    """
    asked = checks.one_of("engine", asked, ENGINES)
    if asked != "auto" or module is not None:
        return "fast" if asked == "auto" else asked
    errors.warn(warning, SlowEngineWarning)
    return "reference"


def chosen_instruction_set(known: list[str]) -> str:
    """Return the instruction set that the environment variable ROCKING_ISA names, or the fastest there is."""
    wanted = os.environ.get("ROCKING_ISA", "")
    if wanted and wanted not in known:
        raise InvalidValueError(f"ROCKING_ISA must be one of {', '.join(known)}, got {wanted!r}")
    return wanted or known[0]


MOST_THREADS = 4096


def check_threads(threads: object) -> None:
    """Refuse what is no number of threads, or None."""
    if threads is not None and (isinstance(threads, bool) or not isinstance(threads, int) or threads < 1):
        raise InvalidValueError(f"threads must be a whole number >= 1, got {threads!r}")
    if isinstance(threads, int) and threads > MOST_THREADS:
        raise InvalidValueError(f"threads must be in [1, {MOST_THREADS}], got {threads}")


def check_progress(progress: object) -> None:
    """Refuse what can not be called."""
    if progress is not None and not callable(progress):
        raise InvalidValueError(f"progress must be a function of the histories done, or None, got {progress!r:.60}")


def processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
