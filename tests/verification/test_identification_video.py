"""Coefficients from videos that were drawn, blurred, noised and compressed: intervals hold the truth.

Here three bodies; `python -m benchmarks.identification_video` has 200, and goes on where it stopped.
"""

import numpy as np
import pytest
from benchmarks import identification_video

import rocking as rk
from rocking.identification import RotationSeries, identify

pytestmark = pytest.mark.slow

BODY = rk.Block(width=0.2, height=0.8, mass=30.0, centre=(0.104, 0.39))


@pytest.mark.verifies(
    "repeated sampling", "rockings made up, drawn, and compressed by OpenCV, of bodies that are not symmetric",
    room="evidence", control="test_another_clock_is_noticed",
)  # fmt: skip
def test_intervals_hold_the_truth():
    """Of three bodies, two at 60 frames/s and one at 240, one 95 % interval may miss; rotations err by 1 mrad."""
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    rows = [identification_video.identified(*case) for case in ((0, 60.0, 3.0), (1, 60.0, 3.0), (7, 240.0, 1.8))]
    assert not any(row["refused"] for row in rows)
    assert sum(row["mean"] for row in rows) >= 2
    assert max(row["error"] for row in rows) < 1e-3
    assert np.mean([row["width"] for row in rows]) < 0.04


@pytest.mark.verifies("negative control", room="evidence")
def test_another_clock_is_noticed():
    """A rotation whose clock is 5 % fast is doubted, one of twice or half the rate refused; the right one neither."""
    response = rk.free_rocking(BODY, rotation=0.5 * BODY.side("right").slenderness_angle, restitution=0.9)
    time = np.arange(0.0, 3.0, 1.0 / 60.0)
    rotation = response.at(time) + 3e-4 * np.random.default_rng(2).normal(size=time.size)

    def found(factor):
        return identify(RotationSeries(factor * time, rotation=rotation), BODY)

    assert not found(1.0).refused
    assert not found(1.0).doubts
    assert "that of a body of another size" in " ".join(found(1.05).doubts)
    assert found(2.0).refused
    assert found(0.5).refused
