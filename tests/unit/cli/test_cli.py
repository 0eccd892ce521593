"""The command line as a user meets it: what it prints, what it writes, how it refuses."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest

from rocking.cli import main
from rocking.evidence import league

ROOT = Path(__file__).parents[3]


def run(capsys, *words):
    """Exit code, standard output and standard error of `rocking WORDS`."""
    with pytest.raises(SystemExit) as stop:
        main([str(word) for word in words])
    printed = capsys.readouterr()
    return stop.value.code or 0, printed.out, printed.err


def test_cor_of_a_block(capsys):
    """`rocking cor --width 1 --height 4` prints every model, Housner's 0.911765 and KED's 0.947367 (Table 2)."""
    code, out, _ = run(capsys, "cor", "--width", 1, "--height", 4)
    assert code == 0
    for word in ("calibrated", "0.911765", "0.947367", "horizontal-momentum", "plastic-winkler", "h/b = 4"):
        assert word in out


def test_cor_json_and_csv(capsys, tmp_path):
    """JSON and CSV hold the same numbers as each other, for both feet of an asymmetric body."""
    path = tmp_path / "cor.csv"
    statue = ROOT / "examples" / "bodies" / "statue_on_pedestal.toml"
    code, out, _ = run(capsys, "cor", statue, "--json", "--out", path)
    answer = json.loads(out)
    assert code == 0
    assert set(answer["coefficients"]) == {"left", "right"}
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    flat = [row for side in answer["coefficients"].values() for row in side]
    assert [float(row["coefficient_of_restitution"]) for row in rows] == [
        row["coefficient_of_restitution"] for row in flat
    ]


def test_cor_options(capsys, tmp_path):
    """Unit, angle, one foot, chosen models, interface factor, identities, own model and picture all do their work."""
    own = tmp_path / "mine.py"
    own.write_text(
        "import rocking as rk\nclass Mine(rk.restitution.RestitutionModel):\n    name = 'mine'\n"
        "    def raw_coefficient(self, body, onto):\n        return 0.5\n",
        encoding="utf-8",
    )
    picture = tmp_path / "body.svg"
    words = ["--restitution", f"{own}:Mine", "--restitution", "ked", "--identities", "--eta", "0.9", "--out", picture]
    words += ["--out", f"stages={tmp_path / 'stages.png'}"]
    code, out, err = run(capsys, "cor", "--width", 100, "--height", 400, "--units", "cm", "--onto", "left", *words)
    assert (code, err) == (0, "")
    assert "0.450000" in out
    assert f"{0.9 * 0.9473668350323697:.6f}" in out
    assert "coincident pivots: violated" in out
    assert "94.1 % stage 1" in out  # cos^2 alpha at h/b = 4 is 16/17
    assert (tmp_path / "stages.png").stat().st_size > 10_000
    assert picture.read_text(encoding="utf-8").startswith("<?xml")
    code, out, _ = run(
        capsys,
        "cor",
        "--set",
        "body.slenderness_angle=0.2449786631",
        "--set",
        "body.semi_diagonal=2",
        "--restitution",
        "housner",
        "--json",
    )
    assert json.loads(out)["body"]["sides"]["left"]["slenderness_ratio"] == pytest.approx(4.0)


REFUSED = {
    "negative": (["cor", "--width", "-1", "--height", "4"], "--width must be a number > 0 [m], got -1"),
    "zero": (["cor", "--width", "0", "--height", "4"], "--width must be a number > 0 [m], got 0"),
    "nan": (["cor", "--width", "nan", "--height", "4"], "--width must be a finite number [m]"),
    "degrees": (
        ["cor", "--set", "body.slenderness_angle=20", "--set", "body.semi_diagonal=1"],
        r"(0, pi/2) rad, got 20; degrees?",
    ),
    "half a block": (["cor", "--width", "1"], "--width and --height"),
    "nothing": (["cor"], "got none of them"),
    "both": (["cor", "x.toml", "--width", "1"], "not both"),
    "unknown model": (
        ["cor", "--width", "1", "--height", "4", "--restitution", "kde"],
        "no restitution model named 'kde'",
    ),
    "unknown unit": (["cor", "--width", "1", "--height", "4", "--units", "gal"], "one of m, cm, mm, ft, in"),
    "missing file": (["cor", "missing.toml"], "missing.toml: there is no such file"),
    "eta": (["cor", "--width", "1", "--height", "4", "--eta", "1.5"], "eta must be in (0, 1]"),
    "onto": (["cor", "--width", "1", "--height", "4", "--onto", "up"], 'onto must be "left"'),
    "gravity": (
        ["cor", "--width", "1", "--height", "4", "--set", "settings.gravity=0"],
        "settings.gravity must be a number > 0",
    ),
    "picture": (["cor", "--width", "1", "--height", "4", "--out", "a.bmp"], ".png, .svg or .pdf"),
    "own file": (["cor", "--width", "1", "--height", "4", "--restitution", "no.py:X"], "no file no.py"),
    "models": (["models", "kde"], "no restitution model named 'kde'"),
}


@pytest.mark.parametrize(("words", "sentence"), REFUSED.values(), ids=list(REFUSED))
def test_bad_input_gives_one_sentence_and_exit_code_2(capsys, words, sentence):
    """Bad input: one sentence on standard error, exit code 2, no number on standard output."""
    code, out, err = run(capsys, *words)
    assert code == 2
    assert sentence in err
    assert err.startswith("rocking: ")
    assert err.count("\n") == 1
    assert out == ""


def test_own_file_that_fails_is_one_sentence(capsys, tmp_path):
    """A user's model file that raises, or holds no model, is reported in one sentence."""
    for content, words in (("1/0", "ZeroDivisionError"), ("x = 1", "has no restitution model")):
        path = tmp_path / "mine.py"
        path.write_text(content, encoding="utf-8")
        code, _, err = run(capsys, "cor", "--width", 1, "--height", 4, "--restitution", f"{path}:Mine")
        assert code == 2
        assert words in err


