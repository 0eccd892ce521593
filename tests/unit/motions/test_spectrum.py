"""Response spectra against closed forms and an independent integrator of high order."""

import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, response_spectrum
from rocking.motions.filters import compiled
from rocking.motions.integrals import quadratic_roots
from rocking.motions.spectrum import _reach, _response, phi

pytestmark = pytest.mark.verifies(room="motions and records")

JAGGED = GroundMotion(np.random.default_rng(5).standard_normal(40), 0.01)


def _histories(motion, period, damping, points):
    """Displacement, velocity and absolute acceleration, by DOP853 from sample to sample and two periods beyond."""
    w = 2.0 * math.pi / period
    ends = [*motion.acceleration, 0.0]
    state, rows = np.zeros(2), []
    for i in range(len(motion)):
        last = i == len(motion) - 1
        h = 2.0 * period if last else motion.time_step
        a, b = (0.0, 0.0) if last else (ends[i], ends[i + 1])

        def rate(t, y, a=a, b=b, h=h):
            return [y[1], -(a + (b - a) * t / h) - 2.0 * damping * w * y[1] - w * w * y[0]]

        count = 20 * points if last else points
        answer = solve_ivp(
            rate, (0.0, h), state, method="DOP853", rtol=1e-10, atol=1e-15, t_eval=np.linspace(0.0, h, count)
        )
        rows.append(answer.y)
        state = answer.y[:, -1]
    u, v = np.hstack(rows)
    return u, v, 2.0 * damping * w * v + w * w * u


@pytest.mark.verifies(
    "computed anew", "an integration of high order", within="1e-4", control="test_peaks_at_samples_only_are_rejected"
)
@pytest.mark.parametrize("period", [0.02, 0.033, 0.3])
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.4])
def test_peaks_agree_with_an_independent_integrator(period, damping):
    """Down to two steps a period, all peaks are within 0.01 % of those of a fine integration."""
    spectrum = response_spectrum(JAGGED, period, damping)
    found = [spectrum.displacement[0], spectrum.velocity[0], spectrum.absolute_acceleration[0]]
    for value, history in zip(found, _histories(JAGGED, period, damping, 400), strict=True):
        assert value == pytest.approx(np.abs(history).max(), rel=1e-4)


@pytest.mark.verifies("negative control", "peaks at samples only")
def test_peaks_at_samples_only_are_rejected():
    """Negative control: without looking inside the steps, the shortest period is wrong by more than 1 %."""
    history = _histories(JAGGED, 0.02, 0.05, 101)[0][: 101 * (len(JAGGED) - 1)]
    at_samples = np.abs(history[::101]).max()
    assert at_samples < 0.99 * response_spectrum(JAGGED, 0.02, 0.05).displacement[0]


@pytest.mark.verifies("closed form", "1 + exp(-pi z / sqrt(1 - z^2))", within="1e-4")
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.2])
def test_step_load(damping):
    """A sudden constant acceleration has the overshoot 1 + exp(-pi z / sqrt(1 - z^2)): 2 without damping."""
    step = GroundMotion(np.ones(400), 0.01)
    expected = 1.0 + math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2))
    found = response_spectrum(step, [0.02, 0.1, 0.7, 2.0], damping).pseudo_acceleration
    np.testing.assert_allclose(found, expected, rtol=1e-4)


@pytest.mark.verifies("closed form", "1 / (2 z), and sqrt(1 + 4 z^2) times it", within="1e-5")
def test_resonance():
    """In steady resonance Sd w^2 is 1 / (2 z), and the true acceleration is larger by sqrt(1 + 4 z^2)."""
    z, period = 0.1, 0.5
    t = np.arange(60_001) * period / 2000.0
    spectrum = response_spectrum(GroundMotion(np.sin(2.0 * np.pi * t / period), period / 2000.0), period, z)
    # 30 periods: what is left of the transient is exp(-2 pi z 30) = 7e-9
    assert spectrum.pseudo_acceleration[0] == pytest.approx(0.5 / z, rel=1e-5)
    assert spectrum.absolute_acceleration[0] == pytest.approx(0.5 / z * math.sqrt(1.0 + 4.0 * z * z), rel=1e-5)
    assert spectrum.pseudo_velocity[0] == pytest.approx(spectrum.displacement[0] * 4.0 * math.pi, rel=1e-14, abs=0.0)


