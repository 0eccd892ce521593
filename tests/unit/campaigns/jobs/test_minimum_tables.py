"""Tables of crossings and minima: every column, against numbers written out by hand and against what they mean."""

import dataclasses

import numpy as np
import pytest
from campaign_jobs import finished, job, search

from rocking import conventions
from rocking.campaigns.jobs import answer
from rocking.studies import SyntheticSet
from rocking.studies.minimum_acceleration import Cases, Effort, Transitions
from rocking.studies.minimum_rounds import tables_of

NAMES = {"motion": ["north", "south"], "restitution": ["0.9"]}
EFFORT = Effort(samples=7, bisections=0, tolerance=0.01)
ISLAND = Transitions(
    acceleration=np.array([4.0, 5.0, 6.0]), ratio=np.array([1.6, 2.0, 2.4]), scale=np.array([0.8, 1.0, 1.2]),
    modes=np.array([[-1, 2], [3, -1], [-1, 0]]), width=np.array([0.01, 0.02, 0.03]), min_pga=2.5, max_pga=30.0,
    uplift_acceleration=2.5, resolution=0.51, starts_overturned=False, samples=19, failed=1, resolution_below=0.04,
)  # fmt: skip
STARTS = Transitions(
    acceleration=np.array([9.0]), ratio=np.array([3.0]), scale=np.array([1.8]), modes=np.array([[1, -1]]),
    width=np.array([0.05]), min_pga=3.5, max_pga=31.0, uplift_acceleration=3.0, resolution=0.44,
    starts_overturned=True, samples=12, failed=0,
)  # fmt: skip
NONE = dataclasses.replace(
    STARTS, acceleration=np.empty(0), ratio=np.empty(0), scale=np.empty(0), modes=np.empty((0, 2), np.int64),
    width=np.empty(0), min_pga=4.5, starts_overturned=False, samples=7,
)  # fmt: skip
NAN = float("nan")
MINIMA = {
    "motion": ["north", "north", "south", "south"],
    "restitution": ["0.9"] * 4,
    "body": [0, 1, 0, 1],
    "minimum": [4.0, NAN, NAN, NAN],
    "certain": [6.0, NAN, NAN, NAN],
    "uplift_acceleration": [2.5, 3.0, 3.0, 7.5],
    "min_pga": [2.5, 3.5, 4.5, 7.0],
    "max_pga": [30.0, 31.0, 31.0, 70.0],
    "resolution": [0.51, 0.44, 0.44, NAN],
    "resolution_below": [0.04, NAN, NAN, NAN],
    "crossings": [3, 1, 0, 0],
    "starts_overturned": [0, 1, 0, 0],
    "samples": [19, 12, 7, 7],
    "failed": [1, 0, 0, 7],
}
CROSSINGS = {
    "motion": ["north"] * 4,
    "restitution": ["0.9"] * 4,
    "body": [0, 0, 0, 1],
    "acceleration": [4.0, 5.0, 6.0, 9.0],
    "ratio": [1.6, 2.0, 2.4, 3.0],
    "scale": [0.8, 1.0, 1.2, 1.8],
    "width": [0.01, 0.02, 0.03, 0.05],
    "mode_below": [-1, 3, -1, 1],
    "mode_above": [2, -1, 0, -1],
}
UNITS = {
    "minimum": "m/s2", "certain": "m/s2", "uplift_acceleration": "m/s2", "min_pga": "m/s2", "max_pga": "m/s2",
    "acceleration": "m/s2", "width": "m/s2",
}  # fmt: skip


def test_every_column_as_written_out():
    """Three crossings, one of a body that overturns from the start, none, and a case without any result."""
    cases = Cases(
        {}, np.ones(4), np.array([2.5, 3.0, 3.0, 7.5]), np.array([2.5, 3.5, 4.5, 7.0]),
        np.array([30.0, 31.0, 31.0, 70.0]), record=True,
    )  # fmt: skip
    sheets = tables_of([ISLAND, STARTS, NONE, None], cases, EFFORT, (2, 1, 2), NAMES)
    assert list(sheets) == ["crossings", "minima"]
    for name, dim, wanted in (("crossings", "crossing", CROSSINGS), ("minima", "case", MINIMA)):
        sheet = sheets[name]
        assert sheet.row == dim
        assert list(sheet.columns) == list(wanted)
        for column, values in wanted.items():
            found = sheet.columns[column]
            assert (found.unit, found.variable) == (UNITS.get(column, "1"), f"{dim}_{column}")
            if found.is_text:
                assert found.values.tolist() == values
            else:
                np.testing.assert_array_equal(found.values, values, err_msg=column)


@pytest.fixture(scope="module")
def searched(tmp_path_factory):
    """Tables of a small search: two motions, two restitutions, two bodies."""
    folder = finished(tmp_path_factory.mktemp("searched") / "c", job("minimum-acceleration", search(12, 0.01)))
    return {name: sheet.columns for name, sheet in answer(folder).tables.items()}


@pytest.mark.slow
def test_crossings_mean_what_they_say(searched):
    """Acceleration is scale times peak and ratio times g tan(alpha); the verdict differs below and above."""
    made = {name: each.values for name, each in searched["crossings"].items()}
    assert made["scale"].size > 8
    motions = SyntheticSet("pulse-like", 2, 3)
    peaks = {motions[k].name: motions[k].peak for k in range(2)}
    assert len(peaks) == 2
    peak = np.array([peaks[name] for name in made["motion"]])
    # a block of width b and height h is lifted by g b / h
    uplift = conventions.g * np.array([0.5 / 2.0, 0.3 / 1.5])[made["body"]]
    np.testing.assert_allclose(made["acceleration"], made["scale"] * peak, rtol=1e-12)
    np.testing.assert_allclose(made["ratio"], made["acceleration"] / uplift, rtol=1e-12)
    assert not np.allclose(made["ratio"], made["scale"])
    assert np.all((made["mode_below"] < 0) != (made["mode_above"] < 0))
    assert np.all((made["width"] > 0.0) & (made["width"] <= 0.01 * made["acceleration"] * 1.01))


def test_minima_follow_from_the_crossings(searched):
    """The first crossing of a case goes up to overturning, verdicts alternate, and the last one is the certain one."""
    minima = {name: each.values for name, each in searched["minima"].items()}
    made = {name: each.values for name, each in searched["crossings"].items()}
    told = 0
    for k in range(8):
        case = (minima["motion"][k], minima["restitution"][k], minima["body"][k])
        own = np.array([row == case for row in zip(made["motion"], made["restitution"], made["body"], strict=True)])
        assert own.sum() == minima["crossings"][k]
        rising = made["mode_above"][own] >= 0
        assert np.array_equal(rising, np.arange(own.sum()) % 2 == minima["starts_overturned"][k])
        if own.any() and not minima["starts_overturned"][k]:
            assert minima["minimum"][k] == made["acceleration"][own].min()
        if own.any() and rising[-1]:
            assert minima["certain"][k] == made["acceleration"][own].max()
            told += own.sum() > 1
        elif own.any():
            assert np.isnan(minima["certain"][k])
    assert told > 0  # cases whose minimum is not the certain one
