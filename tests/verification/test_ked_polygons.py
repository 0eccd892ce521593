"""KED of any polygons: against slices integrated in 30 digits, exact rational moments, its identities.

REF numbers: see CONTRIBUTING.md.
"""

from fractions import Fraction
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_cases import polygons
from scipy.integrate import dblquad

import rocking as rk
from rocking.restitution import projected_moment

pytestmark = pytest.mark.verifies(room="restitution in the plane")

# --- the oracle: horizontal slices, exact along x, 25-digit quadrature along y; nothing is summed a


def exact(points):
    """Vertices as fractions: exactly the floats that the package was given."""
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in points]


def bands(rings):
    """Bands between neighbouring vertex heights, each with the edges that cross it, from left to right."""
    edges = [(a, b) for ring in rings for a, b in zip(ring, [*ring[1:], ring[0]], strict=True) if a[1] != b[1]]
    heights = sorted({y for ring in rings for _, y in ring})
    for low, high in pairwise(heights):
        middle = (low + high) / 2
        lines = []
        for (xa, ya), (xb, yb) in edges:
            if min(ya, yb) < middle < max(ya, yb):
                slope = (xb - xa) / (yb - ya)
                lines.append((xa + slope * (middle - ya), xa + slope * (low - ya), slope))
        lines.sort()
        yield low, high, [(x0, slope) for _, x0, slope in lines]


def number(value):
    return mp.mpf(value.numerator) / value.denominator


def kept_of(rings):
    """Int y^4/(x^2 + y^2) dA over one polygon with holes (rings in any order and sense), foot at the
    origin."""
    total = mp.mpf(0)
    for low, high, lines in bands(rings):
        floor, pairs = number(low), [(number(x0), number(slope)) for x0, slope in lines]

        def slice_(y, floor=floor, pairs=pairs):
            turn = [mp.atan2(x0 + slope * (y - floor), y) for x0, slope in pairs]
            return y**3 * mp.fsum(b - a for a, b in zip(turn[::2], turn[1::2], strict=True))

        top = number(high)
        cuts = [floor, top] if low > 0 else [floor, top / 64, top / 8, top]
        value, doubt = mp.quad(slice_, cuts, error=True)
        assert doubt <= 1e-18 * max(abs(value), mp.mpf(10) ** -30)
        total += value
    return total


def moments_of(regions):
    """Mass, first and second moments of polygons as exact fractions, by fans of triangles about the
    origin."""
    m = mx = my = mxx = myy = Fraction(0)
    for outline, density, holes in regions:
        for ring, sign in [(outline, 1), *((hole, -1) for hole in holes)]:
            parts = []
            for (x0, y0), (x1, y1) in zip(ring, [*ring[1:], ring[0]], strict=True):
                area = (x0 * y1 - x1 * y0) / 2
                parts.append(
                    (
                        area,
                        area * (x0 + x1) / 3,
                        area * (y0 + y1) / 3,
                        area * (x0 * x0 + x0 * x1 + x1 * x1) / 6,
                        area * (y0 * y0 + y0 * y1 + y1 * y1) / 6,
                    )
                )
            sums = [sum(column) for column in zip(*parts, strict=True)]
            weight = Fraction(float(density)) * sign * (1 if sums[0] > 0 else -1)
            m, mx, my, mxx, myy = (old + weight * new for old, new in zip((m, mx, my, mxx, myy), sums, strict=True))
    return m, mx, my, mxx, myy


def moved(regions, dx, dy):
    """Exact regions with (dx, dy) added."""
    return [
        ([(x + dx, y + dy) for x, y in o], d, [[(x + dx, y + dy) for x, y in h] for h in holes])
        for o, d, holes in regions
    ]


def exact_regions(regions):
    return [(exact(outline), density, [exact(hole) for hole in holes]) for outline, density, holes in regions]


def oracle(regions, foot, ground=0.0):
    """Eq. 17, Mao et al. 2024, for polygons on the floats given, with the new foot at (foot, ground)."""
    with mp.workdps(30):
        local = moved(exact_regions(regions), -Fraction(float(foot)), -Fraction(float(ground)))
        kept = mp.fsum(mp.mpf(float(d)) * kept_of([o, *holes]) for o, d, holes in local)
        *_, mxx, myy = moments_of(local)
        return mp.sqrt(kept / number(mxx + myy))


def error(found, expected):
    return float(abs(mp.mpf(float(found)) / expected - 1))


def agrees(found, expected, tolerance=1e-12):
    return error(found, expected) < tolerance


