"""Names of a package that are imported when they are first asked for, so that an answer loads what it needs alone."""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def exports(package: str, homes: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return `__getattr__` and `__dir__` of a package whose names stand in other modules."""
    # no module of the package may have the name of an export: once imported it would stand in its place

    def get(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = import_module(homes[name])
        if homes[name] == f"{package}.{name}":
            return home
        found = getattr(home, name, None)
        return import_module(f"{homes[name]}.{name}") if found is None else found

    return get, lambda: sorted(homes)


presenters: dict[str, str] = {}
"""What rooms above do for those below, as "module:function" by its name: the root of the package fills it in."""


def presenter(name: str) -> Callable[..., Any]:
    """Return what a room above does for one below."""
    module, _, function = presenters[name].partition(":")
    found: Callable[..., Any] = getattr(import_module(module), function)
    return found
