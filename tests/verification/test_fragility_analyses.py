"""Fragility analyses against closed forms of overturning, invariances of the equations, and independent readers."""

import math
import xml.etree.ElementTree as ET

import mpmath as mp
import numpy as np
import pytest
from pulse_boundaries import HALF_SINE, SINE_NO_IMPACT, SINE_ONE_IMPACT
from random_cases import smooth_noises

import rocking as rk
from rocking import conventions
from rocking.errors import InvalidValueError
from rocking.studies import fragility_analysis
from rocking.studies.fragility import model_of, to_nrml

pytestmark = pytest.mark.verifies(room="studies")
LOWER, UPPER, NO_IMPACT = *SINE_ONE_IMPACT[3], SINE_NO_IMPACT[3]  # full sine, Omega = 3, r = 0.9
BLOCK = rk.Block(width=0.4, height=1.6)
NORMALISED = "pga/(g tan alpha)"


def pulse(make, omega, body):
    """Pulse of one m/s2 whose circular frequency is Omega p of a body."""
    return make(1.0, 2.0 * math.pi / (omega * body.frequency_parameter))


def records(count, seed=5, samples=500, step=0.02):
    """Noise in a window, smoothed."""
    return [rk.GroundMotion(noise, step) for noise in smooth_noises(count, seed, samples)]


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form",
    "the roots of the boundary of half sines, 20 digits",
    within="1e-11 (fast), 1e-8 (reference)",
    control="test_the_reported_formula_is_unconservative",
)
@pytest.mark.parametrize("engine", ["fast", "reference"])
def test_first_crossings_are_the_closed_boundaries(engine, agreement):
    """REF: half sines of the slender-linear block, all at once, cross at the roots of their equation."""
    pulses = [pulse(rk.pulses.half_sine, omega, BLOCK) for omega in HALF_SINE]
    # the reference engine is slow, and shows the same with a coarser start and search
    levels, tolerance = (np.linspace(1.05, 6.0, 40), 0.0) if engine == "fast" else ([1.2, 3.0, 6.0], 1e-9)
    found = fragility_analysis(
        BLOCK,
        pulses,
        levels,
        restitution=0.9,
        im=NORMALISED,
        tolerance=tolerance,
        linear=True,
        engine=engine,
        analysis="incremental",
    )
    errors = found.first_crossings / np.array(list(HALF_SINE.values())) - 1.0
    agreement(np.abs(errors).max(), 1e-11 if engine == "fast" else 1e-8)
    assert found.resurrected() == []
    assert [i.is_open for i in found.intervals] == [True] * len(HALF_SINE)


@pytest.mark.verifies("negative control", "Housner's sqrt(1 + Omega^2)", doi="10.1785/BSSA0530020403")
def test_the_reported_formula_is_unconservative():
    """Negative control: Housner's sqrt(1 + Omega^2) for half sines is rejected by the same comparison."""
    found = fragility_analysis(
        BLOCK,
        pulse(rk.pulses.half_sine, 2.0, BLOCK),
        [1.5, 3.0],
        restitution=0.9,
        im=NORMALISED,
        linear=True,
        analysis="incremental",
    )
    assert abs(found.first_crossings[0] / math.sqrt(5.0) - 1.0) > 0.1


@pytest.mark.verifies("closed form", "modes I and II of Zhang and Makris 2001, 18 digits", within="1e-11")
def test_resurrection_of_the_full_sine():
    """REF: overturning by one impact from 1.4036 to 3.4847, survival up to 3.6311, overturning without impact above."""
    found = fragility_analysis(
        BLOCK, pulse(rk.pulses.sine, 3.0, BLOCK), np.linspace(1.0, 5.0, 41), restitution=0.9, im=NORMALISED,
        linear=True, tolerance=0.0, analysis="incremental",
    )  # fmt: skip
    first, second = found.intervals
    for value, expected in ((first.start, LOWER), (first.end, UPPER), (second.start, NO_IMPACT)):
        assert value == pytest.approx(expected, rel=1e-11, abs=0.0)
    assert second.is_open
    assert not first.is_open
    assert found.resurrected() == [0]
    assert found.fraction_resurrected() == 1.0
    assert found.first_crossings[0] == first.start
    assert found.survivals == [(0, first.end, second.start)]
    assert found.resurrected(NO_IMPACT / UPPER - 1.0 + 1e-6) == []
    within = (found.levels > UPPER) & (found.levels < NO_IMPACT)
    assert within.any()
    assert np.all(found.fractions[within] == 0.0)  # "fraction" sees the survival, "first crossing" does not


