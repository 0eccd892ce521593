"""The impact laboratory: closed forms, convergence, what r depends on, files and doors."""

import math
import sys

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution.bed import fast
from rocking.studies import impact_laboratory
from rocking.studies.impact_laboratory import (
    SHAPES,
    Laboratory,
    bed_speed_law,
    coefficients,
    large_bodies,
    points_convergence,
    profile,
    step_convergence,
    study,
)
from rocking.tables import to_netcdf

pytestmark = pytest.mark.verifies(room="contact bed")

needs_engine = pytest.mark.skipif(not fast.available(), reason="the bed's fast engine was not built")

VISCOUS = {2.0: 0.7965354225163898, 4.0: 0.9408847304180785}  # REF, q = 1


@pytest.mark.verifies("closed form", "1 - 3/2 sin^2 alpha", within="1e-3", control="within")
@needs_engine
def test_two_points_over_slenderness():
    """On two points the study is Housner's 1 - 1.5 sin^2 alpha, within what 2 kHz is softer."""
    ratios = np.array([1.5, 2.0, 4.0, 8.0])
    two, three = (study("slenderness", ratios, Laboratory(points=n, frequency=2000.0)).coefficient for n in (2, 3))
    assert two.values == pytest.approx(1.0 - 1.5 / (1.0 + ratios**2), abs=1e-3)
    # negative control: three points are another impact
    assert (three.values - two.values)[:2].min() > 0.03


@pytest.mark.verifies(
    "computed anew", "a simulation of the bed without this package, two to three digits", within="0.01"
)
@needs_engine
def test_points_and_damping_of_another_simulation():
    """Coefficients of a simulation without this package at h/b = 2, to its .007, by points and damping."""
    found = study("points", [2, 3, 5, 11, 41])
    assert found.coefficient.values == pytest.approx([0.700, 0.766, 0.808, 0.840, 0.850], abs=0.01)
    by_damping = study("damping", [1.0, 3.0], Laboratory(points=5))
    assert by_damping.coefficient.values == pytest.approx(0.808, abs=0.01)
    assert np.abs(found.audit.values).max() < 1e-8
    assert found.landing_velocity.attrs["units"] == "rad/s"


@pytest.mark.verifies("invariant", "another size", within="1e-6", control="within")
@needs_engine
def test_size_alone_changes_nothing():
    """One shape on one layer: k ~ w, m ~ w^2, v^2 ~ g w, so that the hardness and r do not see the size."""
    found = study("width", [0.02, 0.2, 2.0])
    assert np.ptp(found.coefficient.values) < 1e-6
    assert np.ptp(found.hardness.values) < 1e-6 * found.hardness.values[0]
    # negative control: mass alone does change the hardness, by its square root
    heavier = study("density", [1000.0, 4000.0])
    assert heavier.hardness.values[0] / heavier.hardness.values[1] == pytest.approx(2.0, rel=1e-6)
    assert abs(float(heavier.coefficient[0] - heavier.coefficient[1])) > 1e-3


@needs_engine
def test_size_matters_with_unevenness_of_one_height():
    """A hollow of the same millimetres under a base ten times as wide moves r less: the scale comes from unevenness."""
    shift = []
    for width in (0.1, 1.0):
        lab = Laboratory(width=width, modulus_over_thickness=1e9, profile=profile("concave", 1e-4, 41))
        flat, uneven = coefficients([lab.but(profile=()), lab])
        shift.append(flat - uneven)
    assert shift[0] > 2.0 * shift[1] > 0.0


@needs_engine
def test_harder_or_faster_is_the_same():
    """r depends on the speed through the hardness only, as long as rotations are small: modulus against release."""
    slow = Laboratory(release=0.05, modulus_over_thickness=1e10)
    speed = study("release", [0.05, 0.1], slow)
    factor = float(speed.hardness[1] / speed.hardness[0]) ** 2
    stiff = study("modulus_over_thickness", [1e10 * factor], slow)
    assert float(stiff.coefficient[0]) == pytest.approx(float(speed.coefficient[1]), abs=5e-4)
    assert abs(float(speed.coefficient[0] - speed.coefficient[1])) > 2e-3


