"""Stacks of two blocks against independent values: histories with sticking joints, and the table of landings.

The values are those of two routes of independent code (Lagrange's equations by Dormand-Prince, and contact forces with
x, z and theta by Gragg-Bulirsch-Stoer); they agree to 1e-13. Case names are those of the source.
"""

import contextlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.stack.chain import Chain
from rocking.dynamics.stack.contact_choice import corner_rows, under_forces
from rocking.dynamics.stack.time_stepping import COMPILED
from rocking.dynamics.stack.trajectory import CLOSES, IMPACT, OPENS, PEAK
from rocking.errors import GeometryError, InvalidValueError
from rocking.outcome import Regime, Status

pytestmark = pytest.mark.verifies(room="rocking in the plane")
fast = pytest.mark.skipif(not COMPILED.available(), reason="the compiled engine of stacks was not built")

G = 9.81


def stack(*sizes, **options):
    return rk.Stack([rk.Block(width=w, height=h, density=1000.0) for w, h in sizes], **options)


@dataclass(frozen=True)
class Case:
    """Events: time, kind, joint, theta of both bodies, theta' before, and theta' after an impact."""

    sizes: tuple
    motion: tuple | None
    rotation: tuple
    duration: float
    events: list
    totals: tuple  # input and loss at the end of the last event [J]
    normal: float


CASES = {
    "SH1": Case(
        ((1.0, 2.0), (0.6, 2.0)), (4.0, 0.8), (0.0, 0.0), 0.97,
        [(0.09885408749, OPENS, 1, (0.0, 0.0), (0.0, 0.0), None),
         (0.32213270444, OPENS, 2, (-7.43810402165e-03, -7.43810402165e-03), (-6.02695964658e-02, -6.02695964658e-02),
          None),
         (0.39893840012, PEAK, 1, (-1.03934167666e-02, -1.18639609475e-02), (0.0, -5.89013229721e-02), None),
         (0.49912150993, IMPACT, 1, (0.0, -1.94190258531e-02), (2.37365833335e-01, -1.02410270391e-01),
          (1.47425679319e-01, 5.39867772323e-02)),
         (0.50935578687, PEAK, 2, (1.38497637955e-03, -1.85114654184e-02), (1.23418267034e-01, 1.23418267034e-01),
          None),
         (0.57060856199, PEAK, 1, (5.00769744358e-03, 1.87721852775e-03), (0.0, 5.43222900985e-01), None),
         (0.57612826621, IMPACT, 2, (4.98058885767e-03, 4.98058885767e-03), (-9.79524427306e-03, 5.81248556207e-01),
          (1.06960135639e-02, 4.79000935636e-01)),
         (0.79107623512, PEAK, 1, (1.57456780205e-02, 1.10550184126e-01), (0.0, 5.62414318343e-01), None),
         (0.91830380554, IMPACT, 1, (0.0, 1.96097321649e-01), (-2.58237791731e-01, 8.09911362746e-01),
          (-1.60318265127e-01, 6.57560453992e-01)),
         (0.96243083059, PEAK, 1, (-3.54227795539e-03, 2.19644479420e-01), (0.0, 4.09948292993e-01), None)],
        (9.133870370e02, 2.123504776e02), 0.607,
    ),
    "SH2": Case(
        ((1.0, 2.0), (1.0, 2.0)), None, (0.06, -0.04), 0.43,
        [(0.14398877600, IMPACT, 2, (2.40512174757e-02, 2.40512174757e-02), (-4.89603451219e-01, 8.73182994546e-01),
          (-2.39295736690e-01, 1.63977803383e-01)),
         (0.25279325460, IMPACT, 1, (0.0, 2.31985161298e-02), (-2.06181902407e-01, -1.75922672089e-01),
          (-1.29654757791e-01, -3.05877074506e-01)),
         (0.28925208808, PEAK, 1, (-2.35278077673e-03, 7.97768562246e-03), (0.0, -5.28879482942e-01), None),
         (0.30619126653, IMPACT, 2, (-1.85309939489e-03, -1.85309939489e-03), (5.88176879125e-02, -6.31704427930e-01),
          (-6.80129047932e-02, -2.72351081930e-01)),
         (0.36372136504, PEAK, 2, (-6.25312008752e-03, -1.21313306154e-02), (-8.52241830493e-02, -8.52241830493e-02),
          None),
         (0.42100323009, IMPACT, 2, (-1.16718236898e-02, -1.16718236898e-02), (-1.04369087248e-01, 1.01740834144e-01),
          (-4.81572905046e-02, -1.06827593425e-02)),
         (0.42484372361, PEAK, 2, (-1.18305794192e-02, -1.17586175976e-02), (-3.45176859768e-02, -3.45176859768e-02),
          None),
         (0.42868417144, IMPACT, 2, (-1.19369566635e-02, -1.19369566635e-02), (-2.08813911238e-02, -5.83568140082e-02),
          (-2.77646320618e-02, -3.88542980173e-02))],
        (0.0, 1.795620217e03), 0.267,
    ),
    "SH3": Case(
        ((1.0, 1.0), (0.6, 2.4)), None, (0.0, 0.15), 2.9,
        [(0.65719679099, IMPACT, 2, (0.0, 0.0), (0.0, -5.49161172575e-01), (0.0, -5.00705774995e-01)),
         (1.15993967680, PEAK, 2, (0.0, -1.12342246130e-01), (0.0, 0.0), None),
         (1.66268256262, IMPACT, 2, (0.0, 0.0), (0.0, 5.00705774995e-01), (0.0, 4.56525853672e-01)),
         (2.07887013767, PEAK, 2, (0.0, 8.77293219685e-02), (0.0, 0.0), None),
         (2.49505771272, IMPACT, 2, (0.0, 0.0), (0.0, -4.56525853672e-01), (0.0, -4.16244160701e-01)),
         (2.85115949901, PEAK, 2, (0.0, -6.98638159955e-02), (0.0, 0.0), None)],
        (0.0, 1.884746419e02), 0.919,
    ),
}  # fmt: skip


