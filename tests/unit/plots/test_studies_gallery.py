"""Pictures of refined maps, clouds, many crossings, differences, inventories and record sets, against the data."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from scipy import stats

import rocking as rk
from rocking import conventions
from rocking.decision.inventory import Inventory, InventoryObject, Thresholds, assess
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.errors import InvalidValueError
from rocking.plots import (
    cloud_picture,
    difference_map_picture,
    inventory_picture,
    labels,
    record_set_picture,
    refined_map_picture,
    sensitivity_picture,
    transitions_of_many_picture,
)
from rocking.studies import SyntheticSet, boundary, fragility_analysis, map_sensitivity, refined_map

pytestmark = pytest.mark.slow

BLOCK, PULSE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.8)
AXES = ("frequency_ratio", np.linspace(0.5, 8.0, 16)), ("amplitude_ratio", np.linspace(1.0, 10.0, 13))


def drawn(figure):
    """Return a figure that has been laid out and drawn without a warning, its legend within the sheet."""
    FigureCanvasAgg(figure).draw()
    for legend in figure.legends:
        box = legend.get_window_extent()
        assert box.x0 >= 0.0
        assert box.x1 <= figure.bbox.x1
    return figure


def legend_of(figure):
    """Return the words of the legend of a figure."""
    return [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.fixture(scope="module")
def refined():
    """Return a refined map and its boundary."""
    told = {"restitution": 0.9, "levels": 2}
    return refined_map(BLOCK, PULSE, *AXES, **told), boundary(BLOCK, PULSE, *AXES, **told)


def test_refined_map(refined):
    """Each pixel has the class of the nearest point, every polyline is there, and the window shows its points."""
    points, lines = refined
    window = ((1.5, 4.0), (2.0, 5.0))
    figure = drawn(refined_map_picture(points, lines, window=window, title="a sine"))
    left, right = figure.axes
    assert len(left.lines) == len(lines)
    for line, shown in zip(lines, left.lines, strict=True):
        np.testing.assert_array_equal(np.column_stack(shown.get_data()), line.points)
    assert (right.get_xlim(), right.get_ylim()) == window
    assert "208 points of the map" in left.get_title(loc="left").replace("\n", " ")
    mesh = left.collections[0]
    colors = mesh.get_array().reshape(700, 700)
    wide = np.linspace(0.5, 8.0, 700), np.linspace(1.0, 10.0, 700)
    for k in np.random.default_rng(1).integers(points.modes.size, size=40):
        i, j = (int(np.abs(v - at).argmin()) for v, at in zip(wide, (points.x[k], points.y[k]), strict=True))
        near = np.hypot((points.x - wide[0][i]) / 0.5, (points.y - wide[1][j]) / 0.75)
        kind = {-2: 1, -1: 2, 0: 4, 1: 5}.get(int(points.modes[near.argmin()]), 6)
        assert colors[j, i] == kind
    assert "boundary, bisected" in legend_of(figure)


def test_refined_map_refuses(refined):
    """Nothing to outline, something else, and an empty window are refused."""
    points, lines = refined
    for given, words in (((points, []), "one or more polylines"), ((lines, lines), "must be of refined_map")):
        with pytest.raises(InvalidValueError, match=words):
            refined_map_picture(*given)
    with pytest.raises(InvalidValueError, match="window must be"):
        refined_map_picture(points, lines, window=((2.0, 1.0), (2.0, 5.0)))


@pytest.fixture(scope="module")
def cloudy():
    """Return a cloud of half sines in which all states occur."""
    random = np.random.default_rng(3)
    pulses = [
        rk.pulses.half_sine(a, t)
        for a, t in zip(random.uniform(2.0, 9.0, 80), random.uniform(0.2, 1.0, 80), strict=True)
    ]
    return fragility_analysis(BLOCK, pulses, restitution=0.9, im="pga", limit_states=(0.3,), analysis="cloud")


def test_cloud(cloudy):
    """Points and ticks are the motions by state; line and areas are those of the analysis."""
    figure = drawn(cloud_picture(cloudy))
    upper, lower = figure.axes
    rotation, over = cloudy.responses.rotation, cloudy.responses.overturned == 1.0
    clear = cloudy.responses.rocked & (rotation >= 0.01)
    words = legend_of(figure)
    counts = (int(clear.sum()), int(over.sum()), int((~clear & ~over).sum()))
    assert [f"{n}" for n in counts] == [text.rpartition(" ")[2] for text in words if ":" in text]
    assert min(counts[:2]) > 5
    line, dots = upper.lines[0], upper.lines[1]
    x, y = line.get_data()
    fitted = np.polyfit(np.log(cloudy.motion_levels[clear]), np.log(rotation[clear]), 1)
    np.testing.assert_allclose(np.log(y), np.polyval(fitted, np.log(x)), rtol=1e-9, atol=1e-9)
    assert sorted(dots.get_ydata()) == sorted(rotation[clear])
    assert f"scatter {cloudy.regression.scatter:.2f}" in upper.get_title(loc="left")
    areas = [each for each in lower.collections if isinstance(each, PolyCollection)]
    assert len(areas) == 4
    # the lowest area ends at the lognormal curve of overturning, the uppermost at one
    corners = areas[0].get_paths()[0].vertices
    edge = corners[(corners[:, 1] > 1e-6) & (corners[:, 0] > 0.25 * conventions.g)]  # where the ground lifts it
    fit = cloudy.fits["overturned"]
    curve = stats.norm.cdf(np.log(edge[:, 0] / fit.median) / fit.dispersion)
    np.testing.assert_allclose(edge[:, 1], curve, rtol=1e-9)
    assert not np.allclose(edge[:, 1], stats.norm.cdf(np.log(edge[:, 0] / (1.02 * fit.median)) / fit.dispersion))
    assert areas[-1].get_paths()[0].vertices[:, 1].max() == pytest.approx(1.0, abs=1e-12)


def test_cloud_refuses():
    """What is no cloud, and a cloud in which nothing falls, have no picture; the reason is the analysis' own."""
    with pytest.raises(InvalidValueError, match="must be of a cloud"):
        cloud_picture([1.0])
    weak = fragility_analysis(
        BLOCK, [rk.pulses.half_sine(a, 0.1) for a in (3.0, 3.5, 4.0, 4.5)], restitution=0.9, analysis="cloud"
    )
    with pytest.raises(InvalidValueError, match="no curve of overturning"):
        cloud_picture(weak)


