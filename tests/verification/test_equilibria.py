"""Equilibria of convex bodies: counts, passes and barriers against closed forms, floods and a scan."""

import math
import os
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from waiting import allowed

from rocking.bodies.equilibria import base_tolerances, equilibria
from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid import Part, Solid, box, cone, cylinder, ellipsoid, extrusion, rotation_about
from rocking.bodies.solid.base import hull as hull_of
from rocking.conventions import g
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

ROCK = Path(__file__).parents[3] / "shared" / "data" / "scans" / "granite_rock.obj"
CAMPAIGN = bool(os.environ.get("ROCKING_CAMPAIGN"))
HULLS = 10_000 if CAMPAIGN else 300


def counts(found):
    return len(found.stable), len(found.saddles), len(found.summits)


def surface(points):
    """Triangles of a hull, counter-clockwise seen from outside."""
    hull = ConvexHull(points)
    faces = hull.simplices.astype(np.int64)
    a, b, c = np.moveaxis(points[faces], 1, 0)
    turn = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[turn] = faces[turn][:, [0, 2, 1]]
    return faces


def random_body(rng, most=60):
    points = rng.normal(size=(rng.integers(4, most), 3)) * rng.uniform(0.3, 1.0, 3)
    return equilibria(points, polyhedron_moments(points[surface(points)]).centre, 1.0)


def spread(count):
    """Directions all over the sphere."""
    turn = np.arange(count) + 0.5
    z, phi = 1.0 - 2.0 * turn / count, math.pi * (1.0 + math.sqrt(5.0)) * turn
    return np.stack([np.sqrt(1.0 - z * z) * np.cos(phi), np.sqrt(1.0 - z * z) * np.sin(phi), z], axis=1)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the Poincare-Hopf theorem", control="test_euler_relation_without_a_facet_is_broken")
def test_euler_relation_of_random_hulls():
    """Stable - saddles + summits = 2, whatever the hull; and at least one of each extreme."""
    rng = np.random.default_rng(17)
    for _ in range(HULLS):
        stable, saddles, summits = counts(random_body(rng))
        assert stable - saddles + summits == 2
        assert stable >= 1
        assert summits >= 1


@pytest.mark.verifies("negative control", "feet taken from other edges")
def test_euler_relation_without_a_facet_is_broken():
    """Negative control: with the foot's place taken from another centre the sum is another one."""
    rng, wrong = np.random.default_rng(17), 0
    for _ in range(20):
        hull = random_body(rng).hull
        moved = np.roll(hull.inward, 1, axis=0)
        stable = np.ones(len(hull.normals), dtype=bool)
        stable[hull.sides[moved <= 0.0]] = False
        saddles = (moved > 0.0).all(axis=1) & (hull.beyond[:, 0] < 0.0) & (hull.beyond[:, 1] > 0.0)
        wrong += int(stable.sum()) - int(saddles.sum()) + int(hull.summits.sum()) != 2
    assert wrong > 10


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the height all round each pose")
def test_counts_are_those_of_the_height_around():
    """Each stable pose is a minimum of the height and each summit a maximum, and there are no others."""
    rng = np.random.default_rng(3)
    around = np.array([[math.cos(a), math.sin(a)] for a in np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)])
    for _ in range(20):
        found = random_body(rng, 16)
        hull = ConvexHull(found.hull_vertices - found.centre)
        normals = hull.equations[:, :3]
        corners = hull.points / np.linalg.norm(hull.points, axis=1, keepdims=True)
        for directions, sign, expected in ((normals, 1.0, found.stable), (corners, -1.0, found.summits)):
            extremes = 0
            for down in directions:
                side = np.linalg.svd(down[None])[2][1:]
                near = down + 1e-5 * around @ side
                extremes += bool((sign * (found.height(near) - found.height(down)) > 0.0).all())
            assert extremes == len(expected)


@pytest.mark.verifies("closed form", "counts of regular bodies")
@pytest.mark.parametrize(
    ("points", "expected"),
    [
        (box(1.0, 1.0, 1.0).vertices, (6, 12, 8)),
        (box(1.0, 2.0, 3.0).vertices, (6, 12, 8)),
        (np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]), (4, 6, 4)),
        (extrusion([(math.cos(a), math.sin(a)) for a in 2.0 * math.pi * np.arange(7) / 7], 1.5).vertices, (9, 21, 14)),
    ],
    ids=["cube", "box", "tetrahedron", "prism"],
)
def test_bodies_whose_counts_are_known(points, expected):
    """Cube and box 6, 12, 8; regular tetrahedron 4, 6, 4; regular prism of 7."""
    inside = polyhedron_moments(points[surface(points)]).centre
    assert counts(equilibria(points, inside, 1.0)) == expected


