"""Pictures of responses in the plane, with contact and in space: what is drawn is what the response says."""

import math
from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

import rocking as rk
from rocking.bodies import Block
from rocking.dynamics import SpatialStart, free_rocking, simulate
from rocking.dynamics.plane_frictional import Regime, friction_demand
from rocking.dynamics.rolling import SpatialBody
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.motions import GroundMotion
from rocking.plots import (
    ground_motion_picture,
    overturning_map_picture,
    regime_map_picture,
    regimes_picture,
    response_picture,
    spatial_picture,
    transitions_picture,
    write,
)
from rocking.plots.response import ground_displacement_at, shown_until, velocity_at

G = 9.80665
BLOCK = Block(width=0.5, height=2.0)
ALPHA, RADIUS = math.atan(0.25), 0.5 * math.hypot(0.5, 2.0)
P = math.sqrt(3.0 * G / (4.0 * RADIUS))
SHARE, R = 0.6, 0.9


def _noise(name="made up", vertical=False):
    time = np.arange(500) * 0.02
    row = 2.6 * np.sin(5.0 * time) * np.exp(-0.3 * time) + 0.3 * np.sin(31.0 * time)
    return GroundMotion(row, 0.02, -2.0 * G * (time == 1.0) if vertical else None, name=name)


@pytest.fixture(scope="module")
def linear():
    """Slender-linear free rocking from 0.6 alpha: every curve is a hyperbolic cosine."""
    return free_rocking(BLOCK, SHARE * ALPHA, R, linear=True)


@pytest.fixture(scope="module")
def panels(linear):
    """The panels of its picture."""
    return response_picture(linear).axes


def _line(axes, label=None):
    """Data of the line with this label, or of the longest one."""
    if label is None:
        return max((line.get_data() for line in axes.lines), key=lambda pair: len(pair[0]))
    (line,) = (line for line in axes.lines if line.get_label().startswith(label))
    return line.get_data()


def _swings():
    """Times and speeds of the first three impacts by closed form: cosh(p t) = 1 / (1 - theta / alpha)."""
    share, found, time = SHARE, [], 0.0
    for k in range(3):
        time += (1.0 if k == 0 else 2.0) * math.acosh(1.0 / (1.0 - share)) / P
        speed = P * ALPHA * math.sqrt(1.0 - (1.0 - share) ** 2)
        found.append((time, speed))
        share = 1.0 - math.sqrt(1.0 - (R * speed / (P * ALPHA)) ** 2)
    return found


def test_rotation_and_velocity_are_the_closed_form(panels):
    """Until the first impact rotation / alpha is 1 - 0.4 cosh(pt), and the velocity -0.4 alpha p sinh(pt), to 1e-9."""
    first = _swings()[0][0]
    (time, rotation), (moments, velocity) = _line(panels[1]), _line(panels[2])
    early = time < first - 1e-9
    assert early.sum() > 50
    np.testing.assert_allclose(rotation[early], 1.0 - (1.0 - SHARE) * np.cosh(P * time[early]), rtol=0.0, atol=1e-9)
    exact = -(1.0 - SHARE) * ALPHA * P * np.sinh(P * moments[early])
    np.testing.assert_allclose(velocity[early], exact, rtol=0.0, atol=1e-8)
    # negative control: the nonlinear body does not follow the hyperbolic cosine
    other = _line(response_picture(free_rocking(BLOCK, SHARE * ALPHA, R)).axes[1])
    assert np.abs(np.interp(0.5, *other) - (1.0 - (1.0 - SHARE) * math.cosh(0.5 * P))) > 1e-3


def test_impacts_are_marked_and_the_velocity_jumps(linear, panels):
    """The first three marks lie on the ground at the closed-form times; there the drawn velocity falls by r."""
    times, heights = _line(panels[1], "impacts")
    assert not np.any(heights)
    moments, velocity = _line(panels[2])
    for k, (time, speed) in enumerate(_swings()):
        assert times[k] == pytest.approx(time, abs=1e-9)
        here = np.abs(velocity[np.abs(moments - time) < 1e-9])
        assert here.max() == pytest.approx(speed, rel=1e-8)
        assert here.min() == pytest.approx(R * speed, rel=1e-8)
    assert panels[1].get_legend().get_texts()[0].get_text() == f"impacts ({linear.impacts.size})"


