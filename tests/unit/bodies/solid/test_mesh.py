"""Surface meshes: what is repaired and said, what is refused and why."""

import math
import struct

import numpy as np
import pytest

from rocking.bodies.formats.mesh import mesh_from_file, solid_from_mesh
from rocking.bodies.solid import Polyhedron, box, rotation_about
from rocking.bodies.solid.repair.merge import WELD
from rocking.bodies.solid.repair.steps import repair_surface
from rocking.errors import BodyFileError, GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

trimesh = pytest.importorskip("trimesh")

CUBE = box(1.0, 1.0, 4.0)
V, F = CUBE.vertices, CUBE.faces
MASS, SPIN = 4000.0, (4000.0 * 17.0 / 12.0, 4000.0 * 17.0 / 12.0, 4000.0 / 6.0)


def saved(folder, vertices, faces, name):
    path = folder / name
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    return path


def triangle_soup(vertices, faces):
    corners = vertices[faces].reshape(-1, 3)
    return corners, np.arange(len(corners)).reshape(-1, 3)


def sphere(divisions=3):
    found = trimesh.creation.icosphere(divisions)
    return np.array(found.vertices), np.array(found.faces)


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.ply", "a.glb"])
def test_formats(tmp_path, name):
    """Every format gives the prism's mass and inertia; STL, which repeats every corner, says that it was welded."""
    solid = solid_from_mesh(saved(tmp_path, V, F, name), 1000.0, units="m")
    assert solid.mass == pytest.approx(MASS, rel=1e-12, abs=0.0)
    assert np.diag(solid.inertia) == pytest.approx(SPIN, rel=1e-12, abs=0.0)
    assert len(solid.base.vertices) == 4
    assert [text.startswith("merged 28 of 36 vertices") for text in solid.repairs] == [True] * (name == "a.stl")


def test_units_and_axis(tmp_path):
    """Millimetres are told, not guessed; y up stands the body up."""
    path = saved(tmp_path, V * 1000.0, F, "a.stl")
    assert solid_from_mesh(path, 1000.0, units="mm").mass == pytest.approx(MASS, rel=1e-6)
    lying = saved(tmp_path, V[:, [0, 2, 1]] * [1, 1, -1], F, "b.glb")
    assert solid_from_mesh(lying, 1000.0, units="m", up="y").centre[2] == pytest.approx(2.0)
    with pytest.raises(TypeError):
        mesh_from_file(path)
    with pytest.raises(InvalidValueError, match="length unit"):
        mesh_from_file(path, units="km")
    with pytest.raises(InvalidValueError, match="up must be"):
        mesh_from_file(path, units="m", up="x")
    with pytest.raises(BodyFileError, match=r"1000 x 1000 x 4000 m in the unit m. Check the unit"):
        mesh_from_file(path, units="m")
    doubt = mesh_from_file(saved(tmp_path, V * 10.0, F, "c.stl"), units="m").repairs[-1]
    assert "check the unit" in doubt


def test_flipped_faces():
    """Faces that look the wrong way are turned back, and the sentence counts them."""
    faces = F.copy()
    faces[[3, 5, 8]] = faces[[3, 5, 8], ::-1]
    done = repair_surface(V, faces)
    assert done.repairs == ("reversed 3 of 12 faces with an orientation opposite to their neighbours",)
    assert done.shape.moments().mass == pytest.approx(4.0, rel=1e-14, abs=0.0)
    # negative controls: as they are they are refused, and the bare sum is wrong
    with pytest.raises(GeometryError, match="must be closed and oriented"):
        Polyhedron(V, faces)
    a, b, c = np.moveaxis(V[faces], 1, 0)
    assert abs(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 - 4.0) > 0.1


def test_inside_out():
    """A surface that is inside out as a whole is turned, and said to be."""
    assert repair_surface(V, F[:, ::-1]).repairs == ("reversed 1 shell(s) with 12 faces",)


