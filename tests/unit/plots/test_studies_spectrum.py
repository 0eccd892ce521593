"""Pictures of rocking spectra and sensitivity: curves, fractiles, sizes against data and closed forms."""

import math
import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import rocking_spectrum_picture, sensitivity_picture
from rocking.plots.rocking_spectrum import fractiles
from rocking.studies.sensitivity import fragility_sensitivity, map_sensitivity, sensitivity, spectrum_sensitivity

pytestmark = pytest.mark.slow

G = 9.80665
PERIODS = np.geomspace(0.8, 12.0, 40)
ANGLES = [0.15, 0.2, 0.3]


@pytest.fixture(scope="module")
def one():
    """Spectra of one pulse."""
    return rk.rocking_spectrum(rk.pulses.sine(5.0, 0.8), ANGLES, PERIODS, 0.9)


@pytest.fixture(scope="module")
def many():
    """Spectra of five pulses."""
    pulses = [rk.pulses.sine(5.0, period) for period in (0.4, 0.6, 0.8, 1.0, 1.2)]
    return rk.rocking_spectrum(pulses, ANGLES, np.linspace(1.0, 9.0, 30), 0.9)


@pytest.fixture(scope="module")
def pictures(one, many):
    """Their pictures."""
    return {"one": rocking_spectrum_picture(one), "many": rocking_spectrum_picture(many)}


def _curves(axes):
    return {line.get_label(): line.get_data() for line in axes.lines if not line.get_label().startswith("_")}


def test_curves_are_the_peaks(one, pictures):
    """Each curve is the peak rotation where the block stands, with a gap where it overturned."""
    upper, lower = pictures["one"].axes[:2]
    assert upper.get_ylabel() == r"peak rotation $\theta\,/\,\alpha$ [-]"
    assert lower.get_xlabel() == r"$2\pi\,/\,p$ [s]"
    for place, alpha in enumerate(ANGLES):
        period, peak = _curves(upper)[f"{alpha:.3g}"]
        stands = one["mode"].values[0, place] < 0
        np.testing.assert_array_equal(period, PERIODS)
        np.testing.assert_array_equal(np.isfinite(peak), stands)
        np.testing.assert_array_equal(peak[stands], one["peak_ratio"].values[0, place, stands])
        assert 0 < stands.sum() < stands.size


def test_bars_cover_what_overturned(one, pictures):
    """A size is under the bar of its slenderness if and only if the block of that size overturned."""
    lower = pictures["one"].axes[1]
    assert "overturns" in lower.get_ylabel()
    for place, bars in enumerate(lower.collections):
        spans = [path.get_extents() for path in bars.get_paths()]
        covered = [any(span.x0 <= t <= span.x1 for span in spans) for t in PERIODS]
        assert covered == (one["mode"].values[0, place] >= 0).tolist()


def test_size_above(pictures):
    """The axis above says R = 3 g / (4 p^2): a period of 4 s is a semi-diagonal of 3 g / pi^2."""
    figure = pictures["one"]
    FigureCanvasAgg(figure).draw()
    upper = figure.axes[0]
    (above,) = upper.child_axes
    assert above.get_xlabel() == "semi-diagonal R [m]"
    place = upper.transData.transform((4.0, 0.0))[0]
    assert above.transData.inverted().transform((place, 0.0))[0] == pytest.approx(3.0 * G / math.pi**2, rel=1e-9)


def test_fractiles_count_overturning_as_beyond(many):
    """Median and band are of all motions, overturned ones above all rotations (sorted by hand)."""
    modes, peaks = many["mode"].values[:, 1], many["peak_ratio"].values[:, 1]
    values = np.where(modes >= 0, math.inf, peaks)
    for share, got in zip((0.16, 0.5, 0.84), fractiles(many, 1), strict=True):
        below = int(4.0 * share)
        part = 4.0 * share - below
        wanted = []
        for column in values.T.tolist():
            low, high = sorted(column)[below], sorted(column)[min(below + 1, 4)]
            wanted.append(low if part == 0.0 else math.nan if math.isinf(high) else (1.0 - part) * low + part * high)
        wanted = np.where(np.isinf(wanted), np.nan, wanted)
        np.testing.assert_allclose(got, wanted, rtol=1e-12)
    # negative control: leaving out what overturned gives a lower median
    standing = np.array([np.median(c[np.isfinite(c)]) if np.isfinite(c).any() else np.nan for c in values.T])
    assert np.nanmin(standing - fractiles(many, 1)[1]) < -1e-3


