"""Bodies on isolated bases against independent values, balances of momentum, Lagrange's equations, limits and energy.

The rows 6H1 and 6H2 are those of two routes of independent code that agree to 1e-13. The equations and impacts are also
formed here from positions of the body and of the base, without the formulas of the engine.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.dynamics.plane.equations import EventKind
from rocking.errors import InvalidValueError, RockingError

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G = 9.81
BLOCK = rk.Block(width=0.5, height=2.0, mass=1000.0)
LINEAR = rk.Isolated(BLOCK, 1000.0, period=1.2, damping_ratio=0.1)
SLIDING = rk.Isolated(BLOCK, 1000.0, friction=0.28)
ROWS = {  # uplift, impacts (t, u, theta', u' before, theta', u' after), turning points, extremes of u, works
    "6H1": (
        (LINEAR, (4.0, 0.8), 1.8), 0.26968596668,
        [(0.88443795952, 1.06805096200, -1.81144588494e-2, 9.22407649002e-1, 5.47071976508e-2)],
        [(0.71645594395, -8.41012298731e-2)],
        [(0.45335069845, -1.41016654393e-1), (0.88203700957, 1.52032292702e-1), (0.89466218380, 1.52290080171e-1),
         (1.44276456989, -1.20495031955e-1)],
        (2.078511962e3, 1.328694521e2, None),
    ),
    "6H2": (
        (SLIDING, (5.0, 0.6), 2.2), 0.04895575070,
        [(0.45498715651, 4.07689557422e-1, 0.0, 3.71716949414e-1, 0.0),
         (2.10935270472, -6.35638048272e-1, 0.0, -5.79552338130e-1, 0.0)],
        [(0.37040422343, -1.64838047447e-2), (1.30034465073, 1.89203098054e-1)],
        [(0.33894147926, -3.82202783027e-2), (0.60091010800, -2.82527886699e-2)],
        (5.717125439e2, 6.813607121e1, 2.656608262e2),
    ),
}  # fmt: skip


def near(rows, expected):
    """Compare rows (time, value) with the nearest rows in time."""
    rows = np.array(rows)
    for time, *values in expected:
        nearest = rows[np.argmin(np.abs(rows[:, 0] - time))]
        assert np.allclose(nearest, [time, *values], rtol=0.0, atol=2e-10)


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.verifies("computed anew", "two independent programs", within="2e-10",
                      control="test_the_rule_without_friction_is_another")  # fmt: skip
def test_independent_values(name):
    """Uplift, impacts, turning points, extremes of the base, and works."""
    (body, pulse, duration), uplift, impacts, peaks, base_peaks, works = ROWS[name]
    response = rk.simulate(body, rk.pulses.sine(*pulse), "housner", gravity=G, duration=duration)
    assert response.uplifts[0] == pytest.approx(uplift, abs=2e-11)
    names = "time", "velocity_before", "base_velocity_before", "velocity_after", "base_velocity_after"
    assert np.allclose([[i[n] for n in names] for i in response.impacts], impacts, rtol=0.0, atol=2e-10)
    near(response.trajectory.peaks, peaks)
    near(response.trajectory.base_peaks, base_peaks)
    values = [response.trajectory.samples[key][response.time.size - 1] for key in ("work", "lost", "dissipated")]
    for value, work in zip(values, works, strict=True):
        assert work is None or value == pytest.approx(work, rel=1e-9)
    assert response.energy_closure < 1e-12


@pytest.mark.verifies("computed anew", "two independent programs", within="2e-10")
def test_the_sliding_base_sticks_and_slips():
    """In 6H2 the base slides from .0597 s to .3389 s, sticks in the impact, and slips at once to .6009 s."""
    response = rk.simulate(SLIDING, rk.pulses.sine(5.0, 0.6), "housner", gravity=G, duration=2.2)
    time, moves = response.time, response.base_velocity != 0.0
    starts, ends = time[1:][np.diff(moves.astype(int)) == 1], time[1:][np.diff(moves.astype(int)) == -1]
    step = time[1]
    assert np.all(starts - [0.05968164301, 0.45498715651] <= step)
    assert np.all(starts >= [0.05968164301, 0.45498715651])
    assert np.all(ends - [0.33894147926, 0.60091010800] <= step)
    assert np.all(ends >= [0.33894147926, 0.60091010800])


def landing(body, base_mass, rate, slip=0.0, friction=0.0, side=1):
    """Return theta' and u' after an impact by the engine with Housner's impulse."""
    from rocking.dynamics.isolated.impact import ImpactSystem

    parameters = rk.dynamics.RockingParameters.of_body(body, "housner", G)
    isolated = rk.Isolated(body, base_mass, friction=friction)
    system = ImpactSystem.of(side, isolated, parameters.side(-side), parameters.side(side))
    return system.after(side * rate, side * slip, parameters.side(side).coefficient)


