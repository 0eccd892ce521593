"""Solids in space: what is drawn is the body that it means, on the vertices of its hull; restitution, refusals."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import rocking as rk
from rocking.bodies.solid import Part, Polyhedron, Solid, box
from rocking.decision.prediction import space
from rocking.decision.prediction.mechanics import Uncertain
from rocking.decision.prediction.shapes import inset as inset_of
from rocking.decision.prediction.space import SampledInSpace, sloping
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import HullGround
from rocking.dynamics.frictional.histories import hull_histories
from rocking.dynamics.frictional.restitution import FixedPosition
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.rolling import SpatialStart
from rocking.errors import RockingError

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="studies")]
KNOWN = {
    "restitution": "housner-3d",
    "friction": 0.6,
    "base": 0.0,
    "centre": 1.0,
    "offset": 0.0,
    "level": 0.0,
    "azimuth": 0.0,
    "model_error": "off",
}


def stone(lift=0.0):
    """A five-sided stone, wider above, its base not under its middle; lift: height of one more corner of its base."""
    base = np.array([[-0.2, -0.15], [0.25, -0.2], [0.3, 0.1], [0.05, 0.25], [-0.15, 0.2]])
    points = np.concatenate(
        [np.column_stack([base, [0.0, 0.0, 0.0, lift, 0.0]]), np.column_stack([1.2 * base, [1.1] * 5])]
    )
    faces, out = ConvexHull(points).simplices, ConvexHull(points).equations[:, :3]
    a, b, c = points[faces.T]
    wrong = (np.cross(b - a, c - a) * out).sum(axis=1) < 0.0
    faces[wrong] = faces[wrong][:, [0, 2, 1]]
    return Solid(Part(Polyhedron(points, faces), 2500.0))


def shaking(scale=1.0):
    motion = rk.examples.motion("three-components", seed=4)
    return {axis: motion[axis].scaled(scale) for axis in "xyz"}


def mechanics(solid, **given):
    return SampledInSpace(solid, shaking(1.5), {**KNOWN, **given}, rk.conventions.g)


def alone(body, law, friction, azimuth, scale=1.5):
    """One history by the reference engine."""
    ground = HullGround(*shaking(scale).values())
    start = SpatialStart(azimuth=azimuth) if azimuth else SpatialStart()
    return hull_histories(body, ground, law, friction, 1.0, start)


@pytest.mark.verifies("computed anew", "hulls made and followed one by one", within="1e-3")
def test_drawn_rows_are_the_bodies_that_they_mean(monkeypatch):
    """Friction, the position of the centre, and points that lie inside of the drawn ones."""
    monkeypatch.setattr(space, "_SETTINGS", HullSettings())
    solid = stone()
    what = mechanics(solid, friction=(0.1, 0.8), base=(-0.02, -0.001), centre=(0.9, 1.1), offset=(-0.02, 0.02))
    draws = np.random.default_rng(2).random((5, 5))
    drawn, found = what.values(draws), what.run(draws, 0, np.ones(5), 1)
    moments = solid.local_moments
    for k in range(5):
        points = np.array(HullBody.of(solid).vertices) - moments.centre
        reach = np.hypot(*points[:, :2].T)
        points[:, :2] *= ((reach + drawn["base"][k]) / reach)[:, None]
        points[:, :2] -= drawn["offset"][k]
        points[:, 2] -= (drawn["centre"][k] - 1.0) * moments.centre[2]
        body = HullBody(points, moments.mass, np.zeros(3), moments.inertia)
        one = alone(body, "housner-3d", float(drawn["friction"][k, 0]), 0.0)
        # other steps: 500 impacts make 2.4e-3 of it
        assert found.peak[k] == pytest.approx(one["peak_tilt"].item(), rel=5e-3)
        assert found.overturning[k] == one.overturned.item()
    assert np.ptp(found.peak) > 0.01


@pytest.mark.verifies("closed form", "which corners touch")
def test_points_close_to_the_ground_touch_it():
    """A corner 2 mm above the ground stands on it where the base is uneven by 3 mm, not where by 1 mm."""
    shapes = [mechanics(stone(lift=0.002)).shapes.of(base, 1.0) for base in (0.001, 0.003)]
    assert [len(shape.body.hull.corners(shape.facet)) for shape in shapes] == [4, 5]


@pytest.mark.verifies("invariant", "a motion turned with the body")
def test_azimuth_turns_the_body():
    """A quarter turn of the body is a quarter turn of the motion the other way."""
    solid, motion = stone(), shaking(1.5)
    turned = {"x": motion["y"], "y": motion["x"].scaled(-1.0), "z": motion["z"]}
    one = SampledInSpace(solid, motion, {**KNOWN, "azimuth": 0.5 * math.pi}, rk.conventions.g)
    two = SampledInSpace(solid, turned, KNOWN, rk.conventions.g)
    wrong = SampledInSpace(solid, motion, KNOWN, rk.conventions.g)
    peaks = [each.run(np.empty((1, 0)), 0, np.ones(1), 1).peak[0] for each in (one, two, wrong)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-3)  # step error 1e-6, and its growth over the impacts
    assert abs(peaks[2] / peaks[0] - 1.0) > 0.01


@pytest.mark.verifies("closed form", "the balance of angular momentum of a block about the impulse", within="2e-3")
def test_measured_coefficients_as_positions_of_the_impulse():
    """The position k of the middle draw gives the median coefficient of the block back."""
    solid = Solid(box(0.6, 0.9, 2.0))
    what = mechanics(solid, restitution=None)
    k = what.inputs["restitution"].quantile(np.array([0.5])).item()
    found = rk.evidence.restitution_distribution(rk.Block(width=0.6, height=2.0))
    median = found.quantile([0.5])[0]
    b, radius_squared = 0.3, 0.3**2 + 1.0
    lever = b * (1.0 - k)  # of the impulse inside of the new foot
    inertia = 4.0 / 3.0 * radius_squared
    # angular momentum about the point of the impulse, before about the old and after about the new foot
    point = b - lever
    before = inertia - radius_squared + 1.0 - b * point
    after = inertia - radius_squared + 1.0 + b * point
    assert before / after == pytest.approx(median, abs=2e-3)  # the table has 1,025 levels
    assert 0.0 < k < 1.0
    # what `simulate` is given of it, and of a coefficient or a model
    assert what.law(0.5) == FixedPosition(k)
    assert [mechanics(solid, restitution=each).law(0.5) for each in (0.8, "ked-3d")] == [0.8, "ked"]


@pytest.mark.verifies("second engine", "the reference engine", within="1e-9")
def test_a_position_of_the_impulse_in_both_engines():
    """k = 1 is Housner's impact to the bit; another k loses less."""
    body, ground = HullBody.of(Solid(box(0.5, 0.7, 2.0))), HullGround(rk.pulses.sine(4.0, 0.7))
    found = {
        name: hull_histories(body, ground, law, friction=math.inf, engine=engine)
        for name, law, engine in (
            ("housner", "housner-3d", "fast"), ("one", FixedPosition(1.0), "fast"),
            ("less", FixedPosition(0.6), "fast"), ("reference", FixedPosition(0.6), "reference"),
        )
    }  # fmt: skip
    assert found["one"]["peak_tilt"].item() == found["housner"]["peak_tilt"].item()
    assert found["less"]["energy_lost"].item() != found["one"]["energy_lost"].item()
    assert found["less"]["peak_tilt"].item() == pytest.approx(found["reference"]["peak_tilt"].item(), rel=1e-9)


