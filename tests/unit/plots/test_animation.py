"""The animations: a page that holds what the response says, a GIF of the right length, a fall to its end."""

import base64
import hashlib
import json
import math
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from rocking.bodies import Block, MassPoints, Region, Section, shapes
from rocking.dynamics import free_rocking, simulate
from rocking.errors import InvalidValueError, RockingError
from rocking.motions import GroundMotion, pulses
from rocking.plots import animate_comparison, animate_gif, animate_html
from rocking.plots.animation import page, page_data, slowest_speed
from rocking.plots.animation_scene import DrawnShape, fall_of, scene_of

BLOCK = Block(width=0.5, height=2.0)
ALPHA = math.atan(0.25)
HOLLOW = Section([Region([(0, 0), (2, 0), (2, 6), (0, 6)], 2000.0, holes=[[(0.5, 1), (1.5, 1), (1.5, 5), (0.5, 5)]])])
LOLLIPOP = MassPoints([(0.2, 2.0), (0.0, 0.5)], [1.0, 3.0], feet=(-0.5, 0.7))


class _Page(HTMLParser):
    """Elements of a page, what is inside them, and those left open."""

    EMPTY = frozenset({"meta", "input"})

    def __init__(self, words):
        super().__init__(convert_charrefs=True)
        self.open, self.seen, self.words = [], [], []
        self.feed(words)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append((self.open[-1] if self.open else "", data))

    def inside(self, tag):
        return [words for place, words in self.words if place == tag]


@pytest.fixture(scope="module")
def rocked():
    """A block that rocks under a sine pulse and stays standing."""
    return simulate(BLOCK, pulses.sine(3.2, 0.8), 0.9)


def _unpacked(words):
    return np.frombuffer(base64.b64decode(words), "<f4")


def _hash(words):
    return f"'sha256-{base64.b64encode(hashlib.sha256(words.encode()).digest()).decode()}'"


def test_page_is_whole_and_alone(rocked, tmp_path):
    """The page closes every element, asks for nothing from elsewhere, and its policy allows its own parts alone."""
    target = animate_html(rocked, tmp_path / "rocking.html")
    words = target.read_text(encoding="utf-8")
    made = _Page(words)
    assert made.open == []
    assert not re.search(r"//[\w-]+\.|https?:|url\(|@import|\bimport\b|fetch\(|XMLHttpRequest|eval\(", words)
    assert not any({"src", "href", "style", "onclick"} & set(attributes) for _, attributes in made.seen)
    (policy,) = (a["content"] for tag, a in made.seen if a.get("http-equiv") == "Content-Security-Policy")
    script, style = made.inside("script")[-1], made.inside("style")[0]
    assert policy == f"default-src 'none'; script-src {_hash(script)}; style-src {_hash(style)}; base-uri 'none'"
    assert ".innerHTML" not in script
    # a minute of rocking stays far below a picture of a telephone
    assert len(words) < 60_000


def test_page_is_told_in_words(rocked):
    """Outcome, motion, model and engine are text; canvases have labels, inputs have names; small screens are meant."""
    made = _Page(page(rocked))
    assert made.inside("h1")[0].lower() == rocked.summary
    assert made.inside("title") == made.inside("h1")
    about = made.inside("p")[0]
    assert "sine pulse, 3.2 m/s2, 0.8 s" in about
    assert "restitution 0.9" in about
    assert rocked.engine in about
    for tag, attributes in made.seen:
        if tag == "canvas":
            assert attributes["role"] == "img"
            assert attributes["aria-label"]
        if tag in {"input", "select"}:
            assert any(t == "label" and a.get("for") == attributes["id"] for t, a in made.seen)
    assert ("html", {"lang": "en"}) in made.seen
    assert any(a.get("name") == "viewport" for _, a in made.seen)


