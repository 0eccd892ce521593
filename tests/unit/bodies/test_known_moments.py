"""Bodies of known mass, centre of mass or moment of inertia: what follows, what is assumed, what is refused."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.formats import body_from_toml, body_to_toml
from rocking.bodies.moments import PlaneMoments, combined_plane, quarters, ring_moments
from rocking.bodies.solid import Part, Solid, box, cylinder, rotation_about
from rocking.bodies.solid import cone as upright_cone
from rocking.errors import GeometryError, InvalidValueError
from rocking.restitution.space import edge_coefficient, unit_energies

pytestmark = pytest.mark.verifies(room="bodies")

G = 9.80665
SIZE = {"width": 0.8, "height": 2.0, "depth": 0.6}
OUTLINE = [(0.0, 0.0), (1.0, 0.0), (0.7, 2.5), (0.3, 2.5)]


def cabinet(**known):
    return rk.Block(**SIZE, **({"mass": 300.0, "centre": (0.42, 0.7)} | known))


@pytest.mark.verifies("closed form", "alpha, R, p, Housner's r and uplift by hand", within="1e-14", control="within")
def test_a_block_with_a_lowered_centre():
    """A cabinet with its centre low and off the middle has alpha, R, p, r and uplift of the closed forms."""
    body = cabinet(moment_of_inertia=95.0)
    m, y, levers, inertia = 300.0, 0.7, {"left": 0.42, "right": 0.38}, 95.0
    for foot, other in (("left", "right"), ("right", "left")):
        side, b, old = body.side(foot), levers[foot], levers[other]
        over = inertia + m * (b * b + y * y)
        assert side.slenderness_angle == pytest.approx(math.atan(b / y), rel=1e-14, abs=0.0)
        assert side.semi_diagonal == pytest.approx(math.hypot(b, y), rel=1e-14, abs=0.0)
        assert side.frequency_parameter == pytest.approx(math.sqrt(m * G * math.hypot(b, y) / over), rel=1e-14, abs=0.0)
        assert side.uplift_acceleration == pytest.approx(G * b / y, rel=1e-14, abs=0.0)
        # angular momentum about the new foot: (I + m (y^2 - b b_old)) / I_O
        r = (inertia + m * (y * y - b * old)) / over
        assert rk.coefficient_of_restitution(body, "housner", foot=foot) == pytest.approx(r, rel=1e-14, abs=0.0)
        assert rk.coefficient_of_restitution(rk.Block(**SIZE), "housner") != pytest.approx(r, rel=1e-2)
    assert (body.mass, *body.centre) == (300.0, 0.42, 0.7)
    assert body.moment_of_inertia == pytest.approx(95.0, rel=1e-15, abs=0.0)


@pytest.mark.verifies("closed form", "four homogeneous quarters", within="1e-13", control="within")
@pytest.mark.parametrize("centre", [(0.42, 0.7), (0.4, 0.05), (0.1, 1.9), (0.4, 1.0)])
def test_an_assumed_moment_is_that_of_four_quarters(centre):
    """A moment that is not given is that of four homogeneous rectangles that meet at the centre, and that is said."""
    body, (x, y) = cabinet(centre=centre), centre
    quarter = {  # mass of a quarter by the lever rule: the more, the nearer its far corner is to the centre
        (left, low): 300.0 * ((0.8 - x if left else x) / 0.8) * ((2.0 - y if low else y) / 2.0)
        for left in (True, False)
        for low in (True, False)
    }
    moments = []
    for (left, low), mass in quarter.items():
        far = np.array([0.0 if left else 0.8, 0.0 if low else 2.0])
        ring = np.array([[x, y], [far[0], y], far, [x, far[1]]])
        plain = ring_moments(ring)
        moments.append(plain.times(mass / plain.mass))
    together = combined_plane(moments)
    assert (together.mass, together.x, together.y) == pytest.approx((300.0, x, y), rel=1e-13)
    assert body.moment_of_inertia == pytest.approx(together.polar, rel=1e-13, abs=0.0)
    assert (body.local_moments.xx, body.local_moments.yy) == pytest.approx((together.xx, together.yy), rel=1e-13)
    assert "moment of inertia assumed" in body.assumed[0]
    assert "moment of inertia assumed" not in " ".join(cabinet(moment_of_inertia=95.0).assumed)
    homogeneous = 300.0 * (0.64 + 4.0) / 12.0
    assert (body.moment_of_inertia == pytest.approx(homogeneous)) is (centre == (0.4, 1.0))


def test_a_body_that_knows_what_it_is_does_not_change():
    """A homogeneous block told its own centre and moment has the same coefficient under every model, KED's too."""
    plain = rk.Block(**SIZE)
    told = rk.Block(**SIZE, centre=plain.centre, moment_of_inertia=plain.moment_of_inertia)
    for name in rk.restitution.models():
        if name not in {"fixed", "calibrated"}:
            r = rk.coefficient_of_restitution(plain, name)
            assert rk.coefficient_of_restitution(told, name) == pytest.approx(r, rel=1e-9), name
    assert plain.known is None
    assert plain.assumed == rk.Block(**SIZE, density=plain.density).assumed
    lowered = cabinet(centre=(0.4, 0.7))
    assert rk.coefficient_of_restitution(lowered, "ked") != pytest.approx(
        rk.coefficient_of_restitution(plain, "ked"), rel=1e-3
    )


