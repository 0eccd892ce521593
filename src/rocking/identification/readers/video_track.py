"""A picture followed through a film: turned and shifted until it lies on every other frame.

Inverse compositional alignment of the pixels that show edges (Baker & Matthews 2004,
doi:10.1023/B:VISI.0000011205.11775.fd), with the weights of Huber.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from rocking.conventions import BoolArray, FloatArray
from rocking.errors import MeasurementError

_PIXELS, _LEAST, _STEPS, _CLOSE = 6000, 40, 20, 2e-3
_BLUR = 1.0  # before slopes are taken [pixels]
_SLOPE, _FLAT = 0.16, 0.1  # noise of slopes over that of pixels, after the blur; slopes that are none
_QUIET = 0.2  # for which the picture at rest is averaged [s]
_ALIKE, _OUTSIDE = 0.3, 0.05  # below the usual correlation; share of pixels
_EDGE = 4  # of a frame, which is left as soon as anything moves [pixels]
_HUBER = 2.0  # times the median


@dataclass(frozen=True, eq=False)
class Film:
    """Grey frames, smaller than they were, and when each was taken."""

    name: str
    frames: NDArray[np.uint8]  # n, rows, columns
    time: FloatArray  # [s]
    scale: float  # pixels here for each of the video

    def error(self, cause: str) -> MeasurementError:
        """Return the error for a cause, to be raised."""
        return MeasurementError(f"{self.name}: {cause}")

    @cached_property
    def changes(self) -> FloatArray:
        """How much a pixel changes from frame to frame, in the mean."""
        some = self.frames[:, ::2, ::2].astype(np.int16)
        return np.array([float(np.abs(b - a).mean()) for a, b in pairwise(some)])

    @cached_property
    def quiet(self) -> slice:
        """Frames while which the least changes: the last ones of those that are as quiet."""
        width = min(max(3, round(_QUIET / float(np.median(np.diff(self.time))))), self.changes.size)
        means = np.convolve(self.changes, np.full(width, 1.0 / width), "valid")
        first = int(np.flatnonzero(means <= 1.1 * means.min())[-1])
        return slice(first, first + width + 1)

    @cached_property
    def rest(self) -> FloatArray:
        """The mean of these frames."""
        return np.asarray(self.frames[self.quiet].mean(axis=0))

    @property
    def noise(self) -> float:
        """Standard deviation of a pixel where nothing moves."""
        return float(np.median(self.changes)) * math.sqrt(math.pi / 4.0)


class RestPicture:
    """Pixels of a picture that show edges, and how each changes as the picture turns and shifts, or its light."""

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
            # along a straight edge nothing tells a shift from noise: such directions are left out
            told, directions = np.linalg.eigh((moved * units).T @ (moved * units) / order.size)
            self.free = units[:, None] * directions[:, told > 5.0 * (_SLOPE * noise) ** 2 + _FLAT]
            self.slopes = np.column_stack([moved @ self.free, self.values, np.ones(order.size)])
            self.usable = self.free.size > 0

    def seen(self, frame: Any, pose: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return its pixels in a frame where it has turned, clockwise, and shifted; and which are inside."""
        y, x = (self.places - self.centre).T
        c, s = math.cos(pose[0]), math.sin(pose[0])
        there = np.stack([s * x + c * y + pose[2], c * x - s * y + pose[1]]) + self.centre[:, None]
        inside = ((there >= 0.0) & (there <= np.array(frame.shape)[:, None] - 1.0)).all(axis=0)
        return ndimage.map_coordinates(frame, there, order=1, mode="nearest"), inside

    def laid(self, frame: Any, pose: FloatArray) -> tuple[FloatArray, FloatArray, float, float]:
        """Return the pose with which it lies best on a frame, differences, their correlation, and the share outside."""
        light = np.array([1.0, 0.0])
        for _ in range(_STEPS):
            found, inside = self.seen(frame, pose)
            missed = found - light[0] * self.values - light[1]  # Eq. 319
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
            alike = float(np.corrcoef(found, self.values)[0, 1])
        return pose, missed, alike, 1.0 - float(inside.mean())


@dataclass(frozen=True, eq=False)
class PoseTrack:
    """How a picture turns and shifts from frame to frame, from the quiet ones in both directions until it is lost."""

    poses: FloatArray  # n, 3: rotation, clockwise [rad], and shift to the right and down [pixels]
    first: int
    last: int  # the first frame that has none
    own: BoolArray  # pixels that go with it rather than stand still

    @classmethod
    def of(cls, film: Film, mask: BoolArray) -> "PoseTrack | None":
        """Return it, or None if the pixels of the mask show too few edges."""
        picture = RestPicture(film.rest, mask, film.noise)
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
                one, two = (n - step * min(abs(n - middle), back) for back in (1, 2))
                pose, missed, alike, outside = picture.laid(frame, 2.0 * poses[one] - poses[two])
                usual = [*usual, alike][:20]
                if not alike > float(np.median(usual)) - _ALIKE or outside > _OUTSIDE:
                    break
                poses[n] = pose
                most = 3.0 * float(np.median(np.abs(missed))) + 1.0
                mine += np.minimum(np.abs(missed), most)
                still += np.minimum(np.abs(picture.seen(frame, np.zeros(3))[0] - picture.values), most)
                n += step
            ends.append(n)
        own = np.zeros(mask.shape, np.bool_)
        own[tuple(picture.places[mine < still].astype(np.int64).T)] = True
        return cls(poses, ends[1] + 1, ends[0], own)