def test_unwelded():
    """A soup of triangles is welded first; without welding nothing is closed, so that nothing is integrated."""
    vertices, faces = triangle_soup(V, F)
    done = repair_surface(vertices, faces)
    assert len(done.shape.vertices) == 8
    with pytest.raises(GeometryError, match="36 edges have no neighbour"):
        Polyhedron(vertices, faces)


def test_nearly_equal_vertices():
    """Corners that rounding pulled apart are merged within 1e-6 of the size; wider gaps are refused."""
    vertices, faces = triangle_soup(V, F)
    noise = np.random.default_rng(1).normal(size=vertices.shape)
    done = repair_surface(vertices + 1e-7 * noise, faces)
    assert "up to 4e-06 m" in done.repairs[0]
    assert done.shape.moments().mass == pytest.approx(4.0, rel=1e-5)
    with pytest.raises(GeometryError, match="is not closed"):
        repair_surface(vertices + 1e-3 * noise, faces)
    assert repair_surface(vertices + 1e-4 * noise, faces, weld_tolerance=2e-3).shape.moments().mass == pytest.approx(
        4.0, rel=1e-3
    )


def test_a_closed_surface_is_left_as_it_is():
    """Corners 1e-9 of the size apart stay two where nothing is open, in a soup of triangles too."""
    beside = len(V)
    vertices = np.vstack([V, V[0] + 1e-3 * WELD * (V[F[0, 1]] - V[F[0, 0]])])
    opposite = next(f for f in F[1:] if set(F[0, :2].tolist()) <= set(f.tolist()))
    # the edge of two faces is split next to its end: a closed surface with an edge of 1e-9 of the size
    split = []
    for face in F.tolist():
        if set(face) in (set(F[0].tolist()), set(opposite.tolist())):
            at = [face.index(number) for number in F[0, :2].tolist()]
            split += [[beside if i == place else number for i, number in enumerate(face)] for place in at]
        else:
            split.append(face)
    done = repair_surface(vertices, np.array(split))
    assert (done.repairs, len(done.shape.vertices)) == ((), 9)
    soup = repair_surface(*triangle_soup(vertices, np.array(split)))
    assert len(soup.shape.vertices) == 9


def test_small_hole():
    """A hole of a thousandth of a sphere is closed, said with its bound, and refused where no repair is wanted."""
    vertices, faces = sphere()
    whole = repair_surface(vertices, faces).shape.moments().mass
    keep = np.ones(len(faces), dtype=bool)
    keep[7] = False
    with pytest.raises(GeometryError, match=r'1 hole\(s\): .*repair="safe" closes'):
        repair_surface(vertices, faces[keep], repair="none")
    done = repair_surface(*triangle_soup(vertices, faces[keep]))
    assert done.repairs[-1].startswith("closed 1 hole(s): 0.202 m wide (3 edges)")
    assert "% of the volume" in done.repairs[-1]
    assert done.shape.moments().mass == pytest.approx(
        whole, rel=1e-12, abs=0.0
    )  # a patch over a flat triangle is the triangle


def test_duplicates_and_degenerates():
    """Doubled faces and faces without area disappear, and are counted."""
    faces = np.concatenate([F, F[:2], [[0, 0, 1]]])
    done = repair_surface(V, faces)
    assert done.repairs == (
        "removed 1 degenerate faces",
        "removed 2 duplicate faces",
    )
    assert done.shape.moments().mass == pytest.approx(4.0, rel=1e-14, abs=0.0)


FOLDED = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])