def balances(body, base_mass, rate, slip, horizontal, side=1):
    """Return theta', u' and the vertical impulse from the balances of momentum of body and base.

    `horizontal` is the impulse of the ground on the base per vertical impulse, or None for a base that sticks. The
    unknowns are the velocities of centre and base, and the impulses of the body and of the ground on the base.
    """
    x, h = body.centre
    old, new = body.feet if side > 0 else body.feet[::-1]
    m, inertia = body.mass, body.moment_of_inertia
    w, u = side * rate, side * slip
    vx, vz = u + h * w, -(x - old) * w
    # unknowns: w, u, vx, vz, Jx, Jz (base on body), Jf (ground on base)
    a, b = np.zeros((7, 7)), np.zeros(7)
    a[0, [2, 4]], b[0] = (m, -1.0), m * vx
    a[1, [3, 5]], b[1] = (m, -1.0), m * vz
    a[2, [0, 4, 5]], b[2] = (inertia, h, new - x), inertia * w  # clockwise: z Jx - x Jz about the centre, with z = -h
    a[3, [1, 4, 6]], b[3] = (base_mass, 1.0, -1.0), base_mass * u
    a[4, [2, 1, 0]] = 1.0, -1.0, -h  # the new foot moves with the base
    a[5, [3, 0]] = 1.0, x - new
    if horizontal is None:
        a[6, 1] = 1.0
    else:
        a[6, [6, 5]] = 1.0, -horizontal
    solution = np.linalg.solve(a, b)
    return solution[0], solution[1], solution[6] / solution[5]


SKEW = rk.Block(width=1.0, height=2.5, mass=2000.0, centre=(0.35, 1.1), moment_of_inertia=1500.0)


@pytest.mark.parametrize("slenderness", [1.5, 2.0, 4.0, 10.0])
@pytest.mark.parametrize("gamma", [0.0, 0.3, 1.0, 5.0, 1e9])
@pytest.mark.verifies("closed form", "r and du of a rectangle (physics.md 7.5, 9.4)", within="1e-8")
def test_closed_form_on_linear_isolators(slenderness, gamma):
    """r = 1 - 2 s^2 (1 + gamma) / (4/3 (1 + gamma) - c^2), and the jump of the base; 19/22 and 3/44 for 4 and 1."""
    block = rk.Block(width=2.0, height=2.0 * slenderness, mass=1.0)
    base = max(gamma, 1e-12)
    s2 = 1.0 / (1.0 + slenderness**2)
    divisor = 4.0 / 3.0 * (1.0 + base) - (1.0 - s2)
    rate, slip = landing(block, base, 1.0)
    assert rate == pytest.approx(1.0 - 2.0 * s2 * (1.0 + base) / divisor, abs=1e-12)
    assert slip / slenderness == pytest.approx(2.0 * s2 / divisor, abs=1e-12)
    if (slenderness, gamma) == (4.0, 1.0):
        assert (rate, slip / slenderness) == pytest.approx((19.0 / 22.0, 3.0 / 44.0), rel=1e-13)
    if gamma == 1e9:
        assert rate == pytest.approx(1.0 - 1.5 * s2, abs=1e-8)  # a heavy base: Housner


