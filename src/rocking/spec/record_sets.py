"""Sets of records from a table of motions: reading, processing, selection, scaling and polarity."""

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

PERIODS = (0.1, 2.0)  # default period range of the comparison with a target spectrum [s]
ZERO_MOTION = "zero acceleration at all times"
VERTICAL_ONLY = "vertical component of a record without horizontal component"
MOST_NAMED = 5  # largest number of ignored files that are listed by name


def is_set(name: str, inputs: InputFiles) -> bool:
    """Return True if the name is a folder, a pattern or a list of records, not one file."""
    path = inputs.folder / name
    return path.is_dir() or (is_pattern(name) and not path.exists()) or rows_of_list(path) is not None


def is_one_set(names: Sequence[str], inputs: InputFiles) -> bool:
    """Return True if the names are read as one set: one name is a set, or several files are in one folder."""
    folders = [(inputs.folder / name).parent for name in names]
    return len(set(folders)) < len(folders) or any(is_set(name, inputs) for name in names)


def record_set(
    table: "MotionTable", inputs: InputFiles, workers: int = 1, progress: Callable[[int], None] | None = None
) -> tuple[RecordSet, Selection | None]:
    """Return the records of a table and, if the table has a target spectrum, their selection."""
    records: list[Components] = []
    left_out: list[tuple[str, Reason]] = []
    if refused := sorted({"component", "vertical", "vertical_file"} & table.model_fields_set):
        raise InvalidValueError("{keys} is not allowed: a set has all components.", keys=", ".join(refused))
    steps = with_files(table, inputs)
    options: dict[str, Any] = {"format": table.format, "units": table.units, "time_step": table.time_step}
    options |= {"stations": stations_of(steps), "skip": table.skip or 0, "workers": workers, "progress": progress}
    groups = _read_together(table.records or [], inputs)
    paths = [[path for name in names for path in _note(name, inputs)] for names in groups]
    own = by_path(table.file_options, [path for group_paths in paths for path in group_paths])
    for names, group_paths in zip(groups, paths, strict=True):
        files = {path: own[path] for path in group_paths if path in own}
        with located("records"):
            group_set = _read(names, inputs, {**options, "files": files})
        records += group_set.records
        left_out += group_set.left_out
    with located("process"):
        processed_records = [
            processed(record, steps).each(lambda component: _scaled(component, table.scale)) for record in records
        ]
    kept = RecordSet(tuple(processed_records), tuple(left_out))
    chosen = None
    if table.target is not None:
        if (inputs.folder / table.target).is_file():
            inputs.file(table.target)
        with located("target"):
            target = target_spectrum(table.target, inputs.folder)
            low, high = table.periods or PERIODS
            chosen = selected(kept, target, table.count, (low, high), workers=workers, progress=progress)
        sentence = chosen.sentence
        kept = replace(
            chosen.records, records=tuple(record.each(partial(_with_provenance, sentence)) for record in chosen.records)
        )
        chosen = replace(chosen, records=kept)
    return kept.mirrored() if table.mirrored else kept, chosen


def _read_together(names: Sequence[str], inputs: InputFiles) -> list[list[str]]:
    """Return the names in groups: one group per set, and one group with all single files."""
    groups: list[list[str]] = []
    files: list[str] = []
    for name in names:
        if name in files:
            raise InvalidValueError("{name} appears twice in records. Remove one.", parameter="records", name=name)
        alone = is_set(name, inputs)
        if alone or not files:
            groups.append([name] if alone else files)
        if not alone:
            files.append(name)
    return groups


def _read(names: Sequence[str], inputs: InputFiles, options: dict[str, Any]) -> RecordSet:
    """Return the records of a set or of single files. Every single file must be readable."""
    paths = {name: inputs.folder / name for name in names}
    record_set = read_records([*paths.values()], **options)
    if is_pattern(names[0]) and record_set.left_out:  # the user named these files, so every one must be readable
        raise _unreadable(*record_set.left_out[0])
    if len(names) > 1:
        unreadable = dict(record_set.left_out)
        used = {
            component.metadata["file"] for record in record_set for component in record.parts if component is not None
        }
        for name, path in paths.items():
            if str(path) in unreadable or (path.name not in used and not is_station_file(path)):
                reasons = (reason for files, reason in record_set.left_out if path.name in files.split(", "))
                raise _unreadable(name, unreadable.get(str(path)) or next(reasons, "the file has no component"))
    return record_set


