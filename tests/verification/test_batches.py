"""The results of a batch belong to its rows alone: not to threads, order, pieces, neighbours or instruction sets."""

import resource
import sys
import tracemalloc
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from engines import built

import rocking as rk
from rocking.dynamics import (
    ConstantRestitution,
    ImpactLaw,
    PlaneSettings,
    RandomRestitution,
    RockingParameters,
    RockingSide,
    SpeedRestitution,
    rows,
)
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane import batch, fast_engine
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.rows import Rows
from rocking.motions import Segments

pytestmark = [
    pytest.mark.verifies("same bits", control="test_a_changed_row_is_seen", room="rocking in the plane"),
    built,
]

KINDS = ("records", "vertical", "pulses")
COUNT = 700


@dataclass(frozen=True)
class Table:
    """Histories as arrays, any of which can be asked for."""

    motions: list[Segments]
    values: dict[str, Any]
    motion: Any
    key: Any = field(default_factory=lambda: np.arange(COUNT))

    def picked(self, order: Any) -> "Table":
        return Table(self.motions, {k: v[order] for k, v in self.values.items()}, self.motion[order], self.key[order])

    def rows(self, first: int, last: int) -> Rows:
        part = slice(first, last)
        return Rows.of(last - first, self.motion[part], self.key[part], **{k: v[part] for k, v in self.values.items()})

    def run(
        self, law: ImpactLaw | None = None, settings: PlaneSettings | None = None, threads: int = 2, name: str = "fast"
    ) -> dict[str, Any]:
        whole = Batch(self.motions, law or ConstantRestitution(), settings or PlaneSettings(), threads, name)
        return whole.run(self.motion.size, self.rows)[0]


def motions_of(kind: str, random: np.random.Generator) -> list[Segments]:
    if kind == "pulses":
        shapes = [rk.pulses.sine(a, period) for a in (3.0, 9.0) for period in (0.3, 1.1)]
        return [pulse.segments().extended(3.0) for pulse in shapes]
    found = []
    for count in (11, 60, 64, 65, 200):  # on both sides of the blocks of 32 stretches
        x, z = random.normal(size=(2, count)) * [[4.0], [3.0]]
        found.append(Segments.between_samples(0.04, x, z if kind == "vertical" else None))
    return found


def table_of(kind: str, count: int = COUNT, seed: int = 11) -> Table:
    """Bodies of all kinds, some of which start in motion; most rock, some rest, some fall."""
    random = np.random.default_rng([seed, KINDS.index(kind)])
    motions = motions_of(kind, random)
    ranges = {"alpha": (0.08, 0.6), "p": (0.8, 6.0), "r": (0.0, 1.0)}
    values = {f"{name}_{side}": random.uniform(*ranges[name], count) for name in ranges for side in ("right", "left")}
    values["scale"] = random.uniform(0.1, 2.0, count)
    moving = random.uniform(size=count) < 0.3
    values["rotation"] = np.where(moving, random.uniform(-0.05, 0.05, count), 0.0)
    values["velocity"] = np.where(moving, random.uniform(-0.1, 0.1, count), 0.0)
    return Table(motions, values, random.integers(0, len(motions), count), np.arange(count))


def same_bits(one: dict[str, Any], other: dict[str, Any]) -> bool:
    return all(one[name].tobytes() == other[name].tobytes() for name in fast_engine.RESULTS)


@pytest.mark.verifies(against="1, 2, 4 and 8 threads")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_threads_do_not_matter(kind: str, linear: bool) -> None:
    """1, 2, 4 and 8 threads give the same bits, and the table is worth it: it has all outcomes."""
    table, settings = table_of(kind), PlaneSettings(linear=linear)
    first = table.run(settings=settings, threads=1)
    assert set(first["outcome"].tolist()) == {0, 1, 2}
    assert all(same_bits(first, table.run(settings=settings, threads=threads)) for threads in (2, 4, 8))


