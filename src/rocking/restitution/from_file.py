"""A restitution model of the user's own, in a Python file."""

import copyreg
import hashlib
import inspect
import os
import re
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from rocking.bodies import Block
from rocking.conventions import FEET, opposite
from rocking.errors import InvalidValueError, RockingError, UnknownModelError
from rocking.restitution._model import RestitutionModel
from rocking.restitution.registry import built, model, number, parameters_in, put, withdraw

_WORD = re.compile(r"(?:(?P<eta>[^*]+)\*)?(?P<path>.+?\.py)(?::(?P<name>\w*)(?::(?P<parameters>.*))?)?")
_VARIABLE = "ROCKING_MODELS"  # of the surroundings: a file, all models of which are known by name
_OWN = "own model, "
_ROUNDING = 1e-9
_IMPACT = "for h/b = {ratio:g}, feet at {left:g} and {right:g} m, onto the {onto} one"
# colour and strokes of models that say none, which no model of the package has
_LOOKS = (
    ("#a8642a", (0, (9, 2))),
    ("#2f8f83", (0, (2, 3))),
    ("#b0589a", (0, (7, 2, 2, 2, 2, 2))),
    ("#76802f", (0, (12, 4))),
)
_SOURCES: dict[type, tuple[str, str]] = {}
_FILES: set[str] = set()
_REGISTERED: dict[str, tuple[str, tuple[type[RestitutionModel], ...]]] = {}  # source and models, by the file


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
        raise UnknownModelError("no file {file}", file=str(file)) from error
    except (OSError, ValueError) as error:
        raise UnknownModelError("{file} cannot be read: {reason}", file=str(file), reason=str(error)) from error
    eta, _, name, parameters = found.groups("") if found else ("", "", "", "")
    kind = _kind(source, str(file), name)
    given = parameters_in(parameters, word, {})
    with blamed(str(file)):
        made = built(kind, f"{file.name}:{kind.__name__}", given)
    return model(made, eta=number("eta", eta)) if eta else made


def register_own() -> None:
    """Register all models of the file that the owner of the machine names in ROCKING_MODELS, if each keeps its word.

    Of a file that was changed since, those that it has now take the place of those that it had.
    """
    path = os.environ.get(_VARIABLE, "")
    if not path:
        return
    path = os.environ[_VARIABLE] = str(Path(path).absolute())  # processes of studies start in other folders
    before, old = _REGISTERED.get(path, (None, ()))
    try:
        source = _own_source(path)
        if source == before:
            return
        _REGISTERED[path] = source, _registered(source, path, old)
    except RockingError:
        _REGISTERED.pop(path, None)
        raise
    finally:  # a name that is known before and after is known meanwhile
        for each in old if _REGISTERED.get(path) != (before, old) else ():
            withdraw(each)


