"""Curves as files: read back to the last digit, with what can be claimed of them, nested or refused."""

import csv
import json
import math
import sys
import xml.etree.ElementTree as ET
from functools import partial

import numpy as np
import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.errors import InvalidValueError, MissingExtraError, extra
from rocking.statistics import fit_lognormal, fit_ordered
from rocking.studies import fragility_analysis
from rocking.studies.fragility import (
    FragilityCurve,
    FragilityModel,
    fema_p58_table,
    model_of,
    to_csv,
    to_excel,
    to_mat,
    to_netcdf,
    to_nrml,
)
from rocking.studies.fragility.curves import curve_of, largest_excess
from rocking.studies.fragility.export import intensity_type, moments_of_lognormal, table
from rocking.tables import safe_cell

pytestmark = pytest.mark.verifies(room="studies")

CURVES = FragilityCurve("rotation > 0.5 alpha", 3.1, 0.25), FragilityCurve("overturned", 4.7, 0.4)
REACHED = {"overturned": np.array([0, 4, 9])}
NASTY = "=HYPERLINK(\"x\") <statue> & 'co' é"


def model(**change):
    """Two curves against PGA."""
    fields = {
        "name": "statue 1", "im": "pga", "unit": "m/s2", "curves": CURVES, "levels": [2.0, 4.0, 8.0],
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
    assert rows[1]["Median Demand"] == pytest.approx(4.7 / 9.80665, rel=1e-14)
    assert rows[1]["Demand Unit"] == "g"
    assert rows[1]["Total Dispersion (Beta)"] == 0.4
    assert rows[1]["Demand Parameter"] == "Peak ground acceleration"
    assert rows[1]["Source of Data"] == "ten records"


def test_pelicun_reads_a_row():
    """Columns and words are those of SimCenter's library (power_network, Hazus v5.1, fragility.csv); medians in g."""
    made = table(model(), "pelicun")
    assert ",".join(made.header) == (
        "ID,Incomplete,Demand-Type,Demand-Unit,Demand-Offset,Demand-Directional,LS1-Family,LS1-Theta_0,LS1-Theta_1,"
        "LS1-DamageStateWeights,LS2-Family,LS2-Theta_0,LS2-Theta_1,LS2-DamageStateWeights"
    )
    (row,) = made.rows
    assert row[1:7] == (0, "Peak Ground Acceleration", "g", 0, 1, "lognormal")
    assert row[11] == pytest.approx(4.7 / 9.80665, rel=1e-14)
    assert (row[8], row[12]) == (0.25, 0.4)
    spectral = table(model(im="sa(1.0)"), "pelicun")
    assert spectral.rows[0][2] == "Spectral Acceleration|1.0"
    with pytest.raises(InvalidValueError, match=r"PELICUN requires curves over pga or sa\(period\)"):
        table(model(im="pgv"), "pelicun")


@pytest.mark.parametrize("word", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", "  =1", "=cmd|'/c calc'!A0"])
def test_formulas_become_words(tmp_path, word):
    """A name that a spreadsheet would run starts with an apostrophe in the file; a plain one does not."""
    assert str(safe_cell(word)).startswith("'")
    with to_csv(model(name=word, source=word), tmp_path / "f.csv").open(encoding="utf-8", newline="") as file:
        cells = [cell for row in csv.reader(file) for cell in row]
    assert not [cell for cell in cells if cell.strip()[:1] in {"=", "+", "-", "@"}]
    assert safe_cell("a statue = 1") == "a statue = 1"
    assert safe_cell(-1.5) == -1.5


def test_mat_reads_back(tmp_path):
    """MATLAB's structure holds curves, counts and words."""
    made = loadmat(to_mat(model(), tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
    assert made.median.tolist() == [3.1, 4.7]
    assert made.dispersion.tolist() == [0.25, 0.4]
    assert made.limit_states.tolist() == ["rotation > 0.5 alpha", "overturned"]
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
    with pytest.raises(MissingExtraError, match=r'Excel needs openpyxl.*"rocking\[excel\]"'):
        to_excel(model(), tmp_path / "f.xlsx")
    assert extra("json", "nothing") is json


def parsed(path):
    """Function nodes of an NRML file, by an XML parser and the schema's names alone."""
    space = {"n": "http://openquake.org/xmlns/nrml/0.5"}
    node = ET.parse(path).getroot().find("n:fragilityModel", space)
    function = node.find("n:fragilityFunction", space)
    return node, function, function.find("n:imls", space), function.findall("n:params", space), space


def test_nrml_names_and_limits(tmp_path):
    """Attributes are those that OpenQuake reads; PGA is in g; nothing rocks below the threshold.

    Brackets, quotes and ampersands survive; states that differ only in signs get different names without blanks.
    """
    node, function, imls, params, space = parsed(to_nrml(model(), tmp_path / "f.xml"))
    assert node.attrib == {"id": "statue_1", "assetCategory": "contents", "lossCategory": "contents"}
    assert function.attrib == {"id": "statue 1", "format": "continuous", "shape": "logncdf"}
    assert imls.attrib["imt"] == "PGA"
    assert float(imls.attrib["noDamageLimit"]) == pytest.approx(2.1 / 9.80665, rel=1e-15, abs=0.0)
    assert float(imls.attrib["maxIML"]) >= 8.0 / 9.80665
    assert [p.attrib["ls"] for p in params] == node.find("n:limitStates", space).text.split()
    assert params[1].attrib["ls"] == "overturned"
    path = to_nrml(model(name=NASTY, source="a < b & c"), tmp_path / "f.xml")
    node, function, _, _, space = parsed(path)
    assert function.attrib["id"] == NASTY
    assert node.find("n:description", space).text == "a < b & c | pga in g"
    assert "<statue>" not in path.read_text(encoding="utf-8")
    curves = tuple(FragilityCurve(name, 2.0 + k, 0.3) for k, name in enumerate(["a>b", "a above b", "0.5", "é"]))
    names = [p.attrib["ls"] for p in parsed(to_nrml(model(curves=curves), tmp_path / "f.xml"))[3]]
    assert len(set(names)) == 4
    assert all(name.replace("_", "").isalnum() and name[0].isalpha() for name in names)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("pga", ("PGA", "g", 1 / 9.80665)),
        ("pgv", ("PGV", "cm/s", 100.0)),
        ("sa(0.3)", ("SA(0.3)", "g", 1 / 9.80665)),
        ("arias", ("IA", "m/s", 1.0)),
    ],
)
def test_nrml_units(name, wanted):
    """g for accelerations, cm/s for PGV, m/s for Arias intensity."""
    assert intensity_type(name) == wanted


def test_nrml_refuses_what_openquake_does_not_know(tmp_path):
    """Normalised measures, other damping, other loss categories."""
    for name in ("pga/(g tan alpha)", "housner", "sa(0.3,0.1)"):
        with pytest.raises(InvalidValueError, match="OpenQuake supports"):
            to_nrml(model(im=name), tmp_path / "f.xml")
    for bad in ("\x00", "\ud800", "bell\x07", ""):  # what XML cannot hold
        with pytest.raises(InvalidValueError):
            to_nrml(model(name=bad), tmp_path / "f.xml")
    with pytest.raises(InvalidValueError, match="loss_category"):
        to_nrml(model(), tmp_path / "f.xml", loss_category="all")
    with pytest.raises(InvalidValueError):
        moments_of_lognormal(1.0, 30.0)
    assert not list(tmp_path.iterdir())


@pytest.mark.verifies("computed anew", "Gauss-Hermite quadrature", within="1e-12")
def test_moments_against_integrals():
    """Mean and standard deviation of the lognormal variable by numerical integration over the normal one."""
    z, weight = np.polynomial.hermite_e.hermegauss(80)
    x = 3.0 * np.exp(0.4 * z)
    mean = float(weight @ x / weight.sum())
    deviation = math.sqrt(float(weight @ (x - mean) ** 2 / weight.sum()))
    assert moments_of_lognormal(3.0, 0.4) == (
        pytest.approx(mean, rel=1e-12, abs=0.0),
        pytest.approx(deviation, rel=1e-12, abs=0.0),
    )


@pytest.mark.slow
def test_models_of_analyses():
    """An analysis becomes curves with its counts; states without a curve are named; none at all is refused."""
    pulses = [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 0.8, 20)]
    found = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, [3.0, 4.0, 5.0, 6.0], restitution=0.9)
    made = model_of(found, "block", "pulses")
    assert [c.state for c in made.curves] == ["rotation > 0.5 alpha", "overturned"]
    assert made.curves[1].median == found.fits["overturned"].median
    np.testing.assert_allclose(
        made.curves[1].probability(found.levels), found.fits["overturned"].probability(found.levels), rtol=1e-12
    )
    assert made.reached["rocking"].tolist() == [20] * 4
    assert made.uplift_threshold == found.uplift.threshold
    none = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, [0.5, 1.0])
    with pytest.raises(InvalidValueError, match="nothing to export"):
        model_of(none, "block")