@pytest.mark.parametrize(
    ("vertices", "faces", "repair", "words"),
    [
        (V, F[:-1], "none", r"1 hole\(s\): 4\.12 m wide \(3 edges\)"),
        (V, F[:-1], "safe", r"The safe limits are 1 % .* Repairs: closed 1 hole"),
        (V * [1.0, 1.0, 0.0], F, "safe", "enclose no volume"),
        (FOLDED, np.array([[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]]), "safe", "no volume"),
        (np.where(np.arange(24).reshape(8, 3) == 16, math.nan, V), F, "all", "vertex 5 must be finite"),
    ],
    ids=["missing face", "large hole", "sheet", "folded sheet", "nan"],
)
def test_what_is_no_surface(vertices, faces, repair, words):
    """A hole is described, one of 12 % of the surface is not safe; sheets enclose nothing; no number is named."""
    with pytest.raises(GeometryError, match=words):
        repair_surface(vertices, faces, repair=repair)


@pytest.mark.slow
def test_shells():
    """Prisms that share an edge add up, one inside another wound inward is a cavity, crossing ones are united."""
    other = np.concatenate([F, F + 8])
    beside = repair_surface(np.concatenate([V, V + np.array([1.0, 1.0, 0.0])]), other)
    assert beside.shape.moments().mass == pytest.approx(8.0, rel=1e-13, abs=0.0)
    assert "2 separate shells, including 0 cavities" in beside.repairs[-1]
    hollow = repair_surface(np.concatenate([V, V * 0.5 + [0.0, 0.0, 1.0]]), np.concatenate([F, F[:, ::-1] + 8]))
    assert hollow.shape.moments().mass == pytest.approx(3.5, rel=1e-13, abs=0.0)
    assert "including 1 cavities" in hollow.repairs[-1]
    for shift, shared in (([0.5, 0.5, 0.0], 1.0), ([0.5, 0.5, 1.0], 0.75), ([0.3, 0.0, 2.0], 1.4)):
        both = repair_surface(np.concatenate([V, V + shift]), other)
        assert both.shape.moments().mass == pytest.approx(8.0 - shared, rel=1e-9, abs=0.0)
        assert f"with a common volume of {shared:.3g} m3" in both.repairs[0]
    with pytest.raises(GeometryError, match='repair="none" allows none: united 2 intersecting shells'):
        repair_surface(np.concatenate([V, V + np.array([0.5, 0.5, 1.0])]), other, repair="none")


def nested(*winding):
    """Boxes one in the other, each beside the middle of the last; wound outward (1) or inward (-1)."""
    box_, sizes = box(1.0, 1.3, 0.7), np.array([4.0, 3.0, 2.0, 1.0, 0.5])[: len(winding)]
    vertices = [size * (box_.vertices - [0.0, 0.0, 0.35]) + 0.3 * (4.0 - size) * np.ones(3) / 3.0 for size in sizes]
    faces = [(box_.faces if out > 0 else box_.faces[:, ::-1]) + 8 * i for i, out in enumerate(winding)]
    return np.concatenate(vertices), np.concatenate(faces)


def enclosed(*signs):
    """Volume of such boxes, added or taken off [m3]."""
    return 1.3 * 0.7 * sum(s * size**3 for s, size in zip(signs, (4.0, 3.0, 2.0, 1.0), strict=False))


@pytest.mark.slow
@pytest.mark.parametrize("outward", [1, -1], ids=["outward", "inward"])
def test_shells_inside_shells(outward):
    """Four boxes one in the other, wound alternately, are a body, a cavity, a body and a cavity."""
    done = repair_surface(*nested(*(outward * np.array([1, -1, 1, -1]))))
    assert done.shape.moments().mass == pytest.approx(enclosed(1, -1, 1, -1), rel=1e-13, abs=0.0)
    assert "4 separate shells, including 2 cavities" in done.repairs[-1]
    assert (len(done.repairs) == 1) == (outward > 0)


