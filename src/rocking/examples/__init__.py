"""Examples within the package: bodies, synthetic motions by seed, a list of objects, questions and jobs.

They are there to try things without own data, and in documentation. Bodies whose file names a source have the sizes
that it states; all else is invented for illustration: no real object was measured for it, and no motion is the record
of an earthquake.
"""

from pathlib import Path
from typing import Any, Literal, overload

from rocking import checks
from rocking.bodies import Body, Solid
from rocking.errors import InvalidValueError
from rocking.examples import table
from rocking.examples.catalogue import Catalogue, catalogue
from rocking.examples.table import Example
from rocking.motions.motion import GroundMotion

__all__ = ["Catalogue", "Example", "body", "catalogue", "motion", "path", "write"]


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

    example = _of(name, "body")
    return read_body(path(example.name), **example.options)


@overload
def motion(name: Literal["three-components"], seed: int | None = None) -> dict[str, GroundMotion]: ...  # type: ignore[overload-overlap]


@overload
def motion(name: str, seed: int | None = None) -> GroundMotion: ...


def motion(name: str, seed: int | None = None) -> Any:
    """Return an example of a ground motion, the same bits on every processor.

    Parameters
    ----------
    name : str
        As ``catalogue("motion")`` lists them.
    seed : int, optional
        Another motion of the same kind, at least 0; 1 if not given. A pulse takes none [-].

    Returns
    -------
    GroundMotion or dict of str to GroundMotion
        The motion; of "three-components" one along each of x, y and z. Model, seed, peak and duration are in the
        metadata.

    Raises
    ------
    InvalidValueError
        If there is no motion of that name, or the seed is none.

    Examples
    --------
    >>> shaking = motion("near-fault")
    >>> shaking.name, shaking.metadata["peak ground acceleration"]
    ('near-fault, seed 1', '4.422 m/s2')
    >>> shaking.metadata["model"]
    'pulse of Mavroeidis & Papageorgiou (2003) on modulated filtered white noise (Rezaeian & Der Kiureghian 2008)'
    >>> list(motion("three-components", seed=7))
    ['x', 'y', 'z']
    """
    example = _of(name, "motion")
    if example.seed is None:
        if seed is not None:
            raise InvalidValueError(
                "{example} is the same every time and takes no seed, got {value}", parameter="seed", value=seed,
                example=example.name,
            )  # fmt: skip
        return _described(example, _made(example), None)
    seed = example.seed if seed is None else checks.whole("seed", seed, high=2**60)
    made = _made(example, seed)
    if isinstance(made, dict):
        return {axis: _described(example, part, seed, axis) for axis, part in made.items()}
    return _described(example, made, seed)


def path(name: str) -> Path:
    """Return the file of an example within the package: a body, a list, a question or a job.

    Parameters
    ----------
    name : str
        As `catalogue` lists them.

    Returns
    -------
    Path
        The file, to be read and left as it is; `write` makes a copy.

    Raises
    ------
    InvalidValueError
        If there is no example of that name, or it is a motion, which is computed.

    Examples
    --------
    >>> path("overturning-map").name
    'overturning-map.toml'
    """
    example = _of(name)
    if not example.files:
        raise InvalidValueError(
            "{example} is computed and has no file: motion({example!r}) makes it, write(...) its record",
            example=example.name,
        )  # fmt: skip
    return table.HERE / example.files[0]


def write(name: str, folder: str | Path = ".", *, force: bool = False) -> list[Path]:
    """Write the files of an example into a folder, with records of the motions that its commands take.

    Parameters
    ----------
    name : str
        As `catalogue` lists them.
    folder : str or Path
        Where to; the current one if not given.
    force : bool
        Whether a file of the same name that holds something else is written over.

    Returns
    -------
    list of Path
        The files; `read_motion` reads a record back to the last bit.

    Raises
    ------
    InvalidValueError
        If there is no example of that name, no such folder, or a file of the same name holds something else.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in write("statue", folder)]
    ['statue.toml', 'near-fault.csv']
    """
    return table.written(_contents(_of(name)), Path(folder), force=force)


def _of(name: str, kind: str | None = None) -> Example:
    known = catalogue(kind)
    return known[checks.one_of(kind or "example", name, known)]


def _made(example: Example, *seed: int) -> Any:
    assert example.make is not None
    return example.make(*seed)


def _described(example: Example, made: GroundMotion, seed: int | None, axis: str = "") -> GroundMotion:
    """Return a motion that says what it is."""
    words = [example.name, *([axis] if axis else []), *([] if seed is None else [f"seed {seed}"])]
    told = {
        "example": f"{example.name} of rocking.examples, no record of an earthquake: {example.title}",
        "model": example.model,
        **({} if seed is None else {"seed": str(seed)}),
        **({"component": axis} if axis else {}),
        "peak ground acceleration": f"{made.peak:.4g} m/s2",
        "duration": f"{made.duration:.6g} s",
    }
    return made.changed(f"example {example.name}", name=", ".join(words), metadata=told)


def _contents(example: Example) -> dict[str, bytes]:
    made = {name: motion(name) for name in example.records}
    named = {name: each if isinstance(each, dict) else {"acceleration": each} for name, each in made.items()}
    return table.contents(example, named)
