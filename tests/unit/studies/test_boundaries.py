"""Boundaries and safe islands: marching squares, bisection, saddles, holes in overturning."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy import ndimage
from scipy.optimize import brentq

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.studies import boundary, overturning_map, safe_beyond_overturning, safe_islands
from rocking.studies.adaptive_grid import AdaptiveGrid, Plane
from rocking.studies.boundaries import chains, crossed_edges, edge_numbers, segments
from rocking.studies.islands import connected

pytestmark = pytest.mark.verifies(room="studies")

BLOCK = rk.Block.from_angle(0.15, 1.0)
HALF_SINE = rk.pulses.half_sine(1.0, 0.5)
GRID = ("frequency_ratio", np.linspace(1.0, 9.0, 9)), ("amplitude_ratio", np.linspace(1.05, 6.05, 11))


def half_sine(omega):
    """Closed form of the half sine."""

    def open_terms(psi):
        return math.cos(psi) + math.exp(-(math.pi - psi) / omega) - omega * math.sin(psi)

    return 1.0 / math.sin(brentq(open_terms, 1e-9, 0.5 * math.pi, xtol=1e-16))


def outline(inside, centre=False):
    """Chains of edges around the True points of a grid."""
    inside = np.asarray(inside, dtype=bool)
    rows, columns = inside.shape
    i, j = (a.ravel() for a in np.meshgrid(np.arange(columns - 1), np.arange(rows - 1)))
    corners = np.stack([inside[j, i], inside[j, i + 1], inside[j + 1, i + 1], inside[j + 1, i]], axis=1)
    return chains(segments(corners, edge_numbers(i, j, columns), np.full(i.size, centre)))


def test_each_of_the_sixteen_cells():
    """Every pattern of corners crosses as many edges as its corners alternate, and joins them in pairs."""
    for pattern in range(16):
        corners = np.array([[bool(pattern >> k & 1) for k in range(4)]])
        alternations = int(sum(corners[0, k] != corners[0, k - 1] for k in range(4)))
        assert crossed_edges(corners).sum() == alternations
        joined = segments(corners, np.array([[10, 11, 12, 13]]), np.array([False]))
        assert len(joined) == alternations // 2
        assert len(np.unique(joined)) == alternations


DIAGONAL = [[0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 0]]


@pytest.mark.parametrize(
    ("inside", "centre", "sizes", "closed"),
    [
        ([[0, 0, 0], [0, 1, 0], [0, 0, 0]], False, [5], True),
        ([[0, 1, 0], [0, 0, 0]], False, [3], False),  # a point at the margin
        (DIAGONAL, False, [5, 5], True),
        (DIAGONAL, True, [9], True),
        ([row[::-1] for row in DIAGONAL], False, [5, 5], True),
        ([row[::-1] for row in DIAGONAL], True, [9], True),
    ],
)
def test_outlines_of_points(inside, centre, sizes, closed):
    """One point has a closed outline of four edges; opposite corners are one outline if the centre is inside."""
    lines = outline(inside, centre)
    assert [len(line) for line in lines] == sizes
    assert all((line[0] == line[-1]) is closed for line in lines)


def test_neighbours_share_edges():
    """The right edge of a cell is the left one of the next, its top the bottom of the one above."""
    numbers = edge_numbers(np.array([0, 1, 0]), np.array([0, 0, 1]), 5)
    assert numbers[0, 1] == numbers[1, 3]
    assert numbers[0, 2] == numbers[2, 0]
    assert len(np.unique(numbers)) == 10


@pytest.mark.verifies("closed form", "the roots of the boundary of half sines", within="1e-9", control="within")
def test_vertices_lie_on_the_closed_form():
    """Every vertex of the half sine's boundary, on upright and level edges, satisfies its equation to 1e-9."""
    (line,) = boundary(BLOCK, HALF_SINE, *GRID, 0.9, linear=True, threads=1)
    expected = [half_sine(omega) for omega in line.points[:, 0]]
    assert len(expected) > 15
    np.testing.assert_allclose(line.points[:, 1], expected, rtol=1e-9)
    reported = np.sqrt(1.0 + line.points[:, 0] ** 2)
    assert (np.abs(line.points[:, 1] / reported - 1.0) > 0.05).all()  # negative control: sqrt(1 + Omega^2)
    assert line.modes.tolist() == [[-1, 0]] * len(expected)
    assert not line.closed
    assert line.axes == ("frequency_ratio", "amplitude_ratio")
    # from cell to cell: no longer than a cell's diagonal, and sorted along this monotone curve
    assert (np.abs(np.diff(line.points, axis=0)) <= [1.0 + 1e-12, 0.5 + 1e-12]).all()
    assert (np.diff(line.points[:, 0]) > 0.0).all() or (np.diff(line.points[:, 0]) < 0.0).all()


