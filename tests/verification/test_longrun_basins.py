"""Basins, overturning from rest, fractal boundaries and thresholds against independent programs and closed forms."""

import math

import numpy as np
import pytest
from long_run_systems import grid, response_by_reference, system_of

import rocking as rk
from rocking import Block, simulate
from rocking.motions.pulse import Sinusoids
from rocking.outcome import UNCOUNTED, Outcome
from rocking.studies.longrun.basins import (
    basin_stability,
    box_dimension,
    cells,
    checked_ends,
    ends_of,
    uncertainty_exponent,
)
from rocking.studies.longrun.study import Cells, LongRunHistories
from rocking.studies.longrun.system import HarmonicRocking
from rocking.studies.longrun.thresholds import slender_thresholds

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")

BASINS = {
    "slender": ((4, 0.9, 3, 0.9, True), (5173, 625, 4202)),
    "slender, above uplift": ((4, 2.0, 4, 0.85, True), (5187, 81, 4732)),
    "rectangle, Housner": ((4, 1.5, 3, "housner", False), (6334, 106, 3560)),
    "rectangle, KED": ((4, 1.5, 3, "ked", False), (7132, 92, 2776)),
}


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine in pure Python, cell for cell")
@pytest.mark.filterwarnings("ignore")
def test_pieces_of_a_basin_by_the_reference_engine():
    """All columns of pieces of a campaign; the final states of two models differ as those of the reference do."""
    systems = tuple(system_of(4, 1.5, 3.0, name) for name in ("housner", "ked"))
    grids, impacts, small = cells(6, 4, 2.0), 8, 0.15
    histories = LongRunHistories(systems=systems, task=Cells(np.array([1.5]), *grids, impacts, small))
    pieces = [histories.run(first, min(first + 7, 48)) for first in range(0, 48, 7)]
    columns = {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}

    def final_state(system, phase, speed):
        """Return 0, 1 or 2 for overturning, a small speed after an impact, and neither after all impacts."""
        response = response_by_reference(system, phase, speed, 1.0, 8.0 * system.excitation.period)
        after = np.abs(response.impacts["velocity_after"][:impacts]) / (system.alpha * system.p)
        if (after < small).any():
            return 1
        assert len(after) == impacts or response.outcome is Outcome.OVERTURNED
        return 2 if len(after) == impacts else 0

    states = [final_state(system, *start) for system in systems for start in np.transpose(grid(*grids))]
    assert columns["final_state"].tolist() == states
    assert set(states) == {0, 1, 2}
    assert columns["outcome"].tolist() == [2 if state == 0 else 1 for state in states]
    assert columns["mode"].tolist() == [UNCOUNTED if state == 0 else -1 for state in states]
    assert not columns["is_uncertain"].any()
    assert states[:24] != states[24:]  # negative control: the other model has other final states


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "two independent programs, cell for cell")
@pytest.mark.parametrize("case", BASINS)
def test_basins_cell_for_cell(case):
    """Counts of 10,000 cells over 120 impacts as by two programs; no cell changes with the step error."""
    (slenderness, amplitude, frequency, restitution, linear), counts = BASINS[case]
    system = system_of(slenderness, amplitude, frequency, restitution, linear=linear)
    kinds, others = checked_ends(system, *grid(*cells(100, 100, 2.0)))
    assert np.bincount(kinds, minlength=4).tolist() == [*counts, 0]
    assert np.array_equal(kinds, others)
    fraction, low, high = basin_stability(kinds)
    assert fraction == pytest.approx(1.0 - counts[0] / 1e4)
    assert low < fraction < high
    assert math.isnan(box_dimension(np.ones((64, 64))))
    # a smooth boundary has dimension 1; boxes of 2 cells and more on 100 x 100 cells estimate it within 3 %
    assert 0.97 < box_dimension(kinds.reshape(100, 100)) < 2.0


# amplitudes for which all relative changes of 1e-13 of the amplitude give this outcome
FIRST_OVERTURNING = {(2, "housner"): (1.18, 1.19), (2, "ked"): (1.11, 1.12), (4, "housner"): (1.04, 1.05)}


