"""Long-run dynamics against independent programs: Taylor series of 80 bits and DOP853, without common code.

Amplitudes are a / (g tan alpha) of a rectangle, or a / (g alpha) of a slender body; frequencies over p; H Housner,
K KED.
"""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking import Block, MassPoints, simulate
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.motions.pulse import Sinusoids
from rocking.outcome import UNCOUNTED, Outcome
from rocking.studies.longrun.attractors import KINDS, diagram, start_states
from rocking.studies.longrun.basins import (
    basin_stability,
    box_dimension,
    cells,
    checked_ends,
    ends_of,
    uncertainty_exponent,
)
from rocking.studies.longrun.continuation import bifurcation_curve, branch_off, continue_orbit
from rocking.studies.longrun.exponents import lyapunov_exponents
from rocking.studies.longrun.orbits import OrbitNotFoundError, find_orbit, slender_orbit, symmetric_orbit
from rocking.studies.longrun.study import Cells, LongRunHistories
from rocking.studies.longrun.system import Harmonic, HarmonicRocking, Numerics, over_impacts, over_periods
from rocking.studies.longrun.thresholds import slender_thresholds

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")
ANYTHING = (0.0, 100.0)
LEANING = MassPoints([[-0.48, 0.0], [0.52, 0.0], [0.5, 4.0], [-0.5, 4.0]], [1.0] * 4, feet=(-0.48, 0.52))

# slenderness, model, frequency: fold, pitchfork, period doublings of the 2-cycle and the 4-cycle; rounded to 9 digits
BRANCHES = {
    (2, "H", 2): (0.365698905, 2.387388435, 2.926390467, 2.986533874),
    (2, "K", 2): (0.195663199, 2.500336996, 3.030085334, 3.079036371),
    (2, "H", 3): (0.392784733, 6.579864832, 7.877147613, 7.972296892),
    (2, "K", 3): (0.211001362, 7.279194891, 8.371502516, 8.433038420),
    (2, "H", 5): (0.409328696, 23.116019009, 23.972022488, 24.075931213),
    (2, "K", 5): (0.220460592, 25.492878862, 25.144905812, 25.181879185),
    (4, "H", 2): (0.098769111, 2.259646782, 2.778527103, 2.827840798),
    (4, "K", 2): (0.057908574, 2.266370833, 2.784943247, 2.833227286),
    (4, "H", 3): (0.106163531, 5.872490435, 7.573468438, 7.679362275),
    (4, "K", 3): (0.062259720, 5.921191045, 7.613923359, 7.716456839),
    (4, "H", 5): (0.110727090, 20.324938470, 23.980808150, 24.095017936),
    (4, "K", 5): (0.064946846, 20.741156173, 24.111797427, 24.216619531),
    (8, "H", 2): (0.025079195, 2.196396393, 2.704207681, 2.752481747),
    (8, "K", 2): (0.015612403, 2.196776068, 2.704574309, 2.752785231),
    (8, "H", 3): (0.026934546, 5.478896915, 7.249761135, 7.368512281),
    (8, "K", 3): (0.016767655, 5.481517441, 7.252249199, 7.370791690),
    (8, "H", 5): (0.028080254, 16.759462433, 23.085940847, 23.257323535),
    (8, "K", 5): (0.017481069, 16.782177349, 23.096955272, 23.267511856),
    (1, "H", 2): (0.99422105088, 1.87532905957, 2.41041716024, 2.47835096824),
    (1, "K", 2): (0.51766354818, 2.85787691869, 3.28506700548, 3.33238266407),
}
MODELS = {"H": "housner", "K": "ked"}


def system_of(slenderness, amplitude, frequency, restitution, **options):
    """Return a rectangle under harmonic ground motion."""
    body = Block(width=1.0, height=float(slenderness))
    return HarmonicRocking.of_ratios(body, amplitude, frequency, restitution=restitution, **options)


def grid(phases, speeds):
    """Return all combinations of phases and speeds, shape (2, combinations)."""
    return np.stack(np.meshgrid(phases, speeds, indexing="ij")).reshape(2, -1)


def is_kind(kind):
    """Return a test of the kind of a bifurcation."""
    return lambda item: item.kind == kind


def cascade(system, doublings):
    """Return fold, pitchfork and period doublings of the symmetric orbit."""
    orbit = symmetric_orbit(system)
    fold = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold")).first("fold")
    pitchfork = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork")).first("pitchfork")
    bifurcations = [fold, pitchfork]
    for step in (0.03, 0.01, 0.003, 0.001)[:doublings]:
        branch = branch_off(bifurcations[-1], ANYTHING, step=step, stop=is_kind("period doubling"))
        bifurcations.append(branch.first("period doubling"))
    return bifurcations


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="6e-10")
@pytest.mark.parametrize("case", BRANCHES)
def test_bifurcations_of_the_symmetric_branch(case):
    """Fold, pitchfork and two period doublings to the digits of the table, also where the pitchfork is subcritical."""
    slenderness, model, frequency = case
    amplitude = {1: 1.6}.get(slenderness, 1.2 if frequency < 3 else 3.0)
    values = [item.value for item in cascade(system_of(slenderness, amplitude, frequency, MODELS[model]), 2)]
    assert values == pytest.approx(BRANCHES[case], abs=6e-10)


