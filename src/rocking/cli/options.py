"""Options that several commands have."""

from collections.abc import Mapping
from typing import Annotated

import typer

_BODY = "Size, in place of a body file"
_FILE = "What a record file leaves open"
_MESH = "What a mesh file leaves open"
_HOW = "How it is computed"
_OUTPUT = "Output"
Width = Annotated[float | None, typer.Option(help=r"Full width of a block \[m, or --units].", rich_help_panel=_BODY)]
Height = Annotated[float | None, typer.Option(help=r"Full height of a block \[m, or --units].", rich_help_panel=_BODY)]
Depth = Annotated[float | None, typer.Option(help=r"Depth of a block \[m, or --units].", rich_help_panel=_BODY)]
Density = Annotated[float | None, typer.Option(help=r"Density \[kg/m3].", rich_help_panel=_BODY)]
Angle = Annotated[
    float | None, typer.Option(help=r"Slenderness angle alpha = atan(b/h) \[rad].", rich_help_panel=_BODY)
]
SemiDiagonal = Annotated[
    float | None, typer.Option(help=r"Semi-diagonal R, with --angle \[m, or --units].", rich_help_panel=_BODY)
]
Up = Annotated[
    str | None, typer.Option(help="Axis of a mesh that points up: z, or y as in GLB files.", rich_help_panel=_MESH)
]
FillHoles = Annotated[
    bool, typer.Option("--fill-holes", help="Close holes of less than 1 % of the surface.", rich_help_panel=_MESH)
]
BaseTolerance = Annotated[
    float | None,
    typer.Option(
        help=r"Points this close to the lowest one stand on the ground \[m, or --units].", rich_help_panel=_MESH
    ),
]
Format = Annotated[
    str | None, typer.Option(help="Format, if not found by content: see rocking formats.", rich_help_panel=_FILE)
]
Units = Annotated[
    str | None,
    typer.Option(
        help="Units: of lengths m, cm, mm, ft, in; of a record m/s2, cm/s2, mm/s2, gal, g, g/10, mg; or mm,g."
    ),
]
RecordUnits = Annotated[
    str | None, typer.Option("--units", help="Unit of the record: m/s2, cm/s2, mm/s2, gal, g, g/10, mg.")
]
TimeStep = Annotated[float | None, typer.Option(help=r"Step between samples \[s].", rich_help_panel=_FILE)]
Component = Annotated[str | None, typer.Option(help="Horizontal component, by name.", rich_help_panel=_FILE)]
Vertical = Annotated[str | None, typer.Option(help="Vertical component, by name.", rich_help_panel=_FILE)]
VerticalFile = Annotated[
    str | None, typer.Option(help="File of the vertical component, where it has its own.", rich_help_panel=_FILE)
]
BodyFile = Annotated[
    str | None,
    typer.Argument(
        help="Body file: TOML, or WKT, GeoJSON, DXF, or a mesh STL, OBJ, PLY with --units; left out with --width."
    ),
]
Record = Annotated[str | None, typer.Argument(help="Record file, or a pulse such as sine:amplitude=3,period=0.8.")]
Motion = Annotated[str | None, typer.Option(help="The same, as an option.")]
Restitution = Annotated[str, typer.Option(help="Model as in rocking models, my_file.py:MyModel, or a coefficient.")]
Linear = Annotated[bool, typer.Option("--linear", help="Slender-linear equations.", rich_help_panel=_HOW)]
Engine = Annotated[str, typer.Option(help="auto, fast or reference.", rich_help_panel=_HOW)]
Gravity = Annotated[float | None, typer.Option(help=r"Acceleration of gravity \[m/s2].", rich_help_panel=_HOW)]
Threads = Annotated[int | None, typer.Option(help="Threads; the results do not depend on them.", rich_help_panel=_HOW)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.", rich_help_panel=_OUTPUT)]


def units_of(word: str | None, *kinds: Mapping[str, float]) -> tuple[str | None, ...]:
    """Return the unit of every kind in a word such as ``mm,g``; no unit is of two kinds.

    Returns one of each kind, None where none was given.

    >>> from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS
    >>> units_of("g, mm", LENGTH_UNITS, ACCELERATION_UNITS), units_of(None, LENGTH_UNITS)
    (('mm', 'g'), (None,))
    """
    from rocking import checks
    from rocking.errors import InvalidValueError

    found: list[str | None] = [None] * len(kinds)
    for part in [] if word is None else word.split(","):
        name = checks.one_of("--units", part.strip(), [each for kind in kinds for each in kind])
        place = next(k for k, kind in enumerate(kinds) if name in kind)
        if found[place] is not None:
            raise InvalidValueError(f"--units must have one unit of a kind, got {found[place]} and {name}")
        found[place] = name
    return tuple(found)


def in_unit(value: float, unit: str, digits: str = ".4g") -> str:
    """Return a length or an acceleration in the unit in which the question was asked.

    value: length or acceleration [m or m/s2].

    >>> in_unit(0.5, "mm"), in_unit(1.0, "gal")
    ('500 mm', '100 gal')
    """
    from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS

    return f"{value / {**LENGTH_UNITS, **ACCELERATION_UNITS}[unit]:{digits}} {unit}"


def beside_g(unit: str) -> str:
    """Return the unit in which an acceleration is written where it stands in g too.

    Returns the same, and m/s2 in place of g.
    """
    return "m/s2" if unit == "g" else unit
