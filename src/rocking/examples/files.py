"""What an example writes into a folder of the user: its own files, and records of the motions that it needs."""

from collections.abc import Mapping
from pathlib import Path

from rocking.errors import InvalidValueError
from rocking.examples.table import Example
from rocking.motions.motion import GroundMotion

HERE = Path(__file__).parent  # where the files of examples are, within the package


def record_text(motions: Mapping[str, GroundMotion]) -> str:
    """Return columns that `read_motion` reads back to the last bit, below what the motion is.

    >>> print(record_text({"x": GroundMotion([0.0, 0.1], 0.02, metadata={"seed": "1"})}))
    # seed: 1
    time [s],x [m/s2]
    0,0.0
    0.02,0.1
    <BLANKLINE>
    """
    parts = list(motions.values())
    lines = [f"# {key}: {value}" for key, value in parts[0].metadata.items()]
    lines.append(",".join(["time [s]", *(f"{name} [m/s2]" for name in motions)]))
    rows = zip(*(part.acceleration.tolist() for part in parts), strict=True)
    lines += [",".join([f"{k * parts[0].time_step:.9g}", *map(repr, row)]) for k, row in enumerate(rows)]
    return "\n".join([*lines, ""])


def contents(example: Example, motions: Mapping[str, Mapping[str, GroundMotion]]) -> dict[str, bytes]:
    """Return what stands in the files of an example; motions: by the names of its records."""
    own = {Path(file).name: (HERE / file).read_bytes() for file in example.files}
    return own | {f"{name}.csv": record_text(parts).encode() for name, parts in motions.items()}


def written(files: Mapping[str, bytes], folder: Path, *, force: bool) -> list[Path]:
    """Write files into a folder and return them; a file that holds something else is refused, before any is written."""
    paths = {folder / name: content for name, content in files.items()}
    if not folder.is_dir():
        raise InvalidValueError(f"no folder {str(folder)!r} to write {', '.join(files)} into")
    if folders := [str(path) for path in paths if path.is_dir()]:
        raise InvalidValueError(f"{', '.join(folders)}: a folder of that name is there already; take another folder")
    if not force and (odd := [path for path, content in paths.items() if holds_another(path, content)]):
        raise InvalidValueError(
            f"{', '.join(map(str, odd))}: there already, with something else in it; take another folder, or write over "
            "it with force"
        )
    for path, content in paths.items():
        path.write_bytes(content)
    return list(paths)


def holds_another(path: Path, content: bytes) -> bool:
    """Return whether there is something of that name that is not what would be written."""
    return path.exists() and path.read_bytes() != content
