"""A script for `foreign`, which reads the frames of a video with OpenCV: grey, of reduced size, with their times."""

from typing import Any

import cv2
import numpy as np

NEEDED = 12


def answer(request: dict[str, Any]) -> tuple[dict[str, Any], list[Any]]:
    """Return the scale of the frames, the frames and their times [s]; beyond the limits of the request, an error."""
    capture = cv2.VideoCapture(request["path"], cv2.CAP_FFMPEG)
    most, pixels, widest, room = (request[name] for name in ("frames", "pixels", "widest", "bytes"))
    count = min(max(int(capture.get(cv2.CAP_PROP_FRAME_COUNT)), 1), most)
    frames: list[Any] = []
    time, size, scale = [], (1, 1), 1.0
    while capture.grab():
        if len(frames) >= most or len(frames) * size[0] * size[1] > 2 * room:
            raise ValueError(f"more than {len(frames)} frames; cut out the trial")
        shown, picture = capture.retrieve()
        if not shown:
            continue
        rows, columns = picture.shape[:2]
        if not frames:
            if rows * columns > pixels:
                raise ValueError(f"frames of {columns} x {rows}; at most {pixels} pixels are allowed")
            scale = min(1.0, widest / max(rows, columns), (room / (count * rows * columns)) ** 0.5)
            size = max(1, round(scale * columns)), max(1, round(scale * rows))
        grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY) if picture.ndim == 3 else picture
        frames.append(cv2.resize(grey, size, interpolation=cv2.INTER_AREA))
        time.append(capture.get(cv2.CAP_PROP_POS_MSEC) / 1000.0)
    if len(frames) < NEEDED:
        raise ValueError(f"only {len(frames)} frames can be decoded, {NEEDED} are required; the file may be damaged")
    return {"scale": scale}, [np.array(frames), np.array(time)]