def test_crossings_of_many():
    """Bars are the overturning stretches in g, lanes are by the least of the first panel, wrong counts are refused."""
    pulses = [rk.pulses.sine(3.0, period) for period in (0.5, 0.8, 0.65)]
    found = {f"r = {r}": [rk.minimum_overturning_acceleration(BLOCK, p, r) for p in pulses] for r in (0.85, 0.95)}
    figure = drawn(transitions_of_many_picture(found, ["0.5", "0.8", "0.65"], lane_title="period [s]"))
    first = figure.axes[0]
    assert [label.get_text() for label in first.get_yticklabels()] == ["0.8", "0.65", "0.5"]
    assert [panel.get_title(loc="left") for panel in figure.axes] == ["r = 0.85", "r = 0.95"]
    one = found["r = 0.85"][1]
    bars = [path.vertices[:, 0] for path in first.collections[1].get_paths()]
    shown = sorted((each.min() * conventions.g, each.max() * conventions.g) for each in bars)
    np.testing.assert_allclose(shown, one.overturning_intervals, rtol=1e-12)
    assert len(shown) == 2  # the block stands again between
    assert first.lines[0].get_xdata()[0] * conventions.g == pytest.approx(one.minimum, rel=1e-12, abs=0.0)
    cut = transitions_of_many_picture(found, ["a", "b", "c"], until=6.0)
    assert cut.axes[0].get_xlim()[1] * conventions.g == pytest.approx(6.0, rel=1e-12, abs=0.0)
    for names, words in ((["a"], "must have 1 Transitions"), ([], "1 to 60 lanes")):
        with pytest.raises(InvalidValueError, match=words):
            transitions_of_many_picture(found, names)


