"""The force of the ground that engines carry: closed forms, differences of the motion itself, and what follows from it.

The force on the whole body is m (a_ground + a_centre), whatever the equations of rocking say; its extremes are looked
at where the samples of a record, uplifts and impacts are.
"""

import math
import warnings
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.conventions import g
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.reference import Reference
from rocking.dynamics.rows import Rows
from rocking.errors import PureRockingWarning
from rocking.outcome import contact_words

LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])
STEP = 0.005
ENGINES = ["fast", "reference"]
pytestmark = [
    pytest.mark.verifies(room="rocking in the plane"),
    pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning"),
]


def shaken(seed: int, vertical: float, horizontal: float = 4.0) -> rk.GroundMotion:
    """A record of 4 s with parts of some hertz, horizontal and vertical [m/s2]."""
    rng, t = np.random.default_rng(seed), np.arange(801) * STEP
    waves = [
        sum(rng.normal() * np.sin(2.0 * np.pi * f * t + rng.uniform(0.0, 6.0)) for f in rng.uniform(0.5, high, 6))
        for high in (2.5, 6.0)
    ]
    across, up = (size * wave / np.abs(wave).max() for size, wave in zip((horizontal, vertical), waves, strict=True))
    return rk.GroundMotion(np.asarray(across), STEP, vertical=np.asarray(up) if vertical else None)


def random_shake(seed: int) -> tuple[rk.Section, rk.GroundMotion]:
    """A leaning body and a record that fades in and out, mostly strong enough to overturn it."""
    rng = np.random.default_rng(seed)
    width, height = rng.uniform(0.3, 0.9), rng.uniform(1.2, 3.0)
    left, right = np.sort(rng.uniform(0.0, width, 2)).tolist()
    body = rk.Section([rk.Region([(0.0, 0.0), (width, 0.0), (right, height), (left, height)], 2400.0)])
    motion = shaken(seed, (seed % 2) * rng.uniform(2.0, 8.0), rng.uniform(4.0, 30.0))
    fade = np.clip(np.minimum(np.arange(801), np.arange(801)[::-1]) / 80.0, 0.0, 1.0)
    up = None if motion.vertical is None else fade * motion.vertical
    return body, rk.GroundMotion(fade * motion.acceleration, STEP, vertical=up)


def of_the_path(
    body: rk.Section, response: Any, motion: rk.GroundMotion, until: float = math.inf
) -> tuple[np.ndarray, np.ndarray]:
    """Forces over m g from the path of the centre alone: second differences within steps, carried on to their ends."""
    parts, times = response.dense_output, np.arange(motion.acceleration.size) * STEP
    last = np.fmin(until, np.nan_to_num(response.overturning_time, nan=math.inf))
    use = (parts.side != 0.0) & (parts.length > 1e-4) & (parts.start < last - 1e-9)
    start, length, side = parts.start[use, None], parts.length[use, None], parts.side[use, None]
    t = start + np.linspace(0.0, 1.0, 9) * length
    size, alpha = (
        np.where(side > 0.0, getattr(body.side("right"), name), getattr(body.side("left"), name))
        for name in ("semi_diagonal", "slenderness_angle")
    )
    to_top = alpha - side * response.at(t)

    def force(path: np.ndarray, ground: Any) -> np.ndarray:
        bent = (path[:, 2:] - 2.0 * path[:, 1:-1] + path[:, :-2]) / (length / 8.0) ** 2
        bent = np.hstack([2.0 * bent[:, :1] - bent[:, 1:2], bent, 2.0 * bent[:, -1:] - bent[:, -2:-1]])
        return np.asarray(bent + np.interp(t, times, ground, right=0.0)) / g

    lift = np.zeros_like(times) if motion.vertical is None else motion.vertical
    return 1.0 + force(size * np.cos(to_top), lift), force(-side * size * np.sin(to_top), motion.acceleration)


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "second differences of the path of the centre", within="1e-3 of the weight", control="within"
)
@pytest.mark.parametrize("engine", ENGINES)
def test_forces_are_those_of_the_path_of_the_centre(engine: str) -> None:
    """Mass times acceleration, between the samples too, up to the instant at which a body passes over its foot.

    Negative controls: of many that overturn, the forces up to the sample before are others.
    """
    stood = fell = late = 0
    for seed in range(24):
        body, motion = random_shake(seed)
        response = rk.simulate(body, motion, 0.6, engine=engine)
        if math.isnan(response.least_force):
            continue
        up, along = of_the_path(body, response, motion)
        # differences over an eighth of a step leave out some 1e-4 of the weight
        assert response.least_force == pytest.approx(up.min(), abs=1e-3)
        demand = np.divide(np.abs(along), up, where=up > 0.0, out=np.full_like(up, math.inf)).max()
        if not 0.0 <= up.min() < 0.1:  # where it nearly lifts, the ratio is anything
            assert response.trajectory.friction_demand == pytest.approx(demand, rel=5e-3)
        before = STEP * math.floor(np.nan_to_num(response.overturning_time) / STEP)
        over = response.outcome is rk.Outcome.OVERTURNED
        stood, fell = stood + (not over), fell + over
        late += over and of_the_path(body, response, motion, before)[0].min() > response.least_force + 3e-3
    assert min(stood, fell, late) >= 3


