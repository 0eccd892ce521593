"""Bodies with restraints against independent values: tendons, fuses, dampers, friction, asymmetric bodies.

The values are those of two routes of independent code (a Lagrangian with one coordinate by Dormand-Prince, and contact
forces with x, z and theta by Gragg-Bulirsch-Stoer); they agree to 1e-10. Case names are those of the source.
"""

import math
from dataclasses import dataclass, field

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq

import rocking as rk
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.restrained.devices import devices_of
from rocking.dynamics.restrained.levers import Lever
from rocking.dynamics.restrained.reference import RestrainedReference
from rocking.dynamics.restrained.settings import RestrainedSettings

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G = 9.81
WALL = rk.Block(width=1.0, height=6.0, mass=4000.0)
BLOCK = rk.Block(width=1.0, height=4.0, mass=2000.0)
SKEW = rk.Block(width=1.0, height=5.0, mass=2000.0, centre=(0.35, 2.0), moment_of_inertia=3000.0)


def tendon(**values):
    return rk.Tendon(x=0.5, prestress=20e3, **values)


def pair(kind, **values):
    return [kind(x=x, length=0.5, **values) for x in (0.0, 1.0)]


FUSES = [rk.Fuse(x=x, length=0.5, stiffness=2e6, yield_force=8e3, hardening=0.02) for x in (0.2, 0.8)]


@dataclass(frozen=True)
class Case:
    """One case: the impacts (time, velocity before, after), and changes of phase (time, restraint, phase, theta, e)."""

    body: rk.Block
    restraints: list
    motion: tuple | None  # amplitude and period of the sine pulse
    impacts: list
    peaks: list  # (time, rotation)
    uplift: float | None = None
    events: list = field(default_factory=list)
    energy: tuple | None = None  # time, input, lost in impacts, work of restraints, mechanical energy
    rotation: float = 0.0
    duration: float = 5.0
    plastic: float = 0.0