@pytest.mark.verifies("published", "the theorem of Conway")
def test_homogeneous_tetrahedra_have_at_least_two_stable_poses():
    """J. H. Conway's theorem."""
    rng = np.random.default_rng(5)
    for _ in range(100):
        points = rng.normal(size=(4, 3)) * [1.0, 0.4, 0.2]
        assert len(equilibria(points, points.mean(axis=0), 1.0).stable) >= 2


@pytest.mark.verifies("closed form", "half sides and half diagonals", within="1e-12")
def test_cube_and_box_in_closed_form():
    """Heights, barriers, uplift accelerations, tilts of a box: half sides and half diagonals."""
    found = Solid(box(1.0, 2.0, 3.0), ground=0.0).equilibria()
    assert [pose.height for pose in found.stable] == pytest.approx([0.5, 0.5, 1.0, 1.0, 1.5, 1.5], abs=1e-14)
    standing = found.settling((0.0, 0.0, -1.0))
    assert standing.height == pytest.approx(1.5, abs=1e-14)
    narrow, wide, corner = math.hypot(0.5, 1.5) - 1.5, math.hypot(1.0, 1.5) - 1.5, math.sqrt(3.5) - 1.5
    assert standing.barrier == pytest.approx(narrow, abs=1e-14)
    azimuths = np.array([0.0, 0.5 * math.pi, math.atan2(1.0, 0.5)])
    assert found.barrier(standing, azimuths[:2]) == pytest.approx([narrow, wide], abs=1e-14)
    assert found.barrier(standing, azimuths[2]) == pytest.approx(corner, abs=1e-12)
    assert standing.uplift_acceleration(azimuths[:2]) == pytest.approx([g / 3.0, g / 1.5], rel=1e-14)
    over = found.neighbours(standing)[0]
    assert over.tilt == pytest.approx(math.atan2(0.5, 1.5), abs=1e-14)
    assert abs(math.cos(over.azimuth)) == pytest.approx(1.0, abs=1e-14)
    assert over.energy == pytest.approx(found.mass * g * narrow, rel=1e-12)


def flood(found, rows):
    """The height at which pairs of stable poses are joined, over a grid of directions that knows of no facet."""
    theta = (np.arange(rows) + 0.5) * math.pi / rows
    phi = np.arange(2 * rows) * math.pi / rows
    sin = np.sin(theta)[:, None]
    grid = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.cos(theta)[:, None] + 0.0 * phi], axis=-1)
    heights, columns = found.height(grid).ravel(), 2 * rows
    parent = list(range(len(heights)))

    def root(node):
        while parent[node] != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    flat = grid.reshape(-1, 3)
    members = {}
    for pose in found.stable:
        members.setdefault(int(np.argmax(flat @ pose.down)), set()).add(pose.number)
    wet, joins = np.zeros(len(heights), dtype=bool), {}
    for node in np.argsort(heights, kind="stable").tolist():
        wet[node] = True
        row, column = divmod(node, columns)
        beside = [row * columns + (column + 1) % columns, row * columns + (column - 1) % columns]
        beside += [node - columns if row else (column + rows) % columns]
        beside += [node + columns if row < rows - 1 else row * columns + (column + rows) % columns]
        for other in beside:
            if wet[other] and (one := root(node)) != (two := root(other)):
                here, there = members.pop(one, set()), members.pop(two, set())
                joins |= {frozenset((a, b)): float(heights[node]) for a in here for b in there}
                parent[one] = two
                if here | there:
                    members[two] = here | there
    return joins


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "water that rises over a grid of directions")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_passes_against_a_flood(seed):
    """The lowest pass of every two poses, against water rising over a grid of directions, to the grid's own error."""
    found = random_body(np.random.default_rng(seed), 30)
    rows = 120
    joins = flood(found, rows)
    reach = float(np.linalg.norm(found.hull_vertices - found.centre, axis=1).max())
    step = math.pi / rows
    assert joins
    for pair, height in joins.items():
        start, end = (found.stable[i] for i in sorted(pair))
        exact = found.lowest_pass(start, end).height
        assert exact - 1e-12 <= height <= exact + reach * step
    # negative control: the pass by another saddle than the lowest is noticed
    tops = [saddle.height for saddle in found.saddles]
    assert max(tops) - min(tops) > reach * step