def test_energy_is_drawn_in_joules():
    """Let go at 0.6 alpha the potential energy is m g R (cos(0.4 alpha) - cos alpha), of which 1 - r2 is lost first."""
    response = free_rocking(BLOCK, SHARE * ALPHA, R)
    axes = response_picture(response).axes[3]
    start = BLOCK.mass * G * RADIUS * (math.cos((1.0 - SHARE) * ALPHA) - math.cos(ALPHA))
    assert axes.get_ylabel() == "energy\n[J]"
    assert _line(axes, "potential")[1][0] == pytest.approx(start, rel=1e-12, abs=0.0)
    time, lost = _line(axes, "lost")
    between = (time > response.impacts["time"][0] + 0.05) & (time < response.impacts["time"][1] - 0.05)
    assert between.sum() > 10
    np.testing.assert_allclose(lost[between], (1.0 - R * R) * start, rtol=1e-9)
    assert not np.any(_line(axes, "work")[1])
    heavy = Block(width=10.0, height=40.0)
    assert response_picture(free_rocking(heavy, SHARE * ALPHA, R)).axes[3].get_ylabel() == "energy\n[MJ]"


def test_ground_and_friction_of_a_body_at_rest():
    """Under a sine too weak to lift it the ground is a sin(wt), and the body takes |a| / g of friction at samples."""
    response = simulate(BLOCK, rk.pulses.sine(2.0, 0.8))
    axes = response_picture(response, friction=0.3).axes
    time, ground = _line(axes[0])
    w = 2.0 * math.pi / 0.8
    np.testing.assert_allclose(ground[time < 0.8], 2.0 * np.sin(w * time[time < 0.8]), rtol=0.0, atol=1e-6)
    moments, taken = _line(axes[4], "demand")
    inside = moments < 0.8
    np.testing.assert_allclose(taken[inside], np.abs(2.0 * np.sin(w * moments[inside])) / G, rtol=0.0, atol=1e-6)
    assert _line(axes[4], "friction 0.3")[1][0] == 0.3
    assert axes[0].get_xlim() == (0.0, pytest.approx(0.8))
    assert all("impacts" not in str(line.get_label()) for line in axes[1].lines)


@pytest.mark.slow
def test_titles_tell_outcome_restitution_and_engine():
    """Outcome in words, motion with its scale, label of the model and engine stand above the panels."""
    response = simulate(BLOCK, rk.pulses.sine(1.6, 0.8), "housner", scale=2.0, engine="reference")
    figure = response_picture(response)
    assert figure.get_suptitle().replace("\n", " ").lower() == response.summary
    small = figure.axes[0].get_title(loc="left")
    for words in ("2 times sine pulse, 1.6 m/s2, 0.8 s", "restitution: housner", "engine: reference"):
        assert words in small
    let_go = response_picture(free_rocking(BLOCK, 0.1))
    assert "free rocking, the ground at rest" in let_go.axes[0].get_title(loc="left")


def test_overturning_is_marked_in_every_panel():
    """Pushed over by a constant a, -theta = (a/g - alpha) (cosh(pt) - 1): the mark is where that is alpha."""
    response = simulate(BLOCK, rk.pulses.rectangular(6.0, 1.5), R, linear=True)
    figure = response_picture(response)
    fall = math.acosh(1.0 + ALPHA / (6.0 / G - ALPHA)) / P
    for panel in figure.axes:
        (mark,) = (line for line in panel.lines if line.get_color() == "#AC8191" and len(line.get_xdata()) == 2)
        assert mark.get_xdata() == pytest.approx([fall, fall], rel=1e-9)
    words = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert words == ["overturning certain"]
    low, high = figure.axes[1].get_ylim()
    assert low == pytest.approx(-1.15 * 2.2)
    assert high == pytest.approx(1.15)


def test_small_rocking_fills_its_panel():
    """Rocking within a tenth of alpha fills the panel, which says that alpha lies outside."""
    axes = response_picture(free_rocking(BLOCK, 0.1 * ALPHA, R)).axes[1]
    assert axes.get_ylim()[1] == pytest.approx(0.125)
    assert "far outside" in axes.get_title(loc="right")


@pytest.mark.slow
def test_lost_contact_is_told():
    """A jerk downwards of 2 g takes the ground away, and the friction panel says so."""
    with pytest.warns(PureRockingWarning, match="the contact force becomes tensile"):
        thrown = simulate(BLOCK, _noise(vertical=True))
    axes = response_picture(thrown).axes[4]
    assert "becomes tensile" in axes.get_title(loc="right")
    assert response_picture(simulate(BLOCK, _noise())).axes[4].get_title(loc="right") == ""