T, C, EL, SL, BR = "yields in tension", "yields in compression", "elastic", "slack", "broken"
CASES = {
    "1H1": Case(
        WALL, [tendon(stiffness=500e3)], (6.0, 1.0),
        [(0.90794165046, 4.93304143925e-01, 4.73305327280e-01), (2.56597920073, -5.09790076316e-01, -4.89122911060e-01),
         (4.15666811880, 4.89122911060e-01, 4.69293603854e-01)],
        [(0.64792503486, -6.64426839475e-02), (1.73811272829, 2.12102748378e-01), (3.36132365976, -1.95480176947e-01)],
        0.06747809037, energy=(4.15666811880, 6.887351865e03, 1.454851862e03, [1.493560831e-11], 5.432500003e03),
    ),
    "1H2": Case(
        WALL, [tendon(stiffness=500e3, yield_force=50e3)], (6.0, 0.8),
        [(0.72704149108, 3.94069966180e-01, 3.78094156740e-01), (2.09442779451, -3.93549931810e-01, -3.77595204844e-01),
         (3.42001498010, 3.77595204844e-01, 3.62287291134e-01)],
        [(0.51866062130, -4.25522352821e-02), (1.40449954325, 1.36362779099e-01), (2.75722138730, -1.25659215095e-01),
         (4.05670676166, 1.15789777429e-01)],
        0.05398247230, [(1.16784881818, 0, T, 1.20072116891e-01, 6.0e-02)],
        (4.05670676166, 4.385073945e03, 8.871468884e02, [2.019475410e03], 1.478451646e03), plastic=8.12857600097e-03,
    ),
    "1H3": Case(
        WALL, [tendon(stiffness=800e3, yield_force=60e3)], (7.0, 0.8),
        [(0.76167499728, 4.70575050689e-01, 4.51497683769e-01),
         (2.16253979718, -3.95937288860e-01, -3.79885777150e-01)],
        [(0.53266510166, -5.88443997675e-02), (1.43857493756, 1.54397036998e-01), (2.87066524568, -1.44424635789e-01)],
        0.04588353708,
        [(1.03086014324, 0, T, 1.00041713612e-01, 5.0e-02),
         (2.15176379097, 0, SL, 4.24372815311e-03, 2.12186248434e-03),
         (2.17377638940, 0, EL, -4.24372815311e-03, 2.12186248434e-03),
         (3.56755410195, 0, SL, -4.24372815311e-03, 2.12186248434e-03)],
        (3.56755410195, 5.678119145e03, 7.410817051e02, [1.377311749e03], 3.559725691e03),
        duration=3.57, plastic=2.71218624843e-02,
    ),
    "1H4": Case(
        WALL, [tendon(stiffness=500e3, yield_force=40e3, rupture_elongation=0.06)], (8.0, 1.0),
        [(1.13989199599, 4.55237333673e-01, 4.36781766092e-01)], [(0.72156306884, -1.29454765662e-01)], 0.04992046254,
        [(0.47920050441, 0, T, -8.00213487080e-02, 4.0e-02), (0.62208695030, 0, BR, -1.20072116891e-01, 6.0e-02)],
        plastic=2.0e-02, duration=3.0,
    ),
    "1H5": Case(
        WALL, [tendon(stiffness=500e3)], None,
        [(0.57211096401, -3.48433833542e-01, -3.34308137588e-01), (1.67101154646, 3.34308137588e-01, 3.20755104983e-01),
         (2.72632998822, -3.20755104983e-01, -3.07751519646e-01), (3.73974172627, 3.07751519646e-01,
         2.95275106687e-01)],
        [(1.12156125524, -9.21270619193e-02), (2.19867076734, 8.48700662293e-02), (3.23303585724, -7.81812422002e-02)],
        energy=(3.73974172627, 0.0, 8.440624440e02, [-1.624062726e03], 2.150622253e03), rotation=0.1,
    ),
    "2H1": Case(
        BLOCK, FUSES, (7.0, 0.7),
        [(0.56951562808, 4.60749466968e-01, 4.20095102235e-01),
         (1.72243315774, -2.19347487709e-01, -1.99993297617e-01)],
        [(0.40874913861, -3.82411747001e-02), (0.98653085793, 1.17579572731e-01)], 0.03987892440,
        [(0.16353904935, 1, T, -5.00002070956e-03, 4.0e-03), (0.26454986308, 0, T, -2.00013256337e-02, 4.0e-03),
         (0.48996886952, 1, C, -2.82358879246e-02, 2.25858062193e-02),
         (0.59134862500, 0, T, 9.55813391678e-03, 7.64639202105e-03), (0.65733912940, 1, T, 4.00105481694e-02, 8.0e-03),
         (1.11553501515, 0, C, 1.07525251351e-01, 8.58727584419e-02),
         (1.31499544272, 1, C, 7.73934447265e-02, 1.54635889988e-02), (1.77673844130, 1, T, -1.00001647055e-02,
         8.0e-03)],
        (1.77673844130, 2.512745851e03, 2.489150067e02, [1.381844853e03, 6.449345170e02], 2.370514737e02),
        duration=1.78, plastic=3.92e-03,
    ),
    "2H2": Case(
        BLOCK, pair(rk.ViscousDamper, coefficient=4e3), (7.0, 0.7),
        [(0.70632897219, 5.19747680162e-01, 4.73887590736e-01), (2.64126886633, -4.04213412086e-01, -3.68547522784e-01),
         (3.69224512365, 3.30351583317e-01, 3.01202914201e-01)],
        [(0.48145592454, -6.93226832191e-02), (1.62872324477, 1.67804421244e-01), (3.15154320204, -8.49370575308e-02)],
        0.03987892440, [], (3.69224512365, 1.698602882e03, 5.187174947e02,
        [3.466921415e02, 3.190951380e02], 5.140981080e02),
    ),
    "2H3": Case(
        BLOCK, pair(rk.ViscousDamper, coefficient=3e3, exponent=0.5), (7.0, 0.7),
        [(0.69262997184, 5.24203170036e-01, 4.77949949151e-01), (2.50105728971, -3.83571519103e-01, -3.49726973300e-01),
         (3.43158406810, 2.98191912553e-01, 2.71880861445e-01)],
        [(0.47509982494, -6.55592774865e-02), (1.50974859229, 1.57433294548e-01), (2.93960015736, -7.07255038493e-02)],
        0.03987892440, [], (3.43158406810, 1.768382456e03, 4.882976747e02,
        [4.639978830e02, 3.972114156e02], 4.188754826e02),
    ),
    "2H4": Case(
        BLOCK, pair(rk.FrictionDamper, slip_force=3e3), (7.0, 0.7),
        [(0.63797932502, 5.03440269046e-01, 4.59019068836e-01), (2.54914254214, -3.16357807288e-01, -2.88443883115e-01),
         (3.22781251593, 2.04310889768e-01, 1.86283458318e-01)],
        [(0.44859042066, -4.91412692671e-02), (1.26872400856, 1.40797142094e-01), (2.82674545446, -3.91632361643e-02)],
        0.05293925847, [], (3.22781251593, 1.946593358e03, 3.778386017e02,
        [8.424532221e02, 5.296595482e02], 1.966419854e02),
    ),
    "3H1": Case(
        SKEW, [rk.Tendon(x=0.55, prestress=6e3, stiffness=2e5)], None,
        [(0.39083679453, -5.11473727706e-01, -4.79634545012e-01), (1.30953149652, 4.79634545012e-01, 4.26994198156e-01),
         (1.96239110595, -4.26994198156e-01, -4.00413856786e-01), (2.75893486735, 4.00413856786e-01,
         3.56468055703e-01)],
        [(0.85018414552, -1.13865522438e-01), (1.63596130123, 6.97282644748e-02), (2.36066298665, -8.17507606942e-02)],
        energy=(2.75893486735, 0.0, 7.967888642e02, [-4.722188203e02], 7.525689641e02), rotation=0.1,
    ),
    "3H2": Case(
        SKEW, [rk.Tendon(x=0.55, prestress=6e3, stiffness=2e5)], (7.0, 0.7),
        [(0.66069864866, 6.01459820132e-01, 5.35449033626e-01), (1.50341095311, -5.51195941141e-01, -5.16884055076e-01),
         (2.47518230100, 5.16884055076e-01, 4.60155539112e-01)],
        [(0.46382928908, -6.39830188520e-02), (1.08224887629, 1.16118078226e-01), (1.98929662705, -1.30300800952e-01)],
        0.04139943768, [], (2.47518230100, 2.135303050e03, 8.812544211e02, [3.543831895e-13], 1.254048629e03),
    ),
}  # fmt: skip


