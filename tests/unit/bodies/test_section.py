"""Section and Region: constructors, normal form, feet and contact, and every shape that is refused."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import AsymmetricBodyError, GeometryError, InvalidValueError, RockingError

BOX = [(0, 0), (2, 0), (2, 3), (0, 3)]
HOLE = [(0.5, 1), (1.5, 1), (1.5, 2), (0.5, 2)]


def area(ring):
    x, y = np.asarray(ring).T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


@pytest.mark.parametrize("outline", [BOX, BOX[::-1], [*BOX, BOX[0]], [BOX[0], *BOX, BOX[-1]]])
@pytest.mark.parametrize("hole", [HOLE, HOLE[::-1], [*HOLE, HOLE[0]]])
def test_rings_are_normalised(outline, hole):
    """Either sense, closed or not, repeated points: outline counter-clockwise, hole clockwise, one
    coefficient."""
    region = rk.Region(outline, 2400.0, [hole])
    assert area(region.outline) == 6.0
    assert [area(ring) for ring in region.holes] == [-1.0]
    assert [len(ring) for ring in region.rings] == [4, 4]
    section = rk.Section([region])
    assert section.mass == pytest.approx(5.0 * 2400.0, rel=1e-14, abs=0.0)
    reference = rk.coefficient_of_restitution(rk.Section([rk.Region(BOX, 2400.0, [HOLE])]), "ked")
    assert rk.coefficient_of_restitution(section, "ked") == pytest.approx(reference, rel=1e-14, abs=0.0)
    assert reference != pytest.approx(rk.coefficient_of_restitution(rk.Section([rk.Region(BOX)]), "ked"), rel=1e-6)


def test_users_arrays_are_not_touched_nor_shared():
    """Changing the array that an outline was given as changes nothing."""
    given = np.array(BOX, dtype=float)
    region = rk.Region(given)
    given[:] = 0.0
    assert area(region.outline) == 6.0


def test_constructors():
    """Rectangle, trapezoid, points, regular polygon, ellipse: areas and centres from elementary geometry."""
    assert rk.Section.from_rectangle(2, 3, density=1.0).mass == pytest.approx(6.0)
    trapezoid = rk.Section.from_trapezoid(1.0, 0.4, 2.5, density=1.0)
    assert trapezoid.mass == pytest.approx(0.7 * 2.5)
    assert trapezoid.centre == pytest.approx((0.5, 2.5 / 3 * (1.0 + 2 * 0.4) / 1.4))
    assert rk.Section.from_trapezoid(1.0, 0.4, 2.5, lean=0.1).centre[0] > 0.5
    hexagon = rk.Section.from_regular_polygon(6, 2.0, density=1.0, depth=3.0)
    assert hexagon.mass == pytest.approx(3.0 * 1.5 * np.sqrt(3.0) * 4.0)
    assert hexagon.feet == pytest.approx((-1.0, 1.0))
    assert hexagon.is_symmetric
    ellipse = rk.Section.from_ellipse(2.0, 3.0, sides=200, density=1.0)
    assert ellipse.mass == pytest.approx(np.pi * 1.5, rel=2e-4)  # inscribed: (2 pi/n)^2/6 = 1.6e-4 too small
    assert ellipse.mass != pytest.approx(np.pi * 1.5, rel=1e-5)
    points = rk.Section.from_points(BOX, 10.0, holes=[HOLE], feet=(0.2, 1.9), depth=0.1)
    assert points.mass == pytest.approx(5.0)
    assert points.feet == pytest.approx((0.2, 1.9))
    assert "2 region" not in repr(points)
    assert "8 vertices" in repr(points)


@pytest.mark.parametrize("sides", [2, 0, -3, 3.5, "6", None, True])
def test_bad_number_of_sides(sides):
    """A polygon has a whole number of sides, at least three."""
    for make in (rk.Section.from_regular_polygon, lambda n, r: rk.Section.from_ellipse(r, r, n)):
        with pytest.raises(InvalidValueError, match="sides must be a whole number >= 3, got"):
            make(sides, 1.0)


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf"), "1", None, True], ids=repr)
def test_bad_sizes_of_shapes(bad):
    """Every shape refuses sizes that are none, by the name of the size."""
    for make, name in [
        (lambda: rk.Section.from_rectangle(bad, 1.0), "width"),
        (lambda: rk.Section.from_rectangle(1.0, bad), "height"),
        (lambda: rk.Section.from_trapezoid(bad, 1.0, 1.0), "base"),
        (lambda: rk.Section.from_trapezoid(1.0, bad, 1.0), "top"),
        (lambda: rk.Section.from_trapezoid(1.0, 1.0, bad), "height"),
        (lambda: rk.Section.from_regular_polygon(5, bad), "radius"),
        (lambda: rk.Section.from_ellipse(bad, 1.0), "width"),
        (lambda: rk.Section.from_ellipse(1.0, bad), "height"),
        (lambda: rk.Section.from_rectangle(1.0, 1.0, depth=bad), "depth"),
        (lambda: rk.Section.from_rectangle(1.0, 1.0, density=bad), "density"),
    ]:
        with pytest.raises(InvalidValueError, match=f"^{name} must be "):
            make()


OUTLINES = {
    "bow-tie": ([(0, 0), (1, 2), (1, 0), (0, 2)], "outline crosses or touches itself.*order of the points"),
    "figure of eight": ([(0, 0), (2, 0), (0, 2), (2, 2)], "crosses or touches itself"),
    "touches itself": ([(0, 0), (2, 0), (1, 1), (2, 2), (0, 2), (1, 1)], "outline"),
    "spike": ([(0, 0), (2, 0), (2, 2), (2, 3), (2, 2), (0, 2)], "outline"),
    "all on one line": ([(0, 0), (1, 0), (2, 0)], "outline"),
    "two points": ([(0, 0), (1, 0)], "at least 3 different points, got 2"),
    "one point thrice": ([(1, 1), (1, 1), (1, 1)], "at least 3 different points, got 0"),
    "empty": ([], "outline must be a list of"),
    "three coordinates": ([(0, 0, 0), (1, 0, 0), (1, 1, 0)], r"shape \(3, 3\)"),
    "flat list": ([0, 0, 1, 0, 1, 1], r"shape \(6,\)"),
    "words": ("square", "outline must be a list of"),
    "nothing": (None, "outline must be a list of"),
    "ragged": ([(0, 0), (1,), (1, 1)], "outline must be a list of"),
    "texts": ([("0", "a"), (1, 0), (1, 1)], "outline must be a list of"),
    "NaN": ([(0, 0), (1, float("nan")), (1, 1)], r"outline: point 1 must be finite, got \(1.0, nan\)"),
    "infinite": ([(0, 0), (float("inf"), 0), (1, 1)], "outline: point 1 must be finite"),
    "millimetres of a planet": ([(0, 0), (1e10, 0), (1e10, 1e10)], "check the unit"),
    "nanometres": ([(0, 0), (1e-10, 0), (1e-10, 1e-10)], "smaller than 1e-09 m"),
}


@pytest.mark.parametrize(("outline", "words"), OUTLINES.values(), ids=list(OUTLINES))
def test_outlines_that_are_none(outline, words):
    """An outline that crosses itself, has no area or no numbers is refused in one sentence with the cause."""
    with pytest.raises(GeometryError, match=words) as refusal:
        rk.Region(outline)
    assert "\n" not in str(refusal.value)


HOLES = {
    "outside": ([[(5, 1), (6, 1), (6, 2)]], "a hole lies outside the outline"),
    "around": ([[(-1, -1), (5, -1), (5, 5), (-1, 5)]], "hole and outline are not exchanged"),
    "crossing": ([[(1, 1), (3, 1), (3, 2), (1, 2)]], "a hole crosses the outline"),
    "same as outline": ([BOX], "hole"),
    "nested": ([HOLE, [(0.7, 1.2), (1.2, 1.2), (1.2, 1.7)]], "one hole lies inside another"),
    "twice": ([HOLE, HOLE], "hole"),
    "crossing each other": ([HOLE, [(1, 1.5), (1.8, 1.5), (1.8, 2.5), (1, 2.5)]], "hole crosses"),
    "bow-tie": ([[(0.5, 1), (1.5, 2), (1.5, 1), (0.5, 2)]], "hole 0 crosses or touches itself"),
    "cutting in two": ([[(0, 1), (1, 1.5), (2, 1), (1, 2)]], "cut the region in two|crosses the outline"),
    "two points": ([[(0.5, 1), (1.5, 1)]], "hole 0 must have at least 3 different points"),
    "a ring instead of a list of rings": (HOLE, "hole 0 must be a list of"),
    "a word": ("hole", "hole 0 must be a list of|holes must be a list"),
    "a number": (3, "holes must be a list of rings"),
    "NaN": ([[(0.5, 1), (float("nan"), 1), (1, 2)]], "hole 0: point 1 must be finite"),
}


@pytest.mark.parametrize(("holes", "words"), HOLES.values(), ids=list(HOLES))
def test_holes_that_are_none(holes, words):
    """Holes outside, around, across, nested, doubled or malformed are refused in one sentence with the
    cause."""
    with pytest.raises(GeometryError, match=words):
        rk.Region(BOX, 2400.0, holes)


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_places_in_messages(shift):
    """The message of a bow-tie names the crossing in the user's coordinates, also far away."""
    outline = [(x + shift, y) for x, y in [(0, 0), (1, 2), (1, 0), (0, 2)]]
    with pytest.raises(GeometryError, match=rf"near x = {shift + 0.5:.9g} m, y = 1 m"):
        rk.Region(outline)