@pytest.mark.parametrize("body", [BLOCK, SKEW], ids=["block", "asymmetric"])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("slip", [-0.05, 0.0, 0.3])
@pytest.mark.parametrize("friction", [0.0, 0.05, 0.15, 0.9])
@pytest.mark.verifies("computed anew", "balances of momentum of body and base", within="1e-12")
def test_impacts_satisfy_the_balances(body, side, slip, friction):
    """The base slides with the full friction, or sticks with less. A slip that ends in the impact needs less, too."""
    rate, after = landing(body, 800.0, 1.0, slip, friction, side)
    stuck = balances(body, 800.0, 1.0, slip, None, side)
    if slip == 0.0 and abs(stuck[2]) <= friction:
        assert (rate, after) == (pytest.approx(stuck[0], rel=1e-12), 0.0)
        return
    full = balances(body, 800.0, 1.0, slip, -np.sign(after) * friction, side)
    if not friction or slip == 0.0 or np.sign(side * slip) == np.sign(after):
        assert (rate, after) == pytest.approx(full[:2], rel=1e-12)
        return
    x, h = body.centre
    old, new = (abs(x - foot) for foot in body.feet[::side])
    vertical = body.mass * (old + new * abs(rate))
    ground = (body.mass + 800.0) * (after - side * slip) + body.mass * h * (rate - side)
    assert abs(ground) < friction * vertical  # the impulse of the ground on the base


@pytest.mark.verifies("closed form", "3 lambda / (1 + 4 lambda^2)", within="1e-9")
def test_the_base_sticks_from_a_limit_of_friction_on():
    """At rest before the impact, the base sticks from mu_imp = 3 lambda / (1 + 4 lambda^2) on, and r is Housner's."""
    limit = 3.0 * 4.0 / (1.0 + 4.0 * 16.0)
    rate, slip = landing(BLOCK, 1000.0, 1.0, friction=limit * (1.0 + 1e-9))
    assert (rate, slip) == (pytest.approx(1.0 - 1.5 / 17.0, rel=1e-12), 0.0)
    assert landing(BLOCK, 1000.0, 1.0, friction=limit * (1.0 - 1e-9))[1] > 0.0


@pytest.mark.verifies("negative control")
def test_the_rule_without_friction_is_another():
    """Negative control: without impulsive friction the coefficient on the base of 6H2 is 19/22, not 31/34."""
    assert abs(landing(BLOCK, 1000.0, 1.0)[0] - landing(BLOCK, 1000.0, 1.0, friction=0.28)[0]) > 0.04


@pytest.mark.verifies("order", "the body on fixed ground", within="an order of 0.8")
def test_a_stiff_isolator_is_fixed_ground():
    """The first impact converges to that on fixed ground with the compliance, of first order."""
    pulse = rk.pulses.sine(4.0, 0.8)
    fixed = rk.simulate(BLOCK, pulse, "housner", gravity=G, duration=1.2).impacts["time"][0]
    gaps = []
    for stiffness in (1e7, 1e8, 1e9):
        body = rk.Isolated(BLOCK, 1000.0, stiffness=stiffness, damping=0.7 * math.sqrt(stiffness * 2000.0))
        gaps.append(abs(rk.simulate(body, pulse, "housner", gravity=G, duration=1.2).impacts["time"][0] - fixed))
    orders = np.diff(np.log10(gaps))
    assert gaps[0] > 1e-5
    assert np.all(orders < -0.8)  # 1e9: of first order up to the vibration of the base at uplift


def shaking(strength):
    """Return a sine pulse with vertical motion, as records."""
    time = np.arange(81) * 0.01
    along, up = strength * np.sin(2.5 * np.pi * time), 1.5 * np.sin(5.0 * np.pi * time) * (time < 0.4)
    return {"x": rk.GroundMotion(along, 0.01), "z": rk.GroundMotion(up, 0.01)}