def test_failed_histories_count_nowhere(many):
    """A history that failed is left out of the fractiles, and of the share that overturned."""
    made = many.copy(deep=True)
    made["mode"][0] = -3
    less = many.isel(motion=slice(1, None))
    for got, wanted in zip(fractiles(made, 0), fractiles(less, 0), strict=True):
        np.testing.assert_array_equal(got, wanted)
    shares = [rocking_spectrum_picture(each).axes[1].lines[0].get_ydata() for each in (made, less)]
    np.testing.assert_array_equal(*shares)


def test_shares_of_many(many, pictures):
    """Below the curves stands the share of the motions that overturned each block; equal steps have a linear axis."""
    figure = pictures["many"]
    lower = figure.axes[1]
    assert (pictures["one"].axes[1].get_xscale(), lower.get_xscale()) == ("log", "linear")
    assert lower.get_ylabel() == "fraction over-\nturned [-]"
    for place, line in enumerate(lower.lines):
        np.testing.assert_allclose(
            line.get_ydata(), (many["mode"].values[:, place] >= 0).sum(axis=0) / 5.0, rtol=0.0, atol=1e-15
        )
    assert "5 motions" in figure.get_suptitle()


def test_nothing_lifts():
    """A pulse below g tan(alpha) gives a picture of zeros, without warnings."""
    made = rk.rocking_spectrum(rk.pulses.sine(0.5, 0.8), [0.2], [2.0, 3.0, 4.0, 5.0], 0.9)
    figure = rocking_spectrum_picture(made)
    FigureCanvasAgg(figure).draw()
    assert not np.any(_curves(figure.axes[0])["0.2"][1])
    assert figure.axes[0].get_ylim()[1] > 0.0


@pytest.mark.parametrize("bad", ["spectrum", None, 1.0])
def test_no_spectrum(bad):
    """What is no spectrum is refused in words."""
    with pytest.raises(InvalidValueError, match="results must be of rocking_spectrum"):
        rocking_spectrum_picture(bad)


BLOCK = rk.Block(width=0.4, height=1.2)
CHOICES = ["housner", "ked", "horizontal-momentum"]
PULSES = [rk.pulses.sine(6.0, period) for period in (0.3, 0.45, 0.6, 0.75, 0.9)]


@pytest.fixture(scope="module")
def maps():
    """A map with three models."""
    x, y = ("frequency_ratio", np.linspace(0.5, 8.0, 24)), ("amplitude_ratio", np.linspace(0.8, 12.0, 20))
    return map_sensitivity(BLOCK, rk.pulses.sine(1.0, 1.0), x, y, CHOICES)


def test_maps_and_flips(maps):
    """Every choice has its map; below it the cells whose verdict differs, counted by hand, with their number."""
    figure = sensitivity_picture(maps)
    axes = figure.axes
    assert [panel.get_title(loc="left") for panel in axes[:3]] == CHOICES
    over = {label: maps.results[label]["mode"].values >= 0 for label in CHOICES}
    for place, label in enumerate(CHOICES[1:], start=1):
        drawn = np.asarray(axes[3 + place].collections[-1].get_array()).reshape(over[label].shape)
        np.testing.assert_array_equal(drawn, over[label].astype(int) - over["housner"].astype(int))
        count = int((over[label] != over["housner"]).sum())
        assert axes[3 + place].get_title(loc="left").startswith(f"{count} of 480 change ({100.0 * count / 480:.3g} %)")
        assert count > 0
    assert axes[0].get_xlabel() == r"$\omega_p\,/\,p$ [-]"
    words = [text.get_text() for text in axes[3].get_legend().get_texts()]
    assert {"changes to overturned", "changes to not overturned", "no uplift"} <= set(words)
    FigureCanvasAgg(figure).draw()


