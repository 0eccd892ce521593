"""Examples within the package: bodies, a list of objects, questions and jobs, to try things without own data.

All of them are invented for illustration: no real object was measured for them.
"""

from pathlib import Path

from rocking import checks
from rocking.bodies import Body, Solid
from rocking.examples.catalogue import Catalogue, catalogue
from rocking.examples.table import Example

__all__ = ["Catalogue", "Example", "body", "catalogue", "path"]


def body(name: str) -> Body | Solid:
    """Return an example of a body.

    Parameters
    ----------
    name : str
        As ``catalogue("body")`` lists them.

    Returns
    -------
    Body or Solid
        The body, plane or in space.

    Raises
    ------
    InvalidValueError
        If there is no body of that name; the error lists them.

    Examples
    --------
    >>> statue = body("statue")
    >>> round(statue.side("left").slenderness_angle, 3), round(statue.side("right").slenderness_angle, 3)
    (0.356, 0.289)
    """
    from rocking.bodies.formats import read_body

    known = catalogue("body")
    example = known[checks.one_of("body", name, known)]
    return read_body(path(example.name), **example.options)


def path(name: str) -> Path:
    """Return the file of an example within the package: a body, a list, a question or a job.

    Parameters
    ----------
    name : str
        As `catalogue` lists them.

    Returns
    -------
    Path
        The file, which is to be read only.

    Raises
    ------
    InvalidValueError
        If there is no example of that name; the error lists them.

    Examples
    --------
    >>> path("overturning-map").name
    'overturning-map.toml'
    """
    known = catalogue()
    return Path(__file__).parent / known[checks.one_of("example", name, known)].files[0]