# --- bodies -------------------------------------------------------------------------------------------------


def polygon(sides, radius):
    angle = -np.pi / 2 + 2 * np.pi / sides * (np.arange(sides) + 0.5)
    points = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    points[:, 1] -= points[:, 1].min()
    points[[0, -1], 1] = 0.0
    return points.tolist()


BOX = [(0, 0), (1, 0), (1, 2), (0, 2)]
TRAPEZOID = [(0, 0), (1, 0), (0.7, 2.5), (0.3, 2.5)]
BODIES = {
    "triangle": ([([(0, 0), (1, 0), (0.4, 1.7)], 2400.0, [])], None),
    "trapezoid": ([(TRAPEZOID, 2400.0, [])], None),
    "leaning": ([([(0, 0), (1, 0), (1.3, 2), (0.6, 2)], 1.0, [])], None),
    "L-shape": ([([(0, 0), (1.2, 0), (1.2, 0.4), (0.5, 0.4), (0.5, 2), (0, 2)], 2400.0, [])], None),
    "holes": (
        [
            (
                [(0, 0), (2, 0), (2, 3), (0, 3)],
                7.0,
                [[(0.3, 0.5), (0.9, 0.6), (0.5, 1.4)], [(1.2, 1.0), (1.8, 1.0), (1.8, 2.7), (1.1, 2.2)]],
            )
        ],
        None,
    ),
    "two densities": (
        [
            ([(0, 0), (1, 0), (1, 0.5), (0, 0.5)], 2400.0, []),
            ([(0.1, 0.5), (0.8, 0.5), (0.6, 2.0), (0.2, 2.1)], 700.0, []),
        ],
        None,
    ),
    "plug in a hole": (
        [
            ([(0, 0), (1, 0), (1, 3), (0, 3)], 1000.0, [[(0.2, 1.0), (0.7, 1.0), (0.7, 2.0), (0.2, 2.0)]]),
            ([(0.2, 1.0), (0.7, 1.0), (0.7, 2.0), (0.2, 2.0)], 7850.0, []),
        ],
        None,
    ),
    "feet inside": ([(TRAPEZOID, 2400.0, [])], (0.2, 0.75)),
    "portal": (
        [([(0, 0), (0.2, 0), (0.2, 1), (0.8, 1), (0.8, 0), (1.1, 0), (1.1, 1.5), (0, 1.5)], 2400.0, [])],
        None,
    ),
    "thin tube": ([(BOX, 7850.0, [[(0.001, 0.001), (0.999, 0.001), (0.999, 1.999), (0.001, 1.999)]])], None),
    "needle": ([([(0, 0), (0.05, 0), (0.03, 10.0), (0.029, 10.0)], 2400.0, [])], None),
    "squat wedge": ([([(0, 0), (1, 0), (0.3, 0.01)], 2400.0, [])], None),
    "squat slab": ([([(0, 0), (1, 0), (0.95, 0.012), (0.02, 0.009)], 2400.0, [])], None),
    "lens": ([([(-0.2, 0), (0.2, 0), (1.0, 0.3), (1.1, 0.5), (-1.0, 0.6), (-0.9, 0.2)], 5.0, [])], None),
    "36-gon": ([(polygon(36, 1.3), 2400.0, [])], None),
}
PLACES = {"here": (0.0, 0.0), "1e6 m away": (1e6, 0.0), "1e6 m away and up": (-1e6 - 0.3, 1e6)}


def placed(name, place):
    """Regions, feet, ground at a place, in the floats that a user would have there."""
    regions, feet = BODIES[name]
    dx, dy = PLACES[place]
    there = [
        (
            [(x + dx, y + dy) for x, y in outline],
            density,
            [[(x + dx, y + dy) for x, y in hole] for hole in holes],
        )
        for outline, density, holes in regions
    ]
    if feet is None:
        base = [x for outline, _, _ in there for x, y in outline if y == dy]
        return there, None, (min(base), max(base)), dy
    feet = (feet[0] + dx, feet[1] + dx)
    return there, feet, feet, dy


def section_of(regions, feet=None, ground=0.0, **options):
    return rk.Section([rk.Region(o, d, holes) for o, d, holes in regions], feet, ground=ground, **options)


# --- tests --------------------------------------------------------------------------------------------------


