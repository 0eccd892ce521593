"""Studies against closed forms: every boundary that has one, by scan and by polyline."""

import math

import numpy as np
import pytest
from pulse_boundaries import (
    COSINE,
    HALF_SINE,
    LOWER_AT_ONE,
    RECTANGLE,
    SINE_NO_IMPACT,
    SINE_ONE_IMPACT,
    SINE_ONE_IMPACT_ELASTIC,
    mode_two,
)  # fmt: skip

import rocking as rk
from rocking.studies import boundary, safe_beyond_overturning, safe_islands

pytestmark = pytest.mark.verifies(room="studies")

ALPHA = 0.12
BLOCK = rk.Block.from_angle(ALPHA, 0.9)
P = BLOCK.frequency_parameter


def crossings(pulse, r, **options):
    """All crossings of the linear equations."""
    return rk.minimum_overturning_acceleration(BLOCK, pulse, r, linear=True, threads=1, **options)


def period(omega):
    """Period of a pulse of that frequency ratio."""
    return 2.0 * math.pi / (omega * P)


@pytest.mark.verifies("closed form", "1 / (1 - exp(-p T))", within="1e-10")
@pytest.mark.parametrize("length", RECTANGLE)
def test_rectangles(length):
    """Rectangles, REF: one crossing, at A = 1 / (1 - exp(-p T))."""
    found = crossings(rk.pulses.rectangular(1.0, length / P), 0.9)
    assert found.ratio == pytest.approx([RECTANGLE[length]], rel=1e-10, abs=0.0)
    assert RECTANGLE[length] == pytest.approx(1.0 / (1.0 - math.exp(-length)), rel=1e-15, abs=0.0)
    assert found.modes.tolist() == [[-1, 0]]


@pytest.mark.verifies(
    "closed form", "the roots of the boundary's equation, 20 digits", within="1e-10", control="within"
)
@pytest.mark.parametrize("omega", HALF_SINE)
def test_half_sines(omega, agreement):
    """Half sines, REF: one crossing; Housner's sqrt(1 + Omega^2) is rejected by the same check."""
    found = crossings(rk.pulses.half_sine(1.0, period(omega)), 0.9)
    (ratio,) = found.ratio
    agreement(abs(ratio / HALF_SINE[omega] - 1.0), 1e-10)
    assert found.modes.tolist() == [[-1, 0]]
    assert found.ratio != pytest.approx([math.sqrt(1.0 + omega**2)], rel=0.04)  # negative control: 6 % and more off


@pytest.mark.slow
@pytest.mark.verifies("closed form", "modes I and II of Zhang and Makris 2001", within="1e-10", control="within")
@pytest.mark.parametrize("omega", SINE_ONE_IMPACT)
def test_full_sines_with_their_gap(omega, agreement):
    """REF: mode I from its lower to its upper boundary, survival, and mode II above: all three crossings."""
    found = crossings(rk.pulses.sine(1.0, period(omega)), 0.9)
    second = SINE_NO_IMPACT.get(omega) or mode_two(omega)
    agreement(np.abs(found.ratio / [*SINE_ONE_IMPACT[omega], second] - 1.0).max(), 1e-10)
    assert found.modes.tolist() == [[-1, 1], [1, -1], [-1, 0]]
    assert len(found.safe_intervals) == 2
    assert found.minimum == found.acceleration[0] < found.certain == found.acceleration[2]
    other = crossings(rk.pulses.sine(1.0, period(omega)), 0.895)
    assert other.ratio[:2] != pytest.approx(SINE_ONE_IMPACT[omega], rel=1e-4)  # negative control


@pytest.mark.verifies("closed form", "modes I and II of Zhang and Makris 2001", within="1e-10")
def test_the_thin_gap_of_a_slow_sine():
    """REF: at Omega = 1 mode I begins at its lower boundary and mode II ends a gap of 0.14 % that no sample met."""
    found = crossings(rk.pulses.sine(1.0, period(1)), 0.9, samples=50)
    assert found.resolution > 0.05
    assert found.ratio[[0, 2]] == pytest.approx([LOWER_AT_ONE, SINE_NO_IMPACT[1]], rel=1e-10, abs=0.0)
    assert found.modes.tolist() == [[-1, 1], [1, -1], [-1, 0]]
    assert 1.0 < found.ratio[2] / found.ratio[1] < 1.002


