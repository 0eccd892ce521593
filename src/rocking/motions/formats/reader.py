"""Reading a record file of whatever format, and writing one."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from functools import cache
from os import PathLike
from pathlib import Path

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, RecordError, RockingError
from rocking.messages import Message, Option
from rocking.motions.components import with_vertical
from rocking.motions.formats import directions
from rocking.motions.formats.record import Component, Record, RecordFormat, Source
from rocking.motions.formats.stations import Places
from rocking.motions.integrals import ground_displacement, ground_velocity
from rocking.motions.motion import GroundMotion

_STARTS = ("starttime", "Record Time", "first time")
"""What miniSEED and SAC, K-NET, and columns say about the time of the first sample."""


@cache
def _classes() -> tuple[type[RecordFormat], ...]:
    """Return every format in the order in which they are tried; a new one is one file, one import and one name here."""
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
        Columns,  # the last resort: numbers without a header describe nothing
    )  # fmt: skip


def formats() -> dict[str, RecordFormat]:
    """Return every record format by name.

    Returns
    -------
    dict of str to RecordFormat
        In the order in which they are tried.
    """
    return {kind.name: kind() for kind in _classes()}


def format_named(name: str) -> RecordFormat:
    """Return one record format."""
    known = formats()
    return known[checks.one_of("format", name, known)]


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
        The file.
    format : str, optional
        Name of its format; found by content if not given.
    units : str, optional
        Unit of acceleration, where the file does not state it: a key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float, optional
        Step between samples, where the file does not state it [s].
    skip : int
        Lines at the top of a text file that are passed over.

    Returns
    -------
    Record
        Components and header.

    Raises
    ------
    InvalidValueError
        If there is no format or unit of that name.
    RecordError
        If the file is missing, of no known format or of more than one, damaged, or at odds with its own header.

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


def read_motion(  # noqa: PLR0913 - every one of them is a property of some files
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
    """Return one component of a record file as a ground motion, with a second one as its vertical part if wanted.

    Where components are in files of their own (PEER, ESM, K-NET), `vertical_path` is the file of the vertical one;
    `format`, `units` and `time_step` then hold for both files.

    Parameters
    ----------
    path : path-like
        The file.
    format : str, optional
        Name of its format; found by content if not given.
    units : str, optional
        Unit of acceleration, where the file does not state it: a key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float, optional
        Step between samples, where the file does not state it [s].
    component : str, optional
        Name of the horizontal component, in any case; needed where the file has several.
    vertical : str, optional
        Name of the vertical component, in any case; with `vertical_path` only needed where that file has several.
    vertical_path : path-like, optional
        Another file, which has the vertical component: of the same step and start; the longer one is cut.
    stations : path-like or sequence of path-like, optional
        StationXML files, or folders of them, by which the counts of a miniSEED file become accelerations.
    skip : int
        Lines at the top of a text file that are passed over.

    Returns
    -------
    GroundMotion
        In m/s2; its metadata hold the raw header, its provenance the SHA-256 of each file.

    Raises
    ------
    InvalidValueError
        If there is no format, unit or component of that name, a component must be named, or the two files hold
        the same component or have different steps.
    RecordError
        If a file is missing, of no known format or of more than one, damaged, or at odds with its own header, or
        the two files state different starts.

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
            None, "steps of {step:g} s and {vertical_step:g} s; resample one first", step=level.time_step,
            vertical_step=upright.time_step,
        )  # fmt: skip
    told = f"component {upright.name}, unit {upright.unit}"
    acceleration = upright.acceleration * ACCELERATION_UNITS[upright.unit]
    about = {"component": upright.name}
    if "channel" in upright.metadata:
        about["channel"] = upright.metadata["channel"]
    part = GroundMotion(acceleration, upright.time_step, None, "", about, (told,))
    return with_vertical(_motion(source, record, level), part)


def motions_in(
    path: Path,
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    stations: Places | None = None,
    skip: int = 0,
) -> list[GroundMotion]:
    """Return every component of a record file as a motion of its own; stations: StationXML files, which counts need."""
    source = Source.of_path(path, skip)
    record = _read(source, format, units, time_step, stations)
    return [_motion(source, record, part) for part in record.components]