@pytest.mark.verifies("computed anew", "the height along the way", within="1e-5")
def test_straight_barriers_against_the_height_along_the_way():
    """Never below the lowest pass into the same pose, and the greatest height on the way there."""
    rng = np.random.default_rng(11)
    for _ in range(4):
        found = random_body(rng)
        pose = found.stable[0]
        azimuths = rng.uniform(-math.pi, math.pi, 8)
        straight = found.barrier(pose, azimuths)
        lowest = found.barrier(pose, azimuths, path="lowest")
        for azimuth, rise, low in zip(azimuths.tolist(), straight.tolist(), lowest.tolist(), strict=True):
            if not math.isfinite(rise):
                continue
            assert rise >= low - 1e-12
            turn = np.array([math.cos(azimuth), math.sin(azimuth), 0.0]) @ pose.rotation
            angle = np.linspace(0.0, 2.0 * math.pi, 8_001)
            way = found.height(np.cos(angle)[:, None] * pose.down + np.sin(angle)[:, None] * turn) - pose.height
            # up to the first valley from which the body settles in another pose
            valleys = np.flatnonzero((way[1:-1] <= way[:-2]) & (way[1:-1] < way[2:])) + 1
            ends = [found.settling(math.cos(angle[v]) * pose.down + math.sin(angle[v]) * turn) for v in valleys]
            first = next(v for v, end in zip(valleys.tolist(), ends, strict=True) if end is not pose)
            assert abs(way[:first].max() - rise) < 1e-5
            assert found.toppled(pose, azimuth) is ends[valleys.tolist().index(first)]


@pytest.mark.slow
@pytest.mark.verifies("closed form", "the centre over an edge by a hair", within="1e-9")
def test_the_pose_that_a_body_stands_in_counts():
    """However shallow, beside round parts too: the nearest edge and the rise by hand; a pole stands on its end."""
    leaning = Solid(
        [box(0.48, 0.40, 1.1), Part(ellipsoid(0.1, 0.1, 0.2), translation=(0.0, 0.0, 1.1))],
        centre=(0.23, 0.03, 0.67),
        mass=100.0,
    )
    found = leaning.equilibria()
    pose = found.settling((0.0, 0.0, -1.0))
    assert pose.height == pytest.approx(0.67, rel=1e-9)
    assert pose.uplift_acceleration(0.0) == pytest.approx(g * 0.01 / 0.67, rel=1e-9)
    assert pose.barrier == pytest.approx(math.hypot(0.67, 0.01) - 0.67, rel=1e-6)
    pole = Solid(cylinder(0.05, 3.0))
    assert pole.settled().centre[2] == pytest.approx(1.5, rel=1e-9)
    # the negative control: without the pose that it stands in the body would lie down
    lying = equilibria(found.hull_vertices, found.centre, found.mass, min_barrier=found.min_barrier)
    assert lying.settling((0.0, 0.0, -1.0)).height < 0.3


@pytest.mark.verifies("invariant", "the points within each tolerance, and the base that a solid finds for itself")
def test_base_tolerances_count_points_inside_the_hull():
    """A bottom that bulges between three feet: points near the ground are those of the surface, not of its hull."""
    turns = np.linspace(0.0, 2.0 * math.pi, 25)[:-1]
    rim = np.stack([0.3 * np.cos(turns), 0.25 * np.sin(turns), np.full(24, 0.0012)], axis=1)
    feet = np.array([[0.2, 0.0, 0.0], [-0.1, 0.17, 0.0], [-0.1, -0.17, 0.0]])
    top = rim * [0.8, 0.9, 1.0] + [0.02, 0.01, 1.0]
    low = rim * [0.98, 0.98, 0.8]
    corners = np.concatenate([rim, feet, top])
    for tolerance, points in ((0.0, feet), (0.001, np.concatenate([feet, low])), (0.002, np.concatenate([feet, rim]))):
        whole = equilibria(np.concatenate([corners, low]), (0.01, 0.0, 0.5), 100.0)
        (row,) = base_tolerances(whole, tolerances=[tolerance])
        assert row.points >= len(points)
        polygon = hull_of(points[:, :2])
        assert row.edge_distance == pytest.approx(polygon.margin(np.array([0.01, 0.0])), rel=1e-6)


