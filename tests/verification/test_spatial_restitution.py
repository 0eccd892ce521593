"""Restitution in space against closed forms, independent quadrature, the plane models and invariances."""

import math
import os
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate
from scipy.spatial import ConvexHull

import rocking as rk
from rocking.bodies.solid import Corner, Edge, Part, Polyhedron, box, cylinder, extrusion, frustum, rotation_about
from rocking.restitution.ked import ring_integral
from rocking.restitution.space import edge_coefficient, impact_in_space, integrals, spatial_models
from rocking.restitution.space.integrals import exact_moment, kept_moments, line_moment
from rocking.restitution.space.ked import energy_left

pytestmark = pytest.mark.verifies(room="restitution in space")

PRISM = rk.Solid(Part(box(1.0, 1.0, 4.0)).moved(0.5, 0.5, 0.0))
MODELS = sorted(spatial_models())
PLANE = {
    "ked-3d": "ked",
    "ked-3d-point": "ked",
    "housner-3d": "housner",
    "horizontal-momentum-3d": "horizontal-momentum",
    "calibrated-3d": "calibrated",
}
ALONG = np.array([0.0, 1.0, 0.0])

# --- REF values (CONTRIBUTING.md) --------------------------------------------------------------------


@pytest.mark.verifies("computed anew", "coefficients to 15 digits", within="1e-10")
@pytest.mark.parametrize(
    ("height", "model", "value"),
    [
        (2.0, "ked", 0.8372108803084781),
        (2.0, "housner", 0.6962025316455697),
        (2.0, "horizontal-momentum", 0.810126582278481),
        (4.0, "ked", 0.9501165798529068),
        (4.0, "housner", 0.9114391143911439),
        (4.0, "horizontal-momentum", 0.9446494464944649),
    ],
)
def test_cylinder_over_a_diameter(height, model, value):
    """REF: a cylinder of diameter 1 that falls back over a diameter."""
    assert edge_coefficient(rk.Solid(cylinder(1.0, height)), model) == pytest.approx(value, rel=1e-10, abs=0.0)


@pytest.mark.verifies("computed anew", "two-dimensional quadrature by SciPy", within="1e-9")
def test_cylinder_as_a_weight_over_the_plane():
    """The depth enters as a weight alone: the same integral by an independent two-dimensional quadrature."""
    radius, height = 0.5, 2.0

    def column(x):
        return integrate.quad(lambda y: y**4 / (y * y + (radius - x) ** 2), 0.0, height, epsabs=1e-13)[0]

    top = integrate.quad(lambda x: 2.0 * math.sqrt(radius**2 - x * x) * column(x), -radius, radius, epsabs=1e-12)[0]
    solid = rk.Solid(cylinder(1.0, 2.0))
    assert line_moment(solid, solid.base.edge(0.0)) / 2400.0 == pytest.approx(top, rel=1e-9, abs=0.0)


@pytest.mark.verifies("closed form", "59/71 and 64/71; KED to 13 digits", within="1e-12")
@pytest.mark.parametrize(
    ("model", "value"),
    [("housner", 59.0 / 71.0), ("horizontal-momentum", 64.0 / 71.0), ("ked-3d-point", 0.9132455302034)],
)
def test_prism_over_its_diagonal(model, value):
    """REF: a prism 1 x 1 x 4 that falls from one corner onto the opposite one."""
    result = impact_in_space(PRISM, [-1.0, 1.0, 0.0], pivot=(0, 0), onto=(1, 1), model=model)
    assert result.coefficient == pytest.approx(value, rel=1e-12, abs=0.0)
    assert result.velocity / np.linalg.norm(result.velocity) == pytest.approx(np.array([-1, 1, 0]) / math.sqrt(2))


@pytest.mark.verifies("computed anew", "KED about a line, 13 digits", within="1e-12")
def test_axis_operator():
    """REF: about a line through the far corner KED gives 0.9125, not the 0.9132 of the point."""
    line = Edge(np.array([1.0, 1.0, 0.0]), np.array([-1.0, 1.0, 0.0]) / math.sqrt(2))
    result = impact_in_space(PRISM, [-1.0, 1.0, 0.0], pivot=(0, 0), onto=line, model="ked-3d-point")
    assert result.coefficient == pytest.approx(0.9125115342467, rel=1e-12, abs=0.0)


