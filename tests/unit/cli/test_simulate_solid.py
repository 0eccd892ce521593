"""`rocking simulate` of bodies in space: Python's numbers, the plane solution, three components, refusals."""

import math

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.dynamics.rolling import SpatialResponse, response
from rocking.dynamics.rolling.body import SpatialBody
from rocking.outcome import Status

pytestmark = pytest.mark.slow

COMMAND = "simulate"

PRISM = 'units = "m"\nname = "prism"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.5, height = 2.0 }\n'
SINE = "sine:amplitude=3.2,period=0.8"
MOTION = rk.pulses.sine(3.2, 0.8)


def same(answer, response):
    """Whether a JSON holds a response in space to the last digit."""
    contacts = [(row["start"], row["end"], row["contact"], tuple(row["vertices"])) for row in answer["intervals"]]
    return (
        answer["peak_tilt"] == response.peak_tilt
        and answer["summary"] == response.summary
        and answer["restitution"] == response.law.label
        and [tuple(row.values()) for row in answer["impacts"]] == response.impacts.tolist()
        and contacts == [(a, b, c.name.lower(), points) for a, b, c, points in response.intervals]
        and tuple("none" if one is None else one["name"] for one in answer["motions"].values()) == response.names
    )


@pytest.fixture
def body(file):
    """Body file of a prism."""
    return file(PRISM, "prism.toml")


@pytest.fixture
def record(file):
    """Time and three components in four columns [m/s2]."""
    k = np.arange(60)
    rows = np.column_stack([k * 0.02, 3.0 * np.sin(k * 0.2), 3.5 * np.sin(k * 0.15), 2.0 * np.cos(k * 0.3)])
    return file("\n".join(" ".join(f"{x:.6f}" for x in row) for row in rows) + "\n", "record.txt")


@pytest.fixture
def followed_once(monkeypatch):
    """Follow a history once for all doors that ask for the same motions, law, settings and duration."""
    follow, histories = response.response_in_space, {}

    def kept(body, motions, restitution, settings, **options):
        key = repr((SpatialBody.of(body).inertia, motions, restitution, settings, options))
        if key not in histories:
            histories[key] = follow(body, motions, restitution, settings, **options)
        return histories[key]

    monkeypatch.setattr(response, "response_in_space", kept)
    return histories


def test_json_is_python_to_the_last_digit(answered, body, followed_once):
    """x by word or option, y and z by options, restitution, scale and gravity: all are rk.simulate."""
    solid, other = rk.read_body(body), rk.pulses.sine(2.9, 0.6)
    expected = rk.simulate(solid, {"x": MOTION, "y": other})
    assert len({c for _, _, c, _ in expected.intervals}) > 2
    for words in ((SINE,), ("--motion", SINE)):
        answer = answered(body, *words, "--motion", "y=sine:amplitude=2.9,period=0.6")
        assert same(answer, expected)
    assert answer["body"]["mass"] == pytest.approx(1200.0)
    ked = ("--restitution", "ked", "--scale", "-1.1", "--set", "settings.gravity=9.81")
    found = answered(body, "--motion", "z=sine:amplitude=1,period=0.3", "--motion", f"y={SINE}", *ked)
    wanted = rk.simulate(solid, {"y": MOTION, "z": rk.pulses.sine(1.0, 0.3)}, "ked-3d", scale=-1.1, gravity=9.81)
    assert same(found, wanted)
    # negative control: the components are not taken for each other
    assert not same(answered(body, "--motion", SINE, *ked), wanted)


def test_three_components_of_one_file(answered, body, record):
    """Each direction names its component of the file; the vertical part may stand with x too."""
    file = ("--units", "m/s2")
    names = [part.name for part in rk.motions.formats.read_record(record, units="m/s2").components]
    x, y, z = names
    along = (f"{record}#{x}", *file, "--motion", f"y={record}#{y}")
    found = answered(body, *along, "--motion", f"z={record}#{z}")
    motions = [rk.read_motion(record, units="m/s2", component=name) for name in names]
    assert found["peak_tilt"] == rk.simulate(rk.read_body(body), motions).peak_tilt
    other = answered(body, *along, "--set", f"motion.vertical={z}")
    assert other["peak_tilt"] == pytest.approx(found["peak_tilt"], rel=1e-12, abs=0.0)
    # negative control: without the vertical motion it is another response
    level = answered(body, *along)
    assert level["peak_tilt"] != pytest.approx(found["peak_tilt"], rel=1e-3)
    mixed = answered(body, SINE, "--motion", f"y={record}#{y}", *file)
    assert mixed["peak_tilt"] == rk.simulate(rk.read_body(body), {"x": MOTION, "y": motions[1]}).peak_tilt