@pytest.mark.verifies("behaviour")
def test_a_base_of_its_own_is_said():
    """A body on feet inside of its facet: the numbers are those of the facet, and the notes say so."""
    on_feet = Solid([box(1.0, 1.0, 2.0)], base=[(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)])
    assert any("base of the body is smaller" in note for note in on_feet.equilibria().notes)
    assert not any("base of the body is smaller" in note for note in Solid([box(1.0, 1.0, 2.0)]).equilibria().notes)


@pytest.mark.verifies("invariant", "the transpose times the rotation", within="1e-12")
def test_upside_down_is_a_rotation_too():
    """Near the turn by 180 degrees nothing is lost to a difference of nearly equal numbers."""
    for tilt in (0.0, 1e-12, 6e-8, 1e-6, 1e-4, 0.1, 2.0, math.pi):
        for azimuth in (0.0, 0.7, 2.0):
            level, up = math.sin(tilt), math.cos(tilt)
            turn = set_down(np.array([level * math.cos(azimuth), level * math.sin(azimuth), up]))
            assert np.abs(turn @ turn.T - np.eye(3)).max() < 1e-12
            assert np.linalg.det(turn) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda f, p: f.settling((0.0, 0.0, 0.0)), "down must be"),
        (lambda f, p: f.settling((math.nan, 0.0, -1.0)), "down must be"),
        (lambda f, p: f.settling((0.0, -1.0)), "down must be"),
        (lambda f, p: f.height((0.0, 0.0, 0.0)), "down must be"),
        (lambda f, p: p.uplift_acceleration(math.nan), "azimuth must be"),
        (lambda f, p: f.barrier(p, math.nan), "azimuth must be"),
        (lambda f, p: f.barrier(0, 0.0), "pose must be a stable pose"),
        (lambda f, p: f.neighbours(Solid(box(1.4, 2.0, 5.0)).equilibria().stable[0]), "pose must be a stable pose"),
        (lambda f, p: Solid(box(1.0, 2.0, 3.0)).settled(0), "pose must be a stable pose"),
    ],
)
def test_what_is_no_direction_and_no_pose_is_refused(call, says):
    """One sentence, no number."""
    found = Solid(box(1.0, 2.0, 3.0)).equilibria()
    with pytest.raises(InvalidValueError, match=says):
        call(found, found.stable[0])


@pytest.mark.verifies("invariant", "the height at the start")
def test_settling_goes_downhill():
    """From any direction, into a pose that is not higher; a pose stays where it is."""
    rng = np.random.default_rng(8)
    found = random_body(rng)
    for down in spread(200):
        assert found.settling(down).height <= float(found.height(down)) + 1e-12
    for pose in found.stable:
        assert found.settling(pose.down) is pose
    for top in (*found.saddles, *found.summits):
        assert found.settling(top.down).height < top.height


@pytest.mark.verifies("invariant", "the body turned and moved", within="1e-13")
def test_frames_do_not_matter():
    """Turned and moved elsewhere, the same heights, barriers and distances."""
    rng = np.random.default_rng(2)
    points = rng.normal(size=(40, 3))
    turn = rotation_about(rng.normal(size=3), 1.234)
    one = equilibria(points, np.zeros(3), 2.0)
    two = equilibria(points @ turn.T + [5.0, -3.0, 1.0], np.array([5.0, -3.0, 1.0]), 2.0)
    assert counts(one) == counts(two)
    for a, b in zip(one.stable, two.stable, strict=True):
        assert (a.height, a.barrier) == pytest.approx((b.height, b.barrier), abs=1e-13)
        assert sorted(a.edge_distances) == pytest.approx(sorted(b.edge_distances), abs=1e-13)


