"""A campaign of a map computes what `overturning_map` does, along every axis; initial conditions are axes too."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.studies import axes
from rocking.studies._overturning_map import map_arrays
from rocking.studies.adaptive_grid import Plane
from rocking.studies.map_rounds import MapHistories

pytestmark = pytest.mark.verifies(room="campaigns")

BLOCK, PULSE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
STATUE = rk.Section([rk.Region([(-0.35, 0.0), (0.25, 0.0), (0.3, 2.5), (-0.15, 2.2)], density=2400.0)])
BOX = rk.dynamics.SpatialBody.box(width=0.5, depth=0.8, height=2.0)
VALUES = {
    "azimuth": [0.0, 0.8, 1.5], "initial_rotation": [-0.15, 0.05, 0.1], "initial_angular_velocity": [-0.8, 0.3, 0.9],
    "slenderness_angle": [0.1, 0.2, 0.3], "slenderness_ratio": [3.0, 4.0, 6.0], "restitution": [0.5, 0.8, 0.95],
    "pgv": [0.2, 0.4, 0.9], "friction": [0.1, 0.3, 0.6], "pga": [1.5, 3.0, 5.0], "height": [1.0, 2.0, 3.0],
    "amplitude_ratio": [1.2, 1.8, 2.5],
}  # fmt: skip


@pytest.mark.parametrize("name", axes())
def test_a_campaign_varies_what_the_axis_says(name: str) -> None:
    """Peaks and times along each axis are those of the map, and differ from value to value."""
    body, motion = (BOX, {"x": PULSE}) if name == "azimuth" else (BLOCK, PULSE)
    other = ("scale", [0.9, 1.3]) if name not in {"scale", "pga", "amplitude_ratio", "pgv"} else ("width", [0.4, 0.5])
    subject = (body, motion, (name, VALUES.get(name, [0.5, 1.0, 1.6])), other, "housner")
    histories = MapHistories.of([Plane.of(*subject)])
    found = histories.rescaled(0, 6, histories.run(0, 6, threads=1))
    expected = map_arrays(*subject)
    for key in ("outcome", "peak_rotation", "overturning_time"):
        np.testing.assert_array_equal(found[key], expected[key].ravel(), err_msg=key)
    assert len(set(expected["peak_rotation"].ravel().tolist())) > 2, "a map of one value proves nothing"


def test_initial_conditions_are_axes() -> None:
    """A cell is `simulate` from that start; under a motion of twice the time, where rates of the body count, too."""
    x, y = ("initial_rotation", [-0.2, -0.05, 0.0, 0.12]), ("initial_angular_velocity", [-0.9, 0.0, 0.4])
    found = rk.overturning_map(STATUE, PULSE, x, y, 0.9)
    assert found["peak_rotation"].dims == ("initial_angular_velocity", "initial_rotation")
    for place in np.ndindex(3, 4):
        alone = rk.simulate(
            STATUE, PULSE, 0.9, rotation=x[1][place[1]], angular_velocity=y[1][place[0]], duration=PULSE.duration
        )
        assert int(found["outcome"].values[place]) == alone.outcome.code
        assert float(found["peak_rotation"].values[place]) == pytest.approx(alone.trajectory.peak_rotation, rel=1e-9)
    slow = rk.overturning_map(STATUE, PULSE, y, ("period", [0.6, 1.2]), 0.9)
    for k, rate in enumerate(y[1]):
        twice = rk.simulate(STATUE, rk.pulses.sine(3.0, 1.2), 0.9, angular_velocity=rate, duration=1.2)
        assert float(slow["peak_rotation"].values[1, k]) == pytest.approx(twice.trajectory.peak_rotation, rel=1e-9)
    assert not np.allclose(slow["peak_rotation"].values[0], slow["peak_rotation"].values[1]), "a negative control"


def test_initial_conditions_enter_the_name_of_a_campaign() -> None:
    """Other starts, another content; the same, the same."""
    keys = [
        MapHistories.of([Plane.of(STATUE, PULSE, ("initial_rotation", row), ("scale", [1.0, 2.0]), 0.9)]).key()
        for row in ([0.0, 0.1], [0.0, math.nextafter(0.1, 1.0)], [0.0, 0.1])
    ]
    assert keys[0] == keys[2] != keys[1]


def test_initial_conditions_of_bodies_in_space_are_refused() -> None:
    for name in ("initial_rotation", "initial_angular_velocity"):
        with pytest.raises(InvalidValueError, match=f"{name} varies only for a plane body"):
            rk.overturning_map(BOX, {"x": PULSE}, (name, [0.0, 0.1]), ("scale", [1.0]), "housner")
