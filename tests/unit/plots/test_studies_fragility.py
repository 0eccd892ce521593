"""Pictures of fragility: points, intervals, curves, bands and words against the analyses and closed forms."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from scipy import stats

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import fragility_picture, incremental_dynamic_analysis_picture, measures_picture, sensitivity_picture
from rocking.plots.fragility import caption, grouped, state_colors, symbol
from rocking.plots.style import PALE
from rocking.studies.fragility import compare_measures, fragility_analysis
from rocking.studies.sensitivity import fragility_sensitivity, map_sensitivity

pytestmark = pytest.mark.slow

G = 9.80665
BLOCK = rk.Block(width=0.4, height=1.6)
PULSES = [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 1.4, 24)]
LEVELS = np.arange(1.5, 9.1, 1.5)


@pytest.fixture(scope="module")
def stripes():
    """24 pulses at six levels."""
    return fragility_analysis(BLOCK, PULSES, LEVELS, 0.9)


@pytest.fixture(scope="module")
def picture(stripes):
    """Their picture."""
    return fragility_picture(stripes)


@pytest.fixture(scope="module")
def raised():
    """The same pulses, raised level by level."""
    return fragility_analysis(BLOCK, PULSES, np.arange(2.0, 12.1, 0.5), 0.9, analysis="incremental")


@pytest.fixture(scope="module")
def clouded():
    """Pulses of many amplitudes and periods, each at its own level."""
    draw = np.random.default_rng(5)
    pulses = [rk.pulses.sine(a, t) for a, t in zip(draw.uniform(2.0, 8.0, 80), draw.uniform(0.3, 1.2, 80), strict=True)]
    return fragility_analysis(BLOCK, pulses, restitution=0.9, analysis="cloud")


def _bars(axes):
    """Points of each state with the ends of their intervals."""
    found = []
    for bar in axes.containers:
        points, _, (segments,) = bar.lines
        found.append((np.asarray(points.get_data()), np.array([s[:, 1] for s in segments.get_segments()])))
    return found


def test_points_and_intervals(stripes, picture):
    """Points are counts over trials; intervals are those of Clopper and Pearson, from the beta distribution."""
    upper, lower = picture.axes
    assert lower.get_xlabel() == "peak ground acceleration [m/s$^2$]"
    assert upper.get_ylabel() == "probability [-]"
    for (points, ends), counts in zip(_bars(upper), stripes.counts.values(), strict=True):
        np.testing.assert_allclose(points, [LEVELS, counts / 24.0], rtol=1e-12)
        low = [stats.beta.ppf(0.025, k, 25 - k) if k else 0.0 for k in counts]
        high = [stats.beta.ppf(0.975, k + 1, 24 - k) if k < 24 else 1.0 for k in counts]
        np.testing.assert_allclose(ends, np.transpose([low, high]), rtol=0.0, atol=1e-9)
        # negative control: the interval from the normal distribution is another
        wald = counts / 24.0 - 1.96 * np.sqrt(counts / 24.0 * (1.0 - counts / 24.0) / 24.0)
        assert np.abs(ends[:, 0] - wald).max() > 0.01


def test_curves_and_bands(stripes, picture):
    """The drawn curve is the lognormal distribution of the fit, and lies within its band."""
    upper = picture.axes[0]
    drawn = [line for line in upper.lines if len(line.get_xdata()) > 50]
    bands = [part for part in upper.collections if isinstance(part, PolyCollection)]
    assert len(drawn) == len(bands) == len(stripes.fits) == 2
    for line, band, fit in zip(drawn, bands, stripes.fits.values(), strict=True):
        at, probability = line.get_data()
        np.testing.assert_allclose(
            probability, stats.lognorm.cdf(at, fit.dispersion, scale=fit.median), rtol=1e-6, atol=1e-12
        )
        corners = band.get_paths()[0].vertices
        for level, value in zip(at[20:100:10], probability[20:100:10], strict=True):
            heights = corners[np.isclose(corners[:, 0], level, rtol=1e-12), 1]
            assert heights.min() <= value <= heights.max()


def test_uplift_is_a_step(picture):
    """Where PGA decides rocking there is no curve but a line at g tan(alpha) = g / 4."""
    upper = picture.axes[0]
    (step,) = (line for line in upper.lines if len(set(line.get_xdata())) == 1 and list(line.get_ydata()) == [0, 1])
    assert step.get_xdata()[0] == pytest.approx(0.25 * G, rel=1e-12, abs=0.0)


def test_states_add_up(stripes, picture):
    """The bars of every level go from 0 to 1, and those of overturning are the counts."""
    lower = picture.axes[1]
    heights = np.array([[bar.get_height() for bar in group] for group in lower.containers])
    np.testing.assert_allclose(heights.sum(axis=0), 1.0, rtol=1e-12)
    np.testing.assert_allclose(heights[-1], stripes.counts["overturned"] / 24.0, rtol=0.0, atol=1e-12)
    words = [text.get_text() for text in lower.get_legend().get_texts()]
    assert words[0] == "no rocking"
    assert words[-1] == "overturned"


def test_words_do_not_overlap(picture):
    """Legends lie beside the panels, not over one another, and nothing is cut off at 90 mm."""
    FigureCanvasAgg(picture).draw()
    upper, lower = (axes.get_legend().get_window_extent() for axes in picture.axes)
    assert not upper.overlaps(lower)
    assert max(upper.x1, lower.x1) <= picture.bbox.x1
    assert picture.get_figwidth() * 25.4 == pytest.approx(90.0)


def test_separation_is_said():
    """Outcomes that form a step get no band, and the caption says that there is no maximum-likelihood curve."""
    found = fragility_analysis(BLOCK, PULSES[8], [2.0, 3.0, 4.0, 8.0], 0.9)
    figure = fragility_picture(found)
    told = figure.get_supxlabel()
    assert "separation" in told
    assert "no maximum-likelihood curve" in told.replace("\n", " ")
    assert told == "" or len(max(told.split("\n"), key=len)) <= 84
    # negative control: outcomes that overlap have no caption
    assert caption(fragility_analysis(BLOCK, PULSES, LEVELS, 0.9, limit_states=())) == ""


def test_cloud_is_gathered(clouded):
    """Outcomes of many levels are gathered: groups hold all of them, none twice."""
    counts = [np.asarray(v, dtype=float) for v in (clouded.counts["overturned"], clouded.trials)]
    at, reached, trials = grouped(np.asarray(clouded.levels), *counts)
    assert (reached.sum(), trials.sum(), at.size) == (counts[0].sum(), 80.0, 10)
    assert np.all(np.diff(at) > 0.0)
    assert fragility_picture(clouded).axes[1].get_xlabel() == "peak ground acceleration [m/s$^2$]"


def test_weighted_mean_of_a_group():
    """Sixteen levels of one trial each make two groups, at their geometric means."""
    levels = np.geomspace(1.0, 16.0, 16)
    at, reached, trials = grouped(levels, (levels > 4.0).astype(float), np.ones(16))
    np.testing.assert_allclose(at, [math.sqrt(levels[0] * levels[7]), math.sqrt(levels[8] * levels[15])])
    assert (reached.tolist(), trials.tolist()) == ([0.0, 8.0], [8.0, 8.0])


def test_names_of_states():
    """States have symbols, and as many colours as there are parts."""
    assert symbol("rotation > 0.2 alpha") == r"$\theta > 0.2\,\alpha$"
    assert symbol("rocking") == "rocks"
    assert len(set(state_colors(4))) == 5


def test_incremental_curves(raised):
    """Grey curves end where overturning starts; crosses are the first crossings; blue points lie above one."""
    figure = incremental_dynamic_analysis_picture(raised)
    left, right = figure.axes
    assert left.get_ylabel() == "peak ground acceleration [m/s$^2$]"
    assert left.get_xlabel() == r"peak rotation $\theta\,/\,\alpha$ [-]"
    (crosses,) = (line for line in left.lines if line.get_marker() == "x")
    wanted = raised.first_crossings[np.isfinite(raised.first_crossings)]
    np.testing.assert_array_equal(np.sort(crosses.get_ydata()), np.sort(wanted))
    blue = [line for line in left.lines if line.get_marker() == "o"]
    again = sum(np.isfinite(c[np.argmax(np.isinf(c)) :]).any() and np.isinf(c).any() for c in raised.curves)
    assert len(blue) == again > 0
    (fraction,) = (line for line in right.lines if line.get_linestyle() == "-")
    np.testing.assert_allclose(fraction.get_xdata(), raised.counts["overturned"] / 24.0)
    (passed,) = (line for line in right.lines if line.get_linestyle() == "--")
    np.testing.assert_allclose(passed.get_xdata(), [(wanted <= level).sum() / 24.0 for level in raised.levels])
    assert np.all(passed.get_xdata() >= fraction.get_xdata())
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert f"resurrection: {len(raised.resurrected(0.01))} motions" in words


def test_incremental_without_overturning():
    """Levels that overturn nothing give a picture without crosses and without warnings."""
    figure = incremental_dynamic_analysis_picture(
        fragility_analysis(BLOCK, PULSES[:3], [2.0, 2.2, 2.4], 0.9, analysis="incremental")
    )
    FigureCanvasAgg(figure).draw()
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert not any("resurrection" in word for word in words)


def test_measures(clouded):
    """Dots are the scores in their order; p-values stand on a log axis beside the line of 0.05."""
    draw = np.random.default_rng(1)
    found = compare_measures(
        clouded, ["pga", "pgv", "pgv/pga", "p pgv/(g tan alpha)"], metadata={"magnitude": draw.uniform(5.0, 7.0, 80)}
    )
    figure = measures_picture(found)
    left, right = figure.axes
    np.testing.assert_array_equal(left.lines[len(found.scores)].get_xdata(), [s.efficiency for s in found.scores])
    assert np.all(np.diff([s.efficiency for s in found.scores]) >= 0.0)
    assert left.get_xlabel() == "dispersion [-]"
    assert len(left.get_yticklabels()) == len(found.scores) == 4
    (dots,) = (line for line in right.lines if line.get_label() == "magnitude")
    np.testing.assert_allclose(dots.get_xdata(), [max(s.sufficiency["magnitude"], 1e-4) for s in found.scores])
    assert right.get_xscale() == "log"
    assert any(list(line.get_xdata()) == [0.05, 0.05] for line in right.lines)
    FigureCanvasAgg(figure).draw()
    # without metadata there is one panel
    assert len(measures_picture(compare_measures(clouded, ["pga", "pgv"])).axes) == 1


def test_refusals(stripes):
    """What is no analysis is refused in words, and a confidence that is no share."""
    for draw in (fragility_picture, incremental_dynamic_analysis_picture, measures_picture):
        with pytest.raises(InvalidValueError, match="got 'no analysis'"):
            draw("no analysis")
    with pytest.raises(InvalidValueError, match="level"):
        fragility_picture(stripes, level=95.0)


TWELVE = [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 1.4, 12)]


def _shaded(axes):
    return [patch for patch in axes.patches if patch.get_facecolor() == to_rgba(PALE)]


def test_what_cannot_be_lifted_is_shaded():
    """The shade ends at g b / h = g / 4 and holds no motion that rocked; it is named."""
    found = fragility_analysis(BLOCK, TWELVE, [1.0, 2.0, 3.0, 5.0, 8.0], 0.9)
    upper = fragility_picture(found).axes[0]
    (shade,) = _shaded(upper)
    assert shade.get_x() + shade.get_width() == pytest.approx(0.25 * G, rel=1e-12, abs=0.0)
    assert shade.get_x() < upper.get_xlim()[0]
    assert [text.get_text() for text in upper.texts] == ["no uplift"]
    assert found.counts["rocking"][found.levels < 0.25 * G].tolist() == [0, 0]


def test_nothing_is_shaded_where_nothing_is_certain():
    """Levels that all lift the body, and a measure that decides nothing, give no shade."""
    above = fragility_analysis(BLOCK, TWELVE, [3.0, 4.0, 5.0, 6.0], 0.9)
    velocity = fragility_analysis(BLOCK, TWELVE, [0.1, 0.4, 0.8], 0.9, im="pgv")
    for found in (above, velocity):
        upper = fragility_picture(found).axes[0]
        assert _shaded(upper) == []
        assert list(upper.texts) == []


def test_levels_below_uplift_alone():
    """Where no level lifts the body all is shaded, there is no curve, and the words say why."""
    figure = fragility_picture(fragility_analysis(BLOCK, TWELVE, [0.5, 1.0, 2.0], 0.9))
    upper = figure.axes[0]
    (shade,) = _shaded(upper)
    assert shade.get_x() + shade.get_width() > upper.get_xlim()[1]
    assert "No failures" in figure.get_supxlabel()
    FigureCanvasAgg(figure).draw()


def test_few_motions_have_no_band():
    """Four motions get no band, which would be too narrow; twelve get one."""
    for count, bands in ((4, 0.0), (12, 0.1)):
        found = fragility_analysis(BLOCK, TWELVE[4 : 4 + count], np.arange(2.0, 9.0, 0.5), 0.9, limit_states=())
        filled = [part for part in fragility_picture(found).axes[0].collections if isinstance(part, PolyCollection)]
        heights = [np.ptp(part.get_paths()[0].vertices[:, 1]) for part in filled]
        assert max(heights, default=0.0) >= bands
        assert bands or max(heights, default=0.0) == 0.0


def test_stripes_stay_stripes():
    """Twenty levels of twelve motions are twenty points; of one motion they would be gathered (negative control)."""
    levels, reached = np.linspace(1.0, 5.0, 20), np.arange(20.0)
    at, hits, trials = grouped(levels, np.minimum(reached, 12.0), np.full(20, 12.0))
    np.testing.assert_allclose(at, levels, rtol=1e-14)
    assert (hits.tolist(), trials.tolist()) == (np.minimum(reached, 12.0).tolist(), 20 * [12.0])
    assert grouped(levels, np.ones(20), np.ones(20))[0].size == 2


@pytest.fixture(scope="module")
def closed_form():
    """One sine of three times the frequency parameter, r = 0.9, slender-linear, raised level by level: its picture."""
    sine = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * BLOCK.frequency_parameter))
    unit = G * BLOCK.slenderness_angle
    found = fragility_analysis(BLOCK, sine, np.linspace(1.0, 4.0, 13) * unit, 0.9, linear=True, analysis="incremental")
    return incremental_dynamic_analysis_picture(found), unit


def test_lanes_are_the_closed_form(closed_form):
    """Brown below 3.4847 and above 3.6311 times g alpha, blue between: the published boundaries of both modes."""
    figure, unit = closed_form
    left = figure.axes[0]
    fallen, again = (part for part in left.collections if isinstance(part, LineCollection))
    ends = np.array([segment[:, 1] for segment in fallen.get_segments()]) / unit
    np.testing.assert_allclose(ends[0, 1], 3.48466273332249203, rtol=1e-7)
    np.testing.assert_allclose(ends[1], [3.6311498724447945014, 4.0], rtol=1e-7)
    (stands,) = (segment[:, 1] / unit for segment in again.get_segments())
    np.testing.assert_allclose(stands, [3.48466273332249203, 3.6311498724447945014], rtol=1e-7)
    (cross,) = (line for line in left.lines if line.get_marker() == "x")
    assert cross.get_ydata()[0] / unit == pytest.approx(ends[0, 0], rel=1e-12, abs=0.0)


def test_every_motion_has_a_lane_of_its_own():
    """Lanes stand beside one another by first crossing, inside the panel; no lane without overturning."""
    found = fragility_analysis(BLOCK, TWELVE, np.arange(2.0, 9.1, 0.5), 0.9, analysis="incremental")
    figure = incremental_dynamic_analysis_picture(found)
    left = figure.axes[0]
    (crosses,) = (line for line in left.lines if line.get_marker() == "x")
    places, starts = crosses.get_data()
    assert places.size == np.isfinite(found.first_crossings).sum()
    assert np.all(np.diff(places) > 0.0)
    assert np.all(np.diff(starts) >= 0.0)
    assert 1.0 < places.min() < places.max() < left.get_xlim()[1]
    FigureCanvasAgg(figure).draw()


def test_words_of_the_incremental_picture_do_not_overlap(closed_form):
    """Axis label, name of the lanes and legend keep apart and inside 90 mm."""
    figure = closed_form[0]
    FigureCanvasAgg(figure).draw()
    left, right = figure.axes
    words = (left.xaxis.label, right.xaxis.label, figure.legends[0], left.texts[0])
    parts = [part.get_window_extent() for part in words]
    for k, part in enumerate(parts):
        assert not any(part.overlaps(other) for other in parts[k + 1 :])
        assert figure.bbox.x0 <= part.x0 < part.x1 <= figure.bbox.x1


def test_units_of_sensitivity():
    """Medians have their unit, the lowest map of differences its own axis."""
    found = fragility_sensitivity(BLOCK, TWELVE, np.arange(2.0, 14.1, 2.0), [0.95, 0.8], repetitions=0)
    title = sensitivity_picture(found).axes[-1].get_title(loc="left")
    medians = [found.results[label].fits["overturned"].median for label in ("0.95", "0.8")]
    ratio = f"ratios of medians {medians[1] / medians[0]:.3g}"
    assert title == f"overturned: medians {medians[0]:.3g}, {medians[1]:.3g} m/s$^2$\n{ratio}"
    axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    panels = sensitivity_picture(map_sensitivity(BLOCK, rk.pulses.sine(3.0, 0.6), *axes, ["housner", "ked"])).axes
    assert panels[3].get_ylabel() == panels[0].get_ylabel() != ""