def write_record(record: Record, path: str | PathLike[str], format: str) -> None:
    """Write a record to a file.

    Parameters
    ----------
    record : Record
        What to write; a format that states its unit converts to it.
    path : path-like
        The file; one that exists is replaced.
    format : str
        Name of the format.

    Raises
    ------
    InvalidValueError
        If there is no format of that name.
    RecordError
        If the format cannot hold the record or the file cannot be written.
    """
    content = format_named(format).write(record)
    try:
        Path(path).write_bytes(content)
    except (OSError, ValueError) as error:
        raise RecordError(getattr(error, "strerror", None) or str(error)).at(str(path)) from error


def write_motion(motion: GroundMotion, path: str | PathLike[str], format: str, units: str = "m/s2") -> None:
    """Write a ground motion to a file, its vertical part as a second component.

    Parameters
    ----------
    motion : GroundMotion
        What to write.
    path : path-like
        The file; one that exists is replaced.
    format : str
        Name of the format.
    units : str
        Unit of acceleration in formats that state none; the others have their own and convert to it.

    Raises
    ------
    InvalidValueError
        If there is no format or unit of that name.
    RecordError
        If the format cannot hold the motion or the file cannot be written.
    """
    units = checks.one_of("units", units, ACCELERATION_UNITS)
    rows = {motion.metadata.get("component", "horizontal"): motion.acceleration}
    if motion.vertical is not None:
        rows[motion.metadata.get("vertical component", "vertical")] = motion.vertical
    factor = ACCELERATION_UNITS[units]
    parts = tuple(Component(name, values / factor, units, motion.time_step) for name, values in rows.items())
    metadata: Mapping[str, str] = {"event": motion.name, **motion.metadata}
    write_record(Record(format, parts, metadata=metadata), path, format)


def _read(
    source: Source, format: str | None, units: str | None, time_step: float | None, stations: Places | None = None
) -> Record:
    units = None if units is None else checks.one_of("units", units, ACCELERATION_UNITS)
    if time_step is not None:
        time_step = checks.positive("time_step", time_step, "s")
    stated = {"format": format, "unit": units, "time step": None if time_step is None else f"{time_step:g} s"}
    stated["lines at the top passed over"] = str(source.skip) if source.skip else None
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
    except Exception as error:  # whatever a file provokes in a reader is a refusal; where it came from stays chained
        where = "while its format was looked for" if chosen is None else f"as {chosen.name}"
        raise source.error(
            None, "it cannot be read {stage} ({type}: {reason:.120})", stage=where, type=type(error).__name__,
            reason=str(error), hint="damaged, or another format?",
        ) from error  # fmt: skip
    if not source.doubts:
        return record
    plausibility.warn(source.doubts)
    return replace(record, metadata={**record.metadata, "doubts": "; ".join(source.doubts)})


def _motion(source: Source, record: Record, part: Component) -> GroundMotion:
    own = {"format": record.format, "unit": part.unit, "component": part.name, "header": record.header}
    own[directions.KEY] = directions.as_text(_direction(source, record, part))
    metadata = {**record.metadata, **part.metadata, **own}
    told = f"read from {source.name}, SHA-256 {source.sha256}, format {record.format}"
    told += f", component {part.name}, unit {part.unit}"
    told += f", counts by {metadata['stations']}" if "stations" in metadata else ""
    name = " ".join(metadata[key] for key in ("event", "station") if metadata.get(key)) or Path(source.name).stem
    name += " borehole" if metadata.get("position") == "borehole" else ""
    acceleration = part.acceleration * ACCELERATION_UNITS[part.unit]
    by_hand = [f"stated by the user: {', '.join(source.stated)}"] if source.stated else []
    motion = GroundMotion(acceleration, part.time_step, None, name, metadata, (told, *by_hand, *source.doubts))
    if quiet := plausibility.of_quiet(motion.peak):
        motion = motion.changed(f"{source.name}: {quiet[0]}")
        plausibility.warn(f"{source.name}: component {part.name}: {doubt}" for doubt in quiet)
    velocity, displacement = ground_velocity(motion), ground_displacement(motion)
    ends = float(velocity[-1]), float(np.abs(velocity).max()), float(np.abs(displacement).max())
    plausibility.warn(f"{source.name}: {doubt}" for doubt in plausibility.of_integrals(*ends))
    return motion


