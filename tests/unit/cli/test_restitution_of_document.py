"""`rocking restitution` of files and options: a file to take away, and what is known of a body, said in every way."""

import json
import math

import pytest

import rocking as rk

BODY = '[body]\nunits = "cm"\nwidth = 50\nheight = 200\n'
TAKEN = f"""[response]
friction = 0.5

{BODY}
[motion]
record = "not-here.AT2"
scale = 1.1

[restitution]
models = ["ked", "housner"]
"""


@pytest.fixture
def taken(file):
    """Return a file to take away, without the record beside it."""
    return file(TAKEN, "response.toml")


def test_the_body_is_taken_and_the_rest_is_for_simulate(run, taken):
    """The table is that of the block itself, below a sentence that says what is not used."""
    code, out, err = run(taken)
    assert (code, err) == (0, "")
    first, _, rest = out.partition("\n")
    assert first.endswith("`rocking simulate` uses the other tables.")
    assert rest == run("--width", 0.5, "--height", 2)[1]


def test_json_stays_alone_on_its_stream(run, taken):
    """With --json the sentence goes to the other stream, and the numbers are those of the block itself."""
    code, out, err = run(taken, "--json")
    assert code == 0
    assert "rocking simulate" in err
    assert json.loads(out) == json.loads(run("--width", 0.5, "--height", 2, "--json")[1])


def test_its_gravity_holds_unless_another_is_given(run, tmp_path):
    """The settings of the file say the gravity; the option says it over them; nothing need move the body yet."""
    path = tmp_path / "moon.toml"
    path.write_text(f"[response]\n{BODY}[settings]\ngravity = 1.62\n")
    for words, gravity in (((), 1.62), (("--set", "settings.gravity=3.7"), 3.7)):
        answer = json.loads(run(path, "--json", *words)[1])
        assert answer["body"]["gravity"] == gravity


@pytest.mark.parametrize(
    ("text", "words", "said"),
    [
        (TAKEN, ["--width", "1"], "--width cannot be combined"),
        (TAKEN, ["--units", "cm"], "--units cannot be combined"),
        (TAKEN.replace("width = 50", "width = -50"), [], "width"),
        (TAKEN.replace("height = 200\n", ""), [], "height"),
        (TAKEN + "[campaign]\n", [], "campaign"),
        ("[response]\ninitial_rotation = 0.5\n", [], "body"),
    ],
)
def test_what_cannot_be_meant_is_refused(run, tmp_path, text, words, said):
    """Sizes beside the file, a body that is none and other tables are refused in a sentence with the file's name."""
    path = tmp_path / "response.toml"
    path.write_text(text)
    code, _, err = run(path, *words)
    assert code != 0
    assert said in err
    assert "response.toml" in err
    assert "Traceback" not in err


COMMAND = "restitution"
SIZE = ("--width", 80, "--height", 200, "--depth", 60, "--units", "cm")
KNOWN = (*SIZE, "--mass", 300, "--centre", "42,70")
BLOCK = rk.Block(width=0.8, height=2.0, depth=0.6, mass=300.0, centre=(0.42, 0.7))
OUTLINE = rk.Block(width=0.8, height=2.0, mass=300.0, centre=(0.42, 0.7))
"""The same block without a depth, as an outline is."""
CRATE = 'units = "cm"\n[solid]\nmass = 300\ncentre = [2, 0, 70]\n[[solid.part]]\n'
CRATE += "box = { width = 80, depth = 60, height = 200 }\n"


def test_options_files_and_sets_say_the_same(run, answered, tmp_path):
    """The body of options, of a body file, of a question's file and of --set is the Block of Python."""
    file = tmp_path / "cabinet.toml"
    file.write_text('units = "cm"\n[block]\nwidth = 80\nheight = 200\ndepth = 60\nmass = 300\ncentre = [42, 70]\n')
    question = tmp_path / "question.toml"
    question.write_text(
        '[body]\nunits = "cm"\nwidth = 80\nheight = 200\ndepth = 60\nmass = 300\ncentre = [42, 70]\n'
        '[motion]\npulse = "sine:amplitude=7,period=0.8"\n[response]\n'
    )
    drawing = tmp_path / "cabinet.wkt"
    drawing.write_text("POLYGON ((0 0, 800 0, 800 2000, 0 2000, 0 0))")
    sets = (*SIZE, "--set", "body.mass=300", "--set", "body.centre=[42, 70]")
    ways = [KNOWN, (file,), (question,), sets, (drawing, "--units", "mm", "--mass", 300, "--centre", "420,700")]
    for words in ways:
        code, out, err = run(*words, "--restitution", "housner", "--json")
        assert code == 0, err
        body = json.loads(out)["body"]
        assert body["mass"] == pytest.approx(300.0, rel=1e-14)
        assert body["centre"] == pytest.approx([0.42, 0.7], rel=1e-14)
        assert body["moment_of_inertia"] == pytest.approx(BLOCK.moment_of_inertia, rel=1e-14)
        assert body["assumed"] == list((BLOCK if words[0] != drawing else OUTLINE).assumed)
        assert body["sides"]["left"]["slenderness_angle"] == pytest.approx(math.atan(0.42 / 0.7), rel=1e-14)
    plain = answered(*SIZE, "--restitution", "housner")["body"]
    assert plain["mass"] != pytest.approx(300.0)


def test_every_model_has_a_row_and_what_was_assumed_is_printed(printed):
    """No model fails for a plane body of known moments; the moment of inertia stands as it was given."""
    page = printed(*KNOWN)
    for name in rk.restitution.models():
        assert name == "fixed" or f"\n{name}" in page
    assert "moment of inertia assumed" in page
    given = printed(*KNOWN, "--moment-of-inertia", 95)
    assert "moment of inertia assumed" not in given
    assert "mass distribution assumed by ked" in given


def test_a_solid_leaves_out_the_models_that_need_more(printed, answered, tmp_path):
    """Of a solid of known moments ked-3d is left out of the table, with its reason; asked for, it is refused."""
    file = tmp_path / "crate.toml"
    file.write_text(CRATE)
    page = printed(file)
    assert "left out: ked-3d" in page
    assert "needs the distribution of mass" in page
    listed = ["housner-3d", "horizontal-momentum-3d", "calibrated-3d"]
    assert list(answered(file)["edges"][0]["coefficients"]) == listed
    file.write_text(CRATE.replace("centre = [2, 0, 70]\n", ""))
    assert "ked-3d" in answered(file)["edges"][0]["coefficients"]
    assert "left out" not in printed(file)


def test_a_mesh_takes_mass_and_centre(answered, tmp_path):
    """Beside a mesh: the mass in place of the density, the centre in the coordinates and the unit of the mesh."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "box.stl"
    trimesh.creation.box((800.0, 600.0, 2000.0)).export(path)
    words = (path, "--units", "mm", "--mass", 300, "--set", "body.centre=[20, 0, -300]")
    body = answered(*words)["body"]
    assert body["mass"] == pytest.approx(300.0, rel=1e-12)
    assert body["centre_height"] == pytest.approx(0.7, rel=1e-9)


def test_a_centre_in_another_unit_is_doubted(answered):
    """The answer is there, with a warning that asks for the unit."""
    doubts = answered(*SIZE, "--centre", "0.42,0.7")["body"]["warnings"]
    assert "check that lengths are in m" in " ".join(doubts)
