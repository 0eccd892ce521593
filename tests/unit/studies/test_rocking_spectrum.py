"""Rocking spectra: block by block the same as single histories; sizes, units, refusals."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.studies import rocking_spectrum

ANGLES, PERIODS = [0.1, 0.2, 0.3], np.linspace(1.0, 9.0, 9)
PULSES = [rk.pulses.sine(3.0, 0.6), rk.pulses.cosine(2.0, 0.9)]


def record(seed):
    """A record of noise."""
    return rk.GroundMotion(2.0 * np.random.default_rng(seed).normal(size=300), 0.02, name=f"noise {seed}")


@pytest.mark.parametrize("motions", [PULSES, [record(1), record(2), record(3)]])
def test_a_spectrum_is_simulate_many_block_by_block(motions):
    """For pulses and records: the same bits as `simulate_many` of the blocks."""
    found = rocking_spectrum(motions, ANGLES, PERIODS, "ked", threads=1)
    sizes = 0.75 * 9.80665 * (0.5 * PERIODS / np.pi) ** 2
    blocks = [rk.Block.from_angle(alpha, size) for alpha in ANGLES for size in sizes]
    single = rk.simulate_many(blocks, motions, "ked", threads=1)
    for name in ("outcome", "peak_rotation", "impacts", "side", "status", "truncation"):
        expected = single[name].values[:, :, 0, 0].T.reshape(len(motions), 3, 9)
        np.testing.assert_array_equal(found[name].values, expected, strict=True)


def test_blocks_have_the_period_and_angle_of_the_axes():
    """2 pi / p and alpha of the blocks are the coordinates; the coefficient is that of each block."""
    found = rocking_spectrum(PULSES[0], ANGLES, PERIODS, "housner", gravity=3.7, threads=1)
    for period, size in zip(PERIODS, found["semi_diagonal"].values, strict=True):
        side = rk.Block.from_angle(0.2, float(size)).side("left", gravity=3.7)
        assert 2.0 * math.pi / side.frequency_parameter == pytest.approx(period, rel=1e-14, abs=0.0)
    expected = 1.0 - 1.5 * np.sin(ANGLES) ** 2
    np.testing.assert_allclose(found["coefficient"].values, np.tile(expected[:, None], 9), rtol=1e-13)


def test_relative_peaks():
    """The relative peak is the peak over alpha; weak pulses lift nothing; what overturned lies at a quarter turn."""
    found = rocking_spectrum(PULSES[0], ANGLES, PERIODS, 0.9, threads=1)
    expected = np.abs(found["peak_rotation"].values) / np.array(ANGLES)[:, None]
    np.testing.assert_allclose(found["peak_ratio"].values, expected, rtol=1e-14)
    lifted = 9.80665 * np.tan(ANGLES) < 3.0
    np.testing.assert_array_equal((found["mode"].values[0] == -2).all(axis=1), ~lifted)
    over = found["mode"].values >= 0
    assert over.any()
    np.testing.assert_array_equal(np.abs(found["peak_rotation"].values[over]), 0.5 * math.pi)


def test_the_linear_spectrum_forgets_the_slenderness():
    """Linear equations with a fixed coefficient: at equal a_p / (g alpha) theta / alpha does not depend on alpha."""
    ratios = [
        rocking_spectrum(rk.pulses.sine(1.5 * 9.80665 * a, 0.6), a, PERIODS, 0.9, linear=True, threads=1)["peak_ratio"]
        for a in (0.05, 0.1)
    ]
    standing = (ratios[0].values < 2.0) & (ratios[1].values < 2.0)
    assert standing.sum() > 5
    np.testing.assert_allclose(ratios[0].values[standing], ratios[1].values[standing], rtol=1e-9)


def test_scale_is_a_factor_on_the_motions():
    """A scale gives the spectrum of the scaled motion."""
    one = rocking_spectrum(PULSES[0], ANGLES, PERIODS, 0.9, scale=1.5, threads=1)
    other = rocking_spectrum(PULSES[0].scaled(1.5), ANGLES, PERIODS, 0.9, threads=1)
    np.testing.assert_allclose(one["peak_rotation"].values, other["peak_rotation"].values, rtol=1e-9)
    np.testing.assert_array_equal(one["mode"].values, other["mode"].values)


def test_what_a_spectrum_says_of_itself():
    """Dimensions, units, software, settings; progress adds up."""
    told = []
    found = rocking_spectrum([record(1), record(2)], ANGLES, PERIODS, "ked", progress=told.append, threads=1)
    assert dict(found.sizes) == {"motion": 2, "slenderness_angle": 3, "period": 9}
    assert sum(told) == 54
    assert found["motion"].values.tolist() == ["noise 1", "noise 2"]
    assert found["period"].attrs["units"] == "s"
    assert all("units" in found[name].attrs for name in found.data_vars)
    assert found.attrs["software"] == f"rocking {rk.__version__}"
    assert found.attrs["restitution"] == "ked"


def test_a_law_has_no_single_coefficient():
    """With a law of impact the coordinate is missing and the attribute names the law; with models it is the model's."""
    laws = {
        "of the speed: 0.7 to 0.9 times ked": rk.dynamics.SpeedRestitution([0.0, 1.0], [0.9, 0.7], times="ked"),
        "at random: 0.8 to 0.9 times 1": rk.dynamics.RandomRestitution([0.8, 0.9], 1),
    }
    for words, law in laws.items():
        found = rocking_spectrum(PULSES[0], ANGLES, PERIODS, law, threads=1)
        assert np.isnan(found["coefficient"].values).all()
        assert found.attrs["restitution"] == words
    sided = rocking_spectrum(PULSES[0], ANGLES, PERIODS, {"left": 0.8, "right": 0.9}, threads=1)
    assert sided.attrs["restitution"] == "left 0.8, right 0.9"
    housner = rocking_spectrum(PULSES[0], ANGLES, PERIODS, "housner", threads=1)
    expected = 1.0 - 1.5 * np.sin(np.asarray(ANGLES)) ** 2
    np.testing.assert_allclose(housner["coefficient"].values, expected[:, None] * np.ones(len(PERIODS)), rtol=1e-12)
