"""Rotation of a body from a video, by alignment with its picture at rest. Fixed objects give the camera motion.

Inverse compositional alignment of the pixels at edges (Baker & Matthews 2004, doi:10.1023/B:VISI.0000011205.11775.fd),
with the weights of Huber.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from rocking import checks
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import InvalidValueError, MeasurementError
from rocking.identification.measurement import RotationSeries
from rocking.identification.readers.columns import clock_doubts
from rocking.motions.formats.foreign import ForeignReader
from rocking.motions.formats.record import Source

_PIXELS, _LEAST, _STEPS, _CLOSE = 6000, 40, 20, 2e-3
_BLUR = 1.0  # width of the blur before differentiation [pixels]
_SLOPE, _FLAT = 0.16, 0.1  # ratio of the noise of slopes to that of pixels, after the blur; limit of negligible slopes
_QUIET = 0.2  # duration of the averaged picture at rest [s]
_ALIKE, _OUTSIDE = 0.3, 0.05  # largest decrease of the correlation; largest fraction of pixels outside the frame
_EDGE = 4  # margin of a frame [pixels]
_HUBER = 2.0  # limit of Huber's weights / median


@dataclass(frozen=True, eq=False)
class Film:
    """Grey frames of reduced size, with their times."""

    name: str
    frames: NDArray[np.uint8]  # grey values, shape (n, rows, columns)
    time: FloatArray  # times of the frames [s]
    scale: float  # pixels per pixel of the video

    def error(self, cause: str, **facts: Any) -> MeasurementError:
        """Return the error for a cause, with the facts of `RockingError`."""
        return MeasurementError(cause, **facts).at(self.name)

    @cached_property
    def changes(self) -> FloatArray:
        """Mean change of a pixel from frame to frame."""
        coarse = self.frames[:, ::2, ::2].astype(np.int16)
        return np.array([float(np.abs(b - a).mean()) for a, b in pairwise(coarse)])

    @cached_property
    def quiet(self) -> slice:
        """Frames with the smallest changes; of several equally quiet intervals, the last."""
        width = min(max(3, round(_QUIET / float(np.median(np.diff(self.time))))), self.changes.size)
        means = np.convolve(self.changes, np.full(width, 1.0 / width), "valid")
        first = int(np.flatnonzero(means <= 1.1 * means.min())[-1])
        return slice(first, first + width + 1)

    @cached_property
    def rest_frame(self) -> FloatArray:
        """Mean of the quiet frames."""
        return np.asarray(self.frames[self.quiet].mean(axis=0))

    @property
    def noise(self) -> float:
        """Standard deviation of a pixel without motion."""
        return float(np.median(self.changes)) * math.sqrt(math.pi / 4.0)


class RestPicture:
    """Pixels at the edges of a picture, with their derivatives by rotation, shift and light."""

    def __init__(self, picture: FloatArray, mask: BoolArray, noise: float) -> None:
        smooth = ndimage.gaussian_filter(picture, _BLUR)
        down, across = np.gradient(smooth)
        inner = np.zeros(mask.shape, np.bool_)
        inner[_EDGE:-_EDGE, _EDGE:-_EDGE] = True
        steep = np.where(mask & inner, np.hypot(down, across), 0.0)
        order = np.argsort(steep, axis=None)[::-1][:_PIXELS]
        order = order[steep.ravel()[order] > max(1.0, 0.1 * steep.max())]
        self.places = np.column_stack(np.unravel_index(order, mask.shape)).astype(float)
        self.values = smooth.ravel()[order]
        self.usable = order.size >= _LEAST
        if self.usable:
            self.centre = self.places.mean(axis=0)
            y, x = (self.places - self.centre).T
            gy, gx = down.ravel()[order], across.ravel()[order]
            moved = np.column_stack([gy * x - gx * y, gx, gy])
            units = np.array([1.0 / max(math.sqrt((x**2 + y**2).mean()), 1.0), 1.0, 1.0])
            # directions along straight edges are excluded: a shift along an edge is not distinguishable from noise
            information, directions = np.linalg.eigh((moved * units).T @ (moved * units) / order.size)
            self.free = units[:, None] * directions[:, information > 5.0 * (_SLOPE * noise) ** 2 + _FLAT]
            self.slopes = np.column_stack([moved @ self.free, self.values, np.ones(order.size)])
            self.usable = self.free.size > 0

    def sampled(self, frame: Any, pose: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return the pixels in a frame after a clockwise rotation and a shift, and a mask of the pixels inside."""
        y, x = (self.places - self.centre).T
        c, s = math.cos(pose[0]), math.sin(pose[0])
        positions = np.stack([s * x + c * y + pose[2], c * x - s * y + pose[1]]) + self.centre[:, None]
        inside = ((positions >= 0.0) & (positions <= np.array(frame.shape)[:, None] - 1.0)).all(axis=0)
        return ndimage.map_coordinates(frame, positions, order=1, mode="nearest"), inside

    def aligned(self, frame: Any, pose: FloatArray) -> tuple[FloatArray, FloatArray, float, float]:
        """Return the best pose in a frame, the residuals, the correlation, and the fraction of pixels outside."""
        light = np.array([1.0, 0.0])
        for _ in range(_STEPS):
            pixels, inside = self.sampled(frame, pose)
            missed = pixels - light[0] * self.values - light[1]  # Eq. 319
            weight = inside / np.maximum(1.0, np.abs(missed) / (_HUBER * float(np.median(np.abs(missed))) + 1.0))
            by = weight[:, None] * self.slopes
            step = np.linalg.solve(by.T @ self.slopes + 1e-6 * np.eye(by.shape[1]), by.T @ missed)
            light += step[-2:]
            turn, right, down = self.free @ step[:-2] / light[0]
            c, s = math.cos(pose[0] - turn), math.sin(pose[0] - turn)
            pose = pose - [turn, c * right - s * down, s * right + c * down]  # Eq. 320
            if abs(turn) * 100.0 + abs(right) + abs(down) < _CLOSE:
                break
        with np.errstate(invalid="ignore"):
            alike = float(np.corrcoef(pixels, self.values)[0, 1])
        return pose, missed, alike, 1.0 - float(inside.mean())


