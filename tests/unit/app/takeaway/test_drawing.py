"""Long curves are drawn with fewer points, and look the same."""

import io

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from rocking.app.takeaway import drawing


def noise(samples):
    """Return a figure with one long, lively curve that has a spike of one sample."""
    values = np.random.default_rng(7).normal(size=samples)
    values[samples // 3] = 9.0
    figure = Figure(figsize=(7.0, 3.0))
    (line,) = figure.subplots().plot(np.linspace(0.0, 300.0, samples), values, linewidth=0.8)
    return figure, line


def raster(figure):
    """Return what is seen, in grey."""
    stream = io.BytesIO()
    figure.savefig(stream, format="raw", dpi=100)
    return np.frombuffer(stream.getvalue(), np.uint8).reshape(300, 700, 4)[..., :3].mean(axis=-1)


def test_a_long_curve_is_thinned_and_keeps_its_spike(tmp_path):
    """60,000 samples become 10,802 at most, four for each of 2,700 dots; the extremes, the first and the last stay."""
    figure, line = noise(60_000)
    before = line.get_ydata().copy()
    drawing.draw_to(lambda: figure, tmp_path / "a.png")
    after = line.get_ydata()
    assert after.size <= 4 * 2700 + 2
    assert (after.max(), after.min(), after[0], after[-1]) == (9.0, before.min(), before[0], before[-1])


def test_the_picture_is_the_same_to_the_eye(tmp_path):
    """Fewer than one dot in a hundred differs visibly; without every other run many more do (negative control)."""
    with mpl.rc_context({"path.simplify": False}):
        whole = raster(noise(60_000)[0])
        figure, _ = noise(60_000)
        drawing.draw_to(lambda: figure, tmp_path / "a.png")
        figure.set_size_inches(7.0, 3.0)
        thin = raster(figure)
        crude, line = noise(60_000)
        line.set_data(line.get_xdata()[::20], line.get_ydata()[::20])
        cruder = raster(crude)
    assert (np.abs(thin - whole) > 64.0).mean() < 0.01
    assert (np.abs(cruder - whole) > 64.0).mean() > 0.05


def test_short_curves_and_those_that_go_back_are_left_alone(tmp_path):
    """A thousand samples, and a closed outline of any length, are drawn as they are."""
    figure, line = noise(1000)
    angle = np.linspace(0.0, 2.0 * np.pi, 20_000)
    (ring,) = figure.axes[0].plot(np.cos(angle), np.sin(angle))
    drawing.draw_to(lambda: figure, tmp_path / "a.png")
    assert (line.get_xdata().size, ring.get_xdata().size) == (1000, 20_000)
