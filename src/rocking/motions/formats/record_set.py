"""Sets of records: a folder, a pattern or a list of files, with the components of each station put together."""

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

PERPENDICULAR = 5.0  # azimuths of two components differ by a right angle, to this [degree]
FEW = 48  # so few files are read by one process: others take longer to start
MOST_TOLD = 6  # so many doubts about files are said one by one

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
_MEANT = {"units": "units", "unit": "units", "einheit": "units", "unità": "units", "time_step": "time_step",
          "dt": "time_step", "format": "format", "skip": "skip"}  # fmt: skip
"""Columns of a list that say how the files of a row are read, and what they are called here."""

LARGEST_LIST = 1 << 24  # no list of records is larger [bytes]
_TOP = 500  # lines within which PEER's list of files begins
_SPECIAL = "*?["


Reason = str | RockingError


@dataclass(frozen=True, eq=False)
class RecordSet:
    """Records of several stations or earthquakes, and what was left out.

    Parameters
    ----------
    records : tuple of Components
        One motion a record: two horizontal components x and y, and z, upwards; None where there is none.
    left_out : tuple of pairs of str and str or RockingError
        File and reason of what could not be read, and of components that could not be put together.

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
        """Return the motions of plane bodies: every horizontal component with the vertical one of its record.

        Returns
        -------
        list of GroundMotion
            Two a record where it has two horizontal components; none of a vertical one alone.
        """
        return [motion for record in self.records for motion in plane_motions(record)]

    def mirrored(self) -> "RecordSet":
        """Return each record twice: as it is, and with its horizontal components turned round.

        Returns
        -------
        RecordSet
            Of twice the length; the vertical components are as they were.
        """
        return replace(self, records=tuple(each for record in self.records for each in (record, turned_round(record))))


def plane_motions(record: Components) -> list[GroundMotion]:
    """Return the horizontal components of a record, each with its vertical one."""
    level = [part for part in (record.x, record.y) if part is not None]
    if len({part.name for part in level}) < len(level):  # what tells them apart
        level = [replace(part, name=f"{part.name} {part.metadata.get('component', '')}".strip()) for part in level]
    return level if record.z is None else [with_vertical(part, record.z) for part in level]


def turned_round(motion: Any) -> Any:
    """Return a motion whose horizontal components have the other sign."""
    if isinstance(motion, Components):
        x, y = (None if part is None else turned_round(part) for part in (motion.x, motion.y))
        return Components(x, y, motion.z)
    return motion.changed("turned round", acceleration=-motion.acceleration, name=f"{motion.name}, turned round")


def read_records(  # noqa: PLR0913 - every one of them is a property of some sets
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
    r"""Return the records of files, of a folder, a pattern or a list, the components of each put into one motion.

    Files of one component belong together if their names differ in nothing but the component (``ELC180``,
    ``ELC270``, ``ELC-UP``; ``.NS``, ``.EW``, ``.UD``), and if their steps, starts, events and azimuths agree; what does
    not fit stays a motion of its own. Components of different length are cut to the shortest. x is the one from which
    y is 90 degrees to the left: East and North, where these are stated; a component that points down is turned up.

    A list is a CSV file of PEER's search results, or one with the columns motion (or x, y, z) and, if wanted, scale
    and name, and units, time_step, format and skip of the files of a row. PEER's scale factors are kept as metadata
    and not applied.

    Parameters
    ----------
    where : path-like, or sequence of path-like
        Folder, looked through with all that are in it; pattern such as ``records/*.at2``; list of files; or one file.
        Of several, the files are put together as those of one folder are; one that is named twice is read once.
    format, units, time_step : optional
        As in `read_motion`, for all files.
    files : mapping of path-like to mapping, optional
        Options of single files by file name, in place of those for all files: ``units``, ``time_step`` [s], ``format``
        and ``skip``, such as ``{"a.txt": {"units": "g"}}``. A name may include folders, to name exactly one file.
    stations : path-like or sequence of path-like, optional
        StationXML files, or folders of them, by which the counts of miniSEED files become accelerations: by network,
        station, location, channel and date. Those among the files of `where` are used without being named.
    skip : int
        Lines at the top of every text file that are passed over.
    workers : int
        Processes that read many files.
    progress : callable, optional
        Called with the number of files that were read since.

    Returns
    -------
    RecordSet
        The records; what could not be read is in its `left_out`.

    Raises
    ------
    RecordError
        If there is no such file, or none could be read.
    InvalidValueError
        If `files` names no file of the set, has an unknown key or value, or repeats a key of the file's row in a list.

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
    places = [Path(where)] if isinstance(where, str | PathLike) else [Path(each) for each in where]
    lists = [(path, rows) for path in places if (rows := rows_of_list(path)) is not None]
    listed = {path for path, _ in lists}
    paths = list(dict.fromkeys(one for path in places if path not in listed for one in paths_of(path)))
    beside = [one for one in paths if is_station_file(one)]
    options: dict[str, Any] = {"format": format, "units": units, "time_step": time_step, "skip": skip}
    read = partial(_read, **options, stations=stations or beside or None)
    records: list[Components] = []
    left_out: list[tuple[str, Reason]] = []
    paths = [one for one in paths if one not in beside]
    in_lists = [file for path, rows in lists for row in rows for file in row.paths(path.parent).values()]
    own = by_path(files, [*paths, *in_lists])
    items = [(path, tuple(sorted(own.get(path, {}).items()))) for path in paths]
    for found in (
        *(_of_list(path, rows, own, read, workers, progress) for path, rows in lists),
        paired(zip(paths, mapped(read, items, workers, progress), strict=True)),
    ):
        records += found.records
        left_out += found.left_out
    if not records:
        named = ", ".join(map(str, places[:MOST_TOLD])) or "no file is named"
        if not left_out:
            raise RecordError("{folders}: none of 0 files could be read", folders=named, hint="it holds no file")
        file, reason = left_out[0]
        cause, hint = (reason, "") if isinstance(reason, str) else (reason.cause, reason.hint)
        raise RecordError(
            "{named}: none of {count} files could be read; {file}: {cause}",
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
    """Return the records that the rows of a list name, whose files are beside it; own: options stated for files."""
    items: list[dict[str, Item]] = [
        {axis: (file, together(file, row.how, own.get(file, {}), path.name)) for axis, file in paths.items()}
        for row in rows
        for paths in [row.paths(path.parent)]
    ]
    distinct = list(dict.fromkeys(item for by_axis in items for item in by_axis.values()))
    reads = dict(zip(distinct, mapped(read, distinct, workers, progress), strict=True))
    read_by_axis = [{axis: reads[item] for axis, item in by_axis.items()} for by_axis in items]
    return _listed(zip(rows, read_by_axis, strict=True))


def paths_of(where: str | PathLike[str]) -> list[Path]:
    """Return the files of a folder or a pattern in alphabetic order, without hidden ones; or the one file."""
    path = Path(where)
    if path.is_dir():
        return sorted(one for one in path.rglob("*") if one.is_file() and not _is_hidden(one.relative_to(path)))
    if path.is_file() or not any(mark in str(where) for mark in _SPECIAL):
        return [path]
    root = Path(path.anchor)
    found = sorted(one for one in root.glob(str(path.relative_to(root))) if one.is_file())
    if not found:
        raise RecordError("{pattern}: the pattern finds no file", pattern=str(where))
    return found


def _is_hidden(path: Path) -> bool:
    return any(part.startswith((".", "__MACOSX")) for part in path.parts)


def mapped(
    function: Callable[[Any], Any], items: Sequence[Any], workers: int, progress: Callable[[int], None] | None
) -> Iterator[Any]:
    """Give a function of every item, in their order, computed by some processes where there are many."""
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
            for each in pool.map(function, items, chunksize=4):
                yield each
                done(1)
    except BrokenProcessPool as error:
        why = 'a script that starts processes needs if __name__ == "__main__": around its calls, or workers=1'
        raise InvalidValueError(
            "{workers} workers could not be started, or one died", workers=workers, hint=why
        ) from error


Read = tuple[list[GroundMotion] | RockingError, list[str]]  # the components or why there are none, and doubts


def _read(item: "Item", **options: Any) -> Read:
    """Read one file with its own options, in whatever process: what it is doubted for is handed back."""
    path, own = item
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        try:
            found: list[GroundMotion] | RockingError = motions_in(path, **{**options, **dict(own)})
        except RockingError as error:
            found = error.without_file(path.name)
    return found, [str(each.message) for each in doubts]


def _motions(path: Path, read: Read, left_out: list[tuple[str, Reason]], doubted: list[str]) -> list[GroundMotion]:
    found, doubts = read
    said = [doubt.removeprefix("check the input: ").removeprefix(f"{path.name}: ") for doubt in doubts]
    doubted += (f"{path.name}: {doubt}" for doubt in said)
    if isinstance(found, RockingError):
        left_out.append((str(path), found))
        return []
    told = {"file": path.name} | ({"doubts": "; ".join(said)} if said else {})
    return [replace(each, metadata={**each.metadata, **told}) for each in found]


def _warn(doubted: list[str]) -> None:
    """Say the first doubts, and of many how many more there are."""
    plausibility.warn(doubted if len(doubted) <= MOST_TOLD else doubted[: MOST_TOLD - 1])
    if (more := len(doubted) - MOST_TOLD + 1) > 1:
        plausibility.warn([f"{more} doubts more about these files: `doubts` in the table of measures has them all"])


def paired(files: Iterable[tuple[Path, Read]]) -> RecordSet:
    """Return the records of files, of which those that belong together by their names or headers are one."""
    groups: dict[Any, list[tuple[GroundMotion, str]]] = {}
    left_out: list[tuple[str, Reason]] = []
    doubted: list[str] = []
    for path, read in files:
        for motions in _by_sensor(_motions(path, read, left_out, doubted)):
            key, token = (("", path.name, *_sensor(motions[0])), "") if len(motions) > 1 else _key(path, motions[0])
            groups.setdefault((path.parent, *key), []).extend((each, token) for each in motions)
    records: list[Components] = []
    for motions in _of_one_header([_directed(group) for group in groups.values()]):
        if why := _at_odds(motions):
            left_out.append((_files(motions), why))
            records += [_joined([each]) for each in motions if not _may_be_vertical(each, motions)]
        else:
            records.append(_joined(motions))
    _warn(doubted)
    return RecordSet(tuple(records), tuple(left_out))


def _files(motions: Sequence[GroundMotion]) -> str:
    return ", ".join(dict.fromkeys(each.metadata["file"] for each in motions))


_SENSOR = "network", "station", "location", "position"


def _sensor(motion: GroundMotion) -> tuple[str, ...]:
    return tuple(motion.metadata.get(key, "") for key in _SENSOR)


def _by_sensor(motions: Sequence[GroundMotion]) -> list[list[GroundMotion]]:
    """Return the components of a file by the sensor that recorded them."""
    groups: dict[tuple[str, ...], list[GroundMotion]] = {}
    for motion in motions:
        groups.setdefault(_sensor(motion), []).append(motion)
    return list(groups.values())


def _key(path: Path, motion: GroundMotion) -> tuple[tuple[str, ...], str]:
    """Return the name of a file without that of its component, with its ending; and what it says of the component."""
    stem, ending = path.stem, path.suffix.casefold()
    name = motion.metadata["component"].split()[0].upper()
    if re.fullmatch(rf"\.{re.escape(name.replace('-', ''))}\d?", ending.upper()):
        return (stem, ending[-1] if ending[-1].isdigit() else ""), ""  # K-NET, and KiK-net's two instruments
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
    """Return the components of one name with their directions, also by what their file names say beside one another."""
    motions = []
    for motion, token in group:
        if token and len(group) > 1 and _oriented(motion) is None:  # the header does not say what the name does
            told = {"component": token, KEY: as_text(orientation(token))}
            motion = replace(motion, metadata={**motion.metadata, **told})  # noqa: PLW2901
        motions.append(motion)
    sides = [_oriented(each) for each in motions]
    return [
        each if side == was else replace(each, metadata={**each.metadata, KEY: as_text(side)})
        for each, was, side in zip(motions, sides, settled(sides), strict=True)
    ]


def _of_one_header(groups: Sequence[list[GroundMotion]]) -> list[list[GroundMotion]]:
    """Return groups in which components of other names are one record where their headers agree."""
    alone: dict[Any, list[int]] = {}
    for place, motions in enumerate(groups):
        if len(motions) == 1 and (key := _header_key(motions[0])):
            alone.setdefault(key, []).append(place)
    made, taken = [*groups], set[int]()
    for places in alone.values():
        members = [groups[place][0] for place in places]
        distinct = len({_oriented(each) for each in members}) == len(members)
        if 1 < len(members) <= 3 and distinct and not _at_odds(members):
            made[places[0]] = members
            taken.update(places[1:])
    return [motions for place, motions in enumerate(made) if place not in taken]


def _header_key(motion: GroundMotion) -> tuple[Any, ...] | None:
    """Return what the headers of the components of one record have in common; None where they state too little."""
    side, told = _oriented(motion), motion.metadata
    when = [told.get(key, "") for key in ("event", "date", "starttime", "Record Time", "Origin Time")]
    where = [told.get(key, "") for key in (*_SENSOR, "station number", "Station Code", "instrument", "kind")]
    named = any(told.get(key) not in {None, "", "unknown"} for key in ("station", "station number", "Station Code"))
    if side is None or side == UNCLEAR or not named or not any(when):
        return None
    return (told["format"], round(motion.time_step, 9), *when, *where)


def _may_be_vertical(motion: GroundMotion, beside: Sequence[GroundMotion]) -> bool:
    """Return whether a component that states no direction stands beside two others of which none is vertical."""
    side, sides = _oriented(motion), [_oriented(each) for each in beside]
    return side == UNCLEAR or (side is None and len(sides) > 2 and not {UP, DOWN} & set(sides))


def _oriented(motion: GroundMotion) -> Direction:
    return of_metadata(motion.metadata)


def _at_odds(motions: Sequence[GroundMotion]) -> str:
    """Return why some components are not of one motion; empty if they are."""
    if why := _sides_at_odds(motions) or _at_other_times(motions):
        return why
    for key in ("event", "station", "date"):
        if len({each.metadata[key] for each in motions if key in each.metadata}) > 1:
            return f"components of different {key}s"
    azimuths = [side for side in map(_oriented, motions) if isinstance(side, float)]
    if len(azimuths) == 2 and abs(abs(azimuths[0] - azimuths[1]) % 180.0 - 90.0) > PERPENDICULAR:
        return f"horizontal components at {azimuths[0]:g} and {azimuths[1]:g} degrees, not at right angles"
    return ""


def _sides_at_odds(motions: Sequence[GroundMotion]) -> str:
    """Return why the directions of some components are not those of one motion; empty if they are."""
    sides = [_oriented(each) for each in motions]
    level = [side for side in sides if not isinstance(side, str)]
    if UNCLEAR in sides:
        name = motions[sides.index(UNCLEAR)].metadata["component"]
        return f"component {name} may be vertical or inclined; name the files of x, y and z in a list"
    if len(level) > 2 and len(level) == len(sides) and None in sides:
        return f"{len(motions)} components, and none is stated to be vertical; name the files of x, y and z in a list"
    if len(level) > 2 or len(sides) - len(level) > 1:
        return f"{len(motions)} components of one name: more than two horizontal ones and one upwards"
    return ""


def _at_other_times(motions: Sequence[GroundMotion]) -> str:
    first = motions[0] if motions else None
    if first is not None and any(abs(each.time_step - first.time_step) > 1e-9 * first.time_step for each in motions):
        return "components of different steps between samples"
    return "components that start at different times" if first and any(delay(first, each) for each in motions) else ""


def _joined(motions: Sequence[GroundMotion]) -> Components:
    """Return one motion of components that fit."""
    count = min(map(len, motions))
    cut = [_cut(each, count) for each in motions]
    upright = [each for each in cut if isinstance(_oriented(each), str)]
    level = [each for each in cut if each not in upright]
    first, second = ([*level, None, None])[:2]
    if second is not None:
        a, b = (_oriented(each) for each in level)
        known = isinstance(a, float) and isinstance(b, float)
        if known and (float(a) - float(b)) % 360.0 > 180.0:  # type: ignore[arg-type]
            first, second = second, first
    up = upright[0] if upright else None
    if up is not None and _oriented(up) == DOWN:
        up = up.changed(
            "turned up: it was positive downwards", acceleration=-up.acceleration, metadata={**up.metadata, KEY: UP}
        )
    return Components(first, second, up)


def _cut(motion: GroundMotion, count: int) -> GroundMotion:
    if len(motion) == count:
        return motion
    return motion.changed(f"cut to the {count} samples of the others", acceleration=motion.acceleration[:count])


@dataclass(frozen=True)
class ListedRecord:
    """One row of a list of records."""

    files: dict[str, str]  # by axis, or alone by an empty name
    scale: float  # factor on the acceleration [-]
    name: str
    metadata: Mapping[str, str]
    how: Mapping[str, Any] = field(default_factory=dict)  # how its files are read: units, time_step, format, skip

    def paths(self, folder: Path) -> dict[str, Path]:
        """Return the paths of its files by axis."""
        return {axis: folder / name for axis, name in self.files.items()}


Item = tuple[Path, Options]


def rows_of_list(path: Path) -> list[ListedRecord] | None:
    """Return the rows of a list of records; None of a file that is none."""
    try:
        if path.suffix.lower() not in {".csv", ".tsv"} or not path.is_file() or path.stat().st_size > LARGEST_LIST:
            return None
        return _rows(path.read_bytes().decode("utf-8-sig", "replace").splitlines(), path.name)
    except (OSError, csv.Error):  # whoever reads it as a record says what is wrong
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
    if not rows or _is_number(rows[0].get(column, "")):  # a record, with a column along x
        return None
    return [_row(row, mark, source) for row in rows if any(row.values())]


def _of_peer(row: Mapping[str, str]) -> ListedRecord:
    axes = {_PEER_AXES[found[1]]: cell for title, cell in row.items() if (found := _OF_NAMES.match(title))}
    files = {axis: cell for axis, cell in axes.items() if cell.strip("- ")}
    told = {f"PEER {title}": cell for title, cell in row.items() if not _OF_NAMES.match(title) and cell.strip("- ")}
    return ListedRecord(files, 1.0, "", told)


def _row(row: Mapping[str, str], mark: str, source: str) -> ListedRecord:
    axes = {axis: row[axis] for axis in "xyz" if row.get(axis)}
    alone = row.get("motion") or row.get("file")
    factor = (row.get("scale") or "1").replace(*(",", ".") if mark == ";" else ("", ""))
    if not _is_number(factor) or bool(axes) == bool(alone):
        raise InvalidValueError(
            "a row has a motion, or x with y and z, and its scale is a number; got {row}", row=f"{dict(row)!r:.120}"
        ).at(source)
    known = {"x", "y", "z", "motion", "file", "scale", "name", "", *_MEANT}
    how: dict[str, Any] = {_MEANT[title]: cell for title, cell in row.items() if title in _MEANT and cell}
    for key, kind in (("time_step", float), ("skip", int)):
        if key in how:
            text = how[key].replace(",", ".") if mark == ";" else how[key]
            if not _is_number(text):
                raise InvalidValueError(
                    "{key} of a row must be a number, got {entry!r:.40}", key=key, entry=how[key]
                ).at(source)
            how[key] = kind(float(text))
    told = {title: cell for title, cell in row.items() if title not in known and cell}
    files = {"": alone} if alone else axes
    return ListedRecord(files, float(factor), row.get("name", ""), told, how)


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
        parts = {axis: _motions(Path(name), reads[axis], left_out, doubted) for axis, name in row.files.items()}
        motions = [each for found in parts.values() for each in found]
        if not all(parts.values()):
            continue
        # with axes the list says itself which is which
        why = _at_odds(motions) if "" in parts else _at_other_times(motions)
        if "" not in parts and len(motions) > len(parts):
            why = "a file of one axis has several components"
        if why:
            left_out.append((", ".join(row.files.values()), why))
            continue
        if "" in parts:
            record = _joined(motions)
        else:
            count = min(map(len, motions))
            record = Components(*(_cut(parts[axis][0], count) if axis in parts else None for axis in "xyz"))
        records.append(record.each(partial(_told, row=row)))
    _warn(doubted)
    return RecordSet(tuple(records), tuple(left_out))


def _told(motion: GroundMotion, row: ListedRecord) -> GroundMotion:
    scaled = motion if row.scale == 1.0 else motion.scaled(row.scale)
    return replace(scaled, name=row.name or motion.name, metadata={**motion.metadata, **row.metadata})
