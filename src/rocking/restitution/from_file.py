"""A restitution model of the user's own, in a Python file."""

import copyreg
import hashlib
import inspect
import re
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from rocking.errors import RockingError, UnknownModelError
from rocking.restitution.model import RestitutionModel
from rocking.restitution.registry import built, model, number, parameters_in

_WORD = re.compile(r"(?:(?P<eta>[^*]+)\*)?(?P<path>.+?\.py)(?::(?P<name>\w*)(?::(?P<parameters>.*))?)?")
_SOURCES: dict[type, tuple[str, str]] = {}
_FILES: set[str] = set()


def file_of(word: str) -> str | None:
    """Return the file that a word names, if it names one.

    >>> file_of("0.98*models/mine.py:Mine:share=0.3"), file_of("0.98*ked")
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
    eta, _, name, parameters = found.groups("") if found else ("", "", "", "")
    kind = _kind(source, str(file), name)
    given = parameters_in(parameters, word, {})
    with blamed(str(file)):
        made = built(kind, f"{file.name}:{kind.__name__}", given)
    return model(made, eta=number("eta", eta)) if eta else made


@contextmanager
def blamed(where: str) -> Iterator[None]:
    """Say of an error in a file of the user's own where it is."""
    try:
        yield
    except RockingError:
        raise
    except Exception as error:
        raise UnknownModelError(in_own_model(error) or f"{where} failed: {type(error).__name__}: {error}") from error


def in_own_model(error: BaseException) -> str:
    """Return what failed in a model of the user's own, and on which line; nothing if it is no such error."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename in _FILES]
    return f"{frames[-1].filename}, line {frames[-1].lineno}: {type(error).__name__}: {error}" if frames else ""


def _kind(source: str, where: str, name: str) -> type[RestitutionModel]:
    with blamed(where):
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
    for kind in kinds.values():
        _SOURCES[kind] = (source, where)
        copyreg.pickle(kind, _reduced)
    return kinds[name]


def _module(source: str, where: str) -> ModuleType:
    """Run a file, once for each content: under a name that says which."""
    name = f"rocking_model_{hashlib.sha256(source.encode()).hexdigest()[:16]}"
    if name not in sys.modules:
        module = ModuleType(name)
        module.__file__ = where
        _FILES.add(where)
        sys.modules[name] = module
        try:
            exec(compile(source, where, "exec"), module.__dict__)  # the user's own, who asked for it
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def _reduced(made: RestitutionModel) -> tuple[Any, ...]:
    return _blank, (*_SOURCES[type(made)], type(made).__name__), vars(made) or None


def _blank(source: str, where: str, name: str) -> RestitutionModel:
    return object.__new__(_kind(source, where, name))
