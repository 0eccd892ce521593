"""Parts of the identification: sequences, shaken half cycles and sounds by closed forms, differences, invariants."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks import identification_forced

import rocking as rk
from rocking.identification import association, forced, forced_friction, forced_start, state_space
from rocking.identification.design import peaks_bound
from rocking.identification.forced_half_cycles import Flights
from rocking.identification.forced_model import HALF, MEAN, SIZE
from rocking.identification.posterior import Knowledge
from rocking.identification.readers import rocking_sequence, sound
from rocking.identification.results import IntervalEstimate
from rocking.identification.series import _peaks

pytestmark = pytest.mark.verifies(room="evidence")
BODY = rk.Block(width=0.2, height=1.0, mass=300.0, centre=(0.106, 0.48))
KNOWN = Knowledge.checked(BODY, 0.02, (0.002, 0.004), 0.05, trend=True, damping=False, first="right")


def lawful(count, ln_r=(-0.12, -0.12), y=0.8, p=3.0):
    """Times of impacts of a slender body: T = (2 / p) artanh y, y falls at every impact; r by the foot that it hits."""
    found, ln_y = [0.0], math.log(y)
    for n in range(count - 1):
        found.append(found[-1] + 2.0 / p * math.atanh(math.exp(ln_y)))
        ln_y += ln_r[n % 2]
    return np.array(found)


# ---- sequences ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("p", [2.0, 3.0])
@pytest.mark.parametrize(("falls", "missed"), [((-0.1, -0.1), 0), ((-0.16, -0.06), 2)])
def test_the_next_impact_of_a_lawful_sequence(p, falls, missed):
    """Where the law puts it, if y begins at what is assumed of it: sides alike, and unlike with two impacts missed."""
    times = lawful(12, falls, rocking_sequence._MODERATE, p)
    at, span = rocking_sequence.next_impact(times[:8], np.arange(8), 8 + missed)
    assert at == pytest.approx(times[8 + missed], rel=1e-9)
    assert span == pytest.approx(times[8 + missed] - times[7 + missed], rel=1e-9)
    assert np.isnan(rocking_sequence.next_impact(times[:2], np.arange(2), 2)[0])  # of one interval nothing follows


def test_the_misfit_of_a_row_does_not_hang_on_the_others():
    """The first arrangement of times has one misfit, alone and beside others; that of the law itself is small."""
    times, orders = lawful(10), np.arange(10)
    other = np.where(orders % 2 == 1, times + 0.02, times)
    other[-1] += 0.1
    beside = rocking_sequence.law_misfit(np.stack([times, other, 1.3 * other]), orders, loose=0.01)
    alone = rocking_sequence.law_misfit(times[None], orders, loose=0.01)
    assert beside[0] == pytest.approx(alone[0], rel=1e-9)
    assert beside[0] < 1.0 < beside[1]


def test_the_variance_of_the_first_speed_is_that_of_two_times():
    """ln y of y = tanh(p T / 2), T between two times with noise s: twice (d ln y / dT)^2 s^2 beside the prior."""
    times, noise, p = lawful(6), 2e-3, 3.0
    quiet, loud = (
        association._started(times, each, (math.log(p), 0.05), (0.0, 0.02)).covariance for each in (0.0, noise)
    )
    beam = association._started(times, noise, (math.log(p), 0.05), (0.0, 0.02))
    whole = beam.number == 1
    gap = times[beam.last] - times[np.argmax(beam.of_click == 0, axis=1)]
    step = 1e-6
    slope = (np.log(np.tanh(0.5 * p * (gap + step))) - np.log(np.tanh(0.5 * p * (gap - step)))) / (2.0 * step)
    added = (loud - quiet)[whole]
    np.testing.assert_allclose(added[:, 1, 1], 2.0 * (slope * noise)[whole] ** 2, rtol=1e-6)
    np.testing.assert_allclose(added[:, 0, 1], slope[whole] * noise**2, rtol=1e-6)
    np.testing.assert_allclose(added[:, 0, 0], noise**2, rtol=1e-12)


def test_unknowns_lead_to_the_times_from_which_they_were_found():
    """`reached` is the inverse of `path`, with sides, tilt, trend and another p."""
    rng = np.random.default_rng(2)
    mean, deviation = np.zeros(len(state_space.SHARED)), np.full(len(state_space.SHARED), 0.02)
    alpha, p = (0.2, 0.17), (3.0, 3.2)
    mean[state_space.SPEED] = math.log(0.7 * 3.0 * 2.0 * math.sin(0.1))
    mean[state_space.MEAN] = -0.1
    deviation[state_space.DAMPING] = 0.0
    model = state_space.Model(np.arange(7) % 2, alpha, p, mean, deviation, middle=-1.0)
    u, scatter = rng.normal(size=(3, model.size)), np.full(3, 0.03)
    times = model.path(u, scatter).times
    start = u.copy()
    start[:, len(state_space.SHARED) :] = 0.0
    start[:, [state_space.START, state_space.SPEED]] = 0.0
    np.testing.assert_allclose(model.unknowns_at_times(start, scatter, times), u, atol=1e-7)


def test_the_bound_of_two_peaks_is_error_propagation():
    """r is the ratio of y = sqrt(1 - (1 - f)^2) after an impact and before it, for peaks f over alpha."""
    before, after, noise, step = 0.6, 0.35, 0.01, 1e-6

    def ln_r(f, g):
        return 0.5 * (math.log(1.0 - (1.0 - g) ** 2) - math.log(1.0 - (1.0 - f) ** 2))

    by_before = (ln_r(before + step, after) - ln_r(before - step, after)) / (2.0 * step)
    by_after = (ln_r(before, after + step) - ln_r(before, after - step)) / (2.0 * step)
    assert peaks_bound(before, after, noise) == pytest.approx(noise * math.hypot(by_before, by_after), rel=1e-8)


def test_turns_of_a_series_are_its_extremes():
    """1 - cos from 0 to 3 pi has a maximum and a minimum between its ends; where it begins and ends is no turn."""
    t = np.linspace(0.0, 3.0 * np.pi, 301)
    for values in (1.0 - np.cos(t), np.cos(t)):
        assert _peaks(values, 0.1).tolist() == [100, 200]
    assert _peaks(1.0 - np.cos(t), 2.1).tolist() == []


def test_an_impact_loses_energy_a_priori():
    """The prior of ln r holds what was measured: its mean is below 0 and all measured means are within 2 deviations."""
    model = KNOWN.model(KNOWN.sides(4), 0.0, np.full(4, -1.0), KNOWN.frequencies[0])
    mean, deviation = model.mean[state_space.MEAN], model.deviation[state_space.MEAN]
    assert mean < 0.0
    # published means of r from 0.81 to 0.99: the tables of Mao et al. (2024)
    assert mean - 2.0 * deviation < math.log(0.81) < math.log(0.99) < mean + deviation


# ---- shaken half cycles ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def shaken():
    """What is known of a body that rocks under a strong motion, and the first fit of its half cycles."""
    case = identification_forced.shaken(0)
    known = Knowledge.checked(case["body"], 0.02, (0.002, 0.004), 0.05, trend=True, damping=False, first="right")
    problem = forced_start.problem_of(case["series"], known, case["motion"], (case["clock"], 0.01))
    problem, fit, _ = forced_start.first_fit(problem, problem.mean)
    return replace(problem, middle=-0.5), fit.x


@pytest.mark.verifies("computed anew", "two simulations whose coefficients differ by 1e-4", within="2%")
@pytest.mark.parametrize(("strength", "is_lost"), [(3.0, True), (4.0, False)])
def test_the_predictable_time_by_the_tangent(strength, is_lost):
    """Two simulations differ by 10 % of the peak at this time, or never; 2 %, since 10 % is not a small difference."""
    time = np.arange(0.0, 20.0, 0.01)
    motion = rk.GroundMotion(strength * np.sin(16.0 * time) * np.sin(0.77 * time + 0.3), 0.01)
    r, x = {"right": 0.93, "left": 0.9}, np.zeros(SIZE)
    x[MEAN], x[HALF] = 0.5 * math.log(0.93 * 0.9), 0.5 * math.log(0.93 / 0.9)

    def sides(sign, *_):
        side = BODY.side("right" if sign > 0.0 else "left")
        return side.slenderness_angle, side.frequency_parameter, None

    problem = SimpleNamespace(prior=SimpleNamespace(body=BODY), motion=motion, sides=sides)
    own = forced._predictable_time(problem, x)
    first, second = (rk.simulate(BODY, motion, {foot: f * r[foot] for foot in r}) for f in (1.0, 1.0 - 1e-4))
    apart = first.time[np.abs(first.rotation - second.rotation) > 0.1 * np.abs(first.rotation).max()]
    assert apart.size > 0 if is_lost else apart.size == 0
    assert own == pytest.approx(apart[0], rel=0.02) if is_lost else math.isnan(own)


def dense(problem, terms):
    """Residuals of all terms, and slopes by all unknowns, a row each."""
    size = terms.times[1].shape[1]
    residuals, rows = [], []
    for residual, by in terms.samples:
        whole = np.zeros((residual.size, size))
        whole[:, :SIZE] = by[:, :SIZE]
        for n, k in enumerate(terms.owners):
            for column in range(2):
                if SIZE + 2 * k + column < size:
                    whole[n, SIZE + 2 * k + column] = by[n, SIZE + column]
                    if k > 0:
                        whole[n, SIZE + 2 * k - 2 + column] = by[n, SIZE + 2 + column]
        residuals.append(residual)
        rows.append(whole)
    return np.concatenate([*residuals, terms.times[0], terms.draws[0]]), np.concatenate([
        *rows, terms.times[1], terms.draws[1]
    ])  # fmt: skip


# of feet that slide, slopes leave out what half cycles before the last one do
@pytest.mark.slow
@pytest.mark.parametrize(("friction", "within"), [(None, 2e-3), (0.3, 0.1)])
def test_slopes_of_a_shaken_body_are_its_differences(shaken, friction, within):
    """By every unknown, of samples, times and ln r: feet that hold, and feet that slide, which the one before moves."""
    problem, x = shaken
    if friction is not None:
        problem, x = forced_friction.sliding(problem, math.log(friction), 0.5), x.copy()
        x[forced_friction.FRICTION] = math.log(friction)
    slopes, step = dense(problem, problem.terms(x))[1], 1e-7
    assert problem.excursions.joined.sum() > 5
    for n in range(x.size):
        ends = []
        for moved in (x.copy(), x.copy()):
            moved[n] += step * (1.0 - 2.0 * len(ends))
            ends.append(dense(problem, problem.terms(moved))[0])
        numeric = (ends[1] - ends[0]) / (2.0 * step)  # residuals fall where what is computed rises
        largest = max(np.abs(numeric).max(), 1e-3)
        np.testing.assert_allclose(slopes[:, n], numeric, rtol=0.0, atol=within * largest, err_msg=f"unknown {n}")


def test_the_frequency_parameter_is_that_of_the_sizes_that_were_found():
    """p of widths and heights at the fit, by R over each foot: p falls as 1 / sqrt(R) where the body is larger."""
    case = identification_forced.shaken(0)
    known = Knowledge.checked(case["body"], 0.02, (0.002, 0.004), 0.05, trend=False, damping=False, first="right")
    found = forced.fit_forced(case["series"], known, case["motion"], (case["clock"], 0.01))
    unknown = IntervalEstimate(math.nan, math.nan, math.nan)
    answer = forced.answer(found, unknown, (), found)
    across, up = (math.exp(found.fit.x[each]) for each in (forced.WIDTH, forced.HEIGHT))
    square = 1.0
    for foot in ("right", "left"):
        side = case["body"].side(foot)
        larger = math.hypot(across * side.half_width, up * side.centre_height) / side.semi_diagonal
        square *= side.frequency_parameter / math.sqrt(larger)
        assert abs(larger - 1.0) > 5e-3
    assert answer.frequency_parameter.value == pytest.approx(math.sqrt(square), rel=3e-4)


def test_between_steps_the_energy_is_kept():
    """Cubics: rotation and velocity of the steps at the steps, and between them the energy of free rocking."""
    motion = rk.GroundMotion(np.zeros(400), 0.01)
    state = np.zeros(1), np.zeros(1), np.array([0.5])
    body = np.array([0.2]), np.array([3.5]), np.array([0.55])
    coarse = Flights.integrated(motion, state, body, np.ones(1), np.array([0.6]))
    count, which = len(coarse.rotation) - 1, np.zeros(len(coarse.rotation) - 1, dtype=np.int64)
    h = coarse.step[0]
    rotation, velocity = coarse.at(h * np.arange(1, count + 1) * (1.0 - 1e-12), which)
    np.testing.assert_allclose(rotation, coarse.rotation[1:, 0], atol=1e-12)
    np.testing.assert_allclose(velocity, coarse.velocity[1:, 0], atol=1e-9)
    # free rocking of a slender body between the steps, theta'' = -p^2 sin(alpha - theta), by its energy
    middle, turning = coarse.at(h * (np.arange(count) + 0.5), which)
    energy = 0.5 * turning**2 + 3.5**2 * np.cos(0.2 - middle)
    np.testing.assert_allclose(energy, 0.125 + 3.5**2 * math.cos(0.2), atol=1e-5)


def test_friction_of_which_nothing_is_told_is_what_was_tried():
    """Evidence that is alike from 0.2 to 0.5, and beyond up to the largest: uniform in the logarithm."""
    tried = {math.log(each): (None, -7.0) for each in (0.2, 0.3, 0.4, 0.5)}
    interval, lowest, above = forced_friction._quantiles(tried)
    span = math.log(forced_friction._MOST / 0.2)
    wanted = [0.2 * math.exp(level * span) for level in forced_friction.LEVELS]
    assert sorted((interval.low, interval.value, interval.high)) == pytest.approx(sorted(wanted), rel=1e-3)
    assert lowest == pytest.approx(0.2, rel=1e-9)
    assert above == pytest.approx(math.log(forced_friction._MOST / 0.5) / span, rel=1e-3)


@pytest.mark.verifies("repeated sampling", "4,000 fits to white noise", within="3 %")
def test_noise_about_a_fit_has_its_degrees_of_freedom():
    """Lines through 15 samples of each of 4 half cycles take 8 of 60 degrees: the variance is the sum over 52."""
    random, line = np.random.default_rng(4), np.column_stack([np.ones(15), np.arange(15.0)])
    off = np.eye(15) - line @ np.linalg.pinv(line)
    problem = SimpleNamespace(kinds=(0,), excursions=SimpleNamespace(sign=np.ones(4)))
    found = []
    for _ in range(4000):
        rest = (random.normal(size=(4, 15)) @ off).ravel()
        fit = SimpleNamespace(terms=SimpleNamespace(samples=[(rest, None)]))
        scatter = forced_start.deviations(problem, fit)[0]
        found.append(scatter**2 / forced_start.correlation(rest))
    assert np.mean(found) == pytest.approx(1.0, rel=0.03)


# ---- sounds ---------------------------------------------------------------------------------------------------------


def test_noise_is_not_like_the_sum_of_other_noise():
    """Correlations of independent noise are of 1 / sqrt(n), and of one click in all of them are 1."""
    random, rate, places = np.random.default_rng(6), 8000.0, np.array([1000, 3000, 5000, 7000])
    noise = random.normal(size=9000)
    size = int(sound.SOUND.long_after * rate) + int(sound.SOUND.before * rate)
    assert np.abs(sound._matches(noise, rate, places, 0)[1]).max() < 5.0 / math.sqrt(size)
    click, alike = random.normal(size=size), np.zeros(9000)
    for k, place in enumerate(places):
        alike[place - int(sound.SOUND.before * rate) :][:size] = (1.0 + k) * click
    np.testing.assert_allclose(sound._matches(alike, rate, places, 0)[1], 1.0, rtol=1e-9)


@pytest.mark.parametrize("late", [0.0, 0.01, -0.008])
def test_an_impact_that_no_click_told_is_found_by_its_foot(late):
    """Each foot has its click, weaker from impact to impact; the ninth is sought by those before it: to a sample."""
    random, rate = np.random.default_rng(8), 8000.0
    times = 0.5 + lawful(9, y=rocking_sequence._MODERATE)
    times[-1] += late
    heard, since = 0.01 * random.normal(size=int((times[-1] + 1.0) * rate)), np.arange(320) / rate
    clicks = [random.normal(size=since.size) * np.exp(-since / 0.008) for _ in range(2)]
    for n, time in enumerate(times):
        heard[round(time * rate) :][: since.size] += 0.85**n * clicks[n % 2]
    at, sure = sound._impact(heard, rate, times[:8], np.arange(8), 8)
    assert at == pytest.approx(times[8], abs=1.5 / rate)
    assert sure > 5.0


@pytest.mark.parametrize("lead", [0.0, 10.0, 30.0])
def test_clicks_are_sharpened_wherever_they_are_in_a_sound(lead):
    """Sounding for 10 ms in a white noise, at a rate whose windows are odd: loud within 4 ms, at the end as at once."""
    random, rate = np.random.default_rng(8), 22050.0
    times, since = lead + np.array([0.6, 1.1, 1.5, 1.8]), np.arange(1300) / 22050.0
    heard = 0.02 * random.normal(size=int((times[-1] + 1.0) * rate))
    for time in times:
        heard[round(time * rate) :][: since.size] += np.sin(3000.0 * np.pi * since) * np.exp(-since / 0.01)
    power = sound.sharpened(heard, rate, times)[0] ** 2
    off = np.arange(heard.size) / rate - times[:, None]
    near, clear = ((off > -0.002) & (off < 0.004)).any(axis=0), ~((off > -0.1) & (off < 0.2)).any(axis=0)
    assert power[near].mean() > 50.0 * power[clear].mean()