def test_page_and_files(printed, body, tmp_path):
    """Body, motions, outcome, contacts and impacts are on the page; every file is written and opens."""
    files = {name: tmp_path / f"a.{name}" for name in ("png", "csv", "mat", "nc", "html")}
    words = (word for path in files.values() for word in ("--output", path))
    out = printed(body, SINE, "--motion", "y=sine:amplitude=2.9,period=0.6", "--details", *words)
    for said in ("prism, 0.5 x 0.5 x 2 m, 1200 kg", "calibrated-3d", "turning about a vertex", "Peak tilt"):
        assert said in out
    for path in files.values():
        assert f"wrote {path}" in out
    assert np.asarray(Image.open(files["png"])).std() > 1.0
    assert "friction" not in files["html"].read_text(encoding="utf-8")
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(files["nc"], engine="h5netcdf", decode_timedelta=False) as data:
        assert float(data["tilt"].max()) < 0.25
        assert data.attrs["mass"] == pytest.approx(1200.0)


def test_meshes_rock_too(answered, tmp_path):
    """A prism from an STL file in mm, turned round on one face, rocks as that of the body file."""
    trimesh = pytest.importorskip("trimesh")
    faces = rk.bodies.solid.box(0.5, 0.5, 2.0)
    path = tmp_path / "prism.stl"
    trimesh.Trimesh(faces.vertices * 1000.0, faces.faces, process=False).export(path)
    answer = answered(path, SINE, "--units", "mm", "--density", "1000")
    assert answer["body"]["mass"] == pytest.approx(500.0)
    plane = rk.simulate(rk.Block(width=0.5, height=2.0), MOTION)
    assert answer["peak_tilt"] == pytest.approx(plane.peak_rotation, rel=1e-9)


def test_overturning_names_edge_and_direction(run, answered, body):
    """Shaken hard along y it lies along y, over one of the edges there; the direction is in radians."""
    answer = answered(body, "--motion", f"y={SINE}", "--scale", "2")
    assert answer["outcome"] == "overturned"
    assert abs(answer["direction"]) == pytest.approx(0.5 * math.pi, abs=1e-9)
    assert answer["overturned_over"] in {"edge 0-1", "edge 2-3"}
    assert "over edge" in run(body, "--motion", f"y={SINE}", "--scale", "2")[1]


def test_a_history_without_a_result_is_refused(run, body, monkeypatch):
    """Where the engine stops, the sentence says why, and no number is printed."""
    monkeypatch.setattr(SpatialResponse, "outcome", rk.Outcome.FAILED)
    monkeypatch.setattr(SpatialResponse, "status", Status.LOST_CONTACT)
    code, out, err = run(body, SINE)
    assert (code, out) == (2, "")
    assert err.startswith("rocking: there is no response: stopped: the contact force becomes tensile")


LEANING = (
    'units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.6, height = 2.0 }\n'
    "[[solid.part]]\nbox = { width = 0.1, depth = 0.6, height = 1.0 }\ndensity = 4800\nat = [0.1, 0, 2.0]\n"
)
CENTRE_X, CENTRE_Z = 1440.0 * np.array([0.0, 1.0]) / 1728.0 + 288.0 * np.array([0.1, 2.5]) / 1728.0


