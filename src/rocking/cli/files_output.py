"""Files that the commands of studies write, and their numbers as JSON."""

from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError


def check_files(picture: Path | None, *others: Path | None) -> None:
    """Refuse, before anything is computed, files that could not be written."""
    if picture is not None and picture.suffix not in {".png", ".svg", ".pdf"}:
        raise InvalidValueError(f"a picture is .png, .svg or .pdf, got {picture.name!r}")
    for path in (picture, *others):
        if path is not None and not path.parent.is_dir():
            raise InvalidValueError(f"no folder {str(path.parent)!r} to write {path.name!r} into")


def write_csv(path: Path, head: list[str], columns: list[Any]) -> None:
    """Write columns as comma-separated values, all digits kept."""
    import numpy as np

    from rocking.tables import Column, Table, to_csv

    table = Table("row", {name: Column(np.asarray(values), "") for name, values in zip(head, columns, strict=True)})
    to_csv(table, path, blank=False)


def plain(values: Any) -> Any:
    """Return an array as nested lists for JSON, with null where there is no number.

    >>> plain([[1.0, float("nan")]])
    [[1.0, None]]
    """
    import numpy as np

    array = np.asarray(values)
    made = array.astype(object)
    made[~np.isfinite(array)] = None
    return made.tolist()