@pytest.mark.verifies("closed form", "(4 l^2 - 5) / (4 l^2 + 7)", within="1e-13")
@pytest.mark.parametrize("slenderness", [1.5, 2.0, 4.0, 8.0])
def test_housner_over_the_diagonal(slenderness):
    """Housner over the diagonal: (4 l^2 - 5)/(4 l^2 + 7) for a square prism of any slenderness."""
    solid = rk.Solid(box(1.0, 1.0, slenderness))
    result = impact_in_space(solid, [-1, 1, 0], pivot=(-0.5, -0.5), onto=(0.5, 0.5), model="housner")
    value = (4.0 * slenderness**2 - 5.0) / (4.0 * slenderness**2 + 7.0)
    assert result.raw_velocity @ [-1, 1, 0] / 2.0 == pytest.approx(value, rel=1e-13, abs=0.0)


@pytest.mark.verifies(
    "computed anew", "angular velocities to 8 digits", within="6e-9", control="test_wrong_closures_are_found_out"
)
@pytest.mark.parametrize(
    ("model", "value"),
    [
        ("housner", (0.18824672, 0.90893638, 0.05603448)),
        ("horizontal-momentum", (0.22073822, 0.91728995, 0.01982759)),
        ("ked-3d-point", (0.22320589, 0.92754448, 0.02004924)),
    ],
)
def test_corner_to_corner(model, value):
    """REF: from corner A to the adjacent B with a spin about the vertical, all three vectors."""
    result = impact_in_space(PRISM, [0.3, 1.0, 0.1], pivot=(0, 0), onto=(1, 0), model=model)
    assert result.velocity == pytest.approx(np.array(value), abs=6e-9)


@pytest.mark.verifies("negative control", "energy without the direction of the momentum, or momentum before stage 1")
def test_wrong_closures_are_found_out():
    """Negative control: energy without the momentum's direction, or momentum before stage 1, miss the vectors."""
    right = np.array([0.22320589, 0.92754448, 0.02004924])
    impact = impact_in_space(PRISM, [0.3, 1.0, 0.1], pivot=(0, 0), onto=(1, 0), model="ked-3d").impact
    for direction in (impact.velocity, np.linalg.solve(impact.inertia, impact.angular_momentum)):
        wrong = direction * math.sqrt(2.0 * energy_left(impact) / (direction @ impact.inertia @ direction))
        assert np.abs(wrong - right).max() > 1e-3


# --- independent quadrature ------------------------------------------------------------------------


@pytest.mark.verifies("computed anew", "Gauss points over graded volumes", within="1e-9")
def test_corner_energy_by_brute_force(agreement):
    """T'' of the corner impact by Gauss points over graded volumes, straight from the operators, to 1e-9."""
    velocity, point = np.array([0.3, 1.0, 0.1]), np.array([1.0, 0.0, 0.0])
    nodes, weights = np.polynomial.legendre.leggauss(10)
    # cubic grading towards the corner B = (1, 0, 0) makes the integrand smooth enough
    u, w = 0.5 * (1.0 + nodes), 0.5 * weights
    cuts = 2.0 ** -np.arange(9.0)
    edges = np.concatenate([[0.0], cuts[::-1]])
    t = (edges[:-1, None] + np.diff(edges)[:, None] * u).ravel()
    wt = (np.diff(edges)[:, None] * w).ravel()
    x, y, z = np.meshgrid(1.0 - t, t, 4.0 * t, indexing="ij")
    dv = 4.0 * np.einsum("i,j,k->ijk", wt, wt, wt).ravel()
    s = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    v = np.cross(velocity, s) * [1.0, 1.0, 0.0]
    d = (s - point) / np.linalg.norm(s - point, axis=1, keepdims=True)
    left = v - d * np.einsum("nd,nd->n", v, d)[:, None]
    brute = 0.5 * 2400.0 * float(dv @ np.einsum("nd,nd->n", left, left))
    impact = impact_in_space(PRISM, velocity, pivot=(0, 0), onto=(1, 0), model="ked-3d").impact
    agreement(abs(energy_left(impact) / brute - 1.0), 1e-9)