@pytest.mark.verifies("closed form", "the residual amplitude of a half sine", within="1e-4")
@pytest.mark.parametrize("ratio", [2.5, 4.0, 20.0])
def test_half_sine_leaves_its_residual(ratio):
    """After a half sine of duration d the amplitude is (T/d) cos(pi d/T) / ((T/2d)^2 - 1), of free swinging."""
    t = np.linspace(0.0, 1.0, 2001)
    pulse = GroundMotion(np.sin(np.pi * t), t[1])
    expected = ratio * math.cos(math.pi / ratio) / ((0.5 * ratio) ** 2 - 1.0)
    assert response_spectrum(pulse, ratio, 0.0).pseudo_acceleration[0] == pytest.approx(expected, rel=1e-4)
    within_record = np.abs(_histories(GroundMotion(pulse.acceleration[::100], 0.05), ratio, 0.0, 5)[0][:100]).max()
    assert within_record * (2.0 * math.pi / ratio) ** 2 < 0.99 * expected


def test_limits_of_short_and_long_periods():
    """A rigid oscillator feels the peak of the ground; a very soft one stays where it was."""
    smooth = GroundMotion([0.0, 1.0, 3.0, 1.0, -1.0, -3.0, -1.0, 0.0], 1.0)
    stiff = response_spectrum(smooth, 0.05, 0.05)
    # the corner at the peak leaves a ripple of the order T / (2 pi step)
    assert stiff.pseudo_acceleration[0] == pytest.approx(3.0, rel=0.02)
    assert stiff.absolute_acceleration[0] == pytest.approx(3.0, rel=0.02)
    # velocity ends at zero, so that the displacement stays: 0.5 t^2 sums by hand to 16 at the end
    assert response_spectrum(smooth, 1e6, 0.05).displacement[0] == pytest.approx(_last_displacement(smooth), rel=1e-4)


def _last_displacement(motion):
    """Second integral by moments: sum of the areas of triangles times the time that is left."""
    areas = motion.acceleration * motion.time_step
    return float(np.sum(areas * (motion.duration - motion.time)))


def test_zeros_after_the_record_change_nothing_at_all():
    """Half a period of free swinging is enough: a longer tail of zeros gives the same spectrum."""
    bare = GroundMotion([0.0, 1.0, -2.0, 0.5, 0.0], 0.05)
    longer = GroundMotion([*bare.acceleration, *np.zeros(400)], 0.05)
    periods = [0.1, 0.6, 3.0]
    one, two = response_spectrum(bare, periods), response_spectrum(longer, periods)
    for name in ("displacement", "velocity", "absolute_acceleration"):
        np.testing.assert_allclose(getattr(one, name), getattr(two, name), rtol=1e-4)


def test_pseudo_and_true_acceleration_differ_with_damping():
    """Without damping PSA is Sa; with 40 % it is not, and the names say which is which."""
    free, damped = response_spectrum(JAGGED, [0.1, 0.5], 0.0), response_spectrum(JAGGED, [0.1, 0.5], 0.4)
    np.testing.assert_allclose(free.pseudo_acceleration, free.absolute_acceleration, rtol=1e-12)
    assert (damped.absolute_acceleration > 1.02 * damped.pseudo_acceleration).all()


@cache  # with and without the compiled module
def _per_period(motion, period, damping):
    """Peaks of one oscillator: every part of every step is looked at, none is passed over."""
    w = 2.0 * math.pi / period
    s = complex(-damping * w, w * math.sqrt(1.0 - damping * damping))
    a, h, states = motion.acceleration, motion.time_step, np.zeros(len(motion), complex)
    first, second = phi(s * h)
    for k in range(a.size - 1):
        states[k + 1] = np.exp(s * h) * states[k] - h * ((first - second) * a[k] + second * a[k + 1])
    parts, rise, best = math.ceil(36 * h / period), np.diff(a), np.zeros(3)
    left = _responses(states[:-1], a[:-1], s)
    for k in range(1, parts + 1):
        t = k * h / parts
        first, second = phi(s * t)
        inside = np.exp(s * t) * states[:-1] - t * first * a[:-1] - (t * t / h * second) * rise
        right = _responses(inside, a[:-1] + k / parts * rise, s)
        best = np.maximum(best, [_cubic_peak(*pair, h / parts) for pair in zip(left, right, strict=True)])
        left = right
    free = states[-1] * np.exp(s * np.linspace(0.0, math.pi / s.imag, 288))
    return np.maximum(best, [np.abs(value).max() for value, _ in _responses(free, np.zeros(288), s)])


def _responses(z, ground, s):
    """Displacement, velocity and absolute acceleration, each with its rate, from the complex state u' - conj(s) u."""
    u = z.imag / s.imag
    v = z.real + s.real * u
    absolute = 2.0 * s.real * v - abs(s) ** 2 * u
    return [(u, v), (v, absolute - ground), (absolute, 2.0 * s.real * (absolute - ground) - abs(s) ** 2 * v)]


def _cubic_peak(left, right, step):
    """Largest magnitude of all cubics through values and slopes at both ends."""
    (y, d), (z, e) = ((side[0], step * side[1]) for side in (left, right))
    rise = z - y
    best = max(np.abs(y).max(), np.abs(z).max())
    for root in quadratic_roots(3.0 * (d + e - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * d - e), d):
        t = np.where((root > 0.0) & (root < 1.0), root, 0.0)
        best = max(best, np.abs(y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise)))).max())
    return best