@pytest.mark.verifies("computed anew", "regions with the densities of the quarters", within="1e-12", control="within")
def test_ked_of_an_assumed_distribution():
    """KED of a block whose centre alone is known is that of a Section of four regions, and not of two."""
    x, y = 0.42, 0.7
    plan = [(0.0, x, 0.8 - x), (x, 0.8, x)], [(0.0, y, 2.0 - y), (y, 2.0, y)]
    regions = [
        rk.Region([(a, c), (b, c), (b, d), (a, d)], 625.0 * w * v / ((b - a) * (d - c)))
        for a, b, w in plan[0]
        for c, d, v in plan[1]
    ]
    known, spread = cabinet(), rk.Section(regions, depth=0.6)
    assert spread.centre == pytest.approx((x, y), rel=1e-12)
    assert spread.moment_of_inertia / spread.mass == pytest.approx(known.moment_of_inertia / 300.0, rel=1e-12)
    for foot in ("left", "right"):
        r = rk.coefficient_of_restitution(spread, "ked", foot=foot)
        assert rk.coefficient_of_restitution(known, "ked", foot=foot) == pytest.approx(r, rel=1e-12)
        other = rk.coefficient_of_restitution(cabinet(moment_of_inertia=60.0), "ked", foot=foot)
        assert other != pytest.approx(r, rel=1e-2)


@pytest.mark.parametrize("share", [0.2, 0.9, 1.0, 1.7, 2.9])
def test_an_assumed_distribution_has_the_moments(share):
    """Mass, centre and moment of what KED takes are those of the body, for little moment and for much."""
    known = cabinet(moment_of_inertia=106.96 * share)
    rings, corners, (inside, outside) = quarters(known.local_moments, known.local_box)
    parts = [ring_moments(ring if ring_moments(ring).mass > 0.0 else ring[::-1]) for ring in rings]  # counter-clockwise
    spread = [part.times(mass / part.mass) for part, mass in zip(parts, inside.tolist(), strict=True) if mass > 0.0]
    points = [PlaneMoments(m, x, y, 0.0, 0.0) for m, (x, y) in zip(outside.tolist(), corners.tolist(), strict=True)]
    together = combined_plane([*spread, *points])
    assert (together.mass, together.x, together.y) == pytest.approx((300.0, 0.42, 0.7), rel=1e-12)
    assert together.polar == pytest.approx(106.96 * share, rel=1e-12)
    assert (outside > 1e-9).any() == (share > 1.0)
    assert 0.0 < rk.coefficient_of_restitution(known, "ked") < 1.0


