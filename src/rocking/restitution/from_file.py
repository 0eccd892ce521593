"""A restitution model of the user's own, in a Python file."""

import copyreg
import hashlib
import inspect
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from rocking.errors import UnknownModelError
from rocking.restitution.model import RestitutionModel

_WORD = re.compile(r"(?P<path>.+\.py)(?::(?P<name>\w*))?")
_SOURCES: dict[type, tuple[str, str]] = {}


def file_of(word: str) -> str | None:
    """Return the file that a word names, if it names one.

    >>> file_of("models/mine.py:Mine"), file_of("0.98*ked")
    ('models/mine.py', None)
    """
    found = _WORD.fullmatch(word)
    return found["path"] if found else None


def model_in_file(word: str, path: Path | None = None) -> RestitutionModel:
    """Return the model that a word names; its class goes by the hash of the file, and its source with it."""
    found = _WORD.fullmatch(word)
    file = Path(file_of(word) or word) if path is None else path
    try:
        source = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise UnknownModelError(f"no file {file}") from error
    except (OSError, ValueError) as error:
        raise UnknownModelError(f"{file} cannot be read: {error}") from error
    return _made(source, str(file), (found and found["name"]) or "")


def _made(source: str, where: str, name: str) -> RestitutionModel:
    try:
        module = _module(source, where)
        kinds = {
            key: kind
            for key, kind in inspect.getmembers(module, inspect.isclass)
            if issubclass(kind, RestitutionModel) and kind.__module__ == module.__name__
        }
        if len(kinds) == 1 and not name:
            (name,) = kinds
        if name not in kinds:
            raise UnknownModelError(
                f"{where} has no restitution model {name or '(name one)'}; it has {', '.join(kinds) or 'none'}"
            )
        made: RestitutionModel = kinds[name]()
    except UnknownModelError:
        raise
    except Exception as error:
        raise UnknownModelError(f"{where} failed: {type(error).__name__}: {error}") from error
    for kind in kinds.values():
        _SOURCES[kind] = (source, where)
        copyreg.pickle(kind, _reduced)
    return made


def _module(source: str, where: str) -> ModuleType:
    """Run a file, once for each content: under a name that says which."""
    name = f"rocking_model_{hashlib.sha256(source.encode()).hexdigest()[:16]}"
    if name not in sys.modules:
        module = ModuleType(name)
        module.__file__ = where
        sys.modules[name] = module
        try:
            exec(compile(source, where, "exec"), module.__dict__)  # the user's own, who asked for it
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def _reduced(made: RestitutionModel) -> tuple[Any, ...]:
    return _made, (*_SOURCES[type(made)], type(made).__name__), vars(made) or None