@pytest.mark.parametrize("friction", [0.0, -1.0, math.nan, "much"])
def test_impossible_friction_is_refused(friction):
    """A coefficient of friction is a finite number above zero."""
    with pytest.raises(InvalidValueError, match="friction"):
        response_picture(free_rocking(BLOCK, 0.1), friction)


def _cases():
    long_name = "a record $_{x}$ whose name goes on " * 8
    return {
        "rocked": lambda: simulate(BLOCK, rk.pulses.sine(3.2, 0.8)),
        "no uplift": lambda: simulate(BLOCK, rk.pulses.sine(2.0, 0.8)),
        "overturned": lambda: simulate(BLOCK, rk.pulses.sine(6.0, 0.8), R),
        "free": lambda: free_rocking(BLOCK, SHARE * ALPHA),
        "record": lambda: simulate(BLOCK, _noise(long_name, vertical=True), scale=-1.25),
        "small": lambda: free_rocking(BLOCK, 0.05 * ALPHA, 0.5),
    }


@pytest.mark.slow
@pytest.mark.parametrize("case", _cases())
def test_no_text_over_text(case):
    """At 1200 pixels no two words touch, and none leaves the page."""
    figure = response_picture(_cases()[case]())
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    texts = [text for text in figure.findobj(Text) if text.get_visible()]
    seen = [text for text in texts if text.get_text().strip() and _drawn(text, figure, renderer)]
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in seen]
    page = figure.bbox
    for words, box in boxes:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{words!r} leaves the page"
    clashes = [
        (a, b)
        for (a, one), (b, two) in combinations(boxes, 2)
        if one.shrunk(0.98, 0.98).overlaps(two.shrunk(0.98, 0.98))
    ]
    assert not clashes
    # 1200 pixels at the least
    assert figure.get_size_inches()[0] * 300 > 1200


def _drawn(text, figure, renderer):
    """Whether a tick label lies within its axis: labels beyond the limits exist but are not drawn."""
    for axes in figure.axes:
        for axis, low, high in ((axes.xaxis, *axes.get_xlim()), (axes.yaxis, *axes.get_ylim())):
            for tick in axis.get_major_ticks():
                if text in (tick.label1, tick.label2):
                    on = text is tick.label1 and tick.label1.get_visible()
                    return on and low - 1e-9 <= tick.get_loc() <= high + 1e-9
    return True


def test_curves_between_samples():
    """Velocity at any instant is the closed form; the ground of a sine pulse has moved a T2 / (2 pi) at its end."""
    response = simulate(BLOCK, rk.pulses.sine(2.0, 0.8))
    assert ground_displacement_at(response, np.array([0.8]))[0] == pytest.approx(1.28 / (2.0 * math.pi), rel=1e-7)
    rocking = free_rocking(BLOCK, SHARE * ALPHA, R, linear=True)
    time = np.linspace(0.0, 0.55, 7)
    np.testing.assert_allclose(velocity_at(rocking, time), -0.4 * ALPHA * P * np.sinh(P * time), rtol=0.0, atol=1e-7)
    assert shown_until(rocking) <= rocking.time[-1]


def test_a_body_that_lies_within_the_first_step() -> None:
    """It is drawn up to the fall, without a warning."""
    with pytest.warns(PureRockingWarning, match="the contact force becomes tensile"):
        response = simulate(Block(width=0.5, height=2.0), GroundMotion([-200.0, -200.0, -200.0, 0.0], 1.0))
    assert response.time.size == 1
    left, right = response_picture(response).axes[0].get_xlim()
    assert (left, right) == (0.0, response.dense_output.end[-1])
    assert right > response.overturning_time


SLENDER = Block(width=1.0, height=4.0).with_feet(0.1, 1)


@pytest.mark.slow
def test_map_shows_four_regimes_and_the_closed_form():
    """Cells of an image hold regimes by complementarity; the curve is friction_demand, 1 % off is told apart."""
    (axes,) = regime_map_picture(SLENDER, cells=20).axes
    (image,) = axes.images
    codes = np.asarray(image.get_array())
    assert set(codes.ravel()) == {r.code for r in (Regime.REST, Regime.SLIDE, Regime.ROCK, Regime.SLIDE_ROCK)}
    x, y = axes.lines[-1].get_data()
    assert y[100] == pytest.approx(friction_demand(SLENDER, x[100]), rel=1e-12, abs=0.0)
    assert y[100] != pytest.approx(0.99 * friction_demand(SLENDER, x[100]), rel=1e-3)
    # cells just above the curve rock, those just below slide and rock
    column = 15
    push = (column + 0.5) * 1.5 / 20
    row = int(friction_demand(SLENDER, push) / 1.5 * 20)
    assert codes[row + 1, column] == Regime.ROCK.code
    assert codes[row - 1, column] == Regime.SLIDE_ROCK.code


