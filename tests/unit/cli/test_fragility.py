"""`rocking fragility`: numbers equal the studies and counts by hand, files, words, refusals in one sentence."""

import csv
import math
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import rocking as rk
from rocking.studies import SyntheticSet
from rocking.studies.fragility import fragility_analysis

pytestmark = pytest.mark.slow

COMMAND = "fragility"

G = 9.80665
SIZE = ("--width", "0.25", "--height", "1.25")
BLOCK = rk.Block(width=0.25, height=1.25)
FAMILY = ("--synthetic", "point-source", "--count", "16", "--seed", "3")
LEVELS = ("--levels", "0.1g:0.9g:9")
SINES = [word for t in (0.5, 0.7) for word in ("--motion", f"sine:amplitude=1,period={t}")]


@pytest.fixture(scope="module")
def motions():
    """The motions of FAMILY."""
    made = SyntheticSet("point-source", 16, 3)
    return [made[k] for k in range(16)]


def test_motions_follow_the_body(answered, tmp_path):
    """Motions are words after the body, as of other commands; --motion says the same, and dimensions need no body."""
    file = tmp_path / "body.wkt"
    file.write_text("POLYGON ((0 0, 250 0, 250 1250, 0 1250, 0 0))")
    pulses, levels = SINES[1::2], ("--levels", "0.2g,0.6g")
    first = answered(*SIZE, *SINES, *levels)
    assert first["motions"]["count"] == 2
    assert answered(*SIZE, *pulses, *levels) == answered(*SIZE, pulses[0], *SINES[2:], *levels) == first
    drawn = answered(file, *pulses, "--units", "mm", *levels)
    assert drawn["results"][0]["reached"] == first["results"][0]["reached"]


def test_json_is_the_python_call(answered, motions):
    """Counts, medians and dispersions of stripes are those of the study, bit by bit; intervals hold them."""
    answer = answered(*SIZE, *FAMILY, *LEVELS, "--limit-states", "0.2,0.5")
    found = fragility_analysis(BLOCK, motions, np.linspace(0.1 * G, 0.9 * G, 9), im="pga", limit_states=(0.2, 0.5))
    (result,) = answer["results"]
    assert answer["levels"] == found.levels.tolist()
    assert result["reached"] == {name: counts.tolist() for name, counts in found.counts.items()}
    assert [each["name"] for each in answer["motions"].pop("sources")] == [motion.name for motion in motions]
    assert answer["motions"] == {"kind": "synthetic", "count": 16, "family": "point-source", "seed": 3}
    # g b / h
    assert answer["uplift_threshold"] == pytest.approx(0.2 * G, rel=1e-14, abs=0.0)
    assert set(result["curves"]) == {"rotation > 0.2 alpha", "rotation > 0.5 alpha", "overturned"}
    for name, fit in found.fits.items():
        curve = result["curves"][name]
        assert (curve["median"], curve["dispersion"], curve["verdict"]) == (fit.median, fit.dispersion, fit.verdict)
        assert curve["median_95"][0] < curve["median"] < curve["median_95"][1]
    curve, fit = result["curves"]["overturned"], found.fits["overturned"]
    # a motion serves at every level
    assert curve["median_95"] == list(fit.interval("median", method="bootstrap"))
    assert curve["median_95"] != list(fit.interval("median", method="profile"))
    assert answer["comparison"] is None


def test_nulls_where_there_is_nothing(answered):
    """Where no level decides or nothing overturns there is null; the keys do not depend on what is found."""
    many, none = (answered(*SIZE, *FAMILY, "--levels", levels) for levels in ("0.1g:0.9g:9", "0.05g,0.1g"))
    uneven = answered("--width", 0.25, "--height", 1.25, "--centre", "0.11,0.6", *FAMILY, "--levels", "0.1g,0.3g")
    assert uneven["uplift_threshold"] is None  # between both sides the sign of the peak decides
    assert uneven["lowest_uplift"] == pytest.approx(0.11 / 0.6 * G, rel=1e-12)
    first, second = many["results"][0], none["results"][0]
    assert (list(many), list(first)) == (list(none), list(second))
    assert list(first["curves"]["overturned"]) == list(second["curves"]["overturned"])
    assert second["curves"]["overturned"]["median"] is None
    assert second["curves"]["overturned"]["median_95"] == [None, None]


