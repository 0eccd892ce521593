"""Sets of records from a folder, a pattern or a list of files. The components of a station are combined."""

import csv
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from rocking import plausibility
from rocking.errors import InvalidValueError, RecordError, RockingError
from rocking.messages import listed
from rocking.motions.components import Components, with_vertical
from rocking.motions.formats.directions import (
    DOWN,
    KEY,
    UNCLEAR,
    UP,
    Direction,
    as_text,
    of_metadata,
    orientation,
    settled,
)
from rocking.motions.formats.file_options import FileOptions, Options, by_path, together
from rocking.motions.formats.reader import delay, motions_in
from rocking.motions.formats.stations import Places, is_station_file
from rocking.motions.motion import GroundMotion

PERPENDICULAR = 5.0  # tolerance of the right angle between two components [degree]
FEW = 48  # for fewer files, one process is faster than several
MAX_WARNINGS = 6  # largest number of warnings about single files

_AT_END = re.compile(
    r"(?:[-_. ]?(?:\d{3}|UP|DO?WN|VERT?|VRT|[NE]-?[SW]|U-?D|[BHCEL][HNLG][ENZ12])|[-_. ][NEZUVXYLT])\d?$",
    re.IGNORECASE,
)
_CODE = re.compile(r"(?<![A-Z0-9])[A-Z][HLGMN][ENZ12](?![A-Z0-9])")
_OF_NAMES = re.compile(r"^(horizontal-1|horizontal-2|vertical) acc\.? filename$")
_PEER_AXES = {"horizontal-1": "x", "horizontal-2": "y", "vertical": "z"}
_PEER = "horizontal-1 acc. filename"
_TITLES = {"motion", "file", "x"}
_ALSO = {"record": "motion", "factor": "scale", "aufzeichnung": "motion", "datei": "motion", "faktor": "scale",
         "skalierung": "scale", "registrazione": "motion", "fattore": "scale"}  # fmt: skip
_OPTION_COLUMNS = {"units": "units", "unit": "units", "einheit": "units", "unità": "units", "time_step": "time_step",
          "dt": "time_step", "format": "format", "skip": "skip"}  # fmt: skip
"""Columns of a list that contain options for the files of a row, and the names of these options."""

LARGEST_LIST = 1 << 24  # largest list of records [bytes]
_TOP = 500  # largest number of lines before the list of files in a PEER list
_SPECIAL = "*?["


Reason = str | RockingError


@dataclass(frozen=True, eq=False)
class RecordSet:
    """Records of several stations or earthquakes, and the omitted files.

    Parameters
    ----------
    records : tuple of Components
        One motion per record: horizontal components x and y, and z (upwards). Missing components are None.
    left_out : tuple of pairs of str and str or RockingError
        Files that are unreadable or have components that do not match, with the reason.

    Examples
    --------
    >>> along = GroundMotion([0.0, 1.0, -2.0], 0.1, name="along")
    >>> both = RecordSet((Components(along, along.scaled(0.5), None),))
    >>> [motion.peak for motion in both.plane()]
    [2.0, 1.0]
    """

    records: tuple[Components, ...]
    left_out: tuple[tuple[str, Reason], ...] = ()

    def __len__(self) -> int:
        return len(self.records)

    def __iter__(self) -> Iterator[Components]:
        return iter(self.records)

    def __getitem__(self, index: int) -> Components:
        return self.records[index]

    def plane(self) -> list[GroundMotion]:
        """Return the motions for plane bodies: every horizontal component, with the vertical component of its record.

        Returns
        -------
        list of GroundMotion
            One motion per horizontal component. A record with only a vertical component gives no motion.
        """
        return [motion for record in self.records for motion in plane_motions(record)]

    def mirrored(self) -> "RecordSet":
        """Return every record twice: as recorded, and with reversed polarity of the horizontal components.

        Returns
        -------
        RecordSet
            Set of twice the length. The vertical components are unchanged.
        """
        return replace(
            self, records=tuple(motion for record in self.records for motion in (record, reversed_polarity(record)))
        )


