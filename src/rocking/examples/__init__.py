"""Built-in examples: bodies, synthetic motions by seed, lists of objects, input files and jobs.

The examples need no user data. Bodies with a source in their file have the dimensions of that source. All other
examples are invented: no real object was measured, and no motion is the record of an earthquake.
"""

from pathlib import Path
from typing import Any, Literal, cast, overload

from rocking import checks
from rocking.bodies import Body, Solid
from rocking.errors import InvalidValueError
from rocking.examples import table
from rocking.examples.catalogue import Catalogue, catalogue
from rocking.examples.table import Example
from rocking.motions.motion import GroundMotion

__all__ = ["Catalogue", "Example", "body", "catalogue", "motion", "path", "write"]


def body(name: str) -> Body | Solid:
    """Return an example body.

    Parameters
    ----------
    name : str
        Name from ``catalogue("body")``.

    Returns
    -------
    Body or Solid
        Plane or 3D body.

    Raises
    ------
    InvalidValueError
        If the body is unknown; the error lists the names.

    Examples
    --------
    >>> statue = body("statue")
    >>> round(statue.side("left").slenderness_angle, 3), round(statue.side("right").slenderness_angle, 3)
    (0.356, 0.289)
    """
    from rocking.bodies.formats import read_body

    example = _of(name, "body")
    return cast("Body | Solid", read_body(path(example.name), **example.options))  # the examples have no restraints


@overload
def motion(name: Literal["three-components"], seed: int | None = None) -> dict[str, GroundMotion]: ...  # type: ignore[overload-overlap]


@overload
def motion(name: str, seed: int | None = None) -> GroundMotion: ...


def motion(name: str, seed: int | None = None) -> Any:
    """Return an example ground motion, with the same bits on every processor.

    Parameters
    ----------
    name : str
        Name from ``catalogue("motion")``.
    seed : int, optional
        Random seed for another motion of this type, >= 0; the default is 1. The pulse has no seed [-].

    Returns
    -------
    GroundMotion or dict of str to GroundMotion
        Motion, or motions along x, y and z for "three-components". The metadata contain model, seed, peak and
        duration.

    Raises
    ------
    InvalidValueError
        If the motion is unknown, or the seed is invalid.

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
                "{example} has no seed, got {value}", parameter="seed", value=seed,
                example=example.name,
            )  # fmt: skip
        return _described(example, _made(example), None)
    seed = example.seed if seed is None else checks.whole("seed", seed, high=2**60)
    result = _made(example, seed)
    if isinstance(result, dict):
        return {axis: _described(example, component, seed, axis) for axis, component in result.items()}
    return _described(example, result, seed)


def path(name: str) -> Path:
    """Return the path of an example file in the package: a body, a list, an input file or a job.

    Parameters
    ----------
    name : str
        Name from `catalogue`.

    Returns
    -------
    Path
        Path of the file, for reading only; `write` creates a copy.

    Raises
    ------
    InvalidValueError
        If the example is unknown, or is a motion, which has no file.

    Examples
    --------
    >>> path("overturning-map").name
    'overturning-map.toml'
    """
    example = _of(name)
    if not example.files:
        raise InvalidValueError(
            "{example} is computed and has no file; use motion({example!r}), or write(...) for a record",
            example=example.name,
        )  # fmt: skip
    return table.HERE / example.files[0]


def write(name: str, folder: str | Path = ".", *, force: bool = False) -> list[Path]:
    """Write the files of an example into a folder, with the records for its commands.

    Parameters
    ----------
    name : str
        Name from `catalogue`.
    folder : str or Path
        Output folder; the default is the current folder.
    force : bool
        True to replace existing files with other content.

    Returns
    -------
    list of Path
        Paths of the files; `read_motion` reads the records without rounding.

    Raises
    ------
    InvalidValueError
        If the example or the folder is unknown, or a file with other content exists.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in write("statue", folder)]
    ['statue.toml', 'near-fault.csv']
    """
    return table.written(_contents(_of(name)), Path(folder), force=force)


def _of(name: str, kind: str | None = None) -> Example:
    examples = catalogue(kind)
    return examples[checks.one_of(kind or "example", name, examples)]


def _made(example: Example, *seed: int) -> Any:
    assert example.make is not None
    return example.make(*seed)


def _described(example: Example, motion: GroundMotion, seed: int | None, axis: str = "") -> GroundMotion:
    """Return a motion with name and metadata of its example."""
    texts = [example.name, *([axis] if axis else []), *([] if seed is None else [f"seed {seed}"])]
    metadata = {
        "example": f"{example.name} of rocking.examples, no record of an earthquake: {example.title}",
        "model": example.model,
        **({} if seed is None else {"seed": str(seed)}),
        **({"component": axis} if axis else {}),
        "peak ground acceleration": f"{motion.peak:.4g} m/s2",
        "duration": f"{motion.duration:.6g} s",
    }
    return motion.changed(f"example {example.name}", name=", ".join(texts), metadata=metadata)


def _contents(example: Example) -> dict[str, bytes]:
    results = {name: motion(name) for name in example.records}
    named = {name: result if isinstance(result, dict) else {"acceleration": result} for name, result in results.items()}
    return table.contents(example, named)