@pytest.mark.parametrize("density", [0.0, -1.0, float("nan"), "heavy", None, True, 1e10], ids=repr)
def test_bad_densities(density):
    """Densities that are none are refused by name."""
    with pytest.raises(InvalidValueError, match=r"^density must be "):
        rk.Region(BOX, density)


def box(x0, y0, x1, y1, density=1.0, holes=()):
    return rk.Region([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], density, holes)


NO_SECTIONS = [
    *(
        (rk.Section, {"regions": [box(0, 0, 1, 1), *others]}, r"regions \d and \d overlap over .* m2; cut a hole")
        for others in (
            [box(0.5, 0.5, 1.5, 2)], [box(0, 0, 1, 1)], [box(0.2, 0.2, 0.8, 0.8)], [box(0.999, 0, 2, 1)],
            [box(1, 0, 2, 1), box(1.9, 0, 3, 1)],
        )
    ),
    *(
        (rk.Section, {"regions": regions}, "A Section needs a list of at least one Region")
        for regions in ([], (), None, "box", BOX, [BOX], [1], box(0, 0, 1, 1), [box(0, 0, 1, 1), None])
    ),
    (rk.Section.from_points, {"outline": [(0, 0), (1, 1), (0, 2), (-1, 1)]}, "touches the ground at one point"),
    (rk.Section.from_trapezoid, {"base": 1.0, "top": 1.0, "height": 2.0, "lean": 2.0}, "not stable"),
]  # fmt: skip