def test_not_a_number_on_the_command_line(capsys):
    """A word where a number is needed is refused with exit code 2 and no traceback."""
    code, out, err = run(capsys, "cor", "--width", "wide", "--height", 4)
    assert (code, out) == (2, "")
    assert err == (
        "rocking: Invalid value for '--width': Input should be a valid number, unable to parse string as a number; "
        "see rocking --help\n"
    )
    assert run(capsys, "cor", "--nope")[0] == 2


def test_models(capsys):
    """`rocking models` tells reference, domain and defects of every model; as JSON too."""
    code, out, _ = run(capsys, "models")
    assert code == 0
    assert "doi:10.3390/buildings14072119" in out
    code, out, _ = run(capsys, "models", "ked", "--json")
    assert len(json.loads(out)["ked"]["known_defects"]) >= 6


def test_model_of_the_user_is_told_like_the_others(capsys, tmp_path):
    """A class in a file is named, with its title, as `rocking models ked` is."""
    own = tmp_path / "mine.py"
    own.write_text(
        "import rocking as rk\nclass Mine(rk.restitution.RestitutionModel):\n    name = 'mine'\n    title = 'of mine'\n"
        "    def raw_coefficient(self, body, onto):\n        return 0.5\n",
        encoding="utf-8",
    )
    code, out, _ = run(capsys, "models", f"{own}:Mine", "--json")
    assert (code, json.loads(out)[f"{own}:Mine"]["title"]) == (0, "of mine")
    code, _, err = run(capsys, "models", f"{own}:Yours")
    assert (code, "mine.py has no restitution model Yours; it has Mine" in err) == (2, True)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("motion", "body.toml"), "perhaps a body: see rocking cor body.toml"),
        (("spectrum", "body.toml"), "perhaps a body: see rocking cor body.toml"),
        (("cor", "m.csv"), "perhaps a record: see rocking motion m.csv"),
        (("fragility", "m.csv", "body.toml"), "the body comes first, then the motion: body.toml m.csv"),
    ],
)
def test_body_in_place_of_a_record_and_the_reverse(words, told, capsys, tmp_path, monkeypatch):
    """A file of the other kind is met with what it probably is, and with what to type."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "body.toml").write_text('units = "m"\nwidth = 0.5\nheight = 2.0\n')
    (tmp_path / "m.csv").write_text("".join(f"{0.01 * k},{k % 3}\n" for k in range(50)))
    code, out, err = run(capsys, *words)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert told in err


def test_paper_summary_and_json(capsys):
    """`rocking paper` prints tables, claims, league and verdict; --json holds them all as numbers."""
    code, out, _ = run(capsys, "paper")
    assert code == 0
    for words in ("Table 3: 54 of 54", "errata found: 10 of 10", "does not hold", "eta*ked", "Verdict"):
        assert words in out
    code, out, _ = run(capsys, "paper", "--json")
    answer = json.loads(out)
    assert {"claims", "errata", "league", "tables", "verdict", "calibration", "provenance"} <= set(answer)


def test_paper_folder(capsys, tmp_path):
    """`rocking paper --out` writes report, figures and tables, opens with what to look at, and needs nothing else."""
    code, out, _ = run(capsys, "paper", "--out", tmp_path / "report")
    assert code == 0
    assert out.startswith("What to look at")
    html = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "<img" not in html
    assert 'src="http' not in html
    assert "<script" not in html
    assert html.count("<svg") == 14
    assert (tmp_path / "report" / "report.pdf").read_bytes().startswith(b"%PDF")
    stems = {"figure_1", "figure_2", "figure_3", "figure_5", "figure_6", "figure_7", "figure_8", "figure_9"}
    for kind in ("png", "svg"):
        assert stems <= {path.stem for path in (tmp_path / "report" / "figures").glob(f"*.{kind}")}
    with (tmp_path / "report" / "tables" / "league.csv").open(encoding="utf-8-sig") as file:
        assert len(list(csv.reader(file))) == 1 + 16 + 3  # titles, models and fits, three contact beds


def test_paper_into_a_file_is_refused(capsys, tmp_path):
    """A folder that cannot be made is one sentence and exit code 2."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    code, _, err = run(capsys, "paper", "--out", tmp_path / "file")
    assert code == 2
    assert "cannot write to" in err


def test_version_and_help(capsys):
    """--version and --help end well."""
    assert run(capsys, "--version")[1].startswith("rocking 0.")
    assert "cor" in run(capsys, "--help")[1]


def test_help_is_quick():
    """`rocking --help` in a fresh process loads neither numpy nor pydantic: that is what keeps it under 0.5 s."""
    code = (
        "import sys\nfrom rocking.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "print('LOADED', [m for m in ('numpy', 'scipy', 'matplotlib', 'pydantic', 'shapely') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "LOADED []" in done.stdout


def test_league_is_whole_in_a_narrow_terminal(capsys, monkeypatch):
    """At 80 columns no number of the league is cut off, however long a model's name is."""
    monkeypatch.setenv("COLUMNS", "80")
    code, out, _ = run(capsys, "paper")
    table = out[out.index("League") : out.index("Verdict")]
    assert code == 0
    assert "…" not in table
    assert all(f"{row.rmse:.4f}" in table for row in league())