@pytest.mark.slow
def test_name_of_a_motion_cannot_become_markup():
    """A motion called like a script, or with a dollar sign, is shown as it is called and runs nothing."""
    name = "</script><script>alert(1)</script> $data & 'x'"
    motion = GroundMotion([0.0, 3.0, -3.0, 0.0], 0.2, [0.0, 0.1, 0.1, 0.0], name=name)
    made = _Page(page(simulate(BLOCK, motion, scale=1.5)))
    assert [tag for tag, _ in made.seen].count("script") == 2
    assert name in made.inside("p")[0]
    assert "1.5 times" in made.inside("p")[0]
    assert "vertical ground motion" in " ".join(made.inside("p"))


def test_data_is_the_response(rocked):
    """Rotation and velocity are the response at equal steps to float32, impacts to the last digit."""
    made = _Page(page(rocked))
    data = json.loads(made.inside("script")[0])
    assert data == json.loads(json.dumps(page_data(rocked)))
    rotation = _unpacked(data["rotation"])
    time = np.linspace(0.0, data["end"], rotation.size)
    np.testing.assert_array_equal(rotation, rocked.at(time).astype("f4"))
    assert (rotation.size - 1) / data["end"] <= 120.0
    # the slope of the rotation is the velocity, where no impact lies between
    velocity = _unpacked(data["velocity"])
    slope = np.gradient(rocked.at(time), time, edge_order=2)
    calm = np.min(np.abs(time[:, None] - np.append(rocked.impacts["time"], rocked.uplifts)), axis=1) > 0.05
    np.testing.assert_allclose(velocity[calm], slope[calm], rtol=0.0, atol=2e-3)
    for row, impact in zip(data["impacts"], rocked.impacts.tolist(), strict=True):
        assert row == [*impact[:4], 1 if impact[4] == "right" else -1]
    assert data["alpha"] == pytest.approx([ALPHA, ALPHA])
    assert data["outcome"] == rocked.summary
    assert (data["fall"], data["overturnedTo"]) == (None, 0)


