"""The picture of a ground motion: exact curves and peaks, the spectrum with its asymptote, and no text over text."""

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg

from rocking.motions import GroundMotion, peak_ground_displacement, peak_ground_velocity, pulses
from rocking.plots import ground_motion_picture
from rocking.plots.labels import fine_samples, traces

pytestmark = pytest.mark.slow

G = 9.80665
AMPLITUDE, PERIOD = 3.0, 0.8
W = 2.0 * math.pi / PERIOD


def _made_up(samples=400, vertical=True):
    time = np.arange(samples) * 0.02
    row = np.sin(9.0 * time) * np.exp(-time) + 0.3 * np.sin(40.0 * time)
    return GroundMotion(row, 0.02, 0.4 * row[::-1] if vertical else None, name="made up, 100 $ for nothing")


def test_pulse_is_drawn_from_its_formulas():
    """a sin(wt), a (1 - cos wt)/w, a (t - sin(wt)/w)/w; peaks at (T/4, a), (T/2, 2a/w) and (T, aT/w) are marked."""
    rows = (
        (lambda t: AMPLITUDE * np.sin(W * t), PERIOD / 4, AMPLITUDE, "PGA 3 m/s$^2$ = 0.306 g at 0.2 s"),
        (lambda t: AMPLITUDE / W * (1.0 - np.cos(W * t)), PERIOD / 2, 2 * AMPLITUDE / W, "PGV 0.764 m/s at 0.4 s"),
        (lambda t: AMPLITUDE / W * (t - np.sin(W * t) / W), PERIOD, AMPLITUDE * PERIOD / W, "PGD 0.306 m at 0.8 s"),
    )
    for axes, (curve, at, peak, title) in zip(
        ground_motion_picture(pulses.sine(AMPLITUDE, PERIOD)).axes[:3], rows, strict=True
    ):
        x, y = max((line.get_data() for line in axes.lines), key=lambda pair: len(pair[0]))
        np.testing.assert_allclose(y, curve(np.asarray(x)), rtol=0.0, atol=1e-12)
        assert len(x) > 500
        (mark,) = (line for line in axes.lines if line.get_marker() == "o")
        # a top that is flat to the third order is found in value to rounding, in time to the cube root of it
        assert mark.get_xdata()[0] == pytest.approx(at, rel=1e-5)
        assert mark.get_ydata()[0] == pytest.approx(peak)
        assert axes.get_title(loc="right") == title


def test_peak_inside_a_step():
    """1, -1 at 1 s: the velocity peaks at 0.25 m/s in the middle of the step, where there is no sample."""
    at, value = traces(GroundMotion([1.0, -1.0], 1.0)).peaks["velocity"]
    assert (at, value) == (0.5, 0.25)
    # negative control: the samples alone, 0 and 0, would miss it
    assert traces(GroundMotion([1.0, -1.0], 1.0)).velocity[[0, -1]].tolist() == [0.0, 0.0]


@settings(max_examples=15)
@given(st.lists(st.floats(-5.0, 5.0, width=32), min_size=2, max_size=30), st.sampled_from([0.01, 0.3]))
def test_peaks_are_those_of_the_intensity_measures(values, step):
    """Marked peaks equal PGV and PGD to rounding, lie within the motion, and no drawn point exceeds them."""
    motion = GroundMotion(values, step)
    curves = traces(motion)
    for name, largest in (
        ("acceleration", motion.peak),
        ("velocity", peak_ground_velocity(motion)),
        ("displacement", peak_ground_displacement(motion)),
    ):
        at, value = curves.peaks[name]
        scale = 10.0 * motion.duration ** {"acceleration": 0, "velocity": 1, "displacement": 2}[name]
        assert abs(value) == pytest.approx(largest, rel=1e-9, abs=1e-12 * scale)
        assert 0.0 <= at <= motion.duration + 1e-12
        assert np.abs(getattr(curves, name)).max() <= abs(value) + 1e-12 * scale


def test_spectrum_ends_in_the_peak_acceleration():
    """PSA in g at the shortest period is within 2 % of the PGA of a smooth pulse, and the dashed line is the PGA."""
    axes = ground_motion_picture(pulses.ricker(2.0, 0.5)).axes[3]
    dashed, curve = axes.lines
    assert dashed.get_ydata()[0] == pytest.approx(2.0 / G)
    # at T = 0.02 s the oscillator still adds (T/T_p)^2-sized dynamics to a pulse of 0.5 s
    assert curve.get_ydata()[0] == pytest.approx(2.0 / G, rel=0.02)
    assert axes.get_xscale() == "log"
    # negative control: a jump is felt by the stiffest oscillator with almost twice its size
    jump = ground_motion_picture(pulses.rectangular(2.0, 0.5)).axes[3].lines[1].get_ydata()[0]
    assert jump == pytest.approx(2.0 / G * (1.0 + math.exp(-0.05 * math.pi / math.sqrt(1.0 - 0.05**2))), rel=1e-3)


@pytest.mark.parametrize(
    "motion", [_made_up(), _made_up(30, vertical=False), pulses.cosine(1.0, 0.5), pulses.ricker(1e-3, 40.0)]
)
@pytest.mark.parametrize("spectrum", [True, False])
def test_labels_have_units_and_nothing_overlaps(motion, spectrum):
    """Every label ends in a unit, and no two titles, labels or legends of the drawn figure touch."""
    figure = ground_motion_picture(motion, spectrum)
    assert len(figure.axes) == (4 if spectrum else 3)
    FigureCanvasAgg(figure).draw()
    shown = [figure._suptitle]
    for axes in figure.axes:
        assert axes.get_ylabel().endswith("]")
        shown += [axes.yaxis.label, axes.xaxis.label, axes._right_title, axes.get_legend()]
    assert figure.axes[2].get_xlabel() == "time [s]"
    boxes = [one.get_window_extent() for one in shown if one is not None and getattr(one, "_text", "x")]
    for first, second in combinations(boxes, 2):
        assert not first.overlaps(second)
    whole = figure.bbox
    assert all(box.x0 >= whole.x0 and box.x1 <= whole.x1 and box.y1 <= whole.y1 for box in boxes)


def test_vertical_part_is_drawn_with_a_legend():
    """A vertical part stands behind the horizontal one and is named; without it there is no legend."""
    motion = _made_up()
    top = ground_motion_picture(motion, spectrum=False).axes[0]
    assert [text.get_text() for text in top.get_legend().get_texts()] == ["vertical", "horizontal"]
    behind = next(line for line in top.lines if line.get_label() == "vertical")
    assert np.asarray(behind.get_ydata()).tolist() == motion.vertical.tolist()
    assert ground_motion_picture(_made_up(vertical=False), spectrum=False).axes[0].get_legend() is None


def test_fine_samples_of_a_pulse():
    """Cut finely, a cosine keeps its jumps at both ends and its integral; a record stays what it is."""
    fine = fine_samples(pulses.cosine(1.0, 0.5))
    assert fine.acceleration[[0, -1]].tolist() == pytest.approx([1.0, 1.0])
    assert fine.duration == pytest.approx(0.5)
    record = _made_up()
    assert fine_samples(record) is record