@pytest.mark.verifies("negative control", "the branches of another restitution model")
def test_the_other_model_is_another_branch():
    """Negative control: with KED's coefficient the table of Housner is rejected by every column."""
    values = np.array([item.value for item in cascade(system_of(2, 1.2, 2, "ked"), 2)])
    assert np.abs(values / BRANCHES[2, "H", 2] - 1.0).min() > 0.02


@pytest.mark.verifies("computed anew", "independent code of 40 digits", within="1e-9")
def test_doubling_cascade_of_a_slender_body():
    """Period doublings of 2-, 4-, 8- and 16-cycles; their ratios approach Feigenbaum's 4.6692."""
    values = [item.value for item in cascade(system_of(4, 1.5, 2.0, 0.5, linear=True), 4)][1:]
    expected = (
        1.827271179103310924,
        2.312850976204278652,
        2.394371332179993847,
        2.411422145578383563,
        2.415057078385863019,
    )
    assert values == pytest.approx(expected, abs=1e-9)
    gaps = np.diff(values[1:])
    assert gaps[:-1] / gaps[1:] == pytest.approx([4.781, 4.691], abs=1e-3)


@pytest.mark.verifies("computed anew", "independent code of 40 digits", within="1e-9")
def test_the_cascade_in_one_call():
    """The branches of one call, and the orbits of a branch at a value, from below its fold to beyond its end."""
    system = system_of(4, 1.2, 2.0, 0.5, linear=True)
    options = {"limits": (0.05, 2.6), "restitution": 0.5, "doublings": 3, "points": 16, "linear": True}
    branches = rk.periodic_orbits(system.body, system.excitation, **options)
    kinds = branches["branch_point"].values
    values = branches["amplitude_ratio"].values[(kinds > 1) & (kinds < 4)]
    cascade = (1.827271179103310924, 2.312850976204278652, 2.394371332179993847, 2.411422145578383563)
    assert values == pytest.approx(cascade, abs=1e-9)
    branch = continue_orbit(symmetric_orbit(system), (0.0, 2.0), increasing=False)
    upper, lower = branch.at(1.1)
    assert (upper.system.amplitude_ratio, lower.system.amplitude_ratio) == pytest.approx((1.1, 1.1), rel=1e-12)
    assert upper.speed == pytest.approx(symmetric_orbit(upper.system).speed, rel=1e-12)
    assert upper.is_stable
    assert not lower.is_stable
    assert branch.at(0.6) == []


@pytest.mark.verifies("computed anew", "independent code of 40 digits", within="1e-9")
@pytest.mark.parametrize(
    ("amplitude", "frequency", "restitution"),
    [
        (2.160498200830855325, 2, 0.9),
        (3.351522505087346245, 3, 0.5),
        (5.254401379660497995, 3, 0.9),
        (9.523233868447443737, 4, 0.9),
    ],
)
def test_pitchforks_of_slender_bodies(amplitude, frequency, restitution):
    """Loss of symmetry of slender bodies, by 40-digit code."""
    orbit = symmetric_orbit(system_of(4, 1.5, frequency, restitution, linear=True))
    branch = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork"))
    assert branch.first("pitchfork").value == pytest.approx(amplitude, abs=1e-9)


def grazing_of_a_slender_body(frequency, restitution):
    """Return the amplitude at which the path of the symmetric orbit touches zero rotation between its impacts.

    x = 1 + (G sin f - 1) cosh t + (v - W G cos f) sinh t - G sin(W t + f) with G = A / (1 + W^2), up to the sign of the
    forcing: x and x' at the touch, x at the next impact, and its speed v / r, are four equations for A, f, v and the
    time of the touch, solved to 40 digits.
    """
    with mp.workdps(40):
        w, r = mp.mpf(frequency), mp.mpf(restitution)

        def path(t, amplitude, f, v):
            g = amplitude / (1 + w * w)
            a, b = g * mp.sin(f) - 1, v + g * w * mp.cos(f)
            x = 1 + a * mp.cosh(t) + b * mp.sinh(t) - g * mp.sin(w * t + f)
            return x, a * mp.sinh(t) + b * mp.cosh(t) - g * w * mp.cos(w * t + f)

        def equations(amplitude, f, v, touch):
            x, speed = path(mp.pi / w, amplitude, f, v)
            return [x, speed + v / r, *path(touch, amplitude, f, v)]

        return float(mp.findroot(equations, (1.23, 0.03, 0.13, 1.5 / w))[0])


