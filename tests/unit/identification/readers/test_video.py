"""Videos: what cannot be followed is refused or told, and no damage ends the process."""

import contextlib
import random
import struct

import numpy as np
import pytest
from benchmarks import identification_video

from rocking.errors import InvalidValueError, MeasurementError, MissingExtraError
from rocking.identification import RotationSeries, identify, read_measurement

cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed")

CASE = identification_video.rocked(1)
RATE, LASTS = 30.0, 3.0


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    """A body that rocks for three seconds."""
    return made(tmp_path_factory.mktemp("videos") / "trial.mp4")


def made(path, edit=None):
    identification_video.filmed(path, CASE, 1, RATE, LASTS, edit)
    return path


def error_of(series):
    """The standard deviation of what was seen about the truth, past which the time may be shifted [rad]."""
    return float((series.rotation - np.array([CASE["response"].at(t) for t in series.time])).std())


def moved(frame, right, turn):
    turned = cv2.getRotationMatrix2D((80, 60), np.degrees(turn), 1.0)
    turned[0, 2] += right
    return cv2.warpAffine(frame, turned, (160, 120), borderMode=cv2.BORDER_REPLICATE)


def with_frame_times(content, steps):
    """The same MP4 with other durations of its frames, in the units of its clock: a new box `stts`."""
    boxes, start, end = [], 0, len(content)
    for name in (b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stts"):
        at = start
        while content[at + 4 : at + 8] != name:
            at += struct.unpack(">I", content[at : at + 4])[0]
            assert at < end
        boxes.append(at)
        start, end = at + 8, at + struct.unpack(">I", content[at : at + 4])[0]
    table = struct.pack(">II", 0, len(steps)) + b"".join(struct.pack(">II", 1, step) for step in steps)
    new = bytearray(content[: boxes[-1]] + struct.pack(">I", len(table) + 8) + b"stts" + table + content[end:])
    for at in boxes[:-1]:
        size = struct.unpack(">I", content[at : at + 4])[0] + len(new) - len(content)
        new[at : at + 4] = struct.pack(">I", size)
    return bytes(new)


@pytest.mark.slow
def test_a_video_tells_the_rotation(trial):
    """Within a milliradian, a 45th of a pixel at the top of the body, with the perspective told."""
    series = read_measurement(trial)
    assert series.time.size == RATE * LASTS
    assert error_of(series) < 1e-3
    assert "10 degrees off the normal" in series.doubts[-1]


def test_a_region_may_be_stated(trial):
    """The body alone, without what stands behind it."""
    assert error_of(read_measurement(trial, kind="video", region=[70, 30, 20, 65])) < 2e-3


def test_frames_may_come_unevenly(trial, tmp_path):
    """Time stamps are those of the container, and uneven ones are told."""
    whole = trial.read_bytes()
    even = read_measurement(trial).time
    unit = 512  # of 15360 a second, as the writer counts
    steps = [unit + (unit // 4 if n % 3 == 0 else -unit // 8) for n in range(even.size)]
    path = tmp_path / "uneven.mp4"
    path.write_bytes(with_frame_times(whole, steps))
    series = read_measurement(path)
    expected = np.concatenate([[0.0], np.cumsum(steps[:-1])]) / (unit * RATE)
    np.testing.assert_allclose(series.time - series.time[0], expected, atol=1e-3)  # the container counts so finely
    assert "time stamps scatter" in " ".join(series.doubts)


def test_a_frame_rate_may_be_stated(trial):
    """Slow motion, played at a fourth of its rate, is stretched back; a rate that is wrong by so much is refused."""
    series = read_measurement(trial, frame_rate=4.0 * RATE)
    assert series.time[-1] == pytest.approx((RATE * LASTS - 1.0) / (4.0 * RATE))
    assert identify(series, CASE["body"]).refused
    assert not identify(read_measurement(trial), CASE["body"]).refused


@pytest.mark.slow
def test_a_camera_that_sways_is_told(tmp_path):
    """How it turns is taken away where a wall behind the body tells it."""
    path = made(tmp_path / "a.mp4", lambda f, t: moved(f, 1.5 * np.sin(9.0 * t), 0.01 * np.sin(7.0 * t)))
    series = read_measurement(path)
    assert "the camera moves by" in " ".join(series.doubts)
    assert error_of(series) < 0.5 * 0.01 / np.sqrt(2.0)


@pytest.mark.slow
def test_what_cannot_be_followed_is_refused_or_told(tmp_path):
    """A camera that shakes, a cut, a body that somebody takes away, and one that does not move."""
    other = np.random.default_rng(1).uniform(50.0, 200.0, (120, 160))
    shaken = made(tmp_path / "shaken.mp4", lambda f, t: moved(f, 9.0 * np.sin(40.0 * t), 0.05 * np.sin(31.0 * t)))
    for path in (shaken, made(tmp_path / "cut.mp4", lambda f, t: f if t > 1.0 else other)):
        with pytest.raises(MeasurementError, match="camera"):
            read_measurement(path)
    with pytest.raises(MeasurementError, match="nothing moves"):
        read_measurement(made(tmp_path / "still.mp4", lambda f, t: other))
    hidden = made(tmp_path / "hidden.mp4", lambda f, t: np.where((abs(np.arange(160) - 80) < 30) & (t < 0.5), 90.0, f))
    series = read_measurement(hidden, region=[70, 30, 20, 65])
    assert "the body is lost before" in " ".join(series.doubts)
    assert series.time[0] > 0.4


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"kind": "sound"}, MeasurementError, "save the sound of the video as WAV"),
        ({"column": "top"}, MeasurementError, "column can be used with tables only"),
        ({"region": [0, 0, 500, 50]}, InvalidValueError, "region must lie within 160 x 120 pixels"),
        ({"region": [1, 2]}, InvalidValueError, "region must be four numbers"),
        ({"region": [60, 30, float("nan"), 20]}, InvalidValueError, "region must be"),
        ({"frame_rate": 0.0}, InvalidValueError, "frame_rate must be"),
    ],
)
def test_what_a_video_does_not_take(trial, given, error, words):
    """By name, with what to give instead."""
    with pytest.raises(error, match=words):
        identify(read_measurement(trial, **given), CASE["body"])