def respond(case, engine, **options):
    body = rk.Restrained(case.body, case.restraints)
    values = {"restitution": "housner", "gravity": G, "duration": case.duration, "engine": engine} | options
    if case.motion is None:
        return rk.free_rocking(body, case.rotation, **values)
    return rk.simulate(body, rk.pulses.sine(*case.motion), **values)


ENGINES = ("reference", "fast")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("computed anew", "two independent programs", within="2e-10", control="test_a_wrong_lever_is_seen")
def test_independent_values(name, engine):
    """Impacts, peaks, events of restraints and plastic elongations are those of independent code."""
    case = CASES[name]
    response = respond(case, engine)
    run = response.trajectory
    impacts = [(e.time, e.before, e.after) for e in run.events if e.kind is EventKind.IMPACT]
    assert np.allclose(impacts[: len(case.impacts)], case.impacts, rtol=0.0, atol=2e-10)
    assert len(impacts) >= len(case.impacts)
    if case.uplift is not None:
        assert response.uplifts[0] == pytest.approx(case.uplift, abs=2e-11)
    events = [(e.time, e.index, e.phase, e.rotation, e.elongation) for e in run.restraint_events]
    for time, index, phase, rotation, elongation in case.events:
        match = min(events, key=lambda e: abs(e[0] - time) + 10.0 * (e[1:3] != (index, phase)))
        assert match[1:3] == (index, phase)
        assert np.allclose([match[0], *match[3:]], [time, rotation, elongation], rtol=0.0, atol=2e-10)
    assert all(device.law.plastic == pytest.approx(case.plastic, abs=2e-12) for device in run.devices)
    peaks = np.array(run.peaks)
    for time, rotation in case.peaks:
        nearest = peaks[np.argmin(np.abs(peaks[:, 0] - time))]
        assert np.allclose(nearest, [time, rotation], rtol=0.0, atol=2e-10)


