"""Intensity measures, velocity and displacement against closed forms, piecewise polynomials and band limits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import trapezoid
from scipy.interpolate import PPoly
from scipy.optimize import brentq

from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.motions import (
    GroundMotion,
    arias_intensity,
    cumulative_absolute_velocity,
    ground_displacement,
    ground_velocity,
    housner_intensity,
    intensity_measures,
    normalised_acceleration,
    normalised_velocity,
    peak_ground_acceleration,
    peak_ground_displacement,
    peak_ground_velocity,
    significant_duration,
    significant_times,
    spectral_acceleration,
)
from rocking.motions.formats import read_motion

pytestmark = pytest.mark.verifies(room="motions and records")

ZIGZAG = GroundMotion([0.0, 1.0, -1.0, 0.0], 1.0)
RECORDS = st.lists(st.floats(-10.0, 10.0).map(lambda x: round(x, 3)), min_size=2, max_size=30)


def _lines(motion):
    a = motion.acceleration
    return PPoly(np.array([np.diff(a) / motion.time_step, a[:-1]]), motion.time)


def _peak(curve, slope):
    turns = np.concatenate([slope.roots(extrapolate=False), curve.x])
    return np.abs(curve(turns[np.isfinite(turns)])).max()


@pytest.mark.verifies("closed form", "integrals on paper", within="1e-15")
def test_hand_made_zigzag():
    """All integrals of a zigzag of three steps are those worked out on paper."""
    assert peak_ground_acceleration(ZIGZAG) == 1.0
    assert peak_ground_velocity(ZIGZAG) == pytest.approx(0.75, rel=1e-15, abs=0.0)
    assert peak_ground_displacement(ZIGZAG) == pytest.approx(1.0, rel=1e-15, abs=0.0)
    assert arias_intensity(ZIGZAG) == pytest.approx(math.pi / g, rel=1e-15, abs=0.0)
    assert cumulative_absolute_velocity(ZIGZAG) == pytest.approx(2.0, rel=1e-15, abs=0.0)


@pytest.mark.verifies("computed anew", "roots of SciPy's piecewise polynomials", within="1e-9")
@given(RECORDS, st.sampled_from([0.005, 0.37, 20.0]))
def test_peaks_agree_with_piecewise_polynomials(samples, step):
    """PGV and PGD are the extremes that the roots of SciPy's piecewise polynomials give."""
    motion = GroundMotion(samples, step)
    line = _lines(motion)
    velocity = line.antiderivative()
    displacement = velocity.antiderivative()
    scale = motion.peak * motion.duration
    assert peak_ground_velocity(motion) == pytest.approx(_peak(velocity, line), rel=1e-9, abs=1e-12 * scale)
    expected = _peak(displacement, velocity)
    assert peak_ground_displacement(motion) == pytest.approx(expected, rel=1e-9, abs=1e-12 * scale * motion.duration)


def _fine(motion, factor=16):
    """Return the band-limited signal through the samples (zeros around it, Shannon), and its step."""
    spectrum = np.fft.rfft(motion.acceleration, 4 * len(motion))
    return factor * np.fft.irfft(spectrum, 4 * factor * len(motion)), motion.time_step / factor


def _band_limited(motion):
    """Return Arias intensity, CAV and significant duration of the band-limited signal."""
    a, step = _fine(motion)
    husid = np.cumsum(a * a) * step
    first, last = np.searchsorted(husid, np.array([0.05, 0.95]) * husid[-1]) * step
    return 0.5 * math.pi / g * husid[-1], np.abs(a).sum() * step, last - first


def _of_lines(motion):
    """Negative control: Arias intensity and CAV of the straight lines between the samples."""
    t = np.linspace(0.0, motion.duration, 64 * (len(motion) - 1) + 1)
    a = np.interp(t, motion.time, motion.acceleration)
    return 0.5 * math.pi / g * trapezoid(a * a, t), trapezoid(np.abs(a), t)


def _check_against_the_band(motion, lost_by_lines):
    arias, area, duration = _band_limited(motion)
    assert arias_intensity(motion) == pytest.approx(arias, rel=1e-4)
    assert cumulative_absolute_velocity(motion) == pytest.approx(area, rel=5e-3)
    assert significant_duration(motion) == pytest.approx(duration, abs=motion.time_step)
    lines = _of_lines(motion)
    assert lines[0] < (1.0 - lost_by_lines) * arias
    assert lines[1] < area


