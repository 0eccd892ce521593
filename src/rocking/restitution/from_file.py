"""Restitution models of users, in Python files."""

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
_VARIABLE = "ROCKING_MODELS"  # environment variable with the path of a file with models, which are registered by name
_OWN = "own model, "
_ROUNDING = 1e-9
_IMPACT = "for h/b = {ratio:g}, feet at {left:g} and {right:g} m, onto the {onto} one"
# colours and line styles for models that define none; they differ from those of the package
_LOOKS = (
    ("#a8642a", (0, (9, 2))),
    ("#2f8f83", (0, (2, 3))),
    ("#b0589a", (0, (7, 2, 2, 2, 2, 2))),
    ("#76802f", (0, (12, 4))),
)
_SOURCES: dict[type, tuple[str, str]] = {}
_FILES: set[str] = set()
_REGISTERED: dict[str, tuple[str, tuple[type[RestitutionModel], ...]]] = {}  # source text and models by file


def file_of(word: str) -> str | None:
    """Return the file in the name of a model; None for names without a file.

    >>> file_of("0.98*models/mine.py:Mine:share=0.3"), file_of("0.98*ked")
    ('models/mine.py', None)
    """
    match = _WORD.fullmatch(word)
    return match["path"] if match else None


def model_in_file(word: str, path: Path | None = None) -> RestitutionModel:
    """Return the model of a name with a file. The hash of the file identifies the class of the model."""
    match = _WORD.fullmatch(word)
    file = Path(file_of(word) or word) if path is None else path
    try:
        source = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise UnknownModelError("no such file").at(str(file)) from error
    except (OSError, ValueError) as error:
        raise UnknownModelError("{file} cannot be read: {reason}", file=str(file), reason=str(error)) from error
    eta, _, name, parameters = match.groups("") if match else ("", "", "", "")
    kind = _kind(source, str(file), name)
    values = parameters_in(parameters, word, {})
    with blamed(str(file)):
        instance = built(kind, f"{file.name}:{kind.__name__}", values)
    return model(instance, eta=number("eta", eta)) if eta else instance


def register_own() -> None:
    """Check and register all models of the file that the environment variable ROCKING_MODELS names.

    After a change of the file, its present models replace its former models.
    """
    path = os.environ.get(_VARIABLE, "")
    if not path:
        return
    path = os.environ[_VARIABLE] = str(Path(path).absolute())  # studies start processes in other folders
    before, old = _REGISTERED.get(path, (None, ()))
    try:
        source = _own_source(path)
        if source == before:
            return
        _REGISTERED[path] = source, _registered(source, path, old)
    except RockingError:
        _REGISTERED.pop(path, None)
        raise
    finally:  # a name that is in both versions stays registered
        for kind in old if _REGISTERED.get(path) != (before, old) else ():
            withdraw(kind)