@dataclass(frozen=True, eq=False)
class PoseTrack:
    """Rotation and shift of a picture in each frame, followed from the quiet frames in both directions."""

    poses: FloatArray  # clockwise rotation [rad], and shift to the right and down [pixels], shape (n, 3)
    first: int
    last: int  # first frame without a pose
    own: BoolArray  # mask of the moving pixels

    @classmethod
    def followed(cls, film: Film, mask: BoolArray) -> "PoseTrack | None":
        """Return the track, or None if the mask contains too few edges."""
        picture = RestPicture(film.rest_frame, mask, film.noise)
        if not picture.usable:
            return None
        middle = (film.quiet.start + film.quiet.stop) // 2
        poses, ends = np.zeros((film.time.size, 3)), []
        mine, still = np.zeros(picture.values.size), np.zeros(picture.values.size)
        for step in (1, -1):
            usual: list[float] = []
            n = middle
            while 0 <= n < film.time.size:
                frame = ndimage.gaussian_filter(film.frames[n].astype(np.float32), _BLUR)
                previous, before_previous = (n - step * min(abs(n - middle), back) for back in (1, 2))
                pose, missed, alike, outside = picture.aligned(frame, 2.0 * poses[previous] - poses[before_previous])
                usual = [*usual, alike][:20]
                if not alike > float(np.median(usual)) - _ALIKE or outside > _OUTSIDE:
                    break
                poses[n] = pose
                most = 3.0 * float(np.median(np.abs(missed))) + 1.0
                mine += np.minimum(np.abs(missed), most)
                still += np.minimum(np.abs(picture.sampled(frame, np.zeros(3))[0] - picture.values), most)
                n += step
            ends.append(n)
        own = np.zeros(mask.shape, np.bool_)
        own[tuple(picture.places[mine < still].astype(np.int64).T)] = True
        return cls(poses, ends[1] + 1, ends[0], own)


VIDEOS = (".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm")
"""Extensions of videos."""

LIMITS = {"frames": 20_000, "pixels": 40_000_000, "widest": 640, "bytes": 150_000_000}
"""Largest number of frames and of pixels per frame, and largest width and memory of the reduced frames."""

_OPENCV = ForeignReader(Path(__file__).with_name("video_frames.py"), "OpenCV", "cv2", seconds=120.0)
_SIGNATURES = ((0, b"RIFF"), (0, b"\x1a\x45\xdf\xa3"), *((4, kind) for kind in (b"ftyp", b"moov", b"mdat", b"wide")))
_FEWEST, _ROUNDS = 12, 2
_ALL, _BASE = 0.7, 0.15  # largest moving fraction of the picture; excluded fraction of the height of the moving region
_SWAYS, _STEADY = 0.3, 1.0  # limits of camera motion: in pixels, and / changes from frame to frame (0.7 for noise)