@pytest.mark.verifies(
    "computed anew", "boundaries to 17 and 8 digits", within="1e-10, and 6e-8 where fewer digits are known"
)
def test_resurrection_of_the_nonlinear_full_sine():
    """REF: tan(alpha) = 1/3, r = 0.85, Omega = 3: overturned from 1.43079 to 3.46980, safe up to 3.68568."""
    block = rk.Block(width=0.5, height=1.5)
    found = fragility_analysis(
        block, pulse(rk.pulses.sine, 3.0, block), np.linspace(1.0, 5.0, 41), restitution=0.85, im=NORMALISED,
        tolerance=0.0, analysis="incremental",
    )  # fmt: skip
    ends = [found.intervals[0].start, found.intervals[0].end, found.intervals[1].start]
    assert ends[0] == pytest.approx(1.43078991141167367, rel=1e-10, abs=0.0)
    assert ends[1:] == [pytest.approx(3.4697991, abs=6e-8), pytest.approx(3.6856831, abs=6e-8)]


@pytest.mark.verifies("invariant", "blocks 4 times as large under motions twice as slow", within="1e-12")
def test_larger_blocks_under_slower_motions():
    """Size: a block s times as large under the record at sqrt(s) times the step has the same fragility in PGA."""
    levels, size = np.linspace(2.0, 9.0, 8), 4.0
    small = fragility_analysis(BLOCK, records(40), levels, restitution=0.9)
    large = fragility_analysis(
        rk.Block(width=0.4 * size, height=1.6 * size), records(40, step=0.02 * math.sqrt(size)), levels, restitution=0.9
    )
    same = small.responses.outcome == large.responses.outcome
    assert same.all()
    assert 0 < small.counts["overturned"].sum() < 320
    assert large.fits["overturned"].median == pytest.approx(small.fits["overturned"].median, rel=1e-12, abs=0.0)


@pytest.mark.verifies("invariant", "blocks of another size", within="1e-9", control="within")
def test_dimensionless_measures_know_the_size():
    """Against p PGV / (g tan alpha) the same two bodies have one curve; against PGV they do not (the control)."""
    size, medians = 4.0, {}
    for im, levels in (("p pgv/(g tan alpha)", np.linspace(0.2, 2.5, 8)), ("pgv", np.linspace(0.1, 2.0, 8))):
        both = [
            fragility_analysis(
                rk.Block(width=0.4 * s, height=1.6 * s), records(30, step=0.02 * math.sqrt(s)), levels,
                restitution=0.9, im=im,
            ).fits["overturned"].median
            for s in (1.0, size)
        ]  # fmt: skip
        medians[im] = both[1] / both[0]
    assert medians["p pgv/(g tan alpha)"] == pytest.approx(1.0, rel=1e-9, abs=0.0)
    assert medians["pgv"] > 1.5


@pytest.mark.verifies("invariant", "two point masses with alpha and p of the block", within="every outcome")
def test_bodies_of_equal_parameters_are_one_body():
    """Two point masses with the alpha and p of a block have its fragility, though they share nothing else with it."""
    half_width, half_height = 0.2, 0.8
    radius = math.hypot(half_width, half_height)
    # g R' / (I / m + R'^2) = p^2 = 3 g / (4 R)
    larger = 1.1
    distance = math.sqrt(larger * radius * (4.0 / 3.0 * radius - larger * radius))
    height = larger * half_height
    points = rk.MassPoints(
        [(0.0, height - distance), (0.0, height + distance)], [5.0, 5.0],
        feet=(-larger * half_width, larger * half_width),
    )  # fmt: skip
    assert points.frequency_parameter == pytest.approx(BLOCK.frequency_parameter, rel=1e-13, abs=0.0)
    levels = np.linspace(2.0, 9.0, 8)
    found = [fragility_analysis(body, records(40), levels, restitution=0.9) for body in (BLOCK, points)]
    assert found[0].responses.outcome.tolist() == found[1].responses.outcome.tolist()
    assert found[0].counts["overturned"].sum() > 20


