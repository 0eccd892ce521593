"""rk.fragility and rk.inventory: datasets with units that say what the analyses behind them say, and refusals."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.decision.inventory import InventoryObject, Thresholds, assess
from rocking.decision.inventory.hazard import Hazard
from rocking.errors import InvalidValueError
from rocking.statistics import fit_lognormal
from rocking.studies import SyntheticSet, fragility_analysis, fragility_sensitivity
from rocking.studies.fragility import model_of

pytestmark = pytest.mark.slow

pytest.importorskip("xarray")

BLOCK = rk.Block(width=0.4, height=1.6)
PULSES = [rk.pulses.sine(1.0, period) for period in (0.4, 0.5, 0.6, 0.7, 0.8, 1.0)]
LEVELS = [2.0, 4.0, 6.0, 8.0]
RECORDS = [rk.GroundMotion(3.0 * np.sin(np.arange(100) * w), 0.01) for w in (0.05, 0.08, 0.12)]
OBJECTS = [InventoryObject(name=n, width=w, depth=2 * w, height=1.0) for n, w in (("chest", 0.9), ("vase", 0.12))]


@pytest.mark.parametrize(
    ("words", "analysis"),
    [
        ({"levels": LEVELS}, lambda: fragility_analysis(BLOCK, PULSES, LEVELS)),
        ({"analysis": "cloud", "scale": 4.0}, lambda: fragility_analysis(BLOCK, PULSES, scale=4.0, analysis="cloud")),
        (
            {"analysis": "incremental", "levels": LEVELS, "tolerance": 1e-3},
            lambda: fragility_analysis(BLOCK, PULSES, LEVELS, tolerance=1e-3, analysis="incremental"),
        ),
    ],
    ids=["stripes", "cloud", "incremental"],
)
def test_fragility_is_the_analysis_with_its_curves(words, analysis):
    """Every variable of the analysis, and the fit of each state, to the last bit; NaN where there is none."""
    labelled, found = rk.fragility(BLOCK, PULSES, **words), analysis()
    for name, values in found.dataset.data_vars.items():
        np.testing.assert_array_equal(labelled[name], values)
    assert labelled["state"].values.tolist() == [state.name for state in found.limit_states]
    for state in labelled["state"].values.tolist():
        curve, fit = labelled.sel(state=state), found.fits.get(state)
        exists = fit is not None and fit.exists and fit.dispersion
        assert math.isnan(float(curve["median"])) == (not exists)
        if exists:
            assert (float(curve["median"]), float(curve["dispersion"])) == (fit.median, fit.dispersion)
            assert str(curve["verdict"].values) == fit.verdict
    assert labelled["median"].attrs["units"] == "m/s2"
    assert labelled["dispersion"].attrs["units"] == "1"


def test_levels_that_serve_where_none_are_given():
    """16 levels from .9 to 9 times what lifts the body, in equal ratios: rocking begins within the first step."""
    levels = rk.fragility(BLOCK, PULSES)["level"].values
    lifts = 9.80665 * 0.25  # g b / h
    np.testing.assert_allclose(levels, lifts * np.geomspace(0.9, 9.0, 16), rtol=1e-14)


def test_inventory_is_the_assessment():
    """Counts, lights and sentences of every verdict, by restitution and direction; the worst object first."""
    labelled = rk.inventory(OBJECTS, RECORDS, pga="0.3g")
    found = assess(OBJECTS, Hazard.of_records([r.scaled(0.3 * 9.80665 / r.peak) for r in RECORDS]))
    assert labelled["object"].values.tolist() == [v.item.name for v in found.verdicts] == ["vase", "chest"]
    assert labelled["restitution"].values.tolist() == [found.restitution, *found.comparisons]
    for place, verdict in enumerate(found.verdicts):
        one = labelled.isel(object=place)
        assert str(one["rating"].values) == verdict.light.word
        assert tuple(one["overturned_fraction_95"].values) == verdict.interval
        assert float(one["uplift_acceleration"]) == verdict.uplift_acceleration
        for model, results in enumerate((verdict.results, *verdict.compared)):
            for result in results:
                cell = one.isel(restitution=model).sel(direction=result.direction)
                for name in ("count", "lifted", "overturned", "failed", "lost_contact"):
                    assert int(cell[name]) == getattr(result, name)
                high = math.inf if result.high_rotation is None else result.high_rotation
                assert float(cell["high_rotation"]) == high
    assert labelled["uplift_acceleration"].attrs["units"] == "m/s2"


def test_the_command_and_the_door_say_the_same(tmp_path, answered):
    """One file, one family: each light, count and sentence of `rocking inventory --json`."""
    path = tmp_path / "list.csv"
    path.write_text("name,width_cm,depth_cm,height_cm\nvase,12,12,100\nbroken,?,1,1\nchest,120,90,100\n")
    labelled = rk.inventory(path, "point-source", pga="0.3g", count=4, seed=2)
    said = answered("inventory", path, "--synthetic", "point-source", "--pga", "0.3g", "--count", 4, "--seed", 2)
    assert labelled["object"].values.tolist() == [each["name"] for each in said["objects"]]
    assert labelled["rating"].values.tolist() == [item["rating"] for item in said["objects"]]
    assert labelled["text"].values.tolist() == [item["text"] for item in said["objects"]]
    assert labelled["not_assessed"].values.tolist() == ["broken"]
    assert labelled["reason"].values.tolist() == [each["reason"] for each in said["not_assessed"]]


def test_negative_control_thresholds_move_the_lights():
    """Another convention gives other lights of the same counts: they are not decoration."""
    usual, strict = (
        rk.inventory(OBJECTS, RECORDS, pga=3.0, thresholds=limits)
        for limits in (None, Thresholds(overturning_green=0.01, overturning_red=0.99, rocking=0.01))
    )
    np.testing.assert_array_equal(usual["overturned"], strict["overturned"])
    assert usual["rating"].values.tolist() != strict["rating"].values.tolist()


BODY = rk.Section.from_points([(0.0, 0.0), (0.3, 0.0), (0.36, 1.5), (0.1, 1.5)])


@pytest.fixture(scope="module")
def motions():
    return list(SyntheticSet("point-source", 20, seed=1))


@pytest.fixture(scope="module")
def stripes(motions):
    return fragility_analysis(BODY, motions, np.linspace(1.0, 9.0, 9), "ked")


def test_a_fragility_prints_its_curves(stripes):
    """The medians that are printed are those that are fitted, and the model of it has the same."""
    assert "180 histories over pga [m/s2]" in repr(stripes)
    for name, fit in stripes.fits.items():
        assert f"{name}: <LognormalFit: median {fit.median:.4g}, dispersion {fit.dispersion:.3g}" in repr(stripes)
        assert f"{name}: median {fit.median:.4g}" in repr(model_of(stripes, "leaning", crossing_curves="refuse"))
    assert len(repr(stripes)) < 400


def test_states_of_a_model_are_chosen(stripes):
    """Rocking of a body that leans hardly overlaps with rest: one dispersion is refused, with the way out."""
    with pytest.raises(InvalidValueError, match=r"The states are rocking, .* limit_states= selects fewer states"):
        model_of(stripes, "leaning", crossing_curves="common-dispersion")
    chosen = model_of(
        stripes, "leaning", crossing_curves="common-dispersion", limit_states=["rotation > 0.5 alpha", "Overturned"]
    )
    assert [curve.state for curve in chosen.curves] == ["rotation > 0.5 alpha", "overturned"]
    assert chosen.curves[0].dispersion == chosen.curves[1].dispersion
    with pytest.raises(InvalidValueError, match=r"states must be one of rocking, .* got 'rested'"):
        model_of(stripes, "leaning", limit_states=["rested"])


def test_a_fit_without_a_curve_says_so(motions):
    """All survive: no curve, neither of a fit nor of a cloud."""
    fit = fit_lognormal([1.0, 2.0, 3.0], [0, 0, 0], [5, 5, 5])
    assert repr(fit) == "<LognormalFit: no curve, from 15 outcomes>"
    assert "no curve" in repr(
        fragility_analysis(BODY, [motion.scaled(1e-3) for motion in motions], restitution="ked", analysis="cloud")
    )


def test_many_transitions_print_their_ends(motions):
    """Hundreds of stretches under a record: how many, from where to where; a few are printed one by one."""
    found = rk.minimum_overturning_acceleration(BODY, motions[0], "ked")
    count, least = len(found.overturning_intervals), found.minimum
    assert count > 3
    assert f"overturns in {count} intervals from {least:.4g} to {found.max_pga:.4g} m/s2" in repr(found)
    few = rk.minimum_overturning_acceleration(BODY, motions[0], "ked", max_pga=1.0001 * least)
    assert f"overturns from {least:.4g} to " in repr(few)


def test_a_sensitivity_prints_what_is_compared(motions):
    """The choices, the baseline last."""
    levels = np.linspace(1.0, 9.0, 5)
    compared = fragility_sensitivity(BODY, motions, levels, ["housner", "ked"], repetitions=10)
    assert repr(compared) == "<Sensitivity: ked against housner>"


def test_a_data_set_prints_in_one_line():
    """How many measurements, and of which slendernesses; also of none."""
    data = rk.evidence.datasets()["S"]
    assert repr(data) == "<DataSet S: 9 measurements of r, h/b 1.5 to 9.75>"
    assert repr(data.rows(np.zeros(9, dtype=bool))) == "<DataSet S: 0 measurements of r>"