@pytest.mark.verifies(
    "computed anew",
    "horizontal slices integrated with 30 digits",
    within="1e-12",
    control="test_slices_criterion_rejects_wrong_bodies",
)
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", BODIES)
def test_against_slices(name, place, agreement):
    """Polygons with holes, densities, inner feet, thin, squat, far away: r to 1e-12 of independent
    quadrature."""
    regions, feet, (left, right), ground = placed(name, place)
    section = section_of(regions, feet, ground)
    agreement(error(rk.coefficient_of_restitution(section, "ked", foot="right"), oracle(regions, right, ground)), 1e-12)
    if place == "here":
        r = rk.coefficient_of_restitution(section, "ked", foot="left")
        agreement(error(r, oracle(regions, left, ground)), 1e-12)


@pytest.mark.verifies("negative control", "the wrong foot, filled holes, mixed-up densities")
def test_slices_criterion_rejects_wrong_bodies():
    """Negative control: the wrong foot, filled holes and mixed-up densities fail the criterion."""
    regions, _, (left, right), _ = placed("holes", "here")
    r = rk.coefficient_of_restitution(section_of(regions), "ked")
    assert agrees(r, oracle(regions, right))
    assert not agrees(r, oracle(regions, left))
    assert not agrees(r, oracle([(outline, density, []) for outline, density, _ in regions], right))
    (low, d_low, _), (high, d_high, _) = BODIES["two densities"][0]
    r = rk.coefficient_of_restitution(section_of(BODIES["two densities"][0]), "ked")
    assert not agrees(r, oracle([(low, d_high, []), (high, d_low, [])], 1.0))


@pytest.mark.verifies("computed anew", "SciPy's dblquad", within="1e-9", control="within")
def test_oracle_against_two_dimensional_quadrature():
    """The slice oracle itself: equal to scipy's dblquad over a triangle, to the 1e-9 that dblquad reaches."""
    regions, _, (_, right), _ = placed("triangle", "here")
    apex_x, apex_y = 0.4, 1.7
    span = lambda y: (apex_x * y / apex_y, 1.0 + (apex_x - 1.0) * y / apex_y)  # noqa: E731
    limits = (0.0, apex_y, lambda y: span(y)[0], lambda y: span(y)[1])
    kept, _ = dblquad(lambda x, y: y**4 / max(y**2 + (right - x) ** 2, 1e-300), *limits, epsabs=1e-12)
    inertia, _ = dblquad(lambda x, y: y**2 + (right - x) ** 2, *limits, epsabs=1e-12)
    assert agrees(np.sqrt(kept / inertia), oracle(regions, right), 1e-9)
    assert not agrees(np.sqrt(kept / inertia), oracle(regions, 0.0), 1e-9)


@pytest.mark.verifies("computed anew", "coefficients to 16 digits", within="1e-14", control="within")
def test_trapezoid_reference():
    """REF: trapezoid 1 x 2.5 m with a 0.4 m top, KED and Housner."""
    section = rk.Section.from_trapezoid(1.0, 0.4, 2.5)
    assert rk.coefficient_of_restitution(section, "ked") == pytest.approx(0.8704740952680223, rel=1e-14, abs=0.0)
    assert rk.coefficient_of_restitution(section, "housner") == pytest.approx(0.7416338582677167, rel=1e-14, abs=0.0)
    upright = rk.Section.from_trapezoid(1.0, 1.0, 2.5)
    assert rk.coefficient_of_restitution(upright, "ked") != pytest.approx(0.8704740952680223, rel=1e-14, abs=0.0)


@pytest.mark.verifies("closed form", "the closed form of the rectangle", within="1e-12", control="within")
@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.5, 1.0, 4.0, 30.0, 300.0])
def test_rectangle_as_section(ratio):
    """The boundary sum of a rectangle equals the closed form of a Block."""
    block = rk.Block(width=1.0, height=ratio)
    found = rk.coefficient_of_restitution(block.to_section(), "ked")
    assert found == pytest.approx(rk.coefficient_of_restitution(block, "ked"), rel=1e-12, abs=0.0)
    leaning = rk.Section.from_trapezoid(1.0, 1.0, ratio, lean=1e-6)
    wrong = rk.coefficient_of_restitution(leaning, "ked")
    assert wrong != pytest.approx(rk.coefficient_of_restitution(block, "ked"), rel=1e-12, abs=0.0)


