"""Overturning maps and rocking spectra: the same as single histories, mirrored, stretched, refined."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.quantities import HISTORY
from rocking.studies import overturning_map, refined_map, rocking_spectrum
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane

BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(3.0, 0.7)
RATIOS = ("frequency_ratio", np.linspace(1.5, 6.0, 19)), ("amplitude_ratio", np.linspace(0.5, 8.0, 26))
SAME = ("outcome", "peak_rotation", "impacts", "side", "status", "truncation", "overturning_time")


def noise(samples=400):
    """A record of smooth noise."""
    rng = np.random.default_rng(4)
    return rk.GroundMotion(np.convolve(rng.normal(size=samples), np.ones(8) / 2.0, "same"), 0.02)


def test_a_map_is_simulate_many_cell_by_cell():
    """Scale against size, with the restitution evaluated for each body: the same bits as `simulate_many`."""
    scales, sizes = np.linspace(0.5, 4.0, 23), np.linspace(0.3, 3.0, 17)
    found = overturning_map(BLOCK, noise(), ("scale", scales), ("semi_diagonal", sizes), "ked", threads=1)
    bodies = [BLOCK.scaled(size=size / BLOCK.semi_diagonal) for size in sizes]
    single = rk.simulate_many(bodies, noise(), "ked", scale=scales, threads=1)
    for name in SAME:
        np.testing.assert_array_equal(found[name].values, single[name].values[:, 0, :, 0], strict=True)
    assert len(np.unique(found["mode"])) > 3


def test_slenderness_against_restitution_is_simulate_many():
    """Two axes of the body: the same bits as one call for each coefficient."""
    ratios, coefficients = np.linspace(2.0, 9.0, 8), [0.5, 0.8, 0.95]
    found = overturning_map(
        BLOCK, PULSE, ("slenderness_ratio", ratios), ("restitution", coefficients), threads=1, restitution="ked"
    )
    angles = np.arctan(1.0 / ratios)
    bodies = [rk.Block.from_angle(angle, BLOCK.semi_diagonal) for angle in angles]
    single = rk.simulate_many(bodies, PULSE, coefficients, threads=1)
    for name in SAME:
        np.testing.assert_array_equal(found[name].values, single[name].values[:, 0, 0, :].T, strict=True)


def test_a_stretched_motion_is_the_motion_with_another_period():
    """Period against scale, from one pulse: rotations and times agree with pulses of their own to 1e-12."""
    periods, scales = [0.3, 0.7, 1.9], [0.6, 1.0, 2.5]
    found = overturning_map(BLOCK, PULSE, ("period", periods), ("scale", scales), 0.9, threads=1)
    pulses = [rk.pulses.sine(3.0, period) for period in periods]
    single = rk.simulate_many(BLOCK, pulses, 0.9, scale=scales, threads=1)
    for name in ("outcome", "impacts", "side"):
        np.testing.assert_array_equal(found[name].values, single[name].values[0, :, :, 0].T)
    for name in ("peak_rotation", "overturning_time"):
        np.testing.assert_allclose(found[name].values, single[name].values[0, :, :, 0].T, rtol=1e-12, atol=0.0)
    assert np.isfinite(found["overturning_time"]).any()


def test_a_stretched_record_is_the_record_with_another_step():
    """Duration against scale: the same as records of another time step; the wrong step is rejected."""
    record, factor = noise(), 1.7
    axes = ("duration", [record.duration * factor]), ("scale", [0.5, 0.8])
    found = overturning_map(BLOCK, record, *axes, 0.9, threads=1)["peak_rotation"].values[:, 0]
    for step, same in ((0.02 * factor, True), (0.02 * factor * 1.001, False)):
        other = rk.GroundMotion(record.acceleration, step)
        single = rk.simulate_many(BLOCK, other, 0.9, scale=[0.5, 0.8], threads=1)["peak_rotation"].values.ravel()
        assert np.allclose(found, single, rtol=1e-9, atol=0.0) == same


def test_mirrored_motion():
    """A symmetric block under the mirrored motion has the same map, with the sides exchanged."""
    one = overturning_map(BLOCK, PULSE, *RATIOS, 0.9, threads=1)
    other = overturning_map(BLOCK, PULSE.scaled(-1.0), *RATIOS, 0.9, threads=1)
    for name in ("mode", "peak_ratio", "impacts", "overturning_time"):
        np.testing.assert_array_equal(one[name].values, other[name].values)
    for name in ("peak_rotation", "side"):
        np.testing.assert_array_equal(one[name].values, -other[name].values)


def test_dimensionless_axes_forget_the_pulse():
    """Over omega_p / p and a_p / (g tan alpha) the pulse that was given does not matter, nor the size of the block."""
    one = overturning_map(BLOCK, PULSE, *RATIOS, 0.9, threads=1)
    other = overturning_map(BLOCK.scaled(size=7.0), rk.pulses.sine(0.01, 40.0), *RATIOS, 0.9, gravity=1.6, threads=1)
    np.testing.assert_array_equal(one["mode"].values, other["mode"].values)
    np.testing.assert_allclose(one["peak_ratio"].values, other["peak_ratio"].values, rtol=1e-9)


def test_threads_and_neighbours_change_nothing():
    """A cell is the same to the last bit whatever else is on the map and however many threads compute it."""
    whole = overturning_map(BLOCK, PULSE, *RATIOS, 0.9, threads=1)
    part = overturning_map(BLOCK, PULSE, (RATIOS[0][0], RATIOS[0][1][3:5]), (RATIOS[1][0], RATIOS[1][1][7:9]), 0.9)
    for name in SAME:
        np.testing.assert_array_equal(part[name].values, whole[name].values[7:9, 3:5])


def test_what_a_map_says_of_itself():
    """Units and meanings of variables and coordinates; software, settings, motion and restitution in the attributes."""
    found = overturning_map(BLOCK, PULSE, ("pga", [1.0, 2.0]), ("pgv", [0.1, 0.2, 0.3]), "housner", linear=True)
    assert found["mode"].dims == ("pgv", "pga")
    assert set(found.data_vars) == set(HISTORY)
    assert all({"units", "long_name"} <= set(found[name].attrs) for name in found.variables)
    assert found["pgv"].attrs["units"] == "m/s"
    assert found.attrs["software"] == f"rocking {rk.__version__}"
    assert found.attrs["setting_linear"] == 1
    assert "sine pulse" in found.attrs["motion"]
    assert found.attrs["restitution"] == "housner"


def test_modes_and_relative_peaks():
    """Below g tan alpha nothing lifts; the relative peak is over the angle, and a quarter turn where it overturned."""
    found = overturning_map(BLOCK, PULSE, *RATIOS, 0.9, threads=1)
    weak = found.sel(amplitude_ratio=slice(0.0, 0.99))
    assert (weak["mode"] == -2).all()
    assert (weak["peak_ratio"] == 0.0).all()
    over = found["mode"].values >= 0
    np.testing.assert_array_equal(over, found["outcome"].values == 2)
    np.testing.assert_array_equal(found["mode"].values[over], found["impacts"].values[over])
    assert found["peak_ratio"].values[over] == pytest.approx(0.5 * math.pi / BLOCK.slenderness_angle)


def test_an_asymmetric_body_divides_by_the_side_it_stands_on():
    """The relative peak of a body with two slendernesses uses that of the side of the peak."""
    body = BLOCK.with_feet(0.0, 0.4)
    found = overturning_map(body, PULSE, ("scale", [0.7, 0.8]), ("semi_diagonal", [1.0, 2.0]), 0.7, threads=1)
    angles = {sign: body.side(foot).slenderness_angle for sign, foot in ((1.0, "right"), (-1.0, "left"))}
    peaks = found["peak_rotation"].values
    expected = np.abs(peaks) / np.vectorize(angles.get)(np.sign(peaks))
    np.testing.assert_allclose(found["peak_ratio"].values, expected.astype(float), rtol=1e-14)


def test_a_bad_cell_touches_no_other():
    """A cell without a block is failed and says so; the others are as if it were not there."""
    found = overturning_map(BLOCK, PULSE, ("width", [0.4, 5.0]), ("semi_diagonal", [1.0, 3.0]), 0.9, threads=1)
    assert found["mode"].values[0, 1] == -3
    assert found["status"].values[0, 1] != 0
    assert np.isnan(found["peak_ratio"].values[0, 1])
    alone = overturning_map(BLOCK, PULSE, ("width", [0.4]), ("semi_diagonal", [1.0, 3.0]), 0.9, threads=1)
    np.testing.assert_array_equal(found["peak_rotation"].values[:, :1], alone["peak_rotation"].values)


def test_refinement_keeps_the_base_and_finds_what_a_fine_map_has():
    """Points of the map stay to the last bit; new ones are those of the map of that spacing, and fewer."""
    x, y = ("frequency_ratio", np.linspace(1.5, 6.0, 10)), ("amplitude_ratio", np.linspace(0.5, 8.0, 11))
    base = overturning_map(BLOCK, PULSE, x, y, 0.9, threads=1)
    finer = overturning_map(BLOCK, PULSE, x, y, 0.9, threads=1, refine=2)
    for name in HISTORY:
        np.testing.assert_array_equal(base[name].values, finer[name].values)
    np.testing.assert_array_equal(finer["refined_mode"].values[: base["mode"].size], base["mode"].values.ravel())
    fine = overturning_map(
        BLOCK, PULSE, (x[0], np.linspace(1.5, 6.0, 37)), (y[0], np.linspace(0.5, 8.0, 41)), 0.9, threads=1
    )
    table = fine["mode"].sel(
        frequency_ratio=finer["refined_x"], amplitude_ratio=finer["refined_y"], method="nearest", tolerance=1e-9
    )
    np.testing.assert_array_equal(table.values, finer["refined_mode"].values)
    assert base["mode"].size < finer.sizes["point"] < 0.7 * fine["mode"].size


def test_refined_map_is_the_same():
    """`refined_map` gives the points of ``refine=`` with their relative peaks, the base first."""
    x, y = ("frequency_ratio", np.linspace(2.0, 4.0, 4)), ("amplitude_ratio", np.linspace(1.0, 5.0, 5))
    one = refined_map(BLOCK, PULSE, x, y, 0.9, levels=2, threads=1)
    other = overturning_map(BLOCK, PULSE, x, y, 0.9, refine=2, threads=1)
    np.testing.assert_array_equal(one.modes, other["refined_mode"].values)
    np.testing.assert_array_equal(one.peak_ratio, other["refined_peak_ratio"].values)
    assert one.base.sum() == 20
    assert one.base[:20].all()


@pytest.mark.slow
def test_the_reference_engine_draws_the_same_map():
    """The other engine gives the same modes, and rotations to 1e-10, and says that it ran."""
    x, y = ("frequency_ratio", [2.0, 3.0, 5.0]), ("amplitude_ratio", [0.9, 1.5, 2.2, 3.0])
    fast = overturning_map(BLOCK, PULSE, x, y, 0.9, threads=1)
    slow = overturning_map(BLOCK, PULSE, x, y, 0.9, engine="reference")
    np.testing.assert_array_equal(fast["mode"].values, slow["mode"].values)
    np.testing.assert_allclose(fast["peak_rotation"].values, slow["peak_rotation"].values, rtol=1e-10)
    assert (fast.attrs["engine"][:4], slow.attrs["engine"]) == ("fast", "reference")


def test_progress_counts_every_history():
    """Progress adds up to the number of histories, refinement included."""
    told = []
    x, y = ("frequency_ratio", np.linspace(2.0, 4.0, 4)), ("amplitude_ratio", np.linspace(1.0, 5.0, 5))
    found = overturning_map(BLOCK, PULSE, x, y, 0.9, refine=1, threads=1, progress=told.append)
    assert sum(told) == found.sizes["point"]


def test_lattice_points_of_the_axes_are_theirs():
    """Whatever the level, the axes' own values are on the lattice to the last bit."""
    x = np.array([0.1, 0.3, 0.7, 1.9])
    plane = Plane.of(BLOCK, PULSE, ("scale", x), ("semi_diagonal", [0.3, 0.9]), 0.9, gravity=9.81)
    lattice = AdaptiveGrid(plane, 3)
    found, _ = lattice.coordinates(np.arange(0, lattice.columns, 8), np.zeros(4, dtype=np.int64))
    assert found.tolist() == x.tolist()


