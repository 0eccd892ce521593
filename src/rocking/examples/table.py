"""The one table of examples: what each is, its files, and the commands that show it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Kind = Literal["body", "list", "question", "job"]


@dataclass(frozen=True)
class Example:
    """One example of the package.

    Parameters
    ----------
    name : str
        By which it is asked for.
    kind : {"body", "list", "question", "job"}
        A body file, a list of objects, a question of one response, or a job of many.
    title : str
        What it is, on one line.
    files : tuple of str
        Its files, that of the example itself first; a path within the package.
    commands : tuple of str
        What to type, where these files are, to see it.
    options : mapping
        What `read_body` is told beside the file, where that does not state it.
    """

    name: str
    kind: Kind
    title: str
    files: tuple[str, ...]
    commands: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)


def _body(name: str, title: str) -> Example:
    commands = (f"rocking cor {name}.toml --out {name}.png",)
    return Example(name, "body", title, (f"bodies/{name}.toml",), commands)


def _question(name: str, title: str) -> Example:
    commands = (f"rocking simulate {name}.toml --out {name}.png",)
    return Example(name, "question", title, (f"questions/{name}.toml",), commands)


def _job(name: str, command: str, title: str) -> Example:
    return Example(name, "job", title, (f"jobs/{name}.toml",), (f"rocking {command} {name}.toml --out {name}.png",))


_ALL = (
    _body("statue", "a marble figure that leans, on a pedestal of brick with its feet set in"),
    _body("stele", "a tapered stele of limestone that leans to the right"),
    _body("pier", "a masonry pier with a shaft inside it"),
    Example(
        "cabinet",
        "body",
        "a cabinet whose equipment stands on its left, drawn in WKT without a unit",
        ("bodies/cabinet.wkt",),
        ("rocking cor cabinet.wkt --units mm --density 300 --out cabinet.png",),
        {"units": "mm", "density": 300.0},
    ),
    Example(
        "objects",
        "list",
        "ten objects of a museum, in centimetres and kilograms",
        ("jobs/objects.csv",),
        ("rocking inventory objects.csv --pga 0.3g --count 80 --out objects.html",),
    ),
    _question("block-under-a-pulse", "a cabinet under one sine, where the model of the impact decides"),
    _question("statue-let-go", "a statue that stands off its middle, let go to the left"),
    _job("overturning-map", "map", "which sine pulses overturn a block, and how: 60 x 60 pulses"),
    _job("refined-map", "map", "the same, refined along the boundaries, which come as polylines"),
    _job("minimum-acceleration", "minimum", "every amplitude at which motions begin or cease to overturn two blocks"),
    _job("rocking-spectrum", "spectrum", "how far blocks of all sizes rock on soft ground, under two models"),
    _job("stripes", "fragility", "how likely a column is to rock and to overturn at twelve levels"),
    _job("cloud", "fragility", "what peak ground velocity says about a statue under motions as they are"),
    _job("incremental", "fragility", "levels at which pulses overturn a block, and those at which it stands again"),
    Example(
        "inventory",
        "job",
        "which objects of a list stay standing in eighty motions of 0.3 g",
        ("jobs/inventory.toml", "jobs/objects.csv"),
        ("rocking inventory inventory.toml --out inventory.html",),
    ),
    Example(
        "histories",
        "job",
        "two blocks, two pulses, fifty scales, coefficients drawn anew at every impact",
        ("jobs/histories.toml",),
        (
            "rocking campaign run histories.toml --out histories",
            "rocking campaign export histories --out histories.csv",
        ),
    ),
)

EXAMPLES: dict[str, Example] = {each.name: each for each in _ALL}
"""Every example by name: a new one is one entry here, and its files."""