@pytest.mark.verifies("computed anew", "the smallest enclosing circle of the corners", within="1e-9", control="within")
def test_the_largest_moment_of_a_polygon():
    """The bound is min over q of (farthest corner from q)^2 - |c - q|^2; more is refused, and a little less is not."""
    from scipy.optimize import minimize

    vertices, centre = np.array(OUTLINE), np.array([0.55, 0.6])
    found = minimize(
        lambda q: ((vertices - q) ** 2).sum(axis=1).max() - ((centre - q) ** 2).sum(), centre, method="Nelder-Mead",
        options={"xatol": 1e-12, "fatol": 1e-14, "maxiter": 4000},
    )  # fmt: skip
    most = 100.0 * float(found.fun)

    def section(moment):
        return rk.Section.from_points(OUTLINE, mass=100.0, centre=(0.55, 0.6), moment_of_inertia=moment)

    assert section(most * (1.0 - 1e-9)).moment_of_inertia == most * (1.0 - 1e-9)
    with pytest.raises(GeometryError, match=r"moment_of_inertia must be at most .* got .* about the centre of mass"):
        section(most * 1.001)
    assumed = rk.Section.from_points(OUTLINE, mass=100.0, centre=(0.55, 0.6)).moment_of_inertia
    own = rk.Section.from_points(OUTLINE, mass=100.0)
    half = minimize(
        lambda q: ((vertices - q) ** 2).sum(axis=1).max() - ((np.array(own.centre) - q) ** 2).sum(), own.centre,
        method="Nelder-Mead", options={"xatol": 1e-12, "fatol": 1e-14, "maxiter": 4000},
    )  # fmt: skip
    assert assumed == pytest.approx(own.moment_of_inertia * float(found.fun) / float(half.fun), rel=1e-9)


def test_mirror_scale_feet_and_section():
    """A mirror moves the centre, a scale all three as their dimensions say, new feet and the Section none of them."""
    body = cabinet(moment_of_inertia=95.0)
    assert body.mirrored().centre == pytest.approx((0.38, 0.7))
    assert body.mirrored().side("left").slenderness_ratio == pytest.approx(body.side("right").slenderness_ratio)
    bigger = body.scaled(size=2.0, density=3.0)
    assert (bigger.mass, *bigger.centre) == pytest.approx((300.0 * 24.0, 0.84, 1.4), rel=1e-14)
    assert bigger.moment_of_inertia == pytest.approx(95.0 * 96.0, rel=1e-14)
    section = body.to_section()
    for same in (
        section,
        section.mirrored().mirrored(),
        body.with_feet(0.1, 0.7),
        section.scaled(size=2.0).scaled(size=0.5),
    ):
        assert (same.mass, same.moment_of_inertia) == pytest.approx((300.0, 95.0), rel=1e-13)
        assert same.known.centre[1] == pytest.approx(0.7, rel=1e-14)
    assert section.mirrored().side("left").half_width == pytest.approx(0.38)
    assert section.scaled(size=2.0).moment_of_inertia == pytest.approx(95.0 * 32.0, rel=1e-14)
    assert body != cabinet()
    assert cabinet() == cabinet()
    assert len({cabinet(), cabinet(), body}) == 2


@pytest.mark.parametrize(
    ("known", "error", "words"),
    [
        (
            {"centre": (0.9, 0.5)},
            GeometryError,
            r"x in \(0, 0\.8\) m, .* got \(0\.9 m, 0\.5 m\); check the origin",
        ),
        ({"centre": (0.4, 0.0)}, GeometryError, "within the outline"),
        ({"centre": (0.4, 2.1)}, GeometryError, "within the outline"),
        ({"centre": 0.7}, GeometryError, "pair"),
        ({"centre": (0.4, 0.7, 0.1)}, GeometryError, "pair"),
        ({"centre": (0.4, "low")}, InvalidValueError, "y of the centre must be a number"),
        ({"centre": (math.nan, 0.7)}, InvalidValueError, "x of the centre must be finite"),
        ({"moment_of_inertia": 0.0}, InvalidValueError, "moment_of_inertia must be > 0 kg m2"),
        ({"moment_of_inertia": math.inf}, InvalidValueError, "moment_of_inertia must be finite"),
        ({"moment_of_inertia": 400.0}, GeometryError, "at most 320.88 kg m2"),
        ({"mass": 0.0}, InvalidValueError, "mass must be > 0 kg"),
        ({"mass": -3.0}, InvalidValueError, "mass must be > 0 kg"),
        ({"mass": "300"}, InvalidValueError, "mass must be a number"),
        ({"mass": 1e300}, InvalidValueError, "density from mass and size"),
        ({"mass": 300.0, "density": 200.0}, InvalidValueError, "not both"),
    ],
)
def test_what_no_block_is(known, error, words):
    """A centre outside, a moment that no mass has, no mass, mass and density: each refused with value and cause."""
    for make in (rk.Block, rk.Section.from_rectangle):
        with pytest.raises(error, match=words):
            make(**SIZE, **({"mass": 300.0, "centre": (0.42, 0.7)} | known))


