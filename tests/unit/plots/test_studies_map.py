"""Pictures of overturning maps: regions, words, boundary and contours against the data and closed forms."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import overturning_map_picture, write
from rocking.plots.labels import axis_label, geometric, plain, wrapped
from rocking.plots.map_labels import FINE, place_in, rastered
from rocking.plots.overturning_map import CLASSES, FIRST, ISLAND, ROCKED, SECOND, classes_of
from rocking.studies import boundary, overturning_map
from rocking.studies.boundaries import Polyline

pytestmark = pytest.mark.slow

BLOCK = rk.Block.from_angle(0.2, 1.0)
PULSE = rk.pulses.sine(1.0, 1.0)
X = ("frequency_ratio", np.linspace(0.5, 8.0, 60))
Y = ("amplitude_ratio", np.linspace(0.5, 12.0, 55))


@pytest.fixture(scope="module")
def found():
    """A map with all common regions."""
    return overturning_map(BLOCK, PULSE, X, Y, 0.9)


@pytest.fixture(scope="module")
def lines():
    """Its boundary."""
    return boundary(BLOCK, PULSE, X, Y, 0.9)


@pytest.fixture(scope="module")
def figure(found, lines):
    """The picture of both."""
    return overturning_map_picture(found, lines)


def _grey(color):
    return float(np.dot(to_rgb(color), (0.2126, 0.7152, 0.0722)))


def _boxes(figure):
    """Extents of the words within the panel, in pixels."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    texts = [text for text in figure.axes[0].texts if text.get_text()]
    return {text.get_text(): text.get_window_extent(canvas.get_renderer()) for text in texts}


def test_labels_and_image(found, figure):
    """Axes have symbols and units; every pixel of the image has the class of its cell; the words say what moves."""
    axes = figure.axes[0]
    assert axes.get_xlabel() == r"$\omega_p\,/\,p$ [-]"
    assert axes.get_ylabel() == r"$a_p\,/\,(g\,\tan\,\alpha)$ [-]"
    assert "sine pulse" in axes.get_title(loc="left")
    assert "restitution 0.9" in axes.get_title(loc="left")
    drawn = np.asarray(axes.collections[0].get_array()).reshape(found["mode"].shape)
    mode = found["mode"].values
    assert (drawn == FIRST).sum() == (mode == 0).sum() > 100
    assert (drawn == SECOND).sum() == (mode == 1).sum() > 100
    assert ((drawn == ROCKED) | (drawn == ISLAND)).sum() == (mode == -1).sum() > 100


def test_boundary_is_the_closed_form():
    """The drawn boundary of a half sine (linear) passes Omega = 2 at A = 1.8007239305607457817."""
    body = rk.Block.from_angle(0.01, 1.0)
    axes_of = ("frequency_ratio", [1.0, 2.0, 3.0]), ("amplitude_ratio", [1.2, 1.7, 2.2, 2.7, 3.2])
    pulse = rk.pulses.half_sine(1.0, 1.0)
    # a half sine lasts half of its period, whose circular frequency is omega
    options = {"linear": True}
    drawn = overturning_map(body, pulse, *axes_of, 0.9, **options)
    panel = overturning_map_picture(drawn, boundary(body, pulse, *axes_of, 0.9, **options)).axes[0]
    assert panel.get_ylabel() == r"$a_p\,/\,(g\,\alpha)$ [-]"
    points = np.concatenate([np.asarray(line.get_data()).T for line in panel.lines])
    (height,) = points[np.isclose(points[:, 0], 2.0, rtol=1e-12), 1]
    assert height == pytest.approx(1.8007239305607457817, rel=1e-8)
    # negative control: the threshold g tan alpha in place of g alpha would be off by more than this check allows
    assert 1.8007239305607457817 * math.tan(0.01) / 0.01 != pytest.approx(height, rel=1e-8)


def test_words_lie_in_their_regions(found, figure):
    """Each region that is named has only its own class under the words, and no two words overlap."""
    boxes = _boxes(figure)
    axes, kinds = figure.axes[0], classes_of(found)
    named = {"overturns without impact": FIRST, "after 1 impact": SECOND, "rocks, does not overturn": ROCKED}
    present = {words: named[told] for words in boxes if (told := words.replace("\n", " ")) in named}
    assert len(present) >= 2
    for words, kind in present.items():
        corners = axes.transData.inverted().transform(boxes[words].get_points())
        columns = np.searchsorted(X[1], corners[:, 0])
        rows = np.searchsorted(Y[1], corners[:, 1])
        under = kinds[rows[0] : rows[1], columns[0] : columns[1]]
        assert under.size > 0
        assert (under == kind).all()
    every = list(boxes.values())
    assert not any(a.overlaps(b) for k, a in enumerate(every) for b in every[:k])


def test_regions_that_are_too_small_are_in_the_legend(figure):
    """What has no room for words is named below the panel; nothing is named twice."""
    below = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    within = {text.get_text().replace("\n", " ") for text in figure.axes[0].texts}
    assert "no uplift" in below or "no uplift" in within
    assert not set(below) & within


def test_regions_are_apart_in_grey():
    """Standing is lighter than overturned, and every way to overturn has its own grey."""
    over = [_grey(CLASSES[kind][1]) for kind in (FIRST, SECOND, 6)]
    assert _grey(CLASSES[ROCKED][1]) > max(over) + 0.19
    assert min(abs(a - b) for k, a in enumerate(over) for b in over[:k]) > 0.1


