"""The command line as a user meets it: what it prints, what it writes, how it refuses."""

import csv
import json
import subprocess
import sys

import pytest

import rocking as rk
from rocking.evidence import league
from rocking.motions.formats import formats
from rocking.reports.paper_document import reproduce

MINE = """import rocking as rk
class Mine(rk.restitution.RestitutionModel):
    name = "mine"
    title = "of mine"
    def raw_coefficient(self, body, foot):
        return 0.5
"""


@pytest.fixture
def own(file):
    """File of a model of the user's."""
    return file(MINE, "mine.py")


def test_cor_json_and_csv(run, tmp_path):
    """JSON and CSV hold the same numbers as each other, for both feet of an asymmetric body."""
    path = tmp_path / "cor.csv"
    statue = rk.examples.path("statue")
    code, out, _ = run("restitution", statue, "--json", "--output", path)
    answer = json.loads(out)
    assert code == 0
    assert set(answer["coefficients"]) == {"left", "right"}
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    flat = [row for side in answer["coefficients"].values() for row in side]
    assert [float(row["coefficient"]) for row in rows] == [row["coefficient"] for row in flat]


@pytest.mark.slow
def test_cor_options(run, own, tmp_path):
    """Unit, angle, one foot, chosen models, interface factor, identities, own model and picture all do their work."""
    picture = tmp_path / "body.svg"
    words = ["--restitution", f"{own}:Mine", "--restitution", "0.9*ked", "--check-identities", "--output", picture]
    words += ["--output", f"stages={tmp_path / 'stages.png'}", "--details"]
    code, out, err = run("restitution", "--width", 100, "--height", 400, "--units", "cm", "--foot", "left", *words)
    assert (code, err) == (0, "")
    assert "0.500000" in out
    assert f"{0.9 * 0.9473668350323697:.6f}" in out
    assert "coincident pivots: violated" in out
    assert "94.1 % stage 1" in out  # cos^2 alpha at h/b = 4 is 16/17
    assert (tmp_path / "stages.png").stat().st_size > 10_000
    assert picture.read_text(encoding="utf-8").startswith("<?xml")
    angle = ("--set", "body.slenderness_angle=0.2449786631", "--set", "body.semi_diagonal=2")
    out = run("restitution", *angle, "--restitution", "housner", "--json")[1]
    assert json.loads(out)["body"]["sides"]["left"]["slenderness_ratio"] == pytest.approx(4.0)


def test_model_of_the_user_is_told_like_the_others(run, own):
    """A class in a file is named, with its title, as `rocking models ked` is."""
    code, out, _ = run("models", f"{own}:Mine", "--json")
    assert (code, json.loads(out)[f"{own}:Mine"]["title"]) == (0, "of mine")
    code, _, err = run("models", f"{own}:Yours")
    assert (code, "mine.py has no restitution model Yours; its models: Mine" in err) == (2, True)


@pytest.fixture(scope="module")
def reproduction():
    """The paper, recomputed once."""
    return reproduce()


@pytest.fixture
def paper(run, reproduction, monkeypatch):
    """Return what runs `rocking reproduce WORDS` in a narrow terminal."""
    monkeypatch.setattr("rocking.reports.paper_document.reproduce", lambda: reproduction)
    monkeypatch.setenv("COLUMNS", "80")
    return lambda *words: run("reproduce", *words)


@pytest.mark.slow
def test_paper_summary_and_json(paper):
    """`rocking reproduce` prints tables, claims, league and verdict, no number cut off; --json has numbers."""
    code, out, _ = paper("--details")
    assert code == 0
    for words in ("Table 3: 54 of 54", "Errata found: 10 of 10", "does not hold", "eta*ked", "Verdict"):
        assert words in out
    table = out[out.index("League") : out.index("Verdict")]
    assert "…" not in table
    assert all(f"{row.rmse:.4f}" in table for row in league())
    answer = json.loads(paper("--json")[1])
    assert {"claims", "errata", "league", "tables", "verdict", "calibration", "provenance"} <= set(answer)