def test_ground_moves_as_the_formulas_say(rocked):
    """Under a sine pulse the ground is at a T / (2 pi) (t - sin(wt) / w), and its acceleration is a sin(wt)."""
    data = page_data(rocked)
    ground, acceleration = _unpacked(data["ground"]), _unpacked(data["acceleration"])
    time = np.linspace(0.0, data["end"], ground.size)
    w = 2.0 * math.pi / 0.8
    early = time < 0.8
    exact = 3.2 / w * (time - np.sin(w * time) / w)
    np.testing.assert_allclose(ground[early], exact[early], rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(ground[~early], 3.2 / w * 0.8, rtol=0.0, atol=1e-6)
    # between samples of the response, 16 ms apart, the arrow is on a straight line
    np.testing.assert_allclose(acceleration[early], 3.2 * np.sin(w * time[early]), rtol=0.0, atol=0.01)


def test_overturning_and_rest_are_told():
    """A fall names its instant and side and ends lying down; a body never lifted shows the motion, and no impact."""
    fell = simulate(BLOCK, pulses.sine(6.0, 0.8), 0.9)
    data = page_data(fell)
    assert data["fall"] == fell.overturning_time
    assert data["overturnedTo"] == 1
    # as far as the samples go, and they go until it lies
    assert _unpacked(data["rotation"])[-1] == pytest.approx(math.pi / 2.0, abs=0.1)
    still = page_data(simulate(BLOCK, pulses.sine(2.0, 0.8)))
    assert (still["end"], still["impacts"]) == (pytest.approx(0.8), [])
    assert not _unpacked(still["rotation"]).any()


def test_outlines_are_those_of_the_bodies():
    """A block is its rectangle, a hole is a second ring, mass points keep their shares, all about their feet."""
    block = DrawnShape.of(BLOCK)
    ((shade, (ring,)),) = block.regions
    assert shade == 1.0
    assert {tuple(row) for row in ring.tolist()} == {(-0.25, 0.0), (0.25, 0.0), (0.25, 2.0), (-0.25, 2.0)}
    assert (block.feet, block.centre) == ((-0.25, 0.25), (0.0, 1.0))
    ((_, rings),) = DrawnShape.of(HOLLOW).regions
    assert [sorted(map(tuple, ring.tolist()))[0] for ring in rings] == [(-1.0, 0.0), (-0.5, 1.0)]
    points = DrawnShape.of(LOLLIPOP)
    np.testing.assert_allclose(points.points, [[0.1, 2.0, 1.0 / 3.0], [-0.1, 0.5, 1.0]], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(points.feet, [-0.6, 0.6])
    np.testing.assert_allclose(points.centre, [-0.05, 0.875])


@pytest.mark.parametrize("theta", [0.3, -0.3])
def test_body_turns_about_the_foot_it_stands_on(theta):
    """Turned clockwise the right foot stays and the left one rises by 2 b sin(theta); no corner sinks."""
    shape = DrawnShape.of(BLOCK)
    left, right = shape.turned(np.array([[-0.25, 0.0], [0.25, 0.0]]), theta)
    stays, rises = (right, left) if theta > 0.0 else (left, right)
    np.testing.assert_allclose(stays, [math.copysign(0.25, theta), 0.0], rtol=0.0, atol=1e-15)
    assert rises[1] == pytest.approx(0.5 * math.sin(0.3))
    assert shape.turned(shape.corners, theta)[:, 1].min() > -1e-12
    # clockwise is to the right
    assert shape.turned(np.array([[0.0, 1.0]]), theta)[0, 0] * theta > 0.0


@pytest.mark.slow
def test_window_holds_the_body_all_the_time(rocked):
    """Every corner at every instant lies inside the window; where the ground runs away the window goes with it."""
    others = simulate(BLOCK, pulses.sine(6.0, 0.8), 0.9), free_rocking(HOLLOW, 0.2), free_rocking(LOLLIPOP, 0.1)
    for response in (rocked, *others):
        scene = scene_of(response)
        x0, y0, x1, y1 = scene.window
        for k in range(0, scene.time.size, 7):
            corners = scene.shape.turned(scene.shape.corners, scene.rotation[k])
            corners += np.array([0.0 if scene.follows else scene.ground[k], 0.0])
            low, high = corners.min(axis=0), corners.max(axis=0)
            assert x0 < low[0] < high[0] < x1
            assert y0 < low[1] < high[1] < y1
        assert not scene.follows
    # half a metre a second for many seconds is far
    assert scene_of(simulate(BLOCK, pulses.rectangular(2.6, 0.5), 0.9)).follows


@pytest.mark.slow
@pytest.mark.parametrize("body", [HOLLOW, LOLLIPOP], ids=["hollow", "points"])
def test_gif_has_its_frames(body, tmp_path):
    """At 20 frames a second and half speed a response of T seconds has ceil(40 T) + 1 frames of 50 ms."""
    response = free_rocking(body, 0.1, 0.5, duration=0.6)
    steps = []
    path = animate_gif(response, tmp_path / "a.gif", fps=20, speed=0.5, progress=lambda *step: steps.append(step))
    count = math.ceil(40.0 * response.time[-1] - 1e-9) + 1
    with Image.open(path) as film:
        assert (film.n_frames, film.is_animated) == (count, True)
        durations = []
        for k in range(film.n_frames):
            film.seek(k)
            durations.append(film.info["duration"])
        assert set(durations) == {50}
        assert film.size[0] == 480
        assert film.info["loop"] == 0
    assert steps == [(k + 1, count) for k in range(count)]


@pytest.mark.slow
def test_gif_moves_and_ends_at_the_end(tmp_path):
    """The first frames of a falling block differ from the last; 30 frames a second are frames of 30 ms."""
    response = simulate(BLOCK, pulses.sine(6.0, 0.8), 0.9)
    path = animate_gif(response, tmp_path / "fall.gif", fps=30, speed=5.0)
    with Image.open(path) as film:
        assert film.info["duration"] == 30
        assert film.n_frames == math.ceil(response.time[-1] / 0.15) + 1
        first = np.asarray(film.convert("L"), dtype=float)
        film.seek(film.n_frames - 1)
        last = np.asarray(film.convert("L"), dtype=float)
    # upright the body fills the middle of the upper half, lying it does not
    assert np.abs(first - last).max() > 50.0


@pytest.mark.slow
def test_gif_follows_a_ground_that_runs_away(tmp_path):
    """Where the ground ends 4 m away, the body stays within the frame: its middle third is never empty."""
    response = simulate(BLOCK, pulses.rectangular(2.6, 0.5), 0.9)
    path = animate_gif(response, tmp_path / "far.gif", fps=10, speed=3.0)
    with Image.open(path) as film:
        for k in range(film.n_frames):
            film.seek(k)
            frame = np.asarray(film.convert("L"), dtype=float)
            middle = frame[150:250, 160:320]
            # the body is grey of 65 %
            assert np.mean(np.abs(middle - 166.0) < 12.0) > 0.2


def test_refusals(rocked, tmp_path):
    """Other suffixes, folders that are not there, too many frames, and impossible speeds are refused in a sentence."""
    with pytest.raises(RockingError, match=r"\.html"):
        animate_html(rocked, tmp_path / "a.gif")
    with pytest.raises(RockingError, match=r"\.gif"):
        animate_gif(rocked, tmp_path / "a.mp4")
    with pytest.raises(RockingError, match="cannot write"):
        animate_html(rocked, tmp_path / "none" / "a.html")
    with pytest.raises(RockingError, match="cannot write"):
        animate_gif(free_rocking(BLOCK, 0.1, 0.5, duration=0.1), tmp_path / "none" / "a.gif")
    with pytest.raises(InvalidValueError, match=r"at most 500 frames.*speed = "):
        animate_gif(rocked, tmp_path / "a.gif", speed=0.05)
    for wrong in ({"fps": 0.5}, {"fps": 51}, {"fps": math.nan}, {"speed": 0.0}, {"speed": math.inf}):
        with pytest.raises(InvalidValueError, match=next(iter(wrong))):
            animate_gif(rocked, tmp_path / "a.gif", **wrong)
    assert not (tmp_path / "a.gif").exists()


def test_slowest_speed_is_real_speed_where_that_fits(rocked):
    """Twenty seconds fit at real speed and 25 frames a second; a long record is shown faster, in at most 500 frames."""
    assert slowest_speed(rocked) == 1.0
    long = simulate(BLOCK, GroundMotion(np.full(6000, 1.0), 0.01), duration=60.0)
    speed = slowest_speed(long)
    assert 60.0 / (0.04 * speed) + 1 <= 500
    assert speed == pytest.approx(3.0, rel=0.01)


BODIES = {
    "leaning": Section([Region(shapes.trapezoid(0.5, 0.3, 1.8, lean=0.1), 2000.0)]),
    "wide base": Section([Region(shapes.trapezoid(1.0, 0.2, 1.5, lean=0.05), 2000.0)]),
    "overhang": Section([Region(shapes.trapezoid(0.4, 0.9, 1.2, lean=0.15), 2000.0)]),
    "points": MassPoints([(0.2, 2.0), (0.0, 0.5), (-0.3, 1.4)], [1.0, 3.0, 0.7], feet=(-0.5, 0.7)),
}


def falling(body, side, **more):
    """Let a body go a little beyond its top, to one side."""
    alpha = body.side("right" if side > 0 else "left").slenderness_angle
    return free_rocking(body, rotation=side * 1.02 * alpha, **more)


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("side", [-1, 1], ids=["left", "right"])
def test_the_body_falls_to_the_ground_with_its_energy(name, side):
    """It ends with a corner beside the foot on the ground, none below it before; energy and time are closed forms.

    theta'^2 / 2 p^2 + cos(alpha - |theta|) stays; time is the integral of d theta over theta' that follows from it.
    Negative control: a fall at the speed with which it begins, as was drawn before, takes a fifth longer.
    """
    response, shape = falling(BODIES[name], side, duration=0.3), DrawnShape.of(BODIES[name])
    scene = scene_of(response)
    corners = np.unique(shape.corners, axis=0)
    lowest = [shape.turned(corners, theta)[:, 1] for theta in scene.rotation]
    assert min(each.min() for each in lowest) > -1e-9
    assert [np.count_nonzero(np.abs(each) < 1e-9) for each in lowest[-2:]] == [1, 2]
    assert np.sign(scene.rotation[-1]) == side
    fall = fall_of(response, shape.lying)
    about = BODIES[name].side("right" if side > 0 else "left")
    alpha, p = about.slenderness_angle, about.frequency_parameter
    size, rate = np.abs(fall.rotation), np.abs(fall.velocity)
    energy = 0.5 * (rate / p) ** 2 + np.cos(alpha - size)
    assert np.abs(energy - energy[0]).max() < 1e-9
    x, w = np.polynomial.legendre.leggauss(400)
    theta = size[0] + 0.5 * (x + 1.0) * (size[-1] - size[0])
    speed = p * np.sqrt(2.0 * (energy[0] - np.cos(alpha - theta)))
    expected = 0.5 * (size[-1] - size[0]) * (w / speed).sum()
    assert fall.time[-1] - fall.time[0] == pytest.approx(expected, rel=1e-7)
    assert (size[-1] - size[0]) / max(rate[0], 0.5) > 1.2 * expected


def test_a_fall_that_was_cut_is_that_of_the_longer_history():
    """Cut in the middle of a fall, under a ground that has stopped, it goes on as the history that was not cut."""
    body = BODIES["leaning"]
    motion = pulses.sine(6.0, 0.8)
    whole = simulate(body, motion, "ked")
    cut = simulate(body, motion, "ked", duration=motion.duration)
    assert cut.time[-1] < whole.time[-1]
    assert abs(cut.rotation[-1]) < 1.2 < abs(whole.dense_output.rotation[-1, 1])
    fall = fall_of(cut, DrawnShape.of(body).lying)
    known = fall.time < whole.dense_output.end[-1]
    assert known.sum() > 10
    np.testing.assert_allclose(fall.rotation[known], whole.at(fall.time[known]), rtol=0.0, atol=1e-8)


def test_a_ground_that_goes_on_goes_on_in_the_fall():
    """Beyond a quarter turn the shaking still counts: the torque is that of the equation of motion, at any instant."""
    body, step = BODIES["wide base"], 0.01
    time = step * np.arange(3000)
    motion = GroundMotion(9.0 * np.sin(5.0 * time), step, vertical=3.9 * np.cos(3.0 * time))
    response = simulate(body, motion, 0.9)
    fall = fall_of(response, DrawnShape.of(body).lying)
    assert abs(fall.rotation[0]) >= 0.5 * math.pi - 1e-9
    assert fall.time.size > 10
    middle = 0.5 * (fall.time[1:-1] + fall.time[:-2])
    found = np.diff(fall.velocity[:-1]) / np.diff(fall.time[:-1])
    side = np.sign(fall.rotation[0])
    about = body.side("right" if side > 0 else "left")
    psi = about.slenderness_angle * side - 0.5 * (fall.rotation[1:-1] + fall.rotation[:-2])
    push, lift = np.interp(middle, time, motion.acceleration), np.interp(middle, time, motion.vertical)
    torque = (1.0 + lift / 9.80665) * np.sin(psi) + push / 9.80665 * np.cos(psi)
    np.testing.assert_allclose(found, -(about.frequency_parameter**2) * torque, rtol=2e-3, atol=2e-3)


def test_a_body_that_ends_on_its_way_over_the_other_foot_lands_on_it_first():
    """Cut while it swings back with more than the other side holds, it lands, loses its speed there, and falls on."""
    body = BODIES["leaning"]
    rotation, velocity = 0.2, -3.0
    cut = free_rocking(body, rotation=rotation, angular_velocity=velocity, restitution="ked", duration=0.01)
    whole = free_rocking(body, rotation=rotation, angular_velocity=velocity, restitution="ked", duration=3.0)
    assert (cut.impacts.size, whole.impacts.size, cut.outcome) == (0, 1, whole.outcome)
    fall = fall_of(cut, DrawnShape.of(body).lying)
    known = fall.time < whole.dense_output.end[-1]
    np.testing.assert_allclose(fall.rotation[known], whole.at(fall.time[known]), rtol=0.0, atol=1e-8)
    assert fall.rotation[-1] < -1.4


def test_where_bodies_lie(rocked):
    """What stands has no fall. A block lies after a quarter turn; leaning out by 45 degrees on a side, an eighth."""
    assert fall_of(rocked, (-1.5, 1.5)).time.size == 0
    assert scene_of(rocked).time[-1] <= rocked.time[-1]
    assert DrawnShape.of(BLOCK).lying == pytest.approx((-0.5 * math.pi, 0.5 * math.pi), abs=1e-12)
    leans = Section([Region([(-0.25, 0.0), (0.25, 0.0), (1.25, 1.0), (-0.75, 1.0)])])
    assert DrawnShape.of(leans).lying == pytest.approx((-math.atan(2.0), 0.25 * math.pi), abs=1e-12)


@pytest.mark.slow
def test_a_comparison_shows_each_response_to_its_end(rocked, tmp_path):
    """Equal responses look the same side by side; where one falls, its panel alone is another at the end."""
    fallen = simulate(BLOCK, pulses.sine(5.0, 0.8), 0.9)
    assert fallen.outcome.name == "OVERTURNED"
    sizes, ends = [], []
    for second in (rocked, fallen):
        path = animate_comparison({"one": rocked, "two": second}, tmp_path / "film.gif", fps=20.0, until=2.0)
        with Image.open(path) as film:
            assert film.n_frames == 2.0 / 0.05 + 1
            durations = []
            for k in range(film.n_frames):
                film.seek(k)
                durations.append(film.info["duration"])
            assert durations == [50] * 40 + [2000]
            sizes.append(film.size)
            frame = np.asarray(film.convert("L"))[40 : film.height // 3] < 250
            ends.append((frame[:, : film.width // 2].sum(), frame[:, film.width // 2 :].sum()))
    (left, right), (_, lying) = ends
    assert abs(left - right) < 0.02 * left  # to the dots at the edges of what is drawn
    assert lying < 0.7 * left  # what has fallen leaves the upper part of its panel


@pytest.mark.slow
def test_a_comparison_refuses(rocked, tmp_path):
    """One response alone, an ending that is no film, and more frames than a page wants to carry."""
    with pytest.raises(InvalidValueError, match="2 to 4"):
        animate_comparison({"one": rocked}, tmp_path / "film.gif")
    both = {"one": rocked, "two": rocked}
    with pytest.raises(RockingError, match="must end in"):
        animate_comparison(both, tmp_path / "film.png")
    with pytest.raises(InvalidValueError, match="at most 500 frames"):
        animate_comparison(both, tmp_path / "film.gif", speed=0.01)
    with pytest.raises(InvalidValueError, match="until"):
        animate_comparison(both, tmp_path / "film.gif", until=0.0)
    with pytest.raises(RockingError, match="cannot write"):
        animate_comparison(both, tmp_path / "none" / "film.gif", until=0.2)