def test_a_prediction_of_a_solid():
    """Probabilities grow with the motion; the same seed gives the same answer on one and on two threads."""
    motions = [rk.pulses.sine(amplitude, 0.9) for amplitude in (0.5, 4.0, 8.0)]
    given = {"count": 8, "friction": 0.6, "contributions": False, "seed": 3}
    one, two = (rk.predict(stone(), motions, threads=threads, **given) for threads in (1, 2))
    assert one.answer().plain()["probability"]["uplift"]["per_motion"][0] == 0.0
    assert one.chances["overturning"].per_motion.tolist() == two.chances["overturning"].per_motion.tolist()
    assert np.all(np.diff(one.chances["overturning"].per_motion) >= 0.0)
    assert one.chances["overturning"].per_motion[-1] > 0.5
    names = {"restitution", "friction", "base", "centre", "offset", "level", "azimuth", "model_error"}
    assert set(one.inputs) == names
    assert any("base:" in each for each in one.assumed)


@pytest.mark.verifies("behaviour")
def test_a_body_put_down_at_a_slant_stands_where_it_settles():
    """A block given on one of its long sides is a low block."""
    lying = SampledInSpace(Solid(Part(box(2.0, 0.5, 0.5), 1000.0)), shaking(), KNOWN, rk.conventions.g)
    assert lying.pose.height == pytest.approx(0.25, abs=1e-12)