def response_of(case, sizes=None):
    options = {"gravity": G, "duration": case.duration, "engine": "reference"}
    body = stack(*(sizes or case.sizes))
    if case.motion is None:
        return rk.free_rocking(body, rotation=case.rotation, **options)
    return rk.simulate(body, rk.pulses.sine(*case.motion), **options)


def miss(case, response):
    """Return the largest difference from the events of a case, relative to 1 or to the value."""
    computed = response.trajectory.events[: len(case.events)]
    if [(e.kind, e.joint + 1) for e in computed] != [event[1:3] for event in case.events]:
        return np.inf
    pairs = []
    for event, (time, _, _, rotation, before, after) in zip(computed, case.events, strict=True):
        pairs += [
            (event.time, time),
            *zip(event.rotation, rotation, strict=True),
            *zip(event.before, before, strict=True),
        ]
        pairs += zip(event.after, after, strict=True) if after else []
    return max(abs(a - b) / max(1e-2, abs(b)) for a, b in pairs)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("computed anew", "two independent programs", within="1e-9", control="test_a_wider_block_is_seen")
def test_independent_histories_of_two_blocks(name):
    """Openings, impacts and turning points of two blocks with sticking joints are those of independent code."""
    case = CASES[name]
    response = response_of(case)
    assert miss(case, response) < 1e-9
    assert response.trajectory.least_normal.min() == pytest.approx(case.normal, rel=0.02)  # a minimum over other times


@pytest.mark.verifies("negative control")
def test_a_wider_block_is_seen():
    """Negative control: an upper block 0.1 mm wider misses the values by far more than the tolerance."""
    assert miss(CASES["SH1"], response_of(CASES["SH1"], ((1.0, 2.0), (0.6001, 2.0)))) > 1e-5