@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series", within="one amplitude")
@pytest.mark.parametrize("case", FIRST_OVERTURNING)
def test_amplitudes_and_phases_that_overturn_from_rest(case):
    """The smallest amplitude that overturns a body from rest at phase 0; other phases as by the engine of records."""
    slenderness, model = case
    system = system_of(slenderness, 1.0, 2.0, model)
    subject = (system.body, system.excitation, model)
    row = rk.basin(*subject, amplitudes=FIRST_OVERTURNING[case], phases=[0.0], speeds=0, impacts=1000)
    assert (row["final_state"].values.ravel() == 0).tolist() == [False, True]
    amplitudes = np.array([0.9, 1.5, 2.5])
    grid = rk.basin(*subject, amplitudes=amplitudes, phases=6, speeds=0, impacts=24)
    assert grid["final_state"].dims == ("amplitude_ratio", "ground_phase", "speed_ratio")
    for amplitude, kinds in zip(amplitudes, grid["final_state"].values[..., 0], strict=True):
        other = system.changed("amplitude", amplitude)
        for phase, kind in zip(grid["ground_phase"].values, kinds, strict=True):
            wave = (other.excitation.amplitude, other.excitation.frequency, phase)
            ground = Sinusoids("harmonic", (wave,), 12.0 * other.excitation.period, wave[0], wave[0], wave[1])
            response = simulate(system.body, ground, model, duration=12.0 * other.excitation.period)
            assert (response.outcome.value == "overturned") == (kind == 0)
            assert kind == 1 or amplitude > 1.0  # without uplift the body stays at rest


UNCERTAINTY = {
    # frequency, r, amplitude: exponent, standard error, fractions at 10^-2 and 10^-4 rad; 30,000 starts
    (3, 0.9, 0.9): (0.415, 0.013, 0.0194, 0.0028),
    (2, 0.7, 1.2): (0.405, 0.008, 0.0491, 0.0073),
}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program, other random starts")
@pytest.mark.parametrize("case", UNCERTAINTY)
def test_uncertainty_exponents(case):
    """Within three standard errors of both samples; a boundary that is smooth has an exponent of one."""
    frequency, restitution, amplitude = case
    value, error, *fractions = UNCERTAINTY[case]
    system = system_of(4, amplitude, frequency, restitution, linear=True)
    result = uncertainty_exponent(system, samples=15000)
    assert result.distance[[4, 0]] == pytest.approx([1e-2, 1e-4])
    assert abs(result.value - value) < 3.0 * math.hypot(error, result.standard_error)
    for own, other in zip(result.fraction[[4, 0]], fractions, strict=True):
        assert abs(own - other) < 3.0 * math.sqrt(other / 15000 + other / 30000)
    below = system.changed("amplitude", 0.85 * slender_thresholds(frequency, restitution).heteroclinic)  # control
    smooth = uncertainty_exponent(below, samples=4000, distances=[0.01, 0.03, 0.1, 0.3])
    assert abs(smooth.value - 1.0) < 3.0 * smooth.standard_error
    assert abs(smooth.value - value) > 3.0 * smooth.standard_error


@pytest.mark.verifies("invariant", "the same ratios at another size")
def test_basins_and_rest_in_other_units():
    """A body ten times as large, in slow motion, ends as the small one: only ratios count."""
    small, large = (
        HarmonicRocking.of_ratios(Block(width=w, height=4.0 * w), 1.5, 3.0, restitution="ked") for w in (0.1, 10.0)
    )
    draws = np.random.default_rng(0).random((2, 200))
    kinds = [ends_of(system, draws[0] * 6.28, draws[1] * 2.0).tolist() for system in (small, large)]
    assert kinds[0] == kinds[1]


@pytest.mark.verifies("closed form", "Lenci and Rega (2006); the half sine", within="1e-13")
def test_thresholds_in_closed_form():
    """Lenci and Rega (2006) and the half sine; Melnikov's is the limit of the exact one for r near 1."""
    assert slender_thresholds(2, 0.5).heteroclinic == pytest.approx(1.386750490563072805, rel=1e-14)
    assert slender_thresholds(3, 0.9).heteroclinic == pytest.approx(0.5198752449100363446, rel=1e-14)
    assert slender_thresholds(2, 0.9).no_impact == pytest.approx(1.8007239305607457817, rel=1e-13)
    assert slender_thresholds(5, 0.9).housner == pytest.approx(5.0990195135927848, rel=1e-14)  # unconservative
    for frequency, restitution, amplitude in (
        (1, 0.9, 1.13204711059768365), (2, 0.9, 1.22517942326831362), (3, 0.9, 1.403565355642782661),
        (5, 0.9, 3.01859986087179637), (6, 0.9, 5.1641589274575678), (10, 1.0, 11.5999959514276214),
    ):  # fmt: skip
        assert slender_thresholds(frequency, restitution).one_impact == pytest.approx(amplitude, rel=1e-13)
    assert math.isnan(slender_thresholds(8, 0.9).one_impact)
    near = slender_thresholds(3, 1.0 - 1e-6)
    assert near.melnikov == pytest.approx(near.heteroclinic, rel=1e-5)
