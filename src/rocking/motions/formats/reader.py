"""Reading and writing of record files in all formats."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from functools import cache
from os import PathLike
from pathlib import Path

from rocking import checks, plausibility
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, RecordError, RockingError
from rocking.messages import Message, Option, listed
from rocking.motions.components import with_vertical
from rocking.motions.formats import directions
from rocking.motions.formats.record import Component, Record, RecordFormat, Source
from rocking.motions.formats.stations import Places
from rocking.motions.integrals import integral_doubts
from rocking.motions.motion import GroundMotion

_STARTS = ("starttime", "Record Time", "first time")
"""Metadata keys of the time of the first sample in miniSEED and SAC, in K-NET, and in columns."""


@cache
def _classes() -> tuple[type[RecordFormat], ...]:
    """Return all formats in the order of detection. A new format needs a file, and an import and a name here."""
    from rocking.motions.formats.bhrc import Bhrc
    from rocking.motions.formats.columns import Columns
    from rocking.motions.formats.cosmos import Cosmos
    from rocking.motions.formats.csmip_v1 import CsmipV1, Usc
    from rocking.motions.formats.csmip_v2 import CsmipV2
    from rocking.motions.formats.csmnc import Csmnc
    from rocking.motions.formats.csn import Csn
    from rocking.motions.formats.cwa import Cwa
    from rocking.motions.formats.eqsig import Eqsig
    from rocking.motions.formats.esm import Esm
    from rocking.motions.formats.geonet import GeonetV1A, GeonetV2A
    from rocking.motions.formats.itaca import Itaca
    from rocking.motions.formats.knet import Knet
    from rocking.motions.formats.miniseed import MiniSeed
    from rocking.motions.formats.nsmn import Nsmn
    from rocking.motions.formats.peer import Peer
    from rocking.motions.formats.sac import Sac
    from rocking.motions.formats.slist import Slist
    from rocking.motions.formats.smc import SmcBoore, SmcUsgs
    from rocking.motions.formats.unam import Unam

    return (
        Peer, Esm, Cosmos, CsmipV1, CsmipV2, Usc, SmcUsgs, SmcBoore, Knet, Cwa, GeonetV1A, GeonetV2A, Bhrc, Csmnc, Nsmn,
        Unam, Itaca, Csn, Slist, Eqsig, MiniSeed, Sac,
        Columns,  # last, because columns have no header
    )  # fmt: skip


def formats() -> dict[str, RecordFormat]:
    """Return all record formats by name.

    Returns
    -------
    dict of str to RecordFormat
        Formats by name, in the order of detection.
    """
    return {kind.name: kind() for kind in _classes()}


def format_named(name: str) -> RecordFormat:
    """Return a record format by name."""
    available = formats()
    return available[checks.one_of("format", name, available)]


def read_record(
    path: str | PathLike[str],
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    *,
    skip: int = 0,
) -> Record:
    r"""Return all components of a record file, in the unit of the file.

    Parameters
    ----------
    path : path-like
        Path of the file.
    format : str, optional
        Name of the format; the default is the detected format.
    units : str, optional
        Unit of acceleration for files without a unit: a key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float, optional
        Time step for files without a time step [s].
    skip : int
        Number of lines to skip at the top of a text file.

    Returns
    -------
    Record
        Components and header of the file.

    Raises
    ------
    InvalidValueError
        If the format or unit is unknown.
    RecordError
        If the file is missing or damaged, has an unknown or ambiguous format, or contradicts its header.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder, "three.txt")
    ...     _ = path.write_text("0.00 0.0\n0.01 0.5\n0.02 -0.2\n")
    ...     record = read_record(path, units="g")
    >>> record.format, record.components[0].time_step, record.components[0].peak
    ('columns', 0.01, 0.5)
    """
    return _read(Source.of_path(Path(path), skip), format, units, time_step)


def read_motion(  # noqa: PLR0913 - all are properties of some files
    path: str | PathLike[str],
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    component: str | None = None,
    vertical: str | None = None,
    *,
    vertical_path: str | PathLike[str] | None = None,
    stations: Places | None = None,
    skip: int = 0,
) -> GroundMotion:
    """Return one component of a record file as a ground motion, with an optional vertical part.

    For formats with one component per file (PEER, ESM, K-NET), `vertical_path` is the file of the vertical component.
    `format`, `units` and `time_step` apply to both files.

    Parameters
    ----------
    path : path-like
        Path of the file.
    format : str, optional
        Name of the format; the default is the detected format.
    units : str, optional
        Unit of acceleration for files without a unit: a key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float, optional
        Time step for files without a time step [s].
    component : str, optional
        Name of the horizontal component, case-insensitive; required for files with several components.
    vertical : str, optional
        Name of the vertical component, case-insensitive. It is required if the file `vertical_path` has several
        components.
    vertical_path : path-like, optional
        File of the vertical component, with equal time step and start. The longer motion is cut.
    stations : path-like or sequence of path-like, optional
        StationXML files, or folders of them, for the conversion of counts in miniSEED files to accelerations.
    skip : int
        Number of lines to skip at the top of a text file.

    Returns
    -------
    GroundMotion
        Motion in m/s2. The metadata contain the raw header, and the provenance contains the SHA-256 of every file.

    Raises
    ------
    InvalidValueError
        If the format, unit or component is unknown; if `component` is required; or if both files contain the same
        component or have different time steps.
    RecordError
        If a file is missing or damaged, has an unknown or ambiguous format, or contradicts its header; or if the files
        state different start times.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from rocking import examples
    >>> with TemporaryDirectory() as folder:
    ...     (path,) = examples.write("three-components", folder)
    ...     motion = read_motion(path, component="x", vertical="z")
    >>> motion
    <GroundMotion 'three-components': 3801 samples at 0.01 s, peak 3.923 m/s2, with vertical>
    """
    source = Source.of_path(Path(path), skip)
    record = _read(source, format, units, time_step, stations)
    if vertical_path is not None:
        motion = _motion(source, record, _chosen(record, "component", component))
        beside = Source.of_path(Path(vertical_path), skip)
        other = _read(beside, format, units, time_step, stations)
        upright = _chosen(other, "vertical", vertical)
        return _joined(motion, _motion(beside, other, upright), beside, same_file=beside.content == source.content)
    if vertical is None:
        return _motion(source, record, _chosen(record, "component", component))
    upright = _chosen(record, "vertical", vertical)
    level = _chosen(record, "component", component, upright)
    if upright.time_step != level.time_step:
        raise source.error(
            None, "time steps of {step:g} s and {vertical_step:g} s; resample one motion first", step=level.time_step,
            vertical_step=upright.time_step,
        )  # fmt: skip
    note = f"component {upright.name}, unit {upright.unit}"
    acceleration = upright.acceleration * ACCELERATION_UNITS[upright.unit]
    about = {"component": upright.name}
    if "channel" in upright.metadata:
        about["channel"] = upright.metadata["channel"]
    vertical_part = GroundMotion(acceleration, upright.time_step, None, "", about, (note,))
    return with_vertical(_motion(source, record, level), vertical_part)


def motions_in(
    path: Path,
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    stations: Places | None = None,
    skip: int = 0,
) -> list[GroundMotion]:
    """Return every component of a record file as a motion. `stations` are StationXML files for counts."""
    source = Source.of_path(path, skip)
    record = _read(source, format, units, time_step, stations)
    return [_motion(source, record, component) for component in record.components]


def write_record(record: Record, path: str | PathLike[str], format: str) -> None:
    """Write a record to a file.

    Parameters
    ----------
    record : Record
        Record to write. Formats with a fixed unit convert the record to this unit.
    path : path-like
        Path of the file. An existing file is replaced.
    format : str
        Name of the format.

    Raises
    ------
    InvalidValueError
        If the format is unknown.
    RecordError
        If the record does not fit the format, or the file cannot be written.
    """
    content = format_named(format).write(record)
    try:
        Path(path).write_bytes(content)
    except (OSError, ValueError) as error:
        raise RecordError(getattr(error, "strerror", None) or str(error)).at(str(path)) from error


def write_motion(motion: GroundMotion, path: str | PathLike[str], format: str, units: str = "m/s2") -> None:
    """Write a ground motion to a file, with its vertical part as second component.

    Parameters
    ----------
    motion : GroundMotion
        Motion to write.
    path : path-like
        Path of the file. An existing file is replaced.
    format : str
        Name of the format.
    units : str
        Unit of acceleration in formats without a fixed unit.

    Raises
    ------
    InvalidValueError
        If the format or unit is unknown.
    RecordError
        If the motion does not fit the format, or the file cannot be written.
    """
    units = checks.one_of("units", units, ACCELERATION_UNITS)
    rows = {motion.metadata.get("component", "horizontal"): motion.acceleration}
    if motion.vertical is not None:
        rows[motion.metadata.get("vertical component", "vertical")] = motion.vertical
    factor = ACCELERATION_UNITS[units]
    components = tuple(Component(name, values / factor, units, motion.time_step) for name, values in rows.items())
    metadata: Mapping[str, str] = {"event": motion.name, **motion.metadata}
    write_record(Record(format, components, metadata=metadata), path, format)


def _read(
    source: Source, format: str | None, units: str | None, time_step: float | None, stations: Places | None = None
) -> Record:
    units = None if units is None else checks.one_of("units", units, ACCELERATION_UNITS)
    if time_step is not None:
        time_step = checks.positive("time_step", time_step, "s")
    stated = {"format": format, "unit": units, "time step": None if time_step is None else f"{time_step:g} s"}
    stated["lines skipped at the top"] = str(source.skip) if source.skip else None
    source.stated.extend(f"{name} {value}" for name, value in stated.items() if value is not None)
    chosen: RecordFormat | None = None
    try:
        chosen = _recognised(source) if format is None else format_named(format)
        if stations is not None and chosen.name == "miniseed":
            from rocking.motions.formats.miniseed import MiniSeed

            chosen = MiniSeed.with_response(stations)
        record = chosen.read(source, units, time_step)
    except RockingError:
        raise
    except Exception as error:  # any error of a reader means that the file is not readable
        stage = "during the detection of its format" if chosen is None else f"as {chosen.name}"
        raise source.error(
            None, "the file cannot be read {stage} ({type}: {reason:.120})", stage=stage, type=type(error).__name__,
            reason=str(error), hint="check the file and its format",
        ) from error  # fmt: skip
    if not source.doubts:
        return record
    plausibility.warn(source.doubts)
    return replace(record, metadata={**record.metadata, "doubts": listed(source.doubts)})


def _motion(source: Source, record: Record, component: Component) -> GroundMotion:
    own = {"format": record.format, "unit": component.unit, "component": component.name, "header": record.header}
    own[directions.KEY] = directions.as_text(_direction(source, record, component))
    metadata = {**record.metadata, **component.metadata, **own}
    note = f"read from {source.name}, SHA-256 {source.sha256}, format {record.format}"
    note += f", component {component.name}, unit {component.unit}"
    note += f", counts by {metadata['stations']}" if "stations" in metadata else ""
    name = " ".join(metadata[key] for key in ("event", "station") if metadata.get(key)) or Path(source.name).stem
    name += " borehole" if metadata.get("position") == "borehole" else ""
    acceleration = component.acceleration * ACCELERATION_UNITS[component.unit]
    by_hand = [f"stated by the user: {', '.join(source.stated)}"] if source.stated else []
    motion = GroundMotion(acceleration, component.time_step, None, name, metadata, (note, *by_hand, *source.doubts))
    if quiet := plausibility.of_quiet(motion.peak):
        motion = motion.changed(f"{source.name}: {quiet[0]}")
        plausibility.warn_of_values(f"{source.name}: component {component.name}: {doubt}" for doubt in quiet)
    plausibility.warn_of_values(f"{source.name}: {doubt}" for doubt in integral_doubts(motion))
    return motion


def _direction(source: Source, record: Record, component: Component) -> directions.Direction:
    """Return the direction of a component from its record, or for a single component also from the file name."""
    sides = directions.settled([other.direction for other in record.components])
    side = sides[record.components.index(component)]
    return directions.both(directions.of_file_name(source.name), side) if len(sides) == 1 else side


def _joined(motion: GroundMotion, upright: GroundMotion, beside: Source, *, same_file: bool) -> GroundMotion:
    name = upright.metadata["component"]
    if same_file and name == motion.metadata["component"]:
        raise InvalidValueError(
            "{file} contains the horizontal component {component}, not the vertical one", file=beside.name,
            component=name,
        )  # fmt: skip
    if late := delay(motion, upright):
        raise beside.error(
            None,
            "the motion starts {delay:g} s after the horizontal component; trim both to a common start",
            delay=late,
        )
    return with_vertical(motion, upright)


def delay(motion: GroundMotion, other: GroundMotion) -> float:
    """Return the delay of another motion [s]; zero if a start is not stated, or if the delay is below half a step."""
    for key in _STARTS:
        if key in motion.metadata and key in other.metadata:
            late = _seconds(other.metadata[key]) - _seconds(motion.metadata[key])
            if abs(late) > 0.5 * motion.time_step:
                return late
    return 0.0


def _seconds(text: str) -> float:
    """Return a stated time in seconds since a fixed origin; NaN if the time is unclear."""
    number, space, unit = text.partition(" ")
    try:
        if space and unit == "s":
            return float(number)
        return datetime.fromisoformat(text.replace("/", "-")).replace(tzinfo=UTC).timestamp()
    except ValueError:
        return float("nan")


def _recognised(source: Source) -> RecordFormat:
    *candidates, last = formats().values()
    matches = [candidate for candidate in candidates if candidate.recognises(source)]
    if len(matches) > 1:
        names = ", ".join(candidate.name for candidate in matches)
        hint = Message("add {option} with one of these", {"option": Option("motion.format")})
        raise source.error(None, "the format is ambiguous: {formats}", formats=names, hint=hint)
    if matches:
        return matches[0]
    if near := next((candidate for candidate in candidates if candidate.resembles(source)), None):
        hint = Message("add {option} to find the damage", {"option": Option("motion.format", near.name)})
        raise source.error(None, "the header resembles {format}; the file may be damaged", format=near.name, hint=hint)
    if last.recognises(source):
        return last
    top = " ".join(source.lines[:5])[:1000].lower() if source.is_text else ""
    quantity = next(
        (word for word in ("spectra", "spectrum", "velocity", "displacement", "counts") if word in top), None
    )
    is_other_quantity = quantity is not None and (quantity.startswith("spectr") or "accel" not in top)
    raise last.refusal(source) or source.error(
        None,
        (_UNKNOWN_QUANTITY if is_other_quantity else _UNKNOWN).text,
        formats=", ".join(formats()),
        **({"quantity": Message(quantity or "")} if is_other_quantity else {}),
    )


_UNKNOWN = Message("unknown format, allowed are {formats}; the file may be damaged")
_UNKNOWN_QUANTITY = Message("the file contains {quantity}; accelerations over time are required; formats: {formats}")


def _chosen(record: Record, parameter: str, name: str | None, other: Component | None = None) -> Component:
    names = [component.name for component in record.components]
    if name is None:
        remaining = [component for component in record.components if component is not other]
        if len(record.components) > 1 or not remaining:
            hint = Message("add {option} with one of these", {"option": Option(f"motion.{parameter}")})
            raise InvalidValueError(
                "the file has the components {names}", hint=hint, names=", ".join(names), components=tuple(names)
            )
        return remaining[0]
    matches = [
        component for component in record.components if component.name.casefold() == str(name).strip().casefold()
    ]
    if len(matches) != 1 or matches[0] is other:
        reason = (
            "this is the vertical component" if matches and matches[0] is other else f"the file has {', '.join(names)}"
        )
        raise InvalidValueError(
            "{parameter} must be the name of one component, got {value}", parameter=parameter, value=name, hint=reason
        )
    return matches[0]
