"""Studies repeated with several restitutions: what is compared, what is said, what is refused."""

from functools import partial

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import RandomRestitution
from rocking.errors import InvalidValueError
from rocking.statistics import share_interval
from rocking.studies import (
    SampledRestitution,
    Sensitivity,
    fragility_sensitivity,
    map_sensitivity,
    spectrum_sensitivity,
)
from rocking.studies.axis import axis_of
from rocking.studies.sensitivity import sensitivity

xr = pytest.importorskip("xarray")
BLOCK, PULSE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
PULSES = [rk.pulses.sine(3.0, period) for period in (0.5, 0.7, 0.9)]
RATIOS = np.linspace(1.0, 8.0, 12)
AXES = ("frequency_ratio", RATIOS), ("amplitude_ratio", RATIOS)


def given(outcomes, dims=("y", "x")):
    """A study whose outcomes are known: it returns what is listed for the restitution asked for."""

    def study(*, restitution):
        return xr.Dataset({"outcome": (dims, np.array(outcomes[restitution], dtype=np.int8))})

    return study


KNOWN = {"housner": [[1, 1, 2], [0, 2, 2]], "ked": [[1, 2, 2], [2, 2, 1]], 0.9: [[3, 1, 2], [0, 2, 2]]}


def test_flips_between_all_pairs():
    """The table of flips holds the counts made by hand, mirrored for gained and lost, nothing on its diagonal."""
    found = sensitivity(given(KNOWN), list(KNOWN)).flips()
    assert found["count"].values.tolist() == [[0, 3, 0], [3, 0, 3], [0, 3, 0]]
    assert found["only_second"].values.tolist() == [[0, 2, 0], [1, 0, 1], [0, 2, 0]]
    assert found["compared"].values.tolist() == [[6, 6, 5], [6, 6, 5], [5, 5, 5]]
    assert found["unknown"].sel(first="housner", second="0.9") == 1
    assert found["fraction"].sel(first="housner", second="ked") == 0.5
    assert np.diag(found["fraction_high"]).tolist() == [0.0, 0.0, 0.0]
    assert found.attrs["cases"] == "cells"


def test_maps_of_differences():
    """The map of verdicts is that made by hand, for every choice but the baseline."""
    found = sensitivity(given(KNOWN), list(KNOWN), baseline="ked").differences()
    assert found["restitution"].values.tolist() == ["housner", "0.9"]
    assert found.sel(restitution="housner").values.tolist() == [[0, -1, 0], [-1, 0, 1]]
    assert found.sel(restitution="0.9").values.tolist() == [[2, -1, 0], [-1, 0, 1]]


def test_the_verdict_in_words():
    """The sentence names both choices, the count, the share, and which way the verdicts went; no interval of cells."""
    words = sensitivity(given(KNOWN), ["housner", "ked", 0.9]).verdict.splitlines()
    assert words[0].startswith("With ked instead of housner, the outcome differs in 3 of 6 cells (50 %); ")
    assert words[0].endswith("2 overturn only with ked, 1 only with housner.")
    assert "in 0 of 5 cells (0 %); 1 could not be computed." in words[1]


def test_histories_of_one_motion_are_counted_together():
    """With a dimension of motions the interval is by motion, wherever that dimension stands."""
    rng = np.random.default_rng(3)
    outcomes = {"housner": np.ones((30, 10), int), "ked": np.where(rng.random((30, 1)) < 0.3, 2, 1) * np.ones(10, int)}
    by_row = sensitivity(given(outcomes, ("motion", "level")), list(outcomes)).flips_between("housner", "ked")
    turned = {name: values.T for name, values in outcomes.items()}
    by_column = sensitivity(given(turned, ("level", "motion")), list(outcomes)).flips_between("housner", "ked")
    assert by_row == by_column
    assert by_row.clusters == 30
    results = {name: given(outcomes)(restitution=name) for name in outcomes}
    cells = Sensitivity(results, baseline="ked", sampled=["ked"]).flips_between("housner", "ked")
    assert by_row.fraction_high - by_row.fraction_low > 2.0 * (cells.fraction_high - cells.fraction_low)