def _unreadable(file: str, reason: Reason) -> RockingError:
    """Return the error of an unusable single file."""
    return (InvalidValueError(reason) if isinstance(reason, str) else reason).at(file)


def motions_of_set(table: "MotionTable", inputs: InputFiles, *, paired: bool, alone: bool = True) -> list[Any]:
    """Return the motions of a study. With `paired` (3D bodies), both horizontal components are one motion.

    Zero motions are ignored. If records are the only source, at least one must have a nonzero acceleration.
    """
    records, _ = record_set(table, inputs)
    motions: list[Any] = []
    left_out = [*records.left_out]
    for record in records:
        horizontal = plane_motions(record)
        moving = [component for component in horizontal if component.peak > 0.0]
        is_paired = paired and record.y is not None and moving
        left_out += (
            [] if is_paired else [(component.name, ZERO_MOTION) for component in horizontal if not component.peak > 0.0]
        )
        motions += [record] if is_paired else moving
    left_out += [
        (record.z.name, VERTICAL_ONLY)
        for record in records
        if motions and record.x is None and record.y is None and record.z is not None
    ]
    has_no_component = not motions and not any(reason == ZERO_MOTION for _, reason in left_out)
    left_out += [(name, "no horizontal component") for name in table.records or () if has_no_component and not alone]
    plausibility.warn(f"ignored: {name}: {reason}" for name, reason in left_out[:MOST_NAMED])
    if (more := len(left_out) - MOST_NAMED) > 0:
        plausibility.warn([f"{more} more files were ignored. rocking record batch lists them."])
    if not motions and alone:
        still = any(reason == ZERO_MOTION for _, reason in left_out)
        raise InvalidValueError(
            "Every record has {reason}." if still else "No record has a horizontal component.", reason=ZERO_MOTION
        )
    return motions


def with_files(table: "MotionKeys", inputs: InputFiles) -> Sequence[str]:
    """Return the processing steps of a table with paths relative to the input file; note their files as inputs."""
    texts = []
    for step in (step_text for text in table.process or () for step_text in text.split(";")):
        before, mark, after = step.partition("stations=")
        path_texts, comma, other_keys = after.partition(",")
        paths = [str(inputs.folder / path_text.strip()) for path_text in path_texts.split(BETWEEN) if mark]
        for path in station_files(paths) if mark else ():
            inputs.file(path.relative_to(inputs.folder).as_posix() if path.is_relative_to(inputs.folder) else str(path))
        texts.append(f"{before}{mark}{BETWEEN.join(paths)}{comma}{other_keys}" if mark else step)
    return texts


def stations_of(steps: Sequence[str]) -> str | None:
    """Return the StationXML files and folders of the steps, or None."""
    return next((str(keys["stations"]) for _, keys in steps_of(steps) if "stations" in keys), None)


def _note(name: str, inputs: InputFiles) -> list[Path]:
    """Note the hash of every file of a name. Return the paths of the record files."""
    path = inputs.folder / name
    rows = rows_of_list(path)
    if rows is not None:
        inputs.file(name)
        names = [(Path(name).parent / file).as_posix() for row in rows for file in row.files.values()]
    elif path.is_dir():
        names = [(Path(name) / file_name.relative_to(path)).as_posix() for file_name in paths_of(path)]
    else:
        names = inputs.named(name)
    for file_name in names:
        if rows is None or (inputs.folder / file_name).is_file():
            inputs.file(file_name)
    return [inputs.folder / file_name for file_name in names]


def _scaled(component: Any, factor: float) -> Any:
    return component if factor == 1.0 else component.scaled(factor)


def _with_provenance(sentence: str, component: Any) -> Any:
    return replace(component, provenance=(*component.provenance, sentence))
