"""`rocking predict`: the same as in Python, from options and from a file; files, refusals."""

import json
import math
from pathlib import Path

import bad_scans
import pytest

import rocking as rk
from rocking.answers import plain
from rocking.cli import main

pytestmark = pytest.mark.slow

trimesh = pytest.importorskip("trimesh")

COMMAND = "predict"
DOCS = Path(__file__).parents[3] / "docs" / "how_to" / "assessment.md"
SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=4.2,period=0.8"
FEW = ("--set", "predict.count=16")
FAST = ("--set", "predict.count=4", "--set", "predict.contributions=false")
ONE = ("--count", "1", "--set", "motion.pga=5")
FILE = """
[body]
units = "cm"
width = 50
height = 200
[motions]
pulse = "sine:amplitude=4.2,period=0.8"
[predict]
friction = { mean = 0.5, deviation = 0.1 }
restitution = 0.9
count = 16
"""


def test_json_is_the_python_call(run):
    code, out, err = run(
        *SIZE, PULSE, "--friction", "0.6", "--restitution", "ked", *FEW, "--set", "predict.base=[0,0.01]", "--json"
    )
    assert (code, err) == (0, "")
    found = rk.predict(
        rk.Block(width=0.5, height=2.0),
        rk.pulses.sine(4.2, 0.8),
        friction=0.6,
        restitution="ked",
        base=(0, 0.01),
        count=16,
    )
    assert json.loads(out) == plain(found.answer().plain())


def test_a_class_of_bodies_is_no_file(printed, run):
    """The class of a body is a value of the model error; other text is the path of a file."""
    given = (*SIZE, PULSE, "--friction", "0.6", *FEW, "--json")
    texts = {}
    for kind in ("machined", "object"):
        texts[kind] = json.loads(printed(*given, "--set", f"predict.model_error={kind}"))["inputs"]["model_error"]
        assert texts[kind] == rk.predict(
            rk.Block(width=0.5, height=2.0), rk.pulses.sine(4.2, 0.8), friction=0.6, model_error=kind, count=16
        ).inputs["model_error"]  # fmt: skip
    assert texts["machined"] != texts["object"]
    code, _, err = run(*given, "--set", "predict.model_error=sculpture")  # negative control: no class
    assert code != 0
    assert "sculpture" in err


def test_a_file_says_everything(printed, tmp_path):
    path = tmp_path / "question.toml"
    path.write_text(FILE, "utf-8")
    out = printed(str(path), "--set", "predict.seed=3", "--json")
    found = rk.predict(
        rk.Block(width=0.5, height=2.0), rk.pulses.sine(4.2, 0.8), friction={"mean": 0.5, "deviation": 0.1},
        restitution=0.9, count=16, seed=3,
    )  # fmt: skip
    assert json.loads(out)["probability"] == plain(found.answer().plain())["probability"]


def test_what_is_printed_and_written(printed, tmp_path):
    picture, table = tmp_path / "found.png", tmp_path / "found.csv"
    out = printed(
        *SIZE, PULSE, "--motion", "sine:amplitude=1,period=0.8", *FEW, "-o", picture, "-o", table, "--details"
    )
    assert out.startswith("Block 0.5 x 2 m, ")
    assert "\nOverturning is " in out
    assert "not sampled:  placement" in out
    assert "Sobol" in out
    assert picture.stat().st_size > 10_000
    assert len(table.read_text("utf-8").splitlines()) == 3


def test_two_components_have_an_azimuth(printed, tmp_path):
    for name in ("ns", "ew"):
        text = "\n".join(f"{0.01 * k:.2f} {(4.0 if name == 'ns' else 1.0) * (-1) ** (k // 40):.1f}" for k in range(160))
        (tmp_path / f"{name}.txt").write_text(text, "utf-8")
    along = [f"--motion={axis}={tmp_path / name}.txt" for axis, name in (("x", "ns"), ("y", "ew"))]
    out = printed(*SIZE, *along, "--units", "m/s2", *FEW, "--json")
    assert "azimuth" in json.loads(out)["inputs"]