@pytest.mark.verifies(against="the same rows shuffled, reversed, repeated and alone")
@pytest.mark.parametrize("kind", KINDS)
def test_order_and_neighbours_do_not_matter(kind: str) -> None:
    """Rows shuffled, reversed, repeated or alone give the bits that they give in the table."""
    table = table_of(kind)
    first, random = table.run(), np.random.default_rng(3)
    orders = [
        random.permutation(COUNT), np.arange(COUNT)[::-1], np.repeat(np.arange(0, COUNT, 7), 9), np.arange(3, 8),
        *([k] for k in range(0, COUNT, 50)),
    ]  # fmt: skip
    for order in orders:
        again = table.picked(order).run()
        assert same_bits({name: values[order] for name, values in first.items()}, again)


@pytest.mark.verifies("negative control", "one row that starts one unit in the last place higher")
def test_a_changed_row_is_seen() -> None:
    """Negative control: one row that starts one rounding step higher changes its own bits and no others."""
    table = table_of("records")
    changed = {k: v.copy() for k, v in table.values.items()}
    row = int(np.flatnonzero(table.run()["impacts"] > 3)[0])
    changed["scale"][row] = np.nextafter(changed["scale"][row], 9.0)
    one, other = table.run(), Table(table.motions, changed, table.motion).run()
    assert not same_bits(one, other)
    others = np.arange(COUNT) != row
    assert same_bits({k: v[others] for k, v in one.items()}, {k: v[others] for k, v in other.items()})


@pytest.mark.slow
@pytest.mark.verifies(against="pieces and chunks of other sizes")
@pytest.mark.parametrize(("piece", "chunk"), [(1, 1), (7, 3), (64, 1000), (1 << 16, 1), (699, 701)])
def test_pieces_do_not_matter(piece: int, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces handed to the engine and chunks handed to its threads leave no trace."""
    table = table_of("vertical")
    law = RandomRestitution.normal(0.9, 0.05, seed=4)
    first = table.run(law)
    monkeypatch.setattr(rows, "PIECE", piece)
    monkeypatch.setattr(batch, "_CHUNK", chunk)
    assert same_bits(first, table.run(law))


@pytest.mark.slow
@pytest.mark.verifies(against="a single run of every fourth row")
@pytest.mark.parametrize("kind", KINDS)
def test_one_history_is_the_row_of_a_batch(kind: str) -> None:
    """`run` gives the bits of the batch; of a body that falls, all but what it does after the top."""
    table = table_of(kind)
    whole = table.run()
    for k in range(0, COUNT, 4):
        row = {name: float(values[k]) for name, values in table.values.items()}
        right, left = (RockingSide(row[f"alpha_{s}"], row[f"p_{s}"], 1.0, row[f"r_{s}"]) for s in ("right", "left"))
        one = run(
            RockingParameters(right, left, ConstantRestitution(), ""), table.motions[table.motion[k]], PlaneSettings(),
            scale=row["scale"], rotation=row["rotation"], velocity=row["velocity"], engine="fast",
        )  # fmt: skip
        names = ["peak_rotation", "peak_time", "overturning_time", "impacts", "uplifts", "side"]
        names += [] if one.outcome is rk.Outcome.OVERTURNED else ["peak_velocity", "truncation"]
        assert one.outcome.code == whole["outcome"][k]
        for name in names:
            assert np.array_equal(getattr(one, name), whole[name][k], equal_nan=True), (k, name)


@pytest.mark.slow
@pytest.mark.verifies(
    against="AVX-512, AVX2 and plain instructions",
    within="the same bits with vectors; plain 1e-10 rad in 99 % of the rows, 10 times the effect of rounding in others",
)
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_instruction_sets(kind: str, linear: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Vectors of 8 and of 4 numbers give the same bits; without vectors peaks agree to 1e-10."""
    table, settings, found = table_of(kind), PlaneSettings(linear=linear), {}
    for name in fast_engine.instruction_sets():
        monkeypatch.setenv("ROCKING_ISA", name)
        found[name] = table.run(settings=settings)
    if not {"avx512", "avx2"} & set(found):
        pytest.skip("this processor has no vectors")
    if {"avx512", "avx2"} <= set(found):
        assert same_bits(found["avx512"], found["avx2"])
    plain, wide = found["plain"], found.get("avx512", found.get("avx2"))
    assert wide is not None
    for name in ("outcome", "side", "status", "impacts", "uplifts"):
        assert np.array_equal(plain[name], wide[name])
    # long strong histories multiply rounding by up to 1e6: by how much, a scale off by a few bits tells
    values = table.values | {"scale": table.values["scale"] * (1.0 + 4e-16)}
    sway = Table(table.motions, values, table.motion).run(settings=settings)["peak_rotation"] - wide["peak_rotation"]
    gap = np.abs(plain["peak_rotation"] - wide["peak_rotation"])
    assert (gap < 1e-10).mean() > 0.99
    assert (gap < 1e-10 + 10.0 * np.abs(sway)).all()


@pytest.mark.verifies(against="the same seed and key, in another order", control="within")
def test_random_restitution_belongs_to_seed_and_key() -> None:
    """The same seed and key give the same bits whatever the order; another seed or key does not."""
    table = table_of("records")
    law = RandomRestitution.normal(0.85, 0.1, seed=5)
    first = table.run(law)
    assert same_bits(first, table.run(RandomRestitution.normal(0.85, 0.1, seed=5)))
    order = np.random.default_rng(8).permutation(COUNT)
    assert same_bits({k: v[order] for k, v in first.items()}, table.picked(order).run(law))
    often = (first["impacts"] > 2) & (first["outcome"] == 1)
    shifted = Table(table.motions, table.values, table.motion, table.key + 1)
    for other in (table.run(RandomRestitution.normal(0.85, 0.1, seed=6)), shifted.run(law)):
        assert np.mean((other["peak_time"] != first["peak_time"])[often]) > 0.3
    assert not same_bits(first, table.run())


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine", "the reference engine", within="1e-8 rad in peaks; counts equal", control="within"
)
@pytest.mark.parametrize(
    "law",
    [
        SpeedRestitution(np.array([0.0, 0.1, 1.0]), np.array([1.0, 0.9, 0.7])),
        RandomRestitution.normal(0.85, 0.1, seed=5),
    ],
    ids=["of the speed", "at random"],
)
def test_laws_against_the_reference(law: ImpactLaw, agreement: Any) -> None:
    """Coefficients that change from impact to impact: both engines count alike and agree on peaks to 1e-8."""
    # long strong histories multiply a difference of 1e-12 by 1e5: the shorter motions, gently
    table = table_of("records")
    table = table.picked(np.flatnonzero((table.motion < 4) & (table.values["scale"] < 0.6))[:120])
    fast, slow, constant = table.run(law), table.run(law, name="reference"), table.run()
    for name in ("outcome", "side", "status", "impacts", "uplifts"):
        assert np.array_equal(fast[name], slow[name]), name
    agreement(np.abs(fast["peak_rotation"] - slow["peak_rotation"]).max(), 1e-8)
    assert np.mean(fast["impacts"] != constant["impacts"]) > 0.2  # the law is not idle