@pytest.mark.parametrize("name", ["SH1", "SH2", "SH3"])
@pytest.mark.verifies("computed anew", "two independent programs", within="1e-9")
def test_independent_energy_of_two_blocks(name):
    """Energy lost in impacts up to the last event of the case, and the work of the ground at its end."""
    case = CASES[name]
    response = response_of(case)
    run, last = response.trajectory, case.events[-1][0]
    until = np.flatnonzero(run.time >= last)[0]
    assert run.lost[until] == pytest.approx(case.totals[1], rel=1e-9)
    assert run.work[-1] == pytest.approx(case.totals[0], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("invariant", "energy", within="1e-10")
def test_energy_of_a_stack_closes(name):
    """Kinetic and potential energy are the work of the ground minus the losses in impacts, at every sample."""
    assert response_of(CASES[name]).energy_closure < 1e-10


LANDINGS = {
    ((1, 2), (1, 2)): "-31/34 -31/34 -0 ; -9/49 -47/98 -- ; -202/319 -1359/638 -+ ; -101/98 41/49 --",
    ((1, 4), (1, 2)): "-71/74 -71/74 -0 ; -9/133 -143/266 -- ; -1076/1259 -5301/2518 -+ ; -269/266 110/133 --",
    ((1, 1), (1, 3)): "-31/34 -31/34 -0 ; -81/197 -131/197 -- ; -109/346 -321/173 -+ ; -218/197 275/394 --",
    ((1, 2), (0.6, 2)): "-0.8439906795 -1.0147104589 -- ; -0.0346696096 -0.8270050029 -- ; "
    "-0.6223071524 -2.1638115219 -+ ; -0.8439906795 0.4852895411 --",
    ((1, 1), (0.6, 2.4)): "-6661/13306 -1.1613933564 -- ; 0 -31/34 0- ; -0.2197189603 -15266/7579 -+ ; "
    "-6661/13306 0.3386066436 --",
    ((2, 1), (1, 4)): "0 -83/68 0- ; 0 -31/34 0- ; 0 -129/68 0+ ; 0 19/68 0-",
}
PATTERNS = [((1, 0), (-1.0, -1.0), 1), ((0, 1), (0.0, -1.0), 2), ((1, 1), (-1.0, -1.5), 1), ((1, -1), (-1.0, 0.5), 1)]


@pytest.mark.parametrize("sizes", LANDINGS, ids=str)
@pytest.mark.verifies("computed anew", "exact fractions", within="1e-12, decimals to 1e-10")
def test_landings_of_two_blocks(sizes):
    """Velocities and contacts after impacts from four patterns: impulses and gap velocities are complementary."""
    for (sides, rates, joint), row in zip(PATTERNS, LANDINGS[sizes].split(" ; "), strict=True):
        *expected, signs = row.split()
        impact = rk.dynamics.stack_impact(stack(*sizes), joint, sides, rates)
        for value, text in zip(impact.angular_velocity, expected, strict=True):
            assert value == pytest.approx(float(Fraction(text)), abs=1e-10 if "." in text else 1e-12)
        assert "".join({1: "+", -1: "-", 0: "0"}[side] for side in impact.sides) == signs
        scale = max(impact.impulses)
        assert min(impact.impulses) >= -1e-12 * scale
        assert min(impact.gap_velocities) >= -1e-12
        assert all(abs(a * b) < 1e-12 * scale for a, b in zip(impact.impulses, impact.gap_velocities, strict=True))
        assert impact.energy_lost > 0.0


@pytest.mark.verifies("negative control")
def test_a_landing_as_a_monolith_is_seen():
    """Negative control: the rule of a rigid column, with the joint kept closed, misses the narrow upper block."""
    body = stack((1, 2), (0.6, 2))
    side, mass = body.side("left"), body.mass
    height, inertia = side.centre_height, side.moment_of_inertia
    rigid = 1.0 - 2.0 * mass * side.half_width**2 / inertia  # Housner's coefficient of the column as one body
    assert height > 0.0
    assert abs(rigid - 0.8439906795) > 1e-3


@pytest.mark.parametrize("motion", [None, (3.0, 0.8)])
@pytest.mark.verifies("second engine", "the plane engine with Housner's restitution", within="1e-11")
def test_a_stack_of_one_is_a_block(motion):
    """A stack of one block has the impacts of the plane engine, with Housner's coefficient without being stated."""
    block = rk.Block(width=1.0, height=4.0)
    options = {"duration": 6.0}
    if motion is None:
        response = rk.free_rocking(rk.Stack([block]), rotation=0.1, **options)
        expected = rk.free_rocking(block, rotation=0.1, restitution="housner", **options)
    else:
        pulse = rk.pulses.sine(*motion)
        response = rk.simulate(rk.Stack([block]), pulse, **options)
        expected = rk.simulate(block, pulse, "housner", **options)
    times = [event.time for event in response.trajectory.events if event.kind == IMPACT]
    assert len(times) == len(expected.impacts) > 5
    np.testing.assert_allclose(times, expected.impacts["time"], rtol=1e-11)


@pytest.mark.verifies("invariant", "a block cut in two", within="1e-12")
def test_a_block_cut_in_two():
    """Two halves of a squat block, cut horizontally, move as one block: the joint between the halves stays closed."""
    options = {"rotation": 0.2, "duration": 2.0}
    cut = rk.free_rocking(stack((1.0, 1.0), (1.0, 1.0)), **options)
    block = rk.free_rocking(stack((1.0, 2.0)), **options)
    first, expected = ([e for e in r.trajectory.events if e.kind == IMPACT] for r in (cut, block))
    assert len(first) == len(expected) > 1
    for a, b in zip(first, expected, strict=True):
        np.testing.assert_allclose((a.time, *a.before, *a.after), (b.time, *b.before * 2, *b.after * 2), atol=1e-12)
    assert cut.joint_states == ("rocking", "monolithic")


@pytest.mark.verifies("invariant", "mirror image", within="1e-12")
def test_the_mirror_image_of_a_stack():
    """The reversed motion gives the mirror image."""
    body, pulse = stack((1.0, 2.0), (0.6, 2.0)), rk.pulses.sine(4.0, 0.8)
    left, right = (rk.simulate(body, pulse, scale=s, duration=1.0) for s in (1.0, -1.0))
    np.testing.assert_allclose(left.rotation, -right.rotation, atol=1e-12)


@pytest.mark.verifies("computed anew", "forces of all corners as one linear problem", within="1e-9")
def test_forces_of_corners():
    """The corner forces from moments are the multipliers of the problem over all corners."""
    chain = Chain.of(stack((1.0, 2.0), (0.6, 2.0)), G)
    for sides, rotation, rates in (((0, 0), (0.0, 0.0), (0.0, 0.0)), ((1, 0), (0.3, 0.3), (0.1, 0.1))):
        ground = (0.5, 0.2)
        forces, problem = (solve(chain, sides, rotation, rates, ground) for solve in (Chain.forces, under_forces))
        rows = corner_rows(chain, sides, rotation, {k for k in (0, 1) if sides[k] == 0})
        for row, multiplier in zip(rows, problem.multipliers, strict=True):
            if row.is_one_sided:
                force = forces[row.joint]
                expected = (force.right if row.side > 0 else force.left) if sides[row.joint] == 0 else force.normal
                assert multiplier == pytest.approx(expected, rel=1e-9)


@pytest.mark.verifies("behaviour")
def test_chattering_joints_close():
    """Impacts of a joint follow each other faster and faster; the closing rule ends the series, and energy closes."""
    response = rk.free_rocking(stack((1.0, 2.0), (1.0, 2.0)), rotation=(0.06, -0.04), duration=5.0)
    assert response.trajectory.events[-1].sides_after == (0, 0)
    assert not response.still_rocking
    assert response.energy_closure < 1e-10
    closer = rk.free_rocking(stack((1.0, 2.0), (1.0, 2.0)), rotation=(0.06, -0.04), duration=5.0, rest_speed=1e-4)
    assert closer.trajectory.impacts > response.trajectory.impacts
    assert closer.trajectory.lost[-1] == pytest.approx(response.trajectory.lost[-1], rel=1e-9)  # all energy is lost


@pytest.mark.verifies("behaviour")
def test_the_limit_of_sticking_is_stated():
    """With little friction the response states joint, time and ratio; the time is that of the first excess."""
    options = {"gravity": G, "duration": 0.97, "engine": "reference"}
    with pytest.warns(rk.errors.PureRockingWarning, match=r"joint 1 slides from .* s: sticking needs friction 0.487"):
        response = rk.simulate(stack((1, 2), (0.6, 2), friction=0.45), rk.pulses.sine(4.0, 0.8), **options)
    assert len(response.doubts()) == 1
    assert response.answer()["warnings"] == response.doubts()
    enough = rk.simulate(stack((1, 2), (0.6, 2), friction=0.5), rk.pulses.sine(4.0, 0.8), **options)
    assert enough.doubts() == []


@pytest.mark.verifies("behaviour")
def test_outcome_of_joints():
    """An upper block overturns alone: its joint is named, and the joint below is not."""
    response = rk.simulate(stack((1.0, 2.0), (0.6, 2.0)), rk.pulses.sine(4.0, 0.8))
    assert response.outcome is rk.Outcome.OVERTURNED
    assert response.joint_states == ("rocking", "overturned")
    assert "overturned at joint 2" in response.summary
    assert rk.simulate(stack((2.0, 2.0), (2.0, 2.0)), rk.pulses.sine(1.0, 0.8)).joint_states == ("monolithic",) * 2


@pytest.mark.verifies("behaviour")
def test_sections_stand_on_top_edges():
    """A trapezoid of the outline of a block gives the block's stack; contact corners follow the narrower face."""
    box = rk.Section.from_trapezoid(1.0, 1.0, 2.0, density=1000.0)
    free = {"rotation": (0.0, 0.1), "duration": 0.4}
    upper = rk.Block(width=0.6, height=2.0, density=1000.0)
    sections, blocks = (
        rk.free_rocking(rk.Stack([lower, upper]), **free) for lower in (box, stack((1.0, 2.0)).bodies[0])
    )
    np.testing.assert_allclose(sections.rotation, blocks.rotation, atol=1e-12)
    wide = rk.Stack([rk.Section.from_trapezoid(1.0, 0.5, 2.0), rk.Block(width=0.8, height=1.0)], offsets=0.1)
    joint = wide.joints[1]
    assert (joint.left, joint.right) == pytest.approx((-0.25, 0.25))
    assert not joint.left_above
    assert not joint.right_above


@pytest.mark.verifies("damage")
def test_refusals_of_stacks():
    """The refusals of impossible stacks contain the number of the joint or body."""
    with pytest.raises(GeometryError, match="joint 2 does not support"):
        stack((1.0, 1.0), (1.0, 1.0), offsets=0.6)
    with pytest.raises(GeometryError, match="body 2 has no support"):
        stack((1.0, 1.0), (1.0, 1.0), offsets=2.0)
    with pytest.raises(GeometryError, match="horizontal top edge"):
        rk.Stack([rk.Section.from_points([(0, 0), (1, 0), (0.5, 2)]), rk.Block(width=0.1, height=0.1)])
    with pytest.raises(InvalidValueError, match="friction"):
        stack((1.0, 1.0), (1.0, 1.0), friction=(0.1, 0.2, 0.3))
    with pytest.raises(InvalidValueError, match="restitution"):
        rk.free_rocking(stack((1.0, 2.0)), rotation=0.1, restitution="housner")
    with pytest.raises(InvalidValueError, match="rotation"):
        rk.free_rocking(stack((1.0, 2.0)), rotation=(0.1, 0.2))


def shaking(rng, amplitude, count=300, step=0.01):
    values = np.convolve(rng.normal(size=count), np.hanning(9), "same")
    values[0] = 0.0
    return rk.GroundMotion(values / np.abs(values).max() * amplitude, step)


@pytest.mark.parametrize("seed", [9, 14, 17])
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@pytest.mark.verifies("invariant", "energy of closing joints", within="1e-9")
def test_closing_joints_create_no_energy(seed):
    """Random stacks under both components: the lost energy never falls, also where chattering joints close."""
    rng = np.random.default_rng(seed)
    sizes = zip(rng.uniform(0.4, 1.2, 2).tolist(), rng.uniform(0.5, 2.0, 2).tolist(), strict=True)
    body = stack(*sizes, offsets=float(rng.uniform(-0.08, 0.08)))
    uplift = min(body.side_above(k, foot).uplift_acceleration for k in (0, 1) for foot in ("left", "right"))
    response = rk.simulate(body, {"x": shaking(rng, 1.5 * uplift), "z": shaking(rng, 1.0)}, duration=3.3)
    run = response.trajectory
    assert sum(event.kind == CLOSES for event in run.events) > 30
    assert np.diff(run.lost).min() >= -1e-9 * run.lost[-1]
    assert response.energy_closure < 1e-9


@pytest.mark.parametrize("friction", [None, pytest.param(5.0, marks=fast)])
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@pytest.mark.parametrize("low", [(), ((1.5, 0.5),)], ids=["one", "two"])
@pytest.mark.verifies("second engine", "outcome of the plane engine", within="")
def test_a_fall_after_the_end_is_overturning(friction, low):
    """A stated duration that ends in the fall gives the outcome of the block, and the time of the longer history."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(4.0, 0.8)
    body = rk.Stack([*stack(*low).bodies, block] if low else [block], friction=friction)
    longer, cut, gentle = (
        rk.simulate(body, pulse, scale=s, duration=d) for s, d in ((1.0, 5.0), (1.0, 1.2), (0.7, 0.3))
    )
    assert rk.simulate(block, pulse, "housner", duration=1.2).outcome is rk.Outcome.OVERTURNED
    assert (cut.outcome, cut.joint_states[-1]) == (rk.Outcome.OVERTURNED, "overturned")
    assert cut.time[-1] == pytest.approx(1.2, abs=0.02)  # a sample
    assert cut.overturning_time == pytest.approx(longer.overturning_time, abs=0.01)  # a sample
    assert cut.peak_rotation == pytest.approx(0.5 * np.pi)
    assert not cut.still_rocking
    assert gentle.outcome is rk.Outcome.ROCKED  # negative control


def lifted(amplitude, horizontal=0.0, step=0.005):
    """Return one period of a vertical sine, and a horizontal sine."""
    t = np.arange(0.0, 2.0, step)
    z = amplitude * np.sin(2.0 * np.pi * t / 0.4) * (t < 0.4)
    x = horizontal * np.sin(2.0 * np.pi * t) * (t < 1.0)
    return {"x": rk.GroundMotion(x, step), "z": rk.GroundMotion(z, step)}


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@pytest.mark.verifies("damage")
def test_a_joint_without_contact_names_the_friction():
    """Two blocks thrown up by a vertical motion stop the engine without flight, and the text proposes the friction."""
    response = rk.simulate(stack((1.0, 1.0), (0.6, 1.0)), lifted(-15.0), duration=1.0)
    assert response.status is Status.LOST_CONTACT
    assert response.summary.endswith("Stack(..., friction=0.6)")
    held = rk.simulate(stack((1.0, 1.0), (0.6, 1.0)), lifted(-5.0), duration=1.0)
    assert "friction" not in held.summary  # negative control: less than gravity


@pytest.mark.verifies("damage")
def test_tops_of_two_points_are_no_edge():
    """A U and an M have two highest edges or vertices, and carry neither a body nor a beam; a flat top does."""
    u = [(0, 0), (2, 0), (2, 1), (1.8, 1), (1.8, 0.3), (0.2, 0.3), (0.2, 1), (0, 1)]
    m = [(0, 0), (2, 0), (2, 1), (1, 0.2), (0, 1)]
    flat = [(0, 0), (2, 0), (2, 1), (1, 1), (0, 1)]  # with a vertex in the edge
    small = rk.Block(width=0.5, height=1.0)
    for points in (u, m):
        section = rk.Section([rk.Region(points, density=2000.0)])
        with pytest.raises(GeometryError, match="horizontal top edge"):
            rk.Stack([section, small])
        with pytest.raises(GeometryError, match="horizontal top edge"):
            rk.Frame([section], beam_mass=100.0)
    section = rk.Section([rk.Region(flat, density=2000.0)])
    assert rk.Stack([section, small]).joints[1].width == pytest.approx(0.5)
    assert rk.Frame([section], beam_mass=100.0).side("left").frequency_parameter > 0.0


@pytest.mark.parametrize("value", ["abc", [0.1, "a"], [0.1, [0.1, 0.2]], 0.1j, True, 2.0, None], ids=repr)
@pytest.mark.verifies("damage")
def test_rotations_that_are_no_numbers(value):
    """Texts, ragged lists, complex numbers, truth values and more than a quarter turn are refused by name."""
    with pytest.raises(InvalidValueError) as refused:
        rk.free_rocking(stack((1.0, 2.0), (1.0, 2.0)), rotation=value)
    assert refused.value.parameter == "rotation"


@pytest.mark.verifies("damage")
def test_inputs_of_stacks():
    """Other refusals with the name of the parameter; a stack at rest has no energy balance error."""
    body, block = stack((1.0, 2.0), (1.0, 2.0)), rk.Block(width=1.0, height=2.0)
    impact = rk.dynamics.stack_impact
    for parameter, refused_input in {
        "angular_velocity": lambda: rk.free_rocking(body, rotation=0.1, angular_velocity=1e9),
        "restitution": lambda: rk.free_rocking(body, rotation=0.1, restitution=np.array([0.1, 0.2])),
        "bodies": lambda: rk.Stack(None),
        "offsets": lambda: rk.Stack([block], offsets=0.3),
        "stack": lambda: impact(block, 1, (1,), (-1.0,)),
        "sides": lambda: impact(body, 1, 1, (-1.0, -2.0)),
    }.items():
        with pytest.raises(InvalidValueError) as refused:
            refused_input()
        assert refused.value.parameter == parameter
    assert rk.free_rocking(body, rotation=0.0, duration=0.5).energy_closure == 0.0


# Time stepping


def stepped(case, step, friction=5.0):
    """Return the response of a case by time stepping, with friction that does not let the joints slide."""
    options = {"gravity": G, "duration": case.duration, "engine": "fast", "longest_step": step}
    body = stack(*case.sizes, friction=friction)
    if case.motion is None:
        return rk.free_rocking(body, rotation=case.rotation, **options)
    return rk.simulate(body, rk.pulses.sine(*case.motion), **options)


def differences(case, response):
    """Return the largest differences of times [s], and of velocities [rad/s], of the impacts of a case."""
    impacts = [event for event in case.events if event[1] == IMPACT]
    computed = response.trajectory.events[: len(impacts)]
    assert [event.joint + 1 for event in computed] == [event[2] for event in impacts]
    times = [abs(a.time - b[0]) for a, b in zip(computed, impacts, strict=True)]
    pairs = [(a.before + a.after, b[4] + b[5]) for a, b in zip(computed, impacts, strict=True)]
    return max(times), max(abs(x - y) for a, b in pairs for x, y in zip(a, b, strict=True))


@fast
@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies(
    "second engine", "the independent values of the events", within="1e-3", control="test_little_friction"
)
def test_time_stepping_of_two_blocks(name):
    """Times and velocities of all impacts agree to 3 digits with a step of 5e-5 sqrt(R/g): the method has order one."""
    times, velocities = differences(CASES[name], stepped(CASES[name], 5e-5))
    assert times < 1e-3
    assert velocities < 1e-3


@fast
@pytest.mark.verifies("negative control")
def test_little_friction():
    """Negative control: with friction 0.45, joint 1 of SH1 slides, and the impacts miss the values."""
    response = stepped(CASES["SH1"], 5e-5, friction=0.45)
    assert differences(CASES["SH1"], response)[1] > 2e-3
    assert response.joint_displacement[-1, 0] != 0.0


@fast
@pytest.mark.parametrize("sizes", [((1.0, 4.0),), ((1.0, 2.0), (0.6, 2.0))], ids=["one", "two"])
@pytest.mark.verifies("order", "the first power of the step", within="0.25")
def test_order_of_time_stepping(sizes):
    """The error against the event-driven engine falls with the first power of the step, for one and for two bodies."""
    pulse, options = rk.pulses.sine(4.0, 0.8), {"gravity": G, "duration": 0.97}
    exact = rk.simulate(stack(*sizes), pulse, engine="reference", **options).rotation
    steps = 0.004 / 2.0 ** np.arange(7)
    errors = [
        np.abs(rk.simulate(stack(*sizes, friction=5.0), pulse, longest_step=step, **options).rotation - exact).max()
        for step in steps.tolist()
    ]
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(1.0, abs=0.25)
    assert errors[-1] < 1e-4


@fast
@pytest.mark.verifies("second engine", "the plane engine with Housner's restitution", within="1e-3")
def test_time_stepping_of_one_block():
    """One block: peak rotation and first impact of the plane engine; no coefficient of restitution is stated."""
    block, pulse = rk.Block(width=1.0, height=4.0), rk.pulses.sine(3.0, 0.8)
    expected = rk.simulate(block, pulse, "housner", duration=4.0)
    response = rk.simulate(rk.Stack([block], friction=5.0), pulse, duration=4.0, longest_step=1e-4)
    assert response.peak_rotation == pytest.approx(expected.peak_rotation, abs=1e-4)
    assert response.trajectory.events[0].time == pytest.approx(expected.impacts["time"][0], abs=1e-6)
    assert response.trajectory.events[1].time == pytest.approx(expected.impacts["time"][1], abs=1e-3)


@fast
@pytest.mark.verifies("closed form", "sliding under a rectangular pulse", within="2e-4")
def test_sliding_of_a_block():
    """A squat block slides under a rectangular pulse: (a - mu g) a T^2 / (2 mu g), and it does not rock."""
    mu, a, duration = 0.3, 4.0, 0.5
    response = rk.simulate(stack((2.0, 1.0), friction=mu), rk.pulses.rectangular(a, duration), gravity=G, duration=2.0)
    exact = -(a - mu * G) * a * duration**2 / (2.0 * mu * G)
    assert response.joint_displacement[-1, 0] == pytest.approx(exact, abs=2e-4)
    assert response.outcome is rk.Outcome.SLID
    assert response.joint_states == ("sliding",)
    assert response.trajectory.lost[-1] == pytest.approx(response.trajectory.work[-1], rel=1e-9)


@fast
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("horizontal", [0.0, 6.0])
@pytest.mark.verifies("second engine", "the plane engine with flight", within="1e-3", control="within")
def test_flight_of_a_stack(horizontal, count):
    """Blocks thrown up: time, gap and displacement are those of the plane engine with flight, and the text has them."""
    block, motion = rk.Block(width=1.0, height=1.0, mass=1000.0), lifted(-25.0, horizontal)
    expected = rk.simulate(block, motion, None, friction=10.0, duration=2.0)
    response = rk.simulate(rk.Stack([block] * count, friction=10.0), motion, duration=2.0)
    run = response.trajectory
    assert response.outcome is expected.outcome is rk.Outcome.FLEW
    assert response.joint_states[0] == "in flight"
    assert "the bodies above joint 1 flew" in response.summary
    assert run.largest_gap[0] == pytest.approx(expected.rise.max(), abs=1e-3)
    assert response.joint_displacement[-1, 0] == pytest.approx(expected.displacement[-1], abs=1e-3)
    departure = next(start for start, _, mode in expected.trajectory.intervals if mode.regime is Regime.FLIGHT)
    assert run.flight_time[0] == pytest.approx(departure, abs=1e-3)
    gentle = rk.simulate(rk.Stack([block] * count, friction=10.0), lifted(-9.0), duration=2.0)
    assert gentle.outcome is rk.Outcome.NO_UPLIFT  # negative control: less than gravity
    assert gentle.joint_states == ("monolithic",) * count


def drums(count, **options):
    return rk.Stack([rk.Block(width=1.6, height=1.0) for _ in range(count)], **options)


def record(peak, count=4000, step=0.01):
    """Return a synthetic record of filtered noise with an envelope."""
    noise = np.convolve(np.random.default_rng(1).normal(size=count), np.hanning(25), "same")
    values = noise * np.exp(-(((np.arange(count) * step - 12.0) / 8.0) ** 2))
    return rk.GroundMotion(values / np.abs(values).max() * peak, step)


@fast
@pytest.mark.parametrize(("peak", "friction"), [(2.0, 0.7), (5.0, 0.4), (8.0, 0.7), (8.0, None)])
@pytest.mark.verifies("invariant", "energy and interpenetration", within="1e-6")
def test_ten_drums_under_a_record(peak, friction):
    """Ten drums: no interpenetration beyond 1e-6 of the size, no energy created beyond 1e-6, energy closes."""
    with pytest.warns(rk.errors.PureRockingWarning) if friction is None else contextlib.nullcontext():
        response = rk.simulate(drums(10, friction=friction), record(peak), duration=40.0)
    run = response.trajectory
    assert run.interpenetration < 1e-6
    assert run.energy_created < 1e-6 * run.lost[-1]
    assert response.energy_closure < 1e-9
    assert (run.unsolved_steps > 0) == (friction is None)  # the paradox of Painleve without a bound on friction
    assert (response.outcome is rk.Outcome.OVERTURNED) == (peak > 2.0)


@fast
@pytest.mark.verifies("same bits", "repetition in threads", within="")
def test_same_bits_of_a_stack():
    """Histories in four threads have the bits of a history alone."""
    body, motion = drums(5, friction=0.5), record(4.0, 1500)

    def bits(_=None):
        response = rk.simulate(body, motion)
        return response.rotation.tobytes() + response.joint_displacement.tobytes()

    with ThreadPoolExecutor(4) as pool:
        assert set(pool.map(bits, range(4))) == {bits()}


@fast
@pytest.mark.verifies("behaviour")
def test_a_slippery_joint_is_named():
    """Of three blocks the joint with little friction slides, the others do not. A long pulse removes the top."""
    body = stack((2.0, 1.0), (2.0, 1.0), (2.0, 1.0), friction=(0.9, 0.1, 0.9))
    response = rk.simulate(body, rk.pulses.sine(3.0, 0.5))
    assert response.joint_states == ("monolithic", "sliding", "monolithic")
    joints = response.answer()["joints"].records
    assert joints[1]["residual_joint_displacement"] == response.joint_displacement[-1, 1] != 0.0
    assert joints[0]["friction_demand"] < 0.9
    assert joints[1]["friction_demand"] == pytest.approx(0.1, rel=1e-6)
    removed = rk.simulate(body, rk.pulses.rectangular(3.0, 2.0))
    assert removed.joint_states[1] in {"overturned", "slid off"}
    assert removed.outcome is rk.Outcome.OVERTURNED


@fast
@pytest.mark.parametrize("restitution", [0.2, 0.6])
@pytest.mark.verifies("invariant", "energy", within="1e-6")
def test_restitution_creates_no_energy(restitution):
    """With restitution blocks bounce; the lost energy grows, and the impulses create none."""
    body = stack((1.0, 2.0), (0.6, 2.0), friction=0.6, restitution=restitution)
    response = rk.simulate(body, rk.pulses.sine(4.0, 0.8), duration=3.0)
    run = response.trajectory
    assert run.energy_created < 1e-6 * run.lost[-1]
    assert np.diff(run.lost).min() > -1e-6 * run.lost[-1]
    assert (
        run.impacts
        > rk.simulate(stack((1.0, 2.0), (0.6, 2.0), friction=0.6), rk.pulses.sine(4.0, 0.8)).trajectory.impacts
    )
    with pytest.raises(InvalidValueError, match="reference engine"):
        rk.simulate(body, rk.pulses.sine(4.0, 0.8), engine="reference")


THREE = ((1.0, 1.0), (0.8, 1.2), (0.6, 1.0))


def peer(sizes, amplitude, period, end, step=2e-5):
    """MuJoCo: bodies with three joints in the plane and stiff contacts. The ground motion is a tilt of gravity."""
    mujoco = pytest.importorskip("mujoco")
    bodies, base = "", 0.0
    for width, height in sizes:
        bodies += (
            f'<body pos="0 0 {base + height / 2}"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
            f'<joint type="hinge" axis="0 1 0"/><geom type="box" size="{width / 2} .5 {height / 2}" density="1000"/>'
            "</body>"
        )
        base += height
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" gravity="0 0 -{G}" cone="elliptic" impratio="10" solver="Newton" '
        'tolerance="1e-12" iterations="100"/><default><geom friction="2 0 0" solref="1e-4 1" '
        f'solimp="0.999 0.9999 0.0001" condim="3"/></default><worldbody><geom type="plane" size="9 9 1"/>{bodies}'
        "</worldbody></mujoco>"
    )
    data, states = mujoco.MjData(model), []
    for _ in range(round(end / step)):
        model.opt.gravity[0] = -amplitude * np.sin(2.0 * np.pi * data.time / period)
        mujoco.mj_step(model, data)
        states.append((data.time, *data.qpos[2::3]))
    return np.array(states).T


@fast
@pytest.mark.verifies(
    "other program", "MuJoCo, steps of 0.02 ms", within="3e-5 of the rotation before the first impact", control="within"
)
def test_a_stack_of_three_in_another_program():
    """Up to the first impact MuJoCo gives the rotations of a stack of three that opens at two joints."""
    options = {"gravity": G, "duration": 0.6, "longest_step": 5e-5}
    pulse = rk.pulses.sine(5.0, 0.8)
    response, slippery = (rk.simulate(stack(*THREE, friction=mu), pulse, **options) for mu in (2.0, 0.25))
    until = response.time < response.impacts["time"][0]
    time, *angles = peer(THREE, 5.0, 0.8, 0.55)
    other = np.column_stack([np.interp(response.time[until], time, values) for values in angles])
    assert (np.abs(response.opening[until]).max(axis=0) > 5e-4).tolist() == [True, True, False]
    np.testing.assert_allclose(response.rotation[until], other, atol=3e-5 * np.abs(other).max())
    assert np.abs(slippery.rotation[: until.sum()] - other).max() > 3e-3 * np.abs(other).max()  # negative control