@pytest.mark.verifies("invariant", "the same body given upright", within="1e-6")
def test_a_body_given_at_a_slant_has_the_impacts_of_its_base():
    """A block drawn at 6 degrees, on points that somebody stated, rocks and loses energy on its own base."""
    shape, lean = box(0.5, 0.7, 2.0), 0.1
    points = shape.vertices @ np.array([
        [math.cos(lean), 0.0, math.sin(lean)], [0.0, 1.0, 0.0], [-math.sin(lean), 0.0, math.cos(lean)]
    ]).T  # fmt: skip
    points[:, 2] -= points[:, 2].min()
    stated = [(-0.2, -0.3), (0.2, -0.3), (0.2, 0.3), (-0.2, 0.3)]
    pulse, given = rk.pulses.sine(3.0, 0.8), {**KNOWN, "restitution": "ked-3d"}
    peaks = {}
    for name, solid in {
        "slanted": Solid(Part(Polyhedron(points, shape.faces), 2500.0), base=stated),
        "upright": Solid(Part(shape, 2500.0)),
        "on stated points": Solid(Part(shape, 2500.0), base=stated),
    }.items():
        what = SampledInSpace(solid, pulse, given, rk.conventions.g)
        peaks[name] = what.run(np.empty((1, 0)), 0, np.ones(1), 1).peak[0]
    assert peaks["slanted"] == pytest.approx(peaks["upright"], rel=1e-6)
    # negative control: impacts as if the body stood on those points are others
    assert peaks["on stated points"] != pytest.approx(peaks["upright"], rel=1e-3)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"polarity": 1.0}, "polarity applies to plane bodies"),
        ({"restitution": "plastic-winkler"}, "restitution of a 3D body must be one of measured"),
        ({"restitution": 1.4}, "restitution"),
        ({"normal_restitution": 0.3}, "normal_restitution applies to plane bodies"),
        ({"base": 4.0}, "base"),
    ],
)
@pytest.mark.verifies("behaviour")
def test_what_cannot_be_meant_is_refused(given, words):
    """Names that do not exist in space, ranges in other units, with the words that say so."""
    with pytest.raises(RockingError, match=words):
        rk.predict(stone(), shaking(), count=4, **given)


@pytest.mark.verifies("computed anew", "a section of the same shape")
def test_a_body_wider_than_its_base_is_measured_as_its_section():
    """A heavy head on a narrow foot: no block on that base has its moment of inertia, which was refused."""
    from rocking.evidence import restitution_distribution

    shapes = {(0.0, 0.2, 0.0, 0.8): 300.0, (-2.4, 2.5, 0.8, 1.1): 2500.0}
    regions = [rk.Region([(a, c), (b, c), (b, d), (a, d)], density) for (a, b, c, d), density in shapes.items()]
    section = rk.Section(regions, feet=(0.0, 0.2))
    parts = [
        Part(box(b - a, 1.5, d - c), density, translation=(0.5 * (a + b), 0.0, c))
        for (a, b, c, d), density in shapes.items()
    ]
    found = SampledInSpace(Solid(parts), rk.pulses.sine(3.0, 0.8), {}, rk.conventions.g)
    r = restitution_distribution(section, foot="left").tables["left"]  # the nearer one
    assert found.inputs["restitution"].text.startswith(f"{r[25]:.3f} to {r[-26]:.3f} over the edge")