def allocated(count: int) -> tuple[int, int]:
    """Most bytes that a run of so many rows held beyond its results, and the process's peak [bytes]."""
    motion = [Segments.between_samples(0.05, 3.0 * np.sin(np.arange(20.0)))]

    def rows(first: int, last: int) -> Rows:
        alpha = 0.1 + 0.3 * (np.arange(first, last) % 997) / 997.0
        sides: dict[str, Any] = {"alpha_right": alpha, "alpha_left": alpha, "p_right": 3.0, "p_left": 3.0}
        return Rows.of(last - first, r_right=0.9, r_left=0.9, scale=1.0, **sides)

    tracemalloc.start()
    try:
        results, _ = Batch(motion, threads=2, engine="fast").run(count, rows)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    kept = sum(values.nbytes for values in results.values())
    unit = 1 if sys.platform == "darwin" else 1024
    return most - kept, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


@pytest.mark.slow
@pytest.mark.verifies("behaviour", "tracemalloc and the peak of the process", within="24 MB beyond the results")
def test_memory_is_flat() -> None:
    """200,000 rows hold at most 24 MB beyond their results, no more than 140,000 do; nor does the engine hoard."""
    fewer, before = allocated(140_000)
    whole, after = allocated(200_000)
    assert whole < 24e6
    assert whole < fewer + 1e5
    # the process grows by the results of the second run, 13 MB, and not by more than 16 MB of its allocator's slack
    assert after - before < 200_000 * sum(np.dtype(kind).itemsize for kind in fast_engine.RESULTS.values()) + 16e6