@pytest.mark.verifies("second engine", "the body on fixed ground", within="1e-10")
def test_a_base_that_never_slides_is_fixed_ground():
    """With much friction the whole response is that on fixed ground, for an asymmetric body and vertical motion."""
    motion = shaking(5.0)
    held = rk.simulate(rk.Isolated(SKEW, 500.0, friction=5.0), motion, "housner", gravity=G, duration=3.0)
    fixed = rk.simulate(SKEW, motion, "housner", gravity=G, duration=3.0)
    count = min(held.rotation.size, fixed.rotation.size)
    assert np.abs(held.rotation[:count] - fixed.rotation[:count]).max() < 1e-10
    assert fixed.impacts.size > 1
    assert np.all(held.base_displacement == 0.0)


def rates_of(body, base_mass, side, theta):
    """Return (mass, inertia, velocity for unit u', velocity for unit theta') of body and base, and the height."""
    foot = np.array([body.feet[side > 0], 0.0])

    def centre(angle):
        x, z = np.array(body.centre) - foot
        return foot + np.array([x * np.cos(angle) + z * np.sin(angle), z * np.cos(angle) - x * np.sin(angle)])

    turn = np.imag(centre(theta + 1e-30j)) / 1e-30
    items = [(body.mass, body.moment_of_inertia, np.array([1.0, 0.0]), turn),
             (base_mass, 0.0, np.array([1.0, 0.0]), np.zeros(2))]  # fmt: skip
    return items, centre(theta)[1]


def accelerations(isolated, side, state, push, lift):
    """Return u'' and theta'' from the mass matrix; its derivative by differences (Lagrange)."""
    u, theta, v, w = state
    body, base = isolated.body, isolated.base_mass

    def matrix(angle):
        items, _ = rates_of(body, base, side, angle)
        return np.array([
            [sum(m * (a @ a) for m, _, a, _ in items), sum(m * (a @ b) for m, _, a, b in items)],
            [sum(m * (a @ b) for m, _, a, b in items), sum(m * (b @ b) + i for m, i, _, b in items)],
        ])  # fmt: skip

    items, _ = rates_of(body, base, side, theta)
    slope = (matrix(theta + 1e-5) - matrix(theta - 1e-5)) / 2e-5
    q = np.array([v, w])
    force = np.array([-isolated.stiffness * u - isolated.damping * v, 0.0])
    ground = np.array([push, lift + G])
    force -= [sum(m * (a @ ground) for m, _, a, _ in items[:1]) + items[1][0] * push,
              sum(m * (b @ ground) for m, _, _, b in items)]  # fmt: skip
    force += [0.0, 0.5 * q @ slope @ q]
    force -= slope @ q * w
    return np.linalg.solve(matrix(theta), force)


@pytest.mark.parametrize("body", [BLOCK, SKEW], ids=["block", "asymmetric"])
@pytest.mark.verifies("computed anew", "Lagrange's equations by scipy", within="1e-7")
def test_free_motion_is_that_of_lagrange(body):
    """Two impacts of a release from 0.1 rad on a soft base; differences of the mass matrix limit the agreement."""
    isolated = rk.Isolated(body, 700.0, period=1.5, damping_ratio=0.05)
    response = rk.free_rocking(isolated, 0.1, "housner", gravity=G, duration=3.0)
    state, side, time = [0.0, 0.1, 0.0, 0.0], 1, 0.0
    for impact in response.impacts[:2]:

        def crossing(_, y):
            return y[1]

        crossing.terminal, crossing.direction = True, -side
        solved = solve_ivp(
            lambda _, y, s=side: [*y[2:], *accelerations(isolated, s, y, 0.0, 0.0)], (0.0, 3.0), state,
            events=crossing, rtol=1e-9, atol=1e-12, method="DOP853",
        )  # fmt: skip
        time += solved.t_events[0][0]
        u, _, v, w = solved.y_events[0][0]
        side = -side
        after = balances(body, 700.0, side * w, side * v, 0.0, side)
        assert impact["time"] == pytest.approx(time, rel=1e-7)
        assert impact["velocity_before"] == pytest.approx(w, rel=1e-7)
        assert impact["velocity_after"] == pytest.approx(after[0], rel=1e-7)
        assert impact["base_velocity_after"] == pytest.approx(after[1], rel=1e-6)
        state = [u, 0.0, after[1], after[0]]
    assert response.impacts.size >= 2


