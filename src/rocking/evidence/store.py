"""The user's own evidence: files of measurements in a folder of the user, outside the package, and their selection."""

import hashlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from rocking import checks
from rocking.errors import InvalidValueError, MeasurementError
from rocking.evidence.measurements import GROUPS, DataSet, all_measurements, datasets, joined
from rocking.tables.table import writing, written_whole

PUBLISHED, OWN = "published", "own"
"""Names of two selections: the 39 coefficients of the package, and all files of the store."""


def data_folder() -> Path:
    """Return the folder of the user's data, within the system's folder for data. The folder may be absent."""
    if sys.platform == "win32":
        root = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
    else:
        root = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local" / "share")
    return Path(root) / "rocking"


def store() -> Path:
    """Return the folder of this user's own evidence."""
    return data_folder() / "evidence"


def own_files() -> list[Path]:
    """Return the files of the store, sorted by name."""
    return sorted(path for path in store().glob("[!.]*") if path.suffix in {".toml", ".csv"})


def own_sets() -> list[tuple[Path, DataSet]]:
    """Return the files of the store with their data; raise an error for unusable files and duplicate rows."""
    from rocking.evidence.measurement_file import read_measurements

    sets = []
    for path in own_files():
        try:
            sets.append((path, read_measurements(path)))
        except MeasurementError as error:
            error.add_hint("this file is in your own evidence; delete it to continue")
            raise
    _once([(str(path), data) for path, data in sets])
    return sets


def _once(sets: Sequence[tuple[str, DataSet]]) -> None:
    """Raise an error for a measurement in two sets. The interface is not compared, because its spelling varies."""
    first_source: dict[tuple[object, ...], str] = {}
    for name, data in sets:
        ratios, values = ([f"{value:.9g}" for value in column] for column in (data.slenderness, data.coefficient))
        rows = set(zip(data.group, data.labels, ratios, values, strict=True))
        if common := rows & first_source.keys():
            row = min(common)
            raise InvalidValueError(
                "the measurement {row} (group, block, h/b, r) is in both {first} and {second}",
                row=", ".join(map(str, row)), first=first_source[row], second=name, hint="omit or delete one of them",
            )  # fmt: skip
        first_source |= dict.fromkeys(rows, name)


def add(path: Path) -> tuple[Path, DataSet, bool]:
    """Check a file of measurements and copy it into the store; return the copy, its data, and True for a new file."""
    from rocking.evidence.measurement_file import read_measurements

    data = read_measurements(path)
    content = path.read_bytes()
    target = store() / f"{path.stem}-{hashlib.sha256(content).hexdigest()[:8]}{path.suffix.lower()}"
    if target.exists():
        return target, data, False
    _once([*((str(kept), data_of_file) for kept, data_of_file in own_sets()), (str(path), data)])
    with writing(f"to {target.parent}"):
        target.parent.mkdir(parents=True, exist_ok=True)
        with written_whole(target) as unfinished:
            unfinished.write_bytes(content)
    return target, data, True


def selected(names: Sequence[str] = ()) -> DataSet:
    """Return the measurements of a selection of files, published sets, `published` and `own`; default: the last two."""
    from rocking.evidence.measurement_file import read_measurements

    published, sets = {name: datasets()[name] for name in GROUPS}, []
    for choice in dict.fromkeys(names or ((PUBLISHED, OWN) if own_files() else (PUBLISHED,))):
        if choice == PUBLISHED:
            sets.append(all_measurements())
        elif choice == OWN:
            if not (own := [data for _, data in own_sets()]):
                raise InvalidValueError(
                    "{folder} has no measurements; add them with rocking measurements add FILE", folder=str(store())
                )
            sets.append(own[0] if len(own) == 1 else joined(own, OWN, "measurements of files"))
        elif choice in published:
            sets.append(published[choice])
        elif Path(choice).suffix:
            sets.append(read_measurements(choice))
        else:
            raise InvalidValueError(
                "unknown measurements {name!r:.60}; use {names}, or a .toml or .csv file", name=choice,
                names=", ".join((PUBLISHED, OWN, *published)),
                hint=checks.nearest(choice, (PUBLISHED, OWN, *published)),
            )  # fmt: skip
    _once([(data.name, data) for data in sets])
    return sets[0] if len(sets) == 1 else joined(sets, "+".join(data.name for data in sets), "a selection")