def test_what_is_no_video(tmp_path):
    """Text, a table asked as one, and a file that is not there."""
    (tmp_path / "a.mp4").write_text("#EXTM3U\n/etc/hostname\n")
    (tmp_path / "a.csv").write_text("time [s],x [rad]\n0,1\n1,2\n2,3\n3,4\n")
    for name, given, words in (
        ("a.mp4", {}, "the first bytes are not those"), ("b.mp4", {}, "no such file"),
        ("a.csv", {"kind": "video"}, "not have the extension of a video"),
        ("a.csv", {"frame_rate": 60.0}, "region= and frame_rate= can be used with videos only"),
    ):  # fmt: skip
        with pytest.raises(MeasurementError, match=words):
            read_measurement(tmp_path / name, **given)


def test_damage_is_refused(trial, tmp_path):
    """Bytes changed, lost or added: a refusal, or a series of finite numbers, and nothing ends the process."""
    whole, draw = trial.read_bytes(), random.Random(4)
    path = tmp_path / "a.mp4"
    for _ in range(4):
        content = bytearray(whole)
        for _ in range(20):
            content[draw.randrange(len(content))] = draw.randrange(256)
        path.write_bytes(content[: draw.randrange(len(content) // 2, len(content))] if draw.random() < 0.5 else content)
        with contextlib.suppress(MeasurementError):
            assert isinstance(read_measurement(path), RotationSeries)


def test_limits(trial, monkeypatch):
    """More frames, or larger ones, are refused by their numbers."""
    from rocking.identification.readers import video

    for name, most, words in (("frames", 20, "more than 20 frames"), ("pixels", 100, "frames of 160 x 120")):
        with monkeypatch.context() as patched:
            patched.setitem(video.LIMITS, name, most)
            with pytest.raises(MeasurementError, match=words):
                read_measurement(trial)
    monkeypatch.setitem(video.LIMITS, "widest", 120)
    assert error_of(read_measurement(trial)) < 2e-3


def test_what_it_needs_is_named(trial, monkeypatch):
    """Without OpenCV, the extra that brings it."""
    from rocking.identification.readers import video
    from rocking.motions.formats.foreign import ForeignReader

    script = trial.with_name("script.py")
    script.write_text("import sys\nsys.modules['cv2'] = None\nimport cv2\n")
    monkeypatch.setattr(video, "_OPENCV", ForeignReader(script, "OpenCV", "cv2"))
    with pytest.raises(MissingExtraError, match=r"rocking\[video\]"):
        read_measurement(trial)
