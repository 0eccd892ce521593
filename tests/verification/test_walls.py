"""Bodies next to a wall: compliant walls against independent values, rigid walls against the problem of impulses.

The values of the compliant walls are those of two routes of independent code, which agree to 1.3e-13.
"""

import math
from contextlib import nullcontext

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import nnls

import rocking as rk
from rocking.bodies.formats.body_file import body_to_toml
from rocking.dynamics.plane.equations import EventKind
from rocking.errors import InvalidValueError, PureRockingWarning

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G = 9.81
SLENDER = rk.Block(width=0.5, height=2.0, mass=500.0)
SKEW = rk.Block(width=0.6, height=2.0, mass=500.0, centre=(0.22, 0.9), moment_of_inertia=170.0)
ENGINES = ("reference", "fast")

# time, kind, rotation or velocity before, force or velocity after; then minimum of f_z / m g and largest force of each
# contact, sampled each 2 ms
CASES = {
    "W2": (
        {"stiffness": 4e4, "damping": 600.0, "height": 1.2}, 0.1,
        [(0.41854866046, "impact", -5.25803339265e-01, -4.79408926977e-01),
         (0.54815244033, "deepest", -3.38010427187e-02, 1.62214112378e+03),
         (0.67114250558, "released", -5.98282567069e-03, 3.98859803680e-01),
         (0.68569041806, "impact", 4.23740262287e-01, 3.86351415615e-01),
         (0.94181795533, "peak", 4.76744587434e-02, 0.0),
         (1.19794549261, "impact", -3.86351415615e-01, -3.52261584825e-01),
         (1.31419153662, "deepest", -2.18323415040e-02, 1.04786914289e+03),
         (1.42224334312, "released", -4.38857364097e-03, 2.92573454348e-01),
         (1.43663751145, "impact", 3.17270549476e-01, 2.89276089228e-01),
         (1.61599197230, "peak", 2.54687194486e-02, 0.0),
         (1.79534643314, "impact", -2.89276089228e-01, -2.63751728414e-01),
         (1.89714604813, "deepest", -1.40539456462e-02, 6.74567184499e+02)],
        [(0.9026080036402646, 1645.2101153225324), (0.9200648019164165, 1066.1188164356442),
         (0.9319393432497972, 689.6772658589)],
    ),
    "W5": (
        {"stiffness": 5e3, "damping": 200.0, "height": 2.0}, 0.08,
        [(0.35608743056, "impact", -4.82077161197e-01, -4.39540941092e-01),
         (0.52947109324, "deepest", -3.89265117851e-02, 3.89166818124e+02),
         (0.67878033982, "released", -1.29792915860e-02, 3.24500511856e-01),
         (0.71533914577, "impact", 3.86098012631e-01, 3.52030540929e-01),
         (0.94241767484, "peak", 3.88148278385e-02, 0.0),
         (1.16949620391, "impact", -3.52030540929e-01, -3.20969022611e-01),
         (1.31259394184, "deepest", -2.31850000644e-02, 2.31829229598e+02),
         (1.42848006692, "released", -9.21221981575e-03, 2.30312010573e-01),
         (1.46388659578, "impact", 2.90433239285e-01, 2.64806776995e-01),
         (1.62604181915, "peak", 2.11489854094e-02, 0.0),
         (1.78819704251, "impact", -2.64806776995e-01, -2.41441473143e-01),
         (1.90492264100, "deepest", -1.41215948405e-02, 1.41211254917e+02)],
        [(0.9235377338799634, 410.07206205664744), (0.9361426208176977, 250.01382635367506),
         (0.9429909189344888, 157.8195102975307)],
    ),
}  # fmt: skip


def at_wall(body=SLENDER, *more, **values):
    return rk.Restrained(body, [rk.Wall(**{"side": "left", "stiffness": 4e4, **values}), *more])


def respond(name, engine, duration=2.3, **changes):
    values, rotation, _, _ = CASES[name]
    return rk.free_rocking(
        at_wall(**values | changes), rotation, "housner", gravity=G, engine=engine, duration=duration
    )


