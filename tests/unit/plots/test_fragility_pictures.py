"""Pictures of fragility where they meet physics: what cannot be lifted, stripes as they are, lanes of intervals."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba

import rocking as rk
from rocking.plots.fragility import fragility_picture, gathered
from rocking.plots.incremental_dynamic_analysis import incremental_dynamic_analysis_picture
from rocking.plots.sensitivity import sensitivity_picture
from rocking.plots.style import PALE
from rocking.studies.fragility import incremental_dynamic_analysis, multiple_stripe_analysis
from rocking.studies.sensitivity import fragility_sensitivity, map_sensitivity

G = 9.80665
BLOCK = rk.Block(width=0.4, height=1.6)
PULSES = [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 1.4, 12)]


def _shaded(axes):
    return [patch for patch in axes.patches if patch.get_facecolor() == to_rgba(PALE)]


def test_what_cannot_be_lifted_is_shaded():
    """The shade ends at g b / h = g / 4 and holds no motion that rocked; it is named."""
    found = multiple_stripe_analysis(BLOCK, PULSES, [1.0, 2.0, 3.0, 5.0, 8.0], 0.9)
    upper = fragility_picture(found).axes[0]
    (shade,) = _shaded(upper)
    assert shade.get_x() + shade.get_width() == pytest.approx(0.25 * G, rel=1e-12)
    assert shade.get_x() < upper.get_xlim()[0]
    assert [text.get_text() for text in upper.texts] == ["not lifted"]
    assert found.counts["rocking"][found.levels < 0.25 * G].tolist() == [0, 0]


def test_nothing_is_shaded_where_nothing_is_certain():
    """Levels that all lift the body, and a measure that decides nothing, give no shade."""
    above = multiple_stripe_analysis(BLOCK, PULSES, [3.0, 4.0, 5.0, 6.0], 0.9)
    velocity = multiple_stripe_analysis(BLOCK, PULSES, [0.1, 0.4, 0.8], 0.9, "pgv")
    for found in (above, velocity):
        upper = fragility_picture(found).axes[0]
        assert _shaded(upper) == []
        assert list(upper.texts) == []


def test_levels_below_uplift_alone():
    """Where no level lifts the body all is shaded, there is no curve, and the words say why."""
    figure = fragility_picture(multiple_stripe_analysis(BLOCK, PULSES, [0.5, 1.0, 2.0], 0.9))
    upper = figure.axes[0]
    (shade,) = _shaded(upper)
    assert shade.get_x() + shade.get_width() > upper.get_xlim()[1]
    assert "Nothing failed" in figure.get_supxlabel()
    FigureCanvasAgg(figure).draw()


def test_few_motions_have_no_band():
    """Four motions get no band, which would be too narrow; twelve get one."""
    for count, bands in ((4, 0.0), (12, 0.1)):
        found = multiple_stripe_analysis(BLOCK, PULSES[4 : 4 + count], np.arange(2.0, 9.0, 0.5), 0.9, states=())
        filled = [part for part in fragility_picture(found).axes[0].collections if isinstance(part, PolyCollection)]
        heights = [np.ptp(part.get_paths()[0].vertices[:, 1]) for part in filled]
        assert max(heights, default=0.0) >= bands
        assert bands or max(heights, default=0.0) == 0.0


def test_stripes_stay_stripes():
    """Twenty levels of twelve motions are twenty points; of one motion they would be gathered (negative control)."""
    levels, reached = np.linspace(1.0, 5.0, 20), np.arange(20.0)
    at, hits, trials = gathered(levels, np.minimum(reached, 12.0), np.full(20, 12.0))
    np.testing.assert_allclose(at, levels, rtol=1e-14)
    assert (hits.tolist(), trials.tolist()) == (np.minimum(reached, 12.0).tolist(), 20 * [12.0])
    assert gathered(levels, np.ones(20), np.ones(20))[0].size == 2


@pytest.fixture(scope="module")
def raised():
    """One sine of three times the frequency parameter, r = 0.9, slender-linear, raised level by level."""
    sine = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * BLOCK.frequency_parameter))
    unit = G * BLOCK.slenderness_angle
    return incremental_dynamic_analysis(BLOCK, sine, np.linspace(1.0, 4.0, 13) * unit, 0.9, linear=True), unit


def test_lanes_are_the_closed_form(raised):
    """Brown below 3.4847 and above 3.6311 times g alpha, blue between: the published boundaries of both modes."""
    found, unit = raised
    left = incremental_dynamic_analysis_picture(found).axes[0]
    fallen, again = (part for part in left.collections if isinstance(part, LineCollection))
    ends = np.array([segment[:, 1] for segment in fallen.get_segments()]) / unit
    np.testing.assert_allclose(ends[0, 1], 3.48466273332249203, rtol=1e-7)
    np.testing.assert_allclose(ends[1], [3.6311498724447945014, 4.0], rtol=1e-7)
    (stands,) = (segment[:, 1] / unit for segment in again.get_segments())
    np.testing.assert_allclose(stands, [3.48466273332249203, 3.6311498724447945014], rtol=1e-7)
    (cross,) = (line for line in left.lines if line.get_marker() == "x")
    assert cross.get_ydata()[0] / unit == pytest.approx(ends[0, 0], rel=1e-12)


def test_every_motion_has_a_lane_of_its_own():
    """Lanes stand beside one another by first crossing, inside the panel; no lane without overturning."""
    found = incremental_dynamic_analysis(BLOCK, PULSES, np.arange(2.0, 9.1, 0.5), 0.9)
    figure = incremental_dynamic_analysis_picture(found)
    left = figure.axes[0]
    (crosses,) = (line for line in left.lines if line.get_marker() == "x")
    places, starts = crosses.get_data()
    assert places.size == np.isfinite(found.first_crossings).sum()
    assert np.all(np.diff(places) > 0.0)
    assert np.all(np.diff(starts) >= 0.0)
    assert 1.0 < places.min() < places.max() < left.get_xlim()[1]
    FigureCanvasAgg(figure).draw()


def test_words_of_the_incremental_picture_do_not_overlap(raised):
    """Axis label, name of the lanes and legend keep apart and inside 90 mm."""
    figure = incremental_dynamic_analysis_picture(raised[0])
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    left, right = figure.axes
    parts = [part.get_window_extent(renderer) for part in (left.xaxis.label, right.xaxis.label, figure.legends[0])]
    parts.append(left.texts[0].get_window_extent(renderer))
    for k, part in enumerate(parts):
        assert not any(part.overlaps(other) for other in parts[k + 1 :])
        assert figure.bbox.x0 <= part.x0 < part.x1 <= figure.bbox.x1


def test_units_of_sensitivity():
    """Medians have their unit, the lowest map of differences its own axis."""
    found = fragility_sensitivity(BLOCK, PULSES, np.arange(2.0, 14.1, 2.0), [0.95, 0.8], repetitions=0)
    title = sensitivity_picture(found).axes[-1].get_title(loc="left")
    medians = [found.results[label].fits["overturned"].median for label in ("0.95", "0.8")]
    assert title == f"overturned: medians {medians[0]:.3g}, {medians[1]:.3g} m/s$^2$"
    axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    panels = sensitivity_picture(map_sensitivity(BLOCK, rk.pulses.sine(3.0, 0.6), *axes, ["housner", "ked"])).axes
    assert panels[3].get_ylabel() == panels[0].get_ylabel() != ""