def test_cells_of_a_grid_have_no_interval_unless_something_is_drawn():
    """A map of constants is no sample: no interval in numbers or words; with one drawn choice its pairs have one."""
    constant = map_sensitivity(BLOCK, PULSE, *AXES, ["housner", "ked"])
    flips = constant.flips_between("housner", "ked")
    assert np.isnan([flips.fraction_low, flips.fraction_high]).all()
    assert "interval" not in constant.verdict
    assert constant.summary()[1]["fraction_low"] is constant.summary()[1]["fraction_high"] is None
    assert constant.flips().attrs["independent"] == "nothing"
    law = RandomRestitution.normal(0.9, 0.02, seed=1)
    drawn = map_sensitivity(BLOCK, PULSE, *AXES, {"housner": "housner", "ked": "ked", "drawn": law})
    assert np.isnan(drawn.flips_between("housner", "ked").fraction_low)
    flips = drawn.flips_between("housner", "drawn")
    assert (flips.fraction_low, flips.fraction_high) == share_interval(flips.count, flips.compared)
    assert [line.count("95 % interval") for line in drawn.verdict.splitlines()] == [0, 1]
    single = spectrum_sensitivity(PULSE, [0.2], [2.0, 3.0, 4.0], ["housner", "ked"])
    assert "interval" not in single.verdict


def test_the_restitution_is_no_axis_where_it_is_compared():
    """A map over the restitution itself would be the same for all choices: refused before anything is computed."""
    told = []
    for axes in ((("restitution", [0.8, 0.9]), AXES[1]), (AXES[0], axis_of(("restitution", [0.8, 0.9])))):
        with pytest.raises(InvalidValueError, match="restitution cannot be an axis in a comparison of restitutions"):
            map_sensitivity(BLOCK, PULSE, *axes, ["housner", "ked"], progress=told.append)
    assert told == []


def test_summary_is_plain():
    """One row a choice, the baseline first, of numbers and words that any table takes."""
    rows = sensitivity(given(KNOWN), list(KNOWN), baseline="ked").summary()
    assert [row["choice"] for row in rows] == ["ked", "housner", "0.9"]
    assert [row["overturned"] for row in rows] == [4, 3, 3]
    assert [row["computed"] for row in rows] == [6, 6, 5]
    assert rows[0]["flips"] == 0
    assert all(value is None or isinstance(value, (str, int, float)) for row in rows for value in row.values())


def test_identical_restitutions_change_nothing():
    """The same coefficient under two names, and r + 0, give zero flips and differences of exactly zero in a map."""
    choices = {"0.9": 0.9, "again": 0.9, "plus nothing": 0.9 + 0.0, "by side": {"left": 0.9, "right": 0.9}}
    found = map_sensitivity(BLOCK, PULSE, *AXES, choices)
    assert found.flips()["count"].sum() == 0
    assert not found.differences("verdict").any()
    for name in ("peak_ratio", "impacts"):
        moved = found.differences(name)
        assert int((moved == 0.0).sum()) == 3 * int((found.datasets["0.9"]["outcome"] < 2).sum()) > 100
        assert not (moved.fillna(0.0) != 0.0).any()


def test_a_map_differs_cell_by_cell():
    """Differences of a map are those of two maps computed apart, and the verdict flips where their outcomes differ."""
    found = map_sensitivity(BLOCK, PULSE, *AXES, ["housner", "ked"])
    one, two = (rk_map(name) for name in ("housner", "ked"))
    flipped = (one["outcome"] == 2) != (two["outcome"] == 2)
    assert 0 < int(flipped.sum()) == found.flips_between("housner", "ked").count
    stood = ((one["outcome"] < 2) & (two["outcome"] < 2)).values
    moved = found.differences("peak_ratio").sel(restitution="ked").values
    assert np.array_equal(moved[stood], (two["peak_ratio"] - one["peak_ratio"]).values[stood])
    assert np.isnan(moved[~stood]).all()


def rk_map(restitution, **options):
    """A map of its own."""
    from rocking.studies import overturning_map

    return overturning_map(BLOCK, PULSE, *AXES, restitution, **options)


def test_spectra_use_the_same_motions():
    """Motions that can be gone through only once serve every choice; flips are counted by motion."""
    found = spectrum_sensitivity(iter(PULSES), [0.2, 0.3], [1.0, 2.0, 4.0], ["housner", "ked"])
    assert found.flips_between("housner", "ked").compared == 3 * 2 * 3
    assert found.cases == "histories"