def record(seed=3, strength=6.0):
    rng = np.random.default_rng(seed)
    return rk.GroundMotion(strength * np.convolve(rng.standard_normal(500), np.ones(8) / 8.0, "same"), 0.01)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("computed anew", "two independent programs", within="1e-10", control="test_another_wall_is_seen")
def test_independent_values(name, engine):
    """Impacts, peaks, deepest points and ends of contacts are those of independent code."""
    assert np.max(np.abs(differences(respond(name, engine), name))) < 2e-11


def differences(response, name):
    """Return the differences from all rows of a case; forces are divided by 1e3 N.

    The force k d + c d' is 0 at the end of a contact, which gives the velocity.
    """
    run, wall = response.trajectory, response.body.restraints[0]
    impacts = [(e.time, e.before, e.after) for e in run.events if e.kind is EventKind.IMPACT]
    ends = [(e.time, e.rotation) for e in run.restraint_events if e.phase == "released"]
    rows = []
    for time, kind, first, second in CASES[name][2]:
        events = impacts if kind == "impact" else ends if kind == "released" else run.peaks
        event = min(events, key=lambda values: abs(values[0] - time))
        rows += [event[0] - time, event[1] - first]
        if kind == "impact":
            rows.append(event[2] - second)
        depth = -wall.height * math.sin(event[1])
        if kind == "deepest":
            rows.append((wall.stiffness * depth - second) / 1e3)
        if kind == "released":
            rows.append(wall.stiffness * depth / (wall.damping * wall.height * math.cos(event[1])) - second)
    return rows


@pytest.mark.verifies("negative control")
def test_another_wall_is_seen():
    """Negative control: a wall 1 mm lower, or a dashpot of 1 % more, misses the values."""
    values = CASES["W2"][0]
    for changes in ({"height": values["height"] - 1e-3}, {"damping": 1.01 * values["damping"]}):
        assert np.max(np.abs(differences(respond("W2", "fast", **changes), "W2"))) > 1e-5


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("computed anew", "two independent programs", within="5e-6")
def test_independent_floor_reaction(name, engine):
    """Minimum of f_z / m g and largest force of the wall in each contact.

    The source takes samples of 2 ms. At most 1 ms from an extreme, its values differ from the extreme by a fraction of
    w^2 (1 ms)^2 / 2 = 5e-5 of the amplitude, with the frequency w = 10 rad/s of the body at the wall.
    """
    expected = CASES[name][3]
    response = respond(name, engine)
    rows = np.array(response.trajectory.contacts)
    time, reaction = response._normal_forces
    starts = [e.time for e in response.trajectory.restraint_events if e.phase == "contact"]
    ends = [e.time for e in response.trajectory.restraint_events if e.phase == "released"]
    for start, end, (smallest, largest) in zip(starts, ends, expected, strict=False):
        assert reaction[(time >= start) & (time <= end)].min() == pytest.approx(smallest, abs=2e-6)
        force = rows[(rows[:, 0] >= start) & (rows[:, 0] <= end), 3]
        assert -force.min() == pytest.approx(largest, rel=3e-5)
    assert response.least_force == pytest.approx(expected[0][0], abs=2e-6)
    assert response.restraints.records[0]["smallest_force"] == pytest.approx(-expected[0][1], rel=5e-6)
    assert not response.doubts()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.verifies("invariant", "energy", within="1e-10")
def test_energy_closes_under_a_record(engine, side):
    """Work of the ground = kinetic + potential + walls (with their dashpots) + impacts; the dashpot dissipates."""
    for walls in (
        at_wall(SKEW, side=side, damping=600.0, gap=0.01),
        at_wall(SKEW, rk.Wall(side="right", stiffness=1e5, height=1.5), rk.Tendon(x=0.3, stiffness=1e5), damping=300.0),
    ):
        response = rk.simulate(walls, record(), "housner", gravity=G, engine=engine, duration=6.0)
        assert response.energy_closure < 1e-10
        assert len(response.trajectory.restraint_events) > 10
        assert response.restraints.records[0]["dissipated_energy"] > 1.0