@pytest.mark.verifies("closed form", "forces at the instants that count, by energy", within="1e-5", control="within")
@pytest.mark.parametrize("engine", ENGINES)
def test_what_follows_a_motion_that_ends(engine: str) -> None:
    """On resting ground: just after the end where the body is about to overturn, and after an impact that overturns it.

    N = 1 - q (sin^2 u + e cos u) over the weight; the other foot, further out, bears less after the impact than the
    first before it.
    """
    alpha, q, p = {"right": 0.1, "left": 0.4}, 0.75, 2.0
    sides = {f"alpha_{foot}": angle for foot, angle in alpha.items()}
    sides |= {f"{name}_{foot}": value for foot in alpha for name, value in (("p", p), ("q", q), ("r", 0.99))}
    lifted = rk.GroundMotion(np.zeros(2), 1e-7, vertical=np.full(2, 0.5 * g)).segments()

    def least(rotation: float, velocity: float, name: str = "least_force") -> float:
        batch = Batch([lifted], engine=engine)
        rows = Rows.of(1, scale=1.0, rotation=rotation, velocity=velocity, **sides)
        found, _ = batch.run(1, lambda a, b: rows)
        assert found["outcome"] == rk.Outcome.OVERTURNED.code
        return float(found[name][0])

    def normal(u: float, speed: float) -> float:
        return 1.0 - q * (math.sin(u) ** 2 + (speed / p) ** 2 * math.cos(u))

    def demand(u: float, speed: float, weight: float) -> float:
        moment, spin = weight * math.sin(u), (speed / p) ** 2
        along, up = q * (moment * math.cos(u) - spin * math.sin(u)), q * (moment * math.sin(u) + spin * math.cos(u))
        return abs(along) / (weight - up)

    assert least(0.05, 0.3) == pytest.approx(normal(0.05, 0.3), rel=1e-5)
    either = max(demand(0.05, 0.3, weight) for weight in (1.0, 1.5))
    assert least(0.05, 0.3, "friction_demand") == pytest.approx(either, rel=1e-5)
    assert least(0.05, 0.3) != pytest.approx(normal(0.05, 0.3) + 0.5, rel=1e-2)  # negative control: while it lifts
    arrives = math.sqrt(0.9**2 + 2.0 * p**2 * (math.cos(0.05) - math.cos(0.1)))
    after = normal(alpha["left"], 0.99 * arrives)
    assert after < normal(alpha["right"], arrives) - 0.05
    assert least(0.05, -0.9) == pytest.approx(after, rel=1e-5)
    steps = [demand(0.05, -0.9, 1.5), demand(0.1, arrives, 1.0), demand(0.4, 0.99 * arrives, 1.0)]
    assert least(0.05, -0.9, "friction_demand") == pytest.approx(max(steps), rel=1e-5)


