"""The models of a command: names with parameters, or a class in the user's own file."""

from collections.abc import Sequence

from rocking.restitution import RestitutionModel, model
from rocking.restitution.from_file import file_of, model_in_file


def models_from(words: Sequence[str] | None) -> list[RestitutionModel] | None:
    """Return the models that a command was given, none if it was given none."""
    return [model_in_file(word) if file_of(word) else model(word) for word in words] if words else None