@pytest.mark.slow
@pytest.mark.verifies("closed form", "the roots of the boundary of half sines", within="1e-9")
@pytest.mark.parametrize("levels", [1, 3])
def test_refinement_adds_vertices_on_the_curve(levels):
    """A refined boundary has more vertices, all on the closed form, and goes from margin to margin."""
    (line,) = boundary(BLOCK, HALF_SINE, *GRID, 0.9, levels=levels, linear=True, threads=1)
    np.testing.assert_allclose(line.points[:, 1], [half_sine(omega) for omega in line.points[:, 0]], rtol=1e-9)
    assert len(line.points) > 12 * 2**levels
    assert sorted(line.points[[0, -1], 0].tolist()) == pytest.approx([1.0, 9.0])


def test_tolerance_is_kept():
    """A loose tolerance leaves brackets that wide, and no more histories than it takes."""
    told, exact = [], []
    options = {"linear": True, "threads": 1}
    (loose,) = boundary(BLOCK, HALF_SINE, *GRID, 0.9, tolerance=1e-3, progress=told.append, **options)
    (tight,) = boundary(BLOCK, HALF_SINE, *GRID, 0.9, progress=exact.append, **options)
    np.testing.assert_allclose(loose.points, tight.points, rtol=1e-3)
    assert sum(told) < 0.5 * sum(exact)


@pytest.mark.slow
def test_outlines_of_modes_enclose_what_the_verdict_does():
    """Every vertex of the verdict's outline is on that of a mode, which also sees gaps between modes within a cell."""
    pulse = rk.pulses.sine(1.0, 0.5)
    axes = ("frequency_ratio", np.linspace(2.0, 6.5, 19)), ("amplitude_ratio", np.linspace(1.1, 9.1, 33))
    by_mode = boundary(BLOCK, pulse, *axes, 0.9, by="mode", linear=True, threads=1)
    by_verdict = boundary(BLOCK, pulse, *axes, 0.9, linear=True, threads=1)
    assert {line.region for line in by_mode} >= {"overturned after 0 impacts", "overturned after 1 impacts"}
    assert {line.region for line in by_verdict} == {"overturned"}

    def met(lines):
        return {(*p,) for line in lines for p, m in zip(line.points.tolist(), line.modes, strict=True) if m[0] < 0}

    assert met(by_verdict) < met(by_mode)


def test_nothing_changes_nothing_to_draw():
    """Where all survives or all overturns there is no boundary."""
    for ratios in ([0.2, 0.5], [50.0, 60.0]):
        assert boundary(BLOCK, HALF_SINE, ("frequency_ratio", [1.0, 2.0]), ("amplitude_ratio", ratios), 0.9) == []


def test_failed_corners_are_left_out():
    """Where there is no block there is no boundary either, and the rest is drawn."""
    lines = boundary(
        BLOCK, HALF_SINE, ("width", np.linspace(0.1, 2.5, 13)), ("semi_diagonal", np.linspace(0.2, 1.0, 9)), 0.9
    )
    for line in lines:
        assert (line.modes != -3).all()
    plane = Plane.of(BLOCK, HALF_SINE, ("width", [0.1, 2.5]), ("semi_diagonal", [0.2, 1.0]), 0.9, gravity=9.81)
    lattice = AdaptiveGrid(plane, 0)
    lattice.compute(lattice.base())
    assert -3 in lattice.modes


@pytest.mark.verifies("invariant", "the map of all points of the finest grid")
def test_slivers_are_outlined_as_in_a_map_of_all_points():
    """Refining finds the lines that marching every point of the finest grid gives, thin gaps between modes included."""
    pulse, finest = rk.pulses.sine(1.0, 0.5), 10 * 2**3 + 1
    ends = {"frequency_ratio": (1.0, 9.0), "amplitude_ratio": (1.05, 12.05)}
    coarse, fine = ([(name, np.linspace(*end, n)) for name, end in ends.items()] for n in (11, finest))
    lines = boundary(BLOCK, pulse, *coarse, 0.9, levels=3, linear=True, threads=1)
    whole = overturning_map(BLOCK, pulse, *fine, 0.9, linear=True, threads=1)["mode"].values
    assert sorted(len(line.points) for line in lines) == sorted(len(chain) for chain in outline(whole >= 0))
    assert len(lines) > 1  # negative control: cells whose verdicts differ lead along a single line
    for line in lines:
        assert (line.modes[:, 0] < 0).all()
        assert (line.modes[:, 1] >= 0).all()


def drawn(*rows):
    """A map from characters, the top row last: . not lifted, s survived, # overturned, x failed."""
    codes = {".": -2, "s": -1, "#": 0, "1": 1, "x": -3}
    modes = np.array([[codes[c] for c in row] for row in reversed(rows)])
    y, x = (np.arange(n, dtype=float) for n in modes.shape)
    return xr.Dataset({"mode": (("y", "x"), modes)}, coords={"x": 10.0 * x, "y": y})