@needs_engine
def test_friction_has_a_threshold():
    """Above the friction that an impact needs r does not change; on too little it does."""
    found = study("friction", [0.1, 0.5, 1.0]).coefficient.values
    # hops may touch the limit for a moment: equal to what steps matter
    assert found[1] == pytest.approx(found[2], abs=1e-5)
    assert abs(found[0] - found[1]) > 0.1


@needs_engine
def test_hollow_bases_tend_to_housner_bulging_ones_to_no_loss():
    """Deep hollows leave the feet alone: r falls towards .7; bulges move the impulse to the middle: r rises."""
    hollow, bulging = (
        study("amplitude", [0.0, 1e-4, 1e-3], shape=shape).coefficient.values for shape in ("concave", "convex")
    )
    assert (np.diff(hollow) < 0.0).all()
    assert hollow[-1] > 0.7
    assert (np.diff(bulging) > 0.0).all()
    assert bulging[-1] < 1.0


@needs_engine
def test_random_bases_follow_their_seed():
    """The same seed is the same base, another one is another."""
    first, again = (study("seed", [1, 2], amplitude=1e-3).coefficient.values for _ in range(2))
    assert (first == again).all()
    assert first[0] != first[1]


@pytest.mark.verifies("order", "distributed impulse q = 1 in closed form", within="0.3 of the order", control="within")
@needs_engine
@pytest.mark.parametrize("ratio", [2.0, 4.0])
def test_order_in_points(ratio):
    """The viscous bed tends to distributed impulse q = 1 with order 2 in the spacing."""
    found = points_convergence(slenderness=ratio, limit=VISCOUS[ratio])
    assert found.error[-1] < 1e-4
    assert found.order[-1] == pytest.approx(2.0, abs=0.3)
    # negative control: towards a limit that is off by one in a thousand there is no order
    assert points_convergence(slenderness=ratio, limit=VISCOUS[ratio] + 1e-3).order[-1] < 0.5


@needs_engine
def test_steps_do_not_matter():
    """r is independent of the step to 1e-4 at every tolerance from 1e-6, and the error falls with it."""
    found = step_convergence((1e-4, 1e-6, 1e-8))
    assert (found.error[1:] < 1e-4).all()
    assert found.error[-1] < found.error[0]


def test_speed_law_in_a_history():
    """`simulate` takes r(speed); a faster impact meets a harder bed and loses more than a slow one."""
    block = rk.Block(width=0.2, height=0.4)
    law = bed_speed_law(block, 400.0)
    assert law.factor(0.6, 0, 0) > law.factor(2.0, 0, 0)
    assert len(rk.free_rocking(block, 0.5 * math.atan(0.5), restitution=law, duration=2.0).impacts) > 1


@needs_engine
def test_large_bodies_lose_the_hollow_and_not_the_difference_to_ked():
    """With size the hollow bed tends to the flat one, which does not see the size; KED is the limit of neither."""
    found = large_bodies([0.1, 1.0, 100.0])
    away = found["flat"] - found["hollow"]
    assert (np.diff(away) < 0.0).all()
    assert away[-1] < 1e-3
    assert np.ptp(found["flat"]) < 1e-5
    assert abs(found["flat"][-1] - found["ked"][-1]) > 1e-3
    # negative control: without a hollow nothing changes with size
    assert np.ptp(large_bodies([0.1, 1.0], hollow=0.0)["hollow"]) < 1e-5


