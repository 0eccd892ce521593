"""The models of a command: names with parameters, or a class in the user's own file."""

import importlib.util
import inspect
from collections.abc import Sequence
from pathlib import Path

from rocking.errors import UnknownModelError
from rocking.restitution import RestitutionModel, model


def models_from(words: Sequence[str] | None) -> list[RestitutionModel] | None:
    """Return the models that a command was given, none if it was given none.

    Parameters
    ----------
    words : sequence of str, optional
        As `rocking.restitution.model` takes them, or ``path/to/file.py:ClassName``.

    Returns
    -------
    list of RestitutionModel, optional
        The models.
    """
    return [_from_file(word) if _names_file(word) else model(word) for word in words] if words else None


def _names_file(word: str) -> bool:
    return word.partition(":")[0].endswith(".py")


def _from_file(word: str) -> RestitutionModel:
    path, _, name = word.partition(":")
    if not Path(path).is_file():
        raise UnknownModelError(f"no file {path}")
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    if spec is None or spec.loader is None:
        raise UnknownModelError(f"{path} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
        kinds = {
            key: kind
            for key, kind in inspect.getmembers(module, inspect.isclass)
            if issubclass(kind, RestitutionModel) and kind.__module__ == module.__name__
        }
        if len(kinds) == 1 and not name:
            (name,) = kinds
        if name not in kinds:
            raise UnknownModelError(
                f"{path} has no restitution model {name or '(name one)'}; it has {', '.join(kinds) or 'none'}"
            )
        found = kinds[name]()
    except UnknownModelError:
        raise
    except Exception as error:
        raise UnknownModelError(f"{path} failed: {type(error).__name__}: {error}") from error
    return found