@pytest.mark.parametrize("gap", [0.0, 0.01])
@pytest.mark.verifies("second engine", "the reference engine", within="1e-12")
def test_both_engines_agree_under_a_record(gap):
    """The compiled and the reference engine give the same events and the same response with two walls."""
    other = rk.Wall(side="right", stiffness=1e5, height=1.5, damping=90.0, gap=0.02)
    body = at_wall(SKEW, other, gap=gap, damping=600.0)
    first, second = (rk.simulate(body, record(4), "housner", engine=engine, duration=6.0) for engine in ENGINES)
    assert np.max(np.abs(first.rotation - second.rotation)) < 1e-12
    phases = [[(e.index, e.phase) for e in r.trajectory.restraint_events] for r in (first, second)]
    assert phases[0] == phases[1]
    assert {"contact", "released", "open"} <= {phase for _, phase in phases[0]}
    assert first.least_force == pytest.approx(second.least_force, rel=1e-10)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("invariant", "the body without a wall", within="1e-12")
def test_a_wall_out_of_reach_changes_nothing(engine):
    """A wall beyond the largest displacement: the response of the body alone."""
    for body, strength in ((SLENDER, 4.0), (SKEW, 5.5)):
        options = {"restitution": "housner", "gravity": G, "duration": 6.0}
        alone = rk.simulate(rk.Restrained(body, []), record(5, strength), engine=engine, **options)
        response = rk.simulate(at_wall(body, gap=2.5, damping=1e3), record(5, strength), engine=engine, **options)
        assert alone.peak_rotation > 0.01
        assert np.max(np.abs(response.rotation - alone.rotation)) < 1e-12
        assert response.peak_rotation == pytest.approx(alone.peak_rotation, rel=1e-12)
        near = rk.simulate(at_wall(body, gap=0.01, damping=1e3), record(5, strength), engine=engine, **options)
        assert np.max(np.abs(near.rotation[:500] - alone.rotation[:500])) > 1e-3  # negative control


@pytest.mark.parametrize("law", ["compliant", "plastic"])
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("invariant", "the mirror image", within="1e-12")
def test_mirror_image(engine, law):
    """An asymmetric body, its wall and its motion reversed: the rotation changes its sign."""
    mirrored = rk.Block(
        width=0.6, height=2.0, mass=500.0, centre=(0.6 - 0.22, 0.9), moment_of_inertia=170.0,
    )  # fmt: skip
    values = {"law": law} | ({"stiffness": None} if law == "plastic" else {"damping": 600.0, "gap": 0.01})
    first = rk.simulate(at_wall(SKEW, **values), record(6), "housner", engine=engine)
    second = rk.simulate(at_wall(mirrored, side="right", **values), record(6), "housner", engine=engine, scale=-1.0)
    assert first.peak_rotation > 0.004
    assert np.max(np.abs(first.rotation + second.rotation)) < 1e-12
    same = rk.simulate(at_wall(mirrored, **values), record(6), "housner", engine=engine, scale=-1.0)
    assert np.max(np.abs(first.rotation[:300] + same.rotation[:300])) > 1e-3  # negative control


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("computed anew", "Dormand-Prince with the force max(0, k d + c d')", within="1e-8")
def test_contact_by_a_stepwise_integration(engine):
    """The time and the depth of a contact with a gap are those of a non-smooth integration without phases."""
    body = at_wall(SLENDER, gap=0.02, damping=600.0, height=1.6)
    response = rk.free_rocking(body, 0.12, 0.95, gravity=G, engine=engine, duration=1.0)
    side = SLENDER.side("left", G)
    start = response.trajectory.events[1]

    def slopes(_, state):
        theta, rate = state
        d, speed = -1.6 * math.sin(theta) - 0.02, -1.6 * math.cos(theta) * rate
        force = max(0.0, 4e4 * d + 600.0 * speed) if d > 0.0 else 0.0
        moment = 500.0 * G * side.semi_diagonal * math.sin(-side.slenderness_angle - theta)
        return rate, (-moment + force * 1.6 * math.cos(theta)) / side.moment_of_inertia

    lands = lambda _, state: state[0]  # noqa: E731
    lands.terminal, lands.direction = True, 1
    run = solve_ivp(
        slopes, (start.time, start.time + 2.0), [-1e-300, start.after], "DOP853", max_step=2e-4, rtol=1e-11, atol=1e-14,
        events=lands,
    )  # fmt: skip
    second = response.trajectory.events[2]
    assert run.t[-1] == pytest.approx(second.time, abs=1e-8)
    assert run.y[1, -1] == pytest.approx(second.before, abs=1e-7)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("closed form", "equilibrium of moments of a rectangle", within="1e-6")