class Watched(RestrainedReference):
    """The reference engine with the totals at each turning point and impact."""

    totals: list

    def _turn(self):
        self._note_totals()
        super()._turn()

    def _impact(self):
        self._note_totals()
        super()._impact()

    def _note_totals(self):
        self.totals = [*getattr(self, "totals", []), (self.now, self.work, *(d.work for d in self.devices))]


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.energy and name not in {"1H3", "2H1"}])
@pytest.mark.verifies("computed anew", "two independent programs", within="1e-9")
def test_independent_energy(name):
    """Input, losses and work of restraints up to the last event of the case (of two cases no peak and no impact)."""
    case = CASES[name]
    time, input_, lost, work, _ = case.energy
    response = respond(case, "reference")
    watched = Watched(
        response.parameters, case.body.mass, devices_of(response.body, linear=False), response.segments,
        RestrainedSettings(gravity=G),
    )  # fmt: skip
    watched.run(case.rotation)
    totals = min(watched.totals, key=lambda row: abs(row[0] - time))
    assert totals[0] == pytest.approx(time, abs=2e-11)
    start = 0.0 if case.rotation else response.trajectory.devices[0].start_energy
    assert totals[1] == pytest.approx(input_, rel=1e-9, abs=1e-9)
    assert totals[2:] == pytest.approx(work, rel=1e-9, abs=1e-7)
    impacts = np.searchsorted(response.impacts["time"], time * (1.0 + 1e-12), side="right")
    losses = np.diff(np.append(0.0, np.unique(response.forces.energy_lost)))
    assert np.sum(losses[: impacts + 1]) == pytest.approx(lost, rel=1e-9)
    assert start >= 0.0


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", CASES)
@pytest.mark.verifies("invariant", "energy", within="1e-12")
def test_energy_closes(name, engine):
    """Work of the ground = kinetic + potential + restraints + impacts, at every sample."""
    assert respond(CASES[name], engine).energy_closure < 1e-12


@pytest.mark.verifies("negative control")
def test_a_wrong_lever_is_seen():
    """Negative control: a tendon 1 mm off the axis misses the values."""
    case = CASES["1H1"]
    moved = rk.Restrained(WALL, [rk.Tendon(x=0.501, prestress=20e3, stiffness=500e3)])
    response = rk.simulate(moved, rk.pulses.sine(*case.motion), "housner", gravity=G, duration=1.0)
    assert abs(response.impacts["time"][0] - case.impacts[0][0]) > 1e-5


PERIODS = [  # P0/mg, k b^2/(m g h), phi0; full period, next peak over alpha (physics.md 9.1: two routes)
    (0.0, 0.0, 0.3, 1.9016606857663715601, 0.241154363592675566),
    (0.5, 0.0, 0.9, 3.3353528272453547137, 0.675690154719092629),
    (0.0, 1.0, 0.3, 1.6499639259360239129, 0.249325011329796254),
    (0.5, 2.0, 0.9, 1.9227300309598490461, 0.772039468687603918),
]


@pytest.mark.parametrize(("prestress", "stiffness", "phi", "period", "peak"), PERIODS)
@pytest.mark.verifies("computed anew", "40-digit quadrature", within="1e-12")
def test_periods_with_a_tendon(prestress, stiffness, phi, period, peak):
    """Quarter period and next peak in free rocking with a tendon in the axis."""
    block = rk.Block(width=1.0, height=4.0, mass=1.0)
    item = rk.Tendon(x=0.5, prestress=prestress * G, stiffness=stiffness * G * 2.0 / 0.25)
    alpha = block.slenderness_angle
    response = rk.free_rocking(
        rk.Restrained(block, item), phi * alpha, "housner", gravity=G, engine="reference", duration=1.3 * period
    )
    first, second = response.impacts["time"][:2]
    # a quarter period to the first impact at the initial amplitude
    assert 4.0 * first == pytest.approx(period, rel=1e-12)
    assert abs(response.trajectory.peaks[1][1]) / alpha == pytest.approx(peak, rel=1e-12)
    assert second > first