@pytest.mark.parametrize(("band", "lost"), [(0.3, 0.04), (0.5, 0.11)])
def test_measures_are_those_of_the_band_limited_signal(band, lost):
    """Noise below a share of the Nyquist frequency, growing fast and fading slowly; lines lose 4 to 13 %."""
    random = np.random.default_rng(5)
    for _ in range(5):
        spectrum = np.fft.rfft(random.standard_normal(4000))
        spectrum[int(band * spectrum.size) :] = 0.0
        time = np.linspace(0.0, 40.0, 4000)
        _check_against_the_band(GroundMotion(time * np.exp(-0.2 * time) * np.fft.irfft(spectrum), 0.01), lost)


@pytest.mark.verifies("computed anew", "integrals of the band-limited signal, of recorded earthquakes")
@pytest.mark.parametrize(
    ("name", "units", "step", "lost"),
    [
        ("peer/elCentro.at2", None, None, 0.042),
        ("peer/CPM000.AT2", None, None, 0.07),
        ("peer/RSN8883_14383980_13849360.AT2", None, None, 0.003),
        ("plain_values/tabasFN.txt", "g", 0.02, 0.07),
        ("two_column/CHV1-20140203E.txt", "cm/s2", None, 0.002),
    ],
)
def test_measures_of_real_records(shared_records, name, units, step, lost):
    """Real records agree with their band-limited signals; straight lines lose up to 7 % of their energy."""
    _check_against_the_band(read_motion(shared_records / name, units=units, time_step=step), lost)


@pytest.mark.verifies(
    "published",
    "the RMS that GNS Science prints of three components of a record (Hanmer Springs, 2016)",
    within="5.1e-6",
    control="within",
)
def test_energy_is_that_of_the_rms_an_agency_states(shared_records):
    """GNS Science prints the RMS of three components (Hanmer Springs, Kaikoura 2016); its square is the energy."""
    lines = (shared_records / "refused/geonet_v1a/20161113_110300_HSES_20.V1A").read_text().splitlines()
    heads = [i for i, line in enumerate(lines) if line.startswith("Acceleration:")]
    assert len(heads) == 3
    for i in heads:
        stated = float(lines[i].split("RMS")[1].split()[0])
        values = [float(line[k : k + 8]) for line in lines[i + 13 : i + 6567] for k in range(0, len(line.rstrip()), 8)]
        motion = GroundMotion(np.array(values[:65536]) * 1e-3, 0.005)
        # five printed digits of the RMS, whose square it is
        mean_square = 2.0 * g / math.pi * arias_intensity(motion) / (65536 * 0.005)
        assert math.sqrt(mean_square) == pytest.approx(1e-3 * stated, abs=5.1e-6)
        lines_only = 2.0 * g / math.pi * _of_lines(motion)[0] / (65536 * 0.005)
        assert abs(math.sqrt(lines_only) - 1e-3 * stated) > 5e-5


@pytest.mark.verifies("closed form", "pi A^2 T / (4 g)", within="1e-13")
@pytest.mark.parametrize("samples", [5, 7, 40])
def test_arias_intensity_of_a_sine(samples):
    """Whole periods of a sine have pi A^2 T / (4 g), to rounding, from five samples a period on."""
    time = np.arange(3 * samples + 1) / samples
    motion = GroundMotion(2.0 * np.sin(2.0 * math.pi * time), 1.0 / samples)
    assert arias_intensity(motion) == pytest.approx(math.pi * 4.0 * 3.0 / (4.0 * g), rel=1e-13, abs=0.0)


def _sine(step):
    # three periods of 0.81 s, so that no turn of sign falls on a sample
    count = round(2.43 / step)
    return GroundMotion(np.sin(2.0 * math.pi / 0.81 * np.arange(count + 1) * step), step)


