"""The compiled engine as Python sees it: whether it is there, and which instructions it uses."""

import os
from functools import cache
from types import ModuleType

from rocking import checks, errors
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning

_NOT_BUILT = (
    "the batch engine in space was not built: it takes a C++17 compiler when rocking is installed (in a checkout, "
    "`make engine`)"
)
_ENGINES = ("auto", "fast", "reference")


@cache
def _module() -> ModuleType | None:
    try:
        from rocking.dynamics import _spatial
    except ImportError:
        return None
    return _spatial


def available() -> bool:
    """Return whether the compiled engine is there.

    Returns if not, the reference engine serves row by row.
    """
    return _module() is not None


def module() -> ModuleType:
    """Return the compiled module."""
    found = _module()
    if found is None:
        raise MissingExtraError(f'{_NOT_BUILT}; engine="reference" gives the same results, slowly')
    return found


def chosen(asked: str) -> str:
    """Return which engine will run, and say so if it is not the one that users expect."""
    asked = checks.one_of("engine", asked, _ENGINES)
    if asked == "fast":
        module()
    if asked == "auto" and not available():
        errors.warn(f"{_NOT_BUILT}; the reference engine runs instead, row by row", SlowEngineWarning)
        return "reference"
    return "fast" if asked == "auto" else asked


def instruction_set() -> str:
    """Return what the compiled engine will use: the environment variable ROCKING_ISA, or the fastest there is."""
    wanted, known = os.environ.get("ROCKING_ISA", ""), list(module().instruction_sets())
    if wanted and wanted not in known:
        raise InvalidValueError(f"ROCKING_ISA must be one of {', '.join(known)}, got {wanted!r}")
    return wanted or known[0]
