"""Pictures of the sensitivity to the restitution: flips, curves and words against counts by hand."""

import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import sensitivity_picture
from rocking.studies.sensitivity import fragility_sensitivity, map_sensitivity, sensitivity, spectrum_sensitivity

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
        assert axes[3 + place].get_title(loc="left").startswith(f"{count} of 480 flip ({100.0 * count / 480:.3g} %)")
        assert count > 0
    assert axes[0].get_xlabel() == r"$\omega_p\,/\,p$ [-]"
    words = [text.get_text() for text in axes[3].get_legend().get_texts()]
    assert {"flips to overturned", "flips to standing", "not lifted"} <= set(words)
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
        assert panel.get_title(loc="left").endswith(f"flips {flips[0]}, {flips[1]} of 75")
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
    with pytest.raises(InvalidValueError, match="a picture of maps, spectra and fragility"):
        sensitivity_picture(sensitivity(lambda restitution: row[restitution], ["ked", "housner"]))
