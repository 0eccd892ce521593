"""`rocking validate-predictions`: invented trials, the same shuffled, bad rows, scans, refusals."""

import csv
import shutil

import pytest
from outcome_folders import BODY, FEW, outcome_folder

import rocking as rk

COMMAND = "validate-predictions"
pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="studies")]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return outcome_folder(tmp_path_factory.mktemp("tried"))


@pytest.fixture
def copy(folder, tmp_path):
    """A folder of the first two motions, to be damaged."""
    target = tmp_path / "tried"
    target.mkdir()
    for name in ("body.toml", "record_0.txt", "record_1.txt"):
        shutil.copy(folder / name, target)
    rows = (folder / "outcomes.csv").read_text("utf-8").splitlines()
    (target / "outcomes.csv").write_text("\n".join(rows[:13]), "utf-8")
    return target


@pytest.mark.verifies(
    "repeated sampling", "simulations whose friction, base and restitution are hidden", room="studies",
    control="test_outcomes_of_other_trials_are_not_foreseen",
)  # fmt: skip
def test_what_is_printed_and_written(run, folder, tmp_path):
    """Who knows what is hidden but for its distribution is better than plain curves; the same in every file."""
    files = [tmp_path / f"found.{ending}" for ending in ("png", "csv", "html")]
    code, out, err = run(folder, *(f"--output={file}" for file in files))
    assert (code, err) == (0, "")
    assert out.startswith("The prediction of overturning is better than the logistic regression on PGA and PGV")
    assert "The prediction of uplift" in out
    assert "sliding" not in out.partition("assumed")[0]  # nobody saw whether it slid
    assert "balanced" in out
    assert files[0].stat().st_size > 10_000
    with files[1].open(newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    seen = (folder / "outcomes.csv").read_text("utf-8").splitlines()
    assert len(table) == 2 * (len(seen) - 1)
    for row in table[:4]:
        assert seen[int(row["line"]) - 1].split(",")[2] == f"{float(row['outcome']):g}"
    assert "is better than the logistic regression" in files[2].read_text("utf-8")


@pytest.mark.verifies("negative control", room="studies")
def test_outcomes_of_other_trials_are_not_foreseen(answered, tmp_path):
    """The same trials, each with what was seen in another one."""
    found = answered(outcome_folder(tmp_path, shuffled=True))["events"]["overturning"]
    assert found["finding"] == "worse"
    assert "is not better" in found["verdict"]
    assert found["better_by"]["logistic"]["brier"]["high"] < 0.0


def test_json_is_the_python_call(answered, copy):
    """Probabilities are those of `predict` of the motions by themselves, which know nothing of the outcomes."""
    found = answered(copy, *FEW)
    record = rk.read_motion(copy / "record_0.txt", units="m/s2")
    options = {"friction": (0.1, 0.8), "base": (0.0, 0.02), "restitution": {"mean": 0.88, "deviation": 0.04}}
    options["model_error"] = "off"
    alone = rk.predict(
        BODY, [record.scaled(s) for s in (0.6, 1.0, 1.7)], **options, centre=1.0, count=16, contributions=False
    )
    steps = found["events"]["overturning"]["reliability"]
    assert found["trials"] == sum(step["count"] for step in steps) == 12
    other = rk.read_motion(copy / "record_1.txt", units="m/s2")
    more = rk.predict(
        BODY, [other.scaled(s) for s in (0.6, 1.0, 1.7)], **options, centre=1.0, count=16, contributions=False
    )
    said = [*alone.chances["overturning"].per_motion, *more.chances["overturning"].per_motion]
    mean = sum((16.0 * p + 0.5) / 17.0 for p in said) / 6.0
    assert sum(step["predicted"] * step["count"] for step in steps) / 12.0 == pytest.approx(mean, rel=1e-12)
    assert found["events"]["overturning"]["finding"] == "not resolved"  # of two motions


def test_bad_rows_are_told_and_touch_nothing(run, answered, copy):
    before = answered(copy, *FEW)
    with (copy / "outcomes.csv").open("a", encoding="utf-8") as file:
        file.write("\nrecord_0.txt,1,often,1\nrecord_9.txt,1,0,0\nbroken.txt,1,0,0\nstill.txt,1,0,0\n")
    (copy / "broken.txt").write_text("no numbers here", "utf-8")
    (copy / "still.txt").write_text("0 0\n0.1 0\n0.2 0", "utf-8")
    after = answered(copy, *FEW)
    assert after["events"] == before["events"]
    why = ("overturned must be 1, 0", "record_9.txt: no such file", "broken.txt", "zero at all times")
    for k, (each, words) in enumerate(zip(after["not_read"], why, strict=True)):
        assert each.startswith(f"outcomes.csv, line {14 + k}: ")
        assert words in each
    _, out, _ = run(copy, *FEW)
    assert "! outcomes.csv, line 14: overturned must be 1, 0, yes" in out


def test_components_of_one_file_are_of_one_motion(answered, copy):
    """Neither is left out while the curve is fitted to the other."""
    lines = "\n".join(f"{0.02 * k:.2f},{(-1) ** (k // 20):.1f},{(-1) ** (k // 13):.1f}" for k in range(80))
    (copy / "both.csv").write_text(f"time,NS [m/s2],EW [m/s2]\n{lines}", "utf-8")
    rows = "motion,overturned\nboth.csv#NS,0\nboth.csv#EW,0\nrecord_0.txt,0\n"
    (copy / "outcomes.csv").write_text(rows, "utf-8")
    found = answered(copy, *FEW, "--set", "predict.contributions=true")
    assert (found["trials"], found["events"]["overturning"]["motions"]) == (3, 2)


def test_a_scan_in_two_components(answered, tmp_path):
    """A block as a mesh in millimetres, with records in g along x and y."""
    points = [(x, y, z) for z in (0, 1600) for x, y in ((0, 0), (400, 0), (400, 400), (0, 400))]
    faces = ["4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
    lines = [*(f"v {x} {y} {z}" for x, y, z in points), *(f"f {face}" for face in faces)]
    (tmp_path / "statue.obj").write_text("\n".join(lines), "utf-8")
    for name, size in (("ns", 0.35), ("ew", 0.02)):
        text = "\n".join(f"{0.02 * k:.2f} {size * (-1) ** (k // 20):.3f}" for k in range(80))
        (tmp_path / f"{name}.txt").write_text(text, "utf-8")
    rows = "x;y;scale;overturned\nns.txt;ew.txt;0,01;no\nns.txt;ew.txt;3;yes\n"
    (tmp_path / "seen.csv").write_text(rows, "utf-8")
    found = answered(tmp_path, "--units", "mm,g", "--set", "predict.count=4", "--friction", "0.7")
    one, other = found["events"]["overturning"]["reliability"]
    assert (one["count"], one["observed"], other["observed"]) == (1, 0.0, 1.0)
    assert (one["predicted"], other["predicted"]) == (0.1, 0.9)  # none and all of 4
    assert "azimuth" in found["inputs"]


@pytest.mark.parametrize(
    ("damage", "words", "why"),
    [
        (lambda at: (at / "outcomes.csv").unlink(), (), "Use one table of outcomes"),
        (lambda at: (at / "body.toml").unlink(), (), "Use one body file (."),
        (lambda at: shutil.copy(at / "body.toml", at / "other.toml"), (), "got body.toml, other.toml"),
        (lambda at: (at / "outcomes.csv").write_text("motion,overturned\n", "utf-8"), (), "the table is empty"),
        (
            lambda at: (at / "outcomes.csv").write_text("motion,overturned\nx,1\n", "utf-8"),
            (),
            "line 2: x: no such file",
        ),
        (lambda at: (at / "outcomes.csv").write_text("motion,overturned\nrecord_0.txt,\n", "utf-8"), (), "are unknown"),
        (
            lambda at: None,
            ("--set", "motion.scale=2"),
            "time_step, units, vertical here, got scale",
        ),
        (lambda at: None, ("--set", "predict.fricton=0.4"), "did you mean friction"),
        (lambda at: None, ("--output", "found.xyz"), "unknown extension"),
        (shutil.rmtree, (), "no such folder"),
    ],
)
def test_refusals(refuses, copy, damage, words, why):
    damage(copy)
    refuses((copy, *words), why)


def test_records_without_a_unit_say_which_option(refuses, copy):
    text = (copy / "body.toml").read_text("utf-8").partition("[motion]")[0]
    (copy / "body.toml").write_text(text, "utf-8")
    refuses((copy,), "add motion.units with one of")