def _direction(source: Source, record: Record, part: Component) -> directions.Direction:
    """Return the direction of a component by its record, and by the name of the file where it is alone in it."""
    sides = directions.settled([one.direction for one in record.components])
    side = sides[record.components.index(part)]
    return directions.both(directions.of_file_name(source.name), side) if len(sides) == 1 else side


def _joined(motion: GroundMotion, upright: GroundMotion, beside: Source, *, same_file: bool) -> GroundMotion:
    name = upright.metadata["component"]
    if same_file and name == motion.metadata["component"]:
        raise InvalidValueError(
            "{file} holds the horizontal component {component} and cannot be the vertical one", file=beside.name,
            component=name,
        )  # fmt: skip
    if late := delay(motion, upright):
        raise beside.error(
            None, "it starts {delay:g} s after the horizontal component; trim both to one start", delay=late
        )
    return with_vertical(motion, upright)


def delay(motion: GroundMotion, other: GroundMotion) -> float:
    """Return how much later another motion starts, as far as both state it and beyond half a step; else zero [s]."""
    for key in _STARTS:
        if key in motion.metadata and key in other.metadata:
            late = _seconds(other.metadata[key]) - _seconds(motion.metadata[key])
            if abs(late) > 0.5 * motion.time_step:
                return late
    return 0.0


def _seconds(said: str) -> float:
    """Return a stated time in seconds since some instant; NaN, which no comparison finds late, if it is unclear."""
    number, space, unit = said.partition(" ")
    try:
        if space and unit == "s":
            return float(number)
        return datetime.fromisoformat(said.replace("/", "-")).replace(tzinfo=UTC).timestamp()
    except ValueError:
        return float("nan")


def _recognised(source: Source) -> RecordFormat:
    *known, last = formats().values()
    found = [one for one in known if one.recognises(source)]
    if len(found) > 1:
        names = ", ".join(one.name for one in found)
        hint = Message("say {option} one of these", {"option": Option("motion.format")})
        raise source.error(None, "it could be {formats}", formats=names, hint=hint)
    if found:
        return found[0]
    if near := next((one for one in known if one.resembles(source)), None):
        hint = Message("say {option} to see where", {"option": Option("motion.format", near.name)})
        raise source.error(None, "its header is nearly that of {format}; damaged?", format=near.name, hint=hint)
    if last.recognises(source):
        return last
    top = " ".join(source.lines[:5])[:1000].lower() if source.is_text else ""
    held = next((word for word in ("spectra", "spectrum", "velocity", "displacement", "counts") if word in top), None)
    speaks = held is not None and (held.startswith("spectr") or "accel" not in top)
    raise last.refusal(source) or source.error(
        None,
        (_UNKNOWN_QUANTITY if speaks else _UNKNOWN).text,
        formats=", ".join(formats()),
        **({"quantity": Message(held or "")} if speaks else {}),
    )


_UNKNOWN = Message("not recognised as any of {formats}; damaged, or another format?")
_UNKNOWN_QUANTITY = Message("it contains {quantity}, and accelerations over time are needed; formats: {formats}")


def _chosen(record: Record, what: str, name: str | None, other: Component | None = None) -> Component:
    names = [part.name for part in record.components]
    if name is None:
        left = [part for part in record.components if part is not other]
        if len(record.components) > 1 or not left:
            hint = Message("say {option} one of these", {"option": Option(f"motion.{what}")})
            raise InvalidValueError(
                "the file has the components {names}", hint=hint, names=", ".join(names), components=tuple(names)
            )
        return left[0]
    found = [part for part in record.components if part.name.casefold() == str(name).strip().casefold()]
    if len(found) != 1 or found[0] is other:
        why = "it is the vertical one already" if found and found[0] is other else f"the file has {', '.join(names)}"
        raise InvalidValueError(
            "{parameter} must name one component, got {value}", parameter=what, value=name, hint=why
        )
    return found[0]