@pytest.mark.verifies("closed form", "cylinder and cone", within="1e-12 of the rings")
def test_bodies_of_revolution_have_rings():
    """A cylinder lies on its side and is balanced on its rims, all the way round; a cone likewise."""
    half, radius = 1.5, 0.5
    found = Solid(cylinder(2.0 * radius, 2.0 * half)).equilibria()
    assert counts(found) == (2, 0, 0)
    assert [(ring.kind, ring.height) for ring in found.rings] == [
        ("stable", pytest.approx(radius, abs=1e-12)),
        ("summit", pytest.approx(math.hypot(half, radius), abs=1e-12)),
        ("summit", pytest.approx(math.hypot(half, radius), abs=1e-12)),
    ]
    assert found.rings[0].tilt == pytest.approx(0.5 * math.pi, abs=1e-6)
    assert found.stable[0].barrier == pytest.approx(math.hypot(half, radius) - half, rel=1e-3)
    lying = Solid(cone(1.0, 1.0)).equilibria().rings[0]
    assert lying.height == pytest.approx(0.75 * math.sin(math.atan(0.5)), abs=1e-12)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "counts of an ellipsoid")
def test_an_ellipsoid_of_three_axes():
    """2, 2, 2, of a smooth one and of its corners where flats do not count; they do in the negative control."""
    assert counts(Solid(ellipsoid(1.0, 0.7, 0.5, cut_below=0.001)).equilibria()) == (2, 2, 2)
    corners = spread(3000) * np.array([1.0, 0.6, 0.35])
    assert counts(equilibria(corners, np.zeros(3), 1.0, min_barrier=1e-3)) == (2, 2, 2)
    flats = counts(equilibria(corners, np.zeros(3), 1.0))
    assert flats[0] > 2
    assert flats[0] - flats[1] + flats[2] == 2


@pytest.mark.verifies("invariant", "mass, inertia and support polygon", within="1e-12")
def test_a_body_set_down_stands_on_its_pose():
    """The same mass and inertia, the centre at the height of the pose, the base its support polygon."""
    body = Solid(extrusion([(0.0, 0.0), (1.0, 0.0), (0.7, 0.9)], 3.0))
    for pose in body.equilibria().stable:
        set_down = body.settled(pose)
        assert set_down.mass == body.mass
        assert set_down.centre == pytest.approx([0.0, 0.0, pose.height], abs=1e-12)
        assert np.linalg.eigvalsh(set_down.inertia) == pytest.approx(np.linalg.eigvalsh(body.inertia), rel=1e-12)
        assert set_down.base.margin(np.zeros(2)) == pytest.approx(float(pose.edge_distances.min()), abs=1e-12)
        assert set_down.equilibria().settling((0.0, 0.0, -1.0)).height == pytest.approx(pose.height, abs=1e-12)
    assert body.settled().base.vertices.shape == (3, 2)


@pytest.mark.verifies("closed form", "distances along rays of a triangle", within="1e-12", control="within")
def test_uplift_of_a_triangular_base_differs_by_azimuth():
    """Uplift towards an azimuth takes g d / h with the distance d from the centre to the base's border along the ray.

    The distance solves c + d u = a + s (b - a) for the edge that the ray crosses. The control mirrors the azimuth.
    """
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (0.7, 0.9)])
    pose = Solid(extrusion(corners.tolist(), 3.0)).equilibria().settling((0.0, 0.0, -1.0))
    centre = corners.mean(axis=0)
    assert pose.height == pytest.approx(1.5, abs=1e-12)

    def distance(azimuth):
        ray, found = np.array([math.cos(azimuth), math.sin(azimuth)]), []
        for a, b in pairwise([*corners, corners[0]]):
            along, place = np.linalg.solve(np.stack([ray, a - b], axis=1), a - centre)
            if along > 0.0 and 0.0 <= place <= 1.0:
                found.append(along)
        (only,) = found
        return only

    azimuths = [0.3, 1.2, 2.5, 4.0, -0.8]
    wanted = [g * distance(each) / 1.5 for each in azimuths]
    np.testing.assert_allclose(pose.uplift_acceleration(azimuths), wanted, rtol=1e-12)
    mirrored = [g * distance(-each) / 1.5 for each in azimuths]
    assert np.abs(np.array(mirrored) / wanted - 1.0).min() > 0.01