@pytest.mark.slow
@pytest.mark.parametrize("outward", [1, -1], ids=["outward", "inward"])
def test_inner_parts_are_decided_by_the_user(outward):
    """Of parts wound like what surrounds them the user states what they are; each reading has its closed form.

    A box wound like the outer one inside it is matter or a cavity; the same within a cavity is matter, which nobody
    doubts, and inside matter again it is as was stated.
    """
    vertices, faces = nested(*(outward * np.ones(4, dtype=int)))
    for repair in ("none", "safe", "all"):
        with pytest.raises(GeometryError, match=r'a difference of 42\.2 %; use inner_parts="solid" or'):
            repair_surface(*nested(outward, outward), repair=repair)
    for inner, volume in (("solid", enclosed(1)), ("cavity", enclosed(1, -1, 1, -1))):
        done = repair_surface(vertices, faces, inner_parts=inner)
        assert done.shape.moments().mass == pytest.approx(volume, rel=1e-13, abs=0.0)
        stated = next(each for each in done.repairs if "inner_parts" in each)
        assert f'inner_parts="{inner}" applied' in stated
        assert f"{enclosed(1):.4g} m3 if solid and {enclosed(1, -1, 1, -1):.4g} m3 if hollow" in stated
    for inner, volume in (("solid", enclosed(1, -1, 1)), ("cavity", enclosed(1, -1, 1, -1))):
        done = repair_surface(*nested(*(outward * np.array([1, -1, 1, 1]))), inner_parts=inner)
        assert done.shape.moments().mass == pytest.approx(volume, rel=1e-13, abs=0.0)
    with pytest.raises(InvalidValueError, match="inner_parts must be one of refuse, solid, cavity"):
        repair_surface(V, F, inner_parts="hollow")


def test_a_small_inner_part_is_within_the_bound_of_safe_repairs():
    """Half a percent of the volume, near the middle, is taken as solid and named; far from it, it moves the centre."""
    speck = 0.005 ** (1.0 / 3.0)
    middle = V.mean(axis=0)

    def with_part(shift, repair="safe"):
        other = np.concatenate([V, middle + speck * (V - middle) + shift])
        return repair_surface(other, np.concatenate([F, F + 8]), repair=repair)

    done = with_part([0.02, 0.05, 0.1])
    assert done.shape.moments().mass == pytest.approx(4.0, rel=1e-13, abs=0.0)
    assert "solid assumed" in done.repairs[0]
    assert "at most 0.5 % of the volume" in done.repairs[0]
    with pytest.raises(GeometryError, match="allows none: 1 closed part inside"):
        with_part([0.0, 0.0, 0.1], "none")
    larger = middle + 0.0101 ** (1.0 / 3.0) * (V - middle)
    with pytest.raises(GeometryError, match="inner_parts="):
        repair_surface(np.concatenate([V, larger]), np.concatenate([F, F + 8]))


@pytest.mark.slow
def test_an_inner_part_through_the_wall_has_the_volume_of_the_solid_reading():
    """A part that pokes out by a thousandth is united: the solid reading of the part inside is continuous with it."""
    inner = V * 0.5 + np.array([0.0, 0.0, 1.0])
    out = inner + np.array([0.251, 0.0, 0.0])
    both = np.concatenate([F, F + 8])
    solid = repair_surface(np.concatenate([V, inner]), both, inner_parts="solid")
    united = repair_surface(np.concatenate([V, out]), both)
    assert united.shape.moments().mass == pytest.approx(4.0 + 0.001 * 0.5 * 2.0, rel=1e-9, abs=0.0)
    assert solid.shape.moments().mass == pytest.approx(4.0, rel=1e-13, abs=0.0)
    turned = repair_surface(
        np.concatenate([V, out, V * 0.2 + [-0.2, 0.0, 0.3]]),
        np.concatenate([both, F + 16])[:, ::-1],
        inner_parts="cavity",
    )
    assert turned.shape.moments().mass == pytest.approx(4.001 - 0.032, rel=1e-9, abs=0.0)


def test_a_thin_wall_of_which_both_skins_look_outward():
    """A skin closely inside another one is a surface scanned twice, unless inner parts are stated to be cavities."""
    inside = V.mean(axis=0) + 0.999 * (V - V.mean(axis=0))
    both = np.concatenate([V, inside]), np.concatenate([F, F + 8])
    assert repair_surface(*both).shape.moments().mass == pytest.approx(4.0, rel=1e-13, abs=0.0)
    hollow = repair_surface(*both, inner_parts="cavity").shape.moments().mass
    assert hollow == pytest.approx(4.0 * (1.0 - 0.999**3), rel=1e-9, abs=0.0)