def plane_motions(record: Components) -> list[GroundMotion]:
    """Return the horizontal components of a record, combined with its vertical component."""
    level = [component for component in (record.x, record.y) if component is not None]
    if len({component.name for component in level}) < len(level):  # add the component, so that names are unique
        level = [
            replace(component, name=f"{component.name} {component.metadata.get('component', '')}".strip())
            for component in level
        ]
    return level if record.z is None else [with_vertical(component, record.z) for component in level]


def reversed_polarity(motion: Any) -> Any:
    """Return a motion with the opposite sign of its horizontal components."""
    if isinstance(motion, Components):
        x, y = (None if component is None else reversed_polarity(component) for component in (motion.x, motion.y))
        return Components(x, y, motion.z)
    return motion.changed("polarity reversed", acceleration=-motion.acceleration, name=f"{motion.name}, reversed")


def read_records(  # noqa: PLR0913 - all are properties of some sets
    where: str | PathLike[str] | Sequence[str | PathLike[str]],
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    *,
    files: FileOptions | None = None,
    stations: Places | None = None,
    skip: int = 0,
    workers: int = 1,
    progress: Callable[[int], None] | None = None,
) -> RecordSet:
    r"""Return the records of files, a folder, a pattern or a list. The components of a record are in one motion.

    Files with one component form one motion if their names differ only in the component (``ELC180``, ``ELC270``,
    ``ELC-UP``; ``.NS``, ``.EW``, ``.UD``), and if their time steps, starts, events and azimuths agree. Other components
    remain separate motions. Components are cut to the length of the shortest component. The azimuth of y is 90 degrees
    to the left of x, such as East and North. Downward components are reversed.

    A list is a CSV file of PEER search results, or a CSV file with the column motion (or x, y, z). Optional columns are
    scale and name, and units, time_step, format and skip of the files of a row. Scale factors of PEER are only
    metadata.

    Parameters
    ----------
    where : path-like, or sequence of path-like
        Folder with its subfolders, pattern such as ``records/*.at2``, list of files, or one file. Files of several
        inputs are combined as in one folder. Repeated files are read once.
    format, units, time_step : optional
        Options of `read_motion`, for all files.
    files : mapping of path-like to mapping, optional
        Options of single files by file name: ``units``, ``time_step`` [s], ``format`` and ``skip``, such as ``{"a.txt":
        {"units": "g"}}``. They replace the options for all files. To be unique, a name may include folders.
    stations : path-like or sequence of path-like, optional
        StationXML files, or folders of them, which convert counts in miniSEED files to accelerations, by network,
        station, location, channel and date. By default, the StationXML files in `where`.
    skip : int
        Number of lines to skip at the top of every text file.
    workers : int
        Number of processes.
    progress : callable, optional
        Called with the number of newly read files.

    Returns
    -------
    RecordSet
        Records; `left_out` contains unreadable files.

    Raises
    ------
    RecordError
        If no file exists, or no file is readable.
    InvalidValueError
        If `files` contains an unknown file, key or value, or repeats a key from the row of the file in a list.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from rocking.motions.formats import write_motion
    >>> with TemporaryDirectory() as folder:
    ...     for end in ("180", "270", "-UP"):
    ...         write_motion(GroundMotion([0.0, 1.0, 0.0], 0.1), Path(folder, f"ELC{end}.AT2"), "peer")
    ...     records = read_records(folder)
    >>> len(records), [part is not None for part in records[0].parts]
    (1, [True, True, True])
    """
    roots = [Path(where)] if isinstance(where, str | PathLike) else [Path(entry) for entry in where]
    lists = [(path, rows) for path in roots if (rows := rows_of_list(path)) is not None]
    listed = {path for path, _ in lists}
    paths = list(dict.fromkeys(file for path in roots if path not in listed for file in paths_of(path)))
    station_paths = [file for file in paths if is_station_file(file)]
    options: dict[str, Any] = {"format": format, "units": units, "time_step": time_step, "skip": skip}
    read = partial(_read, **options, stations=stations or station_paths or None)
    records: list[Components] = []
    left_out: list[tuple[str, Reason]] = []
    paths = [file for file in paths if file not in station_paths]
    in_lists = [file for path, rows in lists for row in rows for file in row.paths(path.parent).values()]
    own = by_path(files, [*paths, *in_lists])
    items = [(path, tuple(sorted(own.get(path, {}).items()))) for path in paths]
    for record_set in (
        *(_of_list(path, rows, own, read, workers, progress) for path, rows in lists),
        paired(zip(paths, mapped(read, items, workers, progress), strict=True)),
    ):
        records += record_set.records
        left_out += record_set.left_out
    if not records:
        named = ", ".join(map(str, roots[:MAX_WARNINGS])) or "no file"
        if not left_out:
            raise RecordError("{folders}: 0 files", folders=named, hint="check the path")
        file, reason = left_out[0]
        cause, hint = (reason, "") if isinstance(reason, str) else (reason.cause, reason.hint)
        raise RecordError(
            "{named}: 0 of {count} files are readable; {file}: {cause}",
            named=named, count=len(left_out), file=file, cause=cause, hint=hint,
        )  # fmt: skip
    return RecordSet(tuple(records), tuple(left_out))