@pytest.mark.parametrize("shape", SHAPES)
def test_profiles(shape):
    """Heights lie between zero and the amplitude; numbers of any kind count, and another seed is another base."""
    heights = profile(shape, 1e-3, 11, seed=3)
    assert len(heights) == 11
    assert 0.0 <= min(heights) <= max(heights) <= 1e-3
    assert profile(shape, 1e-3, np.int64(11), seed=3.0) == heights
    assert (profile(shape, 1e-3, 11, seed=4) == heights) is (shape != "random")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: profile("random", 1e-3, 5, seed=-1), "seed must be a whole number of at least 0, got -1"),
        (lambda: profile("random", 1e-3, 5, seed=0.5), "seed must be a whole number of at least 0, got 0.5"),
        (lambda: profile("random", 1e-3, 5, seed="a"), "seed must be a number"),
        (lambda: profile("random", 1e-3, 5, seed=math.nan), "seed must be finite"),
        (lambda: profile("convex", 1e-3, 2.5), "points must be a whole number of at least 2, got 2.5"),
        (lambda: profile("convex", 1e-3, 1), "points must be a whole number of at least 2, got 1"),
        (lambda: profile("convex", -1e-3, 5), "amplitude must be in"),
        (lambda: profile("wavy", 1e-3, 5), "shape must be one of convex, concave, tilted, random"),
        (lambda: study("colour", [1.0]), "varied must be one of slenderness, points"),
        (lambda: study("damping", [np.nan]), "damping must be a row of finite numbers"),
        (lambda: study("points", [2.7, 3]), "points must be a whole number of at least 2, got 2.7"),
        (lambda: study("points", [1, 3]), "points must be a whole number of at least 2, got 1"),
        (lambda: study("seed", [0, 1.5], amplitude=1e-3), "seed must be a whole number of at least 0, got 1.5"),
        (lambda: study("seed", [-1], amplitude=1e-3), "seed must be a whole number of at least 0, got -1"),
        (lambda: study("amplitude", [1e-3], shape="random", seed=-1), "seed must be a whole number"),
        (lambda: study("amplitude", [0.0]), "the study of amplitude needs shape"),
        (lambda: study("amplitude", [0.0], seed=1), "the study of amplitude needs shape"),
        (lambda: study("amplitude", [0.0], shape="convex", hue=1), "amplitude has the options shape, seed, got hue"),
        (lambda: study("seed", [1]), "the study of seed needs amplitude"),
        (lambda: study("slenderness", [2.0], shape="convex"), "the study of slenderness has no options, got shape"),
        (lambda: points_convergence((11, 20, 41)), "double the number of intervals"),
        (lambda: Laboratory(profile=(0.0,)), "profile must have 41 heights"),
    ],
)
def test_refusals(make, words):
    """What is no seed, count, amplitude, shape or row is refused with its range, before an impact is computed."""
    with pytest.raises(InvalidValueError, match=words):
        make()


def test_xarray_is_asked_for_first(monkeypatch):
    """Without xarray the refusal comes before an impact is computed."""
    monkeypatch.setitem(sys.modules, "xarray", None)
    monkeypatch.setattr(impact_laboratory, "bed_impacts", lambda *_, **__: pytest.fail("impacts were computed"))
    with pytest.raises(MissingExtraError, match="the impact laboratory needs xarray"):
        study("slenderness", [2.0])


@needs_engine
def test_points_are_what_the_coordinate_says():
    """Points given as floats: each result is that of a laboratory with so many points."""
    found, alone = (study("points", row, Laboratory(slenderness=4.0)) for row in ([2.0, 3.0], [3]))
    assert found.points.values.tolist() == [2.0, 3.0]
    assert found.coefficient.values[1] == alone.coefficient.values[0] != found.coefficient.values[0]


@pytest.mark.slow
@needs_engine
def test_files_hold_the_same_numbers(tmp_path):
    """netCDF read back gives the bits of the dataset, with units and the laboratory in attributes."""
    found = study("amplitude", [0.0, 1e-4], Laboratory(points=5), shape="concave")
    with xr.open_dataset(to_netcdf(found, tmp_path / "study.nc"), engine="h5netcdf") as back:
        assert back.identical(found)
        assert back.attrs["software"].startswith("rocking ")
        assert "points=5" in back.attrs["laboratory"]
        assert all(back[name].attrs["units"] for name in back.variables)