@pytest.mark.slow
@pytest.mark.verifies("invariant", "all motions mirrored", within="every bit")
def test_mirrored_motions():
    """Turned round, all motions give the same counts, crossings and fits."""
    levels, motions = np.linspace(2.0, 9.0, 8), records(30)
    mirrored = [m.scaled(-1.0) for m in motions]
    found = [
        fragility_analysis(BLOCK, given, levels, restitution=0.9, analysis="incremental")
        for given in (motions, mirrored)
    ]
    np.testing.assert_array_equal(found[0].curves, found[1].curves)
    np.testing.assert_array_equal(found[0].first_crossings, found[1].first_crossings)
    assert found[0].fits["overturned"].median == found[1].fits["overturned"].median


@pytest.mark.slow
@pytest.mark.verifies("invariant", "all records times 3.7", within="1e-8")
def test_scaled_records():
    """Records times c: the median in PGA stays, and the factor on the records at the first crossing is divided by c."""
    levels, motions, c = np.linspace(2.0, 12.0, 21), records(30), 3.7
    plain, scaled = (
        fragility_analysis(BLOCK, given, levels, restitution=0.9, tolerance=1e-9, analysis="incremental")
        for given in (motions, [m.scaled(c) for m in motions])
    )
    assert plain.counts["overturned"].tolist() == scaled.counts["overturned"].tolist()
    finite = np.isfinite(plain.first_crossings)
    assert finite.sum() > 20
    factors = [found.first_crossings[finite] / found.subject.intensities[finite] for found in (plain, scaled)]
    np.testing.assert_allclose(factors[1], factors[0] / c, rtol=1e-8)
    assert scaled.first_crossing_fit.median == pytest.approx(plain.first_crossing_fit.median, rel=1e-8)


@pytest.mark.verifies("invariant", "gravity and motions times 2.5", within="every outcome")
def test_gravity():
    """Gravity and motions times c, times divided by sqrt(c): the same fragility over g tan(alpha)."""
    c, levels = 2.5, np.linspace(1.1, 4.0, 8)
    plain = fragility_analysis(BLOCK, records(30), levels, restitution=0.9, im=NORMALISED)
    heavy = fragility_analysis(
        BLOCK, records(30, step=0.02 / math.sqrt(c)), levels, restitution=0.9, im=NORMALISED,
        gravity=c * conventions.g,
    )  # fmt: skip
    assert plain.responses.outcome.tolist() == heavy.responses.outcome.tolist()


@pytest.mark.verifies("closed form", "g tan alpha", within="1e-6 on either side, 600 histories")
def test_uplift_is_certain_given_pga():
    """P(no rocking) is a step at g tan(alpha): 600 histories just below and above it, none of which disagrees."""
    threshold = conventions.g * 0.25
    levels = threshold * np.array([0.9, 1.0 - 1e-6, 1.0 + 1e-6, 1.1])
    found = fragility_analysis(BLOCK, records(150), levels, restitution=0.9)
    assert found.counts["rocking"].tolist() == [0, 0, 150, 150]
    assert (found.uplift.checked, found.uplift.contradictions) == (600, 0)
    # linear equations lift at g alpha instead
    linear = fragility_analysis(BLOCK, records(20), [conventions.g * math.atan(0.25)], restitution=0.9, linear=True)
    assert linear.uplift.threshold == pytest.approx(conventions.g * math.atan(0.25), rel=1e-15, abs=0.0)