@pytest.mark.parametrize(
    ("options", "words"), [({"cells": 1}, "cells must be"), ({"largest": 0.2}, "largest must be above")]
)
def test_map_refuses_what_it_cannot_draw(options, words):
    """Too few cells, or no room for rocking."""
    with pytest.raises(InvalidValueError, match=words):
        regime_map_picture(SLENDER, **options)


@pytest.mark.slow
def test_response_is_drawn_over_its_regimes():
    """The curves are the samples, and the bands cover the time axis once."""
    response = rk.simulate(Block(width=1.2, height=2.0), rk.pulses.sine(amplitude=9.0, period=0.9), None, friction=0.62)
    figure = regimes_picture(response)
    time, rotation = max((line.get_data() for line in figure.axes[0].lines), key=lambda pair: len(pair[0]))
    assert np.array_equal(time, response.time)
    assert np.allclose(rotation, np.degrees(response.rotation))
    spans = [path.vertices[:, 0] for c in figure.axes[1].collections for path in c.get_paths()]
    assert sum(np.ptp(x) for x in spans) == pytest.approx(response.trajectory.end, rel=1e-9)


@pytest.fixture(scope="module")
def wobble():
    """A square box let go from a lean off its axes."""
    return rk.free_rocking(
        SpatialBody.box(1.0, 1.0, 4.0), restitution="housner", start=SpatialStart(0.1, 0.4), duration=3.0
    )


def test_the_curves_are_the_response(wobble):
    """Path of the top, tilt in degrees, impacts at their times; the bar of contact covers the time without gaps."""
    plan, tilt, _, contact = spatial_picture(wobble).axes
    np.testing.assert_array_equal(np.column_stack(plan.lines[0].get_data()), wobble.top[:, :2])
    np.testing.assert_allclose(tilt.lines[0].get_ydata(), np.degrees(wobble.tilt))
    np.testing.assert_array_equal(tilt.lines[1].get_xdata(), wobble.impacts["time"])
    bars = sorted((bar.get_x(), bar.get_width()) for bar in contact.patches)
    assert bars[0][0] == 0.0
    assert sum(width for _, width in bars) == pytest.approx(wobble.time[-1])


def _regimes():
    return regimes_picture(rk.simulate(Block(width=1.2, height=2.0), rk.pulses.sine(9.0, 0.9), None, friction=0.62))


def _overturned_in_space():
    response = rk.simulate(SpatialBody.box(1.0, 1.0, 4.0), rk.pulses.half_sine(9.0, 1.2), "housner")
    assert math.isfinite(response.overturning_direction)
    return spatial_picture(response)


def _rolling():
    start = SpatialStart(0.1, angular_velocity=(0.3, 0.0, 0.1))
    cylinder = SpatialBody.cylinder(0.5, 2.0)
    return spatial_picture(rk.free_rocking(cylinder, restitution="housner", start=start, duration=2.0))


def _map():
    axes = ("semi_diagonal", np.geomspace(0.3, 5.0, 6)), ("slenderness_angle", np.linspace(0.1, 0.4, 5))
    return overturning_map_picture(rk.overturning_map(BLOCK, rk.pulses.sine(5.0, 0.8), *axes))


def _transitions():
    found = rk.minimum_overturning_acceleration(BLOCK, rk.pulses.sine(3.0, 0.8), 0.85)
    return transitions_picture(found, BLOCK, rk.pulses.sine(3.0, 0.8), 0.85, points=50)


PICTURES = {
    "response": lambda: response_picture(simulate(BLOCK, _noise(), scale=-1.25)),
    "regimes": _regimes,
    "overturned in space": _overturned_in_space,
    "rolling": _rolling,
    "motion": lambda: ground_motion_picture(_noise(vertical=True)),
    "map": _map,
    "transitions": _transitions,
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", PICTURES)
def test_pictures_of_all_kinds_are_written_the_same_every_time(kind, tmp_path):
    """Drawn and written twice, a file is the same byte by byte, with 300 dots in an inch."""
    figures = [PICTURES[kind]() for _ in range(2)]
    first, second = (write(figure, tmp_path / f"{k}.png").read_bytes() for k, figure in enumerate(figures))
    assert first == second
    assert int.from_bytes(first[16:20]) == int(300 * figures[0].get_figwidth())