@pytest.mark.verifies("closed form", "the path of the symmetric orbit of a slender body, to 40 digits", within="1e-9")
@pytest.mark.parametrize(("frequency", "restitution"), [("2", "0.9"), ("3", "0.85"), ("4", "0.9")])
def test_grazing_of_the_symmetric_orbit(frequency, restitution):
    """Beyond the fold the branch ends where its path touches the other side; negative control: another coefficient."""
    exact, other = (grazing_of_a_slender_body(frequency, r) for r in (restitution, "0.8"))
    orbit = symmetric_orbit(system_of(4, 2.0, float(frequency), float(restitution), linear=True))
    branch = continue_orbit(orbit, ANYTHING, increasing=False)
    assert [item.kind for item in branch.bifurcations] == ["fold", "grazing"]
    assert branch.bifurcations[-1].value == pytest.approx(exact, abs=1e-9)
    assert branch.bifurcations[-1].orbit.trough == pytest.approx(0.0, abs=1e-6)
    assert abs(exact - other) > 1e-5
    with pytest.raises(ValueError, match="pitchfork"):
        branch_off(branch.bifurcations[-1], ANYTHING)


@pytest.mark.verifies("second engine", "the orbit with two impacts fewer, whose path touches zero", within="1e-9")
@pytest.mark.parametrize(
    ("case", "state"),
    [((4, 2.0, 2, 0.9, True), (3.165148, 0.158656)), ((2, 2.0, 2, "ked", False), (3.183132, 0.146774))],
)
def test_grazing_where_impacts_disappear(case, state):
    """The orbit of three impacts per half period loses two of them, without speed, where that of one impact grazes."""
    orbit = symmetric_orbit(system_of(*case[:4], linear=case[4]))
    grazing = continue_orbit(orbit, ANYTHING, increasing=False).first("grazing")
    below = orbit.system.changed("amplitude", grazing.value - 0.01)
    branch = continue_orbit(find_orbit(below, *state, impacts=3, halves=1), ANYTHING, step=0.002)
    assert branch.first("grazing").value == pytest.approx(grazing.value, abs=1e-9)
    first, last = branch.orbits[0], branch.orbits[-1]
    assert (first.slowest > 1e-3, last.slowest < 1e-6, last.trough) == (True, True, math.inf)


@pytest.mark.verifies("closed form", "the symmetric orbit of slender bodies", within="1e-10")
@pytest.mark.parametrize(
    ("frequency", "restitution", "fold"),
    [(2, 0.9, 0.1129065769837577850), (3, 0.9, 0.1211540103402213183917), (5, 0.85, 0.1936330474438083581761)],
)
def test_folds_of_slender_bodies(frequency, restitution, fold):
    """The fold by continuation and in closed form; below it there is no orbit."""
    assert slender_thresholds(frequency, restitution).fold == pytest.approx(fold, rel=1e-13)
    orbit = symmetric_orbit(system_of(4, 1.0, frequency, restitution, linear=True))
    branch = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold"))
    assert branch.first("fold").value == pytest.approx(fold, abs=1e-10)
    with pytest.raises(OrbitNotFoundError):
        slender_orbit(0.999 * fold, frequency, restitution)


TWO_PARAMETERS = {
    1.5: (0.053255755, 1.107309895, 1.304441608),
    2.5: (0.060606598, 3.852251312, 4.886860316),
    3.5: (0.063330110, 8.552220161, 10.933215880),
    4.5: (0.064571133, 15.878966324, 19.204841262),
    6.0: (0.065446675, 33.001589682, 35.418046653),
}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="6e-10")
@pytest.mark.parametrize("number", range(3))
def test_curves_in_two_parameters(number):
    """Fold, pitchfork and period doubling of slenderness 4 with KED, followed over the frequency from 2 both ways."""
    point = cascade(system_of(4, 1.2, 2.0, "ked"), 1)[number]
    for frequency in (1.5, 2.5, 3.5, 4.5, 6.0):
        curve = bifurcation_curve(point, frequency)
        assert curve[-1].orbit.system.frequency_ratio == pytest.approx(frequency, rel=1e-14)
        assert curve[-1].value == pytest.approx(TWO_PARAMETERS[frequency][number], abs=6e-10)
        point = curve[-1] if frequency > 2.0 else point
    if number == 1:  # subcritical at this frequency: the 2-cycles begin unstable and turn at a fold
        branch = branch_off(point, ANYTHING, step=0.03, stop=is_kind("fold"))
        assert branch.first("fold").value == pytest.approx(32.781466186, abs=6e-10)