@pytest.mark.verifies("behaviour", room="doors")
def test_a_conservator_with_a_scan(tmp_path, capsys, monkeypatch):
    """The commands of docs/how_to/assessment.md give a picture, a probability and a report of an open scan in mm."""
    vertices, sides, _ = bad_scans.statue(12, 9)
    trimesh.Trimesh(1000.0 * vertices[:-1], sides, process=False).export(tmp_path / "statue.stl")
    text = DOCS.read_text("utf-8").partition("## Compute a probability from a scan")[2]
    commands = [line.split()[1:] for line in text.partition("\n\n```\n")[2].partition("```")[0].splitlines()]
    assert [words[0] for words in commands] == ["equilibria", "predict", "predict", "predict"]
    rows = [f"{0.01 * step:.2f},{3.0 * math.sin(0.06 * step):.6f}" for step in range(400)]
    (tmp_path / "record.csv").write_text("\n".join(["time (s),acceleration (m/s2)", *rows]), "utf-8")
    monkeypatch.chdir(tmp_path)
    said = []
    for words in commands:
        few = (*FAST, *(ONE if "--synthetic" in words else ())) if words[0] == "predict" else ()
        with pytest.raises(SystemExit) as stop:
            main([*words, *few])
        assert stop.value.code in {0, None}
        said.append(capsys.readouterr().out)
    assert "stable poses" in said[0]
    assert "Overturning is " in said[1]
    assert "given this motion (PGA " in said[1]
    assert "record" in said[1]
    assert said[2].partition("wrote")[0] == said[3].partition("wrote")[0] != said[1].partition("wrote")[0]
    assert all("! closed the open bottom" in each for each in said)
    assert (tmp_path / "statue.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "statue.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    ("arguments", "title"),
    [
        (["cabinet.toml"], "Cabinet 7"),
        (["shelf.toml"], "shelf"),
        ([*SIZE], "A body in an earthquake"),
        (["--width", "0.5", "--height", "2", "site.csv"], "A body in an earthquake"),
    ],
)
def test_the_title_of_a_report_is_the_name_of_the_body(printed, tmp_path, monkeypatch, arguments, title):
    """The title is the key name of the body file, or the name of the file; it is never the name of the record."""
    monkeypatch.chdir(tmp_path)
    block = "[block]\nwidth = 0.5\nheight = 2.0\n"
    Path("cabinet.toml").write_text(f'units = "m"\nname = "Cabinet 7"\n{block}', "utf-8")
    Path("shelf.toml").write_text(f'units = "m"\n{block}', "utf-8")
    rows = "\n".join(f"{0.01 * k:.2f},{4.0 * (-1) ** (k // 40):.1f}" for k in range(160))
    Path("site.csv").write_text(f"time [s],acceleration [m/s2]\n{rows}\n", "utf-8")
    motion = [] if arguments[-1] == "site.csv" else [PULSE]
    printed(*arguments, *motion, *FEW, "--output", "report.html")
    assert f"<title>{title}</title>" in Path("report.html").read_text("utf-8")


def test_reports_say_what_was_said(printed, tmp_path):
    """The page has the verdict, what was assumed and the numbers; an ending that is none is refused."""
    page = tmp_path / "found.html"
    out = printed(*SIZE, PULSE, *FEW, "--output", str(page))
    text = page.read_text("utf-8")
    assert out.splitlines()[3] in text
    assert "placement" in text
    assert "16 bodies under each motion" in text
    found = rk.predict(rk.Block(width=0.5, height=2.0), rk.pulses.sine(4.2, 0.8), count=16, contributions=False)
    with pytest.raises(rk.errors.RockingError, match=r"\.pdf or \.html"):
        rk.reports.report(found, tmp_path / "found.docx")