# --- the plane -------------------------------------------------------------------------------------

TRAPEZOID = rk.Section.from_trapezoid(1.0, 0.4, 2.5)
HOLED = rk.Section.from_points([(0, 0), (1.2, 0), (1.0, 2), (0.1, 2.4)], holes=[[(0.3, 0.5), (0.8, 0.6), (0.5, 1.5)]])
LAYERED = rk.Section(
    [rk.Region([(0, 0), (1, 0), (1, 1), (0, 1)], 7800.0), rk.Region([(0.1, 1), (0.8, 1), (0.5, 3)], 1600.0)],
    feet=(0.05, 0.9),
)


@pytest.mark.verifies("invariant", "the plane model of the section", within="1e-12")
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("onto", ["left", "right"])
@pytest.mark.parametrize("section", [TRAPEZOID, HOLED, LAYERED], ids=["trapezoid", "holed", "layered"])
def test_prisms_of_any_polygon_equal_the_plane(section, onto, model):
    """The edge operator in space is the plane model for every extruded polygon, to 1e-12."""
    solid = rk.Solid.from_section(section)
    left, right = (
        Edge(np.array([x, 0.0, section.ground]), sign * ALONG)
        for x, sign in zip(section.feet, (-1.0, 1.0), strict=True)
    )
    start, end = (left, right) if onto == "right" else (right, left)
    result = impact_in_space(solid, end.direction, pivot=start, onto=end, model=model)
    assert result.coefficient == pytest.approx(
        rk.coefficient_of_restitution(section, PLANE[model], foot=onto), rel=1e-12, abs=0.0
    )


@pytest.mark.verifies("computed anew", "the coefficient to 16 digits", within="1e-12")
def test_known_trapezoid():
    """REF: KED 0.8704740952680223 for the trapezoid, here as a solid."""
    solid = rk.Solid.from_section(TRAPEZOID)
    assert edge_coefficient(solid, start=1, model="ked-3d") == pytest.approx(0.8704740952680223, rel=1e-12, abs=0.0)


@pytest.mark.verifies("computed anew", "quadrature over the faces of the same prism", within="1e-12")
def test_exact_extrusion_equals_surface_quadrature():
    """The polygon's boundary sum and the quadrature over the faces of the same prism agree to 1e-12."""
    solid = rk.Solid.from_section(HOLED)
    mesh = rk.Solid(
        [
            Part(Polyhedron(p.shape.vertices, p.shape.faces), p.density, rotation=p.rotation, translation=p.translation)
            for p in solid.parts
        ],
        base=solid.base,
    )
    edge = Edge(np.array([solid.local_base.vertices[:, 0].max(), 0.0, 0.0]), ALONG)
    assert line_moment(mesh, edge) == pytest.approx(line_moment(solid, edge), rel=1e-12, abs=0.0)


def in_slices(points, along, offset):
    """The integral over a hull about a level line, summed along the line from polygons across it."""
    places = points @ along

    def across(place):
        a, b = np.array(list(product(points[places < place], points[places > place]))).swapaxes(0, 1)
        cut = a + ((place - a @ along) / ((b - a) @ along))[:, None] * (b - a)
        plane = np.column_stack([cut[:, 0] * along[1] - cut[:, 1] * along[0] - offset, cut[:, 2]])
        return ring_integral(plane[ConvexHull(plane).vertices])

    ends = pairwise(np.sort(places))  # between two corners a polygon changes smoothly
    return sum(integrate.quad(across, low, high, epsabs=1e-14, epsrel=1e-12)[0] for low, high in ends)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "polygons across the line, summed along it", within="1e-11", control="within")