@pytest.mark.parametrize("friction", [None, 5.0])
@pytest.mark.parametrize("free", [0.5, -0.5])
def test_free_rocking_of_a_solid(answered, tmp_path, friction, free):
    """A solid that leans towards x, or away from it, meets the ground when the plane body of its section does.

    alpha = atan((b -+ x) / h) on either side of an asymmetric body. Negative control: the sides differ.
    """
    path = tmp_path / "body.toml"
    path.write_text(LEANING, encoding="utf-8")
    answer = answered(
        path, "--initial-rotation", free, "--restitution", 0.5, *([] if friction is None else ["--friction", friction])
    )
    lever = {0.5: 0.25 - CENTRE_X, -0.5: 0.25 + CENTRE_X}
    assert answer["initial_tilt"] == pytest.approx(0.5 * math.atan2(lever[free], CENTRE_Z), rel=1e-12)
    assert answer["initial_azimuth"] == pytest.approx(0.0 if free > 0.0 else math.pi)
    outlines = [(-0.25, 0.25, 0.0, 2.0, 2400.0), (0.05, 0.15, 2.0, 3.0, 4800.0)]
    regions = [rk.Region([(a, c), (b, c), (b, d), (a, d)], density) for a, b, c, d, density in outlines]
    plane = rk.Section(regions)
    side = plane.side("right" if free > 0.0 else "left")
    first = rk.free_rocking(plane, free * side.slenderness_angle, 0.5).impacts["time"][0]
    assert answer["impacts"][0]["time"] == pytest.approx(float(first), rel=1e-6)
    other = rk.free_rocking(plane, -free * plane.side("left" if free > 0.0 else "right").slenderness_angle, 0.5)
    assert answer["impacts"][0]["time"] != pytest.approx(float(other.impacts["time"][0]), rel=1e-3)


def test_free_rocking_of_a_solid_in_words_and_files(printed, answered, body, tmp_path):
    """The page has tilt, direction and balance; a file says the same; a motion has no initial tilt."""
    page = printed(body, "--initial-rotation", "-0.5", "--friction", "0.8")
    assert "released at -7.018 deg, -0.5 of 14.04 deg" in page
    document = tmp_path / "question.toml"
    document.write_text(
        '[body]\nfile = "prism.toml"\n[response]\ninitial_rotation = -0.5\nfriction = 0.8\n', encoding="utf-8"
    )
    assert answered(document)["impacts"] == answered(body, "--initial-rotation", "-0.5", "--friction", "0.8")["impacts"]
    assert "initial_tilt" not in answered(body, SINE)


def test_capitals_of_a_model_do_not_matter(run, answered, body, followed_once):
    """`KED-3D` is `ked-3d`; what is no model is named as it was written."""
    words = (body, "--motion", "sine:amplitude=2.9,period=0.6", "--restitution")
    upper, lower = (answered(*words, name) for name in ("KED-3D", "ked-3d"))
    assert upper["peak_tilt"] == lower["peak_tilt"]
    assert run(*words, "KED-3E")[0] == 2


def test_a_round_base_is_followed_to_rest_or_its_end_has_a_reason(printed, answered, tmp_path, followed_once):
    """A cylinder under one sine comes to rest after it; under two it rolls on without impact, which screen, --json and
    Python state; with a duration that is no reason."""
    file, reason = tmp_path / "drum.toml", "no impact lost energy in the 15 / p after the motion"
    file.write_text(
        'units = "m"\n[[solid.part]]\ncylinder = { diameter = 0.5, height = 2.0 }\ndensity = 1000\n', encoding="utf-8"
    )
    solid, pulse = rk.read_body(file), rk.pulses.sine(3.2, 0.8)
    landed = rk.simulate(solid, {"x": pulse}, "housner")
    assert (landed.still_rocking, landed.ends_early, int(landed.contact[-1])) == (False, False, 0)
    frequency = landed.body.frequency(9.81)
    assert landed.end > pulse.duration + 15.0 / frequency, "it still rocks where the first look ends"
    words = (file, "--motion", "x=sine:amplitude=2.6,period=0.8", "--motion", "y=sine:amplitude=2.5,period=0.5")
    words += ("--restitution", "housner")
    told, page = answered(*words), printed(*words)
    assert told["ends_early"] is True
    for text in (told["last_state"]["unfinished"], told["summary"], " ".join(page.split())):
        assert reason in text
        assert "use duration= in Python for a longer response" in text
    rolling = rk.simulate(solid, {"x": rk.pulses.sine(2.6, 0.8), "y": rk.pulses.sine(2.5, 0.5)}, "housner")
    assert (rolling.exported().provenance["ends_early"], rolling.impacts.size) == (True, 0)
    assert len(followed_once) == 2, "Python, page and --json ask for the same history"
    # negative control: a stated duration ends another history without that reason
    stated = rk.simulate(solid, {"x": pulse}, "housner", duration=3.0)
    assert (stated.still_rocking, stated.ends_early) == (True, False)
    assert reason not in stated.summary
