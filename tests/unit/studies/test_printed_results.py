"""Results print as a line or a few that say what they hold, instead of all their arrays."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.statistics import fit_lognormal
from rocking.studies import SyntheticSet, fragility_analysis, fragility_sensitivity
from rocking.studies.fragility import model_of

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
        assert f"{name}: median {fit.median:.4g}" in repr(model_of(stripes, "leaning", crossing="refuse"))
    assert len(repr(stripes)) < 400


def test_states_of_a_model_are_chosen(stripes):
    """Rocking of a body that leans hardly overlaps with rest: one dispersion is refused, with the way out."""
    with pytest.raises(InvalidValueError, match=r"the states are rocking, .*: states= leaves some out"):
        model_of(stripes, "leaning", crossing="common-dispersion")
    chosen = model_of(stripes, "leaning", crossing="common-dispersion", states=["rotation > 0.5 alpha", "Overturned"])
    assert [curve.state for curve in chosen.curves] == ["rotation > 0.5 alpha", "overturned"]
    assert chosen.curves[0].dispersion == chosen.curves[1].dispersion
    with pytest.raises(InvalidValueError, match=r"states must be one of rocking, .* got 'rested'"):
        model_of(stripes, "leaning", states=["rested"])


def test_a_fit_without_a_curve_says_so(motions):
    """All survive: no curve, neither of a fit nor of a cloud."""
    fit = fit_lognormal([1.0, 2.0, 3.0], [0, 0, 0], [5, 5, 5])
    assert repr(fit) == "<LognormalFit: no curve, from 15 outcomes>"
    assert "no curve" in repr(
        fragility_analysis(BODY, [motion.scaled(1e-3) for motion in motions], restitution="ked", analysis="cloud")
    )


def test_many_transitions_print_their_ends(motions):
    """Hundreds of stretches under a record: how many, from where to where; a few are printed one by one."""
    found = rk.minimum_overturning_acceleration(BODY, motions[0])
    count, least = len(found.overturning_intervals), found.minimum
    assert count > 3
    assert f"overturns in {count} stretches from {least:.4g} to {found.highest:.4g} m/s2" in repr(found)
    few = rk.minimum_overturning_acceleration(BODY, motions[0], highest=1.0001 * least)
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