@pytest.mark.verifies("closed form", "mode II of Zhang and Makris 2001", within="1e-10")
@pytest.mark.parametrize("omega", [8, 10])
def test_full_sines_without_mode_one(omega):
    """REF: at r = 0.9 fast sines overturn without impact only."""
    found = crossings(rk.pulses.sine(1.0, period(omega)), 0.9)
    assert found.ratio == pytest.approx([SINE_NO_IMPACT[omega]], rel=1e-10, abs=0.0)
    assert found.modes.tolist() == [[-1, 0]]


@pytest.mark.verifies("closed form", "mode I of Zhang and Makris 2001 with r = 1", within="1e-10")
@pytest.mark.parametrize("omega", SINE_ONE_IMPACT_ELASTIC)
def test_elastic_full_sines(omega):
    """REF: with r = 1 modes I and II touch, and the last crossing is into mode I."""
    found = crossings(rk.pulses.sine(1.0, period(omega)), 1.0)
    assert found.ratio[-1] == pytest.approx(SINE_ONE_IMPACT_ELASTIC[omega], rel=1e-10, abs=0.0)
    assert found.modes[-1].tolist() == [-1, 1]
    assert len(found) == (3 if omega == 1 else 1)  # a slow sine overturns by three impacts before


@pytest.mark.verifies("closed form", "(1 + Omega^2) / (1 - exp(-2 pi / Omega))", within="1e-10")
@pytest.mark.parametrize("omega", COSINE)
def test_full_cosines(omega):
    """REF: the crossing into mode 0 at (1 + Omega^2) / (1 - exp(-2 pi / Omega))."""
    found = crossings(rk.pulses.cosine(1.0, period(omega)), 0.9)
    assert COSINE[omega] == pytest.approx(
        (1.0 + omega**2) / (1.0 - math.exp(-2.0 * math.pi / omega)), rel=1e-14, abs=0.0
    )
    assert found.modes[-1].tolist() == [-1, 0]
    assert found.ratio[-1] == pytest.approx(COSINE[omega], rel=1e-10, abs=0.0)


@pytest.mark.verifies("computed anew", "critical durations to 18 digits", within="1e-10", control="within")
@pytest.mark.parametrize(
    ("tangent", "ratio", "p_time"),
    [(0.25, 2.0, 0.694657418494709748), (0.25, 1.5, 1.09871626868391818), (0.5, 2.0, 0.698078662751420487)],
)
def test_nonlinear_rectangles(tangent, ratio, p_time):
    """REF: by the exact equations the crossing is at the ratio whose critical duration the pulse has."""
    block = rk.Block.from_angle(math.atan(tangent), 1.1)
    pulse = rk.pulses.rectangular(1.0, p_time / block.frequency_parameter)
    found = rk.minimum_overturning_acceleration(block, pulse, 0.9, threads=1)
    assert found.ratio == pytest.approx([ratio], rel=1e-10, abs=0.0)
    linear = rk.minimum_overturning_acceleration(block, pulse, 0.9, threads=1, linear=True)
    assert linear.ratio != pytest.approx([ratio], rel=1e-5)  # negative control


@pytest.mark.verifies(
    "computed anew", "boundaries to 17 and 8 digits", within="1e-10, and 1e-7 where fewer digits are known"
)
def test_nonlinear_full_sine():
    """REF: full sine, Omega = 3, tan alpha = 1/3, r = 0.85: all three crossings by the exact equations."""
    block = rk.Block.from_angle(math.atan(1.0 / 3.0), 0.7)
    pulse = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * block.frequency_parameter))
    found = rk.minimum_overturning_acceleration(block, pulse, 0.85, threads=1)
    assert found.ratio[0] == pytest.approx(1.43078991141167367, rel=1e-10, abs=0.0)
    assert found.ratio[1:] == pytest.approx([3.4697991, 3.6856831], rel=1e-7)
    assert found.modes.tolist() == [[-1, 1], [1, -1], [-1, 0]]


@pytest.fixture(scope="module")
def lines():
    """Outlines of the modes of the full sine over the classical axes, r = 0.9, linear, whole Omega on the grid."""
    return boundary(
        BLOCK, rk.pulses.sine(1.0, 0.5), ("frequency_ratio", np.linspace(1.0, 10.0, 37)),
        ("amplitude_ratio", np.linspace(0.9, 23.1, 112)), 0.9, by="mode", levels=1, linear=True, threads=1,
    )  # fmt: skip


def at(lines, region, omega):
    """Ordinates at which outlines of a region cross an abscissa of the grid, in order."""
    vertices = np.concatenate([line.points for line in lines if line.region == region])
    return sorted({y for x, y in vertices.tolist() if abs(x - omega) < 1e-12})