@pytest.mark.verifies("second engine", "continuation in one parameter after the other", within="1e-9")
def test_curve_of_a_body_that_is_not_symmetric():
    """The fold at another frequency by its curve, and by continuation of the orbit in frequency, then in amplitude."""
    near = symmetric_orbit(system_of(4, 1.2, 2.0, 0.85))
    system = HarmonicRocking.of_ratios(LEANING, 1.2, 2.0, restitution={"left": 0.8, "right": 0.85})
    orbit = find_orbit(system, near.phase, near.speed, impacts=2)
    down = {"increasing": False, "stop": is_kind("fold")}
    fold = continue_orbit(orbit, ANYTHING, **down).first("fold")
    curve = bifurcation_curve(fold, 2.6)
    other = continue_orbit(orbit, (1.9, 2.6), parameter="frequency").orbits[-2]
    there = find_orbit(other.system.changed("frequency", 2.6), other.phase, other.speed, impacts=2)
    assert curve[-1].value == pytest.approx(continue_orbit(there, ANYTHING, **down).first("fold").value, abs=1e-9)
    assert abs(curve[-1].value / fold.value - 1.0) > 0.01  # control: another value than at the start


@pytest.mark.verifies("closed form", "Spanos and Koh (1984)", within="1e-10")
def test_orbits_in_closed_form():
    """Speed of the symmetric orbit of slender bodies; determinant r^2; modulus r of the multipliers of a focus."""
    for (amplitude, frequency, r), speed in {
        (1.2, 3, 0.9): 0.790917702767388788, (2, 4, 0.9): 0.795424033581792961, (2, 5, 0.85): 0.624486486704868229,
    }.items():  # fmt: skip
        orbit = symmetric_orbit(system_of(4, amplitude, frequency, r, linear=True))
        assert orbit.speed == pytest.approx(speed, rel=1e-13)
        assert orbit.determinant == pytest.approx(r * r, rel=1e-12)
        assert np.abs(orbit.multipliers) == pytest.approx([r, r], rel=1e-11)
        assert orbit.exponents / orbit.system.p == pytest.approx(
            np.full(2, frequency / math.pi * math.log(r)), rel=1e-10
        )


@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="1e-9")
def test_speed_dependent_restitution():
    """r = .95 - .2 |rate| / p: determinant r R' with R' = d(r v) / dv; with r in place of R' it would be .8144."""
    plain = system_of(4, 1.5, 3.0, 0.95)
    p = plain.p
    law = SpeedRestitution(at=[0.0, p], factors=[1.0, 1.0 - 0.2 / 0.95], times=0.95)
    system = system_of(4, 1.5, 3.0, law)
    orbit = find_orbit(system, 2.98898147324233 + math.pi, 0.21455748727069 / plain.alpha)
    assert orbit.speed * plain.alpha == pytest.approx(0.21455748727069, abs=1e-13)
    assert symmetric_orbit(system).speed == pytest.approx(orbit.speed, abs=1e-12)
    assert orbit.trace == pytest.approx(-0.444098450749, abs=1e-11)
    assert orbit.determinant == pytest.approx(0.77150450514269, abs=1e-12)
    fold = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold")).first("fold")
    pitchfork = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork")).first("pitchfork")
    doubling = branch_off(pitchfork, ANYTHING, step=0.03, stop=is_kind("period doubling")).first("period doubling")
    expected = (0.08864716571, 5.42197311344, 7.32008415997)
    assert (fold.value, pitchfork.value, doubling.value) == pytest.approx(expected, abs=1e-9)


def response_by_reference(system, phase, speed, side, duration):
    """Return the response after a start on one foot, by the reference engine in pure Python."""
    motion, rate = system.excitation, system.alpha * system.p
    wave = (motion.amplitude, motion.frequency, phase)
    ground = Sinusoids("harmonic", (wave,), duration, motion.amplitude, motion.amplitude, motion.period)
    return simulate(
        system.body, ground, system.restitution, angular_velocity=side * speed * rate, duration=duration,
        linear=system.linear, gravity=system.gravity, engine="reference", rest_speed=0.0,
    )  # fmt: skip


def by_reference(*start):
    """Return state, tangent and impacts after a start on one foot, by the reference engine in pure Python."""
    response = response_by_reference(*start)
    tangent = response.tangent()
    return tangent.by_start[-1], tangent.by_parameter["amplitude"][-1], response.impacts


BY_SPEED = SpeedRestitution(at=[0.0, 5.0], factors=[1.0, 0.6], times=0.9)