def _of_list(
    path: Path,
    rows: Sequence["ListedRecord"],
    own: Mapping[Path, Mapping[str, Any]],
    read: Callable[["Item"], "Read"],
    workers: int,
    progress: Callable[[int], None] | None,
) -> RecordSet:
    """Return the records of the rows of a list, with files in the folder of the list.

    `own` contains options by file.
    """
    items: list[dict[str, Item]] = [
        {axis: (file, together(file, row.options, own.get(file, {}), path.name)) for axis, file in paths.items()}
        for row in rows
        for paths in [row.paths(path.parent)]
    ]
    distinct = list(dict.fromkeys(item for by_axis in items for item in by_axis.values()))
    reads = dict(zip(distinct, mapped(read, distinct, workers, progress), strict=True))
    read_by_axis = [{axis: reads[item] for axis, item in by_axis.items()} for by_axis in items]
    return _listed(zip(rows, read_by_axis, strict=True))


def paths_of(where: str | PathLike[str]) -> list[Path]:
    """Return the files of a folder or pattern in alphabetical order, without hidden files, or the single file."""
    path = Path(where)
    if path.is_dir():
        return sorted(file for file in path.rglob("*") if file.is_file() and not _is_hidden(file.relative_to(path)))
    if path.is_file() or not any(mark in str(where) for mark in _SPECIAL):
        return [path]
    root = Path(path.anchor)
    matches = sorted(file for file in root.glob(str(path.relative_to(root))) if file.is_file())
    if not matches:
        raise RecordError("{pattern}: no file matches the pattern", pattern=str(where))
    return matches


def _is_hidden(path: Path) -> bool:
    return any(name.startswith((".", "__MACOSX")) for name in path.parts)


def mapped(
    function: Callable[[Any], Any], items: Sequence[Any], workers: int, progress: Callable[[int], None] | None
) -> Iterator[Any]:
    """Apply a function to every item and yield the results in order. Many items use several processes."""
    done = progress or (lambda _: None)
    if workers <= 1 or len(items) < FEW:
        for item in items:
            yield function(item)
            done(1)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    try:
        with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
            for result in pool.map(function, items, chunksize=4):
                yield result
                done(1)
    except BrokenProcessPool as error:
        hint = 'put the calls of a script under if __name__ == "__main__":, or use workers=1'
        raise InvalidValueError(
            "{workers} workers could not start, or one of them ended", workers=workers, hint=hint
        ) from error