def test_states_without_a_curve_are_said():
    """Where too few motions overturn for a curve, the sentence and the table say why in place of a number."""
    levels = [2.6, 2.7, 2.8]  # just above uplift: nothing overturns
    found = fragility_sensitivity(BLOCK, PULSES, levels, ["housner", "ked"], repetitions=20)
    assert "overturned: no curve to compare: " in found.verdict
    assert "overturned: no comparison" in found.summary()[1]
    assert found.flips_between("housner", "ked").clusters == 3


def test_fragility_with_a_distribution_runs_on_the_fast_engine():
    """Stripes with a draw for every history have the draws of their numbers, motion by motion, level by level."""
    law = SampledRestitution.normal(0.9, 0.03, seed=8)
    found = fragility_sensitivity(BLOCK, PULSES, [3.0, 6.0, 9.0], {"fixed": 0.9, "drawn": law}, repetitions=0)
    outcome = found.datasets["drawn"]["outcome"].values.ravel()
    alone = [
        rk.simulate_many(BLOCK, PULSES[k // 3], float(r), scale=[3.0, 6.0, 9.0][k % 3] / 3.0)["outcome"].item()
        for k, r in enumerate(law.draws(np.arange(9)))
    ]
    assert outcome.tolist() == alone
    assert found.results["drawn"].histories.law is law


@pytest.mark.slow
def test_every_study_draws_on_the_fast_engine():
    """A map with a draw for every history runs on the fast engine and ends as on the reference engine, cell by cell."""
    law = SampledRestitution.normal(0.9, 0.03, seed=8)
    fast = map_sensitivity(BLOCK, PULSE, *AXES, [0.9, law]).results
    slow = {label: rk_map(choice, engine="reference") for label, choice in zip(fast, (0.9, law), strict=True)}
    for label, found in fast.items():
        assert found.attrs["engine"].startswith("fast")
        assert np.array_equal(found["outcome"][1:], slow[label]["outcome"][1:])  # the first row is the threshold itself


def test_any_study_with_an_outcome_serves():
    """A study that takes a restitution and returns outcomes is enough, as `simulate_many` does."""
    study = partial(rk.simulate_many, BLOCK, PULSES, scale=[0.5, 1.0, 2.0])
    found = sensitivity(study, ["housner", "ked"])
    assert dict(found.datasets["ked"].sizes) == {"body": 1, "motion": 3, "scale": 3}


@pytest.mark.parametrize(
    ("study", "restitutions", "baseline", "message"),
    [
        ("map", ["ked", 0.9], None, "function"),
        (given(KNOWN), ["ked", "housner"], "fixed", "baseline must be one of ked, housner"),
        (lambda *, restitution: 3.0, ["ked", "housner"], None, "analysis with an outcome"),
        (lambda *, restitution: xr.Dataset({"peak": 1.0}), ["ked", "housner"], None, "analysis with an outcome"),
        (given({"ked": [[1, 2]], "housner": [[1, 2], [1, 2]]}), ["ked", "housner"], None, "one shape"),
        (given({"ked": [[1, 2]], "housner": [[1, 2]]}, ("restitution", "x")), ["ked", "housner"], None, None),
        (
            given({"ked": [[1, 2]], "housner": [[1, 2]]}, ("y", "restitution")),
            ["ked", "housner"],
            None,
            "already varies",
        ),
    ],
)
def test_what_cannot_be_compared_is_refused(study, restitutions, baseline, message):
    """No function, no outcome, other shapes, another baseline, a study over restitutions: each has its sentence."""
    if message is None:
        assert sensitivity(study, restitutions, baseline).labels == ("ked", "housner")
        return
    with pytest.raises(InvalidValueError, match=message):
        sensitivity(study, restitutions, baseline)


def test_unknown_names_are_refused():
    """Choices, states and variables that are not there are refused with what there is."""
    found = sensitivity(given(KNOWN), list(KNOWN))
    with pytest.raises(InvalidValueError, match=r"housner, ked, 0\.9"):
        found.flips_between("housner", "fixed")
    with pytest.raises(InvalidValueError, match="no fragility analysis"):
        found.curve_change("ked")
    with pytest.raises(InvalidValueError, match="verdict or one of"):
        found.differences("peak_ratio")
    with pytest.raises(InvalidValueError, match="baseline"):
        Sensitivity(found.results, baseline="fixed")
