"""Read a measurement from a file: the suffix says what it is, and columns and units are never guessed."""

from collections.abc import Callable, Sequence
from pathlib import Path

from rocking import checks
from rocking.errors import MeasurementError, RecordError, RockingError
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.identification.readers.columns import ReaderOptions, impact_list, motion_series
from rocking.identification.readers.recording import COMPRESSED, read_compressed, read_wav
from rocking.identification.readers.sound import impacts_heard, refuse_sound
from rocking.identification.readers.video import VIDEOS, rotation_seen
from rocking.messages import Option
from rocking.motions.formats.record import Source

Measurement = ImpactTimes | RotationSeries

_NOT_DECODED = (".m4a", ".aac", ".3gp", ".amr", ".wma")

TEXTS = (".csv", ".tsv", ".txt", ".dat")
_TABLES = (*TEXTS, ".xlsx")

SOUNDS = (".wav", *COMPRESSED, *_NOT_DECODED)
ENDINGS = (*SOUNDS, *VIDEOS, *_TABLES)
"""Of files that hold a sound, or any measurement, or seem to."""

KINDS = ("sound", "video", "times", "rotation", "displacement", "angular velocity", "acceleration")
"""What a file may hold."""


def read_measurement(  # noqa: PLR0913 - what may be said of a file
    path: str | Path,
    *,
    kind: str | None = None,
    column: str | None = None,
    unit: str | None = None,
    time_column: str | None = None,
    time_unit: str | None = None,
    height: float | None = None,
    region: Sequence[float] | None = None,
    frame_rate: float | None = None,
) -> Measurement:
    r"""Return what was measured of a body that rocks freely: the times of its impacts, or how it turned.

    Parameters
    ----------
    path : str or Path
        A sound (.wav; .flac, .ogg, .mp3 with soundfile), a video (.mp4, .mov, .avi, .mkv, .webm with OpenCV), or a
        table with a line of names (.csv, .tsv, .txt, .xlsx).
    kind : str, optional
        One of `KINDS`: what the file holds. A sound or a video needs none, nor does a table whose column says so by its
        unit: rad and deg are a rotation, rad/s and deg/s an angular velocity, lengths a displacement, g and m/s2 an
        acceleration; the times of impacts are asked for by "times".
    column, unit : str, optional
        Name of the column and its unit, where the table has several beside the time or states no unit in brackets.
    time_column, time_unit : str, optional
        The same for the times, "s" or "ms"; if not given, the column that is called time, with its unit.
    height : float, optional
        Height of the sensor above the base, for a displacement or an acceleration, both positive to the right [m].
    region : sequence of float, optional
        Of a video, where the body is at rest: left, top, width, height; if not given, what moves is followed [pixels].
    frame_rate : float, optional
        Of a video that is played more slowly than it was taken, with which it was taken [1/s].

    Returns
    -------
    ImpactTimes or RotationSeries
        With its source, and a sentence for each doubt.

    Raises
    ------
    MeasurementError
        If the file is missing, damaged or of another kind, a column or unit must be named, or what it holds is no
        rocking.
    InvalidValueError
        If there is no kind or unit of that name, or a value is outside its range.
    MissingExtraError
        If soundfile, OpenCV or openpyxl is needed and not installed.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "laser.csv"
    ...     _ = path.write_text("time [s],top [mm]\n0.00,20\n0.01,19\n0.02,17\n0.03,14\n")
    ...     series = read_measurement(path, height=0.5)
    >>> round(float(series.rotation[0]), 4)
    0.04
    """
    kind = None if kind is None else checks.one_of("kind", kind, KINDS)
    path = Path(path)
    options = ReaderOptions(kind, column, unit, time_column, time_unit, height, region, frame_rate)
    try:
        if path.suffix.lower() in VIDEOS:
            return _filmed(path, options)
        if (region, frame_rate) != (None, None):
            raise MeasurementError(
                "is no video, and takes no {region} or {rate}",
                region=Option("measurement.region"), rate=Option("measurement.frame_rate"),
            ).at(path.name)  # fmt: skip
        source = Source.of_path(path)
        return _reader(path, kind)(source, options)
    except RecordError as error:  # from what reads the columns of ground motions too
        raise error.copied(MeasurementError) from error
    except RockingError:
        raise
    except Exception as error:  # whatever a file provokes in a reader is a refusal; where it came from stays chained
        raise MeasurementError(
            "cannot be read ({type}: {reason:.120})", type=type(error).__name__, reason=str(error), hint="damaged?"
        ).at(path.name) from error


def _reader(path: Path, kind: str | None) -> Callable[[Source, ReaderOptions], Measurement]:
    suffix = path.suffix.lower()
    if suffix in _NOT_DECODED:
        raise refuse_sound(path.name, suffix)
    sound = suffix == ".wav" or suffix in COMPRESSED
    if sound != (kind == "sound") and kind is not None:
        raise MeasurementError(
            "is a sound by its ending, kind={kind!r} was asked for"
            if sound
            else "is no sound by its ending, kind={kind!r} was asked for",
            kind=kind,
        ).at(path.name)
    if sound:
        return _heard
    if suffix not in _TABLES:
        raise MeasurementError(
            "the name must end in .wav, {extensions}", extensions=", ".join((*COMPRESSED, *VIDEOS, *_TABLES))
        ).at(path.name)
    if kind == "video":
        raise MeasurementError("is no video by its ending, kind='video' was asked for").at(path.name)
    return impact_list if kind == "times" else motion_series


def _filmed(path: Path, options: ReaderOptions) -> RotationSeries:
    if options.kind not in (None, "video"):
        raise MeasurementError(
            "is a video by its ending, kind={kind!r} was asked for", kind=options.kind, hint="save its sound as WAV"
        ).at(path.name)
    if given := options.names("region", "frame_rate"):
        raise MeasurementError("a video takes no {options}: these are for tables", options=given).at(path.name)
    return rotation_seen(path, options.region, options.frame_rate)


def _heard(source: Source, options: ReaderOptions) -> ImpactTimes:
    if given := options.names():
        raise MeasurementError("a sound takes no {options}: these are for tables", options=given).at(source.name)
    wav = source.name.lower().endswith(".wav")
    return impacts_heard((read_wav if wav else read_compressed)(source.content, source.name))
