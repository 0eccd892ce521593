"""A user's own evidence: files of measurements in a folder of this user's, never in the package; and selections."""

import hashlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from rocking.errors import InvalidValueError, MeasurementError
from rocking.evidence.measurements import GROUPS, DataSet, all_measurements, datasets, joined
from rocking.tables.table import writing, written_whole

PUBLISHED, OWN = "published", "own"
"""Words of a selection: the 39 coefficients of the package, and all files of the store."""


def data_folder() -> Path:
    """Return where what belongs to this user is kept, under the system's folder for data; not created here."""
    if sys.platform == "win32":
        root = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
    else:
        root = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local" / "share")
    return Path(root) / "rocking"


def store() -> Path:
    """Return the folder of this user's own evidence."""
    return data_folder() / "evidence"


def own_files() -> list[Path]:
    """Return the files of the store, in the order of their names."""
    return sorted(path for path in store().glob("[!.]*") if path.suffix in {".toml", ".csv"})


def own_sets() -> list[tuple[Path, DataSet]]:
    """Return the files of the store with what they hold; one that cannot be used is named, and no row counts twice."""
    from rocking.evidence.measurement_file import read_measurements

    found = []
    for path in own_files():
        try:
            found.append((path, read_measurements(path)))
        except MeasurementError as error:
            error.add_hint("it is part of your own evidence: delete the file to go on")
            raise
    _once([(str(path), data) for path, data in found])
    return found


def _once(sets: Sequence[tuple[str, DataSet]]) -> None:
    """Refuse measurements that are in two sets; an interface may be written in several ways, so it tells none apart."""
    seen: dict[tuple[object, ...], str] = {}
    for name, data in sets:
        ratios, values = ([f"{value:.9g}" for value in each] for each in (data.slenderness, data.coefficient))
        rows = set(zip(data.group, data.labels, ratios, values, strict=True))
        if both := rows & seen.keys():
            row = min(both)
            raise InvalidValueError(
                "the measurement {row} (group, block, h/b, r) is in {first} and in {second}: it would count twice",
                row=", ".join(map(str, row)), first=seen[row], second=name, hint="leave out or delete one of them",
            )  # fmt: skip
        seen |= dict.fromkeys(rows, name)


def add(path: Path) -> tuple[Path, DataSet, bool]:
    """Check a file of measurements and copy it into the store; return the copy, its data, and whether it is new."""
    from rocking.evidence.measurement_file import read_measurements

    data = read_measurements(path)
    content = path.read_bytes()
    target = store() / f"{path.stem}-{hashlib.sha256(content).hexdigest()[:8]}{path.suffix.lower()}"
    if target.exists():
        return target, data, False
    _once([*((str(kept), each) for kept, each in own_sets()), (str(path), data)])
    with writing(f"to {target.parent}"):
        target.parent.mkdir(parents=True, exist_ok=True)
        with written_whole(target) as unfinished:
            unfinished.write_bytes(content)
    return target, data, True


def selected(words: Sequence[str] = ()) -> DataSet:
    """Return the measurements of a selection: files, published sets, `published`, `own`; both of these if empty."""
    from rocking.evidence.measurement_file import read_measurements

    known, sets = {name: datasets()[name] for name in GROUPS}, []
    for word in dict.fromkeys(words or ((PUBLISHED, OWN) if own_files() else (PUBLISHED,))):
        if word == PUBLISHED:
            sets.append(all_measurements())
        elif word == OWN:
            if not (kept := [each for _, each in own_sets()]):
                raise InvalidValueError(
                    "{folder} has no measurements. Add them: rocking measurements add FILE", folder=str(store())
                )
            sets.append(kept[0] if len(kept) == 1 else joined(kept, OWN, "measurements of files"))
        elif word in known:
            sets.append(known[word])
        elif Path(word).suffix:
            sets.append(read_measurements(word))
        else:
            raise InvalidValueError(
                "no measurements named {name!r:.60}; there are {names}, and files .toml and .csv", name=word,
                names=", ".join((PUBLISHED, OWN, *known)),
            )  # fmt: skip
    _once([(each.name, each) for each in sets])
    return sets[0] if len(sets) == 1 else joined(sets, "+".join(each.name for each in sets), "a selection")