@pytest.mark.verifies("closed form", "a plate on four feet", within="1e-12")
def test_a_base_wider_by_a_tolerance():
    """Four feet of 1 mm under a plate: within that they count, and beyond a wider plate does."""
    plate = box(1.0, 1.0, 0.5).vertices + np.array([0.0, 0.0, 0.001])
    feet = np.array([[x, y, 0.0] for x in (-0.3, 0.3) for y in (-0.2, 0.2)])
    found = equilibria(np.concatenate([plate, feet]), [0.0, 0.0, 0.25], 100.0)
    narrow, also, wide = base_tolerances(found, tolerances=(0.0, 0.0005, 0.0015))
    assert (narrow.edge_distance, also.edge_distance, wide.edge_distance) == pytest.approx((0.2, 0.2, 0.5), abs=1e-12)
    assert narrow.uplift_acceleration == pytest.approx(g * 0.2 / 0.25, rel=1e-12)
    assert (narrow.points, wide.points) == (4, 8)
    assert abs(math.sin(narrow.azimuth)) == pytest.approx(1.0, abs=1e-12)
    assert wide.barrier > narrow.barrier
    with pytest.raises(InvalidValueError, match="tolerance"):
        base_tolerances(found, tolerances=(0.3,))


@pytest.mark.verifies("behaviour")
def test_a_centre_above_an_edge_is_said():
    """The foot on an edge hangs on the last digits; of a body where it does not nothing is said."""
    wedge = np.array(
        [[0.0, y, 0.0] for y in (0, 1)] + [[1.0, y, 0.0] for y in (0, 1)] + [[2.0, y, 1.0] for y in (0, 1)]
    )
    assert any("rounding decides" in note for note in equilibria(wedge, [1.0, 0.5, 0.3], 1.0).notes)
    assert equilibria(wedge, [0.95, 0.5, 0.3], 1.0).notes == ()


@pytest.mark.verifies("behaviour")
def test_what_is_no_body_is_refused():
    """A centre outside the hull, points of one plane, no mass."""
    corners = box(1.0, 1.0, 1.0).vertices
    with pytest.raises(InvalidValueError, match="must lie inside the convex hull"):
        equilibria(corners, [5.0, 0.0, 0.0], 1.0)
    with pytest.raises(GeometryError, match="no volume"):
        equilibria(corners[:, :] * [1.0, 1.0, 0.0], [0.0, 0.0, 0.0], 1.0)
    with pytest.raises(InvalidValueError, match="mass"):
        equilibria(corners, [0.0, 0.0, 0.5], 0.0)


@pytest.mark.verifies("computed anew", "the hull sought")
def test_a_convex_surface_is_its_own_hull():
    """With its faces or without them the same; faces of a body that is not convex do not mislead."""
    points = spread(400) * np.array([1.0, 0.6, 0.35])
    without, within = (equilibria(points, np.zeros(3), 1.0, faces=faces) for faces in (None, surface(points)))
    assert [p.height for p in without.stable] == pytest.approx([p.height for p in within.stable], abs=1e-14)
    notched = extrusion([(0, 0), (2, 0), (2, 1), (1, 0.4), (0, 1)], 1.0)
    centre = notched.moments().centre
    one, two = (equilibria(notched.vertices, centre, 1.0, faces=faces) for faces in (None, notched.faces))
    assert counts(one) == counts(two)


@pytest.mark.verifies("closed form", "m g times the rise of a box", within="1e-12")
def test_energies_of_a_box_are_its_weight_times_the_rise():
    """Edges and corners of a box are as far from its centre as half the diagonals of its faces and of itself."""
    mass, sides = 700.0, (1.0, 1.4, 3.0)
    found = Solid(box(*sides), mass=mass).equilibria()
    lowest = 0.5 * min(sides)
    for several, wanted in (
        (found.stable, np.repeat(sides, 2)),
        (found.saddles, np.repeat([math.hypot(a, b) for a, b in zip(sides, np.roll(sides, 1), strict=True)], 4)),
        (found.summits, np.repeat(math.hypot(*sides), 8)),
    ):
        energies = mass * g * (0.5 * np.sort(wanted) - lowest)
        np.testing.assert_allclose(sorted(each.energy for each in several), energies, rtol=1e-12, atol=1e-9)


def divided_box(sizes, count, turn):
    """Points and triangles of a box whose faces are count x count squares, counter-clockwise seen from outside."""
    line, points, faces = np.linspace(-0.5, 0.5, count + 1), [], []
    for axis in range(3):
        for side in (-0.5, 0.5):
            grid = np.insert(np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2), axis, side, axis=1)
            start, cells = sum(map(len, points)), np.arange((count + 1) * count).reshape(count, -1)[:, :-1].ravel()
            squares = start + cells[:, None] + [0, 1, count + 2, count + 1]
            triangles = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
            points.append(grid)
            faces.append(triangles if (side > 0.0) == (axis != 1) else triangles[:, ::-1])
    whole, number = np.unique(np.concatenate(points).round(9), axis=0, return_inverse=True)
    return whole * sizes @ rotation_about((1.0, 2.0, 3.0), turn).T, number.ravel()[np.concatenate(faces)]