def test_pulses_against_single_simulations(answered):
    """What is counted is what single simulations of the scaled pulses say."""
    answer = answered(*SIZE, *SINES, "--levels", "2,4,6", "--restitution", "0.9")
    assert (answer["motions"]["kind"], answer["motions"]["count"]) == ("pulses", 2)
    wanted = [
        sum(
            rk.simulate(BLOCK, rk.pulses.sine(level, period), 0.9).outcome is rk.Outcome.OVERTURNED
            for period in (0.5, 0.7)
        )
        for level in (2.0, 4.0, 6.0)
    ]
    assert answer["results"][0]["reached"]["overturned"] == wanted
    assert 0 < sum(wanted) < 6


def test_incremental(printed, answered):
    """Intervals and first crossings are the study's; an interval that stays open ends in null."""
    words = ("--width", "0.4", "--height", "1.6", *SINES, "--levels", "3,6,9", "--restitution", "0.9")
    (result,) = answered(*words, "--analysis", "incremental")["results"]
    pulses = [rk.pulses.sine(1.0, period) for period in (0.5, 0.7)]
    found = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, [3.0, 6.0, 9.0], 0.9, analysis="incremental")
    ends = [tuple(one["interval"]) for one in result["overturning_intervals"]]
    assert ends == [(i.start, i.end if math.isfinite(i.end) else None) for i in found.intervals]
    assert None in [end for _, end in ends]
    assert result["first_crossings"] == found.first_crossings.tolist()
    # the second ceases to overturn it at 8.667 m/s2
    assert result["resurrected_motions"] == found.resurrected() == [1]
    out = printed(*words, "--analysis", "incremental", "--details")
    assert "First crossing: " in out
    assert "Fraction: " in out


def test_resurrection_is_said(run, answered):
    """Between 3.485 and 3.631 times g alpha a sine of Omega = 3 leaves a slender block standing (r = 0.9, linear)."""
    block = rk.Block(width=0.4, height=1.6)
    period = 2.0 * math.pi / (3.0 * block.frequency_parameter)
    unit = G * block.slenderness_angle
    words = (
        "--width", "0.4", "--height", "1.6", "--motion", f"sine:amplitude=1,period={period!r}",
        "--set", "settings.linear=true",
             "--restitution", "0.9", "--analysis", "incremental",
             "--levels", f"{3.0 * unit!r},{3.4 * unit!r},{3.55 * unit!r},{4 * unit!r}")  # fmt: skip
    (result,) = answered(*words)["results"]
    low, high = result["overturning_intervals"]
    assert low["interval"][1] / unit == pytest.approx(3.48466273332249203, rel=1e-7)
    assert high["interval"][0] / unit == pytest.approx(3.6311498724447945014, rel=1e-7)
    assert result["resurrected_motions_over_1_percent"] == [0]
    sentence = "Under 1 of 1 motion the body overturns at a level but not at a higher level"
    assert sentence in run(*words, "--details")[1]


def test_cloud(run, answered, motions):
    """A cloud takes the motions as they are, times a factor; its line is the study's."""
    answer = answered(*SIZE, *FAMILY, "--analysis", "cloud", "--scale", "4", "--im", "pgv")
    found = fragility_analysis(BLOCK, motions, im="pgv", scale=4.0, analysis="cloud")
    (result,) = answer["results"]
    assert answer["levels"] == found.levels.tolist()
    assert sum(result["trials"]) == 16
    assert result["regression"]["slope"] == found.regression.slope
    assert answer["uplift_threshold"] is None
    page = run(*SIZE, *FAMILY, "--analysis", "cloud", "--scale", "4", "--im", "pgv", "--details")[1]
    assert f"slope {found.regression.slope:.3g}, scatter" in page
    assert "no level of this measure alone decides" in page


def test_comparison(run, answered, tmp_path):
    """Several restitutions give a result each, flips counted by hand, one table of counts."""
    path = tmp_path / "counts.csv"
    words = (*SIZE, *FAMILY, *LEVELS, "--restitution", "0.95", "--restitution", "0.7", "--output", path)
    answer = answered(*words)
    first, second = (np.array(one["reached"]["overturned"]) for one in answer["results"])
    base, other = answer["comparison"]["choices"]
    assert [base["choice"], other["choice"]] == ["0.95", "0.7"]
    assert (base["overturned"], other["overturned"]) == (first.sum(), second.sum())
    assert other["only_second"] - other["only_first"] == second.sum() - first.sum() < 0
    rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
    assert [row["restitution"] for row in rows] == 9 * ["0.95"] + 9 * ["0.7"]
    assert [int(row["reached overturned [-]"]) for row in rows] == [*first, *second]
    out = run(*words)[1]
    assert "With 0.7 instead of 0.95, the outcome differs in" in out