def test_widths(maps):
    """Two choices fit a column, three take two columns."""
    two = sensitivity(lambda restitution: maps.results[restitution], ["housner", "ked"])
    assert sensitivity_picture(two).get_figwidth() * 25.4 == pytest.approx(90.0)
    assert sensitivity_picture(maps).get_figwidth() * 25.4 == pytest.approx(190.0)


def test_spectra():
    """Every slenderness has a panel with a curve for each choice and the number of flips."""
    found = spectrum_sensitivity(PULSES, [0.15, 0.25], np.geomspace(1.0, 8.0, 15), CHOICES)
    figure = sensitivity_picture(found)
    assert len(figure.axes) == 2
    modes = {label: found.results[label]["mode"].values >= 0 for label in CHOICES}
    for place, panel in enumerate(figure.axes):
        flips = [int((modes[c][:, place] != modes["housner"][:, place]).sum()) for c in CHOICES[1:]]
        assert panel.get_title(loc="left").endswith(f"changes {flips[0]}, {flips[1]} of 75")
        assert len(panel.lines) == 3
    assert figure.axes[-1].get_xlabel() == r"$2\pi\,/\,p$ [s]"
    assert "median" in figure.get_supylabel()


def test_fragility():
    """Curves of all choices stand over their points, with the medians in the title."""
    found = fragility_sensitivity(BLOCK, PULSES, np.arange(2.0, 16.1, 2.0), CHOICES, repetitions=0)
    figure = sensitivity_picture(found)
    assert len(figure.axes) == len(found.states) == 2
    last = figure.axes[-1]
    assert last.get_title(loc="left").startswith("overturned: medians ")
    assert last.get_xlabel() == "peak ground acceleration [m/s$^2$]"
    points = [line for line in last.lines if len(line.get_xdata()) == 8]
    for line, label in zip(points, CHOICES, strict=True):
        np.testing.assert_allclose(line.get_ydata(), found.results[label].counts["overturned"] / 5.0)
    FigureCanvasAgg(figure).draw()


def test_ratios_of_medians_come_from_the_same_motions():
    """Over fragility curves stand ratios of medians to the baseline's, their interval, and bands."""
    found = fragility_sensitivity(BLOCK, PULSES, np.arange(2.0, 16.1, 2.0), CHOICES, repetitions=200)
    last = sensitivity_picture(found).axes[-1]
    told = last.get_title(loc="left").partition("ratios of medians ")[2]
    ratios = [float(word) for word in re.findall(r"[\d.]+", told)]
    medians = [found.results[label].fits["overturned"].median for label in CHOICES]
    row = found.summary()[1]
    ends = [row[f"overturned: median ratio {end}"] for end in ("low", "high")]
    np.testing.assert_allclose(ratios[:3], [medians[1] / medians[0], *ends], rtol=5e-3)  # three digits are printed
    assert ends[0] < ends[1]
    assert len(last.collections) == len(CHOICES)


def test_refusals(maps):
    """No comparison, too many choices, and studies without a picture are refused in words."""
    with pytest.raises(InvalidValueError, match="must be a Sensitivity"):
        sensitivity_picture("maps")
    many = {f"r = {r}": r for r in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)}
    with pytest.raises(InvalidValueError, match="2 to 6 choices, got 7"):
        sensitivity_picture(sensitivity(lambda restitution: maps.results["ked"], many))
    row = {name: maps.results[name].isel(frequency_ratio=0) for name in ("ked", "housner")}
    with pytest.raises(InvalidValueError, match="maps, spectra and fragility"):
        sensitivity_picture(sensitivity(lambda restitution: row[restitution], ["ked", "housner"]))