def test_a_centre_in_the_notch_of_the_box_is_outside():
    """Of a trapezoid the corner of the box is outside the hull; of an angle its hollow is inside of it."""
    with pytest.raises(GeometryError, match="convex hull"):
        rk.Section.from_points(OUTLINE, mass=100.0, centre=(0.2, 2.0))
    angle = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.2), (0.2, 0.2), (0.2, 1.0), (0.0, 1.0)]
    assert rk.Section.from_points(angle, mass=1.0, depth=0.01, centre=(0.3, 0.3)).centre == pytest.approx((0.3, 0.3))
    with pytest.raises(GeometryError, match="must lie between the feet"):
        rk.Section.from_points(OUTLINE, feet=(0.3, 0.7), centre=(0.75, 0.6))


def test_only_a_homogeneous_block_changes_its_sides():
    """Maps over width, height or slenderness need a homogeneous block; over the semi-diagonal any will do."""
    from rocking.studies.question import changed_body

    assert changed_body(cabinet(), {"semi_diagonal": 2.0}).side("right").semi_diagonal == pytest.approx(2.0)
    with pytest.raises(InvalidValueError, match="homogeneous Block"):
        changed_body(cabinet(), {"height": 3.0})
    with pytest.raises(InvalidValueError, match="Remove centre"):
        rk.Block.from_angle(0.3, 1.0, centre=(0.1, 0.1))
    assert rk.Block.from_angle(0.3, 1.0, mass=50.0).mass == pytest.approx(50.0)


@pytest.mark.parametrize(
    "text",
    [
        "[block]\nwidth = 80\nheight = 200\nmass = 300\ncentre = [42, 70]\nmoment_of_inertia = 95",
        "[block]\nwidth = 80\nheight = 200\nfeet = [5, 75]\nmass = 300\ncentre = [42, 70]",
        "[trapezoid]\nbase = 100\ntop = 40\nheight = 250\nmass = 300\ncentre = [42, 70]",
        "[section]\nmass = 300\ncentre = [42, 70]\n[[section.region]]\noutline = [[0, 0], [100, 0], [50, 250]]",
    ],
)
def test_body_files_round_trip(text):
    """Lengths of a file are in its unit, mass in kg; what is written gives the same body back, to the last bit."""
    body = body_from_toml(f'units = "cm"\n{text}')
    assert body.mass == pytest.approx(300.0, rel=1e-14)
    assert body.centre == pytest.approx((0.42, 0.7), rel=1e-14)
    again = body_from_toml(body_to_toml(body))
    assert again.local_moments == body.local_moments
    assert again.known == body.known
    assert body_from_toml(f'units = "cm"\n{text}'.replace("70]", "80]")).centre != body.centre


def solid(**known):
    return Solid(Part(box(0.8, 0.6, 2.0)), **({"mass": 300.0, "centre": (0.02, 0.0, 0.7)} | known))