def test_page_in_the_unit_of_the_levels(run, answered):
    """Medians are printed in g where the levels were; the same in m/s2 otherwise."""
    words = (*SIZE, *FAMILY)
    median = answered(*words, *LEVELS)["results"][0]["curves"]["overturned"]["median"]
    code, out, _ = run(*words, *LEVELS)
    row = next(line for line in out.splitlines() if line.startswith("overturned"))
    assert code == 0
    assert "median [g]" in out
    assert f" {median / G:.4g} " in row
    both = run(*words, *LEVELS, "--restitution", "0.95", "--restitution", "0.7")[1]
    at = float(re.search(r"the probability by at most [^)]*\) at ([\d.]+) g", " ".join(both.split()))[1])
    assert 0.1 <= at <= 0.9
    levels = ",".join(repr(float(x)) for x in np.linspace(0.1 * G, 0.9 * G, 9))
    out = run(*words, "--levels", levels)[1]
    assert "median [m/s2]" in out
    assert f" {median:.4g} " in next(line for line in out.splitlines() if line.startswith("overturned"))
    assert "certain above 1.961 m/s2 (0.2 g), impossible below; 0 of " in out


def test_no_curve_is_said(run):
    """Levels that lift nothing: the verdict says what the data bound, with exit code 0."""
    code, out, err = run(*SIZE, *FAMILY, "--levels", "0.05g,0.1g")
    assert (code, err) == (0, "")
    # one-sided bound of 16 trials: 1 - 0.05 ** (1 / 16) = 0.171
    assert "No failures" in out
    assert "below 0.171" in out


def test_few_motions_have_no_interval(run, answered):
    """Two motions at many levels give a curve, but no interval: drawn anew they would look certain."""
    words = (*SIZE, *SINES, "--levels", "1.5:6:19", "--restitution", "0.9")
    median = answered(*words)["results"][0]["curves"]["overturned"]["median"]
    out = run(*words, "--details")[1]
    row = next(line for line in out.splitlines() if line.startswith("overturned "))
    # median and dispersion alone
    assert (" to " in row, row.split()[1]) == (False, f"{median:.4g}")
    assert "No interval of overturned: each motion is used at every level, and there are too few motions (2 " in out


def test_the_method_of_the_intervals_is_said(run):
    """16 motions have one capacity each; of 30 whole ones are drawn anew."""
    few, many = (run(*SIZE, *FAMILY[:3], count, *LEVELS, "--details")[1] for count in ("16", "30"))
    assert "one capacity per motion" in few
    assert "bootstrap of whole motions" in many


def test_levels_that_serve(answered):
    """Without levels of PGA 16 are taken, from 0.9 to 9 times what lifts the body, in equal ratios."""
    levels = answered(*SIZE, *FAMILY)["levels"]
    np.testing.assert_allclose(levels, 0.2 * G * np.geomspace(0.9, 9.0, 16), rtol=1e-12)