@pytest.fixture
def _no_flight(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a body does that may fly, which takes longest, is not asked."""
    monkeypatch.setattr(rk.Response, "doubts", lambda _: [])


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine", "the reference engine", within="1e-8 of the weight", control="test_wrong_forces_are_noticed"
)
@pytest.mark.usefixtures("_no_flight")
@pytest.mark.parametrize("linear", [False, True])
def test_motions_that_are_cut(linear: bool) -> None:
    """Engines agree to rounding wherever the ground is taken to stop, also where the body overturns after it.

    Feet that differ: after an impact the ground may have to pull more than before it.
    """
    fallen = 0
    for seed in range(4):
        body, motion = random_shake(seed)
        for duration in np.arange(0.4, 3.6, 0.2):
            fast, slow = (
                rk.simulate(body, motion, 0.6, engine=e, duration=float(duration), linear=linear).trajectory
                for e in ENGINES
            )
            assert fast.outcome is slow.outcome
            assert fast.least_force == pytest.approx(slow.least_force, abs=1e-8, nan_ok=True)
            fallen += fast.outcome is rk.Outcome.OVERTURNED and fast.overturning_time > duration - 1e-9
    assert fallen


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine",
    "the reference engine, and the forces of the response",
    within="1e-8 and 1e-9 of the weight",
    control="test_wrong_forces_are_noticed",
)
@pytest.mark.usefixtures("_no_flight")
@pytest.mark.parametrize("vertical", [0.0, 5.0, 14.0])
def test_engines_and_forces_at_samples_agree(vertical: float) -> None:
    """Both engines and the forces of the response, found by other equations at the same instants: to rounding."""
    for seed in range(5):
        motion = shaken(seed, vertical)
        fast, slow = (rk.simulate(LEANING, motion, 0.85, engine=name) for name in ENGINES)
        if math.isnan(fast.least_force):
            continue
        weight = LEANING.mass * g
        assert fast.least_force == pytest.approx(slow.least_force, abs=1e-8)
        assert fast.least_force == pytest.approx(min(1.0, fast.contact.least_vertical / weight), abs=1e-9)
        assert fast.lost_contact == (fast.contact.least_vertical < 0.0)


@pytest.mark.verifies("closed form", "force of the ground by energy", within="1e-9", control="within")
@pytest.mark.parametrize("engine", ENGINES)
def test_closed_forms(engine: str) -> None:
    """Let go at an angle, N = m g (1 - q sin^2 u) at first; before the first impact 1 - q (sin^2 + 2 (1 - E) cos)."""
    block = rk.Block(width=0.6, height=1.8)
    alpha, start = block.slenderness_angle, 0.7 * block.slenderness_angle
    response = rk.free_rocking(block, start, 0.5, engine=engine)
    sine, cosine = math.sin(alpha), math.cos(alpha)
    energy = math.cos(alpha - start) - cosine  # u'^2 / (2 p^2) when it lands
    least = min(1.0 - 0.75 * math.sin(alpha - start) ** 2, 1.0 - 0.75 * (sine**2 + 2.0 * energy * cosine))
    assert response.least_force == pytest.approx(least, rel=1e-9, abs=0.0)
    wrong_sign = 1.0 + 0.75 * (sine**2 + 2.0 * energy * cosine)
    assert response.least_force != pytest.approx(wrong_sign, rel=1e-3)  # negative controls
    assert response.least_force != pytest.approx(1.0 - 0.75 * sine**2, rel=1e-3)  # without the centripetal part


@pytest.mark.verifies("closed form", "force at the release", within="1e-12")
def test_a_body_that_falls_counts_up_to_its_foot() -> None:
    """Released beyond the top and let fall, forces of the fall itself are not asked for: only the start counts."""
    block = rk.Block(width=0.6, height=1.8)
    for engine in ENGINES:
        response = rk.free_rocking(block, 1.2 * block.slenderness_angle, 0.5, engine=engine)
        expected = 1.0 - 0.75 * math.sin(0.2 * block.slenderness_angle) ** 2
        assert response.least_force == pytest.approx(expected, rel=1e-12, abs=0.0)


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("engine", ENGINES)
def test_a_ground_that_falls_twice_as_fast_as_gravity_is_told(engine: str) -> None:
    """At -2 g, with and without a push: contact is lost, whatever the verdict, and it says so without `friction=`."""
    up = np.zeros(200)
    up[50:80] = -2.0 * g
    for push in (0.0, 0.5):
        motion = rk.GroundMotion(push * np.sin(np.arange(200.0)), 0.01, vertical=up)
        with pytest.warns(PureRockingWarning, match=r"(?s)tensile.*Rocking alone: .*With flight.*: "):
            response = rk.simulate(LEANING, motion, 0.9, engine=engine)
        assert response.lost_contact
        assert response.least_force <= -1.0 + 1e-9
        assert rk.Outcome.FLEW.value in response.doubts()[0] or "overturned" in response.doubts()[0]


@pytest.mark.verifies("behaviour")
def test_what_nobody_hears_is_not_followed_and_what_is_asked_is_followed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The history that may fly is computed for a warning that is heard, not for one that is ignored, and once."""
    followed = []
    monkeypatch.setattr(
        rk.dynamics.Response, "_flight_text", lambda response, friction: followed.append(friction) or "flew"
    )
    up = np.full(80, -2.0 * g)
    motion = rk.GroundMotion(0.5 * np.sin(np.arange(80.0)), 0.01, vertical=up)
    response = rk.simulate(LEANING, motion, 0.9)
    assert response.lost_contact
    assert followed == []
    assert response.doubts() == response.doubts() == ["flew"]
    assert followed == [math.inf]
    with warnings.catch_warnings():
        # a filter of sentences may let some through
        warnings.filterwarnings("ignore", message="flew", category=PureRockingWarning)
        rk.simulate(LEANING, motion, 0.9)
    with pytest.warns(PureRockingWarning, match="flew"):
        rk.simulate(LEANING, motion, 0.9)
    assert followed == [math.inf] * 3


@pytest.mark.verifies("negative control", "a weak motion without a vertical part")
def test_nothing_is_said_where_contact_holds() -> None:
    """Without a vertical part, a weak motion: no warning, and the least force is between nought and one."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        response = rk.simulate(LEANING, shaken(1, 0.0), 0.85)
    assert response.lost_contact is False
    assert response.doubts() == []


@pytest.mark.verifies("same bits", "other threads, another order, and the history alone")
def test_batches_carry_the_same_bits() -> None:
    """A history has the same forces alone, in batches of any threads, and beside others; the sentence counts them."""
    motions = [shaken(seed, vertical) for seed in range(6) for vertical in (2.0, 12.0)]
    found = rk.simulate_many(LEANING, motions, [0.8, 0.9], scale=[0.7, 1.3], threads=1)
    again = rk.simulate_many(LEANING, motions[::-1], [0.8, 0.9], scale=[0.7, 1.3], threads=2)
    for name in ("least_force", "friction_demand", "lost_contact"):
        np.testing.assert_array_equal(found[name].to_numpy(), again[name].to_numpy()[:, ::-1])
    alone = rk.simulate(LEANING, motions[3], 0.9, scale=1.3, duration=motions[3].duration)
    assert alone.least_force == float(found["least_force"][0, 3, 1, 1])
    lost = int(found["lost_contact"].sum())
    assert 0 < lost < found["lost_contact"].size
    assert found.attrs["contact"].startswith(
        f"the contact force becomes tensile in {lost} of {found['lost_contact'].size} histories"
    )
    assert contact_words(found["lost_contact"].to_numpy() * 0.0) == ""


@pytest.mark.verifies("behaviour")
def test_without_the_inertia_nothing_is_claimed() -> None:
    """Rows that do not say how the mass is spread have no forces: neither kept nor lost."""
    values = dict.fromkeys(("alpha_right", "alpha_left"), 0.25) | dict.fromkeys(("p_right", "p_left"), 2.5)
    values |= dict.fromkeys(("r_right", "r_left"), 0.9)
    for engine in ENGINES:
        batch = Batch([shaken(1, 3.0).segments()], engine=engine)
        found, _ = batch.run(1, lambda a, b: Rows.of(b - a, scale=1.0, **values))
        assert np.isnan(found["least_force"]).all()
        assert np.isfinite(found["peak_rotation"]).all()


@pytest.mark.verifies("negative control", "forces without the centripetal part, the other way, of the other side")
@pytest.mark.parametrize("which", ["no centripetal part", "the other way", "the other side"])
def test_wrong_forces_are_noticed(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative controls: the comparison with the other engine does not hold for forces that are wrong."""
    motion, right = shaken(2, 3.0), Reference._note_force
    true = rk.simulate(LEANING, motion, 0.85, engine="fast").least_force

    def wrong(self: Reference, u: float, rate: float, push: float, weight: float) -> None:
        spin, sign = 0.0 if which == "no centripetal part" else rate, -1.0 if which == "the other way" else 1.0
        right(self, -u if which == "the other side" else u, spin, sign * push, weight)

    monkeypatch.setattr(Reference, "_note_force", wrong)
    assert rk.simulate(LEANING, motion, 0.85, engine="reference").least_force != pytest.approx(true, abs=1e-3)