@pytest.mark.verifies("order", "closed forms of a sine", within="1e-4 at the finest step")
def test_area_and_durations_are_of_second_order():
    """CAV and significant times of a sine tend to their closed forms with the square of the step."""
    omega = 2.0 * math.pi / 0.81
    husid = lambda t: t / 2.43 - math.sin(2.0 * omega * t) / (2.0 * omega * 2.43)  # noqa: E731
    exact = np.array([brentq(lambda t, p=p: husid(t) - p, 0.0, 2.43) for p in (0.05, 0.95)])
    steps = [0.81 / 10.5, 0.81 / 42.5, 0.81 / 170.5]
    area = [abs(cumulative_absolute_velocity(_sine(h)) - 2.0 / math.pi * 2.43) for h in steps]
    times = [np.abs(np.array(significant_times(_sine(h))) - exact).max() for h in steps]
    for errors in (area, times):
        # a fourth of the step, a sixteenth of the error; where within a step the turns fall moves it by a factor
        assert errors[2] < errors[0] / 64.0
        assert errors[2] < 1e-4


def test_significant_times_of_all_and_of_nothing_around():
    """Zeros around a motion do not change its duration, and 0 to 100 % is where it moves."""
    motion = GroundMotion([0.0, 0.0, 0.0, 2.0, -1.0, 0.0, 0.0, 0.0], 0.5)
    bare = GroundMotion([0.0, 2.0, -1.0, 0.0], 0.5)
    assert significant_duration(motion) == pytest.approx(significant_duration(bare), rel=1e-14, abs=0.0)
    assert significant_times(motion, 1e-9, 100.0)[1] == pytest.approx(2.5, abs=1e-9)


@pytest.mark.verifies("closed form", "a blow of velocity V", within="1e-3")
def test_housner_intensity_of_a_blow():
    """A blow of velocity V has PSV = V exp(-z phi / sqrt(1 - z^2)) at all long periods: 2.4 s times that."""
    blow = GroundMotion([0.0, 1e4, 0.0], 1e-4)
    z = 0.05
    root = math.sqrt(1.0 - z * z)
    expected = 2.4 * math.exp(-z / root * math.atan2(root, z))
    # the blow lasts 2e-4 s, so that oscillators of 0.1 s see it as one within 2e-5
    assert housner_intensity(blow) == pytest.approx(expected, rel=1e-3)
    assert housner_intensity(blow, damping=0.0) == pytest.approx(2.4, rel=1e-3)


def test_normalised_measures_know_angle_and_size():
    """The ratios are PGA and p PGV over g tan(alpha)."""
    alpha = math.atan(0.25)
    assert normalised_acceleration(ZIGZAG, alpha) == pytest.approx(4.0 / g, rel=1e-14, abs=0.0)
    assert normalised_velocity(ZIGZAG, alpha, 2.0) == pytest.approx(2.0 * 0.75 * 4.0 / g, rel=1e-14, abs=0.0)


def test_table_has_names_values_and_units():
    """The table repeats the functions, with units of the SI."""
    quick = GroundMotion(ZIGZAG.acceleration, 0.05)
    table = intensity_measures(quick)
    units = {"pga": "m/s2", "pgv": "m/s", "pgd": "m", "arias": "m/s", "cav": "m/s", "d5_95": "s", "d5_75": "s"}
    assert units.items() <= {name: one.unit for name, one in table.items()}.items()
    assert table["pgv"].value == peak_ground_velocity(quick)
    assert table["d5_75"].value < table["d5_95"].value


REST = GroundMotion([0.0, 0.0], 0.1)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: significant_duration(REST), "record of zeros"),
        (lambda: significant_duration(ZIGZAG, 95.0, 5.0), "end must be"),
        (lambda: normalised_acceleration(ZIGZAG, 0.5 * math.pi), "slenderness_angle"),
        (lambda: normalised_velocity(ZIGZAG, 0.2, math.nan), "frequency_parameter"),
        (lambda: spectral_acceleration(ZIGZAG, 0.0), "period"),
        (lambda: arias_intensity(ZIGZAG, gravity=-9.8), "gravity"),
    ],
)
def test_bad_values_are_refused(call, words):
    """Zero motions have no duration; percentages, angles and periods have ranges."""
    with pytest.raises(InvalidValueError, match=words):
        call()


