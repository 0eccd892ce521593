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
from rocking.dynamics.batch import Batch, Rows
from rocking.dynamics.lost_contact import contact_words
from rocking.dynamics.reference import Reference
from rocking.errors import PureRockingWarning

LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])
STEP = 0.005
ENGINES = ["fast", "reference"]
pytestmark = pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")


def shaken(seed: int, vertical: float, horizontal: float = 4.0) -> rk.GroundMotion:
    """A record of 4 s with parts of some hertz, horizontal and vertical [m/s2]."""
    rng, t = np.random.default_rng(seed), np.arange(801) * STEP
    waves = [
        sum(rng.normal() * np.sin(2.0 * np.pi * f * t + rng.uniform(0.0, 6.0)) for f in rng.uniform(0.5, high, 6))
        for high in (2.5, 6.0)
    ]
    across, up = (size * wave / np.abs(wave).max() for size, wave in zip((horizontal, vertical), waves, strict=True))
    return rk.GroundMotion(np.asarray(across), STEP, vertical=np.asarray(up) if vertical else None)


def by_hand(response: Any, motion: rk.GroundMotion) -> tuple[np.ndarray, np.ndarray]:
    """Forces over m g within the samples from the rotations alone: second differences of the path of the centre."""
    side = {1.0: LEANING.side("right"), -1.0: LEANING.side("left")}
    theta, sign = response.rotation, np.sign(response.rotation)
    angle = np.where(sign > 0, side[1.0].slenderness_angle, side[-1.0].slenderness_angle) - np.abs(theta)
    size = np.where(sign > 0, side[1.0].semi_diagonal, side[-1.0].semi_diagonal)
    x, z = -sign * size * np.sin(angle), size * np.cos(angle)
    within = (sign[1:-1] != 0) & (sign[:-2] == sign[1:-1]) & (sign[2:] == sign[1:-1])
    n = theta.size
    lift = np.zeros(n) if motion.vertical is None else np.append(motion.vertical, np.zeros(n))[:n]
    push = np.append(motion.acceleration, np.zeros(n))[:n]
    up = (g + lift[1:-1] + (z[2:] - 2.0 * z[1:-1] + z[:-2]) / STEP**2) / g
    along = (push[1:-1] + (x[2:] - 2.0 * x[1:-1] + x[:-2]) / STEP**2) / g
    return up[within], along[within]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("vertical", [0.0, 3.0, 12.0])
def test_forces_are_those_of_the_path_of_the_centre(engine: str, vertical: float) -> None:
    """The extremes are those of mass times acceleration, within what differences over 5 ms leave open."""
    seen = 0
    for seed in range(4):
        motion = shaken(seed, vertical)
        response = rk.simulate(LEANING, motion, 0.85, engine=engine, duration=motion.duration)
        if not response.impacts.size or response.outcome is rk.Outcome.OVERTURNED:
            continue
        up, along = by_hand(response, motion)
        # differences miss what happens at impacts, by the change over one sample: a few hundredths of the weight
        assert response.least_force == pytest.approx(up.min(), abs=0.04)
        if up.min() > 0.2:
            assert response.trajectory.friction_demand == pytest.approx((np.abs(along) / up).max(), rel=0.08)
        seen += 1
    assert seen


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


@pytest.mark.parametrize("engine", ENGINES)
def test_closed_forms(engine: str) -> None:
    """Let go at an angle, N = m g (1 - q sin^2 u) at first; before the first impact 1 - q (sin^2 + 2 (1 - E) cos)."""
    block = rk.Block(width=0.6, height=1.8)
    alpha, start = block.slenderness_angle, 0.7 * block.slenderness_angle
    response = rk.free_rocking(block, start, 0.5, engine=engine)
    sine, cosine = math.sin(alpha), math.cos(alpha)
    energy = math.cos(alpha - start) - cosine  # u'^2 / (2 p^2) when it lands
    least = min(1.0 - 0.75 * math.sin(alpha - start) ** 2, 1.0 - 0.75 * (sine**2 + 2.0 * energy * cosine))
    assert response.least_force == pytest.approx(least, rel=1e-9)
    wrong_sign = 1.0 + 0.75 * (sine**2 + 2.0 * energy * cosine)
    assert response.least_force != pytest.approx(wrong_sign, rel=1e-3)  # negative controls
    assert response.least_force != pytest.approx(1.0 - 0.75 * sine**2, rel=1e-3)  # without the centripetal part


def test_a_body_that_falls_counts_up_to_its_foot() -> None:
    """Released beyond the top and let fall, forces of the fall itself are not asked for: only the start counts."""
    block = rk.Block(width=0.6, height=1.8)
    for engine in ENGINES:
        response = rk.free_rocking(block, 1.2 * block.slenderness_angle, 0.5, engine=engine)
        expected = 1.0 - 0.75 * math.sin(0.2 * block.slenderness_angle) ** 2
        assert response.least_force == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_ground_that_falls_twice_as_fast_as_gravity_is_told(engine: str) -> None:
    """At -2 g, with and without a push: contact is lost, whatever the verdict, and it says so without `friction=`."""
    up = np.zeros(200)
    up[50:80] = -2.0 * g
    for push in (0.0, 0.5):
        motion = rk.GroundMotion(push * np.sin(np.arange(200.0)), 0.01, vertical=up)
        with pytest.warns(PureRockingWarning, match=r"(?s)pull.*rocking alone: .*if it may fly, .*: "):
            response = rk.simulate(LEANING, motion, 0.9, engine=engine)
        assert response.lost_contact
        assert response.least_force <= -1.0 + 1e-9
        assert rk.Outcome.FLEW.value in response.doubts()[0] or "overturned" in response.doubts()[0]


def test_nothing_is_said_where_contact_holds() -> None:
    """Without a vertical part, a weak motion: no warning, and the least force is between nought and one."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        response = rk.simulate(LEANING, shaken(1, 0.0), 0.85)
    assert response.lost_contact is False
    assert response.doubts() == []


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
    assert found.attrs["contact"].startswith(f"in {lost} of {found['lost_contact'].size} histories")
    assert contact_words(found["lost_contact"].to_numpy() * 0.0) == ""


def test_without_the_inertia_nothing_is_claimed() -> None:
    """Rows that do not say how the mass is spread have no forces: neither kept nor lost."""
    values = dict.fromkeys(("alpha_right", "alpha_left"), 0.25) | dict.fromkeys(("p_right", "p_left"), 2.5)
    values |= dict.fromkeys(("r_right", "r_left"), 0.9)
    for engine in ENGINES:
        batch = Batch([shaken(1, 3.0).segments()], engine=engine)
        found, _ = batch.run(1, lambda a, b: Rows.of(b - a, scale=1.0, **values))
        assert np.isnan(found["least_force"]).all()
        assert np.isfinite(found["peak_rotation"]).all()


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
