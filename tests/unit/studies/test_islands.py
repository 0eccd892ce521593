"""Safe islands of maps drawn by hand, and of the full sine."""

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.studies._overturning_map import overturning_map
from rocking.studies.islands import safe_beyond_overturning, safe_islands


def drawn(*rows):
    """A map from characters, the top row last: . not lifted, s survived, # overturned, x failed."""
    codes = {".": -2, "s": -1, "#": 0, "1": 1, "x": -3}
    modes = np.array([[codes[c] for c in row] for row in reversed(rows)])
    y, x = (np.arange(n, dtype=float) for n in modes.shape)
    return xr.Dataset({"mode": (("y", "x"), modes)}, coords={"x": 10.0 * x, "y": y})


def test_an_enclosed_island():
    """A hole in overturning is found with its extent and area; the region that is never lifted is none."""
    found = safe_islands(drawn("######", "#ss###", "#s####", "ss####", "......"))
    assert len(found) == 0  # it is joined to the region below
    found = safe_islands(drawn("######", "#ss###", "#s####", "######", "......"))
    assert len(found) == 1
    assert (found[0].cells, found[0].area, found[0].enclosed) == (3, 30.0, True)
    assert (found[0].x, found[0].y) == ((10.0, 20.0), (2.0, 3.0))
    assert found.labels.sum() == 3
    assert found.labels[2].tolist() == [0, 1, 0, 0, 0, 0]


def test_islands_that_reach_the_edge_or_a_failed_point():
    """What reaches the edge of the map, or touches a failed point, may go on there: it is not called enclosed."""
    edge = drawn("##s###", "##s###", "######", "......")
    failed = drawn("######", "#sx###", "######", "......")
    for given in (edge, failed):
        assert len(safe_islands(given)) == 0
        (island,) = safe_islands(given, enclosed=False).islands
        assert not island.enclosed


def test_the_largest_comes_first_and_diagonals_hold():
    """Islands are numbered by area; an oblique strip is one island."""
    found = safe_islands(drawn("#######", "#s##ss#", "###s###", "##s####", "#######", "......."))
    assert [island.cells for island in found.islands] == [4, 1]
    assert found.labels.max() == 2
    assert (found.labels == 1).sum() == 4


def test_between_two_ways_of_overturning_nothing_is_enclosed():
    """Pieces of a strip between two modes are none; a hole in either mode is one, also beside the other mode."""
    strip = drawn("#######", "#s##s##", "11s111s", "1111111", ".......")
    assert len(safe_islands(strip)) == 0
    assert len(safe_islands(strip, enclosed=False)) == 3
    holes = drawn("#######", "#s#####", "#######", "1111111", "1111s11", "1111111", ".......")
    assert [island.cells for island in safe_islands(holes).islands] == [1, 1]
    touching = drawn("#######", "#s#####", "1111111", "1111111", ".......")
    assert len(safe_islands(touching)) == 0


@pytest.mark.parametrize("points", [100, 200])
def test_a_grid_does_not_cut_islands_out_of_a_strip(points):
    """The gap between modes I and II of the full sine is one strip: no grid makes enclosed islands of it."""
    block, pulse = rk.Block.from_angle(0.15, 1.0), rk.pulses.sine(1.0, 0.5)
    axes = ("frequency_ratio", np.linspace(1.0, 9.0, points)), ("amplitude_ratio", np.linspace(0.5, 12.0, points))
    found = overturning_map(block, pulse, *axes, 0.9, linear=True, threads=1)
    assert len(safe_islands(found)) == 0
    # negative control: the grid does cut it into pieces that overturning surrounds
    pieces = safe_islands(found, enclosed=False).islands
    assert sum(piece.x[0] > 1.0 and piece.x[1] < 9.0 and piece.y[1] < 12.0 for piece in pieces) >= 2


def test_safe_beyond_overturning():
    """True where something below, or to the left, overturned; the failed are not called safe."""
    given = drawn("s#s", "###", "#sx", "s.#", "...")
    upwards = safe_beyond_overturning(given)
    assert upwards.values[::-1].tolist() == [[1, 0, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]
    rightwards = safe_beyond_overturning(given, along="x")
    assert rightwards.values[::-1].tolist() == [[0, 0, 1], [0, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, 0]]
    assert upwards.name == "safe_beyond_overturning"


def test_the_full_sine_has_one_between_its_modes():
    """Over few frequencies the gap between modes I and II is an island that reaches the edge; with r = 1 it is gone."""
    block, pulse = rk.Block.from_angle(0.15, 1.0), rk.pulses.sine(1.0, 0.5)
    axes = ("frequency_ratio", np.linspace(3.0, 6.0, 31)), ("amplitude_ratio", np.linspace(0.5, 10.0, 191))
    found = safe_islands(overturning_map(block, pulse, *axes, 0.9, linear=True, threads=1), enclosed=False)
    assert len(found) == 1
    assert found[0].x == (3.0, 6.0)
    elastic = overturning_map(block, pulse, *axes, 1.0, linear=True, threads=1)
    assert len(safe_islands(elastic, enclosed=False)) == 0


@pytest.mark.parametrize("bad", [None, 3, xr.Dataset(), xr.Dataset({"mode": ("x", [1, 2])})])
def test_what_is_no_map_is_refused(bad):
    """Only a dataset with a mode over two axes is a map."""
    with pytest.raises(InvalidValueError, match="a map is"):
        safe_islands(bad)


def test_unknown_axes_are_refused():
    """Only an axis of the map can be gone along."""
    with pytest.raises(InvalidValueError, match="along"):
        safe_beyond_overturning(drawn("##", ".."), along="z")