@pytest.mark.slow
def test_paper_folder(paper, tmp_path):
    """`rocking reproduce --output` writes report, figures and tables, and names them."""
    code, out, _ = paper("--output", tmp_path / "report")
    assert code == 0
    assert f"wrote {tmp_path / 'report' / 'figures'}" in out
    html = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert not [word for word in ("<img", 'src="http', "<script") if word in html]
    assert html.count("<svg") == 14
    assert (tmp_path / "report" / "report.pdf").read_bytes().startswith(b"%PDF")
    stems = {f"figure_{k}" for k in (1, 2, 3, 5, 6, 7, 8, 9)}
    for kind in ("png", "svg"):
        assert stems <= {path.stem for path in (tmp_path / "report" / "figures").glob(f"*.{kind}")}
    with (tmp_path / "report" / "tables" / "league.csv").open(encoding="utf-8-sig") as file:
        assert len(list(csv.reader(file))) == 1 + 16 + 3  # titles, models and fits, three contact beds


def test_paper_into_a_file_is_refused(paper, refuses, tmp_path):
    """A folder that cannot be made is one sentence and exit code 2."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    refuses(("reproduce", "--output", tmp_path / "file"), "cannot write to")


@pytest.mark.slow
def test_help_is_quick():
    """`rocking --help` in a fresh process loads neither numpy nor pydantic: that is what keeps it under 0.5 s."""
    code = (
        "import sys\nfrom rocking.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "print('LOADED', [m for m in ('numpy', 'scipy', 'matplotlib', 'pydantic', 'shapely') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "LOADED []" in done.stdout


@pytest.mark.slow
def test_cor_says_which_model_to_use(run):
    """--recommend prints at most 8 models and the advice, --details the evidence too; JSON contains all of it."""
    words = ("restitution", "--width", 2, "--height", 16, "--units", "cm")
    found = rk.evidence.recommend(rk.Block(width=0.02, height=0.16))
    code, out, err = run(*words, "--recommend")
    assert (code, err) == (0, "")
    assert all(sentence in out for sentence in found.advice)
    assert not any(sentence in out for sentence in found.evidence)
    assert len(out.splitlines()) <= 24
    page = run(*words, "--recommend", "--details")[1]
    assert all(sentence in page for sentence in (*found.evidence, *found.advice))
    told = json.loads(run(*words, "--recommend", "--json")[1])["recommendation"]
    assert told["prediction"] == found.prediction
    assert told["envelope"] == list(found.envelope)
    assert [row["model"] for row in told["models"]] == [each.name for each in found.models]
    assert "recommendation" not in json.loads(run(*words, "--json")[1])


def test_with_json_a_refusal_is_data(run):
    """Scripts read parameter, limits and place of an error, in the same form as from the API; without, a sentence."""
    code, out, err = run("restitution", "--width", -1, "--height", 4, "--json")
    error = json.loads(err)["error"]
    assert (code, out, error["parameter"]) == (2, "", "body.block.width")
    assert error["message"] == "--width must be a number > 0 m, got -1; see rocking restitution --help"
    assert (error["value"], error["allowed"]["low"], error["allowed"]["high"], error["unit"]) == (-1, 0.0, None, "m")
    unknown = json.loads(run("restitution", "--wide", 1, "--json")[2])["error"]
    assert (unknown["parameter"], unknown["message"].split(":")[0]) == ("--wide", "No such option")
    code, out, err = run("restitution", "--width", -1, "--height", 4)
    assert (code, out, err) == (2, "", f"rocking: {error['message']}\n")


def test_table_names_every_format(run):
    """One line per format with its unit and step; --details adds all extensions and the notes."""
    code, short, err = run("record", "formats")
    assert (code, err) == (0, "")
    out = run("record", "formats", "--details")[1]
    assert len(short.splitlines()) == 1 + len(formats()) + 3
    rows = {line.split()[0]: line for line in short.splitlines()}
    assert set(formats()) <= set(rows)
    for name, kind in formats().items():
        assert all(suffix in out for suffix in kind.suffixes)
        assert ("required" in rows[name]) == (not (kind.states_unit and kind.states_time_step))
        assert " ".join(kind.notes.split()) in " ".join(out.split())
        assert not kind.notes or kind.notes[:40] not in short
    assert "--units" in short


def test_json_is_what_the_formats_say(run):
    """JSON holds title, endings, unit, step and notes of each format, in the order in which they are tried."""
    code, out, _ = run("record", "formats", "--json")
    answer = json.loads(out)
    assert code == 0
    assert list(answer) == list(formats())
    assert answer["peer"]["suffixes"] == [".at2"]
    assert answer["peer"]["states_unit"]
    assert not answer["columns"]["states_unit"]
    assert all(
        set(entry) == {"title", "suffixes", "states_unit", "states_time_step", "notes"} for entry in answer.values()
    )