def _own_source(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise UnknownModelError(
            "{variable}={path} cannot be read: {reason}", variable=_VARIABLE, path=path, reason=str(error)
        ) from error


def _registered(source: str, path: str, old: tuple[type[RestitutionModel], ...]) -> tuple[type[RestitutionModel], ...]:
    """Register all models of a file in the place of those that it had, or none of them."""
    with blamed(path):
        kinds = [each for each in _kinds(source, path).values() if not inspect.isabstract(each)]
        if not kinds:
            raise UnknownModelError("{variable}={path} has no restitution model", variable=_VARIABLE, path=path)
        for position, kind in enumerate(kinds):
            name = getattr(kind, "name", kind.__name__)
            try:
                for parameters in kind.trials:
                    _keeps_its_word(built(kind, name, parameters_in(parameters, name, {})))
                put(kind, old)
            except Exception as error:
                for each in kinds[:position]:
                    withdraw(each)
                raise InvalidValueError(
                    "model {model!r}: {reason}", model=name, reason=in_own_model(error) or str(error)
                ).at(path) from error
            kind.title = kind.title or name
            if not kind.colour:
                kind.colour, kind.linestyle = _LOOKS[position % len(_LOOKS)]
            if not kind.reference.startswith(_OWN):  # of a file that is what it once was
                kind.reference = f"{_OWN}{_signed(source, path)}: {kind.reference}"
    return tuple(kinds)


def origin_of(label: str) -> dict[str, str]:
    """Return of which file a model of the user's own is, for what is computed with it; nothing for any other."""
    name = label.rpartition("*")[2].partition(":")[0]
    found = [each for kind, each in _SOURCES.items() if getattr(kind, "name", None) == name]
    return {"restitution_file": _signed(*found[-1])} if found else {}  # the last that was read


def _signed(source: str, where: str) -> str:
    return f"{Path(where).name}, SHA-256 {hashlib.sha256(source.encode()).hexdigest()}"


def _keeps_its_word(tried: RestitutionModel) -> None:
    """Refuse a model that breaks what every model promises, on bodies that are not symmetric and on rectangles."""
    ratios = [0.05, 0.3, 1.0, 2.0, 4.0, 10.0, 100.0]
    for ratio, r in zip(ratios, tried.of_slenderness(ratios).tolist(), strict=True):
        if not 0.0 <= r <= 1.0 + _ROUNDING:
            raise InvalidValueError(
                "r must lie in [0, 1], is {r:.6g} for a rectangle of h/b = {ratio:g}", r=r, ratio=ratio
            )
    for ratio in ratios[1:-1]:
        block = Block(width=1.0, height=ratio)
        for body in (block, block.with_feet(0.35, 0.95), block.with_feet(0.02, 0.7)):
            for onto in FEET:
                r, new, old = tried.coefficient(body, onto), body.side(onto), body.side(opposite(onto))
                gain = r * r * new.moment_of_inertia / old.moment_of_inertia
                impact: dict[str, Any] = {"ratio": ratio, "left": body.feet[0], "right": body.feet[1], "onto": onto}
                if tried.keeps_energy and gain > 1.0 + _ROUNDING:
                    raise InvalidValueError(
                        "an impact creates energy, {gain:.6g} of what there was, " + _IMPACT, gain=gain, **impact
                    )
                for seen, other, foot in (
                    ("size", body.scaled(size=7.3), onto),
                    ("density", body.scaled(density=0.013), onto),
                    ("side", body.mirrored(), opposite(onto)),
                ):
                    there = tried.coefficient(other, foot)
                    if abs(there - r) > 1e-8:
                        raise InvalidValueError(
                            "r must not depend on {property}, is {r:.6g} and {changed:.6g} " + _IMPACT, property=seen,
                            r=r, changed=there, **impact,
                        )  # fmt: skip


@contextmanager
def blamed(where: str) -> Iterator[None]:
    """Say of an error in a file of the user's own where it is."""
    try:
        yield
    except RockingError:
        raise
    except Exception as error:
        if fault := in_own_model(error):
            raise UnknownModelError(fault) from error
        raise UnknownModelError(
            "{file} failed: {type}: {reason}", file=where, type=type(error).__name__, reason=str(error)
        ) from error


def in_own_model(error: BaseException) -> str:
    """Return what failed in a model of the user's own, and on which line; nothing if it is no such error."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename in _FILES]
    return f"{frames[-1].filename}, line {frames[-1].lineno}: {type(error).__name__}: {error}" if frames else ""


def _kind(source: str, where: str, name: str) -> type[RestitutionModel]:
    kinds = _kinds(source, where)
    if len(kinds) == 1 and not name:
        (name,) = kinds
    if name not in kinds:
        raise UnknownModelError(
            "{file} has no restitution model {model}; it has {models}", file=where, model=name or "(name one)",
            models=", ".join(kinds) or "none",
        )  # fmt: skip
    return kinds[name]


def _kinds(source: str, where: str) -> dict[str, type[RestitutionModel]]:
    """Return the models of a file, each of which can be sent to another process with its source."""
    with blamed(where):
        module = _module(source, where)
    kinds = {
        key: kind
        for key, kind in inspect.getmembers(module, inspect.isclass)
        if issubclass(kind, RestitutionModel) and kind.__module__ == module.__name__
    }
    for kind in kinds.values():
        _SOURCES.pop(kind, None)
        _SOURCES[kind] = (source, where)  # the last
        copyreg.pickle(kind, _reduced)
    return kinds


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