@pytest.mark.verifies("closed form", "faces, edges and corners of a box", within="1e-12")
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_divided_box_is_a_box(turn):
    """Triangles of one plane are one facet, and pieces of one straight edge are one edge: 6, 12 and 8."""
    sizes = np.array([1.0, 1.4, 3.0])
    points, faces = divided_box(sizes, 3, turn)
    assert len(faces) == 2 * len(points) - 4  # closed, by Euler
    for given in (faces, None):
        hull = equilibria(points, np.zeros(3), 1.0, faces=given).hull
        assert (len(hull.normals), len(hull.ends), len(hull.vertices)) == (6, 12, 8)
        np.testing.assert_allclose(np.sort(hull.heights), np.repeat(np.sort(sizes) / 2.0, 2), rtol=1e-12)
        lengths = np.linalg.norm(np.diff(hull.vertices[hull.ends], axis=1)[:, 0], axis=1)
        np.testing.assert_allclose(np.sort(lengths), np.repeat(np.sort(sizes), 4), rtol=1e-12)


@pytest.mark.verifies("behaviour")
@pytest.mark.speed
@pytest.mark.skipif(not CAMPAIGN, reason="a million faces: make campaign")
def test_a_million_faces_in_time():
    """Processor time, of a surface that is convex and of a rough one."""
    smooth = spread(500_002) * np.array([0.5, 0.35, 0.25])
    rough = smooth * (1.0 + 0.002 * np.random.default_rng(1).normal(size=(len(smooth), 1)))
    for points, faces in ((smooth, surface(smooth)), (rough, None)):
        start = time.process_time()
        equilibria(points, np.zeros(3), 1.0, faces=faces)
        assert time.process_time() - start < allowed(5.0)


@pytest.fixture(scope="module")
def rock():
    if not ROCK.exists():
        pytest.skip("the scan is not there")
    lines = [line.split() for line in ROCK.read_text("utf-8").splitlines()]
    points = np.array([words[1:4] for words in lines if words[:1] == ["v"]], dtype=float)
    faces = np.array([[int(w.split("/")[0]) - 1 for w in words[1:4]] for words in lines if words[:1] == ["f"]])
    return equilibria(points, polyhedron_moments(points[faces]).centre, 353.8)


@pytest.mark.verifies("other program", "numbers from other code", within="1e-8 m")
def test_the_granite_rock(rock):
    """A scan that stood on a shaking table, against numbers from independent code."""
    assert counts(rock) == (7, 11, 6)
    expected = [0.17133715, 0.18414344, 0.28913945, 0.28969474, 0.29372633, 0.30748508, 0.46160609]
    assert [pose.height for pose in rock.stable] == pytest.approx(expected, abs=1e-8)
    stood = rock.settling((-0.8059, -0.2466, 0.5383))
    assert stood.height == pytest.approx(0.2937263265534584, abs=1e-9)
    assert sorted(1e3 * stood.edge_distances) == pytest.approx([15.7, 23.6, 24.9], abs=0.05)
    assert stood.barrier == min(each.rise for each in rock.neighbours(stood))


@pytest.mark.verifies("invariant", "the pose as scanned")
def test_the_base_of_the_granite_rock_by_tolerance(rock):
    """What it would stand on if points within some millimetres touched: never a narrower base."""
    stood = rock.settling((-0.8059, -0.2466, 0.5383))
    rows = base_tolerances(rock, stood)
    assert [row.tolerance for row in rows] == [0.0, 0.0005, 0.001, 0.002, 0.005]
    assert rows[0].edge_distance == pytest.approx(float(stood.edge_distances.min()), abs=1e-9)
    assert rows[0].barrier == pytest.approx(stood.barrier, abs=1e-9)
    assert all(a.edge_distance <= b.edge_distance + 1e-12 for a, b in pairwise(rows))
    assert all(a.points <= b.points for a, b in pairwise(rows))