Read = tuple[list[GroundMotion] | RockingError, list[str]]  # components or an error, and warnings


def _read(item: "Item", **options: Any) -> Read:
    """Return the motions or the error of one file, read with its own options, and the warnings. Runs in any process."""
    path, own = item
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        try:
            motions: list[GroundMotion] | RockingError = motions_in(path, **{**options, **dict(own)})
        except RockingError as error:
            motions = error.without_file(path.name)
    return motions, [str(warning.message) for warning in doubts]


def _motions(path: Path, read: Read, left_out: list[tuple[str, Reason]], doubted: list[str]) -> list[GroundMotion]:
    motions, doubts = read
    texts = [doubt.removeprefix("check the input: ").removeprefix(f"{path.name}: ") for doubt in doubts]
    doubted += (f"{path.name}: {doubt}" for doubt in texts)
    if isinstance(motions, RockingError):
        left_out.append((str(path), motions))
        return []
    metadata = {"file": path.name} | ({"doubts": listed(texts)} if texts else {})
    return [replace(motion, metadata={**motion.metadata, **metadata}) for motion in motions]


def _warn(doubted: list[str]) -> None:
    """Issue the first warnings, and a warning with the number of other warnings."""
    plausibility.warn(doubted if len(doubted) <= MAX_WARNINGS else doubted[: MAX_WARNINGS - 1])
    if (more := len(doubted) - MAX_WARNINGS + 1) > 1:
        plausibility.warn([f"{more} more doubts about these files: see `doubts` in the table of measures"])


def paired(files: Iterable[tuple[Path, Read]]) -> RecordSet:
    """Return the records of files. Files that match by names or headers form one record."""
    groups: dict[Any, list[tuple[GroundMotion, str]]] = {}
    left_out: list[tuple[str, Reason]] = []
    doubted: list[str] = []
    for path, read in files:
        for motions in _by_sensor(_motions(path, read, left_out, doubted)):
            key, token = (("", path.name, *_sensor(motions[0])), "") if len(motions) > 1 else _key(path, motions[0])
            groups.setdefault((path.parent, *key), []).extend((motion, token) for motion in motions)
    records: list[Components] = []
    for motions in _of_one_header([_directed(group) for group in groups.values()]):
        if reason := _mismatch(motions):
            left_out.append((_files(motions), reason))
            records += [_joined([motion]) for motion in motions if not _may_be_vertical(motion, motions)]
        else:
            records.append(_joined(motions))
    _warn(doubted)
    return RecordSet(tuple(records), tuple(left_out))


def _files(motions: Sequence[GroundMotion]) -> str:
    return ", ".join(dict.fromkeys(motion.metadata["file"] for motion in motions))


_SENSOR = "network", "station", "location", "position"


def _sensor(motion: GroundMotion) -> tuple[str, ...]:
    return tuple(motion.metadata.get(key, "") for key in _SENSOR)


def _by_sensor(motions: Sequence[GroundMotion]) -> list[list[GroundMotion]]:
    """Return the components of a file, grouped by sensor."""
    groups: dict[tuple[str, ...], list[GroundMotion]] = {}
    for motion in motions:
        groups.setdefault(_sensor(motion), []).append(motion)
    return list(groups.values())


def _key(path: Path, motion: GroundMotion) -> tuple[tuple[str, ...], str]:
    """Return the file name without its component but with its extension, and the component in the name."""
    stem, ending = path.stem, path.suffix.casefold()
    name = motion.metadata["component"].split()[0].upper()
    if re.fullmatch(rf"\.{re.escape(name.replace('-', ''))}\d?", ending.upper()):
        return (stem, ending[-1] if ending[-1].isdigit() else ""), ""  # K-NET, and both instruments of KiK-net
    for form in (name.zfill(3), name):
        before, mark, after = stem.upper().rpartition(form)
        if mark and len(form) > 1 and (not after or not (before[-1:] + after[:1]).isalnum()):
            return (before.rstrip("-_. ") + "|" + after, ending), ""
    if codes := list(_CODE.finditer(stem.upper())):
        start, end = codes[-1].span()
        return (stem[:start].upper() + "|" + stem[end:].upper(), ending), codes[-1][0]
    end_of = _AT_END.search(stem)
    if end_of is None:
        return (stem, ending), ""
    return ((stem[: end_of.start()] + "|").upper(), ending), end_of[0].strip("-_. ")