def test_floor_reaction_at_the_first_contact(engine):
    """At theta = 0 the floor pulls if F > m g (4 R^2 / 3 - b^2) / (b z); the message has time and force."""
    b, z, mass = 0.25, 2.0, 500.0
    limit = mass * G * (4.0 * SLENDER.semi_diagonal**2 / 3.0 - b**2) / (b * z)
    assert limit / (mass * G) == pytest.approx(2.708, abs=5e-4)
    free = rk.free_rocking(SLENDER, 0.1, "housner", gravity=G)
    after = abs(free.trajectory.events[1].after)
    rate_term = 1.0 * after**2 / G  # h theta'^2 / g, at theta = 0
    # f_z / m g = 1 - rate_term - b^2 / (4 R^2 / 3) + F b z / (m g 4 R^2 / 3) with F < 0
    inertia = 4.0 * SLENDER.semi_diagonal**2 / 3.0
    exact = (1.0 - rate_term - b**2 / inertia) * mass * G * inertia / (b * z)
    for factor, tensile in ((0.999, False), (1.001, True)):
        damping = factor * exact / (z * after)
        body = at_wall(SLENDER, height=z, stiffness=1.0, damping=damping)
        with pytest.warns(PureRockingWarning) if tensile else nullcontext():
            response = rk.free_rocking(body, 0.1, "housner", gravity=G, engine=engine, duration=1.0)
        assert response.lost_contact is tensile
        assert response.least_force == pytest.approx((1.0 - rate_term - b**2 / inertia) * (1.0 - factor), abs=1e-9)
        answer = response.answer()
        if tensile:
            start = response.trajectory.events[1].time
            assert answer["lost_contact_time"] == pytest.approx(start, abs=1e-9)
            assert f"at {start:.4g} s" in str(answer["warnings"][0])
        else:
            assert math.isnan(answer["lost_contact_time"])
            assert not answer["warnings"]


def stop(left, right, centre, top, inertia):
    """Return the velocity after an impact on floor and wall with impulses >= 0, for unit mass and unit rate.

    The velocity is the projection of the velocity before on all velocities without penetration (Gauss's principle).
    """
    # velocity: x to the right, z upwards, clockwise rotation; the body rotates anticlockwise about its right foot
    before = np.array([-centre, -right, -1.0])
    gaps = np.array([
        [0.0, 1.0, left], [0.0, 1.0, -right],  # floor: left foot, right foot
        [1.0, 0.0, top - centre], [1.0, 0.0, -centre],  # wall: top, foot
    ])  # fmt: skip
    root = np.sqrt([1.0, 1.0, inertia])
    impulses, _ = nnls((gaps / root).T, -root * before)
    after = before + gaps.T @ impulses / root**2
    assert np.all(gaps @ after > -1e-12)
    assert abs(impulses @ gaps @ after) < 1e-12
    return after


@pytest.mark.verifies("computed anew", "complementarity of impulses and velocities", within="1e-12")
def test_rigid_wall_and_floor_stop_the_body():
    """Random rectangles and asymmetric bodies stop at a plastic wall, as by the problem of impulses; others do not."""
    rng = np.random.default_rng(1)
    for k in range(40):
        width, height = rng.uniform(0.3, 2.0), rng.uniform(0.5, 4.0)
        values = {}
        if k % 2:
            centre = width * rng.uniform(0.2, 0.8), height * rng.uniform(0.2, 0.7)
            most = centre[0] * (width - centre[0]) + centre[1] * (height - centre[1])
            values = {"centre": centre, "moment_of_inertia": 100.0 * rng.uniform(0.2, 0.999) * most}
        body = rk.Block(width=width, height=height, mass=100.0, **values)
        x, z = body.centre
        inertia = body.side("left").moment_of_inertia / 100.0 - body.side("left").semi_diagonal ** 2
        assert np.max(np.abs(stop(x, width - x, z, height, inertia))) < 1e-12
        angle = 0.3 * body.side("right").slenderness_angle
        walls = at_wall(body, law="plastic", stiffness=None)
        response = rk.free_rocking(walls, angle, "housner", gravity=G, duration=9.0)
        assert [e.kind for e in response.trajectory.events] == [EventKind.UPLIFT, EventKind.IMPACT, EventKind.REST]
        assert response.trajectory.events[1].before < 0.0 == response.trajectory.events[1].after
        assert response.energy_closure < 1e-12
    # negative control: a body with more inertia than its box allows, or a low wall
    assert np.max(np.abs(stop(0.25, 0.25, 1.0, 2.0, 1.2))) > 1e-3
    assert np.max(np.abs(stop(0.25, 0.25, 1.0, 1.2, (0.25**2 + 1.0) / 3.0))) > 1e-3
    with pytest.raises(InvalidValueError, match="tensile forces"):
        at_wall(SLENDER, law="plastic", stiffness=None, height=1.2)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("closed form", "Sorrentino et al. (2008)", within="1e-12")