def test_one_sided_surface():
    """A Moebius band has an open edge; neither it nor what a patch makes of it becomes a body."""
    count = 12
    turn = 2.0 * math.pi * np.arange(count) / count
    rim = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    half = 0.5 * np.stack([np.cos(turn / 2) * np.cos(turn), np.cos(turn / 2) * np.sin(turn), np.sin(turn / 2)], axis=1)
    vertices = np.concatenate([rim + half, rim - half])
    faces = []
    for i in range(count):
        j, k = (i + 1) % count, i + count
        m = j + count
        if j == 0:
            j, m = m, j
        faces += [(i, j, k), (j, m, k)]
    for repair in ("none", "safe", "all"):
        with pytest.raises(GeometryError):
            repair_surface(vertices, np.array(faces), repair=repair)


def test_dust():
    """Hundreds of loose pieces are refused rather than added to the body."""
    shifts = np.stack([3.0 * np.arange(201.0), np.zeros(201), np.zeros(201)], axis=1)
    vertices = (V[None] + shifts[:, None]).reshape(-1, 3)
    faces = (F[None] + 8 * np.arange(201)[:, None, None]).reshape(-1, 3)
    with pytest.raises(GeometryError, match="201 separate pieces"):
        repair_surface(vertices, faces)


@pytest.mark.verifies("invariant", "the same mesh at the origin", within="1e-9")
def test_far_from_the_origin(tmp_path):
    """In double precision a mesh at 1e6 m keeps its inertia to 1e-9; single precision is found out."""
    offset = np.array([1e6, 2e6, 0.0])
    solid = solid_from_mesh(saved(tmp_path, V + offset, F, "a.obj"), 1000.0, units="m")
    assert np.diag(solid.inertia) == pytest.approx(SPIN, rel=1e-9)
    assert solid.centre == pytest.approx([1e6, 2e6, 2.0], rel=1e-12, abs=0.0)
    with pytest.raises(BodyFileError, match="single precision"):
        mesh_from_file(saved(tmp_path, V + offset, F, "a.stl"), units="m")
    near = mesh_from_file(saved(tmp_path, V + np.array([3000.0, 0.0, 0.0]), F, "b.stl"), units="m")
    assert "single-precision coordinates far from the origin" in near.repairs[-1]


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.ply", "a.glb"])
def test_damaged_files(tmp_path, name):
    """Cut short anywhere, empty, or garbage: never a body that differs from the whole one."""
    whole = saved(tmp_path, *sphere(1), name).read_bytes()
    path = tmp_path / name
    for share in (0.0, 0.1, 0.5, 0.9, 0.99):
        path.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises((BodyFileError, GeometryError), match=name):
            mesh_from_file(path, units="m")
    path.write_bytes(b"\x00nonsense" * 40)
    with pytest.raises(BodyFileError, match=name):
        mesh_from_file(path, units="m")


def test_headers_that_lie(tmp_path):
    """A binary STL with another number of faces than its bytes hold, and an ASCII one without an end, are refused."""
    path = saved(tmp_path, V, F, "a.stl")
    content = bytearray(path.read_bytes())
    content[80:84] = struct.pack("<I", 11)
    path.write_bytes(content)
    with pytest.raises(BodyFileError, match="11 faces in its header"):
        mesh_from_file(path, units="m")
    text = trimesh.Trimesh(V, F, process=False).export(file_type="stl_ascii")
    path.write_text(text.replace("endsolid", ""))
    with pytest.raises(BodyFileError, match="endsolid is missing"):
        mesh_from_file(path, units="m")
    path.write_text(text)
    assert mesh_from_file(path, units="m").shape.moments().mass == pytest.approx(4.0, rel=1e-6)