def _directed(group: Sequence[tuple[GroundMotion, str]]) -> list[GroundMotion]:
    """Return the components of one name with their directions. File names may also give directions."""
    motions = []
    for motion, token in group:
        if token and len(group) > 1 and _oriented(motion) is None:  # only the file name gives the direction
            metadata = {"component": token, KEY: as_text(orientation(token))}
            motion = replace(motion, metadata={**motion.metadata, **metadata})  # noqa: PLW2901
        motions.append(motion)
    sides = [_oriented(component) for component in motions]
    return [
        component if side == before else replace(component, metadata={**component.metadata, KEY: as_text(side)})
        for component, before, side in zip(motions, sides, settled(sides), strict=True)
    ]


def _of_one_header(groups: Sequence[list[GroundMotion]]) -> list[list[GroundMotion]]:
    """Return groups. Components with different names are in one record if their headers agree."""
    alone: dict[Any, list[int]] = {}
    for index, motions in enumerate(groups):
        if len(motions) == 1 and (key := _header_key(motions[0])):
            alone.setdefault(key, []).append(index)
    joined, taken = [*groups], set[int]()
    for indices in alone.values():
        members = [groups[index][0] for index in indices]
        distinct = len({_oriented(member) for member in members}) == len(members)
        if 1 < len(members) <= 3 and distinct and not _mismatch(members):
            joined[indices[0]] = members
            taken.update(indices[1:])
    return [motions for index, motions in enumerate(joined) if index not in taken]


def _header_key(motion: GroundMotion) -> tuple[Any, ...] | None:
    """Return the header facts that the components of one record share; None if there are too few facts."""
    side, metadata = _oriented(motion), motion.metadata
    when = [metadata.get(key, "") for key in ("event", "date", "starttime", "Record Time", "Origin Time")]
    where = [metadata.get(key, "") for key in (*_SENSOR, "station number", "Station Code", "instrument", "kind")]
    named = any(metadata.get(key) not in {None, "", "unknown"} for key in ("station", "station number", "Station Code"))
    if side is None or side == UNCLEAR or not named or not any(when):
        return None
    return (metadata["format"], round(motion.time_step, 9), *when, *where)


def _may_be_vertical(motion: GroundMotion, group: Sequence[GroundMotion]) -> bool:
    """Return True if a component without direction may be the vertical component of three components."""
    side, sides = _oriented(motion), [_oriented(other) for other in group]
    return side == UNCLEAR or (side is None and len(sides) > 2 and not {UP, DOWN} & set(sides))


def _oriented(motion: GroundMotion) -> Direction:
    return of_metadata(motion.metadata)


def _mismatch(motions: Sequence[GroundMotion]) -> str:
    """Return the reason why components do not form one motion; empty if they match."""
    if reason := _direction_mismatch(motions) or _time_mismatch(motions):
        return reason
    for key in ("event", "station", "date"):
        if len({motion.metadata[key] for motion in motions if key in motion.metadata}) > 1:
            return f"components of different {key}s"
    azimuths = [side for side in map(_oriented, motions) if isinstance(side, float)]
    if len(azimuths) == 2 and abs(abs(azimuths[0] - azimuths[1]) % 180.0 - 90.0) > PERPENDICULAR:
        return f"horizontal components at {azimuths[0]:g} and {azimuths[1]:g} degrees are not perpendicular"
    return ""


