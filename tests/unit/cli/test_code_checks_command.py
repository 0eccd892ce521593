"""`rocking code-checks`: what is printed and written, bodies in a grid, refusals."""

import csv

import numpy as np
import pytest

from rocking.decision.code_methods import CODE_METHODS, LEFT_OUT

COMMAND = "code-checks"
FAMILY = ("--synthetic", "firm-ground", "--count", 6, "--restitution", "housner")
GRID = ("--height", "60,400", "--slenderness", 5, "--units", "cm")


@pytest.mark.slow
def test_a_grid_of_bodies(printed, answered, tmp_path):
    """Every method has a line, and every body one of shares; JSON and CSV say the same, sources and readings too."""
    file = tmp_path / "codes.csv"
    page = printed(*GRID, *FAMILY, "--levels", "1.5,2", "--output", file, "--details")
    assert "bodies:       12 x 60 cm; 80 x 400 cm" in page
    assert "pga/(g tan alpha) = 1.5\n" in page
    found = answered(*GRID, *FAMILY, "--levels", "1.5,2")
    assert found["bodies"] == ["12 x 60 cm", "80 x 400 cm"]
    assert found["left_out"] == LEFT_OUT
    with file.open(newline="", encoding="utf-8") as rows:
        table = {(row["method"], row["body"], row["level"]): row for row in csv.DictReader(rows)}
    assert len(table) == 8 * 2 * 2
    for name, said in found["methods"].items():
        assert f"\n{name} " in page
        assert said["reading"] == CODE_METHODS[name].reading
        for k, body in enumerate(found["bodies"]):
            for j, level in enumerate(found["levels"]):
                called, row = said["called_safe"][k][j], table[name, body, level]
                assert (int(row["safe"]), int(row["overturned"])) == (
                    called["safe"], called["overturned"],
                )  # fmt: skip
                assert called["safe"] <= called["histories_known"] == 6
                assert row["outside"] == said["outside"]
    assert found["methods"]["italian-linear"]["called_safe"][0][1]["safe"] == 6


@pytest.mark.slow
def test_one_body_under_one_motion(printed, answered):
    """Of one case it is said whether it is safe; the levels are those of the motion; a side that is worse counts."""
    body = ("--width", 0.8, "--height", 2.2, "--centre", "0.52,0.9", "--mass", 650, "--depth", 1.2)
    page = printed(*body, "sine:amplitude=3.5,period=0.5")
    assert "0 of 1 overturned" in page
    assert "the weaker side governs" in page
    rows = {line.split()[0]: line.split()[1] for line in page.splitlines() if line.split()[:1]}
    assert (rows["static"], rows["italian-linear"]) == ("no", "yes")
    assert (rows["asce-43"], rows["kaneko-hayashi"], rows["housner-pulse"]) == ("outside", "outside", "yes")
    assert "asce-43: outside its domain: unequal sides\nkaneko-hayashi: outside its domain: not a rectangle\n" in page
    assert "vertical" not in page
    found = answered(*body, "sine:amplitude=3.5,period=0.5")
    assert found["methods"]["asce-43"]["outside"] == "unequal sides"
    assert found["worse_side_counts"] == [True]
    ratio = found["methods"]["static"]["called_safe"][0][0]["limit_ratio"]
    assert ratio == pytest.approx(3.5 / (9.80665 * 0.28 / 0.9), rel=1e-6)
    # negative control: the other side alone would be safe
    assert 3.5 / (9.80665 * 0.52 / 0.9) < 1.0


def test_a_giant_that_nothing_overturns(printed):
    """It is said in words that none overturned, not as a ratio of zero."""
    page = printed("--height", 1e3, "--width", 100, *FAMILY)
    assert "0 of 6 overturned" in page
    assert page.count("  none overturned        -\n") == 8


def test_levels_in_another_measure(answered):
    """Levels of PGA in g bring every motion there, and what a wide body cannot be judged by is outside."""
    found = answered("--width", 1, "--height", 0.6, *FAMILY, "--im", "pga", "--levels", "0.2g")
    assert found["levels"] == ["pga = 1.96133 m/s2"]
    assert found["methods"]["asce-43"]["called_safe"][0][0]["histories_known"] == 0
    assert found["methods"]["static"]["called_safe"][0][0] == {
        "histories_known": 6, "safe": 6, "overturned": 0, "limit_ratio": pytest.approx(0.12, rel=1e-9),
        "fraction_95": [0.0, pytest.approx(1.0 - 0.025 ** (1 / 6), rel=1e-9)], "fraction": 0.0,
    }  # fmt: skip


@pytest.mark.slow
def test_vertical_motion_is_in_the_answer(printed, answered, tmp_path):
    """Of a motion with a falling ground each method states its treatment, and the static limit includes it."""
    time = np.arange(1301) * 1e-3
    for name, values in (
        ("h", np.where(time < 0.5, 0.0, 0.6 * 9.80665)),
        ("v", np.where(time < 0.4, 0.0, -0.2 * 9.80665)),
    ):
        rows = "\n".join(f"{at:.3f},{value:.9f}" for at, value in zip(time, values, strict=True))
        (tmp_path / f"{name}.csv").write_text(f"time [s],acceleration [m/s2]\n{rows}\n", encoding="utf-8")
    words = ("--width", 0.6096, "--height", 0.9144, "--motion", f"x={tmp_path / 'h.csv'}")
    page = printed(*words, "--motion", f"z={tmp_path / 'v.csv'}")
    marked = [line.split()[1] for line in page.splitlines() if line.startswith("! ")]
    assert marked == ["italian-linear", "ishiyama", "kaneko-hayashi", "housner-pulse"]
    assert page.count("does not consider vertical motion.\n") == 4
    assert "\nstatic considers vertical motion: the vertical acceleration changes the weight at each sample.\n" in page
    assert "asce-43: outside its domain: vertical motion" in page
    found = answered(*words, "--motion", f"z={tmp_path / 'v.csv'}")
    assert found["motions_with_vertical"] == 1
    ratio = found["methods"]["static"]["called_safe"][0][0]["limit_ratio"]
    assert ratio == pytest.approx((0.6 + 0.2 / 1.5) * 1.5, rel=1e-8)
    assert answered(*words)["methods"]["static"]["called_safe"][0][0]["limit_ratio"] == pytest.approx(0.9, rel=1e-8)


def test_a_depth_that_is_the_weaker_side_is_stated(printed, answered):
    """The caution of the other commands; without it if the width is the weaker side."""
    size = ("--height", 2, "sine:amplitude=3,period=0.8")
    weak, strong = ("--width", 1.2, "--depth", 0.6), ("--width", 0.6, "--depth", 1.2)
    assert "The depth of 0.6 m is smaller" in answered(*size, *weak)["caution"]
    assert "The depth of 0.6 m is smaller" in " ".join(printed(*size, *weak).split())
    assert "caution" not in answered(*size, *strong)
    assert "smaller" not in printed(*size, *strong)