def test_random_restitution():
    """Random coefficients: every cell draws its own, as in `simulate_many`; refinement is refused."""
    law = rk.dynamics.RandomRestitution.normal(0.9, 0.03, seed=3)
    scales = np.linspace(0.5, 1.0, 30)
    found = overturning_map(BLOCK, noise(), ("scale", scales), ("semi_diagonal", [1.5]), law, threads=1)
    body = BLOCK.scaled(size=1.5 / BLOCK.semi_diagonal)
    single = rk.simulate_many(body, noise(), law, scale=scales, threads=1)
    np.testing.assert_array_equal(found["peak_rotation"].values.ravel(), single["peak_rotation"].values.ravel())
    with pytest.raises(InvalidValueError, match="random"):
        overturning_map(BLOCK, noise(), ("scale", scales), ("semi_diagonal", [1.5]), law, refine=1)


ANGLES, PERIODS = [0.1, 0.2, 0.3], np.linspace(1.0, 9.0, 9)
PULSES = [rk.pulses.sine(3.0, 0.6), rk.pulses.cosine(2.0, 0.9)]


def record(seed):
    """A record of noise."""
    return rk.GroundMotion(2.0 * np.random.default_rng(seed).normal(size=300), 0.02, name=f"noise {seed}")


@pytest.mark.slow
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