@pytest.mark.parametrize("seed", range(6))
def test_flat_faces_exactly(seed, agreement, monkeypatch):
    """Random hulls about random level lines, every second with faces that are all but seen from their side.

    The control leaves these out.
    """
    random = np.random.default_rng(seed)
    points, turn = random.uniform([-0.5, -0.3, 0.0], [0.4, 0.6, 1.5], (12, 3)), random.uniform(0.0, 2.0 * math.pi)
    along = np.array([math.cos(turn), math.sin(turn), 0.0])
    points[:3, 2] = 0.0
    offset = float((points[:3, 0] * along[1] - points[:3, 1] * along[0]).max()) + 0.1 * (seed > 2)
    if seed % 2:
        points[3:6, 2], points[6, 2] = 1.5, 1.5 + 1e-4
        points[6, :2] = points[3:6, :2].mean(axis=0) + 0.5 * along[:2]
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    inward = (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) * hull.equations[:, :3]).sum(1) < 0
    faces = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    part, line = Part(Polyhedron(points, faces), 1.0), np.array([offset * along[1], -offset * along[0], 0.0])
    true = in_slices(points[hull.vertices], along, offset)
    agreement(abs(exact_moment(part, line, along) / true - 1.0), 1e-11)
    monkeypatch.setattr(integrals, "samples", lambda *_: [])
    if seed % 2:
        assert abs(exact_moment(part, line, along) / true - 1.0) > 1e-3


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form", "the plane coefficient, with the square of the depth", within="0.05 of the square of the depth"
)
@pytest.mark.parametrize("depth", [1.0, 0.1, 0.01])
def test_thin_bodies_approach_the_plane(depth):
    """About a corner KED tends to the plane value with the square of the depth."""
    solid = rk.Solid(box(1.0, depth, 4.0))
    result = impact_in_space(solid, ALONG, pivot=(-0.5, -0.5 * depth), onto=(0.5, -0.5 * depth), model="ked-3d")
    assert result.velocity[1] == pytest.approx(0.94736683503237, abs=0.05 * depth**2 + 1e-12)


