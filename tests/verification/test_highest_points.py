"""The highest point of a history where it is hard to see: at a step's end, and in a leap within one step."""

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from engines import built

from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings
from rocking.dynamics.batch import Batch
from rocking.dynamics.rows import Rows
from rocking.motions import Segments

pytestmark = [pytest.mark.verifies(room="rocking in the plane"), built]

STEP, BODIES, NEIGHBOURS = 0.1, 60, 41


def run(samples: np.ndarray, values: dict[str, Any], name: str = "fast", **settings: Any) -> dict[str, np.ndarray]:
    """Results of bodies with both sides alike but where a side is named, under samples [m/s2]."""
    both = {f"{key}_{side}": values[key] for key in ("alpha", "p", "r") if key in values for side in ("right", "left")}
    given = {**both, **{key: value for key, value in values.items() if key not in ("alpha", "p", "r")}}
    batch = Batch([Segments.between_samples(STEP, samples)], ConstantRestitution(), PlaneSettings(**settings), 1, name)

    def rows(first: int, last: int) -> Rows:
        part = {key: np.asarray(value)[first:last] for key, value in given.items()}
        return Rows.of(last - first, np.zeros(last - first, int), **part)

    return batch.run(len(values["rotation"]), rows)[0]


def rises_for(alpha: float, p: float, top: float, linear: bool, time: float) -> tuple[float, float]:
    """Rotation and velocity from which a body rises to a top for so long: a Taylor series of 30 terms, to 40 digits."""
    with mp.workdps(40):
        u, s, c = [mp.mpf(alpha) - mp.mpf(top), mp.mpf(0)], [], []
        s0 = u[0] if linear else mp.sin(u[0])
        s.append(s0)
        c.append(mp.mpf(1) if linear else mp.cos(u[0]))
        for k in range(30):
            u.append(mp.mpf(p) ** 2 * s[k] / ((k + 1) * (k + 2)))
            slopes = [(j + 1) * u[j + 1] for j in range(k + 1)]
            s.append(u[k + 1] if linear else mp.fsum(slopes[j] * c[k - j] for j in range(k + 1)) / (k + 1))
            c.append(mp.mpf(0) if linear else -mp.fsum(slopes[j] * s[k - j] for j in range(k + 1)) / (k + 1))
        t = mp.mpf(time)
        at = mp.fsum(term * t**k for k, term in enumerate(u))
        speed = mp.fsum(k * term * t ** (k - 1) for k, term in enumerate(u) if k)
        return float(mp.mpf(alpha) - at), float(speed)


def rising_bodies(linear: bool, samples: float) -> tuple[dict[str, Any], np.ndarray]:
    """Bodies let go so that they turn round so many samples later, to the last digits of their velocity; their tops."""
    random = np.random.default_rng(7)
    values: dict[str, list[float]] = {"alpha": [], "p": [], "rotation": [], "velocity": []}
    tops = []
    for _ in range(BODIES):
        alpha, p = random.uniform(0.1, 0.6), random.uniform(0.3, 1.0)
        top = alpha * random.uniform(0.2, 0.8)
        rotation, velocity = rises_for(alpha, p, top, linear, samples * STEP)
        for digit in range(NEIGHBOURS):
            values["alpha"].append(alpha)
            values["p"].append(p)
            values["rotation"].append(rotation)
            values["velocity"].append(velocity + (digit - NEIGHBOURS // 2) * np.spacing(velocity))
            tops.append(top)
    found = {key: np.array(value) for key, value in values.items()}
    return {**found, "r": np.full(len(tops), 0.1)}, np.array(tops)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "Taylor series of 30 terms with 40 digits", within="1e-11 rad", control="within")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("samples", [1.0, 2.0, 1.5])
def test_a_top_at_the_end_of_a_step_is_not_lost(samples: float, linear: bool, agreement: Any) -> None:
    """Whether a step ends with the last bit of the velocity or the next one begins with it, the top is seen.

    The control is the same bodies let go a thousandth faster: their tops are higher by far more than the tolerance.
    """
    values, tops = rising_bodies(linear, samples)
    found = run(np.zeros(8), values, linear=linear)
    agreement(np.abs(found["peak_rotation"] - tops).max(), 1e-11)  # what order 8 leaves out at p dt = 0.1, and rounding
    assert np.abs(found["peak_time"] - samples * STEP).max() < 1e-5  # a top is flat: half the digits of its height
    faster = run(np.zeros(8), {**values, "velocity": 1.001 * values["velocity"]}, linear=linear)
    assert np.abs(faster["peak_rotation"] - tops).min() > 1e-8


@pytest.mark.verifies("second engine", "the reference engine", within="1e-6")
def test_a_leap_within_one_step_has_a_top() -> None:
    """Nearly at rest after an impact, lifted and pressed down again before the step ends: higher than ever before.

    The record's first line goes from 1 g to -5 g, which sends the body from its wide side over to its slender one.
    """
    values = {
        "alpha_right": [1.4], "alpha_left": [0.1], "p": np.ones(1), "r": np.full(1, 1e-3),
        "rotation": [1e-5], "velocity": [-0.01],
    }  # fmt: skip
    samples = g * np.array([1.0, -5.0, 0.0, 0.0, 0.0])
    truth = run(samples, values, "reference")
    assert truth["peak_rotation"][0] < -1e-4  # ten times as far as it was let go, to the other side
    for settings in ({}, {"longest_step": 0.01}):
        found = run(samples, values, **settings)
        assert found["peak_rotation"][0] == pytest.approx(truth["peak_rotation"][0], rel=1e-6)
        assert found["peak_time"][0] == pytest.approx(truth["peak_time"][0], rel=1e-6)


@pytest.mark.verifies("behaviour")
def test_too_many_steps_without_uplift_are_refused() -> None:
    """A body that nothing lifts, whose steps would be too many, is told as not resolved, and its neighbours are not."""
    count = 3
    values = {
        "alpha": np.full(count, 0.2), "p": np.array([1.0, 1e8, 1.0]), "r": np.full(count, 0.9),
        "rotation": np.zeros(count), "velocity": np.zeros(count),
    }  # fmt: skip
    found = run(np.full(33, 1e-9), values)
    assert found["status"].tolist() == [0, 4, 0]
    assert np.isnan(found["peak_rotation"]).tolist() == [False, True, False]