@pytest.mark.parametrize(
    "body",
    [
        LINEAR, SLIDING, rk.Isolated(SKEW, 300.0, period=1.5, damping_ratio=0.05, friction=0.1),
        rk.Isolated(SKEW, 4000.0),
    ],
    ids=["linear", "sliding", "springs and friction", "rollers"],
)  # fmt: skip
@pytest.mark.parametrize("model", ["housner", "calibrated", "ked"])
@pytest.mark.verifies("invariant", "energy", within="1e-10")
def test_energy_closes(body, model):
    """Work of the ground on body and base = energy + isolators + impacts, with vertical motion."""
    response = rk.simulate(body, shaking(4.0), model, gravity=G, duration=3.0)
    assert response.energy_closure < 1e-10
    assert np.all(np.diff(response.trajectory.samples["lost"][: response.time.size]) >= -1e-9)
    assert np.all(np.diff(response.trajectory.samples["dissipated"][: response.time.size]) >= -1e-9)


@pytest.mark.verifies("behaviour")
def test_a_slippery_base_protects_the_body():
    """With mu < b/h the body never rocks from rest; on rollers the base remains in place and the body does not lift."""
    pulse = rk.pulses.sine(8.0, 0.5)
    for body in (rk.Isolated(BLOCK, 500.0, friction=0.24), rk.Isolated(BLOCK, 500.0)):
        response = rk.simulate(body, pulse, gravity=G, duration=2.0)
        assert response.outcome.name == "NO_UPLIFT"
        assert response.largest_base_displacement > 0.05
    assert rk.simulate(BLOCK, pulse, gravity=G, duration=2.0).outcome.name != "NO_UPLIFT"


@pytest.mark.verifies("behaviour")
def test_a_body_comes_to_rest_on_its_base():
    """Impacts decay, the body rests, and the base vibrates on."""
    response = rk.free_rocking(rk.Isolated(BLOCK, 1000.0, period=2.0, damping_ratio=0.05), 0.1, gravity=G)
    assert not response.still_rocking
    assert response.rotation[-1] == 0.0
    assert response.impacts.size > 10
    assert EventKind.REST not in {event.kind for event in response.trajectory.events}


@pytest.mark.parametrize(
    ("values", "message"),
    [({"period": 1.0, "stiffness": 1e3}, "period and damping_ratio, or stiffness"),
     ({"damping_ratio": 0.1}, "needs a period"), ({"friction": -0.1}, "friction"), ({"period": 0.0}, "period")],
)  # fmt: skip
@pytest.mark.verifies("behaviour")
def test_bad_bases(values, message):
    """Values of a base outside their range are refused with their reason."""
    with pytest.raises(InvalidValueError, match=message):
        rk.Isolated(BLOCK, 100.0, **values)


@pytest.mark.parametrize(
    "analysis",
    [
        lambda: rk.fragility(LINEAR, [rk.pulses.sine(4.0, 0.8)] * 3, [3.0, 4.0]),
        lambda: rk.simulate_many([LINEAR], [rk.pulses.sine(4.0, 0.8)]),
        lambda: rk.overturning_map(LINEAR, rk.pulses.sine(4.0, 0.8), ("pga", [3.0, 4.0]), ("period", [0.5, 1.0])),
        lambda: rk.minimum_overturning_acceleration(LINEAR, rk.pulses.sine(4.0, 0.8)),
        lambda: rk.predict(LINEAR, [rk.pulses.sine(4.0, 0.8)]), lambda: rk.assess(LINEAR, [rk.pulses.sine(4.0, 0.8)]),
        lambda: rk.Isolated(rk.Frame([BLOCK], 100.0), 100.0), lambda: rk.Restrained(LINEAR, []),
        lambda: rk.simulate(LINEAR, rk.pulses.sine(4.0, 0.8), friction=0.4),
    ],
)  # fmt: skip
@pytest.mark.verifies("behaviour")
def test_other_analyses_refuse_a_base(analysis):
    """Analyses without isolated bases refuse such a body."""
    with pytest.raises(RockingError, match=r"isolated base|Block, Section|does not support frames"):
        analysis()


