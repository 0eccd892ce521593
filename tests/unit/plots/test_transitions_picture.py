"""The picture of crossings: shaded where the body overturns, a curve where it stands, names that fit."""

import math
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import transitions_picture
from rocking.plots.overturning_map import CLASSES, FIRST, SECOND

pytestmark = pytest.mark.slow

G = 9.80665
BLOCK, SINE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.8)


@pytest.fixture(scope="module")
def found():
    """Overturned after an impact, safe again, overturned without impact."""
    return rk.minimum_overturning_acceleration(BLOCK, SINE, 0.85)


@pytest.fixture(scope="module")
def axes(found):
    """The panel of the picture, drawn."""
    figure = transitions_picture(found, BLOCK, SINE, 0.85)
    FigureCanvasAgg(figure).draw()
    return figure.axes[0]


def _spans(axes):
    return sorted((patch.get_x(), patch.get_x() + patch.get_width(), patch.get_facecolor()) for patch in axes.patches)


def test_shades_end_at_the_crossings(axes, found):
    """Two shades in the colours of maps, from the first crossing to the second and from the third to the edge."""
    from matplotlib.colors import to_rgba

    first, second = _spans(axes)
    a, b, c = found.acceleration / G
    assert first[:2] == pytest.approx((a, b), rel=1e-9)
    assert second[:2] == pytest.approx((c, axes.get_xlim()[1]), rel=1e-9)
    assert (first[2], second[2]) == (to_rgba(CLASSES[SECOND][1]), to_rgba(CLASSES[FIRST][1]))
    assert [text.get_text() for text in axes.texts] == ["overturns without impact", "overturns after 1 impact"]


def test_curve_is_single_simulations(axes):
    """At a few amplitudes the curve is the peak of a simulation; it is broken wherever the body overturns."""
    place, peak = next(line.get_data() for line in axes.lines if len(line.get_xdata()) > 100)
    for k in range(40, len(place), 97):
        one = rk.simulate(BLOCK, SINE, 0.85, scale=float(place[k] * G / 3.0))
        if one.outcome is rk.Outcome.OVERTURNED:
            assert np.isnan(peak[k])
        else:
            assert peak[k] == pytest.approx(abs(one.peak_rotation) / math.atan(0.25), rel=1e-9)
    spans = _spans(axes)
    inside = np.any([(place > low * (1 + 1e-9)) & (place < high * (1 - 1e-9)) for low, high, _ in spans], axis=0)
    assert np.isnan(peak[inside]).all()
    assert np.isfinite(peak[~inside]).mean() > 0.9


def test_names_are_inside_the_panel_and_apart(axes):
    """No name leaves the panel or meets another."""
    panel, boxes = axes.get_window_extent(), [text.get_window_extent() for text in axes.texts]
    assert all(panel.x0 <= box.x0 and box.x1 <= panel.x1 and panel.y0 <= box.y0 and box.y1 <= panel.y1 for box in boxes)
    assert not any(a.overlaps(b) for a, b in pairwise(boxes))


def test_nothing_overturns():
    """Without crossings there is the curve over the whole range and no shade."""
    found = rk.minimum_overturning_acceleration(BLOCK, SINE, 0.85, max_pga=0.3 * G)
    axes = transitions_picture(found, BLOCK, SINE, 0.85, points=50).axes[0]
    assert not axes.patches
    assert axes.get_xlim() == pytest.approx((0.25, 0.3), rel=1e-9)


def test_stretches_too_narrow_for_words_have_a_legend():
    """Under a long record survival and overturning alternate: what gets no name is in a legend, names come once."""
    time = np.arange(1500) * 0.01
    row = np.sin(4.5 * time) * np.exp(-(((time - 6.0) / 3.0) ** 2)) + 0.3 * np.sin(12.0 * time)
    record, block = rk.GroundMotion(row, 0.01, name="made up, 5 $"), rk.Block.from_angle(0.2, 1.0)
    found = rk.minimum_overturning_acceleration(block, record, 0.9, samples=100, bisections=1)
    figure = transitions_picture(found, block, record, 0.9)
    words = [text.get_text() for text in figure.axes[0].texts]
    assert len(words) == len(set(words))
    told = {text.get_text() for legend in figure.legends for text in legend.get_texts()} | set(words)
    assert len(found) > 4
    assert any("2 or more" in one for one in told)


def test_refusals(found):
    """Something else than crossings, or a number of points that is none, is refused."""
    with pytest.raises(InvalidValueError, match="minimum_overturning_acceleration"):
        transitions_picture([1.0], BLOCK, SINE)
    with pytest.raises(InvalidValueError, match="points"):
        transitions_picture(found, BLOCK, SINE, points=1)
    with pytest.raises(InvalidValueError, match="motion"):
        transitions_picture(found, BLOCK, "no-such", 0.85)