LONG = GroundMotion(
    np.convolve(np.random.default_rng(8).standard_normal(700), np.ones(9) / 9.0, mode="same") * np.hanning(700), 0.01
)


@pytest.mark.verifies(
    "computed anew",
    "a loop over periods and all steps",
    within="1e-12",
    control="test_passing_over_too_much_is_noticed",
)
@pytest.mark.parametrize("motion", [JAGGED, LONG, GroundMotion([0.0, 3.0], 0.02), GroundMotion(np.ones(50), 0.1)])
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.6])
@pytest.mark.parametrize("module", ["compiled", "plain"])
def test_all_periods_at_once_are_each_period_by_itself(motion, damping, module, monkeypatch):
    """The steps that are passed over hold no peak: a loop over periods and all steps agrees to 1e-12."""
    if module == "plain":
        monkeypatch.setattr("rocking.motions.spectrum.compiled", lambda: None)
    elif compiled() is None:
        pytest.skip("without the compiled module")
    periods = motion.time_step * np.geomspace(0.07, 600.0, 9)
    found = response_spectrum(motion, periods, damping)
    wanted = np.array([_per_period(motion, period, damping) for period in periods]).T
    for name, values in zip(("displacement", "velocity", "absolute_acceleration"), wanted, strict=True):
        np.testing.assert_allclose(getattr(found, name), values, rtol=1e-12)


@pytest.mark.verifies("negative control", "a bound of 0.8 of what a step can hold")
def test_passing_over_too_much_is_noticed(monkeypatch):
    """Negative control: with the bound of what a step can hold cut to 80 %, peaks are missed by far over 1e-12."""
    if compiled() is None:
        pytest.skip("without the compiled module no step is passed over")
    monkeypatch.setattr("rocking.motions.spectrum.MARGIN", 0.8)
    periods = LONG.time_step * np.geomspace(2.0, 600.0, 40)
    found = response_spectrum(LONG, periods, 0.05).displacement
    wanted = np.array([_per_period(LONG, period, 0.05)[0] for period in periods])
    assert np.abs(found / wanted - 1.0).max() > 1e-6


def test_phi_functions_on_both_branches():
    """At 1 these are e - 1 and e - 2, just as the series says just below; near zero 1 + x/2 and 1/2 + x/6."""
    for x in (1.0, 1.0 + 1e-12):
        assert phi(x)[0] == pytest.approx(math.e - 1.0, rel=1e-11, abs=0.0)
        assert phi(x)[1] == pytest.approx(math.e - 2.0, rel=1e-11, abs=0.0)
    assert phi(1e-8j)[0] == pytest.approx(1.0 + 0.5e-8j, abs=1e-16)
    assert phi(1e-8j)[1] == pytest.approx(0.5 + 1e-8j / 6.0, abs=1e-16)


def test_bad_values_are_refused():
    """Periods and damping have ranges, and the errors name them."""
    for periods in ([0.1, -1.0], [], [math.nan], [[0.1]], 1e-5):
        with pytest.raises(InvalidValueError, match="periods"):
            response_spectrum(JAGGED, periods)
    for damping in (-0.1, 1.0, 5.0, math.inf):
        with pytest.raises(InvalidValueError, match="damping"):
            response_spectrum(JAGGED, 0.1, damping)


def test_no_phase_goes_beyond_the_reach():
    """Of states of magnitude one, some phase has the largest response and none a larger one, for each response."""
    rates, most = np.array([-0.4 + 3.0j, -0.01 + 70.0j, -5.0 + 2.0j]), np.zeros((3, 3))
    for phase in np.linspace(0.0, 2.0 * np.pi, 4001):
        found = _response(np.full(3, np.exp(1j * phase)), np.zeros(3), rates)
        most = np.maximum(most, [np.abs(value) for value, _ in found])
    # 4000 phases miss the top by (pi / 4000)^2 / 2
    np.testing.assert_allclose(most, _reach(rates), rtol=4e-7)


def test_quadratic_roots() -> None:
    """Both roots without cancellation, even 1e-12 beside 1; complex, linear and empty ones are not finite."""
    second, first = np.array([1.0, 1.0, 0.0]), np.array([-1.0 - 1e-12, 0.0, 2.0])
    one, other = quadratic_roots(second, first, np.array([1e-12, 1.0, 3.0]))
    assert sorted([one[0], other[0]]) == pytest.approx([1e-12, 1.0], rel=1e-14, abs=0.0)
    assert np.isnan(one[1])
    assert np.isnan(other[1])
    assert not np.isfinite(one[2])
    assert other[2] == -1.5