@pytest.mark.verifies("closed form", "points moved towards the middle by a length", within="1e-12")
def test_an_inset_body_is_smaller_in_both_directions():
    """Each point lies 10 mm nearer to the plumb line, in its own direction, at its height."""
    shapes = mechanics(stone()).shapes
    plain, small = shapes.points(0.0), shapes.points(-0.01)
    far = np.linalg.norm(plain[:, :2], axis=1)
    np.testing.assert_allclose(small[:, :2], plain[:, :2] * (1.0 - 0.01 / far)[:, None], rtol=1e-12)
    np.testing.assert_array_equal(small[:, 2], plain[:, 2])


@pytest.mark.verifies("computed anew", "the hull of the points about the moved centre", within="1e-12")
def test_a_moved_centre_has_the_hull_of_the_points():
    """Heights, poses and the facet under the centre are those of a hull that is computed anew."""
    shapes = mechanics(stone()).shapes
    shift = np.array([0.03, -0.05, 0.02 * 0.55])
    fast, slow = shapes.of(-0.01, 1.0).body.moved(shift), HullBody(shapes.points(-0.01), 1.0, shift, np.eye(3))
    assert fast.hull.rolls.tolist() == slow.hull.rolls.tolist()
    np.testing.assert_allclose(fast.hull.heights, slow.hull.heights, rtol=1e-12)
    np.testing.assert_allclose(fast.points, slow.points, rtol=0.0, atol=1e-12)
    # negative control: another centre
    other = HullBody(shapes.points(-0.01), 1.0, 1.2 * shift, np.eye(3))
    assert np.abs(fast.hull.heights - other.hull.heights).max() > 1e-3
    with pytest.raises(RockingError, match="must be inside the hull"):
        fast.moved(np.array([1.0, 0.0, 0.0]))


@pytest.mark.verifies("second engine", "the ground of the reference engine", within="1e-15")
def test_axes_of_a_slope():
    """The slope descends towards its azimuth."""
    slopes = np.array([[0.02, -0.01], [0.0, 0.0], [-0.3, 0.1]])
    for row, (x, y) in zip(sloping(slopes), slopes.tolist(), strict=True):
        ground = HullGround(slope=math.hypot(x, y), azimuth=math.atan2(y, x))
        np.testing.assert_allclose(row[:9], np.ravel(ground.level), rtol=0.0, atol=1e-15)


@pytest.mark.verifies("closed form", "uplift on a slope: g tan(alpha -+ slope)", within="0.5 %")
@pytest.mark.parametrize("azimuth", [0.0, 0.7])
def test_uplift_on_a_slope(azimuth):
    """A body on a slope lifts sooner over its lower edge, and later over its upper edge, in any direction."""
    solid, slope, alpha, ramp = Solid(box(0.5, 2.0, 2.0)), 0.03, math.atan(0.25), np.linspace(0.0, 1.0, 200)
    shapes = {"level": slope, "azimuth": azimuth, "friction": 5.0, "restitution": 0.9}
    for sign in (1.0, -1.0):
        threshold = rk.conventions.g * math.tan(alpha - sign * slope)
        for factor, lifts in ((0.995, 0.0), (1.005, 1.0)):
            peak = -sign * factor * threshold * ramp
            x, y = (rk.GroundMotion(c * peak, 0.05) for c in (math.cos(azimuth), math.sin(azimuth)))
            what = SampledInSpace(solid, {"x": x, "y": y}, {**KNOWN, **shapes}, rk.conventions.g)
            what.inputs["level"] = Uncertain(
                "towards x", lambda u: slope * (np.arange(u.shape[1]) == 0) + 0.0 * u, fixed=True
            )
            assert what.run(np.empty((1, 0)), 0, np.ones(1), 1).uplift[0] == lifts, (sign, factor)
            # negative control: level ground
            flat = SampledInSpace(solid, {"x": x, "y": y}, {**KNOWN, **shapes, "level": 0.0}, rk.conventions.g)
            assert flat.run(np.empty((1, 0)), 0, np.ones(1), 1).uplift[0] == float(sign < 0.0)