@pytest.mark.verifies("closed form", "a sine between impacts", within="1e-13")
def test_slender_positive_stiffness_is_a_sine():
    """kappa = 4: T/4 = acos(q / (phi0 + q)) / w, with q = 1/3, w = sqrt 3 in units of 1/p (physics.md 9.1)."""
    block = rk.Block(width=1.0, height=4.0, mass=1.0)
    side = block.side("right", G)
    alpha, p, unit = side.slenderness_angle, side.frequency_parameter, G * side.semi_diagonal
    # linear equations: k D^2 theta / (m g R) = 4 theta
    item = rk.Tendon(x=0.5, stiffness=4.0 * unit / 0.25)
    response = rk.free_rocking(
        rk.Restrained(block, item), 0.5 * alpha, "housner", gravity=G, linear=True, engine="reference", duration=3.0
    )
    assert p * response.impacts["time"][0] == pytest.approx(0.669310320263978928607, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("body", [WALL, SKEW], ids=["wall", "asymmetric"])
@pytest.mark.verifies("second engine", "the engine without restraints", within="1e-12")
def test_without_force_nothing_changes(body, engine):
    """A tendon of no stiffness, a damper of no coefficient, friction of no force: the response of the body alone."""
    items = [
        rk.Tendon(x=0.4, stiffness=0.0), rk.ViscousDamper(x=0.0, length=0.5, coefficient=0.0),
        rk.ViscousDamper(x=0.0, length=0.5, coefficient=0.0, exponent=0.5),
        rk.FrictionDamper(x=0.1, length=0.5, slip_force=0.0), rk.Spring(ground=(-1.0, 2.0), point=(0.0, 2.0),
        stiffness=0.0),
    ]  # fmt: skip
    options = {"restitution": 0.9, "gravity": G, "duration": 4.0}
    for motion in (rk.pulses.sine(3.5, 0.9), record()):
        tied = rk.simulate(rk.Restrained(body, items), motion, engine=engine, **options)
        alone = rk.simulate(body, motion, engine="reference", **options)
        count = min(tied.rotation.size, alone.rotation.size)
        assert tied.outcome is alone.outcome
        assert np.abs(tied.rotation[:count] - alone.rotation[:count]).max() < 1e-12


def record(seed=1, count=400, strength=4.0):
    values = np.random.default_rng(seed).normal(0.0, 1.0, count)
    smooth = np.convolve(values, np.hanning(15) / np.hanning(15).sum(), "same")
    return rk.GroundMotion(strength * smooth / np.abs(smooth).max(), 0.01)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("invariant", "a linear spring", within="1e-12")
def test_a_fuse_that_never_yields_is_a_spring(engine):
    """A fuse with a yield force that is never reached gives the rotations of a spring of its stiffness."""
    options = {"restitution": 0.93, "gravity": G, "duration": 4.0, "engine": engine}
    position = {"x": 0.3, "length": 0.5, "stiffness": 1e5}
    fuse, spring = (
        rk.simulate(rk.Restrained(WALL, item), record(), **options)
        for item in (rk.Fuse(yield_force=1e12, **position), rk.Spring(**position))
    )
    assert np.abs(fuse.rotation - spring.rotation).max() < 1e-12
    assert fuse.peak_rotation > 1e-3


@pytest.mark.verifies("closed form", "the first order of the rotation", within="0.1")
def test_linear_option_is_the_limit_of_small_rotations():
    """The difference of linear and exact elongation falls with the rotation; at 0.1 rad it is seen."""
    item = rk.Spring(ground=(-2.0, 4.0), point=(0.0, 4.0), stiffness=1.0)
    exact, linear = (Lever.of(item, WALL, 1, linear=flag) for flag in (False, True))
    gaps = [abs(exact.elongation(a) - linear.elongation(a)) / abs(exact.elongation(a)) for a in (1e-1, 1e-3, 1e-5)]
    assert gaps[0] > 1e-3
    assert gaps[2] / gaps[1] == pytest.approx(1e-2, rel=0.1)  # of first order in the rotation


@pytest.mark.parametrize(
    ("ground", "point"),
    [((0.3, -0.5), (0.3, 0.0)), ((0.5, 0.0), (0.5, 0.0)), ((-2.0, 4.0), (0.0, 4.0)), ((2.0, 0.0), (1.0, 5.0))],
)
@pytest.mark.parametrize("theta", [1e-9, -1e-9, 1e-3, -0.2, 1.2])
@pytest.mark.verifies("computed anew", "40-digit distances", within="1e-14")
def test_elongation_is_the_change_of_the_distance(ground, point, theta):
    """Also for a duct mouth on its anchor, which has no direction at zero elongation."""
    mp.mp.dps = 40
    side = 1 if theta > 0.0 else -1
    lever = Lever.of(rk.Spring(ground=ground, point=point, stiffness=1.0), WALL, side, linear=False)
    foot = mp.mpf(1 if side > 0 else 0)

    def distance(angle):
        x, z = mp.mpf(point[0]) - foot, mp.mpf(point[1])
        return mp.hypot(
            foot + x * mp.cos(angle) + z * mp.sin(angle) - mp.mpf(ground[0]),
            z * mp.cos(angle) - x * mp.sin(angle) - mp.mpf(ground[1]),
        )

    exact = distance(mp.mpf(theta)) - distance(mp.mpf(0))
    assert lever.elongation(theta) == pytest.approx(float(exact), rel=1e-14, abs=1e-24)
    slope = (distance(mp.mpf(theta) + mp.mpf("1e-15")) - distance(mp.mpf(theta) - mp.mpf("1e-15"))) / mp.mpf("2e-15")
    assert lever.slope(theta) == pytest.approx(float(slope), rel=1e-12, abs=1e-15)


# ---- traps ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("behaviour")
def test_fuses_outside_the_base_are_compressed_and_unload_at_the_peak(engine):
    """A bar beyond the foot shortens while the body opens about it, yields, and is elastic from the peak on."""
    fuse = rk.Fuse(x=1.6, length=0.5, stiffness=4e6, yield_force=6e3, hardening=0.02)
    response = rk.simulate(
        rk.Restrained(BLOCK, fuse), rk.pulses.sine(-7.0, 0.7), "housner", gravity=G, duration=2.0, engine=engine
    )
    events = response.trajectory.restraint_events
    yields = [event for event in events if event.phase == C and event.rotation > 0.0]
    assert yields
    assert yields[0].elongation == pytest.approx(-6e3 / 4e6, rel=1e-9)
    after = next(event for event in events if event.time > yields[0].time)
    assert after.phase == EL
    k = int(after.time / response.time[1])
    assert response.angular_velocity[k] > 0.0 > response.angular_velocity[k + 1]  # at the peak


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("behaviour")
def test_without_hardening_reverse_yield_coincides_with_the_impact(engine):
    """At every closing the fuse is at -Fy to rounding; after the impact it opens elastically from there."""
    fuse = rk.Fuse(x=0.5, length=0.5, stiffness=2e6, yield_force=8e3)
    response = rk.simulate(
        rk.Restrained(BLOCK, fuse), rk.pulses.sine(7.0, 0.7), "housner", gravity=G, duration=6.0, engine=engine
    )
    device = response.trajectory.devices[0]
    assert device.law.residual_force == pytest.approx(-8e3, rel=1e-12)
    assert response.energy_closure < 1e-12
    # no event at the impacts other than the end of yielding: yields do not multiply by rounding
    assert device.law.yields < 2 * response.impacts.size


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("exponent", [0.3, 0.5, 1.5])
@pytest.mark.verifies("invariant", "energy, and another tolerance", within="1e-11")
def test_powers_of_dampers_near_a_peak(exponent, engine):
    """Energy closes with the singular acceleration at every peak, with equal results for another tolerance."""
    damper = pair(rk.ViscousDamper, coefficient=3e3, exponent=exponent)
    body, pulse = rk.Restrained(BLOCK, damper), rk.pulses.sine(7.0, 0.7)
    options = {"gravity": G, "duration": 3.0, "engine": engine}
    first, second = (rk.simulate(body, pulse, "housner", tolerance=t, **options) for t in (1e-15, 1e-16))
    assert first.energy_closure < 1e-11
    assert np.abs(first.rotation - second.rotation).max() < 1e-11


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("behaviour")
def test_friction_holds_the_body_for_good(engine):
    """Beyond m g b / (sum of arms) the body stays at its first peak; below, it returns."""
    limit = BLOCK.mass * G * 0.5  # one damper at the middle has the arm b, as gravity has
    strong, weak = (
        rk.free_rocking(
            rk.Restrained(BLOCK, rk.FrictionDamper(x=0.5, slip_force=factor * limit)), 0.03, "housner", gravity=G,
            engine=engine,
        )
        for factor in (2.1, 0.5)
    )  # fmt: skip
    assert strong.outcome is rk.Outcome.HELD
    assert strong.residual_rotation == 0.03
    assert "held by friction" in strong.summary
    assert weak.outcome is not rk.Outcome.HELD


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")  # a damper stronger than the weight
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("closed form", "equilibrium of moments", within="1e-10")
def test_friction_releases_the_body_when_the_ground_moves(engine):
    """The held body starts again when the ground acceleration exceeds the closed form."""
    force, theta, alpha = 20e3, 0.05, BLOCK.slenderness_angle
    body = rk.Restrained(BLOCK, rk.FrictionDamper(x=0.5, slip_force=force))
    ramp = rk.GroundMotion(np.linspace(0.0, 6.0, 601), 0.01)
    response = rk.simulate(body, ramp, "housner", gravity=G, rotation=theta, duration=6.0, engine=engine)
    radius, weight = BLOCK.semi_diagonal, BLOCK.mass * G

    def moment(a):
        psi = alpha - theta
        return weight * radius * (math.sin(psi) + a / G * math.cos(psi)) - force * 0.5 * math.cos(0.5 * theta)

    release = brentq(moment, 0.0, 6.0)
    moved = response.trajectory.restraint_events[0].time
    assert moved == pytest.approx(release, rel=1e-10)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("closed form", "equilibrium of moments", within="1e-9")
def test_prestress_delays_uplift_and_the_residual_prestress_decides_rest(engine):
    """Uplift at (g + P0 / m) b / h; after yielding the residual prestress P0 - k ep takes the place of P0."""
    ramp = rk.GroundMotion(np.linspace(0.0, 4.0, 401), 0.01)
    body = rk.Restrained(WALL, tendon(stiffness=500e3))
    response = rk.simulate(body, ramp, "housner", gravity=G, duration=4.0, engine=engine)
    assert response.uplifts[0] == pytest.approx((G + 20e3 / 4000.0) / 6.0, rel=1e-12)
    # a pulse that yields the tendon, then a slow ramp between both thresholds
    pulse = 7.0 * np.sin(2.0 * np.pi * np.linspace(0.0, 1.0, 81))
    motion = rk.GroundMotion(np.concatenate([pulse, np.zeros(6000), np.linspace(0.0, 2.5, 1000)]), 0.01)
    yielding = rk.Restrained(WALL, tendon(stiffness=500e3, yield_force=50e3))
    response = rk.simulate(yielding, motion, 0.93, gravity=G, duration=motion.duration, engine=engine)
    device = response.trajectory.devices[0]
    residual = 20e3 - 500e3 * device.law.plastic
    assert 0.0 < residual < 18e3
    lift = response.uplifts[-1] - 0.01 * (81 + 6000)
    assert 2.5 / 9.99 * lift == pytest.approx((G + residual / 4000.0) / 6.0, rel=1e-9)


@pytest.mark.verifies("closed form", "Housner's coefficient", within="1e-14")
def test_restitution_is_that_of_the_body():
    """Finite forces give no impulse: the coefficient does not depend on the restraints (Dimitrakopoulos & DeJong)."""
    response = respond(CASES["1H1"], "reference")
    expected = rk.coefficient_of_restitution(WALL, "housner")
    ratio = response.impacts["velocity_after"] / response.impacts["velocity_before"]
    assert np.allclose(ratio, expected, rtol=1e-14)


@pytest.mark.verifies("behaviour")
def test_gap_hook_and_buffer():
    """A hook acts beyond its gap in tension only, a buffer in compression only; the pushover shows both."""
    position = {"ground": (-2.0, 6.0), "point": (0.0, 6.0), "stiffness": 1e6, "gap": 0.05}
    hook, buffer = (
        rk.pushover(rk.Restrained(WALL, rk.Spring(action=a, **position)), [0.02, 0.0, 0.0, -0.02, 0.0, 0.0, 0.005])
        for a in ("tension", "compression")
    )
    e = hook.elongation[:, 0]
    assert hook.force[:, 0] == pytest.approx([1e6 * (e[0] - 0.05), *6 * [0.0]])
    assert buffer.force[:, 0] == pytest.approx([*3 * [0.0], 1e6 * (e[3] + 0.05), *3 * [0.0]])


@pytest.mark.verifies("closed form", "the area of the loop", within="1e-12")
def test_pushover_of_a_fuse_dissipates_its_loop():
    """The energy of a cycle is the area of the loop, and the moment at yield is in closed form."""
    item = rk.Fuse(x=0.5, length=0.5, stiffness=2e6, yield_force=8e3)
    path = np.concatenate([np.linspace(0.0, 0.05, 200), np.linspace(0.05, 0.0, 200)])
    curve = rk.pushover(rk.Restrained(BLOCK, item), path, gravity=G)
    e = curve.elongation[:, 0].max()
    assert curve.dissipated[0] == pytest.approx(8e3 * (e - 4e-3) + 8e3 * (e - 8e-3), rel=1e-12)
    area = np.trapezoid(curve.force[:, 0], curve.elongation[:, 0])
    assert curve.restraint_work[-1, 0] == pytest.approx(area, rel=1e-3)  # a polygon of 200 points


@pytest.mark.verifies("behaviour")
def test_bodies_on_files_and_many(tmp_path):
    """A body file with [[restraint]] gives the same body; many histories give the results of each."""
    from rocking.bodies.formats.body_file import body_to_toml

    body = rk.Restrained(BLOCK, [*FUSES, rk.Tendon(x=0.5, area=1e-4, modulus=2e11, free_length=4.0, prestress=2e3)])
    path = tmp_path / "body.toml"
    path.write_text(body_to_toml(body), "utf-8")
    assert rk.read_body(path) == body
    pulse = rk.pulses.sine(7.0, 0.7)
    many = rk.simulate_many([body], pulse, "housner", scale=[0.6, 1.0], gravity=G, duration=2.0)
    one = rk.simulate(body, pulse, "housner", gravity=G, duration=2.0)
    assert float(many.peak_rotation[0, 0, 1, 0]) == pytest.approx(one.trajectory.peak_rotation, rel=1e-12)
    assert np.allclose(many.largest_force[0, 0, 1, 0], one.restraints.columns["largest_force"], rtol=1e-9)
    assert many.sizes["restraint"] == 3


@pytest.mark.parametrize("name", ["1H2", "2H1", "3H2"])
@pytest.mark.verifies("behaviour")
def test_answers_name_all_quantities(name):
    """All keys of an answer with restraints are named quantities."""
    from rocking.quantities import is_named

    answer = respond(CASES[name], "reference").answer()
    assert all(is_named(key) for key in answer.values)
    assert all(is_named(key) for row in ("restraints", "restraint_events") for key in answer[row].columns)
    assert np.isfinite(answer["largest_base_shear"])


@pytest.mark.verifies("closed form", "weight and prestress", within="1e-14")
def test_forces_of_the_ground_balance():
    """At rest the ground carries weight and prestress; the least force is then above the weight."""
    body = rk.Restrained(WALL, tendon(stiffness=500e3))
    response = rk.simulate(body, rk.pulses.sine(1.0, 1.0), "housner", gravity=G, duration=1.5)
    assert response.outcome is rk.Outcome.NO_UPLIFT
    assert np.allclose(response.forces.vertical_force, 4000.0 * G + 20e3, rtol=1e-14)
    assert np.allclose(response.forces.horizontal_force, 4000.0 * response.ground_acceleration, atol=1e-9)


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("kind", "values", "name"),
    [
        (rk.Tendon, {"stiffness": 1e5, "prestress": math.inf}, "prestress"),
        (rk.Tendon, {"stiffness": math.inf}, "stiffness"), (rk.Spring, {"stiffness": math.inf}, "stiffness"),
        (rk.Fuse, {"stiffness": math.inf, "yield_force": 1e3}, "stiffness"),
        (rk.FrictionDamper, {"slip_force": math.inf}, "slip_force"),
        (rk.ViscousDamper, {"coefficient": math.inf}, "coefficient"),
    ],
)  # fmt: skip
def test_infinite_constants_are_refused(kind, values, name):
    """Only limits may be infinite."""
    with pytest.raises(rk.errors.InvalidValueError, match=name):
        kind(x=0.5, length=0.5, **values)
    assert rk.Tendon(x=0.5, stiffness=1e5, yield_force=math.inf).damages == ()
