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


def write_csv(path: Path, columns: dict[str, tuple[Any, str]]) -> None:
    """Write values with their units as comma-separated values, all digits kept."""
    import numpy as np

    from rocking.quantities import QUANTITIES
    from rocking.tables import Column, Table, to_csv

    codes = {name: QUANTITIES[name].codes if name in QUANTITIES else {} for name in columns}
    table = {name: Column(np.asarray(v), unit, codes=codes[name]) for name, (v, unit) in columns.items()}
    to_csv(Table("row", table, no_unit="1"), path, blank=False)


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
