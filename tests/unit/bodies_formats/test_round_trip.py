"""Written bodies come back the same, to the last bit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking import conventions
from rocking.bodies.formats import body_from_toml, body_to_toml
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

SIZES = st.floats(1e-3, 1e3)
DENSITIES = st.floats(1e-3, 1e5)


@pytest.mark.verifies("same bits", "the block that was written", control="test_a_changed_last_digit_is_noticed")
@given(width=SIZES, height=SIZES, depth=SIZES, density=DENSITIES)
def test_block(width, height, depth, density):
    """Every block equals what its own text gives."""
    block = rk.Block(width=width, height=height, depth=depth, density=density)
    assert body_from_toml(body_to_toml(block)) == block


def same(a, b):
    """Whether two sections agree to the last bit, polygons, feet and place."""
    assert (a.depth, a.ground, a.origin_x, a.local_feet) == (b.depth, b.ground, b.origin_x, b.local_feet)
    assert len(a.regions) == len(b.regions)
    for one, other in zip(a.regions, b.regions, strict=True):
        assert one.density == other.density
        assert all(np.array_equal(p, q) for p, q in zip(one.rings, other.rings, strict=True))
    assert (a.mass, a.centre, a.moment_of_inertia) == (b.mass, b.centre, b.moment_of_inertia)


@pytest.mark.slow
@pytest.mark.verifies("same bits", "the section that was written", control="test_a_changed_last_digit_is_noticed")
@settings(max_examples=300)
@given(
    x=st.floats(-1e7, 1e7) | st.floats(-2.0, 2.0),
    ground=st.floats(-1e3, 1e3) | st.just(0.0),
    width=st.floats(0.1, 50.0),
    height=st.floats(0.1, 50.0),
    foot=st.floats(0.0, 0.4),
    holed=st.booleans(),
    depth=SIZES,
    density=DENSITIES,
)
def test_section(x, ground, width, height, foot, holed, depth, density):
    """Sections anywhere, with feet, hole and two materials, come back to the last bit."""
    box = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    size, there = np.array([width, height]), np.array([x, ground])
    holes = [(box * 0.3 + 0.31) * size + there] if holed else []
    regions = [rk.Region(box * size + there, density, holes)]
    top = box * size + there
    top[:, 1] += float(regions[0].outline[:, 1].max()) - top[0, 1]
    regions.append(rk.Region(top, 2.0 * density))
    left, right = float(regions[0].outline[:, 0].min()), float(regions[0].outline[:, 0].max())
    feet = (left + foot * (right - left), right) if foot else None
    section = rk.Section(regions, feet, depth=depth, ground=ground)
    same(body_from_toml(body_to_toml(section)), section)


@pytest.mark.verifies("same bits", "the section that was written", control="test_a_changed_last_digit_is_noticed")
@pytest.mark.parametrize(
    "section",
    [
        rk.Section.from_ellipse(0.7, 2.1, 64),
        rk.Section.from_regular_polygon(7, 1.3),
        rk.Section.from_trapezoid(1.1, 0.3, 2.7, lean=0.1, feet=(0.05, 1.0)),
        rk.Block(width=0.3, height=0.9).with_feet(0.1, 0.25).to_section(),
    ],
)
def test_shapes(section):
    """Shapes with odd coordinates come back to the last bit."""
    same(body_from_toml(body_to_toml(section)), section)


@pytest.mark.verifies("negative control", "fifteen digits")
def test_a_changed_last_digit_is_noticed():
    """Negative control: fifteen digits instead of all of them do not come back the same."""
    block = rk.Block(width=0.1 + 0.2, height=1.0)
    text = body_to_toml(block)
    assert repr(block.width) in text
    assert body_from_toml(text.replace(repr(block.width), f"{block.width:.15g}")) != block


@pytest.mark.parametrize("change", [{"size": 1 / 3}, {"size": 1e-8}, {"density": 0.7}])
def test_scaled_sections_keep_what_matters(change):
    """Mirrored and scaled sections, even scaled to nothing far away, keep slenderness and mass to rounding."""
    section = rk.Section.from_trapezoid(1.1, 0.3, 2.7, lean=0.1).scaled(**change)
    far = rk.Section.from_points([(1e6, 5.0), (1e6 + 1, 5.0), (1e6 + 0.8, 8.0)], ground=5.0).scaled(**change)
    for body in (section, section.mirrored(), far, far.mirrored()):
        back = body_from_toml(body_to_toml(body))
        assert back.mass == pytest.approx(body.mass, rel=1e-8)
        for foot in ("left", "right"):
            assert back.side(foot).slenderness_ratio == pytest.approx(body.side(foot).slenderness_ratio, rel=1e-8)


@pytest.mark.verifies("same bits", "the points that were written", control="test_a_changed_last_digit_is_noticed")
@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(0.01, 9.0), st.floats(0.1, 9.0)), min_size=1, max_size=9))
def test_mass_points(points):
    """Points, masses, feet and contact come back to the last bit."""
    xy, masses = [p[:2] for p in points], [p[2] for p in points]
    for contact in (None, [(-1.5, -0.3), (0.1, 1.25)]):
        body = rk.MassPoints(xy, masses, (-1.5, 1.25), contact)
        back = body_from_toml(body_to_toml(body))
        assert np.array_equal(back.points, body.points)
        assert np.array_equal(back.masses, body.masses)
        assert (back.feet, back.local_contact) == (body.feet, body.local_contact)


def test_other_bodies_are_not_written():
    """What has no table of its own is refused."""
    with pytest.raises(InvalidValueError, match="has no body file"):
        body_to_toml(3.0)


def test_units_scale_lengths_and_nothing_else():
    """The same statue in cm, mm, in and m has one slenderness, and densities stay in kg/m3."""
    bodies = [
        body_from_toml(
            f'units = "{u}"\n[trapezoid]\nbase = {1 / k!r}\ntop = {0.5 / k!r}\nheight = {3 / k!r}\ndepth = {1 / k!r}'
        )
        for u, k in conventions.LENGTH_UNITS.items()
    ]
    assert all(math.isclose(body.mass, bodies[0].mass, rel_tol=1e-14) for body in bodies)
