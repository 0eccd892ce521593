"""Fragility as files: each is read back by other means; words are harmless everywhere."""

import csv
import json
import math
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.errors import InvalidValueError, MissingExtraError, extra
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_analysis
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
from rocking.studies.fragility.export import (
    fema_p58_table,
    intensity_type,
    moments_of_lognormal,
    table,
    to_csv,
    to_excel,
    to_mat,
    to_netcdf,
    to_nrml,
    with_added_dispersion,
)
from rocking.tables import safe_cell

CURVES = FragilityCurve("rotation > 0.5 alpha", 3.1, 0.25), FragilityCurve("overturned", 4.7, 0.4)
REACHED = {"overturned": np.array([0, 4, 9])}
NASTY = "=HYPERLINK(\"x\") <statue> & 'co' é"


def model(**change):
    """Two curves against PGA."""
    fields = {
        "name": "statue 1", "measure": "pga", "unit": "m/s2", "curves": CURVES, "levels": [2.0, 4.0, 8.0],
        "trials": np.array([10, 10, 9]), "reached": REACHED, "source": "ten records", "uplift_threshold": 2.1,
        "about": {"software": "rocking"},
    }  # fmt: skip
    return FragilityModel(**(fields | change))


@pytest.mark.parametrize("which", ["parameters", "points", "fema-p58"])
def test_csv_reads_back_to_the_last_digit(tmp_path, which):
    """Numbers in the file are those of the table, bit by bit."""
    wanted = table(model(), which)
    with to_csv(model(), tmp_path / "f.csv", which).open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == list(wanted.header)
    assert len(rows) == 1 + len(wanted.rows)
    for text, row in zip(rows[1:], wanted.rows, strict=True):
        for cell, value in zip(text, row, strict=True):
            assert cell == value if isinstance(value, str) else float(cell) == value


def test_points_hold_what_the_curves_say():
    """Fitted columns are the normal distribution of the logarithm, observed ones the counts."""
    made = table(model(), "points")
    columns = dict(zip(made.header, zip(*made.rows, strict=True), strict=True))
    expected = [0.5 * math.erfc(-math.log(x / 4.7) / 0.4 / math.sqrt(2.0)) for x in (2.0, 4.0, 8.0)]
    np.testing.assert_allclose(columns["fitted overturned [-]"], expected, rtol=1e-13)
    assert columns["observed overturned [histories]"] == (0, 4, 9)


def test_fema_p58_columns():
    """One row a damage state, from the least, with median, dispersion, demand and source."""
    made = fema_p58_table(model(), "a statue", "Peak ground acceleration")
    rows = [dict(zip(made.header, row, strict=True)) for row in made.rows]
    assert [row["Damage State"] for row in rows] == ["DS1", "DS2"]
    assert rows[1]["Median Demand"] == 4.7
    assert rows[1]["Total Dispersion (Beta)"] == 0.4
    assert rows[1]["Demand Parameter"] == "Peak ground acceleration"
    assert rows[1]["Source of Data"] == "ten records"
    assert with_added_dispersion(0.4, 0.3, 1.2) == pytest.approx(1.3, rel=1e-15)