@pytest.mark.verifies("closed form", "the plane body of the same moments", within="1e-12", control="within")
def test_a_solid_of_known_moments_is_the_plane_one():
    """A box of known centre has the plane block's Housner coefficients over its edges, and its moments in plane."""
    plane = cabinet()
    for body in (solid(), Solid.from_section(plane)):
        side = body.in_plane(0.0)
        assert side.mass == pytest.approx(300.0, rel=1e-12)
        assert side.moment_of_inertia == pytest.approx(plane.moment_of_inertia, rel=1e-12)
        for foot in ("left", "right"):
            r = rk.coefficient_of_restitution(plane, "housner", foot=foot)
            assert side.side(foot).frequency_parameter == pytest.approx(plane.side(foot).frequency_parameter, rel=1e-12)
            assert rk.coefficient_of_restitution(side, "housner", foot=foot) == pytest.approx(r, rel=1e-12)
            edge = 3 if foot == "right" else 1
            assert edge_coefficient(solid(), "housner-3d", start=edge) == pytest.approx(r, rel=1e-12)
    assert edge_coefficient(solid(centre=(0.02, 0.0, 1.0)), "housner-3d", start=1) != pytest.approx(
        edge_coefficient(solid(), "housner-3d", start=1), rel=1e-3
    )


def test_a_solid_turns_mirrors_and_scales_what_it_knows():
    """Centre and inertia turn with the body, mirror with it, and grow with the third and fifth power of its size."""
    tensor = np.array([[95.0, 4.0, 0.0], [4.0, 100.0, 3.0], [0.0, 3.0, 25.0]])
    body = solid(inertia=tensor)
    turn = rotation_about([0.0, 0.0, 1.0], 0.3)
    assert body.turned(0.3).inertia == pytest.approx(turn @ tensor @ turn.T, rel=1e-12)
    assert body.turned(0.3).centre[:2] == pytest.approx((turn @ [0.02, 0.0, 0.0])[:2], rel=1e-12)
    mirror = np.diag([-1.0, 1.0, 1.0])
    assert body.mirrored().inertia == pytest.approx(mirror @ tensor @ mirror, rel=1e-12)
    assert body.scaled(size=2.0, density=3.0).inertia == pytest.approx(96.0 * tensor, rel=1e-12)
    assert body.scaled(size=2.0, density=3.0).mass == pytest.approx(7200.0, rel=1e-12)
    assert solid(inertia=(95.0, 100.0, 25.0)).inertia == pytest.approx(np.diag([95.0, 100.0, 25.0]), rel=1e-12)
    assert any("inertia assumed" in each for each in solid().assumed)
    assert body.assumed == ()


@pytest.mark.parametrize(
    ("known", "error", "words"),
    [
        ({"centre": (0.5, 0.0, 0.7)}, GeometryError, "within the convex hull"),
        ({"centre": (0.0, 0.0, 3.0)}, GeometryError, "within the convex hull"),
        ({"centre": (0.0, 0.7)}, GeometryError, "three finite numbers"),
        ({"inertia": (1.0, 1.0, 5.0)}, GeometryError, "triangle inequality"),
        ({"inertia": (20.0, 20.0, -3.0)}, GeometryError, "triangle inequality"),
        ({"inertia": (1e4, 1e4, 1e4)}, GeometryError, "impossible for masses within the body"),
        ({"inertia": [1.0, 2.0]}, GeometryError, "symmetric tensor"),
        ({"inertia": [[95.0, 4.0, 0.0], [-4.0, 100.0, 0.0], [0.0, 0.0, 25.0]]}, GeometryError, "symmetric tensor"),
        ({"inertia": (math.nan, 1.0, 1.0)}, GeometryError, "symmetric tensor"),
        ({"mass": 0.0}, InvalidValueError, "mass must be > 0 kg"),
    ],
)
def test_what_no_solid_is(known, error, words):
    """A centre outside, an inertia that no mass within has, a tensor that is none, no mass: refused with the cause."""
    with pytest.raises(error, match=words):
        solid(**known)


def test_a_centre_beside_a_cone_is_outside():
    """In the box of a cone but beside its slope: outside of the hull; on its axis inside."""
    shape = Part(upright_cone(1.0, 2.0))
    assert Solid(shape, centre=(0.0, 0.0, 1.5)).centre[2] == 1.5
    with pytest.raises(GeometryError, match="convex hull"):
        Solid(shape, centre=(0.3, 0.0, 1.5))
    with pytest.raises(InvalidValueError, match="not both"):
        Solid(Part(box(1.0, 1.0, 1.0), 2000.0), mass=5.0)


