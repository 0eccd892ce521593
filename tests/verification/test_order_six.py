"""Order 6 takes the place of order 8 only where it is as good, under many g too (docs/theory/engines.md)."""

from typing import Any

import numpy as np
import pytest
from engines import built

from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings
from rocking.dynamics.batch import Batch
from rocking.dynamics.rows import Rows
from rocking.motions import Segments

pytestmark = [pytest.mark.verifies(room="rocking in the plane"), built]

STEP, COUNT = 0.01, 300


def errors(reach: float, strength: float, settings: PlaneSettings, seed: int = 3) -> np.ndarray:
    """Errors of peaks over alpha against steps of a thousandth; bodies of reach p dt, samples of up to `strength` g."""
    random = np.random.default_rng(seed)
    alpha, p = random.uniform(0.1, 0.5, COUNT), np.full(COUNT, reach / STEP)
    motions = [Segments.between_samples(STEP, np.r_[0.0, random.uniform(-1.0, 1.0, 6), 0.0]) for _ in range(COUNT)]

    def rows(first: int, last: int) -> Rows:
        part = slice(first, last)
        values = {"alpha": alpha[part], "p": p[part], "r": np.full(last - first, 0.9)}
        both = {f"{name}_{side}": value for name, value in values.items() for side in ("right", "left")}
        return Rows.of(last - first, np.arange(first, last), scale=np.full(last - first, strength * g), **both)

    def run(chosen: PlaneSettings) -> dict[str, np.ndarray]:
        return Batch(motions, ConstantRestitution(), chosen, 1, "fast").run(COUNT, rows)[0]

    found, truth = run(settings), run(PlaneSettings(longest_step=0.001))
    same = (found["outcome"] == 1) & (truth["outcome"] == 1) & (found["impacts"] == truth["impacts"])
    assert same.sum() > 50
    return (np.abs(found["peak_rotation"] - truth["peak_rotation"]) / alpha)[same]


@pytest.mark.verifies(
    "order", "the same engine at steps of 0.001", within="1e-8 of alpha", control="test_order_six_would_not_be"
)
@pytest.mark.parametrize(
    ("reach", "strength"), [(0.024, 1.0), (0.01, 3.0), (0.01, 10.0), (0.005, 10.0), (0.005, 30.0), (0.002, 100.0)]
)
def test_the_order_that_is_taken_is_good_to_1e_8(reach: float, strength: float, agreement: Any) -> None:
    """Peaks are right to 1e-8 alpha whichever order is taken, up to 100 g."""
    agreement(errors(reach, strength, PlaneSettings()).max(), 1e-8)


@pytest.mark.verifies("negative control", "order 6 wherever its former rule took it")
@pytest.mark.parametrize(("reach", "strength"), [(0.01, 10.0), (0.005, 30.0), (0.002, 100.0)])
def test_order_six_would_not_be(reach: float, strength: float) -> None:
    """The control: it was taken here as long as its rule looked at p dt sqrt(b / 2) < 0.0245 alone."""
    assert reach * np.sqrt(0.5 * strength) < 0.0245
    assert errors(reach, strength, PlaneSettings(order=6)).max() > 1e-8


@pytest.mark.verifies(
    "order", "the fifth power of p dt and the third of the acceleration", within="4.8 to 6.2, and 2.8 to 5.0"
)
def test_what_order_six_leaves_out_grows_as_stated() -> None:
    """With the fifth power of p dt and the third of b, by which the rule goes: medians over bodies and records.

    An error of the velocity grows for as long as the flight lasts, which is longer the further the body is thrown:
    while that is short against 1 / p, up to a power of each is added. The lower bounds are what the rule needs.
    """
    six = PlaneSettings(order=6)
    by_reach = [np.median(errors(reach, 10.0, six)) for reach in (0.005, 0.02)]
    by_strength = [np.median(errors(0.01, strength, six)) for strength in (3.0, 12.0)]
    assert 4.8 < np.log(by_reach[1] / by_reach[0]) / np.log(4.0) < 6.2
    assert 2.8 < np.log(by_strength[1] / by_strength[0]) / np.log(4.0) < 5.0
