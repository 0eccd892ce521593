"""Histories counted by level and motion: the counts of a table of all of them, in a fraction of its memory."""

import tracemalloc

import numpy as np
import pytest

import rocking as rk
from rocking.motions import IntensityMeasure
from rocking.statistics import count_outcomes
from rocking.statistics.counts import pooled
from rocking.studies import MotionSet
from rocking.studies.fragility import model_of
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Subject

LEVELS = np.array([1.0, 2.0, 3.5, 5.0])


def outcomes(motions=300, seed=2):
    """Return random outcomes at levels, some failed, some motions twice in the set."""
    random = np.random.default_rng(seed)
    capacity = np.exp(random.normal(0.8, 0.5, (motions, 1)))
    good = random.random((motions, LEVELS.size)) > 0.1
    good[5] = False
    cluster = np.arange(motions)
    cluster[[40, 90, 91]] = 7
    cluster[120] = 110
    return good, capacity < LEVELS, cluster


def by_name(good, reached, cluster, levels=LEVELS):
    """Return the counts of a list of single histories with the names of their clusters."""
    names = np.broadcast_to(cluster[:, None], good.shape)[good]
    return count_outcomes(np.broadcast_to(levels, good.shape)[good], reached[good], clusters=names.tolist())


def same(found, wanted):
    """Return whether two counts have the same numbers and the same clusters."""
    numbers = ("levels", "failures", "trials")
    return all(np.array_equal(getattr(found, name), getattr(wanted, name)) for name in numbers) and all(
        np.array_equal(mine, others)
        for mine, others in zip(found.distinct_clusters, wanted.distinct_clusters, strict=True)
    )


def test_same_counts_as_one_by_one():
    """Counts, distinct clusters and their numbers are those of the list of all histories; other clusters are not."""
    good, reached, cluster = outcomes()
    (found,) = pooled(np.broadcast_to(LEVELS, good.shape), good, [reached], cluster)
    wanted = by_name(good, reached, cluster)
    assert same(found, wanted)
    assert (found.clusters, found.is_clustered, found.scarcity) == (wanted.clusters, True, "")
    assert not same(found, by_name(good, reached, np.arange(cluster.size)))


def test_levels_of_each_motion_its_own():
    """Motions that were brought to different levels count as the list of their histories does, cluster by cluster."""
    good, reached, cluster = outcomes(motions=130)
    levels = LEVELS * np.where(np.arange(130) % 3 == 1, 1.5, 1.0)[:, None]
    found = pooled(levels, good, [reached, ~reached], cluster)
    for one, state in zip(found, (reached, ~reached), strict=True):
        wanted = by_name(good, state, cluster, levels)
        assert wanted.clusters == 125
        assert same(one, wanted)


def test_many_motions_in_pieces(monkeypatch):
    """The size of the pieces does not matter."""
    good, reached, cluster = outcomes()
    levels = np.broadcast_to(LEVELS, good.shape)
    (whole,) = pooled(levels, good, [reached], cluster)
    monkeypatch.setattr("rocking.statistics.counts._ROWS_AT_ONCE", 17)
    (pieces,) = pooled(levels, good, [reached], cluster)
    assert np.array_equal(whole.distinct_clusters[0], pieces.distinct_clusters[0])
    assert np.array_equal(whole.distinct_clusters[1], pieces.distinct_clusters[1])


@pytest.mark.parametrize("single", [True, False])
def test_clouds(single):
    """One history a motion: no clusters where all motions differ, the counts of the list in any case."""
    random = np.random.default_rng(3)
    levels = random.choice(np.linspace(1.0, 4.0, 50), 200)
    reached, good = random.random(200) < 0.5, random.random(200) > 0.1
    cluster = np.arange(200)
    if not single:
        good[[10, 20]] = True
        levels[20], cluster[20] = levels[10], 10
    (found,) = pooled(levels, good, [reached], cluster)
    wanted = count_outcomes(levels[good], reached[good], clusters=None if single else cluster[good].tolist())
    for name in ("levels", "failures", "trials"):
        assert np.array_equal(getattr(found, name), getattr(wanted, name))
    assert found.clusters == wanted.clusters


class Pulses(MotionSet):
    """As many pulses as wanted, made when they are needed."""

    def __init__(self, count):
        self.count = count

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        return rk.pulses.sine(1.0 + index / self.count, 0.5)

    def description(self):
        return {"count": self.count}


def peak_of(kind, count):
    """Return the memory that the analysis of so many histories takes, its results apart [bytes]."""
    body, motions = rk.Block(width=0.4, height=1.6), Pulses(count // (8 if kind == "stripes" else 1))
    grid = np.linspace(2.0, 9.0, 8)
    subject = Subject.of(body, motions, "ked", "pgv", {})
    question = FragilityQuestion.of(subject, kind, grid if kind == "stripes" else None)
    level = np.broadcast_to(grid, (len(motions), 8)) if kind == "stripes" else np.linspace(2.0, 9.0, count)
    capacity = np.exp(np.random.default_rng(0).normal(1.3, 0.4, (len(motions), 1) if kind == "stripes" else count))
    over = (level > capacity).ravel()
    arrays = {
        "outcome": np.where(over, rk.Outcome.OVERTURNED.code, rk.Outcome.ROCKED.code).astype(np.int8),
        "peak_rotation": np.where(over, 2.0, 0.1),
    }
    tracemalloc.start()
    model = model_of(question.answer(arrays), "many")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert [curve.state for curve in model.curves][-1] == "overturned"
    # a thousand motions know the median to 0.4 sqrt(pi / 2 / 1000) = 1.6 %
    assert model.curves[-1].median == pytest.approx(np.exp(1.3), rel=0.05)
    return peak


# at 10^7 histories these are 0.3 and 1.5 GB, beside 9 bytes of results each; tables of all took 1.6 and 5.1 GB
@pytest.mark.slow
@pytest.mark.parametrize(("kind", "most"), [("stripes", 30.0), ("cloud", 150.0)])
def test_memory_of_an_analysis(monkeypatch, kind, most):
    """What a history more costs in memory is bounded, so that ten million fit into 2 GiB."""
    # the measure of a motion takes longer than its history; what it is does not matter here
    monkeypatch.setattr(IntensityMeasure, "values", lambda _, motions, body: np.linspace(2.0, 9.0, len(motions)))
    peak_of(kind, 8000)  # libraries are loaded
    few, many = peak_of(kind, 40_000), peak_of(kind, 200_000)
    assert (many - few) / 160_000 < most