def _direction_mismatch(motions: Sequence[GroundMotion]) -> str:
    """Return the reason why directions of components do not match; empty if they match."""
    sides = [_oriented(motion) for motion in motions]
    level = [side for side in sides if not isinstance(side, str)]
    if UNCLEAR in sides:
        name = motions[sides.index(UNCLEAR)].metadata["component"]
        return f"component {name} may be vertical or inclined; use a list with the files of x, y and z"
    if len(level) > 2 and len(level) == len(sides) and None in sides:
        return f"{len(motions)} components without a stated vertical one; use a list with the files of x, y and z"
    if len(level) > 2 or len(sides) - len(level) > 1:
        return f"{len(motions)} components of one name: more than two horizontal and one vertical"
    return ""


def _time_mismatch(motions: Sequence[GroundMotion]) -> str:
    first = motions[0] if motions else None
    if first is not None and any(
        abs(motion.time_step - first.time_step) > 1e-9 * first.time_step for motion in motions
    ):
        return "components with different time steps"
    return "components with different start times" if first and any(delay(first, motion) for motion in motions) else ""


def _joined(motions: Sequence[GroundMotion]) -> Components:
    """Return one motion of matching components."""
    count = min(map(len, motions))
    cut = [_cut(motion, count) for motion in motions]
    upright = [motion for motion in cut if isinstance(_oriented(motion), str)]
    level = [motion for motion in cut if motion not in upright]
    first, second = ([*level, None, None])[:2]
    if second is not None:
        a, b = (_oriented(motion) for motion in level)
        are_azimuths = isinstance(a, float) and isinstance(b, float)
        if are_azimuths and (float(a) - float(b)) % 360.0 > 180.0:  # type: ignore[arg-type]
            first, second = second, first
    up = upright[0] if upright else None
    if up is not None and _oriented(up) == DOWN:
        up = up.changed(
            "polarity reversed: it was positive downwards",
            acceleration=-up.acceleration,
            metadata={**up.metadata, KEY: UP},
        )
    return Components(first, second, up)


def _cut(motion: GroundMotion, count: int) -> GroundMotion:
    if len(motion) == count:
        return motion
    return motion.changed(f"cut to {count} samples of the other components", acceleration=motion.acceleration[:count])


@dataclass(frozen=True)
class ListedRecord:
    """One row of a list of records."""

    files: dict[str, str]  # files by axis; a single file has an empty name
    scale: float  # factor on the acceleration [-]
    name: str
    metadata: Mapping[str, str]
    options: Mapping[str, Any] = field(default_factory=dict)  # options of the files: units, time_step, format, skip

    def paths(self, folder: Path) -> dict[str, Path]:
        """Return the paths of the files by axis."""
        return {axis: folder / name for axis, name in self.files.items()}


Item = tuple[Path, Options]


def rows_of_list(path: Path) -> list[ListedRecord] | None:
    """Return the rows of a list of records; None for other files."""
    try:
        if path.suffix.lower() not in {".csv", ".tsv"} or not path.is_file() or path.stat().st_size > LARGEST_LIST:
            return None
        return _rows(path.read_bytes().decode("utf-8-sig", "replace").splitlines(), path.name)
    except (OSError, csv.Error):  # the reader of records reports this error later
        return None


def _rows(lines: Sequence[str], source: str) -> list[ListedRecord] | None:
    of_peer = next((k for k, line in enumerate(lines[:_TOP]) if _PEER in line.casefold()), None)
    top = of_peer if of_peer is not None else next((k for k, line in enumerate(lines) if line.strip()), 0)
    head = "".join(lines[top : top + 1])
    mark = next((mark for mark in ",;\t" if mark in head), ",")
    titles = [title.strip().casefold() for title in next(csv.reader([head], delimiter=mark), [])]
    titles = [_ALSO.get(title, title) for title in titles]
    if of_peer is None and not _TITLES & set(titles):
        return None
    table = csv.reader(lines[top + 1 :], delimiter=mark)
    rows = [dict(zip(titles, (cell.strip() for cell in cells), strict=False)) for cells in table]
    if of_peer is not None:
        ends = next((k for k, row in enumerate(rows) if not row.get(_PEER)), len(rows))
        return [_of_peer(row) for row in rows[:ends]]
    column = next(title for title in titles if title in _TITLES)
    if not rows or _is_number(rows[0].get(column, "")):  # the file is a record with a column x
        return None
    return [_row(row, mark, source) for row in rows if any(row.values())]