def test_difference_map():
    """Colours are the change of the peak where the body stands with both; flips are counted by hand."""
    block = rk.Block(width=0.5, height=1.0)
    found = map_sensitivity(block, PULSE, *AXES, ["housner", "ked", "horizontal-momentum"])
    figure = drawn(difference_map_picture(found, "ked"))
    before, after = (found.results[label] for label in ("housner", "ked"))
    stand = (before["mode"].values < 0) & (after["mode"].values < 0)
    panel = figure.axes[2]
    colors = panel.collections[1].get_array().reshape(stand.shape)
    np.testing.assert_array_equal(~np.ma.getmaskarray(colors), stand)
    change = after["peak_ratio"].values - before["peak_ratio"].values
    np.testing.assert_array_equal(colors[stand], change[stand])
    flips = int(((before["mode"].values >= 0) != (after["mode"].values >= 0)).sum())
    assert flips > 0
    assert f"{flips} of {stand.size} outcomes change" in panel.get_title(loc="left")
    assert "overturns with the choice only" in legend_of(figure)
    other = difference_map_picture(found, "horizontal-momentum").axes[2].collections[1].get_array()
    assert not np.ma.allequal(other.ravel(), colors.ravel())  # the control: another choice is another picture
    for given, words in (((found, "plastic-winkler"), "choice must be one of ked"), (([],), "Sensitivity of maps")):
        with pytest.raises(InvalidValueError, match=words):
            difference_map_picture(*given)


def test_inventory():
    """Each object has its light, its share with the interval and its uplift; the worst is on top."""
    objects = (
        InventoryObject(name="low chest", width=1.0, depth=1.0, height=0.5),
        InventoryObject(name="tall $5 vase", width=0.1, depth=0.1, height=0.8),
    )
    hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=20, seed=1)
    found = assess(Inventory(objects), hazard)
    figure = drawn(inventory_picture(found))
    left, right = figure.axes
    assert [label.get_text() for label in left.get_yticklabels()] == [r"tall \$5 vase", "low chest"]
    assert [text.get_text() for text in left.texts] == ["R", "G"]
    shares = [line.get_xdata()[0] for line in left.lines if line.get_marker() in {"s", "^", "o"}]
    assert shares == [verdict.worse.overturned_fraction for verdict in found.verdicts]
    lifted = [line.get_xdata()[0] for line in right.lines if line.get_marker() == "|"]
    np.testing.assert_allclose(lifted, [0.1 / 0.8, 2.0], rtol=1e-12)  # g b / h, in g
    assert any(line.get_xdata()[0] == Thresholds().overturning_red for line in left.lines)
    assert legend_of(figure)[:3] == ["R: red, 1", "A: amber, 0", "G: green, 1"]
    with pytest.raises(InvalidValueError, match="must be of an inventory"):
        inventory_picture(objects)


def test_record_sets():
    """Points are the peaks of the motions; the line of a set is the median of its spectra."""
    sets = {"far": SyntheticSet("point-source", 4, seed=1), "near": list(SyntheticSet("pulse-like", 3, seed=1))}
    figure = drawn(record_set_picture(sets, [0.2, 0.5, 1.0]))
    left, right = figure.axes
    assert sorted(left.lines[0].get_xdata()) == sorted(motion.peak for motion in sets["far"])
    spectra = [rk.motions.spectral_acceleration(motion, 0.5, 0.05) for motion in sets["near"]]
    assert right.lines[1].get_ydata()[1] == pytest.approx(sorted(spectra)[1], rel=1e-12, abs=0.0)
    assert legend_of(figure) == ["far: 4", "near: 3"]
    assert not math.isclose(right.lines[0].get_ydata()[1], right.lines[1].get_ydata()[1], rel_tol=1e-3)
    for given, words in (({}, "sets must be 1 to 6"), ({"pulse": [PULSE, PULSE]}, "must have two ground motions")):
        with pytest.raises(InvalidValueError, match=words):
            record_set_picture(given)


@pytest.mark.parametrize("count", [2, 6])
def test_no_axis_label_is_longer_than_its_axis(count, monkeypatch):
    """Long words are broken, however narrow the panel: no label is cut off or meets another; short ones stay."""
    name, words = "period", "period of the strongest pulse within the record of the ground [s]"
    axes = (name, [0.5, 1.0, 1.5, 2.0]), ("slenderness_ratio", [2.0, 3.0, 4.0, 5.0])
    found = map_sensitivity(BLOCK, PULSE, *axes, np.linspace(0.7, 0.95, count).tolist())
    monkeypatch.setitem(labels.SYMBOLS, name, words)
    figure = drawn(sensitivity_picture(found))
    panels = [panel for panel in figure.axes if panel.get_xlabel()]
    assert len(panels) == count
    for panel in panels:
        assert panel.xaxis.label.get_window_extent().width <= panel.bbox.width + 12.0
        assert panel.get_xlabel().split() == words.split()
    assert figure.axes[0].get_ylabel() == "slenderness h/b [-]"
