"""What packages export is documented in full: parameters, what is returned and raised, as numpydoc asks."""

import inspect
import pkgutil
import tomllib
import warnings
from enum import Enum
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import rocking

ROOT = Path(__file__).parents[2]
CHECKS = set(
    tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["numpydoc_validation"]["checks"]
)


def packages() -> list[ModuleType]:
    """Every package that exports names, save the doors and the writers behind them, whose users are the rooms here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = [rocking] + [
            import_module(each.name)
            for each in pkgutil.walk_packages(rocking.__path__, "rocking.")
            if each.ispkg and not each.name.startswith(("rocking.cli", "rocking.tables"))
        ]
    return [each for each in found if hasattr(each, "__all__")]


def exported() -> dict[str, object]:
    """Classes with their public methods, and functions, by where they are defined."""
    names: dict[str, object] = {}
    for package in packages():
        for name in package.__all__:
            value = getattr(package, name)
            home = value.__name__ if isinstance(value, ModuleType) else "rocking"
            # of a module what it exports itself, or all of one that does not say
            names_of = getattr(value, "__all__", vars(value)) if isinstance(value, ModuleType) else ()
            for one in [getattr(value, each) for each in names_of] or [value]:
                if not callable(one) or not str(one.__module__).startswith(home) or one.__name__.startswith("_"):
                    continue
                where = f"{one.__module__}.{one.__qualname__}"
                names[where] = one
                if inspect.isclass(one):
                    names |= dict(_first(one, key) for key, member in vars(one).items() if _is_public(key, member))
    return names


def _first(kind: type, name: str) -> tuple[str, object]:
    """A member where its documentation stands: an override needs a line on what differs, or none."""
    kinds = [each for each in kind.__mro__ if name in vars(each) and each.__module__.startswith("rocking")]
    home = next((each for each in kinds[::-1] if vars(each)[name].__doc__), kind)
    return f"{home.__module__}.{home.__qualname__}.{name}", vars(home)[name]


def _is_public(name: str, member: object) -> bool:
    """Whether a member of a class is a method or property that users call."""
    methods = (property, classmethod, staticmethod)
    return not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, methods))


NAMES = exported()


def faults(name: str) -> list[str]:
    """What numpydoc finds fault with."""
    from numpydoc.validate import validate

    value = NAMES[name]
    # what an enumeration, a number or a protocol is made of is Python's to say, that of an error stands with its base
    theirs = inspect.isclass(value) and (
        issubclass(value, (Enum, float))
        or getattr(value, "_is_protocol", False)
        or (issubclass(value, Exception) and "__init__" not in vars(value))
    )
    wanted = CHECKS - {"PR01"} if theirs else CHECKS
    return [f"{name}: {code} {words}" for code, words in validate(name)["errors"] if code in wanted]


def test_public_names_are_documented() -> None:
    """No exported name lacks a part of its documentation."""
    assert len(NAMES) > 500
    assert [fault for name in NAMES for fault in faults(name)] == []


def test_no_module_stands_in_the_place_of_an_export() -> None:
    """Where names are fetched late, a module of the same name would hide one, unless it is what is exported."""
    for package in (each for each in packages() if hasattr(each, "__getattr__")):
        modules = {each.name for each in pkgutil.iter_modules(package.__path__)} & set(package.__all__)
        assert [name for name in modules if not isinstance(getattr(package, name), ModuleType)] == []


def test_a_missing_parameter_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control."""
    text = str(rocking.coefficient_of_restitution.__doc__)
    monkeypatch.setattr(rocking.coefficient_of_restitution, "__doc__", text.replace("eta : float", "zeta : float"))
    found = faults("rocking.restitution.registry.coefficient_of_restitution")
    assert any("PR01" in fault for fault in found)