def _of_peer(row: Mapping[str, str]) -> ListedRecord:
    axes = {_PEER_AXES[match[1]]: cell for title, cell in row.items() if (match := _OF_NAMES.match(title))}
    files = {axis: cell for axis, cell in axes.items() if cell.strip("- ")}
    metadata = {f"PEER {title}": cell for title, cell in row.items() if not _OF_NAMES.match(title) and cell.strip("- ")}
    return ListedRecord(files, 1.0, "", metadata)


def _row(row: Mapping[str, str], mark: str, source: str) -> ListedRecord:
    axes = {axis: row[axis] for axis in "xyz" if row.get(axis)}
    single = row.get("motion") or row.get("file")
    factor = (row.get("scale") or "1").replace(*(",", ".") if mark == ";" else ("", ""))
    if not _is_number(factor) or bool(axes) == bool(single):
        raise InvalidValueError(
            "a row must have motion, or x with y and z, and a number as scale; got {row}", row=f"{dict(row)!r:.120}"
        ).at(source)
    columns = {"x", "y", "z", "motion", "file", "scale", "name", "", *_OPTION_COLUMNS}
    options: dict[str, Any] = {
        _OPTION_COLUMNS[title]: cell for title, cell in row.items() if title in _OPTION_COLUMNS and cell
    }
    for key, kind in (("time_step", float), ("skip", int)):
        if key in options:
            text = options[key].replace(",", ".") if mark == ";" else options[key]
            if not _is_number(text):
                raise InvalidValueError(
                    "{key} of a row must be a number, got {entry!r:.40}", key=key, entry=options[key]
                ).at(source)
            options[key] = kind(float(text))
    metadata = {title: cell for title, cell in row.items() if title not in columns and cell}
    files = {"": single} if single else axes
    return ListedRecord(files, float(factor), row.get("name", ""), metadata, options)


def _is_number(text: str) -> bool:
    try:
        return abs(float(text)) < float("inf")
    except ValueError:
        return False


def _listed(rows: Iterable[tuple[ListedRecord, Mapping[str, Read]]]) -> RecordSet:
    records: list[Components] = []
    left_out: list[tuple[str, Reason]] = []
    doubted: list[str] = []
    for row, reads in rows:
        components = {axis: _motions(Path(name), reads[axis], left_out, doubted) for axis, name in row.files.items()}
        motions = [motion for axis_motions in components.values() for motion in axis_motions]
        if not all(components.values()):
            continue
        # if the list has axes, the list defines the directions
        reason = _mismatch(motions) if "" in components else _time_mismatch(motions)
        if "" not in components and len(motions) > len(components):
            reason = "the file of one axis has several components"
        if reason:
            left_out.append((", ".join(row.files.values()), reason))
            continue
        if "" in components:
            record = _joined(motions)
        else:
            count = min(map(len, motions))
            record = Components(*(_cut(components[axis][0], count) if axis in components else None for axis in "xyz"))
        records.append(record.each(partial(_with_row, row=row)))
    _warn(doubted)
    return RecordSet(tuple(records), tuple(left_out))


def _with_row(motion: GroundMotion, row: ListedRecord) -> GroundMotion:
    scaled = motion if row.scale == 1.0 else motion.scaled(row.scale)
    return replace(scaled, name=row.name or motion.name, metadata={**motion.metadata, **row.metadata})
