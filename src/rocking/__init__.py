"""Predict what an impact costs a rocking body: bodies, restitution models, and the evidence for each."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking import bodies, conventions, errors, evidence, plots, report, restitution
    from rocking.bodies import Block, Body, MassPoints, Region, Section, Side, shapes
    from rocking.bodies.formats import read_body
    from rocking.restitution import RestitutionModel, coefficient_of_restitution

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Body",
    "MassPoints",
    "Region",
    "RestitutionModel",
    "Section",
    "Side",
    "bodies",
    "coefficient_of_restitution",
    "conventions",
    "errors",
    "evidence",
    "plots",
    "read_body",
    "report",
    "restitution",
    "shapes",
]

_HOME = {
    "Block": "rocking.bodies",
    "Body": "rocking.bodies",
    "MassPoints": "rocking.bodies",
    "Region": "rocking.bodies",
    "RestitutionModel": "rocking.restitution",
    "Section": "rocking.bodies",
    "Side": "rocking.bodies",
    "coefficient_of_restitution": "rocking.restitution",
    "read_body": "rocking.bodies.formats",
    "shapes": "rocking.bodies",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that `import rocking` stays quick."""
    if name not in __all__:
        raise AttributeError(f"module 'rocking' has no attribute {name!r}")
    home = _HOME.get(name)
    return getattr(import_module(home), name) if home else import_module(f"rocking.{name}")


def __dir__() -> list[str]:
    """Public names for completion."""
    return sorted([*__all__, "__version__"])
