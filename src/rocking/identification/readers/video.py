"""How a body turns in a video: the picture of it at rest, followed; what stands still tells how the camera moves."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy import ndimage

from rocking import checks
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import InvalidValueError, MeasurementError
from rocking.identification.measurement import RotationSeries
from rocking.identification.readers.columns import clock_doubts
from rocking.identification.readers.video_track import Film, PoseTrack
from rocking.motions.formats.foreign import ForeignReader
from rocking.motions.formats.record import Source

VIDEOS = (".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm")
"""Suffixes of what is read as a video."""

LIMITS = {"frames": 20_000, "pixels": 40_000_000, "widest": 640, "bytes": 150_000_000}
"""Of frames, of pixels of each; frames are made as small as the others ask for."""

_OPENCV = ForeignReader(Path(__file__).with_name("video_frames.py"), "OpenCV", "cv2", seconds=120.0)
_SIGNATURES = ((0, b"RIFF"), (0, b"\x1a\x45\xdf\xa3"), *((4, kind) for kind in (b"ftyp", b"moov", b"mdat", b"wide")))
_FEWEST, _ROUNDS = 12, 2
_ALL, _BASE = 0.7, 0.15  # share of the picture; of the height of what moves
_SWAYS, _STEADY = 0.3, 1.0  # pixels; over changes from frame to frame, where noise has .7


def rotation_seen(path: Path, region: Sequence[float] | None, frame_rate: float | None) -> RotationSeries:
    """Return how a body turns in a video; region: of the body at rest, left, top, width, height [pixels]."""
    if frame_rate is not None:
        frame_rate = checks.positive("frame_rate", frame_rate, "1/s")
    film = read_film(path)
    moving = _moving(film)
    if region is None and moving.mean() > _ALL:
        raise film.error(
            f"{100.0 * moving.mean():.0f} % of the picture moves, and so does the camera: put it on a tripod, or say "
            "where the body is, region= [left, top, width, height] in pixels"
        )
    body = _above_base(moving) if region is None else _stated(film, region)
    track = PoseTrack.of(film, body)
    if track is None:
        raise film.error("what moves in it shows too few edges; more light, or a marker on the body?")
    for _ in range(_ROUNDS if region is None else 0):
        track = PoseTrack.of(film, track.own) or track
    a, b = track.first, track.last
    if b - a < _FEWEST:
        raise film.error(
            f"the body is followed in {max(b - a, 0)} frames only, about {film.time[a]:.3g} s; a swaying camera?"
        )
    rotation, doubts = track.poses[a:b, 0], []
    for lost, when, at in ((a > 0, "before", a), (b < film.time.size, "after", b - 1)):
        if lost:
            doubts.append(f"the body is lost {when} {film.time[at]:.3g} s: a hand, a cut, or it leaves the picture")
    turned, said = _camera(film, ~ndimage.binary_dilation(moving | body, iterations=4), a, b)
    time = film.time
    if frame_rate is not None:  # of a film that is played more slowly than it was taken
        time = time * (time.size - 1) / (time[-1] - time[0]) / frame_rate
    doubts.append(
        "a camera 10 degrees off the normal of the body's plane sees rotations 1.5 % too small, which is in no interval"
    )
    doubts = [*clock_doubts(time[a:b]), *doubts, *said]
    return RotationSeries(time[a:b], rotation=rotation - turned, source=film.name, doubts=tuple(doubts))  # Eq. 321


def _camera(film: Film, around: BoolArray, first: int, last: int) -> tuple[FloatArray, list[str]]:
    """Return how what stands still turns in the picture, zero if it does not, and what there is to say."""
    still, none = PoseTrack.of(film, around), np.zeros(last - first)
    if still is None:
        return none, ["nothing but the body shows edges: whether the camera stood still is not known"]
    if still.first > first or still.last < last:
        at = film.time[still.first - 1 if still.first > first else still.last]
        raise film.error(f"what stands still is lost at {at:.3g} s: the camera was moved, or there is a cut")
    moved = still.poses[first:last] * [0.5 * max(film.rest.shape), 1.0, 1.0]
    sways = float(np.abs(moved).max())
    if sways < _SWAYS or moved.std() < _STEADY * np.diff(moved, axis=0).std():
        return none, []
    words = f"the camera moves by {sways / film.scale:.2g} pixels; how it turns was taken away"
    return still.poses[first:last, 0], [words]


def read_film(path: Path) -> Film:
    """Return what a file shows."""
    if not path.is_file():
        raise MeasurementError(f"{path}: {'not a plain file' if path.exists() else 'no such file'}")
    with path.open("rb") as file:  # text that names other files is no video either
        head = file.read(12)
    if not any(head[at : at + len(kind)] == kind for at, kind in _SIGNATURES):
        raise MeasurementError(f"{path.name}: no video by its first bytes; damaged?")
    said, (frames, time) = _OPENCV.answer(Source(path.name, b""), LIMITS | {"path": str(path.absolute())})
    if np.any(np.diff(time) <= 0.0):
        raise MeasurementError(f"{path.name}: the times of its frames do not increase; damaged, or edited?")
    return Film(path.name, frames, time, said["scale"])


def _moving(film: Film) -> BoolArray:
    """Return where something moves: the largest piece of it."""
    chosen = np.unique(np.linspace(0, film.time.size - 1, 80).astype(np.int64))
    blurred = [ndimage.gaussian_filter(each - each.mean(), 2.0) for each in film.frames[chosen].astype(np.float32)]
    noise = np.median([np.median(np.abs(a - b)) for a, b in zip(blurred[1:], blurred[:-1], strict=True)])
    pieces, count = ndimage.label(np.ptp(blurred, axis=0) > 10.0 * noise + 6.0)
    if not count:
        raise film.error("nothing moves in it, or all of it does, with a camera that nobody holds still")
    largest = 1 + int(np.argmax(np.bincount(pieces.ravel())[1:]))
    return np.asarray(ndimage.binary_dilation(pieces == largest, iterations=2))


def _above_base(moving: BoolArray) -> BoolArray:
    """Return it without its lowest part, where the ground shows under a base that lifts."""
    rows = np.flatnonzero(moving.any(axis=1))
    found = moving.copy()
    found[rows[-1] - int(_BASE * rows.size) :] = False
    return found


def _stated(film: Film, region: Sequence[float]) -> BoolArray:
    rows, columns = film.rest.shape
    if np.shape(region) != (4,):
        raise InvalidValueError(f"region must be four numbers: left, top, width, height [pixels], got {region!r:.60}")
    x, y, width, height = (round(film.scale * checks.number("region", each, "pixels")) for each in region)
    if min(x, y) < 0 or min(width, height) < 4 or x + width > columns or y + height > rows:
        raise InvalidValueError(
            f"region must lie within {columns / film.scale:.0f} x {rows / film.scale:.0f} pixels, got {list(region)}"
        )
    found = np.zeros((rows, columns), np.bool_)
    found[y : y + height, x : x + width] = True
    return found
