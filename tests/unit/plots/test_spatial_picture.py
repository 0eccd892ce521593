"""The picture of a response in space shows its numbers."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import SpatialStart
from rocking.dynamics.space import SpatialBody
from rocking.plots.spatial import spatial_picture
from rocking.plots.style import write


@pytest.fixture(scope="module")
def wobble():
    """A square box let go from a lean off its axes."""
    return rk.free_rocking(
        SpatialBody.box(1.0, 1.0, 4.0), restitution="housner", start=SpatialStart(0.1, 0.4), duration=3.0
    )


def test_the_curves_are_the_response(wobble):
    """Path of the top, tilt in degrees, impacts at their times; the bar of contact covers the time without gaps."""
    plan, tilt, _, contact = spatial_picture(wobble).axes
    np.testing.assert_array_equal(np.column_stack(plan.lines[0].get_data()), wobble.top[:, :2])
    np.testing.assert_allclose(tilt.lines[0].get_ydata(), np.degrees(wobble.tilt))
    np.testing.assert_array_equal(tilt.lines[1].get_xdata(), wobble.impacts["time"])
    bars = sorted((bar.get_x(), bar.get_width()) for bar in contact.patches)
    assert bars[0][0] == 0.0
    assert sum(width for _, width in bars) == pytest.approx(wobble.time[-1])


def test_pictures_of_all_kinds_are_written_the_same_every_time(wobble, tmp_path):
    """A wobble, an overturning and a rolling cylinder; the same bytes twice."""
    pulse = rk.pulses.half_sine(amplitude=9.0, period=1.2)
    cylinder = SpatialBody.cylinder(0.5, 2.0)
    runs = [
        wobble,
        rk.simulate(SpatialBody.box(1.0, 1.0, 4.0), pulse, "housner"),
        rk.free_rocking(
            cylinder, restitution="housner", start=SpatialStart(0.1, angular_velocity=(0.3, 0.0, 0.1)), duration=2.0
        ),
    ]
    for number, run in enumerate(runs):
        first, second = (write(spatial_picture(run), tmp_path / f"{number}-{k}.png").read_bytes() for k in range(2))
        assert first == second
    assert math.isfinite(runs[1].overturning_direction)
