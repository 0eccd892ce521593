"""Where a body overturned, when, and after how many impacts: as numbers, in the response and in its files."""

import json
from pathlib import Path
from typing import Any

import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.export import provenance

BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
# a ground that goes to the left throws the body to the right: the half sine is far above what the block can bear
PUSH = rk.pulses.half_sine(30.0, 0.5)
FALLS = {1: -1.0, -1: 1.0}
"""Side to the factor on the pulse."""

ENGINES = [
    pytest.param("fast", marks=pytest.mark.skipif(not fast_engine.available(), reason="fast engine not built")),
    "reference",
]
STOOD = {
    "rocked": lambda: rk.free_rocking(BODY, 0.1, 0.9),
    "no uplift": lambda: rk.simulate(BODY, rk.pulses.sine(1.0, 0.5), "ked"),
    "stopped": lambda: rk.free_rocking(BODY, 0.1, 0.95, most_events=4, duration=3.0),
}


def fallen(side: int, engine: str = "auto") -> rk.Response:
    """Return a response that overturns to a side."""
    return rk.simulate(BODY, PUSH, "ked", scale=FALLS[side], engine=engine)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("side", FALLS)
def test_side_is_against_the_ground(side: int, engine: str) -> None:
    """A ground that starts to the left leaves the body behind on the right, and the other way round."""
    response = fallen(side, engine)
    assert response.outcome is rk.Outcome.OVERTURNED
    assert response.side == side
    assert isinstance(response.side, int)
    assert float(response.rotation[-1]) * side > 0.0


@pytest.mark.parametrize("kind", STOOD)
def test_no_side_without_a_fall(kind: str) -> None:
    """Negative control: what stays standing, rests or was stopped has the side 0, and no time of overturning."""
    response = STOOD[kind]()
    assert response.side == 0
    found = provenance(response)
    assert found["side"] == 0
    assert "overturning_time_s" not in found
    assert found["impacts"] == response.impacts.size


@pytest.mark.parametrize("side", FALLS)
def test_batches_say_the_same(side: int) -> None:
    """`simulate_many` has the same side under the same name."""
    pytest.importorskip("xarray")
    found = rk.simulate_many(BODY, PUSH, "ked", scale=FALLS[side])
    assert found["side"].item() == fallen(side).side


def holds(attributes: dict[str, Any], response: rk.Response) -> bool:
    """Whether a file holds side, time and impacts of a response that overturned."""
    told = attributes["side"], attributes["overturning_time_s"], attributes["impacts"]
    return bool(told == (response.side, response.overturning_time, response.impacts.size))


@pytest.mark.parametrize("side", FALLS)
def test_files_hold_the_numbers(side: int, tmp_path: Path) -> None:
    """Dataset, netCDF and MATLAB file have them to the last bit; those of the other side are told apart."""
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    pytest.importorskip("h5py")
    response, other = fallen(side), fallen(-side)
    mat = loadmat(response.to_mat(tmp_path / "out.mat"), simplify_cells=True)["rocking"]
    with xarray.open_dataset(response.to_netcdf(tmp_path / "out.nc"), engine="h5netcdf", decode_timedelta=False) as nc:
        for attributes in (response.to_xarray().attrs, nc.attrs, json.loads(mat["provenance"])):
            assert holds(attributes, response)
            assert not holds(attributes, other)