@pytest.mark.verifies("behaviour")
def test_a_fall_after_the_stated_duration_is_overturning():
    """Block and base of 6H1 fall; a response that ends during the fall has the outcome of the complete response."""
    base, motion = LINEAR, rk.pulses.sine(amplitude=4.0, period=0.8)
    complete = rk.simulate(base, motion, "housner", gravity=9.81)
    cut = rk.simulate(base, motion, "housner", gravity=9.81, duration=1.5)
    assert complete.outcome is cut.outcome is rk.Outcome.OVERTURNED
    assert cut.overturning_time == pytest.approx(complete.overturning_time, rel=1e-9)
    assert rk.simulate(base, motion.scaled(0.1), "housner", duration=0.5).outcome is not rk.Outcome.OVERTURNED


@pytest.mark.verifies("behaviour")
def test_downward_motion_without_horizontal_motion_gives_a_result():
    """The base is accelerated downwards by more than gravity; the impact at velocity zero needs no ratio."""
    time = np.arange(0.0, 1.0, 0.01)
    still = rk.GroundMotion(np.zeros(100), 0.01, vertical=np.where(time < 0.2, -12.0, 0.0))
    base = rk.Isolated(rk.Block(width=0.5, height=2.0, mass=1000.0), base_mass=500.0, friction=0.3)
    with pytest.warns(rk.errors.PureRockingWarning, match="tensile"):
        assert rk.simulate(base, still, "housner").lost_contact


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(("name", "value"), [("damping_ratio", ""), ("damping_ratio", 10.0), ("damping_ratio", False)])
def test_values_that_are_no_ratio_are_refused(name, value):
    """Text, logical values and percent are no ratio."""
    with pytest.raises(InvalidValueError, match=name):
        rk.Isolated(rk.Block(width=0.5, height=2.0, mass=1e3), base_mass=1e3, period=1.2, **{name: value})


@pytest.mark.verifies("behaviour")
def test_an_assumed_density_affects_rotations():
    """The ratio of the masses decides; a stated mass is not assumed."""
    free = rk.Isolated(rk.Block(width=0.5, height=2.0), base_mass=1000.0, stiffness=1e5)
    assert any("it affects rotations" in text for text in free.assumed)
    stated = rk.Isolated(rk.Block(width=0.5, height=2.0, mass=1e3), base_mass=1e3, stiffness=1e5)
    assert not any("density" in text for text in stated.assumed)
    mixed = rk.Stack([rk.Block(width=0.5, height=1.0), rk.Block(width=0.4, height=1.0, mass=500.0)])
    assert any("1 of 2 parts" in text and "rotations" in text for text in mixed.assumed)


@pytest.mark.verifies("behaviour")
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
def test_a_base_that_the_ground_would_have_to_pull_is_doubted():
    """The vertical acceleration -15 m/s2 leaves (15 - g) / g of the weight of a heavy base as tension."""
    time = np.arange(0.0, 1.0, 0.01)
    push = np.where(time < 0.4, 3.0 * np.sin(5.0 * np.pi * time), 0.0)
    base = rk.Isolated(BLOCK, base_mass=50e3, friction=1.0)
    for down, is_doubted in ((-15.0, True), (-5.0, False)):
        motion = rk.GroundMotion(push, 0.01, vertical=np.where((time > 0.05) & (time < 0.3), down, 0.0))
        response = rk.simulate(base, motion, "housner", gravity=G, duration=0.5)
        assert any("force of the ground on the base" in doubt for doubt in response.doubts()) is is_doubted
    assert response.trajectory.least_base_force == pytest.approx(1.0 - 5.0 / G, rel=0.02)  # 2 %: motion of the block