@pytest.mark.verifies("second engine", "the reference engine in pure Python and its tangent", within="1e-9")
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("law", [{"left": 0.8, "right": 0.9}, BY_SPEED], ids=["by foot", "by speed"])
def test_reference_engine_gives_the_map_and_its_derivatives(law, linear):
    """Phase, speed, jacobian and derivative by the amplitude over four impacts of a body that is not symmetric."""
    system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law, linear=linear)
    start, omega, rate = (4.5, 0.7), system.excitation.frequency, system.alpha * system.p
    flight, after = (over_impacts(system, *start, n, parameter="amplitude") for n in (4, 5))
    phase, speed = float(flight.phase[0]), float(flight.speed[0])
    until = 0.5 * (float(after.phase[0]) + phase)  # before the fifth impact
    whole, forced, impacts = by_reference(system, *start, 1.0, (until - start[0]) / omega)
    rest, forced_rest, _ = by_reference(system, phase, speed, 1.0, (until - phase) / omega)
    assert len(impacts) == 4
    assert impacts["time"][3] * omega + start[0] == pytest.approx(phase, rel=1e-11)
    assert abs(impacts["velocity_after"][3]) / rate == pytest.approx(speed, rel=1e-11)

    def states(phase, speed):
        """Return derivatives of rotation and velocity at an impact by phase and speed after the impact."""
        push = system.excitation.amplitude / system.gravity * math.sin(phase)
        alpha, p2 = system.sides[:2]
        pull = alpha + push if linear else math.sin(alpha) + push * math.cos(alpha)
        return np.array([[-speed * rate / omega, 0.0], [p2 * pull / omega, rate]])

    back = np.linalg.inv(rest @ states(phase, speed))
    assert back @ whole @ states(*start) == pytest.approx(flight.jacobian[0], rel=1e-9)
    by_ratio = flight.by_parameter[0] * system.amplitude_ratio
    assert back @ (forced - forced_rest) == pytest.approx(by_ratio, rel=1e-9)
    other = replace(system, restitution=0.9)  # control: another law is another map
    assert abs(over_impacts(other, *start, 4).phase[0] / phase - 1.0) > 1e-3


@pytest.mark.verifies("invariant", "the product of r d(r v)/dv over the impacts", within="1e-10")
@pytest.mark.parametrize("linear", [False, True])
def test_sum_rule_of_all_laws(linear):
    """Both exponents add up to the mean logarithm of the impacts' determinants, by foot and by speed."""
    for law in ({"left": 0.8, "right": 0.9}, BY_SPEED):
        system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law, linear=linear)
        starts = start_states(system, np.transpose(grid(np.linspace(0.1, 6.2, 6), [0.4, 0.8])))
        result = over_periods(system, starts, settled=60, kept=100, vectors=2, most_impacts=500)
        alive = (result.ending == 0) & (result.rests == 0)
        assert alive.sum() >= 2
        before, is_right = result.hits[alive, :, 2], result.hits[alive, :, 1] > 0.0
        if law is BY_SPEED:
            r = 0.9 * (1.0 - 0.08 * np.abs(before))
            slopes = 0.9 * (1.0 - 0.16 * np.abs(before))
        else:
            r = slopes = np.where(is_right, 0.9, np.where(np.isnan(before), np.nan, 0.8))
        expected = np.nansum(np.log(r * slopes), axis=1)
        assert result.growth[alive].sum(axis=1) == pytest.approx(expected, abs=1e-10 * 100)
        if law is BY_SPEED:  # control: r^2 is wrong
            assert np.abs(expected - 2.0 * np.nansum(np.log(r), axis=1)).min() > 0.01


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the same law in a table with more points; constant laws", within="1e-9")
@pytest.mark.filterwarnings("ignore")
def test_laws_by_speed_in_all_functions():
    """Basins, sections, exponents, diagrams and orbits accept r(v); a flat law is a constant coefficient."""
    flat = SpeedRestitution(at=[0.0, 5.0], factors=[1.0, 1.0], times=0.9)
    fine = SpeedRestitution(at=np.linspace(0.0, 5.0, 21), factors=np.linspace(1.0, 0.6, 21), times=0.9)
    results = []
    for law in (0.9, flat, BY_SPEED, fine):
        system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law)
        kinds = ends_of(system, *grid(*cells(12, 12, 2.0)))
        starts = start_states(system, [[1.0, 0.7], [4.5, 0.7]])
        systems = [system.changed("amplitude", value) for value in (1.2, 1.4)]
        attractors = diagram(systems, np.stack([starts, starts]), cycles=(100, 130), exponents=True)
        exponents = lyapunov_exponents(system, starts=starts, settled=200, kept=100)
        near = symmetric_orbit(system_of(4, 1.4, 2.5, 0.9))
        orbit = find_orbit(system, near.phase, near.speed, impacts=2)
        fold = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold")).first("fold")
        values = (fold.value, orbit.determinant, *exponents.by_orbit.ravel(), *attractors["impacts_per_period"].ravel())
        results.append((kinds.tolist(), values))
    for first, second in ((0, 1), (2, 3)):
        assert results[first][0] == results[second][0]
        assert results[first][1] == pytest.approx(results[second][1], rel=1e-8)
    assert results[0][0] != results[2][0]
    assert abs(results[0][1][0] / results[2][1][0] - 1.0) > 0.01


PARAMETERS = ("amplitude", "frequency", "restitution", "slenderness")
CASES = st.tuples(
    st.floats(0.2, 1.5), st.floats(-0.3, 0.3), st.floats(0.5, 2.0), st.floats(1.5, 5.0), st.floats(0.0, 6.2),
    st.floats(0.3, 1.2), st.booleans(),
)  # fmt: skip


