"""Pictures of rocking spectra: curves, fractiles, overturning and sizes against the data and closed forms."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.plots import rocking_spectrum_picture
from rocking.plots.rocking_spectrum import fractiles
from rocking.studies import rocking_spectrum

G = 9.80665
PERIODS = np.geomspace(0.8, 12.0, 40)
ANGLES = [0.15, 0.2, 0.3]


@pytest.fixture(scope="module")
def one():
    """Spectra of one pulse."""
    return rocking_spectrum(rk.pulses.sine(5.0, 0.8), ANGLES, PERIODS, 0.9)


@pytest.fixture(scope="module")
def many():
    """Spectra of five pulses."""
    pulses = [rk.pulses.sine(5.0, period) for period in (0.4, 0.6, 0.8, 1.0, 1.2)]
    return rocking_spectrum(pulses, ANGLES, np.linspace(1.0, 9.0, 30), 0.9)


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
    assert lower.get_ylabel() == "share over-\nturned [-]"
    for place, line in enumerate(lower.lines):
        np.testing.assert_allclose(
            line.get_ydata(), (many["mode"].values[:, place] >= 0).sum(axis=0) / 5.0, rtol=0.0, atol=1e-15
        )
    assert "5 motions" in figure.get_suptitle()


def test_nothing_lifts():
    """A pulse below g tan(alpha) gives a picture of zeros, without warnings."""
    made = rocking_spectrum(rk.pulses.sine(0.5, 0.8), [0.2], [2.0, 3.0, 4.0, 5.0], 0.9)
    figure = rocking_spectrum_picture(made)
    FigureCanvasAgg(figure).draw()
    assert not np.any(_curves(figure.axes[0])["0.2"][1])
    assert figure.axes[0].get_ylim()[1] > 0.0


@pytest.mark.parametrize("bad", ["spectrum", None, 1.0])
def test_no_spectrum(bad):
    """What is no spectrum is refused in words."""
    with pytest.raises(InvalidValueError, match="found must be of rocking_spectrum"):
        rocking_spectrum_picture(bad)