def test_every_file(run, tmp_path):
    """Picture, counts, P-58, NRML, workbook, MATLAB and netCDF are written and hold the same medians."""
    import openpyxl
    import scipy.io
    import xarray as xr

    paths = {kind: tmp_path / f"f.{end}" for kind, end in (
        ("picture", "svg"), ("csv", "csv"), ("p58", "p58.csv"), ("pelicun", "pelicun.csv"), ("nrml", "xml"),
        ("excel", "xlsx"), ("mat", "mat"), ("netcdf", "nc"))}  # fmt: skip
    words = [part for kind, path in paths.items() for part in ("--output", f"{kind}={path}")]
    words += ["--name", "vase & stand", "--crossing-curves", "common-dispersion"]
    code, out, err = run(*SIZE, *FAMILY, *LEVELS, *words)
    assert (code, err) == (0, "")
    assert [line[6:] for line in out.splitlines() if line.startswith("wrote ")] == [str(p) for p in paths.values()]
    p58 = list(csv.DictReader(paths["p58"].read_text(encoding="utf-8").splitlines()))
    medians = [float(row["Median Demand"]) for row in p58]
    dispersions = [float(row["Total Dispersion (Beta)"]) for row in p58]
    assert len(medians) == 2
    assert {row["Demand Unit"] for row in p58} == {"g"}
    assert medians[0] < medians[1]
    assert dispersions[0] == dispersions[1]
    assert {row["Component ID"] for row in p58} == {"vase & stand"}
    (row,) = csv.DictReader(paths["pelicun"].read_text(encoding="utf-8").splitlines())
    for k, median in enumerate(medians, 1):
        assert float(row[f"LS{k}-Theta_0"]) == pytest.approx(median, rel=1e-14)
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    params = [one.attrib for one in ET.parse(paths["nrml"]).iter(f"{space}params")]
    # mean and deviation of the lognormal variable itself, in g
    for one, median, dispersion in zip(params, medians, dispersions, strict=True):
        mean, deviation = float(one["mean"]), float(one["stddev"])
        spread = math.sqrt(math.log1p((deviation / mean) ** 2))
        assert spread == pytest.approx(dispersion, rel=1e-12, abs=0.0)
        assert mean / math.exp(0.5 * spread**2) == pytest.approx(median, rel=1e-12, abs=0.0)
    assert "parameters" in openpyxl.load_workbook(paths["excel"]).sheetnames
    mat = scipy.io.loadmat(paths["mat"], squeeze_me=True)["fragility"]
    np.testing.assert_allclose(mat["median"].item(), np.multiply(medians, G), rtol=1e-14)
    with xr.open_dataset(paths["netcdf"], engine="h5netcdf") as found:
        np.testing.assert_allclose(found["median"].values, np.multiply(medians, G), rtol=1e-14)
    assert paths["picture"].read_text(encoding="utf-8").startswith("<?xml")


def test_curves_that_cross_are_shown_as_they_are_exported(run, answered, tmp_path):
    """Where curves cross, screen, JSON and files have one dispersion, the reason, and each state alone."""
    answer = answered(*SIZE, *FAMILY, *LEVELS)
    curves = answer["results"][0]["curves"]
    least, worst = curves["rotation > 0.5 alpha"], curves["overturned"]
    assert worst["alone"]["dispersion"] > 1.2 * least["alone"]["dispersion"]
    assert worst["dispersion"] == least["dispersion"]
    assert (worst["method"], worst["median_95"]) == ("common-dispersion", [None, None])
    reason = answer["crossing_curves"]["adjusted"]
    assert reason.startswith("Separately fitted curves cross: at ")
    code, out, err = run(*SIZE, *FAMILY, *LEVELS, "--output", f"p58={tmp_path / 'p.csv'}", "--details")
    assert (code, err) == (0, "")
    words = " ".join(out.split())
    assert reason in words
    assert f"overturned alone: median {worst['alone']['median'] / G:.4g} g, 95 % " in words
    rows = list(csv.DictReader((tmp_path / "p.csv").read_text(encoding="utf-8").splitlines()))
    for row, curve in zip(rows, (least, worst), strict=True):
        assert float(row["Median Demand"]) * G == pytest.approx(curve["median"], rel=1e-14)
        assert float(row["Total Dispersion (Beta)"]) == curve["dispersion"]
        assert f"{float(row['Median Demand']):.4g} {curve['dispersion']:.3g}" in words
        assert reason.rstrip(".") in row["Data Quality and Relevance"]


def test_unsupported_measures_are_refused_before_the_computation(run, tmp_path, monkeypatch):
    """PELICUN over PGV is refused before a motion is simulated; P-58 over PGV is written."""
    pgv = (*SIZE, *FAMILY, "--im", "pgv", "--levels", "0.2:2:6", "--limit-states", "overturning")
    assert run(*pgv, "--output", f"p58={tmp_path / 'p58.csv'}")[0] == 0
    assert (tmp_path / "p58.csv").exists()

    def computed(*_, **__):
        raise AssertionError("the analysis was computed")

    monkeypatch.setattr("rocking.cli.fragility_answer.FragilityAnswer.of", computed)
    with pytest.raises(AssertionError, match="was computed"):  # the control
        run(*pgv, "--output", f"csv={tmp_path / 'c.csv'}")
    code, _, err = run(*pgv, "--output", f"pelicun={tmp_path / 'p.csv'}", "--output", f"csv={tmp_path / 'c.csv'}")
    assert code == 2
    assert "PELICUN requires curves over pga or sa(period) with 5 % damping, got 'pgv'; for other measures" in err