@pytest.mark.verifies("closed form", "c t^2 / 2 and c t^3 / 6", within="1e-14")
def test_a_ramp() -> None:
    """Under a = c t the velocity is c t^2 / 2 and the displacement c t^3 / 6 at every sample."""
    t = np.arange(11) * 0.3
    motion = GroundMotion(np.asarray(2.0 * t, dtype=np.float64), 0.3)
    np.testing.assert_allclose(ground_velocity(motion), t**2, rtol=1e-14)
    np.testing.assert_allclose(ground_displacement(motion), t**3 / 3.0, rtol=1e-14)


def test_a_zigzag() -> None:
    """One step up, one down, by hand: v = 0, 1/2, 1/2, 0 and u = 0, 1/6, 5/6, 1."""
    np.testing.assert_allclose(ground_velocity(ZIGZAG), [0.0, 0.5, 0.5, 0.0], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(ground_displacement(ZIGZAG), [0.0, 1 / 6, 5 / 6, 1.0], rtol=0.0, atol=1e-15)


@pytest.mark.verifies("order", "closed forms of a sine", within="1e-3 of a factor of 4")
def test_smooth_motions_converge() -> None:
    """Half the step, a quarter of the error: the integrals of a sampled sine are of second order."""
    errors = []
    for count in (100, 200):
        t = np.linspace(0.0, np.pi, count + 1)
        v = ground_velocity(GroundMotion(np.sin(t), float(t[1])))
        errors.append(float(np.abs(v - (1.0 - np.cos(t))).max()))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3)


def test_steps_scale() -> None:
    """Velocity grows with the step, displacement with its square, and both with the motion."""
    samples = [0.3, -1.0, 2.0, 0.1]
    one, other = GroundMotion(samples, 0.1), GroundMotion([-3.0 * a for a in samples], 0.2)
    np.testing.assert_allclose(ground_velocity(other), -6.0 * ground_velocity(one), rtol=1e-14)
    np.testing.assert_allclose(ground_displacement(other), -12.0 * ground_displacement(one), rtol=1e-14)


@pytest.mark.verifies("closed form", "extremes of pieces, by hand", within="1e-14")
@pytest.mark.parametrize(
    ("samples", "step", "velocity", "displacement"),
    [
        # a line from 3 to -1 crosses zero at 3/4 of the step: there the velocity is 9/8 h, more than 1 h at the end
        ([3.0, -1.0], 2.0, 2.25, None),
        ([1.0, 1.0], 2.0, 2.0, None),
        # from 1 to -2 in a unit step u = t^2 / 2 - t^3 / 2: the largest is 2/27 at t = 2/3, and zero at the end
        ([1.0, -2.0], 1.0, None, 2.0 / 27.0),
        ([2.0, 2.0], 1.0, None, 1.0),
        ([0.0, 0.0, 0.0], 2.0, 0.0, 0.0),
    ],
)
def test_peaks_inside_a_step(samples, step, velocity, displacement) -> None:
    """The extremes of quadratic and cubic pieces, by hand; a motion turned round has the same."""
    for sign in (1.0, -1.0):
        motion = GroundMotion([sign * a for a in samples], step)
        if velocity is not None:
            assert peak_ground_velocity(motion) == pytest.approx(velocity, rel=1e-15, abs=0.0)
        if displacement is not None:
            assert peak_ground_displacement(motion) == pytest.approx(displacement, rel=1e-14, abs=0.0)


@pytest.mark.verifies("computed anew", "a resampling a thousand times as fine", within="1e-5, and never passed")
def test_against_many_instants() -> None:
    """Over random motions the exact largest values are reached, never passed, by a fine resampling."""
    random = np.random.default_rng(3)
    for _ in range(10):
        motion = GroundMotion(random.normal(size=12), 0.1)
        t = np.linspace(0.0, 1.1, 11_001)
        fine = GroundMotion(np.interp(t, motion.time, motion.acceleration), float(t[1]))
        for largest, samples in (
            (peak_ground_velocity(motion), ground_velocity(fine)),
            (peak_ground_displacement(motion), ground_displacement(fine)),
        ):
            seen = float(np.abs(samples).max())
            assert seen <= largest * (1.0 + 1e-12)
            assert seen == pytest.approx(largest, rel=1e-5)