@pytest.mark.slow
def test_models_in_space_that_need_the_distribution_refuse():
    """ked-3d and the units of a body of known moments are refused, and the models that need no more are named."""
    from rocking.restitution.space import impact_in_space

    body = solid()
    with pytest.raises(InvalidValueError, match=r"needs the distribution of mass.*housner-3d"):
        edge_coefficient(body, "ked-3d")
    edges = body.base.edges
    result = impact_in_space(body, -edges[0].direction, pivot=edges[0], onto=body.base.opposite(0), model="housner-3d")
    with pytest.raises(InvalidValueError, match="needs the distribution of mass"):
        unit_energies(result)
    with pytest.raises(InvalidValueError, match="needs the distribution of mass"):
        rk.simulate(body, {"x": rk.pulses.sine(7.0, 0.8)}, restitution="ked-3d")
    assert rk.simulate(body, {"x": rk.pulses.sine(7.0, 0.8)}, restitution="housner-3d").outcome is not None
    standings = {row.name: row.standing.name for row in rk.evidence.recommend(body).models}
    assert standings == standings | {"ked-3d": "EXCLUDED", "housner-3d": "UNJUDGED"}


@pytest.mark.verifies("closed form", "extents of a box and of a drum", within="1e-12", control="within")
def test_in_plane():
    """From the side a box is as wide as its base in that direction, a drum the same all round, depth what is behind."""
    crate = Solid(Part(box(1.0, 2.0, 4.0), 500.0))
    for azimuth, width in ((0.0, 1.0), (0.5 * math.pi, 2.0), (0.3, math.cos(0.3) + 2.0 * math.sin(0.3))):
        side = crate.in_plane(azimuth)
        assert side.feet[1] - side.feet[0] == pytest.approx(width, rel=1e-12)
        assert side.mass == pytest.approx(4000.0, rel=1e-12)
        along = np.array([math.cos(azimuth), math.sin(azimuth)])
        about = np.array([-along[1], along[0], 0.0])
        assert side.moment_of_inertia == pytest.approx(about @ crate.inertia @ about, rel=1e-12)
        assert side.centre == pytest.approx((0.0, 2.0), abs=1e-12)
    assert crate.in_plane(0.0).depth == pytest.approx(2.0)
    assert rk.coefficient_of_restitution(crate.in_plane(0.0), "ked") == pytest.approx(
        rk.coefficient_of_restitution(rk.Block(width=1.0, height=4.0), "ked"), rel=1e-9
    )
    assert crate.in_plane(0.3).feet != pytest.approx(crate.in_plane(0.0).feet, rel=1e-2)
    drum = Solid(Part(cylinder(1.0, 3.0)))
    first, second = drum.in_plane(0.0), drum.in_plane(1.234)
    assert first.feet == pytest.approx(second.feet, rel=1e-12)
    assert first.slenderness_ratio == pytest.approx(3.0, rel=1e-12)
    assert second.moment_of_inertia == pytest.approx(first.moment_of_inertia, rel=1e-12)
    back = Solid.from_section(cabinet()).in_plane(math.pi)
    assert back.side("left").half_width == pytest.approx(0.38, rel=1e-12)
    with pytest.raises(InvalidValueError, match="azimuth"):
        crate.in_plane("north")


def test_known_moments_go_with_the_body_into_another_pose():
    """Set down on another face, a known centre and inertia turn with the body: about any axis of the body the same."""
    solid = Solid([box(1.0, 2.0, 3.0)], centre=(0.1, -0.2, 1.3), inertia=np.diag([9.0, 8.0, 5.0]) * 100.0)
    for pose in solid.equilibria().stable:
        lying = solid.settled(pose)
        assert lying.centre == pytest.approx([0.0, 0.0, pose.height], abs=1e-12)
        turned = pose.rotation.T @ lying.local_moments.inertia @ pose.rotation
        assert turned == pytest.approx(np.diag([900.0, 800.0, 500.0]), abs=1e-9)
    assert solid.equilibria().stable[0].height != pytest.approx(
        Solid([box(1.0, 2.0, 3.0)]).equilibria().stable[0].height
    )