def test_curves_that_cross_can_be_refused(run, answered, tmp_path):
    """With refuse each state alone is shown, there is no NRML, and the option that helps is named."""
    refuse = (*SIZE, *FAMILY, *LEVELS, "--crossing-curves", "refuse")
    curves = answered(*refuse)["results"][0]["curves"]
    assert curves["overturned"]["dispersion"] > 1.2 * curves["rotation > 0.5 alpha"]["dispersion"]
    assert curves["overturned"]["alone"] is None
    code, _, err = run(*refuse, "--output", tmp_path / "n.xml")
    assert code == 2
    assert err.startswith("rocking: curves must not cross")
    assert "--crossing-curves keep-uplift fits one dispersion" in err
    assert list(tmp_path.iterdir()) == []
    assert run(*refuse, "--output", tmp_path / "m.mat")[0] == 0


def test_states_are_chosen(run, answered, tmp_path):
    """A state is left out of screen, JSON and files; a word that is no state is refused."""
    whole, part = (answered(*SIZE, *FAMILY, *LEVELS, *more) for more in ((), ("--limit-states", "overturning")))
    assert list(part["results"][0]["reached"]) == list(part["results"][0]["curves"]) == ["overturned"]
    alone = whole["results"][0]["curves"]["overturned"]["alone"]
    assert part["results"][0]["curves"]["overturned"]["median"] == alone["median"]
    assert part["crossing_curves"]["adjusted"] == ""
    file = tmp_path / "p.csv"
    code, out, _ = run(*SIZE, *FAMILY, *LEVELS, "--limit-states", "overturning", "--output", f"p58={file}")
    assert code == 0
    rows = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    assert [row["Damage State Description"] for row in rows] == ["overturned"]
    assert "rotation > 0.5" not in out
    # the outcomes of the lesser state form a step, which no common dispersion describes
    code, out, err = run(*SIZE, *FAMILY, *LEVELS, "--limit-states", "0.2,overturning", "--output", f"p58={file}")
    assert code == 2
    assert (
        "The curves stay separate, because no common dispersion fits the states rotation > 0.2 alpha, overturned" in out
    )
    assert "Select fewer states with --limit-states" in err
    for bad in ("falling", "overturned", "0.5,0.2,rocking", "rocking,rocking", ""):
        code, _, err = run(*SIZE, *FAMILY, *LEVELS, "--limit-states", bad)
        assert code == 2, bad
        assert "limit-states" in err, bad


def test_counts_as_csv(answered, tmp_path):
    """Counts at each level and the fitted probability, the lognormal distribution of median and dispersion."""
    path = tmp_path / "c.csv"
    answer = answered(*SIZE, *FAMILY, *LEVELS, "--output", path)
    rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
    assert [float(row["pga [m/s2]"]) for row in rows] == answer["levels"]
    curve = answer["results"][0]["curves"]["overturned"]
    for row in rows:
        z = math.log(float(row["pga [m/s2]"]) / curve["median"]) / curve["dispersion"]
        assert float(row["fitted overturned [-]"]) == pytest.approx(0.5 * math.erfc(-z / math.sqrt(2.0)), rel=1e-9)
        # no curve where PGA decides
        assert row["fitted rocking [-]"] == ""
    # 0.2 g is the threshold itself, to the last bit
    assert [int(row["reached rocking [-]"]) for row in rows if row is not rows[1]] == [0, *7 * [16]]


@pytest.mark.parametrize("analysis", ["incremental", "cloud", "comparison"])
def test_pictures(run, tmp_path, analysis):
    """Every analysis draws its picture."""
    path = tmp_path / "p.png"
    words = {
        "incremental": (*LEVELS, "--analysis", "incremental"),
        "cloud": ("--analysis", "cloud", "--scale", "4"),
        "comparison": (*LEVELS, "--restitution", "ked", "--restitution", "0.8"),
    }[analysis]
    assert run(*SIZE, *FAMILY, *words, "--output", path)[0] == 0
    assert path.read_bytes().startswith(b"\x89PNG")


def test_nothing_to_export(run, tmp_path):
    """Where there is no curve the numbers are printed, then one sentence says why there is no file."""
    path = tmp_path / "n.xml"
    code, out, err = run(*SIZE, *FAMILY, "--levels", "0.05g,0.1g", "--output", path)
    assert code == 2
    assert "No failures" in out
    assert err.startswith("rocking: nothing to export: no state")
    assert not path.exists()