@pytest.mark.verifies("closed form", "mode II of Zhang and Makris 2001", within="1e-8")
def test_polylines_pass_through_mode_two(lines):
    """REF: the outline of mode 0 passes every boundary of mode II to 1e-8, bisected along the grid's upright edges."""
    for omega, expected in SINE_NO_IMPACT.items():
        found = at(lines, "overturned after 0 impacts", omega)
        if omega > 1:  # there the gap is thinner than a cell, see above
            assert found == pytest.approx([expected], rel=1e-8)


@pytest.mark.verifies("closed form", "mode I of Zhang and Makris 2001", within="1e-8", control="within")
@pytest.mark.parametrize("omega", [3, 5, 6])
def test_polylines_pass_through_mode_one(lines, omega):
    """REF: the outline of mode 1 passes its lower and upper boundary to 1e-8."""
    found = at(lines, "overturned after 1 impacts", omega)
    assert found == pytest.approx(SINE_ONE_IMPACT[omega], rel=1e-8)
    assert found != pytest.approx([1.001 * value for value in SINE_ONE_IMPACT[omega]], rel=1e-8)  # negative control


@pytest.mark.verifies("behaviour")
def test_polylines_name_both_sides(lines):
    """Outside the outline of mode 1 the block survives or overturns by another mode; inside it is always mode 1."""
    first = [line for line in lines if line.region == "overturned after 1 impacts"]
    assert first
    for line in first:
        assert set(line.modes[:, 1].tolist()) == {1}
        assert 1 not in line.modes[:, 0]


@pytest.fixture(scope="module")
def sines():
    """Map of the full sine, r = 0.9, linear."""
    return rk.overturning_map(
        BLOCK, rk.pulses.sine(1.0, 0.5), ("frequency_ratio", np.linspace(1.0, 7.0, 121)),
        ("amplitude_ratio", np.linspace(0.5, 12.0, 231)), 0.9, linear=True, threads=1,
    )  # fmt: skip


@pytest.mark.verifies("closed form", "mode II of Zhang and Makris 2001", within="every cell")
def test_every_cell_is_on_its_side(sines):
    """Every cell of a map is overturned without impact exactly where the closed form of mode II says so."""
    for omega in sines["frequency_ratio"].values:
        column = sines["mode"].sel(frequency_ratio=omega)
        second = mode_two(omega)
        above = column["amplitude_ratio"].values > second
        if omega > 1.5:
            assert ((column.values == 0) == above).all()
        assert (column.values[above] == 0).all()


@pytest.mark.verifies("closed form", "the gap between modes I and II", within="every cell", control="within")
def test_the_safe_region_between_the_modes(sines):
    """Between the upper boundary of mode I and mode II cells survive, above overturning ones; with r = 1 none does."""
    beyond = safe_beyond_overturning(sines)
    for omega, (_, upper) in SINE_ONE_IMPACT.items():
        column = beyond.sel(frequency_ratio=omega, method="nearest")
        ratio = column["amplitude_ratio"].values
        assert (column.values == ((ratio > upper) & (ratio < mode_two(omega)))).all()
    assert beyond.sel(frequency_ratio=slice(2.5, 6.5)).any("amplitude_ratio").all()
    narrow = sines.sel(frequency_ratio=slice(2.5, 6.0))
    assert max(island.cells for island in safe_islands(narrow, enclosed=False).islands) > 100
    assert len(safe_islands(narrow)) == 0  # it opens at the edge of the map
    elastic = rk.overturning_map(
        BLOCK, rk.pulses.sine(1.0, 0.5), ("frequency_ratio", np.linspace(1.0, 7.0, 61)),
        ("amplitude_ratio", np.linspace(0.5, 12.0, 116)), 1.0, linear=True, threads=1,
    )  # fmt: skip
    assert not safe_beyond_overturning(elastic).any()


@pytest.mark.verifies("computed anew", "largest rotations to three digits", within="0.006 of alpha")
def test_survivors_lean_beyond_the_top(sines):
    """REF: below mode II survivors lean to 1.61, 1.51 and 1.39 alpha at Omega = 2, 3, 5: beyond 1 is no overturning."""
    for omega, published in ((2, 1.61), (3, 1.51), (5, 1.39)):
        scale = mode_two(omega) * (1.0 - 1e-9)
        point = rk.overturning_map(
            BLOCK, rk.pulses.sine(1.0, 0.5), ("frequency_ratio", [omega]), ("amplitude_ratio", [scale]), 0.9,
            linear=True, threads=1,
        )  # fmt: skip
        assert point["mode"].item() == -1
        assert point["peak_ratio"].item() == pytest.approx(published, abs=0.006)  # known to three digits
