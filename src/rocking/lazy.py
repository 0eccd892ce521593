"""Names of a package that are imported when they are first asked for, so that an answer loads what it needs alone."""

import re
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

_SHOWN = re.compile(r"^    from ([\w.]+) import \(?\s*(\w+) as \2\b", re.MULTILINE)


def exports(package: str) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """Return `__all__`, `__getattr__` and `__dir__` of a package: of the names that it shows to type checkers alone."""
    # They stand once, as `from home import name as name` below `if TYPE_CHECKING`, and are read from there. No module
    # of the package may have the name of an export: once imported it would stand in its place.
    spec = sys.modules[package].__spec__
    source = getattr(spec and spec.loader, "get_source", lambda _: None)(package)
    if source is None:
        raise ImportError(f"{package} reads its names from its source, which is missing: bundle the .py files too")
    homes = {name: home for home, name in _SHOWN.findall(source)}

    def get(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        if homes[name] == package:
            return import_module(f"{package}.{name}")
        return getattr(import_module(homes[name]), name)

    names = sorted(homes)
    return names, get, names.copy
