"""`rocking assess`: one page, JSON, a report that can be signed, a question in a file, refusals."""

import pytest

pytestmark = pytest.mark.slow

COMMAND = "assess"
BODY = ("--width", 0.8, "--height", 2.2, "--depth", 1.2, "--mass", 650, "--centre", "0.52,0.9")
QUICK = (
    "--restitution",
    "ked",
    "--restitution",
    0.85,
    "--set",
    "predict.count=8",
    "--set",
    "predict.contributions=false",
)
PULSE = "sine:amplitude=7,period=0.8"


def test_a_page(printed):
    """Body, motion, outcome, margin and probability come first; --details has models, codes, causes and measures."""
    short = printed(*BODY, *QUICK, PULSE)
    page = printed(*BODY, *QUICK, PULSE, "--details")
    first = ("Block 0.8 x 2.2 m, 650 kg", "Ground motion: sine pulse", "", "OVERTURNING (1 of 1 motion, ")
    for line, text in zip(short.splitlines(), first, strict=False):
        assert line.startswith(text)
    assert short.splitlines()[:9] == page.splitlines()[:9]
    assert len(short.splitlines()) <= 26
    assumed = next(line for line in short.splitlines() if line.startswith("Assumed: "))
    assert len(assumed) < 200
    assert "depth 1 m" in printed("--width", "0.6", "--height", "2", *QUICK, PULSE)
    stated = printed("--width", "0.6", "--height", "2", "--depth", "0.7", *QUICK, PULSE)
    assert "depth" not in stated.partition("Assumed: ")[2].splitlines()[0]
    assert "--details" in short
    for sentence in ("The body overturns under 1 of 1 motion", "Margin to overturning: 0.", "With uncertain inputs"):
        assert f"\n{sentence}" in page
    for words in ("r = 0.85", "Causes", "Retrofit measures", "kN along the left edge", "Assumed: "):
        assert words in page
    assert "\nasce-43: outside its domain: unequal sides\n" in page
    assert len(page.splitlines()) < 60


def test_vertical_motion_is_on_the_page(printed, tmp_path):
    """Each method states its treatment of a vertical component; without one the page does not mention it."""
    for name, peak in (("level", 7.0), ("up", 2.0)):
        rows = "".join(f"{0.1 * k:.1f},{peak * (k % 4 == 1)}\n" for k in range(9))
        (tmp_path / f"{name}.csv").write_text(f"time [s],acceleration [m/s2]\n{rows}", encoding="utf-8")
    horizontal = (*BODY, *QUICK, "--motion", f"x={tmp_path / 'level.csv'}")
    page = printed(*horizontal, "--motion", f"z={tmp_path / 'up.csv'}", "--details")
    assert "Vertical motion: in 1 of 1 motions.\nstatic considers vertical motion" in page
    assert "! italian-linear does not consider vertical motion.\n" in page
    assert "ertical motion" not in printed(*horizontal, "--details")


def test_json_says_the_same(answered):
    """Everything as plain values, what stands on the report too."""
    found = answered(*BODY, *QUICK, PULSE, "--set", "assess.project=Archive")
    assert found["project"] == "Archive"
    assert set(found["models"]) == {"ked", "r = 0.85"}
    assert found["lowest"]["min_factor"] == min(each["min_factor"] for each in found["models"].values())
    assert found["remedies"]["tension"]["left"] == pytest.approx(650.0 * (7.0 * 0.9 - 9.80665 * 0.28) / 0.8, rel=1e-4)
    assert found["verdict"] == found["sentences"][0]


def test_a_report_is_signed(printed, tmp_path):
    """The report bears project, author and date, assumptions and references; a PDF and a picture are written too."""
    html, pdf = (tmp_path / f"report.{ending}" for ending in ("html", "pdf"))
    signed = [
        f"assess.{name}={words}" for name, words in (("project", "Archive"), ("author", "A. E."), ("date", "1 May"))
    ]
    printed(*BODY, *QUICK, PULSE, *(word for each in signed for word in ("--set", each)),
            "--output", html, "--output", pdf)  # fmt: skip
    text = html.read_text(encoding="utf-8")
    for words in ("Archive", "A. E.", "1 May", "signature", "No safety factor", "Housner 1963", "Measures", "<svg"):
        assert words in text
    assert pdf.read_bytes().startswith(b"%PDF")


def test_a_question_in_a_file(answered, tmp_path):
    """A file with [assess] says everything itself."""
    file = tmp_path / "cabinet.toml"
    file.write_text(
        'body = { units = "m", width = 0.8, height = 2.2, mass = 650.0, centre = [0.52, 0.9] }\n'
        f'[[motions]]\npulse = ["{PULSE}"]\n[predict]\ncount = 8\ncontributions = false\n'
        '[assess]\nrestitutions = ["ked"]\nmargin = 1.2\n',
        "utf-8",
    )  # fmt: skip
    found = answered(file)
    assert found["remedies"]["margin"] == 1.2
    assert list(found["models"]) == ["ked"]


def test_a_solid(printed, answered, tmp_path):
    """A solid has the same page, in space, with the plane body's code methods; one azimuth is one direction."""
    file = tmp_path / "tower.toml"
    file.write_text('units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.9, height = 1.5 }\n', "utf-8")
    quick = (file, *QUICK, "sine:amplitude=4,period=0.8", "--set", "predict.azimuth=0.3")
    page = printed(*quick, "--details")
    for words in (
        "Code methods: plane body",
        "The weakest direction is 0 deg",
        "of 1 motion",
        "r = 0.85",
        "Assumed: ",
    ):
        assert words in page
    assert ", friction 0.55" not in page  # all of it slides, not one row
    assert len(page.splitlines()) < 50
    found = answered(*quick)
    assert found["solid"]["nearest_edge"] == pytest.approx(0.25)
    assert set(found["models"]) == {"ked", "r = 0.85"}


def test_a_weaker_depth_is_on_the_page(printed, answered, tmp_path):
    """Screen, --json and the report warn of a depth below the width; the mark of the report is not good."""
    options = ("--width", 0.8, "--height", 2.0, "--depth", 0.5, *QUICK, "sine:amplitude=3.6,period=0.8")
    answer = answered(*options)
    verdict, report = answer["verdict"], tmp_path / "report.html"
    assert answer["caution"] in verdict
    lines = printed(*options, "-o", report).splitlines()
    assert lines[3:5] == ["NO UPLIFT (0 of 1 motion, 1 model, 1 coefficient, both polarities)", answer["caution"]]
    shown = report.read_text(encoding="utf-8")
    assert verdict in shown
    assert f'<p class="fair">{verdict}' in shown