@pytest.mark.verifies("invariant", "no body stands with its plumb line beyond the edge of its base")
def test_bodies_remain_in_their_pose():
    """Offsets and slopes that would tip the body are smaller; those that do not, are not."""
    shapes = SampledInSpace(Solid(box(0.2, 0.4, 2.0)), shaking(), KNOWN, rk.conventions.g).shapes
    base, shift = np.array([0.0, -0.02, 0.0, 0.0]), np.array([[0.2, 0.0], [0.2, 0.0], [0.05, 0.1], [0.0, -0.4]])
    assert shapes.standing(base, shift) == pytest.approx([0.45, 0.45 * (1.0 - 0.02 / math.hypot(0.1, 0.2)), 1.0, 0.45])


@pytest.mark.verifies("second engine", "finer steps and a later rest", control="within")
def test_coarse_settings_give_the_same_probability(monkeypatch):
    """Settings of a prediction change as many verdicts as a millionth of the motion does, and none in the mean."""
    given = {"restitution": None, "friction": (0.3, 0.8), "base": (-0.01, 0.0), "azimuth": (0.0, 6.0)}
    what, draws = mechanics(stone(), **given), np.random.default_rng(5).random((48, 4))

    def verdicts(settings, factor=0.85):
        monkeypatch.setattr(space, "_SETTINGS", settings)
        return what.run(draws, 0, np.full(48, factor), 1).overturning

    coarse, fine = space._SETTINGS, HullSettings(tolerance=1e-8)
    found, exact, nearby = verdicts(coarse), verdicts(fine), verdicts(fine, 0.85 * (1.0 + 1e-6))
    assert 10 < exact.sum() < 40
    differ, chaos = (int(np.abs(each - exact).sum()) for each in (found, nearby))
    assert differ <= chaos + 3.0 * math.sqrt(chaos + 1.0)
    assert abs(float((found - exact).sum())) <= 2.0 * math.sqrt(differ + 1.0)
    assert abs(float((verdicts(coarse, 1.1) - exact).sum())) > 2.0 * math.sqrt(differ + 1.0)


@pytest.mark.verifies(
    "invariant", "the outline, inset at each height", control="test_a_ledge_beside_the_base_carries_the_body"
)
def test_all_points_are_inside_the_outline():
    """Each point moves horizontally towards the plumb line by the inset, the base and its neighbours alike."""
    solid = stone()
    shapes = SampledInSpace(solid, shaking(), KNOWN, rk.conventions.g).shapes
    inset = 0.01
    before, after = shapes.corners, shapes.points(-inset)
    far = np.linalg.norm(before[:, :2], axis=1)
    np.testing.assert_array_equal(after[:, 2], before[:, 2])
    moved = far - np.linalg.norm(after[:, :2], axis=1)
    np.testing.assert_allclose(moved, np.minimum(inset, 0.9 * far), rtol=1e-12)


@pytest.mark.verifies("negative control")
def test_a_ledge_beside_the_base_carries_the_body():
    """With an inset of the base alone, the outline just above the base lies outside it: the base is not inset."""
    shapes = SampledInSpace(stone(), shaking(), KNOWN, rk.conventions.g).shapes
    low = shapes.corners[:, 2] <= shapes.corners[:, 2].min() + 1e-9
    alone = shapes.corners.copy()
    alone[low, :2] = inset_of(alone[low, :2], -0.05)
    everywhere = shapes.points(-0.05)
    reach = [np.linalg.norm(points[~low][:, :2], axis=1).max() for points in (alone, everywhere)]
    assert reach[0] > reach[1] + 0.049