@pytest.mark.parametrize("word", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", "  =1", "=cmd|'/c calc'!A0"])
def test_formulas_become_words(tmp_path, word):
    """A name that a spreadsheet would run starts with an apostrophe in the file; a plain one does not."""
    assert str(safe_cell(word)).startswith("'")
    with to_csv(model(name=word, source=word), tmp_path / "f.csv").open(encoding="utf-8", newline="") as file:
        cells = [cell for row in csv.reader(file) for cell in row]
    assert not [cell for cell in cells if cell.strip()[:1] in {"=", "+", "-", "@"}]
    assert safe_cell("a statue = 1") == "a statue = 1"
    assert safe_cell(-1.5) == -1.5


def test_cells_are_finite():
    """NaN and infinity never get into a table."""
    for bad in (math.nan, math.inf):
        with pytest.raises(InvalidValueError):
            safe_cell(bad)


def test_mat_reads_back(tmp_path):
    """MATLAB's structure holds curves, counts and words."""
    made = loadmat(to_mat(model(), tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
    assert made.median.tolist() == [3.1, 4.7]
    assert made.dispersion.tolist() == [0.25, 0.4]
    assert made.states.tolist() == ["rotation > 0.5 alpha", "overturned"]
    assert made.exceeded.tolist() == [0.0, 4.0, 9.0]
    assert made.probability.shape == (2, 3)
    assert json.loads(made.provenance) == {"software": "rocking"}


def test_netcdf_reads_back(tmp_path):
    """The file that h5py opens holds the same numbers, with units."""
    h5py = pytest.importorskip("h5py")
    pytest.importorskip("h5netcdf")
    with h5py.File(to_netcdf(model(), tmp_path / "f.nc")) as file:
        assert file["median"][:].tolist() == [3.1, 4.7]
        assert file["level"].attrs["units"] in {"m/s2", b"m/s2"}
        assert file["exceeded"][:].tolist() == [[0, 4, 9]]


def test_excel_reads_back(tmp_path):
    """Every sheet is there, numbers as numbers, and a nasty name as a word."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(to_excel(model(name=NASTY), tmp_path / "f.xlsx"))
    assert book.sheetnames == ["parameters", "points", "fema-p58", "provenance"]
    sheet = book["parameters"]
    assert sheet["A2"].value == f"'{NASTY}"
    types = [cell.data_type for page in book for row in page.iter_rows() for cell in row]
    assert "f" not in types
    assert "n" in types
    assert [sheet["D2"].value, sheet["D3"].value] == [3.1, 4.7]


def test_excel_without_its_extra_says_what_to_install(tmp_path, monkeypatch):
    """Where openpyxl is missing, the error names it and the extra."""
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(MissingExtraError, match=r"Excel needs openpyxl.*\.\[\w+\]"):
        to_excel(model(), tmp_path / "f.xlsx")
    assert extra("json", "nothing") is json


def parsed(path):
    """Function nodes of an NRML file, by an XML parser and the schema's names alone."""
    space = {"n": "http://openquake.org/xmlns/nrml/0.5"}
    node = ET.parse(path).getroot().find("n:fragilityModel", space)
    function = node.find("n:fragilityFunction", space)
    return node, function, function.find("n:imls", space), function.findall("n:params", space), space


def test_nrml_names_and_limits(tmp_path):
    """Attributes are those that OpenQuake reads; PGA is in g; nothing rocks below the threshold."""
    node, function, imls, params, space = parsed(to_nrml(model(), tmp_path / "f.xml"))
    assert node.attrib == {"id": "statue_1", "assetCategory": "contents", "lossCategory": "contents"}
    assert function.attrib == {"id": "statue 1", "format": "continuous", "shape": "logncdf"}
    assert imls.attrib["imt"] == "PGA"
    assert float(imls.attrib["noDamageLimit"]) == pytest.approx(2.1 / 9.80665, rel=1e-15)
    assert float(imls.attrib["maxIML"]) >= 8.0 / 9.80665
    assert [p.attrib["ls"] for p in params] == node.find("n:limitStates", space).text.split()
    assert params[1].attrib["ls"] == "overturned"


def test_nrml_escapes_names(tmp_path):
    """Angle brackets, quotes and ampersands in a name survive the file; what XML cannot hold is refused."""
    path = to_nrml(model(name=NASTY, source="a < b & c"), tmp_path / "f.xml")
    node, function, _, _, space = parsed(path)
    assert function.attrib["id"] == NASTY
    assert node.find("n:description", space).text == "a < b & c"
    assert "<statue>" not in path.read_text(encoding="utf-8")
    for bad in ("\x00", "\ud800", "bell\x07", ""):
        with pytest.raises(InvalidValueError):
            to_nrml(model(name=bad), tmp_path / "g.xml")


def test_nrml_limit_states_are_distinct_words(tmp_path):
    """States that differ only in signs get different names without blanks."""
    curves = tuple(FragilityCurve(name, 2.0 + k, 0.3) for k, name in enumerate(["a>b", "a above b", "0.5", "é"]))
    _, _, _, params, _ = parsed(to_nrml(model(curves=curves), tmp_path / "f.xml"))
    names = [p.attrib["ls"] for p in params]
    assert len(set(names)) == 4
    assert all(name.replace("_", "").isalnum() and name[0].isalpha() for name in names)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("pga", ("PGA", 1 / 9.80665)),
        ("pgv", ("PGV", 100.0)),
        ("sa(0.3)", ("SA(0.3)", 1 / 9.80665)),
        ("arias", ("IA", 1.0)),
    ],
)
def test_nrml_units(name, wanted):
    """g for accelerations, cm/s for PGV, m/s for Arias intensity."""
    assert intensity_type(name) == wanted


def test_nrml_refuses_what_openquake_does_not_know(tmp_path):
    """Normalised measures, other damping, other loss categories."""
    for name in ("pga/(g tan alpha)", "housner", "sa(0.3,0.1)"):
        with pytest.raises(InvalidValueError, match="OpenQuake knows"):
            to_nrml(model(measure=name), tmp_path / "f.xml")
    with pytest.raises(InvalidValueError, match="loss_category"):
        to_nrml(model(), tmp_path / "f.xml", loss_category="all")
    with pytest.raises(InvalidValueError):
        moments_of_lognormal(1.0, 30.0)
    assert not list(tmp_path.iterdir())


def test_moments_against_integrals():
    """Mean and standard deviation of the lognormal variable by numerical integration over the normal one."""
    z, weight = np.polynomial.hermite_e.hermegauss(80)
    x = 3.0 * np.exp(0.4 * z)
    mean = float(weight @ x / weight.sum())
    deviation = math.sqrt(float(weight @ (x - mean) ** 2 / weight.sum()))
    assert moments_of_lognormal(3.0, 0.4) == (pytest.approx(mean, rel=1e-12), pytest.approx(deviation, rel=1e-12))


def test_models_of_analyses():
    """An analysis becomes curves with its counts; states without a curve are named; none at all is refused."""
    pulses = [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 0.8, 20)]
    found = multiple_stripe_analysis(rk.Block(width=0.4, height=1.6), pulses, [3.0, 4.0, 5.0, 6.0], restitution=0.9)
    made = model_of(found, "block", "pulses")
    assert [c.state for c in made.curves] == ["rotation > 0.5 alpha", "overturned"]
    assert made.curves[1].median == found.fits["overturned"].median
    np.testing.assert_allclose(
        made.curves[1].probability(found.levels), found.fits["overturned"].probability(found.levels), rtol=1e-12
    )
    assert made.reached["rocking"].tolist() == [20] * 4
    assert made.uplift_threshold == found.uplift.threshold
    none = multiple_stripe_analysis(rk.Block(width=0.4, height=1.6), pulses, [0.5, 1.0])
    with pytest.raises(InvalidValueError, match="nothing to export"):
        model_of(none, "block")


@pytest.mark.parametrize(
    "change",
    [
        {"curves": ()}, {"curves": (CURVES[0], CURVES[0])}, {"levels": [1.0]}, {"levels": [3.0, 2.0, 1.0]},
        {"trials": np.array([1])}, {"reached": {"x": np.array([1, 2])}},
    ],
)  # fmt: skip
def test_models_that_do_not_fit_are_refused(change):
    """No curve, two of one name, levels that do not increase, counts of another length."""
    with pytest.raises(InvalidValueError):
        model(**change)


@pytest.mark.parametrize("values", [(0.0, 0.4), (1.0, 0.0), (math.nan, 0.4), (1.0, math.inf), (-1.0, 0.3)])
def test_curves_without_meaning_are_refused(values):
    """Median and dispersion are finite and above zero."""
    with pytest.raises(InvalidValueError):
        FragilityCurve("overturned", *values)


def test_paths_and_tables_that_do_not_exist(tmp_path):
    """A folder, a missing folder, a number, an unknown table."""
    for bad in (tmp_path, tmp_path / "no" / "f.csv", 3):
        with pytest.raises(InvalidValueError):
            to_csv(model(), bad)
    with pytest.raises(InvalidValueError):
        table(model(), "nrml")
