"""Curves that cross: what is exported is what is shown, uplift is not moved, states can be left out."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.motions.components import with_vertical
from rocking.plots.fragility import fragility_picture
from rocking.studies import SyntheticSet, fragility_analysis
from rocking.studies.fragility import FragilityCurve, FragilityModel, fema_p58_table, model_of, to_nrml
from rocking.studies.fragility.curves import crosses, shown_curves, without_crossing
from rocking.studies.fragility.limit_states import limit_states_of

pytestmark = pytest.mark.verifies(room="studies")

G = 9.80665
CABINET = rk.Block(width=0.7, height=2.0, depth=0.6, density=300.0, centre=(0.311, 1.0))
LIFTS = 0.311  # tan of the slenderness angle of the weaker side: 0.311 m / 1.0 m [g]


@pytest.fixture(scope="module")
def leaning():
    """A cabinet with unequal sides under 30 motions, at levels between and above those of its two sides."""
    levels = np.array([0.25, 0.32, 0.34, 0.36, 0.38, 0.45, 0.6, 0.8, 1.1, 1.5]) * G
    return fragility_analysis(CABINET, SyntheticSet("point-source", 30, 3), levels, restitution="ked")


@pytest.mark.verifies("closed form", "g tan(alpha) of the weaker side", within="1e-12")
def test_no_motion_lifts_the_body_below_its_weaker_side(leaning):
    """The level is that of the weaker side; no history rocks below; files have no damage there."""
    assert leaning.uplift.threshold is None  # between both sides the sign of the peak decides
    assert leaning.subject.lowest_uplift == pytest.approx(LIFTS * G, rel=1e-12)
    below = leaning.history_levels < LIFTS * G
    assert below.sum() == 30
    assert not leaning.responses.rocked[below].any()
    assert leaning.responses.rocked[leaning.history_levels < 0.34 * G].any()  # a slightly higher level lifts it
    assert model_of(leaning, "cabinet").uplift_threshold == leaning.subject.lowest_uplift
    upwards = with_vertical(rk.GroundMotion([0.0, 1.0, 0.0], 0.1), rk.GroundMotion([0.0, 1.0, 0.0], 0.1))
    assert fragility_analysis(CABINET, upwards, [1.0, 2.0], restitution="ked").subject.lowest_uplift is None


@pytest.mark.verifies("computed anew", "maximum likelihood by scipy", within="1e-4, the tolerance of its simplex")
def test_the_default_does_not_move_uplift(leaning):
    """Rocking keeps its curve, the other states get one dispersion; that of all states would move rocking down."""
    alone = {name: (fit.median, fit.dispersion) for name, fit in leaning.fits.items()}
    assert crosses(shown_curves(leaning, "refuse")) is not None
    made = model_of(leaning, "cabinet")
    curves = {curve.state: curve for curve in made.curves}
    names = ["rotation > 0.5 alpha", "overturned"]
    if "rocking" in curves:
        assert (curves["rocking"].median, curves["rocking"].dispersion) == alone["rocking"]
        assert "is not changed: no motion causes uplift below 0.311 g" in made.adjusted
    else:
        assert "left out" in made.without["rocking"]
    assert "The states rotation > 0.5 alpha, overturned have a common dispersion" in made.adjusted
    assert crosses(made) is None
    counts, trials = [leaning.counts[name] for name in names], leaning.trials

    def minus(x):
        high, low = (norm.cdf((np.log(leaning.levels) - m) / math.exp(x[2])) for m in x[:2])
        parts = (trials - counts[0], 1.0 - high), (counts[0] - counts[1], high - low), (counts[1], low)
        return -sum(float(np.sum(n * np.log(np.maximum(p, 1e-300)))) for n, p in parts)

    start = [math.log(alone[name][0]) for name in names] + [math.log(0.4)]
    best = minimize(minus, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000}).x
    for name, log_median in zip(names, best[:2], strict=True):
        assert curves[name].median == pytest.approx(math.exp(log_median), rel=1e-4)
        assert curves[name].dispersion == pytest.approx(math.exp(best[2]), rel=1e-4)
        assert curves[name].dispersion != pytest.approx(alone[name][1], rel=0.05)
    moved = shown_curves(leaning, "common-dispersion")
    assert moved.curves[0].probability(0.2 * G) > 0.01  # rocking, at a level where nothing can lift the body
    assert "at the level of uplift: no motion causes uplift below 0.311 g" in moved.adjusted
    assert all(curve.probability(0.2 * G) < 0.01 for curve in made.curves if curve.state == "rocking")


def test_every_file_contains_the_curves_that_are_shown(leaning, tmp_path):
    """Picture, FEMA P-58 and NRML have the medians of `shown_curves`, with the reason; curves alone would differ."""
    shown, made = shown_curves(leaning), model_of(leaning, "cabinet")
    assert [(c.state, c.median, c.dispersion) for c in made.curves] == [
        (c.state, c.median, c.dispersion) for c in shown.curves
    ]
    rows = fema_p58_table(made).rows
    assert [row[4] * G for row in rows] == pytest.approx([c.median for c in shown.curves], rel=1e-14)
    for row in rows:
        assert made.adjusted.rstrip(".") in row[9]
        assert "no motion causes uplift below 0.311 g" in row[9]
        assert ".;" not in row[9]
    assert made.adjusted in to_nrml(made, tmp_path / "f.xml").read_text("utf-8").replace("&gt;", ">")
    figure = fragility_picture(leaning, curves=shown)
    drawn = [line.get_xydata() for line in figure.axes[0].lines if len(line.get_xdata()) == 120]
    for curve in (c for c in shown.curves if c.state in shown.shared):
        assert any(np.allclose(data[:, 1], curve.probability(data[:, 0]), rtol=1e-12) for data in drawn)
        alone = leaning.fits[curve.state]
        assert not any(np.allclose(data[:, 1], alone.probability(data[:, 0]), rtol=1e-3) for data in drawn)
    assert "so that their curves do not cross" in figure._supxlabel.get_text().replace("\n", " ")


def model(curves, **change):
    """Curves with counts of 60 histories at five levels."""
    levels = np.array([1.0, 2.0, 3.0, 4.0, 6.0])
    reached = {"rotation > 0.5 alpha": np.array([6, 16, 35, 50, 60]), "overturned": np.array([4, 14, 22, 32, 45])}
    reached["rocking"] = np.array([7, 58, 60, 60, 60])
    return FragilityModel("body", "pga", "m/s2", curves, levels, np.full(5, 60), reached, **change)


FAR, OVER = FragilityCurve("rotation > 0.5 alpha", 2.7, 0.5), FragilityCurve("overturned", 4.0, 0.8)


def test_a_state_that_would_still_cross_is_left_out():
    """A curve of rocking that crosses even so is left out with the reason; without a level it is fitted."""
    late = FragilityCurve("rocking", 2.6, 0.1)
    made = without_crossing(model((late, FAR, OVER), uplift_threshold=0.5))
    assert [curve.state for curve in made.curves] == ["rotation > 0.5 alpha", "overturned"]
    assert made.without["rocking"].startswith("The limit state rocking is omitted")
    assert made.without["rocking"] in made.adjusted
    early = without_crossing(model((FragilityCurve("rocking", 0.9, 0.1), FAR, OVER), uplift_threshold=0.8))
    assert [curve.state for curve in early.curves] == ["rocking", "rotation > 0.5 alpha", "overturned"]
    assert early.curves[0].median == 0.9
    assert early.without == {}
    undecided = without_crossing(model((FragilityCurve("rocking", 1.4, 0.2), FAR, OVER)))
    assert len({curve.dispersion for curve in undecided.curves}) == 1
    assert len(undecided.curves) == 3


def test_curves_that_do_not_cross_are_kept():
    """Above the level of uplift nothing crosses: the same curves, no reason; without the level they cross."""
    curves = FragilityCurve("rotation > 0.5 alpha", 2.0, 0.3), FragilityCurve("overturned", 4.0, 0.35)
    kept = model(curves, uplift_threshold=0.9)
    assert without_crossing(kept) is kept
    assert kept.adjusted == ""
    wide = (curves[0], FragilityCurve("overturned", 4.0, 0.8))
    assert without_crossing(model(wide, uplift_threshold=1.5)).adjusted == ""
    assert without_crossing(model(wide)).shared
    none = without_crossing(model((FAR, FragilityCurve("overturned", 4.0, 0.9)), uplift_threshold=0.1))
    assert none.shared
    bare = FragilityModel("body", "pga", "m/s2", (FAR, OVER), [1.0], np.array([9]), {})
    assert without_crossing(bare).curves == (FAR, OVER)
    assert (
        "The curves stay separate, because no common dispersion fits the states rotation > 0.5 alpha, overturned"
        in without_crossing(bare).adjusted
    )
    with pytest.raises(InvalidValueError, match="curves must not cross"):
        fema_p58_table(without_crossing(bare))


def test_states_can_be_left_out():
    """Numbers alone include rocking and overturning; with a name the states are those given, from the least."""
    names = {
        (): ["rocking", "overturned"],
        (0.5,): ["rocking", "rotation > 0.5 alpha", "overturned"],
        ("overturning",): ["overturned"],
        ("overturning", 0.5): ["rotation > 0.5 alpha", "overturned"],
        (0.2, 0.5, "rocking"): ["rocking", "rotation > 0.2 alpha", "rotation > 0.5 alpha"],
        ("overturning", "rocking"): ["rocking", "overturned"],
    }
    for given, wanted in names.items():
        assert [state.name for state in limit_states_of(given)] == wanted
    assert [state.name for state in limit_states_of("overturning")] == ["overturned"]
    for bad in (("overturned",), ("rocking", "rocking"), (0.5, 0.2, "rocking"), ("rocking", -1.0), (math.nan,), "all"):
        with pytest.raises(InvalidValueError, match="states must"):
            limit_states_of(bad)


@pytest.mark.slow
def test_a_cloud_without_a_state_knows_its_parts():
    """The parts of a cloud do not depend on the states that are shown."""
    pulses = [rk.pulses.sine(a, 0.6) for a in (2.0, 2.6, 2.8, 3.2, 3.0, 6.0, 2.9, 8.0)]
    block = rk.Block(width=0.4, height=1.6)
    whole, part = (
        fragility_analysis(block, pulses, analysis="cloud", limit_states=s, restitution="ked")
        for s in ((0.5,), (0.5, "rocking"))
    )
    assert list(part.fits) == ["rotation > 0.5 alpha"]
    for name, values in whole.parts([2.9, 4.0], 0.5).items():
        np.testing.assert_array_equal(part.parts([2.9, 4.0], 0.5)[name], values)
    assert rk.fragility(block, pulses, analysis="cloud", limit_states=["overturning"])["state"].values.tolist() == [
        "overturned"
    ]


def test_one_state_has_no_common_dispersion(leaning):
    """A single curve crosses none: it keeps its own fit and interval by every treatment."""
    for crossing_curves in ("keep-uplift", "common-dispersion", "refuse"):
        made = model_of(leaning, "cabinet", crossing_curves=crossing_curves, limit_states=["overturned"])
        (curve,) = made.curves
        assert made.adjusted == ""
        assert (curve.median, curve.dispersion) == (
            leaning.fits["overturned"].median,
            leaning.fits["overturned"].dispersion,
        )
        assert curve.median_95 is not None
    assert "a common dispersion" in model_of(leaning, "cabinet", crossing_curves="common-dispersion").adjusted
