"""Coverage of the intervals of `identify` for synthetic compressed videos of rocking bodies.

`python -m benchmarks.identification_video` makes 200 videos (some minutes), stores the results in
build/identification_video.jsonl, resumes an earlier run, and prints the coverage. It needs OpenCV.
"""

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.special import ndtri

import rocking as rk
from benchmarks.predictions import resumed
from rocking.dynamics import RandomRestitution
from rocking.identification import identify, read_measurement

ROOT = Path(__file__).parents[1]
COLUMNS, ROWS = 160, 120
"""Of a frame."""

SIZE_ERROR, HALF_ERROR, OPEN = 0.01, 0.02, 0.5
"""Relative error of a length; half the difference of ln r between the sides; share of a frame's time that it sees."""

Picture = NDArray[np.float64]
Edit = Callable[[Picture, float], Picture]


def rocked(number: int) -> dict[str, Any]:
    """Return an assumed body, and the free rocking of the true one."""
    random = np.random.default_rng([18, 7, number])
    alpha, centre = random.uniform(0.16, 0.28), random.uniform(0.48, 0.52)
    width, height = 0.8 * math.tan(alpha), 0.8
    body = rk.Block(width=width, height=height, centre=(width * centre, 0.5 * height * random.uniform(0.95, 1.05)))
    factor = math.exp(SIZE_ERROR * random.normal())
    x, y = body.centre
    real = rk.Block(width=factor * width, height=height, centre=(factor * x, y))
    truth: dict[str, Any] = {"r": random.uniform(0.86, 0.93), "half": HALF_ERROR * random.normal()}
    draws = random.uniform(0.005, 0.02) * ndtri((np.arange(257) + 0.5) / 257)
    by_side = {
        foot: np.exp(math.log(truth["r"]) + s * truth["half"] + draws) for foot, s in (("right", 1), ("left", -1))
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        response = rk.free_rocking(
            real, rotation=random.uniform(0.4, 0.6) * real.side("right").slenderness_angle,
            restitution=RandomRestitution(by_side, int(random.integers(1 << 30))),
        )  # fmt: skip
    look = {"noise": random.uniform(1.0, 5.0), "blur": random.uniform(0.5, 1.2), "textured": bool(random.integers(2))}
    return truth | look | {"body": body, "real": real, "response": response}


def drawn(case: dict[str, Any], rotation: float, texture: Picture | None) -> Picture:
    """Draw the body over a floor, before a wall, edges smooth over a pixel; texture: of the body and of the wall."""
    width, height = case["real"].width, case["real"].height
    scale = 0.75 * ROWS / height
    row, column = np.mgrid[:ROWS, :COLUMNS].astype(float)
    x, y = (column - 0.5 * COLUMNS) / scale, (ROWS - 12.0 - row) / scale
    foot = math.copysign(0.5 * width, rotation)
    c, s = math.cos(rotation), math.sin(rotation)
    across, up = foot + c * (x - foot) - s * y, s * (x - foot) + c * y
    within = np.minimum.reduce([across + 0.5 * width, 0.5 * width - across, up, height - up]) * scale
    wall, face = np.where(y < 0.0, 130.0, 190.0), np.full(x.shape, 60.0)
    if texture is not None:
        face += map_coordinates(texture, [200.0 + scale * up, 200.0 + scale * across], order=1, mode="wrap")
        wall += 0.3 * texture[:ROWS, :COLUMNS]
    cover = np.clip(within + 0.5, 0.0, 1.0)
    return np.asarray(wall * (1.0 - cover) + face * cover)


def filmed(path: Path, case: dict[str, Any], number: int, rate: float, lasts: float, edit: Edit | None = None) -> None:
    """Write a video with motion blur, blur, noise, and the losses of OpenCV's MPEG-4; edit: changes frames at times."""
    import cv2

    random = np.random.default_rng([number, 1])
    response, end = case["response"], float(case["response"].time[-1])
    texture = 25.0 * gaussian_filter(random.normal(size=(400, 400)), 2.0) * 7.0 if case["textured"] else None
    video = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), rate, (COLUMNS, ROWS), True)
    for n in range(int(lasts * rate)):
        rotations = [
            float(response.at(min(max((n + OPEN * fraction) / rate, 0.0), end))) for fraction in (-0.33, 0.0, 0.33)
        ]
        frame = gaussian_filter(
            np.mean([drawn(case, rotation, texture) for rotation in rotations], axis=0), case["blur"]
        )
        frame = frame if edit is None else edit(frame, n / rate)
        grey = np.clip(frame + case["noise"] * random.normal(size=frame.shape), 0.0, 255.0).astype(np.uint8)
        video.write(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR))
    video.release()


def identified(number: int, rate: float | None = None, lasts: float = 5.0) -> dict[str, Any]:
    """Return whether the interval of one holds the truth."""
    case = rocked(number)
    rate = (30.0, 60.0, 120.0, 240.0)[number % 4] if rate is None else rate
    with TemporaryDirectory() as folder:
        filmed(Path(folder) / "trial.mp4", case, number, rate, lasts)
        series = read_measurement(Path(folder) / "trial.mp4")
    result = identify(series, case["body"], size_error=SIZE_ERROR, tilt=0.0, asymmetry=2.0 * HALF_ERROR)
    assert series.rotation is not None
    true = np.array([float(case["response"].at(min(t, case["response"].time[-1]))) for t in series.time])
    error = series.rotation - true
    row = {"rate": rate, "refused": list(result.refused), "error": float(error.std())}
    return row | {"mean": result.mean.low <= case["r"] <= result.mean.high, "width": result.mean.high - result.mean.low}


def main(cases: int = 200) -> None:
    """Print the coverage."""
    rows = list(
        resumed(ROOT / "build" / "identification_video.jsonl", cases, identified, __file__, ("identification",))
    )
    kept = [row for row in rows if not row["refused"]]
    print(f"| refused | {1.0 - len(kept) / len(rows):.4f} |")
    for rate in (30.0, 60.0, 120.0, 240.0):
        rows_at_rate = [row for row in kept if row["rate"] == rate]
        fraction, error, width = (
            float(np.mean([row[name] for row in rows_at_rate])) for name in ("mean", "error", "width")
        )
        print(
            f"| {rate:.0f} 1/s | {len(rows_at_rate)} | held {fraction:.3f} | error {1e3 * error:.3f} mrad | "
            f"width {width:.4f} |"
        )


if __name__ == "__main__":
    main()