def test_sorrentino(engine):
    """Speeds after the first three returns of a block of slenderness 4; the answer states the conditions of the law."""
    body = at_wall(rk.Block(width=1.0, height=4.0, mass=2000.0), law="sorrentino", stiffness=None)
    assert body.restraints[0].rebound(body.body) == pytest.approx(-0.342306126603, abs=1e-12)
    with pytest.warns(PureRockingWarning, match="friction at the wall"):
        response = rk.free_rocking(body, 0.1, 0.5, gravity=G, engine=engine)
    impacts = [e for e in response.trajectory.events if e.kind is EventKind.IMPACT]
    assert impacts[0].before == pytest.approx(-0.371799106765, abs=1e-12)
    assert [e.after for e in impacts[:3]] == pytest.approx([0.127269112111, 0.043564996803, 0.014912565311], abs=1e-12)
    assert np.all(response.rotation >= 0.0)
    assert response.rotation[-1] == 0.0
    assert response.energy_closure < 1e-12
    with pytest.raises(InvalidValueError, match="homogeneous rectangle"):
        at_wall(SKEW, law="sorrentino", stiffness=None)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("behaviour")
def test_a_rigid_wall_blocks_one_direction(engine, tmp_path):
    """Under a record the body rotates only away from the wall, and a rotation into the wall is refused."""
    body = at_wall(SLENDER, law="plastic", stiffness=None)
    response = rk.simulate(body, record(7), "housner", gravity=G, engine=engine)
    assert response.rotation.min() == 0.0
    assert response.rotation.max() > 0.005
    assert response.trajectory.uplifts > 1
    response.report(tmp_path / "report.html")
    text = " ".join((tmp_path / "report.html").read_text("utf-8").split())
    assert "2.453 m/s2 about the right foot, no uplift about the left foot at a rigid wall" in text
    for refused in (lambda: rk.free_rocking(body, -0.05, "housner"), lambda: rk.pushover(body, [0.0, -0.01])):
        with pytest.raises(InvalidValueError, match="cannot rotate to the left"):
            refused()


@pytest.mark.verifies("behaviour")
def test_doors(tmp_path):
    """Files, answers, and refusals: positions of a wall, missing stiffness, studies."""
    body = at_wall(SKEW, gap=0.01, damping=5.0, name="north wall")
    path = tmp_path / "wall.toml"
    path.write_text(body_to_toml(body))
    assert rk.read_body(path).restraints == body.restraints
    assert body.restraints[0].ends == ((-0.01, 2.0), (0.0, 2.0))
    path.write_text(
        'units = "cm"\n[block]\nwidth = 50\nheight = 200\n[[restraint]]\nkind = "wall"\nside = "right"\nheight = 120\n'
        "gap = 1\nstiffness = 4e4\n"
    )
    assert rk.read_body(path).restraints[0].ends == ((0.51, 1.2), (0.5, 1.2))
    answer = rk.free_rocking(body, 0.05, "housner").answer()
    assert answer["restraints"].records[0]["restraint_kind"] == "wall"
    for values, text in (
        ({"stiffness": None}, "needs stiffness"), ({"law": "plastic"}, "no gap, stiffness"),
        ({"ground": (0.0, 0.0)}, "does not apply to a wall"), ({"side": "top"}, "side"),
    ):  # fmt: skip
        with pytest.raises(InvalidValueError, match=text):
            at_wall(SLENDER, **values)
    with pytest.raises(InvalidValueError, match="do not support walls"):
        rk.simulate_many(body, record(), restitution="housner")
    with pytest.raises(InvalidValueError, match="do not support walls"):
        rk.fragility(body, [record()], restitution="housner")