@pytest.mark.parametrize(("make", "given", "words"), NO_SECTIONS)
def test_what_is_no_section(make, given, words):
    """Regions that overlap, or are none, one foot, and a centre beside the base are refused with the cause."""
    with pytest.raises(GeometryError, match=words):
        make(**given)


@pytest.mark.parametrize(("dy", "words"), [(0.1, "above"), (-0.1, "below"), (5.0, "above")])
def test_ground(dy, words):
    """A body that floats or sinks is refused with its lowest point and what to pass instead."""
    outline = [(x, y + dy) for x, y in BOX]
    with pytest.raises(GeometryError, match=rf"y = {dy:.9g} m, is {words} the ground .*ground={dy:.9g}"):
        rk.Section.from_points(outline)
    assert rk.Section.from_points(outline, ground=dy).centre == pytest.approx((1.0, 1.5 + dy))


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "0", None, True], ids=repr)
def test_bad_ground_and_depth(bad):
    """Ground and depth are numbers."""
    with pytest.raises(InvalidValueError, match=r"^ground must be "):
        rk.Section.from_points(BOX, ground=bad)
    with pytest.raises(InvalidValueError, match=r"^depth must be "):
        rk.Section.from_points(BOX, depth=bad)


FEET = {
    "left outside": ((-0.1, 2.0), r"the left foot must lie on the base, x in \[0, 2\] m, got -0.1"),
    "right outside": ((0.0, 2.1), r"the right foot must lie on the base, x in \[0, 2\] m, got 2.1"),
    "swapped": ((2.0, 0.0), "the left foot must be left of the right foot, got 2 and 0 m"),
    "equal": ((1.0, 1.0), "the left foot must be left of the right foot"),
    "both left of the centre": (
        (0.0, 0.9),
        r"the centre of mass \(x = 1 m\) must lie between the feet \(0 and 0.9 m\)",
    ),
    "right under the centre": ((0.0, 1.0), "must lie between the feet"),
    "one": ((0.0,), "feet must be a pair"),
    "three": ((0.0, 1.0, 2.0), "feet must be a pair"),
    "number": (1.0, "feet must be a pair"),
    "NaN": ((0.0, float("nan")), "right foot must be finite"),
    "words": (("a", "b"), "left foot must be a number"),
    "booleans": ((False, True), "left foot must be a number"),
    "nothing": ((None, 2.0), "left foot must be a number"),
}