@pytest.mark.verifies("closed form", "the cosine between the edges times the plane coefficient", within="1e-11")
@pytest.mark.parametrize("model", ["ked-3d-point", "horizontal-momentum"])
@pytest.mark.parametrize("sides", [3, 5, 7])
def test_stepping_between_edges(model, sides):
    """From an edge onto one at an angle, r = |e1 . e2| times the plane coefficient of e2.

    The plane motion may have any pivot: neither model cares where the old one was."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    solid = rk.Solid(extrusion(np.stack([np.cos(turn), np.sin(turn)], axis=1), 6.0))
    edges = solid.base.edges
    for i, edge in enumerate(edges[1:], 1):
        cosine = -float(edges[0].direction @ edge.direction)
        if cosine <= 0.0:
            continue
        plane = impact_in_space(solid, edge.direction, pivot=(0.0, 0.0), onto=edge, model=model).coefficient
        assert edge_coefficient(solid, model, start=0, onto=i) == pytest.approx(cosine * plane, rel=1e-11, abs=0.0)


# --- invariances and bounds ------------------------------------------------------------------------

COLUMN = rk.Solid([Part(box(1.0, 1.2, 0.3), 2400.0), Part(frustum(0.8, 0.5, 2.0), 2700.0).moved(0.05, 0.0, 0.3)])
CASE = {"velocity": np.array([0.3, 1.0, 0.1]), "pivot": np.array([-0.5, -0.6]), "onto": np.array([0.5, -0.6])}


def outcome(solid, case, model):
    return impact_in_space(solid, case["velocity"], pivot=case["pivot"], onto=case["onto"], model=model).raw_velocity


@pytest.mark.slow
@pytest.mark.verifies("invariant", "another size and density, turned and mirrored", within="1e-11")
@pytest.mark.parametrize("model", MODELS)
def test_size_density_turn_and_mirror(model):
    """Size and density change nothing; a turned or mirrored body has the turned or mirrored velocity."""
    here = outcome(COLUMN, CASE, model)
    large = {**CASE, "pivot": 3.0 * CASE["pivot"], "onto": 3.0 * CASE["onto"]}
    assert outcome(COLUMN.scaled(size=3.0, density=7.0), large, model) == pytest.approx(here, rel=1e-11, abs=0.0)
    turn = rotation_about((0, 0, 1), 0.83)
    rotated = {key: turn[: len(value), : len(value)] @ value for key, value in CASE.items()}
    assert outcome(COLUMN.turned(0.83), rotated, model) == pytest.approx(turn @ here, rel=1e-11, abs=0.0)
    # in the mirror x -> -x an angular velocity keeps its x component and turns the others
    mirrored = {key: np.array([-1.0, 1.0]) * CASE[key] for key in ("pivot", "onto")}
    mirrored["velocity"] = np.array([1.0, -1.0, -1.0]) * CASE["velocity"]
    assert outcome(COLUMN.mirrored(), mirrored, model) == pytest.approx([1.0, -1.0, -1.0] * here, rel=1e-11, abs=0.0)


@pytest.mark.verifies("invariant", "the same prism in two halves, as a mesh and as an extrusion", within="1e-12")
def test_additivity_of_parts():
    """The integrals of KED are sums over parts: a prism in two halves, and as a box, a mesh and an extrusion."""
    halves = rk.Solid([box(1.0, 1.0, 2.0), Part(box(1.0, 1.0, 2.0)).moved(0, 0, 2.0)])
    whole = rk.Solid(box(1.0, 1.0, 4.0))
    mesh = rk.Solid(Polyhedron(whole.parts[0].shape.vertices, whole.parts[0].shape.faces))
    prism = rk.Solid(extrusion([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)], 4.0))
    corner = Corner(np.array([0.5, 0.5, 0.0]))
    expected = kept_moments(whole, corner).fourth
    for other in (halves, mesh, prism):
        assert kept_moments(other, corner).fourth == pytest.approx(expected, rel=1e-12, abs=1e-9)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "energy, and the bound of Cauchy and Schwarz", within="1e-12")
@settings(max_examples=30 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 12, deadline=None)
@given(
    st.floats(0.3, 6.0),
    st.floats(0.3, 2.0),
    st.tuples(st.floats(-0.9, 0.9), st.floats(0.2, 1.0), st.floats(-1.0, 1.0)),
    st.sampled_from([(0.5, -0.5), (0.5, 0.5)]),
)
def test_energy_bounds(height, depth, velocity, corner):
    """No model creates energy; KED by points never turns slower than its momentum alone says (Cauchy-Schwarz)."""
    solid = rk.Solid(box(1.0, depth, height))
    case = {"pivot": (-0.5, -0.5 * depth), "onto": (corner[0], corner[1] * depth)}
    middle = np.array([0.5, 0.5 * depth, 0.0])
    if np.cross(velocity, middle)[2] > -1e-3:
        return
    results = {model: impact_in_space(solid, velocity, model=model, **case) for model in MODELS}
    for result in results.values():
        energy = 0.5 * result.raw_velocity @ result.impact.inertia @ result.raw_velocity
        assert energy <= result.energy_before * (1.0 + 1e-12)
    ked, momentum = (np.linalg.norm(results[name].raw_velocity) for name in ("ked-3d-point", "horizontal-momentum-3d"))
    assert ked >= momentum * (1.0 - 1e-12)


@pytest.mark.verifies("invariant", "Carnot's theorem", within="1e-12")
def test_housner_is_a_projection():
    """Identity of rigid bodies: what Housner loses is the energy of the velocity that is lost (Carnot)."""
    result = impact_in_space(PRISM, [0.3, 1.0, 0.1], pivot=(0, 0), onto=(1, 0), model="housner")
    impact, moments = result.impact, result.impact.moments
    spin = impact.velocity - result.velocity
    centre = impact.landing_velocity + np.cross(spin, moments.centre)
    lost = 0.5 * (spin @ moments.inertia @ spin + moments.mass * centre @ centre)
    assert result.energy_before - result.energy_after == pytest.approx(lost, rel=1e-12, abs=0.0)


@pytest.mark.verifies("invariant", "no loss where the corner stays", within="1e-13", control="within")
def test_same_pivot_is_no_impact_for_housner():
    """With the new corner where the old one was Housner and KED lose nothing, KED by points does."""
    case = {"velocity": [0.3, 1.0, 0.1], "pivot": (0.0, 0.0), "onto": (0.0, 0.0)}
    for model in ("housner", "ked"):
        assert impact_in_space(PRISM, model=model, **case).energy_ratio == pytest.approx(1.0, rel=1e-13, abs=0.0)
    assert impact_in_space(PRISM, model="ked-3d-point", **case).energy_ratio < 0.99
