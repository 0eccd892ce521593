"""The model `contact-bed` against impacts resolved in time, at points that are not in its table."""

import math

import numpy as np
import pytest

from rocking.bodies import Block
from rocking.conventions import FloatArray
from rocking.dynamics.bed import fast
from rocking.errors import InvalidValueError
from rocking.restitution import model
from rocking.restitution.bed_table import POINTS, STATED_ERROR, BedTable, bed_table, nodes
from rocking.studies.impact_laboratory.beds import Laboratory, hardness_of
from rocking.studies.impact_laboratory.tabulation import impulse_position, resolved

needs_engine = pytest.mark.skipif(not fast.available(), reason="the bed's fast engine was not built")


def random_cases(count: int, seed: int) -> FloatArray:
    axes = nodes()
    low, high = np.array([axis[0] for axis in axes]), np.array([axis[-1] for axis in axes])
    share = np.random.default_rng(seed).random((count, 4))
    cases = low + share * (high - low)
    cases[:, 2:] = low[2:] * (high[2:] / low[2:]) ** share[:, 2:]
    return cases


def read(table: BedTable, points: int, cases: FloatArray) -> FloatArray:
    found = []
    for flatness, offset, damping, hardness in cases.tolist():
        kappa = table.position(table.plane(points, damping, hardness), np.array(flatness), np.array(offset))
        arm, gyration = float(kappa) - offset, 1.0 / flatness - 1.0
        found.append((gyration - arm * (1.0 + offset)) / (gyration + arm * (1.0 - offset)))
    return np.array(found)


@needs_engine
@pytest.mark.parametrize("points", POINTS)
def test_stated_error(points: int) -> None:
    """300 random impacts inside the table are met within the stated error; a quarter of the nodes would not do."""
    cases = random_cases(300, seed=points)
    exact = resolved(cases, points)
    assert np.abs(read(bed_table(), points, cases) - exact).max() <= STATED_ERROR
    if points > 2:  # negative control; two points are Housner's impact, the same everywhere in the table
        assert np.abs(read(bed_table().coarser(), points, cases) - exact).max() > STATED_ERROR


@needs_engine
def test_the_table_is_what_is_computed() -> None:
    """Nodes of the shipped table computed again differ by its rounding, 2^-16, and no more."""
    table, rng = bed_table(), np.random.default_rng(5)
    at = np.column_stack([rng.integers(0, axis.size, 40) for axis in nodes()])
    cases = np.column_stack([axis[at[:, i]] for i, axis in enumerate(nodes())])
    for i, points in enumerate(POINTS):
        kappa = impulse_position(resolved(cases, points), cases[:, 0], cases[:, 1])
        assert kappa == pytest.approx(table.positions[i][tuple(at.T)], abs=2.0**-16 + 1e-6)


# physics.md 3.4, zeta = 1 and 3, 400 Hz, b = 0.1 m, released at half the slenderness angle
REF = {
    (2.0, 2): (0.700, 0.700), (2.0, 3): (0.766, 0.764), (2.0, 5): (0.808, 0.808), (2.0, 11): (0.840, 0.845),
    (2.0, 41): (0.850, 0.850), (4.0, 2): (0.912, 0.912), (4.0, 3): (0.933, 0.934), (4.0, 5): (0.948, 0.950),
}  # fmt: skip


@pytest.mark.parametrize("case", REF)
def test_reference_values(case: tuple[float, int]) -> None:
    """The table of physics.md 3.4 within .01: it has two to three digits, and n = 41 is a large release."""
    ratio, points = case
    setup = Laboratory(slenderness=ratio, points=points).setup
    for damping, expected in zip((1.0, 3.0), REF[case], strict=True):
        bed = model("contact-bed", points=points, damping=damping, hardness=hardness_of(setup))
        assert bed.coefficient(setup_block(ratio)) == pytest.approx(expected, abs=0.01)


def setup_block(ratio: float) -> Block:
    return Block(width=0.2, height=0.2 * ratio)


def test_two_points_are_housner() -> None:
    """n = 2 is 1 - 1.5 sin^2 alpha (physics.md 1.1) within .003 for the hardest bed, and more points lose less."""
    for ratio in (1.5, 2.0, 4.0, 8.0):
        r = [model("contact-bed", points=n, hardness=1000.0).coefficient(setup_block(ratio)) for n in POINTS]
        assert r[0] == pytest.approx(1.0 - 1.5 / (1.0 + ratio**2), abs=3e-3)
        assert (np.diff(r) > 0.0).all()


def test_between_viscous_and_elastic() -> None:
    """Many points of a damped bed lie above distributed impulse q = 1 (physics.md 1.5), its limit without springs."""
    for ratio, viscous in {1.0: 0.4774610600698219, 2.0: 0.7965354225163898, 4.0: 0.9408847304180785}.items():
        for hardness in (30.0, 100.0, 1000.0):
            bed = model("contact-bed", hardness=hardness)
            assert viscous < bed.coefficient(setup_block(ratio)) < 1.0


@pytest.mark.parametrize(
    "wrong", [{"points": 4}, {"points": 2.5}, {"damping": 0.3}, {"hardness": 1e5}, {"hardness": math.nan}]
)
def test_beds_that_were_not_tabulated_are_refused(wrong: dict[str, float]) -> None:
    """A bed outside the table is refused with the way out."""
    with pytest.raises(InvalidValueError, match=next(iter(wrong))):
        model("contact-bed", **wrong)