@pytest.mark.verifies("computed anew", "central differences", within="1e-5")
@settings(max_examples=40, deadline=None)
@given(CASES)
def test_derivatives_are_those_of_differences(case):
    """Jacobian and derivatives by all parameters, over three impacts of a body that is not symmetric."""
    height, shift, amplitude, frequency, phase, speed, linear = case
    body = MassPoints(
        [[-0.4, 0.0], [0.6, 0.0], [0.1 + shift, 1.0 + height], [shift, 2.0]], [1.0, 1.0, 2.0, 1.0], feet=(-0.4, 0.6)
    )
    system = HarmonicRocking.of_ratios(
        body, amplitude, frequency, restitution={"left": 0.8, "right": 0.9}, linear=linear
    )
    flight = over_impacts(system, phase, speed, 3)
    if flight.event[0] != 1 or np.abs(flight.jacobian).max() > 100.0:
        return  # overturns or at rest, or nearly grazes: differences say little
    step = 1e-6
    columns = [
        [over_impacts(system, phase + sign * step * a, speed + sign * step * b, 3) for sign in (1, -1)]
        for a, b in ((1, 0), (0, 1))
    ]
    for k, (above, below) in enumerate(columns):
        difference = np.array([above.phase[0] - below.phase[0], above.speed[0] - below.speed[0]]) / (2.0 * step)
        assert flight.jacobian[0][:, k] == pytest.approx(difference, rel=1e-5, abs=1e-6)
    for name in ("amplitude", "frequency"):
        value = system.value(name)
        ends = [
            over_impacts(system.changed(name, value * (1.0 + sign * step)), phase, speed, 3) for sign in (1.0, -1.0)
        ]
        difference = np.array([ends[0].phase[0] - ends[1].phase[0], ends[0].speed[0] - ends[1].speed[0]]) / (
            2.0 * step * value
        )
        assert over_impacts(system, phase, speed, 3, parameter=name).by_parameter[0] == pytest.approx(
            difference, rel=1e-5, abs=1e-6
        )


@pytest.mark.verifies("computed anew", "central differences", within="1e-6")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("name", PARAMETERS)
def test_derivatives_by_parameters_of_a_rectangle(name, linear):
    """Also by the coefficient of both feet, and by the slenderness angle with constant p."""
    system = system_of(3, 1.4, 2.7, 0.9, linear=linear)
    value, step = system.value(name), 1e-6
    ends = [over_impacts(system.changed(name, value + sign * step), 5.7, 0.8, 4) for sign in (1.0, -1.0)]
    difference = np.array([ends[0].phase[0] - ends[1].phase[0], ends[0].speed[0] - ends[1].speed[0]]) / (2.0 * step)
    assert over_impacts(system, 5.7, 0.8, 4, parameter=name).by_parameter[0] == pytest.approx(difference, rel=1e-6)


EXPONENTS = {
    # slenderness, model, frequency, amplitude: largest exponent over p, standard error; 64 orbits
    (2, "H", 2, 3.007): (0.07301, 0.00024),
    (2, "H", 2, 3.0166): (0.11552, 0.00040),
    (2, "H", 3, 8.0189): (0.17498, 0.00053),
    (1, "H", 2, 2.54): (0.11888, 0.00040),
    (1, "H", 2, 2.60): (0.25176, 0.00027),
    (1, "K", 2, 3.36): (0.1078, 0.0006),
}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853")
@pytest.mark.parametrize("case", EXPONENTS)
def test_exponents_of_chaos(case):
    """Within three standard errors of both programs; the sum rule to 1e-10 in each run."""
    slenderness, model, frequency, amplitude = case
    system = system_of(slenderness, amplitude, frequency, MODELS[model])
    orbit = symmetric_orbit(
        system_of(slenderness, 1.6 if slenderness == 1 else 2.0 if frequency == 2 else 5.0, frequency, MODELS[model])
    )
    near = continue_orbit(orbit, (0.0, amplitude), step=0.05).orbits[-2]
    draws = np.random.default_rng(1).normal(scale=0.01, size=(64, 2))
    states = [
        ((near.phase + a) / system.excitation.frequency, near.speed * (1 + b) * system.alpha * system.p)
        for a, b in draws
    ]
    starts = np.array([(time, 1e-12, velocity) for time, velocity in states])
    result = lyapunov_exponents(system, starts=starts, settled=1500, kept=2000)
    value, error = EXPONENTS[case]
    assert len(result.finite) > 4
    assert result.sticking == 0
    own = result.standard_errors[0] / system.p
    assert abs(result.values[0] / system.p - value) < 3.0 * math.hypot(own, error)
    assert np.abs(result.sum_rule[np.isfinite(result.sum_rule)]).max() < 1e-10 * system.p