@pytest.mark.parametrize(
    "make",
    [
        *[partial(model, **change) for change in (
            {"curves": ()}, {"curves": (CURVES[0], CURVES[0])}, {"levels": [1.0]}, {"levels": [3.0, 2.0, 1.0]},
            {"trials": np.array([1])}, {"reached": {"x": np.array([1, 2])}},
        )],
        *[partial(FragilityCurve, "overturned", *values) for values in (
            (0.0, 0.4), (1.0, 0.0), (math.nan, 0.4), (1.0, math.inf), (-1.0, 0.3),
        )],
        partial(table, model(), "nrml"), partial(to_csv, model(), 3), partial(to_csv, model(), "no/such/folder/f.csv"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused(make):
    """No curve, two of one name, levels that fall, counts of another length, curves without meaning, no file."""
    with pytest.raises(InvalidValueError):
        make()


TAG = "{http://openquake.org/xmlns/nrml/0.5}"
CROSSED = FragilityCurve("rotation > 0.5 alpha", 3.1, 0.2), FragilityCurve("overturned", 3.4, 0.8)


def claimed(**change):
    """Curves that cross, without counts."""
    return model(**({"curves": CROSSED, "reached": {}} | change))


STEP = ([1.0, 2.0, 3.0, 4.0], [0, 0, 10, 10])


def separated():
    """A model whose one curve is the penalised convention for outcomes that form a step."""
    fit = fit_lognormal(*STEP, [10] * 4)
    assert fit.separation.step
    return claimed(
        curves=(curve_of("overturned", fit),), levels=STEP[0], trials=np.full(4, 10),
        reached={"overturned": np.array(STEP[1])},
    ), fit  # fmt: skip


def test_a_penalised_curve_says_so_in_every_file(tmp_path):
    """Method and verdict of a curve that is a convention reach FEMA P-58, NRML, netCDF, MATLAB and CSV."""
    made, fit = separated()
    told = "a convention, not a result"
    assert told in fit.verdict
    rows = fema_p58_table(made)
    quality = rows.rows[0][rows.header.index("Data Quality and Relevance")]
    assert quality.startswith("Analytical; penalised; ")
    described = ET.parse(to_nrml(made, tmp_path / "f.xml")).getroot().find(f".//{TAG}description").text
    mat = loadmat(to_mat(made, tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
    assert mat.method == "penalised"
    attributes = made.dataset.attrs
    assert attributes["method"] == "overturned: penalised"
    parameters = table(made)
    cells = dict(zip(parameters.header, parameters.rows[0], strict=True))
    for words in (quality, described, mat.verdict, attributes["verdict"], cells["verdict"]):
        assert told in words
    assert cells["intervals by"] == "profile"
    # nothing bounds the dispersion of a step but the penalty: ends are numbers or empty, never infinite
    assert all(cells[name] == "" or math.isfinite(cells[name]) for name in parameters.header if " 95 % " in name)


def crossed():
    """A model whose worse state is likelier at low levels, with counts of 60 histories each."""
    levels = np.array([1.0, 2.0, 3.0, 4.0, 6.0])
    reached = {"rotation > 0.5 alpha": np.array([6, 16, 35, 50, 60]), "overturned": np.array([4, 14, 22, 32, 45])}
    return claimed(curves=CROSSED, levels=levels, trials=np.full(5, 60), reached=reached)


def test_curves_that_cross_are_refused(tmp_path):
    """Where and by how much is named, from the densities' closed form; nothing is written; a hair's breadth is let."""
    # extreme where the densities are equal: a dense grid finds it as well
    grid = np.linspace(2.1, 60.0, 400_001)
    apart = CROSSED[1].probability(grid) - CROSSED[0].probability(grid)
    words = f"at {grid[apart.argmax()] / 9.80665:.4g} g the probability of 'overturned' exceeds .* by {apart.max():.2g}"
    for write in (lambda: to_nrml(crossed(), tmp_path / "f.xml"), lambda: fema_p58_table(crossed())):
        with pytest.raises(InvalidValueError, match=words):
            write()
    assert not list(tmp_path.iterdir())
    inside = largest_excess(crossed(), 0.0, 60.0)
    everywhere = np.linspace(1e-3, 60.0, 400_001)
    difference = CROSSED[1].probability(everywhere) - CROSSED[0].probability(everywhere)
    assert inside.size == pytest.approx(difference.max(), rel=1e-6)
    assert inside.level == pytest.approx(everywhere[difference.argmax()], rel=1e-3)
    assert largest_excess(crossed(), 3.3, 60.0) is None  # above the crossing the order is right
    assert largest_excess(claimed(curves=CROSSED[:1]), 0.0, 60.0) is None
    with pytest.raises(InvalidValueError, match="crossing_curves must be one of"):
        to_nrml(crossed(), tmp_path / "f.xml", crossing_curves="ignore")


def test_one_dispersion_for_all_states_on_request(tmp_path):
    """The files hold the curves of the ordered fit instead, which never cross, and say how they were found."""
    made = crossed()
    fit = fit_ordered(made.levels, *made.reached.values(), made.trials, method="common-dispersion")
    rows = fema_p58_table(made, crossing_curves="common-dispersion")
    cells = [dict(zip(rows.header, row, strict=True)) for row in rows.rows]
    for cell, curve in zip(cells, (fit.rocked, fit.overturned), strict=True):
        assert cell["Median Demand"] == pytest.approx(curve[0] / 9.80665, rel=1e-14)
        assert cell["Total Dispersion (Beta)"] == curve[1]
        assert "common-dispersion" in cell["Data Quality and Relevance"]
    path = to_nrml(made, tmp_path / "f.xml", crossing_curves="common-dispersion")
    params = ET.parse(path).getroot().findall(f".//{TAG}params")
    mean = moments_of_lognormal(fit.overturned[0] / 9.80665, fit.overturned[1])[0]
    assert float(params[1].attrib["mean"]) == pytest.approx(mean, rel=1e-12, abs=0.0)
    to_csv(made, tmp_path / "f.csv", "fema-p58", crossing_curves="common-dispersion")
    with pytest.raises(InvalidValueError, match="counts of all states"):
        to_nrml(claimed(), tmp_path / "g.xml", crossing_curves="common-dispersion")


def test_a_workbook_keeps_what_is_sound(tmp_path):
    """Curves that cross leave words on the sheet of FEMA P-58, and the other sheets whole."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(to_excel(crossed(), tmp_path / "f.xlsx"))
    assert "must not cross" in book["fema-p58"]["A1"].value
    assert book["parameters"]["D2"].value == 3.1
    whole = openpyxl.load_workbook(to_excel(crossed(), tmp_path / "g.xlsx", crossing_curves="common-dispersion"))
    assert whole["fema-p58"].max_row == 3


def read_back(path):
    """Median [m/s2] and dispersion of each state of a file, by the documented rules of its format alone."""
    if path.suffix == ".xml":
        _, _, imls, params, _ = parsed(path)
        assert imls.attrib["imt"] == "PGA"  # in g, by the manual of OpenQuake
        moments = [(float(p.attrib["mean"]), float(p.attrib["stddev"])) for p in params]
        spread = [math.sqrt(math.log1p((deviation / mean) ** 2)) for mean, deviation in moments]
        return [(m * 9.80665 * math.exp(-0.5 * b * b), b) for (m, _), b in zip(moments, spread, strict=True)]
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if "Damage State" in rows[0]:
        sizes = {"g": 9.80665, "m/s2": 1.0}
        return [
            (float(r["Median Demand"]) * sizes[r["Demand Unit"]], float(r["Total Dispersion (Beta)"])) for r in rows
        ]
    (row,) = rows
    # pelicun/model/demand_model.py: the demand of a component that is not directional is multiplied, 1.2 by default
    times = {"1": 1.0, "0": 1.2}[row["Demand-Directional"]]
    assert row["Demand-Unit"] == "g"
    return [(float(row[f"LS{k}-Theta_0"]) * 9.80665 / times, float(row[f"LS{k}-Theta_1"])) for k in (1, 2)]


@pytest.mark.verifies("computed anew", "the rules by which each format is read", within="1e-12")
def test_three_files_give_the_same_curves(tmp_path):
    """NRML, PELICUN and FEMA P-58 have one unit, g; what their readers compute is the curve that was exported."""
    made = model()
    paths = [
        to_nrml(made, tmp_path / "f.xml"),
        to_csv(made, tmp_path / "pelicun.csv", "pelicun"),
        to_csv(made, tmp_path / "p58.csv", "fema-p58"),
    ]
    for path in paths:
        for (median, dispersion), curve in zip(read_back(path), CURVES, strict=True):
            assert (median, dispersion) == pytest.approx((curve.median, curve.dispersion), rel=1e-12, abs=0.0)
    units = [table(made, "pelicun").rows[0][3], fema_p58_table(made).rows[0][7]]
    assert units == ["g", "g"]
    assert fema_p58_table(model(im="pgv", unit="m/s")).rows[1][4:8:3] == (pytest.approx(470.0, rel=1e-14), "cm/s")
    assert fema_p58_table(model(im="sa(1.0,0.1)")).rows[0][7] == "g"
    assert fema_p58_table(model(im="p pgv/(g tan alpha)", unit="-")).rows[0][7] == "dimensionless"


@pytest.mark.slow
def test_texts_of_files_name_the_unit(tmp_path):
    """Levels in the texts of NRML and FEMA P-58 are in g, as the curves are, and each has its unit."""
    made = fragility_analysis(
        rk.Block(width=0.4, height=1.6), [rk.pulses.sine(1.0, period) for period in np.linspace(0.3, 0.8, 20)],
        [3.0, 4.0, 5.0, 6.0], restitution=0.9,
    )  # fmt: skip
    curves = model_of(made, "block")
    fit = made.fits["overturned"]
    words = f"median {fit.median / 9.80665:.4g} g, dispersion {fit.dispersion:.3g}"
    described = ET.parse(to_nrml(curves, tmp_path / "f.xml", highest=6.0)).getroot().find(f".//{TAG}description").text
    assert "pga in g" in described
    assert words in described
    assert words in curves.curves[1].verdict
    assert words not in fit.verdict  # of a fit alone, which knows no unit
    made = separated()[0]
    assert curve_of("overturned", fit_lognormal(*STEP, [10] * 4), "pga", "m/s2").verdict.count(" g") >= 3
    assert "between 2 and 3" in made.curves[0].verdict
