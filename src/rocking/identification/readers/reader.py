"""The function `read_measurement`: the extension determines the kind of file; columns and units are never guessed."""

from collections.abc import Callable, Sequence
from pathlib import Path

from rocking import checks
from rocking.errors import MeasurementError, RecordError, RockingError
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.identification.readers.columns import ReaderOptions, impact_list, motion_series
from rocking.identification.readers.recording import COMPRESSED, read_compressed, read_wav
from rocking.identification.readers.sound import impacts_from_sound, undecoded_sound
from rocking.identification.readers.video import VIDEOS, rotation_from_video
from rocking.messages import Option
from rocking.motions.formats.record import Source

Measurement = ImpactTimes | RotationSeries

_NOT_DECODED = (".m4a", ".aac", ".3gp", ".amr", ".wma")

TEXTS = (".csv", ".tsv", ".txt", ".dat")
_TABLES = (*TEXTS, ".xlsx")

SOUNDS = (".wav", *COMPRESSED, *_NOT_DECODED)
ENDINGS = (*SOUNDS, *VIDEOS, *_TABLES)
"""Extensions of measurement files."""

KINDS = ("sound", "video", "times", "rotation", "displacement", "angular velocity", "acceleration")
"""Kinds of measurements in a file."""


def read_measurement(  # noqa: PLR0913 - options of a file
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
    r"""Return the measurement of a freely rocking body: times of its impacts, or its rotation.

    Parameters
    ----------
    path : str or Path
        A sound (.wav; .flac, .ogg, .mp3 with soundfile), a video (.mp4, .mov, .avi, .mkv, .webm with OpenCV), or a
        table with a line of names (.csv, .tsv, .txt, .xlsx).
    kind : str, optional
        One of `KINDS`. Default for a table: from the unit of its column. The units rad and deg are a rotation, rad/s
        and deg/s an angular velocity, lengths a displacement, g and m/s2 an acceleration. "times" selects times of
        impacts.
    column, unit : str, optional
        Name of the column and its unit, if the table has several columns or contains no unit in brackets.
    time_column, time_unit : str, optional
        Name of the column of times and its unit, "s" or "ms". Default: the column named time.
    height : float, optional
        Height of the sensor above the base, for a displacement or an acceleration, both positive to the right [m].
    region : sequence of float, optional
        For a video, the body at rest: left, top, width, height. Default: the moving region [pixels].
    frame_rate : float, optional
        Frame rate of the camera, for a video in slow motion [1/s].

    Returns
    -------
    ImpactTimes or RotationSeries
        The measurement, with source and doubts.

    Raises
    ------
    MeasurementError
        If the file is missing, damaged or of another kind, if a column or unit must be named, or if the measurement
        contains no rocking.
    InvalidValueError
        If a kind or unit is unknown, or a value is outside its range.
    MissingExtraError
        If soundfile, OpenCV or openpyxl is required and not installed.

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
            return _read_video(path, options)
        if (region, frame_rate) != (None, None):
            raise MeasurementError(
                "the file is not a video; {region} and {rate} can be used with videos only",
                region=Option("measurement.region"), rate=Option("measurement.frame_rate"),
            ).at(path.name)  # fmt: skip
        source = Source.of_path(path)
        return _reader(path, kind)(source, options)
    except RecordError as error:  # the error of the reader of columns, which also reads ground motions
        raise error.copied(MeasurementError) from error
    except RockingError:
        raise
    except Exception as error:  # any error of a reader refuses the file; the original error stays chained
        raise MeasurementError(
            "the file cannot be read ({type}: {reason:.120})",
            type=type(error).__name__,
            reason=str(error),
            hint="the file may be damaged",
        ).at(path.name) from error


def _reader(path: Path, kind: str | None) -> Callable[[Source, ReaderOptions], Measurement]:
    suffix = path.suffix.lower()
    if suffix in _NOT_DECODED:
        raise undecoded_sound(path.name, suffix)
    sound = suffix == ".wav" or suffix in COMPRESSED
    if sound != (kind == "sound") and kind is not None:
        raise MeasurementError(
            "has the extension of a sound, but kind={kind!r}"
            if sound
            else "does not have the extension of a sound, but kind={kind!r}",
            kind=kind,
        ).at(path.name)
    if sound:
        return _read_sound
    if suffix not in _TABLES:
        raise MeasurementError(
            "the extension of the file must be .wav, {extensions}",
            extensions=", ".join((*COMPRESSED, *VIDEOS, *_TABLES)),
        ).at(path.name)
    if kind == "video":
        raise MeasurementError("the file does not have the extension of a video, but kind='video'").at(path.name)
    return impact_list if kind == "times" else motion_series


def _read_video(path: Path, options: ReaderOptions) -> RotationSeries:
    if options.kind not in (None, "video"):
        raise MeasurementError(
            "the file has the extension of a video, but kind={kind!r}",
            kind=options.kind,
            hint="save the sound of the video as WAV",
        ).at(path.name)
    if stated := options.names("region", "frame_rate"):
        raise MeasurementError("{options} can be used with tables only, not with a video", options=stated).at(path.name)
    return rotation_from_video(path, options.region, options.frame_rate)


def _read_sound(source: Source, options: ReaderOptions) -> ImpactTimes:
    if stated := options.names():
        raise MeasurementError("{options} can be used with tables only, not with a sound", options=stated).at(
            source.name
        )
    wav = source.name.lower().endswith(".wav")
    return impacts_from_sound((read_wav if wav else read_compressed)(source.content, source.name))