@pytest.mark.parametrize(
    ("rows", "enclosed", "every"),
    [
        (("######", "#ss###", "#s####", "ss####", "......"), [], 0),  # joined to the region below
        (("######", "#ss###", "#s####", "######", "......"), [3], 1),
        # what reaches the edge, or touches a failed point, may go on there
        (("##s###", "##s###", "######", "......"), [], 1),
        (("######", "#sx###", "######", "......"), [], 1),
        # the largest first; an oblique strip is one island
        (("#######", "#s##ss#", "###s###", "##s####", "#######", "......."), [4, 1], 2),
        # pieces of a strip between two modes are islands as well; that at the edge is none
        (("#######", "#s##s##", "11s111s", "1111111", "......."), [2, 1], 3),
        (("#######", "#s#####", "#######", "1111111", "1111s11", "1111111", "......."), [1, 1], 2),
        (("#######", "#s#####", "1111111", "1111111", "......."), [1], 1),
    ],
)
def test_islands(rows, enclosed, every):
    """Holes in overturning are enclosed islands, by their cells; others are found where asked for."""
    found, more = safe_islands(drawn(*rows)), safe_islands(drawn(*rows), enclosed=False)
    assert [island.cells for island in found.islands] == enclosed
    assert len(more) == every
    assert sum(island.enclosed for island in more.islands) == len(enclosed)
    assert found.labels.max() == len(enclosed)
    assert [int((found.labels == k).sum()) for k in range(1, 1 + len(enclosed))] == enclosed


def test_words_of_islands():
    """The answer defines the word, and counts cells that are not decided, and islands between two ways to overturn."""
    found = drawn("#######", "#ss####", "1111111", "11111s1", "1111111", ".......")
    still = np.zeros(found["mode"].shape)
    still[4, 1] = 1.0  # a cell of the island between both ways
    words = " ".join(safe_islands(found.assign(still_rocking=(("y", "x"), still))).sentences)
    assert words.startswith(
        "Safe islands: 2, with 3 of 42 cells. A safe island is a region of cells that do not overturn,"
    )
    assert "Cells still rocking at the end of the computation: 1 of 3" in words
    assert "Islands between two modes of overturning: 1 of 2" in words
    assert [(each.modes, each.is_between_modes, each.still_rocking) for each in safe_islands(found).islands] == [
        ((0, 1), True, 0), ((1,), False, 0),
    ]  # fmt: skip
    one = safe_islands(drawn("####", "#s##", "####", "....")).sentences
    assert len(one) == 1
    none = safe_islands(drawn("####", "#ss#", "..s.")).sentences
    assert none == (f"No safe islands. {safe_islands(found).definition}",)


def test_extent_of_an_island():
    """Area, and least and greatest coordinates."""
    (found,) = safe_islands(drawn("######", "#ss###", "#s####", "######", "......")).islands
    assert (found.area, found.x, found.y) == (30.0, (10.0, 20.0), (2.0, 3.0))


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "SciPy's label", within="every map")
def test_regions_are_those_of_scipy():
    """Random maps are numbered as `scipy.ndimage.label` numbers them, neighbours also diagonally."""
    random = np.random.default_rng(1)
    for _ in range(300):
        survived = random.random(random.integers(1, 13, 2)) < random.random()
        expected, _ = ndimage.label(survived, np.ones((3, 3)))
        assert np.array_equal(connected(survived), expected)


@pytest.mark.parametrize("points", [100, 200])
def test_a_grid_does_not_cut_islands_out_of_a_strip(points):
    """The gap between modes I and II of the full sine is one strip: what the grid cuts out of it is said to be so."""
    block, pulse = rk.Block.from_angle(0.15, 1.0), rk.pulses.sine(1.0, 0.5)
    axes = ("frequency_ratio", np.linspace(1.0, 9.0, points)), ("amplitude_ratio", np.linspace(0.5, 12.0, points))
    found = overturning_map(block, pulse, *axes, 0.9, linear=True, threads=1)
    pieces = safe_islands(found).islands
    assert len(pieces) >= 2
    assert all(piece.is_between_modes for piece in pieces)
    # negative control: a hole in one way to overturn is not
    assert not safe_islands(drawn("####", "#s##", "####", "....")).islands[0].is_between_modes


def test_safe_beyond_overturning():
    """True where something below, or to the left, overturned; the failed are not called safe."""
    given = drawn("s#s", "###", "#sx", "s.#", "...")
    upwards = safe_beyond_overturning(given)
    assert upwards.values[::-1].tolist() == [[1, 0, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]
    rightwards = safe_beyond_overturning(given, along="x")
    assert rightwards.values[::-1].tolist() == [[0, 0, 1], [0, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, 0]]
    assert upwards.name == "safe_beyond_overturning"


@pytest.mark.parametrize("bad", [None, 3, xr.Dataset(), xr.Dataset({"mode": ("x", [1, 2])})])
def test_what_is_no_map_is_refused(bad):
    """Only a dataset with a mode over two axes is a map."""
    with pytest.raises(InvalidValueError, match="a map is"):
        safe_islands(bad)


def test_unknown_axes_are_refused():
    """Only an axis of the map can be gone along."""
    with pytest.raises(InvalidValueError, match="along"):
        safe_beyond_overturning(drawn("##", ".."), along="z")
