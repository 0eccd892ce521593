"""Predict what an impact costs a rocking body: bodies, restitution models, and the evidence for each."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking import bodies, conventions, errors, restitution
    from rocking.bodies import Block, Body, MassPoints, Region, Section, Side
    from rocking.restitution import RestitutionModel, coefficient_of_restitution

__version__ = "0.1.0"

_HOME = {
    "Block": "rocking.bodies",
    "Body": "rocking.bodies",
    "MassPoints": "rocking.bodies",
    "Region": "rocking.bodies",
    "RestitutionModel": "rocking.restitution",
    "Section": "rocking.bodies",
    "Side": "rocking.bodies",
    "coefficient_of_restitution": "rocking.restitution",
}
_ROOMS = ("bodies", "conventions", "errors", "restitution")

__all__ = [*_HOME, *_ROOMS]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that `import rocking` stays quick."""
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    if name in _ROOMS:
        return import_module(f"rocking.{name}")
    raise AttributeError(f"module 'rocking' has no attribute {name!r}")


def __dir__() -> list[str]:
    """Public names for completion."""
    return sorted([*__all__, "__version__"])