@pytest.mark.verifies(
    "computed anew", "exact fractions", within="1e-12", control="test_far_away_criterion_rejects_uncentred_sums"
)
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", BODIES)
def test_exact_moments(name, place):
    """Mass, centre and polar moment equal the exact rational ones of the same floats, also 1e6 m away."""
    regions, feet, _, ground = placed(name, place)
    section = section_of(regions, feet, ground, depth=0.5)
    m, mx, my, mxx, myy = moments_of(exact_regions(regions))
    polar = float((mxx + myy - (mx * mx + my * my) / m) / 2)
    assert section.mass == pytest.approx(float(m / 2), rel=1e-12, abs=0.0)
    assert section.moment_of_inertia == pytest.approx(polar, rel=1e-12, abs=0.0)
    # rounded once to the user's coordinates; a wall of 1e-3 m is the difference of areas 300 times its own
    assert section.centre == pytest.approx((float(mx / m), float(my / m)), rel=1e-15, abs=1e-13)


@pytest.mark.verifies("negative control", "the same sums in the user's coordinates")
def test_far_away_criterion_rejects_uncentred_sums():
    """Negative control: the same sums in the user's coordinates lose everything 1e6 m away."""
    regions, _, _, _ = placed("trapezoid", "1e6 m away and up")
    x, y = np.array(regions[0][0]).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    area = 0.5 * cross.sum()
    naive = (cross * (x * x + x * x1 + x1 * x1 + y * y + y * y1 + y1 * y1)).sum() / 12.0
    naive -= ((cross * (x + x1)).sum() ** 2 + (cross * (y + y1)).sum() ** 2) / (36.0 * area)
    m, mx, my, mxx, myy = moments_of(exact_regions([(regions[0][0], 1.0, [])]))
    assert naive != pytest.approx(float(mxx + myy - (mx * mx + my * my) / m), rel=1e-3)


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "horizontal slices integrated with 30 digits",
    within="1e-12",
    control="test_slices_criterion_rejects_wrong_bodies",
)
@settings(max_examples=12)
@given(polygons())
def test_random_polygons_against_slices(ring):
    """Random asymmetric polygons: r to 1e-12 of independent quadrature, about both feet."""
    section, regions = rk.Section.from_points(ring, 1.0), [(ring, 1.0, [])]
    assert agrees(rk.coefficient_of_restitution(section, "ked", foot="right"), oracle(regions, ring[1][0]))
    assert agrees(rk.coefficient_of_restitution(section, "ked", foot="left"), oracle(regions, ring[0][0]))


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the body cut into touching triangles", within="1e-11")
@given(polygons())
def test_additive_over_a_cut(ring):
    """N, mass and inertia of a body cut into a fan of touching triangles equal those of the whole."""
    left, right, *rest = ring
    fan = [right, *rest, left]
    parts = [rk.Region([(0.0, 0.0), a, b], 3.0) for a, b in pairwise(fan)]
    whole, cut = rk.Section.from_points(ring, 3.0), rk.Section(parts)
    for foot in ("left", "right"):
        assert projected_moment(cut, foot) == pytest.approx(projected_moment(whole, foot), rel=1e-11, abs=0.0)
    assert cut.mass == pytest.approx(whole.mass, rel=1e-12, abs=0.0)
    assert cut.moment_of_inertia == pytest.approx(whole.moment_of_inertia, rel=1e-11, abs=0.0)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "every edge cut into many", within="1e-11", control="within")
@given(polygons(), st.integers(2, 40))
def test_vertices_on_edges_change_nothing(ring, pieces):
    """Every edge cut into many: the same coefficient, and a vertex moved by 1e-6 is noticed."""
    corners = np.array([*ring, ring[0]])
    along = np.linspace(0.0, 1.0, pieces, endpoint=False)[:, None]
    fine = np.concatenate([a + (b - a) * along for a, b in pairwise(corners)])
    r = rk.coefficient_of_restitution(rk.Section.from_points(ring), "ked")
    assert rk.coefficient_of_restitution(rk.Section.from_points(fine), "ked") == pytest.approx(r, rel=1e-11, abs=0.0)
    corners[2] *= 1.0 + 1e-6
    assert rk.coefficient_of_restitution(rk.Section.from_points(corners[:-1]), "ked") != pytest.approx(
        r, rel=1e-11, abs=0.0
    )