def _own_source(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise UnknownModelError(
            "{variable}={path} cannot be read: {reason}", variable=_VARIABLE, path=path, reason=str(error)
        ) from error


def _registered(source: str, path: str, old: tuple[type[RestitutionModel], ...]) -> tuple[type[RestitutionModel], ...]:
    """Register all models of a file instead of its former models. After an error, none is registered."""
    with blamed(path):
        kinds = [registered for registered in _kinds(source, path).values() if not inspect.isabstract(registered)]
        if not kinds:
            raise UnknownModelError("{variable}={path} has no restitution model", variable=_VARIABLE, path=path)
        for position, kind in enumerate(kinds):
            name = getattr(kind, "name", kind.__name__)
            try:
                for parameters in kind.trials:
                    _check_promises(built(kind, name, parameters_in(parameters, name, {})))
                put(kind, old)
            except Exception as error:
                for registered in kinds[:position]:
                    withdraw(registered)
                raise InvalidValueError(
                    "model {model!r}: {reason}", model=name, reason=in_own_model(error) or str(error)
                ).at(path) from error
            kind.title = kind.title or name
            if not kind.colour:
                kind.colour, kind.linestyle = _LOOKS[position % len(_LOOKS)]
            if not kind.reference.startswith(_OWN):  # in an unchanged file, the reference is already extended
                kind.reference = f"{_OWN}{_signed(source, path)}: {kind.reference}"
    return tuple(kinds)


def origin_of(label: str) -> dict[str, str]:
    """Return the file of a user-defined model for the provenance of results; empty for other models."""
    name = label.rpartition("*")[2].partition(":")[0]
    sources = [source for kind, source in _SOURCES.items() if getattr(kind, "name", None) == name]
    return {"restitution_file": _signed(*sources[-1])} if sources else {}  # the latest version


def _signed(source: str, where: str) -> str:
    return f"{Path(where).name}, SHA-256 {hashlib.sha256(source.encode()).hexdigest()}"


def _check_promises(candidate: RestitutionModel) -> None:
    """Raise an error if a model violates common properties of models, for rectangles and asymmetric bodies."""
    ratios = [0.05, 0.3, 1.0, 2.0, 4.0, 10.0, 100.0]
    for ratio, r in zip(ratios, candidate.of_slenderness(ratios).tolist(), strict=True):
        if not 0.0 <= r <= 1.0 + _ROUNDING:
            raise InvalidValueError(
                "r must be in [0, 1], got {r:.6g} for a rectangle of h/b = {ratio:g}", r=r, ratio=ratio
            )
    for ratio in ratios[1:-1]:
        block = Block(width=1.0, height=ratio)
        for body in (block, block.with_feet(0.35, 0.95), block.with_feet(0.02, 0.7)):
            for foot in FEET:
                r, new, old = candidate.coefficient(body, foot), body.side(foot), body.side(opposite(foot))
                gain = r * r * new.moment_of_inertia / old.moment_of_inertia
                impact: dict[str, Any] = {"ratio": ratio, "left": body.feet[0], "right": body.feet[1], "onto": foot}
                if candidate.keeps_energy and gain > 1.0 + _ROUNDING:
                    raise InvalidValueError(
                        "an impact must not create energy, got {gain:.6g} times the energy before, " + _IMPACT,
                        gain=gain,
                        **impact,
                    )
                for quantity, changed_body, landing in (
                    ("size", body.scaled(size=7.3), foot),
                    ("density", body.scaled(density=0.013), foot),
                    ("side", body.mirrored(), opposite(foot)),
                ):
                    changed = candidate.coefficient(changed_body, landing)
                    if abs(changed - r) > 1e-8:
                        raise InvalidValueError(
                            "r must not depend on {property}, got {r:.6g} and {changed:.6g} " + _IMPACT,
                            property=quantity, r=r, changed=changed, **impact,
                        )  # fmt: skip


@contextmanager
def blamed(where: str) -> Iterator[None]:
    """Add the file of a user-defined model to errors of the model."""
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
    """Return file, line and text of an error in a user-defined model; empty for other errors."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename in _FILES]
    return f"{frames[-1].filename}, line {frames[-1].lineno}: {type(error).__name__}: {error}" if frames else ""


def _kind(source: str, where: str, name: str) -> type[RestitutionModel]:
    kinds = _kinds(source, where)
    if len(kinds) == 1 and not name:
        (name,) = kinds
    if name not in kinds:
        raise UnknownModelError(
            "{file} has no restitution model {model}; its models: {models}", file=where, model=name or "(give a name)",
            models=", ".join(kinds) or "none",
        )  # fmt: skip
    return kinds[name]


def _kinds(source: str, where: str) -> dict[str, type[RestitutionModel]]:
    """Return the models of a file by name. A model can be pickled together with its source."""
    with blamed(where):
        module = _module(source, where)
    kinds = {
        key: kind
        for key, kind in inspect.getmembers(module, inspect.isclass)
        if issubclass(kind, RestitutionModel) and kind.__module__ == module.__name__
    }
    for kind in kinds.values():
        _SOURCES.pop(kind, None)
        _SOURCES[kind] = (source, where)  # the latest version
        copyreg.pickle(kind, _reduced)
    return kinds


def _module(source: str, where: str) -> ModuleType:
    """Return the module of a file, with a name from its hash. The file is run once per content."""
    name = f"rocking_model_{hashlib.sha256(source.encode()).hexdigest()[:16]}"
    if name not in sys.modules:
        module = ModuleType(name)
        module.__file__ = where
        _FILES.add(where)
        sys.modules[name] = module
        try:
            exec(compile(source, where, "exec"), module.__dict__)  # runs code of the user
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def _reduced(instance: RestitutionModel) -> tuple[Any, ...]:
    return _blank, (*_SOURCES[type(instance)], type(instance).__name__), vars(instance) or None


def _blank(source: str, where: str, name: str) -> RestitutionModel:
    return object.__new__(_kind(source, where, name))
