"""Sets of records that a table of motions names: read, put through their steps, chosen, scaled and turned round."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import plausibility
from rocking.errors import InvalidValueError, RockingError, located
from rocking.motions.components import Components
from rocking.motions.formats.file_options import by_path
from rocking.motions.formats.record_set import Reason, RecordSet, paths_of, plane_motions, read_records, rows_of_list
from rocking.motions.formats.stations import BETWEEN, is_station_file, station_files
from rocking.motions.pipeline import processed, steps_of
from rocking.motions.selection import Selection, selected
from rocking.motions.target_spectra import target_spectrum
from rocking.spec.reading import InputFiles, is_pattern

if TYPE_CHECKING:
    from rocking.spec.motion_tables import MotionKeys, MotionTable

PERIODS = (0.1, 2.0)  # that count where records are compared with a target and nobody says otherwise [s]
STILL = "zero throughout: the ground would not move"
UPRIGHT = "vertical, and no horizontal component of its record is there"
MOST_NAMED = 5  # files that were left out and are named one by one


def is_set(name: str, inputs: InputFiles) -> bool:
    """Return whether a name is that of a folder, a pattern or a list of records rather than of one file."""
    path = inputs.folder / name
    return path.is_dir() or (is_pattern(name) and not path.exists()) or rows_of_list(path) is not None


def are_together(names: Sequence[str], inputs: InputFiles) -> bool:
    """Return whether names are read as a set: one that is a set, or files of one folder, which may be one record."""
    folders = [(inputs.folder / name).parent for name in names]
    return len(set(folders)) < len(folders) or any(is_set(name, inputs) for name in names)


def record_set(
    table: "MotionTable", inputs: InputFiles, workers: int = 1, progress: Callable[[int], None] | None = None
) -> tuple[RecordSet, Selection | None]:
    """Return the records of a table, and how they were chosen where it has a target."""
    records: list[Components] = []
    left_out: list[tuple[str, Reason]] = []
    if odd := sorted({"component", "vertical", "vertical_file"} & table.model_fields_set):
        raise InvalidValueError("a set takes no {keys}: all components of its records are read", keys=", ".join(odd))
    steps = with_files(table, inputs)
    how: dict[str, Any] = {"format": table.format, "units": table.units, "time_step": table.time_step}
    how |= {"stations": stations_of(steps), "skip": table.skip or 0, "workers": workers, "progress": progress}
    groups = _read_together(table.records or [], inputs)
    paths = [[path for name in names for path in _note(name, inputs)] for names in groups]
    own = by_path(table.file_options, [path for of_group in paths for path in of_group])
    for names, of_group in zip(groups, paths, strict=True):
        files = {path: own[path] for path in of_group if path in own}
        with located("records"):
            found = _read(names, inputs, {**how, "files": files})
        records += found.records
        left_out += found.left_out
    with located("process"):
        made = [processed(each, steps).each(lambda part: _scaled(part, table.scale)) for each in records]
    kept = RecordSet(tuple(made), tuple(left_out))
    chosen = None
    if table.target is not None:
        if (inputs.folder / table.target).is_file():
            inputs.file(table.target)
        with located("target"):
            target = target_spectrum(table.target, inputs.folder)
            low, high = table.periods or PERIODS
            chosen = selected(kept, target, table.count, (low, high), workers=workers, progress=progress)
        told = chosen.sentence
        kept = replace(chosen.records, records=tuple(each.each(partial(_told, told)) for each in chosen.records))
        chosen = replace(chosen, records=kept)
    return kept.mirrored() if table.mirrored else kept, chosen


def _read_together(names: Sequence[str], inputs: InputFiles) -> list[list[str]]:
    """Return names in groups: each set by itself, and the files that are named one by one."""
    groups: list[list[str]] = []
    files: list[str] = []
    for name in names:
        if name in files:
            raise InvalidValueError("records: {name} is named twice", parameter="records", name=name)
        alone = is_set(name, inputs)
        if alone or not files:
            groups.append([name] if alone else files)
        if not alone:
            files.append(name)
    return groups


def _read(names: Sequence[str], inputs: InputFiles, how: dict[str, Any]) -> RecordSet:
    """Return the records of a set, or of files that are named one by one, of which none is left out."""
    paths = {name: inputs.folder / name for name in names}
    found = read_records([*paths.values()], **how)
    if is_pattern(names[0]) and found.left_out:  # these files were named
        raise _unreadable(*found.left_out[0])
    if len(names) > 1:
        unreadable = dict(found.left_out)
        used = {part.metadata["file"] for record in found for part in record.parts if part is not None}
        for name, path in paths.items():
            if str(path) in unreadable or (path.name not in used and not is_station_file(path)):
                reasons = (reason for files, reason in found.left_out if path.name in files.split(", "))
                raise _unreadable(name, unreadable.get(str(path)) or next(reasons, "holds no component"))
    return found


def _unreadable(file: str, reason: Reason) -> RockingError:
    """Return the error of a file that was named and cannot be used."""
    return (InvalidValueError(reason) if isinstance(reason, str) else reason).at(file)


def motions_of_set(table: "MotionTable", inputs: InputFiles, *, paired: bool, alone: bool = True) -> list[Any]:
    """Return the motions of a study; paired: two horizontal components are one motion, which no plane body takes.

    Of records alone there must be one that moves; among others they are left out.
    """
    found, _ = record_set(table, inputs)
    motions: list[Any] = []
    left_out = [*found.left_out]
    for record in found:
        level = plane_motions(record)
        moving = [each for each in level if each.peak > 0.0]
        both = paired and record.y is not None and moving
        left_out += [] if both else [(each.name, STILL) for each in level if not each.peak > 0.0]
        motions += [record] if both else moving
    left_out += [
        (each.z.name, UPRIGHT) for each in found if motions and each.x is None and each.y is None and each.z is not None
    ]
    none = not motions and not any(why == STILL for _, why in left_out)
    left_out += [(name, "no horizontal component") for name in table.records or () if none and not alone]
    plausibility.warn(f"left out: {name}: {why}" for name, why in left_out[:MOST_NAMED])
    if (more := len(left_out) - MOST_NAMED) > 0:
        plausibility.warn([f"{more} more files were left out; rocking record batch lists them"])
    if not motions and alone:
        still = any(why == STILL for _, why in left_out)
        raise InvalidValueError(
            "every record is {reason}" if still else "no record has a horizontal component", reason=STILL
        )
    return motions


def with_files(table: "MotionKeys", inputs: InputFiles) -> Sequence[str]:
    """Return the steps of a table, whose files are looked for beside the document, and noted."""
    words = []
    for step in (part for text in table.process or () for part in text.split(";")):
        before, mark, after = step.partition("stations=")
        places, comma, rest = after.partition(",")
        named = [str(inputs.folder / place.strip()) for place in places.split(BETWEEN) if mark]
        for path in station_files(named) if mark else ():
            inputs.file(path.relative_to(inputs.folder).as_posix() if path.is_relative_to(inputs.folder) else str(path))
        words.append(f"{before}{mark}{BETWEEN.join(named)}{comma}{rest}" if mark else step)
    return words


def stations_of(steps: Sequence[str]) -> str | None:
    """Return the StationXML files and folders that steps name; none if they name none."""
    return next((str(keys["stations"]) for _, keys in steps_of(steps) if "stations" in keys), None)


def _note(name: str, inputs: InputFiles) -> list[Path]:
    """Note the hash of every file that a name stands for; return the paths of its record files."""
    path = inputs.folder / name
    rows = rows_of_list(path)
    if rows is not None:
        inputs.file(name)
        names = [(Path(name).parent / file).as_posix() for row in rows for file in row.files.values()]
    elif path.is_dir():
        names = [(Path(name) / each.relative_to(path)).as_posix() for each in paths_of(path)]
    else:
        names = inputs.named(name)
    for each in names:
        if rows is None or (inputs.folder / each).is_file():
            inputs.file(each)
    return [inputs.folder / each for each in names]


def _scaled(part: Any, factor: float) -> Any:
    return part if factor == 1.0 else part.scaled(factor)


def _told(sentence: str, part: Any) -> Any:
    return replace(part, provenance=(*part.provenance, sentence))