def test_contours_are_those_of_the_peak(found):
    """Along the drawn line of 0.5 the peak rotation of the map, interpolated, is 0.5."""
    from scipy.interpolate import RegularGridInterpolator

    axes = overturning_map_picture(found, contours=(0.5,)).axes[0]
    (line,) = (part for part in axes.collections if hasattr(part, "levels") and list(part.levels) == [0.5])
    vertices = np.concatenate([path.vertices for path in line.get_paths()])
    peak = RegularGridInterpolator((Y[1], X[1]), found["peak_ratio"].values)(vertices[:, ::-1])
    # on lines of the grid both interpolations are linear; across corners that overturned they are not
    on_grid = [np.isclose(v[:, None], a, rtol=1e-12).any(axis=1) for v, a in zip(vertices.T, (X[1], Y[1]), strict=True)]
    chosen = on_grid[0] | on_grid[1]
    assert chosen.sum() > 40
    np.testing.assert_allclose(peak[chosen], 0.5, rtol=0.0, atol=1e-9)


def test_log_axes_and_files(tmp_path):
    """Values in equal ratios are drawn on a log axis, with plain numbers; a file holds the words of the labels."""
    axes_of = ("semi_diagonal", np.geomspace(0.3, 5.0, 20)), ("slenderness_angle", np.linspace(0.1, 0.4, 15))
    made = overturning_map(rk.Block(width=0.5, height=2.0), rk.pulses.sine(5.0, 0.8), *axes_of)
    figure = overturning_map_picture(made)
    assert (figure.axes[0].get_xscale(), figure.axes[0].get_yscale()) == ("log", "linear")
    assert figure.axes[0].get_xlabel() == "semi-diagonal R [m]"
    assert "semi-diagonal R [m]" in write(figure, tmp_path / "a.svg").read_text(encoding="utf-8")


def test_failed_cells_are_black():
    """A point that could not be computed is drawn as such, not as a verdict."""
    axes_of = ("frequency_ratio", [1.0, 2.0, 3.0]), ("restitution", [0.5, 0.9])
    made = overturning_map(BLOCK, rk.pulses.sine(4.0, 1.0), *axes_of)
    made["mode"][0, 1] = -3
    assert classes_of(made)[0, 1] == 0
    words = [t.get_text() for legend in overturning_map_picture(made).legends for t in legend.get_texts()]
    words += [t.get_text() for t in overturning_map_picture(made).axes[0].texts]
    assert any("not computed" in word.replace("\n", " ") for word in words)


def test_refusals(found):
    """What is no map, a boundary along other axes, and a map of one row are refused in words."""
    other = [Polyline(np.ones((2, 2)), np.zeros((2, 2), int), "overturned", ("frequency_ratio", "scale"))]
    for given, words in (
        *((([bad]), "results must be a map") for bad in ("map", None, 3.0)),
        ((found, other), "boundary must be along frequency_ratio and amplitude_ratio"),
        ((found.isel(amplitude_ratio=[0]),), "two or more values"),
    ):
        with pytest.raises(InvalidValueError, match=words):
            overturning_map_picture(*given)


def test_place_in_a_disc():
    """Words go to the centre of a disc, break where it is narrow, and are left out where there is no room."""
    rows, columns = np.mgrid[0 : FINE[0], 0 : FINE[1]]
    disc = (rows - 120) ** 2 + (columns - 150) ** 2 < 80**2
    place = place_in(disc, "words", (3.0, 2.4))
    assert place.text == "words"
    # centre of a pixel grid: half a pixel of 240 or 300
    assert (place.x, place.y) == pytest.approx((0.5, 0.5), abs=0.01)
    assert place_in(disc, "many words that are long together", (3.0, 2.4)).text.count("\n") >= 1
    assert place_in(disc, "many words that are long together" * 5, (3.0, 2.4)) is None
    assert place_in(np.zeros(FINE, bool), "words", (3.0, 2.4)) is None


def test_raster_takes_the_nearest():
    """Each pixel has the value of the nearest point, so uneven spacing shows as uneven cells."""
    fine = rastered(np.array([[1, 2, 3]]), np.array([0.0, 1.0, 5.0]), np.array([1.0]))
    # cells from -0.5 to 0.5, 3 and 7 of 7.5 in all
    assert [(fine[0] == k).mean() for k in (1, 2, 3)] == pytest.approx([1 / 7.5, 2.5 / 7.5, 4 / 7.5], abs=1 / 300)


def test_words():
    """Labels have units, odd names are drawn as they are, long words are broken."""
    assert axis_label("sa(0.5)", "m/s2") == "Sa(0.5 s) [m/s$^2$]"
    assert axis_label("strange", "") == "strange [-]"
    assert plain("a\n$x$") == r"a \$x\$"
    assert wrapped("one two three four", 9, 2) == "one two\nthree ..."
    assert geometric(np.geomspace(1.0, 9.0, 5))
    assert not geometric(np.linspace(1.0, 9.0, 5))
    assert not geometric(np.array([-1.0, 1.0, 3.0]))


def test_the_title_leaves_out_what_the_axes_vary():
    """Amplitude and period of the base motion stand in the title only where no axis varies them."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    ratios, angles = [1.0, 2.0], [0.2, 0.3]
    for axes, words in (
        ((("frequency_ratio", ratios), ("amplitude_ratio", ratios)), "sine pulse;"),
        ((("pga", ratios), ("slenderness_angle", angles)), "sine pulse, 0.6 s;"),
        ((("period", ratios), ("slenderness_angle", angles)), "sine pulse, 3 m/s$^2$;"),
        ((("semi_diagonal", ratios), ("slenderness_angle", angles)), "sine pulse, 3 m/s$^2$, 0.6 s;"),
    ):
        figure = overturning_map_picture(overturning_map(block, pulse, *axes, 0.9))
        assert figure.axes[0].get_title(loc="left").startswith(words)