@pytest.mark.parametrize(("feet", "words"), FEET.values(), ids=list(FEET))
def test_feet_that_are_none(feet, words):
    """Feet outside the base, swapped, beside the centre or malformed are refused, at once and by
    with_feet."""
    with pytest.raises(InvalidValueError, match=words):
        rk.Section.from_points(BOX, feet=feet)
    if isinstance(feet, tuple) and len(feet) == 2:
        with pytest.raises(InvalidValueError, match=words):
            rk.Section.from_points(BOX).with_feet(*feet)


def test_contact_stretches():
    """Contact is cut at the feet, merged over touching regions, and skips gaps and points."""
    legs = [(0, 0), (0.2, 0), (0.2, 1), (0.8, 1), (0.8, 0), (1.0, 0), (1.0, 1.5), (0, 1.5)]
    portal = rk.Section.from_points(legs)
    assert np.ravel(portal.local_contact) == pytest.approx([-0.5, -0.3, 0.3, 0.5])
    assert np.ravel(portal.with_feet(0.1, 0.9).local_contact) == pytest.approx([-0.4, -0.3, 0.3, 0.4])
    two = rk.Section([box(0, 0, 1, 1), box(1, 0, 2, 1)])
    assert np.ravel(two.local_contact) == pytest.approx([-1.0, 1.0])
    pointed = rk.Section.from_points([(0, 0), (0.5, 0.2), (1, 0), (1, 2), (0, 2)])
    assert pointed.local_contact == ()
    assert pointed.feet == pytest.approx((0.0, 1.0))
    assert pointed.with_feet(0.0, 0.9).feet[1] != pytest.approx(1.0)


def test_sides_of_an_asymmetric_body():
    """A body with unequal sides refuses what depends on the side, and gives it per side."""
    section = rk.Section.from_points(BOX, feet=(0.5, 2.0))
    assert not section.is_symmetric
    names = "slenderness_ratio slenderness_angle semi_diagonal frequency_parameter uplift_acceleration"
    for name in names.split():
        with pytest.raises(AsymmetricBodyError, match=rf'{name} depends on the side.*side\("left"\)'):
            getattr(section, name)
    assert section.side("left").half_width == pytest.approx(0.5)
    assert section.side("right").half_width == pytest.approx(1.0)
    assert section.side("left").slenderness_ratio == pytest.approx(3.0)
    assert issubclass(AsymmetricBodyError, RockingError)


@pytest.mark.parametrize("shift", [0.1, 1e3, 1e6])
def test_symmetric_far_away(shift):
    """A symmetric body is still one where floats are coarse: its coordinates are off by 1e-10 m 1e6 m
    away."""
    outline = [(x * 0.15 + shift, y) for x, y in BOX]
    assert rk.Section.from_points(outline).slenderness_ratio == pytest.approx(10.0, rel=1e-8)


def test_mirrored_scaled_with_feet_leave_the_original():
    """Copies do not change the body they come from, nor its cached numbers."""
    section = rk.Section.from_points(BOX, 7.0, holes=[[(0.2, 1), (0.6, 1), (0.6, 2)]], feet=(0.3, 2.0))
    before = section.mass, section.centre, section.feet, section.local_contact
    mirrored = section.mirrored()
    assert mirrored.feet == pytest.approx((0.0, 1.7))
    assert mirrored.centre[0] == pytest.approx(2.0 - section.centre[0])
    assert mirrored.mirrored().centre == pytest.approx(section.centre)
    scaled = section.scaled(size=3.0, density=2.0)
    assert scaled.mass == pytest.approx(27.0 * 2.0 * section.mass)
    assert scaled.moment_of_inertia == pytest.approx(3.0**5 * 2.0 * section.moment_of_inertia)
    assert section.with_feet(0.1, 1.9).feet == pytest.approx((0.1, 1.9))
    assert before == (section.mass, section.centre, section.feet, section.local_contact)