@pytest.mark.verifies(
    "invariant", "cos^2-like bound below, conservation of energy above", within="1e-12", control="within"
)
@given(polygons())
def test_between_horizontal_momentum_and_the_energy_bound(ring):
    """r_HM <= r_KED and N <= I_O for any body; an integrand with a length too many breaks
    it."""
    section = rk.Section.from_points(ring)
    for foot, other in (("left", "right"), ("right", "left")):
        r = rk.coefficient_of_restitution(section, "ked", foot=foot)
        assert rk.coefficient_of_restitution(section, "horizontal-momentum", foot=foot) <= r * (1 + 1e-12)
        assert projected_moment(section, foot) <= section.side(other).moment_of_inertia * (1 + 1e-12)
    tall = rk.Block(width=1.0, height=4.0)
    y_to_the_fourth = 4.0**5 / 5.0 * tall.density
    assert y_to_the_fourth > tall.side("left").moment_of_inertia


def weighted_sines(x, y, m):
    """sin^2 phi of points about O' = (1, 0), and the shares of |S - O'|^2 dm."""
    squared = (1.0 - x) ** 2 + y**2
    return y**2 / squared, m * squared / (m * squared).sum()


@pytest.mark.verifies(
    "invariant",
    "r_KED^2 = r_HM^2 + the variance of sin^2",
    within="1e-12",
    control="test_a_variance_by_mass_alone_is_noticed",
)
@given(st.lists(st.tuples(st.floats(-0.9, 0.9), st.floats(0.0, 4.0), st.floats(0.1, 3.0)), min_size=1, max_size=12))
def test_variance_identity_of_points(points):
    """r_KED^2 = r_HM^2 + Var_w(sin^2 phi), w = |S - O'|^2 dm, for any mass points."""
    x, y, m = np.array(points).T
    body = rk.MassPoints(np.column_stack([x, y]), m, (-1.0, 1.0))
    sine, weight = weighted_sines(x, y, m)
    mean = weight @ sine
    variance = weight @ (sine - mean) ** 2
    ked = rk.coefficient_of_restitution(body, "ked") ** 2
    assert rk.coefficient_of_restitution(body, "horizontal-momentum") == pytest.approx(mean, abs=1e-14)
    assert ked == pytest.approx(mean**2 + variance, rel=1e-12, abs=1e-28)


@pytest.mark.verifies("negative control", "the variance with shares of mass alone")
def test_a_variance_by_mass_alone_is_noticed():
    """Negative control: with shares of mass in place of |S - O'|^2 dm the identity fails."""
    x, y, m = np.array([0.0, 0.5, -0.3]), np.array([1.0, 3.0, 0.4]), np.array([1.0, 0.7, 2.0])
    body = rk.MassPoints(np.column_stack([x, y]), m, (-1.0, 1.0))
    sine, weight = weighted_sines(x, y, m)
    mean = weight @ sine
    by_mass = np.average((sine - mean) ** 2, weights=m)
    assert rk.coefficient_of_restitution(body, "ked") ** 2 != pytest.approx(mean**2 + by_mass, rel=1e-3)


@pytest.mark.verifies(
    "computed anew",
    "SciPy's dblquad of the variance, and 15 digits for a rectangle",
    within="1e-9; 1e-14",
    control="within",
)
def test_variance_identity_of_bodies():
    """The same identity for a rectangle (REF) and a trapezoid, the variance by quadrature."""
    block = rk.Block(width=1.0, height=2.0)
    ked, momentum = (rk.coefficient_of_restitution(block, name) for name in ("ked", "horizontal-momentum"))
    assert momentum == pytest.approx(0.8, rel=1e-15, abs=0.0)
    assert ked**2 == pytest.approx(0.689413284635524127, rel=1e-14, abs=0.0)
    assert ked**2 - momentum**2 == pytest.approx(0.0494132846355241272, rel=1e-13, abs=0.0)

    section = rk.Section.from_trapezoid(1.0, 0.4, 2.5)
    ked, momentum = (rk.coefficient_of_restitution(section, name) for name in ("ked", "horizontal-momentum"))
    limits = (0.0, 2.5, lambda y: 0.12 * y, lambda y: 1.0 - 0.12 * y)
    inertia, _ = dblquad(lambda x, y: y**2 + (1 - x) ** 2, *limits, epsabs=1e-12)

    def spread(x, y, mean=momentum):
        squared = max(y**2 + (1 - x) ** 2, 1e-300)
        return (y**2 / squared - mean) ** 2 * squared

    variance = dblquad(spread, *limits, epsabs=1e-12)[0] / inertia
    assert ked**2 == pytest.approx(momentum**2 + variance, rel=1e-9, abs=0.0)
    shifted = dblquad(lambda x, y: spread(x, y, 0.99 * momentum), *limits, epsabs=1e-12)[0] / inertia
    assert ked**2 != pytest.approx(momentum**2 + shifted, rel=1e-9, abs=0.0)