def rotation_from_video(path: Path, region: Sequence[float] | None, frame_rate: float | None) -> RotationSeries:
    """Return the rotation of a body in a video; `region` of the body at rest: left, top, width, height [pixels]."""
    if frame_rate is not None:
        frame_rate = checks.positive("frame_rate", frame_rate, "1/s")
    film = read_film(path)
    moving = _moving(film)
    if region is None and moving.mean() > _ALL:
        raise film.error(
            "{moving:.0f} % of the picture moves: the camera is not fixed. Use a tripod, or state region= [left, "
            "top, width, height] of the body in pixels", moving=100.0 * moving.mean(),
        )  # fmt: skip
    body = _above_base(moving) if region is None else _stated(film, region)
    track = PoseTrack.followed(film, body)
    if track is None:
        raise film.error("the moving region has too few edges; use more light or a marker on the body")
    for _ in range(_ROUNDS if region is None else 0):
        track = PoseTrack.followed(film, track.own) or track
    a, b = track.first, track.last
    if b - a < _FEWEST:
        raise film.error(
            "the body is tracked in only {frames} frames, near {time:.3g} s", frames=max(b - a, 0), time=film.time[a],
            hint="fix the camera",
        )  # fmt: skip
    rotation, doubts = track.poses[a:b, 0], []
    for lost, when, at in ((a > 0, "before", a), (b < film.time.size, "after", b - 1)):
        if lost:
            doubts.append(
                f"the body is lost {when} {film.time[at]:.3g} s: it is hidden, or outside the picture, or "
                "the video has a cut"
            )
    turned, camera_doubts = _camera(film, ~ndimage.binary_dilation(moving | body, iterations=4), a, b)
    time = film.time
    if frame_rate is not None:  # a stated frame rate replaces the rate in the file
        time = time * (time.size - 1) / (time[-1] - time[0]) / frame_rate
    doubts.append(
        "a camera direction 10 degrees off the normal of the plane reduces rotations by 1.5 %; the intervals "
        "exclude this error"
    )
    doubts = [*clock_doubts(time[a:b]), *doubts, *camera_doubts]
    return RotationSeries(time[a:b], rotation=rotation - turned, source=film.name, doubts=tuple(doubts))  # Eq. 321


def _camera(film: Film, around: BoolArray, first: int, last: int) -> tuple[FloatArray, list[str]]:
    """Return the rotation of the fixed background, zero for a fixed camera, and doubts."""
    still, no_rotation = PoseTrack.followed(film, around), np.zeros(last - first)
    if still is None:
        return no_rotation, ["only the body has edges: the motion of the camera is unknown"]
    if still.first > first or still.last < last:
        at = film.time[still.first - 1 if still.first > first else still.last]
        raise film.error("the background is lost at {time:.3g} s: the camera moved, or the video has a cut", time=at)
    moved = still.poses[first:last] * [0.5 * max(film.rest_frame.shape), 1.0, 1.0]
    sways = float(np.abs(moved).max())
    if sways < _SWAYS or moved.std() < _STEADY * np.diff(moved, axis=0).std():
        return no_rotation, []
    doubt = f"the camera moves by {sways / film.scale:.2g} pixels; its rotation is subtracted"
    return still.poses[first:last, 0], [doubt]


def read_film(path: Path) -> Film:
    """Return the frames of a file."""
    if not path.is_file():
        raise MeasurementError("not a plain file" if path.exists() else "no such file").at(str(path))
    with path.open("rb") as file:  # refuse a text file that names other files
        head = file.read(12)
    if not any(head[at : at + len(kind)] == kind for at, kind in _SIGNATURES):
        raise MeasurementError("the first bytes are not those of a video", hint="the file may be damaged").at(path.name)
    reply, (frames, time) = _OPENCV.answer(Source(path.name, b""), LIMITS | {"path": str(path.absolute())})
    if np.any(np.diff(time) <= 0.0):
        raise MeasurementError("the times of its frames do not increase", hint="the file may be damaged or edited").at(
            path.name
        )
    return Film(path.name, frames, time, reply["scale"])


def _moving(film: Film) -> BoolArray:
    """Return the mask of the largest moving region."""
    chosen = np.unique(np.linspace(0, film.time.size - 1, 80).astype(np.int64))
    blurred = [ndimage.gaussian_filter(frame - frame.mean(), 2.0) for frame in film.frames[chosen].astype(np.float32)]
    noise = np.median([np.median(np.abs(a - b)) for a, b in zip(blurred[1:], blurred[:-1], strict=True)])
    pieces, count = ndimage.label(np.ptp(blurred, axis=0) > 10.0 * noise + 6.0)
    if not count:
        raise film.error("no moving region: nothing moves, or the camera is not fixed")
    largest = 1 + int(np.argmax(np.bincount(pieces.ravel())[1:]))
    return np.asarray(ndimage.binary_dilation(pieces == largest, iterations=2))


def _above_base(moving: BoolArray) -> BoolArray:
    """Return the mask without its lowest part, where the ground is visible during uplift."""
    rows = np.flatnonzero(moving.any(axis=1))
    mask = moving.copy()
    mask[rows[-1] - int(_BASE * rows.size) :] = False
    return mask


def _stated(film: Film, region: Sequence[float]) -> BoolArray:
    rows, columns = film.rest_frame.shape
    if np.shape(region) != (4,):
        raise InvalidValueError(
            parameter="region", allowed="four numbers: left, top, width, height [pixels]", value=region
        )
    x, y, width, height = (round(film.scale * checks.number("region", number, "pixels")) for number in region)
    if min(x, y) < 0 or min(width, height) < 4 or x + width > columns or y + height > rows:
        raise InvalidValueError(
            "{parameter} must lie within {columns:.0f} x {rows:.0f} pixels, got {value}", parameter="region",
            value=list(region), columns=columns / film.scale, rows=rows / film.scale,
        )  # fmt: skip
    mask = np.zeros((rows, columns), np.bool_)
    mask[y : y + height, x : x + width] = True
    return mask
