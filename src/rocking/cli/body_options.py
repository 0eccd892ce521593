"""The body of a command: a file, or dimensions on the command line."""

import math
from pathlib import Path

from rocking.bodies import Block, Body
from rocking.checks import length_unit
from rocking.cli.shared_options import in_unit
from rocking.cli.solid_options import is_body
from rocking.conventions import FEET, Foot
from rocking.errors import BodyFileError, InvalidValueError


def body_from(
    file: Path | None,
    *,
    width: float | None,
    height: float | None,
    depth: float | None,
    density: float | None,
    angle: float | None,
    semi_diagonal: float | None,
    unit: str | None,
) -> Body:
    """Return the body that a command was given.

    density: density [kg/m3]; angle: slenderness angle [rad].
    """
    sizes = {"--width": width, "--height": height, "--angle": angle, "--semi-diagonal": semi_diagonal}
    given = [name for name, value in sizes.items() if value is not None]
    if file is not None:
        if given or depth is not None or density is not None:
            raise InvalidValueError("give a body file or dimensions, not both")
        from rocking.bodies.formats import read_body

        try:
            return read_body(file, units=unit)
        except BodyFileError as error:
            if is_body(file):
                raise
            raise BodyFileError(f"{error}; perhaps a record: see rocking motion {file}") from error
    scale = length_unit(unit or "m")
    options: dict[str, float] = {} if density is None else {"density": density}
    if depth is not None:
        options["depth"] = depth * scale
    if width is not None and height is not None and len(given) == 2:
        return Block(width=width * scale, height=height * scale, **options)
    if angle is not None and semi_diagonal is not None and len(given) == 2:
        return Block.from_angle(angle, semi_diagonal * scale, **options)
    raise InvalidValueError(
        "a body is a file, or --width and --height, or --angle and --semi-diagonal; "
        f"got {' '.join(given) if given else 'none of them'}"
    )


def body_words(body: Body, gravity: float, length: str = "m") -> str:
    """Return a plane body in a line.

    gravity: acceleration of gravity [m/s2]. Returns Kind, mass, and what decides how it rocks, of both feet where they
    differ.
    """
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    sides = {foot: body.side(foot, gravity) for foot in feet}
    shape = "; ".join(
        f"{'' if body.is_symmetric else f'{foot} '}alpha = {side.slenderness_angle:.4g} rad "
        f"({math.degrees(side.slenderness_angle):.3g} deg), R = {in_unit(side.semi_diagonal, length)}, "
        f"p = {side.frequency_parameter:.4g} rad/s"
        for foot, side in sides.items()
    )
    return f"{type(body).__name__}, {body.mass:.4g} kg, {shape}"
