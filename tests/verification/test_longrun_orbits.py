"""Periodic orbits and their bifurcations against programs in Taylor series of 80 bits and DOP853, no common code."""

import math

import mpmath as mp
import numpy as np
import pytest
from long_run_systems import ANYTHING, LEANING, MODELS, cascade, is_kind, system_of

import rocking as rk
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.studies.longrun.continuation import bifurcation_curve, branch_off, continue_orbit
from rocking.studies.longrun.orbits import OrbitNotFoundError, find_orbit, slender_orbit, symmetric_orbit
from rocking.studies.longrun.system import HarmonicRocking, over_impacts
from rocking.studies.longrun.thresholds import slender_thresholds

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")

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


@pytest.mark.verifies("behaviour")
def test_a_branch_ends_where_its_orbit_overturns():
    """A cube rocks up to a rotation of 90 degrees, which is overturning; the end of the branch is no bifurcation."""
    orbit = symmetric_orbit(system_of(1, 6.0, 5, "housner"))
    branch = continue_orbit(orbit, ANYTHING, step=0.05)
    assert branch.bifurcations == []
    last = branch.orbits[-1]
    assert last.peak * last.system.alpha == pytest.approx(math.pi / 2.0, rel=2e-3)  # seen at the end of a step
    assert last.determinant == pytest.approx(0.25**2, rel=1e-9)
    assert last.slowest > 1.0


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