REGULAR = {
    # slenderness, model, frequency, amplitude: exact largest exponent over p, doublings
    (2, "H", 2, 1.2): (-0.2270663216, 0), (2, "H", 2, 2.383): (-0.0028727025, 0),
    (2, "H", 2, 2.923): (-0.0095412630, 1), (2, "H", 2, 2.986): (-0.0034538155, 2),
    (4, "H", 3, 5.868): (-0.0035272186, 0), (4, "K", 5, 24.109): (-0.0601666878, 1),
    (8, "K", 3, 7.37): (-0.0138778503, 2),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="2e-10")
@pytest.mark.parametrize("case", REGULAR)
def test_exponents_of_periodic_orbits(case):
    """From the multipliers of the symmetric orbit, the 2-cycle and the 4-cycle: ten digits."""
    slenderness, model, frequency, amplitude = case
    value, doublings = REGULAR[case]
    orbit = symmetric_orbit(system_of(slenderness, 1.2 if frequency < 3 else 3.0, frequency, MODELS[model]))
    if doublings:
        kinds = ["pitchfork", "period doubling"][:doublings]
        branch = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork"))
        for kind, step in zip(kinds, (0.03, 0.01)[:doublings], strict=True):
            branch = branch_off(branch.first(kind), ANYTHING, step=step, stop=is_kind("period doubling"))
        orbit = min(branch.orbits, key=lambda item: abs(item.system.amplitude_ratio - amplitude))
        exact = find_orbit(orbit.system.changed("amplitude", amplitude), orbit.phase, orbit.speed, impacts=2**doublings)
    else:
        branch = continue_orbit(orbit, (0.0, amplitude + 0.01), step=0.02)
        orbit = min(branch.orbits, key=lambda item: abs(item.system.amplitude_ratio - amplitude))
        exact = find_orbit(orbit.system.changed("amplitude", amplitude), orbit.phase, orbit.speed)
    assert exact.exponents[0] / exact.system.p == pytest.approx(value, abs=2e-10)


@pytest.mark.verifies("behaviour")
def test_a_rest_erases_memory():
    """An orbit that comes to rest in each period has exponents of minus infinity: it is never called chaotic."""
    system = system_of(2, 1.1, 2.0, "housner")
    result = lyapunov_exponents(system, starts=np.zeros((1, 3)), settled=100, kept=200)
    assert result.sticking == 1
    assert np.isneginf(result.by_orbit).all()
    attractors = diagram([system], np.zeros((1, 1, 3)), cycles=(100, 200), exponents=True)
    assert KINDS[attractors["attractor"].item()] == "sticking"
    assert np.isneginf(attractors["exponent"].item())


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


FIRST_OVERTURNING = {(4, "housner"): (1.04, 1.05), (4, "ked"): (1.02, 1.03), (8, "ked"): (1.0, 1.01)}


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


@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="1e-9")
def test_the_orbit_to_hit_by_simulation():
    """A stable 4-cycle of slenderness 2 is kept for 2,000 periods to 1e-9."""
    system = system_of(2, 2.986, 2, "housner")
    cycle = [
        (3.890097635432, 0.471444330597), (1.928517618213, 0.354409890312), (3.538382056983, 0.609643603441),
        (2.119220994315, 0.494099572035),
    ]  # fmt: skip
    orbit = find_orbit(system, cycle[0][0] + math.pi, cycle[0][1] / system.alpha, impacts=4)
    flights = [over_impacts(system, orbit.phase, orbit.speed, n) for n in (1, 2, 3, 4)]
    for n, flight in enumerate(flights, 1):
        phase, speed = cycle[n % 4]
        assert flight.speed[0] * system.alpha == pytest.approx(speed, abs=1e-11)
        assert math.remainder(flight.phase[0] + (n + 1) * math.pi - phase, 2.0 * math.pi) == pytest.approx(
            0.0, abs=1e-11
        )
    options = {"starts": [[orbit.phase, orbit.speed]], "cycles": (0, 2000), "at": "impact"}
    section = rk.poincare(system.body, system.excitation, "housner", **options)
    speeds = np.abs(section["velocity_ratio"].values[0, :3999]) * system.alpha
    assert np.abs(np.sort(speeds[-4:]) - np.sort([speed for _, speed in cycle])).max() < 1e-9


@pytest.mark.verifies("second engine", "the same engine for other instruction sets", within="1e-9")
def test_engines_of_all_processors_agree():
    """Every instruction set gives the same verdicts, and the same bits on two that fuse multiplications."""
    from rocking.dynamics import _longrun

    system = system_of(3, 1.7, 2.5, "housner")
    starts = start_states(system, np.transpose(grid(np.linspace(0.1, 6.0, 6), [0.2, 0.7])))
    tables = {}
    for isa in ("plain", "avx2", "avx512"):
        results = np.full((len(starts), 9), np.nan)
        states, hits = np.full((len(starts), 20, 2), np.nan), np.empty((len(starts), 0, 3))
        sides, sines = np.tile(system.sides, (len(starts), 1)), np.tile(system.sine, (len(starts), 1, 1))
        try:
            _longrun.many(
                sides, sines, starts, results, states, hits, np.empty((2, 0)), 30, 2, False, 1.5, 1e-7, 1e-16, 2, isa
            )
        except ValueError:
            continue  # this processor has none
        tables[isa] = (results, states)
    for results, states in tables.values():
        assert results[:, 0].tolist() == tables["plain"][0][:, 0].tolist()
        assert states == pytest.approx(tables["plain"][1], abs=1e-9, nan_ok=True)
    if "avx512" in tables:
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(tables["avx2"], tables["avx512"], strict=True))


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