@pytest.mark.verifies("closed form", "the boundary of half sines", within="3e-9")
def test_cloud_of_pulses_has_the_boundary_between_its_levels():
    """One pulse shape at many amplitudes: the cloud is separated exactly at the closed boundary."""
    boundary = HALF_SINE[2] * conventions.g * math.atan(0.25)
    unit = pulse(rk.pulses.half_sine, 2.0, BLOCK)
    pulses = [unit.scaled(boundary * f) for f in (0.8, 0.9, 1.0 - 1e-9, 1.0 + 1e-9, 1.1, 1.2)]
    found = fragility_analysis(BLOCK, pulses, restitution=0.9, limit_states=(), linear=True, analysis="cloud")
    assert found.responses.overturned.tolist() == [False] * 3 + [True] * 3
    low, high = found.fits["overturned"].median_interval
    assert low < boundary < high
    assert high / low - 1.0 < 3e-9


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "the file read by a parser of its own, and OpenQuake's formula with 30 digits",
    within="1e-12",
    control="within",
)
def test_nrml_reproduces_the_curve(tmp_path, agreement):
    """Read by a parser of its own and evaluated by mpmath as OpenQuake does, the file gives P(im) to 1e-12."""
    found = fragility_analysis(BLOCK, records(60), np.linspace(2.0, 10.0, 9), restitution=0.9, limit_states=(0.2, 0.5))
    made = model_of(found, "block <1>", crossing_curves="refuse")
    with pytest.raises(InvalidValueError, match="curves must not cross, but at"):
        to_nrml(made, tmp_path / "fragility.xml")
    assert not list(tmp_path.iterdir())
    path = to_nrml(made, tmp_path / "fragility.xml", crossing_curves="common-dispersion")
    tag = "{http://openquake.org/xmlns/nrml/0.5}"
    root = ET.parse(path).getroot()
    params = root.findall(f".//{tag}params")
    curves = model_of(found, "block <1>", crossing_curves="common-dispersion").curves
    words = ["rotation_above_0_2_alpha", "rotation_above_0_5_alpha", "overturned"]
    assert root.find(f".//{tag}limitStates").text.split() == words
    assert [curve.state for curve in curves] == list(found.fits)
    mp.mp.dps = 30
    worst, wrong = 0.0, 0.0
    for node, word, fit in zip(params, words, curves, strict=True):
        assert node.attrib["ls"] == word
        mean, deviation = mp.mpf(node.attrib["mean"]), mp.mpf(node.attrib["stddev"])
        sigma = mp.sqrt(mp.log(1 + (deviation / mean) ** 2))
        median = mean**2 / mp.sqrt(deviation**2 + mean**2)
        for level in np.linspace(2.5, 12.0, 20):
            p = mp.ncdf(mp.log(mp.mpf(level) / mp.mpf(conventions.g) / median) / sigma)
            worst = max(worst, abs(float(p - mp.mpf(float(fit.probability(level))))))
            # negative control: median and dispersion written as if they were mean and standard deviation
            naive_sigma = mp.sqrt(mp.log(1 + (mp.mpf(fit.dispersion) / fit.median) ** 2))
            wrong = max(wrong, abs(float(mp.ncdf(mp.log(level / mp.mpf(fit.median)) / naive_sigma) - p)))
    agreement(worst, 1e-12)
    assert wrong > 0.05


@pytest.mark.verifies("closed form", "modes I of full sines, and the intervals counted anew", within="1e-8")
def test_both_definitions_on_one_set():
    """Sines of many periods: the definitions differ where motions come back, by what the intervals say."""
    pulses = [pulse(rk.pulses.sine, omega, BLOCK) for omega in np.linspace(2.0, 6.0, 41)]
    levels = np.linspace(1.05, 8.0, 140)
    found = fragility_analysis(
        BLOCK, pulses, levels, restitution=0.9, im=NORMALISED, linear=True, tolerance=1e-9, analysis="incremental"
    )
    by_intervals = np.array([sum(i.start <= level < i.end for i in found.intervals) / len(pulses) for level in levels])
    np.testing.assert_allclose(found.fractions, by_intervals, rtol=0.0, atol=1e-15)
    passed = np.array([np.mean(found.first_crossings <= level) for level in levels])
    most = (passed - found.fractions).max()
    print(f"\nresurrected: {found.fraction_resurrected():.2f}; definitions differ by up to {most:.2f}")
    assert np.all(passed >= found.fractions)
    assert most > 0.05
    # REF (same section): with r = 0.9 the full sines at Omega = 2, 3, 5, 6 all survive between mode I and mode II
    # (at Omega = 2 the survival, from 2.314 to 2.350, is narrower than the distance between levels)
    assert found.fraction_resurrected() == 1.0
    ends = {round(omega, 3): k for k, omega in enumerate(np.linspace(2.0, 6.0, 41))}
    for omega, (low, high) in {
        2.0: (1.22517942326831362, 2.31440295302158405), 3.0: (LOWER, UPPER),
        5.0: (3.01859986087179637, 6.31807052982744609), 6.0: (5.1641589274575678, 7.6698730415941765),
    }.items():  # fmt: skip
        first = next(i for i in found.intervals if i.motion == ends[omega])
        assert (first.start, first.end) == (pytest.approx(low, rel=1e-8), pytest.approx(high, rel=1e-8))
