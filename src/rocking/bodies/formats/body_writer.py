"""Write a body as the text of a TOML body file that gives the same body back, to the last bit."""

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import singledispatch

import numpy as np

from rocking.bodies.block import Block
from rocking.bodies.body import Body
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.section import Section
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

_Places = dict[float, float]


@singledispatch
def body_to_toml(body: Body) -> str:
    """Return the text of a body file that describes a body.

    Reading it gives the same numbers to the last bit. Only a `Section` that was mirrored or scaled may come back
    with its last bits changed; and one that was scaled down so far from its origin that its coordinates cannot
    hold it is written about its own origin, which the text says.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.

    Returns
    -------
    str
        TOML, in m and kg/m3.

    Raises
    ------
    InvalidValueError
        If this kind of body cannot be written.

    Examples
    --------
    >>> print(body_to_toml(Block(width=1.0, height=4.0)))
    units = "m"
    <BLANKLINE>
    [block]
    width = 1.0
    height = 4.0
    depth = 1.0
    density = 2400.0
    <BLANKLINE>
    """
    raise InvalidValueError(f"a {type(body).__name__} body cannot be written as a body file")


@body_to_toml.register
def _(body: Block) -> str:
    sizes = (f"{key} = {_number(getattr(body, key))}" for key in ("width", "height", "depth", "density"))
    return _lines('units = "m"', "", "[block]", *sizes, *_known(body, 0.0, 0.0))


@body_to_toml.register
def _(body: MassPoints) -> str:
    lines = [f"points = {_points(body.points)}", f"masses = {_row(body.masses)}", f"feet = {_row(body.feet)}"]
    if body.local_contact != (body.feet,):
        lines.append(f"contact = {_points(body.local_contact)}")
    return _lines('units = "m"', "", "[mass_points]", *lines)


@body_to_toml.register
def _(body: Section) -> str:
    remarks, x, y = _coordinates(body)
    lines = [*remarks, 'units = "m"', "", "[section]", f"feet = {_row([x[foot] for foot in body.local_feet])}"]
    lines += [f"depth = {_number(body.depth)}", f"ground = {_number(0.0 if remarks else body.ground)}"]
    lines += _known(body, 0.0 if remarks else body.origin_x, 0.0 if remarks else body.ground)
    for region in body.regions:
        outline, *holes = ([(x[a], y[b]) for a, b in ring.tolist()] for ring in region.rings)
        lines += ["", "[[section.region]]", f"density = {_number(region.density)}", f"outline = {_points(outline)}"]
        if holes:
            lines.append(f"holes = [{', '.join(_points(hole) for hole in holes)}]")
    return _lines(*lines)


def _known(body: Block | Section, x: float, y: float) -> list[str]:
    """Return the lines of what is known of a body, the centre seen from an origin at (-x, -y) [m]."""
    known = body.known
    lines = []
    if known is not None and known.centre is not None:
        place = (next(_preimages(c, shift), c + shift) for c, shift in zip(known.centre, (x, y), strict=True))
        lines.append(f"centre = {_row(list(place))}")
    if known is not None and known.moment_of_inertia is not None:
        lines.append(f"moment_of_inertia = {_number(known.moment_of_inertia)}")
    return lines


def _coordinates(body: Section) -> tuple[list[str], _Places, _Places]:
    """Return remarks, and the user's coordinate of every local one."""
    rings = [ring for region in body.regions for ring in region.rings]
    x = np.unique(np.concatenate([*(ring[:, 0] for ring in rings), body.local_feet]))
    y = np.unique(np.concatenate([ring[:, 1] for ring in rings]))
    low, _, high, _ = body.local_box
    there_x, there_y = _placed(x, body.origin_x), _placed(y, body.ground)
    _keep_middle(there_x, low, high, body.origin_x)
    held = all(
        b - shift == a for there, shift in ((there_x, body.origin_x), (there_y, body.ground)) for a, b in there.items()
    )
    coarse = max(math.ulp(body.origin_x), math.ulp(body.ground)) > 1e-12 * (high - low)
    if held or not coarse:
        return [], there_x, there_y
    remark = f"# about its own origin, x = {body.origin_x!r} m, y = {body.ground!r} m"
    return [remark], _placed(x, 0.0), _placed(y, 0.0)


def _placed(values: FloatArray, shift: float) -> _Places:
    """Return for each local value the nearest number that the reader will turn into it by subtracting `shift`."""
    return {value: next(_preimages(value, shift), value + shift) for value in values.tolist()}


def _preimages(value: float, shift: float) -> Iterator[float]:
    """Yield numbers u near value + shift with u - shift == value in floating point."""
    guess = value + shift
    fine = math.ulp(value)
    near = [guess, math.nextafter(guess, math.inf), math.nextafter(guess, -math.inf)]
    near += [guess + k * fine for k in (0.25, -0.25, 0.5, -0.5)]
    return (u for u in near if u - shift == value)


def _keep_middle(places: _Places, low: float, high: float, origin: float) -> None:
    """Choose the ends so that the middle of the box, the local origin, comes out the same to the last bit."""
    for a in _preimages(low, origin):
        for b in _preimages(high, origin):
            if 0.5 * (a + b) == origin:
                places[low], places[high] = a, b
                return


def _number(value: float) -> str:
    return repr(float(value))


def _row(values: Sequence[float] | FloatArray) -> str:
    return f"[{', '.join(_number(value) for value in values)}]"


def _points(points: Iterable[Sequence[float]] | FloatArray) -> str:
    return f"[{', '.join(_row(point) for point in points)}]"


def _lines(*lines: str) -> str:
    return "\n".join(lines) + "\n"