def test_other_files(tmp_path):
    """No such file, no such format, no triangles: a sentence each."""
    with pytest.raises(BodyFileError, match="no such file"):
        mesh_from_file(tmp_path / "a.stl", units="m")
    (tmp_path / "a.step").write_text("x")
    with pytest.raises(BodyFileError, match="stl, obj, ply, glb, xyz"):
        mesh_from_file(tmp_path / "a.step", units="m")
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n")
    with pytest.raises(BodyFileError, match=r"no triangles, and . points are too few"):
        mesh_from_file(tmp_path / "a.obj", units="m")


def test_scans_stand_on_a_tolerance(tmp_path):
    """A base that is uneven by millimetres is let down onto three corners, or stands on all within a tolerance."""
    vertices = V.copy()
    vertices[[1, 2, 3], 2] += [0.001, 0.0015, 0.002]
    path = saved(tmp_path, vertices, F, "a.obj")
    rests = solid_from_mesh(path, units="m")
    assert len(rests.base.vertices) == 3
    assert rests.repairs[-1].startswith("rotated by 0.")
    assert len(solid_from_mesh(path, units="m", base_tolerance=0.003).base.vertices) == 4


def test_a_mesh_in_single_precision_stands_on_its_whole_face(tmp_path):
    """Corners of a turned box, rounded as in binary STL: four of them are its base, not three."""
    turn = rotation_about([0.3, -0.5, 0.8], 1.1)
    sides = box(0.5, 0.7, 1.1)
    down = turn @ np.array([0.0, 0.0, 1.0])
    path = saved(tmp_path, (sides.vertices @ turn.T).astype(np.float32).astype(np.float64), sides.faces, "a.obj")
    solid = solid_from_mesh(path, units="m", up=down)
    assert len(solid.base.vertices) == 4
    assert solid.base.margin(solid.centre[:2]) == pytest.approx(0.25, rel=1e-5)


def test_what_is_known_is_let_down_with_the_mesh(tmp_path):
    """A known centre beyond the base lays the prism on its side; it is told as the file stands, inertia likewise."""
    path = saved(tmp_path, V, F, "a.obj")
    assert solid_from_mesh(path, units="m", centre=(0.4, 0.1, 2.5)).centre == pytest.approx([0.4, 0.1, 2.5])
    leaning = rotation_about([0.0, 1.0, 0.0], 0.5)
    path = saved(tmp_path, V @ leaning.T, F, "b.obj")
    local, moments = np.array([0.2, 0.1, 2.5]), np.diag([4500.0, 4200.0, 700.0])
    known = {"centre": leaning @ local, "inertia": leaning @ moments @ leaning.T, "mass": 3000.0}
    lying = solid_from_mesh(path, units="m", **known)  # OBJ has eight digits
    assert (lying.mass, lying.centre[2] - lying.ground) == pytest.approx((3000.0, 0.5 - 0.2), rel=1e-7)
    assert np.sort(np.linalg.eigvalsh(lying.inertia)) == pytest.approx([700.0, 4200.0, 4500.0], rel=1e-7)
    assert lying.inertia[2, 2] == pytest.approx(4500.0, rel=1e-7)
    assert "to a stable pose" in lying.repairs[-1]
    upright = solid_from_mesh(path, units="m")
    assert upright.centre[2] - upright.ground != pytest.approx(0.3, rel=1e-2)


def test_a_tetrahedron_loses_its_doubled_face_alone():
    """Four faces are a body, and stay one when a fifth lies on one of them: volume abc / 6."""
    corners = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.4, 2.0, 0.0], [0.7, 0.5, 5.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 3, 0]])
    done = repair_surface(corners, faces)
    assert len(done.shape.faces) == 4
    assert done.shape.moments().mass == pytest.approx(3.0 * 2.0 * 5.0 / 6.0, rel=1e-14, abs=0.0)
    assert any("removed 1 duplicate face" in each for each in done.repairs)