@pytest.mark.verifies("invariant", "the same ratios at another size")
def test_basins_and_rest_in_other_units():
    """A body ten times as large, in slow motion, ends as the small one: only ratios count."""
    small, large = (
        HarmonicRocking.of_ratios(Block(width=w, height=4.0 * w), 1.5, 3.0, restitution="ked") for w in (0.1, 10.0)
    )
    draws = np.random.default_rng(0).random((2, 200))
    kinds = [ends_of(system, draws[0] * 6.28, draws[1] * 2.0).tolist() for system in (small, large)]
    assert kinds[0] == kinds[1]


@pytest.mark.verifies("damage")
def test_bad_input_is_refused():
    """Values out of range name their parameter; orbits of asymmetric bodies have an even number of impacts."""
    with pytest.raises(ValueError, match="period"):
        Harmonic(amplitude=1.0, period=0.0)
    with pytest.raises(ValueError, match="amplitude"):
        Harmonic(amplitude=math.nan, period=1.0)
    lean = MassPoints([[-0.4, 0.0], [0.6, 0.0], [0.3, 2.0]], [1.0, 1.0, 2.0], feet=(-0.4, 0.6))
    system = HarmonicRocking.of_ratios(lean, 1.5, 2.0, restitution="ked")
    with pytest.raises(ValueError, match="both"):
        find_orbit(system, 1.0, 1.0)
    block = system_of(4, 1.5, 2.0, "ked")
    for name, call in {
        "kept": lambda: over_periods(block, np.zeros((1, 3)), kept=0),
        "vectors": lambda: over_periods(block, np.zeros((1, 3)), vectors=3),
        "starts": lambda: over_periods(block, np.full((1, 3), math.nan)),
        "one row per system": lambda: over_periods([block], np.zeros((2, 3))),
        "impacts": lambda: over_impacts(block, 1.0, 1.0, 0),
        "parameter": lambda: block.changed("mass", 1.0),
        "restitution": lambda: block.changed("restitution", 1.2),
        "coefficient of restitution": lambda: system_of(4, 1.5, 2.0, 1.2).sides,
        "slenderness": lambda: block.changed("slenderness", 2.0),
        "frequency": lambda: system_of(4, 1.5, 0.0, "ked"),
        "amplitude": lambda: over_impacts(block.changed("amplitude", 0.0), 1.0, 1.0, parameter="amplitude"),
        "step_error": lambda: Numerics(step_error=math.nan),
        "excitation": lambda: HarmonicRocking(Block(width=1.0, height=4.0), 3.0),
        "symmetric": lambda: symmetric_orbit(system),
        "seed": lambda: lyapunov_exponents(block, seed=-1),
    }.items():
        with pytest.raises(ValueError, match=name):
            call()
    with pytest.raises(ValueError, match="restitution"):
        slender_thresholds(2.0, 0.0)
    with pytest.raises(ValueError, match="settled"):
        lyapunov_exponents(system, settled=5)
    with pytest.raises(ValueError, match="starts"):
        rk.bifurcation(system.body, system.excitation, "amplitude", [1.0, 2.0], starts=np.zeros((2, 3)))


@pytest.mark.verifies("closed form", "the fold of the branch")
def test_sweeps_with_memory_show_hysteresis():
    """Below uplift a body at rest stays at rest, while a sweep down keeps the large orbit to its fold."""
    system = system_of(4, 1.0, 3.0, "ked")
    values = np.linspace(0.04, 1.2, 30)
    orbit = symmetric_orbit(system.changed("amplitude", 1.2))
    subject = (system.body, system.excitation, "amplitude")
    options = {"restitution": "ked", "exponents": False, "cycles": (200, 130)}
    down = rk.bifurcation(*subject, values, starts=[[orbit.phase, orbit.speed]], sweeps=("down",), **options)
    rocking = values[down["impacts_per_period"].values[0, :, 0, 0] > 1.9]
    assert rocking.min() == pytest.approx(0.0622597, abs=values[1] - values[0])
    rest = rk.bifurcation(*subject, values[values < 1.0], starts=1, **options)
    assert set(rest["attractor"].values.ravel()) == {KINDS.index("rest")}
    assert over_periods(system, np.zeros((1, 3))).peak[0] == 0.0