@pytest.mark.verifies("closed form", "k d z cos theta", within="1e-9")
def test_pushover_into_a_wall():
    """The moment of a compliant wall in a slow rotation is k d z cos theta beyond the gap."""
    theta = -np.linspace(0.0, 0.05, 11)
    alone, wall = (rk.pushover(b, theta) for b in (rk.Restrained(SLENDER, []), at_wall(gap=0.02, height=1.5)))
    d = np.maximum(1.5 * np.sin(-theta) - 0.02, 0.0)
    assert np.allclose(alone.restoring_moment - wall.restoring_moment, 4e4 * d * 1.5 * np.cos(theta), rtol=0, atol=1e-9)


@pytest.mark.verifies("behaviour")
def test_a_body_away_from_a_rigid_wall_may_fall_back():
    """The velocity at the start points to the wall, but the body is not upright."""
    tower = rk.Block(width=1.0, height=4.0, mass=2000.0)
    adjacent = rk.Restrained(tower, rk.Wall(side="left", law="plastic"))
    response = rk.free_rocking(adjacent, rotation=0.1, angular_velocity=-0.2, restitution=0.9)
    assert response.impacts.size == 1
    assert response.rotation[-1] == 0.0
    with pytest.raises(rk.errors.InvalidValueError, match="rigid"):
        rk.free_rocking(adjacent, rotation=0.0, angular_velocity=-0.2, restitution=0.9)


TRAPEZOID = rk.Section([rk.Region([(0.0, 0.0), (1.0, 0.0), (0.8, 3.0), (0.2, 3.0)], 2000.0)])


@pytest.mark.verifies("behaviour")
def test_walls_touch_points_of_the_body():
    """The default point of a wall is on the outline at its height; a rigid wall needs a vertical face."""
    wall = rk.Restrained(TRAPEZOID, rk.Wall(side="left", height=1.5, stiffness=1e5)).restraints[0]
    assert wall.ends[1] == pytest.approx((0.1, 1.5), abs=1e-12)
    right = rk.Restrained(TRAPEZOID, rk.Wall(side="right", stiffness=1e5)).restraints[0]
    assert right.ends[1] == pytest.approx((0.8, 3.0), abs=1e-12)
    step = rk.Section([rk.Region([(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.6, 2.0), (0.6, 3.0), (0.0, 3.0)], 2000.0)])
    assert rk.Restrained(step, rk.Wall(side="left", law="plastic")).restraints[0].ends[1] == (0.0, 3.0)


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("body", "values", "name"),
    [
        (TRAPEZOID, {"law": "plastic"}, "vertical face"), (TRAPEZOID, {"height": 10.0, "stiffness": 1e5}, "height"),
        (TRAPEZOID, {"x": 50.0, "stiffness": 1e5}, "x"),
        (rk.Block(width=1.0, height=4.0), {"x": 0.5, "law": "plastic"}, "vertical face"),
    ],
)  # fmt: skip
def test_points_that_are_not_on_the_body_are_refused(body, values, name):
    """A wall acts on no point outside the body."""
    with pytest.raises(rk.errors.InvalidValueError, match=name):
        rk.Restrained(body, rk.Wall(side="left", **values))


@pytest.mark.verifies("damage")
@pytest.mark.parametrize("value", [5, None, "tendon"])
def test_restraints_and_columns_are_lists(value):
    """No type of Python is an error without a sentence."""
    with pytest.raises(rk.errors.InvalidValueError, match="restraints"):
        rk.Restrained(rk.Block(width=1.0, height=4.0), value)
    with pytest.raises(rk.errors.InvalidValueError, match="columns"):
        rk.Frame(value, beam_mass=100.0)
